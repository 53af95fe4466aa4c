"""Picture of states: where pucks are, coloured by when."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.columns import COLUMNS
from puck_tables.plot.style import LAUNCH, canvas, legend_below
from puck_tables.states import States

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(states: States) -> Figure:
    """Places, seen from the launch."""
    figure = canvas(7.5, 5.4)
    draw_on(figure.add_subplot(), states)
    return figure


def draw_on(axes: Axes, states: States) -> None:
    """The same on given axes."""
    marks = axes.scatter(states.x.ravel(), states.y.ravel(), c=states.time.ravel(), s=12)
    axes.plot(0.0, 0.0, **LAUNCH, label="launch")
    figure = axes.get_figure()
    assert figure is not None
    figure.colorbar(marks, ax=axes, label=COLUMNS["time"].axis)
    axes.set(xlabel=COLUMNS["x"].axis, ylabel=COLUMNS["y"].axis)
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(axes)
