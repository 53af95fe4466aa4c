"""Bicubic spline of friction with a coefficient that depends on the slip speed, compiled.

Coordinates: the side of φ = π/4 and η of :mod:`puck_tables.kernels.spline`, and
ξ = asinh(U/u₀)/asinh(U_max/u₀) of the fastest slip U = v + r|ω|, the divisor being ``reach``.
Coefficients: (2, ξ cells + 3, η cells + 3, 3) over 36.  Speeds beyond U_max are not extrapolated:
NaN.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import basis, cell_at

FloatArray = npt.NDArray[np.float64]

DONE, TOO_FAST = 0, 1
_ROUNDING = 1.0 + 1e-12


@inlined
def speed_ratios(
    coefficients: FloatArray, scale: float, reach: float, ratio: float, fast: bool, speed: float
) -> tuple[float, float, float]:
    """F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ).

    ``ratio`` = min(v, r|ω|)/max(v, r|ω|) ∈ [0, 1], ``fast`` whether r|ω| > v, ``speed`` =
    Q = hypot(v, rω) in m/s, ``scale`` = u₀ in m/s, ``reach`` = asinh(U_max/u₀).
    """
    n_speed, n_eta = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    x = speed * (1.0 + ratio) / (scale * math.sqrt(1.0 + ratio * ratio))
    xi = math.log(x + math.sqrt(1.0 + x * x)) / reach  # asinh; its absolute error is rounding
    if not (xi <= _ROUNDING):
        return math.nan, math.nan, math.nan
    p = math.sqrt(math.sqrt((1.0 - ratio) / (1.0 + ratio))) * n_eta
    i = cell_at(p, n_eta)
    u = basis(p - i)
    q = min(xi, 1.0) * n_speed
    j = cell_at(q, n_speed)
    parallel, across, turning = 0.0, 0.0, 0.0
    for k, v in enumerate(basis(q - j)):
        row = coefficients[1 if fast else 0, j + k]
        for m, w in enumerate(u):
            parallel += v * w * row[i + m, 0]
            across += v * w * row[i + m, 1]
            turning += v * w * row[i + m, 2]
    return parallel, across, turning


@kernel
def fill_speed(
    coefficients: FloatArray, scale: float, reach: float,
    ratio: FloatArray, fast: npt.NDArray[np.bool_], speed: FloatArray, out: FloatArray,
) -> int:  # fmt: skip
    """The three at flat arrays of points into ``out`` (3, n); a status."""
    status = DONE
    for n in range(ratio.size):
        a, b, c = speed_ratios(coefficients, scale, reach, ratio[n], fast[n], speed[n])
        out[0, n], out[1, n], out[2, n] = a, b, c
        if a != a:
            status = TOO_FAST
    return status
