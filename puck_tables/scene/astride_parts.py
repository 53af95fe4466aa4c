"""Sums of the slip direction, times f N, over a disc that lies on several frictions."""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_boundary import line_sums
from puck_tables.kernels.base_parts import (
    beyond_sums,
    common_sums,
    inside_disc,
    rim_sums,
    turn_between,
    whole_sums,
)
from puck_tables.kernels.base_sums import NOTHING, RING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
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
    REACH,
    SHARE,
    border_of,
    corner_of,
    load_of,
    patch_of,
    strip_at,
)


class Slip(NamedTuple):
    """A slip: v and r ω over Q, ω without its sign, and the direction (cosine, sine) of v."""

    along: float
    turning: float
    cosine: float
    sine: float


@inlined
def slip_of(ux: float, uy: float, rim: float) -> Slip:
    """The slip (ux, uy) of the centre and r ω, both over Q."""
    speed = math.sqrt(ux * ux + uy * uy)
    cosine, sine = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    return Slip(speed, abs(rim), cosine, sine)


@inner
def least_under(ground: FloatArray, radius: float) -> float:
    """The least f N that a base may have under a part of it."""
    x, y = ground[PLACE_X], ground[PLACE_Y]
    place = ground[ACROSS_X] * x + ground[ACROSS_Y] * y
    least = math.inf
    for i in range(int(ground[BORDERS]) + 1):
        below = i == 0 or border_of(ground, i - 1) < place + radius
        if below and (i == int(ground[BORDERS]) or border_of(ground, i) > place - radius):
            least = min(least, load_of(ground, i))
    for k in range(int(ground[PATCHES])):
        dx, dy = patch_of(ground, k, MIDDLE_X) - x, patch_of(ground, k, MIDDLE_Y) - y
        if math.sqrt(dx * dx + dy * dy) < radius + patch_of(ground, k, REACH):
            least = min(least, patch_of(ground, k, LOAD))
    return ground[SHARE] * least


@inner
def _polygon_sums(
    ground: FloatArray, first: int, count: int, radius: float, slip: Slip, mirrored: float,
    size: float, law: int,
) -> Sums:  # fmt: skip
    """What of a disc lies in a polygon: around it, on its edges in the disc, else on the rim.

    Where it is outside, the rim under it, as seen from the centre, up to where it comes in again.
    """
    alpha, beta = slip.along, slip.turning
    cosine, sine = slip.cosine / radius, slip.sine / radius
    x, y = ground[PLACE_X], ground[PLACE_Y]
    sums, start, turn, px, py = NOTHING, 0.0, 0.0, 0.0, 0.0
    for n in range(count + 1):
        # the mirror image of a polygon runs the other way round
        corner = corner_of(ground, first + (n % count if mirrored > 0.0 else (count - n) % count))
        dx, dy = corner[0] - x, corner[1] - y
        qx, qy = dx * cosine + dy * sine, mirrored * (dy * cosine - dx * sine)
        if n == 0:
            px, py, start = qx, qy, math.atan2(qy, qx)
            continue
        low, high = inside_disc(size, px, py, qx, qy)
        if low >= high:
            turn += turn_between(px, py, qx, qy)
        else:
            dx, dy = qx - px, qy - py
            x1, y1, x2, y2 = px + low * dx, py + low * dy, px + high * dx, py + high * dy
            if low > 0.0:
                turn += turn_between(px, py, x1, y1)
            sums = plus(sums, 1.0, rim_sums(alpha, beta, size, start, turn, law))
            if law != RING:
                sums = plus(sums, 1.0, line_sums(alpha, beta, x1, y1, x2, y2, law))
            start = math.atan2(y2, x2)
            turn = turn_between(x2, y2, qx, qy) if high < 1.0 else 0.0
        px, py = qx, qy
    return plus(sums, 1.0, rim_sums(alpha, beta, size, start, turn, law))


@inner
def weighted(
    ground: FloatArray, radius: float, slip: Slip, mirrored: float, size: float, law: int
) -> Sums:
    """Sums over a disc of radius ``size`` times f N; ``mirrored`` −1: of a clockwise spin.

    ``law``: of pressure; of a ring over the rim, by the angle.  In axes along the slip and across
    it.  A clockwise spin is the mirror image of the other.
    """
    alpha, beta = slip.along, slip.turning
    x, y = ground[PLACE_X], ground[PLACE_Y]
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * x + north * y
    nx = east * slip.cosine + north * slip.sine
    ny = mirrored * (north * slip.cosine - east * slip.sine)
    strip = strip_at(ground, x, y)
    sums, whole = NOTHING, load_of(ground, strip)
    if whole != 0.0:
        sums = plus(sums, whole, whole_sums(alpha, beta, size, law))
    for i in range(strip, int(ground[BORDERS])):
        away = (border_of(ground, i) - place) / radius
        if away >= size:
            break
        more = load_of(ground, i + 1) - load_of(ground, i)
        sums = plus(sums, more, beyond_sums(alpha, beta, size, nx, ny, away, law))
    for i in range(strip - 1, -1, -1):
        away = (place - border_of(ground, i)) / radius
        if away >= size:
            break
        more = load_of(ground, i) - load_of(ground, i + 1)
        sums = plus(sums, more, beyond_sums(alpha, beta, size, -nx, -ny, away, law))
    for k in range(int(ground[PATCHES])):
        mx, my = patch_of(ground, k, MIDDLE_X), patch_of(ground, k, MIDDLE_Y)
        dx, dy, reach = (mx - x) / radius, (my - y) / radius, patch_of(ground, k, REACH) / radius
        if dx * dx + dy * dy >= (size + reach) * (size + reach):
            continue
        more = patch_of(ground, k, LOAD) - load_of(ground, strip_at(ground, mx, my))
        first, count = int(patch_of(ground, k, CORNER)), int(patch_of(ground, k, CORNERS))
        if count == 0:
            px = dx * slip.cosine + dy * slip.sine
            py = mirrored * (dy * slip.cosine - dx * slip.sine)
            sums = plus(sums, more, common_sums(alpha, beta, size, px, py, reach, law))
        if count > 0:
            sums = plus(
                sums, more, _polygon_sums(ground, first, count, radius, slip, mirrored, size, law)
            )
    return sums
