"""One explicit Runge–Kutta step, for any tableau, and the integrators that there are."""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.method_errors import Selection
from puck_tables.accuracy.methods import Method
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.equations_of_motion import derivatives
from puck_tables.motion.state import SIZE
from puck_tables.motion.tableaus import DORMAND_PRINCE, DORMAND_PRINCE_8, RK4, Tableau

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

    >>> from puck_tables.accuracy.method_errors import select
    >>> from puck_tables.accuracy.methods import INTEGRATED
    >>> stepping_of(select("stop", 1e-4, INTEGRATED)).steps
    10.0
    """
    tableau, value = TABLEAUS[selection.method], selection.number(selection.method.setting)
    if tableau.e.any():
        return Stepping(tableau, 0.0, min(value, loosest))
    return Stepping(tableau, value, 1.0)


# of the work space: as many stages as any method has, the slopes at an event, and a state
ROWS = len(DORMAND_PRINCE_8.c) + 2
AT_EVENT = ROWS - 2


@inlined
def times_as_long(error: float, tolerance: float, power: float, least: float) -> float:
    """By how much a step may be longer, at most 5, or must be shorter, for its error to be right.

    ``power``: of the error over the length; ``least``: the shortest it may become at once.
    """
    if not error < math.inf:
        return least
    if error == 0.0:
        return 5.0
    return min(max(0.9 * (tolerance / error) ** power, least), 5.0)


@inlined
def estimated(tableau: Tableau, work: FloatArray, i: int) -> float:
    """The error of one number of the state in a step just done, over its length."""
    error, other = 0.0, 0.0
    for stage in range(tableau.b.size):
        error += tableau.e[0, stage] * work[stage, i]
        other += tableau.e[1, stage] * work[stage, i]
    return error if other == 0.0 else error * (abs(error) / math.hypot(error, 0.1 * other))


@inner
def step(
    tableau: Tableau, z: float, y: FloatArray, h: float, section: FloatArray, delta: float,
    work: FloatArray, out: FloatArray,
) -> float:  # fmt: skip
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
        derivatives(z + tableau.c[stage] * h, state, section, delta, work[stage])
    largest = 0.0
    for i in range(SIZE):
        increment = 0.0
        for j in range(stages):
            increment += tableau.b[j] * work[j, i]
        out[i] = y[i] + h * increment
        error = abs(h * estimated(tableau, work, i))
        if not error <= largest:  # a NaN is never small
            largest = error
    return largest
