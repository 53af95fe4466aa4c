"""A board on axes: walls, edges, posts, arcs, pockets, discs; for pictures and films."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from puck_tables.plot.animation import Animation, MovingDisc
from puck_tables.plot.base_outlines import path_of, placed
from puck_tables.plot.floor_axes import Box, draw_floor
from puck_tables.plot.painted_lines import draw_painted
from puck_tables.plot.round_parts import draw_rounds
from puck_tables.plot.style import RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Circle, PathPatch

_WIDE, _HIGH = 9.0, 7.0  # in, of a panel at most
_LOW = 1.2  # in, at least


def size_of(box: Box) -> tuple[float, float]:
    """Width and height of a panel that shows a box to scale, in.

    Examples
    --------
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
    told: set[str] = set()
    for line in film.lines:
        looks: dict[str, Any] = {"color": "black", "linewidth": 2.5, "solid_capstyle": "projecting"}
        if line.kind == "edge":
            looks = {"color": RED, "linewidth": 1.2, "linestyle": "--"}
        looks |= {} if line.kind in told else {"label": line.kind}
        told.add(line.kind)
        axes.plot(line.x, line.y, zorder=1, **looks)


def disc(
    body: MovingDisc, x: float, y: float, angle: float = 0.0, **looks: Any
) -> Circle | PathPatch:
    """A disc at a place, or what it is instead, to scale; one that is driven is hatched."""
    from matplotlib.patches import Circle, PathPatch

    hatch = {"hatch": "////"} if body.driven else {}
    if body.outline:
        return PathPatch(path_of(placed(body.outline, x, y, angle)), **hatch, **looks)
    return Circle((x, y), body.radius, **hatch, **looks)


def show(axes: Axes, box: Box) -> None:
    """To scale, all of a box in sight."""
    axes.set(xlabel="x / m", ylabel="y / m", xlim=box[:2], ylim=box[2:])
    axes.set_aspect("equal")
