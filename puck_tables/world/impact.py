"""Impacts: of two discs, of a disc and an obstacle, and of as many at once as touch.

A contact follows the law of :mod:`puck_tables.motion.impact_law`, with restitution e, tangential
restitution β and friction μ of its pair (:mod:`puck_tables.world.layout`); where e falls with speed
it is that at u_n, in every round anew.

Of discs that touch, those contacts that approach are resolved, then those that approach then, and
so on: a row of pucks passes an impact on, as if there were gaps between them (after 200 rounds
those that take turns are resolved together with e = β = 0; those that are squeezed at once).
Contacts of one round that share a disc are resolved together: the impulses for e = β = 0 are those
of one complementarity problem (:mod:`puck_tables.world.complementarity`), then enlarged by 1 + e
and 1 + β, as Poisson has it, and lessened together should energy grow.  So no numbering matters,
and what is symmetric stays so.  Rebounds that die out (:mod:`puck_tables.world.touching`) have
e = 0.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.impact_law import impulses
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.world.complementarity import find_modes, most
from puck_tables.world.contact_row import (
    ACTS,
    BETA,
    CROSS,
    FIRST_N,
    FIRST_T,
    HOPS,
    LOSS,
    MU,
    NX,
    NY,
    ONE,
    OTHER,
    PN,
    PT,
    SLICK,
    SOFT,
    SUM_N,
    SUM_T,
    E,
    approach,
    got_impulse,
)
from puck_tables.world.contact_search import HARDLY
from puck_tables.world.engine_state import Engine, Whole
from puck_tables.world.group import ARM, GRIP, LEVEL, STICKS, GroupBuffer, Scales
from puck_tables.world.group import NX as GROUP_NX
from puck_tables.world.group import NY as GROUP_NY
from puck_tables.world.holds import forbid, response
from puck_tables.world.layout import HOLD, INV_INERTIA, INV_MASS, RADIUS, smaller_at, write_over
from puck_tables.world.multipliers import stop_slips
from puck_tables.world.touching import dies_out

NO_END, TOO_FAST = -1, -2  # how impacts fail: rounds without end; faster than a table goes

NEGLIGIBLE = 1e-13  # of the scale of speeds: an approach as slow is none
MOST_ROUNDS = 2_000  # at one moment: ten times those after which turns are resolved together
TURNS = 200  # rounds after which contacts that take turns are resolved together, with e = 0


@inlined
def _push(engine: Engine, i: int, j: int, row: FloatArray, states: FloatArray) -> None:
    """What impulses along n and t do to the velocities."""
    pn, pt = row[PN], row[PT]
    px, py = pn * row[NX] - pt * row[NY], pn * row[NY] + pt * row[NX]
    discs = engine.discs
    dx, dy, turn = response(discs[i], states[i], px, py, discs[i, RADIUS] * pt)
    states[i, VX] -= dx
    states[i, VY] -= dy
    states[i, SPIN] -= turn
    if j >= 0:
        dx, dy, turn = response(discs[j], states[j], -px, -py, discs[j, RADIUS] * pt)
        states[j, VX] -= dx
        states[j, VY] -= dy
        states[j, SPIN] -= turn


@inlined
def _keep_velocities(i: int, j: int, states: FloatArray, before: FloatArray) -> None:
    """Of a disc and its partner, before this round."""
    write_over(before[i, VX:], states[i, VX:])
    if j >= 0:
        write_over(before[j, VX:], states[j, VX:])


@inlined
def _recall(
    contacts: Whole, count: int, rows: FloatArray, before: FloatArray, states: FloatArray
) -> None:
    """The velocities before this round."""
    for n in range(count):
        if rows[n, ACTS] > 0.0:
            for m in range(2):
                disc = contacts[n, m]
                if disc >= 0:
                    write_over(states[disc, VX:], before[disc, VX:])


@inlined
def _push_all(
    engine: Engine, contacts: Whole, count: int, rows: FloatArray, before: FloatArray,
    states: FloatArray,
) -> None:  # fmt: skip
    """The velocities after the impulses of this round."""
    _recall(contacts, count, rows, before, states)
    for n in range(count):
        if rows[n, ACTS] > 0.0:
            _push(engine, contacts[n, 0], contacts[n, 1], rows[n], states)


@inlined
def _alone(engine: Engine, i: int, j: int, row: FloatArray, states: FloatArray) -> None:
    """The law for one contact."""
    un, ut = approach(engine, i, j, row[NX], row[NY], states)
    row[PN], row[PT] = impulses(un, ut, row[SOFT], row[SLICK], row[E], row[BETA], row[MU])
    _push(engine, i, j, row, states)


@inner
def as_forces(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, states: FloatArray,
    buffer: GroupBuffer,
) -> int:  # fmt: skip
    """The contacts that act as a problem of forces, with velocities for accelerations.

    How many they are; −1: too many.  Discs are the members, by their numbers.
    """
    acting, ties = 0, 0
    for i in range(states.shape[0]):
        buffer.inverse[i, 0] = buffer.inverse[i, 1] = 0.0
    for n in range(count):
        row = rows[n]
        if row[ACTS] == 0.0:
            continue
        if acting == buffer.pairs.shape[0]:
            return -1
        contact = buffer.kinematics[acting]
        for column in range(contact.shape[0]):
            contact[column] = 0.0
        contact[GROUP_NX], contact[GROUP_NY] = row[NX], row[NY]
        contact[GRIP] = 0.0  # β = −1: smooth
        if row[BETA] > -1.0:
            contact[GRIP] = row[MU] * (1.0 + row[E]) / (1.0 + row[BETA])
        for m in range(2):
            i = contacts[n, m]
            buffer.pairs[acting, m] = i
            if i < 0:
                continue
            disc = engine.discs[i]
            contact[ARM + m] = disc[RADIUS]
            if buffer.inverse[i, 0] > 0.0 or disc[INV_MASS] == 0.0:
                continue
            buffer.inverse[i, 0], buffer.inverse[i, 1] = disc[INV_MASS], disc[INV_INERTIA]
            own = buffer.own[i]
            own[0], own[1], own[2] = states[i, VX], states[i, VY], states[i, SPIN]
            if disc[HOLD] != 0.0:
                if ties + 2 > buffer.ties.shape[0]:
                    return -1
                more = forbid(
                    disc, engine.surface, t, states[i], buffer.ties[ties:], buffer.strays[ties:]
                )
                for _ in range(more):  # impulses leave what is led as it goes
                    tie = buffer.ties[ties]
                    buffer.strays[ties, 2] = tie[0] * own[0] + tie[1] * own[1] + tie[2] * own[2]
                    buffer.led_places[ties] = i
                    ties += 1
        acting += 1
    buffer.number[0] = ties
    return acting


@inner
def _together(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, before: FloatArray,
    states: FloatArray, buffer: GroupBuffer,
) -> bool:  # fmt: skip
    """The law for contacts that share discs, or bear on what is led; whether there are impulses.

    Those for e = β = 0, enlarged by 1 + e and 1 + β.
    """
    acting = as_forces(engine, t, contacts, count, rows, states, buffer)
    if acting < 0:
        return False
    modes = buffer.modes[0, :acting]
    c = 0
    for n in range(count):  # as each would be alone
        row = rows[n]
        if row[ACTS] > 0.0:
            un, ut = approach(engine, contacts[n, 0], contacts[n, 1], row[NX], row[NY], states)
            slides = abs(ut) * row[SOFT] > most(buffer.kinematics[c], un) * row[SLICK]
            modes[c] = int(math.copysign(1.0, ut)) if slides else STICKS
            c += 1
    speed = engine.scale[0]
    scales = Scales(speed, NEGLIGIBLE / LEVEL * speed, 0.0)
    if not find_modes(buffer, modes, states.shape[0], scales):
        return False
    c = 0
    for n in range(count):
        row = rows[n]
        row[PN] = row[PT] = 0.0
        if row[ACTS] > 0.0:
            row[PN] = max(buffer.pushes[c, 0], 0.0) * (1.0 + row[E])
            row[PT] = buffer.pushes[c, 1] * (1.0 + row[BETA])
            c += 1
    _push_all(engine, contacts, count, rows, before, states)
    gain, cost = 0.0, 0.0
    for n in range(count):
        row = rows[n]
        if row[ACTS] > 0.0:
            i, j = contacts[n, 0], contacts[n, 1]
            un, ut = approach(engine, i, j, row[NX], row[NY], before)
            vn, vt = approach(engine, i, j, row[NX], row[NY], states)
            gain += row[PN] * un + row[PT] * ut
            cost += 0.5 * (row[PN] * (un - vn) + row[PT] * (ut - vt))
    if cost > gain > 0.0:  # impulses of this share of them keep the energy
        for n in range(count):
            rows[n, PN] *= gain / cost
            rows[n, PT] *= gain / cost
        _push_all(engine, contacts, count, rows, before, states)
    return True


@inner
def _hold_together(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, states: FloatArray,
    buffer: GroupBuffer,
) -> bool:  # fmt: skip
    """Take away how slowly those part that hop; whether that is possible.

    Else a disc between three others, or in a corner, chatters for ever at a height that is
    rounding: each impact brings apart those that met in the last one.
    """
    for n in range(count):
        rows[n, ACTS] = rows[n, HOPS]
    acting = as_forces(engine, t, contacts, count, rows, states, buffer)
    if acting > 0:
        modes = buffer.modes[0, :acting]
        modes[:] = 1
        heat = stop_slips(buffer, modes, states)
        for n in range(count):
            if got_impulse(rows[n]):  # so it is told
                rows[n, LOSS] += heat
                break
    return acting >= 0


@inlined
def _share_discs(contacts: Whole, count: int, rows: FloatArray, shares: Whole) -> bool:
    """Whether acting contacts bear on each other, or approach and slip of one do."""
    for n in range(count):
        for m in range(2):
            if contacts[n, m] >= 0:
                shares[contacts[n, m]] = 0
    for n in range(count):
        if rows[n, ACTS] > 0.0:
            if rows[n, CROSS] != 0.0:
                return True
            for m in range(2):
                i = contacts[n, m]
                if i >= 0:
                    shares[i] += 1
                    if shares[i] > 1:
                        return True
    return False


@inner
def collide(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, before: FloatArray,
    states: FloatArray, shares: Whole, buffer: GroupBuffer, squeezed: bool,
) -> int:  # fmt: skip
    """All impacts of discs that touch, at one instant; how many rounds there were.

    Or NO_END, or TOO_FAST, where the approach that no table knows is FIRST_N of a row with E < 0.

    ``contacts`` (count, 2): discs and their partners, prepared in ``rows``; ``states`` (n, 6) get
    the velocities after them; ``before`` (n, 6), ``shares`` (n,) and ``buffer`` are room to work.
    ``squeezed``: all that do not part are resolved together, with e = 0.
    """
    for turn in range(MOST_ROUNDS):
        acting = 0
        for n in range(count):
            row, i, j = rows[n], contacts[n, 0], contacts[n, 1]
            un, ut = approach(engine, i, j, row[NX], row[NY], states)
            row[ACTS] = 1.0 if un > NEGLIGIBLE * engine.scale[0] else 0.0
            if row[ACTS] > 0.0:
                acting += 1
                if row[ONE] < 0.0 or row[OTHER] < 0.0:
                    row[E] = smaller_at(engine.rims, row[ONE], row[OTHER], un)
                    if row[E] < 0.0:
                        row[FIRST_N] = un
                        return TOO_FAST
                if row[SUM_N] == 0.0:
                    row[FIRST_N], row[FIRST_T] = un, ut
                _keep_velocities(i, j, states, before)
        if acting == 0:
            if squeezed and not _hold_together(engine, t, contacts, count, rows, states, buffer):
                return NO_END
            return turn
        last = turn >= TURNS or squeezed
        if last:  # such as of a light disc between a heavy one and a wall
            for n in range(count):
                row, i, j = rows[n], contacts[n, 0], contacts[n, 1]
                un, _ = approach(engine, i, j, row[NX], row[NY], states)
                if got_impulse(row) or (squeezed and un >= -HARDLY * engine.scale[0]):
                    row[ACTS], row[E], row[ONE], row[OTHER] = 1.0, 0.0, 0.0, 0.0
                    if row[BETA] > -1.0:
                        row[BETA] = 0.0  # rims that are pressed, as in a contact that lasts
                    _keep_velocities(i, j, states, before)
        shared = _share_discs(contacts, count, rows, shares)
        again = True
        while again:
            if not shared:
                for n in range(count):
                    if rows[n, ACTS] > 0.0:
                        _alone(engine, contacts[n, 0], contacts[n, 1], rows[n], states)
            elif not _together(engine, t, contacts, count, rows, before, states, buffer):
                return NO_END
            again = False
            for n in range(count):
                row = rows[n]
                i, j = contacts[n, 0], contacts[n, 1]
                if row[ACTS] * row[E] > 0.0 and dies_out(engine, i, j, t, row, states):
                    row[E] = row[ONE] = row[OTHER] = 0.0
                    again = True
            if again:
                _recall(contacts, count, rows, before, states)
        for n in range(count):
            row, i, j = rows[n], contacts[n, 0], contacts[n, 1]
            if row[ACTS] > 0.0:
                un, ut = approach(engine, i, j, row[NX], row[NY], before)
                vn, vt = approach(engine, i, j, row[NX], row[NY], states)
                row[SUM_N] += row[PN]
                row[SUM_T] += row[PT]
                row[LOSS] += 0.5 * (row[PN] * (un + vn) + row[PT] * (ut + vt))
    return NO_END
