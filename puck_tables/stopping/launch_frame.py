"""States and their derivatives from natural units, in the frame of the launch, to SI units."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.stopping.stop_jacobian import (
    BY_DECEL,
    BY_DELTA,
    BY_RADIUS,
    BY_SPIN,
    BY_TIME,
    BY_VX,
    BY_VY,
)

# what is differentiated
STATE_X, STATE_Y, STATE_TURNED, STATE_VX, STATE_VY, STATE_SPIN = range(6)


@inlined
def rotated(one: float, other: float, cosine: float, sine: float) -> tuple[float, float]:
    """A vector turned by an angle of this cosine and sine."""
    return one * cosine - other * sine, one * sine + other * cosine


@inlined
def place_state(puck: FloatArray, time: float, own: FloatArray, out: FloatArray) -> None:
    """From natural units in the frame of the launch, ``own`` (6, 6), to ``out`` (6, 7)."""
    vx, vy, spin = puck[0], puck[1], puck[2]
    decel, radius = puck[4], puck[5]
    speed = math.hypot(vx, vy)
    slip = math.hypot(speed, radius * spin)
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    around = 1.0 if spin >= 0.0 else -1.0
    duration = slip / decel
    for row in (STATE_X, STATE_VX):  # pairs: along and to the left of the launch
        place = row == STATE_X
        unit = slip * duration if place else slip
        unit_by_speed = duration if place else 1.0
        unit_by_time = slip if place else decel
        ahead, aside = own[row, 1], around * own[row + 1, 1]
        one_x, one_y = rotated(ahead, aside, east, north)
        two_x, two_y = rotated(around * own[row, 2], own[row + 1, 2], east, north)
        out[row, BY_VX] = unit_by_speed * (east * one_x - north * two_x)
        out[row + 1, BY_VX] = unit_by_speed * (east * one_y - north * two_y)
        out[row, BY_VY] = unit_by_speed * (north * one_x + east * two_x)
        out[row + 1, BY_VY] = unit_by_speed * (north * one_y + east * two_y)
        rim_x, rim_y = rotated(around * own[row, 3], own[row + 1, 3], east, north)
        out[row, BY_SPIN] = radius * unit_by_speed * rim_x
        out[row + 1, BY_SPIN] = radius * unit_by_speed * rim_y
        out[row, BY_RADIUS] = spin * unit_by_speed * rim_x
        out[row + 1, BY_RADIUS] = spin * unit_by_speed * rim_y
        tilt_x, tilt_y = rotated(own[row, 4], around * own[row + 1, 4], east, north)
        out[row, BY_DELTA], out[row + 1, BY_DELTA] = unit * tilt_x, unit * tilt_y
        rate_x, rate_y = rotated(own[row, 5], around * own[row + 1, 5], east, north)
        out[row, BY_TIME], out[row + 1, BY_TIME] = unit_by_time * rate_x, unit_by_time * rate_y
        here_x, here_y = rotated(own[row, 0], around * own[row + 1, 0], east, north)
        own_unit = unit if place else 0.0
        elapsed = time / decel
        out[row, BY_DECEL] = elapsed * out[row, BY_TIME] - own_unit / decel * here_x
        out[row + 1, BY_DECEL] = elapsed * out[row + 1, BY_TIME] - own_unit / decel * here_y
    for row in (STATE_TURNED, STATE_SPIN):
        angle = row == STATE_TURNED
        unit = slip * duration / radius if angle else slip / radius
        unit_by_speed = duration / radius if angle else 1.0 / radius
        unit_by_time = slip / radius if angle else decel / radius
        value = around * unit * own[row, 0]
        by_speed, by_rim = around * unit_by_speed * own[row, 1], unit_by_speed * own[row, 3]
        out[row, BY_VX], out[row, BY_VY] = east * by_speed, north * by_speed
        out[row, BY_SPIN] = radius * by_rim
        out[row, BY_RADIUS] = spin * by_rim - value / radius
        out[row, BY_DELTA] = around * unit * own[row, 4]
        out[row, BY_TIME] = around * unit_by_time * own[row, 5]
        gone = value / decel if angle else 0.0
        out[row, BY_DECEL] = time / decel * out[row, BY_TIME] - gone


@kernel
def fill_placed_states(
    puck: FloatArray, times: FloatArray, own: FloatArray, out: FloatArray
) -> None:
    """Derivatives of states (n, 6, 7) of a puck from natural ones ``own`` (n, 6, 6)."""
    for n in range(times.size):
        place_state(puck, times[n], own[n], out[n])
