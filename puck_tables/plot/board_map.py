"""Picture of a sweep of several pucks: where each of them ends, on the board."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot.board import draw_board, show
from puck_tables.plot.board_panels import close_up, legend_under, panels_for
from puck_tables.plot.film import Box, Film, film_of
from puck_tables.plot.style import titled
from puck_tables.world.sweep import WorldMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED, _MOST = 8, 20_000
_MOST_ENDS = (0.02, 0.98)  # of the ends stand in a close-up


def draw(ends: WorldMap) -> Figure:
    """The ends of all runs as points in the colours of the pucks."""
    film = film_of(ends.an_example())
    boxes = [_box(ends, film), *_close_up(ends, film)]
    figure, panels = panels_for(boxes)
    for axes, box in zip(panels, boxes, strict=True):
        _draw(axes, ends, film, box)
    legend_under(figure, panels[0], boxes)
    titled(figure, f"{ends.scene.title or 'Scene'}: ends of {ends.end.size} runs")
    return figure


def draw_on(axes: Axes, ends: WorldMap) -> None:
    """The board alone."""
    film = film_of(ends.an_example())
    _draw(axes, ends, film, _box(ends, film))


def _draw(axes: Axes, ends: WorldMap, film: Film, box: Box) -> None:
    draw_board(axes, film)
    step = max(1, ends.end.size // _MOST)
    for number, (name, body) in enumerate(zip(ends.names, film.bodies, strict=True)):
        there = ends.in_play[..., number].ravel() > 0.0  # NaN: no end
        x, y = (ends.columns[c][..., number].ravel()[there][::step] for c in ("x", "y"))
        label = name if len(ends.names) <= _NAMED else None
        axes.plot(
            x, y, linestyle="", marker=".", markersize=2.5, alpha=0.6, color=body.colour,
            label=label, zorder=3,
        )  # fmt: skip
    show(axes, box)


def _close_up(ends: WorldMap, film: Film) -> list[Box]:
    """Around most of the ends, where pucks are too small to be seen."""
    there = ends.columns["in_play"] > 0.0  # NaN: no end
    if not there.any():
        return []
    x, y = (ends.columns[name][there] for name in ("x", "y"))
    middle = [np.quantile(row, _MOST_ENDS) for row in (x, y)]
    radius = max(body.radius for body in film.bodies)
    return close_up(film.box, np.stack(middle, axis=1), radius)


def _box(ends: WorldMap, film: Film) -> Box:
    """What shows the board and all ends."""
    left, right, low, top = film.box
    x, y = ends.columns["x"], ends.columns["y"]
    radius = max(piece.radius for piece in ends.scene.pucks) if ends.scene.pucks else 0.0
    return (
        min(left, float(np.nanmin(x)) - radius), max(right, float(np.nanmax(x)) + radius),
        min(low, float(np.nanmin(y)) - radius), max(top, float(np.nanmax(y)) + radius),
    )  # fmt: skip
