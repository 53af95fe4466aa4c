"""Picture of stops: where launches come to rest, coloured by when."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.columns import COLUMNS
from puck_tables.plot.style import LAUNCH, canvas, legend_below
from puck_tables.stops import Stops

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(stops: Stops) -> Figure:
    """Places of rest, seen from the launch."""
    figure = canvas(7.5, 5.4)
    draw_on(figure.add_subplot(), stops)
    return figure


def draw_on(axes: Axes, stops: Stops) -> None:
    """The same on given axes."""
    x, y = stops.stop_position.reshape(-1, 2).T
    marks = axes.scatter(x, y, c=stops.stop_time.ravel(), s=16)
    axes.plot(0.0, 0.0, **LAUNCH, label="launch")
    figure = axes.get_figure()
    assert figure is not None
    figure.colorbar(marks, ax=axes, label=COLUMNS["stop_time"].axis)
    axes.set(xlabel=COLUMNS["stop_x"].axis, ylabel=COLUMNS["stop_y"].axis)
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(axes)
