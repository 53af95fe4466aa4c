"""What lies ahead of a puck that a floor carries: walls, edges, borders of strips, and patches.

A floor that moves straight on carries it along a ray, one that turns around a circle.  Where
nothing lies on that way the rest lasts.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.boundaries import Boundaries
from puck_tables.scene.cushions import NX, NY
from puck_tables.scene.friction import X, Y
from puck_tables.scene.ground import (
    CORNER,
    CORNERS,
    MIDDLE_X,
    MIDDLE_Y,
    REACH,
    corner_of,
    patch_of,
)
from puck_tables.scene.ingredients import Surface
from puck_tables.scene.patches import INSIDE, OUTSIDE, distance_to

_PARALLEL = 1e-15  # of the speed of the floor: across a line, that is rounding of its direction

_GRAZE = 1e-9  # of the radius: a rim that has just left a patch has it no closer ahead


@inlined
def _meets(
    surface: Surface, rows: FloatArray, i: int, sign: float, y: FloatArray, margin: float
) -> bool:
    """Whether a place that is carried along, where sign (n·x − c) ≥ 0, comes so close to a line."""
    nx, ny, c = sign * rows[i, NX], sign * rows[i, NY], sign * rows[i, 2] + margin
    if surface.spin == 0.0:
        speed = math.hypot(surface.vx, surface.vy)
        return nx * surface.vx + ny * surface.vy < -_PARALLEL * speed
    mx, my, way = circle_of(surface, y[X], y[Y])
    return nx * mx + ny * my - way <= c


@inlined
def circle_of(surface: Surface, x: float, y: float) -> tuple[float, float, float]:
    """The circle around which a floor that turns carries a place: its middle and radius."""
    mx, my = surface.cx - surface.vy / surface.spin, surface.cy + surface.vx / surface.spin
    return mx, my, math.hypot(x - mx, y - my)


@inner
def _ray_to_patch(ground: FloatArray, k: int, x: float, y: float, ux: float, uy: float) -> float:
    """How close a ray along the unit vector (ux, uy) comes to a patch that it starts outside of."""
    nearest = distance_to(ground, k, x, y)
    count, first = int(patch_of(ground, k, CORNERS)), int(patch_of(ground, k, CORNER))
    if count == 0:
        dx, dy = patch_of(ground, k, MIDDLE_X) - x, patch_of(ground, k, MIDDLE_Y) - y
        ahead, aside = ux * dx + uy * dy, ux * dy - uy * dx
        return abs(aside) - patch_of(ground, k, REACH) if ahead > 0.0 else nearest
    for n in range(count):
        one = corner_of(ground, first + n)
        two = corner_of(ground, first + (n + 1 if n + 1 < count else 0))
        # to an edge it is closest at its start, beside a corner, or where both cut each other
        ahead, aside = ux * (one[0] - x) + uy * (one[1] - y), ux * (one[1] - y) - uy * (one[0] - x)
        to_ahead, to_aside = (
            ux * (two[0] - x) + uy * (two[1] - y), ux * (two[1] - y) - uy * (two[0] - x)
        )  # fmt: skip
        if ahead >= 0.0:
            nearest = min(nearest, abs(aside))
        if (aside > 0.0) != (to_aside > 0.0):
            cut = ahead + aside / (aside - to_aside) * (to_ahead - ahead)
            nearest = 0.0 if cut >= 0.0 else nearest
    return nearest


@inlined
def _comes_over(
    surface: Surface, ground: FloatArray, k: int, how: int, radius: float, y: FloatArray
) -> bool:
    """Whether the rim of a base may come over the border of a patch, or leave it."""
    if surface.spin == 0.0:
        speed = math.hypot(surface.vx, surface.vy)
        ux, uy = surface.vx / speed, surface.vy / speed
        near = _ray_to_patch(ground, k, y[X], y[Y], ux, uy)
        return how != OUTSIDE or near < (1.0 - _GRAZE) * radius
    mx, my, way = circle_of(surface, y[X], y[Y])
    apart = math.hypot(mx - patch_of(ground, k, MIDDLE_X), my - patch_of(ground, k, MIDDLE_Y))
    reach = patch_of(ground, k, REACH)
    if how == INSIDE and int(patch_of(ground, k, CORNERS)) == 0:
        return apart + way + radius >= reach
    return how != OUTSIDE or abs(apart - way) <= reach + radius


@inner
def leads_on(
    surface: Surface, bounds: Boundaries, leans: npt.NDArray[np.bool_], ground: FloatArray,
    lies: npt.NDArray[np.int64], zone: int, radius: float, y: FloatArray,
) -> bool:  # fmt: skip
    """Whether a floor that moves carries a puck to a wall, an edge, a border or a patch.

    On one that turns also where it only might: a polygon counts as the circle about its corners.
    """
    walls, edges, borders = bounds.walls, bounds.edges, bounds.borders
    for i in range(len(walls)):
        if not leans[i] and _meets(surface, walls, i, 1.0, y, 0.0):
            return True
    for i in range(len(edges)):
        if _meets(surface, edges, i, 1.0, y, radius):
            return True
    if zone > 0 and _meets(surface, borders, zone - 1, 1.0, y, 0.0):
        return True
    if zone < len(borders) and _meets(surface, borders, zone, -1.0, y, 0.0):
        return True
    found = False
    for k in range(lies.size):
        found = found or _comes_over(surface, ground, k, lies[k], radius, y)
    return found
