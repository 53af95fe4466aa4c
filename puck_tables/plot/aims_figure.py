"""Picture of aims: where the targets are, and the launches that lead to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.aim_figure import caption
from puck_tables.plot.style import GREY, LAUNCH, canvas, colour_bar, ramp
from puck_tables.plot.titles import counted, legend_below
from puck_tables.stopping.aim_at_targets import Aim

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Aim) -> Figure:
    """The targets, and speeds of launches against their spins."""
    figure = canvas(10.0, 4.6)
    targets, launches = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    draw_on(targets, result)
    launches.scatter(result.launch_spin, result.launch_speed, c=result.stop_time, s=8, cmap=ramp())
    caption(figure, launches, result.puck, result.answer)
    return figure


def draw_on(axes: Axes, result: Aim) -> None:
    """The targets alone, coloured by the stop time of a launch to them."""
    if result.launch_spin.size == 0:
        raise InputError(f"there is nothing to draw: {result.answer}")
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
