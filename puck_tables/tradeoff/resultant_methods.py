"""Methods for the three resultants at scattered points, other tables and models among them.

The bicubic table over φ and δ on the same nodes says what polynomials of the height are worth.  Of
the models, with c = cos φ, s = sin φ ≥ 0:

* Padé (V. Ph. Zhuravlev 1998; eq. 1.6 of Salnikova, Treschev, Gallyamov 2012):
  F = F₀ v/(v + a r|ω|), M = M₀ r|ω|/(r|ω| + b v), F₀ = fN, M₀ = (2/3) fNr, so
  ρ_∥ = 1/(c + a s), ρ_ω = (4/3)/(s + b c).  With the slopes dF/dv at v = 0 and dM/dω at ω = 0
  right, a = 1 and b = 8/3; fitted for the least worst error of the resultants, a and b follow.
* ellipsoidal limit surface (Howe, Cutkosky 1996): (F/F₀)² + (M/M₀)² = 1, motion along its normal:
  ρ_∥ = 1/w, ρ_ω = (8/9)/w, w² = c² + (4/9) s².
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import law_of
from puck_tables.kernels.closed_form_kernel import _fill as fill_closed_form
from puck_tables.kernels.compile import allocating, kernel, patience
from puck_tables.kernels.quadratic import basis, cell_at, fill_resultants, row_sums, side_and_eta
from puck_tables.table.resultant_table import HEIGHTS, ResultantTable
from puck_tables.table.slip_spline import LawAxis
from puck_tables.table.spline_fit import clamped_coefficients
from puck_tables.tradeoff.truth import Contender, Made, Question, Run, filled

# along φ, doubled, and those of the table that comes along
_NODES = (17, 33, 65, 129, 257, 513, 991, 2049)
_BLOCK = 128  # points at once
_CELLS = 512  # of a model as a table, either side of the line: far less than models err by


def contenders(points: Question) -> Iterator[Contender]:
    """All methods to the resultants."""
    in_numpy, by_quadrature = _by(closed_form.integrals), _by(quadrature.integrals)
    judged = replace(points, truth=in_numpy(points.inputs))  # the truth itself, by closed forms
    yield Contender(judged, "direct quadrature", "", lambda: (None, by_quadrature), 64)
    yield Contender(points, "closed forms, plain NumPy", "", lambda: (None, in_numpy))
    compiled = filled(lambda inputs, out: fill_closed_form(inputs[0], inputs[1], out))
    yield Contender(points, "closed forms", "", lambda: (None, compiled))
    for kind, dtype, sizes in (("", np.float64, _NODES), (", float32", np.float32, (257, 991))):
        for size in sizes:
            make = partial(_quadratic, size, dtype)
            yield Contender(points, "quadratic in delta" + kind, f"nodes={size}", make)
    for size in (33, 129, 513, 991):
        yield Contender(points, "bicubic, graded", f"nodes={size}x4", partial(_bicubic, size))
    for grid in ((100, 9), (400, 17), (1600, 17)):
        words, make = f"nodes={grid[0]}x{grid[1]}", partial(_scipy_spline, *grid)
        yield Contender(points, "scipy NdBSpline", words, make, 10_000, outsider=True)
    flat = points.some(points.inputs[1] == 0.0)
    for method in MODELS:
        yield Contender(flat, method, "", partial(_modelled, method), outsider=True)


def _quadratic(size: int, dtype: type) -> Made:
    table = ResultantTable.tabulated(law_of("uniform"), size // 2)
    c: FloatArray = table.columns.astype(dtype)
    sides = np.array(table.axis.sides)
    return c, filled(lambda inputs, out: fill_resultants(c, sides, inputs[0], inputs[1], out))


def _bicubic(size: int) -> Made:
    c = graded_coefficients(ResultantTable.tabulated(law_of("uniform"), size // 2))
    return c, filled(lambda inputs, out: fill_bicubic(c, 1.0, inputs[0], inputs[1], out))


def _modelled(method: str) -> Made:
    fill = MODELS[method]
    return None, filled(lambda inputs, out: fill(inputs[0], out))


def _by(integrals: Callable[[FloatArray], Any]) -> Run:
    """The balance of moments over the integrals."""

    def run(inputs: FloatArray) -> FloatArray:
        phi, delta = inputs
        return np.stack(moment_balance(integrals(phi), slip_direction(phi), delta))

    return run


def _scipy_spline(n_phi: int, n_delta: int) -> Made:
    """Three bicubic splines of the resultants on a uniform grid, as one would write it."""
    from scipy.interpolate import NdBSpline, make_interp_spline

    axes = np.linspace(0.0, 0.5 * np.pi, n_phi), np.linspace(0.0, 1.0, n_delta)
    points = np.stack([grid.ravel() for grid in np.meshgrid(*axes, indexing="ij")])
    values = _by(closed_form.integrals)(points).reshape(3, n_phi, n_delta)
    along_phi = make_interp_spline(axes[0], np.moveaxis(values, 0, -1), k=3)
    along_delta = make_interp_spline(axes[1], along_phi.c, k=3, axis=1)
    coefficients = np.ascontiguousarray(np.moveaxis(along_delta.c, 0, 1))
    spline = NdBSpline((along_phi.t, along_delta.t), coefficients, 3)
    return coefficients, lambda inputs: spline(inputs.T).T


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


@kernel
def fill_model(a: float, b: float, squared: bool, phi: FloatArray, out: FloatArray) -> None:
    """ρ_∥ = 1/(c + a s), ρ_⊥ = 0, ρ_ω = (4/3)/(s + b c) at 0 ≤ φ ≤ π/2 into ``out`` (3, n).

    ``squared``: roots of the sums of squares for the sums.
    """
    patience(phi.size)
    for n in range(phi.size):
        c, s = np.cos(phi[n]), np.sin(phi[n])
        along, turning = c + a * s, s + b * c
        if squared:
            along, turning = np.sqrt(c * c + a * a * s * s), np.sqrt(s * s + b * b * c * c)
        out[0, n], out[1, n], out[2, n] = 1.0 / along, 0.0, (4.0 / 3.0) / turning


MODELS = {
    "Pade, slopes matched": partial(fill_model, 1.0, 8.0 / 3.0, False),
    "Pade, fitted": partial(fill_model, 0.724222, 1.515858, False),  # test_no_other_pade_is_better
    "limit surface": partial(fill_model, 2.0 / 3.0, 1.5, True),
}


def as_table(model: str) -> ResultantTable:
    """One of :data:`MODELS` as a table of resultants, the same at every δ."""
    law = law_of("uniform")
    phi = LawAxis(law.edges, _CELLS).nodes()
    rho = np.empty((3, phi.size))
    MODELS[model](phi, rho)
    return ResultantTable(np.repeat(rho.T[:, None, :], HEIGHTS, axis=1), law=law)
