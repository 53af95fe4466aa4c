"""A step of Radau IIA, order 5, for slips whose direction settles much faster than they change.

The three stages z_i = y(t + c_i h) − y solve z = h A f(y + z).  Only velocities and spin are stiff:
Newton's iteration uses the Jacobian of their rates at the start of the step, by differences, at
each stage scaled by how much faster a smaller slip settles, and takes the rest along.  The error is
that of Hairer and Wanner (Solving Ordinary Differential Equations II, IV.8), (μ/h − J)⁻¹ (f₀ +
Σ e_i z_i/h).
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.equations import (
    FIRST,
    SECOND,
    SIZE,
    rates_in_step,
    settling_rates,
    slip_speed,
    stopping,
)
from puck_tables.scene.friction import SPIN, VX, X
from puck_tables.scene.ingredients import Phase

_ROOT = math.sqrt(6.0)
_A = np.array([
    [(88 - 7 * _ROOT) / 360, (296 - 169 * _ROOT) / 1800, (-2 + 3 * _ROOT) / 225],
    [(296 + 169 * _ROOT) / 1800, (88 + 7 * _ROOT) / 360, (-2 - 3 * _ROOT) / 225],
    [(16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / 9],
])  # fmt: skip
_C = _A.sum(axis=1)
# the estimate of the error: its weights e, and μ, the real eigenvalue of A⁻¹
_ERROR = np.array([-13 - 7 * _ROOT, -13 + 7 * _ROOT, -1.0]) / 3.0
_MU = 3.0 + 3.0 ** (2 / 3) - 3.0 ** (1 / 3)
_STIFF = 3  # vx, vy, spin
RADAU_ROWS = 13 + 3 * _STIFF  # of what a step works in, the last for the matrix of Newton's method
_LEAST = 0.1  # of the slip: that a step leaves, as Newton's iteration foresees it
_NUDGE = 1e-5  # of the slip: of the differences
_ITERATIONS = 12  # of Newton's method: beyond, the step is shortened
_RELATIVE = 1e-3  # of the slip: no step is worse
_ROUNDING = 1e-12  # of the scales: what no iteration makes better, and
_NOISE = 1e-14  # of what friction alone would do in the step
_LENGTH = 1e-14  # of a step's length: its places and energies are known to that, however short
_SURE = 1e-6  # of it: how well the stages are known


@inlined
def _factored(matrix: FloatArray, order: FloatArray) -> bool:
    """LU with row pivoting in place; whether it can be solved."""
    size = matrix.shape[0]
    for k in range(size):
        best = k
        for i in range(k + 1, size):
            best = i if abs(matrix[i, k]) > abs(matrix[best, k]) else best
        order[k] = best
        if not abs(matrix[best, k]) > 0.0:
            return False
        for j in range(size):
            matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        for i in range(k + 1, size):
            matrix[i, k] /= matrix[k, k]
            for j in range(k + 1, size):
                matrix[i, j] -= matrix[i, k] * matrix[k, j]
    return True


@inlined
def _solve(matrix: FloatArray, order: FloatArray, b: FloatArray) -> None:
    size = matrix.shape[0]
    for k in range(size):
        best = int(order[k])
        b[k], b[best] = b[best], b[k]
    for i in range(size):
        for j in range(i):
            b[i] -= matrix[i, j] * b[j]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, size):
            b[i] -= matrix[i, j] * b[j]
        b[i] /= matrix[i, i]


@inlined
def _jacobian(
    phase: Phase, t: float, y: FloatArray, at: FloatArray, rows: FloatArray, out: FloatArray
) -> None:
    """∂(vx, vy, spin)′/∂(vx, vy, spin) at (t, y) by central differences into ``out`` (3, 3).

    A slip that begins grows slowly beside how fast it settles: one-sided ones would hide it.
    """
    slip, radius = slip_speed(phase.model.body.radius, y), phase.model.body.radius
    for i in range(SIZE):
        at[i] = y[i]
    for j in range(_STIFF):
        nudge = _NUDGE * (slip if slip > 0.0 else 1.0) / (radius if VX + j == SPIN else 1.0)
        at[VX + j] = y[VX + j] - nudge
        rates_in_step(phase, t, at, rows, FIRST)
        at[VX + j] = y[VX + j] + nudge
        rates_in_step(phase, t, at, rows, SECOND)
        at[VX + j] = y[VX + j]
        for i in range(_STIFF):
            out[i, j] = 0.5 * (rows[1, VX + i] - rows[0, VX + i]) / nudge


@inlined
def _stiffer(phase: Phase, h: float, y: FloatArray, work: FloatArray) -> float:
    """By what the slip settles faster after h, when it has changed at its rate of now, work[0]."""
    model, q = phase.model, slip_speed(phase.model.body.radius, y)
    if not q > 0.0:
        return 1.0
    damps, turns = settling_rates(model, phase.friction.load)
    later = max(q + h * stopping(model.body.radius, y, work)[3], _LEAST * q)
    return (damps + turns / later) / (damps + turns / q)


@kernel
def radau_step(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new``; its error in ``scale``.

    inf: Newton's iteration did not converge.  On entry work[0] is dy/dt at t; its other rows,
    RADAU_ROWS in all, are to work in.
    """
    rows, z, at = work[1:4], work[4:7], work[7]
    jacobian, step, order = work[8:11], work[11, : 3 * _STIFF], work[12]
    matrix = work[13:RADAU_ROWS, : 3 * _STIFF]
    _jacobian(phase, t, y, at, rows, jacobian)
    for stage in range(3):
        stiffer = h * _stiffer(phase, _C[stage] * h, y, work)
        for j in range(_STIFF):
            column = _STIFF * stage + j
            for i in range(3 * _STIFF):
                part = stiffer * _A[i // _STIFF, stage] * jacobian[i % _STIFF, j]
                matrix[i, column] = (1.0 if i == column else 0.0) - part
    if not _factored(matrix, order):
        return math.inf
    for stage in range(3):
        for i in range(SIZE):
            is_damped = VX <= i < VX + _STIFF  # within the step, so its rate now says nothing of it
            z[stage, i] = 0.0 if is_damped else h * _C[stage] * work[0, i]
    before, slip_scale = math.inf, scale[VX]
    friction, body = phase.friction, phase.model.body
    brakes = abs(h) * friction.load / (body.mass * slip_scale)
    rounding = _ROUNDING + _NOISE * brakes
    for i in range(SIZE):
        new[i] = math.nan
    for iteration in range(_ITERATIONS):
        for stage in range(3):
            for i in range(SIZE):
                at[i] = y[i] + z[stage, i]
            rates_in_step(phase, t + _C[stage] * h, at, rows, stage)
        largest, of_damped = 0.0, 0.0
        for stage in range(3):
            for i in range(SIZE):
                whole = 0.0
                for j in range(3):
                    whole += _A[stage, j] * rows[j, i]
                whole *= h
                if VX <= i < VX + _STIFF:
                    step[_STIFF * stage + i - VX] = whole - z[stage, i]
                else:
                    change = abs(whole - z[stage, i]) / scale[i]
                    of_damped = max(of_damped, change)
                    z[stage, i] = whole
        _solve(matrix, order, step)
        moved = 0.0
        for stage in range(3):
            for i in range(_STIFF):
                change = abs(step[_STIFF * stage + i]) / scale[VX + i]
                largest = change if not change <= largest else largest
                moved = max(moved, change * slip_scale)
                z[stage, VX + i] += step[_STIFF * stage + i]
        for i in range(SIZE):
            at[i] = y[i] + z[2, i]
        sure = moved <= _SURE * max(slip_speed(body.radius, y), slip_speed(body.radius, at))
        # the step carries what rounding leaves of velocities on to places and energies
        noise = max(largest, of_damped / (1.0 + brakes))
        largest = max(largest, of_damped)
        stalls = iteration > 1 and largest >= 0.3 * before and noise <= rounding
        if sure and (largest <= phase.newton or stalls):
            break
        if not largest < math.inf or (iteration > 2 and largest > 0.9 * before):
            return math.inf
        before = largest
    else:
        return math.inf
    for i in range(SIZE):
        new[i] = y[i] + z[2, i]
    matrix = matrix[:_STIFF, :_STIFF]
    return _error(phase, h, y, scale, work, z, new, jacobian, matrix, order, step[:_STIFF])


@inlined
def _error(
    phase: Phase, h: float, y: FloatArray, scale: FloatArray, work: FloatArray, z: FloatArray,
    new: FloatArray, jacobian: FloatArray, matrix: FloatArray, order: FloatArray, b: FloatArray,
) -> float:  # fmt: skip
    """In ``scale``, and of velocities also against the slip that is left.

    Worked out in ``matrix`` (3, 3), ``order`` and ``b`` (3,).
    """
    for i in range(_STIFF):
        for j in range(_STIFF):
            matrix[i, j] = (_MU / h if i == j else 0.0) - jacobian[i, j]
    if not _factored(matrix, order):
        return math.inf
    largest, radius = 0.0, phase.model.body.radius
    left = max(slip_speed(radius, y), slip_speed(radius, new))
    for i in range(SIZE):
        defect = work[0, i]
        for j in range(3):
            defect += _ERROR[j] * z[j, i] / h
        if VX <= i < VX + _STIFF:
            b[i - VX] = defect
        else:
            length = abs(work[0, i]) / scale[i] + left / scale[X]
            largest = max(largest, h * (abs(defect) / _MU / scale[i] - _LENGTH * length))
    _solve(matrix, order, b)
    for i in range(_STIFF):
        size = scale[VX + i]
        error = abs(b[i]) / size
        relative = abs(b[i]) * (radius if VX + i == SPIN else 1.0)
        if relative > _RELATIVE * left:
            error = max(error, 1.0)  # more than any tolerance
        largest = error if not error <= largest else largest
    return largest
