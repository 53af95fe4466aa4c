"""Pictures of scene runs: the plane with what is in it, speeds, and energies over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from puck_tables.drawing import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PICTURE_KINDS,
    RED,
    canvas,
    legend_below,
    save,
    titled,
)
from puck_tables.errors import InputError
from puck_tables.result_file import kind_of
from puck_tables.scene.outcome import SceneRun
from puck_tables.scene.scene import files_of
from puck_tables.scene.simulate import simulate_scene
from puck_tables.scene_plane import draw_plane

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = npt.NDArray[np.float64]

_ENERGIES = {
    "kinetic_energy": ("kinetic", BLUE),
    "heat_dry": ("dry friction", ORANGE),
    "heat_viscous": ("viscous friction", GREEN),
    "heat_impact": ("impacts", RED),
    "work_given": ("work of forces", "#8b2fa0"),
    "work_support": ("work of supports", GREY),
}
_STATES = 2000  # of the picture, at least
_STATES_A_TURN, _MOST_STATES = 60, 50_000
_EVENTS_DRAWN = 60  # as lines over time


def plot_scene(run: SceneRun, path: str | Path, overwrite: bool = False) -> None:
    """Draw a scene run: its path among all that is in the plane; speeds; and the energy ledger.

    The whole motion is drawn, with every event, whatever states the run has: it is run again.

    Raises
    ------
    InputError
        If the ending is not known, or a file that the scene names has changed since the run.
    MissingExtraError
        If matplotlib is not installed.
    OutputError
        If the file exists or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables.scene.simulate import simulate_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": [1.0, 0.0]}
    >>> run = simulate_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_scene(run, folder + "/scene.png")
    """
    kind = kind_of(path, PICTURE_KINDS)
    columns = states_drawn(run)
    figure = canvas(10.0, 9.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    draw_plane(figure.add_subplot(grid[0, :]), run, columns)
    speeds = figure.add_subplot(grid[1, 0])
    time, radius = columns["time"], run.scene.puck.radius
    speeds.plot(time, np.hypot(columns["vx"], columns["vy"]), color=BLUE, label="speed v")
    speeds.plot(time, radius * columns["spin"], color=ORANGE, label="rim speed rω")
    energies = figure.add_subplot(grid[1, 1], sharex=speeds)
    largest = max(float(np.abs(columns[name]).max()) for name in _ENERGIES)
    for name, (label, color) in _ENERGIES.items():
        if np.abs(columns[name]).max() > 1e-9 * largest:
            energies.plot(time, columns[name], color=color, label=label)
    for axes, unit in ((speeds, "m/s"), (energies, "J")):
        axes.axhline(0.0, color=GREY, linewidth=0.6)
        axes.set(xlabel="time / s", ylabel=unit)
        _draw_events(axes, run)
        legend_below(axes)
    title = run.scene.title or "Scene"
    titled(figure, f"{title}: {run.end} after {run.end_time:.4g} s")
    save(figure, path, kind, overwrite)


def states_drawn(run: SceneRun) -> dict[str, FloatArray]:
    """States of a run so close that lines between them are its curves, before and after events.

    Raises
    ------
    InputError
        If a file that the scene names has changed since the run.
    """
    if files_of(run.scene) != run.files:
        raise InputError("a file that the scene names has changed since the run: run it again")
    scene = run.scene
    turns = (
        abs(run.last["orientation"] - scene.launch.orientation)
        + (abs(scene.launch.spin) + abs(scene.floor.turning)) * run.end_time
    ) / (2.0 * math.pi)
    count = int(min(max(_STATES, _STATES_A_TURN * turns), _MOST_STATES))
    events = np.array([event.time for event in run.events])
    times = np.concatenate(
        [np.linspace(0.0, run.end_time, count), events, np.nextafter(events, np.inf)]
    )
    times = np.unique(times[times <= run.end_time])
    return dict(simulate_scene(scene, times).columns)


def _draw_events(axes: Axes, run: SceneRun) -> None:
    """Thin lines at what happens, as long as there are not too many."""
    events = [e for e in run.events if e.what in ("bounces", "leans", "border", "slips", "rests")]
    for event in events if len(events) <= _EVENTS_DRAWN else ():
        axes.axvline(event.time, color=GREY, linewidth=0.5, linestyle=":")
