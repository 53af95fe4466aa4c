"""Picture of stops or states: where pucks are, seen from the launch, coloured by when."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.wording import counted
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import LAUNCH, canvas, colour_bar, ramp
from puck_tables.plot.titles import legend_below, noted
from puck_tables.stopping.states import States
from puck_tables.stopping.stops import Stops

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Stops | States) -> Figure:
    """Places and times."""
    figure = canvas(7.5, 5.4)
    draw_on(figure.add_subplot(), result)
    return figure


def draw_on(axes: Axes, result: Stops | States) -> None:
    """Places, coloured by time, on given axes."""
    names = ("x", "y", "time") if isinstance(result, States) else ("stop_x", "stop_y", "stop_time")
    columns = result.dataset().columns
    x, y, time = (columns[name].values.ravel() for name in names)
    marks = axes.scatter(x, y, c=time, s=14, cmap=ramp())
    lost = int(np.count_nonzero(~np.isfinite(x + y)))
    if lost:
        noted(axes, f"{lost} of {counted(x.size, 'launch', 'launches')} without a place")
    axes.plot(0.0, 0.0, **LAUNCH, label="launch")
    colour_bar(axes, marks, COLUMNS[names[2]].axis)
    axes.set(xlabel=COLUMNS[names[0]].axis, ylabel=COLUMNS[names[1]].axis)
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(axes)
