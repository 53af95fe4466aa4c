"""Whether residuals are noise: what is left of a wrong model has a pattern."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate

_PARTS = 8
_MOVING, _ENOUGH = 0.1, 20  # of the greatest speed; frames


def chi_square_tail(value: float, degrees: int) -> float:
    """The probability that χ² exceeds a value.

    Examples
    --------
    >>> round(chi_square_tail(3.841459, 1), 6)
    0.05
    """
    from scipy.special import gammaincc

    return float(gammaincc(0.5 * degrees, 0.5 * value))


def runs(found: Estimate) -> float:
    """The probability of so few or so many changes of sign along the frames (Wald and Wolfowitz).

    Of all tracks, x, y and angles together.
    """
    off, variance = 0.0, 0.0
    for rows in _series(found):
        above = rows > 0.0
        n, plus = above.size, int(above.sum())
        minus = n - plus
        if plus < 2 or minus < 2:
            continue
        mean = 2.0 * plus * minus / n
        changes = int((above[1:] != above[:-1]).sum())
        off += changes - mean
        variance += mean * (2.0 * plus * minus - n) / (n * (n - 1.0))
    if variance == 0.0:
        return 1.0
    return math.erfc(abs(off) / math.sqrt(2.0 * variance))


def drift(found: Estimate) -> float:
    """The probability that means over eighths of the tracks are so far from 0 by chance."""
    total, degrees = 0.0, 0
    for rows in _series(found):
        for part in np.array_split(rows, min(_PARTS, rows.size)):
            total += part.sum() ** 2 / part.size
            degrees += 1
    scale = max(found.chi2 / max(found.degrees, 1), 1e-300)
    return chi_square_tail(total / scale, max(degrees - found.x.size, 1)) if degrees else 1.0


def lengthways(found: Estimate) -> float:
    """The spread of residuals along the motion over that across it, less what chance may do.

    Of frames that move, by three standard errors of such a ratio; 1 of too few.
    """
    along, across = [], []
    off, rates = found.problem.off(found.x), found.problem.rates(found.x)
    films = found.problem.films
    for film, (x, _, _), one, rate in zip(films, found.problem.each(), off, rates, strict=True):
        if film.straight is not None:
            continue
        speed = np.hypot(rate[0], rate[1])
        moving = found.kept[x] & (speed > _MOVING * speed.max(initial=0.0))
        ahead = rate[:2, moving] / speed[moving]
        along.append((one[:2, moving] * ahead).sum(axis=0))
        across.append(one[0, moving] * ahead[1] - one[1, moving] * ahead[0])
    one, two = (np.concatenate(part or [np.empty(0)]) for part in (along, across))
    if one.size < _ENOUGH or not two.any():
        return 1.0
    ratio = math.sqrt(float(np.mean(one**2) / np.mean(two**2)))
    return ratio * (1.0 - 3.0 / math.sqrt(one.size))


def _series(found: Estimate) -> list[FloatArray]:
    """Residuals that count, frame after frame."""
    return [
        rows
        for part in found.problem.each()
        for where in part
        if (rows := found.residuals[where][found.kept[where]]).size
    ]
