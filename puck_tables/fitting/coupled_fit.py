"""The joint fit of slides that impacts join, and what it says of the impacts.

Without angles a slide tells its spin by how it slows and bends: each friction has spins of its own,
of either sign where the path hardly bends, and what the law of impact makes of them differs.  So
frictions and tilts are tried in turn; with both held every slide is a problem of its own, and the
few spins that suit it are found.  Candidates are all that slides and spins may go together, those
first in which the slides fit best.

Slides are joined by one restitution and one friction of the rims for all impacts of a kind.  That
is a law, and it is judged: by how much χ² rises over that of slides with launches of their own, for
as many conditions as there are unknowns less.  Where it fails the slides stay as they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Certainty
from puck_tables.fitting.estimate import Estimate, capped_squares, estimate
from puck_tables.fitting.fit_spec import OF_PAIRS, OF_WALLS, FitSpec
from puck_tables.fitting.forward_model import ImpactSpec, WallLine
from puck_tables.fitting.impact_matching import (
    Line,
    SlideIndex,
    begin,
    matched_impacts,
    radii_of,
    wall_at,
)
from puck_tables.fitting.numbers import FOLLOWS, Number, quadratic
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.problem import ROBUST, Problem, multi_start

_GRIPS = 0.97  # of the impulse that stops the rims
_REACH, _REACH_FRAMES = 0.4, 4.0  # of the time between impacts, and at least


class CoupledFit(NamedTuple):
    """Slides that are joined: what least squares are asked, unknowns to begin with.

    ``pieces``: for each piece its track in ``problem``, and the first of its frames there.
    """

    problem: Problem
    start: FloatArray
    pieces: tuple[int, ...]


def coupled(
    problem: Problem, x: FloatArray, pieces: tuple[SlideIndex, ...],
    films: tuple[Observations, ...], spec: FitSpec, lines: Sequence[Line],
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
    radius = radii_of(problem, x)[0]
    step = max(film.usual_step for film in problem.films)
    numbers: dict[int, int] = {}
    for match_ in matches:
        kink = match_.kinks_of_slides[0]
        own = match_.pieces
        ends = [problem.films[n + more].time[-1] for n in own for more in (0, 1)]
        number = -1
        if len(own) == 1:
            known, wall = wall_at(lines, kink, radius) or (-1 - len(walls), None)
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
        values = {**problem.numbers_at(x), **begin(one, matches)}
        for name in one.free:
            low, high = one.limits(name)
            values[name] = min(max(values[name], low), high)
        start = shared.unknowns(values, launches, tuple(starts))
        result.append(CoupledFit(shared, start, tuple(home[n] for n in range(len(pieces)))))
    return result


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
            result = {**numbers, **spec.with_scales(one, tilt)}
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


_BY_CHANCE = 1e-5  # of the rise of χ²: less, and the law of impact is not that of these slides
_STEP = 1e-6  # of an unknown, in differences; of friction: a rim that is as close to it slides
_SAME = 1e-9  # of the size of coordinates: a point lies on a wall
_WALK = ((8, 16), (12, 8), (25, 4))  # steps from each start, and how many then go on
_WORSE = 15.0  # what other minima may cost more
_TRIED = 12  # ways of slides that are not joined, to see whether they have rivals
_HARDER = 3.0  # times the friction of a rim that slides
_RUBS = ("rim_friction", "pair_friction")
_EQUAL = 0.01  # of χ²: two forms of one law


class Impact(NamedTuple):
    """An impact with a wall, or of two pucks.

    ``track``: its name; ``partner``: that of the other puck, empty of a wall; ``time`` s; ``place``
    (x, y) m of the centre; ``wall`` rad: the direction from there to what is met; ``restitution``
    e; ``rim``: tangential over normal impulse, which is the friction of the rims where they slid
    all the time; ``mass_ratio``: of the partner's mass to that of the puck.
    """

    track: str
    partner: str
    time: float
    place: tuple[float, float]
    wall: float
    restitution: Number
    rim: Number
    mass_ratio: Number | None


def couple(
    slides: Estimate, pieces: tuple[SlideIndex, ...], films: tuple[Observations, ...],
    spec: FitSpec, lines: Sequence[Line],
) -> tuple[Estimate, str]:  # fmt: skip
    """The estimate of joined slides; that of slides apart and why, if these are not joined."""
    from scipy.special import chdtrc

    groups: dict[tuple[object, ...], list[CoupledFit]] = {}
    starts = candidates_of(slides)
    for x in starts:
        for one in coupled(slides.problem, x, pieces, films, spec, lines):
            frames = tuple(film.time.size for film in one.problem.films)
            groups.setdefault((one.problem.names, one.pieces, frames), []).append(one)
    if not groups:
        return slides, ""
    most = max(len(group[0].problem.impact_specs) for group in groups.values())
    fits = []
    for group in groups.values():
        if len(group[0].problem.impact_specs) < most:
            continue
        if len(group) == 1:
            best = estimate(group[0].problem, group[0].start)
        else:  # from the best of several starts, with other minima near which it may lie
            walked = multi_start([(one.problem, one.start) for one in group], _WALK, ROBUST, _WORSE)
            near = tuple(x for x, cost in walked if cost < walked[0][1] + _WORSE)
            best = replace(estimate(group[0].problem, walked[0][0]), minima=near)
        fits.append((_rise(slides, best, group[0]), best))
    least = min(rise for rise, _ in fits)
    alike = [fit for fit in fits if fit[0] < least + _EQUAL]
    rise, result = min(alike, key=lambda fit: (_unlikely(fit[1]), fit[0]))
    conditions = slides.x.size - result.x.size
    if chdtrc(max(conditions, 1), max(rise, 0.0)) < _BY_CHANCE:
        return replace(slides, minima=tuple(starts[:_TRIED])), (
            "The slides are not joined at the impacts: one law of impact for all of them, with "
            f"states that match, would raise chi^2 by {rise:.4g} for {conditions} "
            f"condition{'' if conditions == 1 else 's'}"
        )
    problem = result.problem
    rubs = [k for k, (_, name) in enumerate(problem.names) if name in _RUBS]
    if not rubs or all(film.angle is not None for film in problem.films):
        return result, ""
    x = result.x.copy()  # rims that slide may grip instead: with angles it is seen that they do
    x[rubs] = np.minimum(_HARDER * x[rubs], problem.limits[1][rubs])
    return replace(result, minima=(*result.minima, x)), ""


def _unlikely(result: Estimate) -> int:
    """Of forms of one law: friction where rims slide, 0, before tangential restitution, 1.

    Last is a friction that no impact tells, as all rims grip.
    """
    problem = result.problem
    if not {*_RUBS} & {*problem.spec.free}:
        return 1
    numbers = problem.numbers_at(result.x)
    for impact_spec, impact in zip(problem.impact_specs, problem.slides(result.x)[1], strict=True):
        friction = problem.spec.rims(numbers, impact_spec.wall < 0).friction
        if abs(impact.ratio) >= (1.0 - _STEP) * friction:
            return 0
    return 2


def not_met(impacts: Sequence[Impact], problem: Problem, lines: Sequence[Line]) -> tuple[str, ...]:
    """A sentence for each given wall that was never met, or one if there is no impact at all."""
    if not impacts:
        return ("No impact was found: each track is taken for one slide",)
    if not problem.impact_specs:  # nothing is joined at walls
        return ()
    walls = [wall for wall in problem.walls if wall is not None]

    def through(wall: WallLine, point: tuple[float, float]) -> bool:
        off = point[0] * math.cos(wall.angle) + point[1] * math.sin(wall.angle) - wall.distance
        return abs(off) <= _SAME * max(*map(abs, point), abs(wall.distance))

    return tuple(
        f"No impact was found on the wall through ({a[0]:g}, {a[1]:g}) and ({b[0]:g}, {b[1]:g}): "
        "see that its points are in m, along the axes of the tracks"
        for a, b in lines if not any(through(wall, a) and through(wall, b) for wall in walls)
    )  # fmt: skip


def _rise(slides: Estimate, result: Estimate, whole: CoupledFit) -> float:
    """By how much χ² is larger, over the frames of all slides, with the noise of these."""
    noise = slides.problem.noise
    apart = capped_squares(slides.problem, slides.x)
    together = capped_squares(result.problem.with_noise(noise, result.x, result.kept), result.x)
    rise = 0.0
    for n, (film, squares) in enumerate(zip(slides.problem.films, apart, strict=True)):
        track = whole.pieces[n]
        places = np.searchsorted(result.problem.films[track].frame, film.frame)
        rise += float((together[track][places] - squares).sum())
    return rise


def impacts_coupled(
    result: Estimate, certainty: Certainty, numbers: dict[str, Number]
) -> tuple[Impact, ...]:
    """The impacts of a joint fit."""
    problem = result.problem

    def ratios(x: FloatArray) -> FloatArray:
        return np.array([impact.ratio for impact in problem.slides(x)[1]])

    slopes = _slopes(result, certainty, ratios)
    first, impacts = problem.films[0].start, []
    every = zip(problem.impact_specs, problem.slides(result.x)[1], slopes, strict=True)
    for impact_spec, impact, slope in every:
        pair = impact_spec.wall < 0
        names, error = list(OF_PAIRS if pair else OF_WALLS), certainty.error_of(slope, 1.0)
        films = [problem.films[n].name for n in impact_spec.films]
        impacts.append(Impact(
            films[0], films[1] if pair else "", first + impact.time,
            (float(impact.place[0]), float(impact.place[1])), impact.toward,
            numbers[names[0]], quadratic(impact.ratio, error, "1", FOLLOWS, certainty.reach),
            numbers[names[3]] if pair else None,
        ))  # fmt: skip
    return tuple(impacts)


def impacts_apart(
    slides: Estimate, pieces: tuple[SlideIndex, ...], certainty: Certainty, names: Sequence[str]
) -> tuple[Impact, ...]:
    """The impacts between slides with launches of their own; ``names``: of the tracks."""
    problem = slides.problem
    matches = matched_impacts(problem, pieces, slides.x)

    def values(x: FloatArray) -> FloatArray:
        """Restitution, ratio and mass of each; as they are where an impact comes to nothing."""
        others = {one.pieces: one for one in matched_impacts(problem, pieces, x)}
        rows = [others.get(one.pieces, one) for one in matches]
        return np.array([[one.restitution, one.ratio, one.mass] for one in rows]).ravel()

    if not matches:
        return ()
    slopes = _slopes(slides, certainty, values).reshape(len(matches), 3, -1)
    impacts = []
    for match_, slope in zip(matches, slopes, strict=True):
        numbers = [
            quadratic(value, certainty.error_of(one, 1.0), "1", FOLLOWS, certainty.reach)
            for value, one in zip((match_.restitution, match_.ratio, match_.mass), slope,
            strict=True) if math.isfinite(value)
        ]  # fmt: skip
        tracks = [names[pieces[kink.piece].track] for kink in match_.kinks_of_slides]
        x, y = match_.kinks_of_slides[0].before[:2].tolist()
        impacts.append(Impact(
            tracks[0], tracks[1] if len(tracks) > 1 else "",
            problem.films[0].start + match_.kinks_of_slides[0].time, (x, y), match_.toward,
            numbers[0], numbers[1], numbers[2] if len(tracks) > 1 else None,
        ))  # fmt: skip
    return tuple(impacts)


def _slopes(
    result: Estimate, certainty: Certainty, of: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """The derivatives of numbers to the unknowns, (numbers, m)."""
    columns = []
    low, high = result.problem.limits
    for k in range(result.x.size):
        step = _STEP * max(abs(float(result.x[k])), float(certainty.plausible[k]) * 1e-2)
        ends, values = [], []
        for side in (1.0, -1.0):
            moved = result.x.copy()
            moved[k] = min(max(moved[k] + side * step, low[k]), high[k])
            ends.append(moved[k])
            values.append(of(moved))
        with np.errstate(invalid="ignore"):
            columns.append(np.nan_to_num((values[0] - values[1]) / (ends[0] - ends[1])))
    return np.stack(columns, axis=1)
