"""Methods for the three resultants at scattered points."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import law_of
from puck_tables.contact.resultants import moment_balance
from puck_tables.kernels.closed_form_kernel import _fill as fill_closed_form
from puck_tables.kernels.quadratic import fill_resultants
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.bicubic import fill_bicubic, graded_coefficients
from puck_tables.tradeoff.literature_models import MODELS
from puck_tables.tradeoff.truth import Contender, Question, Run, filled, kept

# along φ, doubled, and those of the table that comes along
_NODES = (17, 33, 65, 129, 257, 513, 991, 2049)


def _tabulated(size: int) -> ResultantTable:
    return ResultantTable.tabulated(law_of("uniform"), size // 2)


_SIDES = np.array(_tabulated(9).axis.sides)


def _columns(size: int, dtype: type) -> FloatArray:
    return _tabulated(size).columns.astype(dtype)


def _by(integrals: Callable[[FloatArray], Any]) -> Run:
    """The balance of moments over the integrals."""

    def run(inputs: FloatArray) -> FloatArray:
        phi, delta = inputs
        return np.stack(moment_balance(integrals(phi), slip_direction(phi), delta))

    return run


def contenders(points: Question) -> Iterator[Contender]:
    """All methods to the resultants."""
    in_numpy = _by(closed_form.integrals)
    judged = replace(points, truth=in_numpy(points.inputs))  # the truth itself, by closed forms
    yield Contender(
        judged, "direct quadrature", "", kept(None), lambda _: _by(quadrature.integrals), 64
    )
    yield Contender(
        points, "closed forms", "", kept(None),
        lambda _: filled(lambda inputs, out: fill_closed_form(inputs[0], inputs[1], out)),
    )  # fmt: skip
    yield Contender(points, "closed forms, plain NumPy", "", kept(None), lambda _: in_numpy)
    for kind, dtype, sizes in (("", np.float64, _NODES), (", float32", np.float32, (257, 991))):
        for size in sizes:
            yield Contender(
                points, "quadratic in delta" + kind, f"nodes={size}",
                partial(_columns, size, dtype), lambda c: filled(
                    lambda inputs, out: fill_resultants(c, _SIDES, inputs[0], inputs[1], out)
                ),
            )  # fmt: skip
    for size in (33, 129, 513, 991):
        yield Contender(
            points, "bicubic, graded", f"nodes={size}x4",
            partial(lambda size: graded_coefficients(_tabulated(size)), size),
            lambda c: filled(
                lambda inputs, out: fill_bicubic(c, 1.0, inputs[0], inputs[1], out)
            ),
        )  # fmt: skip
    yield from _outsiders(points)


def _outsiders(points: Question) -> Iterator[Contender]:
    for grid in ((100, 9), (400, 17), (1600, 17)):
        yield Contender(
            points, "scipy NdBSpline", f"nodes={grid[0]}x{grid[1]}", partial(_scipy_spline, *grid),
            lambda built: lambda inputs: built[1](inputs.T).T, 10_000, outsider=True,
        )  # fmt: skip
    flat = points.some(points.inputs[1] == 0.0)
    for method, fill in MODELS.items():
        yield Contender(
            flat, method, "", kept(fill),
            lambda fill: filled(lambda inputs, out: fill(inputs[0], out)), outsider=True,
        )  # fmt: skip


def _scipy_spline(n_phi: int, n_delta: int) -> tuple[FloatArray, Any]:
    """Three bicubic splines of the resultants on a uniform grid, as one would write it."""
    from scipy.interpolate import NdBSpline, make_interp_spline

    axes = np.linspace(0.0, 0.5 * np.pi, n_phi), np.linspace(0.0, 1.0, n_delta)
    points = np.stack([grid.ravel() for grid in np.meshgrid(*axes, indexing="ij")])
    values = _by(closed_form.integrals)(points).reshape(3, n_phi, n_delta)
    along_phi = make_interp_spline(axes[0], np.moveaxis(values, 0, -1), k=3)
    along_delta = make_interp_spline(axes[1], along_phi.c, k=3, axis=1)
    coefficients = np.ascontiguousarray(np.moveaxis(along_delta.c, 0, 1))
    return coefficients, NdBSpline((along_phi.t, along_delta.t), coefficients, 3)
