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

from collections.abc import Callable
from functools import partial

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import law_of
from puck_tables.kernels.compile import kernel, patience
from puck_tables.table.resultant_table import HEIGHTS, ResultantTable
from puck_tables.table.slip_axis import LawAxis

Fill = Callable[[FloatArray, FloatArray], object]  # of φ (n,), ρ_∥, ρ_⊥, ρ_ω (3, n) to be filled


@kernel
def fill_pade(a: float, b: float, phi: FloatArray, out: FloatArray) -> None:
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


MODELS: dict[str, Fill] = {
    "Pade, slopes matched": partial(fill_pade, 1.0, 8.0 / 3.0),
    "Pade, fitted": partial(fill_pade, 0.724222, 1.515858),  # test_no_other_pade_is_better
    "limit surface": fill_limit_surface,
}


def as_table(model: str, cells: int = 512) -> ResultantTable:
    """One of :data:`MODELS` as a table of resultants, the same at every δ.

    Examples
    --------
    >>> float(as_table("limit surface").resultants(np.pi / 2, 0.0).spin.round(9))
    1.333333333
    """
    law = law_of("uniform")
    phi = LawAxis(law.edges, cells).nodes()
    rho = np.empty((3, phi.size))
    MODELS[model](phi, rho)
    return ResultantTable(np.repeat(rho.T[:, None, :], HEIGHTS, axis=1), law=law)
