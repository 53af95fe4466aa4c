"""Who touches whom at an instant, and where that presses."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.scene.friction import X, Y
from puck_tables.world.contact_row import ACTS, NX, NY, approach, opening, prepare_contact
from puck_tables.world.contact_search import HARDLY
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import is_over_belts, outruns_law, over_floor, slips
from puck_tables.world.layout import (
    DECEL,
    INTEGRATED,
    KIND,
    LIGHTNESS,
    NO_CUSHION,
    PULL_X,
    PULL_Y,
    RADIUS,
    TWIST,
)
from puck_tables.world.obstacle_shapes import ROUNDED, TOUCH, normal_to, slack_of
from puck_tables.world.segment import GONE, PLACE_X, PLACE_Y, STILL, drifts
from puck_tables.world.segment_starts import CONCERNED, LOOKED_AT, NOT_CONCERNED, Room, locate

BLUR = 1e-15  # of the time since the start, at full speed: another


@inlined
def _contact_of(room: Room, count: int, i: int, j: int) -> bool:
    """Whether a contact is among those found."""
    for n in range(count):
        a, b = room.contacts[n, 0], room.contacts[n, 1]
        if (a == i and b == j) or (a == j and b == i):
            return True
    return False


@inner
def find_touching(engine: Engine, t: float, room: Room) -> int:
    """All contacts of those marked, of those that they touch, and so on; how many."""
    count, discs = 0, engine.discs
    grown = True
    while grown:
        grown = False
        for i in range(discs.shape[0]):
            if room.marks[i] != CONCERNED:
                continue
            patience(1)
            room.marks[i] = LOOKED_AT
            for j in range(discs.shape[0]):  # a group ends its segments together
                if engine.group[j] == engine.group[i] > 0 and room.marks[j] == NOT_CONCERNED:
                    locate(engine, j, t, room)
                    room.marks[j], grown = CONCERNED, True
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
                if room.marks[j] == NOT_CONCERNED:
                    locate(engine, j, t, room)
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
        prepare_contact(engine, room.contacts[n, 0], room.contacts[n, 1], room.states, room.rows[n])
    return count


@inlined
def press_somewhere(engine: Engine, count: int, t: float, room: Room) -> bool:
    """Whether contacts that do not approach would, if all flew on alone; they are marked.

    If none would, no force acts in any: that is a solution, and accelerations have but one.
    """
    found = False
    for n in range(count):
        i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
        un, _ = approach(engine, i, j, row[NX], row[NY], room.states)
        row[ACTS] = 1.0 if abs(un) <= HARDLY * engine.scale[0] else 0.0
        # what neither presses nor parts is a group, too: alone, both would look for each other
        moves = slips(engine.surface, engine.discs[i], room.states[i])
        moves = moves or (j >= 0 and slips(engine.surface, engine.discs[j], room.states[j]))
        least = HARDLY * engine.scale[1] if moves else -HARDLY * engine.scale[1]
        if row[ACTS] > 0.0 and opening(engine, i, j, t, row, room.states) < least:
            found = True
    return found


@inlined
def sets_off_too_fast(engine: Engine, i: int, state: FloatArray) -> bool:
    """Whether its rim slips faster than the friction law of the floor is known."""
    ux, uy, w = over_floor(engine.surface, engine.discs[i], state)
    free = engine.discs[i, LIGHTNESS] > 0.0
    return free and outruns_law(engine.regions, engine.discs[i, RADIUS], ux, uy, w)


@inlined
def is_integrated(engine: Engine, i: int, state: FloatArray) -> bool:
    """Whether the motion of a disc from here, alone, is to be integrated, or may be."""
    disc = engine.discs[i]
    if disc[INTEGRATED] == 0.0 or engine.kinds[i] == GONE:
        return False
    if slips(engine.surface, disc, state) or engine.surface.spin != 0.0 or disc[TWIST] != 0.0:
        return True
    if is_over_belts(engine.regions, engine.discs, i):
        return True
    forced = engine.spans[i, 0] < engine.spans[i, 1]
    holds = disc[DECEL] if disc[INTEGRATED] == 1.0 else 0.0
    return forced or math.hypot(disc[PULL_X], disc[PULL_Y]) > holds
