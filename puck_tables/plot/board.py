"""A board on axes, for pictures and films: the whole, and a close-up where pucks are small."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.animation import Animation, MovingDisc
from puck_tables.plot.base_outlines import path_of, placed
from puck_tables.plot.board_parts import draw_painted, draw_rounds
from puck_tables.plot.floor_axes import Box, draw_floor
from puck_tables.plot.style import RED, canvas
from puck_tables.plot.titles import legend_below, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, PathPatch

_WIDE, _HIGH = 9.0, 7.0  # in, of a panel at most
_LOW = 1.2  # in, at least
LEGEND_ROW = 6  # entries
_BESIDE, _UNDER = 0.85, 0.6  # in, for the labels of axes
_TITLE, _NOTE = 0.3, 0.2  # in, a line of the title, of a note above a panel
_NARROW = 6.5  # in, at least: for the legend
_SMALL = 0.012  # of the panel's width: smaller pucks are shown in a close-up as well


def size_of(box: Box) -> tuple[float, float]:
    """Width and height of a panel that shows a box to scale, in.

    >>> size_of(Box(0.0, 2.0, 0.0, 1.0))
    (9.0, 4.5)
    """
    shape = (box[3] - box[2]) / (box[1] - box[0])
    wide = min(_WIDE, _HIGH / shape)
    return wide, max(wide * shape, _LOW)


def draw_board(axes: Axes, film: Animation) -> None:
    """The floor, and all that stands still, each kind labelled once, to scale."""
    draw_floor(axes, film.floor, film.box, max(film.frictions, default=0.0))
    draw_painted(axes, film.painted)
    draw_rounds(axes, film.rounds)
    told: set[str] = set()
    for line in film.lines:
        looks: dict[str, Any] = {"color": "black", "linewidth": 2.5, "solid_capstyle": "projecting"}
        if line.kind == "edge":
            looks = {"color": RED, "linewidth": 1.2, "linestyle": "--"}
        looks |= {} if line.kind in told else {"label": line.kind}
        told.add(line.kind)
        axes.plot(line.x, line.y, zorder=1, **looks)


def disc(
    body: MovingDisc, x: float, y: float, angle: float = 0.0, **looks: Any
) -> Circle | PathPatch:
    """A disc at a place, or what it is instead, to scale; one that is driven is hatched."""
    from matplotlib.patches import Circle, PathPatch

    hatch = {"hatch": "////"} if body.driven else {}
    if body.outline:
        return PathPatch(path_of(placed(body.outline, x, y, angle)), **hatch, **looks)
    return Circle((x, y), body.radius, **hatch, **looks)


def draw_body(
    axes: Axes, body: MovingDisc, x: float, y: float, angle: float, left: bool = False
) -> None:
    """A body as it is, with a mark that turns with it; ``left``: where it left play."""
    looks: dict[str, Any] = {"facecolor": body.colour, "edgecolor": "black", "linewidth": 0.7}
    if left:
        looks = {"facecolor": "none", "edgecolor": body.line, "linewidth": 1.2, "linestyle": ":"}
    elif body.driven:
        looks |= {"facecolor": "white", "edgecolor": body.line, "linewidth": 1.2}
    axes.add_patch(disc(body, x, y, angle, zorder=4, **looks))
    if not left and not body.driven:
        axes.plot(
            [x, x + body.mark_length * math.cos(angle)],
            [y, y + body.mark_length * math.sin(angle)], color=body.mark, linewidth=0.8, zorder=5,
        )  # fmt: skip


def show(axes: Axes, box: Box) -> None:
    """To scale, all of a box in sight."""
    axes.set(xlabel="x / m", ylabel="y / m", xlim=box[:2], ylim=box[2:])
    axes.set_aspect("equal")


def close_up(box: Box, places: FloatArray, radius: float) -> list[Box]:
    """A box around places (n, 2) where pucks are too small to be seen in the whole; or none.

    >>> (box,) = close_up(Box(0.0, 40.0, -2.0, 2.0), np.array([[30.0, 0.0], [32.0, 1.0]]), 0.15)
    >>> [round(side, 9) for side in box]
    [29.7, 32.3, -0.3, 1.3]
    >>> close_up(Box(0.0, 4.0, -2.0, 2.0), np.array([[3.0, 0.0], [3.2, 0.1]]), 0.15)
    []
    """
    wide = box[1] - box[0]
    if radius > _SMALL * wide or not len(places):
        return []
    x, y = places.T
    high = 0.5 * float(np.ptp(y)) + 2.0 * radius
    half = max(0.5 * float(np.ptp(x)) + 2.0 * radius, 1.2 * high)
    if 2.0 * half > 0.6 * wide:
        return []
    middle = 0.5 * float(x.min() + x.max()), 0.5 * float(y.min() + y.max())
    return [Box(middle[0] - half, middle[0] + half, middle[1] - high, middle[1] + high)]


def panels_for(boxes: list[Box]) -> tuple[Figure, list[Axes]]:
    """A figure with a panel for each box."""
    heights = [size_of(box)[1] for box in boxes]
    figure = canvas(max(*(size_of(box)[0] + _BESIDE for box in boxes), _NARROW), _NARROW)
    panels = figure.subplots(len(boxes), 1, squeeze=False, height_ratios=heights)[:, 0]
    return figure, list(panels)


def finished(figure: Figure, panels: list[Axes], boxes: list[Box], title: str) -> None:
    """What is labelled in the first panel below all, the title, and the height that all takes."""
    legend_below(figure, LEGEND_ROW, shown=panels[0].get_legend_handles_labels())
    titled(figure, title)
    under = sum(one.get_window_extent().height for one in figure.legends) / figure.dpi
    lines = figure.get_suptitle().count("\n") + 1
    notes = [one.get_title("left") for one in panels]
    above = _TITLE * lines + _NOTE * sum(note.count("\n") + 1 for note in notes if note)
    high = sum(size_of(box)[1] + _UNDER for box in boxes)
    figure.set_size_inches(figure.get_figwidth(), high + under + above)
