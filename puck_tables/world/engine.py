"""From event to event: what comes next, who is concerned, where they fly then."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.world.borders import next_border
from puck_tables.world.contact_row import SUM_N, SUM_T, got_impulse
from puck_tables.world.contact_search import are_apart, next_contact, next_crossing, rest_together
from puck_tables.world.engine_state import (
    LAUNCH_I,
    LAUNCH_SPIN,
    LAUNCH_TIME,
    LAUNCH_VX,
    LAUNCH_VY,
    LOOK_AGAIN,
    N_AT_ONCE,
    N_CONTACTS,
    N_EVENTS,
    N_HISTORY,
    N_LAUNCHES,
    NOTHING,
    OVER_EDGE,
    PATH_ENDS,
    POCKETED,
    STRUCK,
    Engine,
)
from puck_tables.world.impact import TOO_FAST, collide
from puck_tables.world.layout import (
    EDGE,
    INV_MASS,
    KIND,
    NO_CUSHION,
    ON_FLOOR,
    OVERHANG,
    POCKET,
    RADIUS,
    kinetic,
)
from puck_tables.world.segment import (
    GONE,
    LOOKED_UP,
    PATH,
    STILL,
    UNTIL,
    corridor,
)  # fmt: skip
from puck_tables.world.segment_starts import (
    CURRENT,
    LOOKED_AT,
    PARTNER_STALE,
    STALE,
    Room,
    cross,
    drive_on,
    leave,
    locate,
    note_impacts,
    overhang,
)  # fmt: skip
from puck_tables.world.setting_off import (
    CROWDED,
    FULL,
    OFF_TABLE,
    PAUSED,
    REACHED,
    TANGLED,
    go_on,
    put,
    take_off_all,
)
from puck_tables.world.touching import find_touching, is_squeezed

NOBODY, EVERYBODY, THOSE_LEFT = -1, -2, -3  # who is concerned at once; else an event by hand
MOST_AT_ONCE = 1_000  # events at one moment
MOST_IN_A_CALL = 2_000  # then the caller may hear Ctrl-C


@inlined
def _earlier(engine: Engine, i: int, time: float, partner: int) -> None:
    """Note a meeting, or a moment to look again, if nothing comes before."""
    if time < 0.0:
        time, partner = -1.0 - time, LOOK_AGAIN
    if time < engine.next_time[i]:
        engine.next_time[i], engine.next_partner[i] = time, partner


@inner
def _look_at_board(engine: Engine, i: int, t: float, room: Room) -> None:
    """What comes next for a disc by itself: on its way, its floor and with what stands."""
    engine.next_time[i], engine.next_partner[i] = math.inf, NOTHING
    if engine.kinds[i] == PATH:
        _earlier(engine, i, engine.segments[i, UNTIL], PATH_ENDS)
    for k in range(engine.obstacles.shape[0]):
        shape, driven = int(engine.obstacles[k, KIND]), engine.discs[i, INV_MASS] == 0.0
        if driven and (shape == OVERHANG or shape < NO_CUSHION):
            continue  # what is driven is carried, and its way leads past cushions
        if shape >= ON_FLOOR:
            moment = next_border(engine, i, k, t, engine.next_time[i], room.work, room.one)
        else:
            moment = next_crossing(engine, i, k, t, engine.next_time[i], room.work, room.one)
        _earlier(engine, i, moment, -1 - k)


@inner
def _look_at_others(engine: Engine, i: int, t: float, room: Room) -> None:
    """Whom a disc meets next, if nothing comes before, also for them."""
    kind = engine.kinds[i]
    known = kind in (STILL, LOOKED_UP)
    mine = corridor(kind, engine.segments[i], engine.discs[i], room.one, math.inf, t)
    for j in range(engine.discs.shape[0]):
        if j == i or (j < i and room.marks[j] > 0):
            continue  # that one has looked
        other = engine.kinds[j]
        if known and other in (STILL, LOOKED_UP):  # most lie far from where this one goes
            if rest_together(kind, engine.segments[i], other, engine.segments[j]):
                continue
            reach = engine.discs[i, RADIUS] + engine.discs[j, RADIUS]
            far = corridor(other, engine.segments[j], engine.discs[j], room.one, math.inf, t)
            if are_apart(mine, far, reach):
                continue
        moment = next_contact(engine, i, j, t, engine.next_time[i], room.work, room.one, room.two)
        _earlier(engine, i, moment, j)
        _earlier(engine, j, moment, i)


@inner
def _happen(engine: Engine, i: int, partner: int, t: float, room: Room) -> int:
    """What comes next for a disc happens; those concerned are marked."""
    discs = engine.discs
    for j in range(discs.shape[0]):
        room.marks[j] = CURRENT
    locate(engine, i, t, room)
    room.marks[i] = STALE
    if partner == LOOK_AGAIN:
        return REACHED
    hangs = partner < 0 and int(engine.obstacles[-1 - partner, KIND]) == OVERHANG
    if hangs and overhang(engine, i, t, -1 - partner, room):
        return REACHED
    if partner == PATH_ENDS and engine.drives[i, 0] < engine.drives[i, 1]:
        drive_on(engine, i, t, room)
        locate(engine, i, t, room)
    for j in range(discs.shape[0]):
        with_i = engine.group[j] > 0 and engine.group[j] == engine.group[i]
        with_partner = 0 <= partner < NOTHING and engine.group[j] == engine.group[partner] > 0
        if (with_i or with_partner or j == partner) and room.marks[j] == CURRENT:
            locate(engine, j, t, room)
            room.marks[j] = STALE
    if partner < 0:
        shape = int(engine.obstacles[-1 - partner, KIND])
        if shape >= ON_FLOOR:
            cross(engine, i, t, -1 - partner, room)
        if shape in (POCKET, EDGE):
            leave(engine, i, t, POCKETED if shape == POCKET else OVER_EDGE, partner, room)
            room.marks[i] = LOOKED_AT
    count = find_touching(engine, t, room)
    if count < 0:
        return CROWDED
    squeezed = is_squeezed(engine, t, room.contacts, count, room.rows, room.states)
    rounds = collide(
        engine, t, room.contacts, count, room.rows, room.before, room.states, room.shares,
        room.buffer, squeezed,
    )  # fmt: skip
    if rounds < 0:
        engine.counts[N_CONTACTS] = count
        return OFF_TABLE if rounds == TOO_FAST else TANGLED
    for n in range(count):
        if not math.isfinite(room.rows[n, SUM_N] + room.rows[n, SUM_T]):
            return TANGLED
    note_impacts(engine, t, count, room)
    # those that no impulse reached fly on
    for j in range(discs.shape[0]):
        with_them = engine.group[j] > 0 and room.marks[j] > 0
        room.marks[j] = STALE if with_them else CURRENT
    room.marks[i] = STALE
    for n in range(count):
        if got_impulse(room.rows[n]):
            room.marks[room.contacts[n, 0]] = STALE
            if room.contacts[n, 1] >= 0:
                room.marks[room.contacts[n, 1]] = STALE
    return go_on(engine, t, count, room)


@inlined
def _launch(engine: Engine, row: FloatArray, t: float, room: Room) -> int:
    """A later launch of a disc, if it is still in play."""
    i = int(row[LAUNCH_I])
    for j in range(engine.discs.shape[0]):
        room.marks[j] = CURRENT
    if engine.kinds[i] == GONE:
        return REACHED
    room.marks[i] = STALE
    for column in range(VX):
        room.before[i, column] = math.nan
    room.before[i, VX], room.before[i, VY] = row[LAUNCH_VX], row[LAUNCH_VY]
    room.before[i, SPIN] = row[LAUNCH_SPIN]
    return put(engine, STRUCK, t, room)


@inner
def _look_again(engine: Engine, t: float, room: Room) -> None:
    """What comes next for those marked, and for whoever was to meet one of them."""
    count = engine.discs.shape[0]
    for i in range(count):
        partner = engine.next_partner[i]
        alone = room.marks[i] == CURRENT and 0 <= partner < NOTHING
        if alone and room.marks[partner] > 0:
            room.marks[i] = PARTNER_STALE
    for i in range(count):
        if room.marks[i] > 0:
            _look_at_board(engine, i, t, room)
    for i in range(count):
        if room.marks[i] > 0:
            patience(1)
            _look_at_others(engine, i, t, room)


@inlined
def lacks_rows(engine: Engine, room: Room) -> bool:
    """Whether one event more may not find room."""
    return (
        engine.counts[N_EVENTS] + 2 * room.contacts.shape[0] + 2 > engine.events.shape[0]
        or engine.counts[N_HISTORY] + engine.discs.shape[0] + 1 > engine.history.shape[0]
    )


@kernel
def advance(engine: Engine, until: float, first: int, room: Room) -> int:
    """All that happens up to a time; how it ended.

    After FULL the caller gives more rows and calls again, after PAUSED it just calls again.

    ``first``: what happens before.  An event by hand (STRUCK, PLACED, ...): those who are marked
    get their states, see :func:`puck_tables.world.setting_off.put`; NOBODY; at the start,
    EVERYBODY looks ahead; after FULL, or after PUSHING when the groups that push are on their way,
    THOSE_LEFT set off.
    """
    count = engine.discs.shape[0]
    events = 0
    if first != NOBODY:
        status = REACHED
        if first == THOSE_LEFT:
            status = take_off_all(engine, engine.clock[0], room)
        elif first == EVERYBODY:
            engine.scale[3] = 0.0
            for i in range(count):
                room.marks[i], state = STALE, room.states[i]
                energy = kinetic(engine.discs[i], state[VX], state[VY], state[SPIN])
                engine.scale[3] += energy
            contacts = find_touching(engine, engine.clock[0], room)
            if contacts < 0:
                return CROWDED
            for i in range(count):
                room.marks[i] = STALE
            status = go_on(engine, engine.clock[0], contacts, room)
        else:
            status = put(engine, first, engine.clock[0], room)
        if status != REACHED:
            return status
        _look_again(engine, engine.clock[0], room)
    while True:
        patience(1)
        who, t = count - 1, math.inf
        for i in range(count):
            # a driven disc turns before those that it pushes are asked where they go
            turns = (
                engine.next_partner[i] == PATH_ENDS and engine.drives[i, 0] < engine.drives[i, 1]
            )
            if engine.next_time[i] < t or (turns and engine.next_time[i] == t):
                who, t = i, engine.next_time[i]
        done, launch = engine.counts[N_LAUNCHES], math.inf
        if done < engine.launches.shape[0]:
            launch = engine.launches[done, LAUNCH_TIME]
        if min(t, launch) > until or min(t, launch) == math.inf:
            if until < math.inf:
                engine.clock[0] = max(until, engine.clock[0])
            return REACHED
        if lacks_rows(engine, room):
            for i in range(count):
                room.marks[i] = CURRENT
            return FULL
        if events == MOST_IN_A_CALL:
            return PAUSED
        events += 1
        due = min(t, launch)
        engine.counts[N_AT_ONCE] = engine.counts[N_AT_ONCE] + 1 if due == engine.clock[0] else 0
        if engine.counts[N_AT_ONCE] > MOST_AT_ONCE + 8 * count:
            return CROWDED
        if launch <= t:
            t = launch
            status = _launch(engine, engine.launches[done], t, room)
            engine.counts[N_LAUNCHES] += 1
        else:
            status = _happen(engine, who, engine.next_partner[who], t, room)
        engine.clock[0] = t
        if status != REACHED:
            return status
        _look_again(engine, t, room)
