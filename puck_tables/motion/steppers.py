"""One explicit Runge–Kutta step, for any tableau: the classical method and Dormand–Prince 5(4)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import kernel
from puck_tables.motion.equations import SIZE, derivatives

FloatArray = npt.NDArray[np.float64]


class Tableau(NamedTuple):
    """Butcher tableau: stage weights, stage nodes, weights, and error weights (zero: none)."""

    a: FloatArray
    c: FloatArray
    b: FloatArray
    e: FloatArray


def _tableau(rows: list[list[float]], weights: list[float], error: list[float]) -> Tableau:
    size = len(rows)
    a = np.zeros((size, size))
    for i, row in enumerate(rows):
        a[i, : len(row)] = row
    return Tableau(a, a.sum(axis=1), np.array(weights), np.array(error))


# Kutta 1901
RK4 = _tableau([[], [1 / 2], [0, 1 / 2], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], [0.0] * 4)

# Dormand and Prince 1980, RK5(4)7M; the last stage is the next step's first
_LAST = [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]
DORMAND_PRINCE = _tableau(
    [
        [],
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        _LAST,
    ],
    [*_LAST, 0.0],
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
)

ROWS = 8  # of the work space: at most seven stages, and a state


@kernel
def step(
    tableau: Tableau,
    z: float,
    y: FloatArray,
    h: float,
    cut: FloatArray,
    delta: float,
    work: FloatArray,
    out: FloatArray,
) -> float:
    """A step from (z, y) over h into ``out``; returns the largest local error estimate.

    On entry work[0] is dy/dz at z; on return the other rows are the stages.
    """
    stages = tableau.b.size
    state = work[ROWS - 1]
    for stage in range(1, stages):
        for i in range(SIZE):
            state[i] = y[i]
        for j in range(stage):
            if tableau.a[stage, j] != 0.0:
                weight = h * tableau.a[stage, j]
                for i in range(SIZE):
                    state[i] += weight * work[j, i]
        derivatives(z + tableau.c[stage] * h, state, cut, delta, work[stage])
    largest = 0.0
    for i in range(SIZE):
        increment, error = 0.0, 0.0
        for j in range(stages):
            increment += tableau.b[j] * work[j, i]
            error += tableau.e[j] * work[j, i]
        out[i] = y[i] + h * increment
        if not abs(h * error) <= largest:  # a NaN is never small
            largest = abs(h * error)
    return largest
