"""An explicit step of order 8.

The pair 8(5,3) of Dormand and Prince (:data:`puck_tables.motion.steppers.DORMAND_PRINCE_8`).  Its
error is h e₅²/√(e₅² + e₃²/100), of order 8, with e₅ and e₃ those of embedded methods of order 5, 3.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial.legendre import legint, legval, legvander

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.motion.steppers import DORMAND_PRINCE_8
from puck_tables.scene.equations import SIZE, by_floor, has_axes, rates_by_blade, rates_here
from puck_tables.scene.friction import VX, VY
from puck_tables.scene.ingredients import Phase

STAGES = len(DORMAND_PRINCE_8.c)  # the last one stands at the end of the step

_A, _C = DORMAND_PRINCE_8.a, DORMAND_PRINCE_8.c
_ERROR_5, _ERROR_3 = DORMAND_PRINCE_8.e
# of each stage, the first one besides that at the start that it is made of; and of the end
_SECOND = np.array([
    [*np.flatnonzero(row), stage, stage][1] for stage, row in enumerate(_A)
])  # fmt: skip
_LATE = int(_SECOND[-1])

# a step is known at so many shares of it, by weights of the stages for what an integral has come
# there, over 1, with the error h⁷, and for its rate: of a polynomial through all that are exact to
# h⁵, with different nodes
SHARES = 16
_EXACT = [n for n, row in enumerate(_A) if abs(row @ _C**4 - _C[n] ** 5 / 5) < 1e-14]
_NODES = [n for n in _EXACT if n == STAGES - 1 or _C[n] < 1.0]
_FIRST_NODE, _AT = _NODES[1], np.linspace(-1.0, 1.0, SHARES + 1)  # besides that at the start
_BASIS = np.linalg.inv(legvander(2.0 * _C[_NODES] - 1.0, len(_NODES) - 1))
_CHANGES, _RATES = np.zeros((2, SHARES + 1, STAGES))
_CHANGES[:, _NODES] = legval(_AT, 0.5 * legint(_BASIS, lbnd=-1)).T
_RATES[:, _NODES] = legval(_AT, _BASIS).T


@inlined
def come_by(share: int, h: float, work: FloatArray, i: int) -> float:
    """By how much a number of the state has changed at so many shares of a step done over h."""
    total = _CHANGES[share, 0] * work[0, i]
    for stage in range(_FIRST_NODE, STAGES):
        total += _CHANGES[share, stage] * work[stage, i]
    return h * total


@inlined
def rate_at(share: int, work: FloatArray, i: int) -> float:
    """The rate of a number of the state at so many shares of a step done."""
    total = _RATES[share, 0] * work[0, i]
    for stage in range(_FIRST_NODE, STAGES):
        total += _RATES[share, stage] * work[stage, i]
    return total


@inlined
def _five(y: FloatArray, i: int, h: float, stage: int, work: FloatArray, new: FloatArray) -> None:
    """Five numbers, from i on, of the state at a stage into ``new``.

    By name, so that they stay in registers: a compiler does not see that ``new`` and ``work`` are
    apart, and in loops over both to write and read again takes as long as to add.
    """
    w = h * _A[stage, 0]
    a, b, c = y[i] + w * work[0, i], y[i + 1] + w * work[0, i + 1], y[i + 2] + w * work[0, i + 2]
    d, e = y[i + 3] + w * work[0, i + 3], y[i + 4] + w * work[0, i + 4]
    for j in range(_SECOND[stage], stage):
        w = h * _A[stage, j]
        a, b, c = a + w * work[j, i], b + w * work[j, i + 1], c + w * work[j, i + 2]
        d, e = d + w * work[j, i + 3], e + w * work[j, i + 4]
    new[i], new[i + 1], new[i + 2], new[i + 3], new[i + 4] = a, b, c, d, e


@inlined
def explicit_step(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new``; its error in ``scale``.

    On entry work[0] is dy/dt at t, on return work[STAGES − 1] that at the end.  Velocities of a
    blade are by its own axes, on entry and on return.
    """
    own = has_axes(phase)
    for stage in range(1, STAGES):
        moment = t + h * _C[stage]
        _five(y, 0, h, stage, work, new)
        _five(y, 5, h, stage, work, new)
        along, across = new[VX], new[VY]
        if own:
            by_floor(phase, new)
        rates_here(phase, moment, new, work, stage)
        if own:
            new[VX], new[VY] = along, across
            rates_by_blade(phase, new, work, stage)
    largest = 0.0
    for i in range(SIZE):
        rate = work[0, i]
        fifth, third = _ERROR_5[0] * rate, _ERROR_3[0] * rate
        for k in range(_LATE, STAGES - 1):
            rate = work[k, i]
            fifth += _ERROR_5[k] * rate
            third += _ERROR_3[k] * rate
        measured = h / scale[i]
        fifth, third = measured * fifth, measured * third
        square = fifth * fifth
        below = square + 0.01 * third * third
        error = 0.0 if below == 0.0 else square * square / below  # squared
        if not error <= largest:
            largest = error
    return math.sqrt(largest)
