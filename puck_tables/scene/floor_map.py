"""The frictions of a floor and the base over them, as compiled code reads them: in one array."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import room_to_clip
from puck_tables.kernels.base_friction import LEVER as BASE_LEVER
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.elliptic_sums import Ellipse

# A ground, all in one array, which is quick to hand on: where the centre of the base is, the factor
# on all friction now, what holds for all of it, how the base is turned, whether velocities of the
# floor differ, the one that states are relative to, how many edges cut the base, whether a part
# of it may lift, of its width how much it has to be pressed on, or tips, and how fast axes of the
# floor turn, and how far they are now, and cosine and sine of how the base is turned,
PLACE_X, PLACE_Y, SHARE, LEVER, ACROSS_X, ACROSS_Y, BORDERS, PATCHES = range(8)
BASE, LAW, ROOM, ANGLE, BELTS, OVER_X, OVER_Y, EDGES, LEFT, LIFTS, LEAST_WIDTH = range(8, 19)
TURNING, TURNED, COSINE, SINE = range(19, 23)
_HEAD = 23
# the places of its borders, f N between them as it is summed now, f N of all strips and then of all
# patches where no factor changes it, the same with their factors, their velocities, where the law
# begins by which their f goes (0: none; N then stands for f N), a row for each patch (its middle,
# the radius of a circle about it, the first of its corners, how many (none: it is that circle), and
# f N there now),
MIDDLE_X, MIDDLE_Y, REACH, CORNER, CORNERS, LOAD = range(6)
PATCH_COLUMNS = 6
# the corners of all patches, and a row for each edge (its normal into the floor, its place along
# it); from BASE on the base, from LAW on its laws of friction (0: it has none), from LEFT on room
# for two contours of what is left of the base, and from ROOM on room to work.  A law is factors
# along and across, the angle of the first, 1: in the floor, or 0: in the body, and from AXES on f
# over the slip speed (0: it is 1).
AXES = 4
MOST_EDGES = 6  # under one base: every cut may double the pieces of its contour


class FloorMap(NamedTuple):
    """All frictions of a floor, and the base that may lie on several of them.

    ``across_x``, ``across_y``: the direction across the borders of strips; ``borders`` (n,): their
    places along it, ascending, m; ``loads`` (n + 1,): f N between them; ``patches`` (k, 6), and
    ``corners`` (m, 2) of those that are polygons, counter-clockwise, m; ``base``: in one array
    (:func:`puck_tables.kernels.base_friction.packed`), its lever the height of the centre of mass
    over N, m/N; ``laws``: its frictions f by the direction and the slip speed, each in one array,
    of four numbers and one of :func:`puck_tables.contact.law_moments.packed_law`, or 0;
    ``which`` (n + 1 + k,): of strips and patches the number of their law, −1: none, whose
    load is N then; ``belts`` (n + 1 + k, 2): their velocities, m/s, none: all alike; ``edges``
    (e, 3): those beyond which the base is not carried, a unit normal into the floor and the place
    along it, m; ``lifts``: whether some state of motion lifts a part of the base; ``narrowest``:
    of the width of what lies on the floor what has to be pressed, or it tips; ``turning``: of the
    axes of the floor, rad/s.
    """

    across_x: float
    across_y: float
    borders: FloatArray
    loads: FloatArray
    patches: FloatArray
    corners: FloatArray
    base: FloatArray
    laws: Sequence[FloatArray] = ()
    which: Sequence[int] = ()
    belts: FloatArray = np.empty((0, 2))
    edges: FloatArray = np.empty((0, 3))
    lifts: bool = False
    narrowest: float = 0.0
    turning: float = 0.0

    def packed(self) -> FloatArray:
        """In one array."""
        whole = np.concatenate([self.loads, self.patches[:, LOAD]])
        belts = self.belts if len(self.belts) else np.zeros((len(whole), 2))
        begins = np.zeros(len(whole))
        tables = [
            self.borders, self.loads, whole, whole, belts.ravel(), begins, self.patches.ravel(),
            self.corners.ravel(), self.edges.ravel(),
        ]  # fmt: skip
        at = _HEAD + sum(table.size for table in tables)
        law = at + self.base.size
        ends = law + np.cumsum([0, *map(len, self.laws)])
        for part, number in enumerate(self.which):
            begins[part] = ends[number] if number >= 0 else 0.0
        sections = 0 if not len(self.edges) else len(self.edges) + 1
        room = np.zeros(room_to_clip(self.base, sections, len(self.corners) > 0))
        left = room if sections or self.lifts else room[:0]
        head = [
            0.0, 0.0, 1.0, self.base[BASE_LEVER], self.across_x, self.across_y,
            len(self.borders), len(self.patches), at, law if self.laws else 0,
            ends[-1] + len(left), 0.0, float((belts != belts[0]).any()), *belts[0],
            len(self.edges), ends[-1], float(self.lifts),
            self.narrowest, self.turning, 0.0, 1.0, 0.0,
        ]  # fmt: skip
        first = np.array(head, np.float64)
        return np.concatenate([first, *tables, self.base, *self.laws, left, room])


NO_FLOOR_MAP = np.empty(0)


@inlined
def border_of(floor_map: FloatArray, number: int) -> float:
    """The place of a border."""
    return floor_map[_HEAD + number]


@inlined
def load_of(floor_map: FloatArray, strip: int) -> float:
    """F N on a strip."""
    return floor_map[_HEAD + int(floor_map[BORDERS]) + strip]


@inlined
def _patches_in(floor_map: FloatArray) -> int:
    """Where the patches begin."""
    return _HEAD + 2 * int(floor_map[BORDERS]) + 1 + 5 * parts_in(floor_map)


@inlined
def patch_of(floor_map: FloatArray, number: int, column: int) -> float:
    """What is known of a patch."""
    return floor_map[_patches_in(floor_map) + PATCH_COLUMNS * number + column]


@inlined
def corner_of(floor_map: FloatArray, number: int) -> tuple[float, float]:
    """A corner of a patch."""
    first = _patches_in(floor_map) + PATCH_COLUMNS * int(floor_map[PATCHES])
    return floor_map[first + 2 * number], floor_map[first + 2 * number + 1]


@inlined
def edge_of(floor_map: FloatArray, number: int) -> tuple[float, float, float]:
    """The normal of an edge into the floor, and its place along it."""
    at = int(floor_map[BASE]) - 3 * (int(floor_map[EDGES]) - number)
    return floor_map[at], floor_map[at + 1], floor_map[at + 2]


@inlined
def strip_at(floor_map: FloatArray, x: float, y: float) -> int:
    """The number of the strip at a place; one on a border is beyond it."""
    place = floor_map[ACROSS_X] * x + floor_map[ACROSS_Y] * y
    low, high = 0, int(floor_map[BORDERS])
    while low < high:
        middle = (low + high) // 2
        if border_of(floor_map, middle) <= place:
            low = middle + 1
        else:
            high = middle
    return low


@inlined
def parts_in(floor_map: FloatArray) -> int:
    """How many strips and patches there are."""
    return int(floor_map[BORDERS]) + 1 + int(floor_map[PATCHES])


@inlined
def _loads_in(floor_map: FloatArray) -> int:
    """Where f N of all stretches stands."""
    return _HEAD + 2 * int(floor_map[BORDERS]) + 1


@inlined
def _sum_with(floor_map: FloatArray, part: int, load: float) -> None:
    """Let a stretch be summed with so much f N."""
    strips = int(floor_map[BORDERS]) + 1
    if part < strips:
        floor_map[_HEAD + strips - 1 + part] = load
    else:
        floor_map[_patches_in(floor_map) + PATCH_COLUMNS * (part - strips) + LOAD] = load


@inlined
def summed_load(floor_map: FloatArray, part: int) -> float:
    """F N on a strip, or after all of them a patch, as it is summed now; N under a law."""
    strips = int(floor_map[BORDERS]) + 1
    if part < strips:
        return load_of(floor_map, part)
    return patch_of(floor_map, part - strips, LOAD)


@inlined
def law_on(floor_map: FloatArray, part: int) -> int:
    """Where the law of a stretch begins; 0: its f is a number."""
    return int(floor_map[_loads_in(floor_map) + 4 * parts_in(floor_map) + part])


@inlined
def ellipse_on(floor_map: FloatArray, at: int) -> Ellipse:
    """The factors of a law that begins at a place, in the axes of the base as it is turned."""
    if floor_map[at] == floor_map[at + 1]:
        return Ellipse(floor_map[at], floor_map[at], 1.0, 0.0)
    angle = floor_map[at + 2] + floor_map[at + 3] * (floor_map[TURNED] - floor_map[ANGLE])
    return Ellipse(floor_map[at], floor_map[at + 1], math.cos(angle), math.sin(angle))


@inlined
def set_factor(floor_map: FloatArray, part: int, factor: float) -> None:
    """Let friction on a strip, or after all of them a patch, be so many times what it is."""
    at = _loads_in(floor_map) + part
    floor_map[at + parts_in(floor_map)] = factor * floor_map[at]
    _sum_with(floor_map, part, factor * floor_map[at])


@inlined
def belt_of(floor_map: FloatArray, part: int) -> tuple[float, float]:
    """The velocity of a stretch, m/s."""
    at = _loads_in(floor_map) + 2 * parts_in(floor_map) + 2 * part
    return floor_map[at], floor_map[at + 1]


@inlined
def sum_over(floor_map: FloatArray, vx: float, vy: float, every: bool) -> None:
    """Let stretches of a velocity be summed alone, or every one."""
    at = _loads_in(floor_map) + parts_in(floor_map)
    for part in range(parts_in(floor_map)):
        bx, by = belt_of(floor_map, part)
        load = floor_map[at + part] if every or (bx == vx and by == vy) else 0.0
        _sum_with(floor_map, part, load)


OUTSIDE, OVERLAPS, INSIDE = range(3)  # how a base lies to a patch


@inner
def distance_to(floor_map: FloatArray, number: int, x: float, y: float) -> float:
    """How far a point is from the border of a patch; inside it that is negative."""
    dx, dy = x - patch_of(floor_map, number, MIDDLE_X), y - patch_of(floor_map, number, MIDDLE_Y)
    count = int(patch_of(floor_map, number, CORNERS))
    first = int(patch_of(floor_map, number, CORNER))
    if count == 0:
        return math.sqrt(dx * dx + dy * dy) - patch_of(floor_map, number, REACH)
    nearest, within = math.inf, False
    for n in range(count):
        one = corner_of(floor_map, first + n)
        two = corner_of(floor_map, first + (n + 1 if n + 1 < count else 0))
        ax, ay, bx, by = x - one[0], y - one[1], two[0] - one[0], two[1] - one[1]
        share = min(max((ax * bx + ay * by) / (bx * bx + by * by), 0.0), 1.0)
        ox, oy = ax - share * bx, ay - share * by
        nearest = min(nearest, ox * ox + oy * oy)
        if (one[1] > y) != (two[1] > y) and ax < ay / by * bx:
            within = not within
    return -math.sqrt(nearest) if within else math.sqrt(nearest)
