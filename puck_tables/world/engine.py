"""From event to event: what comes next, who is concerned, where they fly then."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.world.flight import (
    FASTEST,
    FIRST_PIECE,
    FLIGHT_COLUMNS,
    GONE,
    LAST_PIECE,
    PATH,
    ROOM,
    STILL,
    STRONGEST,
    UNTIL,
    start_flight,
    state_at,
)
from puck_tables.world.game import (
    APPROACH,
    AT_X,
    AT_Y,
    IMPACT,
    LAUNCH_SPIN,
    LAUNCH_TIME,
    LAUNCH_VX,
    LAUNCH_VY,
    LAUNCHED,
    LOOK_AGAIN,
    LOST,
    N_AT_ONCE,
    N_CONTACTS,
    N_EVENTS,
    N_HISTORY,
    N_IMPACTS,
    N_LAUNCHES,
    NORMAL_X,
    NORMAL_Y,
    NOTHING,
    OVER_EDGE,
    PARTNER,
    PATH_ENDS,
    POCKETED,
    PUSH,
    RUB,
    SLIDE,
    STRUCK,
    TIME,
    WHAT,
    WHO,
    Game,
    Whole,
)
from puck_tables.world.impact import (
    ACTS,
    CONTACT_COLUMNS,
    FIRST_N,
    FIRST_T,
    LOSS,
    NX,
    NY,
    SUM_N,
    SUM_T,
    approach,
    collide,
    opening,
    prepare_contact,
)
from puck_tables.world.layout import DECEL, EDGE, INTEGRATED, KIND, POCKET, RADIUS
from puck_tables.world.meeting import next_crossing, next_meeting, normal_to
from puck_tables.world.paths import DURATION, FIRST
from puck_tables.world.paths import START as BEGINS

REACHED, FULL, CROWDED, TANGLED, PAUSED, PUSHING = range(6)  # how a call ends

NOBODY, EVERYBODY, THOSE_LEFT = -1, -2, -3
# of a disc while an event is worked on: not concerned, concerned, its contacts are known, was to
# meet one that is concerned, flies on in a group that pushes
NOT_CONCERNED, CONCERNED, LOOKED_AT, DISAPPOINTED, PUSHED = range(5)

TOUCH = 1e-12  # of the radius: a gap as small is none
BLUR = 1e-15  # of the time since the start, at full speed: another
HARDLY = 1e-11  # of the scales of speeds and accelerations: none
MOST_AT_ONCE = 1_000  # events at one moment
MOST_IN_A_CALL = 2_000  # then the caller may hear Ctrl-C


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


@inlined
def _locate(game: Game, i: int, t: float, room: Room) -> None:
    """The state of a disc now."""
    state_at(
        game.kinds[i], game.flights[i], game.discs[i], game.curves, game.pieces, t, room.work,
        room.states[i],
    )  # fmt: skip


@inlined
def _earlier(game: Game, i: int, time: float, partner: int) -> None:
    """Note a meeting, or a moment to look again, if nothing comes before."""
    if time < 0.0:
        time, partner = -1.0 - time, LOOK_AGAIN
    if time < game.next_time[i]:
        game.next_time[i], game.next_partner[i] = time, partner


@inner
def look_ahead(game: Game, i: int, t: float, room: Room) -> None:
    """What comes next for a disc, and whether that is the next for others too."""
    game.next_time[i], game.next_partner[i] = math.inf, NOTHING
    if game.kinds[i] == PATH:
        _earlier(game, i, game.flights[i, UNTIL], PATH_ENDS)
    for k in range(game.obstacles.shape[0]):
        found = next_crossing(game, i, k, t, game.next_time[i], room.work, room.one)
        _earlier(game, i, found, -1 - k)
    for j in range(game.discs.shape[0]):
        if j != i:
            found = next_meeting(game, i, j, t, game.next_time[i], room.work, room.one, room.two)
            _earlier(game, i, found, j)
            _earlier(game, j, found, i)


@inlined
def keep_flight(game: Game, i: int) -> None:
    """Write down the flight that a disc begins."""
    row = game.history[game.counts[N_HISTORY]]
    row[0], row[1] = i, game.kinds[i]
    for column in range(FLIGHT_COLUMNS):
        row[2 + column] = game.flights[i, column]
    game.counts[N_HISTORY] += 1


@inlined
def _take_off(game: Game, i: int, t: float, room: Room) -> None:
    """A new flight of a disc alone, from its state; what it was is kept."""
    game.kinds[i] = start_flight(
        room.states[i], game.discs[i], game.curves, t, room.work, game.flights[i]
    )
    game.group[i] = 0
    keep_flight(game, i)


@inlined
def stay(game: Game, i: int, t: float, room: Room) -> None:
    """A disc at rest, that others or a cushion may hold there."""
    room.states[i, VX] = room.states[i, VY] = room.states[i, SPIN] = 0.0
    game.kinds[i] = start_flight(
        room.states[i], game.discs[i], game.curves, t, room.work, game.flights[i]
    )
    keep_flight(game, i)


@inner
def drive_on(game: Game, i: int, t: float, room: Room) -> None:
    """The next straight piece of the way along which a disc is driven; at its end it stays."""
    piece, last = int(game.flights[i, FIRST_PIECE]), game.drives[i, 1]
    if game.kinds[i] == PATH:
        piece += 1
    start_flight(room.states[i], game.discs[i], game.curves, t, room.work, game.flights[i])
    if piece < last:
        row = game.pieces[piece]
        game.kinds[i] = PATH
        game.flights[i, FIRST_PIECE], game.flights[i, LAST_PIECE] = piece, piece + 1
        game.flights[i, UNTIL] = row[BEGINS] + row[DURATION]
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
def _contact_of(room: Room, count: int, i: int, j: int) -> bool:
    """Whether a contact is among those found."""
    for n in range(count):
        a, b = room.contacts[n, 0], room.contacts[n, 1]
        if (a == i and b == j) or (a == j and b == i):
            return True
    return False


@inner
def _touching(game: Game, t: float, room: Room) -> int:
    """All contacts of those marked, of those that they touch, and so on; how many."""
    count, discs = 0, game.discs
    grown = True
    while grown:
        grown = False
        for i in range(discs.shape[0]):
            if room.marks[i] != CONCERNED:
                continue
            room.marks[i] = LOOKED_AT
            # moments are rounded, and so are the gaps at them
            near = TOUCH * discs[i, RADIUS] + BLUR * t * game.pace[0]
            for k in range(game.obstacles.shape[0]):
                shape = int(game.obstacles[k, KIND])
                gap, _, _, there = normal_to(
                    game.obstacles[k], discs[i, RADIUS], room.states[i, X], room.states[i, Y]
                )
                if gap <= near and there and shape not in (POCKET, EDGE):
                    if count == room.contacts.shape[0]:
                        return -1
                    room.contacts[count, 0], room.contacts[count, 1] = i, -1 - k
                    count += 1
            for j in range(discs.shape[0]):
                if j == i or game.kinds[j] == GONE:
                    continue
                if room.marks[j] == NOT_CONCERNED:
                    _locate(game, j, t, room)
                reach = discs[i, RADIUS] + discs[j, RADIUS]
                dx = room.states[j, X] - room.states[i, X]
                dy = room.states[j, Y] - room.states[i, Y]
                if abs(dx) > 1.01 * reach or math.hypot(dx, dy) - reach > near:
                    continue
                if not _contact_of(room, count, i, j):
                    if count == room.contacts.shape[0]:
                        return -1
                    room.contacts[count, 0], room.contacts[count, 1] = min(i, j), max(i, j)
                    count += 1
                if room.marks[j] == NOT_CONCERNED:
                    room.marks[j], grown = CONCERNED, True
    for n in range(count):
        prepare_contact(game, room.contacts[n, 0], room.contacts[n, 1], room.states, room.rows[n])
    return count


@inlined
def _note_impacts(game: Game, t: float, count: int, room: Room) -> None:
    for n in range(count):
        row, i = room.rows[n], room.contacts[n, 0]
        if row[SUM_N] > 0.0:
            radius = game.discs[i, RADIUS]
            note(
                game, t, IMPACT, i, room.contacts[n, 1],
                room.states[i, X] + radius * row[NX], room.states[i, Y] + radius * row[NY],
            )  # fmt: skip
            event = game.events[game.counts[N_EVENTS] - 1]
            event[NORMAL_X], event[NORMAL_Y] = row[NX], row[NY]
            event[APPROACH], event[SLIDE] = row[FIRST_N], row[FIRST_T]
            event[PUSH], event[RUB], event[LOST] = row[SUM_N], row[SUM_T], row[LOSS]
            game.counts[N_IMPACTS] += 1


@inlined
def _moves(state: FloatArray) -> bool:
    return state[VX] != 0.0 or state[VY] != 0.0 or state[SPIN] != 0.0


@inlined
def _press_somewhere(game: Game, count: int, room: Room) -> bool:
    """Whether contacts that do not approach would, if all flew on alone; they are marked.

    If none would, no force acts in any: that is a solution, and accelerations have but one.
    """
    found = False
    for n in range(count):
        i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
        un, _ = approach(game, i, j, row[NX], row[NY], room.states)
        row[ACTS] = 1.0 if abs(un) <= HARDLY * game.pace[0] else 0.0
        # what neither presses nor parts is a group, too: alone, both would look for each other
        moves = _moves(room.states[i]) or (j >= 0 and _moves(room.states[j]))
        least = HARDLY * game.pace[1] if moves else -HARDLY * game.pace[1]
        if row[ACTS] > 0.0 and opening(game, i, j, row, room.states) < least:
            found = True
    return found


@inlined
def _leave(game: Game, i: int, t: float, what: int, k: int, room: Room) -> None:
    """A disc falls into a pocket or over an edge."""
    note(game, t, what, i, -1 - k, room.states[i, X], room.states[i, Y])
    room.states[i, VX] = room.states[i, VY] = room.states[i, SPIN] = 0.0
    start_flight(room.states[i], game.discs[i], game.curves, t, room.work, game.flights[i])
    game.kinds[i] = GONE
    game.group[i] = 0
    keep_flight(game, i)


@inner
def _happen(game: Game, i: int, partner: int, t: float, room: Room) -> int:
    """What comes next for a disc happens; those concerned are marked."""
    discs = game.discs
    for j in range(discs.shape[0]):
        room.marks[j] = NOT_CONCERNED
    _locate(game, i, t, room)
    room.marks[i] = CONCERNED
    if partner == LOOK_AGAIN:
        return REACHED
    if partner == PATH_ENDS and game.drives[i, 0] < game.drives[i, 1]:
        drive_on(game, i, t, room)
        _locate(game, i, t, room)
    for j in range(discs.shape[0]):
        with_i = game.group[j] > 0 and game.group[j] == game.group[i]
        with_partner = 0 <= partner < NOTHING and game.group[j] == game.group[partner] > 0
        if (with_i or with_partner or j == partner) and room.marks[j] == NOT_CONCERNED:
            _locate(game, j, t, room)
            room.marks[j] = CONCERNED
    if partner < 0:
        shape = int(game.obstacles[-1 - partner, KIND])
        if shape in (POCKET, EDGE):
            _leave(game, i, t, POCKETED if shape == POCKET else OVER_EDGE, -1 - partner, room)
            room.marks[i] = LOOKED_AT
    count = _touching(game, t, room)
    if count < 0:
        return CROWDED
    if collide(game, room.contacts, count, room.rows, room.before, room.states, room.shares) < 0:
        return TANGLED
    _note_impacts(game, t, count, room)
    # those that no impulse reached fly on
    for j in range(discs.shape[0]):
        with_them = game.group[j] > 0 and room.marks[j] > 0
        room.marks[j] = CONCERNED if with_them else NOT_CONCERNED
    room.marks[i] = CONCERNED
    for n in range(count):
        if room.rows[n, SUM_N] > 0.0:
            room.marks[room.contacts[n, 0]] = CONCERNED
            if room.contacts[n, 1] >= 0:
                room.marks[room.contacts[n, 1]] = CONCERNED
    return _go_on(game, t, count, room)


@inlined
def _go_on(game: Game, t: float, count: int, room: Room) -> int:
    """New flights of all that are concerned; PUSHING where some have to be integrated before."""
    game.counts[N_CONTACTS] = count
    pushes = _press_somewhere(game, count, room)
    for j in range(game.discs.shape[0]):
        pushes = pushes or (room.marks[j] == CONCERNED and is_integrated(game, j, room.states[j]))
    if pushes:
        return PUSHING
    _take_off_all(game, t, room)
    return REACHED


@inlined
def is_integrated(game: Game, i: int, state: FloatArray) -> bool:
    """Whether the motion of a disc from here, alone, is to be integrated."""
    disc = game.discs[i]
    if disc[INTEGRATED] == 0.0 or game.kinds[i] == GONE:
        return False
    return _moves(state) or math.hypot(game.pull[0], game.pull[1]) > disc[DECEL]


@inlined
def _take_off_all(game: Game, t: float, room: Room) -> None:
    """New flights of all that are concerned, but for those that are driven."""
    for j in range(game.discs.shape[0]):
        driven = game.drives[j, 0] < game.drives[j, 1]
        if room.marks[j] == CONCERNED and game.kinds[j] != GONE and not driven:
            _take_off(game, j, t, room)


@inner
def _send(game: Game, i: int, t: float, vx: float, vy: float, spin: float, room: Room) -> int:
    """Give a disc in play another velocity and spin: like an impact from outside."""
    for j in range(game.discs.shape[0]):
        room.marks[j] = NOT_CONCERNED
    if game.kinds[i] == GONE:
        return REACHED
    for j in range(game.discs.shape[0]):  # and whoever pushes it, or is pushed by it
        if j == i or (game.group[i] > 0 and game.group[j] == game.group[i]):
            _locate(game, j, t, room)
            room.marks[j] = CONCERNED
    room.states[i, VX], room.states[i, VY], room.states[i, SPIN] = vx, vy, spin
    note(game, t, STRUCK, i, i, room.states[i, X], room.states[i, Y])
    count = _touching(game, t, room)
    if count < 0:
        return CROWDED
    for j in range(game.discs.shape[0]):
        with_i = game.group[i] > 0 and game.group[j] == game.group[i]
        room.marks[j] = CONCERNED if j == i or with_i else NOT_CONCERNED
    return _go_on(game, t, count, room)


@inner
def _look_again(game: Game, t: float, room: Room) -> None:
    """What comes next for those marked, and for whoever was to meet one of them."""
    count = game.discs.shape[0]
    for i in range(count):
        partner = game.next_partner[i]
        alone = room.marks[i] == NOT_CONCERNED and 0 <= partner < NOTHING
        if alone and room.marks[partner] > 0:
            room.marks[i] = DISAPPOINTED
    for i in range(count):
        if room.marks[i] > 0:
            game.next_time[i], game.next_partner[i] = math.inf, NOTHING
    for i in range(count):
        if room.marks[i] > 0:
            look_ahead(game, i, t, room)


@inlined
def lacks_rows(game: Game, room: Room) -> bool:
    """Whether one event more may not find room."""
    return (
        game.counts[N_EVENTS] + 2 * room.contacts.shape[0] + 2 > game.events.shape[0]
        or game.counts[N_HISTORY] + game.discs.shape[0] + 1 > game.history.shape[0]
    )


@kernel
def advance(game: Game, until: float, struck: int, state: FloatArray, room: Room) -> int:
    """All that happens up to a time; how it ended.

    After FULL the caller gives more rows and calls again, after PAUSED it just calls again.

    ``struck``: the disc that gets the velocity and spin of ``state`` before; NOBODY; at the start,
    EVERYBODY looks ahead; after PUSHING, when the groups that push are on their way, THOSE_LEFT.
    """
    count = game.discs.shape[0]
    events = 0
    if struck != NOBODY:
        status = REACHED
        if struck == THOSE_LEFT:
            _take_off_all(game, game.clock[0], room)
        elif struck == EVERYBODY:
            for i in range(count):
                room.marks[i] = CONCERNED
            contacts = _touching(game, game.clock[0], room)
            if contacts < 0:
                return CROWDED
            for i in range(count):
                room.marks[i] = CONCERNED
            status = _go_on(game, game.clock[0], contacts, room)
        else:
            vx, vy, spin = state[VX], state[VY], state[SPIN]
            status = _send(game, struck, game.clock[0], vx, vy, spin, room)
        if status != REACHED:
            return status
        _look_again(game, game.clock[0], room)
    while True:
        first, t = count - 1, math.inf
        for i in range(count):
            # a driven disc turns before those that it pushes are asked where they go
            turns = game.next_partner[i] == PATH_ENDS and game.drives[i, 0] < game.drives[i, 1]
            if game.next_time[i] < t or (turns and game.next_time[i] == t):
                first, t = i, game.next_time[i]
        done, launch = game.counts[N_LAUNCHES], math.inf
        if done < game.launches.shape[0]:
            launch = game.launches[done, LAUNCH_TIME]
        if min(t, launch) > until or min(t, launch) == math.inf:
            if until < math.inf:
                game.clock[0] = max(until, game.clock[0])
            return REACHED
        if lacks_rows(game, room):
            return FULL
        if events == MOST_IN_A_CALL:
            return PAUSED
        events += 1
        due = min(t, launch)
        game.counts[N_AT_ONCE] = game.counts[N_AT_ONCE] + 1 if due == game.clock[0] else 0
        if game.counts[N_AT_ONCE] > MOST_AT_ONCE + 8 * count:
            return CROWDED
        if launch <= t:
            t, row = launch, game.launches[done]
            status = _send(
                game, int(row[LAUNCHED]), t, row[LAUNCH_VX], row[LAUNCH_VY], row[LAUNCH_SPIN], room
            )
            game.counts[N_LAUNCHES] += 1
        else:
            status = _happen(game, first, game.next_partner[first], t, room)
        game.clock[0] = t
        if status != REACHED:
            return status
        _look_again(game, t, room)


def room_for(discs: int) -> Room:
    """Room to work for so many discs: a disc touches six others at most of its size."""
    contacts = 6 * discs + 16
    return Room(
        np.zeros((discs, 6)), np.zeros((discs, 6)), np.zeros(discs, np.int64),
        np.zeros(discs, np.int64), np.zeros((contacts, 2), np.int64),
        np.zeros((contacts, CONTACT_COLUMNS)), np.zeros(ROOM), np.zeros(6), np.zeros(6),
    )  # fmt: skip
