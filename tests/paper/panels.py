"""Pictures made of panels of curves: plain data in, one file out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.style import COLORS, GREY, canvas, shaded
from puck_tables.plot.titles import titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class PlotLine:
    """A curve, or points if it has a ``marker`` (``hollow`` or not).

    ``shade`` from 0 to 1 gives its place in a family of curves, light to dark; without it colours
    go by turns.  A ``dashed`` curve is a thin grey line for reference.  Where neighbours differ by
    more than ``leap`` they are dots: a line between them would be made up.
    """

    x: FloatArray
    y: FloatArray
    label: str = ""
    shade: float | None = None
    dashed: bool = False
    marker: str = ""
    hollow: bool = False
    leap: float = np.inf


@dataclass(frozen=True)
class Panel:
    """Curves over common axes, whose labels say the units.

    ``x_ticks`` names places on the x axis.
    """

    x_label: str
    y_label: str
    lines: Sequence[PlotLine]
    title: str = ""
    x_ticks: dict[float, str] | None = None


@dataclass(frozen=True)
class Picture:
    """Panels one below the other under a title, ``height`` inches each."""

    title: str
    panels: Sequence[Panel]
    height: float = 4.2


def draw(picture: Picture) -> Figure:
    """The panels of a picture.

    >>> line = PlotLine(np.array([0.0, 1.0]), np.array([0.0, 2.0]), "twice")
    >>> len(draw(Picture("A line", [Panel("x / m", "y / m", [line])])).axes)
    1
    """
    count = len(picture.panels)
    figure = canvas(8.6, picture.height * count)
    for row, panel in enumerate(picture.panels, start=1):
        draw_panel(figure.add_subplot(count, 1, row), panel)
    titled(figure, picture.title)
    return figure


def draw_panel(axes: Axes, panel: Panel) -> None:
    """Draw the curves of a panel on given axes."""
    for number, line in enumerate(panel.lines):
        look = _style(line, number)
        leaps = np.flatnonzero(np.abs(np.diff(line.y)) > line.leap)
        x = np.insert(line.x, leaps + 1, np.nan)
        y = np.insert(line.y, leaps + 1, np.nan)
        axes.plot(x, y, label=line.label or None, **look)
        beside = np.union1d(leaps, leaps + 1)
        axes.plot(
            line.x[beside], line.y[beside], linestyle="", marker=".", markersize=4,
            color=look["color"],
        )  # fmt: skip
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    axes.set_title(panel.title, fontsize=10)
    axes.margins(y=0.08)
    axes.grid(color="#e4e4e4", linewidth=0.6)
    if panel.x_ticks is not None:
        axes.set_xticks(list(panel.x_ticks), list(panel.x_ticks.values()))
    low, high = axes.get_ylim()
    if low < 0.0 < high:
        axes.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
    if any(line.label for line in panel.lines):
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def _style(line: PlotLine, number: int) -> dict[str, Any]:
    """How matplotlib is to draw a curve, the ``number``-th of its panel."""
    if line.dashed:
        return {"color": GREY, "linestyle": "--", "linewidth": 1.2}
    color: Any = COLORS[number % len(COLORS)]
    if line.shade is not None:
        color = shaded(line.shade)
    if line.marker:
        face = "white" if line.hollow else color
        return {"color": color, "linestyle": "", "marker": line.marker, "markersize": 8,
                "markerfacecolor": face, "zorder": 3}  # fmt: skip
    return {"color": color, "linewidth": 1.8}
