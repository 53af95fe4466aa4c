"""Discs that push each other: who they are, and the paths on which they go until that changes.

The engine says when contacts press; here those that do become groups, each is followed
(:mod:`puck_tables.world.group_paths`), and its paths become the segments of its discs.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined, inner, on_demand
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.world.contact_row import ACTS, NX, NY
from puck_tables.world.engine_state import (
    CONTACT,
    LOST,
    N_CONTACTS,
    N_EVENTS,
    N_GROUPS,
    N_HELD,
    N_HISTORY,
    N_PIECES,
    N_WORK_ROWS,
    TIPS,
    Engine,
    Whole,
)
from puck_tables.world.group_paths import Workplace, paths_of
from puck_tables.world.layout import INV_MASS, RADIUS, kinetic, write_over
from puck_tables.world.lone import LONGEST
from puck_tables.world.paths import BEGINS, DURATION, FIRST, FOR_EVER
from puck_tables.world.segment import ANGLE, FIRST_PIECE, PATH, PLACE_X, PLACE_Y
from puck_tables.world.segment_starts import (
    CURRENT,
    SENT,
    STALE,
    Room,
    fly_along,
    keep_segment,
    leave,
    loses_balance,
    note,
    stay,
)  # fmt: skip
from puck_tables.world.setting_off import FULL, REACHED, TANGLED
from puck_tables.world.step_ledger import (
    BACK_X,
    BACK_Y,
    DONE,
    LED_BY,
    LEDGER,
    NO_SEGMENT,
    NONE,
    RIM_HEAT,
    SEGMENT,
    SEVERAL,
    WORK_START,
)

LOST_SHARE = 1e-15  # of the energy of free pucks: less lost as rims grip is rounding
_PRESSES, _PRESSED = 1.0, 2.0  # ACTS of a contact: now, and before already


@on_demand("int64")
def push_on(engine: Engine, room: Room, place: Workplace) -> int:
    """Send the groups that push now on their way; marks say who is left to fly alone.

    FULL: nothing was done, for there may be too few rows; TANGLED: it is no motion.
    """
    t, rows = engine.clock[0], _find_groups(engine, room) * (LONGEST + 1)
    lacks_rows = engine.counts[N_WORK_ROWS] + rows > engine.work_rows.shape[0]
    if lacks_rows or engine.counts[N_PIECES] + rows > engine.pieces.shape[0]:
        return FULL
    _let_go(engine, room)
    _look_at_driven(engine, t, place)
    for first in range(engine.discs.shape[0]):
        size, contacts = _gather(engine, first, room, place)
        if contacts > 0 and not _send(engine, t, size, contacts, room, place):
            return TANGLED
    return REACHED


@inlined
def _find_groups(engine: Engine, room: Room) -> int:
    """Give all discs that contacts join the number of the first; how many press on something."""
    grouped, count = room.shares, 0
    for i in range(grouped.shape[0]):
        grouped[i] = -1
    for n in range(engine.counts[N_CONTACTS]):
        for m in range(2):
            i = room.contacts[n, m]
            if room.rows[n, ACTS] > 0.0 and i >= 0 and grouped[i] < 0:
                grouped[i] = i
                count += 1
    grown = True
    while grown:
        grown = False
        for n in range(engine.counts[N_CONTACTS]):
            i, j = room.contacts[n, 0], room.contacts[n, 1]
            if room.rows[n, ACTS] > 0.0 and j >= 0 and grouped[i] != grouped[j]:
                grouped[i] = grouped[j] = min(grouped[i], grouped[j])
                grown = True
    return count


@inlined
def _let_go(engine: Engine, room: Room) -> None:
    """Contacts held no more are forgotten; those that press remember whether they did before."""
    for n in range(engine.counts[N_CONTACTS]):
        row = room.rows[n]
        for k in range(engine.counts[N_HELD]):
            i, j = engine.held[k, 0], engine.held[k, 1]
            same = i == room.contacts[n, 0] and j == room.contacts[n, 1]
            if same and engine.group[i] > 0 and row[ACTS] > 0.0:
                row[ACTS] = _PRESSED
    for i in range(engine.discs.shape[0]):
        if room.marks[i] == STALE:
            engine.group[i] = 0
    left = 0
    for k in range(engine.counts[N_HELD]):
        if engine.group[engine.held[k, 0]] > 0:  # others fly alone
            write_over(engine.held[left], engine.held[k])
            left += 1
    engine.counts[N_HELD] = left


@inlined
def _look_at_driven(engine: Engine, t: float, place: Workplace) -> None:
    """The piece on which each driven disc is now, or at whose end it stays."""
    for i in range(engine.discs.shape[0]):
        if engine.drives[i, 0] >= engine.drives[i, 1]:
            continue
        place.engine.drives[i, 0], place.engine.drives[i, 1] = i, i + 1
        row, segment = place.engine.pieces[i], engine.segments[i]
        if engine.kinds[i] == PATH:
            write_over(row, engine.pieces[int(segment[FIRST_PIECE])])
        else:
            row[BEGINS], row[DURATION] = t, FOR_EVER
            for end in (FIRST, FIRST + 9):
                row[end], row[end + 1], row[end + 2] = (
                    segment[PLACE_X], segment[PLACE_Y], segment[ANGLE],
                )  # fmt: skip


@inlined
def _gather(engine: Engine, first: int, room: Room, place: Workplace) -> tuple[int, int]:
    """The members and contacts of the group of which a disc is the first; how many."""
    size = contacts = 0
    for i in range(engine.discs.shape[0]):
        if room.shares[i] == first:
            place.members[size] = i
            size += 1
    for n in range(engine.counts[N_CONTACTS]):
        if room.rows[n, ACTS] > 0.0 and room.shares[room.contacts[n, 0]] == first:
            write_over(place.contacts[contacts], room.contacts[n])
            place.contacts[contacts, 2] = n
            contacts += 1
    return size, contacts


@inner
def _send(engine: Engine, t: float, size: int, contacts: int, room: Room, place: Workplace) -> bool:
    """Follow a group, and note its contacts, paths and works; whether there is a motion."""
    members, states, jump, alone = place.members[:size], room.states, place.jump, True
    for c in range(contacts):
        alone = alone and place.contacts[c, 1] >= 0
    first_row = place.contacts[0, 2]
    for i in range(states.shape[0]):
        write_over(room.before[i], states[i])
    jump[:] = 0.0
    kept, t_end, count = paths_of(engine, t, size, contacts, states, place)
    if kept < 0:
        return _tips(engine, t, members, room)
    _note_contacts(engine, t, kept, first_row, room, place)
    led = NONE
    for i in members:
        if engine.discs[i, INV_MASS] == 0.0:
            led = i if led == NONE else SEVERAL
    if jump[RIM_HEAT] != 0.0 and led >= 0 and alone:  # no cushion shares it
        jump[BACK_X] = jump[BACK_Y] = 0.0
        for i in members:
            if engine.discs[i, INV_MASS] > 0.0:
                for m in range(2):
                    change = room.before[i, VX + m] - states[i, VX + m]
                    jump[BACK_X + m] += change / engine.discs[i, INV_MASS]
    jump[RIM_HEAT] = 0.0  # the event has it
    for i in members:  # a rim that gripped at once has changed what touches it, too
        for column in range(6):
            if room.marks[i] == CURRENT and states[i, column] != room.before[i, column]:
                room.marks[i] = STALE
    segment = NO_SEGMENT
    if kept > 0:
        segment = _set_out(engine, t, t_end, size, count, room, place)
        for c in range(kept):
            write_over(engine.held[engine.counts[N_HELD]], room.contacts[place.contacts[c, 2]])
            engine.counts[N_HELD] += 1
    _book(engine, segment, t, count, led, place)
    return True


@inner
def _tips(engine: Engine, t: float, members: Whole, room: Room) -> bool:
    """Whether it is one of those who press that has no motion, for it tips; others are let go."""
    tipped = False
    for i in members:
        write_over(room.states[i], room.before[i])
    for i in members:
        if engine.discs[i, INV_MASS] > 0.0 and loses_balance(engine, i, t, room):
            leave(engine, i, t, TIPS, i, room)
            room.marks[i], tipped = SENT, True
    return tipped


@inlined
def _set_out(
    engine: Engine, t: float, t_end: float, size: int, count: int, room: Room, place: Workplace
) -> int:
    """The segments of a group along its paths, which are kept; that of one of them."""
    engine.counts[N_GROUPS] += 1
    segment = NO_SEGMENT
    for k in range(size):
        i = place.members[k]
        engine.group[i] = engine.counts[N_GROUPS]
        if engine.drives[i, 0] < engine.drives[i, 1]:
            continue  # it stays on its own way
        room.marks[i] = SENT
        if t_end == math.inf:
            stay(engine, i, t, room)
        else:
            first = engine.counts[N_PIECES]
            for row in range(count):
                write_over(engine.pieces[first + row], place.pieces[k, row])
            engine.counts[N_PIECES] += count
            fly_along(engine.segments[i], engine.pieces, first, first + count, t, t_end)
            engine.kinds[i] = PATH
            keep_segment(engine, i)
        segment = engine.counts[N_HISTORY] - 1
    return segment


@inlined
def _book(engine: Engine, segment: int, t: float, count: int, led: int, place: Workplace) -> None:
    """Keep what was worked on a segment from t on, and at its start, perhaps led by a disc."""
    jumps = False
    for column in range(LEDGER):
        jumps = jumps or place.jump[column] != 0.0
    first = engine.counts[N_WORK_ROWS]
    if jumps:
        row = engine.work_rows[first]
        row[:] = 0.0
        row[WORK_START], row[SEGMENT], row[LED_BY] = t, segment, led
        write_over(row[DONE:], place.jump)
        first += 1
    for k in range(count):
        row = engine.work_rows[first + k]
        write_over(row, place.work_rows[k])
        row[SEGMENT], row[LED_BY] = segment, led
    engine.counts[N_WORK_ROWS] = first + count


@inlined
def _note_contacts(
    engine: Engine, t: float, kept: int, first_row: int, room: Room, place: Workplace
) -> None:
    """Write down the contacts that are new, and what was lost where rims gripped at once."""
    lost, energy, fresh = place.jump[RIM_HEAT], 0.0, 0
    for c in range(kept):
        fresh += room.rows[place.contacts[c, 2], ACTS] == _PRESSES
    for i in range(engine.discs.shape[0]):
        at = room.before[i]
        energy += kinetic(engine.discs[i], at[VX], at[VY], at[SPIN])
    once = fresh == 0 and abs(lost) > LOST_SHARE * energy
    for c in range(1 if once else kept):
        n = first_row if once else place.contacts[c, 2]
        if once or room.rows[n, ACTS] == _PRESSES:
            i, radius = room.contacts[n, 0], engine.discs[room.contacts[n, 0], RADIUS]
            note(
                engine, t, CONTACT, i, room.contacts[n, 1],
                room.states[i, X] + radius * room.rows[n, NX],
                room.states[i, Y] + radius * room.rows[n, NY],
            )  # fmt: skip
            engine.events[engine.counts[N_EVENTS] - 1, LOST] = lost
            lost = 0.0
