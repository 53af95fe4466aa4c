"""Who touches whom at an instant, and where that presses; which rebounds have died out.

Those that press on each other then stay in contact.  Where rebounds are lower than 1e-13 of the
radius, than 1e-14 of the places, or than a hundredth of the error of a step (in units of Q²/J),
they have died out.  Those of a disc that others squeeze follow each other, none of them the last:
they are told by how soon one comes after the other.  How long what dies out would have lasted is
kept: of one puck it is part of the error estimate.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.world.contact_row import ACTS, HOPS, NX, NY, E, approach, opening, prepare_contact
from puck_tables.world.contact_search import HARDLY, is_among
from puck_tables.world.engine_state import IMPACT, N_EVENTS, PARTNER, TIME, WHAT, WHO, Engine, Whole
from puck_tables.world.floor_under import is_over_belts, outruns_law, over_floor, slips
from puck_tables.world.layout import (
    DECEL,
    INTEGRATED,
    INV_MASS,
    KIND,
    NO_CUSHION,
    PULL_X,
    PULL_Y,
    RADIUS,
    ROUNDED,
    TOUCH,
    TWIST,
    normal_to,
    slack_of,
)
from puck_tables.world.segment import GONE, PLACE_X, PLACE_Y, STILL, drifts
from puck_tables.world.segment_starts import CURRENT, LOOKED_AT, STALE, Room, locate

BLUR = 1e-15  # of the time since the start, at full speed: another


@inner
def find_touching(engine: Engine, t: float, room: Room) -> int:
    """All contacts of those marked, of those that they touch, and so on; how many."""
    count, discs = 0, engine.discs
    grown = True
    while grown:
        grown = False
        for i in range(discs.shape[0]):
            if room.marks[i] != STALE:
                continue
            patience(1)
            room.marks[i] = LOOKED_AT
            for j in range(discs.shape[0]):  # a group ends its segments together
                if engine.group[j] == engine.group[i] > 0 and room.marks[j] == CURRENT:
                    locate(engine, j, t, room)
                    room.marks[j], grown = STALE, True
            # moments are rounded, and so are the gaps at them
            far = abs(room.states[i, X]) + abs(room.states[i, Y])
            near = TOUCH * discs[i, RADIUS] + BLUR * t * engine.scale[0] + 2.0 * ROUNDED * far
            slack = slack_of(discs[i, RADIUS], room.states[i, X], room.states[i, Y])
            for k in range(engine.obstacles.shape[0]):
                shape = int(engine.obstacles[k, KIND])
                gap, _, _, there = normal_to(
                    engine.obstacles[k], discs[i, RADIUS], room.states[i, X], room.states[i, Y],
                    slack,
                )  # fmt: skip
                if gap <= near and there and shape < NO_CUSHION:
                    if count == room.contacts.shape[0]:
                        return -1
                    room.contacts[count, 0], room.contacts[count, 1] = i, -1 - k
                    count += 1
            for j in range(discs.shape[0]):
                if j == i or engine.kinds[j] == GONE:
                    continue
                reach = discs[i, RADIUS] + discs[j, RADIUS]
                if engine.kinds[j] == STILL and not drifts(engine.segments[j]):
                    segment = engine.segments[j]
                    dx = segment[PLACE_X] - room.states[i, X]
                    dy = segment[PLACE_Y] - room.states[i, Y]
                    if abs(dx) > 1.01 * reach or abs(dy) > 1.01 * reach:
                        continue
                if room.marks[j] == CURRENT:
                    locate(engine, j, t, room)
                dx = room.states[j, X] - room.states[i, X]
                dy = room.states[j, Y] - room.states[i, Y]
                if abs(dx) > 1.01 * reach or math.hypot(dx, dy) - reach > near:
                    continue
                if not is_among(room.contacts, count, i, j):
                    if count == room.contacts.shape[0]:
                        return -1
                    room.contacts[count, 0], room.contacts[count, 1] = min(i, j), max(i, j)
                    count += 1
                if room.marks[j] == CURRENT:
                    room.marks[j], grown = STALE, True
    for n in range(count):
        prepare_contact(engine, room.contacts[n, 0], room.contacts[n, 1], room.states, room.rows[n])
    return count


@inlined
def press_somewhere(engine: Engine, count: int, t: float, room: Room) -> bool:
    """Whether contacts that do not approach would, if all flew on alone; they are marked.

    If none would, no force acts in any: that is a solution, and accelerations have but one.
    """
    pressed = False
    for n in range(count):
        i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
        un, _ = approach(engine, i, j, row[NX], row[NY], room.states)
        row[ACTS] = 1.0 if abs(un) <= HARDLY * engine.scale[0] else 0.0
        # what neither presses nor parts is a group, too: alone, both would look for each other
        moves = slips(engine, i, room.states[i])
        moves = moves or (j >= 0 and slips(engine, j, room.states[j]))
        least = HARDLY * engine.scale[1] if moves else -HARDLY * engine.scale[1]
        if row[ACTS] > 0.0 and opening(engine, i, j, t, row, room.states) < least:
            pressed = True
    return pressed


@inlined
def sets_off_too_fast(engine: Engine, i: int, state: FloatArray) -> bool:
    """Whether its rim slips faster than the friction law of the floor is known."""
    ux, uy, w = over_floor(engine, i, state)
    return engine.discs[i, INV_MASS] > 0.0 and outruns_law(engine, i, ux, uy, w)


@inlined
def is_integrated(engine: Engine, i: int, state: FloatArray) -> bool:
    """Whether the motion of a disc from here, alone, is to be integrated, or may be."""
    disc = engine.discs[i]
    if disc[INTEGRATED] == 0.0 or engine.kinds[i] == GONE:
        return False
    if slips(engine, i, state) or engine.surface.spin != 0.0 or disc[TWIST] != 0.0:
        return True
    if is_over_belts(engine, i):
        return True
    forced = engine.spans[i, 0] < engine.spans[i, 1]
    holds = disc[DECEL] if disc[INTEGRATED] == 1.0 else 0.0
    return forced or math.hypot(disc[PULL_X], disc[PULL_Y]) > holds


_FLAT = 1e-13  # of the radius: rebounds as low have died out,
_LOW = 1e-14  # of the places: as these, whose height is rounding,
_LEAST = 1e-2  # and of the error of a step, in units of Q²/J
_LASTING = 0.99  # of the rebound before, at most: so long is the next one taken to be
_PRESSED = 1e-3  # of the scale of accelerations: what presses less brings no rebounds to an end
_SLOW = 1e-6  # of the scale of speeds: an impact that only what pushes brings about
MOST_BACK = 64  # events


@inlined
def _slip2(engine: Engine, i: int, states: FloatArray) -> float:
    """Q² of a disc over the floor."""
    vx, vy, spin = over_floor(engine, i, states[i])
    rim = engine.discs[i, RADIUS] * spin
    return vx**2 + vy**2 + rim * rim


@inlined
def _lasting(
    engine: Engine, i: int, j: int, t: float, row: FloatArray, states: FloatArray, un: float,
    rising: float,
) -> float:  # fmt: skip
    """How long rebounds from an obstacle would last, of which the first begins at un.

    They are braked by ``rising`` on the way up; on the way down the rims and the floor rub back.
    """
    for side in range(2):  # there and back
        turn = (2.0 - 4.0 * side) * un
        states[i, VX] += turn * row[NX]
        states[i, VY] += turn * row[NY]
        if side == 0:
            falling = -opening(engine, i, j, t, row, states)
    if falling <= 0.0 or rising <= _PRESSED * engine.scale[1]:
        return 0.0
    share = math.sqrt(falling / rising)
    return un / rising * (1.0 + 1.0 / share) / (1.0 - min(row[E] * share, _LASTING))


@inlined
def dies_out(engine: Engine, i: int, j: int, t: float, row: FloatArray, states: FloatArray) -> bool:
    """Whether both press on each other so that this rebound and those after it are too low."""
    if row[E] >= 1.0:
        return False
    un, _ = approach(engine, i, j, row[NX], row[NY], states)
    closing = -opening(engine, i, j, t, row, states)
    slip2 = _slip2(engine, i, states)
    if j >= 0:
        slip2 = max(slip2, _slip2(engine, j, states))
    rounded = _LOW * (abs(states[i, X]) + abs(states[i, Y]))
    least = _LEAST * engine.scale[2] * slip2 / engine.scale[1]
    height = max(rounded, _FLAT * engine.discs[i, RADIUS], least)
    if closing <= 0.0 or un > 0.0 or un * un > 2.0 * closing * height:
        return False
    if j < 0:
        engine.scale[4] += _lasting(engine, i, j, t, row, states, -un, closing)
    return True


@inlined
def is_squeezed(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, states: FloatArray
) -> bool:
    """Whether slow impacts follow so soon on the last of the same two that these never parted.

    So go on those that are squeezed by what pushes and rubs them, such as a disc between another
    one and a cushion: no single rebound of them dies out, and they would never end.  HOPS of a row
    tells who meets whom so.
    """
    slow, since = _SLOW * engine.scale[0], math.inf
    for n in range(count):
        i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
        un, _ = approach(engine, i, j, row[NX], row[NY], states)
        if un > slow:
            return False
        row[HOPS] = 1.0 if un > 0.0 else 0.0
        if un <= 0.0 or since < t:
            continue
        early, last = t - _FLAT * engine.discs[i, RADIUS] / un, math.inf
        for back in range(1, min(engine.counts[N_EVENTS], MOST_BACK) + 1):
            event = engine.events[engine.counts[N_EVENTS] - back]
            if event[TIME] < early and since == math.inf:
                break
            if event[WHAT] == IMPACT and event[WHO] == i and event[PARTNER] == j:
                if since < t:  # each rebound lasts a share of the one before: what is left of them
                    hop, share = t - last, (t - last) / (last - event[TIME])
                    low = 8.0 * _FLAT * engine.discs[i, RADIUS] / (_PRESSED * engine.scale[1])
                    if row[E] > 0.0 and share < _LASTING and hop * hop < low:
                        engine.scale[4] += hop * share / (1.0 - share)
                    break
                since, last = early, event[TIME]
    if since == math.inf:
        return False
    for back in range(1, min(engine.counts[N_EVENTS], MOST_BACK) + 1):
        event = engine.events[engine.counts[N_EVENTS] - back]
        if event[TIME] < since:
            break
        for n in range(count):
            i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
            if event[WHAT] == IMPACT and event[WHO] == i and event[PARTNER] == j:
                un, _ = approach(engine, i, j, row[NX], row[NY], states)
                row[HOPS] = 1.0 if un >= -slow else 0.0
    return True
