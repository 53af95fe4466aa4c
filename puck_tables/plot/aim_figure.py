"""Picture of an aim: its launches on their way to one place, or the places they lead to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.wording import counted
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import BLUE, GREY, LAUNCH, ORANGE, canvas, colour_bar, ramp
from puck_tables.plot.titles import legend_below, titled
from puck_tables.stopping.aim_at_targets import Aim
from puck_tables.stopping.states import states as states_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure


def draw(result: Aim) -> Figure:
    """The paths of launches, or their targets; and their speeds against their spins."""
    figure, puck = canvas(10.0, 4.5), result.puck
    places, launches = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    colours, by = draw_on(places, result)
    answer, size = result.answer, 8
    if result.is_one:
        x, y = result.target
        answer, size = f"launches that stop at ({x:g}, {y:g}) m", 36
        for sense in (result.launch_spin <= 0.0, result.launch_spin >= 0.0):
            line = result.launch_spin[sense], result.launch_speed[sense]
            launches.plot(*line, color=GREY, linewidth=0.8, zorder=1)
    launches.scatter(result.launch_spin, result.launch_speed, size, colours.to_rgba(by), zorder=2)
    launches.set(xlabel=COLUMNS["launch_spin"].axis, ylabel=COLUMNS["launch_speed"].axis)
    launches.set_ylim(bottom=0.0)
    words = (
        f"{answer}: r = {puck.radius:g} m, δ = 2fh/r = {puck.delta:.4g}, fg = {puck.decel:.4g} m/s²"
    )
    titled(figure, words)
    return figure


def draw_on(places: Axes, result: Aim) -> tuple[ScalarMappable, FloatArray]:
    """The paths or the targets alone; the colours of launches, and by what they are coloured."""
    if result.launch_spin.size == 0:
        raise InputError(f"there is nothing to draw: {result.answer}")
    if result.is_one:
        return _draw_paths(places, result), result.launch_spin
    return _draw_targets(places, result), result.stop_time


def _draw_targets(axes: Axes, result: Aim) -> ScalarMappable:
    """The targets, coloured by the stop time of a launch to them."""
    missed = result.target[result.launches == 0]
    if missed.size:
        words = f"no launch ({len(missed)} of {counted(result.launches.size, 'target')})"
        axes.plot(*missed.T, "x", color=GREY, markersize=4, label=words)
    marks = axes.scatter(result.target_x, result.target_y, c=result.stop_time, s=12, cmap=ramp())
    axes.plot(0.0, 0.0, **LAUNCH, label="launch")
    colour_bar(axes, marks, COLUMNS["stop_time"].axis)
    axes.set(xlabel=COLUMNS["target_x"].axis, ylabel=COLUMNS["target_y"].axis)
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(axes)
    return marks


def _draw_paths(paths: Axes, result: Aim) -> ScalarMappable:
    """The paths to one target, coloured by spin."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    largest = float(np.abs(result.launch_spin).max()) or 1.0
    ramp = LinearSegmentedColormap.from_list("spin", [BLUE, "#303030", ORANGE])
    colours = ScalarMappable(Normalize(-largest, largest), ramp)
    shares = np.linspace(0.0, 1.0, 200)
    states = states_at(
        result.launch_velocity[:, None, :], result.launch_spin[:, None],
        result.stop_time[:, None] * shares, **result.puck.arguments(),
    )  # fmt: skip
    for n, spin in enumerate(result.launch_spin):
        paths.plot(states.x[n], states.y[n], color=colours.to_rgba(spin), linewidth=1.3)
    paths.plot(0.0, 0.0, **LAUNCH)
    paths.plot(*result.target, "x", color="black", markersize=8, markeredgewidth=1.8, zorder=5)
    x, y = result.target.tolist()
    outwards = 1 if x >= 0.0 else -1  # labels stand clear of the paths
    for text, place, side in (("launch", (0.0, 0.0), -outwards), ("target", (x, y), outwards)):
        paths.annotate(
            text, place, xytext=(9 * side, -3), textcoords="offset points", fontsize=9,
            ha="left" if side > 0 else "right",
        )  # fmt: skip
    paths.set(xlabel="x / m", ylabel="y / m (not to scale)")
    paths.margins(0.18, 0.2)
    colour_bar(paths, colours, COLUMNS["launch_spin"].axis)
    return colours
