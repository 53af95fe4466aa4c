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
from puck_tables.tradeoff.contender import Contender, Ready
from puck_tables.tradeoff.literature_models import (
    PADE_MATCHED,
    fill_limit_surface,
    fill_pade,
    pade_at_best,
)
from puck_tables.tradeoff.truth import Points

Fill = Callable[[FloatArray, FloatArray, FloatArray], object]  # phi, delta, out (3, n)

QUESTION = "resultants"
SCATTERED = 40_000  # points timed
QUADRATIC, BICUBIC = "quadratic in delta", "bicubic, graded"
# along φ, doubled, and those of the table that comes along
_NODES = (17, 33, 65, 129, 257, 513, 991, 2049)


class ResultantTask:
    """Points to answer at: scattered ones for the clock, judged ones for the error."""

    def __init__(self, truth: Points, flat_truth: Points) -> None:
        rng = np.random.default_rng(7)
        self.truth, self.flat_truth = truth, flat_truth
        self.phi, self.delta = rng.uniform(0.0, 0.5 * np.pi, SCATTERED), rng.random(SCATTERED)

    def ready(self, fill: Fill, size: int = 0, items: int = SCATTERED, flat: bool = False) -> Ready:
        """Ready to answer; ``flat``: judged at δ = 0 alone."""
        truth = self.flat_truth if flat else self.truth
        judged = np.empty((3, truth.phi.size))
        fill(truth.phi, truth.delta, judged)
        error = truth.errors(judged)
        out = np.empty((3, items))
        phi, delta = self.phi[:items].copy(), self.delta[:items].copy()
        return Ready(lambda: fill(phi, delta, out), items, 0.0 * error, error, size)

    def judge(self) -> Ready:
        """The truth itself, judged by the closed forms."""
        judged = np.empty((3, self.truth.phi.size))
        _plain_closed_form(self.truth.phi, self.truth.delta, judged)
        return replace(self.ready(_quadrature, items=64), place_error=self.truth.errors(judged))


def _tabulated(size: int) -> ResultantTable:
    return ResultantTable.tabulated(law_of("uniform"), size // 2)


_SIDES = np.array(_tabulated(9).axis.sides)


def _quadratic_columns(size: int, dtype: type) -> FloatArray:
    return _tabulated(size).columns.astype(dtype)


def _quadratic(c: FloatArray, phi: FloatArray, delta: FloatArray, out: FloatArray) -> None:
    fill_resultants(c, _SIDES, phi, delta, out)


def _bicubic_coefficients(size: int) -> FloatArray:
    return graded_coefficients(_tabulated(size))


def _bicubic(c: FloatArray, phi: FloatArray, delta: FloatArray, out: FloatArray) -> None:
    fill_bicubic(c, 1.0, phi, delta, out)


def _plain_closed_form(phi: FloatArray, delta: FloatArray, out: FloatArray) -> None:
    out[:] = moment_balance(closed_form.integrals(phi), slip_direction(phi), delta)


def _quadrature(phi: FloatArray, delta: FloatArray, out: FloatArray) -> None:
    out[:] = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)


def contenders(task: ResultantTask) -> Iterator[Contender]:
    """All methods to the resultants."""

    def contender(
        method: str, setting: str, build: Callable[[], Any], ready: Callable[[Any], Ready],
        outsider: bool = False,
    ) -> Contender:  # fmt: skip
        return Contender(QUESTION, method, setting, build, ready, outsider)

    def nothing() -> None:
        return None

    yield contender("direct quadrature", "", nothing, lambda _: task.judge())
    yield contender("closed forms", "", nothing, lambda _: task.ready(fill_closed_form))
    yield contender(
        "closed forms, plain NumPy", "", nothing, lambda _: task.ready(_plain_closed_form)
    )
    for size in _NODES:
        yield contender(
            QUADRATIC, f"nodes={size}", partial(_quadratic_columns, size, np.float64),
            lambda c: task.ready(partial(_quadratic, c), c.nbytes),
        )  # fmt: skip
    for size in (257, 991):
        yield contender(
            QUADRATIC + ", float32", f"nodes={size}", partial(_quadratic_columns, size, np.float32),
            lambda c: task.ready(partial(_quadratic, c), c.nbytes),
        )  # fmt: skip
    for size in (33, 129, 513, 991):
        yield contender(
            BICUBIC, f"nodes={size}x4", partial(_bicubic_coefficients, size),
            lambda c: task.ready(partial(_bicubic, c), c.nbytes),
        )  # fmt: skip
    yield from _outsiders(task, contender)


def _outsiders(task: ResultantTask, contender: Callable[..., Contender]) -> Iterator[Contender]:
    for size in ((100, 9), (400, 17), (1600, 17)):
        yield contender(
            "scipy NdBSpline", f"nodes={size[0]}x{size[1]}", partial(_scipy_spline, *size),
            lambda spline: task.ready(partial(_by_spline, spline), spline.c.nbytes, items=10_000),
            outsider=True,
        )  # fmt: skip

    def pade(ab: tuple[float, float]) -> Ready:
        return task.ready(lambda phi, delta, out: fill_pade(phi, *ab, out), flat=True)

    yield contender("Pade, slopes matched", "", lambda: PADE_MATCHED, pade, outsider=True)
    flat = task.flat_truth
    yield contender(
        "Pade, fitted", "", lambda: pade_at_best(flat.phi, flat.resultants), pade, outsider=True
    )
    yield contender(
        "limit surface", "", lambda: None,
        lambda _: task.ready(lambda phi, delta, out: fill_limit_surface(phi, out), flat=True),
        outsider=True,
    )  # fmt: skip


def _scipy_spline(n_phi: int, n_delta: int) -> Any:
    """Three bicubic splines of the resultants on a uniform grid, as one would write it."""
    from scipy.interpolate import NdBSpline, make_interp_spline

    phi, delta = np.linspace(0.0, 0.5 * np.pi, n_phi), np.linspace(0.0, 1.0, n_delta)
    values = np.empty((3, n_phi * n_delta))
    grid_phi, grid_delta = (grid.ravel() for grid in np.meshgrid(phi, delta, indexing="ij"))
    _plain_closed_form(grid_phi, grid_delta, values)
    along_phi = make_interp_spline(phi, np.moveaxis(values.reshape(3, n_phi, n_delta), 0, -1), k=3)
    along_delta = make_interp_spline(delta, along_phi.c, k=3, axis=1)
    coefficients = np.ascontiguousarray(np.moveaxis(along_delta.c, 0, 1))
    return NdBSpline((along_phi.t, along_delta.t), coefficients, 3)


def _by_spline(spline: Any, phi: FloatArray, delta: FloatArray, out: FloatArray) -> None:
    out[:] = spline(np.stack([phi, delta], axis=-1)).T
