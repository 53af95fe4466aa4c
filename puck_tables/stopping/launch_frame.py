"""Derivatives of stops and states from natural units, in the frame of the launch, to SI units.

The chain rule of the similarity: places and body angles grow like Q²/J, the latter like 1/r too,
times like Q/J, velocities like Q; everything turns with the launch velocity, and the mirror image
belongs to the opposite spin.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience, weighted_rows

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
    way, moving = (place, duration, slip, unit * place), (slip, 1.0, decel, 0.0)
    return (
        *_line(own[:6], *way, *frame),
        *_line(own[6:12], *way, *frame),
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
