"""The straight parts of a scene that have ends: what pictures and movies draw of its walls."""

from __future__ import annotations

from typing import NamedTuple

from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import sides_in


class StraightPart(NamedTuple):
    """A straight part of the board: a wall or an edge, m."""

    kind: str
    x: tuple[float, float]
    y: tuple[float, float]


def straight_parts(scene: SceneSpec) -> list[StraightPart]:
    """The sides of walls with ends.

    Examples
    --------
    >>> from puck_tables import Puck, Scene, Wall
    >>> straight_parts(Scene(Puck(0.1, friction=0.1), walls=[Wall((0.0, 1.0), (2.0, 1.5))]))
    [StraightPart(kind='wall', x=(0.0, 2.0), y=(1.0, 1.5))]
    """
    return [
        StraightPart("wall", (side.start[0], side.end[0]), (side.start[1], side.end[1]))
        for side in sides_in(scene)
    ]
