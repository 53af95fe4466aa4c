"""Stops by look-up, compiled: a launch in Cartesian components, square roots, one cell, no angle.

With Q = hypot(v, rω), T = ``time``, and the factors that vanish taken out,

    X = cos φ · along,   Y = δ sin φ cos φ · across,   path = cos φ · length,   body = sin φ · body,

the stop of a launch (vx, vy), ω is

    t = (Q/J) T,    x = (Q · along · vx − δ rω · across · vy)/J,    y likewise,

and no direction has to be computed: at rest, in pure sliding and in pure spin nothing is divided
by zero.  Each function is a cubic spline in ξ (see :mod:`puck_tables.stopping.axes`) whose
coefficients are polynomials in s = 2δ² − 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, weighted_rows
from puck_tables.kernels.spline import basis

STOP_POWERS = 8
STOP_ROW = 3 * STOP_POWERS  # for states: three functions by eight powers, whole cache lines
CURVE_ROW = 40  # four functions by nine powers, padded to whole cache lines
_BLOCK = 128
_NOTHING = 1e-300  # where nothing moves, 0/0 is 0
SMALLEST, LARGEST = 1e-250, 1e250  # between them squares of speeds lose nothing that counts


@inlined
def slip_place(speed: float, rim: float) -> tuple[int, float]:
    """Side (1: r|ω| > v) and ξ of a motion; 1 − q without cancellation next to φ = π/4."""
    # the inverse of the least would overflow, and the sum of the largest
    raised = 2.0**200 if speed + rim < 1e-290 else 1.0
    raised = 0.25 if speed + rim > 1e307 else raised
    speed, rim = raised * speed, raised * rim
    total = speed + rim
    inverse = 1.0 / total if total > 0.0 else 0.0
    q = math.sqrt(math.sqrt(2.0 * min(speed, rim) * inverse))
    rest = abs(speed - rim) * inverse / ((1.0 + q) * (1.0 + q * q))
    xi = 1.0 - math.sqrt(rest)
    return (1 if rim > speed else 0), (xi if xi > 0.0 else 0.0)  # an overflow has a place, too


@inlined
def quick_place(speed: float, rim: float, cells: float) -> tuple[float, float]:
    """Cell and place in it; 1 − q may lose digits next to φ = π/4, where slopes in ξ vanish."""
    q = math.sqrt(math.sqrt(2.0 * min(speed, rim) / (speed + rim + _NOTHING)))
    p = (1.0 - math.sqrt(max(1.0 - q, 0.0))) * cells
    cell = _cell(p, cells)
    return cell, p - cell


@inlined
def _cell(place: float, cells: float) -> float:
    """As :func:`puck_tables.kernels.spline.cell_at`, without leaving floating point."""
    inside = place if place > 0.0 else 0.0
    last = cells - 1.0
    cell: float = np.floor(inside if inside < last else last)
    return cell


def row_width(powers: int) -> int:
    """Numbers a node holds: T with ``powers`` powers of 2δ² − 1, along and across one fewer."""
    return 3 * powers - 2


@cache
def stops_kernel(powers: int) -> Callable[[FloatArray, FloatArray, FloatArray], int]:
    """The compiled look-up for stop tables of so many powers of 2δ² − 1.

    The function (launches, coefficients, out): stop time, x, y of launches (6, n): vx, vy, ω, δ, J,
    r, into ``out`` (3, n); returns of how many Q²/J or Q²/(J r) is too large.  Coefficients: array
    (2 sides, cells + 3, :func:`row_width`), powers ascending, functions T, along, across.

    In blocks of three loops: places (vectorised), sums over a cell as whole rows
    (:func:`puck_tables.kernels.compile.weighted_rows`), results (vectorised).  The number of powers
    is a constant of the compiled code: with it the rows stay in registers.
    """
    width, top = row_width(powers), 3 * powers - 3

    @allocating
    def fill(launches: FloatArray, coefficients: FloatArray, out: FloatArray) -> int:
        cells = float(coefficients.shape[1] - 3)
        side_stride = float(coefficients.shape[1] * width)
        c = coefficients.reshape(-1)
        first = np.empty(_BLOCK, np.int64)
        inside, slip, edge = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
        overflows = 0
        for start in range(0, launches.shape[1], _BLOCK):
            vx = launches[0, start : start + _BLOCK]
            vy = launches[1, start : start + _BLOCK]
            spin = launches[2, start : start + _BLOCK]
            delta = launches[3, start : start + _BLOCK]
            decel = launches[4, start : start + _BLOCK]
            radius = launches[5, start : start + _BLOCK]
            time = out[0, start : start + _BLOCK]
            x = out[1, start : start + _BLOCK]
            y = out[2, start : start + _BLOCK]
            unsafe = 0
            for n in range(vx.size):
                rim = radius[n] * spin[n]
                speed2 = vx[n] * vx[n] + vy[n] * vy[n]
                slip2 = speed2 + rim * rim
                edge[n] = rim
                slip[n] = math.sqrt(slip2)
                unsafe += 0 if (slip2 > SMALLEST) & (slip2 < LARGEST) else 1
                cell, inside[n] = quick_place(math.sqrt(speed2), abs(rim), cells)
                first[n] = int(width * cell + (side_stride if rim * rim > speed2 else 0.0))
            if unsafe > 0:  # anew, with care for the largest and smallest numbers
                for n in range(vx.size):
                    slip2 = vx[n] * vx[n] + vy[n] * vy[n] + edge[n] * edge[n]
                    if (slip2 > SMALLEST) & (slip2 < LARGEST):
                        continue  # the same bits whatever else is in the block
                    speed = math.hypot(vx[n], vy[n])
                    slip[n] = math.hypot(speed, edge[n])
                    side, xi = slip_place(speed, abs(edge[n]))
                    cell = _cell(xi * cells, cells)
                    inside[n] = xi * cells - cell
                    first[n] = int(width * cell + side * side_stride)
            for n in range(vx.size):
                a, b, d, e = basis(inside[n])
                row = weighted_rows(c, first[n], (a, b, d, e), width)
                s = 2.0 * delta[n] * delta[n] - 1.0
                f, g, h = row[top], 0.0, 0.0
                for m in range(powers - 2, -1, -1):
                    f = f * s + row[3 * m]
                    g = g * s + row[3 * m + 1]
                    h = h * s + row[3 * m + 2]
                time[n], x[n], y[n] = f, g, h
            for n in range(vx.size):
                rim, along, left = edge[n], vx[n], vy[n]
                scale = slip[n] / decel[n]
                straight = scale * (0.5 if rim == 0.0 else x[n])
                across = delta[n] * (rim / decel[n]) * y[n]
                still = (along == 0.0) & (left == 0.0)
                t = scale * (1.0 if rim == 0.0 else (0.75 if still else time[n]))
                place_x = straight * along - across * left
                place_y = straight * left + across * along
                time[n], x[n], y[n] = t, place_x, place_y
                size = 2.0 * scale * slip[n]  # as solvers.fits
                overflows += 0 if abs(size / radius[n] + size) < math.inf else 1
        return overflows

    return fill
