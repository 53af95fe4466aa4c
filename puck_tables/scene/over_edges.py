"""What edges leave on the floor of a base that hangs over them."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import beyond_line, whole_contour
from puck_tables.kernels.base_friction import REACH
from puck_tables.kernels.compile import inner
from puck_tables.scene.floor_map import (
    BASE,
    COSINE,
    EDGES,
    LEFT,
    PLACE_X,
    PLACE_Y,
    ROOM,
    SINE,
    edge_of,
)

MOST_EDGES = 6  # under one base: every cut may double the pieces of its contour
# of the reach: the centre of mass is taken to be this far on the floor at least, for what is
# pressed shrinks to a line as it comes to an edge
_LEAST = 1e-4


@inner
def left_on_floor(floor_map: FloatArray) -> tuple[int, int, int]:
    """Where the contour begins and ends that edges leave of a base, and where there is room.

    That of the base itself where no edge is under it.
    """
    begin, one = int(floor_map[BASE]), int(floor_map[LEFT])
    reach, to, other = floor_map[begin + REACH], one, (one + int(floor_map[ROOM])) // 2
    first, last = whole_contour(floor_map[begin:], begin)
    for k in range(int(floor_map[EDGES])):
        east, north, place = edge_of(floor_map, k)
        place -= east * floor_map[PLACE_X] + north * floor_map[PLACE_Y]
        if place > -reach:
            c, s = floor_map[COSINE], floor_map[SINE]
            nx, ny = c * east + s * north, c * north - s * east
            place = min(place, -_LEAST * reach)
            end = beyond_line(floor_map, first, last, to, nx, ny, place, math.inf, math.inf)
            first, last, to, other = to, end, other, to
    return first, last, to
