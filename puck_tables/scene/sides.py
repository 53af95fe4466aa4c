"""The straight sides of walls with ends, and the corners where a rim may meet such an end.

A wall with ends is the piece between them, from both sides.  What touches a rim is then the foot
of its centre on a side, where there is one, or an end.  Where walls meet in one point, or one ends
on another, that point is met only from where the centre lies beyond all of them; so every centre
has one place that it may touch, and no corner counts twice.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.scene.floor_patches import corners_of, edges_apart, point_to_edge
from puck_tables.scene.parts import Edge, Wall

if TYPE_CHECKING:
    from puck_tables.scene.scene_spec import SceneSpec

_SAME = 1e-12  # of the largest coordinate: ends as near are one point
_STRAIGHT = 1e-9  # rad: walls that go on as straight have no corner
Point = tuple[float, float]


class WallSide(NamedTuple):
    """A straight side of a wall, m; ``wall``: its number."""

    wall: int
    start: Point
    end: Point

    @property
    def normal(self) -> Point:
        """The unit normal to the left of the way from start to end."""
        ex, ey = self.end[0] - self.start[0], self.end[1] - self.start[1]
        long = math.hypot(ex, ey)
        return -ey / long, ex / long

    @property
    def along(self) -> Point:
        """The unit vector from start to end."""
        nx, ny = self.normal
        return ny, -nx


class Corner(NamedTuple):
    """A point where walls end that a rim may meet, from beyond ``one`` and ``other``.

    These are unit vectors along the walls, from it; ``wall``: the number of the first of them.
    """

    wall: int
    point: Point
    one: Point
    other: Point


def shape_faults(wall: Wall) -> Iterator[str]:
    """What is wrong with where a wall is.

    >>> list(shape_faults(Wall((0.0, 0.0))))
    ['give a point with the normal into the field, a start and an end, or corners']
    """
    line = wall.point is not None, wall.normal is not None
    ends = wall.start is not None, wall.end is not None
    forms = [all(line), all(ends), bool(wall.corners)]
    if sum(forms) != 1 or any(line) != all(line) or any(ends) != all(ends):
        yield "give a point with the normal into the field, a start and an end, or corners"
    elif all(ends) and wall.start == wall.end:
        yield f"end = {wall.end}: must lie elsewhere than its start"
    elif wall.corners:
        try:
            corners_of(wall)
        except InputError as error:
            yield str(error)


def line_of(line: Wall | Edge) -> tuple[float, float, float]:
    """The unit normal of a line without ends, and its place along it.

    >>> line_of(Edge((0.0, 1.0), normal=(0.0, -2.0)))
    (0.0, -1.0, -1.0)
    """
    if line.point is None or line.normal is None:
        raise TypeError("a wall with ends is no line")
    size = math.hypot(*line.normal)
    nx, ny = line.normal[0] / size, line.normal[1] / size
    return nx, ny, nx * line.point[0] + ny * line.point[1]


def ends_of_floor(scene: SceneSpec) -> list[int]:
    """The numbers of the edges beyond which there is no floor.

    >>> from puck_tables import Edge, Puck, Scene
    >>> there = [Edge((-1.0, 0.0), normal=(1.0, 0.0), beyond=one) for one in ("floor", "nothing")]
    >>> ends_of_floor(Scene(Puck(0.04), edges=there))
    [1]
    """
    return [number for number, edge in enumerate(scene.edges) if edge.beyond == "nothing"]


def sides_of(wall: Wall, number: int = 0) -> list[WallSide]:
    """The sides of a wall with ends, one after the other; none of one without.

    >>> [side.end for side in sides_of(Wall(corners=[[0, 0], [1, 0], [0, 1]]))]
    [(1.0, 0.0), (0.0, 1.0), (0.0, 0.0)]
    """
    if wall.start is not None and wall.end is not None:
        return [WallSide(number, wall.start, wall.end)]
    places = [(x, y) for x, y in corners_of(wall).tolist()] if wall.corners else []
    return [WallSide(number, one, other) for one, other in zip(places, places[1:] + places[:1],
                                                           strict=True)]  # fmt: skip


def sides_in(scene: SceneSpec) -> list[WallSide]:
    """All sides of all walls with ends, those that end in one point to the last bit."""
    sides = [side for k, wall in enumerate(scene.walls) for side in sides_of(wall, k)]
    if not sides:
        return []
    ends = np.array([side[1:] for side in sides]).reshape(-1, 2)
    near = _SAME * float(np.abs(ends).max())
    same = (np.abs(ends[:, None] - ends) <= near).all(axis=2)
    points: list[Point] = [(x, y) for x, y in ends[same.argmax(axis=1)].tolist()]
    return [WallSide(side.wall, *points[2 * n : 2 * n + 2]) for n, side in enumerate(sides)]


def corners_in(scene: SceneSpec) -> list[Corner]:
    """All points where walls end that a rim may meet.

    >>> from puck_tables import Puck, Scene
    >>> angle = [Wall((1.0, 0.0), (2.0, 0.0)), Wall((2.0, 0.0), (2.0, 1.0))]
    >>> [corner.point for corner in corners_in(Scene(Puck(0.1, friction=0.1), walls=angle))]
    [(1.0, 0.0), (2.0, 0.0), (2.0, 1.0)]
    """
    sides = sides_in(scene)
    leaving: dict[Point, list[tuple[int, Point]]] = {}
    for side in sides:
        ux, uy = side.along
        leaving.setdefault(side.start, []).append((side.wall, (ux, uy)))
        leaving.setdefault(side.end, []).append((side.wall, (-ux, -uy)))
    covered = _covered(scene, sides, list(leaving))
    corners = []
    for (point, branches), goes_on in zip(leaving.items(), covered, strict=True):
        if goes_on:
            continue
        walls = {direction: wall for wall, direction in reversed(branches)}
        ordered = sorted(walls.items(), key=_angle)
        for (one, wall), (other, next_wall) in zip(ordered, ordered[1:] + ordered[:1],
                                                   strict=True):  # fmt: skip
            turn = math.atan2(one[0] * other[1] - one[1] * other[0],
                              one[0] * other[0] + one[1] * other[1])  # fmt: skip
            if len(ordered) == 1 or -math.pi + _STRAIGHT < turn < 0.0:  # more than half a turn free
                corners.append(Corner(min(wall, next_wall), point, one, other))
    return corners


def _angle(direction: tuple[Point, int]) -> float:
    return math.atan2(direction[0][1], direction[0][0])


def _covered(scene: SceneSpec, sides: list[WallSide], points: list[Point]) -> list[bool]:
    """Which points lie on a wall that goes on to both sides of them."""
    if not points:
        return []
    places = np.array(points)
    near = _SAME * float(np.abs(places).max())
    starts = np.array([side.start for side in sides])
    directions = np.array([side.along for side in sides])
    off = places[:, None] - starts
    along = (off * directions).sum(axis=2)
    across = off[:, :, 0] * directions[:, 1] - off[:, :, 1] * directions[:, 0]
    longest = np.array([math.dist(side.start, side.end) for side in sides]) - near
    covered = ((near < along) & (along < longest) & (np.abs(across) <= near)).any(axis=1)
    for wall in scene.walls:
        if wall.point is not None:
            nx, ny, at = line_of(wall)
            covered |= np.abs(places @ (nx, ny) - at) <= near
    return list(map(bool, covered))


def cushions_in(scene: SceneSpec) -> list[tuple[str, int]]:
    """Kind and number of all that rims bounce off, in the order in which the engine has them.

    A wall with ends is there once for each of its sides, and after the arcs for its corners.

    >>> from puck_tables import Puck, Scene
    >>> cushions_in(Scene(Puck(0.1, friction=0.1), walls=[Wall((0.0, 1.0), (1.0, 1.0))]))
    [('wall', 0), ('wall', 0), ('wall', 0)]
    """
    cushions = []
    for n, wall in enumerate(scene.walls):
        cushions += [("wall", n)] * max(len(sides_of(wall)), 1)
    cushions += [("post", n) for n in range(len(scene.posts))]
    cushions += [("arc", n) for n in range(len(scene.arcs))]
    return cushions + [("wall", corner.wall) for corner in corners_in(scene)]


def gap_to(wall: Wall, place: Point) -> float:
    """How far a place is from a wall, m; behind one without ends less than 0.

    >>> gap_to(Wall((0.0, 0.0), (1.0, 0.0)), (4.0, 4.0))
    5.0
    """
    if wall.point is not None:
        nx, ny, at = line_of(wall)
        return nx * place[0] + ny * place[1] - at
    there = np.array(place)
    return min(point_to_edge(there, *map(np.array, side[1:])) for side in sides_of(wall))


def gap_along(wall: Wall, before: FloatArray, after: FloatArray) -> float:
    """How far a straight way (2,) to (2,) stays from a wall with ends, m; 0 across it.

    >>> gap_along(Wall((0.0, 0.0), (1.0, 0.0)), np.array([0.5, 1.0]), np.array([0.5, -1.0]))
    0.0
    """
    return min(edges_apart(before, after, *map(np.array, side[1:])) for side in sides_of(wall))
