"""Friction on a base that lies on stretches of the floor with velocities of their own.

Each part of the base is summed with its own slip: those of one velocity together, with all others
left out.  Sums are in axes of the base, and add up there; then the load tilts as it does on several
frictions.  States are relative to one of the velocities.  What moves at it rests on its part of the
floor, which holds it against what the others do: their friction is a force like any other.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.base_on_floor import friction_sums
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    ANGLE,
    BELTS,
    BORDERS,
    OVER_X,
    OVER_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    belt_of,
    border_of,
    parts_in,
    sum_over,
)
from puck_tables.scene.patches import distance_to

Far = tuple[float, float, float]  # Σ over the parts of velocity times e, x e and y e


@inner
def lies_on(floor_map: FloatArray, area: int, x: float, y: float, radius: float) -> bool:
    """Whether a base at a place may have a part on a strip, or after all of them a patch."""
    strips = int(floor_map[BORDERS]) + 1
    if area >= strips:
        return distance_to(floor_map, area - strips, x, y) < radius
    place = floor_map[ACROSS_X] * x + floor_map[ACROSS_Y] * y
    if area > 0 and place + radius <= border_of(floor_map, area - 1):
        return False
    if area < strips - 1 and place - radius >= border_of(floor_map, area):
        return False
    covered = False
    for k in range(int(floor_map[PATCHES])):
        covered = covered or distance_to(floor_map, k, x, y) <= -radius
    return not covered


@inlined
def _is_first(floor_map: FloatArray, area: int) -> bool:
    """Whether no stretch before has the same velocity."""
    vx, vy = belt_of(floor_map, area)
    for before in range(area):
        ox, oy = belt_of(floor_map, before)
        if ox == vx and oy == vy:
            return False
    return True


@inner
def nearest_belt(
    floor_map: FloatArray, x: float, y: float, radius: float, vx: float, vy: float
) -> tuple[float, float, float]:
    """Of the velocities under a base at a place the one nearest to (vx, vy), and how far it is."""
    least, bx, by = math.inf, floor_map[OVER_X], floor_map[OVER_Y]
    for area in range(parts_in(floor_map)):
        ox, oy = belt_of(floor_map, area)
        off = math.sqrt((vx - ox) * (vx - ox) + (vy - oy) * (vy - oy))
        if off < least and lies_on(floor_map, area, x, y, radius):
            least, bx, by = off, ox, oy
    return bx, by, least


@inner
def is_rubbed(floor_map: FloatArray, radius: float) -> bool:
    """Whether parts of a base may lie on velocities that differ."""
    if floor_map[BELTS] == 0.0:
        return False
    for area in range(parts_in(floor_map)):
        ox, oy = belt_of(floor_map, area)
        other = ox != floor_map[OVER_X] or oy != floor_map[OVER_Y]
        if other and lies_on(floor_map, area, floor_map[PLACE_X], floor_map[PLACE_Y], radius):
            return True
    return False


@inner
def sums_over_belts(
    floor_map: FloatArray, first: int, last: int, ux: float, uy: float, w: float, moving: float
) -> tuple[Sums, Far]:
    """Sums over all parts of a contour that slip, each at its own velocity, in axes of the base.

    And what they take to far off.
    """
    c, s = math.cos(floor_map[ANGLE]), math.sin(floor_map[ANGLE])
    sums, one, two, three = NOTHING, 0.0, 0.0, 0.0
    for area in range(parts_in(floor_map)):
        bx, by = belt_of(floor_map, area)
        ox, oy = bx - floor_map[OVER_X], by - floor_map[OVER_Y]
        px, py = c * ox + s * oy, c * oy - s * ox
        vx, vy = ux - px, uy - py
        if (vx == 0.0 and vy == 0.0 and w == 0.0) or not _is_first(floor_map, area):
            continue
        sum_over(floor_map, bx, by, False)
        part = friction_sums(floor_map, first, last, vx, vy, w, moving)
        sums = plus(sums, 1.0, part)
        one += px * part[0] + py * part[1]
        two += px * part[2] + py * part[4]
        three += px * part[3] + py * part[5]
    sum_over(floor_map, 0.0, 0.0, True)
    return sums, (one, two, three)
