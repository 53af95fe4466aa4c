"""Bicubic spline on the graded grid, compiled: the table as the hot loop reads it.

The splined functions are the *friction ratios*

    1/ρ_∥,   ρ_⊥/ρ_∥,   ρ_ω/ρ_∥ ,

because in full contact each is a polynomial of degree ≤ 2 in δ, which a cubic spline reproduces
exactly: the δ axis costs nothing in accuracy and needs few nodes.  They are also what the
equations of motion need.

Coordinates: ``fast`` tells which side of φ = π/4 a point lies on, and

    η = |tan(φ − π/4)|^(1/4) = |(r|ω| − v)/(r|ω| + v)|^(1/4) ∈ [0, 1]

is uniform on the grid.  The resultants behave like x² ln|x| at φ = π/4; in η that is η⁸ ln η, smooth
enough for a cubic spline to keep order 4.  All slopes vanish at both ends of η (the resultants are
even about φ = 0 and π/2, and dφ/dη = 0 at π/4), so every side is a clamped spline.

Coefficients: array (2, n_delta + 2, n_eta + 3, 3) of B-spline weights: side, δ, η, function.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import kernel

FloatArray = npt.NDArray[np.float64]


@kernel
def basis(t: float) -> tuple[float, float, float, float]:
    """The four uniform cubic B-splines that overlap a cell, at t ∈ [0, 1]."""
    s = 1.0 - t
    return (
        s * s * s / 6.0,
        (4.0 + t * t * (3.0 * t - 6.0)) / 6.0,
        (4.0 + s * s * (3.0 * s - 6.0)) / 6.0,
        t * t * t / 6.0,
    )


@kernel
def eta_of_phi(phi: float) -> tuple[int, float]:
    """Side and graded coordinate η of an angle |φ| ≤ π/2; tan by Lambert's continued fraction."""
    x = abs(phi) - 0.25 * math.pi
    y = x * x
    up = x * (34459425.0 - y * (4729725.0 - y * (135135.0 - y * (990.0 - y))))
    down = 34459425.0 - y * (16216200.0 - y * (945945.0 - y * (13860.0 - 45.0 * y)))
    return (1 if x > 0.0 else 0), min(math.sqrt(math.sqrt(abs(up / down))), 1.0)


@kernel
def evaluate(
    coefficients: FloatArray, side: int, eta: float, delta_share: float
) -> tuple[float, float, float]:
    """The three friction ratios at (side, η, δ/δ_max)."""
    n_delta = coefficients.shape[1] - 3
    n_eta = coefficients.shape[2] - 3
    p = eta * n_eta
    i = min(int(p), n_eta - 1)
    q = delta_share * n_delta
    j = min(int(q), n_delta - 1)
    w0, w1, w2, w3 = basis(p - i)
    inverse, across, spin = 0.0, 0.0, 0.0
    weights = basis(q - j)
    for m in range(4):
        c = coefficients[side, j + m]
        w = weights[m]
        inverse += w * (w0 * c[i, 0] + w1 * c[i + 1, 0] + w2 * c[i + 2, 0] + w3 * c[i + 3, 0])
        across += w * (w0 * c[i, 1] + w1 * c[i + 1, 1] + w2 * c[i + 2, 1] + w3 * c[i + 3, 1])
        spin += w * (w0 * c[i, 2] + w1 * c[i + 1, 2] + w2 * c[i + 2, 2] + w3 * c[i + 3, 2])
    return inverse, across, spin


@kernel
def cut(coefficients: FloatArray, delta_share: float, out: FloatArray) -> None:
    """Contract the δ axis once for a run at fixed δ: ``out`` is (2, n_eta + 3, 3)."""
    n_delta = coefficients.shape[1] - 3
    q = delta_share * n_delta
    j = min(int(q), n_delta - 1)
    w0, w1, w2, w3 = basis(q - j)
    for side in range(2):
        a, b = coefficients[side, j], coefficients[side, j + 1]
        c, d = coefficients[side, j + 2], coefficients[side, j + 3]
        for i in range(out.shape[1]):
            for f in range(3):
                out[side, i, f] = w0 * a[i, f] + w1 * b[i, f] + w2 * c[i, f] + w3 * d[i, f]


@kernel
def evaluate_cut(slice_: FloatArray, side: int, eta: float) -> tuple[float, float, float]:
    """The three friction ratios at (side, η) of a slice made by :func:`cut`."""
    n_eta = slice_.shape[1] - 3
    p = eta * n_eta
    i = min(int(p), n_eta - 1)
    w0, w1, w2, w3 = basis(p - i)
    c = slice_[side]
    return (
        w0 * c[i, 0] + w1 * c[i + 1, 0] + w2 * c[i + 2, 0] + w3 * c[i + 3, 0],
        w0 * c[i, 1] + w1 * c[i + 1, 1] + w2 * c[i + 2, 1] + w3 * c[i + 3, 1],
        w0 * c[i, 2] + w1 * c[i + 1, 2] + w2 * c[i + 2, 2] + w3 * c[i + 3, 2],
    )


@kernel
def fill_resultants(
    coefficients: FloatArray,
    delta_max: float,
    phi: FloatArray,
    delta: FloatArray,
    out: FloatArray,
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked."""
    for n in range(phi.size):
        side, eta = eta_of_phi(phi[n])
        inverse, across, spin = evaluate(coefficients, side, eta, delta[n] / delta_max)
        parallel = 1.0 / inverse
        out[0, n] = parallel
        out[1, n] = across * parallel
        out[2, n] = spin * parallel
