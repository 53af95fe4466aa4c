"""Dry friction of a base of any shape: polygons and discs, with holes, and a linear pressure.

With e the slip direction and lengths from the centre of mass, the pressure p = a + b·x over the
base, for a weight of 1, carries the puck and balances the moment of friction at the height z of its
centre of mass,

    ∫ p dA = 1 ,   ∫ p x dA = z f ∫ p e dA :

three linear equations, as ∫ p e dA is linear in a and b.  Of a flat base (z = 0) they fix p once
for all.  Friction is then −f ∫ p e dA and its moment.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.contact.laws import Law
from puck_tables.kernels.base_boundary import disc_at
from puck_tables.kernels.base_sums import GALIN, HERTZ, NOTHING, RING, TABLE, UNIFORM, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    PIECE_COLUMNS,
    RADIUS,
    TURN,
    polygon_sums,
)

Moments = tuple[float, float, float, float, float, float]

# A base in one array: how many sides and discs, how far its farthest point is, ∫ dA, ∫ x dA and
# ∫ x x dA over it, z f, its law of pressure, and how many rows that has; then its contour, a row
# for each side and then for each disc, which turns backwards around a hole, and of a foot with a
# load of its own as often as it presses harder; from the centre of mass
SIDES, DISCS, REACH, AREA, FIRST_X, FIRST_Y, SECOND_XX, SECOND_XY, SECOND_YY, LEVER = range(10)
PRESSURE, ROWS = 10, 11
HEAD = 12
# of a law of pressure follow the radii of a tabulated one, and of its pieces of W = A + B ρ, with
# one on either side where nothing presses, each A and B, flat; then room to work
_ROOM, _ROOM_A_ROW = 62, 11
_PRESSURES = {"ring": RING, "hertz": HERTZ, "galin": GALIN}


def packed(base: Base, lever: float) -> FloatArray:
    """A base in one array; ``lever``: friction times the height of the centre of mass, m.

    >>> packed(Base.box(0.2, 0.1), 0.0)[:4].round(6).tolist()
    [4.0, 0.0, 0.111803, 0.02]
    """
    area, first, second = base.about_centre
    middle, sides = np.array(base.middle), []
    for outline in base.outlines:
        corners = np.array(outline) - middle
        along = np.roll(corners, -1, axis=0) - corners
        length = np.hypot(*along.T)
        anew = np.zeros(len(corners))
        anew[0] = 1.0
        last, turn = np.roll(corners, -1, axis=0), np.zeros(len(corners))
        rows = [corners, along / length[:, None], length, anew, last, turn]
        sides.append(np.column_stack(rows).ravel())
    discs = []
    for x, y, radius, sign in base.discs:
        x, y = x - middle[0], y - middle[1]
        begin = x + radius, y
        discs.append([*begin, x, y, radius, 0.0, *begin, sign * 2.0 * math.pi])
    head = [
        sum(map(len, base.outlines)), len(discs), base.reach, area, *first,
        second[0, 0], second[0, 1], second[1, 1], lever, UNIFORM, 0.0,
    ]  # fmt: skip
    return np.concatenate([head, *sides, np.ravel(discs)]).astype(np.float64)


def packed_round(radius: float, law: Law, lever: float) -> FloatArray:
    """A round base under a pressure law in one array, as :func:`packed`.

    >>> from puck_tables.contact.laws import law_of
    >>> packed_round(1.0, law_of("hertz"), 0.0)[[SECOND_XX, PRESSURE]].round(6).tolist()
    [0.628319, 2.0]
    """
    if law.name.startswith("annulus:"):
        return packed(Base.annulus(radius, law.edges[0] * radius), lever)
    base = packed(Base.disc(radius), lever)
    base[SECOND_XX] = base[SECOND_YY] = base[AREA] * radius * radius * law.mean_square
    base[PRESSURE] = _PRESSURES.get(law.name, UNIFORM)
    if law.profile is None:
        return np.concatenate([base, np.zeros(2 + _ROOM)])
    rho, weight = law.profile
    middle = 0.25 * (rho[1:] + rho[:-1]) * (weight[1:] + weight[:-1])
    ends = rho * weight
    load = float(np.sum(np.diff(rho) * (ends[1:] + ends[:-1] + 4.0 * middle))) / 6.0
    weight = 0.5 * weight / load
    slope = np.diff(weight) / np.diff(rho)
    at_centre = weight[:-1] - slope * rho[:-1]
    base[PRESSURE], base[ROWS] = TABLE, len(rho)
    room = np.zeros(_ROOM + _ROOM_A_ROW * len(rho))
    return np.concatenate([base, rho, np.pad(at_centre, 1), np.pad(slope, 1), room])


@inlined
def disc_in(base: FloatArray, number: int) -> tuple[float, float, float, float]:
    """The middle of a disc of a base, its radius, and how hard it is pressed; < 0: a hole."""
    at = HEAD + PIECE_COLUMNS * (int(base[SIDES]) + number)
    weight = base[at + TURN] / (2.0 * math.pi)
    return base[at + ABOUT_X], base[at + ABOUT_Y], base[at + RADIUS], weight


@inner
def base_sums(base: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """Sums of the slip direction over a base, in its own axes, at a slip and a spin, not both 0."""
    count, sums = int(base[SIDES]), NOTHING
    if count > 0:
        sums = polygon_sums(base, HEAD, count, base[REACH], ux, uy, w)
    for i in range(int(base[DISCS])):
        cx, cy, size, sign = disc_in(base, i)
        sums = plus(sums, sign, disc_at(cx, cy, size, ux, uy, w))
    return sums


@inlined
def moments_in(base: FloatArray) -> Moments:
    """∫ dA, ∫ x dA and ∫ x x dA of a whole base; of a law of pressure ∫ x x times that."""
    return (
        base[AREA], base[FIRST_X], base[FIRST_Y], base[SECOND_XX], base[SECOND_XY],
        base[SECOND_YY],
    )  # fmt: skip


@inlined
def pressure_over(
    moments: Moments, sums: Sums, lever: float, mx: float, my: float
) -> tuple[float, float, float]:
    """A, b_x and b_y of the pressure a + b·x for a weight of 1, over any part of a base.

    ``lever``: z f, of what slips with these sums over that part; (mx, my): where the load of what
    is at rest stands from the centre of mass, m.
    """
    area, sx, sy = moments[0], moments[1], moments[2]
    tx, ty, ox, oy = sx - lever * sums[0], sy - lever * sums[1], sx / area, sy / area
    xx, xy = moments[3] - lever * sums[2] - tx * ox, moments[4] - lever * sums[3] - tx * oy
    yx, yy = moments[4] - lever * sums[4] - ty * ox, moments[5] - lever * sums[5] - ty * oy
    px, py = mx - tx / area, my - ty / area
    turn = 1.0 / (xx * yy - xy * yx)
    bx, by = turn * (yy * px - xy * py), turn * (xx * py - yx * px)
    return (1.0 - sx * bx - sy * by) / area, bx, by


@inlined
def pressure_on(base: FloatArray, sums: Sums) -> tuple[float, float, float]:
    """A, b_x and b_y of the pressure a + b·x for a weight of 1, as it slips."""
    return pressure_over(moments_in(base), sums, base[LEVER], 0.0, 0.0)


@inlined
def is_uniform(base: FloatArray) -> bool:
    """Whether it is a polygon under uniform pressure."""
    flat = base[LEVER] == 0.0 and base[FIRST_X] == 0.0 and base[FIRST_Y] == 0.0
    return flat and base[DISCS] == 0.0


@inlined
def grip(base: FloatArray, ux: float, uy: float, w: float) -> tuple[float, float, float]:
    """Force and torque over f N that keep a base slipping, in its own axes: against friction."""
    sums = base_sums(base, ux, uy, w)
    if is_uniform(base):
        return under_load(sums, 1.0 / base[AREA], 0.0, 0.0)
    return under_load(sums, *pressure_on(base, sums))


@inlined
def under_load(sums: Sums, a: float, bx: float, by: float) -> tuple[float, float, float]:
    """Force and torque under the pressure a + b·x."""
    return (
        a * sums[0] + bx * sums[2] + by * sums[3], a * sums[1] + bx * sums[4] + by * sums[5],
        a * (sums[4] - sums[3]) + bx * sums[6] + by * sums[7],
    )  # fmt: skip


@inner
def base_friction(
    base: FloatArray, angle: float, ux: float, uy: float, w: float
) -> tuple[float, float, float]:
    """Force and torque about the centre of mass, over f N, of a base turned by an angle.

    (ux, uy): the slip of the centre of mass, m/s; w: the spin over the floor, rad/s; not both 0.
    """
    c, s = math.cos(angle), math.sin(angle)
    fx, fy, torque = grip(base, c * ux + s * uy, c * uy - s * ux, w)
    return s * fy - c * fx, -s * fx - c * fy, -torque
