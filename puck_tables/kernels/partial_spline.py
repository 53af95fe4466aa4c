"""Bicubic spline of what lifting off changes in the resultants, compiled.

Splined is the *excess* of ρ_∥, ρ_⊥, ρ_ω in partial contact over the law of full contact at the same
φ and δ: it grows from zero like (δ − δ_c)^(5/2), so that no error of the table shows where contact
opens, and where the slip axis ends.  Coordinates as in :mod:`puck_tables.table.partial_grid`:
η = |tan(φ − π/4)|^(1/4) on either side of π/4, over its largest value there, and ζ from the height
δ_c at which contact opens.  1/δ_c² is splined too, over η (δ_c itself runs off to infinity not far
beyond the table), so that a look-up takes one logarithm and no elliptic integral.

Coefficients: (2, ζ cells + 3, η cells + 3, 3) B-spline weights over 36: side, ζ, η, function;
opening: (2, η cells + 3) over 6, of 1/δ_c².
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.closed_form import friction_ratios
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import basis, cell_at, side_and_eta

FloatArray = npt.NDArray[np.float64]


@inlined
def partial_excess(
    coefficients: FloatArray,
    opening: FloatArray,
    ends: FloatArray,
    side: int,
    eta: float,
    delta: float,
) -> tuple[bool, float, float, float]:
    """Whether contact is partial at (side, η, δ), and what that adds to ρ_∥, ρ_⊥, ρ_ω.

    ``ends``: largest η of side 0 and 1, largest ζ, δ_c at π/4, and the height where pucks tip.
    """
    n_zeta, n_eta = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    p = eta / ends[side] * n_eta
    if p > n_eta:  # full contact at every height of the table
        return False, 0.0, 0.0, 0.0
    i = cell_at(p, n_eta)
    u0, u1, u2, u3 = basis(p - i)
    critical = 1.0 / math.sqrt(
        u0 * opening[side, i] + u1 * opening[side, i + 1]
        + u2 * opening[side, i + 2] + u3 * opening[side, i + 3]
    )  # fmt: skip
    if delta <= critical:
        return False, 0.0, 0.0, 0.0
    top = ends[4] * max(1.0, critical / ends[3])
    zeta = math.sqrt(math.log((top - critical) / (top - delta)))
    q = zeta / ends[2] * n_zeta
    j = cell_at(q, n_zeta)
    v0, v1, v2, v3 = basis(q - j)
    parallel, perpendicular, spin = 0.0, 0.0, 0.0
    for k, v in enumerate((v0, v1, v2, v3)):
        row = coefficients[side, j + k]
        parallel += v * (
            u0 * row[i, 0] + u1 * row[i + 1, 0] + u2 * row[i + 2, 0] + u3 * row[i + 3, 0]
        )
        perpendicular += v * (
            u0 * row[i, 1] + u1 * row[i + 1, 1] + u2 * row[i + 2, 1] + u3 * row[i + 3, 1]
        )
        spin += v * (u0 * row[i, 2] + u1 * row[i + 1, 2] + u2 * row[i + 2, 2] + u3 * row[i + 3, 2])
    return True, parallel, perpendicular, spin


@kernel
def fill_partial(
    coefficients: FloatArray, opening: FloatArray, ends: FloatArray,
    phi: FloatArray, delta: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked."""
    for n in range(phi.size):
        cosine, sine = abs(math.cos(phi[n])), abs(math.sin(phi[n]))
        inverse, across, turning = friction_ratios(
            min(sine, cosine) / max(sine, cosine), 1.0 if sine > cosine else 0.0, delta[n]
        )
        side, eta = side_and_eta(phi[n])
        _, parallel, perpendicular, spin = partial_excess(
            coefficients, opening, ends, side, eta, delta[n]
        )
        out[0, n] = 1.0 / inverse + parallel
        out[1, n] = across / inverse + perpendicular
        out[2, n] = turning / inverse + spin
