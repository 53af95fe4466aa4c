"""Derivatives of stops by look-up, compiled: what the stop table holds, and the chain rule."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    LINE,
    inlined,
    into_rows,
    look_up,
    patience,
    row_of,
    rows_of,
    spline_polynomials,
    stream_line,
    turn_square,
)
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping.launch_arrays import (
    DECEL,
    DELTA,
    RADIUS,
    SPIN,
    VX,
    VY,
    fetch_block,
    fill_constants,
)
from puck_tables.stopping.launch_derivatives import (
    PLACED_STOPS,
    Numbers,
    placed_stop,
    stop_by_speeds,
)
from puck_tables.stopping.lookup import EDGE, FIRST, INSIDE, PLACED, SLIP, SPEED, place_block
from puck_tables.stopping.slopes import STOP_FUNCTIONS, STOP_POWERS, STOP_WIDTH

_STOP_VALUES = 3 * STOP_FUNCTIONS  # what a place on the curve says of a stop
_STOP_ROW = STOP_POWERS * STOP_WIDTH  # numbers of a node
# rows of a block behind those of the launches and their places
_VALUES = PLACED
_PUT = PLACED + _STOP_VALUES
_ROWS = _PUT + 2 * PLACED_STOPS

# More than caches hold, but less than what C libraries ask of the system anew each time (32 MiB):
# that has just been cleared, through the caches.
_MANY, _NEW = 1 << 19, 1 << 22


@inlined
def _functions(slopes: FloatArray, first: int, weights: Numbers, delta: float) -> Numbers:
    """The functions of the stop at a place of the curve (15); ``slopes`` flat."""
    s, k = 2.0 * delta * delta - 1.0, 4.0 * delta
    f = spline_polynomials(slopes, first, weights, s, STOP_WIDTH, STOP_POWERS)
    return (
        f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9],
        k * f[12], k * f[13], k * f[14], k * f[15], k * f[16],
    )  # fmt: skip


def is_streamed(out: FloatArray) -> bool:
    """Whether an array, or that of which it is a part, is best written past the caches."""
    size = out.size if out.base is None else out.base.size
    return _MANY < size <= _NEW


@inlined
def row_by_row(
    room: FloatArray, first: int, rows: int, count: int, out: FloatArray, start: int, streamed: bool
) -> None:
    """So many rows of a block, from one on, side by side into ``out``, from number start · rows.

    Behind them as many rows are free.  ``streamed``: see :func:`is_streamed`.
    """
    begin = rows * start
    side, goal = (room, (first + rows) * BLOCK) if streamed else (out, begin)
    whole, size = count - count % 4, rows * count
    for n in range(0, whole, 4):
        for row in range(0, rows, 4):
            at = min(row, rows - 4)
            turn_square(room, (first + at) * BLOCK + n, BLOCK, side, goal + rows * n + at, rows)
    for n in range(whole, count):
        for row in range(rows):
            side[goal + rows * n + row] = room[(first + row) * BLOCK + n]
    if streamed:
        head = min(-(out.ctypes.data // 8 + begin) % LINE, size)
        tail = head + (size - head) // LINE * LINE
        for n in range(head):
            out[begin + n] = side[goal + n]
        for n in range(head, tail, LINE):
            stream_line(side, goal + n, out, begin + n)
        for n in range(tail, size):
            out[begin + n] = side[goal + n]


@look_up
def fill_stop_jacobians(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, slopes: FloatArray, streamed: bool, out: FloatArray,
) -> None:  # fmt: skip
    """∂(time, x, y, path, body angle)/∂(vx, vy, ω, δ, J, r) of launches into ``out`` (n, 5, 6).

    Launches as for :func:`puck_tables.stopping.lookup.stops_kernel`; ``slopes``:
    :attr:`puck_tables.stopping.slopes.Slopes.stops`.  NaN for a launch at rest, where the time has
    no derivative, and for the path of pure spin by vx and vy, which grows like |v|.
    """
    patience(len(out))
    flat, numbers, room = slopes.reshape(-1), out.reshape(-1), np.empty(_ROWS * BLOCK)
    fill_constants(vx, vy, spin, delta, decel, radius, len(out), room)
    for start in range(0, len(out), BLOCK):
        count = min(BLOCK, len(out) - start)
        fetch_block(vx, vy, step, spin, delta, decel, radius, start, count, room)
        place_block(room, count, slopes, _STOP_ROW)
        for n in range(count):
            first, tilt = int(row_of(room, FIRST, n)), row_of(room, DELTA, n)
            result = _functions(flat, first, basis(row_of(room, INSIDE, n)), tilt)
            into_rows(room, _VALUES, n, result)
        for n in range(count):
            speed, slip = row_of(room, SPEED, n), row_of(room, SLIP, n)
            c, s = speed / slip, abs(row_of(room, EDGE, n)) / slip
            result = rows_of(room, _VALUES, _STOP_VALUES, n)
            own = stop_by_speeds(c, s, 1.0, c, s, row_of(room, DELTA, n), result)
            placed = placed_stop(
                row_of(room, VX, n), row_of(room, VY, n), row_of(room, SPIN, n),
                row_of(room, DECEL, n), row_of(room, RADIUS, n), speed, slip, own,
            )  # fmt: skip
            into_rows(room, _PUT, n, placed)
        row_by_row(room, _PUT, PLACED_STOPS, count, numbers, start, streamed)
