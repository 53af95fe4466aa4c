"""A board on axes, for pictures and films: the whole, and a close-up where pucks are small.

And the picture of a run of several pucks on it: their ways, where they start and end, and meet.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.animation import Animation, MovingDisc, between, film_of, path_of
from puck_tables.plot.base_outlines import path_of as path_through
from puck_tables.plot.base_outlines import placed
from puck_tables.plot.board_parts import draw_painted, draw_rounds
from puck_tables.plot.floor_axes import Box, draw_floor
from puck_tables.plot.style import GREY, RED, canvas
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.scene.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, PathPatch

_WIDE, _HIGH = 9.0, 7.0  # in, of a panel at most
_LOW = 1.2  # in, at least
LEGEND_ROW = 6  # entries
_LEFT, _UNDER = 0.85, 0.6  # in, for the labels of axes
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
    labels: set[str] = set()
    for line in film.lines:
        looks: dict[str, Any] = {"color": "black", "linewidth": 2.5, "solid_capstyle": "projecting"}
        if line.kind == "edge":
            looks = {"color": RED, "linewidth": 1.2, "linestyle": "--"}
        looks |= {} if line.kind in labels else {"label": line.kind}
        labels.add(line.kind)
        axes.plot(line.x, line.y, zorder=1, **looks)


def disc(
    body: MovingDisc, x: float, y: float, angle: float = 0.0, **looks: Any
) -> Circle | PathPatch:
    """A disc at a place, or what it is instead, to scale; one that is driven is hatched."""
    from matplotlib.patches import Circle, PathPatch

    hatch = {"hatch": "////"} if body.driven else {}
    if body.outline:
        return PathPatch(path_through(placed(body.outline, x, y, angle)), **hatch, **looks)
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
    figure = canvas(max(*(size_of(box)[0] + _LEFT for box in boxes), _NARROW), _NARROW)
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


_NAMED = 8  # pucks: more are told apart by colour alone


def draw(run: Run, title: str = "") -> Figure:
    """The board with all ways on it, and a close-up of the impacts where pucks are small.

    The whole motion is drawn, whatever states the run has: it is run again.
    """
    film = film_of(run)
    boxes = [film.box, *_close_up(film)]
    figure, panels = panels_for(boxes)
    for axes, box in zip(panels, boxes, strict=True):
        _draw_film(axes, film, box)
    for panel in panels[1:]:
        noted(panel, "close-up")
    title = title or f"{film.title or 'Scene'}: {film.end} after {film.end_time:.4g} s"
    finished(figure, panels, boxes, title)
    return figure


def draw_on(axes: Axes, run: Run) -> None:
    """The board alone."""
    film = film_of(run)
    _draw_film(axes, film, film.box)
    legend_below(axes, LEGEND_ROW // 2)


def _draw_film(axes: Axes, film: Animation, box: Box) -> None:
    draw_board(axes, film)
    few = len(film.bodies) <= _NAMED
    for body in film.bodies:
        _draw_body(axes, body, body.name if few else "")
    impacts = [one for one in film.happenings if one.what == "impact"]
    if impacts:
        axes.plot(
            [one.x for one in impacts], [one.y for one in impacts], linestyle="", marker="o",
            markersize=3.6, color=RED, markeredgecolor="white", markeredgewidth=0.5, zorder=6,
            label="impact", rasterized=True,
        )  # fmt: skip
    _explain_looks(axes, film)
    notes = [] if few else [f"{len(film.bodies)} pucks, by their colours alone"]
    notes += [film.hidden] if film.hidden else []
    if notes:
        noted(axes, "; ".join(notes))
    show(axes, box)


def _draw_body(axes: Axes, body: MovingDisc, label: str) -> None:
    """Its way, its outline at the start, and itself at the end, with a mark that turns with it."""
    path = path_of(body, body.gone)
    hidden = " " if label.startswith("_") else ""  # such labels stand in no legend
    words: dict[str, Any] = {"label": hidden + label} if label else {}
    moves = float(np.abs(path - path[0]).max()) > 1e-9 * body.radius
    axes.plot(
        path[:, 0], path[:, 1], color=body.line, linewidth=1.1, zorder=3,
        linestyle=(0, (5, 2)) if body.driven else "-", **words,
    )  # fmt: skip
    if moves:
        x, y, angle = path[0, 0], path[0, 1], body.knots[0, 3]
        start = disc(body, x, y, angle, fill=False, edgecolor=body.line, linewidth=0.9, zorder=2)
        axes.add_patch(start)
    x, y, angle = between(body.knots, body.knots[-1:, 0])[0]
    draw_body(axes, body, x, y, angle, body.gone < math.inf)


def _explain_looks(axes: Axes, film: Animation) -> None:
    """What outlines, fillings and hatches mean, as far as they are in the picture."""
    from matplotlib.patches import Circle

    looks: list[tuple[str, dict[str, Any]]] = [("start", {"fill": False, "edgecolor": GREY})]
    if any(body.gone == math.inf and not body.driven for body in film.bodies):
        looks.append(("end", {"facecolor": GREY, "edgecolor": "black"}))
    if any(body.gone < math.inf for body in film.bodies):
        looks.append(("left play", {"fill": False, "edgecolor": GREY, "linestyle": ":"}))
    if any(body.driven for body in film.bodies):
        looks.append(("driven", {"facecolor": "white", "edgecolor": GREY, "hatch": "////"}))
    for words, look in looks:
        axes.add_patch(Circle((math.nan, math.nan), label=words, **look))


def _close_up(film: Animation) -> list[Box]:
    """Around impacts and ends, where pucks are too small to be seen."""
    places = [(one.x, one.y) for one in film.happenings]
    if places:
        places += [tuple(body.knots[-1, 1:3].tolist()) for body in film.bodies]
    radius = max(body.radius for body in film.bodies)
    return close_up(film.box, np.array(places).reshape(-1, 2), radius)
