"""Picture of a run of several pucks: their ways, where they start and end, and where they meet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.plot.animation import Animation, MovingDisc, between, film_of, path_of
from puck_tables.plot.board import (
    LEGEND_ROW,
    close_up,
    disc,
    draw_board,
    draw_body,
    finished,
    panels_for,
    show,
)
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.style import GREY, RED
from puck_tables.plot.titles import legend_below, noted
from puck_tables.scene.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
    few = _named(film) > 0
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


def _named(film: Animation) -> int:
    """How many pucks are named in the legend."""
    return len(film.bodies) if len(film.bodies) <= _NAMED else 0


def _close_up(film: Animation) -> list[Box]:
    """Around impacts and ends, where pucks are too small to be seen."""
    places = [(one.x, one.y) for one in film.happenings]
    if places:
        places += [tuple(body.knots[-1, 1:3].tolist()) for body in film.bodies]
    radius = max(body.radius for body in film.bodies)
    return close_up(film.box, np.array(places).reshape(-1, 2), radius)
