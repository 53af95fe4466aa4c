"""Where something touches a puck, told by its places alone.

A free puck changes its velocity smoothly, whatever the floor is: a hand that lets go, a grip or a
wall makes velocity or acceleration jump, and nothing but a push makes a puck on a level floor
faster.  So frames before and after a moment are laid beside two parabolas, and beside one
polynomial with as many coefficients: where the two are far nearer something happened there.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.observations import Observations, noise_of, rests_from

FAR = 25.0  # of χ²: by so much nearer, and by as much for each 1 of it that is left
_REACHES = (6, 12, 24, 48)  # frames to either side
_LEAST, _CURVED = 3, 5  # frames of a side, and those that tell a curvature
_SPIKE = 6.0  # standard deviations of a frame that is no motion
_JUMPS, _PARTS, _FASTER = 5.0, 4, 1.1


def first_touch(film: Observations, first: int, last: int) -> int | None:
    """The frame from ``first`` to ``last`` before which the motion jumps most; None if none does.

    Examples
    --------
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
    for middle in range(max(first, _LEAST), min(last, film.time.size - _LEAST) + 1):
        for reach in _REACHES:
            gain = _gain(film, noise, steady, middle, reach, rests)
            if gain > best:
                best, where = gain, middle
            if min(middle, film.time.size - middle) <= reach:
                break
    return where


def pushed(film: Observations, start: int, stop: int) -> bool:
    """Whether the puck gets faster between two frames.

    Examples
    --------
    >>> t = np.arange(40) / 40.0
    >>> noise = np.random.default_rng(1).normal(0.0, 1e-4, (40, 2))
    >>> place = np.stack([t * t, 0.0 * t], axis=1) + noise
    >>> film = Observations("a", 0.0, t, place, None, np.arange(40))
    >>> pushed(film, 0, 40), pushed(film, 0, 6)
    (True, False)
    """
    width = (stop - start) // _PARTS
    noise = noise_of([film])[0]
    if width < _LEAST or not noise > 0.0:
        return False
    slowest = math.inf
    error = noise * math.sqrt(12.0 / width**3) / film.usual_step
    for n in range(_PARTS):
        part = slice(start + n * width, start + (n + 1) * width)
        speed = math.hypot(*np.polyfit(film.time[part], film.place[part], 1)[0])
        if speed > max(slowest + _JUMPS * error, _FASTER * slowest):
            return True
        slowest = min(slowest, speed)
    return False


def _gain(
    film: Observations,
    noise: float,
    steady: npt.NDArray[np.bool_],
    middle: int,
    reach: int,
    rests: int,
) -> float:
    """By how much two parabolas are nearer than one polynomial, 0 where that is by chance.

    ``rests``: the frame from which on the puck does.  It comes to rest by itself, where its
    acceleration jumps: before that what comes after does not count, there the velocity has to jump.
    """
    stops = middle >= rests - _LEAST
    end = middle + reach if stops else min(middle + reach, rests)
    sides = [
        np.flatnonzero(steady[start:stop]) + start
        for start, stop in ((max(0, middle - reach), middle), (middle, end))
    ]
    if min(side.size for side in sides) < _LEAST:
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
        hidden = _LEAST * film.usual_step + 2.0 * math.sqrt(10.0 * noise / max(slowing, 1e-12))
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
    spikes: npt.NDArray[np.bool_] = (deviations > _SPIKE) & (deviations >= around)
    return spikes
