"""Panels of a board, to scale: the whole, and a close-up where pucks are small; a legend below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.board import size_of
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.style import canvas
from puck_tables.plot.titles import legend_below, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEGEND_ROW = 6  # entries
_BESIDE, _UNDER = 0.85, 0.6  # in, for the labels of axes
_TITLE, _NOTE = 0.3, 0.2  # in, a line of the title, of a note above a panel
_NARROW = 6.5  # in, at least: for the legend
_SMALL = 0.012  # of the panel's width: smaller pucks are shown in a close-up as well


def close_up(box: Box, places: FloatArray, radius: float) -> list[Box]:
    """A box around places (n, 2) where pucks are too small to be seen in the whole; or none.

    Examples
    --------
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
