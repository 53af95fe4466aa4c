"""The grid, the spline through it, and what is built from both."""

from __future__ import annotations

import numpy as np
import pytest

from puck_tables import Table, build_table, load_table, resultants, validate
from puck_tables.contact import quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.resultants import moment_balance
from puck_tables.errors import AccuracyError, InputError
from puck_tables.table.check import adversarial_points, by_closed_form
from puck_tables.table.fit import clamped_coefficients, not_a_knot_coefficients
from puck_tables.table.grid import DeltaAxis, PhiAxis, checked_size

QUARTER = 0.25 * np.pi


def spline(coefficients: np.ndarray, position: np.ndarray) -> np.ndarray:
    """A uniform cubic B-spline by its textbook formula; position in cells."""
    cell = np.minimum(position.astype(int), len(coefficients) - 4)
    t = (position - cell).reshape(-1, *([1] * (coefficients.ndim - 1)))
    weights = (
        (1 - t) ** 3 / 6,
        (3 * t**3 - 6 * t**2 + 4) / 6,
        (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6,
        t**3 / 6,
    )
    return sum(w * coefficients[cell + i] for i, w in enumerate(weights))


def slope(sizes: list[int], errors: list[float]) -> float:
    return -float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def test_phi_nodes_meet_the_special_angles_and_invert_the_map():
    axis = PhiAxis(129)
    nodes = axis.nodes()
    assert (nodes[0], nodes[64], nodes[-1]) == (0.0, QUARTER, 0.5 * np.pi)
    assert np.all(np.diff(nodes) > 0.0)
    direction = slip_direction(nodes)
    np.testing.assert_allclose(axis.slip_direction().ratio, direction.ratio, rtol=0, atol=3e-16)
    eta = np.tan(nodes[64:] - QUARTER) ** 0.25
    np.testing.assert_allclose(eta, np.arange(65) / 64, atol=1e-4)  # rounding at the fourth root
    np.testing.assert_allclose(eta[8:], np.arange(8, 65) / 64, atol=1e-12)


def test_spline_keeps_order_4_in_phi_through_the_singular_angle():
    sizes, errors = [], []
    for cells in (16, 32, 64, 128, 256, 512):
        table = build_table(n_phi=2 * cells + 1)
        sizes.append(cells)
        errors.append(table.accuracy.worst)
    assert slope(sizes, errors) >= 3.8
    steps = np.log2(np.array(errors[:-1]) / errors[1:])
    assert steps.min() >= 3.8, steps


def test_uniform_phi_grid_loses_its_order():
    phi = QUARTER + np.concatenate([np.linspace(-0.3, 0.3, 20001), 10.0 ** -np.linspace(2, 9, 99)])
    truth = np.stack(by_closed_form(phi, 1.0), axis=-1)
    sizes, errors = [], []
    for cells in (64, 128, 256, 512, 1024):
        nodes = 0.5 * np.pi * np.arange(cells + 1) / cells
        values = np.stack(by_closed_form(nodes, 1.0), axis=-1)
        # even about both ends, so the clamped spline is right there; π/4 is a node
        error = spline(clamped_coefficients(values), phi / (0.5 * np.pi) * cells) - truth
        sizes.append(cells)
        errors.append(np.abs(error).max())
    assert slope(sizes, errors) <= 2.3
    assert errors[2] > 1000 * build_table(n_phi=257).accuracy.worst


def test_delta_spline_has_order_4_and_is_exact_for_what_is_splined():
    phi = np.linspace(0.0, 0.5 * np.pi, 50)[:, None]
    delta = np.linspace(0.0, 1.0, 1001)
    truth = np.stack(by_closed_form(phi, delta))  # (3, phi, delta): rational functions of δ
    sizes, errors = [4, 8, 16, 32, 64], []
    for cells in sizes:
        values = np.stack(by_closed_form(phi, np.arange(cells + 1) / cells))
        coefficients = not_a_knot_coefficients(values.transpose(2, 0, 1))
        error = spline(coefficients, delta * cells).transpose(1, 2, 0) - truth
        errors.append(np.abs(error).max())
    assert slope(sizes, errors) >= 3.8
    # the friction ratios are polynomials: four nodes do what 33 do, to rounding
    few, many = build_table(n_phi=257, n_delta=4), build_table(n_phi=257, n_delta=33)
    points = adversarial_points(few.phi_axis, 1.0, 5000, seed=3)
    difference = np.stack(few.resultants(*points)) - np.stack(many.resultants(*points))
    assert np.abs(difference).max() <= 5e-15


def test_exact_at_phi_0_and_right_angle_at_every_delta(table: Table):
    delta = np.linspace(0.0, 1.0, 777)
    rho = table.resultants([[0.0], [0.5 * np.pi]], delta)
    expected = (
        [np.ones_like(delta), 9 / (9 + delta**2)],
        [delta / 4, 3 * delta / (9 + delta**2)],
        [(4 - delta**2) / 8, np.full_like(delta, 4 / 3)],
    )
    for got, wanted in zip(rho, expected, strict=True):
        np.testing.assert_allclose(got, wanted, rtol=0, atol=2e-15)


def test_even_in_phi_and_scalar_as_array(table: Table):
    phi = np.random.default_rng(5).uniform(0, 0.5 * np.pi, 500)
    for plus, minus in zip(table.resultants(phi, 0.7), table.resultants(-phi, 0.7), strict=True):
        np.testing.assert_array_equal(plus, minus)
    one = table.resultants(float(phi[3]), 0.7)
    assert one.spin.shape == ()
    assert float(one.spin) == float(table.resultants(phi, 0.7).spin[3])
    assert table.resultants(phi[:6].reshape(2, 3, 1), [0.1, 0.2]).parallel.shape == (2, 3, 2)
    assert table.resultants([], 0.5).spin.shape == (0,)


def test_default_table_against_quadrature_which_shares_no_code_with_it(table: Table):
    phi, delta = adversarial_points(table.phi_axis, 1.0, 1000, seed=99)
    pick = np.random.default_rng(1).choice(phi.size, 3000, replace=False)
    phi, delta = phi[pick], delta[pick]
    truth = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    assert error.max() <= 2e-11 <= 5e-9


def test_stated_accuracy_is_what_the_table_has(table: Table):
    phi, delta = adversarial_points(table.phi_axis, 1.0, 100_000, seed=4)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(resultants(phi, delta)))
    assert table.accuracy.worst <= table.tolerance
    np.testing.assert_allclose(error.max(axis=1), table.accuracy.largest, rtol=0.15)
    assert table.accuracy.order >= 3.8


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13])
def test_accuracy_asked_is_reached(accuracy: float):
    built = build_table(accuracy=accuracy)
    assert 0.01 * accuracy < built.accuracy.worst <= accuracy == built.tolerance


def test_validate_passes_the_default_and_fails_a_table_that_promises_too_much(rough_table: Table):
    assert validate(load_table(), random_points=200).passed
    bold = Table(
        rough_table.phi_axis, rough_table.delta_axis, rough_table.values, tolerance=1e-9,
        accuracy=rough_table.accuracy,
    )  # fmt: skip
    report = validate(bold, random_points=200)
    assert not report.passed
    assert {check.name for check in report.checks if not check.passed} >= {
        "direct quadrature",
        "closed forms",
    }
    spoilt = rough_table.values.copy()
    spoilt[5, 2, 1] += 1e-3
    report = validate(
        Table(rough_table.phi_axis, rough_table.delta_axis, spoilt, tolerance=1e-6),
        random_points=200,
    )
    failed = {(check.name, check.function) for check in report.checks if not check.passed}
    assert ("closed forms", "perpendicular") in failed
    assert ("identity pressure balance", "perpendicular") in failed


def test_progress_is_told():
    seen: list[tuple[int, int]] = []
    build_table(n_phi=20001, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (20001, 20001)
    assert len(seen) >= 5


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"n_phi": 100}, InputError, "odd"),
        ({"n_phi": 7}, InputError, "from 9"),
        ({"n_delta": 3}, InputError, "from 4"),
        ({"n_phi": 10**9 + 1}, InputError, "from 9 to"),
        ({"n_phi": 4000001, "n_delta": 1000}, InputError, "MiB"),
        ({"n_delta": 5000}, InputError, "from 4 to 1025"),
        ({"n_phi": 101, "accuracy": 1e-6}, InputError, "both"),
        ({"accuracy": 1e-15}, AccuracyError, "1e-13"),
        ({"accuracy": float("nan")}, AccuracyError, "accuracy"),
    ],
)
def test_bad_grids_are_refused(arguments: dict, error: type, words: str):
    with pytest.raises(error, match=words):
        build_table(**arguments)


@pytest.mark.parametrize(
    ("phi", "delta"),
    [(0.1, 1.0 + 1e-15), (0.1, -1e-300), (1.6, 0.5), (np.nan, 0.5), (0.1, np.inf), ("x", 0.1)],
)
def test_nothing_is_extrapolated(table: Table, phi: object, delta: object):
    with pytest.raises(InputError):
        table.resultants(phi, delta)


def test_axis_checks():
    with pytest.raises(InputError):
        DeltaAxis(2)
    with pytest.raises(InputError):
        checked_size(10**6, 10**6)
