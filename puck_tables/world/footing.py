"""What a disc stands on: a floor at rest, a belt, a turntable, one of several strips."""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import Surface, floor_velocity
from puck_tables.world.game import Game
from puck_tables.world.layout import DECEL, DELTA, INTEGRATED, REGION


@inlined
def over_floor(surface: Surface, state: FloatArray) -> tuple[float, float, float]:
    """Velocity and spin of a state (6,) relative to the floor under it."""
    sx, sy, turning = floor_velocity(surface, state[X], state[Y])
    return state[VX] - sx, state[VY] - sy, state[SPIN] - turning


@inlined
def slips(surface: Surface, state: FloatArray) -> bool:
    """Whether it moves over the floor."""
    vx, vy, spin = over_floor(surface, state)
    return vx != 0.0 or vy != 0.0 or spin != 0.0


@inlined
def moves_along(surface: Surface) -> bool:
    """Whether the floor moves."""
    return surface.vx != 0.0 or surface.vy != 0.0 or surface.spin != 0.0


@inlined
def strip_under(game: Game, i: int) -> int:
    """The strip of the floor that a disc is on."""
    return int(game.discs[i, REGION]) // game.discs.shape[0]


@inlined
def step_onto(game: Game, i: int, strip: int) -> None:
    """A disc comes onto a strip of the floor, and has the friction there."""
    disc, region = game.discs[i], strip * game.discs.shape[0] + i
    disc[REGION] = region
    disc[DECEL], disc[DELTA] = game.floors[region, 0], game.floors[region, 1]
    disc[INTEGRATED] = game.floors[region, 2]
