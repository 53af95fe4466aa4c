"""Derivatives of stops by look-up, compiled, and those of states from natural units to SI units.

The chain rule of the similarity: places and body angles grow like Q²/J, the latter like 1/r too,
times like Q/J, velocities like Q; everything turns with the launch velocity, and the mirror image
belongs to the opposite spin.

Of stops: with a = rω, s = sin φ, c = cos φ and D_f = f_u/(s c²) of
:mod:`puck_tables.stopping.slopes`, in the frame of the launch (along its velocity, and to the left
of it; w = vx + i vy), for a ≥ 0,

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
    kernel,
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
from puck_tables.stopping.lookup import EDGE, FIRST, INSIDE, PLACED, SLIP, SPEED, place_block
from puck_tables.stopping.slopes import STOP_FUNCTIONS, STOP_POWERS, STOP_WIDTH

Numbers = tuple[float, ...]
STATES, STATE_COLUMNS = 6, 7  # what is differentiated, and by how many: the launch and time
OWN_STATES = STATES * 6  # of each: itself; by v, v across, rω, δ, time
PLACED_STATES = STATES * STATE_COLUMNS  # of each: by vx, vy, ω, δ, J, r, time


@inlined
def direction(vx: float, vy: float, speed: float) -> tuple[float, float]:
    """Cosine and sine of the direction of a velocity; along x where there is none."""
    moving = speed if speed > 0.0 else 1.0
    return (vx if speed > 0.0 else 1.0) / moving, vy / moving


@inlined
def rotated(one: float, other: float, cosine: float, sine: float) -> tuple[float, float]:
    """A vector turned by an angle of this cosine and sine."""
    return one * cosine - other * sine, one * sine + other * cosine


@inlined
def in_world(own: Numbers, east: float, north: float, around: float) -> Numbers:
    """Six rows of six along and to the left of the launch, as such along x and y.

    (``east``, ``north``): the direction of the launch; ``around``: the sign of its spin.
    """
    x0, y0 = rotated(own[0], around * own[6], east, north)
    x1, y1 = rotated(own[1], around * own[7], east, north)
    x2, y2 = rotated(around * own[2], own[8], east, north)
    x3, y3 = rotated(own[3], around * own[9], east, north)
    x4, y4 = rotated(own[4], around * own[10], east, north)
    x5, y5 = rotated(own[5], around * own[11], east, north)
    p0, q0 = rotated(own[18], around * own[24], east, north)
    p1, q1 = rotated(own[19], around * own[25], east, north)
    p2, q2 = rotated(around * own[20], own[26], east, north)
    p3, q3 = rotated(own[21], around * own[27], east, north)
    p4, q4 = rotated(own[22], around * own[28], east, north)
    p5, q5 = rotated(own[23], around * own[29], east, north)
    return (
        x0, x1, x2, x3, x4, x5, y0, y1, y2, y3, y4, y5, *own[12:18],
        p0, p1, p2, p3, p4, p5, q0, q1, q2, q3, q4, q5, *own[30:],
    )  # fmt: skip


@inlined
def _line(
    own: Numbers, unit: float, by_speed: float, by_time: float, gone: float, elapsed: float,
    around: float, east: float, north: float, spin: float, radius: float,
) -> Numbers:  # fmt: skip
    """A row of seven, of what has a direction."""
    rim, rate = around * by_speed * own[3], by_time * own[5]
    east, north = by_speed * east, by_speed * north
    return (
        east * own[1] - north * own[2], north * own[1] + east * own[2], radius * rim,
        unit * own[4], elapsed * rate - gone * own[0], spin * rim, rate,
    )  # fmt: skip


@inlined
def _turn(
    own: Numbers, unit: float, by_speed: float, by_time: float, gone: float, elapsed: float,
    around: float, east: float, north: float, spin: float, radius: float, deflection: float,
) -> Numbers:  # fmt: skip
    """A row of seven, of what changes its sign with the spin."""
    value, ahead = around * unit * own[0], around * by_speed * own[1]
    rim, rate = by_speed * own[3], around * by_time * own[5]
    return (
        east * ahead, north * ahead, radius * rim, around * unit * own[4],
        elapsed * rate - gone * value, spin * rim - value * deflection, rate,
    )  # fmt: skip


@inlined
def placed_state(
    east: float, north: float, around: float, spin: float, decel: float, unit: float,
    radius: float, deflection: float, slip: float, time: float, own: Numbers,
) -> Numbers:  # fmt: skip
    """From natural units, along x and y (:func:`in_world`), six rows of six to six of seven.

    ``unit``: 1/J; ``deflection``: 1/r.
    """
    duration, elapsed = slip * unit, time * unit
    place = slip * duration
    frame = elapsed, around, east, north, spin, radius
    lengths, moving = (place, duration, slip, unit * place), (slip, 1.0, decel, 0.0)
    return (
        *_line(own[:6], *lengths, *frame),
        *_line(own[6:12], *lengths, *frame),
        *_turn(own[12:18], deflection * place, deflection * duration, deflection * slip, unit,
        *frame, deflection), *_line(own[18:24], *moving, *frame),
        *_line(own[24:30], *moving, *frame),
        *_turn(own[30:], deflection * slip, deflection, deflection * decel, 0.0, *frame,
        deflection),
    )  # fmt: skip


@inlined
def placed_stop(
    vx: float, vy: float, spin: float, decel: float, radius: float, speed: float, slip: float,
    own: Numbers,
) -> Numbers:  # fmt: skip
    """From the frame of the launch and Q = J = r = 1, five rows of four, to five rows of six.

    NaN for the path of pure spin by vx and vy.
    """
    unit, deflection = 1.0 / decel, 1.0 / radius
    duration = slip * unit
    place, lost = slip * duration, unit * duration
    east, north = direction(vx, vy, speed)
    around = 1.0 if spin >= 0.0 else -1.0
    frame = 0.0, around, east, north, spin, radius
    # z = e (ahead + i aside) v: across the velocity it changes by i z/v
    x0, y0 = rotated(own[4], around * own[8], east, north)
    x1, y1 = rotated(own[5], around * own[9], east, north)
    x2, y2 = rotated(-around * own[8], own[4], east, north)
    x3, y3 = rotated(own[6], around * own[10], east, north)
    x4, y4 = rotated(own[7], around * own[11], east, north)
    by_speed = own[13] if speed > 0.0 else math.nan
    time = _line((own[0], own[1], 0.0, own[2], own[3], 0.0), duration, unit, 0.0, lost, *frame)
    x = _line((x0, x1, x2, x3, x4, 0.0), place, duration, 0.0, lost * speed, *frame)
    y = _line((y0, y1, y2, y3, y4, 0.0), place, duration, 0.0, lost * speed, *frame)
    length = _line(
        (own[12], by_speed, 0.0, own[14], own[15], 0.0), place, duration, 0.0, unit * place, *frame
    )
    body = _turn(
        (own[16], own[17], 0.0, own[18], own[19], 0.0), deflection * place, deflection * duration,
        0.0, unit, *frame, deflection,
    )  # fmt: skip
    return (*time[:6], *x[:6], *y[:6], *length[:6], *body[:6])


@kernel
def fill_placed_states(
    puck: FloatArray, times: FloatArray, own: FloatArray, out: FloatArray
) -> None:
    """Derivatives of states (n, 6, 7) of a puck from natural ones ``own`` (n, 6, 6)."""
    vx, vy, spin, decel, radius = puck[0], puck[1], puck[2], puck[4], puck[5]
    speed = math.hypot(vx, vy)
    slip, unit = math.hypot(speed, radius * spin), 1.0 / decel
    east, north = direction(vx, vy, speed)
    around = 1.0 if spin >= 0.0 else -1.0
    flat, numbers = own.reshape(-1), out.reshape(-1)
    for n in range(times.size):
        patience(1)
        row = weighted_rows(flat, OWN_STATES * n, (1.0,), OWN_STATES)
        placed = placed_state(
            east, north, around, spin, decel, unit, radius, 1.0 / radius, slip, times[n],
            in_world(row, east, north, around),
        )  # fmt: skip
        for k in range(PLACED_STATES):
            numbers[PLACED_STATES * n + k] = placed[k]


STOP_ROWS = 5  # what is differentiated: time, x, y, path, body angle
LAUNCH_COLUMNS = 6  # vx, vy, ω, δ, J, r

# what a place on the curve says of a stop: five functions, D of each, and derivatives by δ
T, ALONG, ACROSS, TURNED, LENGTH = range(STOP_FUNCTIONS)
D, BY_HEIGHT = STOP_FUNCTIONS, 2 * STOP_FUNCTIONS
STOP_VALUES = 3 * STOP_FUNCTIONS
# of a stop in the frame of its launch: value, by v, by a, by δ; J = 1
OWN_COLUMNS = 4  # of such a row: the four above
OWN = STOP_ROWS * OWN_COLUMNS
STOP_ROW = STOP_POWERS * STOP_WIDTH
_OUT = STOP_ROWS * LAUNCH_COLUMNS
# rows of a block behind those of the launches and their places
_VALUES = PLACED
_PUT = PLACED + STOP_VALUES
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
    w, dw, w_tilt = result[LENGTH], result[D + LENGTH], result[BY_HEIGHT + LENGTH]
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
            into_rows(room, _VALUES, n, result)
        for n in range(count):
            speed, slip = row_of(room, SPEED, n), row_of(room, SLIP, n)
            c, s = speed / slip, abs(row_of(room, EDGE, n)) / slip
            result = rows_of(room, _VALUES, STOP_VALUES, n)
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
