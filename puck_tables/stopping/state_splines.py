"""Places on the curve of all motions for many numbers at once, and what stands there.

What :mod:`puck_tables.stopping.similarity_lookup` finds in two steps, the ratio of speed and spin
from the time that is left and then the functions at that ratio, is tabulated here over the first
place itself: 2w/y, T, along, across, body angle, and the heading's regular part

    δ G = regular − a ln y [− h₀ ln T],    a = h₀/A for v > r|ω|, (h₀ − h₁)/B above,

in which ln 2w = ln y + ln(2w/y) leaves nothing singular.  So a state takes one look-up, and its
logarithms and exponentials are done for several states at once.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import exp_of, log_of

ORBIT_WIDTH = 8  # 2w/y, T, along, across; body angle, G and nothing
TURN_STEP, TURN_POWERS = 4, 3  # of one function: powers m, m + 4, m + 8 of s, m = 0 … 3
SHARE, TIME_FACTOR, ALONG, ACROSS, BODY_FACTOR, REGULAR = range(6)
TINY = 1e-300  # its logarithm is a number


@inlined
def log_place(
    sign: float, log_n: float, kappa: float, slow: float, fast: float
) -> tuple[bool, float]:
    """Whether r|ω| > v, and ln y of the number sign·exp(log_n), by arithmetic alone."""
    is_slow = (sign < 0.0) & (log_n >= 0.0)
    is_large = (sign > 0.0) & (log_n > 1.0)
    moderate = log_n if log_n < 1.0 else 1.0
    power = exp_of(-log_n if is_large else moderate)
    log = log_of(1.0 + 2.0 * power if is_large else 2.0 + sign * power)
    log_fast = fast * (log + (log_n if is_large else 0.0))
    return not is_slow, -(slow * log_n if is_slow else log_fast) / kappa


@inlined
def place_of_log(log_y: float) -> tuple[float, float]:
    """Y and ξ from ln y ≤ 0."""
    y = exp_of(log_y if log_y < 0.0 else 0.0)
    q = math.sqrt(math.sqrt(y))
    return y, 1.0 - math.sqrt((1.0 - y) / ((1.0 + q) * (1.0 + q * q)))


@inlined
def cell_of(xi: float, is_fast: bool, cells: float, row: int) -> tuple[float, float]:
    """The place of the first row of a cell in a flat table, and that in the cell."""
    p = xi * cells
    inside = p if p > 0.0 else 0.0
    last = cells - 1.0
    cell = np.floor(inside if inside < last else last)
    return row * (cell + (cells + 3.0 if is_fast else 0.0)), p - cell
