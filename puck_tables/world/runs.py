"""Many runs of a scene: over its ranges, or with numbers that are drawn; where and how each ends.

Runs that differ in nothing but launches are done together.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray, instance
from puck_tables._core.digest import files_named, refuse_changed
from puck_tables._core.memory import check_memory
from puck_tables.bulk.finish import Doing, finish
from puck_tables.bulk.spreads import Spread, checked_samples
from puck_tables.bulk.work import Columns, Tally, Work
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.entries import tables_of
from puck_tables.scene.library import files_of, plain_name
from puck_tables.scene.run import ENDS, LAST_END, REFUSED
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.board_case import BoardCase
from puck_tables.world.map import Map
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.scene_ends import Sample, SceneEnds, axes_of, numbers_of

FEWEST, MOST = 1 << 6, 1 << 13  # runs kept together in a store
_COPIES = 4  # of the columns: as made, in their shape, and what follows from them


def sweep(scene: SceneSpec, how: Doing) -> Any:
    """The map over a scene, as :meth:`puck_tables.Scene.sweep` has it."""
    return finish(Runs(scene, how.chunk), how)


def sample(
    scene: SceneSpec, count: int, seed: int, spreads: Mapping[str, Spread], how: Doing
) -> Any:
    """Samples of a scene, as :meth:`puck_tables.Scene.sample` has it."""
    count, seed = checked_samples(count, seed)
    instance("spreads", spreads, Mapping)
    return finish(DrawnRuns(scene, how.chunk, None, count, seed, dict(spreads)), how)


class Runs(Work):
    """The runs of a scene over its ranges.

    Raises InputError if nothing ranges.
    """

    code = "end"
    meanings = ENDS
    spreads: Mapping[str, Spread] = {}

    def __init__(
        self, scene: SceneSpec, part: int, read: dict[str, str] | None = None,
        axes: Mapping[str, FloatArray] | None = None, shape: tuple[int, ...] | None = None,
    ) -> None:  # fmt: skip
        self.scene, self.part = scene, part
        self.axes = axes_of(scene) if axes is None else axes
        if not self.axes:
            own = "puck[0].launch.spin" if scene.pucks else "launch.spin"
            raise InputError(
                "no number of the scene is a range: write one as 'START:STOP:COUNT' or as a list "
                f"(such as {own} = '0:10:101')"
            )
        self.shape = tuple(values.size for values in self.axes.values()) if shape is None else shape
        self.names, self._columns = BoardCase.names(scene), BoardCase.columns(scene)
        self.columns: Mapping[str, tuple[int, ...]] = self._columns
        self.block = min(MOST, max(FEWEST, self.size // 64))
        self._whole, self.files = tables_of(scene), files_of(scene)
        self._read = files_named(self._whole) if read is None else read
        launches = {path: BoardCase.launches(scene, path) for path in self.axes}
        self._inner = {one for paths in launches.values() for one in paths}
        others = [self.axes[path].size or self.size for path, own in launches.items() if not own]
        self._alike = self.size // math.prod(others)  # runs that differ in nothing but launches
        self._case = lru_cache(maxsize=8)(self._made)

    def __reduce__(self) -> Any:
        return Runs, (self.scene, self.part, self._read)

    @property
    def identity(self) -> Mapping[str, Any]:
        """The scene, its ranges, and what stands in the files that it names."""
        tables = self._whole["puck"] if self.scene.pucks else [self._whole["puck"]]
        pucks = [
            {**table, "pressure": _differences(puck)} if isinstance(puck.pressure, Law) else table
            for puck, table in zip(pucks_of(self.scene), tables, strict=True)
        ]
        ranges = list(self.scene.ranges.items())
        return {"scene": {**self._whole, "puck": pucks}, "axes": ranges, "files": self._read}

    def refuse_memory(self) -> None:
        """By its columns."""
        check_memory(self.shape, 8 * _COPIES * sum(math.prod(one) for one in self.columns.values()))

    def numbers(self, start: int, stop: int) -> dict[str, FloatArray]:
        """What differs between runs, by path, of some of them."""
        return numbers_of(self.scene.ranges, np.arange(start, stop))

    def along(self, run: int) -> dict[str, float]:
        """Where a run is along the axes."""
        place = np.unravel_index(run, self.shape)
        axes = zip(self.axes.items(), place, strict=True)
        return {path: float(values[i]) for (path, values), i in axes}

    def _made(self, numbers: tuple[tuple[str, float], ...]) -> BoardCase | InputError:
        try:
            return BoardCase(self.scene.at(dict(numbers)), self._alike)
        except InputError as error:
            return error

    def of(self, start: int, stop: int) -> Columns:
        """The ends of some runs.

        Raises InputError if a file that the scene names was changed meanwhile.
        """
        numbers, count = self.numbers(start, stop), stop - start
        outer = {path: values.tolist() for path, values in numbers.items()
                 if path not in self._inner}  # fmt: skip
        keys = list(zip(*outer.values(), strict=True)) or [()] * count
        columns: Columns = {name: np.empty((count, *one)) for name, one in self._columns.items()}
        columns[self.code] = np.empty(count, np.int8)
        begin = 0
        while begin < count:  # runs that differ in nothing but launches, together
            last = begin + 1
            while last < count and keys[last] == keys[begin]:
                last += 1
            part = {path: values[begin:last] for path, values in numbers.items()}
            self._together(tuple(zip(outer, keys[begin], strict=True)), part, columns, begin, last)
            begin = last
        refuse_changed(self._whole, self._read)
        return columns

    def _together(
        self, fixed: tuple[tuple[str, float], ...], numbers: Mapping[str, FloatArray],
        parts: Columns, start: int, stop: int,
    ) -> None:  # fmt: skip
        """Ends of runs that differ in nothing but launches, of which one may not be allowed."""
        launches = {path: values for path, values in numbers.items() if path in self._inner}
        case = self._case(fixed)
        try:
            if isinstance(case, InputError):  # perhaps by the launch that the scene itself has
                ends, end = self._alone(numbers) if stop - start == 1 and launches else ({}, None)
            else:
                ends, end = case.ends(launches, stop - start)
        except InputError:
            ends, end = {}, None
        if end is None and launches and stop - start > 1:
            for i in range(stop - start):
                one = {path: values[i : i + 1] for path, values in numbers.items()}
                self._together(fixed, one, parts, start + i, start + i + 1)
            return
        for name in self._columns:
            parts[name][start:stop] = np.nan if end is None else ends[name]
        parts[self.code][start:stop] = REFUSED if end is None else end

    def _alone(self, numbers: Mapping[str, FloatArray]) -> Any:
        """The end of one run, in a case of its own."""
        one = self.scene.at({path: float(values[0]) for path, values in numbers.items()})
        return BoardCase(one).ends({}, 1)

    def _refusal(self, run: int) -> str:
        """Why a run is refused."""
        try:
            return str(self._alone(self.numbers(run, run + 1)))
        except InputError as error:
            return str(error)

    def checked(self, tally: Tally) -> None:
        """Refuse runs none of which has an end."""
        if any(code <= LAST_END for code in tally.counts):
            return
        if set(tally.counts) == {REFUSED}:
            refusal = self._refusal(tally.first[REFUSED])
            raise InputError(f"every run of this sweep is refused, the first: {refusal}")
        raise InputError("\n  ".join(["no run of this sweep has an end", *self.without_end(tally)]))

    def without_end(self, tally: Tally) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        lines = []
        for code, count in tally.counts.items():
            if code > LAST_END:
                first = tally.first[code]
                at = ", ".join(f"{path} = {one:.10g}" for path, one in self.along(first).items())
                refused = code == REFUSED
                advice = self._refusal(first) if refused else BoardCase.advice(self.scene, code)
                lines.append(
                    f"{count} of {self.size} runs: {ENDS[code]}; the first at {at}: {advice}"
                )
        return lines

    def _first(self, tally: Tally) -> BoardCase:
        """The case of the first run that is not refused."""
        first = min(run for code, run in tally.first.items() if code != REFUSED)
        numbers = {path: float(one[0]) for path, one in self.numbers(first, first + 1).items()}
        case = self._case(tuple(at for at in numbers.items() if at[0] not in self._inner))
        return BoardCase(self.scene.at(numbers)) if isinstance(case, InputError) else case

    def explain(self, tally: Tally) -> str:
        """The model of the first run that is valid, and why."""
        return self._first(tally).explanation

    def labelled(self, columns: Columns) -> Dataset:
        """The ends with names, axes and units; the scene and its files as texts."""
        return self._result(columns, "", "", ()).labelled()

    def result(self, columns: Columns) -> SceneEnds:
        """The map, or the samples."""
        tally = Tally.of(columns[self.code])
        case = self._first(tally)
        remarks = tuple(self.without_end(tally))
        return self._result(columns, case.model, case.explanation, remarks)

    def _result(
        self, columns: Columns, model: str, explanation: str, parts: tuple[str, ...]
    ) -> SceneEnds:
        kept = dict(columns)
        end = kept.pop(self.code)
        return self._ends(
            scene=self.scene, names=self.names, columns=kept, end=end, model=model,
            explanation=explanation, endless=parts, files=self.files,
        )  # fmt: skip

    def _ends(self, **ends: Any) -> SceneEnds:
        return Map(**ends)


class DrawnRuns(Runs):
    """The runs of a scene of which some numbers are drawn.

    Raises InputError if nothing scatters, or what does is no number of the scene.
    """

    is_sample = True

    def __init__(
        self, scene: SceneSpec, part: int, read: dict[str, str] | None, count: int, seed: int,
        spreads: Mapping[str, Spread],
    ) -> None:  # fmt: skip
        if scene.ranges:
            raise InputError(
                f"samples have no ranges: give {', '.join(scene.ranges)} one number or a spread"
            )
        if not spreads or not all(isinstance(one, Spread) for one in spreads.values()):
            own = "puck[0].launch.spin" if scene.pucks else "launch.spin"
            raise InputError(
                f"samples need a spread: say what scatters, such as {own}=normal:5:0.2"
            )
        self.spreads, self.seed = spreads, seed
        middle = {path: one.of(np.array([0.5])).item() for path, one in spreads.items()}
        try:
            scene.at(middle)  # what is no number of the scene is refused here
            for path, one in spreads.items():
                one.checked_for(path, scene.unit_of(path))
        except InputError as error:
            raise InputError(f"samples: in the middle of what is drawn, {error}") from None
        super().__init__(scene, part, read, {path: np.zeros(0) for path in spreads}, (count,))
        self.columns = {**{plain_name(path): () for path in spreads}, **self._columns}

    def __reduce__(self) -> Any:
        return DrawnRuns, (
            self.scene, self.part, self._read, self.size, self.seed, self.spreads
        )  # fmt: skip

    @property
    def identity(self) -> Mapping[str, Any]:
        """The scene, and what is drawn."""
        drawn = {path: str(one) for path, one in self.spreads.items()}
        return {**super().identity, "drawn": drawn, "seed": self.seed, "count": self.size}

    def numbers(self, start: int, stop: int) -> dict[str, FloatArray]:
        """What is drawn, by path, for some samples."""
        return {path: one.drawn(path, self.seed, start, stop) for path, one in self.spreads.items()}

    def along(self, run: int) -> dict[str, float]:
        """What was drawn for a sample."""
        return {path: float(one[0]) for path, one in self.numbers(run, run + 1).items()}

    def of(self, start: int, stop: int) -> Columns:
        """The ends of some samples, and what was drawn."""
        drawn = {plain_name(path): one for path, one in self.numbers(start, stop).items()}
        return {**super().of(start, stop), **drawn}

    def _ends(self, **ends: Any) -> SceneEnds:
        return Sample(**ends, spreads=self.spreads, seed=self.seed)


def _differences(puck: PuckSpec) -> dict[str, Any]:
    """What tells a pressure law that is given as an object from another."""
    law = puck.body.law
    ratios = np.stack(law.friction(np.linspace(0.0, 0.5 * np.pi, 99), 0.0))
    return {"name": law.name, "edges": law.edges, "profile": law.profile, "friction": ratios}
