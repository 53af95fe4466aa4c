"""How long do the three resultants take at scattered points, on one thread?

Errors: tables against the closed forms at all points, closed forms against direct quadrature at
the first thousand.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.interpolate import NdBSpline, RectBivariateSpline, make_interp_spline

import puck_tables
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.kernels.closed_form_kernel import _fill
from puck_tables.kernels.quadratic import fill_resultants
from puck_tables.tradeoff.resultant_methods import fill_bicubic, graded_coefficients

FloatArray = npt.NDArray[np.float64]

pytestmark = pytest.mark.benchmark(group="three resultants at scattered points")

POINTS = 100_000
JUDGED = 1000
GRID = (200, 33)


@pytest.fixture
def points(rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    return rng.uniform(0.0, 0.5 * np.pi, POINTS), rng.uniform(0.0, 1.0, POINTS)


@pytest.fixture(scope="module")
def grid() -> tuple[FloatArray, FloatArray, FloatArray]:
    """The uniform grid of the rivals: both axes and values (200, 33, 3)."""
    phi, delta = np.linspace(0.0, 0.5 * np.pi, GRID[0]), np.linspace(0.0, 1.0, GRID[1])
    return phi, delta, np.moveaxis(uncompiled(*np.meshgrid(phi, delta, indexing="ij")), 0, -1)


def uncompiled(phi: FloatArray, delta: FloatArray) -> FloatArray:
    """The closed forms in plain NumPy."""
    return np.stack(moment_balance(closed_form.integrals(phi), slip_direction(phi), delta))


def against_closed_form(values: FloatArray, points: tuple[FloatArray, FloatArray]) -> float:
    return float(np.abs(values - uncompiled(*points)).max())


def against_quadrature(values: FloatArray, points: tuple[FloatArray, FloatArray]) -> float:
    phi, delta = (axis[:JUDGED] for axis in points)
    truth = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    return float(np.abs(values[:, :JUDGED] - np.stack(truth)).max())


def run(measure: Any, name: str, function: Callable[[], Any], error: float) -> None:
    measure(name, function, items=POINTS, unit="point", error=error)


def test_table_kernel(measure, table, points):
    out = np.empty((3, POINTS))
    columns, sides = table.columns, np.array(table.axis.sides)
    fill_resultants(columns, sides, *points, out)
    error = against_closed_form(out, points)
    run(
        measure, "default table, kernel", lambda: fill_resultants(columns, sides, *points, out),
        error,
    )  # fmt: skip


def test_table_bicubic(measure, table, points):
    out = np.empty((3, POINTS))
    coefficients = graded_coefficients(table)
    fill_bicubic(coefficients, 1.0, *points, out)
    error = against_closed_form(out, points)
    run(
        measure, "the same as a bicubic, kernel",
        lambda: fill_bicubic(coefficients, 1.0, *points, out), error,
    )  # fmt: skip


def test_table_public(measure, table, points):
    error = against_closed_form(np.stack(table.resultants(*points)), points)
    run(measure, "default table, Table.resultants", lambda: table.resultants(*points), error)


def test_closed_form_kernel(measure: Any, points: tuple[FloatArray, FloatArray]) -> None:
    out = np.empty((3, POINTS))
    assert _fill(*points, out) < 0
    error = against_quadrature(out, points)
    run(measure, "closed forms, kernel", lambda: _fill(*points, out), error)


def test_closed_form_public(measure: Any, points: tuple[FloatArray, FloatArray]) -> None:
    error = against_quadrature(np.stack(puck_tables.resultants(*points)), points)
    run(
        measure, "closed forms, puck_tables.resultants", lambda: puck_tables.resultants(*points),
        error,
    )  # fmt: skip


def test_rival_uncompiled(measure: Any, points: tuple[FloatArray, FloatArray]) -> None:
    error = against_quadrature(uncompiled(*points), points)
    run(measure, "rival: closed forms in plain NumPy", lambda: uncompiled(*points), error)


def test_rival_rect_bivariate_spline(measure, grid, points):
    phi, delta, values = grid
    splines = [RectBivariateSpline(phi, delta, values[..., f]) for f in range(3)]

    def look_up() -> list[FloatArray]:
        return [spline.ev(*points) for spline in splines]

    error = against_closed_form(np.stack(look_up()), points)
    run(measure, "rival: RectBivariateSpline, 200 x 33", look_up, error)


def test_rival_ndbspline(measure, grid, points):
    phi, delta, values = grid
    along_phi = make_interp_spline(phi, values, k=3)
    along_delta = make_interp_spline(delta, along_phi.c, k=3, axis=1)
    coefficients = np.ascontiguousarray(np.moveaxis(along_delta.c, 0, 1))
    spline = NdBSpline((along_phi.t, along_delta.t), coefficients, 3)
    pairs = np.stack(points, axis=-1)
    error = against_closed_form(spline(pairs).T, points)
    run(measure, "rival: NdBSpline, 200 x 33", lambda: spline(pairs), error)
