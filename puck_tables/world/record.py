"""The states of all discs at any moments of the past, from the flights they had."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import kernel, patience
from puck_tables.world.flight import ROOM, START, state_at
from puck_tables.world.game import N_HISTORY, Game, Whole


def states_at(game: Game, times: FloatArray) -> FloatArray:
    """States of all discs, array (times, discs, 6), at times up to now, s.

    One that has left play stays where it left.
    """
    rows = flight_rows(game, times)
    moments = np.repeat(np.asarray(times, np.float64), len(game.discs))
    return states_on(game, rows.ravel(), moments).reshape(len(times), len(game.discs), 6)


def flight_rows(game: Game, times: FloatArray) -> Whole:
    """On which flights the discs are, rows of the history, array (times, discs)."""
    discs, starts = _flights(game)
    rows = np.empty((len(times), len(game.discs)), np.int64)
    for i in range(len(game.discs)):
        mine = np.flatnonzero(discs == i)
        rows[:, i] = mine[np.searchsorted(starts[mine[1:]], times, side="right")]
    return rows


def flights_of(game: Game) -> tuple[Whole, FloatArray]:
    """The disc of every flight, and its states at the start and the end, array (flights, 2, 6)."""
    discs, starts = _flights(game)
    ends = np.full(len(discs), game.clock[0])
    for i in range(len(game.discs)):
        mine = np.flatnonzero(discs == i)
        ends[mine[:-1]] = starts[mine[1:]]
    rows = np.repeat(np.arange(len(discs)), 2)
    return discs, states_on(game, rows, np.stack([starts, ends], 1).ravel()).reshape(-1, 2, 6)


def _flights(game: Game) -> tuple[Whole, FloatArray]:
    """The disc and the start of every flight, in the order in which they began."""
    history = game.history[: game.counts[N_HISTORY]]
    return history[:, 0].astype(np.int64), history[:, 2 + START].copy()


def states_on(game: Game, rows: Whole, times: FloatArray) -> FloatArray:
    """States (n, 6) on the flights in these rows at these times."""
    out = np.empty((len(rows), 6))
    _fill(game, rows, times, np.empty(ROOM), out)
    return out


@kernel
def _fill(game: Game, rows: Whole, times: FloatArray, work: FloatArray, out: FloatArray) -> None:
    for n in range(rows.size):
        patience(1)
        flight = game.history[rows[n]]
        state_at(
            int(flight[1]), flight[2:], game.discs[int(flight[0])], game.curves, game.pieces,
            times[n], work, out[n],
        )  # fmt: skip
