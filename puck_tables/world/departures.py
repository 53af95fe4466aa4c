"""What the engine works with, how flights begin, and what is written down."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel
from puck_tables.scene.equations import ROW
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import floor_velocity
from puck_tables.scene.patches import ASTRIDE, INSIDE, OUTSIDE
from puck_tables.world.flight import (
    ANGLE,
    DRIFT_X,
    DRIFT_Y,
    FASTEST,
    FIRST_PIECE,
    FLIGHT_COLUMNS,
    GONE,
    LAST_PIECE,
    PATH,
    PLACE_X,
    PLACE_Y,
    ROOM,
    START,
    STILL,
    STRONGEST,
    UNTIL,
    start_flight,
    state_at,
)
from puck_tables.world.footing import (
    choose_belt,
    floor_of,
    ground_span,
    move_floor,
    off_border,
    step_onto,
)
from puck_tables.world.game import (
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
    N_WORKS,
    NORMAL_X,
    NORMAL_Y,
    OVERHANGS,
    PARTNER,
    PUSH,
    RUB,
    SLIDE,
    TIME,
    WHAT,
    WHO,
    Game,
    Whole,
)
from puck_tables.world.holds import work_of_hold
from puck_tables.world.impact import (
    CONTACT_COLUMNS,
    FIRST_N,
    FIRST_T,
    LOSS,
    NX,
    NY,
    SUM_N,
    SUM_T,
    was_hit,
)
from puck_tables.world.layout import (
    EDGE_NUMBER,
    KIND,
    LIES,
    LIGHTNESS,
    OVERHANG,
    RADIUS,
    A,
    B,
    C,
    kinetic,
)
from puck_tables.world.lone import DESK_ROWS, LONGEST, follow_alone
from puck_tables.world.paths import DURATION, FIRST, FOR_EVER, bounds_of
from puck_tables.world.paths import START as BEGINS

# of a disc while an event is worked on: not concerned, concerned, its contacts are known, was to
# meet one that is concerned, has set off
NOT_CONCERNED, CONCERNED, LOOKED_AT, DISAPPOINTED, SENT = range(5)


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


def room_for(discs: int) -> Room:
    """Room to work for so many discs: a disc touches six others at most of its size."""
    contacts = 6 * discs + 16
    return Room(
        np.zeros((discs, 6)), np.zeros((discs, 6)), np.zeros(discs, np.int64),
        np.zeros(discs, np.int64), np.zeros((contacts, 2), np.int64),
        np.zeros((contacts, CONTACT_COLUMNS)), np.zeros(ROOM), np.zeros(6), np.zeros(6),
        np.zeros((DESK_ROWS, ROW)),
    )  # fmt: skip


@inlined
def locate(game: Game, i: int, t: float, room: Room) -> None:
    """The state of a disc now, and how its floor moves."""
    move_floor(game.surface, game.discs, game.tides, game.spans, i, t)
    state_at(
        game.kinds[i], game.flights[i], game.discs[i], game.curves, game.pieces, t, room.work,
        room.states[i],
    )  # fmt: skip


@inlined
def keep_flight(game: Game, i: int) -> None:
    """Write down the flight that a disc begins."""
    row = game.history[game.counts[N_HISTORY]]
    row[0], row[1] = i, game.kinds[i]
    for column in range(FLIGHT_COLUMNS):
        row[2 + column] = game.flights[i, column]
    game.counts[N_HISTORY] += 1


@inlined
def _start(game: Game, i: int, t: float, room: Room) -> int:
    """The flight of a disc alone, from its state, over the floor that it is on; its kind."""
    floor = floor_of(game.surface, game.discs[i])
    return start_flight(
        room.states[i], game.discs[i], floor, game.curves, t, room.work, game.flights[i]
    )


@inlined
def take_off(game: Game, i: int, t: float, room: Room) -> None:
    """A new flight of a disc alone, from its state; what it was is kept."""
    game.kinds[i] = _start(game, i, t, room)
    game.group[i] = 0
    keep_flight(game, i)


@inlined
def stay(game: Game, i: int, t: float, room: Room) -> None:
    """A disc at rest on its floor, that others or a cushion may hold there."""
    state = room.states[i]
    floor = floor_of(game.surface, game.discs[i])
    state[VX], state[VY], state[SPIN] = floor_velocity(floor, state[X], state[Y])
    game.kinds[i] = _start(game, i, t, room)
    keep_flight(game, i)


@kernel
def fly_along(
    flight: FloatArray, pieces: FloatArray, first: int, last: int, t: float, until: float
) -> None:
    """The flight along pieces from t on, which is known until a time."""
    flight[START], flight[UNTIL] = t, until
    flight[FIRST_PIECE], flight[LAST_PIECE] = first, last
    flight[DRIFT_X] = flight[DRIFT_Y] = flight[FASTEST] = flight[STRONGEST] = 0.0
    flight[PLACE_X], flight[PLACE_Y] = pieces[first, FIRST], pieces[first, FIRST + 1]
    flight[ANGLE] = pieces[first, FIRST + 2]
    for piece in range(first, last):
        speed, bend = bounds_of(pieces[piece])
        flight[FASTEST] = max(flight[FASTEST], speed)
        flight[STRONGEST] = max(flight[STRONGEST], bend)


@inlined
def lacks_pieces(game: Game) -> bool:
    """Whether one path more may not find room."""
    return (
        game.counts[N_PIECES] + LONGEST > game.pieces.shape[0]
        or game.counts[N_WORKS] + LONGEST > game.works.shape[0]
    )


@inner
def integrate(game: Game, i: int, t: float, room: Room) -> bool:
    """The path of a disc alone, from its state; whether it can be followed."""
    done, until, count = follow_alone(game, i, t, room.states[i], room.workspace)
    game.group[i] = 0
    if until == math.inf:
        stay(game, i, t, room)
    elif done:
        first = game.counts[N_PIECES]
        game.counts[N_PIECES] += count
        game.counts[N_WORKS] += count
        fly_along(game.flights[i], game.pieces, first, first + count, t, until)
        game.kinds[i] = PATH
        keep_flight(game, i)
    return done


@inner
def drive_on(game: Game, i: int, t: float, room: Room) -> None:
    """The next straight piece of the way along which a disc is driven; at its end it stays."""
    piece, last = int(game.flights[i, FIRST_PIECE]), game.drives[i, 1]
    if game.kinds[i] == PATH:
        piece += 1
    piece = max(piece, game.drives[i, 0])  # a way that is led anew
    _start(game, i, t, room)
    if piece < last and game.pieces[piece, DURATION] > 0.0:
        row = game.pieces[piece]
        game.kinds[i] = PATH
        game.flights[i, FIRST_PIECE], game.flights[i, LAST_PIECE] = piece, piece + 1
        ends = row[BEGINS] + row[DURATION]
        game.flights[i, UNTIL] = ends if row[DURATION] < FOR_EVER else math.inf
        game.flights[i, FASTEST] = math.hypot(row[FIRST + VX], row[FIRST + VY])
        game.flights[i, STRONGEST] = 0.0
    else:
        game.kinds[i] = STILL
    keep_flight(game, i)


@inlined
def note(game: Game, t: float, what: int, who: int, partner: int, x: float, y: float) -> None:
    """Write down an event."""
    event = game.events[game.counts[N_EVENTS]]
    event[:] = 0.0
    event[TIME], event[WHAT], event[WHO], event[PARTNER] = t, what, who, partner
    event[AT_X], event[AT_Y] = x, y
    game.counts[N_EVENTS] += 1


@inlined
def _work(
    game: Game, i: int, px: float, py: float, rub: float, room: Room, event: FloatArray
) -> None:
    """Add to an event what a driven body works, or a constraint, by an impulse that its disc gets.

    ``rub``: of it, along the rim with the spin.
    """
    disc, state = game.discs[i], room.states[i]
    turn = disc[RADIUS] * rub
    if disc[LIGHTNESS] > 0.0:
        event[LED] += work_of_hold(disc, game.surface, state, px, py, turn)
    else:
        event[GOT] -= px * state[VX] + py * state[VY] + turn * state[SPIN]


@inlined
def note_impacts(game: Game, t: float, count: int, room: Room) -> None:
    """Write down the impacts of contacts that had an impulse."""
    for n in range(count):
        row, i = room.rows[n], room.contacts[n, 0]
        if was_hit(row):
            radius = game.discs[i, RADIUS]
            note(
                game, t, IMPACT, i, room.contacts[n, 1],
                room.states[i, X] + radius * row[NX], room.states[i, Y] + radius * row[NY],
            )  # fmt: skip
            event = game.events[game.counts[N_EVENTS] - 1]
            event[NORMAL_X], event[NORMAL_Y] = row[NX], row[NY]
            event[APPROACH], event[SLIDE] = row[FIRST_N], row[FIRST_T]
            event[PUSH], event[RUB], event[LOST] = row[SUM_N], row[SUM_T], row[LOSS]
            px = row[SUM_N] * row[NX] - row[SUM_T] * row[NY]
            py = row[SUM_N] * row[NY] + row[SUM_T] * row[NX]
            j = room.contacts[n, 1]
            _work(game, i, -px, -py, -row[SUM_T], room, event)
            if j >= 0:
                _work(game, j, px, py, -row[SUM_T], room, event)
            game.counts[N_IMPACTS] += 1


@inlined
def cross(game: Game, i: int, t: float, k: int, room: Room) -> None:
    """The rim of a disc comes over a border or a patch of the floor, or leaves it."""
    number, x, y = int(game.obstacles[k, A]), room.states[i, X], room.states[i, Y]
    enters = int(game.discs[i, LIES + number]) != ASTRIDE
    how = ASTRIDE
    if not enters:
        first, last = ground_span(game.regions, game.discs, i)
        away = off_border(game.regions.ground[first:last], number, x, y)
        how = OUTSIDE if away > 0.0 else INSIDE
    game.discs[i, LIES + number] = how
    note(game, t, ENTERS if enters else LEAVES, i, -1 - k, x, y)
    step_onto(game, i)
    choose_belt(game.regions, game.discs, i, room.states[i])


@inlined
def overhang(game: Game, i: int, t: float, k: int, room: Room) -> None:
    """The rim of a disc comes over an edge, which is told, or is back; it flies on."""
    number = int(game.obstacles[k, EDGE_NUMBER])
    if game.hangs[i, number] == 0:
        note(game, t, OVERHANGS, i, -1 - k, room.states[i, X], room.states[i, Y])
    game.hangs[i, number] = 1 - game.hangs[i, number]


@inlined
def hang_over(game: Game, i: int, t: float, state: FloatArray) -> None:
    """See over which edges the rim of a disc is that is put down; what is new is told."""
    for k in range(game.obstacles.shape[0]):
        row, number = game.obstacles[k], int(game.obstacles[k, EDGE_NUMBER])
        if int(row[KIND]) == OVERHANG:
            gap = row[A] * state[X] + row[B] * state[Y] - row[C]
            over = game.discs[i, LIGHTNESS] > 0.0 and gap < game.discs[i, RADIUS]
            if over and game.hangs[i, number] == 0:
                note(game, t, OVERHANGS, i, -1 - k, state[X], state[Y])
            game.hangs[i, number] = 1 if over else 0


@inlined
def leave(game: Game, i: int, t: float, what: int, partner: int, room: Room) -> None:
    """A disc falls into a pocket or over an edge, or is taken away."""
    note(game, t, what, i, partner, room.states[i, X], room.states[i, Y])
    vx, vy, spin = room.states[i, VX], room.states[i, VY], room.states[i, SPIN]
    game.events[game.counts[N_EVENTS] - 1, GOT] = kinetic(game.discs[i], vx, vy, spin)
    room.states[i, VX] = room.states[i, VY] = room.states[i, SPIN] = 0.0
    _start(game, i, t, room)
    game.flights[i, DRIFT_X] = game.flights[i, DRIFT_Y] = 0.0
    game.kinds[i] = GONE
    game.group[i] = 0
    keep_flight(game, i)
