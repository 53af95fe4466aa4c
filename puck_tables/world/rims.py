"""By which law a disc meets its partner.

Of two discs the smaller of each number counts, of restitutions at the speed at which they meet; an
obstacle says it alone; a law of a pair comes before both.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

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


class Rims(NamedTuple):
    """Laws of rims.

    ``laws`` (…,): the numbers of all laws of restitution, one after the other; ``pairs`` (k, 3):
    restitution, tangential restitution and friction of pairs, NaN where one is as without;
    ``meets`` (c, c): the row of ``pairs`` for two kinds of rims, −1: none.
    """

    laws: FloatArray
    pairs: FloatArray
    meets: npt.NDArray[np.int64]


PLAIN_RIMS = Rims(np.zeros(0), np.zeros((0, 3)), np.zeros((1, 1), np.int64))


@inlined
def _pair_of(rims: Rims, discs: FloatArray, obstacles: FloatArray, i: int, j: int) -> int:
    """The row of a pair; −1: none."""
    if rims.pairs.shape[0] == 0:
        return -1
    other = discs[j, MAKE] if j >= 0 else obstacles[-1 - j, OBSTACLE_MAKE]
    return rims.meets[int(discs[i, MAKE]), int(other)]


@inlined
def along_of_pair(
    rims: Rims, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """Tangential restitution and friction where disc i meets its partner j."""
    if j >= 0:
        beta = min(discs[i, TANGENTIAL], discs[j, TANGENTIAL])
        mu = min(discs[i, FRICTION], discs[j, FRICTION])
    else:
        beta, mu = obstacles[-1 - j, WALL_TANGENTIAL], obstacles[-1 - j, WALL_FRICTION]
    row = _pair_of(rims, discs, obstacles, i, j)
    if row >= 0:
        own = rims.pairs[row]
        beta = beta if math.isnan(own[OF_PAIR_TANGENTIAL]) else own[OF_PAIR_TANGENTIAL]
        mu = mu if math.isnan(own[OF_PAIR_FRICTION]) else own[OF_PAIR_FRICTION]
    return beta, mu


@inlined
def restitutions_of_pair(
    rims: Rims, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """The restitutions, numbers or laws, the smaller of which counts."""
    row = _pair_of(rims, discs, obstacles, i, j)
    if row >= 0 and not math.isnan(rims.pairs[row, OF_PAIR_RESTITUTION]):
        return rims.pairs[row, OF_PAIR_RESTITUTION], rims.pairs[row, OF_PAIR_RESTITUTION]
    if j >= 0:
        return discs[i, RESTITUTION], discs[j, RESTITUTION]
    k = -1 - j
    return obstacles[k, WALL_RESTITUTION], obstacles[k, WALL_RESTITUTION]


@inlined
def smaller_at(rims: Rims, one: float, other: float, speed: float) -> float:
    """The smaller of two restitutions at a speed of approach; −1 beyond the end of a table."""
    if one < 0.0:
        one = restitution_at(rims.laws, int(-1.0 - one), speed)
    if other < 0.0:
        other = restitution_at(rims.laws, int(-1.0 - other), speed)
    return min(one, other)
