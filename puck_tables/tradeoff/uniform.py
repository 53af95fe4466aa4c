"""A bicubic table on a grid uniform in φ: what grading is worth."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import kernel
from puck_tables.kernels.spline import basis, cell_at
from puck_tables.table.check import by_closed_form
from puck_tables.table.fit import clamped_coefficients, not_a_knot_coefficients

FloatArray = npt.NDArray[np.float64]


def uniform_coefficients(n_phi: int, n_delta: int = 4) -> FloatArray:
    """B-spline weights over 36 of the friction ratios on [0, π/2] × [0, 1].

    Parameters
    ----------
    n_phi, n_delta : numbers of nodes

    Returns
    -------
    array (n_delta + 2, n_phi + 2, 3)

    Examples
    --------
    >>> uniform_coefficients(9).shape
    (6, 11, 3)
    """
    phi, delta = np.linspace(0.0, 0.5 * np.pi, n_phi), np.linspace(0.0, 1.0, n_delta)
    rho = by_closed_form(phi[:, None], delta)
    ratios = np.stack(
        [1.0 / rho.parallel, rho.perpendicular / rho.parallel, rho.spin / rho.parallel], axis=-1
    )
    along_phi = clamped_coefficients(ratios)
    along_delta = not_a_knot_coefficients(np.moveaxis(along_phi, 1, 0))
    return np.ascontiguousarray(along_delta) / 36.0


@kernel
def fill_uniform(
    c: FloatArray, phi: FloatArray, delta: FloatArray, sums: FloatArray, out: FloatArray
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at points with 0 ≤ φ ≤ π/2 into ``out`` (3, n); ``sums`` (3,) is work space."""
    cells_delta, cells_phi = c.shape[0] - 3, c.shape[1] - 3
    scale = cells_phi / (0.5 * np.pi)
    for n in range(phi.size):
        p, q = phi[n] * scale, delta[n] * cells_delta
        i, j = cell_at(p, cells_phi), cell_at(q, cells_delta)
        a, b, d, e = basis(p - i)
        v = basis(q - j)
        for f in range(3):
            sums[f] = 0.0
            for m in range(4):
                sums[f] += v[m] * (
                    a * c[j + m, i, f]
                    + b * c[j + m, i + 1, f]
                    + d * c[j + m, i + 2, f]
                    + e * c[j + m, i + 3, f]
                )
        out[0, n] = 1.0 / sums[0]
        out[1, n] = sums[1] * out[0, n]
        out[2, n] = sums[2] * out[0, n]
