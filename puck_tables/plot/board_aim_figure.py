"""Picture of an aim on a board: the run of one launch, the target, and where the others lead."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.errors import InputError
from puck_tables.plot import pucks_figure
from puck_tables.plot.style import GREY
from puck_tables.plot.titles import counted
from puck_tables.world.aimed import BoardAim

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 8  # other launches whose headings are shown
_ARROW = 4.0  # radii of the striker


def draw(found: BoardAim) -> Figure:
    """The board with the ways of the first launch on it, and close-ups as of any run.

    Raises
    ------
    InputError
        If there is no launch to draw.
    """
    run = _first(found)
    title = (
        f"{found.scene.title or 'Board'}: {found.puck} {found.where}\n"
        f"{found.striker} sent off at {found.launch_speed[0]:.4g} m/s, "
        f"{math.degrees(found.launch_heading[0]):.2f}°, "
        f"{found.launch_spin[0]:.4g} rad/s{_others(found)}"
    )
    figure = pucks_figure.draw(run, title)
    for panel in figure.axes:
        _mark(panel, found)
    return figure


def _others(found: BoardAim) -> str:
    """What is told of the other launches."""
    others = len(found) - 1
    if not others:
        return ""
    return f"; grey: {counted(min(others, _MOST), 'other launch', 'other launches')}" + (
        f" of {others}" if others > _MOST else ""
    )


def draw_on(axes: Axes, found: BoardAim) -> None:
    """The board alone."""
    pucks_figure.draw_on(axes, _first(found))
    _mark(axes, found)


def _first(found: BoardAim) -> Any:
    if not len(found):
        raise InputError(f"there is nothing to draw: {found.answer}")
    return found.run(0)


def _mark(axes: Axes, found: BoardAim) -> None:
    """The target, and the headings of the other launches."""
    axes.plot(
        *found.target, "x", color="black", markersize=9, markeredgewidth=1.8, zorder=8,
    )  # fmt: skip
    others = slice(1, _MOST + 1)
    x, y, radius = found.start
    for heading in np.asarray(found.launch_heading)[others].tolist():
        far = _ARROW * radius
        axes.annotate(
            "", (x + far * math.cos(heading), y + far * math.sin(heading)), (x, y), zorder=2,
            arrowprops={"arrowstyle": "->", "color": GREY, "linewidth": 0.8},
            annotation_clip=True,
        )  # fmt: skip
