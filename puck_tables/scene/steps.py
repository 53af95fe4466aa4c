"""One step of Dormand–Prince 5(4) in time, put onto the constraint at its end."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.steppers import Tableau
from puck_tables.scene.equations import SIZE, SPIN, THETA, VX, VY, X, Y, rates
from puck_tables.scene.ingredients import BLADE, PIVOT, RAIL, Hold, Model, floor_velocity

FloatArray = npt.NDArray[np.float64]

STAGES = 7


@inlined
def put_right(hold: Hold | None, t: float, y: FloatArray) -> None:
    """Position and velocity onto the constraint, from which rounding and step errors lead away."""
    if hold is None:
        return
    if hold.kind == RAIL:
        off = hold.ax * (y[VX] - hold.vx) + hold.ay * (y[VY] - hold.vy)
        y[VX] -= off * hold.ax
        y[VY] -= off * hold.ay
        return
    cosine, sine = math.cos(y[THETA] + hold.angle), math.sin(y[THETA] + hold.angle)
    if hold.kind == BLADE:
        off = -sine * y[VX] + cosine * y[VY] - hold.vx
        y[VX] += off * sine
        y[VY] -= off * cosine
    if hold.kind == PIVOT:
        y[X] = hold.ax + hold.vx * t - hold.reach * cosine
        y[Y] = hold.ay + hold.vy * t - hold.reach * sine
        y[VX] = hold.vx + y[SPIN] * hold.reach * sine
        y[VY] = hold.vy - y[SPIN] * hold.reach * cosine


@kernel
def step(
    tableau: Tableau,
    t: float,
    h: float,
    inside: float,
    y: FloatArray,
    model: Model,
    region: int,
    leaning: FloatArray,
    carried: bool,
    scale: FloatArray,
    work: FloatArray,
    new: FloatArray,
) -> float:
    """A step from (t, y) over h into ``new``, put onto the constraint; its error in ``scale``.

    On entry work[0] is dy/dt at t.
    """
    state = work[STAGES]
    for stage in range(1, STAGES):
        for i in range(SIZE):
            total = 0.0
            for j in range(stage):
                total += tableau.a[stage, j] * work[j, i]
            state[i] = y[i] + h * total
        rates(t + tableau.c[stage] * h, inside, state, model, region, leaning, carried, work[stage])
    largest = 0.0
    for i in range(SIZE):
        increment, error = 0.0, 0.0
        for j in range(STAGES):
            increment += tableau.b[j] * work[j, i]
            error += tableau.e[j] * work[j, i]
        new[i] = y[i] + h * increment
        share = abs(h * error) / scale[i]
        if not share <= largest:
            largest = share
    if carried:
        new[VX], new[VY], new[SPIN] = floor_velocity(model.surface, new[X], new[Y])
    else:
        put_right(model.hold, t + h, new)
    return largest
