"""Sums under a base on several frictions by its law of pressure.

Uniform, Hertz's, Galin's and that of a ring are summed as they are.  A tabulated one is a pile of
discs: with W(ρ) the pressure over its mean and D(a) the sums over the disc of radius a, times f N,
those under the base are (1/π) times

    W(1) D(1) − W(ρ₀) D(ρ₀) − ∫ W'(a) D(a) da , tabulated from ρ₀ on.

D is analytic in a but where the circle touches a border, passes a corner or the centre of rotation:
like powers and a half, or logarithms.  Between these radii it is Gauss's rule in a variable that
goes slowly at both ends.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_parts import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.load_parts import RING, TABLE, UNIFORM
from puck_tables.scene.astride_parts import Slip, weighted
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
    PLACE_X,
    PLACE_Y,
    PRESSURE,
    PROFILE,
    RADII,
    REACH,
    ROWS,
    SHARE,
    border_of,
    corner_of,
    patch_of,
)

_GROWTH = 2.5  # of a part, over how far the next radius is from its near end
_FAR = 4.0  # radii: a centre of rotation farther away is none
_LEAST = 1e-5  # of the length between two radii: nearer ones beyond them count as one
# Gauss's rule on [0, 1] in u with x = u³ (10 − 15 u + 6 u²): ends like √x do not harm it
_NODES = 24
_U, _BY_U = (0.5 * side for side in np.polynomial.legendre.leggauss(_NODES))
_U = 0.5 + _U
_PLACE = _U**3 * (10.0 + _U * (6.0 * _U - 15.0))
_SHARE = _BY_U * 30.0 * (_U * (1.0 - _U)) ** 2


@inlined
def _put(ground: FloatArray, count: int, value: float) -> int:
    """Put a radius between 0 and 1 among those in their room, ascending; how many there are."""
    if not 0.0 < value < 1.0:
        return count
    first = int(ground[RADII])
    n = first + count
    while n > first and ground[n - 1] > value:
        ground[n] = ground[n - 1]
        n -= 1
    ground[n] = value
    return count + 1


@inlined
def _put_line(
    ground: FloatArray, count: int, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> int:
    """Put how far a piece of a line from (ax, ay) along (bx, by) is, and its point next to C."""
    square = bx * bx + by * by
    if 0.0 < -(ax * bx + ay * by) < square:
        count = _put(ground, count, abs(ax * by - ay * bx) / math.sqrt(square))
    share = ((cx - ax) * bx + (cy - ay) * by) / square
    if 0.0 < share < 1.0:
        count = _put(ground, count, math.hypot(ax + share * bx, ay + share * by))
    return count


@inner
def _radii(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> int:
    """Into their room the radii between 0 and 1 at which D(a) is not analytic; how many.

    Also those at which the border on a circle passes closest to the centre of rotation, C.
    """
    x, y, count, c = ground[PLACE_X], ground[PLACE_Y], 0, _FAR
    if slip.along < _FAR * slip.turning:
        c = slip.along / slip.turning
        count = _put(ground, count, c)
    cx, cy = -mirrored * c * slip.sine, mirrored * c * slip.cosine
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * x + north * y
    for i in range(int(ground[BORDERS])):
        away = (border_of(ground, i) - place) / radius
        ax, ay = away * east + _FAR * north, away * north - _FAR * east
        if abs(away) < 1.0:
            count = _put_line(
                ground, count, ax, ay, -2.0 * _FAR * north, 2.0 * _FAR * east, cx, cy
            )  # fmt: skip
    for k in range(int(ground[PATCHES])):
        mx = (patch_of(ground, k, MIDDLE_X) - x) / radius
        my = (patch_of(ground, k, MIDDLE_Y) - y) / radius
        apart, reach = math.sqrt(mx * mx + my * my), patch_of(ground, k, REACH) / radius
        first, corners = int(patch_of(ground, k, CORNER)), int(patch_of(ground, k, CORNERS))
        if apart >= reach + 1.0:
            continue
        if corners == 0:
            count = _put(ground, count, abs(apart - reach))
            count = _put(ground, count, apart + reach)
            to_c = math.hypot(cx - mx, cy - my)
            if to_c > 0.0:
                share = reach / to_c
                near = math.hypot(mx + share * (cx - mx), my + share * (cy - my))
                count = _put(ground, count, near)
        for n in range(corners):
            one = corner_of(ground, first + n)
            two = corner_of(ground, first + (n + 1 if n + 1 < corners else 0))
            ax, ay = (one[0] - x) / radius, (one[1] - y) / radius
            bx, by = (two[0] - one[0]) / radius, (two[1] - one[1]) / radius
            count = _put(ground, count, math.sqrt(ax * ax + ay * ay))
            count = _put_line(ground, count, ax, ay, bx, by, cx, cy)
    first = int(ground[PROFILE])
    for n in range(int(ground[ROWS])):
        count = _put(ground, count, ground[first + 2 * n])
    return count


@inner
def _part(
    ground: FloatArray, radius: float, slip: Slip, mirrored: float, low: float, high: float
) -> Sums:
    """∫ D da over a part that is smooth within."""
    sums, length = NOTHING, high - low
    for i in range(_NODES):
        more = weighted(ground, radius, slip, mirrored, low + length * _PLACE[i], UNIFORM)
        sums = plus(sums, length * _SHARE[i], more)
    return sums


@inner
def _graded(
    ground: FloatArray, radius: float, slip: Slip, mirrored: float, low: float, high: float,
    left: float, right: float,
) -> Sums:  # fmt: skip
    """The same, of parts that grow away from both ends: beyond them the next ones are near."""
    length = high - low
    if _GROWTH * min(left, right) >= length:
        return _part(ground, radius, slip, mirrored, low, high)
    sums, half = NOTHING, 0.5 * length
    for side in range(2):
        gap, near = max(left if side == 0 else right, _LEAST * length), 0.0
        while near < half:
            far = near + _GROWTH * (gap + near)
            far = half if far > 0.8 * half else far
            if side == 0:
                more = _part(ground, radius, slip, mirrored, low + near, low + far)
            else:
                more = _part(ground, radius, slip, mirrored, high - far, high - near)
            sums, near = plus(sums, 1.0, more), far
    return sums


@inner
def _tabulated(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """A tabulated law, straight between its radii."""
    count, room = _radii(ground, radius, slip, mirrored), int(ground[RADII])
    at, last = int(ground[PROFILE]), int(ground[ROWS]) - 1
    sums = weighted(ground, radius, slip, mirrored, 1.0, UNIFORM)
    sums = plus(NOTHING, ground[at + 2 * last + 1], sums)
    if ground[at] > 0.0:
        hole = weighted(ground, radius, slip, mirrored, ground[at], UNIFORM)
        sums = plus(sums, -ground[at + 1], hole)
    low, left, row = ground[at], max(ground[at], 1e-3), 0
    for n in range(count + 1):
        high = ground[room + n] if n < count else 1.0
        if not high > low:
            continue
        right = 1.0
        if n < count:
            right = (ground[room + n + 1] if n + 1 < count else 1.0) - high
        while row < last - 1 and ground[at + 2 * row + 2] <= low:
            row += 1
        here = at + 2 * row
        slope = (ground[here + 3] - ground[here + 1]) / (ground[here + 2] - ground[here])
        if slope != 0.0:
            more = _graded(ground, radius, slip, mirrored, low, high, left, right)
            sums = plus(sums, -slope, more)
        left, low = high - low, high
    return sums


@inner
def sums_under(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """(1/A) ∫ W f N over the base, of what :mod:`puck_tables.kernels.base_parts` sums."""
    law, share = int(ground[PRESSURE]), ground[SHARE] / math.pi
    if law == TABLE:
        return plus(NOTHING, share, _tabulated(ground, radius, slip, mirrored))
    if law == RING:
        share *= 0.5
    hole = ground[INNER]
    share /= 1.0 - hole * hole
    sums = plus(NOTHING, share, weighted(ground, radius, slip, mirrored, 1.0, law))
    if hole > 0.0:
        sums = plus(sums, -share, weighted(ground, radius, slip, mirrored, hole, UNIFORM))
    return sums
