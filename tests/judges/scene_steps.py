"""A step of DOP853, and the state within it."""

from __future__ import annotations

import math

from numba import njit
from scene_motion import rates
from scipy.integrate._ivp import dop853_coefficients as dop

_A, _B, _C, _E3, _E5, _D = dop.A, dop.B, dop.C, dop.E3, dop.E5, dop.D
_STAGES, ALL = 12, 16


@njit(cache=True)
def stage(world, ctx, base, t, y, out, k, row, fr):
    """Rates at (t, y) into k[row]; returns the reactions of walls."""
    r = rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
    k[row] = out
    return r


@njit(cache=True)
def _stages(world, ctx, base, t, h, y, k, tmp, out, fr, first, end):
    for s in range(first, end):
        tmp[:] = y
        for j in range(s):
            a = h * _A[s, j]
            if a != 0.0:
                for i in range(6):
                    tmp[i] += a * k[j, i]
        stage(world, ctx, base, t + _C[s] * h, tmp, out, k, s, fr)


@njit(cache=True)
def advance(world, ctx, base, t, h, y, new, k, tmp, out, fr, size):
    """A step of DOP853 from y into ``new``; k[0] is known; its error over ``size``."""
    _stages(world, ctx, base, t, h, y, k, tmp, out, fr, 1, _STAGES)
    new[:] = y
    for j in range(_STAGES):
        for i in range(6):
            new[i] += h * _B[j] * k[j, i]
    stage(world, ctx, base, t + h, new, out, k, _STAGES, fr)
    e5, e3 = 0.0, 0.0
    for i in range(6):
        a, b = 0.0, 0.0
        for j in range(_STAGES + 1):
            a += _E5[j] * k[j, i]
            b += _E3[j] * k[j, i]
        e5 += (a / size[i]) ** 2
        e3 += (b / size[i]) ** 2
    if e5 == 0.0 and e3 == 0.0:
        return 0.0
    return abs(h) * e5 / math.sqrt((e5 + 0.01 * e3) * 6.0)


@njit(cache=True)
def prepare_dense(world, ctx, base, t, h, y, new, k, tmp, out, fr, f):
    """What :func:`dense` needs of that step, into ``f`` (7, 6)."""
    _stages(world, ctx, base, t, h, y, k, tmp, out, fr, _STAGES + 1, ALL)
    for i in range(6):
        d = new[i] - y[i]
        f[0, i] = d
        f[1, i] = h * k[0, i] - d
        f[2, i] = 2.0 * d - h * (k[_STAGES, i] + k[0, i])
        for j in range(4):
            total = 0.0
            for s in range(ALL):
                total += _D[j, s] * k[s, i]
            f[3 + j, i] = h * total


@njit(cache=True)
def dense(y, f, x, at):
    """The state at the share x of the step."""
    for i in range(6):
        v = 0.0
        for j in range(7):
            v += f[6 - j, i]
            v *= x if j % 2 == 0 else 1.0 - x
        at[i] = y[i] + v
