"""Pictures of trajectories, maps of stops, and aims."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from puck_tables.aiming import Aim, kind_of_puck
from puck_tables.body import is_plain
from puck_tables.drawing import (
    BLUE,
    FEW,
    GREEN,
    GREY,
    LAUNCH,
    ORANGE,
    PICTURE_KINDS,
    STOP,
    canvas,
    draw_over,
    legend_below,
    save,
    titled,
)
from puck_tables.errors import InputError
from puck_tables.result_file import kind_of
from puck_tables.states import flow
from puck_tables.stop_map import StopMap
from puck_tables.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MAP_LABELS = {
    "stop_time": "stop time / s",
    "stop_x": "stop x / m",
    "stop_y": "stop y / m",
    "path_length": "path length / m",
    "turn_angle": "turn of heading / rad",
    "body_angle": "turn of body / rad",
}
_AXIS_LABELS = {"delta": "height δ", "speed": "speed v₀ / m/s", "w0": "spin ω₀ / rad/s"}
_PUCKS_DRAWN = 9
_STATES_DRAWN = 1001


def plot_trajectory(run: Trajectory, path: str | Path, overwrite: bool = False) -> None:
    """Draw a trajectory: the path with the puck's orientation, and speeds against time.

    Parameters
    ----------
    run : Trajectory
        The whole motion is drawn, whatever states it has.
    path : .png, .svg or .pdf
    overwrite : whether an existing file may be replaced

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
    >>> from puck_tables import simulate
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_trajectory(simulate((1.0, 0.0), 5.0), folder + "/run.png")
    """
    kind = kind_of(path, PICTURE_KINDS)
    run = run.at(np.linspace(0.0, run.stop_time, _STATES_DRAWN))
    figure = canvas(9.5, 7.6)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.15, 1.0))
    _draw_path(figure.add_subplot(grid[0, :]), run)
    speeds = figure.add_subplot(grid[1, 0])
    speeds.plot(run.time, run.speed, color=BLUE, label="speed v")
    speeds.plot(run.time, run.radius * run.spin, color=ORANGE, label="rim speed rω")
    speeds.axhline(0.0, color=GREY, linewidth=0.6)
    for moment, text in ((run.contact_opens, "base lifts"), (run.contact_closes, "base down")):
        if moment is not None:
            speeds.axvline(moment, color=GREY, linestyle=":", linewidth=1.0, label=text)
    speeds.set_ylabel("m/s")
    speeds.set_xlabel("time / s")
    legend_below(speeds)
    ratio = figure.add_subplot(grid[1, 1], sharex=speeds)
    moving = run.speed > 0.0
    if moving.any() and run.w0 != 0.0:
        ratio.plot(run.time[moving], np.tan(run.slip_angle[moving]), color=GREEN)
        if run.limit_angle < 0.5 * math.pi:
            _draw_limit(ratio, run, float(np.tan(run.slip_angle[moving]).max()))
    else:
        ratio.text(
            0.5, 0.5, "spin only" if run.w0 != 0.0 else "no spin",
            ha="center", transform=ratio.transAxes, color=GREY,
        )  # fmt: skip
    ratio.set_ylabel("rω/v")
    ratio.set_xlabel("time / s")
    titled(
        figure,
        f"v₀ = ({run.v0[0]:g}, {run.v0[1]:g}) m/s, ω₀ = {run.w0:g} rad/s, r = {run.radius:g} m, "
        f"δ = {run.delta:.4g}, J = {run.decel:.4g} m/s²{_kind(run)}",
    )
    save(figure, path, kind, overwrite)


def _kind(run: Trajectory) -> str:
    """The kind of puck, and how much of its base is loaded, where there is something to say."""
    text = ""
    if not is_plain(run.pressure, run.gyration, 0.0):
        text = f"\npressure {run.pressure}, k/r = {run.gyration:.4g}"
    if run.least_loaded_share < 1.0:
        text += f"\nat the least {100.0 * run.least_loaded_share:.3g} % of the base loaded"
    return text


def _draw_limit(panel: Axes, run: Trajectory, largest: float) -> None:
    """The ratio that the motion tends to."""
    limit = math.copysign(math.tan(run.limit_angle), run.w0)
    panel.axhline(limit, color=GREY, linestyle="--", linewidth=1.0)
    above = limit > largest
    panel.annotate(
        f"limit {limit:.3f}", (0.02, limit), xycoords=("axes fraction", "data"),
        xytext=(0, -3 if above else 3), va="top" if above else "bottom",
        textcoords="offset points", color=GREY, fontsize=9,
    )  # fmt: skip


def plot_map(stops: StopMap, path: str | Path, overwrite: bool = False) -> None:
    """Draw stops: maps when two quantities are ranged, curves when one is or one has few values.

    With three ranged quantities the maps are drawn at the middle value of the first.

    Parameters
    ----------
    stops : StopMap
    path : .png, .svg or .pdf
    overwrite : whether an existing file may be replaced

    Raises
    ------
    InputError
        If nothing is ranged or the ending is not known.
    MissingExtraError
        If matplotlib is not installed.
    OutputError
        If the file exists or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import sweep
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_map(sweep([0.0, 1.0, 2.0], 1.0), folder + "/map.png")
    """
    kind = kind_of(path, PICTURE_KINDS)
    axes = dict(stops.axes)
    if not axes:
        raise InputError("there is nothing to draw: range at least one of w0, speed, delta")
    values = {name: getattr(stops, name) for name in _MAP_LABELS}
    fixed = dict(stops.fixed)
    left_out = ""
    if len(axes) == 3:
        name, nodes = next(iter(axes.items()))
        middle = nodes.size // 2
        fixed[name] = float(nodes[middle])
        left_out = f" (one of {axes.pop(name).size} values of {name})"
        values = {key: value[middle] for key, value in values.items()}
    figure = canvas(11.0, 6.8)
    panels = figure.subplots(2, 3, sharex=True)
    labels = {name: _AXIS_LABELS[name] for name in axes}
    for panel, (name, value) in zip(panels.flat, values.items(), strict=True):
        draw_over(figure, panel, axes, labels, value, _MAP_LABELS[name])
    if any(panel.get_legend_handles_labels()[1] for panel in panels.flat):
        handles, words = panels.flat[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="outside lower center", ncols=FEW, frameon=False)
    titled(figure, _fixed_title(fixed) + left_out)
    save(figure, path, kind, overwrite)


def plot_aim(found: Aim, path: str | Path, overwrite: bool = False) -> None:
    """Draw the paths of an aim to their target, and their speeds against their spins.

    Parameters
    ----------
    found : Aim
        With at least one launch.
    path : .png, .svg or .pdf
    overwrite : whether an existing file may be replaced

    Raises
    ------
    InputError
        If there is no launch to draw, or the ending is not known.
    MissingExtraError
        If matplotlib is not installed.
    OutputError
        If the file exists or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import aim
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_aim(aim((2.0, 0.1)), folder + "/aim.png")
    """
    kind = kind_of(path, PICTURE_KINDS)
    if found.w0.size == 0:
        raise InputError(f"there is nothing to draw: {found.answer}")
    figure = canvas(10.0, 4.4)
    paths, launches = figure.subplots(1, 2, width_ratios=(1.7, 1.0))
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    largest = float(np.abs(found.w0).max()) or 1.0
    ramp = LinearSegmentedColormap.from_list("spin", [BLUE, "#303030", ORANGE])
    colours = ScalarMappable(Normalize(-largest, largest), ramp)
    shares = np.linspace(0.0, 1.0, 200)
    states = flow(
        found.v0[:, None, :], found.w0[:, None], found.stop_time[:, None] * shares,
        delta=found.delta, decel=found.decel, radius=found.radius, **kind_of_puck(found),
    )  # fmt: skip
    for n, w0 in enumerate(found.w0):
        paths.plot(states.x[n], states.y[n], color=colours.to_rgba(w0), linewidth=1.3)
    paths.plot(0.0, 0.0, **LAUNCH)
    paths.plot(*found.target, "x", color="black", markersize=8, markeredgewidth=1.8, zorder=5)
    outwards = 1 if found.target[0] >= 0.0 else -1  # labels stand clear of the paths
    for text, place, side in (
        ("launch", (0.0, 0.0), -outwards),
        ("target", found.target, outwards),
    ):
        paths.annotate(
            text, place, xytext=(9 * side, -3), textcoords="offset points", fontsize=9,
            ha="left" if side > 0 else "right",
        )  # fmt: skip
    paths.set(xlabel="x / m", ylabel="y / m (not to scale)")
    paths.margins(0.18, 0.2)
    figure.colorbar(colours, ax=paths, label="launch spin ω₀ / rad/s")
    for sense in (found.w0 <= 0.0, found.w0 >= 0.0):
        launches.plot(found.w0[sense], found.speed[sense], color=GREY, linewidth=0.8, zorder=1)
    launches.scatter(found.w0, found.speed, c=colours.to_rgba(found.w0), zorder=2)
    launches.set(xlabel="launch spin ω₀ / rad/s", ylabel="launch speed v₀ / m/s")
    launches.set_ylim(bottom=0.0)
    titled(
        figure,
        f"launches that stop at ({found.target[0]:g}, {found.target[1]:g}) m: "
        f"r = {found.radius:g} m, δ = {found.delta:.4g}, J = {found.decel:.4g} m/s²",
    )
    save(figure, path, kind, overwrite)


def _draw_path(axes: Axes, run: Trajectory) -> None:
    from matplotlib.patches import Circle

    axes.plot(run.x, run.y, color=BLUE, linewidth=1.6)
    extent = max(np.ptp(run.x), np.ptp(run.y))
    true_size = extent == 0.0 or 0.02 * extent <= run.radius <= 0.12 * extent
    radius = run.radius if true_size else 0.045 * extent
    travelled = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(run.x), np.diff(run.y)))])
    wanted = np.linspace(0.0, travelled[-1], _PUCKS_DRAWN)
    chosen = np.unique(np.searchsorted(travelled, wanted).clip(0, run.time.size - 1))
    for index in chosen:
        x, y, angle = run.x[index], run.y[index], run.orientation[index]
        axes.add_patch(Circle((x, y), radius, fill=False, color=GREY, linewidth=0.9))
        axes.plot(
            [x, x + radius * math.cos(angle)], [y, y + radius * math.sin(angle)],
            color=ORANGE, linewidth=1.4,
        )  # fmt: skip
    axes.plot(run.x[0], run.y[0], **LAUNCH, label="launch")
    axes.plot(*run.stop_position, **STOP, label="stop")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12)
    axes.set_xlabel("x / m")
    axes.set_ylabel("y / m")
    axes.set_title("puck to scale" if true_size else "puck not to scale", fontsize=10)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def _fixed_title(fixed: dict[str, float]) -> str:
    units = {"decel": ("J", " m/s²"), "radius": ("r", " m"), "delta": ("δ", ""),
             "speed": ("v₀", " m/s"), "w0": ("ω₀", " rad/s")}  # fmt: skip
    parts = []
    if "v0_x" in fixed:
        parts.append(f"v₀ = ({fixed['v0_x']:g}, {fixed['v0_y']:g}) m/s")
    parts += [f"{units[n][0]} = {v:.4g}{units[n][1]}" for n, v in fixed.items() if n in units]
    return "stops at " + ", ".join(parts)
