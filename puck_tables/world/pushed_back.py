"""What pucks gave a disc that is driven: by impacts, and by pushing it for a while."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.world.engine_state import (
    IMPACT,
    N_EVENTS,
    N_HISTORY,
    N_WORKS,
    NORMAL_X,
    NORMAL_Y,
    PARTNER,
    PUSH,
    RUB,
    WHAT,
    WHO,
    Engine,
)
from puck_tables.world.segment import START
from puck_tables.world.step_ledger import (
    BACK_X,
    BACK_Y,
    DURATION,
    LED_BY,
    LEDGER,
    SEGMENT,
    SEVERAL,
    add_worked,
)
from puck_tables.world.step_ledger import START as BEGINS


class Reported(NamedTuple):
    """Until when it was told: time, s, how many events and works, and the first not at its end."""

    time: float = 0.0
    events: int = 0
    work_rows: int = 0
    open: int = 0


def pushed_back(engine: Engine, i: int, since: Reported) -> tuple[FloatArray, Reported]:
    """The impulse (2,) N s on a disc since then, and until when it is told now.

    NaN where several that are driven pushed the same pucks: nobody knows how they share it.
    """
    now, counts = float(engine.clock[0]), engine.counts
    impulse = _of_impacts(engine.events[since.events : counts[N_EVENTS]], i)
    still_open = int(counts[N_WORKS])
    ends: dict[int, float] = {}
    for n in range(since.open, int(counts[N_WORKS])):
        row = engine.work_rows[n]
        segment = int(row[SEGMENT])
        if segment not in ends:
            ends[segment] = _end_of(engine, segment)
        cut = ends[segment]
        if min(float(row[BEGINS] + row[DURATION]), cut) > now:
            still_open = min(still_open, n)
        driver = int(row[LED_BY])
        if driver not in (i, SEVERAL) or min(now, cut) < row[BEGINS]:
            continue
        given = _worked(row, min(now, cut))
        if n < since.work_rows:
            given -= _worked(row, min(since.time, cut))
        impulse += given if driver == i else math.nan
    return impulse, Reported(now, int(counts[N_EVENTS]), int(counts[N_WORKS]), still_open)


def _of_impacts(events: FloatArray, i: int) -> FloatArray:
    """The impulse (2,) of impacts on a disc."""
    hits = events[events[:, WHAT] == IMPACT]
    sign = (hits[:, PARTNER] == i) * 1.0 - (hits[:, WHO] == i)
    nx, ny, push, rub = hits[:, [NORMAL_X, NORMAL_Y, PUSH, RUB]].T
    return np.array([sign @ (push * nx - rub * ny), sign @ (push * ny + rub * nx)])


def _worked(row: FloatArray, t: float) -> FloatArray:
    """What of a row was given by t."""
    ledger = np.zeros(LEDGER)
    if t >= row[BEGINS]:
        add_worked(row, t, ledger)
    return ledger[[BACK_X, BACK_Y]]


def _end_of(engine: Engine, segment: int) -> float:
    """When a segment, a row of the history, ended; inf: not yet, or it is none."""
    if segment < 0:
        return math.inf
    later = engine.history[segment + 1 : engine.counts[N_HISTORY]]
    own = np.flatnonzero(later[:, 0] == engine.history[segment, 0])
    return float(later[own[0], 2 + START]) if own.size else math.inf
