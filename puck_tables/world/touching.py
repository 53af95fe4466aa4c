"""Who touches whom at an instant, and where that presses."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.scene.friction import X, Y
from puck_tables.world.departures import CONCERNED, LOOKED_AT, NOT_CONCERNED, Room, locate
from puck_tables.world.flight import GONE, PLACE_X, PLACE_Y, STILL, drifts
from puck_tables.world.footing import is_over_belts, outruns_law, over_floor, slips
from puck_tables.world.game import (
    Game,
)
from puck_tables.world.impact import (
    ACTS,
    NX,
    NY,
    approach,
    opening,
    prepare_contact,
)
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
from puck_tables.world.meeting import HARDLY, ROUNDED, TOUCH, normal_to, slack_of

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
def find_touching(game: Game, t: float, room: Room) -> int:
    """All contacts of those marked, of those that they touch, and so on; how many."""
    count, discs = 0, game.discs
    grown = True
    while grown:
        grown = False
        for i in range(discs.shape[0]):
            if room.marks[i] != CONCERNED:
                continue
            patience(1)
            room.marks[i] = LOOKED_AT
            # moments are rounded, and so are the gaps at them
            far = abs(room.states[i, X]) + abs(room.states[i, Y])
            near = TOUCH * discs[i, RADIUS] + BLUR * t * game.pace[0] + 2.0 * ROUNDED * far
            slack = slack_of(discs[i, RADIUS], room.states[i, X], room.states[i, Y])
            for k in range(game.obstacles.shape[0]):
                shape = int(game.obstacles[k, KIND])
                gap, _, _, there = normal_to(
                    game.obstacles[k], discs[i, RADIUS], room.states[i, X], room.states[i, Y],
                    slack,
                )  # fmt: skip
                if gap <= near and there and shape < NO_CUSHION:
                    if count == room.contacts.shape[0]:
                        return -1
                    room.contacts[count, 0], room.contacts[count, 1] = i, -1 - k
                    count += 1
            for j in range(discs.shape[0]):
                if j == i or game.kinds[j] == GONE:
                    continue
                reach = discs[i, RADIUS] + discs[j, RADIUS]
                if game.kinds[j] == STILL and not drifts(game.flights[j]):
                    flight = game.flights[j]
                    dx, dy = (
                        flight[PLACE_X] - room.states[i, X],
                        flight[PLACE_Y] - room.states[i, Y],
                    )
                    if abs(dx) > 1.01 * reach or abs(dy) > 1.01 * reach:
                        continue
                if room.marks[j] == NOT_CONCERNED:
                    locate(game, j, t, room)
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
def press_somewhere(game: Game, count: int, t: float, room: Room) -> bool:
    """Whether contacts that do not approach would, if all flew on alone; they are marked.

    If none would, no force acts in any: that is a solution, and accelerations have but one.
    """
    found = False
    for n in range(count):
        i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
        un, _ = approach(game, i, j, row[NX], row[NY], room.states)
        row[ACTS] = 1.0 if abs(un) <= HARDLY * game.pace[0] else 0.0
        # what neither presses nor parts is a group, too: alone, both would look for each other
        moves = slips(game.surface, game.discs[i], room.states[i])
        moves = moves or (j >= 0 and slips(game.surface, game.discs[j], room.states[j]))
        least = HARDLY * game.pace[1] if moves else -HARDLY * game.pace[1]
        if row[ACTS] > 0.0 and opening(game, i, j, t, row, room.states) < least:
            found = True
    return found


@inlined
def sets_off_too_fast(game: Game, i: int, state: FloatArray) -> bool:
    """Whether its rim slips faster than the friction law of the floor is known."""
    ux, uy, w = over_floor(game.surface, game.discs[i], state)
    free = game.discs[i, LIGHTNESS] > 0.0
    return free and outruns_law(game.regions, game.discs[i, RADIUS], ux, uy, w)


@inlined
def is_integrated(game: Game, i: int, state: FloatArray) -> bool:
    """Whether the motion of a disc from here, alone, is to be integrated, or may be."""
    disc = game.discs[i]
    if disc[INTEGRATED] == 0.0 or game.kinds[i] == GONE:
        return False
    if slips(game.surface, disc, state) or game.surface.spin != 0.0 or disc[TWIST] != 0.0:
        return True
    if is_over_belts(game.regions, game.discs, i):
        return True
    forced = game.spans[i, 0] < game.spans[i, 1]
    holds = disc[DECEL] if disc[INTEGRATED] == 1.0 else 0.0
    return forced or math.hypot(disc[PULL_X], disc[PULL_Y]) > holds
