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
from puck_tables.kernels.compile import (
    BLOCK,
    inlined,
    into_row,
    look_up,
    patience,
    row_of,
    spline_values,
)
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping.launch_arrays import (
    COLUMNS,
    DECEL,
    DELTA,
    RADIUS,
    SPIN,
    VX,
    VY,
    fetch_block,
    fill_constants,
    mark_block,
)

# rows of a block behind those of the launches
FIRST, INSIDE, SLIP, EDGE, SPEED = range(COLUMNS, COLUMNS + 5)
PLACED = COLUMNS + 5
_TIME, _X, _Y, _ROWS = range(PLACED, PLACED + 4)
STOP_POWERS = 8  # of s, a cache line
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
    """The cell in which a place lies, found without leaving floating point."""
    inside = place if place > 0.0 else 0.0
    last = cells - 1.0
    cell: float = np.floor(inside if inside < last else last)
    return cell


@inlined
def place_block(room: FloatArray, count: int, coefficients: FloatArray, row: int) -> int:
    """Where in a table the launches of a block stand, and Q, rω and v, into rows of ``room``.

    FIRST: the place of the first of four rows of ``row`` numbers; INSIDE: that in the cell.
    Returns how many are no launches: numbers that are none, δ < 0, J or r not above 0.
    """
    cells = float(coefficients.shape[1] - 3)
    side_stride = float(coefficients.shape[1] * row)
    unsafe = 0
    for n in range(count):
        vx, vy, delta = row_of(room, VX, n), row_of(room, VY, n), row_of(room, DELTA, n)
        decel, radius = row_of(room, DECEL, n), row_of(room, RADIUS, n)
        rim = radius * row_of(room, SPIN, n)
        speed2 = vx * vx + vy * vy
        slip2 = speed2 + rim * rim
        usual = (slip2 > SMALLEST) & (slip2 < LARGEST) & (delta >= 0.0) & (decel > 0.0)
        usual &= (delta < math.inf) & (decel < math.inf) & (radius > 0.0) & (radius < math.inf)
        unsafe += 0 if usual & ((speed2 > SMALLEST) | ((vx == 0.0) & (vy == 0.0))) else 1
        speed = math.sqrt(speed2)
        cell, inside = quick_place(speed, abs(rim), cells)
        into_row(room, EDGE, n, rim)
        into_row(room, SPEED, n, speed)
        into_row(room, SLIP, n, math.sqrt(slip2))
        into_row(room, INSIDE, n, inside)
        into_row(room, FIRST, n, row * cell + (side_stride if rim * rim > speed2 else 0.0))
    return _place_with_care(room, count, cells, float(row), side_stride) if unsafe > 0 else 0


@inlined
def _place_with_care(
    room: FloatArray, count: int, cells: float, row: float, side_stride: float
) -> int:
    """Place a block with care for the largest and smallest numbers; how many are no launches."""
    bad = 0
    for n in range(count):
        vx, vy, edge = row_of(room, VX, n), row_of(room, VY, n), row_of(room, EDGE, n)
        delta = row_of(room, DELTA, n)
        decel = row_of(room, DECEL, n)
        radius = row_of(room, RADIUS, n)
        good = (delta >= 0.0) & (delta < math.inf) & (decel > 0.0) & (decel < math.inf)
        good &= (radius > 0.0) & (radius < math.inf)
        good &= (
            (abs(vx) < math.inf) & (abs(vy) < math.inf) & (abs(row_of(room, SPIN, n)) < math.inf)
        )
        bad += 0 if good else 1
        speed = math.hypot(vx, vy)
        if speed < 1e-120:
            into_row(room, SPEED, n, speed)
        slip2 = vx * vx + vy * vy + edge * edge
        if (slip2 > SMALLEST) & (slip2 < LARGEST):
            continue  # the same bits whatever else is in the block
        into_row(room, SPEED, n, speed)
        into_row(room, SLIP, n, math.hypot(speed, edge))
        side, xi = slip_place(speed, abs(edge))
        cell = _cell(xi * cells, cells)
        into_row(room, INSIDE, n, xi * cells - cell)
        into_row(room, FIRST, n, row * cell + side * side_stride)
    return bad


@cache
def stops_kernel(powers: int) -> Callable[..., tuple[int, int, int]]:
    """The compiled look-up for stop tables of so many powers of 2δ² − 1.

    The function (vx, vy, step, spin, delta, decel, radius, coefficients, time, x, y, apart): stop
    time, x, y of launches (see :class:`puck_tables.stopping.launch_arrays.Launches`) into ``time``
    (n,) and every ``apart``-th place of ``x`` and ``y``.  Returns of how many launches Q²/J or
    Q²/(J r) may be too large, how many are no launches, and their mark.  Coefficients: array (2
    sides, cells + 3, powers × :data:`WIDTH`), powers ascending, functions T, along, across.

    In blocks of three loops: places (vectorised), functions (in the lanes of registers,
    :func:`puck_tables.kernels.compile.spline_values`), results (vectorised).  The number of powers
    is a constant of the compiled code: with it the rows stay in registers.
    """
    row = WIDTH * powers

    @look_up
    def fill(
        vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
        decel: FloatArray, radius: FloatArray, coefficients: FloatArray, time: FloatArray,
        x: FloatArray, y: FloatArray, apart: int,
    ) -> tuple[int, int, int]:  # fmt: skip
        patience(time.size)
        c, room = coefficients.reshape(-1), np.empty(_ROWS * BLOCK)
        fill_constants(vx, vy, spin, delta, decel, radius, time.size, room)
        doubtful, bad, mark = 0, 0, 0
        for start in range(0, time.size, BLOCK):
            count = min(BLOCK, time.size - start)
            fetch_block(vx, vy, step, spin, delta, decel, radius, start, count, room)
            mark += mark_block(vx, vy, step, spin, delta, decel, radius, start, count)
            bad += place_block(room, count, coefficients, row)
            for n in range(count):
                tilt = row_of(room, DELTA, n)
                s, at = 2.0 * tilt * tilt - 1.0, int(row_of(room, FIRST, n))
                weights = basis(row_of(room, INSIDE, n))
                values = spline_values(c, at, weights, s, WIDTH, powers)
                into_row(room, _TIME, n, values[0])
                into_row(room, _X, n, values[1])
                into_row(room, _Y, n, values[2])
            doubtful += _place_stops(room, count)
            times = time[start : start + count]
            for n in range(count):
                times[n] = row_of(room, _TIME, n)
            x_here, y_here = x[apart * start :], y[apart * start :]
            if apart == 2:
                for n in range(count):
                    x_here[2 * n], y_here[2 * n] = row_of(room, _X, n), row_of(room, _Y, n)
            else:
                for n in range(count):
                    x_here[n], y_here[n] = row_of(room, _X, n), row_of(room, _Y, n)
        return doubtful, bad, mark

    return fill


@inlined
def _place_stops(room: FloatArray, count: int) -> int:
    """From functions to stops; how many may be too large for floating point."""
    doubtful = 0
    for n in range(count):
        rim, slip, tilt = row_of(room, EDGE, n), row_of(room, SLIP, n), row_of(room, DELTA, n)
        along, left = row_of(room, VX, n), row_of(room, VY, n)
        decel = row_of(room, DECEL, n)
        scale = slip / decel
        straight = scale * (0.5 if rim == 0.0 else row_of(room, _X, n))
        across = tilt * (rim / decel) * row_of(room, _Y, n)
        still = (along == 0.0) & (left == 0.0)
        time = 1.0 if rim == 0.0 else (0.75 if still else row_of(room, _TIME, n))
        into_row(room, _TIME, n, scale * time)
        into_row(room, _X, n, straight * along - across * left)
        into_row(room, _Y, n, straight * left + across * along)
        size, radius = scale * slip, row_of(room, RADIUS, n)
        usual = (size < LARGEST) & (size < LARGEST * radius)
        doubtful += 0 if usual else 1
    return doubtful
