"""Many runs of one board that differ in nothing but launches, compiled, without events kept.

What is kept of a disc is what it went through: which impacts led to where it ends.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import in_slices
from puck_tables.kernels.compile import inner, kernel, patience
from puck_tables.scene.friction import VX
from puck_tables.world.engine import EVERYBODY, NOBODY, advance
from puck_tables.world.engine_state import (
    CONTACT,
    COUNTS,
    IMPACT,
    N_EVENTS,
    N_HISTORY,
    N_IMPACTS,
    N_PIECES,
    OVER_EDGE,
    PARTNER,
    POCKETED,
    TIPS,
    WHAT,
    WHO,
    Engine,
    Whole,
    copy_of,
)
from puck_tables.world.floor_under import least_slip, moves_along
from puck_tables.world.lasting import GOES_ON, at_rest_below, limits_of, next_target
from puck_tables.world.layout import RADIUS, write_over
from puck_tables.world.ledger import LEDGER_COLUMNS, tally
from puck_tables.world.lone import LONGEST
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.prepare import fastest, scales_of
from puck_tables.world.segment import GONE, START, moves_until, state_at
from puck_tables.world.segment_starts import Room, room_for
from puck_tables.world.setting_off import FULL, PAUSED, PUSHING, REACHED
from puck_tables.world.step_ledger import WORK_COLUMNS

PRINT, LENGTH, OUTCOME, PASSES = range(4)  # columns of a sequence
SEQUENCE_COLUMNS = 4  # the four above

_PRIME = 2147483647  # products of two numbers below it fit 64 bits
_LOOKS = 6  # at a slide before its end: at Q/2J, Q/4J, ...
MOST_ROWS = 1 << 16  # of events and segments, and of steps: 60 MB
END_COLUMNS = 6  # of a puck: its state at the end
_JUST = 1e-15  # of a time: before it


@kernel
def trace(
    engine: Engine, disc: int, through: int, prints: Whole, marks: Whole, sequence: Whole
) -> None:
    """The impact sequence of a disc, from the events of a run.

    ``sequence`` (4,): a print, the same for runs in which the same impacts led there (in whatever
    order those happened that do not bear on each other); how many; the obstacle −1 − k by which it
    left play, or 0; whether the disc ``through`` was in one of them, 1 or 0.

    ``prints``, ``marks`` (n,): room.
    """
    for i in range(engine.discs.shape[0]):
        prints[i], marks[i] = i + 1, 0
    events = engine.counts[N_EVENTS]
    sequence[OUTCOME] = 0
    for n in range(events):
        patience(1)
        what, i = int(engine.events[n, WHAT]), int(engine.events[n, WHO])
        if what not in (IMPACT, CONTACT, POCKETED, OVER_EDGE, TIPS):
            continue
        j = int(engine.events[n, PARTNER])
        other = prints[j] if j >= 0 else (-j * 742938285) % _PRIME
        both = (prints[i] + other) % _PRIME * 48271 + prints[i] * other % _PRIME * 16807 + what
        prints[i] = (both % _PRIME * 40692 + i + 1) % _PRIME
        if j >= 0:
            prints[j] = (both % _PRIME * 40692 + j + 1) % _PRIME
        elif i == disc and what in (POCKETED, OVER_EDGE):
            sequence[OUTCOME] = j
    sequence[PRINT], sequence[LENGTH], sequence[PASSES] = prints[disc], 0, 0
    marks[disc] = 1
    for back in range(events):
        row = engine.events[events - 1 - back]
        what, i, j = int(row[WHAT]), int(row[WHO]), int(row[PARTNER])
        if what not in (IMPACT, CONTACT):
            continue
        if marks[i] == 1 or (j >= 0 and marks[j] == 1):
            marks[i] = 1
            if j >= 0:
                marks[j] = 1
                if through in (i, j):
                    sequence[PASSES] = 1
            sequence[LENGTH] += 1


class Ends(NamedTuple):
    """States (runs, pucks, 6) at the end, whether in play, and at rest on the floor, (runs, pucks).

    End time, impacts, and how it ended.

    ``how`` (runs,): as :func:`puck_tables.world.engine.advance` says, or without a time
    :func:`puck_tables.world.lasting.next_target`.  ``sequences`` (runs, 4): of
    the disc that is watched, see :func:`puck_tables.world.bulk.trace`.
    ``ledgers`` (runs, 9):
    where energy went, see :mod:`puck_tables.world.ledger`; of runs that are watched none.
    """

    states: FloatArray
    in_play: FloatArray
    carried: FloatArray
    time: FloatArray
    impacts: FloatArray
    how: Whole
    sequences: Whole
    ledgers: FloatArray


@inner
def _to_the_end(
    engine: Engine, until: float, limit: float, prescribed: float, struck: int, room: Room,
    work: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """Run it until a time, or, if that is inf, until nothing more can happen; how, and when."""
    endless, how, target = until == math.inf, GOES_ON, until
    if endless:
        target = limit if engine.surface.spin == 0.0 else engine.clock[0]
    while how == GOES_ON:
        how = advance(engine, target, struck, room)
        struck = NOBODY
        while how == PAUSED:
            how = advance(engine, target, struck, room)
        if endless and how == REACHED:
            how, target = next_target(engine, limit, prescribed, room, work)
    return how, target


@kernel
def _follow_all(
    engine: Engine, fresh: FloatArray, kinds: Whole, hangs: Whole, segments: FloatArray,
    first: FloatArray, discs: Whole, launches: FloatArray, scales: FloatArray, until: float,
    limits: FloatArray, prescribed: float, watch: Whole, room: Room, rows: FloatArray,
    ends: Ends,
) -> None:  # fmt: skip
    """Runs from the states ``first`` (n, 6), with launches (runs, m, 3) of the ``discs`` (m,).

    ``scales`` (runs, 2): the scales of each, so that none depends on others; ``limits`` (runs,) and
    ``prescribed``: see :func:`puck_tables.world.lasting.limits_of`.  ``watch`` (3,): the
    disc whose sequences are wanted, −1: none; the one that they are to pass; and how many impacts
    they may have: a run is given up when there are more.
    """
    patience(launches.shape[0])
    count, driven = first.shape[0], 0
    for i in range(count):
        driven = max(driven, engine.drives[i, 1])
    for run in range(launches.shape[0]):
        engine.clock[0] = 0.0
        engine.scale[0], engine.scale[1] = scales[run, 0], scales[run, 1]
        for column in range(COUNTS):
            engine.counts[column] = driven if column == N_PIECES else 0
        for i in range(count):
            engine.kinds[i], engine.group[i] = kinds[i], 0
            write_over(engine.discs[i], fresh[i])
            write_over(engine.segments[i], segments[i])
            write_over(engine.hangs[i], hangs[i])
            write_over(room.states[i], first[i])
        for m in range(discs.size):
            write_over(room.states[discs[m], VX:], launches[run, m])
        looks = _LOOKS if watch[0] >= 0 else 0
        struck = EVERYBODY
        for look in range(looks, -1, -1):
            part = engine.scale[0] / engine.scale[1] * 0.5**look if look > 0 else until
            how, ended = _to_the_end(
                engine, min(part, until), limits[run], prescribed, struck, room, ends.in_play[run]
            )
            struck = NOBODY
            if watch[0] >= 0:
                trace(engine, watch[0], watch[1], room.shares, room.marks, ends.sequences[run])
                if ends.sequences[run, LENGTH] > watch[2]:
                    break
            if how != REACHED:
                break
        ends.how[run] = how
        last = 0.0
        for i in range(count):
            kind, segment = engine.kinds[i], engine.segments[i]
            last = max(last, segment[START], moves_until(kind, segment))
        if until == math.inf and moves_along(engine.surface):
            last = at = ended
        else:
            last, at = min(last, until), until
        ends.time[run], ends.impacts[run] = last, engine.counts[N_IMPACTS]
        for i in range(count):
            kind, segment = engine.kinds[i], engine.segments[i]
            if kind == GONE and count == 1:  # its run ends as it leaves
                row = engine.history[engine.counts[N_HISTORY] - 2]
                kind, at, segment = int(row[1]), segment[START], row[2:]
                last = at * (1.0 - _JUST)  # before what leaves takes its energy along
            state_at(
                kind, segment, engine.discs[i], engine.lookups, engine.pieces, at, room.work,
                ends.states[run, i],
            )  # fmt: skip
            ends.in_play[run, i] = 0.0 if engine.kinds[i] == GONE else 1.0
            slip = least_slip(engine, i, ends.states[run, i], at)
            ends.carried[run, i] = ends.in_play[run, i] if slip <= at_rest_below(engine) else 0.0
        if watch[0] < 0:
            rows[0] = last
            tally(engine, rows[:1], room, rows[1:], ends.ledgers[run : run + 1])


def follow_all(
    engine: Engine, first: FloatArray, discs: Whole, launches: FloatArray, until: float,
    watch: tuple[int, int, int] = (-1, -1, 0),
) -> Ends:  # fmt: skip
    """The ends of runs of a board at its start, with launches (runs, m, 3) of some discs.

    ``watch``: the disc whose sequences are wanted, one that they are to pass (−1: none), and how
    many impacts they may have: runs with more are given up where they are.  A board where more
    happens than rows are there for gets more rows, and is run again.
    """
    runs, count = len(launches), len(engine.discs)
    ends = Ends(
        np.empty((runs, count, END_COLUMNS)), np.empty((runs, count)), np.empty((runs, count)),
        np.empty(runs), np.empty(runs), np.empty(runs, np.int64),
        np.zeros((runs, SEQUENCE_COLUMNS), np.int64), np.zeros((runs, LEDGER_COLUMNS)),
    )  # fmt: skip
    scales = _scales(engine, first, discs, launches)
    limits, prescribed = limits_of(engine, scales)
    room, rows = room_for(count), 256 + 16 * count
    mine = own_engine(engine, rows)

    def work(start: int, stop: int) -> None:
        columns: Any = [one[start:stop] for one in ends]
        _follow_all(
            mine, engine.discs, engine.kinds, engine.hangs, engine.segments, first, discs,
            launches[start:stop], scales[start:stop], until, limits[start:stop], prescribed,
            np.array(watch), room, np.empty(1 + len(mine.history) + count),
            Ends(*columns),
        )  # fmt: skip

    in_slices(work, runs)
    full = np.flatnonzero(ends.how == FULL)
    while full.size:
        if rows > MOST_ROWS:
            ends.how[full] = PUSHING
            break
        rows *= 4
        mine = own_engine(engine, rows)
        for run in full:
            work(int(run), int(run) + 1)
        full = full[ends.how[full] == FULL]
    return ends


def _scales(engine: Engine, first: FloatArray, discs: Whole, launches: FloatArray) -> FloatArray:
    """The scales of every run, (runs, 2), see :func:`puck_tables.world.prepare.scales_of`."""
    others = first.copy()
    others[discs, VX:] = 0.0
    slips = np.hypot(
        np.hypot(launches[:, :, 0], launches[:, :, 1]),
        engine.discs[discs, RADIUS] * launches[:, :, 2],
    )
    slowest = fastest(engine, others)
    return scales_of(engine, np.maximum(slowest, slips.max(axis=1, initial=0.0)))


def own_engine(engine: Engine, rows: int, more: int = 0, pushed: int = 0) -> Engine:
    """A copy to run on, with so many rows for events and segments; for paths if there are any.

    ``more``: rows for paths beside these; ``pushed``: of groups that push.
    """
    steps = pushed + (rows + LONGEST if engine.floors[:, 2].any() else 0)
    pieces = np.zeros((more + steps, PIECE_COLUMNS))
    return copy_of(engine)._replace(
        clock=np.zeros(1), pieces=np.vstack([engine.pieces, pieces]),
        work_rows=np.zeros((steps, WORK_COLUMNS)), events=np.zeros((rows, engine.events.shape[1])),
        history=np.zeros((rows, engine.history.shape[1])),
    )  # fmt: skip
