"""Boards between calls, each a row of numbers in a store, and the kernel that plays them.

Of what was a board keeps what is still asked for: until when its discs moved before their segments,
and its last events, by which the engine tells what is squeezed.  To play it, its row is copied to a
bench, an engine with room for much; done without a hitch it goes to another row, so that
what fails leaves all boards as they were.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.friction import VX
from puck_tables.world.bench import (
    ALL_PUT,
    LACKS_PIECES,
    LED,
    LET_GO,
    REPORT_COLUMNS,
    TO_DO,
    WAITS,
    Bench,
    Orders,
    Slots,
)
from puck_tables.world.by_hand import lead
from puck_tables.world.engine import NOBODY, THOSE_LEFT, advance
from puck_tables.world.engine_state import (
    LAUNCH_TIME,
    N_AT_ONCE,
    N_CONTACTS,
    N_EVENTS,
    N_HISTORY,
    N_LAUNCHES,
    N_PIECES,
    N_WORK_ROWS,
    PATH_ENDS,
    PLACED,
    REPORTED,
    Engine,
    Whole,
)
from puck_tables.world.floor_under import law_goes_to
from puck_tables.world.groups import push_on
from puck_tables.world.lasting import GOES_ON, ROUND, moves_on, next_target, prescribed_until
from puck_tables.world.layout import INV_MASS, write_over
from puck_tables.world.passings import COLUMNS, FROM, LINE, NEXT, SIDE, UNKNOWN, find_passings
from puck_tables.world.paths import FOR_EVER
from puck_tables.world.segment import (
    FIRST_PIECE,
    GONE,
    LAST_PIECE,
    LOOKED_UP,
    PATH,
    SEGMENT_COLUMNS,
    START,
    UNTIL,
    moves_until,
    state_at,
)  # fmt: skip
from puck_tables.world.segment_starts import CURRENT, STALE, Room, locate
from puck_tables.world.setting_off import FULL, PAUSED, PUSHING, REACHED
from puck_tables.world.touching import MOST_BACK


@inlined
def _take(store: Slots, slot: int, time: float, bench: Bench) -> None:
    """Copy a board to the bench, with a segment before that of each disc: until when it moved."""
    engine, count = bench.engine, bench.ended.size
    for column in range(bench.numbers.size):
        bench.numbers[column] = store.numbers[slot, column]
    for column in range(bench.whole.size):
        bench.whole[column] = store.whole[slot, column]
    engine.clock[0] = time
    for row in range(bench.shared, engine.counts[N_PIECES]):
        for column in range(engine.pieces.shape[1]):
            engine.pieces[row, column] = store.pieces[slot, row - bench.shared, column]
    for i in range(count):
        before, row = engine.history[i], engine.history[count + i]
        before[0], before[1] = i, LOOKED_UP
        before[2 + START], before[2 + UNTIL] = 0.0, bench.ended[i]
        row[0], row[1] = i, engine.kinds[i]
        for column in range(SEGMENT_COLUMNS):
            row[2 + column] = engine.segments[i, column]
        bench.passed[i] = count + i
    bench.passed[count] = 2 * count
    for n in range(engine.counts[N_EVENTS]):
        write_over(engine.events[n], bench.tail[n])


@kernel
def take(store: Slots, slot: int, time: float, bench: Bench) -> None:
    """Copy a board to the bench."""
    patience(1 + bench.numbers.size // 1000)
    _take(store, slot, time, bench)


@inlined
def _own_rows(engine: Engine, i: int, shared: int) -> tuple[int, int]:
    """The pieces of a disc that other boards do not have: of its way, or of its segment."""
    first, last = engine.drives[i, 0], engine.drives[i, 1]
    if first >= last and engine.kinds[i] == PATH:
        first, last = int(engine.segments[i, FIRST_PIECE]), int(engine.segments[i, LAST_PIECE])
    return (first, last) if shared <= first < last else (0, 0)


@inlined
def _keep_pieces(engine: Engine, shared: int, pieces: FloatArray) -> bool:
    """Keep the pieces that boards do not share, one after the other, if there is room."""
    count, own = engine.discs.shape[0], 0
    for i in range(count):
        first, last = _own_rows(engine, i, shared)
        own += last - first
    if own > pieces.shape[0]:
        return False
    own = 0
    for i in range(count):
        first, last = _own_rows(engine, i, shared)
        for row in range(first, last):
            for column in range(pieces.shape[1]):
                pieces[own + row - first, column] = engine.pieces[row, column]
        if last > first:
            if engine.kinds[i] == PATH:
                engine.segments[i, FIRST_PIECE] += shared + own - first
                engine.segments[i, LAST_PIECE] += shared + own - first
            if engine.drives[i, 0] < engine.drives[i, 1]:
                engine.drives[i, 0], engine.drives[i, 1] = shared + own, shared + own + last - first
        own += last - first
    engine.counts[N_PIECES] = shared + own
    return True


@inlined
def _find_ends(engine: Engine, room: Room, ended: FloatArray) -> None:
    """Until when discs moved before their segments of now, s; 0: they never did."""
    for i in range(ended.size):
        ended[i], end = 0.0, -1.0
        for n in range(engine.counts[N_HISTORY] - 1, -1, -1):
            if int(engine.history[n, 0]) == i:
                moved = moves_on(engine, n, end, room) if end >= 0.0 else -math.inf
                if moved >= 0.0:
                    ended[i] = moved
                    break
                end = engine.history[n, 2 + START]


@inlined
def _next_due(engine: Engine, seen: FloatArray) -> float:
    """Before when nothing happens, nor is passed; −inf: perhaps now."""
    due, done = math.inf, engine.counts[N_LAUNCHES]
    if done < engine.launches.shape[0]:
        due = engine.launches[done, LAUNCH_TIME]
    for i in range(engine.discs.shape[0]):
        due = min(due, engine.next_time[i])
        for k in range(seen.shape[1] if engine.kinds[i] != GONE else 0):
            for part in range(2):
                if seen[i, k, part, SIDE] != UNKNOWN:
                    looked = seen[i, k, part, NEXT]
                    due = min(due, looked if looked >= 0.0 else seen[i, k, part, FROM])
    return due


@inner
def _put_away(engine: Engine, bench: Bench, store: Slots, slot: int) -> bool:
    """Copy what a board keeps to a slot, if its pieces have room there."""
    count = bench.ended.size
    _find_ends(engine, bench.room, bench.ended)
    if not _keep_pieces(engine, bench.shared, store.pieces[slot]):
        return False
    events = engine.counts[N_EVENTS]
    kept = min(events, MOST_BACK)
    for n in range(kept):
        row = bench.tail[n]
        write_over(row, engine.events[events - kept + n, : row.size])
    engine.counts[N_EVENTS], engine.counts[N_HISTORY] = kept, 2 * count
    engine.counts[N_WORK_ROWS] = 0
    store.due[slot] = _next_due(engine, bench.seen)
    for column in range(bench.numbers.size):
        store.numbers[slot, column] = bench.numbers[column]
    for column in range(bench.whole.size):
        store.whole[slot, column] = bench.whole[column]
    return True


@kernel
def put_away(engine: Engine, bench: Bench, store: Slots, slot: int) -> bool:
    """Copy an engine that :func:`lay_out` gave to a slot, if its pieces have room there."""
    patience(1 + bench.numbers.size // 1000)
    return _put_away(engine, bench, store, slot)


@inlined
def _lay_hands_on(what: int, k: int, orders: Orders, bench: Bench) -> None:
    """What a hand does to a board, up to what the engine does of it."""
    engine, room, t = bench.engine, bench.room, bench.engine.clock[0]
    engine.counts[N_AT_ONCE] = 0
    engine.scale[0], engine.scale[1] = orders.scales[k, 0], orders.scales[k, 1]
    for i in range(engine.discs.shape[0]):
        room.marks[i] = CURRENT
    for m in range(orders.discs.size):
        i, row, changed = orders.discs[m], orders.rows[k, m], False
        locate(engine, i, t, room)
        state = room.states[i]
        for column in range(6):
            changed = changed or (row[column] == row[column] and row[column] != state[column])
        if what == LED:
            write_over(state[VX:], row[VX:])
            lead(engine, i, state, FOR_EVER)
            engine.next_time[i], engine.next_partner[i] = t, PATH_ENDS
        elif changed or what != ALL_PUT or engine.kinds[i] != GONE:
            if changed and what in (PLACED, ALL_PUT) and engine.discs[i, INV_MASS] == 0.0:
                for column in range(6):
                    if row[column] == row[column]:  # not NaN
                        state[column] = row[column]
                lead(engine, i, state, FOR_EVER)
            room.marks[i] = STALE
            write_over(room.before[i], row)


@inner
def _run(engine: Engine, until: float, first: int, bench: Bench) -> int:
    """All that happens up to a time, groups that push included; how it ended."""
    how = advance(engine, until, first, bench.room)
    while how in (PUSHING, PAUSED):
        first = NOBODY
        if how == PUSHING:
            crowded = engine.counts[N_CONTACTS] > bench.place.modes.size
            if crowded or law_goes_to(engine.regions) < math.inf:
                return how
            first, how = THOSE_LEFT, push_on(engine, bench.room, bench.place)
            if how != REACHED:
                return how
        how = advance(engine, until, first, bench.room)
    return how


@inner
def _played(what: int, k: int, orders: Orders, bench: Bench) -> int:
    """Do what is to be done on the board on the bench; how it ended, as the engine says."""
    engine, room, until = bench.engine, bench.room, orders.until[k]
    if what != LET_GO:
        _lay_hands_on(what, k, orders, bench)
        first = NOBODY if what == LED else PLACED if what == ALL_PUT else what
        return _run(engine, engine.clock[0], first, bench)
    how, target = GOES_ON, until
    if until < math.inf:
        how = _run(engine, until, NOBODY, bench)
    else:
        target, prescribed = engine.clock[0], prescribed_until(engine)
        limit = max(target, prescribed) + orders.longest[k]
        while how == GOES_ON:
            how = _run(engine, target, NOBODY, bench)
            if how == REACHED:
                how, target = next_target(engine, limit, prescribed, room, bench.ended)
        if how == ROUND:
            how = REACHED
        if how == REACHED and engine.surface.spin == 0.0:  # it was waited for what may come
            engine.clock[0] = target
    return how


@inlined
def tell(board: int, engine: Engine, first: int, bench: Bench, passed: int, out: FloatArray) -> int:
    """Write down what happened on a board from an event on, and what passed; how many rows."""
    used = 0
    for n in range(first, engine.counts[N_EVENTS]):
        out[used, 0] = board
        write_over(out[used, 1:], engine.events[n, :REPORTED])
        used += 1
    for n in range(passed):
        from_event, row = bench.reports[n], out[used]
        row[0] = board
        write_over(row[1:], from_event)
        row[4] = -1.0 - engine.obstacles.shape[0] - from_event[LINE]
        for column in range(1 + COLUMNS, REPORT_COLUMNS):
            row[column] = 0.0
        used += 1
    return used


@kernel
def play(
    what: int, orders: Orders, store: Slots, bench: Bench, start: int, stop: int, out: FloatArray
) -> tuple[int, int]:  # fmt: skip
    """Play boards, until all are done or ``out`` may lack rows; how far it came, and rows used.

    ``what``: an event by hand, LED or LET_GO.  What the engine does not do by itself is left as it
    was, to be played alone.
    """
    patience((stop - start) * (1 + bench.numbers.size // 1000))  # all of them are copied
    engine, room, used = bench.engine, bench.room, 0
    for k in range(start, stop):
        source = orders.source[k]
        if orders.how[k] != TO_DO:
            continue
        if what == LET_GO and store.due[source] > orders.until[k]:
            orders.how[k], orders.after[k] = WAITS, orders.until[k]
            continue
        if used + engine.events.shape[0] + bench.reports.shape[0] > out.shape[0]:
            return k, used
        _take(store, source, orders.time[k], bench)
        first, passed = engine.counts[N_EVENTS], 0
        how = _played(what, k, orders, bench)
        if how == REACHED and bench.lines.shape[0] > 0:
            passed = find_passings(
                engine, bench.lines, bench.seen, bench.passed, room.work, room.one, bench.reports
            )
            if passed > bench.reports.shape[0]:
                how = FULL
        if how == REACHED:
            rows = tell(orders.boards[k], engine, first, bench, passed, out[used:])
            if _put_away(engine, bench, store, orders.target[k]):
                used, orders.after[k] = used + rows, engine.clock[0]
            else:
                how = LACKS_PIECES
        orders.how[k] = how
    return stop, used


@kernel
def fill_states(
    store: Slots, slots: Whole, times: FloatArray, bench: Bench, start: int, stop: int,
    states: FloatArray, moving: Whole,
) -> None:  # fmt: skip
    """States (n, pucks, 6) of boards in slots, and which pucks move."""
    patience((stop - start) * (1 + bench.numbers.size // 1000))  # all of them are copied
    engine = bench.engine
    for k in range(start, stop):
        _take(store, slots[k], times[k], bench)
        for i in range(engine.discs.shape[0]):
            kind, segment, n = engine.kinds[i], engine.segments[i], bench.order[i]
            state_at(
                kind, segment, engine.discs[i], engine.lookups, engine.pieces, times[k],
                bench.room.work, states[k, n],
            )  # fmt: skip
            moving[k, n] = 1 if moves_until(kind, segment) > times[k] else 0
