"""Tables under any pressure law: regions, order, accuracy, file."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xarray

from puck_tables import load_table
from puck_tables.contact import quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import law_of, profile_law
from puck_tables.contact.pressure import GALIN, HERTZ
from puck_tables.contact.resultants import moment_balance
from puck_tables.errors import AccuracyError, InputError, OutputError, TableError
from puck_tables.table.law_file import load_law_table, save_law_table
from puck_tables.table.law_grid import LawAxis
from puck_tables.table.law_table import LawTable, build_law_table, tabulate

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
NAMES = ("uniform", "galin", "hertz", "ring", "annulus:0.3", "annulus:0.8", "annulus:0.999")


def worst(table: LawTable, law, count: int = 3000) -> float:
    """Largest error at random points and ever closer to every edge's line."""
    rng = np.random.default_rng(21)
    phi = rng.uniform(0.0, HALF, count)
    lines = np.arctan2(1.0, law.edges)
    phi[::3] = rng.choice(lines, phi[::3].size) + rng.choice([-1, 1], phi[::3].size) * 10.0 ** (
        -rng.uniform(0.5, 12, phi[::3].size)
    )
    phi = np.clip(phi, 0.0, HALF)
    delta = table.delta_max * rng.random(count)
    error = np.stack(table.resultants(phi, delta)) - np.stack(law.resultants(phi, delta))
    return float(np.abs(error).max())


def test_regions_come_from_the_edges():
    phi = LawAxis((0.8, 1.0), 16).phi()
    assert phi.shape == (4, 17)
    np.testing.assert_allclose(phi[:, 0], [QUARTER, QUARTER, *2 * [math.atan(1.25)]], atol=1e-15)
    half = 0.5 * (QUARTER + math.atan(1.25))
    assert phi[:, -1].tolist() == [0.0, half, half, HALF]
    assert np.all(np.diff(phi[::2], axis=1) < 0.0) and np.all(np.diff(phi[1::2], axis=1) > 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_order_4_under_every_law(name):
    law = law_of(name)
    cells = [24, 48, 96, 192]
    errors = [worst(tabulate(law, n), law) for n in cells]
    slope = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
    assert slope >= 3.7, (slope, errors)


def test_grid_that_does_not_know_the_inner_edge_loses_its_order():
    law = law_of("annulus:0.8")
    blind = type(law)("blind", (1.0,), law.integrals)
    cells = [24, 48, 96, 192]
    errors = [worst(tabulate(blind, n), law) for n in cells]
    assert -np.polyfit(np.log(cells), np.log(errors), 1)[0] < 2.7, errors
    assert errors[-1] > 100 * worst(tabulate(law, 192), law)


@pytest.mark.parametrize("name", NAMES)
def test_accuracy_asked_is_reached(name):
    law = law_of(name)
    table = build_law_table(law, accuracy=1e-8)
    assert table.accuracy.worst <= table.tolerance == 1e-8
    assert worst(table, law) <= 1.3e-8


def test_uniform_is_the_default_table_of_full_contact():
    law, default = law_of("uniform"), load_table()
    table = tabulate(law, default.phi_axis.cells_per_side)
    phi = np.random.default_rng(2).uniform(-HALF, HALF, 2000)
    for got, truth in zip(table.resultants(phi, 0.7), default.resultants(phi, 0.7), strict=True):
        np.testing.assert_allclose(got, truth, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("law", [GALIN, HERTZ], ids=lambda law: law.name)
def test_against_quadrature_with_chord_moments_by_gauss(law):
    """The builder takes elementary chord moments; here they are summed from W itself."""
    table = build_law_table(law_of(law.name), accuracy=1e-8)
    rng = np.random.default_rng(14)
    phi, delta = rng.uniform(0.0, HALF, 200), table.delta_max * rng.random(200)
    plain = type(law)(law.name, law.weight)
    p = quadrature.integrals(phi, plain)
    mean_square = {"galin": 1 / 3, "hertz": 1 / 5}[law.name]
    truth = moment_balance(p, slip_direction(phi), delta / (4 * mean_square))
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    assert error.max() <= 1e-8


def test_profile_goes_through_the_same_builder():
    law = profile_law([0.5, 0.75, 1.0], [1.0, 2.0, 0.5])
    table = build_law_table(law, accuracy=1e-5)
    assert table.axis.edges == (0.5, 0.75, 1.0) and worst(table, law, 400) <= 1e-5


def test_round_trip_and_refusals(tmp_path: Path):
    table = build_law_table(law_of("annulus:0.8"), cells=12)
    path = tmp_path / "washer.h5"
    loaded = save_law_table(table, path)
    np.testing.assert_array_equal(loaded.values, table.values)
    again = load_law_table(path)
    assert (again.law_name, again.axis, again.delta_max) == ("annulus:0.8", table.axis, 1.64)
    assert again.accuracy == table.accuracy and again.tolerance == table.tolerance
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        assert data.spin.dims == ("side", "xi", "delta")
        assert data.attrs["pressure_law"] == "annulus:0.8"
    with pytest.raises(OutputError, match="exists already"):
        save_law_table(table, path)
    with pytest.raises(TableError, match="holds 'resultants under a pressure law'"):
        load_table(path)
    with pytest.raises(TableError, match="not an HDF5 file"):
        (tmp_path / "x.h5").write_text("puck")
        load_law_table(tmp_path / "x.h5")


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"cells": 3}, InputError, "from 4"),
        ({"cells": 10**7}, InputError, "from 4 to"),
        ({"cells": 16, "accuracy": 1e-3}, InputError, "both"),
        ({"accuracy": 1e-14}, AccuracyError, "1e-11"),
    ],
)
def test_bad_requests_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        build_law_table(law_of("hertz"), **arguments)


def test_nothing_is_extrapolated():
    table = tabulate(law_of("hertz"), 8)
    for phi, delta in [(0.1, 0.81), (1.6, 0.1), (math.nan, 0.1), (0.1, -1.0), ("x", 0.1)]:
        with pytest.raises(InputError):
            table.resultants(phi, delta)
