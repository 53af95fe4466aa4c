"""Maps over a scene: how and where it ends, for all combinations of the numbers that range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.digest import files_named, refuse_changed
from puck_tables._core.executor import Progress
from puck_tables._core.memory import check_memory
from puck_tables.bulk.finish import check_part, finish
from puck_tables.bulk.work import Columns, Tally, Work
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.columns import derived
from puck_tables.io.dataset import Dataset, Variable, variable
from puck_tables.result import Result
from puck_tables.scene.bulk import ENDS_COLUMNS
from puck_tables.scene.case import RESULTS, Case, is_launch, told_apart
from puck_tables.scene.checked import largest_error
from puck_tables.scene.entries import BATCH, LAUNCH, entry_at, tables_of
from puck_tables.scene.library import files_of
from puck_tables.scene.loop import NOT_FINITE, OVER_EDGE
from puck_tables.scene.outcome import (
    ENDS,
    NO_END,
    REFUSED,
    column_of,
    plain_name,
    scene_texts,
)
from puck_tables.scene.plan import Plan
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.simulate import FAILURES

CHUNK = 256
FEWEST, MOST = 1 << 6, 1 << 13  # runs kept together in a store
BYTES = 8 * 4 * ENDS_COLUMNS


@dataclass(frozen=True, eq=False, repr=False)
class SceneMap(Result):
    """Ends of a scene over its ranges.

    ``scene``: the scene with its ranges; ``axes``: their values by path (of many launches their
    numbers from 0 on); ``columns``: arrays of the shape of the axes by name, units as everywhere,
    NaN for a run without an end; ``end``: index of :data:`puck_tables.scene.outcome.ENDS`;
    ``plan``: the model of the last one that is valid; ``told``: what :meth:`without_end` says;
    ``files``: what stands in the files that the scene names, by path.
    """

    scene: SceneSpec
    plan: Plan
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)
    told: tuple[str, ...] = field(default=(), repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "scene_map"
    meanings: ClassVar[tuple[str, ...]] = ENDS

    @property
    def axes(self) -> dict[str, FloatArray]:
        """What ranges, by path."""
        return axes_of(self.scene)

    def __repr__(self) -> str:
        ranged = " x ".join(f"{path} ({values.size})" for path, values in self.axes.items())
        return f"SceneMap({self.scene.title or 'scene'} over {ranged}, {self.plan.model})"

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    @cached_property
    def error_estimate(self) -> float:
        """The largest error of a few runs, each done again alone, with twins; in Q/J and Q²/J.

        Raises
        ------
        InputError
            If a file that the scene names has changed since the sweep.
        """
        if files_of(self.scene) != self.files:
            raise InputError("a file that the scene names has changed since: sweep it again")
        return largest_error(self.scene, self.axes, self.columns, self.end)

    @property
    def model(self) -> str:
        """The model that was taken."""
        return self.plan.model

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.plan.why

    def dataset(self) -> Dataset:
        """The results over what ranges; the scene and its files as texts."""
        columns = {**self.columns, **derived(self.columns)}
        found = labelled(self.scene, self.axes, self.files, columns, self.end)
        more = {"model": self.plan.model, "error_estimate": self.error_estimate}
        return replace(found, attributes={**found.attributes, **more})

    def without_end(self) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        return list(self.told)


def axes_of(scene: SceneSpec) -> dict[str, FloatArray]:
    """What ranges in a scene, by path; many launches by their numbers from 0 on.

    Examples
    --------
    >>> from puck_tables import Launch, Puck, Scene
    >>> axes_of(Scene(Puck(1.0), launch=Launch([[1.0, 0.0], [2.0, 0.0]])))
    {'launch': array([0., 1.])}
    """
    return {
        path: np.arange(float(len(values))) if path == BATCH else values
        for path, values in scene.ranges.items()
    }


def labelled(
    scene: SceneSpec, axes: Mapping[str, FloatArray], files: Mapping[str, str], results: Columns,
    end: npt.NDArray[np.int8],
) -> Dataset:  # fmt: skip
    """Columns of the ends of a scene with axes, names and units."""
    dims = tuple(plain_name(path) for path in axes)
    along, columns = {}, {}
    for path, values in axes.items():
        along[plain_name(path)] = _along(scene, path, values, plain_name(path))
    if BATCH in axes:
        for path, values in zip(LAUNCH, scene.ranges[BATCH].T, strict=True):
            if path not in axes:
                columns[plain_name(path)] = _along(scene, path, values, BATCH)
    columns |= {name: variable(name, values, dims) for name, values in results.items()}
    columns["end"] = variable("end", end, dims, ENDS)
    return Dataset(along, columns, {"title": scene.title or "Scene"}, scene_texts(scene, files))


def _along(scene: SceneSpec, path: str, values: FloatArray, axis: str) -> Variable:
    """Numbers of the scene along an axis."""
    if path == BATCH:
        return Variable(values, (axis,), "1", "number of the launch")
    doc = entry_at(scene, path).doc
    text = f"{path} of the scene" + (f", {doc}" if doc else "")
    return Variable(values, (axis,), scene.unit_of(path) or "1", text)


def sweep(
    scene: SceneSpec, *, threads: int | None = None, chunk: int = CHUNK,
    progress: Progress | None = None, store: str | Path | None = None, cluster: str | None = None,
    overwrite: bool = False,
) -> SceneMap:  # fmt: skip
    """The map over a scene, as :meth:`puck_tables.Scene.sweep` has it."""
    check_part(chunk)
    work = SceneWork(scene, chunk)
    if store is None:
        check_memory(work.shape, BYTES)
    found: SceneMap = finish(work, threads, progress, store, cluster, overwrite)
    return found


class SceneWork(Work):
    """The runs of a scene over its ranges.

    Raises
    ------
    InputError
        If nothing ranges.
    """

    code = "end"
    meanings = ENDS

    def __init__(
        self, scene: SceneSpec, part: int, read: dict[str, str] | None = None,
        axes: Mapping[str, FloatArray] | None = None, shape: tuple[int, ...] | None = None,
    ) -> None:  # fmt: skip
        self.scene, self.part = scene, part
        self.axes = axes_of(scene) if axes is None else axes
        if not self.axes:
            raise InputError(
                "no number of the scene is a range: write one as 'START:STOP:COUNT' or as a list "
                "(such as launch.spin = '0:10:101')"
            )
        self.shape = tuple(values.size for values in self.axes.values()) if shape is None else shape
        self.columns = dict.fromkeys(RESULTS, ())
        self.block = min(MOST, max(FEWEST, self.size // 64))
        self._whole = tables_of(scene)
        self.files = files_of(scene)
        self._read = files_named(self._whole) if read is None else read
        self._inner = [path for path in self.axes if is_launch(path, scene)]
        self._outer = [path for path in self.axes if path not in self._inner]
        self._batch = scene.ranges.get(BATCH, np.empty((0, len(LAUNCH))))
        self._case = lru_cache(maxsize=8)(self._made)

    def __reduce__(self) -> Any:
        return SceneWork, (self.scene, self.part, self._read)

    @property
    def identity(self) -> Mapping[str, Any]:
        """The scene, its ranges, and what stands in the files that it names."""
        scene = self.scene
        law = told_apart(scene) if isinstance(scene.puck.pressure, Law) else None
        puck = {**self._whole["puck"], "pressure": law or scene.puck.pressure}
        ranges = list(scene.ranges.items())
        return {"scene": {**self._whole, "puck": puck}, "axes": ranges, "files": self._read}

    def _made(self, numbers: tuple[float, ...]) -> Case | InputError:
        changed: dict[str, float] = {}
        for path, number in zip(self._outer, numbers, strict=True):
            if path == BATCH:
                changed |= zip(LAUNCH, self._batch[int(number)].tolist(), strict=True)
            else:
                changed[path] = number
        try:
            return Case(self.scene.at(changed))
        except InputError as error:
            return error

    def _together(
        self, numbers: tuple[float, ...], part: Mapping[str, FloatArray], count: int
    ) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        one = self._case(numbers)
        try:
            if isinstance(one, Case):
                return one.ends(part, count)
        except InputError:  # one of these launches
            if count > 1:
                alone = [{path: values[i : i + 1] for path, values in part.items()}
                         for i in range(count)]  # fmt: skip
                ends = [self._together(numbers, launch, 1) for launch in alone]
                return np.hstack([e[0] for e in ends]), np.hstack([e[1] for e in ends])
        return np.full((len(RESULTS), count), np.nan), np.full(count, REFUSED, np.int8)

    def _split(
        self, start: int, stop: int
    ) -> tuple[list[tuple[float, ...]], dict[str, FloatArray]]:
        values = self._values(start, stop)
        numbers = zip(*(values[path].tolist() for path in self._outer), strict=True)
        launches = {path: values[path] for path in self._inner}
        return list(numbers) or [()] * (stop - start), launches

    def _values(self, start: int, stop: int) -> dict[str, FloatArray]:
        """What ranges, of some runs."""
        runs = np.unravel_index(np.arange(start, stop), self.shape)
        place = dict(zip(self.axes, runs, strict=True))
        values = {path: self.axes[path][place[path]] for path in self.axes}
        if BATCH in self._inner:
            values[BATCH] = self._batch[place[BATCH]]
        return values

    def of(self, start: int, stop: int) -> Columns:
        """The ends of some runs.

        Raises
        ------
        InputError
            If a file that the scene names was changed meanwhile.
        """
        numbers, launches = self._split(start, stop)
        out, end = np.empty((len(RESULTS), stop - start)), np.empty(stop - start, np.int8)
        begin = 0
        while begin < stop - start:  # launches that differ in nothing but the launch, together
            last = begin + 1
            while last < stop - start and numbers[last] == numbers[begin]:
                last += 1
            part = {path: values[begin:last] for path, values in launches.items()}
            out[:, begin:last], end[begin:last] = self._together(numbers[begin], part, last - begin)
            begin = last
        refuse_changed(self._whole, self._read)
        return dict(zip(RESULTS, out, strict=True)) | {self.code: end}

    def _refusal(self, run: int) -> str:
        numbers, launch = self._split(run, run + 1)
        try:
            one = self._case(numbers[0])
            return str(one) if isinstance(one, InputError) else str(one.ends(launch, 1))
        except InputError as error:
            return str(error)

    def checked(self, tally: Tally) -> None:
        """Refuse a sweep no run of which has an end."""
        if any(code <= OVER_EDGE for code in tally.counts):
            return
        if set(tally.counts) == {REFUSED}:
            refusal = self._refusal(tally.first[REFUSED])
            raise InputError(f"every run of this sweep is refused, the first: {refusal}")
        raise InputError("\n  ".join(["no run of this sweep has an end", *self.without_end(tally)]))

    def without_end(self, tally: Tally) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        lines = []
        for code, count in tally.counts.items():
            if code > OVER_EDGE:
                first = tally.first[code]
                at = self._values(first, first + 1)
                at |= {path: self.axes[path][[first]] for path in at if path == BATCH}
                run = ", ".join(f"{path} = {values[0]:.10g}" for path, values in at.items())
                lines.append(
                    f"{count} of {self.size} runs: {ENDS[code]}; the first at {run}: "
                    + self._advice(code, first)
                )
        return lines

    def _advice(self, code: int, run: int) -> str:
        if code == REFUSED:
            return self._refusal(run)
        if code == NO_END:
            return "none by a thousand times its time scale, it may never stop; give a time"
        if code == NOT_FINITE and self.scene.floor.law:
            return "its rim slips faster than the friction law goes; give the law more speeds"
        return FAILURES[code].partition(": ")[2] or FAILURES[code]

    def explain(self, tally: Tally) -> str:
        """The model of the first run that is valid, and why."""
        first = min(run for code, run in tally.first.items() if code != REFUSED)
        one = self._case(self._split(first, first + 1)[0][0])
        assert isinstance(one, Case)
        return one.plan.why

    def labelled(self, columns: Columns) -> Dataset:
        """The ends over what ranges; the scene and its files as texts."""
        results = {name: columns[name] for name in RESULTS}
        return labelled(self.scene, self.axes, self.files, results, columns[self.code])

    def result(self, columns: Columns) -> SceneMap:
        """The map."""
        end = columns[self.code]
        valid = np.flatnonzero(end.ravel() != REFUSED)
        last = self._case(self._split(int(valid[-1]), int(valid[-1]) + 1)[0][0])
        assert isinstance(last, Case)
        lines = tuple(self.without_end(Tally.of(end)))
        results = {name: columns[name] for name in RESULTS}
        return SceneMap(self.scene, last.plan, results, end, lines, self.files)
