"""Bicubic spline on the graded grid, compiled: the table as the hot loop reads it.

The splined functions are the *friction ratios*

    1/ρ_∥,   ρ_⊥/ρ_∥,   ρ_ω/ρ_∥ ,

because in full contact each is a polynomial of degree ≤ 2 in δ, which a cubic spline reproduces
exactly: the δ axis costs nothing in accuracy and needs few nodes.  They are also what the
equations of motion need.

Coordinates: ``fast`` tells which side of φ = π/4 a point lies on, and

    η = |tan(φ − π/4)|^(1/4) = |(r|ω| − v)/(r|ω| + v)|^(1/4) ∈ [0, 1]

is uniform on the grid.  The resultants behave like x² ln|x| at φ = π/4; in η that is η⁸ ln η,
smooth enough for a cubic spline to keep order 4.  All slopes vanish at both ends of η (the
resultants are even about φ = 0 and π/2, and dφ/dη = 0 at π/4): each side is a clamped spline.

Coefficients: array (2, δ cells + 3, η cells + 3, 3) of B-spline weights over 36, so that the
B-splines can be taken without their 1/6: side, δ, η, function.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import allocating, inlined, kernel

FloatArray = npt.NDArray[np.float64]

_BLOCK = 128


@inlined
def basis(t: float) -> tuple[float, float, float, float]:
    """Six times the four uniform cubic B-splines that overlap a cell, at t ∈ [0, 1]."""
    s = 1.0 - t
    return s * s * s, 4.0 + t * t * (3.0 * t - 6.0), 4.0 + s * s * (3.0 * s - 6.0), t * t * t


@inlined
def cell_at(place: float, cells: int) -> int:
    """The cell of a place in [0, cells]: always one of them, also for what is no number.

    Where a place is no number the weights are none either, and so is what is looked up.
    """
    inside = place if place > 0.0 else 0.0
    last = cells - 1.0
    return int(inside if inside < last else last)


@inlined
def side_and_eta(phi: float) -> tuple[int, float]:
    """Side and graded coordinate η of an angle |φ| ≤ π/2; tan by Lambert's continued fraction."""
    x = abs(phi) - 0.25 * math.pi
    y = x * x
    up = x * (34459425.0 - y * (4729725.0 - y * (135135.0 - y * (990.0 - y))))
    down = 34459425.0 - y * (16216200.0 - y * (945945.0 - y * (13860.0 - 45.0 * y)))
    return (1 if x > 0.0 else 0), min(math.sqrt(math.sqrt(abs(up / down))), 1.0)


@inlined
def _row(
    c: FloatArray, k: np.uint64, w0: float, w1: float, w2: float, w3: float
) -> tuple[float, float, float]:
    """Three functions at once from four neighbouring coefficients each."""
    return (
        w0 * c[k] + w1 * c[k + 3] + w2 * c[k + 6] + w3 * c[k + 9],
        w0 * c[k + 1] + w1 * c[k + 4] + w2 * c[k + 7] + w3 * c[k + 10],
        w0 * c[k + 2] + w1 * c[k + 5] + w2 * c[k + 8] + w3 * c[k + 11],
    )


@allocating
def fill_resultants(
    coefficients: FloatArray, delta_max: float, phi: FloatArray, delta: FloatArray, out: FloatArray
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked.

    In blocks of three loops: where and with which weights (vectorised), the sums (short dependency
    chains: one point does not wait for another), the division (vectorised).
    """
    n_delta, n_eta = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    c = coefficients.reshape(-1)
    row = 3 * (n_eta + 3)
    step = np.uint64(row)
    first = np.empty(_BLOCK, np.int64)
    w = np.empty((8, _BLOCK))
    w0, w1, w2, w3 = w[0], w[1], w[2], w[3]
    v0, v1, v2, v3 = w[4], w[5], w[6], w[7]
    for start in range(0, phi.size, _BLOCK):
        angle = phi[start : start + _BLOCK]
        height = delta[start : start + _BLOCK]
        parallel = out[0, start : start + _BLOCK]
        perpendicular = out[1, start : start + _BLOCK]
        spin = out[2, start : start + _BLOCK]
        for n in range(angle.size):
            side, eta = side_and_eta(angle[n])
            p = eta * n_eta
            i = cell_at(p, n_eta)
            q = height[n] / delta_max * n_delta
            j = cell_at(q, n_delta)
            first[n] = (side * (n_delta + 3) + j) * row + 3 * i
            w0[n], w1[n], w2[n], w3[n] = basis(p - i)
            v0[n], v1[n], v2[n], v3[n] = basis(q - j)
        for n in range(angle.size):
            k = np.uint64(first[n])  # unsigned: no test for negative indices
            a, b, d, e = w0[n], w1[n], w2[n], w3[n]
            f0, g0, h0 = _row(c, k, a, b, d, e)
            f1, g1, h1 = _row(c, k + step, a, b, d, e)
            f2, g2, h2 = _row(c, k + step + step, a, b, d, e)
            f3, g3, h3 = _row(c, k + step + step + step, a, b, d, e)
            a, b, d, e = v0[n], v1[n], v2[n], v3[n]
            parallel[n] = a * f0 + b * f1 + d * f2 + e * f3
            perpendicular[n] = a * g0 + b * g1 + d * g2 + e * g3
            spin[n] = a * h0 + b * h1 + d * h2 + e * h3
        for n in range(angle.size):
            parallel[n] = 1.0 / parallel[n]
            perpendicular[n] *= parallel[n]
            spin[n] *= parallel[n]


@kernel
def cut(coefficients: FloatArray, delta_share: float, out: FloatArray) -> None:
    """Contract the δ axis once for a run at fixed δ/δ_max: ``out`` is flat, 2·3·(n_eta + 3)."""
    n_delta = coefficients.shape[1] - 3
    q = delta_share * n_delta
    j = cell_at(q, n_delta)
    w0, w1, w2, w3 = basis(q - j)
    k = 0
    for side in range(2):
        for i in range(coefficients.shape[2]):
            for f in range(3):
                out[k] = (
                    w0 * coefficients[side, j, i, f]
                    + w1 * coefficients[side, j + 1, i, f]
                    + w2 * coefficients[side, j + 2, i, f]
                    + w3 * coefficients[side, j + 3, i, f]
                )
                k += 1


@inlined
def evaluate_cut(cut_: FloatArray, side: int, eta: float) -> tuple[float, float, float]:
    """The three friction ratios at (side, η) from the contraction made by :func:`cut`."""
    row = cut_.size // 2
    n_eta = row // 3 - 3
    p = eta * n_eta
    i = cell_at(p, n_eta)
    w0, w1, w2, w3 = basis(p - i)
    return _row(cut_, np.uint64(side * row + 3 * i), w0, w1, w2, w3)
