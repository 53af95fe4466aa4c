"""Roots, slopes and rates of functions of one number."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """A sign change of a function between two points, by bisection to the last digit.

    NaN if the function has the same sign at both.

    >>> round(root(lambda x: x * x - 2.0, 0.0, 2.0), 12)
    1.414213562373
    """
    positive = function(high) > 0.0
    if (function(low) > 0.0) == positive:
        return math.nan
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        if (function(middle) > 0.0) == positive:
            high = middle
        else:
            low = middle


def power(size: npt.ArrayLike, quantity: npt.ArrayLike) -> float:
    """The exponent of quantity ~ size^power, from the first and the last of the values.

    >>> round(power([1.0, 0.5, 0.1], [3.0, 0.75, 0.03]), 12)
    2.0
    """
    x, y = np.log(np.abs(size)), np.log(np.abs(quantity))
    return float((y[-1] - y[0]) / (x[-1] - x[0]))
