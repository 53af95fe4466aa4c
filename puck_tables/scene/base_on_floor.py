"""Dry friction of a base on a floor of one friction, or of strips and patches.

They are those of the whole base with the coefficient under its centre of mass, and of every part
with what its own differs by.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import (
    beyond_line,
    in_circle,
    whole_contour,
)
from puck_tables.kernels.base_friction import (
    AREA,
    is_uniform,
    pressure_at,
    pressure_on,
    under_load,
    uniform_sums,
)
from puck_tables.kernels.base_friction import REACH as BASE_REACH
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner, on_demand
from puck_tables.kernels.contour_sums import contour_sums, look_at, whole_sums
from puck_tables.kernels.elliptic_sums import Ellipse, elliptic_sums
from puck_tables.kernels.law_sums import law_sums
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    ANGLE,
    AXES,
    BASE,
    BORDERS,
    CORNER,
    CORNERS,
    LAW,
    LOAD,
    MIDDLE_X,
    MIDDLE_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    ROOM,
    SHARE,
    border_of,
    corner_of,
    load_of,
    patch_of,
    strip_at,
)
from puck_tables.scene.ground import REACH as PATCH_REACH
from puck_tables.scene.patches import distance_to

_TWO_CUTS = 12  # times as many pieces as there were are after two cuts at most


@inner
def _in_polygon(
    ground: FloatArray, base: FloatArray, first: int, count: int, contour: int, last: int,
    ux: float, uy: float, w: float,
) -> Sums:  # fmt: skip
    """Sums over what of a base, whose contour stands in the ground, lies in a patch with corners.

    By convex parts that begin at the first corner, and are added, or taken off where they turn
    back; each is cut out by its edges, as many as there is room for.
    """
    sums, one = NOTHING, int(ground[ROOM])
    half, reach = (len(ground) - one) // 2, base[BASE_REACH]
    ox, oy = _from_base(ground, *corner_of(ground, first))
    ax, ay = _from_base(ground, *corner_of(ground, first + 1))
    k = 1
    while k < count - 1:
        bx, by = _from_base(ground, *corner_of(ground, first + k + 1))
        way, sx, sy = 1.0, ax - ox, ay - oy
        if sx * (by - oy) < sy * (bx - ox):
            way = -1.0
        begin, end, to = _left_of(ground, contour, last, one, one, half, ox, oy, ax, ay, way, reach)
        goes_on = True
        while goes_on:
            begin, end, to = _left_of(
                ground, begin, end, to, one, half, ax, ay, bx, by, way, reach
            )  # fmt: skip
            px, py, ax, ay = ax, ay, bx, by
            k += 1
            goes_on = k < count - 1 and _TWO_CUTS * (end - begin) <= half
            if goes_on:
                bx, by = _from_base(ground, *corner_of(ground, first + k + 1))
                bends = way * ((ax - px) * (by - ay) - (ay - py) * (bx - ax)) > 0.0
                ahead = way * ((ax - ox) * (by - oy) - (ay - oy) * (bx - ox)) > 0.0
                goes_on = bends and ahead and way * (sx * (by - oy) - sy * (bx - ox)) > 0.0
        begin, end, to = _left_of(ground, begin, end, to, one, half, ax, ay, ox, oy, way, reach)
        if end > begin:
            sums = plus(sums, way, contour_sums(base, ground, begin, end, ux, uy, w))
    return sums


@inlined
def _left_of(
    room: FloatArray, first: int, last: int, to: int, one: int, half: int, px: float, py: float,
    qx: float, qy: float, way: float, reach: float,
) -> tuple[int, int, int]:  # fmt: skip
    """Put what of a contour lies to the left of a line at a place, or to its right.

    Where it begins and ends, and the other of two places to work, the next to put it.
    """
    dx, dy = qx - px, qy - py
    per = way / math.sqrt(dx * dx + dy * dy)
    nx, ny = -dy * per, dx * per
    place = nx * px + ny * py
    if place <= -reach or first == last:
        return first, last, to
    end = beyond_line(room, first, last, to, nx, ny, place, math.inf, math.inf)
    return to, end, 2 * one + half - to


@inlined
def _from_base(ground: FloatArray, x: float, y: float) -> tuple[float, float]:
    """A place on the floor in the axes of the base."""
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    x, y = x - ground[PLACE_X], y - ground[PLACE_Y]
    return c * x + s * y, c * y - s * x


@inner
def _in_patch(
    ground: FloatArray, patch: int, contour: int, last: int, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    """Sums over what of a base lies in a patch."""
    base = ground[int(ground[BASE]) :]
    reach, away = base[BASE_REACH], distance_to(ground, patch, ground[PLACE_X], ground[PLACE_Y])
    if away >= reach:
        return NOTHING
    if away <= -reach:
        return whole_sums(base, ux, uy, w)
    corners = int(patch_of(ground, patch, CORNERS))
    if corners > 0:
        first = int(patch_of(ground, patch, CORNER))
        return _in_polygon(ground, base, first, corners, contour, last, ux, uy, w)
    one = int(ground[ROOM])
    mx, my = _from_base(
        ground, patch_of(ground, patch, MIDDLE_X), patch_of(ground, patch, MIDDLE_Y)
    )  # fmt: skip
    end = in_circle(ground, contour, last, one, mx, my, patch_of(ground, patch, PATCH_REACH))
    return contour_sums(base, ground, one, end, ux, uy, w)


@on_demand(*["float64"] * 8)
def friction_sums(ground: FloatArray, ux: float, uy: float, w: float, moving: float) -> Sums:
    """Sums over the base times f N of what is under each part, in the axes of the base.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    first, last = int(ground[LAW]), int(ground[ROOM])
    if first > 0 and last - first == AXES:
        angle = ground[first + 2] - ground[first + 3] * ground[ANGLE]
        law = Ellipse(ground[first], ground[first + 1], math.cos(angle), math.sin(angle))
        sums = elliptic_sums(ground[int(ground[BASE]) : first], law, ux, uy, w)
        return plus(NOTHING, ground[SHARE], sums)
    if moving != 0.0 and first > 0:
        sums = law_sums(
            ground[int(ground[BASE]) : first], ground[first:last], ux, uy, w
        )  # fmt: skip
        return plus(NOTHING, ground[SHARE], sums)
    begin, to = int(ground[BASE]), int(ground[ROOM])
    base = ground[begin:]
    contour, end = whole_contour(base, begin)
    reach, borders = base[BASE_REACH], int(ground[BORDERS])
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * ground[PLACE_X] + north * ground[PLACE_Y]
    nx, ny = c * east + s * north, c * north - s * east
    first, last = 0, borders
    while first < borders and border_of(ground, first) - place <= -reach:
        first += 1
    while last > first and border_of(ground, last - 1) - place >= reach:
        last -= 1
    look_at(base, ux, uy, w)
    sums, whole = NOTHING, load_of(ground, strip_at(ground, ground[PLACE_X], ground[PLACE_Y]))
    if whole != 0.0:
        sums = plus(sums, whole, whole_sums(base, ux, uy, w))
    for i in range(first, last):  # the smaller part of a round base, and from its middle: no noise
        away = border_of(ground, i) - place
        side = 1.0 if away > 0.0 else -1.0
        more = side * (load_of(ground, i + 1) - load_of(ground, i))
        until = beyond_line(
            ground, contour, end, to, side * nx, side * ny, side * away, away * nx, away * ny
        )  # fmt: skip
        sums = plus(sums, more, contour_sums(base, ground, to, until, ux, uy, w))
    for k in range(int(ground[PATCHES])):
        mx, my = patch_of(ground, k, MIDDLE_X), patch_of(ground, k, MIDDLE_Y)
        more = patch_of(ground, k, LOAD) - load_of(ground, strip_at(ground, mx, my))
        sums = plus(sums, more, _in_patch(ground, k, contour, end, ux, uy, w))
    return plus(NOTHING, ground[SHARE], sums)


@inner
def friction_of_base(
    ground: FloatArray, ux: float, uy: float, w: float, moving: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor, not all 0.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    base = ground[int(ground[BASE]) :]
    one = ground[BORDERS] == 0.0 and ground[PATCHES] == 0.0 and ground[LAW] == 0.0
    if one and is_uniform(base):
        x, y, turning = uniform_sums(base, c * ux + s * uy, c * uy - s * ux, w)
        mean = ground[SHARE] * load_of(ground, 0) / base[AREA]
        fx, fy, torque = mean * (c * x - s * y), mean * (s * x + c * y), mean * turning
        return -fx, -fy, -torque, fx * ux + fy * uy + torque * w
    sums = friction_sums(ground, c * ux + s * uy, c * uy - s * ux, w, moving)
    a, bx, by = pressure_on(base, sums)
    x, y, torque = under_load(sums, a, bx, by)
    fx, fy = c * x - s * y, s * x + c * y
    return -fx, -fy, -torque, fx * ux + fy * uy + torque * w


@inner
def friction_held(
    ground: FloatArray, ux: float, uy: float, w: float, mx: float, my: float
) -> tuple[float, float, float]:
    """∫ f p e dA and its moment, of the pressure that carries a moment (mx, my) of the load, m."""
    base = ground[int(ground[BASE]) :]
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    sums = friction_sums(ground, c * ux + s * uy, c * uy - s * ux, w, 0.0)
    a, bx, by = pressure_at(base, c * mx + s * my, c * my - s * mx)
    x, y, torque = under_load(sums, a, bx, by)
    return c * x - s * y, s * x + c * y, torque
