"""Maps over a scene: how and where it ends, for all combinations of the numbers that range."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.checkpoint import chunked, files_named
from puck_tables._core.executor import Progress
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.columns import derived
from puck_tables.io.dataset import Dataset, Variable, variable
from puck_tables.result import Result
from puck_tables.scene.agreement import launch_velocity
from puck_tables.scene.bulk import ENDS_COLUMNS
from puck_tables.scene.entries import BATCH, LAUNCH, entry_at, tables_of
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.library import files_of
from puck_tables.scene.loop import AT_REST, CARRIED_AWAY, NOT_FINITE, OVER_EDGE, TIME_UP
from puck_tables.scene.outcome import (
    ENDS,
    LEDGER,
    NO_END,
    REFUSED,
    column_of,
    ledger,
    plain_name,
    scene_texts,
)
from puck_tables.scene.plan import Plan, plan_for
from puck_tables.scene.prepare import Prepared, prepare
from puck_tables.scene.scene import Scene
from puck_tables.scene.simulate import FAILURES, is_endless
from puck_tables.stopping.sweep import check_memory

CHUNK = 256
BYTES = 8 * 4 * ENDS_COLUMNS
STATE = (VX, VY, SPIN, X, Y, THETA)  # where the numbers of LAUNCH stand in a state
RESULTS = (*LEDGER[1:], "impacts", "energy_residual", "end_time")


@dataclass(frozen=True, eq=False, repr=False)
class SceneMap(Result):
    """Ends of a scene over its ranges.

    ``scene``: the scene with its ranges; ``axes``: their values by path (of many launches their
    numbers from 0 on); ``columns``: arrays of the shape of the axes by name, units as everywhere,
    NaN for a run without an end; ``end``: index of :data:`puck_tables.scene.outcome.ENDS`;
    ``plan``: the model of the last one that is valid; ``refusal``: what is wrong with the first run
    that is not; ``files``: what stands in the files that the scene names, by path.
    """

    scene: Scene
    plan: Plan
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)
    refusal: str = field(default="", repr=False)
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

    @property
    def model(self) -> str:
        """The model that was taken."""
        return self.plan.model

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.plan.why

    def dataset(self) -> Dataset:
        """The results over what ranges; the scene and its files as texts."""
        dims = tuple(plain_name(path) for path in self.axes)
        axes, columns = {}, {}
        for path, values in self.axes.items():
            axes[plain_name(path)] = self._along(path, values, plain_name(path))
        if BATCH in self.axes:
            for path, values in zip(LAUNCH, self.scene.ranges[BATCH].T, strict=True):
                if path not in self.axes:
                    columns[plain_name(path)] = self._along(path, values, BATCH)
        results = {**self.columns, **derived(self.columns)}
        columns |= {name: variable(name, values, dims) for name, values in results.items()}
        columns["end"] = variable("end", self.end, dims, ENDS)
        attributes = {"title": self.scene.title or "Scene", "model": self.plan.model}
        return Dataset(axes, columns, attributes, scene_texts(self.scene, self.files))

    def _along(self, path: str, values: FloatArray, axis: str) -> Variable:
        """Numbers of the scene along an axis."""
        if path == BATCH:
            return Variable(values, (axis,), "1", "number of the launch")
        doc = entry_at(self.scene, path).doc
        text = f"{path} of the scene" + (f", {doc}" if doc else "")
        return Variable(values, (axis,), self.scene.unit_of(path) or "1", text)

    def without_end(self) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        lines = []
        for code in range(OVER_EDGE + 1, len(ENDS)):
            found = np.argwhere(self.end == code)
            if found.size:
                run = f"{len(found)} of {self.end.size} runs: {ENDS[code]}; the first at "
                lines.append(run + self.run_at(found[0]) + ": " + self._advice(code))
        return lines

    def run_at(self, index: Iterable[int]) -> str:
        """The numbers of one run in words."""
        places = zip(self.axes.items(), index, strict=True)
        return ", ".join(f"{path} = {values[i]:.10g}" for (path, values), i in places)

    def _advice(self, code: int) -> str:
        if code == REFUSED:
            return self.refusal
        if code == NO_END:
            return "none by a thousand times its time scale, it may never stop; give run.time"
        if code == NOT_FINITE and self.scene.floor.law:
            return "its rim slips faster than the friction law goes; give the law more speeds"
        return FAILURES[code].partition(": ")[2] or FAILURES[code]


def axes_of(scene: Scene) -> dict[str, FloatArray]:
    """What ranges in a scene, by path; many launches by their numbers from 0 on.

    Examples
    --------
    >>> from puck_tables import Launch, Puck
    >>> axes_of(Scene(Puck(1.0), launch=Launch([[1.0, 0.0], [2.0, 0.0]])))
    {'launch': array([0., 1.])}
    """
    return {
        path: np.arange(float(len(values))) if path == BATCH else values
        for path, values in scene.ranges.items()
    }


def sweep(
    scene: Scene, *, threads: int | None = None, chunk: int = CHUNK,
    progress: Progress | None = None, checkpoint: str | Path | None = None,
) -> SceneMap:  # fmt: skip
    """The map over a scene, as :meth:`puck_tables.Scene.sweep` has it."""
    axes = axes_of(scene)
    if not axes:
        raise InputError(
            "no number of the scene is a range: write one as 'START:STOP:COUNT' or as a list (such "
            "as launch.spin = '0:10:101')"
        )
    shape = tuple(values.size for values in axes.values())
    check_memory(shape, BYTES)
    size = math.prod(shape)
    whole = tables_of(scene)
    read, files = files_named(whole), files_of(scene)
    inner = [path for path in axes if _is_launch(path, scene)]
    outer = [path for path in axes if path not in inner]
    batch = scene.ranges.get(BATCH, np.empty((0, len(LAUNCH))))

    @lru_cache(maxsize=8)
    def case(numbers: tuple[float, ...]) -> _Case | InputError:
        changed: dict[str, float] = {}
        for path, number in zip(outer, numbers, strict=True):
            if path == BATCH:
                changed |= zip(LAUNCH, batch[int(number)].tolist(), strict=True)
            else:
                changed[path] = number
        try:
            return _Case(scene.at(changed))
        except InputError as error:
            return error

    def together(
        numbers: tuple[float, ...], part: Mapping[str, FloatArray], count: int
    ) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        one = case(numbers)
        try:
            if isinstance(one, _Case):
                return one.ends(part, count)
        except InputError:  # one of these launches
            if count > 1:
                alone = [{path: values[i : i + 1] for path, values in part.items()}
                         for i in range(count)]  # fmt: skip
                ends = [together(numbers, launch, 1) for launch in alone]
                return np.hstack([e[0] for e in ends]), np.hstack([e[1] for e in ends])
        return np.full((len(RESULTS), count), np.nan), np.full(count, REFUSED, np.int8)

    def split(start: int, stop: int) -> tuple[list[tuple[float, ...]], dict[str, FloatArray]]:
        place = dict(zip(axes, np.unravel_index(np.arange(start, stop), shape), strict=True))
        values = {path: axes[path][place[path]] for path in axes}
        if BATCH in inner:
            values[BATCH] = batch[place[BATCH]]
        numbers = zip(*(values[path].tolist() for path in outer), strict=True)
        launches = {path: values[path] for path in inner}
        return list(numbers) or [()] * (stop - start), launches

    def ends_of(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        numbers, launches = split(start, stop)
        out, status = np.empty((len(RESULTS), stop - start)), np.empty(stop - start, np.int8)
        begin = 0
        while begin < stop - start:  # launches that differ in nothing but the launch, together
            end = begin + 1
            while end < stop - start and numbers[end] == numbers[begin]:
                end += 1
            part = {path: values[begin:end] for path, values in launches.items()}
            out[:, begin:end], status[begin:end] = together(numbers[begin], part, end - begin)
            begin = end
        return out, status

    def refusal_of(run: int) -> str:
        numbers, launch = split(run, run + 1)
        try:
            one = case(numbers[0])
            return str(one) if isinstance(one, InputError) else str(one.ends(launch, 1))
        except InputError as error:
            return str(error)

    def whole_ends(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        found = ends_of(start, stop)
        if files_named(whole) != read:
            raise InputError(
                f"a file that this scene names was changed while it was swept ({', '.join(read)}): "
                "begin again"
            )
        return found

    law = _told_apart(scene) if isinstance(scene.puck.pressure, Law) else None
    puck = {**whole["puck"], "pressure": law or scene.puck.pressure}
    ranges = list(scene.ranges.items())
    work = {"scene": {**whole, "puck": puck}, "axes": ranges, "files": read}
    out, status = chunked(
        whole_ends, len(RESULTS), size, chunk, threads, progress, checkpoint, work
    )
    refused, valid = np.flatnonzero(status == REFUSED), np.flatnonzero(status != REFUSED)
    refusal = refusal_of(int(refused[0])) if refused.size else ""
    if not valid.size:
        raise InputError(f"every run of this sweep is refused, the first: {refusal}")
    last = case(split(int(valid[-1]), int(valid[-1]) + 1)[0][0])
    assert isinstance(last, _Case)
    columns = {name: row.reshape(shape) for name, row in zip(RESULTS, out, strict=True)}
    ends = SceneMap(scene, last.plan, columns, status.reshape(shape), refusal, files)
    if (status > OVER_EDGE).all():
        raise InputError("\n  ".join(["no run of this sweep has an end", *ends.without_end()]))
    return ends


class _Case:
    """A scene of which only the launch still varies."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.plan = scene, plan_for(scene)
        self.by_look_up = self.plan.plain and scene.run.time is None
        if self.by_look_up:
            self.plan = Plan("free pucks: stop look-up", True, self.plan.why)
        self.endless = is_endless(scene)
        self.prepared: Prepared | None = None if self.by_look_up else prepare(scene)

    def ends(
        self, launches: Mapping[str, FloatArray], count: int
    ) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        """Results (m, count) and how it ended."""
        scene = self.scene
        states = np.zeros((count, SIZE))
        states[:, [X, Y]], states[:, THETA] = scene.launch.position, scene.launch.orientation
        states[:, [VX, VY]], states[:, SPIN] = launch_velocity(scene), scene.launch.spin
        for path, values in launches.items():
            states[:, list(STATE) if path == BATCH else STATE[LAUNCH.index(path)]] = values
        mass = scene.puck.mass
        inertia = mass * (scene.puck.gyration * scene.puck.radius) ** 2
        with np.errstate(over="ignore"):  # of launches that leave floating point
            energy = 0.5 * mass * (states[:, VX] ** 2 + states[:, VY] ** 2)
            energy += 0.5 * inertia * states[:, SPIN] ** 2
        status = np.empty(count, np.int8)
        rows = np.empty((ENDS_COLUMNS, count))
        if self.endless:
            status[:] = NO_END
        elif self.prepared is None:
            self._look_up(states, rows, status)
        else:
            self.prepared.follow_all(states, rows, status)
            if scene.run.time is None:
                status[status == TIME_UP] = NO_END
        rows[:, status > OVER_EDGE] = np.nan  # how it failed stands in ``end``
        last = dict(zip(LEDGER[:-1], rows[:-1], strict=True))
        last["kinetic_energy"] = 0.5 * mass * (last["vx"] ** 2 + last["vy"] ** 2)
        last["kinetic_energy"] += 0.5 * inertia * last["spin"] ** 2
        if self.prepared is None:  # nothing is integrated: heat is what else is not there
            last["heat_dry"][:] = energy + last["work_support"] - last["kinetic_energy"]
        with np.errstate(all="ignore"):  # runs that failed are not a number
            missing, largest = ledger(last, energy)
            residual = missing / np.where(largest > 0.0, largest, 1.0)
        results = [last[name] for name in LEDGER[1:]]
        return np.stack([*results, rows[-1], residual, last["time"]]), status

    def _look_up(self, states: FloatArray, rows: FloatArray, status: npt.NDArray[np.int8]) -> None:
        belt = self.scene.floor.velocity
        velocities, spins = states[:, [VX, VY]] - belt, states[:, SPIN]
        stops = self.scene.puck.stop(velocities, spins, tol=self.scene.run.tol)
        rows[...] = 0.0
        last = dict(zip(LEDGER[:-1], rows[:-1], strict=True))
        last["time"][:] = stops.stop_time
        for i, name in enumerate(("x", "y")):
            last[name][:] = states[:, i] + stops.stop_position[:, i] + belt[i] * stops.stop_time
            last["v" + name][:] = belt[i]
            last["work_support"][:] += (
                self.scene.puck.mass * belt[i] * (belt[i] - states[:, VX + i])
            )
        last["orientation"][:] = states[:, THETA] + stops.body_angle
        last["carried"][:] = 1.0
        status[:] = np.where(stops.status == 0, CARRIED_AWAY if any(belt) else AT_REST, NOT_FINITE)


def _is_launch(path: str, scene: Scene) -> bool:
    """Whether a range only changes the launch, and nothing has to be checked or fixed to it."""
    moves = path.startswith("launch.position") or path == BATCH
    fixed = moves and bool(scene.walls or scene.edges)
    return path in (*LAUNCH, BATCH) and scene.constraint is None and not fixed


def _told_apart(scene: Scene) -> dict[str, Any]:
    """What tells a pressure law that is given as an object from another."""
    law = scene.puck.body.law
    ratios = np.stack(law.friction(np.linspace(0.0, 0.5 * np.pi, 99), 0.0))
    return {"name": law.name, "edges": law.edges, "profile": law.profile, "friction": ratios}
