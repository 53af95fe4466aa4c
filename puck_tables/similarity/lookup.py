"""Stops by look-up, compiled: a launch in Cartesian components, square roots, one cell, no angle.

With Q = hypot(v, rω), T = ``time``, and the factors that vanish taken out,

    X = cos φ · along,   Y = δ sin φ cos φ · across,   path = cos φ · length,   body = sin φ · body,

the stop of a launch (vx, vy), ω is

    t = (Q/J) T,    x = (Q · along · vx − δ rω · across · vy)/J,    y likewise,

and no direction has to be computed: at rest, in pure sliding and in pure spin nothing is divided
by zero.  Each function is a cubic spline in ξ (see :mod:`puck_tables.similarity.axes`) whose
coefficients are polynomials in s = 2δ² − 1: array (2 sides, cells + 3, powers × functions).
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import basis

FloatArray = npt.NDArray[np.float64]

STOP_POWERS = 8
_DEGREE = STOP_POWERS - 1
CURVE_ROW = 40  # four functions by nine powers, padded to whole cache lines
STOP_ROW = 3 * STOP_POWERS  # whole cache lines
_BLOCK = 128


@inlined
def slip_place(speed: float, rim: float) -> tuple[int, float]:
    """Side (1: r|ω| > v) and ξ of a motion; 1 − q without cancellation next to φ = π/4."""
    raised = 2.0**200 if speed + rim < 1e-290 else 1.0  # the inverse of the least would overflow
    speed, rim = raised * speed, raised * rim
    total = speed + rim
    inverse = 1.0 / total if total > 0.0 else 0.0
    q = math.sqrt(math.sqrt(2.0 * min(speed, rim) * inverse))
    rest = abs(speed - rim) * inverse / ((1.0 + q) * (1.0 + q * q))
    return (1 if rim > speed else 0), 1.0 - math.sqrt(rest)


@inlined
def _safe(speed2: float, rim2: float) -> bool:
    """Whether squares of speeds have lost nothing to over- or underflow."""
    largest = max(speed2, rim2)
    return 1e-250 < largest < 1e250


@kernel
def fill_stops_by_table(launches: FloatArray, coefficients: FloatArray, out: FloatArray) -> int:
    """Stop time, x, y of launches (6, n): vx, vy, ω, δ, J, r, into ``out`` (3, n).

    Returns of how many Q²/J or Q²/(J r) is too large for floating point.  In blocks of three
    loops, as in :mod:`puck_tables.kernels.spline`: places and weights (vectorised), sums over a
    cell, results (vectorised).
    """
    cells = coefficients.shape[1] - 3
    side_stride = coefficients.shape[1] * STOP_ROW
    c = coefficients.reshape(-1)
    first = np.empty(_BLOCK, np.int64)
    w0, w1, w2, w3 = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    slip, edge = np.empty(_BLOCK), np.empty(_BLOCK)
    sums = np.empty(STOP_ROW)
    overflows = 0
    for start in range(0, launches.shape[1], _BLOCK):
        vx = launches[0, start : start + _BLOCK]
        vy = launches[1, start : start + _BLOCK]
        spin = launches[2, start : start + _BLOCK]
        delta = launches[3, start : start + _BLOCK]
        decel = launches[4, start : start + _BLOCK]
        radius = launches[5, start : start + _BLOCK]
        time = out[0, start : start + _BLOCK]
        x = out[1, start : start + _BLOCK]
        y = out[2, start : start + _BLOCK]
        unsafe = 0
        for n in range(vx.size):
            speed2 = vx[n] * vx[n] + vy[n] * vy[n]
            edge[n] = radius[n] * spin[n]
            rim2 = edge[n] * edge[n]
            unsafe += 0 if _safe(speed2, rim2) else 1
            slip[n] = math.sqrt(speed2 + rim2)
            side, xi = slip_place(math.sqrt(speed2), abs(edge[n]))
            p = xi * cells
            i = min(int(p), cells - 1)
            first[n] = side * side_stride + i * STOP_ROW
            w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        if unsafe > 0:  # anew, with care for the largest and smallest numbers
            for n in range(vx.size):
                if _safe(vx[n] * vx[n] + vy[n] * vy[n], edge[n] * edge[n]):
                    continue  # the same bits whatever else is in the block
                speed = math.hypot(vx[n], vy[n])
                slip[n] = math.hypot(speed, edge[n])
                side, xi = slip_place(speed, abs(edge[n]))
                p = xi * cells
                i = min(int(p), cells - 1)
                first[n] = side * side_stride + i * STOP_ROW
                w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        for n in range(vx.size):
            k = np.uint64(first[n])
            a, b, d, e = w0[n], w1[n], w2[n], w3[n]
            for m in range(STOP_ROW):
                o = k + np.uint64(m)
                sums[m] = (
                    a * c[o]
                    + b * c[o + np.uint64(STOP_ROW)]
                    + d * c[o + np.uint64(2 * STOP_ROW)]
                    + e * c[o + np.uint64(3 * STOP_ROW)]
                )
            s = 2.0 * delta[n] * delta[n] - 1.0
            f, g, h = sums[3 * _DEGREE], sums[3 * _DEGREE + 1], sums[3 * _DEGREE + 2]
            for m in range(_DEGREE - 1, -1, -1):
                f = f * s + sums[3 * m]
                g = g * s + sums[3 * m + 1]
                h = h * s + sums[3 * m + 2]
            time[n], x[n], y[n] = f, g, h
        for n in range(vx.size):
            along = slip[n] * (0.5 if edge[n] == 0.0 else x[n])
            across = delta[n] * edge[n] * y[n]
            still = vx[n] == 0.0 and vy[n] == 0.0
            t = 1.0 if edge[n] == 0.0 else (0.75 if still else time[n])
            scale = slip[n] / decel[n]
            time[n] = scale * t
            x[n] = (along * vx[n] - across * vy[n]) / decel[n]
            y[n] = (along * vy[n] + across * vx[n]) / decel[n]
            overflows += 0 if math.isfinite(scale * slip[n] / radius[n] + scale * slip[n]) else 1
    return overflows
