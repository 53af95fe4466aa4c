"""The table of friction resultants as compiled code reads it: five splines over the slip angle.

In full contact the *friction ratios* are polynomials of the height under every pressure law,

    1/ρ_∥ = a₀ + a₂ δ²,    ρ_⊥/ρ_∥ = b₁ δ,    ρ_ω/ρ_∥ = c₀ + c₂ δ² ,

with functions of φ alone.  They are also what the equations of motion need.  Five cubic splines in
η then do what three bicubic ones do, with 20 products a point instead of 48 and a fifth of the
memory.

Coefficients: array (sides, η cells + 3, 5) of B-spline weights over 6, in the order a₀, a₂, b₁, c₀,
c₂; sides: rows of line, end and extent as in :mod:`puck_tables.table.slip_axis`.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, kernel, patience
from puck_tables.kernels.section_spline import (
    HEADER,
    INERTIA,
    INVERSE_EXTENT,
    LINE_COS,
    LINE_SIN,
    PLAIN,
    RATIOS,
    UPPER_COS,
    UPPER_SIN,
)
from puck_tables.kernels.spline import basis, cell_at, side_and_eta

TERMS = 5  # of the ratios over δ (table.fit.height_terms)
NO_COLUMNS = np.empty((2, 0, TERMS))  # closed forms; read-only like those of a table
NO_COLUMNS.flags.writeable = False
_BLOCK = 128  # points at once: their numbers fit the first cache
_HALF_ROOT = math.sqrt(0.5)


@inlined
def _side_and_eta(phi: float, sides: FloatArray) -> tuple[int, float]:
    """Side and η ∈ [0, 1] of an angle |φ| ≤ π/2."""
    angle = abs(phi)
    side = 0
    while side < len(sides) - 1 and angle > max(sides[side, 0], sides[side, 1]):
        side += 1
    _, eta = side_and_eta(0.25 * np.pi + angle - sides[side, 0])
    return side, min(eta / abs(sides[side, 2]) ** 0.25, 1.0)


@allocating
def fill_resultants(
    coefficients: FloatArray, sides: FloatArray, phi: FloatArray, delta: FloatArray, out: FloatArray
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked.

    In blocks of three loops: where and with which weights (vectorised where π/4 is the only line),
    the sums (short dependency chains: one point does not wait for another), the division.
    """
    patience(phi.size)
    n_eta = coefficients.shape[1] - 3
    c = coefficients.reshape(-1)
    side_stride = TERMS * (n_eta + 3)
    one_line = len(sides) == 2
    first = np.empty(_BLOCK, np.int64)
    w0, w1, w2, w3 = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, phi.size, _BLOCK):
        angle = phi[start : start + _BLOCK]
        height = delta[start : start + _BLOCK]
        parallel = out[0, start : start + _BLOCK]
        perpendicular = out[1, start : start + _BLOCK]
        spin = out[2, start : start + _BLOCK]
        if one_line:
            for n in range(angle.size):
                side, eta = side_and_eta(angle[n])
                p = eta * n_eta
                i = cell_at(p, n_eta)
                first[n] = side * side_stride + TERMS * i
                w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        else:
            for n in range(angle.size):
                side, eta = _side_and_eta(angle[n], sides)
                p = eta * n_eta
                i = cell_at(p, n_eta)
                first[n] = side * side_stride + TERMS * i
                w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        for n in range(angle.size):
            k = np.uint64(first[n])  # unsigned: no test for negative indices
            f = c[k : k + np.uint64(4 * TERMS)]
            a, b, d, e = w0[n], w1[n], w2[n], w3[n]
            h = height[n]
            h2 = h * h
            parallel[n] = (
                a * (f[0] + h2 * f[1])
                + b * (f[5] + h2 * f[6])
                + d * (f[10] + h2 * f[11])
                + e * (f[15] + h2 * f[16])
            )
            perpendicular[n] = h * (a * f[2] + b * f[7] + d * f[12] + e * f[17])
            spin[n] = (
                a * (f[3] + h2 * f[4])
                + b * (f[8] + h2 * f[9])
                + d * (f[13] + h2 * f[14])
                + e * (f[18] + h2 * f[19])
            )
        for n in range(angle.size):
            parallel[n] = 1.0 / parallel[n]
            perpendicular[n] *= parallel[n]
            spin[n] *= parallel[n]


@kernel
def section_at(coefficients: FloatArray, delta: float, out: FloatArray) -> None:
    """The section of plain pucks at one height into ``out``, of :func:`room_for_section`."""
    for side in range(coefficients.shape[0]):
        k = HEADER
        for i in range(coefficients.shape[1]):
            row = coefficients[side, i]
            out[side, k] = row[0] + delta * delta * row[1]
            out[side, k + 1] = delta * row[2]
            out[side, k + 2] = row[3] + delta * delta * row[4]
            k += 3


@allocating
def room_for_section(coefficients: FloatArray) -> FloatArray:
    """A section with the header of plain pucks; no rows where there are no coefficients."""
    sides, nodes = coefficients.shape[0], coefficients.shape[1]
    out = np.zeros((sides if nodes > 0 else 0, HEADER + RATIOS * nodes))
    for side in range(out.shape[0]):
        out[side, LINE_COS], out[side, LINE_SIN] = _HALF_ROOT, _HALF_ROOT  # φ = π/4, LINE = 0
        out[side, UPPER_COS] = _HALF_ROOT if side == 0 else 0.0
        out[side, UPPER_SIN] = _HALF_ROOT if side == 0 else 1.0
        out[side, INVERSE_EXTENT], out[side, INERTIA], out[side, PLAIN] = 1.0, 0.5, 1.0
    return out
