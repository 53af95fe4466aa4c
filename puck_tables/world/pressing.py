"""What holds at an instant: which contacts press, which rims stick, which discs stay at rest."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.scene.friction import SPIN, VX
from puck_tables.world.complementarity import rim_mode
from puck_tables.world.footing import choose_belt, over_floor
from puck_tables.world.forces import (
    can_rest,
    count_rows,
    gain_of,
    place_driven,
    rest_on_floor,
    slip_of,
)
from puck_tables.world.group import (
    APART,
    APPROACH,
    DRIVEN,
    GAINS,
    GRIP,
    HELD,
    MOVES,
    STICKS,
    STILL,
    TIME_UP,
    UNSOLVED,
    YIELDS,
    Desk,
    Group,
    IntArray,
    Scales,
    find_places,
    small_slip,
)
from puck_tables.world.layout import LIGHTNESS, RADIUS, TURNABILITY
from puck_tables.world.meeting import HARDLY
from puck_tables.world.putting_right import stop_slips
from puck_tables.world.sights import look, look_at_ties
from puck_tables.world.works import DRIVE_WORK, RIM_HEAT
from puck_tables.world.yielding import settle

_CREEPS = 8  # rounds
_SAME = 0.9  # the cosine between directions that are the same


@inlined
def _energy(group: Group, members: IntArray, y: FloatArray) -> float:
    """Kinetic energy of those that can move."""
    total = 0.0
    for place in range(members.shape[0]):
        disc = group.discs[members[place]]
        if disc[LIGHTNESS] > 0.0:
            square = y[place, VX] ** 2 + y[place, VX + 1] ** 2
            total += 0.5 * (square / disc[LIGHTNESS] + y[place, SPIN] ** 2 / disc[TURNABILITY])
    return total


@inlined
def _goes_on(group: Group, number: int, place: int, scales: Scales, desk: Desk) -> bool:
    """Whether a small slip, if there is one, grows in the direction that it has."""
    y, way, radius = desk.states[0, place], desk.ways[place], group.discs[number, RADIUS]
    slip = slip_of(group, number, y)
    vx, vy, spin = over_floor(group.surface, group.discs[number], y)
    along = way[0] * vx + way[1] * vy + radius * radius * way[2] * spin
    gains = gain_of(group, number, place, desk) > GAINS * scales.rate
    return slip == 0.0 or (gains and along > _SAME * slip)


@inlined
def _stop_creeping(
    group: Group, members: IntArray, contacts: int, modes: IntArray, y: FloatArray,
    scales: Scales, desk: Desk,
) -> float:  # fmt: skip
    """Take out approaches of what touches without pressing that are mere rounding; the heat.

    What has just been put to rest leaves such to its neighbours, which would creep into it.
    """
    stopped, heat = desk.modes[1, :contacts], 0.0
    for _ in range(_CREEPS):
        look(group, members, desk.pairs[:contacts], y, desk.sights)
        again = False
        for c in range(contacts):
            comes = desk.sights[c, APPROACH]
            if modes[c] == APART and stopped[c] == APART and 0.0 < comes <= HARDLY * scales.speed:
                stopped[c], again = 1, True
        if not again:
            break
        heat += stop_slips(desk, stopped, y)
    return heat


@inlined
def _let_go(
    group: Group, members: IntArray, modes: IntArray, doings: IntArray, y: FloatArray,
    scales: Scales, desk: Desk,
) -> bool:  # fmt: skip
    """Forces where rims without bound on their friction leave none; whether found.

    Such rims then grip where they press without a grip, or else nowhere: the others are smooth.
    """
    count = modes.shape[0]
    sights, seen = desk.sights, desk.midway
    look(group, members, desk.pairs[:count], y, seen)
    for attempt in range(2):
        for c in range(count):
            if seen[c, GRIP] == math.inf:
                sights[c, GRIP] = 0.0
                modes[c] = rim_mode(sights[c], scales.speed)
        if not settle(group, members, modes, doings, y, scales, desk):
            return False
        if attempt == 0:
            for c in range(count):
                still = seen[c, GRIP] == math.inf and rim_mode(seen[c], scales.speed) == STICKS
                if still and modes[c] != APART:
                    sights[c, GRIP], modes[c] = math.inf, STICKS
            if settle(group, members, modes, doings, y, scales, desk):
                return True
    return True


@kernel
def press(
    group: Group, members: IntArray, contacts: IntArray, states: FloatArray, t: float,
    scales: Scales, modes: IntArray, doings: IntArray, ledger: FloatArray, desk: Desk,
) -> int:  # fmt: skip
    """See which of the contacts press, which rims stick and which members are at rest.

    Parameters
    ----------
    members : (m,) numbers of discs; contacts : (c, 2) see :mod:`puck_tables.world.layout`
        Contacts touch, and approach no more than by rounding.
    states : (n, 6) of all discs at t in the laboratory, m, rad, m/s, rad/s
        Changed by rounding: who is as good as at rest is put to rest, who presses approaches no
        more.  Rims that press and have friction without bound are stopped at once: then contacts
        that are APART may approach.
    modes : (c,) and doings : (m,), the answer, see :mod:`puck_tables.world.group`
    ledger : (8,) J, to which the heat of what is stopped is added

    Returns
    -------
    TIME_UP, or UNSOLVED where no forces satisfy all conditions
    """
    count = members.shape[0]
    find_places(members, contacts, desk)
    pairs, y = desk.pairs[: contacts.shape[0]], desk.states[0]
    for place in range(count):
        number = members[place]
        for i in range(6):
            y[place, i] = states[number, i]
        doings[place] = MOVES
        choose_belt(group.regions, group.discs, number, y[place])
        if group.discs[number, LIGHTNESS] == 0.0:
            doings[place] = DRIVEN
        elif can_rest(group, number):
            q = slip_of(group, number, y[place])
            if q <= STILL * scales.speed:
                doings[place] = HELD
                rest_on_floor(group, number, y[place])
            elif q <= small_slip(scales):
                doings[place] = YIELDS
                vx, vy, spin = over_floor(group.surface, group.discs[number], y[place])
                way = desk.ways[place]
                way[0], way[1], way[2] = vx / q, vy / q, spin / q
    count_rows(group, members, t, desk)
    place_driven(group, members, doings, t, y, desk)
    stopped, again = desk.modes[1, : contacts.shape[0]], True
    while again:
        patience(1)
        look(group, members, pairs, y, desk.sights)
        look_at_ties(group, members, t, y, desk)
        for c in range(contacts.shape[0]):
            modes[c] = rim_mode(desk.sights[c], scales.speed)
            stopped[c] = STICKS
            if modes[c] != STICKS and desk.sights[c, GRIP] == math.inf:
                desk.sights[c, GRIP], stopped[c] = 0.0, APART  # first it is seen whether it presses
        found = settle(group, members, modes, doings, y, scales, desk)
        if not found and not _let_go(group, members, modes, doings, y, scales, desk):
            return UNSOLVED
        again = False
        for place in range(count):
            if doings[place] == YIELDS and not _goes_on(group, members[place], place, scales, desk):
                doings[place], again = MOVES, True
        if again:
            continue
        for c in range(contacts.shape[0]):
            if stopped[c] == APART and modes[c] != APART:
                desk.sights[c, GRIP], stopped[c], again = math.inf, STICKS, True
            elif modes[c] == APART or rim_mode(desk.sights[c], scales.speed) != STICKS:
                stopped[c] = modes[c]
        before = _energy(group, members, y)
        heat = stop_slips(desk, stopped, y)
        ledger[RIM_HEAT] += heat
        ledger[DRIVE_WORK] += heat + _energy(group, members, y) - before
    ledger[RIM_HEAT] += _stop_creeping(group, members, contacts.shape[0], modes, y, scales, desk)
    goes = False
    for place in range(count):
        if doings[place] == YIELDS:
            goes = goes or gain_of(group, members[place], place, desk) > GAINS * scales.rate
    for place in range(count):
        number = members[place]
        if doings[place] == YIELDS and slip_of(group, number, y[place]) == 0.0:
            gains = gain_of(group, number, place, desk) > 0.01 * GAINS * scales.rate
            doings[place] = YIELDS if goes and gains else HELD  # with one go all that it pushes
        for i in range(6):
            states[number, i] = y[place, i]
    return TIME_UP
