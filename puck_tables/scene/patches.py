"""How far a place is from the border of a patch of the floor."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inner
from puck_tables.scene.floor_map import (
    CORNER,
    CORNERS,
    MIDDLE_X,
    MIDDLE_Y,
    REACH,
    corner_of,
    patch_of,
)

OUTSIDE, ASTRIDE, INSIDE = range(3)  # how a base lies to a patch


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
