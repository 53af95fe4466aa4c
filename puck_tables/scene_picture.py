"""Pictures of scenes: the plane with what is in it, and energies over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.errors import InputError
from puck_tables.plots import (
    BLUE,
    COLORS,
    GREEN,
    GREY,
    ORANGE,
    PICTURE_KINDS,
    RED,
    canvas,
    save,
)
from puck_tables.result_file import kind_of
from puck_tables.scene.outcome import SceneRun
from puck_tables.scene.sweep import SceneMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PUCKS_DRAWN = 12
_SHAPE = 2.2  # width of the upper panel over its height
_ENERGIES = {
    "kinetic_energy": ("kinetic", BLUE),
    "heat_dry": ("dry friction", ORANGE),
    "heat_viscous": ("viscous friction", GREEN),
    "heat_impact": ("impacts", RED),
    "work_given": ("work of forces", "#8b2fa0"),
    "work_support": ("work of supports", GREY),
}
_MAPS = ("end_time", "x", "y", "orientation")
_LABELS = {"end_time": "end time / s", "x": "end x / m", "y": "end y / m",
           "orientation": "orientation / rad"}  # fmt: skip


def plot_scene(run: SceneRun, path: str | Path, overwrite: bool = False) -> None:
    """Draw a scene run: its path among walls, edges and strips; speeds; and the energy ledger.

    Raises
    ------
    InputError
        If the ending is not known, or the run holds fewer than two states.
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
    columns = run.columns
    if columns["time"].size < 2:
        raise InputError("a picture needs two states or more: ask for more frames")
    figure = canvas(10.0, 8.2)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    _draw_plane(figure.add_subplot(grid[0, :]), run)
    speeds = figure.add_subplot(grid[1, 0])
    time, radius = columns["time"], run.scene.puck.radius
    speeds.plot(time, np.hypot(columns["vx"], columns["vy"]), color=BLUE, label="speed v")
    speeds.plot(time, radius * columns["spin"], color=ORANGE, label="rim speed rω")
    speeds.axhline(0.0, color=GREY, linewidth=0.6)
    speeds.set(xlabel="time / s", ylabel="m/s")
    speeds.legend(frameon=False, fontsize=9)
    energies = figure.add_subplot(grid[1, 1], sharex=speeds)
    largest = max(float(np.abs(columns[name]).max()) for name in _ENERGIES)
    for name, (label, color) in _ENERGIES.items():
        if np.abs(columns[name]).max() > 1e-9 * largest:
            energies.plot(time, columns[name], color=color, label=label)
    energies.axhline(0.0, color=GREY, linewidth=0.6)
    energies.set(xlabel="time / s", ylabel="J")
    energies.legend(frameon=False, fontsize=9)
    for axes in (speeds, energies):
        for event in run.events:
            if event.what in ("bounces", "border", "slips", "rests"):
                axes.axvline(event.time, color=GREY, linewidth=0.5, linestyle=":")
    title = run.scene.title or "Scene"
    figure.suptitle(f"{title}: {run.end} after {run.end_time:.4g} s")
    save(figure, path, kind, overwrite)


def _draw_plane(axes: Axes, run: SceneRun) -> None:
    from matplotlib.patches import Circle

    columns, scene = run.columns, run.scene
    x, y, angle = columns["x"], columns["y"], columns["orientation"]
    radius = scene.puck.radius
    turns = [event for event in run.events if event.what == "bounces"]
    when = np.searchsorted(columns["time"], [event.time for event in turns])
    path = [np.insert(x, when, [e.x for e in turns]), np.insert(y, when, [e.y for e in turns])]
    axes.plot(*path, color=BLUE, linewidth=1.4, zorder=3)
    axes.plot([e.x for e in turns], [e.y for e in turns], "o", markersize=3, color=RED, zorder=4)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    count = min(_PUCKS_DRAWN, max(2, int(way[-1] / (2.2 * radius)) + 1))
    chosen = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], count)).clip(0, x.size - 1))
    for n in chosen:
        axes.add_patch(
            Circle((x[n], y[n]), radius, fill=False, color=GREY, linewidth=0.8, zorder=2)
        )
        tip = (x[n] + radius * math.cos(angle[n]), y[n] + radius * math.sin(angle[n]))
        axes.plot([x[n], tip[0]], [y[n], tip[1]], color=GREY, linewidth=0.8, zorder=2)
    box = _box(x, y, 1.6 * radius)
    for wall in scene.wall:
        _draw_line(axes, wall.point, wall.normal, box, color="black", linewidth=2.5)
    for edge in scene.edge:
        _draw_line(axes, edge.point, edge.normal, box, color=RED, linestyle="--")
    strips = scene.floor.strips
    if strips is not None:
        across = (math.cos(strips.direction), math.sin(strips.direction))
        for border in strips.borders:
            point = (border * across[0], border * across[1])
            _draw_line(axes, point, across, box, color=GREEN, linestyle="-.")
    axes.plot(x[0], y[0], marker="s", color=GREEN, markersize=6, zorder=5, label="launch")
    axes.plot(x[-1], y[-1], marker="o", color=ORANGE, markersize=6, zorder=5, label=run.end)
    axes.legend(frameon=False, fontsize=9, loc="best")
    axes.set(xlabel="x / m", ylabel="y / m", xlim=box[:2], ylim=box[2:])
    axes.set_aspect("equal")


def _box(x: Any, y: Any, margin: float) -> tuple[float, float, float, float]:
    """Limits of the plane around a path, of the shape of the panel."""
    middle = ((x.min() + x.max()) / 2, (y.min() + y.max()) / 2)
    wide, high = float(np.ptp(x)) / 2 + margin, float(np.ptp(y)) / 2 + margin
    wide, high = 1.05 * max(wide, _SHAPE * high), 1.05 * max(high, wide / _SHAPE)
    return middle[0] - wide, middle[0] + wide, middle[1] - high, middle[1] + high


def _draw_line(
    axes: Axes, point: tuple[float, float], normal: tuple[float, float], box: Any, **style: Any
) -> None:
    """A line, drawn only where it is in sight."""
    size = math.hypot(*normal)
    nx, ny = normal[0] / size, normal[1] / size
    middle = ((box[0] + box[1]) / 2, (box[2] + box[3]) / 2)
    half = math.hypot(box[1] - box[0], box[3] - box[2])
    off = nx * (middle[0] - point[0]) + ny * (middle[1] - point[1])
    if abs(off) > half:
        return
    foot = (middle[0] - off * nx, middle[1] - off * ny)
    axes.plot(
        [foot[0] - half * ny, foot[0] + half * ny], [foot[1] + half * nx, foot[1] - half * nx],
        zorder=1, **style,
    )  # fmt: skip


def plot_scene_map(stops: SceneMap, path: str | Path, overwrite: bool = False) -> None:
    """Draw ends of a scene: maps when two numbers range, curves when one does.

    With more, the maps are drawn at the middle of the first ones.

    Raises
    ------
    InputError
        If the ending is not known.
    MissingExtraError
        If matplotlib is not installed.
    OutputError
        If the file exists or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables.scene.sweep import sweep_scene
    >>> floor, launch = {"friction": 0.1}, {"velocity": ["1:2:9", 0.0]}
    >>> stops = sweep_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": launch})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_scene_map(stops, folder + "/map.png")
    """
    kind = kind_of(path, PICTURE_KINDS)
    figure = canvas(10.0, 7.6)
    names = list(stops.axes)
    fixed = {name: stops.axes[name].size // 2 for name in names[:-2]}
    place = tuple(fixed.values())
    for panel, name in enumerate(_MAPS):
        axes = figure.add_subplot(2, 2, panel + 1)
        values = stops.columns[name][place]
        if len(names) == 1:
            axes.plot(stops.axes[names[0]], values, color=COLORS[panel])
            axes.set(xlabel=names[0], ylabel=_LABELS[name])
        else:
            mesh = axes.pcolormesh(
                stops.axes[names[-1]], stops.axes[names[-2]], values, shading="nearest",
                cmap="viridis", rasterized=True,
            )  # fmt: skip
            figure.colorbar(mesh, ax=axes, label=_LABELS[name])
            axes.set(xlabel=names[-1], ylabel=names[-2])
    at = ", ".join(f"{name} = {stops.axes[name][n]:g}" for name, n in fixed.items())
    figure.suptitle((stops.title or "Scene") + (f" at {at}" if at else ""))
    save(figure, path, kind, overwrite)
