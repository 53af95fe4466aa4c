"""Sums of the slip direction under a base on several frictions, under a tabulated pressure.

Of the whole base they are those of :mod:`puck_tables.kernels.cone_sums`, of a part what its borders
say (:mod:`puck_tables.kernels.profile_border`) and, where it holds a stretch of the ray from the
centre of the base through C, what lies under the circles about the centre through that stretch.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.cone_sums import Four, pile_up, piled
from puck_tables.kernels.elementary import angle_of
from puck_tables.kernels.profile_border import Border, border_sums
from puck_tables.scene.astride_parts import Slip
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    BORDERS,
    CORNER,
    CORNERS,
    LOAD,
    MIDDLE_X,
    MIDDLE_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    PROFILE,
    REACH,
    ROOM,
    ROWS,
    border_of,
    corner_of,
    load_of,
    patch_of,
    strip_at,
)


@inlined
def _with_whole(sums: Sums, weight: float, four: Four) -> Sums:
    """Sums and so many times those of whole circles."""
    return (
        sums[0] + weight * four[0], sums[1], sums[2], sums[3] + weight * four[1],
        sums[4] + weight * four[2], sums[5], sums[6], sums[7] + weight * four[3],
    )  # fmt: skip


@inner
def _line(ground: FloatArray, slip: Slip, px: float, py: float, qx: float, qy: float) -> Sums:
    """A straight border from p to q, what is to its left, and beyond it on the ray through C."""
    count, profile, room = int(ground[ROWS]), int(ground[PROFILE]), int(ground[ROOM])
    rows, piles, rest = ground[profile:room], ground[room:], ground[room + 8 * count :]
    alpha, beta = slip.along, slip.turning
    dx, dy = qx - px, qy - py
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return NOTHING
    tx, ty = dx / length, dy / length
    off, begin = px * ty - py * tx, px * tx + py * ty
    end, half = begin + length, math.sqrt(max((1.0 - off) * (1.0 + off), 0.0))
    low, high = max(begin, -half), min(end, half)
    first, second = -1.0 if px < 0.0 else 1.0, -1.0 if qx < 0.0 else 1.0
    sums, split, above = NOTHING, high, 0.0
    if first != second:
        share = -px / dx
        above = py + share * dy
        split = begin + share * length if above > 0.0 else high
        if above <= 0.0:  # it passes below, and is above on one side at most
            first = first if py > qy else second
    if above > 0.0:
        sums = _with_whole(sums, first, piled(rows, piles, count, alpha, beta, min(above, 1.0)))
    if low < high:
        split = min(max(split, low), high)
        border = Border(off * ty, -off * tx, tx, ty, 0.0, low, high, split, high, first, second)
        sums = plus(sums, 1.0, border_sums(rows, rest, count, alpha, beta, border))
    return sums


@inner
def _beyond(
    ground: FloatArray, slip: Slip, nx: float, ny: float, place: float, whole: Four
) -> Sums:
    """What lies beyond the line n·x = place ≥ 0."""
    half = math.sqrt((1.0 - place) * (1.0 + place))
    mx, my, along_x, along_y = place * nx, place * ny, half * ny, -half * nx
    px, py, qx, qy = mx - along_x, my - along_y, mx + along_x, my + along_y
    sums = _line(ground, slip, px, py, qx, qy)
    # the rim beyond it, from q to p, crosses the ray through C
    from_right = not qx < 0.0
    above = qy > py if from_right else qy < py
    if (px < 0.0) == from_right:
        above = from_right
    return _with_whole(sums, 1.0, whole) if above else sums


@inner
def _round(ground: FloatArray, slip: Slip, cx: float, cy: float, radius: float) -> Sums:
    """What lies in a circle about (cx, cy)."""
    count, profile, room = int(ground[ROWS]), int(ground[PROFILE]), int(ground[ROOM])
    rows, piles, rest = ground[profile:room], ground[room:], ground[room + 8 * count :]
    alpha, beta = slip.along, slip.turning
    apart, sums = math.sqrt(cx * cx + cy * cy), NOTHING
    upper, lower = 0.0, 0.0
    if abs(cx) < radius:
        root = math.sqrt((radius - cx) * (radius + cx))
        upper, lower = cy + root, cy - root
        if upper > 0.0:
            sums = _with_whole(sums, 1.0, piled(rows, piles, count, alpha, beta, min(upper, 1.0)))
        if lower > 0.0:
            sums = _with_whole(sums, -1.0, piled(rows, piles, count, alpha, beta, min(lower, 1.0)))
    near, span = abs(apart - radius), 4.0 * apart * radius
    if near >= 1.0 or apart == 0.0:
        return sums
    room_left = (1.0 - near) * (1.0 + near)
    end = math.pi
    if room_left < span:
        end = 2.0 * angle_of(math.sqrt(room_left), math.sqrt(span - room_left))
    tx, ty = -cx / apart, -cy / apart
    one, two = end, end  # where it crosses C's ray
    if 0.0 < upper < 1.0:
        one = math.atan2(-cx * -ty + (upper - cy) * tx, -cx * tx + (upper - cy) * ty)
    if 0.0 < lower < 1.0:
        two = math.atan2(-cx * -ty + (lower - cy) * tx, -cx * tx + (lower - cy) * ty)
    one, two = min(max(min(one, two), -end), end), min(max(one, two, -end), end)
    border = Border(cx, cy, tx, ty, radius, -end, end, one, two, 0.0, 0.0)
    return plus(sums, 1.0, border_sums(rows, rest, count, alpha, beta, border))


@inner
def _polygon(
    ground: FloatArray, first: int, count: int, radius: float, slip: Slip, mirrored: float
) -> Sums:
    cosine, sine = slip.cosine / radius, slip.sine / radius
    x, y = ground[PLACE_X], ground[PLACE_Y]
    sums, px, py = NOTHING, 0.0, 0.0
    for n in range(count + 1):
        # the mirror image of a polygon runs the other way round
        corner = corner_of(ground, first + (n % count if mirrored > 0.0 else (count - n) % count))
        dx, dy = corner[0] - x, corner[1] - y
        qx, qy = dx * cosine + dy * sine, mirrored * (dy * cosine - dx * sine)
        if n > 0:
            sums = plus(sums, 1.0, _line(ground, slip, px, py, qx, qy))
        px, py = qx, qy
    return sums


@inner
def under_profile(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """∫ W f N over the base; ``mirrored`` −1: of a clockwise spin, as the mirror image."""
    count, profile, room = int(ground[ROWS]), int(ground[PROFILE]), int(ground[ROOM])
    rows, piles = ground[profile:room], ground[room:]
    pile_up(rows, piles, count, slip.along, slip.turning)
    whole = piled(rows, piles, count, slip.along, slip.turning, 1.0)
    x, y = ground[PLACE_X], ground[PLACE_Y]
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * x + north * y
    nx = east * slip.cosine + north * slip.sine
    ny = mirrored * (north * slip.cosine - east * slip.sine)
    strip = strip_at(ground, x, y)
    sums = _with_whole(NOTHING, load_of(ground, strip), whole)
    for i in range(strip, int(ground[BORDERS])):
        away = (border_of(ground, i) - place) / radius
        if away >= 1.0:
            break
        more = load_of(ground, i + 1) - load_of(ground, i)
        sums = plus(sums, more, _beyond(ground, slip, nx, ny, away, whole))
    for i in range(strip - 1, -1, -1):
        away = (place - border_of(ground, i)) / radius
        if away >= 1.0:
            break
        more = load_of(ground, i) - load_of(ground, i + 1)
        sums = plus(sums, more, _beyond(ground, slip, -nx, -ny, away, whole))
    for k in range(int(ground[PATCHES])):
        mx, my = patch_of(ground, k, MIDDLE_X), patch_of(ground, k, MIDDLE_Y)
        dx, dy, reach = (mx - x) / radius, (my - y) / radius, patch_of(ground, k, REACH) / radius
        if dx * dx + dy * dy >= (1.0 + reach) * (1.0 + reach):
            continue
        more = patch_of(ground, k, LOAD) - load_of(ground, strip_at(ground, mx, my))
        first, corners = int(patch_of(ground, k, CORNER)), int(patch_of(ground, k, CORNERS))
        if corners == 0:
            px = dx * slip.cosine + dy * slip.sine
            py = mirrored * (dy * slip.cosine - dx * slip.sine)
            sums = plus(sums, more, _round(ground, slip, px, py, reach))
        if corners > 0:
            sums = plus(sums, more, _polygon(ground, first, corners, radius, slip, mirrored))
    return sums
