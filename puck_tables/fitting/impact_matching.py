"""From slides with launches of their own to slides that impacts join.

The states before and after a kink say what was met.  Two tracks that bend at the same moment, two
radii apart, are two pucks that meet; any other kink is a wall, one of those given or one to be
found.  From a wall follow P_t = −k² Δω/r and P_n = √(|Δv|² − P_t²) per unit of mass, with n the
direction to the wall, so that −Δv = P_n n + P_t t.  What the law of impacts
(:mod:`puck_tables.motion.impact_law`) says of them are the values that the joint fit begins with,
or what is told where slides cannot be joined.

Without angles a slide tells its spin by how it slows and bends: each friction has spins of its own,
of either sign where the path hardly bends, and what the law of impact makes of them differs.  So
frictions and tilts are tried in turn; with both held every slide is a problem of its own, and the
few spins that suit it are found.  Candidates are all that slides and spins may go together, those
first in which the slides fit best.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise, product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import ImpactSpec, Slide, WallLine, state_at
from puck_tables.fitting.least_squares import ROBUST, multi_start
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.parameters import OF_PAIRS, OF_WALLS
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.starts import numbers_with
from puck_tables.fitting.touches import SlideIndex
from puck_tables.motion.impact_law import along_normal, law_of_impulses

_TOGETHER = 2.0  # steps between frames within which two tracks bend at one moment
_NEAR = 1.0  # radii: how far off two pucks, or a puck and a wall that was given, may seem to be
_BOUNCES = 1.5  # the largest restitution that noise may show
_GRIPS = 0.97  # of the impulse that stops the rims
_REACH, _REACH_FRAMES = 0.4, 4.0  # of the time between impacts, and at least

Line = tuple[tuple[float, float], tuple[float, float]]


class Kink(NamedTuple):
    """What is seen of an impact from the slides on both sides.

    ``piece``: the one before; ``time`` s after the start of the first track; ``before``,
    ``after``: x, y, vx, vy, spin of the puck there.
    """

    piece: int
    time: float
    before: FloatArray
    after: FloatArray


class ImpactMatch(NamedTuple):
    """An impact as both sides show it: of one bend with a wall, or of two.

    ``tangential``: β, if the rims did not slide all the time; ``ratio``: μ, if they did.
    """

    kinks_of_slides: tuple[Kink, ...]
    toward: float
    restitution: float
    tangential: float
    ratio: float
    mass: float

    @property
    def pieces(self) -> tuple[int, ...]:
        """The pieces that end there."""
        return tuple(kink.piece for kink in self.kinks_of_slides)


def matched_impacts(
    problem: Problem, pieces: tuple[SlideIndex, ...], x: FloatArray
) -> list[ImpactMatch]:
    """The impacts that slides show, in the order of time; ``x``: their unknowns."""
    kinks_of_slides = [
        _kink(problem, x, n) for n in range(len(pieces) - 1)
        if pieces[n].track == pieces[n + 1].track and pieces[n].slide + 1 == pieces[n + 1].slide
    ]  # fmt: skip
    radius = problem.spec.scales(problem.numbers_at(x))[2]
    step = max(film.usual_step for film in problem.films)
    taken: set[int] = set()
    matches = []
    near = [
        (abs(math.hypot(*(one.before[:2] - two.before[:2])) - 2.0 * radius), i, k)
        for (i, one), (k, two) in combinations(enumerate(kinks_of_slides), 2)
        if pieces[one.piece].track != pieces[two.piece].track
        and abs(one.time - two.time) <= _TOGETHER * step
    ]
    for deviations, i, k in sorted(near):
        if deviations < _NEAR * radius and not taken & {i, k}:
            match_ = _of_two(problem, x, kinks_of_slides[i], kinks_of_slides[k])
            if match_ is not None:
                matches.append(match_)
                taken |= {i, k}
    alone = [kink for k, kink in enumerate(kinks_of_slides) if k not in taken]
    matches += filter(None, (_of_wall(problem, x, kink) for kink in alone))
    return sorted(matches, key=lambda one: one.kinks_of_slides[0].time)


def _kink(problem: Problem, x: FloatArray, n: int) -> Kink:
    """Between piece ``n`` and the next."""
    launches, result = problem.launches(x), problem.numbers_at(x)
    moving = problem.moving(result)
    first = problem.films[0].start
    one, two = problem.films[n], problem.films[n + 1]
    slides = [Slide(film.start - first, launches[k]) for k, film in ((n, one), (n + 1, two))]
    # straight lines through both ends of the gap meet nearest where the impact was
    last, start = slides[0].since + float(one.time[-1]), slides[1].since
    end, begin, gap = state_at(moving, slides[0], last), slides[1].launch, start - last
    closing = end[2:4] - begin[2:4]
    apart = begin[:2] - begin[2:4] * gap - end[:2]
    size = float(closing @ closing)
    since = float(apart @ closing) / size if size > 0.0 else 0.5 * gap
    time = last + min(max(since, -gap), 2.0 * gap)
    # before its launch a slide goes on as it slows
    later = state_at(moving, slides[1], start + gap)
    back = begin[2:5] - (later[2:5] - begin[2:5]) * (start - time) / gap
    before = state_at(moving, slides[0], max(time, slides[0].since))
    return Kink(n, time, before[:5], np.concatenate([begin[:2], back]))


def _numbers(problem: Problem, x: FloatArray) -> tuple[float, float]:
    """Radius of the puck and its radius of gyration over it."""
    result = problem.numbers_at(x)
    return problem.spec.scales(result)[2], problem.gyration(result)


def _of_wall(problem: Problem, x: FloatArray, kink: Kink) -> ImpactMatch | None:
    """An impact with a wall; None if nothing pushed the puck back."""
    radius, gyration = _numbers(problem, x)
    kick = kink.before[2:4] - kink.after[2:4]
    rub = float(kink.before[4] - kink.after[4]) * gyration**2 * radius
    if not abs(rub) < 0.7 * math.hypot(*kick):  # without angles spin is hardly known
        rub = 0.0
    push = math.sqrt(max(float(kick @ kick) - rub * rub, 0.0))
    toward = math.atan2(kick[1], kick[0]) - math.atan2(rub, push)
    vx, vy, spin = kink.before[2:5].tolist()
    approach, slip = along_normal(vx, vy, radius * spin, math.cos(toward), math.sin(toward))
    if not (approach > 0.0 and approach < push < (1.0 + _BOUNCES) * approach):
        return None
    law = law_of_impulses(approach, slip, 1.0, 1.0 + gyration**-2, push, rub)
    return ImpactMatch((kink,), toward, *law, math.inf)


def _of_two(problem: Problem, x: FloatArray, one: Kink, two: Kink) -> ImpactMatch | None:
    """An impact of two pucks; None if they were not pushed apart."""
    radius, gyration = _numbers(problem, x)
    dx, dy, vx, vy, _ = (two.before - one.before).tolist()
    apart = math.hypot(dx, dy) or 1.0
    nx, ny = dx / apart, dy / apart
    rims = radius * float(one.before[4] + two.before[4])
    approach, slip = along_normal(-vx, -vy, rims, nx, ny)
    kick, other = (one.before - one.after).tolist(), (two.after - two.before).tolist()
    push, rub = along_normal(kick[2], kick[3], 0.0, nx, ny)
    answer, _ = along_normal(other[2], other[3], 0.0, nx, ny)
    if not (push > 0.0 and answer > 0.0 and approach > 0.0):
        return None
    mass, soft = push / answer, 1.0 + answer / push
    law = law_of_impulses(approach, slip, soft, (1.0 + gyration**-2) * soft, push, rub)
    return ImpactMatch((one, two), math.atan2(ny, nx), *law, mass)


class CoupledFit(NamedTuple):
    """Slides that are joined: what least squares are asked, unknowns to begin with.

    ``pieces``: for each piece its track in ``problem``, and the first of its frames there.
    """

    problem: Problem
    start: FloatArray
    pieces: tuple[int, ...]


def coupled(
    problem: Problem, x: FloatArray, pieces: tuple[SlideIndex, ...], films: tuple[Observations,
    ...], spec: FitSpec, lines: Sequence[Line],
) -> list[CoupledFit]:  # fmt: skip
    """The problem of slides that impacts join; none where there is no impact.

    Where rims seem to stop on what they meet in each of several impacts there is another, in which
    they may slide.  ``problem``, ``x``: of slides, each with a launch of its own, and a way in
    which they may move; ``films``: the tracks, uncut; ``spec``: with the numbers of impacts.
    """
    matches = matched_impacts(problem, pieces, x)
    if not matches:
        return []
    follows = {piece + 1 for match_ in matches for piece in match_.pieces}
    starts_new = [n for n in range(len(pieces)) if n not in follows]
    sequences = [[*range(*ends)] for ends in pairwise([*starts_new, len(pieces)])]
    tracks, home = [], {}
    for k, slides in enumerate(sequences):
        first, last = problem.films[slides[0]], problem.films[slides[-1]]
        whole = films[pieces[slides[0]].track]
        inside = (whole.frame >= first.frame[0]) & (whole.frame <= last.frame[-1])
        name = whole.name if len(slides) > 1 else first.name
        tracks.append(replace(whole.part(inside), name=name))
        home.update(dict.fromkeys(slides, k))
    walls: list[WallLine | None] = []
    starts: list[WallLine] = []
    impact_specs = []
    shift = problem.films[0].start - tracks[0].start
    radius = _numbers(problem, x)[0]
    step = max(film.usual_step for film in problem.films)
    numbers: dict[int, int] = {}
    for match_ in matches:
        kink = match_.kinks_of_slides[0]
        own = match_.pieces
        ends = [problem.films[n + more].time[-1] for n in own for more in (0, 1)]
        number = -1
        if len(own) == 1:
            known, wall = _wall_at(lines, kink, radius) or (-1 - len(walls), None)
            number = numbers.setdefault(known, len(walls))
            if number == len(walls):
                normal = np.array([math.cos(match_.toward), math.sin(match_.toward)])
                away = float(kink.before[:2] @ normal) + radius
                walls.append(wall)
                starts.append(wall or WallLine(match_.toward, away))
        films_met = tuple(home[n] for n in own)
        reach = max(_REACH * float(min(ends)), _REACH_FRAMES * step)
        impact_specs.append(ImpactSpec(kink.time + shift, reach, films_met, number))
    sizes = {len(match_.kinks_of_slides) for match_ in matches}
    grip = all(abs(1.0 + match_.tangential) > _GRIPS for match_ in matches)
    specs = [spec.coupled(sizes, grip)]
    if grip and len(matches) > 1:
        specs += [other for other in [spec.coupled(sizes, False)] if other.free != specs[0].free]
    firsts = [slides[0] for slides in sequences]
    launches, result = problem.launches(x)[firsts], []
    for one in specs:
        shared = Problem(
            one, tuple(tracks), problem.noise, problem.tall,
            rests=tuple(problem.rests[n] for n in firsts) if problem.rests else (),
            walls=tuple(walls), impact_specs=tuple(impact_specs), known=problem.known,
            smooth=problem.smooth,
        )  # fmt: skip
        values = {**problem.numbers_at(x), **_begin(one, matches)}
        for name in one.free:
            low, high = one.limits(name)
            values[name] = min(max(values[name], low), high)
        start = shared.unknowns(values, launches, tuple(starts))
        result.append(CoupledFit(shared, start, tuple(home[n] for n in range(len(pieces)))))
    return result


def _begin(spec: FitSpec, matches: list[ImpactMatch]) -> dict[str, float]:
    """Values of the numbers of impacts to begin with."""
    result = {}
    for names, count in ((OF_WALLS, 1), (OF_PAIRS, 2)):
        mine = [match_ for match_ in matches if len(match_.kinks_of_slides) == count]
        if not mine:
            continue
        e, mu, turned, *mass = names
        result[e] = float(np.median([match_.restitution for match_ in mine]))
        result[mu] = max(abs(match_.ratio) for match_ in mine)  # rims that grip rub less
        result[turned] = float(np.median([match_.tangential for match_ in mine]))
        if mass:
            result[mass[0]] = float(np.median([match_.mass for match_ in mine]))
    return {name: spec.start.get(name, value) for name, value in result.items()}


def _wall_at(lines: Sequence[Line], kink: Kink, radius: float) -> tuple[int, WallLine] | None:
    """The given wall that a puck touched, and its number; None if it was none of them."""
    best: tuple[float, int, WallLine] | None = None
    for n, (one, two) in enumerate(lines):
        along = np.subtract(two, one)
        normal = np.array([along[1], -along[0]]) / math.hypot(*along)
        if float((np.array(one) - kink.before[:2]) @ normal) < 0.0:
            normal = -normal
        distance = float(np.array(one) @ normal)
        deviations = abs(distance - float(kink.before[:2] @ normal) - radius)
        closes = float(kink.before[2:4] @ normal) > 0.0
        if closes and deviations < _NEAR * radius and (best is None or deviations < best[0]):
            best = deviations, n, WallLine(math.atan2(normal[1], normal[0]), distance)
    return None if best is None else best[1:]


_DECELS = (0.5, 0.62, 0.77, 1.0, 1.3, 1.65)  # times the one that was found
_DELTAS = (0.05, 0.2, 0.5)  # δ to begin from
_RATIOS = (0.2, 0.8, 2.0)  # rω/v, of either sign
_MODERATE = 4.0  # rω/v: the width of the prior of spins, of which few frames tell nothing
_STEPS = ((2, 4), (8, 3))  # and how many spins then go on
_FRAMES = 40  # to which those spins are fitted: enough for a start
_CLOSE = 60.0  # what another spin of a slide may cost more
_ALIKE = 0.15  # of v/r: spins so near are one
_EACH = 6  # ways of one friction
_LEAST_SPEED = 1e-6  # m/s, that is divided by

Option = tuple[float, FloatArray]


def candidates_of(slides: Estimate) -> list[FloatArray]:
    """Unknowns of slides apart, those that were found first.

    Where all slides have angles there are no others.
    """
    problem = slides.problem
    if all(film.angle is not None for film in problem.films):
        return [slides.x]
    spec, numbers = problem.spec, problem.numbers_at(slides.x)
    decel, delta, _ = spec.scales(numbers)
    slows = {"friction", "decel", "gravity"} & {*spec.free}
    decels = [decel * one for one in (_DECELS if slows else (1.0,))]
    deltas = _DELTAS if {"delta", "height"} & {*spec.free} else (delta,)
    low, high = (ends[: len(spec.free)] for ends in problem.limits)
    ranked: list[tuple[float, FloatArray]] = []
    for one in decels:
        mine: list[tuple[float, FloatArray]] = []
        for tilt in deltas:
            result = {**numbers, **numbers_with(spec, one, tilt)}
            values = np.clip([result[name] for name in spec.free], low, high).tolist()
            result = dict(zip(spec.free, values, strict=True))
            options = [_spins_of(slides, n, result) for n in range(len(problem.films))]
            for chosen in product(*options):
                costs, launches = zip(*chosen, strict=True)
                mine.append((sum(costs), problem.unknowns(result, np.array(launches))))
        ranked += sorted(mine, key=lambda option: option[0])[:_EACH]
    ranked.sort(key=lambda option: option[0])
    return [slides.x, *(x for _, x in ranked)]


def _spins_of(slides: Estimate, n: int, result: dict[str, float]) -> list[Option]:
    """Launches of a slide, with what they cost, for numbers of the puck that are held."""
    problem = slides.problem
    launch = problem.launches(slides.x)[n]
    film = problem.films[n]
    if film.angle is not None or problem.spinless[n] or (problem.rests and problem.rests[n]):
        return [(0.0, launch)]
    radius = problem.spec.scales(result)[2]
    speed = max(math.hypot(launch[2], launch[3]), _LEAST_SPEED)
    # of few frames no spin but an absurd one is seen
    moderate = {"launch_spin": (0.0, _MODERATE * speed / radius)}
    fixed, priors = {**problem.spec.fixed, **result}, {**moderate, **problem.spec.priors}
    held = replace(problem.spec, free=(), fixed=fixed, priors=priors)
    alone = Problem(held, (film.thinned(_FRAMES),), problem.noise, problem.tall)
    starts = []
    for ratio, sign in product(_RATIOS, (1.0, -1.0)):
        other = launch.copy()
        other[4] = held.fixed.get("launch_spin", sign * ratio * speed / radius)
        starts.append((alone, alone.unknowns({}, other[None])))
    walked = multi_start(starts, _STEPS, ROBUST)
    options: list[Option] = []
    for x, cost in walked:
        one = alone.launches(x)[0]
        new = all(abs(one[4] - other[4]) > _ALIKE * speed / radius for _, other in options)
        if cost < walked[0][1] + _CLOSE and new:
            options.append((cost, one))
    return options
