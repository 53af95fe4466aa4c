"""Maps of stops over ranges of spin, speed and height."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables.any_stops import HEIGHT_COST, AnyStops
from puck_tables.checkpoint import Checkpoint, work_digest
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.executor import run_chunks
from puck_tables.front import Choice
from puck_tables.puck import positive, velocity_array
from puck_tables.real import finite_array
from puck_tables.similarity.stop_table import StopTable
from puck_tables.solvers import OUTPUTS
from puck_tables.stops import DEFAULT_TOL, any_solver
from puck_tables.table.resultant_table import ResultantTable

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

CHUNK = 1024
# Arrays, the encoded HDF5 file and working copies; as text (CSV) much more.
BYTES_PER_LAUNCH, BYTES_PER_ROW = 130, 750

DEFAULT_SPEED = np.linspace(0.0, 2.0, 41)
DEFAULT_SPIN = np.linspace(-4.0, 4.0, 41)


@dataclass(frozen=True)
class StopMap:
    """Stops over a grid of launches.

    ``axes`` maps the ranged quantities, in the order of the arrays' dimensions, to their values:
    of ``delta`` (1), ``speed`` (m/s, along x) and ``w0`` (rad/s).  ``fixed`` holds the others, with
    ``radius`` (m), ``decel`` (m/s²) and, if given instead of a speed, ``v0_x``, ``v0_y`` (m/s).

    Arrays: ``stop_time`` s, ``stop_x``, ``stop_y`` m from the launch, ``path_length`` m,
    ``turn_angle`` rad (until Q has fallen to 1/1000; integrated, to a hundred times the tolerance),
    ``body_angle`` rad, ``status`` (0: stopped).  ``method`` says how ('look-up', 'integrated'),
    ``table`` with which table, ``choice`` why.
    """

    axes: dict[str, FloatArray]
    fixed: dict[str, float]
    tol: float
    method: str
    choice: Choice | None = field(repr=False)
    table: str
    stop_time: FloatArray = field(repr=False)
    stop_x: FloatArray = field(repr=False)
    stop_y: FloatArray = field(repr=False)
    path_length: FloatArray = field(repr=False)
    turn_angle: FloatArray = field(repr=False)
    body_angle: FloatArray = field(repr=False)
    status: npt.NDArray[np.int8] = field(repr=False)


def sweep(
    w0: npt.ArrayLike | None = None,
    speed: npt.ArrayLike | None = None,
    *,
    v0: npt.ArrayLike | None = None,
    delta: npt.ArrayLike = 0.5,
    decel: float = 1.0,
    radius: float = 1.0,
    tol: float = DEFAULT_TOL,
    method: str | None = None,
    table: ResultantTable | StopTable | None = None,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
    threads: int | None = None,
    chunk: int = CHUNK,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
) -> StopMap:
    """Stops of all combinations of spins, speeds and heights.

    Parameters
    ----------
    w0 : number or array (n,), rad/s
    speed : number or array (n,), m/s, ≥ 0, along x
        Without ``w0``, ``speed`` and ``v0``: a map of 41 speeds by 41 spins.
    v0 : (vx, vy), m/s, instead of ``speed``
    delta : number or array (n,), dimensionless height
        Below 3.9637 under uniform pressure, up to the full contact of another law.
    decel, radius : J = fg in m/s² and m, > 0
    tol : float
        Largest error in units of Q/J (time) and Q²/J (place).
    method, table, pressure, gyration : optional
        As in :func:`puck_tables.stop`.
    threads, chunk : int
        How the work is cut; the numbers do not depend on it, to the last bit.
    progress : callable (done, total), optional
    checkpoint : path, optional
        A file that keeps what is done: called again with the same arguments, the work goes on from
        there.  It stays until you remove it.

    Returns
    -------
    StopMap
        One dimension for each argument that is an array.

    Raises
    ------
    InputError
        If an argument is not finite or outside its range, the map would not fit in memory, or
        ``checkpoint`` belongs to other work.
    AccuracyError
        If the tolerance is out of reach.

    Examples
    --------
    >>> stops = sweep([0.0, 1.0, 2.0], v0=(1.0, 0.0), delta=0.0)
    >>> stops.stop_x.round(4).tolist()
    [0.5, 0.6374, 0.9835]
    """
    for name, count in (("chunk", chunk), ("threads", 1 if threads is None else threads)):
        if not isinstance(count, int) or count < 1:
            raise InputError(f"{name} must be a whole number from 1 on, got {count!r}")
    solver = any_solver(tol, table, method, pressure, gyration, delta)
    if v0 is not None and speed is not None:
        raise InputError("v0 and speed both give the velocity: give one of them")
    if w0 is None and speed is None and v0 is None:
        w0, speed = DEFAULT_SPIN, DEFAULT_SPEED
    fixed = {"decel": positive("decel", decel, "m/s^2"), "radius": positive("radius", radius, "m")}
    direction = (1.0, 0.0)
    given: dict[str, npt.ArrayLike] = {"delta": delta}
    if v0 is None:
        given["speed"] = 1.0 if speed is None else speed
    else:
        velocity = velocity_array(v0)
        if velocity.shape != (2,):
            raise InputError(f"v0 must be one velocity (vx, vy), got shape {velocity.shape}")
        direction = (float(velocity[0]), float(velocity[1]))
        fixed["v0_x"], fixed["v0_y"] = direction
    given["w0"] = 0.0 if w0 is None else w0

    units = {"delta": "", "speed": "m/s", "w0": "rad/s"}
    values = {name: finite_array(name, value, units[name]) for name, value in given.items()}
    for name, array in values.items():
        if array.ndim > 1 or array.size == 0:
            raise InputError(f"{name} must be a number or a list of numbers")
    if "speed" in values and not np.all(values["speed"] >= 0.0):
        raise InputError(f"speed must not be negative, got {values['speed'].min():g} m/s")
    solver.checked_range(values["delta"])
    axes = {name: array for name, array in values.items() if array.ndim == 1}
    fixed.update({name: float(array) for name, array in values.items() if array.ndim == 0})
    shape = tuple(array.size for array in axes.values())
    check_memory(shape)

    size = math.prod(shape)
    flat = {name: array.ravel() for name, array in values.items()}
    sizes = tuple(array.size for array in flat.values())

    prepared = 0
    if isinstance(solver, AnyStops):
        heights = np.unique(flat["delta"])
        prepared = HEIGHT_COST * heights.size

        def on_heights(done: int, total: int) -> None:
            if progress is not None:
                progress(HEIGHT_COST * done, prepared + size)

        solver.prepare(heights, size // heights.size, threads, on_heights)

    def on_stops(done: int, total: int) -> None:
        if progress is not None:
            progress(prepared + done, prepared + size)

    def stops_of(start: int, stop: int) -> tuple[FloatArray, npt.NDArray[np.int8]]:
        index = np.unravel_index(np.arange(start, stop), sizes)
        launch = {name: flat[name][i] for name, i in zip(flat, index, strict=True)}
        along = launch.get("speed", np.ones(stop - start))
        launches = np.stack([
            along * direction[0], along * direction[1], launch["w0"], launch["delta"],
            np.full(stop - start, decel), np.full(stop - start, radius),
        ])  # fmt: skip
        return solver.all(launches)

    if checkpoint is None:
        out, status = np.empty((len(OUTPUTS), size)), np.empty(size, np.int8)

        def work(start: int, stop: int) -> None:
            out[:, start:stop], status[start:stop] = stops_of(start, stop)

        run_chunks(work, size, chunk, threads, on_stops)
    else:
        what = work_digest(solver=solver.work, launches=values, numbers={**fixed, "tol": tol})
        with Checkpoint(checkpoint, what, len(OUTPUTS), size, chunk) as kept:

            def work_on(start: int, stop: int) -> None:
                if not kept.is_done(start):
                    kept.put(start, stop, *stops_of(start, stop))

            run_chunks(work_on, size, chunk, threads, on_stops)
            out, status = kept.values, kept.status
    results = {name: row.reshape(shape) for name, row in zip(OUTPUTS, out, strict=True)}
    return StopMap(
        axes=axes,
        fixed=fixed,
        tol=tol,
        method=solver.method,
        choice=solver.choice,
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
