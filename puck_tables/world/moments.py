"""What is watched on a step of a group, so that it ends where something changes.

Of every contact four numbers, which are positive while its mode holds: the push, the slip of rims
that slide, what is left of the friction of rims that stick, the way to the end of an arc.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined, inner
from puck_tables.world.break_away import find_break_away, overborne
from puck_tables.world.complementarity import load_of, most
from puck_tables.world.forces import gain_of
from puck_tables.world.group import (
    APART,
    GAINS,
    GRIP,
    HELD,
    LEVEL,
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
    Group,
    GroupBuffer,
    IntArray,
    Scales,
)
from puck_tables.world.multipliers import leads


@inner
def watch(buffer: GroupBuffer, modes: IntArray, scales: Scales, end: bool) -> None:
    """What is watched at the start or end of a step, from sights and pushes."""
    for c in range(modes.shape[0]):
        seen, sight = buffer.watched[1 if end else 0, c], buffer.sights[c]
        for i in range(WATCHES):
            seen[i] = math.inf
        if modes[c] == APART:
            continue
        seen[RUNS_OFF - PARTS] = sight[TO_END]
        _, _, soft, rolls = leads(buffer, c)
        if soft == 0.0:
            continue
        push, rim = buffer.pushes[c, 0], buffer.pushes[c, 1]
        seen[0] = load_of(sight, modes[c], push, rim) * soft + LEVEL * scales.rate
        if sight[GRIP] == 0.0:
            continue
        if modes[c] != STICKS:
            seen[RIM_STOPS - PARTS] = modes[c] * sight[SLIP] + SMOOTH_SLIP * scales.speed
        elif sight[GRIP] < math.inf:
            left = (most(sight, push) - abs(rim)) * rolls
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
    group: Group, members: IntArray, modes: IntArray, motions: IntArray, scales: Scales,
    buffer: GroupBuffer,
) -> int:  # fmt: skip
    """Whether what presses on the discs at rest moves one: 1, or 0; −1: not solved.

    From the pushes of the state at the end of a step, which is that of ``buffer.states[1]``; only
    where a disc alone could not bear them all is it looked at who moves.
    """
    contacts = modes.shape[0]
    y = buffer.states[1]
    if not overborne(group, members, motions, contacts, y, scales, False, buffer):
        return 0
    trial, does = buffer.modes[0, :contacts], buffer.motions[: members.shape[0]]
    for c in range(contacts):
        trial[c] = modes[c]
    for place in range(members.shape[0]):
        does[place] = motions[place]
    if not find_break_away(group, members, trial, does, y, scales, buffer):
        return -1
    for place in range(members.shape[0]):
        begins = motions[place] == HELD and does[place] == YIELDS
        if begins and gain_of(group, members[place], place, buffer) > GAINS * scales.rate:
            return 1
    return 0
