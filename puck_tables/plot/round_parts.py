"""The round parts of a scene, posts, arcs and pockets, on axes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from puck_tables.plot.style import GREY
from puck_tables.scene.scene_spec import SceneSpec

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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

    told: set[str] = set()
    for one in rounds:
        centre = one.x, one.y
        label: dict[str, Any] = {} if one.kind in told else {"label": one.kind}
        told.add(one.kind)
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
