"""By which law a disc meets its partner.

Of two discs the smaller of each number counts, of restitutions at the speed at which they meet; an
obstacle says it alone; a law of a pair comes before both.

``rims`` (…,) is one array, for every array that is handed to a kernel takes its time: how many
kinds of rims there are, c; for every two kinds, c² numbers, where in it the restitution, tangential
restitution and friction of such a pair stand (−1: none; NaN where one is as without); these; and
the numbers of all laws of restitution.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.restitution_at import restitution_at
from puck_tables.world.layout import (
    FRICTION,
    MAKE,
    OBSTACLE_MAKE,
    RESTITUTION,
    TANGENTIAL,
    WALL_FRICTION,
    WALL_RESTITUTION,
    WALL_TANGENTIAL,
)

OF_PAIR_RESTITUTION, OF_PAIR_TANGENTIAL, OF_PAIR_FRICTION = range(3)
PLAIN_RIMS = np.zeros(1)


@inlined
def _pair_of(rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int) -> int:
    """Where the numbers of a pair stand; −1: none."""
    kinds = int(rims[0])
    if kinds == 0:
        return -1
    other = discs[j, MAKE] if j >= 0 else obstacles[-1 - j, OBSTACLE_MAKE]
    return int(rims[1 + int(discs[i, MAKE]) * kinds + int(other)])


@inlined
def along_of_pair(
    rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """Tangential restitution and friction where disc i meets its partner j."""
    if j >= 0:
        beta = min(discs[i, TANGENTIAL], discs[j, TANGENTIAL])
        mu = min(discs[i, FRICTION], discs[j, FRICTION])
    else:
        beta, mu = obstacles[-1 - j, WALL_TANGENTIAL], obstacles[-1 - j, WALL_FRICTION]
    at = _pair_of(rims, discs, obstacles, i, j)
    if at >= 0:
        own, grip = rims[at + OF_PAIR_TANGENTIAL], rims[at + OF_PAIR_FRICTION]
        beta = beta if math.isnan(own) else own
        mu = mu if math.isnan(grip) else grip
    return beta, mu


@inlined
def restitutions_of_pair(
    rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """The restitutions, numbers or laws, the smaller of which counts."""
    at = _pair_of(rims, discs, obstacles, i, j)
    if at >= 0 and not math.isnan(rims[at + OF_PAIR_RESTITUTION]):
        return rims[at + OF_PAIR_RESTITUTION], rims[at + OF_PAIR_RESTITUTION]
    if j >= 0:
        return discs[i, RESTITUTION], discs[j, RESTITUTION]
    k = -1 - j
    return obstacles[k, WALL_RESTITUTION], obstacles[k, WALL_RESTITUTION]


@inlined
def smaller_at(rims: FloatArray, one: float, other: float, speed: float) -> float:
    """The smaller of two restitutions at a speed of approach; −1 beyond the end of a table."""
    if one < 0.0:
        one = restitution_at(rims, int(-1.0 - one), speed)
    if other < 0.0:
        other = restitution_at(rims, int(-1.0 - other), speed)
    return min(one, other)
