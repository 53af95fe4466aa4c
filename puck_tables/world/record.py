"""The states of all discs at any moments of the past, from the flights they had."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import kernel
from puck_tables.world.flight import ROOM, START, state_at
from puck_tables.world.game import N_HISTORY, Game, Whole


def states_at(game: Game, times: FloatArray) -> FloatArray:
    """States of all discs, array (times, discs, 6), at times up to now, ascending, s.

    One that has left play stays where it left.
    """
    history = game.history[: game.counts[N_HISTORY]]
    order = np.argsort(history[:, 0], kind="stable")
    first = np.searchsorted(history[order, 0], np.arange(len(game.discs) + 1))
    out = np.empty((len(times), len(game.discs), 6))
    _fill(game, order, first, np.ascontiguousarray(times, np.float64), np.empty(ROOM), out)
    return out


@kernel
def _fill(
    game: Game, order: Whole, first: Whole, times: FloatArray, work: FloatArray, out: FloatArray
) -> None:
    for i in range(first.size - 1):
        row, last = first[i], first[i + 1] - 1
        for n in range(times.size):
            while row < last and game.history[order[row + 1], 2 + START] <= times[n]:
                row += 1
            flight = game.history[order[row]]
            state_at(
                int(flight[1]), flight[2:], game.discs[i], game.curves, game.pieces, times[n],
                work, out[n, i],
            )  # fmt: skip


def flights_of(game: Game) -> tuple[Whole, FloatArray]:
    """The disc of every flight, and its states at the start and the end, array (flights, 2, 6)."""
    history = game.history[: game.counts[N_HISTORY]]
    discs = history[:, 0].astype(np.int64)
    order = np.lexsort((np.arange(len(discs)), discs))
    start = history[:, 2 + START]
    end = np.full(len(discs), game.clock[0])
    same = discs[order[1:]] == discs[order[:-1]]
    end[order[:-1][same]] = start[order[1:][same]]
    out = np.empty((len(discs), 2, 6))
    _fill_ends(game, discs, np.stack([start, end], axis=1), np.empty(ROOM), out)
    return discs, out


@kernel
def _fill_ends(
    game: Game, discs: Whole, times: FloatArray, work: FloatArray, out: FloatArray
) -> None:
    for row in range(discs.size):
        flight = game.history[row]
        for n in range(2):
            state_at(
                int(flight[1]), flight[2:], game.discs[discs[row]], game.curves, game.pieces,
                times[row, n], work, out[row, n],
            )  # fmt: skip
