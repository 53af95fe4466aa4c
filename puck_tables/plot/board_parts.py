"""What pictures and movies draw of a scene: sides of walls, round parts, painted lines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from puck_tables.plot.style import GREY
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import sides_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROUND = 97  # points of a round line


class StraightPart(NamedTuple):
    """A straight part of the board: a wall or an edge, m."""

    kind: str
    x: tuple[float, float]
    y: tuple[float, float]


def straight_parts(scene: SceneSpec) -> list[StraightPart]:
    """The sides of walls with ends.

    >>> from puck_tables import Puck, Scene, Wall
    >>> straight_parts(Scene(Puck(0.1, friction=0.1), walls=[Wall((0.0, 1.0), (2.0, 1.5))]))
    [StraightPart(kind='wall', x=(0.0, 2.0), y=(1.0, 1.5))]
    """
    return [
        StraightPart("wall", (side.start[0], side.end[0]), (side.start[1], side.end[1]))
        for side in sides_in(scene)
    ]


class RoundPart(NamedTuple):
    """A round part of the board: a post, an arc or a pocket; angles in rad."""

    kind: str
    x: float
    y: float
    radius: float
    start: float = 0.0
    span: float = 2.0 * math.pi


def rounds_of(scene: SceneSpec) -> list[RoundPart]:
    """Posts, arcs and pockets."""
    posts = [RoundPart("post", *post.point, post.radius) for post in scene.posts]
    arcs = [RoundPart("arc", *arc.point, arc.radius, arc.start, arc.span) for arc in scene.arcs]
    return [*posts, *arcs, *(RoundPart("pocket", *one.point, one.radius) for one in scene.pockets)]


def draw_rounds(axes: Axes, rounds: list[RoundPart]) -> None:
    """All of them to scale, each kind labelled once."""
    from matplotlib.patches import Arc, Circle

    labels: set[str] = set()
    for one in rounds:
        centre = one.x, one.y
        label: dict[str, Any] = {} if one.kind in labels else {"label": one.kind}
        labels.add(one.kind)
        if one.kind == "arc":
            ends = np.degrees([one.start, one.start + one.span])
            whole = one.span >= 2.0 * math.pi
            axes.add_patch(
                Arc(
                    centre, 2.0 * one.radius, 2.0 * one.radius, theta1=0.0 if whole else ends[0],
                    theta2=360.0 if whole else ends[1], color="black", linewidth=2.5, zorder=1,
                )
            )  # fmt: skip
            axes.plot([], [], color="black", linewidth=2.5, **label)
            continue
        looks: dict[str, Any] = {"facecolor": "#d8d8d8", "edgecolor": GREY, "linewidth": 0.8}
        if one.kind == "post":
            looks = {"facecolor": "#606060", "edgecolor": "black", "linewidth": 0.5}
        axes.add_patch(Circle(centre, one.radius, zorder=1, **looks, **label))


class Painted(NamedTuple):
    """A painted line: its colour, and the points that it goes through, m."""

    colour: str
    x: tuple[float, ...]
    y: tuple[float, ...]


def painted_on(scene: SceneSpec) -> list[Painted]:
    """All of them.

    >>> from puck_tables import Line, Puck, Scene
    >>> painted_on(Scene(Puck(0.1), lines=[Line((0.0, 0.0), (0.0, 2.0))]))[0].y
    (0.0, 2.0)
    """
    lines, turn = [], np.linspace(0.0, 2.0 * math.pi, _ROUND)
    for line in scene.lines:
        colour = line.colour or GREY
        if line.start is None or line.end is None:
            x = line.centre[0] + line.radius * np.cos(turn)
            y = line.centre[1] + line.radius * np.sin(turn)
            lines.append(Painted(colour, tuple(x.tolist()), tuple(y.tolist())))
        else:
            x0, x1 = zip(line.start, line.end, strict=True)
            lines.append(Painted(colour, x0, x1))
    return lines


def draw_painted(axes: Axes, lines: list[Painted], zorder: float = 0.9) -> None:
    """All of them, labelled once."""
    for number, line in enumerate(lines):
        label = "line" if number == 0 else None
        axes.plot(line.x, line.y, color=line.colour, linewidth=1.1, zorder=zorder, label=label)
