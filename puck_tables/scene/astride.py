"""Dry friction on a base that lies on several frictions at once, each felt under its own part.

With e the direction of the slip, f its coefficient at a place and lengths in radii, the force is
−∫ f σ e dA.  The base stays loaded everywhere, σ = (N/A) (1 + b·x), and the balance of moments of a
puck of height h with the mean square ⟨x²⟩ of its pressure,

    ⟨x²⟩ N b = (h/2r) ∫ f σ e dA ,

is linear in b.  Nothing is symmetric here, so that its two components go together:

    (1 − κ S) b = κ s ,   s = (N/A) ∫ f e dA ,   S_jk = (N/A) ∫ f e_j x_k dA ,   κ = h/(2r ⟨x²⟩ N) .

|b| is at most κ f N for the largest f, which is δ/(4⟨x²⟩): where no strip or patch would lift the
base, none does astride.  The sums are those of :mod:`puck_tables.kernels.base_parts`, of the whole
base with the coefficient under its centre, and of every part with what its own differs by.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_parts import (
    NOTHING,
    Sums,
    beyond_sums,
    common_sums,
    disc_sums,
    inside_disc,
    line_sums,
    plus,
    rim_sums,
    turn_between,
)
from puck_tables.kernels.compile import inlined, inner

# A ground, all in one array, which is quick to hand on: where the centre of the base is, 1 or by
# how much all friction is taken wrong, and what holds for all of it,
PLACE_X, PLACE_Y, SHARE, LEVER, INNER, ACROSS_X, ACROSS_Y, BORDERS, PATCHES = range(9)
_HEAD = 9
# the places of its borders, f N between them, a row for each patch (its middle, the radius of a
# circle about it, the first of its corners, how many (none: it is that circle), and f N there),
MIDDLE_X, MIDDLE_Y, REACH, CORNER, CORNERS, LOAD = range(6)
PATCH_COLUMNS = 6
# and the corners of all patches.


class Ground(NamedTuple):
    """All frictions of a floor, and the base that may lie on several of them.

    ``across_x``, ``across_y``: the direction across the borders of strips; ``borders`` (n,): their
    places along it, ascending, m; ``loads`` (n + 1,): f N between them; ``patches`` (k, 6), and
    ``corners`` (m, 2) of those that are polygons, counter-clockwise, m; ``lever``: κ, 1/N;
    ``inner``: radius of the hole of the base over the outer.
    """

    across_x: float
    across_y: float
    borders: FloatArray
    loads: FloatArray
    patches: FloatArray
    corners: FloatArray
    lever: float
    inner: float

    def packed(self) -> FloatArray:
        """In one array."""
        head = [0.0, 0.0, 1.0, self.lever, self.inner, self.across_x, self.across_y]
        counts = [len(self.borders), len(self.patches)]
        return np.concatenate([
            head, counts, self.borders, self.loads, self.patches.ravel(), self.corners.ravel()
        ]).astype(np.float64)  # fmt: skip


NO_GROUND = np.empty(0)


def own_ground(ground: FloatArray, share: float) -> FloatArray:
    """The ground of a run, with all friction so many times as large."""
    own = ground.copy()
    own[SHARE : SHARE + 1] *= share
    return own


@inlined
def border_of(ground: FloatArray, number: int) -> float:
    """The place of a border."""
    return ground[_HEAD + number]


@inlined
def load_of(ground: FloatArray, strip: int) -> float:
    """F N on a strip."""
    return ground[_HEAD + int(ground[BORDERS]) + strip]


@inlined
def patch_of(ground: FloatArray, number: int, column: int) -> float:
    """What is known of a patch."""
    return ground[_HEAD + 2 * int(ground[BORDERS]) + 1 + PATCH_COLUMNS * number + column]


@inlined
def corner_of(ground: FloatArray, number: int) -> tuple[float, float]:
    """A corner of a patch."""
    first = _HEAD + 2 * int(ground[BORDERS]) + 1 + PATCH_COLUMNS * int(ground[PATCHES])
    return ground[first + 2 * number], ground[first + 2 * number + 1]


@inlined
def patches_on(ground: FloatArray) -> int:
    """How many patches there are."""
    return int(ground[PATCHES]) if ground.size > 0 else 0


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


@inlined
def strip_at(ground: FloatArray, x: float, y: float) -> int:
    """The number of the strip at a place; one on a border is beyond it."""
    place = ground[ACROSS_X] * x + ground[ACROSS_Y] * y
    low, high = 0, int(ground[BORDERS])
    while low < high:
        middle = (low + high) // 2
        if border_of(ground, middle) <= place:
            low = middle + 1
        else:
            high = middle
    return low


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
    size: float,
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
            sums = plus(sums, 1.0, rim_sums(alpha, beta, size, start, turn))
            sums = plus(sums, 1.0, line_sums(alpha, beta, x1, y1, x2, y2))
            start = math.atan2(y2, x2)
            turn = turn_between(x2, y2, qx, qy) if high < 1.0 else 0.0
        px, py = qx, qy
    return plus(sums, 1.0, rim_sums(alpha, beta, size, start, turn))


@inner
def _weighted(ground: FloatArray, radius: float, slip: Slip, mirrored: float, size: float) -> Sums:
    """Sums over a disc of radius ``size`` times f N; ``mirrored`` −1: of a clockwise spin.

    In axes along the slip and across it.  A clockwise spin is the mirror image of the other.
    """
    alpha, beta = slip.along, slip.turning
    x, y = ground[PLACE_X], ground[PLACE_Y]
    east, north = ground[ACROSS_X], ground[ACROSS_Y]
    place = east * x + north * y
    nx = east * slip.cosine + north * slip.sine
    ny = mirrored * (north * slip.cosine - east * slip.sine)
    strip = strip_at(ground, x, y)
    sums = plus(NOTHING, load_of(ground, strip), disc_sums(alpha, beta, size))
    for i in range(strip, int(ground[BORDERS])):
        away = (border_of(ground, i) - place) / radius
        if away >= size:
            break
        more = load_of(ground, i + 1) - load_of(ground, i)
        sums = plus(sums, more, beyond_sums(alpha, beta, size, nx, ny, away))
    for i in range(strip - 1, -1, -1):
        away = (place - border_of(ground, i)) / radius
        if away >= size:
            break
        more = load_of(ground, i) - load_of(ground, i + 1)
        sums = plus(sums, more, beyond_sums(alpha, beta, size, -nx, -ny, away))
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
            sums = plus(sums, more, common_sums(alpha, beta, size, px, py, reach))
        if count > 0:
            sums = plus(
                sums, more, _polygon_sums(ground, first, count, radius, slip, mirrored, size)
            )
    return sums


@inner
def sums_under(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """(1/A) ∫ f N over the base, of what :mod:`puck_tables.kernels.base_parts` sums."""
    hole = ground[INNER]
    weight = ground[SHARE] / (math.pi * (1.0 - hole * hole))
    sums = plus(NOTHING, weight, _weighted(ground, radius, slip, mirrored, 1.0))
    if hole > 0.0:
        sums = plus(sums, -weight, _weighted(ground, radius, slip, mirrored, hole))
    return sums


@inlined
def tilted(sums: Sums, bx: float, by: float) -> tuple[float, float, float]:
    """∫ f σ e dA and its moment, of the pressure with the slopes (bx, by)."""
    return (
        sums[0] + bx * sums[2] + by * sums[3],
        sums[1] + bx * sums[4] + by * sums[5],
        sums[4] - sums[3] + bx * sums[6] + by * sums[7],
    )


@inner
def astride_friction(
    ground: FloatArray, radius: float, ux: float, uy: float, w: float,
    slip: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Force, torque and the power they take, at velocities relative to the floor; Q = ``slip``."""
    to_unit = 1.0 / slip
    way = slip_of(to_unit * ux, to_unit * uy, to_unit * radius * w)
    mirrored = -1.0 if w < 0.0 else 1.0
    sums = sums_under(ground, radius, way, mirrored)
    lever = ground[LEVER]
    bx, by = 0.0, 0.0
    if lever > 0.0:
        xx, xy = 1.0 - lever * sums[2], -lever * sums[3]
        yx, yy = -lever * sums[4], 1.0 - lever * sums[5]
        turn = lever / (xx * yy - xy * yx)
        bx, by = turn * (yy * sums[0] - xy * sums[1]), turn * (xx * sums[1] - yx * sums[0])
    along, across, torque = tilted(sums, bx, by)
    power = slip * (way.along * along + way.turning * torque)
    across *= mirrored
    return (
        -along * way.cosine + across * way.sine,
        -along * way.sine - across * way.cosine,
        -mirrored * radius * torque,
        power,
    )


@inner
def held_friction(
    ground: FloatArray, radius: float, nx: float, ny: float, rim: float,
    bx: float, by: float,
) -> tuple[float, float, float]:  # fmt: skip
    """∫ f σ e dA and its moment over r at a slip of Q = 1, of a pressure with slopes (bx, by)."""
    way = slip_of(nx, ny, rim)
    mirrored = -1.0 if rim < 0.0 else 1.0
    sums = sums_under(ground, radius, way, mirrored)
    ahead = bx * way.cosine + by * way.sine
    aside = mirrored * (by * way.cosine - bx * way.sine)
    along, across, torque = tilted(sums, ahead, aside)
    across *= mirrored
    return (
        along * way.cosine - across * way.sine,
        along * way.sine + across * way.cosine,
        mirrored * torque,
    )
