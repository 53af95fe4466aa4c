"""Panels of a board, to scale: the whole, and a close-up where pucks are small; a legend below."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.board import size_of
from puck_tables.plot.film import Box
from puck_tables.plot.style import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

LEGEND_ROW = 6  # entries
_LEGEND_HEIGHT = 0.2  # in
_BESIDE, _UNDER, _TITLE = 0.85, 0.6, 0.35  # in, for the labels of axes and for the title
_NARROW = 6.5  # in, at least: for the legend
_SMALL = 0.012  # of the panel's width: smaller pucks are shown in a close-up as well


def close_up(box: Box, places: FloatArray, radius: float) -> list[Box]:
    """A box around places (n, 2) where pucks are too small to be seen in the whole; or none.

    Examples
    --------
    >>> (box,) = close_up((0.0, 40.0, -2.0, 2.0), np.array([[30.0, 0.0], [32.0, 1.0]]), 0.15)
    >>> [round(side, 9) for side in box]
    [29.7, 32.3, -0.3, 1.3]
    >>> close_up((0.0, 4.0, -2.0, 2.0), np.array([[3.0, 0.0], [3.2, 0.1]]), 0.15)
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
    return [(middle[0] - half, middle[0] + half, middle[1] - high, middle[1] + high)]


def panels_for(boxes: list[Box]) -> tuple[Figure, list[Axes]]:
    """A figure with a panel for each box, the second titled a close-up."""
    heights = [size_of(box)[1] for box in boxes]
    figure = canvas(_NARROW, _NARROW)
    panels = figure.subplots(len(boxes), 1, squeeze=False, height_ratios=heights)[:, 0]
    if len(boxes) > 1:
        panels[1].set_title("close-up", fontsize=10)
    return figure, list(panels)


def legend_under(figure: Figure, panel: Axes, boxes: list[Box]) -> None:
    """What is labelled in a panel, below all; and the size of the figure that all this takes."""
    handles, labels = panel.get_legend_handles_labels()
    rows = math.ceil(len(labels) / LEGEND_ROW)
    sizes = [size_of(box) for box in boxes]
    figure.set_size_inches(
        max(*(wide + _BESIDE for wide, _ in sizes), _NARROW),
        sum(high + _UNDER for _, high in sizes) + _LEGEND_HEIGHT * rows + _TITLE,
    )
    legend = figure.legend(
        handles, labels, loc="outside lower center", ncols=LEGEND_ROW, frameon=False, fontsize=9
    )
    as_they_stand(legend)


def as_they_stand(legend: Legend) -> None:
    """What users write is no mathematics."""
    for text in legend.get_texts():
        text.set_parse_math(False)
