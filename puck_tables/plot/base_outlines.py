"""What is drawn of the base of a puck: its outlines, turned and at their places."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.plot.style import GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path

MARK = 0.7  # of the reach of a base that is not round: a line so long lies in most of them
_POINTS = 96  # of a circle: it misses a thousandth of its radius, which is not seen


def outline_of(puck: PuckSpec) -> list[FloatArray]:
    """Outlines of its base and rim, points (n, 2), m from the centre of mass; holes run clockwise.

    >>> [len(part) for part in outline_of(PuckSpec(base="box:0.2x0.1"))]
    [4]
    """
    base = puck.shape
    if base is None:
        return [_circle(0.0, 0.0, puck.radius, 1.0)]
    x, y = base.middle
    polygons = [np.array(corners) - (x, y) for corners in base.outlines]
    rim = [_circle(0.0, 0.0, puck.radius, 1.0)] if puck.has_rim else []
    return rim + polygons + [_circle(d[0] - x, d[1] - y, d[2], d[3]) for d in base.discs]


def placed(
    outline: Sequence[FloatArray], x: float, y: float, angle: float, scale: float = 1.0
) -> list[FloatArray]:
    """Outlines turned by an angle about the centre of mass, at its place.

    >>> placed([np.array([[1.0, 0.0]])], 1.0, 2.0, 0.0)[0].tolist()
    [[2.0, 2.0]]
    """
    c, s = scale * math.cos(angle), scale * math.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    return [part @ turn + (x, y) for part in outline]


def path_of(outline: Sequence[FloatArray]) -> Path:
    """Outlines as one path of matplotlib, in which holes stay open.

    >>> len(path_of([np.zeros((4, 2))]).vertices)
    5
    """
    from matplotlib.path import Path

    closed = [Path(np.concatenate([part, part[:1]]), closed=True) for part in outline]
    return Path.make_compound_path(*closed)


def draw_along(
    axes: Axes, puck: PuckSpec, x: FloatArray, y: FloatArray, angle: FloatArray, most: int,
    scale: float = 1.0, colour: str = GREY,
) -> list[int]:  # fmt: skip
    """A puck at places along its path, at most so many, each with a mark; which they are."""
    from matplotlib.patches import PathPatch

    outline, radius = outline_of(puck), scale * puck.radius
    mark = radius * (1.0 if puck.shape is None else MARK)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    count = min(most, max(2, int(arc[-1] / (2.2 * radius or 1.0)) + 1))
    chosen = np.unique(np.searchsorted(arc, np.linspace(0.0, arc[-1], count)).clip(0, x.size - 1))
    for n in chosen:
        there = path_of(placed(outline, x[n], y[n], angle[n], scale))
        axes.add_patch(PathPatch(there, fill=False, color=GREY, linewidth=0.8, zorder=2))
        dx, dy = mark * math.cos(angle[n]), mark * math.sin(angle[n])
        axes.plot([x[n], x[n] + dx], [y[n], y[n] + dy], color=colour, linewidth=0.9, zorder=2)
    frames: list[int] = chosen.tolist()
    return frames


def _circle(x: float, y: float, radius: float, sign: float) -> FloatArray:
    turn = sign * np.linspace(0.0, 2.0 * np.pi, _POINTS, endpoint=False)
    return np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)])
