"""What is left on the floor of a flat base that hangs over edges, and how that carries it.

The pressure is p = max(0, a + b·x) over the part of the base on the floor; for a weight of 1

    ∫ p dA = 1 ,   ∫ p x dA = m ,

x from the centre of mass, m where the load stands.  These are the gradient of a convex function of
a and b.  Newton's rule for it: solve the three linear equations on what was pressed in the last
round, then cut what is left of the base where p changes its sign, until that does not move.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import beyond_line, whole_contour
from puck_tables.kernels.base_friction import REACH, pressure_over
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    BEGIN_X,
    BEGIN_Y,
    END_X,
    END_Y,
    PIECE_COLUMNS,
    RADIUS,
    START,
    TURN,
)
from puck_tables.scene.floor_map import ANGLE, BASE, EDGES, PLACE_X, PLACE_Y, ROOM, edge_of

MOST_EDGES = 6  # under one base: every cut may double the pieces of its contour
# of the reach: the centre of mass is taken to be this far on the floor at least, for what is
# pressed shrinks to a line as it comes to an edge
_LEAST = 1e-4
# of the pressure: it does not move any more; below the other, less only if it is not rounding
_SETTLED, _NEAR = 1e-13, 1e-3
_ROUNDS = 200  # at most; near an edge each takes off a third of what is pressed

Moments = tuple[float, float, float, float, float, float]
Left = tuple[int, int, float, float, float]


@inlined
def _swept(sums: Moments, px: float, py: float, qx: float, qy: float) -> Moments:
    """∫ dA, ∫ x dA and ∫ x x dA, and those of the triangle from the origin to a straight piece."""
    cross = px * qy - py * qx
    x, y, part = px + qx, py + qy, cross / 24.0
    return (
        sums[0] + 0.5 * cross, sums[1] + cross * x / 6.0, sums[2] + cross * y / 6.0,
        sums[3] + part * (x * x + px * px + qx * qx),
        sums[4] + part * (x * y + px * py + qx * qy),
        sums[5] + part * (y * y + py * py + qy * qy),
    )  # fmt: skip


@inlined
def _sector(sums: Moments, room: FloatArray, at: int) -> Moments:
    """∫ dA, ∫ x dA and ∫ x x dA, and those of the sector of an arc, from its middle."""
    x, y, r = room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS]
    start, turn = room[at + START], room[at + TURN]
    c, s = math.cos(start), math.sin(start)
    until_c, until_s = math.cos(start + turn), math.sin(start + turn)
    area, third, fourth = 0.5 * r * r * turn, r * r * r / 3.0, 0.125 * r * r * r * r
    fx, fy = third * (until_s - s), third * (c - until_c)
    double, single = until_s * until_c - s * c, until_s * until_s - s * s
    return (
        sums[0] + area, sums[1] + fx + area * x, sums[2] + fy + area * y,
        sums[3] + fourth * (turn + double) + 2.0 * x * fx + area * x * x,
        sums[4] + fourth * single + x * fy + y * fx + area * x * y,
        sums[5] + fourth * (turn - double) + 2.0 * y * fy + area * y * y,
    )  # fmt: skip


@inner
def _pressure(
    room: FloatArray, first: int, last: int, mx: float, my: float
) -> tuple[float, float, float]:
    """A, b_x and b_y of a + b·x over what a contour bounds, with a weight of 1 at m."""
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for at in range(first, last, PIECE_COLUMNS):
        px, py, qx, qy = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
        if room[at + TURN] == 0.0:
            sums = _swept(sums, px, py, qx, qy)
        else:
            x, y = room[at + ABOUT_X], room[at + ABOUT_Y]
            sums = _sector(_swept(_swept(sums, px, py, x, y), x, y, qx, qy), room, at)
    return pressure_over(sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], mx, my)


@inner
def left_on_floor(floor_map: FloatArray, mx: float, my: float) -> Left:
    """Of a base over edges the contour that is pressed, and a, b_x and b_y of its pressure.

    Where in the array the contour begins and ends; nothing where no edge is under the base.
    (mx, my): where the load stands in the axes of the base, m.
    """
    begin, one = int(floor_map[BASE]), int(floor_map[ROOM])
    base, half = floor_map[begin:], (len(floor_map) - one) // 2
    reach, to, cut = base[REACH], one, False
    first, last = whole_contour(base, begin)
    c, s = math.cos(floor_map[ANGLE]), math.sin(floor_map[ANGLE])
    for k in range(int(floor_map[EDGES])):
        east, north, place = edge_of(floor_map, k)
        place -= east * floor_map[PLACE_X] + north * floor_map[PLACE_Y]
        if place > -reach:
            nx, ny = c * east + s * north, c * north - s * east
            place = min(place, -_LEAST * reach)
            end = beyond_line(floor_map, first, last, to, nx, ny, place, math.inf, math.inf)
            first, last, to, cut = to, end, 2 * one + half - to, True
    if not cut:
        return 0, 0, 0.0, 0.0, 0.0
    a, bx, by = _pressure(floor_map, first, last, mx, my)
    pressed, until, last_move = first, last, math.inf
    for _ in range(_ROUNDS):
        slope = math.sqrt(bx * bx + by * by)
        if a >= slope * reach:
            break
        until = beyond_line(
            floor_map, first, last, to, bx / slope, by / slope, -a / slope, math.inf, math.inf
        )
        pressed = to
        na, nx, ny = _pressure(floor_map, to, until, mx, my)
        moved = abs(na - a) + reach * (abs(nx - bx) + abs(ny - by))
        moved /= abs(na) + reach * (abs(nx) + abs(ny))
        a, bx, by = na, nx, ny
        if moved <= _SETTLED or (moved < _NEAR and moved >= last_move):
            break
        last_move = moved
    return pressed, until, a, bx, by
