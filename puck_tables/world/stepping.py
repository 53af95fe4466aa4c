"""One step of a group in time, Dormand–Prince 5(4), that ends with every gap closed."""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.tableaus import DORMAND_PRINCE
from puck_tables.scene.friction import size
from puck_tables.scene.ingredients import carried_along
from puck_tables.world.forces import (
    act,
    can_rest,
    load_on,
    place_driven,
    power_of_contacts,
    rest_on_floor,
    slip_of,
)
from puck_tables.world.group import (
    DRIVEN,
    HELD,
    MOVES,
    YIELDS,
    Desk,
    Group,
    IntArray,
    Scales,
)
from puck_tables.world.layout import LIGHTNESS, RADIUS, TURNABILITY
from puck_tables.world.multipliers import push_and_move
from puck_tables.world.paths import DURATION, FIRST, START
from puck_tables.world.putting_right import close_gaps, stop_slips
from puck_tables.world.sights import look, look_at_ties
from puck_tables.world.works import LEDGER, write_work
from puck_tables.world.yielding import turn_ways

_A, _C, _E = DORMAND_PRINCE.a, DORMAND_PRINCE.c, DORMAND_PRINCE.e[0]
STAGES = len(_C)
# the weights of the method half way through a step, of order four (Shampine 1986)
_HALF = 0.5 * np.array([
    6025192743 / 30085553152, 0.0, 51252292925 / 65400821598, -2691868925 / 45128329728,
    187940372067 / 1594534317056, -1776094331 / 19743644256, 11237099 / 235043384,
])  # fmt: skip
# where the rates at both ends of a step stand; plain numbers would compile ``rates_at`` for each
BEGIN, END = cast(int, np.int64(0)), cast(int, np.int64(STAGES))
_NEAR = 0.5  # of the time in which a slip would end, at most, is a step,
_TURN = 1.5  # and of that in which friction turns it; three times as long steps turn it to and fro


@inner
def rates_at(
    group: Group, members: IntArray, modes: IntArray, doings: IntArray, t: float, y: FloatArray,
    stage: int, scales: Scales, desk: Desk,
) -> None:  # fmt: skip
    """Rates of states y (m, 6) and of the ledger into a stage; the driven are put into place."""
    contacts, power = modes.shape[0], desk.powers[stage]
    place_driven(group, members, doings, t, y, desk)
    act(group, members, doings, y, power, desk)
    look(group, members, desk.pairs[:contacts], y, desk.sights)
    look_at_ties(group, members, t, y, desk)
    push_and_move(desk, modes, members.shape[0])
    for place in range(members.shape[0]):
        if doings[place] == YIELDS:
            turn_ways(group, members, modes, doings, y, scales, False, power, desk)
            break
    power_of_contacts(group, members, doings, contacts, y, power, desk)
    for place in range(members.shape[0]):
        for i in range(3):
            desk.stages[stage, place, i] = y[place, 3 + i]
            desk.stages[stage, place, 3 + i] = desk.rates[place, i]


@inner
def step(
    group: Group, members: IntArray, modes: IntArray, doings: IntArray, t: float, h: float,
    scales: Scales, desk: Desk,
) -> float:  # fmt: skip
    """From states[0] at t, with its rates in stage 0, over h into states[1]; the error.

    The error is in units of ``scales``.  Rates at the end stand in stage END.
    """
    y, new, stages = desk.states[0], desk.states[1], desk.stages
    for stage in range(1, STAGES):
        for place in range(members.shape[0]):
            for i in range(6):
                total = 0.0
                for j in range(stage):
                    total += _A[stage, j] * stages[j, place, i]
                new[place, i] = y[place, i] + h * total
        rates_at(group, members, modes, doings, t + _C[stage] * h, new, stage, scales, desk)
    largest, turning = 0.0, group.surface.spin != 0.0
    for place in range(members.shape[0]):
        if doings[place] == HELD:
            rest_on_floor(group, members[place], new[place])
        if doings[place] == DRIVEN or (doings[place] == HELD and not turning):
            continue
        for i in range(6):
            error = 0.0
            for j in range(STAGES):
                error += _E[j] * stages[j, place, i]
            scale = scales.speed if i > 2 else scales.speed * scales.speed / scales.rate
            if i % 3 == 2:
                scale /= group.discs[members[place], RADIUS]
            share = abs(h * error) / scale
            if not share <= largest:
                largest = share
    if modes.shape[0] + desk.number[0] == 0 and not turning:
        for place in range(members.shape[0]):
            for i in range(6):
                stages[END, place, i] = stages[STAGES - 1, place, i]
        for i in range(LEDGER):
            desk.powers[END, i] = desk.powers[STAGES - 1, i]
    elif largest < math.inf:
        close_gaps(desk, modes, new)
        look(group, members, desk.pairs[: modes.shape[0]], new, desk.sights)
        look_at_ties(group, members, t + h, new, desk)
        stop_slips(desk, modes, new)
        rates_at(group, members, modes, doings, t + h, new, END, scales, desk)
    return largest


@inlined
def longest_step(group: Group, members: IntArray, doings: IntArray, desk: Desk) -> float:
    """What steps from states[0] may have where a slip is about to end, or has just begun."""
    longest = math.inf
    for place in range(members.shape[0]):
        number = members[place]
        if doings[place] == MOVES and can_rest(group, number):
            radius, rate = group.discs[number, RADIUS], desk.stages[0, place]
            cx, cy = carried_along(group.surface, rate[0], rate[1])
            pull = size(rate[3] - cx, rate[4] - cy, radius * rate[5])
            q = slip_of(group, number, desk.states[0, place])
            disc = group.discs[number]
            turns = max(disc[LIGHTNESS], 0.5 * radius * radius * disc[TURNABILITY])
            pull = max(pull / _NEAR, load_on(group, number) * turns / _TURN)
            if longest * pull > q:
                longest = q / pull
    return longest


@inlined
def add_work(h: float, start: float, row: FloatArray, desk: Desk) -> None:
    """Write down what a step adds to the ledger."""
    done, halfway = desk.powers[END + 1], desk.powers[END + 2]
    for i in range(LEDGER):
        total, half = 0.0, _HALF[STAGES - 1] * desk.powers[STAGES - 1, i]
        for j in range(STAGES - 1):
            total += _A[STAGES - 1, j] * desk.powers[j, i]
            half += _HALF[j] * desk.powers[j, i]
        done[i], halfway[i] = h * total, h * half
    write_work(row, start, h, desk.powers[0], done, desk.powers[END], halfway)


@inlined
def write_piece(piece: FloatArray, start: float, h: float, place: int, desk: Desk) -> None:
    """The way of a member on a step as a piece of its path."""
    piece[START], piece[DURATION] = start, h
    for i in range(6):
        piece[FIRST + i] = desk.states[0, place, i]
        piece[FIRST + 9 + i] = desk.states[1, place, i]
    for i in range(3):
        piece[FIRST + 6 + i] = desk.stages[0, place, 3 + i]
        piece[FIRST + 15 + i] = desk.stages[END, place, 3 + i]
