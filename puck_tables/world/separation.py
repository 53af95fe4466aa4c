"""How long two that hardly move towards each other stay apart: a bound of third order.

With the relative place Δ along the normal n at t, a the accelerations then, and jerks of B at most,

    gap(t + s) ≥ gap + gap′ s + ½ n·a s² − B s³/6,

for the distance of two centres is never less than n·Δ.  Within an arc the way along the rim, W s at
most, takes (W s)²/|Δ| from the gap.  Under dry friction in full contact the acceleration is
J v/Q, and changes by 0.5 J² v/Q² at most, while the speed v falls and Q falls by 4/3 J at most; so
while Q is more than half of what it is, jerks are below 4 · 0.5 J² v/Q².
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.forces import per_change, per_speed
from puck_tables.scene.friction import SPIN, VX, VY, friction_force, size
from puck_tables.scene.ingredients import DryFriction
from puck_tables.world.engine_state import Engine
from puck_tables.world.layout import DECEL, DRAG, INV_MASS, RADIUS, REGION
from puck_tables.world.paths import BEGINS, DURATION, jerk_on, on_piece, piece_at
from puck_tables.world.segment import (
    DAMPED,
    DRIFT_X,
    DRIFT_Y,
    FIRST_PIECE,
    LAST_PIECE,
    LOOKED_UP,
    PATH,
    RIDING,
    UNTIL,
)

_JERK = 2.4  # J² v/Q² while Q is more than half of what it was: 4 times 0.5, and some more
_HALF = 0.375  # Q/J, in which Q falls by half at most
_UNSURE = 1e-9  # of accelerations that are looked up
_HALVINGS = 60  # of an interval by its logarithm: 17 take 30 decades to a thousandth


@inlined
def _knows(
    engine: Engine, i: int, state: FloatArray, t: float, room: FloatArray
) -> tuple[float, float, float, float]:
    """Acceleration of a disc now, the most by which it changes per second, and for how long."""
    kind, segment, disc = engine.kinds[i], engine.segments[i], engine.discs[i]
    vx, vy = state[VX] - segment[DRIFT_X], state[VY] - segment[DRIFT_Y]
    if kind == RIDING:
        turning = segment[2]
        speed = turning * math.hypot(vx, vy)
        return -turning * vy, turning * vx, abs(turning * speed), math.inf
    if kind == PATH:
        row = engine.pieces[
            piece_at(engine.pieces, int(segment[FIRST_PIECE]), int(segment[LAST_PIECE]), t)
        ]
        on_piece(row, t, room)
        return room[6], room[7], jerk_on(row), row[BEGINS] + row[DURATION] - t
    if kind == DAMPED:
        speed = math.hypot(vx, vy)
        drag = per_speed(disc[DRAG:], speed)
        jerk = drag * per_change(disc[DRAG:], speed) * speed
        return -drag * vx, -drag * vy, jerk, math.inf
    slip = size(vx, vy, disc[RADIUS] * state[SPIN])
    if kind != LOOKED_UP or slip == 0.0 or not t < segment[UNTIL]:
        return 0.0, 0.0, 0.0, math.inf
    regions, row = engine.regions, int(disc[REGION])
    friction = DryFriction(
        regions.load[row], regions.delta[row], regions.limits[row], regions.by_speed
    )
    fx, fy, _, _ = friction_force(friction, disc[RADIUS], vx, vy, state[SPIN])
    decel, light = disc[DECEL], disc[INV_MASS]
    jerk = _JERK * decel * decel * math.hypot(vx, vy) / slip / slip
    return light * fx, light * fy, jerk, _HALF * slip / decel


@inlined
def _first_root(gap: float, rate: float, accel: float, jerk: float, longest: float) -> float:
    """Until when gap + rate s + ½ bend s² − jerk s³/6 stays positive, at most."""
    if rate < 0.0 and accel > 0.0:
        accel = 0.0  # it might dip below zero, and rise again
    low, high = 0.0, longest
    if high == math.inf:
        high = 1e9
    if gap + high * (rate + high * (0.5 * accel - high * jerk / 6.0)) > 0.0:
        return high
    # with one change of sign there is one root; times of all sizes are halved by their logarithms
    low = 1e-30 * high
    if not gap + low * (rate + low * (0.5 * accel - low * jerk / 6.0)) > 0.0:
        return 0.0
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high)
        if high <= 1.001 * low:
            break
        if gap + middle * (rate + middle * (0.5 * accel - middle * jerk / 6.0)) > 0.0:
            low = middle
        else:
            high = middle
    return low


@inner
def stays_apart(
    engine: Engine, i: int, j: int, t: float, gap: float, nx: float, ny: float, far: float,
    arc: bool, room: FloatArray, one: FloatArray, two: FloatArray,
) -> float:  # fmt: skip
    """How long a gap > 0 surely stays one.

    (nx, ny): from disc i to disc j, whose states are in one and two, or to an obstacle (j < 0);
    ``far``: within an ``arc`` the distance from its centre.
    """
    ax, ay, jerk, longest = _knows(engine, i, one, t, room)
    wx, wy = one[VX], one[VY]
    unsure = _UNSURE * math.hypot(ax, ay)
    if j >= 0:
        bx, by, more, shorter = _knows(engine, j, two, t, room)
        unsure += _UNSURE * math.hypot(bx, by)
        ax, ay, jerk, longest = ax - bx, ay - by, jerk + more, min(longest, shorter)
        wx, wy = wx - two[VX], wy - two[VY]
    rate, accel = -(wx * nx + wy * ny), -(ax * nx + ay * ny) - unsure
    if not longest > 0.0:
        return 0.0
    if arc:
        speed, pull = math.hypot(wx, wy), math.hypot(ax, ay)
        if far == 0.0 or speed == 0.0:
            return 0.0
        longest = min(longest, 0.25 * far / speed)
        fastest = speed + longest * (pull + longest * jerk)
        longest = min(longest, 0.5 * far / fastest)
        accel -= 2.0 * fastest * fastest / far
    return _first_root(gap, rate, accel, jerk, longest)
