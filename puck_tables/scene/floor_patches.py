"""Patches of other friction on a floor: round ones, and polygons; what is wrong with them."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.drawn_outlines import outlines_of
from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.scene.parts import Floor, Patch, Wall

MOST_CORNERS = 200  # of a patch: each side adds to the cost of a look
_FLAT = 1e-12  # of the square of its size: the area of a polygon that has none


def corners_of(part: Patch | Wall) -> FloatArray:
    """The corners (n, 2) of a patch or a wall, counter-clockwise, m; none of a round patch.

    Raises InputError if they are no corners of a polygon, or their file cannot be read.

    >>> from puck_tables import Patch
    >>> corners_of(Patch(0.1, corners=[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])).tolist()
    [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]
    """
    if not part.corners:
        return np.empty((0, 2))
    rows, *more = outlines_of(part.corners)
    if more:
        raise InputError(f"{part.corners}: it holds {len(more) + 1} outlines: leave one in it")
    if not 3 <= len(rows) <= MOST_CORNERS:
        source = f" in {part.corners}" if isinstance(part.corners, str) else ""
        raise InputError(
            f"corners must be from 3 to {MOST_CORNERS} rows of x and y, got {len(rows)}{source}"
        )
    corners = tuple(map(tuple, rows.tolist()))
    closed = len(corners) > 3 and corners[0] == corners[-1]  # as maps have them
    return _around(corners[:-1] if closed else corners)


@lru_cache(maxsize=256)
def _around(corners: tuple[tuple[float, ...], ...]) -> FloatArray:
    """Corners counter-clockwise; kept, for a sweep asks for them again and again."""
    rows = np.array(corners)
    ahead = np.roll(rows, -1, axis=0)
    for n in np.flatnonzero((rows == ahead).all(axis=1)).tolist():
        raise InputError(f"corner {(n + 1) % len(rows)} repeats corner {n}: give each corner once")
    if crossing := _crossing(rows, ahead):
        raise InputError(
            f"the edges from corners {crossing[0]} and {crossing[1]} meet: give the corners one "
            "after the other around it"
        )
    around = rows - rows[0]
    area = 0.5 * float(np.sum(around[:, 0] * np.roll(around[:, 1], -1)
                              - around[:, 1] * np.roll(around[:, 0], -1)))  # fmt: skip
    if abs(area) <= _FLAT * float(np.ptp(rows, axis=0).max()) ** 2:
        raise InputError("the corners lie on a line: what they go around needs an area")
    return rows if area > 0.0 else rows[::-1].copy()


def _crossing(rows: FloatArray, ahead: FloatArray) -> tuple[int, int] | None:
    """Two edges of a polygon that meet besides at a corner between them."""
    count = len(rows)
    for i in range(count):
        for j in range(i + 1, count):
            if j == i + 1 or (i == 0 and j == count - 1):
                if np.array_equal(rows[i], rows[j]):
                    return i, j
            elif edges_apart(rows[i], ahead[i], rows[j], ahead[j]) == 0.0:
                return i, j
    return None


def edges_apart(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> float:
    """How far two straight pieces ab and cd are from each other.

    >>> a, b, c, d = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [2.0, -1.0]])
    >>> edges_apart(a, b, c, d), edges_apart(a, 3.0 * b, c, d)
    (1.0, 0.0)
    """

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    if side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0:
        return 0.0
    return min(
        point_to_edge(c, a, b), point_to_edge(d, a, b), point_to_edge(a, c, d),
        point_to_edge(b, c, d),
    )  # fmt: skip


def point_to_edge(p: FloatArray, a: FloatArray, b: FloatArray) -> float:
    """How far a point is from a straight piece."""
    along = b - a
    square = float(along @ along)
    share = min(max(float((p - a) @ along) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return math.dist(p, a + share * along)


def patch_faults(floor: Floor) -> list[str]:
    """What is wrong with the patches of a floor; they may touch, but not overlap.

    >>> from puck_tables import Floor, Patch
    >>> patch_faults(Floor(patches=[Patch(0.1)]))
    ['floor.patch[0]: give a radius > 0 m, or corners']
    """
    faults, shapes = [], []
    for i, patch in enumerate(floor.patches):
        name = f"floor.patch[{i}]"
        if patch.corners and (patch.radius > 0.0 or any(patch.centre)):
            faults.append(f"{name}: give corners, or centre and radius, not both")
        elif not patch.corners and not patch.radius > 0.0:
            faults.append(f"{name}: give a radius > 0 m, or corners")
        else:
            try:
                shapes.append((i, patch, corners_of(patch)))
            except InputError as error:
                faults.append(f"{name}: {error}")
    if faults:
        return faults
    for n, (i, patch, places) in enumerate(shapes):
        if crosses := _over_border(floor, patch, places):
            faults.append(f"floor.patch[{i}] {crosses}: give a patch on each side of it")
        for j, other, theirs in shapes[:n]:
            if _overlap(patch, places, other, theirs):
                faults.append(
                    f"floor.patch[{j}] and floor.patch[{i}] overlap: of two frictions at one place "
                    "only one can be; move one, or cut it"
                )
    return faults


def _over_border(floor: Floor, patch: Patch, places: FloatArray) -> str:
    """Which border of strips a patch lies over, in words."""
    if floor.strips is None:
        return ""
    across = np.array([math.cos(floor.strips.direction), math.sin(floor.strips.direction)])
    along = places @ across if len(places) else across @ patch.centre + np.array(
        [-patch.radius, patch.radius]
    )  # fmt: skip
    room = 1e-12 * float(np.abs(along).max() + np.ptp(along))
    for i, border in enumerate(floor.strips.borders):
        if along.min() < border - room and along.max() > border + room:
            return f"lies over floor.strips.borders[{i}] = {border:g}"
    return ""


def _overlap(one: Patch, ours: FloatArray, other: Patch, theirs: FloatArray) -> bool:
    """Whether two patches have more in common than a border."""
    if not len(ours) and not len(theirs):
        reach = one.radius + other.radius
        return math.dist(one.centre, other.centre) < reach * (1.0 - 1e-12)
    if not len(ours):
        one, ours, other, theirs = other, theirs, one, ours
    if not len(theirs):
        centre = np.array(other.centre)
        edges = zip(ours, np.roll(ours, -1, axis=0), strict=True)
        near = min(point_to_edge(centre, a, b) for a, b in edges)
        return inside(ours, centre) or near < other.radius * (1.0 - 1e-12)
    size = max(float(np.ptp(ours, axis=0).max()), float(np.ptp(theirs, axis=0).max()))
    return _reaches_into(ours, theirs, size) or _reaches_into(theirs, ours, size)


def _reaches_into(ours: FloatArray, theirs: FloatArray, size: float) -> bool:
    """Whether a polygon has part of its border within another one."""
    ahead = np.roll(theirs, -1, axis=0)
    for a, b in zip(ours, np.roll(ours, -1, axis=0), strict=True):
        ends = {0.0, 1.0}
        for c, d in zip(theirs, ahead, strict=True):
            along, side = b - a, d - c
            cross = along[0] * side[1] - along[1] * side[0]
            if abs(cross) > 1e-14 * size * size:
                ends.add(min(max(((c - a)[0] * side[1] - (c - a)[1] * side[0]) / cross, 0.0), 1.0))
        places = sorted(ends)
        for low, high in pairwise(places):
            middle = a + 0.5 * (low + high) * (b - a)
            deep = min(point_to_edge(middle, c, d) for c, d in zip(theirs, ahead, strict=True))
            if deep > 1e-9 * size and inside(theirs, middle):
                return True
    same = bool(len(ours) == len(theirs)) and inside(theirs, _within(ours))
    return same and inside(ours, _within(theirs))


def _within(places: FloatArray) -> FloatArray:
    """A point inside a polygon that runs counter-clockwise: in its lowest corner."""
    n = int(np.lexsort((places[:, 0], places[:, 1]))[0])
    corner, before, after = places[n], places[n - 1], places[(n + 1) % len(places)]
    return corner + 1e-6 * ((before - corner) + (after - corner))


def inside(places: FloatArray, point: FloatArray) -> bool:
    """Whether a point lies in a polygon.

    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> inside(square, np.array([0.5, 0.5])), inside(square, np.array([1.5, 0.5]))
    (True, False)
    """
    (x, y), ahead = places.T, np.roll(places, -1, axis=0).T
    over = (y > point[1]) != (ahead[1] > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        place = x + (point[1] - y) / (ahead[1] - y) * (ahead[0] - x)
    return bool(np.count_nonzero(over & (point[0] < place)) % 2)
