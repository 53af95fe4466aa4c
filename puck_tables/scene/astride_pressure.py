"""Sums under a base on several frictions by its law of pressure.

Uniform, Hertz's, Galin's and that of a ring are summed as they are.  A tabulated one is a pile of
discs: with W(ρ) the pressure over its mean and D(a) the sums over the disc of radius a, times f N,
those under the base are (1/π) times

    W(1) D(1) − W(ρ₀) D(ρ₀) − ∫ W'(a) D(a) da , tabulated from ρ₀ on.

D is that of the whole disc, times f N at the centre of rotation C, and a rest.  The whole is like
(a − c)² ln|a − c| where the circle passes C, the rest like powers and a half where it touches a
border or passes a corner, and next to singular where it passes what of a border is close to C.
Between these radii both are polynomials in u with 3u² − 2u³ the place in between, known at Gauss's
nodes; W' times those is integrated exactly, whatever number of rows W has.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_parts import disc_sums, turn_between
from puck_tables.kernels.base_sums import NOTHING, RING, TABLE, UNIFORM, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.astride_parts import Slip, weighted
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    BORDERS,
    CORNER,
    CORNERS,
    INNER,
    LOAD,
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
    WEIGHTS,
    border_of,
    corner_of,
    load_of,
    patch_of,
    strip_at,
)

_FAR = 4.0  # radii: a centre of rotation farther away is none
_CLOSE = 0.5  # radii: a border farther from the centre of rotation does not show it
_SMOOTH, _BENT = 18, 36  # nodes; where W bends, all that they know counts
_T, _BY_T = (np.concatenate(both) for both in zip(
    np.polynomial.legendre.leggauss(_SMOOTH), np.polynomial.legendre.leggauss(_BENT), strict=True
))  # fmt: skip
_U = 0.5 + 0.5 * _T
_PLACE = _U * _U * (3.0 - 2.0 * _U)
_SHARE = 3.0 * _BY_T * _U * (1.0 - _U)
_INVERSE = 1.0 / np.arange(1.0, _BENT + 2.0)
_LEGENDRE = np.polynomial.legendre.legvander(_T[_SMOOTH:], _BENT - 1)


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
def _put_near(ground: FloatArray, count: int, ax: float, ay: float, cx: float, cy: float) -> int:
    """Put how far a point of a border is, if it is close to C."""
    off_x, off_y = ax - cx, ay - cy
    if off_x * off_x + off_y * off_y < _CLOSE * _CLOSE:
        return _put(ground, count, math.sqrt(ax * ax + ay * ay))
    return count


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
        count = _put_near(ground, count, ax + share * bx, ay + share * by, cx, cy)
    return count


@inner
def _radii(ground: FloatArray, radius: float, cx: float, cy: float) -> tuple[int, float]:
    """Into their room the radii between 0 and 1 where the rest is not smooth; how many; f N at C.

    Of a C that is not under the base, that under its centre.  (cx, cy): C from there, in radii.
    """
    x, y, count = ground[PLACE_X], ground[PLACE_Y], 0
    within = 1.0 if cx * cx + cy * cy < 1.0 else 0.0
    strip = strip_at(ground, x + within * radius * cx, y + within * radius * cy)
    load = load_of(ground, strip)
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * x + north * y
    for i in range(int(ground[BORDERS])):
        away = (border_of(ground, i) - place) / radius
        if abs(away) < 1.0:
            count = _put(ground, count, abs(away))
            more = away - (east * cx + north * cy)
            count = _put_near(ground, count, cx + more * east, cy + more * north, cx, cy)
    for k in range(int(ground[PATCHES])):
        mx = (patch_of(ground, k, MIDDLE_X) - x) / radius
        my = (patch_of(ground, k, MIDDLE_Y) - y) / radius
        apart, reach = math.sqrt(mx * mx + my * my), patch_of(ground, k, REACH) / radius
        first, corners = int(patch_of(ground, k, CORNER)), int(patch_of(ground, k, CORNERS))
        if apart >= reach + 1.0:
            continue
        to_c, turns = math.hypot(cx - mx, cy - my), 0.0
        if corners == 0:
            count = _put(ground, count, abs(apart - reach))
            count = _put(ground, count, apart + reach)
            if to_c > 0.0:
                share = reach / to_c
                ax, ay = mx + share * (cx - mx), my + share * (cy - my)
                count = _put_near(ground, count, ax, ay, cx, cy)
        for n in range(corners):
            one = corner_of(ground, first + n)
            two = corner_of(ground, first + (n + 1 if n + 1 < corners else 0))
            ax, ay = (one[0] - x) / radius, (one[1] - y) / radius
            bx, by = (two[0] - one[0]) / radius, (two[1] - one[1]) / radius
            count = _put(ground, count, math.sqrt(ax * ax + ay * ay))
            count = _put_line(ground, count, ax, ay, bx, by, cx, cy)
            turns += turn_between(ax - cx, ay - cy, ax + bx - cx, ay + by - cy)
        if within > 0.0 and (turns > math.pi or (corners == 0 and to_c < reach)):
            load = patch_of(ground, k, LOAD)
    return count, load


@inlined
def _slope(ground: FloatArray, row: int) -> float:
    here = int(ground[PROFILE]) + 2 * row
    return (ground[here + 3] - ground[here + 1]) / (ground[here + 2] - ground[here])


@inner
def _weights(ground: FloatArray, row: int, low: float, high: float) -> tuple[int, int, int]:
    """Into their room the weights of ∫ W' D da from one radius to another.

    The first node and how many, and the row at the end.  Legendre's polynomials P_k times a W' that
    jumps give P_{k+1} − P_{k−1} where it does.
    """
    at, last, room = int(ground[PROFILE]), int(ground[ROWS]) - 2, int(ground[WEIGHTS])
    while row < last and ground[at + 2 * row + 2] <= low:
        row += 1
    length, slope = high - low, _slope(ground, row)
    if row == last or ground[at + 2 * row + 2] >= high:
        for i in range(_SMOOTH):
            ground[room + i] = length * slope * _SHARE[i]
        return 0, _SMOOTH, row
    sums = room + _BENT
    for k in range(_BENT + 1):
        ground[sums + k] = 0.0
    while row < last and ground[at + 2 * row + 2] < high:
        row += 1
        after = _slope(ground, row)
        before, here, slope = 0.0, after - slope, after
        t = -2.0 * math.sin(math.asin(1.0 - 2.0 * (ground[at + 2 * row] - low) / length) / 3.0)
        for k in range(_BENT + 1):
            ground[sums + k] += here
            before, here = here, ((2 * k + 1) * t * here - k * before) * _INVERSE[k]
    for i in range(_BENT):
        weight = slope - 0.5 * (ground[sums] + ground[sums + 1])
        for k in range(1, _BENT):
            weight -= 0.5 * (ground[sums + k + 1] - ground[sums + k - 1]) * _LEGENDRE[i, k]
        ground[room + i] = length * weight * _SHARE[_SMOOTH + i]
    return _SMOOTH, _BENT, row


@inner
def _tabulated(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """A tabulated law, straight between its radii."""
    at, last, weights = int(ground[PROFILE]), int(ground[ROWS]) - 1, int(ground[WEIGHTS])
    sums = weighted(ground, radius, slip, mirrored, 1.0, UNIFORM, 0.0)
    sums = plus(NOTHING, ground[at + 2 * last + 1], sums)
    begin = ground[at]
    if begin > 0.0:
        hole = weighted(ground, radius, slip, mirrored, begin, UNIFORM, 0.0)
        sums = plus(sums, -ground[at + 1], hole)
    c = slip.along / slip.turning if slip.along < _FAR * slip.turning else _FAR
    count, load = _radii(ground, radius, -mirrored * c * slip.sine, mirrored * c * slip.cosine)
    low, row = begin, 0
    for n in range(2):
        high = min(max(c, begin), 1.0) if n == 0 else 1.0
        if high > low:
            first, nodes, row = _weights(ground, row, low, high)
            for i in range(nodes):
                a = low + (high - low) * _PLACE[first + i]
                more = disc_sums(slip.along, slip.turning, a)
                sums = plus(sums, -load * ground[weights + i], more)
            low = high
    low, row = begin, 0
    for n in range(count + 1):
        high = ground[int(ground[RADII]) + n] if n < count else 1.0
        if not high > low:
            continue
        first, nodes, row = _weights(ground, row, low, high)
        for i in range(nodes):
            a = low + (high - low) * _PLACE[first + i]
            more = weighted(ground, radius, slip, mirrored, a, UNIFORM, load)
            sums = plus(sums, -ground[weights + i], more)
        low = high
    return sums


@inner
def sums_under(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """(1/A) ∫ W f N over the base, of what :mod:`puck_tables.kernels.base_boundary` sums."""
    law, share = int(ground[PRESSURE]), ground[SHARE] / math.pi
    if law == TABLE:
        return plus(NOTHING, share, _tabulated(ground, radius, slip, mirrored))
    if law == RING:
        share *= 0.5
    hole = ground[INNER]
    share /= 1.0 - hole * hole
    sums = plus(NOTHING, share, weighted(ground, radius, slip, mirrored, 1.0, law, 0.0))
    if hole > 0.0:
        sums = plus(sums, -share, weighted(ground, radius, slip, mirrored, hole, UNIFORM, 0.0))
    return sums
