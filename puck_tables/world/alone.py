"""What a disc would do if nothing touched it."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.forces import dragged
from puck_tables.scene.friction import VX, VY, X, Y, at_slip_zero, friction_force, size
from puck_tables.scene.ingredients import floor_acceleration
from puck_tables.scene.over_time import FORCED, prescribed_by, rows_passed
from puck_tables.world.engine_state import Engine, Whole
from puck_tables.world.floor_under import floor_of, friction_now, over_floor
from puck_tables.world.holds import led
from puck_tables.world.layout import (
    DECEL,
    DRAG,
    LIGHTNESS,
    PULL_X,
    PULL_Y,
    RADIUS,
    TURNABILITY,
    TWIST,
)


@inlined
def pull_on(
    discs: FloatArray, forcing: FloatArray, spans: Whole, i: int, passed: int, t: float
) -> tuple[float, float, float]:
    """The accelerations by a slope and given forces, of whose rows so many have passed."""
    ax, ay, turn = discs[i, PULL_X], discs[i, PULL_Y], discs[i, TWIST]
    first, last = spans[i, 0], spans[i, 1]
    if first < last:
        fx, fy, torque = prescribed_by(forcing[first:last], passed, t)
        ax += discs[i, LIGHTNESS] * fx
        ay += discs[i, LIGHTNESS] * fy
        turn += discs[i, TURNABILITY] * torque
    return ax, ay, turn


@inlined
def acceleration(engine: Engine, i: int, t: float, state: FloatArray) -> tuple[float, float]:
    """The acceleration of the centre."""
    disc = engine.discs[i]
    if disc[LIGHTNESS] == 0.0:
        return 0.0, 0.0  # straight on
    passed = rows_passed(engine.forcing, engine.spans[i, 0], engine.spans[i, 1], t)
    ax, ay, turn = pull_on(engine.discs, engine.forcing, engine.spans, i, passed, t)
    ux, uy, w = over_floor(engine.surface, disc, state)
    if size(ux, uy, w) == 0.0:
        floor = floor_of(engine.surface, disc)
        cx, cy = floor_acceleration(floor, state[X], state[Y], state[VX], state[VY])
        push, holds = math.hypot(ax - cx, ay - cy), disc[DECEL]
        if push > 0.0 and engine.forcing.shape[1] > FORCED:
            friction = friction_now(
                engine.regions, engine.discs, engine.forcing, engine.spans, i, passed, t, state
            )  # fmt: skip
            fx, fy, _, _ = friction_force(
                at_slip_zero(friction, 1.0), disc[RADIUS], (ax - cx) / push, (ay - cy) / push, 0.0
            )  # fmt: skip
            holds = disc[LIGHTNESS] * math.hypot(fx, fy)
        left = 1.0 - holds / push if push > engine.surface.static * holds else 0.0
        ax, ay = cx + left * (ax - cx), cy + left * (ay - cy)
    else:
        friction = friction_now(
            engine.regions, engine.discs, engine.forcing, engine.spans, i, passed, t, state
        )
        fx, fy, torque, _ = friction_force(friction, disc[RADIUS], ux, uy, w)
        dx, dy, slows, _, _ = dragged(disc[DRAG:], ux, uy, w)
        ax += disc[LIGHTNESS] * fx + dx
        ay += disc[LIGHTNESS] * fy + dy
        turn += disc[TURNABILITY] * torque + slows
    ax, ay, _ = led(disc, engine.surface, state, ax, ay, turn)
    return ax, ay
