"""Dry friction of a base on a floor of one friction, or of strips and patches.

It is that of the whole base with the friction under its centre of mass, and of every part with what
its own differs by: a number, or a law over the slip speed or the direction, of which none or both
are summed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import beyond_line, in_circle
from puck_tables.kernels.base_friction import HEAD
from puck_tables.kernels.base_friction import REACH as BASE_REACH
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner, on_demand
from puck_tables.kernels.contour_sums import contour_sums, look_at, whole_sums
from puck_tables.kernels.elliptic_sums import elliptic_sums
from puck_tables.kernels.law_sums import coefficient_at_rest, law_sums
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    AXES,
    BASE,
    BORDERS,
    CORNER,
    CORNERS,
    COSINE,
    MIDDLE_X,
    MIDDLE_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    ROOM,
    SHARE,
    SINE,
    border_of,
    corner_of,
    distance_to,
    ellipse_on,
    law_on,
    patch_of,
    strip_at,
    summed_load,
)
from puck_tables.scene.floor_map import REACH as PATCH_REACH

_TWO_EDGES = 12  # times as many pieces as there were are after two cuts at most
_NONE = -1  # no stretch


class _Slip(NamedTuple):
    """A velocity over the floor in the axes of the base; ``moving`` 0: friction at slip zero."""

    x: float
    y: float
    spin: float
    moving: float


@inner
def _with(
    floor_map: FloatArray, sums: Sums, load: float, law: int, first: int, last: int, slip: _Slip
) -> Sums:  # fmt: skip
    """Sums, and those over a contour with a load by a law, see :func:`law_on`."""
    if load == 0.0 or first == last:
        return sums
    base = floor_map[int(floor_map[BASE]) :]
    if law > 0:
        axes, by_speed = ellipse_on(floor_map, law), floor_map[law + AXES :]
        if by_speed[0] > 0.0 and slip.moving != 0.0:
            more = law_sums(
                floor_map, first, last, base[BASE_REACH], by_speed, axes, slip.x, slip.y, slip.spin
            )  # fmt: skip
            return plus(sums, load, more)
        if by_speed[0] > 0.0:
            load *= coefficient_at_rest(by_speed)
        if axes.along != axes.across:
            more = elliptic_sums(
                floor_map, first, last, base[BASE_REACH], axes, slip.x, slip.y, slip.spin
            )  # fmt: skip
            return plus(sums, load, more)
        load *= axes.along
    if first == int(floor_map[BASE]) + HEAD:  # all of it
        return plus(sums, load, whole_sums(base, slip.x, slip.y, slip.spin))
    return plus(sums, load, contour_sums(base, floor_map, first, last, slip.x, slip.y, slip.spin))


@inner
def _exchanged(
    floor_map: FloatArray, sums: Sums, weight: float, part: int, other: int, first: int, last: int,
    slip: _Slip,
) -> Sums:  # fmt: skip
    """Sums, and so many times those over a contour with a stretch in place of another, or none."""
    law, gain = law_on(floor_map, part), weight * summed_load(floor_map, part)
    if other != _NONE:
        before, loss = law_on(floor_map, other), weight * summed_load(floor_map, other)
        if before == law:
            gain -= loss
        else:
            sums = _with(floor_map, sums, -loss, before, first, last, slip)
    return _with(floor_map, sums, gain, law, first, last, slip)


@inner
def _in_polygon(
    floor_map: FloatArray, sums: Sums, part: int, other: int, first: int, count: int, contour: int,
    last: int, slip: _Slip,
) -> Sums:  # fmt: skip
    """Sums, and those over what of a base, whose contour stands there, lies in corners.

    By convex parts that begin at the first corner, and are added, or taken off where they turn
    back; each is cut out by its edges, as many as there is room for.
    """
    one = int(floor_map[ROOM])
    half, reach = (len(floor_map) - one) // 2, floor_map[int(floor_map[BASE]) + BASE_REACH]
    ox, oy = _from_base(floor_map, *corner_of(floor_map, first))
    ax, ay = _from_base(floor_map, *corner_of(floor_map, first + 1))
    k = 1
    while k < count - 1:
        bx, by = _from_base(floor_map, *corner_of(floor_map, first + k + 1))
        sense, sx, sy = 1.0, ax - ox, ay - oy
        if sx * (by - oy) < sy * (bx - ox):
            sense = -1.0
        begin, end, to = _left_of(
            floor_map, contour, last, one, one, half, ox, oy, ax, ay, sense, reach
        )
        goes_on = True
        while goes_on:
            begin, end, to = _left_of(
                floor_map, begin, end, to, one, half, ax, ay, bx, by, sense, reach
            )  # fmt: skip
            px, py, ax, ay = ax, ay, bx, by
            k += 1
            goes_on = k < count - 1 and _TWO_EDGES * (end - begin) <= half
            if goes_on:
                bx, by = _from_base(floor_map, *corner_of(floor_map, first + k + 1))
                turns_left = sense * ((ax - px) * (by - ay) - (ay - py) * (bx - ax)) > 0.0
                ahead = sense * ((ax - ox) * (by - oy) - (ay - oy) * (bx - ox)) > 0.0
                goes_on = turns_left and ahead and sense * (sx * (by - oy) - sy * (bx - ox)) > 0.0
        begin, end, to = _left_of(
            floor_map, begin, end, to, one, half, ax, ay, ox, oy, sense, reach
        )
        sums = _exchanged(floor_map, sums, sense, part, other, begin, end, slip)
    return sums


@inlined
def _left_of(
    room: FloatArray, first: int, last: int, to: int, one: int, half: int, px: float, py: float,
    qx: float, qy: float, direction: float, reach: float,
) -> tuple[int, int, int]:  # fmt: skip
    """Put what of a contour lies to the left of a line at a place, or to its right.

    Where it begins and ends, and the other of two places to work, the next to put it.
    """
    dx, dy = qx - px, qy - py
    per = direction / math.sqrt(dx * dx + dy * dy)
    nx, ny = -dy * per, dx * per
    place = nx * px + ny * py
    if place <= -reach or first == last:
        return first, last, to
    end = beyond_line(room, first, last, to, nx, ny, place, math.inf, math.inf)
    return to, end, 2 * one + half - to


@inlined
def _from_base(floor_map: FloatArray, x: float, y: float) -> tuple[float, float]:
    """A place on the floor in the axes of the base."""
    c, s = floor_map[COSINE], floor_map[SINE]
    x, y = x - floor_map[PLACE_X], y - floor_map[PLACE_Y]
    return c * x + s * y, c * y - s * x


@inner
def _in_patch(
    floor_map: FloatArray, sums: Sums, patch: int, contour: int, last: int, slip: _Slip
) -> Sums:  # fmt: skip
    """Sums, and those over what of a base lies in a patch, in place of what is around that."""
    x, y = floor_map[PLACE_X], floor_map[PLACE_Y]
    reach, away = floor_map[int(floor_map[BASE]) + BASE_REACH], distance_to(floor_map, patch, x, y)
    if away >= reach:
        return sums
    middle_x = patch_of(floor_map, patch, MIDDLE_X)
    middle_y = patch_of(floor_map, patch, MIDDLE_Y)
    part, other = int(floor_map[BORDERS]) + 1 + patch, strip_at(floor_map, middle_x, middle_y)
    if away <= -reach:
        return _exchanged(floor_map, sums, 1.0, part, other, contour, last, slip)
    corners = int(patch_of(floor_map, patch, CORNERS))
    if corners > 0:
        first = int(patch_of(floor_map, patch, CORNER))
        return _in_polygon(
            floor_map, sums, part, other, first, corners, contour, last, slip
        )  # fmt: skip
    one = int(floor_map[ROOM])
    mx, my = _from_base(floor_map, middle_x, middle_y)
    end = in_circle(floor_map, contour, last, one, mx, my, patch_of(floor_map, patch, PATCH_REACH))
    return _exchanged(floor_map, sums, 1.0, part, other, one, end, slip)


@on_demand(*["float64"] * 8)
def friction_sums(
    floor_map: FloatArray, contour: int, end: int, ux: float, uy: float, w: float, moving: float
) -> Sums:  # fmt: skip
    """Sums over a contour of the base times f N of what is under each part, in its axes.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    base, to = floor_map[int(floor_map[BASE]) :], int(floor_map[ROOM])
    reach, borders = base[BASE_REACH], int(floor_map[BORDERS])
    c, s = floor_map[COSINE], floor_map[SINE]
    east, north = floor_map[ACROSS_X], floor_map[ACROSS_Y]
    place = east * floor_map[PLACE_X] + north * floor_map[PLACE_Y]
    nx, ny = c * east + s * north, c * north - s * east
    first, last = 0, borders
    while first < borders and border_of(floor_map, first) - place <= -reach:
        first += 1
    while last > first and border_of(floor_map, last - 1) - place >= reach:
        last -= 1
    look_at(base, ux, uy, w)
    slip = _Slip(ux, uy, w, moving)
    under = strip_at(floor_map, floor_map[PLACE_X], floor_map[PLACE_Y])
    sums = _exchanged(floor_map, NOTHING, 1.0, under, _NONE, contour, end, slip)
    for i in range(first, last):  # the smaller part of a round base, and from its middle: no noise
        away = border_of(floor_map, i) - place
        beyond = away > 0.0
        side = 1.0 if beyond else -1.0
        until = beyond_line(
            floor_map, contour, end, to, side * nx, side * ny, side * away, away * nx, away * ny
        )  # fmt: skip
        part, other = (i + 1, i) if beyond else (i, i + 1)
        sums = _exchanged(floor_map, sums, 1.0, part, other, to, until, slip)
    for k in range(int(floor_map[PATCHES])):
        sums = _in_patch(floor_map, sums, k, contour, end, slip)
    return plus(NOTHING, floor_map[SHARE], sums)
