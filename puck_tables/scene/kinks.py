"""When the friction on a base that lies on several will bend next, as the motion is now.

It bends where a rim, also that of a hole, meets a border or leaves it, or passes a corner, and
where the centre of rotation comes over a border under the base, or close beside it.  Only foreseen:
steps end there, and begin anew.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    BORDERS,
    CORNER,
    CORNERS,
    INNER,
    MIDDLE_X,
    MIDDLE_Y,
    PATCHES,
    REACH,
    border_of,
    corner_of,
    patch_of,
)
from puck_tables.scene.ingredients import Surface, carried_along

_CLOSE = 1e-9  # of the time in which the slip goes a radius: nearer moments are now
_BEYOND = 1e-5  # of the time to a kink: by so much later, so that it is passed
_BESIDE = 1.3 * 1.3  # radii, squared: where the centre of rotation is felt, if not under the base
_FAR = 8.0  # radii: nobody foresees more


@inlined
def _when(gap: float, rate: float, bend: float, after: float) -> float:
    """The first time after one at which gap + rate t + ½ bend t² is 0; inf: never."""
    square = rate * rate - 2.0 * bend * gap
    if square < 0.0:
        return math.inf
    turn = -(rate + math.copysign(math.sqrt(square), rate))
    one = 2.0 * gap / turn if turn != 0.0 else math.inf
    two = turn / bend if bend != 0.0 else math.inf
    one, two = min(one, two), max(one, two)
    return one if one > after else (two if two > after else math.inf)


@inlined
def _sides(gap: float, rate: float, bend: float, one: float, two: float, after: float) -> float:
    """The same, at which it is one of two numbers."""
    return min(_when(gap - one, rate, bend, after), _when(gap - two, rate, bend, after))


@inner
def next_kink(
    ground: FloatArray, radius: float, surface: Surface, y: FloatArray, first: FloatArray,
    near: float,
) -> float:  # fmt: skip
    """In what time; inf: none is foreseen.  The centre of rotation may be on a border ``near``.

    ``first``: dy/dt.
    """
    px, py, vx, vy, ux, uy, w = y[X], y[Y], first[X], first[Y], y[VX], y[VY], y[SPIN]
    cx, cy = carried_along(surface, vx, vy)
    ax, ay = first[VX] + cx, first[VY] + cy
    speed = math.sqrt(vx * vx + vy * vy)
    close = _CLOSE * radius / (speed + radius * abs(w) + 1e-300)
    near = max(near, close)
    # the centre of rotation and its velocity
    turns = ux * ux + uy * uy < _BESIDE * radius * radius * w * w
    inverse = 1.0 / w if turns else 0.0
    cx, cy = px - uy * inverse, py + ux * inverse
    slows = first[SPIN] * inverse
    ox, oy = vx - (first[VY] - uy * slows) * inverse, vy + (first[VX] - ux * slows) * inverse
    least = _FAR * radius / speed if speed > 0.0 else math.inf
    nx, ny, hole = ground[ACROSS_X], ground[ACROSS_Y], ground[INNER] * radius
    for i in range(int(ground[BORDERS])):
        place = border_of(ground, i)
        gap, rate, bend = nx * px + ny * py - place, nx * vx + ny * vy, nx * ax + ny * ay
        least = min(least, _sides(gap, rate, bend, radius, -radius, close))
        if hole > 0.0:
            least = min(least, _sides(gap, rate, bend, hole, -hole, close))
        if turns:
            least = min(least, _when(nx * cx + ny * cy - place, nx * ox + ny * oy, 0.0, near))
    for k in range(int(ground[PATCHES])):
        begin, corners = int(patch_of(ground, k, CORNER)), int(patch_of(ground, k, CORNERS))
        if corners == 0:
            mx, my = patch_of(ground, k, MIDDLE_X), patch_of(ground, k, MIDDLE_Y)
            reach = patch_of(ground, k, REACH)
            away, rate, bend = _from(px - mx, py - my, vx, vy, ax, ay)
            sides = _sides(away, rate, bend, reach + radius, abs(reach - radius), close)
            least = min(least, sides)
            if hole > 0.0:
                sides = _sides(away, rate, bend, reach + hole, abs(reach - hole), close)
                least = min(least, sides)
            if turns:
                away, rate, _ = _from(cx - mx, cy - my, ox, oy, 0.0, 0.0)
                least = min(least, _when(away - reach, rate, 0.0, near))
        for n in range(corners):
            one = corner_of(ground, begin + n)
            two = corner_of(ground, begin + (n + 1 if n + 1 < corners else 0))
            away, rate, bend = _from(px - one[0], py - one[1], vx, vy, ax, ay)
            least = min(least, _when(away - radius, rate, bend, near))
            if hole > 0.0:
                least = min(least, _when(away - hole, rate, bend, near))
            ex, ey = two[0] - one[0], two[1] - one[1]
            size = math.sqrt(ex * ex + ey * ey)
            ex, ey = ex / size, ey / size
            gap, rate, bend = (
                ex * (py - one[1]) - ey * (px - one[0]), ex * vy - ey * vx, ex * ay - ey * ax,
            )  # fmt: skip
            t = _sides(gap, rate, bend, radius, -radius, close)
            if hole > 0.0:
                t = min(t, _sides(gap, rate, bend, hole, -hole, close))
            if t < least:
                sx, sy = t * (vx + 0.5 * t * ax), t * (vy + 0.5 * t * ay)
                along = ex * (px + sx - one[0]) + ey * (py + sy - one[1])
                least = t if 0.0 < along < size else least
            if turns:
                gap, rate = ex * (cy - one[1]) - ey * (cx - one[0]), ex * oy - ey * ox
                t = _when(gap, rate, 0.0, near)
                if t < least:
                    along = ex * (cx + t * ox - one[0]) + ey * (cy + t * oy - one[1])
                    least = t if 0.0 < along < size else least
    return (1.0 + _BEYOND) * least + close


@inlined
def _from(
    dx: float, dy: float, vx: float, vy: float, ax: float, ay: float
) -> tuple[float, float, float]:
    """How far a point is from another, the rate of that, and its rate."""
    away = math.sqrt(dx * dx + dy * dy)
    if away == 0.0:
        return 0.0, 0.0, 0.0
    rate = (dx * vx + dy * vy) / away
    return away, rate, (vx * vx + vy * vy + dx * ax + dy * ay - rate * rate) / away
