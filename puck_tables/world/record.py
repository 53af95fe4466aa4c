"""The states of all discs at any moments of the past, from the segments they had."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.world.engine_state import N_HISTORY, Engine, Whole
from puck_tables.world.segment import ROOM, START, state_at


def states_now(engine: Engine, work: FloatArray) -> FloatArray:
    """States of all discs now, array (discs, 6); ``work``: of a room."""
    out = np.empty((len(engine.discs), 6))
    _fill_now(engine, work, out)
    return out


def states_at(engine: Engine, times: FloatArray) -> FloatArray:
    """States of all discs, array (times, discs, 6), at ascending times up to now, s.

    One that has left play stays where it left.
    """
    count, moments = len(engine.discs), np.asarray(times, np.float64)
    rows, segments = np.empty((len(moments), count), np.int64), int(engine.counts[N_HISTORY])
    _fill_rows(engine.history, segments, moments, np.full(count, len(moments)), rows)
    states = states_on(engine, rows.ravel(), np.repeat(moments, count))
    return states.reshape(len(moments), count, 6)


def segments_of(engine: Engine) -> tuple[Whole, FloatArray, FloatArray]:
    """The disc of every segment, when it ended, and its states then and at its start.

    Arrays (segments,), (segments,) and (segments, 2, 6), the start first.
    """
    history = engine.history[: engine.counts[N_HISTORY]]
    discs, starts = history[:, 0].astype(np.int64), history[:, 2 + START]
    ends, own = np.full(len(discs), engine.clock[0]), np.argsort(discs, kind="stable")
    before, after = own[:-1], own[1:]
    one = discs[before] == discs[after]
    ends[before[one]] = starts[after[one]]
    rows = np.repeat(np.arange(len(discs)), 2)
    states = states_on(engine, rows, np.stack([starts, ends], 1).ravel())
    return discs, ends, states.reshape(-1, 2, 6)


def states_on(engine: Engine, rows: Whole, times: FloatArray) -> FloatArray:
    """States (n, 6) on the segments in these rows at these times."""
    out = np.empty((len(rows), 6))
    _fill(engine, rows, times, np.empty(ROOM), out)
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
    history: FloatArray, segments: int, times: FloatArray, open_to: Whole, out: Whole
) -> None:
    """On which segments discs are, rows of the history (times, discs).

    ``open_to`` (discs,): before which time nothing is filled yet, at first all.
    """
    for n in range(segments - 1, -1, -1):
        i = int(history[n, 0])
        begin = first_from(times, history[n, 2 + START])
        for k in range(begin, open_to[i]):
            patience(1)
            out[k, i] = n
        open_to[i] = min(open_to[i], begin)


@kernel
def _fill_now(engine: Engine, work: FloatArray, out: FloatArray) -> None:
    for i in range(engine.discs.shape[0]):
        state_at(
            engine.kinds[i], engine.segments[i], engine.discs[i], engine.lookups, engine.pieces,
            engine.clock[0], work, out[i],
        )  # fmt: skip


@kernel
def _fill(
    engine: Engine, rows: Whole, times: FloatArray, work: FloatArray, out: FloatArray
) -> None:
    for n in range(rows.size):
        patience(1)
        segment = engine.history[rows[n]]
        state_at(
            int(segment[1]), segment[2:], engine.discs[int(segment[0])], engine.lookups,
            engine.pieces, times[n], work, out[n],
        )  # fmt: skip
