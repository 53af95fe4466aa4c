"""One explicit Runge–Kutta step, for any tableau, and the integrators that there are."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.front import Selection
from puck_tables.accuracy.methods import Method
from puck_tables.kernels.compile import inner
from puck_tables.motion.equations import derivatives
from puck_tables.motion.state import SIZE


class Tableau(NamedTuple):
    """Butcher tableau: stage weights, stage nodes, weights, and error weights (zero: none).

    ``order``: of the error of a motion with fixed steps; of a pair, of the local error that it
    estimates.  ``reused``: whether the last stage is the first of the next step.  ``unrolled``:
    whether :mod:`puck_tables.motion.rk4` takes the same steps.
    """

    a: FloatArray
    c: FloatArray
    b: FloatArray
    e: FloatArray
    order: int
    reused: bool
    unrolled: bool


def _tableau(
    rows: list[list[float]], weights: list[float], error: list[float], order: int,
    unrolled: bool = False,
) -> Tableau:  # fmt: skip
    size = len(rows)
    a = np.zeros((size, size))
    for i, row in enumerate(rows):
        a[i, : len(row)] = row
    reused = bool(np.array_equal(a[-1], weights))
    return Tableau(a, a.sum(axis=1), np.array(weights), np.array(error), order, reused, unrolled)


# Kutta 1901
RK4 = _tableau(
    [[], [1 / 2], [0, 1 / 2], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], [0.0] * 4, 4, True
)

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
    5,
)

TABLEAUS = {Method.RK4: RK4, Method.ADAPTIVE: DORMAND_PRINCE}


class Stepping(NamedTuple):
    """An integrator with its setting: so many fixed steps, or 0 and the local error of a step."""

    tableau: Tableau
    steps: float
    local: float

    @property
    def fixed(self) -> bool:
        """Whether the steps are fixed."""
        return self.steps > 0.0

    def finer(self, steps: float, local: float, finest: float) -> Stepping:
        """With so many times the steps, or the local error times ``local``, at least ``finest``."""
        more = float(math.ceil(steps * self.steps))
        return Stepping(self.tableau, more, max(local * self.local, finest))


def stepping_of(selection: Selection, loosest: float = 1.0) -> Stepping:
    """The integrator that was selected; its local error at most ``loosest``.

    Examples
    --------
    >>> from puck_tables.accuracy.front import select
    >>> from puck_tables.accuracy.methods import INTEGRATED
    >>> stepping_of(select("stop", 1e-4, INTEGRATED)).steps
    10.0
    """
    tableau, value = TABLEAUS[selection.method], selection.number(selection.method.setting)
    if tableau.e.any():
        return Stepping(tableau, 0.0, min(value, loosest))
    return Stepping(tableau, value, 1.0)


ROWS = 8  # of the work space: at most seven stages, and a state


@inner
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
