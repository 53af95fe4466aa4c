"""Where the energy of several pucks went: floor, rims, impacts; what drives, pulls and carries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.holds import allowed_velocity
from puck_tables.scene.ingredients import BLADE, FREE, floor_velocity
from puck_tables.scene.parts import Floor
from puck_tables.scene.pieces import Piece
from puck_tables.world import game as g
from puck_tables.world.agreement import pieces_of
from puck_tables.world.flight import DRIFT_X, DRIFT_Y, PATH, START
from puck_tables.world.holds import edge_of
from puck_tables.world.layout import (
    HOLD,
    HOLD_VX,
    HOLD_VY,
    LIGHTNESS,
    RADIUS,
    TURNABILITY,
)
from puck_tables.world.record import flights_of, states_at
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


def ledger(world: World) -> dict[str, float]:
    """Kinetic energy given by launches, heats, and works of driven bodies, forces and supports, J.

    Of motions that are looked up the heat of the floor is what the flights lose; of those that are
    integrated heats and works are integrated with them; that of impacts comes from their impulses.
    ``energy_residual``: what is missing, as a share of the largest entry.
    """
    game = world._game
    free = game.discs[:, LIGHTNESS] > 0.0
    discs, flights = flights_of(game)
    energies = _kinetic(game, discs[:, None], flights)
    known = free[discs] & (game.history[: len(discs), 1] != PATH)
    booked = _booked(game)
    over = flights - _drift(game, len(discs))
    slips = _kinetic(game, discs[:, None], over)
    lost = float((energies[known, 0] - energies[known, 1]).sum())
    floor = float((slips[known, 0] - slips[known, 1]).sum())
    support = floor - lost + booked[SUPPORT_WORK]  # of a belt, on what is looked up
    floor += booked[FLOOR_HEAT] + booked[DRAG_HEAT]
    events = game.events[: game.counts[g.N_EVENTS]]
    impacts = float(events[:, g.LOST].sum())
    count = len(game.discs)
    floor_of = world.scene.floor
    given = sum(_launched(piece, floor_of) for piece in pieces_of(world.scene))  # rims may grip
    given += sum(
        _given(game, row, discs, energies) for row in events[events[:, g.WHAT] == g.STRUCK]
    )
    driven = sum(_driven(game, row) for row in events[events[:, g.WHAT] == g.IMPACT])
    driven = float(driven + booked[DRIVE_WORK])
    support += _led(game, events, discs, flights)
    forces, rims = booked[PULL_WORK], booked[RIM_HEAT]
    gone = sum(
        energies[_before(game, row, discs), 1]
        for row in events if row[g.WHAT] in (g.POCKETED, g.OVER_EDGE)
    )  # fmt: skip
    everyone = np.arange(count)
    now = states_at(game, game.clock)[0]
    left = float(_kinetic(game, everyone, now)[free].sum()) + gone
    entries = [given, floor, rims, impacts, driven, forces, support, left]
    largest = max(map(abs, entries))
    missing = abs(given + driven + forces + support - floor - rims - impacts - left)
    return {
        "kinetic_energy": given, "heat_floor": floor, "heat_rims": rims, "heat_impact": impacts,
        "work_driven": driven, "work_given": forces, "work_support": support,
        "energy_residual": missing / largest if largest else 0.0,
    }  # fmt: skip


def _booked(game: g.Game) -> list[float]:
    """What was booked of all that were integrated, up to where their flights ended."""
    history = game.history[: game.counts[g.N_HISTORY]]
    ends = np.full(len(history) + 1, float(game.clock[0]))  # the last of what has NO_FLIGHT
    for disc in range(len(game.discs)):
        mine = np.flatnonzero(history[:, 0] == disc)
        ends[mine[:-1]] = history[mine[1:], 2 + START]
    rows = game.works[: game.counts[g.N_WORKS]]
    booked: list[float] = worked(rows, ends[rows[:, FLIGHT].astype(np.int64)]).tolist()
    return booked


def _launched(piece: Piece, floor: Floor) -> float:
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


def _led(game: g.Game, events: FloatArray, discs: g.Whole, flights: FloatArray) -> float:
    """The work of constraints that move, or that grip a floor that moves, in impacts.

    What a disc gets beside the impulses of its contacts is the constraint's; A V is as before.
    """
    work = 0.0
    hits = events[events[:, g.WHAT] == g.IMPACT]
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
            work += float(got @ along)
    return work


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
