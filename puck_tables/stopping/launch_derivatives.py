"""From natural units to derivatives by the launch: one chain rule for all pucks, compiled.

A puck with Q = J = r = 1 at the launch, ω ≥ 0 and v along x is known by its slip angle φ and its
height δ alone.  How its stop and its states change with these two, at the same Q, is looked up for
plain pucks (:mod:`puck_tables.stopping.stop_jacobian`, :mod:`puck_tables.stopping.state_jacobian`)
and integrated for all others (:mod:`puck_tables.stopping.variational`); the rest is done here.

At the same time: Q falls by d ln Q/dt = −q and u = ln tan φ by du/d ln Q = −ρ, so a change t_p of
the time at the same Q changes

    ln Q by q t_p,    u by u_p − ρ q t_p,    places by x_p − v t_p .

By the launch: a quantity Q^n f(φ, δ) changes by n f with ln Q and by f_φ with φ.  With
v = Q cos φ, a = rω = Q sin φ, c = cos φ and s = sin φ that is a rotation,

    ∂/∂v = c n f − s f_φ,    ∂/∂a = s n f + c f_φ .

In SI units: places and body angles grow like Q²/J, the latter like 1/r too, times like Q/J,
velocities like Q; everything turns with the launch velocity, and the mirror image belongs to the
opposite spin.

What the stop table holds is smooth at both ends.  With D_f = f_u/(s c²)
(:mod:`puck_tables.stopping.slopes`), in the frame of the launch (along its velocity, and to the
left of it; w = vx + i vy),

    ∂t/∂v = c (T − s D_T)/J,    ∂t/∂a = (s T + c² D_T)/J,
    ∂z/∂v = [Q (α + c² (α − s D_α)) + i δ a (β − s c² D_β)]/J,    ∂z/∂v_⊥ = i z/v,
    ∂z/∂a = v [s α + c² D_α + i δ (β + s c² D_β)]/J,    ∂z/∂δ = v [Q α_δ + i a (β + δ β_δ)]/J,

and likewise for path and body angle: nothing is divided by v or a, so that pure spin and pure
sliding are cases like all others.  z/v = (Q α + i δ a β)/J.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, kernel, patience, weighted_rows
from puck_tables.stopping.slopes import STOP_FUNCTIONS

Numbers = tuple[float, ...]
STATES, STATE_COLUMNS = 6, 7  # what is differentiated, and by how many: the launch and time
OWN_STATES = STATES * 6  # of each: itself; by v, v across, rω, δ, time
PLACED_STATES = STATES * STATE_COLUMNS  # of each: by vx, vy, ω, δ, J, r, time
STOP_ROWS = 5  # what is differentiated: time, x, y, path, body angle
# of a stop in the frame of its launch: value, by v, by a, by δ; J = 1
OWN_COLUMNS = 4  # of such a row: the four above
OWN = STOP_ROWS * OWN_COLUMNS
PLACED_STOPS = STOP_ROWS * 6  # of each: by vx, vy, ω, δ, J, r
# what a place on the curve says of a stop: five functions, D of each, and derivatives by δ
T, ALONG, ACROSS, TURNED, LENGTH = range(STOP_FUNCTIONS)
D, BY_HEIGHT = STOP_FUNCTIONS, 2 * STOP_FUNCTIONS


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


@inlined
def at_same_time(change: Numbers, moving: Numbers) -> Numbers:
    """How x, y, body angle, vx, vy and rω change at one time, from what changes at one Q.

    ``change``: of u, heading, time, x, y and body angle; ``moving``: v, rω, cosine and sine of φ
    and of the heading, −d ln Q/dt, ρ = −du/d ln Q, and the turn of the heading per ln Q.

    A pure slide half over, read a little later:

    >>> half_over = 0.5, 0.0, 1.0, 0.0, 1.0, 0.0, 2.0, 0.5, 0.0
    >>> at_same_time((0.0, 0.0, -1.0, 0.0, 0.0, 0.0), half_over)[:4]
    (0.5, 0.0, 0.0, -1.0)
    """
    u, turn, time, x, y, body = change
    speed, rim, c, s, east, north, fall, rate, swing = moving
    log_q = fall * time
    u = u - rate * log_q  # of arrays too
    v, a = speed * (log_q - s * (s * u)), rim * (log_q + c * (c * u))
    aside, gone = speed * (turn + swing * log_q), speed * time
    return (
        x - gone * east, y - gone * north, body - rim * time, v * east - aside * north,
        v * north + aside * east, a,
    )  # fmt: skip


@inlined
def by_launch(
    c: float, s: float, inverse: float, time: float, value: Numbers, by_angle: Numbers,
    by_height: Numbers, by_time: Numbers,
) -> Numbers:  # fmt: skip
    """A state and its derivatives in natural units, along x and y, six rows of six.

    ``c``, ``s``: of the slip angle of the launch; ``inverse``: 1/c.  The others: x, y, body angle,
    vx, vy, rω at a time, and their derivatives by φ, δ, and that time.  Columns: itself; by v, v
    across, rω, δ, time.
    """
    x, y, b, vx, vy, a = value
    x1, y1, b1, p1, q1, a1 = by_angle
    x4, y4, b4, p4, q4, a4 = by_height
    x5, y5, b5, p5, q5, a5 = by_time
    xv, xa = rotated(2.0 * x - time * x5, x1, c, s)
    yv, ya = rotated(2.0 * y - time * y5, y1, c, s)
    bv, ba = rotated(2.0 * b - time * b5, b1, c, s)
    pv, pa = rotated(vx - time * p5, p1, c, s)
    qv, qa = rotated(vy - time * q5, q1, c, s)
    av, aa = rotated(a - time * a5, a1, c, s)
    return (
        x, xv, -y * inverse, xa, x4, x5, y, yv, x * inverse, ya, y4, y5, b, bv, 0.0, ba, b4, b5,
        vx, pv, -vy * inverse, pa, p4, p5, vy, qv, vx * inverse, qa, q4, q5, a, av, 0.0, aa, a4, a5,
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
    """From natural units, along x and y, six rows of six to six of seven.

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
        placed = placed_state(
            east, north, around, spin, decel, unit, radius, 1.0 / radius, slip, times[n],
            weighted_rows(flat, OWN_STATES * n, (1.0,), OWN_STATES),
        )  # fmt: skip
        for k in range(PLACED_STATES):
            numbers[PLACED_STATES * n + k] = placed[k]


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
        for k in range(PLACED_STOPS):
            numbers[PLACED_STOPS * n + k] = placed[k]
