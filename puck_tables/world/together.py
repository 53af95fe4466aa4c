"""Boards that are played together, in slots of a store, as a whole or not at all."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, whole
from puck_tables._core.executor import run_chunks
from puck_tables._core.memory import check_memory
from puck_tables.errors import InputError, PuckError
from puck_tables.kernels.patience import FEW, compiled_at_once
from puck_tables.scene.friction import VX, VY
from puck_tables.scene.ingredients import FREE
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world import stored
from puck_tables.world.bench import (
    ALONE,
    LACKS_PIECES,
    LED,
    LET_GO,
    REPORT_COLUMNS,
    ROWS,
    SCALES,
    TO_DO,
    WAITS,
    Bench,
    Orders,
    Slots,
    bench_for,
    lay_out,
)
from puck_tables.world.by_hand import slips_of
from puck_tables.world.floor_under import law_goes_to, moves_along
from puck_tables.world.lasting import longest_of
from puck_tables.world.layout import HOLD, INV_MASS
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.prepare import scales_of
from puck_tables.world.segment_starts import room_for
from puck_tables.world.setting_off import REACHED, SURELY
from puck_tables.world.world import World

_PARTS = 16  # in which threads take boards at least
_ROWS = 4 * ROWS  # of events that are told at once


class Together:
    """Copies of a board, with nobody's hand in them yet: see :class:`puck_tables.Worlds`.

    Each is in one of two slots of its own, or in the last slot, where the scene starts; what is
    done to it goes to its other slot, and is taken over where all went well.
    """

    def __init__(self, scene: SceneSpec, n: int) -> None:
        self._n = whole("n", n, 1)
        self._first = first = World(scene)
        self.scene, self.names = first.scene, first.names
        self._order, self._place, engine = first._order, first._place, first._engine
        held = (engine.discs[:, HOLD] != FREE).any() or engine.surface.changes != 0.0
        self._plain = not (held or moves_along(engine.surface))
        bench = self._bench(0)
        self._columns = bench.numbers.size + bench.whole.size + len(self._order) * PIECE_COLUMNS
        self._refuse_many(n)
        self._store = Slots(
            np.empty((2 * n + 1, bench.numbers.size)), np.empty((2 * n + 1, bench.whole.size), int),
            np.empty((2 * n + 1, 1, PIECE_COLUMNS)), np.empty(2 * n + 1),
        )  # fmt: skip
        self._free: list[tuple[Bench, FloatArray]] = []
        self._apart: dict[int, g.Engine] = {}  # slots of boards whose floors know faster slips
        self._at = np.full(n, 2 * n)  # of each board, the slot in which it is; the last: the start
        self.time: FloatArray = np.zeros(n)
        self._described: list[FloatArray] = []
        first._passings.follow(first._engine)
        self._keep(bench, first, 2 * n)

    def _refuse_many(self, n: int) -> None:
        """Refuse more boards than memory has room for."""
        check_memory((2 * n + 1,), 8 * self._columns, "ask for fewer boards", f"{n} boards")

    def _copied(self, some: g.Whole) -> Self:
        """Boards of their own that go on as some of these are."""
        count, old = len(some), self._store
        if count == 0:
            raise InputError("boards must be one board at least")
        self._refuse_many(count)
        slots = np.concatenate([self._at[some], self._at[some], [2 * self._n]])
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other._n, other._at, other.time = count, np.arange(count), self.time[some]
        other._store = Slots(*(part[slots] for part in old))
        other._free, other._described = [], []
        apart = enumerate(slots[:count].tolist())
        other._apart = {k: self._apart[slot] for k, slot in apart if slot in self._apart}
        return other

    def _do(
        self, what: int, some: g.Whole, alone: Callable[[World, int], Any], span: float,
        rows: FloatArray | None = None, discs: g.Whole | None = None, anew: bool = False,
    ) -> None:  # fmt: skip
        """Do it on boards, together or ``alone``, as a whole or not at all."""
        count, n = len(some), self._n
        source = np.full(count, 2 * n) if anew else self._at[some]
        time = np.zeros(count) if anew else self.time[some]
        target = np.where(self._at[some] == some, some + n, some)
        how, longest = np.full(count, TO_DO), np.zeros(count)
        scales = self._store.numbers[source, SCALES]
        if what != LET_GO and not self._plain:
            how[:] = ALONE
        elif rows is not None and discs is not None:
            self._quicken(what, rows, discs, source, time, scales)
        elif span == math.inf:
            longest = longest_of(self._first._engine, scales)
        how[np.isin(source, list(self._apart))] = ALONE
        orders = Orders(
            some, source, target, time, time + span, np.zeros(0, int) if discs is None else discs,
            np.zeros((0, 0, 6)) if rows is None else rows, scales, longest, np.empty(count), how,
        )  # fmt: skip
        results = self._play(what, orders)
        apart: dict[int, g.Engine] = {}
        failed: dict[int, PuckError] = {}
        for k in np.flatnonzero((how != REACHED) & (how != WAITS)).tolist():
            try:
                results.append(self._play_alone(orders, k, alone, apart))
            except PuckError as error:
                failed[int(some[k])] = error
        if failed:
            raise of_boards(failed)
        self._at[some] = np.where(how == WAITS, source, target)
        self.time = self.time.copy()
        self.time[some], self._described = orders.after, results
        if self._apart or apart:
            still = np.setdiff1d(self._at, target)
            self._apart = {slot: one for slot, one in self._apart.items() if slot in still} | apart

    def _quicken(
        self, what: int, rows: FloatArray, discs: g.Whole, slots: g.Whole, time: FloatArray,
        scales: FloatArray,
    ) -> None:  # fmt: skip
        """Scales that hold for what a hand gives, too: as World sets them, to the bit."""
        if what == g.REMOVED:
            return
        engine = self._first._engine
        own = engine.discs[discs]
        if what == LED:
            fastest = np.hypot(rows[:, 0, VX], rows[:, 0, VY])
            new = np.flatnonzero(fastest > scales[:, 0])
            fastest = fastest[new]
        else:
            known = (own[:, INV_MASS] == 0.0) | (law_goes_to(engine.regions) < math.inf)
            new = np.flatnonzero(~(slips_of(own, rows) <= scales[:, :1]).all(axis=1) | known.any())
            now = self._states(slots[new], time[new])[0][:, self._order]
            states = now.copy()
            states[:, discs] = np.where(np.isnan(rows[new]), states[:, discs], rows[new])
            changed, slips = (states != now)[:, discs], slips_of(own, states[:, discs])
            swift = changed[..., VX:].any(axis=2) & (slips > SURELY * scales[new, :1])
            unseen = (known & (changed.any(axis=2) | (what == g.STRUCK)) | swift).any(axis=1)
            unseen &= (slips > scales[new, :1]).any(axis=1) | known.any()
            new, states = new[unseen], states[unseen]
            fastest = slips_of(engine.discs, states).max(axis=1, initial=0.0)
        if new.size:
            scales[new] = np.maximum(scales[new], scales_of(engine, fastest))

    def _play(self, what: int, orders: Orders) -> list[FloatArray]:
        """Play boards together; what happened."""
        answers: list[FloatArray] = []

        def work(start: int, stop: int) -> None:
            bench, out = self._a_bench()
            while start < stop:
                start, used = stored.play(what, orders, self._store, bench, start, stop, out)
                if used:
                    answers.append(out[:used].copy())
            self._free.append((bench, out))

        while (orders.how == TO_DO).any():
            self._on_all_cores(work, len(orders.how))
            lacking = orders.how == LACKS_PIECES
            if lacking.any():
                self._grow()
                orders.how[lacking] = TO_DO
        return answers

    def _on_all_cores(self, work: Callable[[int, int], None], count: int) -> None:
        """Call it for parts of so many boards; many are compiled for at once.

        A thread that runs a kernel as it is written, and gives up, would put back what others did.
        """

        def at_once(start: int, stop: int) -> None:
            with compiled_at_once():
                work(start, stop)

        few = count <= FEW
        run_chunks(work if few else at_once, count, max(FEW, -(-count // _PARTS)))

    def _play_alone(
        self, orders: Orders, k: int, alone: Callable[[World, int], Any], apart: dict[int, g.Engine]
    ) -> FloatArray:
        """Play a board as a world of its own; what happened."""
        mine, source, board = self._a_bench(), int(orders.source[k]), int(orders.boards[k])
        bench = mine[0]
        stored.take(self._store, source, float(orders.time[k]), bench)
        world = object.__new__(World)
        world.__dict__.update(self._first.__dict__)
        engine = bench.engine
        if source in self._apart:
            floors, regions = self._apart[source].floors, self._apart[source].regions
            own, kept = (
                regions.floor_map,
                engine.regions.floor_map,
            )  # of one size, it is in the slot
            floor_map = kept if kept.size == own.size else own.copy()
            engine = engine._replace(regions=regions._replace(floor_map=floor_map), floors=floors)
        world._engine, world._room, world._described = engine, room_for(len(self.names)), {}
        world._passings = self._first._passings.copy()
        world._passings.seen, world._passings.segments = bench.seen.copy(), bench.passed.copy()
        first = int(engine.counts[g.N_EVENTS])
        alone(world, k)
        world._passings.follow(world._engine)
        if world._engine.floors is not self._first._engine.floors:
            apart[int(orders.target[k])] = world._engine
        passed = world._passings.rows
        out = np.empty((int(world._engine.counts[g.N_EVENTS]) + len(passed), REPORT_COLUMNS))
        used = stored.tell(
            board, world._engine, first, bench._replace(reports=passed), len(passed), out
        )
        orders.after[k], orders.how[k] = world.time, REACHED
        self._free.append(mine)
        self._keep(bench, world, int(orders.target[k]))
        return out[:used]

    def _keep(self, bench: Bench, world: World, slot: int) -> None:
        """Put a world away in a slot."""
        engine = lay_out(bench, world._engine, world._passings.seen)
        while not stored.put_away(engine, bench, self._store, slot):
            self._grow()

    def _grow(self) -> None:
        """Twice the rows for pieces."""
        pieces = self._store.pieces
        more = np.empty((len(pieces), 2 * pieces.shape[1], PIECE_COLUMNS))
        more[:, : pieces.shape[1]] = pieces
        self._store, self._free = self._store._replace(pieces=more), []

    def _bench(self, rows: int) -> Bench:
        """A new one."""
        passings = self._first._passings
        return bench_for(self._first._engine, self._order, passings.lines, passings.seen, rows)

    def _a_bench(self) -> tuple[Bench, FloatArray]:
        """One that nobody uses, and rows for what happens."""
        try:
            return self._free.pop()
        except IndexError:
            bench = self._bench(self._store.pieces.shape[1])
            rows = _ROWS + 2 * len(bench.engine.events)
            return bench, np.empty((rows, REPORT_COLUMNS))

    def _kinds(self, slots: g.Whole) -> g.Whole:
        """Of the segments of all discs of boards, (slots, discs)."""
        return self._store.whole[slots, : len(self.names)]

    def _states(
        self, slots: g.Whole, times: FloatArray
    ) -> tuple[FloatArray, npt.NDArray[np.bool_]]:  # fmt: skip
        """States of boards, and which pucks move."""
        states = np.empty((len(slots), len(self.names), 6))
        moving = np.zeros(states.shape[:2], int)

        def work(start: int, stop: int) -> None:
            mine = self._a_bench()
            stored.fill_states(self._store, slots, times, mine[0], start, stop, states, moving)
            self._free.append(mine)

        self._on_all_cores(work, len(slots))
        return states, moving > 0


def of_boards(failed: dict[int, PuckError]) -> PuckError:
    """The error of the first of them, in which the others are named."""
    board = min(failed)
    more = f", and {len(failed) - 1} more" if len(failed) > 1 else ""
    kind = InputError if isinstance(failed[board], InputError) else PuckError
    error = kind(f"board {board}{more}: {failed[board]}")
    error.boards = tuple(sorted(failed))
    return error
