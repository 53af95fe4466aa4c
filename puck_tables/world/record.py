"""The states of all discs at any moments of the past, from the flights they had."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.world.flight import ROOM, START, state_at
from puck_tables.world.game import N_HISTORY, Game, Whole


def states_now(game: Game, work: FloatArray) -> FloatArray:
    """States of all discs now, array (discs, 6); ``work``: of a room."""
    out = np.empty((len(game.discs), 6))
    _fill_now(game, work, out)
    return out


def states_at(game: Game, times: FloatArray) -> FloatArray:
    """States of all discs, array (times, discs, 6), at ascending times up to now, s.

    One that has left play stays where it left.
    """
    count, moments = len(game.discs), np.asarray(times, np.float64)
    rows, flights = np.empty((len(moments), count), np.int64), int(game.counts[N_HISTORY])
    _fill_rows(game.history, flights, moments, np.full(count, len(moments)), rows)
    states = states_on(game, rows.ravel(), np.repeat(moments, count))
    return states.reshape(len(moments), count, 6)


def flights_of(game: Game) -> tuple[Whole, FloatArray, FloatArray]:
    """The disc of every flight, when it ended, and its states then and at its start.

    Arrays (flights,), (flights,) and (flights, 2, 6), the start first.
    """
    history = game.history[: game.counts[N_HISTORY]]
    discs, starts = history[:, 0].astype(np.int64), history[:, 2 + START]
    ends, own = np.full(len(discs), game.clock[0]), np.argsort(discs, kind="stable")
    before, after = own[:-1], own[1:]
    one = discs[before] == discs[after]
    ends[before[one]] = starts[after[one]]
    rows = np.repeat(np.arange(len(discs)), 2)
    states = states_on(game, rows, np.stack([starts, ends], 1).ravel())
    return discs, ends, states.reshape(-1, 2, 6)


def states_on(game: Game, rows: Whole, times: FloatArray) -> FloatArray:
    """States (n, 6) on the flights in these rows at these times."""
    out = np.empty((len(rows), 6))
    _fill(game, rows, times, np.empty(ROOM), out)
    return out


@inlined
def first_from(times: FloatArray, t: float) -> int:
    """The first of ascending times that is not before t; their number: none."""
    low, high = 0, times.size
    while low < high:
        middle = (low + high) // 2
        if times[middle] < t:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _fill_rows(
    history: FloatArray, flights: int, times: FloatArray, open_to: Whole, out: Whole
) -> None:
    """On which flights discs are, rows of the history (times, discs).

    ``open_to`` (discs,): before which time nothing is filled yet, at first all.
    """
    for n in range(flights - 1, -1, -1):
        i = int(history[n, 0])
        begin = first_from(times, history[n, 2 + START])
        for k in range(begin, open_to[i]):
            patience(1)
            out[k, i] = n
        open_to[i] = min(open_to[i], begin)


@kernel
def _fill_now(game: Game, work: FloatArray, out: FloatArray) -> None:
    for i in range(game.discs.shape[0]):
        state_at(
            game.kinds[i], game.flights[i], game.discs[i], game.curves, game.pieces,
            game.clock[0], work, out[i],
        )  # fmt: skip


@kernel
def _fill(game: Game, rows: Whole, times: FloatArray, work: FloatArray, out: FloatArray) -> None:
    for n in range(rows.size):
        patience(1)
        flight = game.history[rows[n]]
        state_at(
            int(flight[1]), flight[2:], game.discs[int(flight[0])], game.curves, game.pieces,
            times[n], work, out[n],
        )  # fmt: skip
