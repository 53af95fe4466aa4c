"""What a disc stands on: a floor at rest, a belt, a turntable, strips and patches of friction.

Where friction differs, the rows of ``regions`` are all discs on the first strip, on the second, …,
on every patch, and then all discs astride: on several frictions at once, each of which is felt
under its own part of the base (:mod:`puck_tables.scene.base_on_floor`), or over an edge, carried by
what is left of it (:mod:`puck_tables.scene.base_balance`).  ``regions.ground`` has
one such ground for every disc, all of one length, for each has its own load.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.base_balance import nearest_belt
from puck_tables.scene.by_speed import WITHIN
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    BELTS,
    BORDERS,
    EDGES,
    INSIDE,
    OUTSIDE,
    OVER_X,
    OVER_Y,
    OVERLAPS,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    border_of,
    distance_to,
    edge_of,
)
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    SUMMED,
    BySpeed,
    DryFriction,
    Regions,
    Surface,
    floor_velocity,
    friction_at,
    put_at,
    surface_at,
)
from puck_tables.scene.orthotropic import is_elliptic
from puck_tables.scene.over_time import rows_passed
from puck_tables.world.engine_state import Engine
from puck_tables.world.layout import (
    BELT_AX,
    BELT_AY,
    BELT_SPIN,
    BELT_TURN,
    BELT_X,
    BELT_Y,
    DECEL,
    DELTA,
    EDGE_NUMBER,
    HEIGHT_RATIO,
    INTEGRATED,
    INV_MASS,
    KIND,
    LIES,
    NORMAL,
    OVERHANG,
    RADIUS,
    REGION,
    A,
    B,
    C,
)

_NEARER = 0.9  # of the slip over one belt is that over another: states are relative to that
SURE = 1.0 - 1e-9  # of the last slip that a friction law knows: whoever is faster comes beyond


@inlined
def floor_of(surface: Surface, disc: FloatArray) -> Surface:
    """How the floor moves that a disc is on."""
    return Surface(
        disc[BELT_X], disc[BELT_Y], surface.cx, surface.cy, disc[BELT_SPIN], disc[BELT_AX],
        disc[BELT_AY], disc[BELT_TURN], surface.changes, surface.static,
    )  # fmt: skip


@inlined
def move_floor(engine: Engine, i: int, t: float) -> None:
    """Let the floor under a disc move as it does at a time."""
    first, last = engine.spans[i, 0], engine.spans[i, 1]
    if engine.surface.changes != 0.0 and first < last:
        passed, disc = rows_passed(engine.forcing, first, last, t), engine.discs[i]
        now = surface_at(engine.surface, engine.forcing[first:last], passed, t)
        disc[BELT_X], disc[BELT_Y], disc[BELT_SPIN] = now.vx, now.vy, now.spin
        disc[BELT_AX], disc[BELT_AY], disc[BELT_TURN] = now.ax, now.ay, now.turn


@inlined
def over_floor(engine: Engine, i: int, state: FloatArray) -> tuple[float, float, float]:
    """Velocity and spin of a disc in a state (6,) relative to the floor that it is on."""
    floor = floor_of(engine.surface, engine.discs[i])
    sx, sy, turning = floor_velocity(floor, state[X], state[Y])
    return state[VX] - sx, state[VY] - sy, state[SPIN] - turning


@inlined
def slips(engine: Engine, i: int, state: FloatArray) -> bool:
    """Whether it moves over the floor."""
    vx, vy, spin = over_floor(engine, i, state)
    return vx != 0.0 or vy != 0.0 or spin != 0.0


@inlined
def moves_along(surface: Surface) -> bool:
    """Whether the floor moves, or any of it: of all belts it knows the fastest."""
    return surface.vx != 0.0 or surface.vy != 0.0 or surface.spin != 0.0


@inlined
def floor_map_span(engine: Engine, i: int) -> tuple[int, int]:
    """Where in ``regions.floor_map`` that of a disc begins and ends; empty: friction is one."""
    size = engine.regions.floor_map.size // engine.discs.shape[0]
    return i * size, (i + 1) * size


@inlined
def law_under(engine: Engine, i: int) -> BySpeed:
    """Friction by speed or direction on a disc, as its own load has it; none: nothing."""
    law, disc = engine.regions.by_speed, engine.discs[i]
    if law.normal == 0.0:
        return law
    own = law.table[engine.regions.laws[i, 0] : engine.regions.laws[i, 1]]
    return BySpeed(own, disc[HEIGHT_RATIO], disc[NORMAL], 1.0)


@inlined
def friction_under_disc(engine: Engine, i: int) -> DryFriction:
    """The dry friction on a disc where it is."""
    regions, region, law = engine.regions, int(engine.discs[i, REGION]), law_under(engine, i)
    if regions.summed[region]:
        first, last = floor_map_span(engine, i)
        law = BySpeed(regions.floor_map[first:last], 0.0, SUMMED, 1.0)
    return DryFriction(regions.load[region], regions.delta[region], regions.limits[region], law)


@inlined
def friction_now(
    engine: Engine, i: int, passed: int, t: float, state: FloatArray
) -> DryFriction:  # fmt: skip
    """The dry friction on a disc in a state (6,) at t, when so many of its rows have passed."""
    rows = engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
    friction = friction_at(friction_under_disc(engine, i), rows, passed, t)
    put_at(friction, state[X], state[Y], state[THETA])
    return friction


@inlined
def law_goes_to(regions: Regions) -> float:
    """Up to which slip of a rim friction is known, m/s."""
    law = regions.by_speed
    if law.normal == 0.0 or is_elliptic(law.table):
        return math.inf
    return WITHIN * law.table[int(law.table[0])]


@inlined
def outruns_law(engine: Engine, i: int, ux: float, uy: float, w: float) -> bool:
    """Whether the rim of a disc slips as fast as friction is known, or faster."""
    rim = engine.discs[i, RADIUS] * abs(w)
    return math.hypot(ux, uy) + rim >= SURE * law_goes_to(engine.regions)


@inlined
def off_border(floor_map: FloatArray, number: int, x: float, y: float) -> float:
    """How far a point is from a border, or after all of them a patch; beyond or in it < 0."""
    if number < int(floor_map[BORDERS]):
        return border_of(floor_map, number) - (floor_map[ACROSS_X] * x + floor_map[ACROSS_Y] * y)
    return distance_to(floor_map, number - int(floor_map[BORDERS]), x, y)


@inner
def changes_below(floor_map: FloatArray, disc: FloatArray, surface: Surface) -> bool:
    """Whether a base that the floor carries is over a border, or has an edge under it or ahead.

    Elsewhere nothing changes under it before it comes to a border.
    """
    for number in range(LIES, disc.size):
        if disc[number] == OVERLAPS:
            return True
    x, y = floor_map[PLACE_X], floor_map[PLACE_Y]
    vx, vy, spin = floor_velocity(surface, x, y)
    for k in range(int(floor_map[EDGES])):
        east, north, place = edge_of(floor_map, k)
        inside = east * x + north * y - place
        if spin != 0.0 or inside < disc[RADIUS] or east * vx + north * vy < 0.0:
            return True
    return False


@inlined
def lies_to(away: float, radius: float) -> int:
    """How a base lies to what its centre is so far from."""
    if abs(away) < radius:
        return OVERLAPS
    return OUTSIDE if away > 0.0 else INSIDE


@inlined
def is_over(engine: Engine, i: int) -> bool:
    """Whether a disc is taken for astride."""
    return engine.regions.summed[int(engine.discs[i, REGION])]


@inlined
def is_over_belts(engine: Engine, i: int) -> bool:
    """Whether a disc may have parts on stretches of the floor with different velocities."""
    first, last = floor_map_span(engine, i)
    floor_map = engine.regions.floor_map
    return is_over(engine, i) and last > first and floor_map[first + BELTS] != 0.0


@inlined
def choose_belt(engine: Engine, i: int, state: FloatArray) -> None:
    """Of the velocities under a disc let states be relative to the one nearest to its own."""
    if is_over_belts(engine, i):
        first, last = floor_map_span(engine, i)
        floor_map, disc = engine.regions.floor_map[first:last], engine.discs[i]
        bx, by, _ = nearest_belt(
            floor_map, state[X], state[Y], disc[RADIUS], state[VX], state[VY]
        )  # fmt: skip
        floor_map[OVER_X], floor_map[OVER_Y] = bx, by
        disc[BELT_X], disc[BELT_Y] = bx, by


@inlined
def nears_another(engine: Engine, i: int, x: float, y: float, vx: float, vy: float) -> bool:
    """Whether a disc that moves at (vx, vy) is nearer to another velocity of the floor."""
    if not is_over_belts(engine, i):
        return False
    first, last = floor_map_span(engine, i)
    floor_map, disc = engine.regions.floor_map[first:last], engine.discs[i]
    _, _, least = nearest_belt(floor_map, x, y, disc[RADIUS], vx, vy)
    ox, oy = vx - disc[BELT_X], vy - disc[BELT_Y]
    return least < _NEARER * math.sqrt(ox * ox + oy * oy)


@inlined
def least_slip(engine: Engine, i: int, state: FloatArray, t: float) -> float:
    """The slip of the rim of a disc over the nearest of the floors under it, anywhere, m/s."""
    rows = engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
    surface = surface_at(engine.surface, rows, rows_passed(rows, 0, len(rows), t), t)
    sx, sy, turning = floor_velocity(surface, state[X], state[Y])
    first, last = floor_map_span(engine, i)
    radius, floor_map = engine.discs[i, RADIUS], engine.regions.floor_map[first:last]
    speed, rim = math.hypot(state[VX] - sx, state[VY] - sy), radius * (state[SPIN] - turning)
    if floor_map.size > 0 and floor_map[BELTS] != 0.0:
        _, _, speed = nearest_belt(floor_map, state[X], state[Y], radius, state[VX], state[VY])
    return math.sqrt(speed * speed + rim * rim)


@inlined
def room_on_floor(engine: Engine, i: int, state: FloatArray) -> float:
    """How far a disc in a state (6,) is from lying otherwise than it is taken to; < 0: it does."""
    first, last = floor_map_span(engine, i)
    floor_map, disc = engine.regions.floor_map[first:last], engine.discs[i]
    radius, room = disc[RADIUS], math.inf
    for number in range(disc.size - LIES):
        away, how = off_border(floor_map, number, state[X], state[Y]), int(disc[LIES + number])
        if how == OVERLAPS:
            room = min(room, radius - abs(away))
        else:
            room = min(room, (away if how == OUTSIDE else -away) - radius)
    return room


@inlined
def step_onto(engine: Engine, i: int) -> None:
    """A disc has the friction that belongs to how it lies to borders, patches and edges."""
    first, last = floor_map_span(engine, i)
    disc, floor_map = engine.discs[i], engine.regions.floor_map[first:last]
    strip, patch, is_mixed = 0, -1, False
    if floor_map.size > 0:
        borders, patches = int(floor_map[BORDERS]), int(floor_map[PATCHES])
        for number in range(borders + patches):
            how = int(disc[LIES + number])
            is_mixed = is_mixed or how == OVERLAPS
            if how == INSIDE and number < borders:
                strip += 1
            elif how == INSIDE:
                patch = number - borders
        if patch >= 0:
            strip = borders + 1 + patch
        if floor_map[EDGES] > 0.0:
            for number in range(engine.hangs.shape[1]):
                is_mixed = is_mixed or engine.hangs[i, number] != 0
        if is_mixed:
            strip = borders + 1 + patches
    region = strip * engine.discs.shape[0] + i
    disc[REGION] = region
    disc[DECEL], disc[DELTA] = engine.floors[region, 0], engine.floors[region, 1]
    disc[INTEGRATED] = engine.floors[region, 2]
    if engine.surface.changes == 0.0 and not is_over_belts(engine, i):
        disc[BELT_X], disc[BELT_Y] = engine.floors[region, 3], engine.floors[region, 4]


@inlined
def is_beyond(disc: FloatArray, edge: FloatArray, x: float, y: float) -> bool:
    """Whether the rim of a disc at a place, which is not driven, is over an edge."""
    return disc[INV_MASS] > 0.0 and edge[A] * x + edge[B] * y - edge[C] < disc[RADIUS]


@inlined
def lie_at(engine: Engine, i: int, x: float, y: float) -> None:
    """See how a disc at a place lies to borders, patches and edges: it has the friction there."""
    first, last = floor_map_span(engine, i)
    disc, floor_map = engine.discs[i], engine.regions.floor_map[first:last]
    if disc[INV_MASS] > 0.0:  # else it is driven, and may have no map
        for number in range(engine.discs.shape[1] - LIES):
            away = off_border(floor_map, number, x, y)
            disc[LIES + number] = lies_to(away, disc[RADIUS])
    for k in range(engine.obstacles.shape[0]):
        row = engine.obstacles[k]
        if int(row[KIND]) == OVERHANG:
            engine.hangs[i, int(row[EDGE_NUMBER])] = int(is_beyond(disc, row, x, y))
    step_onto(engine, i)


@inlined
def lay_down(engine: Engine, i: int, state: FloatArray) -> None:
    """A disc is put down."""
    lie_at(engine, i, state[X], state[Y])
    engine.discs[i, BELT_SPIN] = engine.surface.spin
    move_floor(engine, i, engine.clock[0])
    choose_belt(engine, i, state)
