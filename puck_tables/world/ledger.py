"""Where the energy of pucks went over time: floor, drag, rims, impacts; what drives and carries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.holds import allowed_velocity
from puck_tables.scene.ingredients import BLADE, FREE, floor_velocity
from puck_tables.scene.parts import Floor
from puck_tables.scene.pieces import PieceSpec
from puck_tables.world import game as g
from puck_tables.world.agreement import pieces_of
from puck_tables.world.flight import DAMPED, DRIFT_X, DRIFT_Y, PATH, START
from puck_tables.world.holds import edge_of
from puck_tables.world.layout import (
    HOLD,
    HOLD_VX,
    HOLD_VY,
    LIGHTNESS,
    RADIUS,
    TURNABILITY,
)
from puck_tables.world.record import flight_rows, flights_of, states_at
from puck_tables.world.works import (
    DRAG_HEAT,
    DRIVE_WORK,
    FLIGHT,
    FLOOR_HEAT,
    PULL_WORK,
    RIM_HEAT,
    SUPPORT_WORK,
    worked,
)

if TYPE_CHECKING:
    from puck_tables.world.world import World

Moments = tuple[FloatArray, FloatArray]  # when, s, ascending, and how much, J


def energies_of(world: World, times: FloatArray) -> dict[str, FloatArray]:
    """Kinetic energy of every puck (times, pucks), and heats and works until then (times,), J.

    ``energy_given`` by launches, ``energy_gone`` with who left play.  Of motions that are looked up
    the heat of the floor is what the flights lose; of those that are integrated heats and works are
    integrated with them; that of impacts comes from their impulses.
    """
    game = world._game
    free = game.discs[:, LIGHTNESS] > 0.0
    discs, flights = flights_of(game)
    drift = _drift(game, len(discs))
    energies, slips = (_kinetic(game, discs[:, None], one) for one in (flights, flights - drift))
    kinds = game.history[: len(discs), 1]
    known = free[discs] & (kinds != PATH)
    rows = flight_rows(game, times)
    states = states_at(game, times)
    everyone = np.arange(len(game.discs))
    now = _kinetic(game, everyone, states)
    over = _kinetic(game, everyone, states - drift[rows, 0])
    lost = _lost(discs, rows, known, energies, now)
    damped = known & (kinds == DAMPED)
    drag = _lost(discs, rows, damped, slips, over)
    dry = _lost(discs, rows, known & ~damped, slips, over)
    booked = _booked(game, times)
    events = game.events[: game.counts[g.N_EVENTS]]
    hits = events[events[:, g.WHAT] == g.IMPACT]
    struck = events[events[:, g.WHAT] == g.STRUCK]
    gone = events[np.isin(events[:, g.WHAT], (g.POCKETED, g.OVER_EDGE))]
    floor = world.scene.floor
    first = sum(_launched(piece, floor) for piece in pieces_of(world.scene))  # rims may grip
    given = np.array([_given(game, row, discs, energies) for row in struck])
    driven = np.array([_driven(game, row) for row in hits])
    taken = np.array([energies[_before(game, row, discs), 1] for row in gone])
    return {
        "kinetic_energy": now,
        "energy_given": first + _until(times, (struck[:, g.TIME], given)),
        "energy_gone": _until(times, (gone[:, g.TIME], taken)),
        "work_given": booked[PULL_WORK],
        "work_driven": booked[DRIVE_WORK] + _until(times, (hits[:, g.TIME], driven)),
        # of a belt, on what is looked up
        "work_support": booked[SUPPORT_WORK] + dry + drag - lost
        + _until(times, _led(game, hits, discs, flights)),
        "heat_dry": dry + booked[FLOOR_HEAT],
        "heat_viscous": drag + booked[DRAG_HEAT],
        "heat_rims": booked[RIM_HEAT],
        "heat_impact": _until(times, (events[:, g.TIME], events[:, g.LOST])),
    }  # fmt: skip


def _lost(
    discs: g.Whole, rows: g.Whole, which: g.Whole, energies: FloatArray, now: FloatArray
) -> FloatArray:
    """What some flights lost of an energy (flights, 2) until moments with ``rows``, (times,).

    ``now``: the energy then (times, discs).
    """
    whole = np.where(which, energies[:, 0] - energies[:, 1], 0.0)
    total = np.zeros(len(rows))
    for disc in range(rows.shape[1]):
        mine = np.flatnonzero(discs == disc)
        before = np.concatenate([[0.0], np.cumsum(whole[mine])])
        row = rows[:, disc]
        total += before[np.searchsorted(mine, row)]
        total += np.where(which[row], energies[row, 0] - now[:, disc], 0.0)
    return total


def _until(times: FloatArray, moments: Moments) -> FloatArray:
    """The sum of what came until each time."""
    when, values = moments
    order = np.argsort(when, kind="stable")
    sums = np.concatenate([[0.0], np.cumsum(values[order])])
    found: FloatArray = sums[np.searchsorted(when[order], times, side="right")]
    return found


def _booked(game: g.Game, times: FloatArray) -> FloatArray:
    """The ledger (6, times) of all that were integrated, J; a row ends where its flight does."""
    history = game.history[: game.counts[g.N_HISTORY]]
    ends = np.full(len(history) + 1, float(game.clock[0]))  # the last of what has NO_FLIGHT
    for disc in range(len(game.discs)):
        mine = np.flatnonzero(history[:, 0] == disc)
        ends[mine[:-1]] = history[mine[1:], 2 + START]
    rows = game.works[: game.counts[g.N_WORKS]]
    return worked(rows, ends[rows[:, FLIGHT].astype(np.int64)], times)


def _launched(piece: PieceSpec, floor: Floor) -> float:
    """The kinetic energy with which a puck is launched at the start, J."""
    launch = piece.launch
    if piece.path or launch.time > 0.0:  # driven, or struck later
        return 0.0
    rim = piece.gyration * piece.radius * launch.spin
    velocity = allowed_velocity(launch, piece.constraint, floor)
    return 0.5 * piece.mass * (math.hypot(*velocity) ** 2 + rim * rim)


def _kinetic(game: g.Game, discs: g.Whole, states: FloatArray) -> FloatArray:
    """½ m v² + ½ I ω²; nothing of what is driven."""
    light, turn = game.discs[discs, LIGHTNESS], game.discs[discs, TURNABILITY]
    with np.errstate(divide="ignore", invalid="ignore"):
        energy = 0.5 * (states[..., VX] ** 2 + states[..., VY] ** 2) / light
        energy = energy + 0.5 * states[..., SPIN] ** 2 / turn
    return np.where(light > 0.0, energy, 0.0)


def _drift(game: g.Game, flights: int) -> FloatArray:
    """The velocities of belts under flights that drift, as states (flights, 1, 6)."""
    drift = np.zeros((flights, 1, 6))
    drift[:, 0, VX : VY + 1] = game.history[:flights, 2 + DRIFT_X : 2 + DRIFT_Y + 1]
    return drift


def _led(game: g.Game, hits: FloatArray, discs: g.Whole, flights: FloatArray) -> Moments:
    """The works of constraints that move, or that grip a floor that moves, in impacts.

    What a disc gets beside the impulses of its contacts is the constraint's; A V is as before.
    """
    times, works = [], []
    for disc in np.flatnonzero(game.discs[:, HOLD] != FREE):
        mass = 1.0 / game.discs[disc, LIGHTNESS]
        mine = hits[(hits[:, g.WHO] == disc) | (hits[:, g.PARTNER] == disc)]
        for time in np.unique(mine[:, g.TIME]):
            rows = mine[mine[:, g.TIME] == time]
            of = np.flatnonzero(discs == disc)
            start = game.history[of, 2 + START]
            first = int(np.searchsorted(start, time, "left"))
            last = int(np.searchsorted(start, time, "right"))
            before, after = flights[of[max(first - 1, 0)], 1], flights[of[last - 1], 0]
            sign = np.where(rows[:, g.WHO] == disc, 1.0, -1.0)
            nx, ny = sign * rows[:, g.NORMAL_X], sign * rows[:, g.NORMAL_Y]
            rub = rows[:, g.RUB]
            got = mass * (after - before)[VX : VY + 1]
            push = rows[:, g.PUSH]
            got = got + np.array([(push * nx - rub * ny).sum(), (push * ny + rub * nx).sum()])
            kind = int(game.discs[disc, HOLD])
            along = game.discs[disc, [HOLD_VX, HOLD_VY]]
            if kind == BLADE:  # what it grips, and its own side slip across it
                across = np.array([-1.0, 1.0]) * edge_of(game.discs[disc], before)[::-1]
                floor = floor_velocity(game.surface, *before[:2].tolist())[:2]
                along = floor + game.discs[disc, HOLD_VX] * across
            times.append(float(time))
            works.append(float(got @ along))
    return np.array(times), np.array(works)


def _before(game: g.Game, row: FloatArray, discs: g.Whole) -> int:
    """The flight that an event ends."""
    flights = game.history[: len(discs)]
    start = flights[:, 2 + START]
    mine = np.flatnonzero((discs == row[g.WHO]) & (start <= row[g.TIME]))
    after = mine[start[mine] == row[g.TIME]]
    return int(mine[mine < after[0]][-1]) if after.size and after[0] > mine[0] else int(mine[0])


def _given(game: g.Game, row: FloatArray, discs: g.Whole, energies: FloatArray) -> float:
    """The energy that a launch gave."""
    before = _before(game, row, discs)
    mine = np.flatnonzero(discs == row[g.WHO])
    after = mine[mine > before][0]
    return float(energies[after, 0] - energies[before, 1])


def _driven(game: g.Game, row: FloatArray) -> float:
    """The work of driven bodies in an impact: the impulse times the speed of their rim."""
    nx, ny = row[g.NORMAL_X], row[g.NORMAL_Y]
    along = row[g.PUSH] * np.array([nx, ny]) + row[g.RUB] * np.array([-ny, nx])
    work = 0.0
    for disc, sign in ((int(row[g.WHO]), 1.0), (int(row[g.PARTNER]), -1.0)):
        if disc >= 0 and game.discs[disc, LIGHTNESS] == 0.0:
            state = states_at(game, row[g.TIME : g.TIME + 1])[0, disc]
            rim = sign * state[SPIN] * game.discs[disc, RADIUS]
            work += sign * float(along @ (state[VX : VY + 1] + rim * np.array([-ny, nx])))
    return work
