"""What holds at an instant: which contacts press, which rims stick, which discs stay at rest.

A disc at rest stays while what acts on it is within what its floor friction bears.  Beyond that it
yields: friction is at its limit, against a slip that turns to where the disc is driven.  If it
then is driven nowhere, since others at rest stand in its way, it is jammed: it stays, and passes
on what its friction does not take.  A slip that has begun has, while it is small, the direction in
which it grows: to turn there it needs but Q/J.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.scene.friction import SPIN, VX, size
from puck_tables.scene.rest import SLACK
from puck_tables.world.complementarity import find_modes, rim_mode
from puck_tables.world.contact_search import HARDLY
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import choose_belt, over_floor
from puck_tables.world.group import (
    APART,
    APPROACH,
    DRIVEN,
    GAINS,
    GRIP,
    HELD,
    LEVEL,
    MOVES,
    NX,
    NY,
    STICKS,
    STILL,
    TIME_UP,
    UNSOLVED,
    YIELDS,
    GroupBuffer,
    IntArray,
    Scales,
    find_places,
    look,
    look_at_ties,
    small_slip,
)  # fmt: skip
from puck_tables.world.group_forces import (
    act,
    can_rest,
    count_rows,
    excess_on,
    gain_of,
    load_on,
    place_driven,
    rest_on_floor,
    slip_of,
)
from puck_tables.world.layout import INV_INERTIA, INV_MASS, RADIUS, kinetic, write_over
from puck_tables.world.multipliers import leads, push_and_move, stop_slips
from puck_tables.world.step_ledger import DRIVE_WORK, RIM_HEAT

_TURNS, _LONGEST = 400, 0.3  # at most; in the time that friction needs to turn a slip, at first
_CONVERGED, _ROUNDING = 1e-10, 1e-14  # of the gain, of the scale of accelerations: turns no more
_CREEPS = 8  # rounds
_SAME = 0.9  # the cosine between directions that are the same


@inlined
def _turn(
    engine: Engine, number: int, place: int, radius: float, buffer: GroupBuffer
) -> tuple[float, float]:
    """Turn one towards its acceleration; how much of that is across, and along.

    At a pace of J over Q where only friction turns with it; where others lead it, faster.
    """
    slip, scale = buffer.slips[place], buffer.turn_rates[place]
    gain = gain_of(engine, number, place, buffer)
    ox = buffer.rates[place, 0] - buffer.floor_accels[place, 0] - gain * slip[0]
    oy = buffer.rates[place, 1] - buffer.floor_accels[place, 1] - gain * slip[1]
    ow = radius * (buffer.rates[place, 2] - buffer.floor_accels[place, 2] - gain * slip[2])
    off = size(ox, oy, ow)
    if off > 0.97 * scale[1]:
        scale[0] = max(_LONGEST, 0.5 * scale[0]) if off > 1.001 * scale[1] else 1.3 * scale[0]
    scale[1] = off
    disc = engine.discs[number]
    turns = max(disc[INV_MASS], 0.5 * radius * radius * disc[INV_INERTIA])
    share = scale[0] / (load_on(engine, number) * turns)
    if share * size(off, gain, 0.0) > 1.0:
        share = 1.0 / size(off, gain, 0.0)
    wx, wy, ww = slip[0] + share * ox, slip[1] + share * oy, radius * slip[2] + share * ow
    whole = size(wx, wy, ww)
    slip[0], slip[1], slip[2] = wx / whole, wy / whole, ww / whole / radius
    return off, gain


@inner
def turn_directions(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, y: FloatArray,
    scales: Scales, find: bool, power: FloatArray, buffer: GroupBuffer,
) -> None:  # fmt: skip
    """Turn slips that begin to where they are driven, all at once; pushes and accelerations.

    ``find``: also the modes.
    """
    for place in range(members.shape[0]):
        buffer.turn_rates[place, 0], buffer.turn_rates[place, 1] = _LONGEST, math.inf
    for _ in range(_TURNS):
        steady = True
        for place in range(members.shape[0]):
            if motions[place] == YIELDS:
                radius = engine.discs[members[place], RADIUS]
                off, gain = _turn(engine, members[place], place, radius, buffer)
                level = max(_CONVERGED * abs(gain), _ROUNDING * scales.rate)
                steady = steady and off <= level
        if steady:
            return
        act(engine, members, motions, y, power, buffer)
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
    engine: Engine, members: IntArray, motions: IntArray, contacts: int, y: FloatArray,
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
                motions[place], slip = YIELDS, buffer.slips[place]
                buffer.firm[place] = engine.surface.static
                slip[0], slip[1] = sign * buffer.kinematics[c, NX], sign * buffer.kinematics[c, NY]
                slip[2] = 0.0
    for place in range(members.shape[0]):
        if motions[place] == HELD and (mark or not more):
            excess, ux, uy, w = excess_on(engine, members, place, contacts, y, buffer)
            if excess > SLACK:
                more = True
                if mark:
                    motions[place], slip = YIELDS, buffer.slips[place]
                    buffer.firm[place] = engine.surface.static
                    slip[0], slip[1], slip[2] = ux, uy, w
    return more


@inner
def find_break_away(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, y: FloatArray,
    scales: Scales, buffer: GroupBuffer,
) -> bool:  # fmt: skip
    """Modes, pushes and accelerations where members are at rest; whether found.

    ``motions``: those at rest are HELD or YIELDS, which also is the answer; ``buffer.slips``: where
    those slip that yield.  The kinematics are of y (m, 6).
    """
    power = buffer.powers[buffer.powers.shape[0] - 1]
    while True:
        act(engine, members, motions, y, power, buffer)
        solved = find_modes(buffer, modes, members.shape[0], scales)
        if solved:
            turn_directions(engine, members, modes, motions, y, scales, True, power, buffer)
        if not overborne(engine, members, motions, modes.shape[0], y, scales, True, buffer):
            return solved


@inlined
def _energy(engine: Engine, members: IntArray, y: FloatArray) -> float:
    """Kinetic energy of those that can move."""
    total = 0.0
    for place in range(members.shape[0]):
        disc = engine.discs[members[place]]
        total += kinetic(disc, y[place, VX], y[place, VX + 1], y[place, SPIN])
    return total


@inlined
def _goes_on(engine: Engine, number: int, place: int, scales: Scales, buffer: GroupBuffer) -> bool:
    """Whether a small slip, if there is one, grows in the direction that it has."""
    y, line, radius = buffer.states[0, place], buffer.slips[place], engine.discs[number, RADIUS]
    slip = slip_of(engine, number, y)
    vx, vy, spin = over_floor(engine, number, y)
    along = line[0] * vx + line[1] * vy + radius * radius * line[2] * spin
    gains = gain_of(engine, number, place, buffer) > GAINS * scales.rate
    return slip == 0.0 or (gains and along > _SAME * slip)


@inlined
def _stop_creeping(
    engine: Engine, members: IntArray, contacts: int, modes: IntArray, y: FloatArray,
    scales: Scales, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """Take out approaches of what touches without pressing that are mere rounding; the heat.

    What has just been put to rest leaves such to its neighbours, which would creep into it.
    """
    stopped, heat = buffer.modes[1, :contacts], 0.0
    for _ in range(_CREEPS):
        look(engine, members, buffer.pairs[:contacts], y, buffer.kinematics)
        again = False
        for c in range(contacts):
            comes = buffer.kinematics[c, APPROACH]
            if modes[c] == APART and stopped[c] == APART and 0.0 < comes <= HARDLY * scales.speed:
                stopped[c], again = 1, True
        if not again:
            break
        heat += stop_slips(buffer, stopped, y)
    return heat


@inlined
def _come_to_rest(
    engine: Engine, members: IntArray, motions: IntArray, y: FloatArray, scales: Scales
) -> bool:
    """Put to rest whom the others have stopped; whether there are any."""
    any_rests = False
    for place in range(members.shape[0]):
        number = members[place]
        small = slip_of(engine, number, y[place]) <= STILL * scales.speed
        if small and motions[place] == MOVES and can_rest(engine, number):
            motions[place], any_rests = HELD, True
            rest_on_floor(engine, number, y[place])
    return any_rests


@inner
def press(
    engine: Engine, members: IntArray, contacts: IntArray, states: FloatArray, t: float,
    scales: Scales, modes: IntArray, motions: IntArray, ledger: FloatArray, buffer: GroupBuffer,
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
    modes : (c,) and motions : (m,), the answer, see :mod:`puck_tables.world.group`
        On entry modes say to which side rims begin to slip that stick, ±1; else STICKS.
    ledger : (8,) J, to which the heat of what is stopped is added

    Returns
    -------
    TIME_UP, or UNSOLVED where no forces satisfy all conditions
    """
    count = members.shape[0]
    find_places(members, contacts, buffer)
    pairs, gives, y = buffer.pairs[: contacts.shape[0]], buffer.gives, buffer.states[0]
    for c in range(contacts.shape[0]):
        gives[c] = modes[c]
    for place in range(count):
        number = members[place]
        write_over(y[place], states[number])
        motions[place] = MOVES
        choose_belt(engine, number, y[place])
        if engine.discs[number, INV_MASS] == 0.0:
            motions[place] = DRIVEN
        elif can_rest(engine, number):
            q = slip_of(engine, number, y[place])
            if q <= STILL * scales.speed:
                motions[place] = HELD
                rest_on_floor(engine, number, y[place])
            elif q <= small_slip(scales):
                motions[place] = YIELDS
                vx, vy, spin = over_floor(engine, number, y[place])
                slip, buffer.firm[place] = buffer.slips[place], 1.0
                slip[0], slip[1], slip[2] = vx / q, vy / q, spin / q
    count_rows(engine, members, t, buffer)
    place_driven(engine, members, motions, t, y, buffer)
    stopped, again, rounds = buffer.modes[1, : contacts.shape[0]], True, 0
    while again:
        patience(1)
        rounds += 1
        look(engine, members, pairs, y, buffer.kinematics)
        look_at_ties(engine, members, t, y, buffer)
        for c in range(contacts.shape[0]):
            modes[c] = rim_mode(buffer.kinematics[c], scales.speed)
            if modes[c] == STICKS:
                modes[c] = gives[c]
            stopped[c] = STICKS
            if modes[c] != STICKS and buffer.kinematics[c, GRIP] == math.inf:
                buffer.kinematics[c, GRIP], stopped[c] = 0.0, APART  # first, whether it presses
        if not find_break_away(engine, members, modes, motions, y, scales, buffer):
            return UNSOLVED
        again = False
        for place in range(count):
            if motions[place] == YIELDS and not _goes_on(
                engine, members[place], place, scales, buffer
            ):
                motions[place], again = MOVES, True
            elif (
                motions[place] == YIELDS and buffer.firm[place] > 1.0
                and gain_of(engine, members[place], place, buffer) > GAINS * scales.rate
            ):  # fmt: skip
                buffer.firm[place], again = 1.0, True  # it slips: static friction is over
        if again:
            continue
        for c in range(contacts.shape[0]):
            if stopped[c] == APART and modes[c] != APART:
                buffer.kinematics[c, GRIP], stopped[c], again = math.inf, STICKS, True
            elif modes[c] == APART or rim_mode(buffer.kinematics[c], scales.speed) != STICKS:
                stopped[c] = modes[c]
        before = _energy(engine, members, y)
        heat = stop_slips(buffer, stopped, y)
        ledger[RIM_HEAT] += heat
        ledger[DRIVE_WORK] += heat + _energy(engine, members, y) - before
        heat = _stop_creeping(engine, members, contacts.shape[0], modes, y, scales, buffer)
        ledger[RIM_HEAT] += heat
        if rounds < _CREEPS and _come_to_rest(engine, members, motions, y, scales):
            again = True
    goes = False
    for place in range(count):
        if motions[place] == YIELDS:
            goes = goes or gain_of(engine, members[place], place, buffer) > GAINS * scales.rate
    for place in range(count):
        number = members[place]
        if motions[place] == YIELDS and slip_of(engine, number, y[place]) == 0.0:
            gains = gain_of(engine, number, place, buffer) > 0.01 * GAINS * scales.rate
            motions[place] = YIELDS if goes and gains else HELD  # with one go all that it pushes
        write_over(states[number], y[place])
    return TIME_UP
