"""A board on axes: walls, edges, posts, arcs, pockets, discs; for pictures and films."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.plot.animation import Animation, Box, MovingDisc
from puck_tables.plot.floor_axes import Box as Sight
from puck_tables.plot.floor_axes import draw_floor
from puck_tables.plot.style import GREY, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Circle

_WIDE, _HIGH = 9.0, 7.0  # in, of a panel at most
_LOW = 1.2  # in, at least


def size_of(box: Box) -> tuple[float, float]:
    """Width and height of a panel that shows a box to scale, in.

    Examples
    --------
    >>> size_of((0.0, 2.0, 0.0, 1.0))
    (9.0, 4.5)
    """
    shape = (box[3] - box[2]) / (box[1] - box[0])
    wide = min(_WIDE, _HIGH / shape)
    return wide, max(wide * shape, _LOW)


def draw_board(axes: Axes, film: Animation) -> None:
    """The floor, and all that stands still, each kind labelled once, to scale."""
    from matplotlib.patches import Arc, Circle

    draw_floor(axes, film.floor, Sight(*film.box), max(film.frictions, default=0.0))
    told: set[str] = set()

    def label(kind: str) -> dict[str, Any]:
        new = {} if kind in told else {"label": kind}
        told.add(kind)
        return new

    for one in film.rounds:
        centre = (one.x, one.y)
        if one.kind == "arc":
            ends = np.degrees([one.start, one.start + one.span])
            whole = one.span >= 2.0 * math.pi
            axes.add_patch(
                Arc(
                    centre, 2.0 * one.radius, 2.0 * one.radius, theta1=0.0 if whole else ends[0],
                    theta2=360.0 if whole else ends[1], color="black", linewidth=2.5, zorder=1,
                )
            )  # fmt: skip
            axes.plot([], [], color="black", linewidth=2.5, **label("arc"))
            continue
        looks: dict[str, Any] = {"facecolor": "#d8d8d8", "edgecolor": GREY, "linewidth": 0.8}
        if one.kind == "post":
            looks = {"facecolor": "#606060", "edgecolor": "black", "linewidth": 0.5}
        axes.add_patch(Circle(centre, one.radius, zorder=1, **looks, **label(one.kind)))
    for line in film.lines:
        looks = {"color": "black", "linewidth": 2.5, "solid_capstyle": "projecting"}
        if line.kind == "edge":
            looks = {"color": RED, "linewidth": 1.2, "linestyle": "--"}
        axes.plot(line.x, line.y, zorder=1, **looks, **label(line.kind))


def disc(body: MovingDisc, x: float, y: float, **looks: Any) -> Circle:
    """A disc at a place, to scale; one that is driven is hatched."""
    from matplotlib.patches import Circle

    hatch = {"hatch": "////"} if body.driven else {}
    return Circle((x, y), body.radius, **hatch, **looks)


def show(axes: Axes, box: Box) -> None:
    """To scale, all of a box in sight."""
    axes.set(xlabel="x / m", ylabel="y / m", xlim=box[:2], ylim=box[2:])
    axes.set_aspect("equal")
