"""What acts on the discs of a group besides their contacts: dry friction, drag, a pull, a film."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import SPIN, VX, VY, at_slip_zero, dry_friction, size
from puck_tables.scene.ingredients import dry_in
from puck_tables.scene.rest import free_yield
from puck_tables.world.group import (
    ARM,
    DRIVEN,
    HELD,
    NX,
    NY,
    SLIP,
    YIELDS,
    Desk,
    Group,
    IntArray,
)
from puck_tables.world.layout import (
    DAMPING,
    LIGHTNESS,
    RADIUS,
    SPIN_DAMPING,
    TURNABILITY,
    WAKE,
)
from puck_tables.world.paths import on_piece, piece_at
from puck_tables.world.works import DRAG_HEAT, DRIVE_WORK, FLOOR_HEAT, PULL_WORK, RIM_HEAT


@inlined
def slip_of(group: Group, number: int, y: FloatArray) -> float:
    """Q of a disc in the state y (6,)."""
    return size(y[VX], y[VY], group.discs[number, RADIUS] * y[SPIN])


@inlined
def place_driven(
    group: Group, members: IntArray, doings: IntArray, t: float, y: FloatArray, desk: Desk
) -> None:
    """Put the driven members where their films have them at t, and their accelerations."""
    for place in range(members.shape[0]):
        if doings[place] == DRIVEN:
            first, last = group.reels[members[place], 0], group.reels[members[place], 1]
            on_piece(group.films[piece_at(group.films, first, last, t)], t, desk.film)
            for i in range(6):
                y[place, i] = desk.film[i]
            for i in range(3):
                desk.own[place, i] = desk.film[6 + i]


@inner
def act(
    group: Group, members: IntArray, doings: IntArray, y: FloatArray, power: FloatArray, desk: Desk
) -> None:
    """Accelerations of the members as if there were no contacts, and the power of what acts."""
    for i in range(power.shape[0]):
        power[i] = 0.0
    for place in range(members.shape[0]):
        number = members[place]
        disc, own, inverse = group.discs[number], desk.own[place], desk.inverse[place]
        doing, radius = doings[place], disc[RADIUS]
        inverse[0] = inverse[1] = 0.0
        if doing == DRIVEN:
            continue
        if doing == HELD:
            own[0] = own[1] = own[2] = 0.0
            continue
        inverse[0], inverse[1] = disc[LIGHTNESS], disc[TURNABILITY]
        vx, vy, spin = y[place, VX], y[place, VY], y[place, SPIN]
        dry = dry_in(group.regions, number)
        if doing == YIELDS:
            way = desk.ways[place]
            fx, fy, torque, _ = dry_friction(at_slip_zero(dry), radius, way[0], way[1], way[2])
            heat = -(fx * vx + fy * vy + torque * spin)
        else:
            fx, fy, torque, heat = dry_friction(dry, radius, vx, vy, spin)
        square = vx * vx + vy * vy
        drag, turn_drag = disc[DAMPING] + disc[WAKE] * math.sqrt(square), disc[SPIN_DAMPING]
        own[0] = group.gx + fx * inverse[0] - drag * vx
        own[1] = group.gy + fy * inverse[0] - drag * vy
        own[2] = torque * inverse[1] - turn_drag * spin
        power[FLOOR_HEAT] += heat
        power[DRAG_HEAT] += drag * square / inverse[0] + turn_drag * spin * spin / inverse[1]
        power[PULL_WORK] += (group.gx * vx + group.gy * vy) / inverse[0]


@inlined
def force_of_contacts(desk: Desk, count: int, place: int) -> tuple[float, float, float]:
    """Force and torque of all contacts on a member."""
    fx, fy, torque = 0.0, 0.0, 0.0
    for c in range(count):
        push, rim = desk.pushes[c, 0], desk.pushes[c, 1]
        nx, ny = desk.sights[c, NX], desk.sights[c, NY]
        for side in range(2):
            if desk.pairs[c, side] == place:
                sign = 2.0 * side - 1.0
                fx += sign * (push * nx - rim * ny)
                fy += sign * (push * ny + rim * nx)
                torque -= desk.sights[c, ARM + side] * rim
    return fx, fy, torque


@inlined
def power_of_contacts(
    doings: IntArray, count: int, y: FloatArray, power: FloatArray, desk: Desk
) -> None:
    """Heat of the rims, and work of what drives, into ``power``."""
    for c in range(count):
        power[RIM_HEAT] += desk.pushes[c, 1] * desk.sights[c, SLIP]
    for place in range(doings.shape[0]):
        if doings[place] == DRIVEN:
            fx, fy, torque = force_of_contacts(desk, count, place)
            power[DRIVE_WORK] -= fx * y[place, VX] + fy * y[place, VY] + torque * y[place, SPIN]


@inlined
def excess_on(
    group: Group, number: int, place: int, count: int, desk: Desk
) -> tuple[float, float, float, float]:
    """By how much what acts on a disc at rest exceeds its friction, over f N, and the slip then."""
    dry = at_slip_zero(dry_in(group.regions, number))
    fx, fy, torque = force_of_contacts(desk, count, place)
    mass = 1.0 / group.discs[number, LIGHTNESS]
    excess, ux, uy, w = free_yield(
        dry, group.discs[number, RADIUS], fx + mass * group.gx, fy + mass * group.gy, torque, False
    )
    return excess / dry.load, ux, uy, w


@inlined
def gain_of(group: Group, number: int, place: int, desk: Desk) -> float:
    """How fast a disc that yields gains speed along its way."""
    way, rate, radius = desk.ways[place], desk.rates[place], group.discs[number, RADIUS]
    return way[0] * rate[0] + way[1] * rate[1] + radius * radius * way[2] * rate[2]


@inlined
def can_rest(group: Group, number: int) -> bool:
    """Whether the floor can hold a disc."""
    return group.regions.load[number] > 0.0
