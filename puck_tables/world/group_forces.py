"""What acts on the discs of a group besides their contacts: friction, drag, forces, a film.

And what a disc would do if nothing touched it.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.base_balance import heat_at_rest
from puck_tables.scene.forces import dragged
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y, at_slip_zero, friction_force, size
from puck_tables.scene.ingredients import (
    FREE,
    Body,
    floor_acceleration,
    floor_velocity,
)
from puck_tables.scene.over_time import FORCED, prescribed_by, rows_passed
from puck_tables.scene.rest import constrained_yield, free_yield
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import (
    floor_of,
    friction_now,
    is_over_belts,
    move_floor,
    over_floor,
)  # fmt: skip
from puck_tables.world.group import (
    ARM,
    DRIVEN,
    HELD,
    NX,
    NY,
    SLIP,
    YIELDS,
    GroupBuffer,
    IntArray,
)
from puck_tables.world.holds import constraint_on, led
from puck_tables.world.layout import (
    DECEL,
    DRAG,
    HOLD,
    INV_INERTIA,
    INV_MASS,
    PULL_X,
    PULL_Y,
    RADIUS,
    REGION,
    TWIST,
    write_over,
)
from puck_tables.world.paths import on_piece, piece_at
from puck_tables.world.step_ledger import (
    BACK_X,
    BACK_Y,
    DRAG_HEAT,
    DRIVE_WORK,
    FLOOR_HEAT,
    PULL_WORK,
    RIM_HEAT,
    SUPPORT_WORK,
)

_BEGUN = 1e-12  # m/s: a slip that has a direction, and no size


@inlined
def pull_on(engine: Engine, i: int, passed: int, t: float) -> tuple[float, float, float]:
    """The accelerations by a slope and given forces, of whose rows so many have passed."""
    disc, first, last = engine.discs[i], engine.spans[i, 0], engine.spans[i, 1]
    ax, ay, turn = disc[PULL_X], disc[PULL_Y], disc[TWIST]
    if first < last:
        fx, fy, torque = prescribed_by(engine.forcing[first:last], passed, t)
        ax += disc[INV_MASS] * fx
        ay += disc[INV_MASS] * fy
        turn += disc[INV_INERTIA] * torque
    return ax, ay, turn


@inlined
def acceleration(engine: Engine, i: int, t: float, state: FloatArray) -> tuple[float, float]:
    """The acceleration of the centre."""
    disc = engine.discs[i]
    if disc[INV_MASS] == 0.0:
        return 0.0, 0.0  # straight on
    passed = rows_passed(engine.forcing, engine.spans[i, 0], engine.spans[i, 1], t)
    ax, ay, turn = pull_on(engine, i, passed, t)
    ux, uy, w = over_floor(engine, i, state)
    if size(ux, uy, w) == 0.0:
        floor = floor_of(engine.surface, disc)
        cx, cy = floor_acceleration(floor, state[X], state[Y], state[VX], state[VY])
        push, holds = math.hypot(ax - cx, ay - cy), disc[DECEL]
        if push > 0.0 and engine.forcing.shape[1] > FORCED:
            friction = friction_now(engine, i, passed, t, state)
            fx, fy, _, _ = friction_force(
                at_slip_zero(friction, 1.0), disc[RADIUS], (ax - cx) / push, (ay - cy) / push, 0.0
            )  # fmt: skip
            holds = disc[INV_MASS] * math.hypot(fx, fy)
        left = 1.0 - holds / push if push > engine.surface.static * holds else 0.0
        ax, ay = cx + left * (ax - cx), cy + left * (ay - cy)
    else:
        friction = friction_now(engine, i, passed, t, state)
        fx, fy, torque, _ = friction_force(friction, disc[RADIUS], ux, uy, w)
        dx, dy, slows, _, _ = dragged(disc[DRAG:], ux, uy, w)
        ax += disc[INV_MASS] * fx + dx
        ay += disc[INV_MASS] * fy + dy
        turn += disc[INV_INERTIA] * torque + slows
    ax, ay, _ = led(disc, engine.surface, state, ax, ay, turn)
    return ax, ay


@inlined
def slip_of(engine: Engine, number: int, y: FloatArray) -> float:
    """Q of a disc in the state y (6,) over the floor."""
    vx, vy, spin = over_floor(engine, number, y)
    return size(vx, vy, engine.discs[number, RADIUS] * spin)


@inlined
def load_on(engine: Engine, number: int) -> float:
    """F N of the floor on which a disc is."""
    return engine.regions.load[int(engine.discs[number, REGION])]


@inlined
def rest_on_floor(engine: Engine, number: int, y: FloatArray) -> None:
    """Give a disc in a state (6,) the velocity of the floor that it is on."""
    floor = floor_of(engine.surface, engine.discs[number])
    y[VX], y[VY], y[SPIN] = floor_velocity(floor, y[X], y[Y])


@inlined
def slip_at(engine: Engine, number: int, y: FloatArray, t: float) -> float:
    """Q of a disc in the state y (6,) over the floor at a time."""
    move_floor(engine, number, t)
    return slip_of(engine, number, y)


@inlined
def count_rows(engine: Engine, members: IntArray, t: float, buffer: GroupBuffer) -> None:
    """How many rows over time of the members have passed, and how their floors move."""
    for place in range(members.shape[0]):
        number = members[place]
        first, last = engine.spans[number, 0], engine.spans[number, 1]
        buffer.passed[place] = rows_passed(engine.forcing, first, last, t)
        move_floor(engine, number, t)


@inlined
def place_driven(
    engine: Engine,
    members: IntArray,
    motions: IntArray,
    t: float,
    y: FloatArray,
    buffer: GroupBuffer,
) -> None:
    """Put the driven members where their films have them at t, and their accelerations."""
    buffer.clock[0] = t
    for place in range(members.shape[0]):
        move_floor(engine, members[place], t)
        if motions[place] == DRIVEN:
            first, last = engine.drives[members[place], 0], engine.drives[members[place], 1]
            on_piece(engine.pieces[piece_at(engine.pieces, first, last, t)], t, buffer.film)
            write_over(y[place], buffer.film[:6])
            write_over(buffer.own[place], buffer.film[6:])


@inner
def act(
    engine: Engine, members: IntArray, motions: IntArray, y: FloatArray, power: FloatArray,
    buffer: GroupBuffer,
) -> None:  # fmt: skip
    """Accelerations of the members as if there were no contacts, and the power of what acts.

    Those of who rests are the floor's.
    """
    for i in range(power.shape[0]):
        power[i] = 0.0
    for place in range(members.shape[0]):
        number = members[place]
        disc, own, inverse = engine.discs[number], buffer.own[place], buffer.inverse[place]
        doing, radius = motions[place], disc[RADIUS]
        inverse[0] = inverse[1] = 0.0
        vx, vy, spin = y[place, VX], y[place, VY], y[place, SPIN]
        floor = floor_of(engine.surface, disc)
        cx, cy = floor_acceleration(floor, y[place, X], y[place, Y], vx, vy)
        held = buffer.floor_accels[place]
        held[0], held[1], held[2] = cx, cy, floor.turn
        if doing == DRIVEN:
            continue
        passed, now = buffer.passed[place], buffer.clock[0]
        px, py, pull = pull_on(engine, number, passed, now)
        light, turns = disc[INV_MASS], disc[INV_INERTIA]
        power[PULL_WORK] += (px * vx + py * vy) / light + pull * spin / turns
        rubbed = is_over_belts(engine, number)
        if doing == HELD:
            own[0], own[1], own[2] = cx, cy, floor.turn
            if rubbed:
                friction = friction_now(engine, number, passed, now, y[place])
                heat = heat_at_rest(friction.by_speed.table, -px / light, -py / light)
                power[FLOOR_HEAT] += heat
                power[SUPPORT_WORK] += heat
            continue
        inverse[0], inverse[1] = light, turns
        sx, sy, turning = floor_velocity(floor, y[place, X], y[place, Y])
        ux, uy, w = vx - sx, vy - sy, spin - turning
        friction = friction_now(engine, number, passed, now, y[place])
        if doing == YIELDS:
            slip, small = buffer.slips[place], _BEGUN if rubbed else 1.0  # other belts slip by more
            nx, ny, nw = small * slip[0], small * slip[1], small * slip[2]
            fx, fy, torque, heat = friction_force(
                at_slip_zero(friction, buffer.firm[place]), radius, nx, ny, nw
            )  # fmt: skip
            others = heat + fx * nx + fy * ny + torque * nw if rubbed else 0.0
            heat = others - (fx * ux + fy * uy + torque * w)
        else:
            fx, fy, torque, heat = friction_force(friction, radius, ux, uy, w)
        ax, ay, turn, warmth, turning_warmth = dragged(disc[DRAG:], ux, uy, w)
        ax, ay, turn = ax + fx * light, ay + fy * light, turn + torque * turns
        own[0], own[1], own[2] = px + ax, py + ay, pull + turn
        if rubbed:  # what others of the belts do
            power[SUPPORT_WORK] += heat + fx * ux + fy * uy + torque * w
        power[FLOOR_HEAT] += heat
        power[DRAG_HEAT] += warmth / light + turning_warmth / turns
        power[SUPPORT_WORK] += (ax * sx + ay * sy) / light + turn * turning / turns


@inlined
def force_of_contacts(buffer: GroupBuffer, count: int, place: int) -> tuple[float, float, float]:
    """Force and torque of all contacts on a member."""
    fx, fy, torque = 0.0, 0.0, 0.0
    for c in range(count):
        push, rim = buffer.pushes[c, 0], buffer.pushes[c, 1]
        nx, ny = buffer.kinematics[c, NX], buffer.kinematics[c, NY]
        for side in range(2):
            if buffer.pairs[c, side] == place:
                sign = 2.0 * side - 1.0
                fx += sign * (push * nx - rim * ny)
                fy += sign * (push * ny + rim * nx)
                torque -= buffer.kinematics[c, ARM + side] * rim
    return fx, fy, torque


@inlined
def power_of_contacts(
    engine: Engine, members: IntArray, motions: IntArray, count: int, y: FloatArray,
    power: FloatArray, buffer: GroupBuffer,
) -> None:  # fmt: skip
    """Heat of the rims, and work of what drives, leads and carries, into ``power``."""
    for c in range(count):
        power[RIM_HEAT] += buffer.pushes[c, 1] * buffer.kinematics[c, SLIP]
    for place in range(motions.shape[0]):
        vx, vy, spin = y[place, VX], y[place, VY], y[place, SPIN]
        if motions[place] == DRIVEN:
            fx, fy, torque = force_of_contacts(buffer, count, place)
            power[DRIVE_WORK] -= fx * vx + fy * vy + torque * spin
            power[BACK_X] += fx
            power[BACK_Y] += fy
        elif motions[place] == HELD and size(vx, vy, spin) > 0.0:
            fx, fy, torque = _wanted_of_floor(engine, members, place, count, buffer)
            power[SUPPORT_WORK] -= fx * vx + fy * vy + torque * spin
    for tie in range(buffer.number[0]):
        place, row = buffer.led_places[tie], buffer.ties[tie]
        if motions[place] != HELD:
            rate = row[0] * y[place, VX] + row[1] * y[place, VY] + row[2] * y[place, SPIN]
            power[SUPPORT_WORK] -= buffer.tautness[tie] * rate


@inlined
def _wanted_of_floor(
    engine: Engine, members: IntArray, place: int, count: int, buffer: GroupBuffer
) -> tuple[float, float, float]:
    """Force and torque that a member at rest exerts on the floor."""
    disc = engine.discs[members[place]]
    fx, fy, torque = force_of_contacts(buffer, count, place)
    px, py, pull = pull_on(engine, members[place], buffer.passed[place], buffer.clock[0])
    light, turns = disc[INV_MASS], disc[INV_INERTIA]
    floor = buffer.floor_accels[place]
    fx, fy = fx + (px - floor[0]) / light, fy + (py - floor[1]) / light
    return fx, fy, torque + (pull - floor[2]) / turns


@inlined
def excess_on(
    engine: Engine, members: IntArray, place: int, count: int, y: FloatArray, buffer: GroupBuffer
) -> tuple[float, float, float, float]:
    """By how much what acts on a disc at rest exceeds its friction, over f N, and the slip then."""
    number = members[place]
    disc, load = engine.discs[number], load_on(engine, number)
    friction = friction_now(engine, number, buffer.passed[place], buffer.clock[0], y[place])
    friction = at_slip_zero(friction, engine.surface.static)
    fx, fy, torque = _wanted_of_floor(engine, members, place, count, buffer)
    kind = int(disc[HOLD])
    if kind == FREE:
        excess, ux, uy, w = free_yield(friction, disc[RADIUS], fx, fy, torque, False)
        return excess / load, ux, uy, w
    hold = constraint_on(disc)
    body = Body(1.0 / disc[INV_MASS], 1.0 / disc[INV_INERTIA], disc[RADIUS])
    excess, ux, uy, w = constrained_yield(
        friction, hold, body, y[place, THETA], 0.0, 0.0, 0.0, fx, fy, torque, True
    )
    return excess / load, ux, uy, w


@inlined
def gain_of(engine: Engine, number: int, place: int, buffer: GroupBuffer) -> float:
    """How fast a disc that yields gains speed along its way."""
    slip, rate, radius = buffer.slips[place], buffer.rates[place], engine.discs[number, RADIUS]
    ax, ay = rate[0] - buffer.floor_accels[place, 0], rate[1] - buffer.floor_accels[place, 1]
    turn = rate[2] - buffer.floor_accels[place, 2]
    return slip[0] * ax + slip[1] * ay + radius * radius * slip[2] * turn


@inlined
def can_rest(engine: Engine, number: int) -> bool:
    """Whether the floor can hold a disc."""
    return load_on(engine, number) > 0.0
