"""The table of partial contact: its grid, order, accuracy, file, and what it refuses."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import strips
import xarray

from puck_tables import load_table
from puck_tables.contact import one_sided
from puck_tables.contact.one_sided import balance
from puck_tables.contact.opening import critical_delta
from puck_tables.errors import AccuracyError, ContactError, InputError, OutputError, TableError
from puck_tables.kernels.spline import fill_resultants
from puck_tables.table.partial_build import build_partial_table, tabulate
from puck_tables.table.partial_check import adversarial_points, validate_partial
from puck_tables.table.partial_file import load_partial_table, save_partial_table
from puck_tables.table.partial_grid import UPPER_DELTA, PartialAxes, height_at
from puck_tables.table.partial_table import PartialTable

QUARTER = 0.25 * math.pi


@pytest.fixture(scope="module")
def rough() -> PartialTable:
    return build_partial_table(cells=24)


@pytest.fixture(scope="module")
def default() -> PartialTable:
    return load_partial_table()


def error_of(table: PartialTable, phi, delta) -> np.ndarray:
    return np.abs(np.stack(table.resultants(phi, delta)) - np.stack(balance(phi, delta)[0]))


def test_grid_meets_the_opening_the_corner_and_the_upper_end():
    axes = PartialAxes(24)
    phi, delta = axes.phi(), axes.delta()
    assert (phi[0], phi[24]) == (0.0, QUARTER) and np.all(np.diff(phi) > 0.0)
    assert delta.shape == axes.shape == (49, 25)
    np.testing.assert_allclose(delta[:, 0], critical_delta(phi), rtol=1e-14)
    assert np.all(np.diff(delta, axis=1) > 0.0)
    assert abs(delta[0, -1] - UPPER_DELTA) < 1e-12
    assert delta[:, -1].min() >= UPPER_DELTA - 1e-12 and delta[:25].max() < 4.0
    assert critical_delta(phi[-1]) > UPPER_DELTA  # contact is full beyond
    # the map keeps the opening at its square root
    zeta = np.array([1e-4, 2e-4])
    rise = height_at(np.array(1.2), zeta) - 1.2
    assert abs(rise[1] / rise[0] - 4.0) < 1e-6


def test_order_in_the_body_of_the_range():
    """Order 4 up to δ = 3, through φ = π/4 and across the opening."""
    phi, delta = adversarial_points(PartialAxes(24), 1500, seed=11)
    kept = delta < 3.0
    phi, delta = phi[kept], delta[kept]
    cells = np.array([12, 16, 24, 32])
    errors = [error_of(tabulate(PartialAxes(n)), phi, delta).max() for n in cells]
    slope = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
    assert slope >= 3.7 and errors[-1] < 3e-6, (slope, errors)


def test_a_grid_that_ignores_the_opening_loses_its_order():
    """Along δ at φ = 0.6: uniform cells across δ_c leave 2.5; the same cells in ζ keep 4."""
    phi, critical = 0.6, float(critical_delta(0.6))

    def cubic_error(nodes: np.ndarray, coordinate, probes: np.ndarray) -> float:
        """Local cubic through the four nodes around each probe, in a coordinate."""
        values = one_sided.resultants(phi, nodes).spin
        truth = one_sided.resultants(phi, probes).spin
        first = np.clip(np.searchsorted(nodes, probes) - 2, 0, len(nodes) - 4)
        around = first[:, None] + np.arange(4)
        x, at = coordinate(nodes)[around], coordinate(probes)[:, None]
        estimate = np.zeros(len(probes))
        for k in range(4):
            others = np.delete(np.arange(4), k)
            estimate += values[around[:, k]] * np.prod(
                (at - x[:, others]) / (x[:, [k]] - x[:, others]), axis=1
            )
        return float(np.abs(estimate - truth).max())

    plain, fitted = [], []
    sizes = np.array([16, 32, 64, 128])
    for n in sizes:
        uniform = critical + 0.25 * (np.arange(n + 1) - 0.37 * n) / n
        middles = 0.5 * (uniform[1:] + uniform[:-1])
        close = np.abs(middles - critical) < 3.0 / n
        plain.append(cubic_error(uniform, lambda d: d, middles[close]))
        root = 0.4 * np.arange(n + 1) / n
        fitted.append(
            cubic_error(
                critical + root**2,
                lambda d: np.sqrt(np.maximum(d - critical, 0.0)),
                critical + (0.5 * (root[1:] + root[:-1])) ** 2,
            )
        )
    assert 2.2 < -np.polyfit(np.log(sizes), np.log(plain), 1)[0] < 2.8, plain
    assert -np.polyfit(np.log(sizes), np.log(fitted), 1)[0] > 3.7, fitted


def test_default_table_has_the_accuracy_it_states(default: PartialTable):
    phi, delta = adversarial_points(default.axes, 4000, seed=4)
    error = error_of(default, phi, delta)
    assert default.accuracy.worst <= default.tolerance == 1e-6
    assert error.max() <= 1e-6
    assert error[:, delta < 3.5].max() <= 3e-8
    assert error[:, phi > QUARTER].max() <= 2e-8
    assert validate_partial(default, points=1000).passed


def test_default_table_against_strips_which_share_no_code_with_it(default: PartialTable):
    for phi, delta in [(0.5, 2.0), (QUARTER, 3.9), (0.9, 2.0), (0.7737, 3.898), (1.19, 3.85)]:
        chord = balance(np.array([phi]), np.array([delta]))[1]
        start = round(float(chord.offset[0]), 2), round(float(chord.bearing[0]), 2)
        truth = strips.resultants(phi, delta, start)
        np.testing.assert_allclose(default.resultants(phi, delta), truth, rtol=0.0, atol=1e-6)


def test_full_contact_by_closed_forms_and_continuous_where_it_opens(default: PartialTable):
    rng = np.random.default_rng(9)
    phi, delta = rng.uniform(-1.5707, 1.5707, 4000), rng.uniform(0.0, UPPER_DELTA, 4000)
    closed = delta <= critical_delta(phi)
    assert 1000 < closed.sum() < 3000
    got = np.stack(default.resultants(phi[closed], delta[closed]))
    truth = np.stack(one_sided.resultants(phi[closed], delta[closed]))
    np.testing.assert_allclose(got, truth, rtol=0.0, atol=1e-14)
    phi = np.linspace(0.0, 1.2, 500)
    critical = critical_delta(phi)
    phi, critical = phi[critical < UPPER_DELTA], critical[critical < UPPER_DELTA]
    below, above = (
        np.stack(default.resultants(phi, critical * (1 + side * 1e-9))) for side in (-1, 1)
    )
    np.testing.assert_allclose(below, above, rtol=0.0, atol=5e-9)


def test_table_of_full_contact_goes_on_where_contact_stays_full():
    """Its ratios are polynomials of degree 2 in δ: the last cell serves beyond δ = 1."""
    table, rng = load_table(), np.random.default_rng(17)
    phi, delta = rng.uniform(0.0, 0.5 * math.pi, 20_000), rng.uniform(1.0, 4.0, 20_000)
    kept = delta <= critical_delta(phi)
    phi, delta = phi[kept], delta[kept]
    out = np.empty((3, phi.size))
    fill_resultants(table.coefficients, table.delta_axis.upper, phi, delta, out)
    error = np.abs(out - np.stack(one_sided.resultants(phi, delta)))
    assert error.max() <= 5e-11


def test_even_scalar_shapes_and_empty(default: PartialTable):
    phi = np.random.default_rng(5).uniform(0.0, 1.3, 300)
    for one, other in zip(default.resultants(phi, 3.0), default.resultants(-phi, 3.0), strict=True):
        np.testing.assert_array_equal(one, other)
    one = default.resultants(float(phi[3]), 3.0)
    assert one.spin.shape == () and float(one.spin) == float(default.resultants(phi, 3.0).spin[3])
    assert default.resultants(phi[:6].reshape(2, 3, 1), [0.1, 2.0]).parallel.shape == (2, 3, 2)
    assert default.resultants([], 2.0).spin.shape == (0,)
    with pytest.raises(ValueError, match="read-only"):
        default.values[0, 0, 0] = 1.0


def test_accuracy_asked_is_reached():
    table = build_partial_table(accuracy=3e-3)
    assert 3e-5 < table.accuracy.worst <= 3e-3 == table.tolerance


def test_validation_fails_a_table_that_promises_too_much(rough: PartialTable):
    assert rough.accuracy.order > 1.5 and validate_partial(rough, points=600).passed
    bold = replace(rough, tolerance=1e-6)
    failed = {check.name for check in validate_partial(bold, points=600).checks if not check.passed}
    assert "one-sided balance" in failed
    spoilt = rough.values.copy()
    spoilt[:, 0, 1] += 0.02
    report = validate_partial(replace(rough, values=spoilt), points=600)
    assert "closed forms at the opening" in {c.name for c in report.checks if not c.passed}
    spoilt = rough.values.copy()
    spoilt[0, 10, 0] += 0.02
    report = validate_partial(replace(rough, values=spoilt), points=600)
    assert "pure sliding" in {check.name for check in report.checks if not check.passed}


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"cells": 7}, InputError, "even and from 8"),
        ({"cells": 33}, InputError, "even"),
        ({"cells": 10**9}, InputError, "from 8 to"),
        ({"cells": 16, "accuracy": 1e-3}, InputError, "both"),
        ({"accuracy": 1e-12}, AccuracyError, "1e-08 to 0.01"),
        ({"accuracy": float("nan")}, AccuracyError, "accuracy"),
    ],
)
def test_bad_grids_are_refused(arguments: dict, error: type, words: str):
    with pytest.raises(error, match=words):
        build_partial_table(**arguments)


@pytest.mark.parametrize(
    ("phi", "delta", "error", "words"),
    [
        (0.1, 3.91, ContactError, "outside the table of partial contact"),
        (0.1, 4.0, ContactError, "tips over"),
        (0.1, -1e-300, InputError, "negative"),
        (1.6, 2.0, InputError, "phi"),
        (math.nan, 2.0, InputError, "phi"),
        ("x", 2.0, InputError, "phi"),
    ],
)
def test_nothing_is_extrapolated(default: PartialTable, phi, delta, error, words):
    with pytest.raises(error, match=words):
        default.resultants(phi, delta)


# --- the file ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def file(rough: PartialTable, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("partial") / "rough.h5"
    save_partial_table(rough, path, command="a test")
    return path


def test_round_trip_is_exact_and_says_what_it_holds(file: Path, rough: PartialTable):
    loaded = load_partial_table(file)
    np.testing.assert_array_equal(loaded.values, rough.values)
    assert loaded.accuracy == rough.accuracy and loaded.tolerance == rough.tolerance
    for name in ("kind", "interpretation", "phi_map", "delta_map", "valid_range", "content_digest"):
        assert loaded.passport[name], name
    with xarray.open_dataset(file, engine="h5netcdf") as data:
        assert data.spin.dims == ("phi", "zeta") and data.spin.shape == (49, 25)
        np.testing.assert_array_equal(data.parallel, rough.values[..., 0])
        # the map in the passport, by hand, at one node
        critical = critical_delta([float(data.phi[30]), QUARTER])
        top = 4.0 * critical[0] / critical[1]
        delta = top - (top - critical[0]) * math.exp(-(float(data.zeta[12]) ** 2))
        truth = balance(data.phi.values[30:31], np.array([delta]))[0]
        assert abs(float(data.spin[30, 12]) - truth.spin[0]) < 1e-12


def test_default_table_ships_small():
    from importlib.resources import files

    content = files("puck_tables.tables").joinpath("partial.h5").read_bytes()
    assert len(content) <= 2_000_000


def test_other_kinds_and_altered_files_are_refused(file: Path, rough: PartialTable, tmp_path: Path):
    with pytest.raises(TableError, match="holds 'partial contact', not a table of 'resultants'"):
        load_table(file)
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 4
    (tmp_path / "bad.h5").write_bytes(content)
    with pytest.raises(TableError, match="digest"):
        load_partial_table(tmp_path / "bad.h5")
    with pytest.raises(TableError, match="cannot use"):
        save_partial_table(replace(rough, values=-rough.values), tmp_path / "minus.h5")
    with pytest.raises(OutputError, match="exists already"):
        save_partial_table(rough, file)
    with pytest.raises(OutputError, match="without measured accuracy"):
        save_partial_table(replace(rough, accuracy=None), tmp_path / "none.h5")
    with h5py.File(file) as opened:
        assert {opened[name].dtype.kind for name in opened} == {"f"}
