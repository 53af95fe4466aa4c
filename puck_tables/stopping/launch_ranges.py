"""Ranges of u = ln(r|ω|/v) that bounds leave of a family of launches, and samples of them."""

from __future__ import annotations

import math

import numpy as np

_SAMPLED_U = math.log(math.tan(math.radians(80.0)))  # as far as is sampled without a bound


def between(low: float, high: float) -> float:
    """A u inside an interval, one end of which may be infinite, or both.

    Examples
    --------
    >>> between(-math.inf, 1.0), between(0.0, 1.0)
    (-0.5, 0.5)
    """
    return 0.5 * (max(low, min(high, 0.0) - 2.0) + min(high, max(low, 0.0) + 2.0))


def concatenated(
    intervals: list[tuple[float, float]], inside: list[bool]
) -> list[tuple[float, float]]:
    """The intervals that are inside, neighbours as one.

    Examples
    --------
    >>> concatenated([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)], [True, True, False])
    [(0.0, 2.0)]
    """
    within: list[tuple[float, float]] = []
    for (low, high), one in zip(intervals, inside, strict=True):
        if one:
            follows = within and within[-1][1] == low
            within[-1:] = [(within[-1][0], high)] if follows else [*within[-1:], (low, high)]
    return within


def sample(ranges: list[tuple[float, float]], count: int) -> list[float]:
    """Equally spaced slip angles, as u: each range of u has its share of them, at least one.

    Examples
    --------
    >>> [round(u, 3) for u in sample([(-math.inf, 0.0), (1.0, math.inf)], 5)]
    [-inf, -1.317, -0.549, 0.0, 1.0]
    """
    if not ranges:
        return []
    ends = [(low, high if high < math.inf else max(low + 1.0, _SAMPLED_U)) for low, high in ranges]
    angles = [(math.atan(math.exp(low)), math.atan(math.exp(high))) for low, high in ends]
    shares = [1] * len(ranges)
    for _ in range(count - len(ranges)):
        densest = max(range(len(ranges)), key=lambda n: (angles[n][1] - angles[n][0]) / shares[n])
        shares[densest] += 1
    us: list[float] = []
    for (low, high), (first, last), share in zip(ends, angles, shares, strict=True):
        inner = np.log(np.tan(np.linspace(first, last, share)[1:-1])).tolist()
        us += [low, *inner, high] if share > 1 else [low]  # the ends to the last digit
    return us
