"""One step of a group in time, Dormand–Prince 5(4), that ends with every gap closed.

It ends where something changes.  Of every contact four numbers are watched, which are positive
while its mode holds: the push, the slip of rims that slide, what is left of the friction of rims
that stick, the way to the end of an arc.
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.steppers import DORMAND_PRINCE
from puck_tables.scene.friction import VX, X, Y, size
from puck_tables.scene.ingredients import floor_acceleration
from puck_tables.world.complementarity import load_of, most
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import floor_of
from puck_tables.world.group import (
    APART,
    DRIVEN,
    GAINS,
    GRIP,
    HELD,
    LEVEL,
    MOVES,
    PARTS,
    RIM_GIVES,
    RIM_STOPS,
    RUNS_OFF,
    SLIP,
    SMOOTH_SLIP,
    STICKS,
    TO_END,
    WATCHES,
    YIELDS,
    GroupBuffer,
    IntArray,
    Scales,
    look,
    look_at_ties,
)
from puck_tables.world.group_forces import (
    act,
    can_rest,
    gain_of,
    load_on,
    place_driven,
    power_of_contacts,
    rest_on_floor,
    slip_of,
)
from puck_tables.world.layout import INV_INERTIA, INV_MASS, RADIUS, write_over
from puck_tables.world.multipliers import close_gaps, leads, push_and_move, stop_slips
from puck_tables.world.paths import BEGINS, DURATION, FIRST
from puck_tables.world.pressing import find_break_away, overborne, turn_directions
from puck_tables.world.step_ledger import LEDGER, write_work

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
def watch(buffer: GroupBuffer, modes: IntArray, scales: Scales, end: bool) -> None:
    """What is watched at the start or end of a step, from kinematics and pushes."""
    for c in range(modes.shape[0]):
        seen, contact = buffer.watched[1 if end else 0, c], buffer.kinematics[c]
        for i in range(WATCHES):
            seen[i] = math.inf
        if modes[c] == APART:
            continue
        seen[RUNS_OFF - PARTS] = contact[TO_END]
        _, _, soft, rolls = leads(buffer, c)
        if soft == 0.0:
            continue
        push, rim = buffer.pushes[c, 0], buffer.pushes[c, 1]
        seen[0] = load_of(contact, modes[c], push, rim) * soft + LEVEL * scales.rate
        if contact[GRIP] == 0.0:
            continue
        if modes[c] != STICKS:
            seen[RIM_STOPS - PARTS] = modes[c] * contact[SLIP] + SMOOTH_SLIP * scales.speed
        elif contact[GRIP] < math.inf:
            left = (most(contact, push) - abs(rim)) * rolls
            seen[RIM_GIVES - PARTS] = left + LEVEL * scales.rate


@inlined
def first_negative(buffer: GroupBuffer, end: int, count: int) -> tuple[int, int]:
    """A contact and what of it is negative at the start or end of a step; −1: nothing."""
    for c in range(count):
        for i in range(WATCHES):
            if buffer.watched[end, c, i] < 0.0:
                return c, i
    return -1, 0


@inner
def sets_off(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, scales: Scales,
    buffer: GroupBuffer,
) -> int:  # fmt: skip
    """Whether what presses on the discs at rest moves one: 1, or 0; −1: not solved.

    From the pushes of the state at the end of a step, which is that of ``buffer.states[1]``; only
    where a disc alone could not bear them all is it looked at who moves.
    """
    contacts = modes.shape[0]
    y = buffer.states[1]
    if not overborne(engine, members, motions, contacts, y, scales, False, buffer):
        return 0
    trial, does = buffer.modes[0, :contacts], buffer.motions[: members.shape[0]]
    for c in range(contacts):
        trial[c] = modes[c]
    for place in range(members.shape[0]):
        does[place] = motions[place]
    if not find_break_away(engine, members, trial, does, y, scales, buffer):
        return -1
    for place in range(members.shape[0]):
        begins = motions[place] == HELD and does[place] == YIELDS
        if begins and gain_of(engine, members[place], place, buffer) > GAINS * scales.rate:
            return 1
    return 0


@inner
def rates_at(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, t: float, y: FloatArray,
    stage: int, scales: Scales, buffer: GroupBuffer,
) -> None:  # fmt: skip
    """Rates of states y (m, 6) and of the ledger into a stage; the driven are put into place."""
    contacts, power = modes.shape[0], buffer.powers[stage]
    place_driven(engine, members, motions, t, y, buffer)
    act(engine, members, motions, y, power, buffer)
    look(engine, members, buffer.pairs[:contacts], y, buffer.kinematics)
    look_at_ties(engine, members, t, y, buffer)
    push_and_move(buffer, modes, members.shape[0])
    for place in range(members.shape[0]):
        if motions[place] == YIELDS:
            turn_directions(engine, members, modes, motions, y, scales, False, power, buffer)
            break
    power_of_contacts(engine, members, motions, contacts, y, power, buffer)
    for place in range(members.shape[0]):
        write_over(buffer.stages[stage, place], y[place, 3:])
        write_over(buffer.stages[stage, place, 3:], buffer.rates[place])


@inner
def step(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, t: float, h: float,
    scales: Scales, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """From states[0] at t, with its rates in stage 0, over h into states[1]; the error.

    The error is in units of ``scales``.  Rates at the end stand in stage END.
    """
    y, new, stages = buffer.states[0], buffer.states[1], buffer.stages
    for stage in range(1, STAGES):
        for place in range(members.shape[0]):
            for i in range(6):
                total = 0.0
                for j in range(stage):
                    total += _A[stage, j] * stages[j, place, i]
                new[place, i] = y[place, i] + h * total
        rates_at(engine, members, modes, motions, t + _C[stage] * h, new, stage, scales, buffer)
    largest, turning = 0.0, engine.surface.spin != 0.0 or engine.surface.changes != 0.0
    for place in range(members.shape[0]):
        if motions[place] == HELD:
            rest_on_floor(engine, members[place], new[place])
        if motions[place] == DRIVEN or (motions[place] == HELD and not turning):
            continue
        for i in range(6):
            error = 0.0
            for j in range(STAGES):
                error += _E[j] * stages[j, place, i]
            scale = scales.speed if i > 2 else scales.speed * scales.speed / scales.rate
            if i % 3 == 2:
                scale /= engine.discs[members[place], RADIUS]
            share = abs(h * error) / scale
            if not share <= largest:  # no number stays the largest, whoever comes after
                largest = share if share < math.inf else math.inf
    if modes.shape[0] + buffer.number[0] == 0 and not turning:
        for place in range(members.shape[0]):
            write_over(stages[END, place], stages[STAGES - 1, place])
        write_over(buffer.powers[END], buffer.powers[STAGES - 1])
    elif largest < math.inf:
        close_gaps(buffer, modes, new)
        look(engine, members, buffer.pairs[: modes.shape[0]], new, buffer.kinematics)
        look_at_ties(engine, members, t + h, new, buffer)
        stop_slips(buffer, modes, new)
        rates_at(engine, members, modes, motions, t + h, new, END, scales, buffer)
        for place in range(members.shape[0]):
            if not math.isfinite(stages[END, place, VX]):  # it tips there
                return math.inf
    return largest


@inlined
def longest_step(
    engine: Engine, members: IntArray, motions: IntArray, buffer: GroupBuffer
) -> float:
    """What steps from states[0] may have where a slip is about to end, or has just begun."""
    longest = math.inf
    for place in range(members.shape[0]):
        number = members[place]
        if motions[place] == MOVES and can_rest(engine, number):
            radius, rate = engine.discs[number, RADIUS], buffer.stages[0, place]
            floor, y = floor_of(engine.surface, engine.discs[number]), buffer.states[0, place]
            cx, cy = floor_acceleration(floor, y[X], y[Y], rate[0], rate[1])
            pull = size(rate[3] - cx, rate[4] - cy, radius * (rate[5] - floor.turn))
            q = slip_of(engine, number, y)
            disc = engine.discs[number]
            turns = max(disc[INV_MASS], 0.5 * radius * radius * disc[INV_INERTIA])
            pull = max(pull / _NEAR, load_on(engine, number) * turns / _TURN)
            if longest * pull > q:
                longest = q / pull
    return longest


@inlined
def add_work(h: float, start: float, row: FloatArray, buffer: GroupBuffer) -> None:
    """Write down what a step adds to the ledger."""
    done, halfway = buffer.powers[END + 1], buffer.powers[END + 2]
    for i in range(LEDGER):
        total, half = 0.0, _HALF[STAGES - 1] * buffer.powers[STAGES - 1, i]
        for j in range(STAGES - 1):
            total += _A[STAGES - 1, j] * buffer.powers[j, i]
            half += _HALF[j] * buffer.powers[j, i]
        done[i], halfway[i] = h * total, h * half
    write_work(row, start, h, buffer.powers[0], done, buffer.powers[END], halfway)


@inlined
def write_piece(piece: FloatArray, start: float, h: float, place: int, buffer: GroupBuffer) -> None:
    """The way of a member on a step as a piece of its path."""
    piece[BEGINS], piece[DURATION] = start, h
    write_over(piece[FIRST:], buffer.states[0, place])
    write_over(piece[FIRST + 6 :], buffer.stages[0, place, 3:])
    write_over(piece[FIRST + 9 :], buffer.states[1, place])
    write_over(piece[FIRST + 15 :], buffer.stages[END, place, 3:])
