"""One step of the classical Runge–Kutta method, and of the Dormand–Prince 5(4) pair."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import kernel
from puck_tables.motion.equations import SIZE, derivatives

FloatArray = npt.NDArray[np.float64]

STAGES = 8  # rows of work space: seven stages and one state

# Dormand and Prince 1980, RK5(4)7M
_C = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
_A = np.zeros((7, 7))
_A[1, :1] = [1 / 5]
_A[2, :2] = [3 / 40, 9 / 40]
_A[3, :3] = [44 / 45, -56 / 15, 32 / 9]
_A[4, :4] = [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729]
_A[5, :5] = [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656]
_A[6, :6] = [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]
_E = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])


@kernel
def rk4_step(
    s: float,
    y: FloatArray,
    h: float,
    cut: FloatArray,
    delta: float,
    work: FloatArray,
    out: FloatArray,
) -> None:
    """Classical Runge–Kutta of order 4 from (s, y) over h into ``out``; work[0] holds dy/ds at s."""
    k1, k2, k3, k4, middle = work[0], work[1], work[2], work[3], work[7]
    for i in range(SIZE):
        middle[i] = y[i] + 0.5 * h * k1[i]
    derivatives(s + 0.5 * h, middle, cut, delta, k2)
    for i in range(SIZE):
        middle[i] = y[i] + 0.5 * h * k2[i]
    derivatives(s + 0.5 * h, middle, cut, delta, k3)
    for i in range(SIZE):
        middle[i] = y[i] + h * k3[i]
    derivatives(s + h, middle, cut, delta, k4)
    for i in range(SIZE):
        out[i] = y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])


@kernel
def pair_step(
    s: float,
    y: FloatArray,
    h: float,
    cut: FloatArray,
    delta: float,
    work: FloatArray,
    out: FloatArray,
) -> float:
    """Dormand–Prince from (s, y) over h into ``out``; returns the largest local error estimate.

    work[0] holds dy/ds at s; work[6] then holds it at s + h.
    """
    state = work[7]
    for stage in range(1, 7):
        for i in range(SIZE):
            total = 0.0
            for j in range(stage):
                total += _A[stage, j] * work[j, i]
            state[i] = y[i] + h * total
        derivatives(s + _C[stage] * h, state, cut, delta, work[stage])
    largest = 0.0
    for i in range(SIZE):
        out[i] = state[i]
        error = 0.0
        for j in range(7):
            error += _E[j] * work[j, i]
        error = abs(h * error)
        if not error <= largest:  # a NaN is never small
            largest = error
    return largest
