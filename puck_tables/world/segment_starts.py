"""What the engine works with, how segments begin, and what is written down."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel
from puck_tables.scene.equations import ROW
from puck_tables.scene.floor_map import INSIDE, OUTSIDE, OVERLAPS
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y, friction_force
from puck_tables.scene.ingredients import is_mixed
from puck_tables.scene.over_time import rows_passed
from puck_tables.world.contact_row import (
    CONTACT_COLUMNS,
    FIRST_N,
    FIRST_T,
    LOSS,
    NX,
    NY,
    SUM_N,
    SUM_T,
    got_impulse,
)  # fmt: skip
from puck_tables.world.engine_state import (
    APPROACH,
    AT_X,
    AT_Y,
    ENTERS,
    GOT,
    IMPACT,
    LEAVES,
    LED,
    LOST,
    N_EVENTS,
    N_HISTORY,
    N_IMPACTS,
    N_PIECES,
    N_WORK_ROWS,
    NORMAL_X,
    NORMAL_Y,
    OVERHANGS,
    PARTNER,
    PUSH,
    RUB,
    SLIDE,
    TIME,
    TIPS,
    WHAT,
    WHO,
    Engine,
    Whole,
)  # fmt: skip
from puck_tables.world.floor_under import (
    choose_belt,
    floor_map_span,
    floor_of,
    friction_now,
    is_beyond,
    is_over,
    move_floor,
    off_border,
    over_floor,
    step_onto,
)  # fmt: skip
from puck_tables.world.group import GroupBuffer, buffer_for
from puck_tables.world.group_forces import rest_on_floor
from puck_tables.world.holds import work_of_hold
from puck_tables.world.layout import (
    EDGE_NUMBER,
    INV_INERTIA,
    INV_MASS,
    KIND,
    LIES,
    OVERHANG,
    RADIUS,
    A,
    kinetic,
    write_over,
)  # fmt: skip
from puck_tables.world.lone import LONGEST, follow_alone
from puck_tables.world.paths import BEGINS, DURATION, FIRST, FOR_EVER, bounds_of
from puck_tables.world.segment import (
    ANGLE,
    DRIFT_X,
    DRIFT_Y,
    FASTEST,
    FIRST_PIECE,
    GONE,
    LAST_PIECE,
    PATH,
    PLACE_X,
    PLACE_Y,
    RIDES,
    ROOM,
    SEGMENT_COLUMNS,
    START,
    STILL,
    STRONGEST,
    UNTIL,
    start_segment,
    state_at,
)  # fmt: skip
from puck_tables.world.step_pieces import BUFFER_ROWS

# of a disc while an event is worked on: not concerned, concerned, its contacts are known, was to
# meet one that is concerned, has set off; is to get a state that nobody has looked at
CURRENT, STALE, LOOKED_AT, PARTNER_STALE, SENT, BY_HAND = range(6)

_MOMENT = 1e-3  # of Q/J: what no step follows loses its balance as soon, where it tips
_AT_ONCE = 256  # contacts whose impacts are found together, and discs led among them, at most


class Room(NamedTuple):
    """Where the engine works: rows for every disc, contacts, and a few numbers."""

    states: FloatArray
    before: FloatArray
    marks: Whole
    shares: Whole
    contacts: Whole
    rows: FloatArray
    work: FloatArray
    one: FloatArray
    two: FloatArray
    workspace: FloatArray
    buffer: GroupBuffer


def room_for(discs: int) -> Room:
    """Room to work for so many discs: a disc touches six others at most of its size.

    All together have 3 n − 6 contacts with each other at most, for these make a plane graph.
    """
    contacts, at_once = 6 * discs + 16, min(3 * discs + 16, _AT_ONCE)
    return Room(
        np.zeros((discs, 6)), np.zeros((discs, 6)), np.zeros(discs, np.int64),
        np.zeros(discs, np.int64), np.zeros((contacts, 2), np.int64),
        np.zeros((contacts, CONTACT_COLUMNS)), np.zeros(ROOM), np.zeros(6), np.zeros(6),
        np.zeros((BUFFER_ROWS, ROW)),
        buffer_for(discs, at_once, min(discs, _AT_ONCE)),
    )  # fmt: skip


@inlined
def locate(engine: Engine, i: int, t: float, room: Room) -> None:
    """The state of a disc now, and how its floor moves."""
    move_floor(engine, i, t)
    state_at(
        engine.kinds[i], engine.segments[i], engine.discs[i], engine.lookups, engine.pieces, t,
        room.work, room.states[i],
    )  # fmt: skip


@inlined
def keep_segment(engine: Engine, i: int) -> None:
    """Write down the segment that a disc begins."""
    row = engine.history[engine.counts[N_HISTORY]]
    row[0], row[1] = i, engine.kinds[i]
    for column in range(SEGMENT_COLUMNS):
        row[2 + column] = engine.segments[i, column]
    engine.counts[N_HISTORY] += 1


@inlined
def _start(engine: Engine, i: int, t: float, room: Room) -> int:
    """The segment of a disc alone, from its state, over the floor that it is on; its kind."""
    floor = floor_of(engine.surface, engine.discs[i])
    return start_segment(
        room.states[i], engine.discs[i], floor, engine.lookups, t, room.work, engine.segments[i]
    )


@inlined
def take_off(engine: Engine, i: int, t: float, room: Room) -> None:
    """A new segment of a disc alone, from its state; what it was is kept."""
    engine.kinds[i] = _start(engine, i, t, room)
    engine.group[i] = 0
    keep_segment(engine, i)


@inlined
def stay(engine: Engine, i: int, t: float, room: Room) -> None:
    """A disc at rest on its floor, that others or a cushion may hold there."""
    rest_on_floor(engine, i, room.states[i])
    engine.kinds[i] = _start(engine, i, t, room)
    keep_segment(engine, i)


@kernel
def fly_along(
    segment: FloatArray, pieces: FloatArray, first: int, last: int, t: float, until: float
) -> None:
    """The segment along pieces from t on, which is known until a time."""
    segment[START], segment[UNTIL] = t, until
    segment[FIRST_PIECE], segment[LAST_PIECE] = first, last
    segment[RIDES] = 0.0
    segment[DRIFT_X] = segment[DRIFT_Y] = segment[FASTEST] = segment[STRONGEST] = 0.0
    segment[PLACE_X], segment[PLACE_Y] = pieces[first, FIRST], pieces[first, FIRST + 1]
    segment[ANGLE] = pieces[first, FIRST + 2]
    for piece in range(first, last):
        speed, accel = bounds_of(pieces[piece])
        segment[FASTEST] = max(segment[FASTEST], speed)
        segment[STRONGEST] = max(segment[STRONGEST], accel)


@inlined
def lacks_pieces(engine: Engine) -> bool:
    """Whether one path more may not find room."""
    return (
        engine.counts[N_PIECES] + LONGEST > engine.pieces.shape[0]
        or engine.counts[N_WORK_ROWS] + LONGEST > engine.work_rows.shape[0]
    )


@inner
def loses_balance(engine: Engine, i: int, t: float, room: Room) -> bool:
    """Whether in a moment no pressure of the floor under a disc carries it, so that it tips."""
    rows = engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
    disc, state = engine.discs[i], room.one
    write_over(state, room.states[i])
    h, fx, fy, torque = 0.0, 0.0, 0.0, 0.0
    for _ in range(2):
        state[X], state[Y], state[THETA] = (
            state[X] + h * state[VX], state[Y] + h * state[VY], state[THETA] + h * state[SPIN]
        )  # fmt: skip
        state[VX], state[VY] = (
            state[VX] + h * disc[INV_MASS] * fx,
            state[VY] + h * disc[INV_MASS] * fy,
        )
        state[SPIN] += h * disc[INV_INERTIA] * torque
        passed = rows_passed(rows, 0, len(rows), t + h)
        friction = friction_now(engine, i, passed, t + h, state)
        vx, vy, spin = over_floor(engine, i, state)
        fx, fy, torque, _ = friction_force(friction, disc[RADIUS], vx, vy, spin)
        h = _MOMENT * engine.scale[0] / engine.scale[1]
    return is_mixed(friction) and math.isnan(fx)


@inner
def integrate(engine: Engine, i: int, t: float, room: Room) -> bool:
    """The path of a disc alone, from its state, or how it tips; whether it can be followed."""
    done, until, count, held = follow_alone(engine, i, t, room.states[i], room.workspace)
    engine.group[i] = 0
    if not done and (until < math.inf or loses_balance(engine, i, t, room)):
        leave(engine, i, t, TIPS, i, room)
        return True
    if until == math.inf:
        stay(engine, i, t, room)
    elif done:
        first = engine.counts[N_PIECES]
        engine.counts[N_PIECES] += count
        engine.counts[N_WORK_ROWS] += count
        fly_along(engine.segments[i], engine.pieces, first, first + count, t, until)
        engine.segments[i, RIDES] = 1.0 if held else 0.0
        engine.kinds[i] = PATH
        keep_segment(engine, i)
    return done


@inner
def drive_on(engine: Engine, i: int, t: float, room: Room) -> None:
    """The next straight piece of the way along which a disc is driven; at its end it stays."""
    piece, last = int(engine.segments[i, FIRST_PIECE]), engine.drives[i, 1]
    if engine.kinds[i] == PATH:
        piece += 1
    piece = max(piece, engine.drives[i, 0])  # a way that is led anew
    _start(engine, i, t, room)
    if piece < last and engine.pieces[piece, DURATION] > 0.0:
        row = engine.pieces[piece]
        engine.kinds[i] = PATH
        engine.segments[i, FIRST_PIECE], engine.segments[i, LAST_PIECE] = piece, piece + 1
        ends = row[BEGINS] + row[DURATION]
        engine.segments[i, UNTIL] = ends if row[DURATION] < FOR_EVER else math.inf
        engine.segments[i, FASTEST] = math.hypot(row[FIRST + VX], row[FIRST + VY])
        engine.segments[i, STRONGEST] = 0.0
    else:
        engine.kinds[i] = STILL
    keep_segment(engine, i)


@inlined
def note(engine: Engine, t: float, what: int, who: int, partner: int, x: float, y: float) -> None:
    """Write down an event."""
    event = engine.events[engine.counts[N_EVENTS]]
    event[:] = 0.0
    event[TIME], event[WHAT], event[WHO], event[PARTNER] = t, what, who, partner
    event[AT_X], event[AT_Y] = x, y
    engine.counts[N_EVENTS] += 1


@inlined
def _work(
    engine: Engine, i: int, px: float, py: float, rub: float, room: Room, event: FloatArray
) -> None:
    """Add to an event what a driven body works, or a constraint, by an impulse that its disc gets.

    ``rub``: of it, along the rim with the spin.
    """
    disc, state = engine.discs[i], room.states[i]
    turn = disc[RADIUS] * rub
    if disc[INV_MASS] > 0.0:
        event[LED] += work_of_hold(disc, engine.surface, state, px, py, turn)
    else:
        event[GOT] -= px * state[VX] + py * state[VY] + turn * state[SPIN]


@inlined
def note_impacts(engine: Engine, t: float, count: int, room: Room) -> None:
    """Write down the impacts of contacts that had an impulse."""
    for n in range(count):
        row, i = room.rows[n], room.contacts[n, 0]
        if got_impulse(row):
            radius = engine.discs[i, RADIUS]
            note(
                engine, t, IMPACT, i, room.contacts[n, 1],
                room.states[i, X] + radius * row[NX], room.states[i, Y] + radius * row[NY],
            )  # fmt: skip
            event = engine.events[engine.counts[N_EVENTS] - 1]
            event[NORMAL_X], event[NORMAL_Y] = row[NX], row[NY]
            event[APPROACH], event[SLIDE] = row[FIRST_N], row[FIRST_T]
            event[PUSH], event[RUB], event[LOST] = row[SUM_N], row[SUM_T], row[LOSS]
            px = row[SUM_N] * row[NX] - row[SUM_T] * row[NY]
            py = row[SUM_N] * row[NY] + row[SUM_T] * row[NX]
            j = room.contacts[n, 1]
            _work(engine, i, -px, -py, -row[SUM_T], room, event)
            if j >= 0:
                _work(engine, j, px, py, -row[SUM_T], room, event)
            engine.counts[N_IMPACTS] += 1


@inlined
def cross(engine: Engine, i: int, t: float, k: int, room: Room) -> None:
    """The rim of a disc comes over a border or a patch of the floor, or leaves it."""
    number, x, y = int(engine.obstacles[k, A]), room.states[i, X], room.states[i, Y]
    enters = int(engine.discs[i, LIES + number]) != OVERLAPS
    how = OVERLAPS
    if not enters:
        first, last = floor_map_span(engine, i)
        away = off_border(engine.regions.floor_map[first:last], number, x, y)
        how = OUTSIDE if away > 0.0 else INSIDE
    engine.discs[i, LIES + number] = how
    note(engine, t, ENTERS if enters else LEAVES, i, -1 - k, x, y)
    step_onto(engine, i)
    choose_belt(engine, i, room.states[i])


@inlined
def overhang(engine: Engine, i: int, t: float, k: int, room: Room) -> bool:
    """The rim of a disc comes over an edge, which is told, or is back; whether it flies on.

    It does unless its friction is summed only while it hangs.
    """
    number = int(engine.obstacles[k, EDGE_NUMBER])
    if engine.hangs[i, number] == 0:
        note(engine, t, OVERHANGS, i, -1 - k, room.states[i, X], room.states[i, Y])
    engine.hangs[i, number] = 1 - engine.hangs[i, number]
    summed = is_over(engine, i)
    step_onto(engine, i)
    return summed == is_over(engine, i)


@inlined
def hang_over(engine: Engine, i: int, t: float, state: FloatArray) -> None:
    """Tell over which edges the rim of a disc is that is about to be put down, and was not."""
    for k in range(engine.obstacles.shape[0]):
        row, number = engine.obstacles[k], int(engine.obstacles[k, EDGE_NUMBER])
        is_new = int(row[KIND]) == OVERHANG and engine.hangs[i, number] == 0
        if is_new and is_beyond(engine.discs[i], row, state[X], state[Y]):
            note(engine, t, OVERHANGS, i, -1 - k, state[X], state[Y])


@inlined
def leave(engine: Engine, i: int, t: float, what: int, partner: int, room: Room) -> None:
    """A disc falls into a pocket or over an edge, or is taken away."""
    note(engine, t, what, i, partner, room.states[i, X], room.states[i, Y])
    vx, vy, spin = room.states[i, VX], room.states[i, VY], room.states[i, SPIN]
    engine.events[engine.counts[N_EVENTS] - 1, GOT] = kinetic(engine.discs[i], vx, vy, spin)
    room.states[i, VX] = room.states[i, VY] = room.states[i, SPIN] = 0.0
    _start(engine, i, t, room)
    engine.segments[i, DRIFT_X] = engine.segments[i, DRIFT_Y] = 0.0
    engine.kinds[i] = GONE
    engine.group[i] = 0
    keep_segment(engine, i)
