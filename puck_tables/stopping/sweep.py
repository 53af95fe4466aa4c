"""Maps of stops over ranges of spin, speed and height."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.checkpoint import chunked
from puck_tables._core.real import finite_array, one_velocity, positive
from puck_tables.accuracy.front import Selection
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS, derived, following
from puck_tables.io.dataset import Dataset, variable
from puck_tables.result import Result
from puck_tables.stopping.per_height import HEIGHT_COST, SolverPerHeight
from puck_tables.stopping.solvers import OUTPUTS, STATUS_MEANINGS
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable

Progress = Callable[[int, int], None]

# Arrays, the encoded HDF5 file and working copies; as text (CSV) much more.
BYTES_PER_LAUNCH, BYTES_PER_ROW = 160, 850

_ARGUMENTS = {"delta": "delta", "launch_speed": "speed", "launch_spin": "spin"}
DEFAULT_SPEED = np.linspace(0.0, 2.0, 41)
DEFAULT_SPIN = np.linspace(-4.0, 4.0, 41)


@dataclass(frozen=True, eq=False, repr=False)
class StopMap(Result):
    """Stops over a grid of launches.

    ``axes`` maps the ranged quantities, in the order of the arrays' dimensions, to their values:
    of ``delta`` (1), ``launch_speed`` (m/s, along x) and ``launch_spin`` (rad/s).  ``fixed`` holds
    the others, with ``radius`` (m), ``decel`` (m/s²) and, if given instead of a speed,
    ``launch_vx``, ``launch_vy`` (m/s).

    Arrays: ``stop_time`` s, ``stop_x``, ``stop_y`` m from the launch, ``path_length`` m,
    ``turn_angle`` rad (until Q has fallen to 1/1000; integrated, to a hundred times the tolerance),
    ``body_angle`` rad, ``status`` (0: stopped).  ``method`` says how ('look-up', 'integrated', or
    both where heights differ), ``table`` with which table, ``selections`` what was selected for
    the tolerance.
    """

    axes: dict[str, FloatArray]
    fixed: dict[str, float]
    tol: float
    method: str
    selections: tuple[Selection, ...] = field(repr=False)
    explanation: str = field(repr=False)
    table: str
    stop_time: FloatArray = field(repr=False)
    stop_x: FloatArray = field(repr=False)
    stop_y: FloatArray = field(repr=False)
    path_length: FloatArray = field(repr=False)
    turn_angle: FloatArray = field(repr=False)
    body_angle: FloatArray = field(repr=False)
    status: npt.NDArray[np.int8] = field(repr=False)

    picture: ClassVar[str] = "stop_map"

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others, such as ``stop_distance`` in m."""
        column: FloatArray = following(self, name)
        return column

    def __repr__(self) -> str:
        ranged = " x ".join(f"{name} ({values.size})" for name, values in self.axes.items())
        return f"StopMap({ranged or 'one launch'}, by {self.method})"

    def explain(self) -> str:
        """Which method was taken, and why."""
        return self.explanation

    def dataset(self) -> Dataset:
        """The stops over what was ranged; the rest as attributes."""
        dims = tuple(self.axes)
        axes = {name: variable(name, values, (name,)) for name, values in self.axes.items()}
        values = {name: getattr(self, name) for name in OUTPUTS}
        values |= derived(values)
        columns = {name: variable(name, array, dims) for name, array in values.items()}
        columns["status"] = variable("status", self.status, dims, STATUS_MEANINGS)
        attributes = {
            "title": "Stops of sliding, spinning pucks", **self.fixed,
            "tol": self.tol, "method": self.method, "table": self.table,
        }  # fmt: skip
        return Dataset(axes, columns, attributes)


def sweep(
    spin: npt.ArrayLike | None, speed: npt.ArrayLike | None, *, velocity: npt.ArrayLike | None,
    delta: npt.ArrayLike, decel: float, radius: float, pressure: str | Law, gyration: float,
    tol: float, method: str | None, table: ResultantTable | StopTable | None, threads: int | None,
    chunk: int, progress: Progress | None, checkpoint: str | Path | None,
) -> StopMap:  # fmt: skip
    """Stops of all combinations of spins, speeds and heights: :meth:`puck_tables.Puck.sweep`."""
    for name, count in (("chunk", chunk), ("threads", 1 if threads is None else threads)):
        if not isinstance(count, int) or count < 1:
            raise InputError(f"{name} must be a whole number from 1 on, got {count!r}")
    solver = SolverPerHeight(pressure, gyration, tol, method, table)
    if velocity is not None and speed is not None:
        raise InputError("velocity and speed both give the velocity: give one of them")
    if spin is None and speed is None and velocity is None:
        spin, speed = DEFAULT_SPIN, DEFAULT_SPEED
    fixed = {"decel": positive("decel", decel, "m/s^2"), "radius": positive("radius", radius, "m")}
    direction = (1.0, 0.0)
    given: dict[str, npt.ArrayLike] = {"delta": delta}
    if velocity is None:
        given["launch_speed"] = 1.0 if speed is None else speed
    else:
        direction = one_velocity(velocity)
        fixed["launch_vx"], fixed["launch_vy"] = direction
    given["launch_spin"] = 0.0 if spin is None else spin

    values = {
        name: finite_array(_ARGUMENTS[name], value, COLUMNS[name].unit)
        for name, value in given.items()
    }
    for name, array in values.items():
        if array.ndim > 1 or array.size == 0:
            raise InputError(f"{_ARGUMENTS[name]} must be a number or a list of numbers")
    speeds = values.get("launch_speed", np.zeros(1))
    if not np.all(speeds >= 0.0):
        raise InputError(f"speed must not be negative, got {speeds.min():g} m/s")
    solver.checked_range(values["delta"])
    axes = {name: array for name, array in values.items() if array.ndim == 1}
    fixed.update({name: float(array) for name, array in values.items() if array.ndim == 0})
    shape = tuple(array.size for array in axes.values())
    check_memory(shape)

    size = math.prod(shape)
    flat = {name: array.ravel() for name, array in values.items()}
    sizes = tuple(array.size for array in flat.values())

    each = size // values["delta"].size
    prepared = HEIGHT_COST * solver.heights_to_prepare(flat["delta"])

    def on_heights(done: int, total: int) -> None:
        if progress is not None:
            progress(HEIGHT_COST * done, prepared + size)

    solver.prepare(flat["delta"], each, threads, on_heights)

    def on_stops(done: int, total: int) -> None:
        if progress is not None:
            progress(prepared + done, prepared + size)

    def stops_of(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        index = np.unravel_index(np.arange(start, stop), sizes)
        launch = {name: flat[name][i] for name, i in zip(flat, index, strict=True)}
        along = launch.get("launch_speed", np.ones(stop - start))
        launches = np.stack([
            along * direction[0], along * direction[1], launch["launch_spin"], launch["delta"],
            np.full(stop - start, decel), np.full(stop - start, radius),
        ])  # fmt: skip
        return solver.all(launches)

    work = {"solver": solver.work, "launches": values, "numbers": {**fixed, "tol": tol}}
    out, status = chunked(stops_of, len(OUTPUTS), size, chunk, threads, on_stops, checkpoint, work)
    results = {name: row.reshape(shape) for name, row in zip(OUTPUTS, out, strict=True)}
    return StopMap(
        axes=axes,
        fixed=fixed,
        tol=tol,
        method=solver.method,
        selections=solver.selections,
        explanation=solver.explanation,
        table=solver.source,
        status=status.reshape(shape),
        **results,
    )


def check_memory(shape: tuple[int, ...], per_launch: int = BYTES_PER_LAUNCH) -> None:
    """Refuse a map that would not fit in memory, before anything is allocated.

    Parameters
    ----------
    shape : the sizes of the ranges
    per_launch : bytes needed for each launch

    Raises
    ------
    InputError

    Examples
    --------
    >>> check_memory((1000, 1000))
    """
    needed = float(per_launch) * math.prod(shape)
    available = _memory()
    if needed > available:
        sizes = " x ".join(str(n) for n in shape)
        raise InputError(
            f"a map of {sizes} launches would need {needed / 2**30:.3g} GiB of memory, "
            f"{available / 2**30:.3g} GiB are free: use smaller counts"
        )


def _memory() -> float:
    """Free memory in bytes where the system tells it, else 4 GiB."""
    try:
        with open("/proc/meminfo") as file:
            for line in file:
                if line.startswith("MemAvailable"):
                    return 1024.0 * float(line.split()[1])
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, AttributeError):
        return 4.0 * 2**30
