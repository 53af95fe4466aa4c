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
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, spline_values
from puck_tables.kernels.spline import basis
from puck_tables.stopping.launches import BLOCK, COLUMNS, fetch_block, fill_constants

STOP_POWERS = 8
STOP_ROW = 3 * STOP_POWERS  # for states: three functions by eight powers, whole cache lines
CURVE_ROW = 40  # four functions by nine powers, padded to whole cache lines
WIDTH = 4  # functions side by side, as many as fit into a register: T, along, across and nothing
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


@inlined
def place_block(
    room: FloatArray, count: int, coefficients: FloatArray, row: int, first: npt.NDArray[np.int64],
    inside: FloatArray, slip: FloatArray, edge: FloatArray,
) -> int:  # fmt: skip
    """Where in a table the launches of a block ``room`` (6, BLOCK) stand; Q and rω beside.

    Into ``first`` the place of the first of four rows of ``row`` numbers, into ``inside`` that in
    the cell.  Returns of how many launches the numbers are none, or δ < 0, or J or r are not above
    0.
    """
    cells = float(coefficients.shape[1] - 3)
    side_stride = float(coefficients.shape[1] * row)
    vx, vy, spin = room[0], room[1], room[2]
    delta, decel, radius = room[3], room[4], room[5]
    unsafe = 0
    for n in range(count):
        rim = radius[n] * spin[n]
        speed2 = vx[n] * vx[n] + vy[n] * vy[n]
        slip2 = speed2 + rim * rim
        edge[n] = rim
        slip[n] = math.sqrt(slip2)
        usual = (slip2 > SMALLEST) & (slip2 < LARGEST) & (delta[n] >= 0.0) & (decel[n] > 0.0)
        unsafe += 0 if usual & (decel[n] < math.inf) & (radius[n] > 0.0) else 1
        cell, inside[n] = quick_place(math.sqrt(speed2), abs(rim), cells)
        first[n] = int(row * cell + (side_stride if rim * rim > speed2 else 0.0))
    if unsafe == 0:
        return 0
    bad = 0
    for n in range(count):  # anew, with care for the largest and smallest numbers
        slip2 = vx[n] * vx[n] + vy[n] * vy[n] + edge[n] * edge[n]
        good = (delta[n] >= 0.0) & (delta[n] < math.inf)
        for m in range(4, 6):
            good &= (room[m, n] > 0.0) & (room[m, n] < math.inf)
        for m in range(3):
            good &= abs(room[m, n]) < math.inf
        bad += 0 if good else 1
        if (slip2 > SMALLEST) & (slip2 < LARGEST):
            continue  # the same bits whatever else is in the block
        speed = math.hypot(vx[n], vy[n])
        slip[n] = math.hypot(speed, edge[n])
        side, xi = slip_place(speed, abs(edge[n]))
        cell = _cell(xi * cells, cells)
        inside[n] = xi * cells - cell
        first[n] = int(row * cell + side * side_stride)
    return bad


@cache
def stops_kernel(powers: int) -> Callable[..., tuple[int, int, int]]:
    """The compiled look-up for stop tables of so many powers of 2δ² − 1.

    The function (vx, vy, step, spin, delta, decel, radius, coefficients, time, x, y, apart): stop
    time, x, y of launches (see :class:`puck_tables.stopping.launches.Launches`) into ``time`` (n,)
    and every ``apart``-th place of ``x`` and ``y``.  Returns of how many launches Q²/J or Q²/(J r)
    may be too large, how many are no launches, and their mark.  Coefficients: array (2 sides,
    cells + 3, powers × :data:`WIDTH`), powers ascending, functions T, along, across.

    In blocks of three loops: places (vectorised), functions (in the lanes of registers,
    :func:`puck_tables.kernels.compile.spline_values`), results (vectorised).  The number of powers
    is a constant of the compiled code: with it the rows stay in registers.
    """
    row = WIDTH * powers

    @allocating
    def fill(
        vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
        decel: FloatArray, radius: FloatArray, coefficients: FloatArray, time: FloatArray,
        x: FloatArray, y: FloatArray, apart: int,
    ) -> tuple[int, int, int]:  # fmt: skip
        c = coefficients.reshape(-1)
        room, first = np.empty((COLUMNS, BLOCK)), np.empty(BLOCK, np.int64)
        inside, slip, edge = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
        fill_constants(vx, vy, spin, delta, decel, radius, room)
        found = np.empty((3, BLOCK))
        doubtful, bad, mark = 0, 0, 0
        for start in range(0, time.size, BLOCK):
            count = min(BLOCK, time.size - start)
            mark += fetch_block(vx, vy, step, spin, delta, decel, radius, start, count, room)
            bad += place_block(room, count, coefficients, row, first, inside, slip, edge)
            east, north, tilt = room[0], room[1], room[3]
            weight, size_of = room[4], room[5]
            f, g, h = found[0], found[1], found[2]
            for n in range(count):
                s = 2.0 * tilt[n] * tilt[n] - 1.0
                values = spline_values(c, first[n], basis(inside[n]), s, WIDTH, powers)
                f[n], g[n], h[n] = values[0], values[1], values[2]
            here = time[start : start + count]
            for n in range(count):
                rim, along, left = edge[n], east[n], north[n]
                inverse = 1.0 / weight[n]
                scale = slip[n] * inverse
                straight = scale * (0.5 if rim == 0.0 else g[n])
                across = tilt[n] * (rim * inverse) * h[n]
                still = (along == 0.0) & (left == 0.0)
                here[n] = scale * (1.0 if rim == 0.0 else (0.75 if still else f[n]))
                g[n] = straight * along - across * left
                h[n] = straight * left + across * along
                size = scale * slip[n]
                usual = (size < LARGEST) & (size < LARGEST * size_of[n]) & (inverse < math.inf)
                doubtful += 0 if usual else 1
            if apart == 2:
                x_here, y_here = x[2 * start :], y[2 * start :]
                for n in range(count):
                    x_here[2 * n], y_here[2 * n] = g[n], h[n]
            else:
                x[start : start + count], y[start : start + count] = g[:count], h[:count]
        return doubtful, bad, mark

    return fill
