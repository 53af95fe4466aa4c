"""What of a base is pressed, and how: a floor pushes and never pulls.

With e the slip direction the pressure is p = max(0, a + b·x) over what of a base lies on the floor;
for a weight of 1

    ∫ p dA = 1 ,   ∫ p x dA = m + z f ∫ p e dA ,

x from the centre of mass, m where the load of what is at rest stands, z f = 0 of what is flat or at
rest.  Newton's rule for that: solve the three linear equations on what was pressed in the last
round, then cut what there is of the base where p changes its sign, until that does not move.  Where
no pressure balances, the body tips.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import beyond_line
from puck_tables.kernels.base_friction import Moments, pressure_over
from puck_tables.kernels.base_sums import Sums
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

MOST_ROUNDS = 200  # near an edge each takes off a third of what is pressed
# of the pressure: it does not move any more; below the other, less only if it is not rounding
_CONVERGED, _NEAR = 1e-13, 1e-3
# of how wide is what there is: pressed on less, a tall body tips, or one on feet; narrower,
# rounding moves friction by more than 1e-10
NARROWEST = 1e-3


class Pressed(NamedTuple):
    """A contour that is pressed, its pressure, and by how much that has moved; 0: it has settled.

    ``moved`` inf: it has none yet.
    """

    first: int
    last: int
    a: float
    bx: float
    by: float
    moved: float


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


@inlined
def _moments_of(room: FloatArray, first: int, last: int) -> Moments:
    """∫ dA, ∫ x dA and ∫ x x dA over what a contour bounds."""
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for at in range(first, last, PIECE_COLUMNS):
        px, py, qx, qy = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
        if room[at + TURN] == 0.0:
            sums = _swept(sums, px, py, qx, qy)
        else:
            x, y = room[at + ABOUT_X], room[at + ABOUT_Y]
            sums = _sector(_swept(_swept(sums, px, py, x, y), x, y, qx, qy), room, at)
    return sums


@inlined
def _narrowness(moments: Moments) -> float:
    """The least mean square of the distances from a line through the middle, m²."""
    area, sx, sy = moments[0], moments[1], moments[2]
    xx = moments[3] / area - sx * sx / (area * area)
    xy = moments[4] / area - sx * sy / (area * area)
    yy = moments[5] / area - sy * sy / (area * area)
    return (xx * yy - xy * xy) / (xx + yy)


@inner
def next_pressed(
    room: FloatArray, first: int, last: int, to: int, reach: float, narrowest: float, now: Pressed,
    sums: Sums, lever: float, mx: float, my: float,
) -> Pressed:  # fmt: skip
    """The next round, from the sums over what is pressed now; no number where the body tips.

    ``first``, ``last``: the contour of all that there is; ``to``: where that of a part is put;
    ``narrowest``: of the width of all, what presses at least.
    """
    moments = _moments_of(room, now.first, now.last)
    a, bx, by = pressure_over(moments, sums, lever, mx, my)
    slope = math.sqrt(bx * bx + by * by)
    if now.first == first and a >= slope * reach:
        return Pressed(first, last, a, bx, by, 0.0)
    moved = abs(a - now.a) + reach * (abs(bx - now.bx) + abs(by - now.by))
    moved /= abs(a) + reach * (abs(bx) + abs(by))
    if moved <= _CONVERGED or (moved < _NEAR and moved >= now.moved):
        return Pressed(now.first, now.last, a, bx, by, 0.0)
    until = beyond_line(
        room, first, last, to, bx / slope, by / slope, -a / slope, math.inf, math.inf
    )
    wide = narrowest * narrowest * _narrowness(_moments_of(room, first, last))
    if until == to or not _narrowness(_moments_of(room, to, until)) > wide:
        return Pressed(first, last, math.nan, math.nan, math.nan, 0.0)
    return Pressed(to, until, a, bx, by, moved)
