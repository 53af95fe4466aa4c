"""One step of Dormand–Prince 5(4) in time, put onto the constraint at its end."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.steppers import DORMAND_PRINCE
from puck_tables.scene.equations import SIZE, rates
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    BLADE,
    CARRIED,
    FREE,
    PIVOT,
    RAIL,
    SLIDES,
    Hold,
    Stretch,
    floor_velocity,
)

FloatArray = npt.NDArray[np.float64]

_A, _C, _E = DORMAND_PRINCE.a, DORMAND_PRINCE.c, DORMAND_PRINCE.e
STAGES = len(_C)


@inlined
def put_right(hold: Hold, t: float, y: FloatArray) -> None:
    """Position and velocity onto the constraint, from which rounding and step errors lead away."""
    if hold.kind == FREE:
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
    stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new``, put onto the constraint; its error in ``scale``.

    On entry work[0] is dy/dt at t.
    """
    for stage in range(1, STAGES):
        for i in range(SIZE):
            new[i] = y[i]
        for j in range(stage):
            weight = h * _A[stage, j]
            for i in range(SIZE):
                new[i] += weight * work[j, i]
        rates(stretch, t + _C[stage] * h, new, work, stage)
    largest = 0.0
    for i in range(SIZE):  # the last stage stood at the end of the step
        error = 0.0
        for j in range(STAGES):
            error += _E[j] * work[j, i]
        share = abs(h * error) / scale[i]
        if not share <= largest:
            largest = share
    model = stretch.model
    if stretch.mode == CARRIED:
        new[VX], new[VY], new[SPIN] = floor_velocity(model.surface, new[X], new[Y])
    elif stretch.mode == SLIDES:
        put_right(model.hold, t + h, new)
    return largest
