"""Dry friction of a base of any shape on a floor of one friction, by law or not, or of strips.

What of the base lies beyond a border is bounded by its own contour there and by pieces of the
border.  The sums along such a piece are those from one point of the border, the foot, to one end of
it less those to the other: so every place where the contour crosses the border adds a side from the
foot to it, or back, and nothing has to be put in order.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import (
    AREA,
    DISC_COLUMNS,
    DISCS,
    HEAD,
    SIDES,
    base_sums,
    disc_at,
    is_uniform,
    pressure_at,
    pressure_on,
    under_load,
    uniform_sums,
)
from puck_tables.kernels.base_friction import REACH as BASE_REACH
from puck_tables.kernels.base_parts import beyond_sums
from puck_tables.kernels.base_sums import (
    NOTHING,
    UNIFORM,
    Sums,
    from_slip,
    moved,
    plus,
    scaled,
)
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.law_sums import law_sums
from puck_tables.kernels.polygon_sums import (
    ANEW,
    BEGIN_X,
    BEGIN_Y,
    LENGTH,
    SIDE_COLUMNS,
    TANGENT_X,
    TANGENT_Y,
    polygon_sums,
)
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    ANGLE,
    BORDERS,
    PLACE_X,
    PLACE_Y,
    PROFILE,
    ROOM,
    ROWS,
    SHARE,
    border_of,
    load_of,
)


@inlined
def _side(room: FloatArray, count: int, px: float, py: float, qx: float, qy: float) -> int:
    """Add a side from p to q; how many there are then."""
    tx, ty = qx - px, qy - py
    length = math.sqrt(tx * tx + ty * ty)
    if not length > 0.0:
        return count
    at = SIDE_COLUMNS * count
    room[at + BEGIN_X], room[at + BEGIN_Y], room[at + ANEW] = px, py, 1.0
    room[at + TANGENT_X], room[at + TANGENT_Y], room[at + LENGTH] = tx / length, ty / length, length
    return count + 1


@inlined
def _sides_beyond(
    base: FloatArray, room: FloatArray, nx: float, ny: float, place: float
) -> int:  # fmt: skip
    """The sides of the polygons of a base beyond the line n·x = place, closed along it."""
    fx, fy, count, first = place * nx, place * ny, 0, HEAD
    last = HEAD + SIDE_COLUMNS * int(base[SIDES])
    for i in range(HEAD, last, SIDE_COLUMNS):
        if base[i + ANEW] != 0.0:
            first = i
        after = i + SIDE_COLUMNS
        if after == last or base[after + ANEW] != 0.0:
            after = first
        px, py, qx, qy = base[i], base[i + 1], base[after], base[after + 1]
        one, two = nx * px + ny * py - place, nx * qx + ny * qy - place
        if one >= 0.0 and two >= 0.0:
            count = _side(room, count, px, py, qx, qy)
        elif one >= 0.0 or two >= 0.0:
            share = one / (one - two)
            x, y = px + share * (qx - px), py + share * (qy - py)
            if one >= 0.0:
                count = _side(room, count, px, py, x, y)
                count = _side(room, count, x, y, fx, fy)
            else:
                count = _side(room, count, fx, fy, x, y)
                count = _side(room, count, x, y, qx, qy)
    return count


@inlined
def _disc_beyond(
    cx: float, cy: float, size: float, nx: float, ny: float, place: float, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    """Sums over what of a disc about (cx, cy) lies beyond the line n·x = place."""
    away = (place - (nx * cx + ny * cy)) / size
    if away >= 1.0:
        return NOTHING
    whole = disc_at(cx, cy, size, ux, uy, w) if away < 0.0 else NOTHING
    if away <= -1.0:
        return whole
    # in radii about its own middle, by axes along the slip there, in which the spin is not negative
    sense = 1.0 if away >= 0.0 else -1.0
    ux, uy, mirrored = ux - w * cy, uy + w * cx, -1.0 if w < 0.0 else 1.0
    speed = math.sqrt(ux * ux + uy * uy)
    c, s = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    tx, ty = sense * (c * nx + s * ny), sense * mirrored * (c * ny - s * nx)
    part = beyond_sums(speed, size * abs(w), 1.0, tx, ty, sense * away, UNIFORM)
    part = moved(from_slip(scaled(part, size), c, s, mirrored), cx, cy)
    return plus(whole, sense, part)


@inner
def _beyond(
    base: FloatArray, room: FloatArray, nx: float, ny: float, place: float, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    """Sums over what of a base lies beyond the line n·x = place, all in its axes."""
    count, sums = _sides_beyond(base, room, nx, ny, place), NOTHING
    if count > 0:
        sums = polygon_sums(room, 0, count, base[BASE_REACH], ux, uy, w)
    discs = HEAD + SIDE_COLUMNS * int(base[SIDES])
    for k in range(int(base[DISCS])):
        at = discs + DISC_COLUMNS * k
        part = _disc_beyond(base[at], base[at + 1], base[at + 2], nx, ny, place, ux, uy, w)
        sums = plus(sums, base[at + 3], part)
    return sums


@inner
def friction_sums(ground: FloatArray, ux: float, uy: float, w: float, moving: float) -> Sums:
    """Sums over the base times f N of what is under each part, in the axes of the base.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    if moving != 0.0 and ground[ROWS] > 0.0:
        first = int(ground[ROWS])
        law = ground[first : int(ground[ROOM])]
        return plus(
            NOTHING, ground[SHARE], law_sums(ground[int(ground[PROFILE]) : first], law, ux, uy, w)
        )
    base, room = ground[int(ground[PROFILE]) :], ground[int(ground[ROOM]) :]
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
    sums, whole = NOTHING, load_of(ground, first)
    if whole != 0.0:
        sums = plus(sums, whole, base_sums(base, ux, uy, w))
    for i in range(first, last):
        more = load_of(ground, i + 1) - load_of(ground, i)
        part = _beyond(base, room, nx, ny, border_of(ground, i) - place, ux, uy, w)
        sums = plus(sums, more, part)
    return plus(NOTHING, ground[SHARE], sums)


@inner
def friction_of_base(
    ground: FloatArray, ux: float, uy: float, w: float, moving: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor, not all 0.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    base = ground[int(ground[PROFILE]) :]
    if ground[BORDERS] == 0.0 and ground[ROWS] == 0.0 and is_uniform(base):
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
    base = ground[int(ground[PROFILE]) :]
    c, s = math.cos(ground[ANGLE]), math.sin(ground[ANGLE])
    sums = friction_sums(ground, c * ux + s * uy, c * uy - s * ux, w, 0.0)
    a, bx, by = pressure_at(base, c * mx + s * my, c * my - s * mx)
    x, y, torque = under_load(sums, a, bx, by)
    return c * x - s * y, s * x + c * y, torque
