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
from puck_tables.scene.friction import SPIN, VX, VY, dry_friction, size
from puck_tables.scene.ingredients import Dry
from puck_tables.world.flight import (
    CARRIED,
    DAMPED,
    DRIFT_X,
    DRIFT_Y,
    FIRST_PIECE,
    LAST_PIECE,
    LOOKED_UP,
    PATH,
    UNTIL,
)
from puck_tables.world.game import Game
from puck_tables.world.layout import DECEL, DRAG, LIGHTNESS, RADIUS, REGION
from puck_tables.world.paths import DURATION, START, jerk_on, on_piece, piece_at

_JERK = 2.4  # J² v/Q² while Q is more than half of what it was: 4 times 0.5, and some more
_HALF = 0.375  # Q/J, in which Q falls by half at most
_UNSURE = 1e-9  # of accelerations that are looked up
_HALVINGS = 60  # of an interval by its logarithm: 17 take 30 decades to a thousandth


@inlined
def _knows(
    game: Game, i: int, state: FloatArray, t: float, room: FloatArray
) -> tuple[float, float, float, float]:
    """Acceleration of a disc now, the most by which it changes per second, and for how long."""
    kind, flight, disc = game.kinds[i], game.flights[i], game.discs[i]
    vx, vy = state[VX] - flight[DRIFT_X], state[VY] - flight[DRIFT_Y]
    if kind == CARRIED:
        turning = flight[2]
        speed = turning * math.hypot(vx, vy)
        return -turning * vy, turning * vx, abs(turning * speed), math.inf
    if kind == PATH:
        row = game.pieces[
            piece_at(game.pieces, int(flight[FIRST_PIECE]), int(flight[LAST_PIECE]), t)
        ]
        on_piece(row, t, room)
        return room[6], room[7], jerk_on(row), row[START] + row[DURATION] - t
    if kind == DAMPED:
        speed = math.hypot(vx, vy)
        drag = per_speed(disc[DRAG:], speed)
        jerk = drag * per_change(disc[DRAG:], speed) * speed
        return -drag * vx, -drag * vy, jerk, math.inf
    slip = size(vx, vy, disc[RADIUS] * state[SPIN])
    if kind != LOOKED_UP or slip == 0.0 or not t < flight[UNTIL]:
        return 0.0, 0.0, 0.0, math.inf
    regions, row = game.regions, int(disc[REGION])
    dry = Dry(regions.load[row], regions.delta[row], regions.cuts[row], regions.by_speed)
    fx, fy, _, _ = dry_friction(dry, disc[RADIUS], vx, vy, state[SPIN])
    decel, light = disc[DECEL], disc[LIGHTNESS]
    jerk = _JERK * decel * decel * math.hypot(vx, vy) / slip / slip
    return light * fx, light * fy, jerk, _HALF * slip / decel


@inlined
def _first_root(gap: float, rate: float, bend: float, jerk: float, longest: float) -> float:
    """Until when gap + rate s + ½ bend s² − jerk s³/6 stays positive, at most."""
    if rate < 0.0 and bend > 0.0:
        bend = 0.0  # it might dip below zero, and rise again
    low, high = 0.0, longest
    if high == math.inf:
        high = 1e9
    if gap + high * (rate + high * (0.5 * bend - high * jerk / 6.0)) > 0.0:
        return high
    # with one change of sign there is one root; times of all sizes are halved by their logarithms
    low = 1e-30 * high
    if not gap + low * (rate + low * (0.5 * bend - low * jerk / 6.0)) > 0.0:
        return 0.0
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high)
        if high <= 1.001 * low:
            break
        if gap + middle * (rate + middle * (0.5 * bend - middle * jerk / 6.0)) > 0.0:
            low = middle
        else:
            high = middle
    return low


@inner
def stays_apart(
    game: Game, i: int, j: int, t: float, gap: float, nx: float, ny: float, far: float, arc: bool,
    room: FloatArray, one: FloatArray, two: FloatArray,
) -> float:  # fmt: skip
    """How long a gap > 0 surely stays one.

    (nx, ny): from disc i to disc j, whose states are in one and two, or to an obstacle (j < 0);
    ``far``: within an ``arc`` the distance from its centre.
    """
    ax, ay, jerk, longest = _knows(game, i, one, t, room)
    wx, wy = one[VX], one[VY]
    unsure = _UNSURE * math.hypot(ax, ay)
    if j >= 0:
        bx, by, more, shorter = _knows(game, j, two, t, room)
        unsure += _UNSURE * math.hypot(bx, by)
        ax, ay, jerk, longest = ax - bx, ay - by, jerk + more, min(longest, shorter)
        wx, wy = wx - two[VX], wy - two[VY]
    rate, bend = -(wx * nx + wy * ny), -(ax * nx + ay * ny) - unsure
    if not longest > 0.0:
        return 0.0
    if arc:
        speed, pull = math.hypot(wx, wy), math.hypot(ax, ay)
        if far == 0.0 or speed == 0.0:
            return 0.0
        longest = min(longest, 0.25 * far / speed)
        fastest = speed + longest * (pull + longest * jerk)
        longest = min(longest, 0.5 * far / fastest)
        bend -= 2.0 * fastest * fastest / far
    return _first_root(gap, rate, bend, jerk, longest)
