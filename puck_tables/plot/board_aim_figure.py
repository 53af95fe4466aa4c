"""Picture of an aim on a board: the run of one launch, the target, and where the others lead."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.wording import counted
from puck_tables.errors import InputError
from puck_tables.plot import board
from puck_tables.plot.style import GREY
from puck_tables.world.aimed import BoardAim

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 8  # other launches whose headings are shown
_ARROW = 4.0  # radii of the striker


def draw(result: BoardAim) -> Figure:
    """The board with the ways of the first launch on it, and close-ups as of any run."""
    run = _first(result)
    title = (
        f"{result.scene.title or 'Board'}: {result.puck} {result.where}\n"
        f"{result.striker} sent off at {result.launch_speed[0]:.4g} m/s, "
        f"{math.degrees(result.launch_heading[0]):.2f}°, "
        f"{result.launch_spin[0]:.4g} rad/s{_others(result)}"
    )
    figure = board.draw(run, title)
    for panel in figure.axes:
        _mark(panel, result)
    return figure


def _others(result: BoardAim) -> str:
    """What is told of the other launches."""
    others = len(result) - 1
    if not others:
        return ""
    return f"; grey: {counted(min(others, _MOST), 'other launch', 'other launches')}" + (
        f" of {others}" if others > _MOST else ""
    )


def draw_on(axes: Axes, result: BoardAim) -> None:
    """The board alone."""
    board.draw_on(axes, _first(result))
    _mark(axes, result)


def _first(result: BoardAim) -> Any:
    if not len(result):
        raise InputError(f"there is nothing to draw: {result.answer}")
    return result.run(0)


def _mark(axes: Axes, result: BoardAim) -> None:
    """The target, and the headings of the other launches."""
    axes.plot(
        *result.target, "x", color="black", markersize=9, markeredgewidth=1.8, zorder=8,
    )  # fmt: skip
    others = slice(1, _MOST + 1)
    x, y, radius = result.start
    for heading in np.asarray(result.launch_heading)[others].tolist():
        far = _ARROW * radius
        axes.annotate(
            "", (x + far * math.cos(heading), y + far * math.sin(heading)), (x, y), zorder=2,
            arrowprops={"arrowstyle": "->", "color": GREY, "linewidth": 0.8},
            annotation_clip=True,
        )  # fmt: skip
