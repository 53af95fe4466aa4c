"""Scene runs and maps as files: HDF5 that xarray opens, CSV, JSON lines; whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.result_file import MAP_KINDS, TRAJECTORY_KINDS, as_csv, as_hdf5, kind_of
from puck_tables.safe_write import write_bytes
from puck_tables.scene.entries import as_toml, entry_at, tables_of, units_of
from puck_tables.scene.outcome import COLUMNS, ENDS, SceneRun
from puck_tables.scene.scene import Scene
from puck_tables.scene.sweep import RESULTS, SceneMap

FloatArray = npt.NDArray[np.float64]

END = {"end": ("1", "how it ends: " + ", ".join(f"{i} {end}" for i, end in enumerate(ENDS)))}
EVENT_UNITS = {"time": "s", "what": "1", "which": "1", "x": "m", "y": "m"}


def scene_summary(run: SceneRun) -> dict[str, Any]:
    """The scalars of a scene run with its inputs and all units, ready for JSON.

    Examples
    --------
    >>> from puck_tables.scene.simulate import simulate_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": [1.0, 0.0]}
    >>> run = simulate_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> told = scene_summary(run)
    >>> told["end"], told["scene"]["launch"]["velocity"], told["units"]["scene.launch.velocity"]
    ('at rest', [1.0, 0.0], 'm/s')
    """
    last = {name: value for name, value in run.last.items() if name != "time"}
    return {
        "title": run.scene.title,
        "end": run.end,
        "end_time": run.end_time,
        **last,
        "events": [event._asdict() for event in run.events],
        "energy_residual": run.energy_residual,
        "error_estimate": run.error_estimate,
        "speed_scale": run.speed_scale,
        "rate_scale": run.rate_scale,
        "steps": run.steps,
        "model": run.plan.model,
        "scene": tables_of(run.scene),
        "units": {
            "end_time": "s",
            "speed_scale": "m/s",
            "rate_scale": "m/s^2",
            **{name: COLUMNS[name][0] for name in last},
            **{f"events.{name}": unit for name, unit in EVENT_UNITS.items()},
            **{f"scene.{path}": unit for path, unit in units_of(run.scene).items()},
        },
    }


def _texts(
    scene: Scene, ranges: Mapping[str, FloatArray], files: Mapping[str, str]
) -> tuple[dict[str, str], dict[str, tuple[str, str]]]:
    """A scene as a scene file, the files it names, and what they are."""
    texts = {"scene": as_toml(scene, ranges)}
    names = {"scene": ("", "the scene as a scene file (TOML)")}
    for path, text in files.items():
        texts[_plain(path)] = text
        names[_plain(path)] = ("", f"what stands in the file that {path} of the scene names")
    return texts, names


def save_scene_run(run: SceneRun, path: str | Path, overwrite: bool = False) -> None:
    """Write the states of a scene run as HDF5, CSV or JSON lines, by the ending of the name.

    Raises
    ------
    InputError
        If the ending is not .h5, .csv or .jsonl.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables.scene.simulate import simulate_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": [1.0, 0.0]}
    >>> run = simulate_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_scene_run(run, folder + "/run.csv")
    ...     print(Path(folder, "run.csv").read_text()[:12])
    time[s],x[m]
    """
    kind = kind_of(path, TRAJECTORY_KINDS)
    columns = dict(run.columns)
    if kind == ".h5":
        content = _run_as_hdf5(run)
    else:
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        if kind == ".csv":
            content = as_csv(COLUMNS, rows)
        else:
            content = "".join(
                json.dumps(dict(zip(columns, row, strict=True)), allow_nan=False) + "\n"
                for row in rows
            ).encode()
    write_bytes(path, content, overwrite)


def _run_as_hdf5(run: SceneRun) -> bytes:
    columns: dict[str, Any] = dict(run.columns)
    axes: dict[str, Any] = {"time": columns.pop("time")}
    dimensions: dict[str, tuple[str, ...]] = dict.fromkeys(columns, ("time",))
    names = dict(COLUMNS)
    if run.events:
        axes["event"] = np.arange(len(run.events))
        columns |= {
            "event_time": np.array([event.time for event in run.events]),
            "event_what": [event.what for event in run.events],
            "event_which": np.array([event.which for event in run.events]),
        }
        dimensions |= dict.fromkeys(("event_time", "event_what", "event_which"), ("event",))
        names |= {
            "event": ("1", "number of the event"),
            "event_time": ("s", "when it happens"),
            "event_what": ("1", "rests, slips, bounces, leans, border or edge"),
            "event_which": ("1", "number of the wall, the edge or the region"),
        }
    left = (*names, "events", "scene", "units", "title")
    scalars = {n: v for n, v in scene_summary(run).items() if n not in left}
    texts, about = _texts(run.scene, {}, run.files)
    attributes = {"title": run.scene.title or "Scene", **scalars}
    return as_hdf5(axes, columns, {**names, **about}, attributes, dimensions, texts=texts)


def save_scene_map(stops: SceneMap, path: str | Path, overwrite: bool = False) -> None:
    """Write a map over a scene as HDF5, or as CSV with one row a run, by the ending of the name.

    Raises
    ------
    InputError
        If the ending is neither .h5 nor .csv.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables.scene.sweep import sweep_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": ["1:2:2", 0.0]}
    >>> stops = sweep_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_scene_map(stops, folder + "/map.h5")
    """
    if kind_of(path, MAP_KINDS) == ".csv":
        write_bytes(path, scene_map_as_csv(stops).encode(), overwrite)
        return
    axes = {_plain(path): values for path, values in stops.axes.items()}
    names = {}
    for at in stops.axes:
        entry = entry_at(stops.scene, at)
        text = f"{at} of the scene" + (f", {entry.doc}" if entry.doc else "")
        names[_plain(at)] = (entry.kind.unit or "1", text)
    attributes = {"title": stops.scene.title or "Scene", "model": stops.plan.model}
    texts, about = _texts(stops.scene, stops.axes, stops.files)
    content = as_hdf5(
        axes, {**stops.columns, "end": stops.end}, {**names, **RESULTS, **END, **about},
        attributes, flags={"end": ENDS}, texts=texts,
    )  # fmt: skip
    write_bytes(path, content, overwrite)


def _plain(path: str) -> str:
    """A path as a name: no brackets or dots, which other programs stumble over.

    Examples
    --------
    >>> _plain("launch.velocity[0]")
    'launch_velocity_0'
    """
    return path.replace("[", "_").replace("]", "").replace(".", "_")


def scene_map_as_csv(stops: SceneMap) -> str:
    """A map as CSV text: ranged numbers, then results; one row a run.

    Examples
    --------
    >>> from puck_tables.scene.sweep import sweep_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": ["1:2:2", 0.0]}
    >>> stops = sweep_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> len(scene_map_as_csv(stops).splitlines())
    3
    """
    grids = np.meshgrid(*stops.axes.values(), indexing="ij")
    columns = [grid.ravel().tolist() for grid in grids]
    columns += [column.ravel().tolist() for column in stops.columns.values()]
    ends = [ENDS[code] for code in stops.end.ravel()]
    header = as_csv({**RESULTS, **END}, iter(())).decode()
    body = as_csv({}, zip(*columns, ends, strict=True)).decode().split("\n", 1)[1]
    units = [entry_at(stops.scene, path).kind.unit or "1" for path in stops.axes]
    named = [f"{path}[{unit}]" for path, unit in zip(stops.axes, units, strict=True)]
    return ",".join([*named, header]) + body
