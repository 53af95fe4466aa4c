"""The bicubic table over φ and δ on the same nodes: what polynomials of the height are worth."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, patience
from puck_tables.kernels.spline import basis, cell_at, row_sums, side_and_eta
from puck_tables.table.resultant_table import HEIGHTS, ResultantTable
from puck_tables.table.spline_fit import clamped_coefficients

_BLOCK = 128  # points at once


def graded_coefficients(table: ResultantTable) -> FloatArray:
    """B-spline weights over 36 of the friction ratios at the nodes of a table with one edge."""
    parallel = table.values[..., :1]
    ratios = np.concatenate([1.0 / parallel, table.values[..., 1:] / parallel], axis=-1)
    along_phi = clamped_coefficients(np.moveaxis(table.axis.by_side(ratios), 0, 1))
    # over four heights one cubic: of p the coefficients are p − p″/6
    powers, places = np.arange(HEIGHTS), np.arange(-1.0, HEIGHTS + 1.0)[:, None]
    bent = powers * (powers - 1) / 6.0 * places ** np.maximum(powers - 2, 0)
    of_values = (places**powers - bent) @ np.linalg.inv(places[1:-1] ** powers)
    return np.ascontiguousarray(np.einsum("mj,nsjf->smnf", of_values, along_phi)) / 36.0


@allocating
def fill_bicubic(
    coefficients: FloatArray, delta_max: float, phi: FloatArray, delta: FloatArray, out: FloatArray
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked.

    In blocks of three loops: where and with which weights (vectorised), the sums (short dependency
    chains: one point does not wait for another), the division (vectorised).
    """
    patience(phi.size)
    n_delta, n_eta = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    c = coefficients.reshape(-1)
    row = 3 * (n_eta + 3)
    step = np.uint64(row)
    first, w = np.empty(_BLOCK, np.int64), np.empty((8, _BLOCK))
    w0, w1, w2, w3, v0, v1, v2, v3 = w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7]
    for start in range(0, phi.size, _BLOCK):
        angle, height = phi[start : start + _BLOCK], delta[start : start + _BLOCK]
        values = out[:, start : start + _BLOCK]
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
            f0, g0, h0 = row_sums(c, k, a, b, d, e)
            f1, g1, h1 = row_sums(c, k + step, a, b, d, e)
            f2, g2, h2 = row_sums(c, k + step + step, a, b, d, e)
            f3, g3, h3 = row_sums(c, k + step + step + step, a, b, d, e)
            a, b, d, e = v0[n], v1[n], v2[n], v3[n]
            values[0, n] = a * f0 + b * f1 + d * f2 + e * f3
            values[1, n] = a * g0 + b * g1 + d * g2 + e * g3
            values[2, n] = a * h0 + b * h1 + d * h2 + e * h3
        for n in range(angle.size):
            values[0, n] = 1.0 / values[0, n]
            values[1, n] *= values[0, n]
            values[2, n] *= values[0, n]
