"""Sums under a base on several frictions by its law of pressure."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, RING, TABLE, UNIFORM, Sums, plus
from puck_tables.kernels.compile import inner
from puck_tables.scene.astride_parts import Slip, weighted
from puck_tables.scene.astride_profile import under_profile
from puck_tables.scene.ground import INNER, PRESSURE, SHARE


@inner
def sums_under(ground: FloatArray, radius: float, slip: Slip, mirrored: float) -> Sums:
    """(1/A) ∫ W f N over the base, of what :mod:`puck_tables.kernels.base_boundary` sums."""
    law, share = int(ground[PRESSURE]), ground[SHARE] / math.pi
    if law == TABLE:
        return plus(NOTHING, share, under_profile(ground, radius, slip, mirrored))
    if law == RING:
        share *= 0.5
    hole = ground[INNER]
    share /= 1.0 - hole * hole
    sums = plus(NOTHING, share, weighted(ground, radius, slip, mirrored, 1.0, law))
    if hole > 0.0:
        sums = plus(sums, -share, weighted(ground, radius, slip, mirrored, hole, UNIFORM))
    return sums
