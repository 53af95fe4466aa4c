"""Where boards between calls are kept, and where one is played: arrays in rows, laid out once."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.world.bulk import own_engine
from puck_tables.world.engine_state import REPORTED, Engine, Whole
from puck_tables.world.group_paths import Workplace, workplace_for
from puck_tables.world.lone import LONGEST
from puck_tables.world.passings import COLUMNS
from puck_tables.world.segment_starts import Room, room_for
from puck_tables.world.touching import MOST_BACK

# what is done to boards beside an event by hand: time passes; a disc is led; all are put, but those
# out of play whose rows are what they were
LET_GO, LED, ALL_PUT = -1, -2, -3
# how, beside what the engine says
WAITS, TO_DO, ALONE, LACKS_PIECES = -1, -2, -3, -4
ROWS = 2048  # of events and segments of a board in one call; beyond them it is played alone
_PUSHES = 2  # of all its discs at once, in one call; so are more
REPORT_COLUMNS = 1 + REPORTED  # of an event that is told: its board, then those
_PASSINGS = 64  # passings of lines in one call
_NUMBERS = ("scale", "discs", "segments", "next_time")
_WHOLE = ("kinds", "group", "next_partner", "counts", "drives", "hangs", "held")
SCALES = slice(0, 2)  # where in a row the scales of a board are


class Slots(NamedTuple):
    """What boards keep, in slots: rows of numbers, of whole ones, and of pieces (slots, rows, 21).

    ``due`` (slots,): before when nothing happens, s.
    """

    numbers: FloatArray
    whole: Whole
    pieces: FloatArray
    due: FloatArray


class Bench(NamedTuple):
    """Where a board is played: a state of the engine whose arrays lie in two rows, as in a slot.

    So do ``ended`` (discs,), until when each moved before its segment, ``tail``, the last events,
    and ``seen``, see :class:`puck_tables.world.passings.Passings`.  ``shared``: the pieces of ways
    that all boards have; ``order``: of discs, the number of each puck; ``place``: for
    groups that push.
    """

    engine: Engine
    numbers: FloatArray
    whole: Whole
    ended: FloatArray
    tail: FloatArray
    seen: FloatArray
    passed: Whole
    lines: FloatArray
    reports: FloatArray
    shared: int
    order: Whole
    room: Room
    place: Workplace


class Orders(NamedTuple):
    """What is to be done, a row for each board.

    ``boards``; from which slot to which; ``time`` and ``until``, s; ``discs`` (m,) by hand, with
    ``rows`` (n, m, 6) as :meth:`puck_tables.world.world.World._put` has them and scales ``scales``
    (n, 2) from then on; ``longest``: see :func:`puck_tables.world.lasting.longest_of`.  ``after``,
    to be filled: the time then; ``how``: TO_DO, or what became of it.
    """

    boards: Whole
    source: Whole
    target: Whole
    time: FloatArray
    until: FloatArray
    discs: Whole
    rows: FloatArray
    scales: FloatArray
    longest: FloatArray
    after: FloatArray
    how: Whole


def bench_for(
    engine: Engine, order: Whole, lines: FloatArray, seen: FloatArray, more: int
) -> Bench:
    """Room to play boards that began as an engine did; ``more``: rows for pieces that are kept."""
    count = len(engine.discs)
    own = own_engine(engine, ROWS + 16 * count, more + count, _PUSHES * count * (LONGEST + 1))
    parts: dict[str, Any] = own._asdict()
    numbers, floats = _in_a_row(
        [parts[name] for name in _NUMBERS]
        + [own.regions.floor_map, np.zeros(count), np.zeros((MOST_BACK, 4)), seen]
    )
    whole, ints = _in_a_row([parts[name] for name in _WHOLE])
    *held, floor_map, ended, tail, seen = floats
    own = own._replace(
        regions=own.regions._replace(floor_map=floor_map),
        **dict(zip(_NUMBERS, held, strict=True)), **dict(zip(_WHOLE, ints, strict=True)),
    )  # fmt: skip
    return Bench(
        own, numbers, whole, ended, tail, seen, np.zeros(count + 1, np.int64), lines,
        np.zeros((_PASSINGS, COLUMNS)), int(engine.drives.max()), order, room_for(count),
        workplace_for(own, 3 * count + 16),
    )  # fmt: skip


def _in_a_row(arrays: list[Any]) -> tuple[Any, list[Any]]:
    """One row of all that they hold, and they as views of it."""
    row = np.concatenate([array.ravel() for array in arrays])
    parts = np.split(row, np.cumsum([array.size for array in arrays])[:-1])
    return row, [part.reshape(array.shape) for part, array in zip(parts, arrays, strict=True)]


def lay_out(bench: Bench, engine: Engine, seen: FloatArray) -> Engine:
    """An engine played alone, in the arrays of a bench; rows of what was as it has them."""
    theirs: Any = engine._asdict()
    mine: Any = bench.engine._asdict()
    for name in ("clock", *_NUMBERS, *_WHOLE):
        mine[name][...] = theirs[name]
    if bench.engine.regions.floor_map.size == engine.regions.floor_map.size:  # no law that grew
        bench.engine.regions.floor_map[...] = engine.regions.floor_map
    bench.seen[...] = seen
    return bench.engine._replace(
        events=engine.events, history=engine.history, pieces=engine.pieces,
        work_rows=engine.work_rows,
    )  # fmt: skip
