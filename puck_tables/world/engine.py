"""From event to event: what comes next, who is concerned, where they fly then."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.world.borders import next_border
from puck_tables.world.departures import (
    CONCERNED,
    DISAPPOINTED,
    LOOKED_AT,
    NOT_CONCERNED,
    SENT,
    Room,
    cross,
    drive_on,
    integrate,
    lacks_pieces,
    leave,
    locate,
    note,
    note_impacts,
    overhang,
    take_off,
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
    GOT,
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
)
from puck_tables.world.layout import (
    EDGE,
    KIND,
    LIGHTNESS,
    ON_FLOOR,
    OVERHANG,
    POCKET,
    RADIUS,
    kinetic,
)
from puck_tables.world.meeting import are_apart, next_crossing, next_meeting, rest_together
from puck_tables.world.quiet import quieten
from puck_tables.world.touching import (
    find_touching,
    is_integrated,
    press_somewhere,
    sets_off_too_fast,
)

# how a call ends
REACHED, FULL, CROWDED, TANGLED, PAUSED, PUSHING, OFF_TABLE, TOO_SHORT = range(8)

NOBODY, EVERYBODY, THOSE_LEFT = -1, -2, -3
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
        if int(game.obstacles[k, KIND]) == OVERHANG and game.discs[i, LIGHTNESS] == 0.0:
            continue  # what is driven is carried
        if int(game.obstacles[k, KIND]) >= ON_FLOOR:
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
def _happen(
    game: Game, i: int, partner: int, t: float, room: Room, desk: FloatArray | None
) -> int:  # fmt: skip
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
            leave(game, i, t, POCKETED if shape == POCKET else OVER_EDGE, -1 - partner, room)
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
        if room.rows[n, SUM_N] > 0.0:
            room.marks[room.contacts[n, 0]] = CONCERNED
            if room.contacts[n, 1] >= 0:
                room.marks[room.contacts[n, 1]] = CONCERNED
    return _go_on(game, t, count, room, desk)


@inlined
def _go_on(game: Game, t: float, count: int, room: Room, desk: FloatArray | None) -> int:
    """New flights of all that are concerned.

    PUSHING: some push each other, or slip faster than the friction law is known: before, the caller
    does what is to be done.
    """
    game.counts[N_CONTACTS] = count
    if quieten(game, count, room):
        _whole_groups(game, count, room)
    pushes = press_somewhere(game, count, t, room)
    for j in range(game.discs.shape[0]):
        pushes = pushes or (
            room.marks[j] == CONCERNED and sets_off_too_fast(game, j, room.states[j])
        )
    return PUSHING if pushes else _take_off_all(game, t, room, desk)


@inlined
def _whole_groups(game: Game, count: int, room: Room) -> None:
    """Mark the groups of those concerned."""
    grown = True
    while grown:
        grown = False
        for n in range(count):
            i, j = room.contacts[n, 0], room.contacts[n, 1]
            if j < 0 or game.group[i] == 0 or game.group[i] != game.group[j]:
                continue
            if (room.marks[i] == CONCERNED) != (room.marks[j] == CONCERNED):
                room.marks[i] = room.marks[j] = CONCERNED
                grown = True


@inlined
def _take_off_all(game: Game, t: float, room: Room, desk: FloatArray | None) -> int:
    """New flights of all that are concerned and not driven; how it ended.

    FULL: not yet of all; TOO_SHORT: no step is short enough to follow one.
    """
    for j in range(game.discs.shape[0]):
        driven = game.drives[j, 0] < game.drives[j, 1]
        if room.marks[j] != CONCERNED or game.kinds[j] == GONE or driven:
            continue
        if desk is None:
            take_off(game, j, t, room)
        elif is_integrated(game, j, room.states[j]):
            if lacks_pieces(game):
                return FULL
            if not integrate(game, j, t, room, desk):
                return TOO_SHORT
        else:
            take_off(game, j, t, room)
        room.marks[j] = SENT
    return REACHED


@inner
def _send(
    game: Game, i: int, t: float, vx: float, vy: float, spin: float, room: Room,
    desk: FloatArray | None,
) -> int:  # fmt: skip
    """Give a disc in play another velocity and spin: like an impact from outside."""
    for j in range(game.discs.shape[0]):
        room.marks[j] = NOT_CONCERNED
    if game.kinds[i] == GONE:
        return REACHED
    for j in range(game.discs.shape[0]):  # and whoever pushes it, or is pushed by it
        if j == i or (game.group[i] > 0 and game.group[j] == game.group[i]):
            locate(game, j, t, room)
            room.marks[j] = CONCERNED
    disc, state = game.discs[i], room.states[i]
    before = kinetic(disc, state[VX], state[VY], state[SPIN])
    state[VX], state[VY], state[SPIN] = vx, vy, spin
    note(game, t, STRUCK, i, i, state[X], state[Y])
    game.events[game.counts[N_EVENTS] - 1, GOT] = kinetic(disc, vx, vy, spin) - before
    count = find_touching(game, t, room)
    if count < 0:
        return CROWDED
    for j in range(game.discs.shape[0]):
        with_i = game.group[i] > 0 and game.group[j] == game.group[i]
        room.marks[j] = CONCERNED if j == i or with_i else NOT_CONCERNED
    return _go_on(game, t, count, room, desk)


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
def advance(
    game: Game, until: float, struck: int, state: FloatArray, room: Room, desk: FloatArray | None
) -> int:  # fmt: skip
    """All that happens up to a time; how it ended.

    After FULL the caller gives more rows and calls again, after PAUSED it just calls again.

    ``struck``: the disc that gets the velocity and spin of ``state`` before; NOBODY; at the start,
    EVERYBODY looks ahead; after FULL, or after PUSHING when the groups that push are on their way,
    THOSE_LEFT set off.  ``desk``: to integrate on, see
    :func:`puck_tables.world.departures.desk_for`; None: nothing is.
    """
    count = game.discs.shape[0]
    events = 0
    if struck != NOBODY:
        status = REACHED
        if struck == THOSE_LEFT:
            status = _take_off_all(game, game.clock[0], room, desk)
        elif struck == EVERYBODY:
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
            status = _go_on(game, game.clock[0], contacts, room, desk)
        else:
            vx, vy, spin = state[VX], state[VY], state[SPIN]
            status = _send(game, struck, game.clock[0], vx, vy, spin, room, desk)
        if status != REACHED:
            return status
        _look_again(game, game.clock[0], room)
    while True:
        patience(1)
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
            t, row = launch, game.launches[done]
            status = _send(
                game, int(row[LAUNCHED]), t, row[LAUNCH_VX], row[LAUNCH_VY], row[LAUNCH_SPIN],
                room, desk,
            )  # fmt: skip
            game.counts[N_LAUNCHES] += 1
        else:
            status = _happen(game, first, game.next_partner[first], t, room, desk)
        game.clock[0] = t
        if status != REACHED:
            return status
        _look_again(game, t, room)
