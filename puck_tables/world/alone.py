"""What a disc would do if nothing touched it."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.forces import dragged
from puck_tables.scene.friction import VX, VY, X, Y, at_slip_zero, dry_friction, size
from puck_tables.scene.ingredients import carried_along
from puck_tables.scene.over_time import FORCED, given_by, rows_passed
from puck_tables.world.footing import dry_now, floor_of, over_floor
from puck_tables.world.game import Game, Whole
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
    discs: FloatArray, tides: FloatArray, spans: Whole, i: int, passed: int, t: float
) -> tuple[float, float, float]:
    """The accelerations by a slope and given forces, of whose rows so many have passed."""
    ax, ay, turn = discs[i, PULL_X], discs[i, PULL_Y], discs[i, TWIST]
    first, last = spans[i, 0], spans[i, 1]
    if first < last:
        fx, fy, torque = given_by(tides[first:last], passed, t)
        ax += discs[i, LIGHTNESS] * fx
        ay += discs[i, LIGHTNESS] * fy
        turn += discs[i, TURNABILITY] * torque
    return ax, ay, turn


@inlined
def acceleration(game: Game, i: int, t: float, state: FloatArray) -> tuple[float, float]:
    """The acceleration of the centre."""
    disc = game.discs[i]
    if disc[LIGHTNESS] == 0.0:
        return 0.0, 0.0  # straight on
    passed = rows_passed(game.tides, game.spans[i, 0], game.spans[i, 1], t)
    ax, ay, turn = pull_on(game.discs, game.tides, game.spans, i, passed, t)
    ux, uy, w = over_floor(game.surface, disc, state)
    if size(ux, uy, w) == 0.0:
        floor = floor_of(game.surface, disc)
        cx, cy = carried_along(floor, state[X], state[Y], state[VX], state[VY])
        push, holds = math.hypot(ax - cx, ay - cy), disc[DECEL]
        if push > 0.0 and game.tides.shape[1] > FORCED:
            dry = dry_now(
                game.regions, game.discs, game.tides, game.spans, i, passed, t, state
            )  # fmt: skip
            fx, fy, _, _ = dry_friction(
                at_slip_zero(dry), disc[RADIUS], (ax - cx) / push, (ay - cy) / push, 0.0
            )  # fmt: skip
            holds = disc[LIGHTNESS] * math.hypot(fx, fy)
        left = 1.0 - holds / push if push > holds else 0.0
        ax, ay = cx + left * (ax - cx), cy + left * (ay - cy)
    else:
        dry = dry_now(game.regions, game.discs, game.tides, game.spans, i, passed, t, state)
        fx, fy, torque, _ = dry_friction(dry, disc[RADIUS], ux, uy, w)
        dx, dy, slows, _, _ = dragged(disc[DRAG:], ux, uy, w)
        ax += disc[LIGHTNESS] * fx + dx
        ay += disc[LIGHTNESS] * fy + dy
        turn += disc[TURNABILITY] * torque + slows
    ax, ay, _ = led(disc, game.surface, state, ax, ay, turn)
    return ax, ay
