"""Picture of a trajectory: the whole motion, whatever states it has."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot.base_outlines import draw_along
from puck_tables.plot.style import BLUE, GREEN, GREY, LAUNCH, ORANGE, STOP, canvas
from puck_tables.plot.titles import legend_below, titled
from puck_tables.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PUCKS_DRAWN = 9  # outlines along a path: more run into each other
_STATES_DRAWN = 1001  # points of a path: smooth at any size of print


def draw(run: Trajectory) -> Figure:
    """The path with the puck's orientation, and speeds and their ratio against time."""
    run = _whole(run)
    figure = canvas(9.5, 7.6)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.15, 1.0))
    _draw_path(figure.add_subplot(grid[0, :]), run)
    speeds = figure.add_subplot(grid[1, 0])
    speeds.plot(run.time, run.speed, color=BLUE, label="speed v")
    arm, rim, k = "r", "rim speed rω", run.puck.radius
    if run.puck.shape is not None:
        arm, rim, k = "k", "kω, k of gyration", run.puck.inertia_radius
    speeds.plot(run.time, k * run.spin, color=ORANGE, label=rim)
    speeds.axhline(0.0, color=GREY, linewidth=0.6)
    for moment, text in ((run.contact_opens, "base lifts"), (run.contact_closes, "base down")):
        if moment is not None:
            speeds.axvline(moment, color=GREY, linestyle=":", linewidth=1.0, label=text)
    speeds.set(xlabel="time / s", ylabel="m/s")
    legend_below(speeds)
    ratio = figure.add_subplot(grid[1, 1], sharex=speeds)
    moving = run.speed > 0.0
    if moving.any() and run.launch_spin != 0.0:
        epsilon = 1.0 / np.tan(run.slip_angle[moving])
        ratio.plot(run.time[moving], epsilon, color=GREEN)
        if run.limit_angle:
            limit = math.copysign(1.0 / math.tan(run.limit_angle), run.launch_spin)
            _draw_limit(ratio, limit, float(epsilon.max()))
    else:
        ratio.text(
            0.5, 0.5, "spin only" if run.launch_spin != 0.0 else "no spin",
            ha="center", transform=ratio.transAxes, color=GREY,
        )  # fmt: skip
    ratio.set(xlabel="time / s", ylabel=f"ε = v/({arm}ω)")
    vx, vy = run.launch_velocity
    titled(
        figure,
        f"v₀ = ({vx:g}, {vy:g}) m/s, ω₀ = {run.launch_spin:g} rad/s, {_puck(run)}{_kind(run)}",
    )
    return figure


def _puck(run: Trajectory) -> str:
    puck = run.puck
    if puck.shape is None:
        return f"r = {puck.radius:g} m, δ = 2fh/r = {puck.delta:.4g}, fg = {puck.decel:.4g} m/s²"
    high = f", h = {puck.height:.4g} m" if puck.height > 0.0 else ""
    return (
        f"base {puck.shape.name}, k = {puck.inertia_radius:.4g} m{high}, f = {puck.friction:.4g}, "
        f"fg = {puck.decel:.4g} m/s²"
    )


def draw_on(axes: Axes, run: Trajectory) -> None:
    """The path alone."""
    _draw_path(axes, _whole(run))


def _whole(run: Trajectory) -> Trajectory:
    return run(np.linspace(0.0, run.stop_time, _STATES_DRAWN))


def _kind(run: Trajectory) -> str:
    """The kind of puck, and how much of its base is loaded, where there is something to say."""
    text = ""
    if run.puck.shape is None and run.puck.body.kind:
        text = f"\n{run.puck.body.kind}"
    if run.least_loaded_share < 1.0:
        text += f"\nat the least {100.0 * run.least_loaded_share:.3g} % of the base loaded"
    return text


def _draw_limit(panel: Axes, limit: float, largest: float) -> None:
    """The ratio that the motion tends to."""
    panel.axhline(limit, color=GREY, linestyle="--", linewidth=1.0)
    above = limit > largest
    panel.annotate(
        f"limit {limit:.3f}", (0.02, limit), xycoords=("axes fraction", "data"),
        xytext=(0, -3 if above else 3), va="top" if above else "bottom",
        textcoords="offset points", color=GREY, fontsize=9,
    )  # fmt: skip


def _draw_path(axes: Axes, run: Trajectory) -> None:
    axes.plot(run.x, run.y, color=BLUE, linewidth=1.6)
    extent = max(np.ptp(run.x), np.ptp(run.y))
    true_size = extent == 0.0 or 0.02 * extent <= run.puck.radius <= 0.3 * extent
    scale = 1.0 if true_size else 0.045 * extent / run.puck.radius
    draw_along(axes, run.puck, run.x, run.y, run.orientation, _PUCKS_DRAWN, scale, ORANGE)
    axes.plot(run.x[0], run.y[0], **LAUNCH, label="launch")
    axes.plot(*run.stop_position, **STOP, label="stop")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12)
    axes.set(xlabel="x / m", ylabel="y / m")
    axes.set_title("puck to scale" if true_size else "puck not to scale", fontsize=10)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
