"""States and their derivatives from natural units, in the frame of the launch, to SI units."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, weighted_rows
from puck_tables.stopping.stop_jacobian import Numbers, direction

# what is differentiated
STATE_X, STATE_Y, STATE_TURNED, STATE_VX, STATE_VY, STATE_SPIN = range(6)
STATES, STATE_COLUMNS = 6, 7
OWN_STATES = STATES * 6  # of each: itself; by v, v across, rω, δ, time
PLACED_STATES = STATES * STATE_COLUMNS


@inlined
def rotated(one: float, other: float, cosine: float, sine: float) -> tuple[float, float]:
    """A vector turned by an angle of this cosine and sine."""
    return one * cosine - other * sine, one * sine + other * cosine


@inlined
def _pair(
    ahead: Numbers, aside: Numbers, unit: float, by_speed: float, by_time: float, gone: float,
    elapsed: float, around: float, east: float, north: float, spin: float, radius: float,
) -> Numbers:  # fmt: skip
    """Two rows of seven, along x and y, from those along and to the left of the launch."""
    one_x, one_y = rotated(ahead[1], around * aside[1], east, north)
    two_x, two_y = rotated(around * ahead[2], aside[2], east, north)
    rim_x, rim_y = rotated(around * ahead[3], aside[3], east, north)
    tilt_x, tilt_y = rotated(ahead[4], around * aside[4], east, north)
    rate_x, rate_y = rotated(ahead[5], around * aside[5], east, north)
    here_x, here_y = rotated(ahead[0], around * aside[0], east, north)
    rim_x, rim_y = by_speed * rim_x, by_speed * rim_y
    rate_x, rate_y = by_time * rate_x, by_time * rate_y
    return (
        by_speed * (east * one_x - north * two_x), by_speed * (north * one_x + east * two_x),
        radius * rim_x, unit * tilt_x, elapsed * rate_x - gone * here_x, spin * rim_x, rate_x,
        by_speed * (east * one_y - north * two_y), by_speed * (north * one_y + east * two_y),
        radius * rim_y, unit * tilt_y, elapsed * rate_y - gone * here_y, spin * rim_y, rate_y,
    )  # fmt: skip


@inlined
def _turn(
    own: Numbers, unit: float, by_speed: float, by_time: float, gone: float, elapsed: float,
    around: float, east: float, north: float, spin: float, radius: float, bend: float,
) -> Numbers:  # fmt: skip
    """A row of seven, of what changes its sign with the spin."""
    value, ahead = around * unit * own[0], around * by_speed * own[1]
    rim, rate = by_speed * own[3], around * by_time * own[5]
    return (
        east * ahead, north * ahead, radius * rim, around * unit * own[4],
        elapsed * rate - gone * value, spin * rim - value * bend, rate,
    )  # fmt: skip


@inlined
def placed_state(
    east: float, north: float, spin: float, decel: float, unit: float, radius: float, slip: float,
    time: float, own: Numbers,
) -> Numbers:  # fmt: skip
    """From natural units in the frame of the launch, six rows of six, to six rows of seven.

    (``east``, ``north``): its direction; ``unit``: 1/J.
    """
    around, bend = 1.0 if spin >= 0.0 else -1.0, 1.0 / radius
    duration, elapsed = slip * unit, time * unit
    place = slip * duration
    frame = elapsed, around, east, north, spin, radius
    return (
        *_pair(own[:6], own[6:12], place, duration, slip, unit * place, *frame),
        *_turn(own[12:18], bend * place, bend * duration, bend * slip, unit, *frame, bend),
        *_pair(own[18:24], own[24:30], slip, 1.0, decel, 0.0, *frame),
        *_turn(own[30:], bend * slip, bend, bend * decel, 0.0, *frame, bend),
    )  # fmt: skip


@kernel
def fill_placed_states(
    puck: FloatArray, times: FloatArray, own: FloatArray, out: FloatArray
) -> None:
    """Derivatives of states (n, 6, 7) of a puck from natural ones ``own`` (n, 6, 6)."""
    vx, vy, spin, decel, radius = puck[0], puck[1], puck[2], puck[4], puck[5]
    speed = math.hypot(vx, vy)
    slip, unit = math.hypot(speed, radius * spin), 1.0 / decel
    east, north = direction(vx, vy, speed)
    flat, numbers = own.reshape(-1), out.reshape(-1)
    for n in range(times.size):
        row = weighted_rows(flat, OWN_STATES * n, (1.0,), OWN_STATES)
        placed = placed_state(east, north, spin, decel, unit, radius, slip, times[n], row)
        for k in range(PLACED_STATES):
            numbers[PLACED_STATES * n + k] = placed[k]
