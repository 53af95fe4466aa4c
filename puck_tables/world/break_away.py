"""Discs at rest that friction holds no more: who starts to slip, and where to.

A disc at rest stays while what acts on it is within what its floor friction bears.  Beyond that it
yields: friction is at its limit, against a slip that turns to where the disc is driven.  If it
then is driven nowhere, since others at rest stand in its way, it is jammed: it stays, and passes
on what its friction does not take.  A slip that has begun has, while it is small, the direction in
which it grows: to turn there it needs but Q/J.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import size
from puck_tables.scene.rest import SLACK
from puck_tables.world.complementarity import find_modes
from puck_tables.world.forces import act, excess_on, gain_of, load_on
from puck_tables.world.group import (
    DRIVEN,
    HELD,
    LEVEL,
    NX,
    NY,
    YIELDS,
    Group,
    GroupBuffer,
    IntArray,
    Scales,
)
from puck_tables.world.layout import LIGHTNESS, RADIUS, TURNABILITY
from puck_tables.world.multipliers import leads, push_and_move

_TURNS, _PACE = 400, 0.3  # at most; in the time that friction needs to turn a slip, at first
_SETTLED, _ROUNDING = 1e-10, 1e-14  # of the gain, of the scale of accelerations: turns no more


@inlined
def _turn(
    group: Group, number: int, place: int, radius: float, buffer: GroupBuffer
) -> tuple[float, float]:
    """Turn one towards its acceleration; how much of that is across, and along.

    At a pace of J over Q where only friction turns with it; where others lead it, faster.
    """
    way, scale = buffer.ways[place], buffer.turn_rates[place]
    gain = gain_of(group, number, place, buffer)
    ox = buffer.rates[place, 0] - buffer.carried[place, 0] - gain * way[0]
    oy = buffer.rates[place, 1] - buffer.carried[place, 1] - gain * way[1]
    ow = radius * (buffer.rates[place, 2] - buffer.carried[place, 2] - gain * way[2])
    off = size(ox, oy, ow)
    if off > 0.97 * scale[1]:
        scale[0] = max(_PACE, 0.5 * scale[0]) if off > 1.001 * scale[1] else 1.3 * scale[0]
    scale[1] = off
    disc = group.discs[number]
    turns = max(disc[LIGHTNESS], 0.5 * radius * radius * disc[TURNABILITY])
    share = scale[0] / (load_on(group, number) * turns)
    if share * size(off, gain, 0.0) > 1.0:
        share = 1.0 / size(off, gain, 0.0)
    wx, wy, ww = way[0] + share * ox, way[1] + share * oy, radius * way[2] + share * ow
    whole = size(wx, wy, ww)
    way[0], way[1], way[2] = wx / whole, wy / whole, ww / whole / radius
    return off, gain


@inner
def turn_directions(
    group: Group, members: IntArray, modes: IntArray, motions: IntArray, y: FloatArray,
    scales: Scales, find: bool, power: FloatArray, buffer: GroupBuffer,
) -> None:  # fmt: skip
    """Turn slips that begin to where they are driven, all at once; pushes and accelerations.

    ``find``: also the modes.
    """
    for place in range(members.shape[0]):
        buffer.turn_rates[place, 0], buffer.turn_rates[place, 1] = _PACE, math.inf
    for _ in range(_TURNS):
        settled = True
        for place in range(members.shape[0]):
            if motions[place] == YIELDS:
                radius = group.discs[members[place], RADIUS]
                off, gain = _turn(group, members[place], place, radius, buffer)
                level = max(_SETTLED * abs(gain), _ROUNDING * scales.rate)
                settled = settled and off <= level
        if settled:
            return
        act(group, members, motions, y, power, buffer)
        if not find:
            push_and_move(buffer, modes, members.shape[0])
        elif not find_modes(buffer, modes, members.shape[0], scales):
            return


@inlined
def _driven_into(buffer: GroupBuffer, motions: IntArray, c: int, scales: Scales) -> int:
    """Which side of a contact, at rest, something driven moves into; −1: none."""
    one, other = buffer.pairs[c, 0], buffer.pairs[c, 1]
    if leads(buffer, c)[0] > -LEVEL * scales.rate:
        return -1
    if other < 0:  # it is carried into what stands
        return 0 if motions[one] == HELD else -1
    if motions[one] == DRIVEN and motions[other] == HELD:
        return 1
    return 0 if motions[one] == HELD and motions[other] == DRIVEN else -1


@inlined
def overborne(
    group: Group, members: IntArray, motions: IntArray, contacts: int, y: FloatArray,
    scales: Scales, mark: bool, buffer: GroupBuffer,
) -> bool:  # fmt: skip
    """Whether there are any at rest that cannot stay for themselves; ``mark``: they yield."""
    more = False
    for c in range(contacts):
        side = _driven_into(buffer, motions, c, scales)
        if side >= 0:
            more = True
            if mark:
                place, sign = buffer.pairs[c, side], 2.0 * side - 1.0
                motions[place], way = YIELDS, buffer.ways[place]
                buffer.firm[place] = group.surface.static
                way[0], way[1] = sign * buffer.sights[c, NX], sign * buffer.sights[c, NY]
                way[2] = 0.0
    for place in range(members.shape[0]):
        if motions[place] == HELD and (mark or not more):
            excess, ux, uy, w = excess_on(group, members, place, contacts, y, buffer)
            if excess > SLACK:
                more = True
                if mark:
                    motions[place], way = YIELDS, buffer.ways[place]
                    buffer.firm[place] = group.surface.static
                    way[0], way[1], way[2] = ux, uy, w
    return more


@inner
def find_break_away(
    group: Group, members: IntArray, modes: IntArray, motions: IntArray, y: FloatArray,
    scales: Scales, buffer: GroupBuffer,
) -> bool:  # fmt: skip
    """Modes, pushes and accelerations where members are at rest; whether found.

    ``motions``: those at rest are HELD or YIELDS, which also is the answer; ``buffer.ways``: where
    those slip that yield.  The sights are of y (m, 6).
    """
    power = buffer.powers[buffer.powers.shape[0] - 1]
    while True:
        act(group, members, motions, y, power, buffer)
        solved = find_modes(buffer, modes, members.shape[0], scales)
        if solved:
            turn_directions(group, members, modes, motions, y, scales, True, power, buffer)
        if not overborne(group, members, motions, modes.shape[0], y, scales, True, buffer):
            return solved
