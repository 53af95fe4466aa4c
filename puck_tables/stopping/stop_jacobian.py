"""Derivatives of stops by look-up, compiled.

With a = rω, s = sin φ, c = cos φ and D_f = f_u/(s c²) of :mod:`puck_tables.stopping.slopes`, in the
frame of the launch (along its velocity, and to the left of it; w = vx + i vy), for a ≥ 0,

    ∂t/∂v = c (T − s D_T)/J,    ∂t/∂a = (s T + c² D_T)/J,
    ∂z/∂v = [Q (α + c² (α − s D_α)) + i δ a (β − s c² D_β)]/J,    ∂z/∂v_⊥ = i z/v,
    ∂z/∂a = v [s α + c² D_α + i δ (β + s c² D_β)]/J,    ∂z/∂δ = v [Q α_δ + i a (β + δ β_δ)]/J,

and likewise for path and body angle: nothing is divided by v or a, so that pure spin and pure
sliding are cases like all others.  z/v = (Q α + i δ a β)/J.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    LINE,
    allocating,
    inlined,
    into_rows,
    look_up,
    patience,
    row_of,
    rows_of,
    spline_polynomials,
    stream_line,
    turn_square,
    weighted_rows,
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
from puck_tables.stopping.launch_frame import Numbers, placed_stop
from puck_tables.stopping.lookup import EDGE, FIRST, INSIDE, PLACED, SLIP, SPEED, place_block
from puck_tables.stopping.slopes import STOP_FUNCTIONS, STOP_POWERS, STOP_WIDTH

STOP_ROWS = 5  # what is differentiated: time, x, y, path, body angle
LAUNCH_COLUMNS = 6  # vx, vy, ω, δ, J, r

# what a place on the curve says of a stop: five functions, D of each, and derivatives by δ
T, ALONG, ACROSS, TURNED, WAY = range(STOP_FUNCTIONS)
D, BY_HEIGHT = STOP_FUNCTIONS, 2 * STOP_FUNCTIONS
STOP_FOUND = 3 * STOP_FUNCTIONS
# of a stop in the frame of its launch: value, by v, by a, by δ; J = 1
OWN_COLUMNS = 4  # of such a row: the four above
OWN = STOP_ROWS * OWN_COLUMNS
STOP_ROW = STOP_POWERS * STOP_WIDTH
_OUT = STOP_ROWS * LAUNCH_COLUMNS
# rows of a block behind those of the launches and their places
_FOUND = PLACED
_PUT = PLACED + STOP_FOUND
_ROWS = _PUT + 2 * _OUT

# More than caches hold, but less than what C libraries ask of the system anew each time (32 MiB):
# that has just been cleared, through the caches.
_MANY, _NEW = 1 << 19, 1 << 22


@inlined
def stop_functions(slopes: FloatArray, first: int, weights: Numbers, delta: float) -> Numbers:
    """The functions of the stop at a place of the curve (15); ``slopes`` flat."""
    s, k = 2.0 * delta * delta - 1.0, 4.0 * delta
    f = spline_polynomials(slopes, first, weights, s, STOP_WIDTH, STOP_POWERS)
    return (
        f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9],
        k * f[12], k * f[13], k * f[14], k * f[15], k * f[16],
    )  # fmt: skip


@inlined
def stop_by_speeds(
    speed: float, rim: float, slip: float, c: float, s: float, delta: float, result: Numbers
) -> Numbers:
    """Time, z/v, way and body angle and their derivatives by v, a ≥ 0 and δ, five rows of four.

    Rows: time, along, to the left, path, body angle; J = r = 1.  Along and left: of z, but the
    first column holds z/v.
    """
    c2, sc2 = c * c, s * c * c
    t, dt, t_tilt = result[T], result[D + T], result[BY_HEIGHT + T]
    x, dx, x_tilt = result[ALONG], result[D + ALONG], result[BY_HEIGHT + ALONG]
    y, dy, y_tilt = result[ACROSS], result[D + ACROSS], result[BY_HEIGHT + ACROSS]
    w, dw, w_tilt = result[WAY], result[D + WAY], result[BY_HEIGHT + WAY]
    b, db, b_tilt = result[TURNED], result[D + TURNED], result[BY_HEIGHT + TURNED]
    return (
        slip * t, c * (t - s * dt), s * t + c2 * dt, slip * t_tilt,
        slip * x, slip * (x + c2 * (x - s * dx)), speed * (s * x + c2 * dx), speed * slip * x_tilt,
        delta * rim * y, delta * rim * (y - sc2 * dy), delta * speed * (y + sc2 * dy),
        speed * rim * (y + delta * y_tilt),
        slip * speed * w, slip * w + speed * c * (w - s * dw), speed * (s * w + c2 * dw),
        slip * speed * w_tilt,
        slip * rim * b, rim * c * (b - s * db), slip * b + rim * (s * b + c2 * db),
        slip * rim * b_tilt,
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
        place_block(room, count, slopes, STOP_ROW)
        for n in range(count):
            first, tilt = int(row_of(room, FIRST, n)), row_of(room, DELTA, n)
            result = stop_functions(flat, first, basis(row_of(room, INSIDE, n)), tilt)
            into_rows(room, _FOUND, n, result)
        for n in range(count):
            speed, slip = row_of(room, SPEED, n), row_of(room, SLIP, n)
            c, s = speed / slip, abs(row_of(room, EDGE, n)) / slip
            result = rows_of(room, _FOUND, STOP_FOUND, n)
            own = stop_by_speeds(c, s, 1.0, c, s, row_of(room, DELTA, n), result)
            placed = placed_stop(
                row_of(room, VX, n), row_of(room, VY, n), row_of(room, SPIN, n),
                row_of(room, DECEL, n), row_of(room, RADIUS, n), speed, slip, own,
            )  # fmt: skip
            into_rows(room, _PUT, n, placed)
        row_by_row(room, _PUT, _OUT, count, numbers, start, streamed)


@allocating
def fill_placed_stops(launches: FloatArray, own: FloatArray, out: FloatArray) -> None:
    """Derivatives of stops (n, 5, 6) from natural ones ``own`` (n, 5, 4) of launches (6, n)."""
    flat, numbers = own.reshape(-1), out.reshape(-1)
    for n in range(launches.shape[1]):
        patience(1)
        vx, vy, spin, radius = launches[0, n], launches[1, n], launches[2, n], launches[5, n]
        speed = math.hypot(vx, vy)
        slip = math.hypot(speed, radius * spin)
        row = weighted_rows(flat, OWN * n, (1.0,), OWN)
        placed = placed_stop(vx, vy, spin, launches[4, n], radius, speed, slip, row)
        for k in range(_OUT):
            numbers[_OUT * n + k] = placed[k]
