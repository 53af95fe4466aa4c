"""Picture of a sweep of several pucks: where each of them ends, on the board."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot.board import draw_board, show, size_of
from puck_tables.plot.film import Box, film_of
from puck_tables.plot.style import canvas, titled
from puck_tables.world.sweep import WorldMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED, _MOST, _LEGEND_ROW = 8, 20_000, 4
_MARGINS, _NARROW = (0.85, 1.3), 6.5  # in


def draw(ends: WorldMap) -> Figure:
    """The ends of all runs as points in the colours of the pucks."""
    wide, high = size_of(_box(ends))
    figure = canvas(max(wide + _MARGINS[0], _NARROW), high + _MARGINS[1])
    axes = figure.subplots()
    _draw(axes, ends)
    handles, labels = axes.get_legend_handles_labels()
    legend = figure.legend(
        handles, labels, loc="outside lower center", ncols=_LEGEND_ROW, frameon=False, fontsize=9
    )
    for text in legend.get_texts():  # what users write is no mathematics
        text.set_parse_math(False)
    titled(figure, f"{ends.scene.title or 'Scene'}: ends of {ends.end.size} runs")
    return figure


def draw_on(axes: Axes, ends: WorldMap) -> None:
    """The board alone."""
    _draw(axes, ends)


def _draw(axes: Axes, ends: WorldMap) -> None:
    film = film_of(ends.an_example())
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
    show(axes, _box(ends))


def _box(ends: WorldMap) -> Box:
    """What shows the board and all ends."""
    left, right, low, top = film_of(ends.an_example()).box
    x, y = ends.columns["x"], ends.columns["y"]
    radius = max(piece.radius for piece in ends.scene.pucks) if ends.scene.pucks else 0.0
    return (
        min(left, float(np.nanmin(x)) - radius), max(right, float(np.nanmax(x)) + radius),
        min(low, float(np.nanmin(y)) - radius), max(top, float(np.nanmax(y)) + radius),
    )  # fmt: skip
