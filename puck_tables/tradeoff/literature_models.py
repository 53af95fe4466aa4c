"""Friction of a flat puck (δ = 0) by the simple models of the literature, as resultants.

With c = cos φ, s = sin φ ≥ 0:

* Padé (V. Ph. Zhuravlev 1998; eq. 1.6 of Salnikova, Treschev, Gallyamov 2012):
  F = F₀ v/(v + a r|ω|), M = M₀ r|ω|/(r|ω| + b v), F₀ = fN, M₀ = (2/3) fNr, so
  ρ_∥ = 1/(c + a s), ρ_ω = (4/3)/(s + b c).  With the slopes dF/dv at v = 0 and dM/dω at ω = 0
  right, a = 1 and b = 8/3; fitted for the least worst error of the resultants, a and b follow.
* ellipsoidal limit surface (Howe, Cutkosky 1996): (F/F₀)² + (M/M₀)² = 1, motion along its normal:
  ρ_∥ = 1/w, ρ_ω = (8/9)/w, w² = c² + (4/9) s².
"""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import law_of
from puck_tables.kernels.compile import kernel, patience
from puck_tables.table.resultant_table import HEIGHTS, ResultantTable
from puck_tables.table.slip_axis import LawAxis
from puck_tables.tradeoff.truth import Question

PADE_MATCHED = (1.0, 8.0 / 3.0)  # a, b: so that slopes at pure spin and pure sliding are right


@kernel
def fill_pade(phi: FloatArray, a: float, b: float, out: FloatArray) -> None:
    """ρ_∥, ρ_⊥ = 0, ρ_ω at angles 0 ≤ φ ≤ π/2 into ``out`` (3, n)."""
    patience(phi.size)
    for n in range(phi.size):
        c, s = np.cos(phi[n]), np.sin(phi[n])
        out[0, n] = 1.0 / (c + a * s)
        out[1, n] = 0.0
        out[2, n] = (4.0 / 3.0) / (s + b * c)


@kernel
def fill_limit_surface(phi: FloatArray, out: FloatArray) -> None:
    """ρ_∥, ρ_⊥ = 0, ρ_ω of the ellipsoidal limit surface at such angles into ``out`` (3, n)."""
    patience(phi.size)
    for n in range(phi.size):
        c, s = np.cos(phi[n]), np.sin(phi[n])
        w = 1.0 / np.sqrt(c * c + (4.0 / 9.0) * s * s)
        out[0, n] = w
        out[1, n] = 0.0
        out[2, n] = (8.0 / 9.0) * w


def pade_at_best(flat: Question) -> tuple[float, float]:
    """The a and b with the least worst error at resultants of δ = 0.

    Examples
    --------
    >>> from puck_tables.tradeoff.truth import random_points
    >>> points = random_points(2000)
    >>> [round(x, 2) for x in pade_at_best(points.some(points.inputs[1] == 0.0))]
    [0.72, 1.52]
    """
    from scipy.optimize import minimize_scalar

    phi, out = np.ascontiguousarray(flat.inputs[0]), np.empty(flat.truth.shape)

    def error(row: int, a: float, b: float) -> float:
        fill_pade(phi, a, b, out)
        return float(np.abs(out[row] - flat.truth[row]).max())

    a = minimize_scalar(lambda a: error(0, a, 1.0), bounds=(0.3, 1.5), method="bounded").x
    b = minimize_scalar(lambda b: error(2, 1.0, b), bounds=(1.5, 4.0), method="bounded").x
    return float(a), float(b)


def as_table(model: str, a: float = 1.0, b: float = 8.0 / 3.0, cells: int = 512) -> ResultantTable:
    """A model ('pade' or 'limit surface') as a table of resultants, the same at every δ.

    Examples
    --------
    >>> float(as_table("limit surface").resultants(np.pi / 2, 0.0).spin.round(9))
    1.333333333
    """
    law = law_of("uniform")
    phi = LawAxis(law.edges, cells).nodes()
    rho = np.empty((3, phi.size))
    if model == "pade":
        fill_pade(phi, a, b, rho)
    else:
        fill_limit_surface(phi, rho)
    return ResultantTable(np.repeat(rho.T[:, None, :], HEIGHTS, axis=1), law=law)
