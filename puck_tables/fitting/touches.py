"""Where something touches a puck, told by its places alone: a hand, a wall, another puck.

A free puck changes its velocity smoothly, whatever the floor is: a hand that lets go, a grip or a
wall makes velocity or acceleration jump, and nothing but a push makes a puck on a level floor
faster.  So frames before and after a moment are laid beside two parabolas, and beside one
polynomial with as many coefficients: where the two are far nearer something happened there.

Where impacts are looked for a track is cut between two frames where its velocity jumps by far more
than it changes nearby.  The pieces are fitted together, as slides of one puck with launches of
their own; then the law of impact joins them (:mod:`puck_tables.fitting.impact_matching`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import FARTHEST, Estimate
from puck_tables.fitting.observations import FEWEST, Observations, noise_of, rests_from, turning_of
from puck_tables.fitting.problem import UNSEEN
from puck_tables.fitting.starts import robust_parabola

FAR = 25.0  # of χ²: by so much nearer, and by as much for each 1 of it that is left
_REACHES = (6, 12, 24, 48)  # frames to either side
_FEWEST_NEARBY, _CURVED = 3, 5  # frames of a side, and those that tell a curvature
_SPIKE = 6.0  # standard deviations of a frame that is no motion
_JUMPS, _PARTS, _FASTER = 5.0, 4, 1.1  # standard errors; parts of a track; times a speed before


def first_touch(film: Observations, first: int, last: int) -> int | None:
    """The frame from ``first`` to ``last`` before which the motion jumps most; None if none does.

    >>> t = np.arange(60) / 60.0
    >>> noise = np.random.default_rng(1).normal(0.0, 1e-4, (60, 2))
    >>> impact = np.stack([np.where(t < 0.5, t, 0.75 - 0.5 * t), 0.0 * t], axis=1) + noise
    >>> slid = np.stack([t - 0.4 * t * t, 0.0 * t], axis=1) + noise
    >>> films = [Observations("a", 0.0, t, place, None, np.arange(60)) for place in (impact, slid)]
    >>> [first_touch(film, 2, 57) for film in films]
    [31, None]
    """
    noise = noise_of([film])[0]
    if not noise > 0.0:
        return None
    steady = ~_spikes(film.place, noise)
    rests = rests_from(film, noise)
    best, where = 0.0, None
    for middle in range(max(first, _FEWEST_NEARBY), min(last, film.time.size - _FEWEST_NEARBY) + 1):
        for reach in _REACHES:
            gain = _gain(film, noise, steady, middle, reach, rests)
            if gain > best:
                best, where = gain, middle
            if min(middle, film.time.size - middle) <= reach:
                break
    return where


def pushed(film: Observations, start: int, stop: int) -> bool:
    """Whether the puck gets faster between two frames.

    >>> t = np.arange(40) / 40.0
    >>> noise = np.random.default_rng(1).normal(0.0, 1e-4, (40, 2))
    >>> place = np.stack([t * t, 0.0 * t], axis=1) + noise
    >>> film = Observations("a", 0.0, t, place, None, np.arange(40))
    >>> pushed(film, 0, 40), pushed(film, 0, 6)
    (True, False)
    """
    width = (stop - start) // _PARTS
    noise = noise_of([film])[0]
    if width < _FEWEST_NEARBY or not noise > 0.0:
        return False
    slowest, error = math.inf, noise * math.sqrt(12.0 / width**3) / film.usual_step
    for at in range(start, start + _PARTS * width, width):
        part = slice(at, at + width)
        speed = math.hypot(*np.polyfit(film.time[part], film.place[part], 1)[0])
        if speed > max(slowest + _JUMPS * error, _FASTER * slowest):
            return True
        slowest = min(slowest, speed)
    return False


def _gain(
    film: Observations, noise: float, steady: npt.NDArray[np.bool_], middle: int, reach: int,
    rests: int,
) -> float:  # fmt: skip
    """By how much two parabolas are nearer than one polynomial, 0 where that is by chance.

    ``rests``: the frame from which on the puck does.  It comes to rest by itself, where its
    acceleration jumps: before that what comes after does not count, there the velocity has to jump.
    """
    stops = middle >= rests - _FEWEST_NEARBY
    end = middle + reach if stops else min(middle + reach, rests)
    ends = (max(0, middle - reach), middle), (middle, end)
    sides = [np.flatnonzero(steady[start:stop]) + start for start, stop in ends]
    if min(side.size for side in sides) < _FEWEST_NEARBY:
        return 0.0
    time = film.time - film.time[middle]
    left, count, slopes = 0.0, 0, []
    for side in sides:
        order = 2 if side.size >= _CURVED else 1
        result, deviations = _near(time[side], film.place[side], order)
        left, count = left + deviations, count + order + 1
        slopes.append((result[1], 192.0 if order == 2 else 12.0, side.size, result[order]))
    both = np.concatenate(sides)
    one = _near(time[both], film.place[both], count - 1)[1]
    left, one = left / noise**2, one / noise**2
    gain = one - left
    if gain < FAR * max(1.0, left / max(2 * (both.size - count), 1)):
        return 0.0
    if stops:
        jump = math.hypot(*(slopes[1][0] - slopes[0][0]))
        error = math.sqrt(sum(spread / size**3 for _, spread, size, _ in slopes)) * noise
        slowing = 2.0 * math.hypot(*slopes[0][3])
        hidden = _FEWEST_NEARBY * film.usual_step
        hidden += 2.0 * math.sqrt(10.0 * noise / max(slowing, 1e-12))
        if jump < max(_JUMPS * error / film.usual_step, slowing * hidden):
            return 0.0
    return gain


def _near(time: FloatArray, place: FloatArray, order: int) -> tuple[FloatArray, float]:
    """Coefficients of the nearest polynomial, and the squares that are left."""
    scale = float(np.abs(time).max())
    powers = np.vander(time / scale, order + 1, increasing=True)
    result = np.linalg.lstsq(powers, place, rcond=None)[0]
    left = place - powers @ result
    return result / scale ** np.arange(order + 1.0)[:, None], float((left**2).sum())


def _spikes(place: FloatArray, noise: float) -> npt.NDArray[np.bool_]:
    """Frames that lie far from the cubic through the two before and the two after (n,)."""
    deviations = np.zeros(len(place))
    inner = place[2:-2] - (4.0 * (place[1:-3] + place[3:-1]) - place[:-4] - place[4:]) / 6.0
    deviations[2:-2] = np.hypot(*inner.T) / (1.4 * noise)
    around = np.stack([np.roll(deviations, k) for k in (-2, -1, 1, 2)]).max(axis=0)
    return np.asarray((deviations > _SPIKE) & (deviations >= around))


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


_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_NEARBY = 0.1  # of the frames that are left, at most
_SMALLER = 0.45  # of the frames: a hand or what a wall did
_SLACK = 3  # frames
_MOSTLY = 0.7  # of them are outliers


def trimmed(result: Estimate, uncut: tuple[Observations, ...]) -> tuple[Observations, ...]:
    """The tracks without what lies at their ends and is not of the motion; ``uncut``: with all.

    What is off there is left out where something touches the puck (:func:`first_touch`); else it is
    the model that is wrong.  A hand that lets go slows otherwise by about J, and is off by as much
    as an outlier only the time √(2 · 4σ/J) before: so long beside what is foreign is left out, too.
    """
    films, problem = [], result.problem
    decel = problem.spec.scales(problem.numbers_at(result.x))[0]
    hidden = math.sqrt(2.0 * FARTHEST * problem.noise[0] / decel)
    for film, whole, (x, _, _) in zip(problem.films, uncut, problem.each(), strict=True):
        out = ~result.kept[x] & (problem.kinds[x] != UNSEEN)
        ends = [_foreign(out), _foreign(out[::-1])]
        close = math.ceil(min(hidden / film.usual_step, _NEARBY * (out.size - sum(ends))))
        for n, before in enumerate(ends):
            edge = before if n == 0 else out.size - before
            at = int(np.searchsorted(whole.frame, film.frame[min(edge, out.size - 1)]))
            at += edge == out.size
            ends[n] = before + close if before and _ends(whole, at, close, n == 0) else 0
        inner = np.arange(film.time.size)
        chosen = (inner >= ends[0]) & (inner < out.size - ends[1])
        same = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if same else film.part(chosen))
    same = all(a is b for a, b in zip(films, problem.films, strict=True))
    return problem.films if same else tuple(films)


def _ends(whole: Observations, at: int, close: int, first: bool) -> bool:
    """Whether the free motion begins, or ends, about a frame since something touches the puck."""
    rests = rests_from(whole, noise_of([whole])[0])
    if not whole.cuttable[0 if first else 1] or (first and at >= rests - FEWEST):
        return False
    if first_touch(whole, at - close - _SLACK, at + close + _SLACK) is not None:
        return True
    count = whole.time.size
    foreign, free = ((0, at), (at, count)) if first else ((at, count), (0, at))
    return pushed(whole, *foreign) and not pushed(whole, *free)


def without_ends(film: Observations) -> list[Observations]:
    """A track without what lies before or after a touch, where that is the smaller part."""
    order, parts = np.arange(film.time.size), []
    count = round(_SMALLER * order.size)
    for end, ends in enumerate(((0, count), (order.size - count, order.size))):
        at = first_touch(film, *ends) if film.cuttable[end] else None
        if at is not None:
            parts.append(film.part((order >= at) != bool(end)))
    return [part for part in parts if part.time.size >= FEWEST + 2]


def _foreign(out: npt.NDArray[np.bool_]) -> int:
    """How many frames at the beginning are mostly outliers."""
    sizes = np.arange(1, out.size + 1)
    mostly = out & (np.cumsum(out) >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    return int(sizes[mostly].max(initial=0))
