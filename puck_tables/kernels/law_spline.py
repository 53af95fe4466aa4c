"""Bicubic spline of the friction ratios under any pressure law, compiled.

As :mod:`puck_tables.kernels.spline`, with as many sides as the law has regions.  Coefficients:
(sides, δ cells + 3, η cells + 3, 3) over 36; ``sides``: rows of line, end and extent as in
:mod:`puck_tables.table.law_grid`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import basis, cell_at, side_and_eta

FloatArray = npt.NDArray[np.float64]

_QUARTER = 0.25 * np.pi


@inlined
def law_side_and_eta(phi: float, sides: FloatArray) -> tuple[int, float]:
    """Side and η ∈ [0, 1] of an angle |φ| ≤ π/2."""
    angle = abs(phi)
    side = 0
    while side < len(sides) - 1 and angle > max(sides[side, 0], sides[side, 1]):
        side += 1
    _, eta = side_and_eta(_QUARTER + angle - sides[side, 0])
    return side, min(eta / abs(sides[side, 2]) ** 0.25, 1.0)


@inlined
def law_ratios(
    coefficients: FloatArray, sides: FloatArray, phi: float, delta_share: float
) -> tuple[float, float, float]:
    """1/ρ_∥, ρ_⊥/ρ_∥ and ρ_ω/ρ_∥ at φ and δ/δ_max."""
    n_delta, n_eta = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    side, eta = law_side_and_eta(phi, sides)
    p = eta * n_eta
    i = cell_at(p, n_eta)
    u = basis(p - i)
    q = delta_share * n_delta
    j = cell_at(q, n_delta)
    inverse, across, turning = 0.0, 0.0, 0.0
    for k, v in enumerate(basis(q - j)):
        row = coefficients[side, j + k]
        for m, w in enumerate(u):
            inverse += v * w * row[i + m, 0]
            across += v * w * row[i + m, 1]
            turning += v * w * row[i + m, 2]
    return inverse, across, turning


@kernel
def fill_law(
    coefficients: FloatArray, sides: FloatArray, delta_max: float,
    phi: FloatArray, delta: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked."""
    for n in range(phi.size):
        inverse, across, turning = law_ratios(coefficients, sides, phi[n], delta[n] / delta_max)
        out[0, n], out[1, n], out[2, n] = 1.0 / inverse, across / inverse, turning / inverse
