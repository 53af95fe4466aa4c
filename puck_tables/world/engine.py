"""From event to event: what comes next, who is concerned, where they fly then."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.world.borders import next_border
from puck_tables.world.departures import (
    CONCERNED,
    DISAPPOINTED,
    LOOKED_AT,
    NOT_CONCERNED,
    Room,
    cross,
    drive_on,
    leave,
    locate,
    note_impacts,
    overhang,
)
from puck_tables.world.flight import (
    GONE,
    LOOKED_UP,
    PATH,
    STILL,
    UNTIL,
    corridor,
)
from puck_tables.world.game import (
    IMPACT,
    LAUNCH_SPIN,
    LAUNCH_TIME,
    LAUNCH_VX,
    LAUNCH_VY,
    LAUNCHED,
    LOOK_AGAIN,
    N_AT_ONCE,
    N_CONTACTS,
    N_EVENTS,
    N_HISTORY,
    N_LAUNCHES,
    NOTHING,
    OVER_EDGE,
    PARTNER,
    PATH_ENDS,
    POCKETED,
    STRUCK,
    TIME,
    WHAT,
    WHO,
    Game,
)
from puck_tables.world.impact import (
    FLAT,
    LASTING,
    NX,
    NY,
    PRESSED,
    SUM_N,
    SUM_T,
    TOO_FAST,
    E,
    approach,
    collide,
    was_hit,
)
from puck_tables.world.layout import (
    EDGE,
    KIND,
    LIGHTNESS,
    NO_CUSHION,
    ON_FLOOR,
    OVERHANG,
    POCKET,
    RADIUS,
    kinetic,
)
from puck_tables.world.meeting import are_apart, next_crossing, next_meeting, rest_together
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
from puck_tables.world.touching import find_touching

NOBODY, EVERYBODY, THOSE_LEFT = -1, -2, -3  # who is concerned at once; else an event by hand
SLOW = 1e-6  # of the scale of speeds: an impact that only what pushes brings about
MOST_BACK = 64  # events
MOST_AT_ONCE = 1_000  # events at one moment
MOST_IN_A_CALL = 2_000  # then the caller may hear Ctrl-C


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
        shape, driven = int(game.obstacles[k, KIND]), game.discs[i, LIGHTNESS] == 0.0
        if driven and (shape == OVERHANG or shape < NO_CUSHION):
            continue  # what is driven is carried, and its way leads past cushions
        if shape >= ON_FLOOR:
            found = next_border(game, i, k, t, game.next_time[i], room.work, room.one)
        else:
            found = next_crossing(game, i, k, t, game.next_time[i], room.work, room.one)
        _earlier(game, i, found, -1 - k)
    kind = game.kinds[i]
    known = kind in (STILL, LOOKED_UP)
    mine = corridor(kind, game.flights[i], game.discs[i], room.one, math.inf, t)
    for j in range(game.discs.shape[0]):
        other = game.kinds[j]
        if known and other in (STILL, LOOKED_UP):  # most lie far from where this one goes
            if rest_together(kind, game.flights[i], other, game.flights[j]):
                continue
            reach = game.discs[i, RADIUS] + game.discs[j, RADIUS]
            far = corridor(other, game.flights[j], game.discs[j], room.one, math.inf, t)
            if are_apart(mine, far, reach):
                continue
        if j != i:
            found = next_meeting(game, i, j, t, game.next_time[i], room.work, room.one, room.two)
            _earlier(game, i, found, j)
            _earlier(game, j, found, i)


@inlined
def _is_squeezed(game: Game, t: float, count: int, room: Room) -> bool:
    """Whether slow impacts follow so soon on the last of the same two that these never parted.

    So go on those that are squeezed by what pushes and rubs them, such as a disc between another
    one and a cushion: no single rebound of them dies out, and they would never end.
    """
    found, slow = False, SLOW * game.pace[0]
    for n in range(count):
        i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
        un, _ = approach(game, i, j, row[NX], row[NY], room.states)
        if un > slow:
            return False
        if un <= 0.0 or found:
            continue
        since, last = t - FLAT * game.discs[i, RADIUS] / un, math.inf
        for back in range(1, min(game.counts[N_EVENTS], MOST_BACK) + 1):
            event = game.events[game.counts[N_EVENTS] - back]
            if event[TIME] < since and not found:
                break
            if event[WHAT] == IMPACT and event[WHO] == i and event[PARTNER] == j:
                if found:  # each rebound lasts a share of the one before: what is left of them
                    hop, share = t - last, (t - last) / (last - event[TIME])
                    low = 8.0 * FLAT * game.discs[i, RADIUS] / (PRESSED * game.pace[1])
                    if row[E] > 0.0 and share < LASTING and hop * hop < low:
                        game.pace[4] += hop * share / (1.0 - share)
                    break
                found, last = True, event[TIME]
    return found


@inner
def _happen(game: Game, i: int, partner: int, t: float, room: Room) -> int:
    """What comes next for a disc happens; those concerned are marked."""
    discs = game.discs
    for j in range(discs.shape[0]):
        room.marks[j] = NOT_CONCERNED
    locate(game, i, t, room)
    room.marks[i] = CONCERNED
    if partner == LOOK_AGAIN:
        return REACHED
    if partner < 0 and int(game.obstacles[-1 - partner, KIND]) == OVERHANG:
        overhang(game, i, t, -1 - partner, room)
        return REACHED
    if partner == PATH_ENDS and game.drives[i, 0] < game.drives[i, 1]:
        drive_on(game, i, t, room)
        locate(game, i, t, room)
    for j in range(discs.shape[0]):
        with_i = game.group[j] > 0 and game.group[j] == game.group[i]
        with_partner = 0 <= partner < NOTHING and game.group[j] == game.group[partner] > 0
        if (with_i or with_partner or j == partner) and room.marks[j] == NOT_CONCERNED:
            locate(game, j, t, room)
            room.marks[j] = CONCERNED
    if partner < 0:
        shape = int(game.obstacles[-1 - partner, KIND])
        if shape >= ON_FLOOR:
            cross(game, i, t, -1 - partner, room)
        if shape in (POCKET, EDGE):
            leave(game, i, t, POCKETED if shape == POCKET else OVER_EDGE, partner, room)
            room.marks[i] = LOOKED_AT
    count = find_touching(game, t, room)
    if count < 0:
        return CROWDED
    squeezed = _is_squeezed(game, t, count, room)
    rounds = collide(
        game, t, room.contacts, count, room.rows, room.before, room.states, room.shares, squeezed
    )
    if rounds < 0:
        game.counts[N_CONTACTS] = count
        return OFF_TABLE if rounds == TOO_FAST else TANGLED
    for n in range(count):
        if not math.isfinite(room.rows[n, SUM_N] + room.rows[n, SUM_T]):
            return TANGLED
    note_impacts(game, t, count, room)
    # those that no impulse reached fly on
    for j in range(discs.shape[0]):
        with_them = game.group[j] > 0 and room.marks[j] > 0
        room.marks[j] = CONCERNED if with_them else NOT_CONCERNED
    room.marks[i] = CONCERNED
    for n in range(count):
        if was_hit(room.rows[n]):
            room.marks[room.contacts[n, 0]] = CONCERNED
            if room.contacts[n, 1] >= 0:
                room.marks[room.contacts[n, 1]] = CONCERNED
    return go_on(game, t, count, room)


@inlined
def _launch(game: Game, row: FloatArray, t: float, room: Room) -> int:
    """A later launch of a disc, if it is still in play."""
    i = int(row[LAUNCHED])
    for j in range(game.discs.shape[0]):
        room.marks[j] = NOT_CONCERNED
    if game.kinds[i] == GONE:
        return REACHED
    room.marks[i] = CONCERNED
    for column in range(VX):
        room.before[i, column] = math.nan
    room.before[i, VX], room.before[i, VY] = row[LAUNCH_VX], row[LAUNCH_VY]
    room.before[i, SPIN] = row[LAUNCH_SPIN]
    return put(game, STRUCK, t, room)


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
            patience(1)
            look_ahead(game, i, t, room)


@inlined
def lacks_rows(game: Game, room: Room) -> bool:
    """Whether one event more may not find room."""
    return (
        game.counts[N_EVENTS] + 2 * room.contacts.shape[0] + 2 > game.events.shape[0]
        or game.counts[N_HISTORY] + game.discs.shape[0] + 1 > game.history.shape[0]
    )


@kernel
def advance(game: Game, until: float, first: int, room: Room) -> int:
    """All that happens up to a time; how it ended.

    After FULL the caller gives more rows and calls again, after PAUSED it just calls again.

    ``first``: what happens before.  An event by hand (STRUCK, PLACED, ...): those who are marked
    get their states, see :func:`puck_tables.world.setting_off.put`; NOBODY; at the start,
    EVERYBODY looks ahead; after FULL, or after PUSHING when the groups that push are on their way,
    THOSE_LEFT set off.
    """
    count = game.discs.shape[0]
    events = 0
    if first != NOBODY:
        status = REACHED
        if first == THOSE_LEFT:
            status = take_off_all(game, game.clock[0], room)
        elif first == EVERYBODY:
            game.pace[3] = 0.0
            for i in range(count):
                room.marks[i], state = CONCERNED, room.states[i]
                given = kinetic(game.discs[i], state[VX], state[VY], state[SPIN])
                game.pace[3] += given
            contacts = find_touching(game, game.clock[0], room)
            if contacts < 0:
                return CROWDED
            for i in range(count):
                room.marks[i] = CONCERNED
            status = go_on(game, game.clock[0], contacts, room)
        else:
            status = put(game, first, game.clock[0], room)
        if status != REACHED:
            return status
        _look_again(game, game.clock[0], room)
    while True:
        patience(1)
        who, t = count - 1, math.inf
        for i in range(count):
            # a driven disc turns before those that it pushes are asked where they go
            turns = game.next_partner[i] == PATH_ENDS and game.drives[i, 0] < game.drives[i, 1]
            if game.next_time[i] < t or (turns and game.next_time[i] == t):
                who, t = i, game.next_time[i]
        done, launch = game.counts[N_LAUNCHES], math.inf
        if done < game.launches.shape[0]:
            launch = game.launches[done, LAUNCH_TIME]
        if min(t, launch) > until or min(t, launch) == math.inf:
            if until < math.inf:
                game.clock[0] = max(until, game.clock[0])
            return REACHED
        if lacks_rows(game, room):
            for i in range(count):
                room.marks[i] = NOT_CONCERNED
            return FULL
        if events == MOST_IN_A_CALL:
            return PAUSED
        events += 1
        due = min(t, launch)
        game.counts[N_AT_ONCE] = game.counts[N_AT_ONCE] + 1 if due == game.clock[0] else 0
        if game.counts[N_AT_ONCE] > MOST_AT_ONCE + 8 * count:
            return CROWDED
        if launch <= t:
            t = launch
            status = _launch(game, game.launches[done], t, room)
            game.counts[N_LAUNCHES] += 1
        else:
            status = _happen(game, who, game.next_partner[who], t, room)
        game.clock[0] = t
        if status != REACHED:
            return status
        _look_again(game, t, room)
