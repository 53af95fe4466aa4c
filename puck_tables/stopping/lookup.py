"""Stops by look-up, compiled: a launch in Cartesian components, square roots, one cell, no angle.

With Q = hypot(v, rω), T = ``time``, and the factors that vanish taken out,

    X = cos φ · along,   Y = δ sin φ cos φ · across,   path = cos φ · length,   body = sin φ · body,

the stop of a launch (vx, vy), ω is

    t = (Q/J) T,    x = (Q · along · vx − δ rω · across · vy)/J,    y likewise,

and no direction has to be computed: at rest, in pure sliding and in pure spin nothing is divided
by zero.  Each function is a cubic spline in ξ whose coefficients are polynomials in s = 2δ² − 1.

Slip axis.  On either side of φ = π/4 let k = min(v, r|ω|)/max(v, r|ω|) and 2k/(1 + k) = q⁴.  The
nodes are uniform in ξ ∈ [0, 1] with

    q = ξ (2 − ξ),   so   k ∝ ξ⁴ at φ = 0 and π/2,   1 − k ∝ (1 − ξ)² at π/4.

What is tabulated carries k^(8/(4 + δ²)) and k² ln k at φ = 0, a power between 2 and 4 at π/2, and
x³ ln|x| at π/4; in ξ all of it is smooth enough for a cubic spline with zero end slopes to keep
order 4.  No angle is needed to find the place of a launch: square roots are enough.

Height axis.  Everything tabulated is analytic in δ², for 0 ≤ δ ≤ 1, and held at nine Chebyshev
points of δ².  For the stop itself a polynomial of degree 7 in δ² is enough (1e-12); the curve takes
degree 8 (5e-11).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.errors import InputError
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
from puck_tables.table.spline_fit import clamped_coefficients

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


# nodes over δ: the polynomials through them err by 5e-12; and, to 1e-12, for what depends on δ
# alone, as next to the limit its error is magnified:
# test_polynomials_of_the_height_are_as_exact_as_they_say
HEIGHTS = 9
CONSTANT_HEIGHTS = 14
MAX_CELLS = 1 << 16  # of an axis: more is a damaged file


def by_power(nodes: FloatArray, powers: int = HEIGHTS) -> FloatArray:
    """Coefficients (powers, nodes + 2, 2, …) from values (2 sides, nodes, heights, …).

    Powers of 2δ² − 1, ascending; a sixth of the B-splines' weights, from one end of a side to φ =
    π/4.
    """
    splines = clamped_coefficients(np.moveaxis(nodes, 1, 0)) / 6.0  # node, side, height, …
    return height_polynomials(np.moveaxis(splines, 2, 0), powers)


def side_by_side(coefficients: FloatArray) -> FloatArray:
    """Coefficients (power, node, side, function) as (2 sides, nodes, powers × functions)."""
    ordered = coefficients.transpose(2, 1, 0, 3)
    return aligned(ordered.reshape(*ordered.shape[:2], -1))


def section_rows(sides: FloatArray, powers: int) -> FloatArray:
    """Rows (2, nodes + 2, powers × WIDTH) of T, along, across, body (2 sides, nodes, heights, 4).

    All but T have one power fewer.
    """
    times = by_power(sides[..., 0], powers)  # power, node, side
    places = by_power(sides[..., 1:], powers - 1)
    result = np.zeros((2, times.shape[1], powers, WIDTH))
    result[..., 0] = times.transpose(2, 1, 0)
    result[:, :, :-1, 1:] = places.transpose(2, 1, 0, 3)
    return aligned(result.reshape(2, -1, powers * WIDTH))


def at_height(rows: FloatArray, delta: float) -> FloatArray:
    """T, along, δ · across and body at one height, (2, (cells + 3) × WIDTH): of no power."""
    powers = rows.reshape(2, -1, STOP_POWERS, WIDTH)
    result = np.zeros_like(powers[:, :, 0])
    for power in range(STOP_POWERS - 1, -1, -1):
        result = result * (2.0 * delta**2 - 1.0) + powers[:, :, power]
    result[..., 2] *= delta
    return np.ascontiguousarray(result.reshape(2, -1))


@dataclass(frozen=True)
class SlipAxis:
    """The nodes of slip, from pure sliding (φ = 0) over φ = π/4 to pure spin (φ = π/2).

    ``cells``: cells on either side of π/4, at least 8; the axis has ``2 cells + 1`` nodes.

    >>> SlipAxis(8).phi().round(4).tolist()[:5]
    [0.0, 0.0015, 0.0187, 0.0739, 0.1858]
    """

    cells: int

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= MAX_CELLS:
            raise InputError(f"cells must be from 8 to {MAX_CELLS}, got {self.cells}")

    @property
    def size(self) -> int:
        """Number of nodes."""
        return 2 * self.cells + 1

    def ratio(self) -> FloatArray:
        """K at the nodes of one side, from 0 to 1 (φ = π/4)."""
        return ratio_at(np.arange(self.cells + 1) / self.cells)

    def phi(self) -> FloatArray:
        """φ at all nodes, radians, ascending from 0 to π/2."""
        slow = np.arctan(self.ratio())
        return np.concatenate([slow, 0.5 * np.pi - slow[-2::-1]])


def ratio_at(xi: FloatArray) -> FloatArray:
    """The slip ratio k at ξ.

    >>> ratio_at(np.array([0.0, 0.5, 1.0])).round(6).tolist()
    [0.0, 0.187935, 1.0]
    """
    q4 = (xi * (2.0 - xi)) ** 4
    return q4 / (2.0 - q4)


def heights(count: int = HEIGHTS) -> FloatArray:
    """The heights δ at which the stop table holds values: Chebyshev points of δ² on [0, 1].

    >>> heights().round(4).tolist()
    [0.0872, 0.2588, 0.4226, 0.5736, 0.7071, 0.8192, 0.9063, 0.9659, 0.9962]
    """
    return np.sin(0.25 * np.pi * (2.0 * np.arange(count) + 1.0) / count)


def height_polynomials(values: FloatArray, count: int = HEIGHTS) -> FloatArray:
    """Coefficients in powers of 2δ² − 1 from values at the n points of :func:`heights`, axis 0.

    Of the interpolating Chebyshev series the first ``count`` terms are kept, nearly the best
    polynomial of that degree.

    >>> height_polynomials(heights() ** 2, 2).round(12).tolist()
    [0.5, 0.5]
    """
    n = len(values)
    nodes = 2.0 * heights(n) ** 2 - 1.0
    series = chebyshev.chebfit(nodes, values.reshape(n, -1), n - 1)[:count]
    return (series_to_powers(count) @ series).reshape(count, *values.shape[1:])


def series_to_powers(count: int) -> FloatArray:
    """What makes the coefficients of a polynomial from those of its Chebyshev series.

    >>> series_to_powers(3).tolist()  # 1, x, 2x² − 1
    [[1.0, 0.0, -1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]
    """
    matrix = np.zeros((count, count))
    for m, one in enumerate(np.eye(count)):
        matrix[: m + 1, m] = chebyshev.cheb2poly(one[: m + 1])
    return matrix
