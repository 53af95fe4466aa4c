"""Where tracks bend, and which impacts that shows.

Where impacts are looked for a track is cut between two frames where its velocity jumps by far more
than it changes nearby.  The pieces are fitted together, as slides of one puck with launches of
their own.  Then the states before and after a kink say what was met.  Two tracks that bend at the
same moment, two radii apart, are two pucks that meet; any other kink is a wall, one of those given
or one to be found.  From a wall follow P_t = −k² Δω/r and P_n = √(|Δv|² − P_t²) per unit of mass,
with n the direction to the wall, so that −Δv = P_n n + P_t t.  What the law of impacts
(:mod:`puck_tables.motion.impact_law`) says of them are the values that the joint fit begins with,
or what is told where slides cannot be joined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import OF_PAIRS, OF_WALLS, FitSpec
from puck_tables.fitting.forward_model import Slide, WallLine, state_at
from puck_tables.fitting.observations import (
    FEWEST,
    Observations,
    noise_of,
    rests_from,
    robust_parabola,
    turning_of,
)
from puck_tables.fitting.problem import Problem
from puck_tables.motion.impact_law import along_normal, law_of_impulses

_WINDOW, _WIDER = 5, 15  # frames to either side
_USUAL, _NOISY, _LEAST = 6.0, 6.0, 0.15  # times the usual jump, the noise of one, the speed
_STILL, _LEAST_TURN = 3.0, 1e-9  # times the noise; rad
_TOP = 0.95  # of the largest jump around: in the middle of these is the kink


class SlideIndex(NamedTuple):
    """Which slide of which track a piece is, both counted from 0."""

    track: int
    slide: int


def kinks(film: Observations, noise: float) -> list[int]:
    """Frames after which the velocity of a track jumps.

    >>> t = np.arange(80.0) / 100.0
    >>> x = np.where(t < 0.395, t, 0.79 - t)
    >>> place = np.stack([x, 0.0 * x], axis=1)
    >>> kinks(Observations("a", 0.0, t, place, None, np.arange(80)), 1e-5)
    [39]
    """
    count = film.time.size
    places = range(_WINDOW - 1, count - _WINDOW)
    if len(places) < 2 * _WINDOW:
        return []
    every = [_velocity(film, i, i + _WINDOW) for i in range(count - _WINDOW + 1)]
    before, after = (np.array(every[k : k + len(places)]) for k in (0, _WINDOW))
    change, speed = after - before, np.hypot(*before.T)
    # less what friction changes near each frame: the median of frames beside it
    away = np.r_[-3 * _WINDOW : -_WINDOW, _WINDOW + 1 : 3 * _WINDOW + 1]
    near = (at[(at >= 0) & (at < len(change))] for at in (n + away for n in range(len(change))))
    jump = np.hypot(*(change - np.array([np.median(change[at], axis=0) for at in near])).T)
    error = noise * math.sqrt(48.0 / _WINDOW**3) / film.usual_step
    high = max(_USUAL * float(np.median(jump)), _NOISY * error)
    result = []
    for n, size in enumerate(jump.tolist()):
        window = jump[max(0, n - _WINDOW) : n + _WINDOW + 1]
        top = max(0, n - _WINDOW) + np.flatnonzero(window >= _TOP * window.max())
        highest = n == int(top[top.size // 2])
        if highest and size > max(high, _LEAST * float(speed[n])):
            result.append(n + _WINDOW - 1)
    ends = [-1, *result, count - 1]
    return [
        ends[k] for k in range(1, len(ends) - 1)
        if _jumps(film, noise, ends[k - 1] + 1, ends[k] + 1, ends[k + 1] + 1)
    ]  # fmt: skip


def _jumps(film: Observations, noise: float, start: int, middle: int, stop: int) -> bool:
    """Whether robust parabolas over more frames tell a jump, too: several outliers are none."""
    start, stop = max(start, middle - _WIDER), min(stop, middle + _WIDER)
    if min(middle - start, stop - middle) < FEWEST:
        return True
    before = robust_parabola(film.time, film.place, start, middle)
    after = robust_parabola(film.time, film.place, middle, stop)
    at = 0.5 * (film.time[middle - 1] + film.time[middle])
    jump = math.hypot(*(after[1] - before[1] + 2.0 * at * (after[2] - before[2])))
    span = min(middle - start, stop - middle)
    error = noise * math.sqrt(2.0 * 192.0 / span**3) / film.usual_step
    return jump > max(_NOISY * error, _LEAST * math.hypot(*(before[1] + 2.0 * at * before[2])))


def _velocity(film: Observations, start: int, stop: int) -> FloatArray:
    """The median of the slopes between any two frames, which one outlier in five does not move."""
    time, place = film.time[start:stop], film.place[start:stop]
    one, two = np.triu_indices(time.size, 1)
    slopes = (place[two] - place[one]) / (time[two] - time[one])[:, None]
    return np.asarray(np.median(slopes, axis=0))


def slides_apart(
    films: tuple[Observations, ...], noise: float
) -> tuple[tuple[Observations, ...], tuple[SlideIndex, ...], tuple[bool, ...]]:
    """The tracks cut at their kinks, which pieces they are, and whether the puck rests in each.

    A piece too short to be fitted is left out.
    """
    pieces, numbers, rests = [], [], []
    for n, film in enumerate(films):
        ends = [0, *(k + 1 for k in kinks(film, noise)), film.time.size]
        number = np.arange(film.time.size)
        for k, (start, stop) in enumerate(pairwise(ends)):
            if stop - start < FEWEST + 2:
                continue
            piece = film.part((number >= start) & (number < stop))
            name = film.name if len(ends) == 2 else slide_name(film.name, k)
            pieces.append(replace(piece, name=name))
            numbers.append(SlideIndex(n, k))
            rests.append(len(ends) > 2 and rests_from(piece, noise) == 0 and not turns(piece))
    return tuple(pieces), tuple(numbers), tuple(rests)


def slide_name(track: str, k: int) -> str:
    """The name of a slide between impacts, counted from 0."""
    return f"{track}, slide {k + 1}"


def turns(film: Observations) -> bool:
    """Whether the body of a track turns.

    >>> t = 0.01 * np.arange(50)
    >>> turns(Observations("a", 0.0, t, np.zeros((50, 2)), 3.0 * t, np.arange(50)))
    True
    """
    turning, noise = turning_of(film), np.nan_to_num(noise_of([film])[1])
    least = _STILL * max(float(noise), _LEAST_TURN)
    return turning is not None and float(np.nanstd(turning.angle)) > least


_TOGETHER = 2.0  # steps between frames within which two tracks bend at one moment
NEAR = 1.0  # radii: how far off two pucks, or a puck and a wall that was given, may seem to be
_BOUNCES = 1.5  # the largest restitution that noise may show

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
        if deviations < NEAR * radius and not taken & {i, k}:
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


def radii_of(problem: Problem, x: FloatArray) -> tuple[float, float]:
    """Radius of the puck and its radius of gyration over it."""
    numbers = problem.spec.numbers(problem.numbers_at(x))
    return numbers["radius"], numbers["gyration"]


def _of_wall(problem: Problem, x: FloatArray, kink: Kink) -> ImpactMatch | None:
    """An impact with a wall; None if nothing pushed the puck back."""
    radius, gyration = radii_of(problem, x)
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
    radius, gyration = radii_of(problem, x)
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


def wall_at(lines: Sequence[Line], kink: Kink, radius: float) -> tuple[int, WallLine] | None:
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
        if closes and deviations < NEAR * radius and (best is None or deviations < best[0]):
            best = deviations, n, WallLine(math.atan2(normal[1], normal[0]), distance)
    return None if best is None else best[1:]


def begin(spec: FitSpec, matches: list[ImpactMatch]) -> dict[str, float]:
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
