"""Tracks that hold impacts: where they bend, and the slides between.

A track is cut between two frames where its velocity jumps by far more than it changes nearby.  The
pieces are fitted together, as slides of one puck with launches of their own; then the law of impact
joins them (:mod:`puck_tables.fitting.impact_matching`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.observations import FEWEST, Observations, noise_of, rests_from, turning_of
from puck_tables.fitting.starts import robust_parabola

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

    Examples
    --------
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
    before = np.array([_velocity(film, i - _WINDOW + 1, i + 1) for i in places])
    after = np.array([_velocity(film, i + 1, i + 1 + _WINDOW) for i in places])
    change, speed = after - before, np.hypot(*before.T)
    jump = np.hypot(*(change - _around(change)).T)
    error = noise * math.sqrt(48.0 / _WINDOW**3) / film.usual_step
    high = max(_USUAL * float(np.median(jump)), _NOISY * error)
    result = []
    for n, size in enumerate(jump.tolist()):
        near = jump[max(0, n - _WINDOW) : n + _WINDOW + 1]
        top = max(0, n - _WINDOW) + np.flatnonzero(near >= _TOP * near.max())
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


def _around(change: FloatArray) -> FloatArray:
    """What friction changes near each frame (n, 2): the median of frames beside it."""
    count = len(change)
    out = np.empty_like(change)
    for n in range(count):
        close = np.r_[
            max(0, n - 3 * _WINDOW) : max(0, n - _WINDOW),
            min(count, n + _WINDOW + 1) : min(count, n + 3 * _WINDOW + 1),
        ]
        out[n] = np.median(change[close], axis=0)
    return out


def _velocity(film: Observations, start: int, stop: int) -> FloatArray:
    """The median of the slopes between any two frames, which one outlier in five does not move."""
    time, place = film.time[start:stop], film.place[start:stop]
    one, two = np.triu_indices(time.size, 1)
    velocity: FloatArray = np.median(
        (place[two] - place[one]) / (time[two] - time[one])[:, None], axis=0
    )
    return velocity


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

    Examples
    --------
    >>> t = 0.01 * np.arange(50)
    >>> turns(Observations("a", 0.0, t, np.zeros((50, 2)), 3.0 * t, np.arange(50)))
    True
    """
    turning = turning_of(film)
    _, angle = noise_of([film])
    noise = angle if math.isfinite(angle) else 0.0
    return turning is not None and float(np.nanstd(turning.angle)) > _STILL * max(
        noise, _LEAST_TURN
    )
