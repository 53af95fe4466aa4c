"""What acts on a disc that nothing touches, and for how long that may be followed at once."""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined
from puck_tables.scene.base_balance import is_rubbed
from puck_tables.scene.forces import Forces
from puck_tables.scene.ingredients import (
    Body,
    DryFriction,
    Model,
    Surface,
    is_mixed,
    is_over_belts,
    surface_at,
)
from puck_tables.scene.over_time import rows_passed
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import changes_below, floor_of, moves_along
from puck_tables.world.holds import constraint_on
from puck_tables.world.layout import DRAG, INV_INERTIA, INV_MASS, PULL_X, PULL_Y, RADIUS, TWIST

_FARTHER = 0.1  # of the time since the start: so far ahead a path may go


@inlined
def model_of(engine: Engine, i: int) -> Model:
    """All that acts on a disc but dry friction."""
    disc = engine.discs[i]
    mass, inertia = 1.0 / disc[INV_MASS], 1.0 / disc[INV_INERTIA]
    drive = engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
    forces = Forces(
        mass * disc[PULL_X], mass * disc[PULL_Y], inertia * disc[TWIST], drive,
        disc[DRAG:],
    )  # fmt: skip
    body, floor = Body(mass, inertia, disc[RADIUS]), floor_of(engine.surface, disc)
    return Model(body, floor, forces, constraint_on(disc))


@inlined
def surface_of(model: Model, t: float) -> Surface:
    """How the floor moves at a time."""
    drive = model.forces.drive
    return surface_at(model.surface, drive, rows_passed(drive, 0, len(drive), t), t)


@inlined
def swings(engine: Engine, i: int, model: Model, friction: DryFriction, rows: int) -> bool:
    """Whether what the floor has to do for a puck at rest on it changes as it is carried."""
    surface, drive = model.surface, model.forces.drive
    if surface.changes != 0.0 and rows < len(drive):
        return True
    surface = surface_at(surface, drive, rows, 0.0)  # as it goes on
    forces = model.forces
    pulled = forces.x != 0.0 or forces.y != 0.0 or forces.torque != 0.0 or len(drive) > 0
    if (surface.spin != 0.0 and pulled) or not is_mixed(friction):
        return surface.spin != 0.0 and pulled
    floor_map, radius = friction.by_speed.table, model.body.radius
    if is_over_belts(friction) and is_rubbed(floor_map, radius):
        return True  # it gets warm
    return moves_along(surface) and changes_below(floor_map, engine.discs[i], surface)


@inlined
def horizon_of(engine: Engine, model: Model, t: float) -> float:
    """Until when a path is followed: what is pulled or carried may get faster for ever.

    Ever farther, so that what goes on for long takes few paths.
    """
    hold, rows = model.hold, len(model.forces.drive)
    pulled = rows > 0 and model.forces.drive[rows - 1, 0] > t
    pulled = pulled or model.forces.x != 0.0 or model.forces.y != 0.0 or model.forces.torque != 0.0
    if pulled or moves_along(engine.surface) or hold.vx != 0.0 or hold.vy != 0.0:
        return t + max(2.0 * engine.scale[0] / engine.scale[1], _FARTHER * t)
    return math.inf
