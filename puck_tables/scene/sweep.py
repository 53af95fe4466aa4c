"""Maps over a scene: how and where it ends, for all combinations of the numbers that range."""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.checkpoint import Checkpoint, files_named, work_digest
from puck_tables.errors import InputError
from puck_tables.executor import Progress, run_chunks
from puck_tables.scene.bulk import ENDS_COLUMNS
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.library import find_scene
from puck_tables.scene.loop import AT_REST, CARRIED_AWAY, NOT_FINITE, OVER_EDGE, TIME_UP
from puck_tables.scene.outcome import COLUMNS, ledger
from puck_tables.scene.plan import Plan, free_puck, plan_for
from puck_tables.scene.prepare import Prepared, prepare
from puck_tables.scene.scene import Scene, launch_velocity, scene_from
from puck_tables.scene.simulate import refuse_endless
from puck_tables.stop_map import check_memory
from puck_tables.stops import stop

FloatArray = npt.NDArray[np.float64]

CHUNK = 256
BYTES = 8 * 4 * ENDS_COLUMNS
LAUNCH = {
    "launch.velocity[0]": VX, "launch.velocity[1]": VY, "launch.spin": SPIN,
    "launch.position[0]": X, "launch.position[1]": Y, "launch.orientation": THETA,
}  # fmt: skip
RESULTS = {
    **{name: text for name, text in COLUMNS.items() if name != "time"},
    "bounces": ("1", "rebounds from walls"),
    "energy_residual": ("1", "what the energy ledger misses, of its largest entry"),
    "end_time": ("s", "when it ends"),
}


@dataclass(frozen=True)
class SceneMap:
    """Ends of a scene over its ranges.

    ``axes``: values by path; ``columns``: arrays of the shape of the axes by name, units in
    :data:`RESULTS`; ``end``: index of :data:`puck_tables.scene.outcome.ENDS`; ``plan``: the model
    of the last one.
    """

    title: str
    axes: Mapping[str, FloatArray]
    plan: Plan
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)


def sweep_scene(
    tables: Mapping[str, Any] | str | Path,
    *,
    threads: int | None = None,
    chunk: int = CHUNK,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
) -> SceneMap:
    """Run a scene for all combinations of the numbers in it that are ranges.

    Parameters
    ----------
    tables : nested tables, or the name of a scene file
        As :func:`puck_tables.scene.scene.scene_from` takes them, with 'START:STOP:COUNT' for one
        number or more.
    threads, chunk : int
        How the work is cut; the numbers do not depend on it, to the last bit.
    progress : callable (done, total), optional
    checkpoint : path, optional
        A file that keeps what is done: called again with the same scene, the work goes on.

    Returns
    -------
    SceneMap

    Raises
    ------
    InputError
        If a scene is not valid, nothing ranges, or the map would not fit in memory.

    Examples
    --------
    >>> stops = sweep_scene({
    ...     "puck": {"radius": 0.04}, "floor": {"friction": 0.1},
    ...     "launch": {"velocity": ["1:2:2", 0.0]},
    ... })
    >>> stops.columns["x"].round(6).tolist()
    [0.509858, 2.039432]
    """
    source = "scene"
    if isinstance(tables, str | Path):
        tables, source = find_scene(str(tables)), str(tables)
    found = dict(tables)
    first, axes = scene_from(found, source)
    whole = copy.deepcopy(found)
    if not axes:
        raise InputError(
            "no number of the scene is a range: write one as 'START:STOP:COUNT' (such as "
            "launch.spin = '0:10:101')"
        )
    shape = tuple(values.size for values in axes.values())
    check_memory(shape, BYTES)
    size = math.prod(shape)
    inner = [path for path in axes if _is_launch(path, first)]
    outer = [path for path in axes if path not in inner]

    @lru_cache(maxsize=8)
    def case(numbers: tuple[float, ...]) -> _Case:
        changed = copy.deepcopy(whole)
        for path, number in zip(outer, numbers, strict=True):
            set_path(changed, path, number)
        return _Case(scene_from(changed)[0])

    def ends_of(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        index = np.unravel_index(np.arange(start, stop), shape)
        place = dict(zip(axes, index, strict=True))
        values = {path: axes[path][place[path]] for path in axes}
        out = np.empty((len(RESULTS), stop - start))
        status = np.empty(stop - start, np.int8)
        begin = 0
        while begin < stop - start:  # launches that differ in nothing but the launch, together
            numbers = tuple(float(values[path][begin]) for path in outer)
            end = begin + 1
            while end < stop - start and all(
                values[path][end] == number for path, number in zip(outer, numbers, strict=True)
            ):
                end += 1
            part = {path: values[path][begin:end] for path in inner}
            out[:, begin:end], status[begin:end] = case(numbers).ends(part, end - begin)
            if first.run.time is None and (status[begin:end] == TIME_UP).any():
                raise InputError(
                    "a run of this sweep still moves after a thousand times its time scale: it may "
                    "never stop; give run.time"
                )
            begin = end
        return out, status

    read = files_named(whole)

    def whole_ends(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        found = ends_of(start, stop)
        if files_named(whole) != read:
            raise InputError(
                f"a file that this scene names was changed while it was swept ({', '.join(read)}): "
                "begin again"
            )
        return found

    plan = case(tuple(float(axes[path][-1]) for path in outer)).plan
    if checkpoint is None:
        out, status = np.empty((len(RESULTS), size)), np.empty(size, np.int8)

        def work(start: int, stop: int) -> None:
            out[:, start:stop], status[start:stop] = whole_ends(start, stop)

        run_chunks(work, size, chunk, threads, progress)
    else:
        digest = work_digest(scene=whole, files=read)
        with Checkpoint(checkpoint, digest, len(RESULTS), size, chunk) as kept:

            def work_on(start: int, stop: int) -> None:
                if not kept.is_done(start):
                    kept.put(start, stop, *whole_ends(start, stop))

            run_chunks(work_on, size, chunk, threads, progress)
            out, status = kept.values, kept.status
    columns = {name: row.reshape(shape) for name, row in zip(RESULTS, out, strict=True)}
    return SceneMap(first.title, axes, plan, columns, status.reshape(shape))


class _Case:
    """A scene of which only the launch still varies."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.plan = scene, plan_for(scene)
        self.by_look_up = self.plan.plain and scene.run.time is None
        if self.by_look_up:
            self.plan = Plan("free pucks: stop look-up", True, self.plan.why)
        else:
            refuse_endless(scene)
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
            states[:, LAUNCH[path]] = values
        mass = scene.puck.mass
        inertia = mass * (scene.puck.gyration * scene.puck.radius) ** 2
        energy = 0.5 * mass * (states[:, VX] ** 2 + states[:, VY] ** 2)
        energy += 0.5 * inertia * states[:, SPIN] ** 2
        status = np.empty(count, np.int8)
        rows = np.empty((ENDS_COLUMNS, count))
        if self.prepared is None:
            self._look_up(states, rows, status)
        else:
            self.prepared.follow_all(states, rows, status)
            rows[:, status > OVER_EDGE] = np.nan  # how it failed stands in ``end``
        last = dict(zip(list(COLUMNS)[:-1], rows[:-1], strict=True))
        last["kinetic_energy"] = 0.5 * mass * (last["vx"] ** 2 + last["vy"] ** 2)
        last["kinetic_energy"] += 0.5 * inertia * last["spin"] ** 2
        if self.prepared is None:  # nothing is integrated: heat is what else is not there
            last["heat_dry"][:] = energy + last["work_support"] - last["kinetic_energy"]
        with np.errstate(all="ignore"):  # runs that failed are not a number
            missing, largest = ledger(last, energy)
            residual = missing / np.where(largest > 0.0, largest, 1.0)
        results = [last[name] for name in COLUMNS if name != "time"]
        return np.stack([*results, rows[-1], residual, last["time"]]), status

    def _look_up(self, states: FloatArray, rows: FloatArray, status: npt.NDArray[np.int8]) -> None:
        belt = self.scene.floor.velocity
        free = free_puck(self.scene)
        free |= {"v0": states[:, [VX, VY]] - belt, "w0": states[:, SPIN]}
        stops = stop(**free, tol=self.scene.run.tol)
        rows[...] = 0.0
        last = dict(zip(list(COLUMNS)[:-1], rows[:-1], strict=True))
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
    fixed = path.startswith("launch.position") and bool(scene.wall or scene.edge)
    return path in LAUNCH and scene.constraint is None and not fixed


def set_path(tables: dict[str, Any], path: str, value: Any) -> None:
    """Put a value at a path such as launch.velocity[0] or wall[1].restitution.

    Raises
    ------
    InputError
        If the path leads nowhere.

    Examples
    --------
    >>> tables = {"launch": {"velocity": [1.0, 0.0]}}
    >>> set_path(tables, "launch.velocity[0]", 2.0)
    >>> set_path(tables, "floor.slope", 0.1)
    >>> tables
    {'launch': {'velocity': [2.0, 0.0]}, 'floor': {'slope': 0.1}}
    """
    if not re.fullmatch(r"\w+(\[\d{1,6}\])?(\.\w+(\[\d{1,6}\])?)*", path):
        raise InputError(f"{path!r} is no path: write one like launch.spin or wall[0].restitution")
    steps: list[str | int] = [
        int(number) if number else name for name, number in re.findall(r"(\w+)|\[(\d+)\]", path)
    ]
    at: Any = tables
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        try:
            if following is None:
                at[step] = value
            elif isinstance(step, str) and step not in at:
                at[step] = {} if isinstance(following, str) else [0.0, 0.0]
                at = at[step]
            else:
                at = at[step]
        except (IndexError, TypeError, KeyError):
            raise InputError(
                f"{path}: the scene has no such entry to set; 'puck scene fields' lists what may "
                "be, walls and edges are written in a file"
            ) from None
