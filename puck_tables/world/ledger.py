"""Where the energy of pucks went until any moment: floor, drag, rims, impacts; what drives.

A row holds what :mod:`puck_tables.world.step_ledger` has, and what launches gave, what went
with who left play, and the heat of impacts.  Of motions that are looked up the heat of the floor is
what the segments lose; of those that are integrated heats and works are integrated with them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.over_time import rows_passed
from puck_tables.world.engine_state import (
    ADDED,
    GOT,
    IMPACT,
    LED,
    LOST,
    N_EVENTS,
    N_HISTORY,
    N_WORK_ROWS,
    OVER_EDGE,
    PLACED,
    POCKETED,
    REMOVED,
    STRUCK,
    TIME,
    TIPS,
    WHAT,
    Engine,
)
from puck_tables.world.layout import INV_INERTIA, INV_MASS, PULL_X, PULL_Y, kinetic
from puck_tables.world.record import first_from
from puck_tables.world.segment import DAMPED, DRIFT_X, DRIFT_Y, GONE, PATH, START, STILL, state_at
from puck_tables.world.segment_starts import Room
from puck_tables.world.step_ledger import (
    DRAG_HEAT,
    DRIVE_WORK,
    DURATION,
    FLOOR_HEAT,
    LEDGER,
    PULL_WORK,
    RIM_HEAT,
    SEGMENT,
    SUPPORT_WORK,
    WORK_START,
    add_worked,
)

if TYPE_CHECKING:
    from puck_tables.world.world import World

LAUNCH_ENERGY, LEFT, IMPACT_HEAT = range(LEDGER, LEDGER + 3)
LEDGER_COLUMNS = LEDGER + 3  # those of works, and these
NAMES = {
    "energy_given": LAUNCH_ENERGY, "energy_gone": LEFT, "work_given": PULL_WORK,
    "work_driven": DRIVE_WORK, "work_support": SUPPORT_WORK, "heat_dry": FLOOR_HEAT,
    "heat_viscous": DRAG_HEAT, "heat_rims": RIM_HEAT, "heat_impact": IMPACT_HEAT,
}  # fmt: skip


_NOTHING = 1e-6  # of what the pucks hold at the scale of speeds: an energy next to their rounding


def energy_scale(engine: Engine) -> float:
    """The least energy to which what a ledger misses is compared, J."""
    light = engine.discs[:, INV_MASS]
    return _NOTHING * 0.5 * float((1.0 / light[light > 0.0]).sum() * engine.scale[0] ** 2)


@inner
def _pulled(engine: Engine, i: int, start: float, t: float, vx: float, vy: float) -> float:
    """What slope and given forces work on a disc that a belt carries, from the start to t, J."""
    disc, first, last = engine.discs[i], engine.spans[i, 0], engine.spans[i, 1]
    work = (disc[PULL_X] * vx + disc[PULL_Y] * vy) / disc[INV_MASS] * (t - start)
    for n in range(first + max(rows_passed(engine.forcing, first, last, start), 1), last):
        one, two = engine.forcing[n - 1], engine.forcing[n]
        begin, end = max(one[0], start), min(two[0], t)
        if begin >= end:
            continue
        share = (0.5 * (begin + end) - one[0]) / (two[0] - one[0])  # straight in between
        fx, fy = one[1] + share * (two[1] - one[1]), one[2] + share * (two[2] - one[2])
        work += (fx * vx + fy * vy) * (end - begin)
    return work


@inner
def _begin_flown(engine: Engine, n: int, room: Room) -> bool:
    """The state at the start of a segment into ``room.one``; False: it is integrated, or driven."""
    row = engine.history[n]
    i, kind, segment = int(row[0]), int(row[1]), row[2:]
    if engine.discs[i, INV_MASS] == 0.0 or kind in (PATH, GONE):
        return False
    state_at(
        kind, segment, engine.discs[i], engine.lookups, engine.pieces, segment[START], room.work,
        room.one,
    )  # fmt: skip
    return True


@inner
def _add_flown(engine: Engine, n: int, t: float, room: Room, ledger: FloatArray) -> None:
    """Add what a segment has lost by t, since its start as it stands in ``room.one``."""
    row = engine.history[n]
    i, kind, segment = int(row[0]), int(row[1]), row[2:]
    disc, one, two = engine.discs[i], room.one, room.two
    start, vx, vy = segment[START], segment[DRIFT_X], segment[DRIFT_Y]
    state_at(kind, segment, disc, engine.lookups, engine.pieces, t, room.work, two)
    lost = kinetic(disc, one[VX], one[VY], one[SPIN]) - kinetic(disc, two[VX], two[VY], two[SPIN])
    over = kinetic(disc, one[VX] - vx, one[VY] - vy, one[SPIN]) - kinetic(
        disc, two[VX] - vx, two[VY] - vy, two[SPIN]
    )
    ledger[DRAG_HEAT if kind == DAMPED else FLOOR_HEAT] += over
    ledger[SUPPORT_WORK] += over - lost
    if kind == STILL and (vx != 0.0 or vy != 0.0):  # the floor holds it against what pulls
        work = _pulled(engine, i, start, t, vx, vy)
        ledger[PULL_WORK] += work
        ledger[SUPPORT_WORK] -= work


@inlined
def _add_event(event: FloatArray, ledger: FloatArray) -> None:
    what = int(event[WHAT])
    ledger[IMPACT_HEAT] += event[LOST]
    ledger[SUPPORT_WORK] += event[LED]
    if what in (STRUCK, PLACED, ADDED):
        ledger[LAUNCH_ENERGY] += event[GOT]
    elif what in (POCKETED, OVER_EDGE, TIPS, REMOVED):
        ledger[LEFT] += event[GOT]
    elif what == IMPACT:
        ledger[DRIVE_WORK] += event[GOT]


@kernel
def tally(engine: Engine, times: FloatArray, room: Room, ends: FloatArray, out: FloatArray) -> None:
    """Ledgers at ascending times, J, one a row; ``ends``: room for all segments and discs."""
    segments, last = engine.counts[N_HISTORY], times.size
    for i in range(engine.discs.shape[0]):
        ends[segments + i] = math.inf
    for n in range(segments - 1, -1, -1):
        i = int(engine.history[n, 0])
        ends[n], ends[segments + i] = ends[segments + i], engine.history[n, 2 + START]
    for k in range(last):
        for column in range(LEDGER_COLUMNS):
            out[k, column] = 0.0
        out[k, LAUNCH_ENERGY] = engine.scale[3] if k == 0 else 0.0
    for n in range(segments):  # all of it, from its end on
        patience(1)
        k = first_from(times, ends[n])
        if k < last and _begin_flown(engine, n, room):
            _add_flown(engine, n, ends[n], room, out[k])
    for n in range(engine.counts[N_WORK_ROWS]):
        end = _end_of(engine, n, ends)
        k = first_from(times, end)
        if k < last:
            add_worked(engine.work_rows[n], end, out[k])
    for n in range(engine.counts[N_EVENTS]):
        k = first_from(times, engine.events[n, TIME])
        if k < last:
            _add_event(engine.events[n], out[k])
    for k in range(1, last):
        for column in range(LEDGER_COLUMNS):
            out[k, column] += out[k - 1, column]
    for n in range(segments):  # and a part of it, on the way
        patience(1)
        begin, end = first_from(times, engine.history[n, 2 + START]), first_from(times, ends[n])
        if begin == end or not _begin_flown(engine, n, room):
            continue
        for k in range(begin, end):
            _add_flown(engine, n, times[k], room, out[k])
    for n in range(engine.counts[N_WORK_ROWS]):
        begin = first_from(times, engine.work_rows[n, WORK_START])
        for k in range(begin, first_from(times, _end_of(engine, n, ends))):
            add_worked(engine.work_rows[n], times[k], out[k])


@inlined
def _end_of(engine: Engine, n: int, ends: FloatArray) -> float:
    """When a row of works ends, perhaps with the segment of those who were sent on with it."""
    row = engine.work_rows[n]
    end, segment = row[WORK_START] + row[DURATION], int(row[SEGMENT])
    return min(end, ends[segment]) if segment >= 0 else end


def ledgers_of(world: World, times: FloatArray) -> FloatArray:
    """Ledgers (times, LEDGER_COLUMNS) of a world at ascending times up to now, J."""
    engine = world._engine
    out = np.empty((len(times), LEDGER_COLUMNS))
    ends = np.empty(int(engine.counts[N_HISTORY]) + len(engine.discs))
    tally(engine, np.asarray(times, np.float64), world._room, ends, out)
    return out


def energies_of(world: World, times: FloatArray, states: FloatArray) -> dict[str, FloatArray]:
    """Kinetic energy of every puck (times, pucks), and heats and works until then (times,), J.

    ``states`` (times, pucks, 6): then.  ``energy_given`` by launches, ``energy_gone`` with who left
    play.
    """
    ledgers = ledgers_of(world, times)
    energies = kinetic_of(world._engine, states[:, world._order])[:, world._place]
    return {"kinetic_energy": energies, **{name: ledgers[:, n] for name, n in NAMES.items()}}


def kinetic_of(engine: Engine, states: FloatArray) -> FloatArray:
    """½ m v² + ½ I ω² of states (..., discs, 6), J; nothing of what is driven."""
    light, turn = engine.discs[:, INV_MASS], engine.discs[:, INV_INERTIA]
    with np.errstate(divide="ignore", invalid="ignore"):
        energy = 0.5 * (states[..., VX] ** 2 + states[..., VY] ** 2) / light
        energy = energy + 0.5 * states[..., SPIN] ** 2 / turn
    return np.where(light > 0.0, energy, 0.0)
