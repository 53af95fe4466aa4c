"""What holds at an instant: which contacts press, which rims stick, which discs stay at rest.

A disc at rest stays while what acts on it is within what its floor friction bears.  Beyond that it
yields: friction is at its limit, against a slip that turns to where the disc is driven.  If it
then is driven nowhere, since others at rest stand in its way, it is jammed: it stays, and passes
on what its friction does not take.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.friction import SPIN, VX, size
from puck_tables.scene.rest import SLACK
from puck_tables.world.complementarity import find_modes, rim_mode
from puck_tables.world.forces import act, can_rest, excess_on, place_driven, slip_of
from puck_tables.world.group import (
    APART,
    DRIVE_WORK,
    DRIVEN,
    HELD,
    MOVES,
    RIM_HEAT,
    SLIP,
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
)
from puck_tables.world.layout import LIGHTNESS, RADIUS, TURNABILITY
from puck_tables.world.putting_right import stop_slips
from puck_tables.world.sights import look

_TURNS, _SETTLED = 400, 1e-12  # at most; of the scale of accelerations: a direction stays
_GAINS = 1e-10  # of the scale of accelerations: what gains less stays
_FIRST = 2.0 * STILL  # of the scale of speeds: what a slip begins with


@kernel
def settle(
    group: Group, members: IntArray, modes: IntArray, doings: IntArray, y: FloatArray,
    scales: Scales, desk: Desk,
) -> tuple[bool, bool]:  # fmt: skip
    """Modes, pushes and accelerations where members are at rest: solved?, and is any set off?

    ``doings``: of those at rest HELD or YIELDS, which also are the answer; ``desk.ways``: where
    those slip that yield.  The sights are of y (m, 6).
    """
    count, contacts = members.shape[0], modes.shape[0]
    power = desk.powers[desk.powers.shape[0] - 1]
    while True:
        act(group, members, doings, y, power, desk)
        if not find_modes(desk, modes, count, scales):
            return False, False
        _turn_ways(group, members, modes, doings, y, scales, desk)
        more = False
        for place in range(count):
            if doings[place] == HELD:
                number = members[place]
                excess, ux, uy, w = excess_on(group, number, place, contacts, desk)
                if excess > SLACK:
                    doings[place] = YIELDS
                    way = desk.ways[place]
                    way[0], way[1], way[2] = ux, uy, w
                    more = True
        if not more:
            break
    goes = False
    for place in range(count):
        if doings[place] == YIELDS:
            goes = goes or _gain(group, members[place], place, desk) > _GAINS * scales.rate
    return True, goes


@inlined
def _gain(group: Group, number: int, place: int, desk: Desk) -> float:
    """How fast a disc that yields gains speed along its way."""
    way, rate, radius = desk.ways[place], desk.rates[place], group.discs[number, RADIUS]
    return way[0] * rate[0] + way[1] * rate[1] + radius * radius * way[2] * rate[2]


@inlined
def _turn_ways(
    group: Group, members: IntArray, modes: IntArray, doings: IntArray, y: FloatArray,
    scales: Scales, desk: Desk,
) -> None:  # fmt: skip
    """Turn slips that begin to where they are driven; all at once."""
    power = desk.powers[desk.powers.shape[0] - 1]
    share, before = 0.3, math.inf
    for _ in range(_TURNS):
        off = 0.0
        for place in range(members.shape[0]):
            if doings[place] != YIELDS:
                continue
            number = members[place]
            way, radius = desk.ways[place], group.discs[number, RADIUS]
            gain = _gain(group, number, place, desk)
            ox = desk.rates[place, 0] - gain * way[0]
            oy = desk.rates[place, 1] - gain * way[1]
            ow = radius * (desk.rates[place, 2] - gain * way[2])
            off = max(off, size(ox, oy, ow))
            pace = share / (group.regions.load[number] * group.discs[number, LIGHTNESS])
            wx, wy, ww = way[0] + pace * ox, way[1] + pace * oy, radius * way[2] + pace * ow
            whole = size(wx, wy, ww)
            way[0], way[1], way[2] = wx / whole, wy / whole, ww / whole / radius
        if off <= _SETTLED * scales.rate:
            return
        share *= 0.7 if off > before else 1.03
        before = off
        act(group, members, doings, y, power, desk)
        if not find_modes(desk, modes, members.shape[0], scales):
            return


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
        Changed by rounding: who is as good as at rest is put to rest, who starts gets a first slip
        of 2e-12 Q.  Rims with friction without bound are stopped at once.
    modes : (c,) and doings : (m,), the answer, see :mod:`puck_tables.world.group`
    ledger : (5,) J, to which the heat of what is stopped is added

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
        if group.discs[number, LIGHTNESS] == 0.0:
            doings[place] = DRIVEN
        elif can_rest(group, number) and slip_of(group, number, y[place]) <= STILL * scales.speed:
            doings[place] = HELD
            y[place, 3] = y[place, 4] = y[place, 5] = 0.0
    place_driven(group, members, doings, t, y, desk)
    for again in range(2):
        look(group, members, pairs, y, desk.sights)
        for c in range(contacts.shape[0]):
            modes[c] = rim_mode(desk.sights[c], scales.speed)
        solved, _ = settle(group, members, modes, doings, y, scales, desk)
        if not solved:
            return UNSOLVED
        grips, stopped = False, desk.modes[1, : contacts.shape[0]]
        for c in range(contacts.shape[0]):
            grips = grips or (
                modes[c] == STICKS and abs(desk.sights[c, SLIP]) > STILL * scales.speed
            )
            begins = modes[c] != APART and rim_mode(desk.sights[c], scales.speed) == STICKS
            stopped[c] = STICKS if begins else modes[c]
        before = _energy(group, members, y)
        heat = stop_slips(desk, stopped, y)
        ledger[RIM_HEAT] += heat
        ledger[DRIVE_WORK] += heat + _energy(group, members, y) - before
        if again == 1 or not grips:
            break
    for place in range(count):
        number = members[place]
        if doings[place] == YIELDS:
            doings[place] = HELD
            if _gain(group, number, place, desk) > _GAINS * scales.rate:
                doings[place] = MOVES
                for i in range(3):
                    y[place, 3 + i] = _FIRST * scales.speed * desk.ways[place, i]
        for i in range(6):
            states[number, i] = y[place, i]
    return TIME_UP
