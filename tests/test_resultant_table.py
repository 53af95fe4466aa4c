"""The table of friction resultants: axis, splines, order and accuracy under every pressure law."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pucks import simulate, sweep

import puck_tables as pt
from puck_tables import Table, resultants, stop
from puck_tables.contact import quadrature
from puck_tables.contact.closed_form import by_closed_form, moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import HOMOGENEOUS, law_of, profile_law
from puck_tables.contact.one_sided import critical_delta
from puck_tables.contact.pressure import GALIN, HERTZ
from puck_tables.errors import InputError
from puck_tables.motion.friction_source import table_friction
from puck_tables.table.resultant_table import ResultantTable, adversarial_points
from puck_tables.table.slip_spline import LawAxis
from puck_tables.table.spline_fit import clamped_coefficients, height_terms

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
NAMES = ("uniform", "galin", "hertz", "ring", "annulus:0.3", "annulus:0.8", "annulus:0.999")


def spline(coefficients: np.ndarray, position: np.ndarray) -> np.ndarray:
    """A uniform cubic B-spline by its textbook formula; position in cells."""
    cell = np.minimum(position.astype(int), len(coefficients) - 4)
    t = (position - cell).reshape(-1, *([1] * (coefficients.ndim - 1)))
    weights = (
        (1 - t) ** 3 / 6, (3 * t**3 - 6 * t**2 + 4) / 6, (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6,
        t**3 / 6,
    )  # fmt: skip
    return sum(w * coefficients[cell + i] for i, w in enumerate(weights))


def slope(sizes: list[int], errors: list[float]) -> float:
    return -float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def worst(table: Table, law, count: int = 3000) -> float:
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


# ---- axis and splines


def test_nodes_meet_the_special_angles_and_invert_the_map():
    nodes = LawAxis((1.0,), 64).nodes()
    assert (nodes[0], nodes[64], nodes[-1]) == (0.0, QUARTER, HALF)
    assert np.all(np.diff(nodes) > 0.0)
    eta = np.tan(nodes[64:] - QUARTER) ** 0.25
    np.testing.assert_allclose(eta, np.arange(65) / 64, atol=1e-4)  # rounding at the fourth root
    np.testing.assert_allclose(eta[8:], np.arange(8, 65) / 64, atol=1e-12)


def test_sides_come_from_the_edges():
    axis = LawAxis((0.8, 1.0), 16)
    phi = axis.by_side(axis.nodes())
    assert phi.shape == (4, 17)
    np.testing.assert_allclose(phi[:, 0], [QUARTER, QUARTER, *2 * [math.atan(1.25)]], atol=1e-15)
    half = 0.5 * (QUARTER + math.atan(1.25))
    assert phi[:, -1].tolist() == [0.0, half, half, HALF]
    assert np.all(np.diff(phi[::2], axis=1) < 0.0) and np.all(np.diff(phi[1::2], axis=1) > 0.0)


def test_uniform_phi_grid_loses_its_order():
    phi = QUARTER + np.concatenate([np.linspace(-0.3, 0.3, 20001), 10.0 ** -np.linspace(2, 9, 99)])
    truth = np.stack(by_closed_form(phi, 1.0), axis=-1)
    sizes, errors = [64, 128, 256, 512, 1024], []
    for cells in sizes:
        nodes = HALF * np.arange(cells + 1) / cells
        values = np.stack(by_closed_form(nodes, 1.0), axis=-1)
        # even about both ends, so the clamped spline is right there; π/4 is a node
        error = spline(clamped_coefficients(values), phi / HALF * cells) - truth
        errors.append(np.abs(error).max())
    assert slope(sizes, errors) <= 2.3
    assert errors[2] > 1000 * Table.build(cells=128).accuracy.worst


@pytest.mark.parametrize("name", NAMES)
def test_the_ratios_are_polynomials_of_the_height_under_every_law(name):
    law = law_of(name)
    phi, delta = np.linspace(0.0, HALF, 40)[:, None], np.linspace(0.0, law.delta_max, 33)
    terms = height_terms(np.stack(law.resultants(phi, delta), axis=-1), delta)
    rho = law.resultants(phi, delta)
    a0, a2, b1, c0, c2 = np.moveaxis(terms[..., None], -2, 0)
    np.testing.assert_allclose(a0 + a2 * delta**2, 1.0 / rho.parallel, atol=2e-12)
    np.testing.assert_allclose(b1 * delta, rho.perpendicular / rho.parallel, atol=2e-12)
    np.testing.assert_allclose(c0 + c2 * delta**2, rho.spin / rho.parallel, atol=2e-12)


def test_the_polynomials_go_on_where_contact_stays_full():
    rng = np.random.default_rng(17)
    phi, delta = rng.uniform(0.0, HALF, 20_000), rng.uniform(1.0, 4.0, 20_000)
    kept = delta <= critical_delta(phi)
    phi, delta = phi[kept], delta[kept]
    from puck_tables.kernels.quadratic import fill_resultants

    table, out = Table.shipped(), np.empty((3, phi.size))
    fill_resultants(table.columns, np.array(table.axis.sides), phi, delta, out)
    assert np.abs(out - np.stack(by_closed_form(phi, delta))).max() <= 5e-11


# ---- order and accuracy


@pytest.mark.parametrize("name", NAMES)
def test_order_4_through_every_singular_line(name):
    law = law_of(name)
    cells = [24, 48, 96, 192]
    errors = [worst(ResultantTable.tabulated(law, n), law) for n in cells]
    assert slope(cells, errors) >= 3.7, errors


def test_order_4_under_uniform_pressure_step_by_step():
    errors = [Table.build(cells=n).accuracy.worst for n in (16, 32, 64, 128, 256, 512)]
    steps = np.log2(np.array(errors[:-1]) / errors[1:])
    assert steps.min() >= 3.8, steps


def test_grid_that_does_not_know_the_inner_edge_loses_its_order():
    law = law_of("annulus:0.8")
    blind = type(law)("blind", (1.0,), law.integrals)
    cells = [24, 48, 96, 192]
    errors = [worst(ResultantTable.tabulated(blind, n), law) for n in cells]
    assert slope(cells, errors) < 2.7, errors
    assert errors[-1] > 100 * worst(ResultantTable.tabulated(law, 192), law)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13])
def test_accuracy_asked_is_reached(accuracy: float):
    built = Table.build(accuracy=accuracy)
    assert 0.01 * accuracy < built.accuracy.worst <= accuracy == built.tolerance


@pytest.mark.parametrize("name", NAMES)
def test_accuracy_asked_is_reached_under_every_law(name):
    law = law_of(name)
    table = Table.build(law, 1e-8)
    assert table.accuracy.worst <= table.tolerance == 1e-8
    assert worst(table, law) <= 1e-8


def test_profile_goes_through_the_same_builder():
    law = profile_law([0.5, 0.75, 1.0], [1.0, 2.0, 0.5])
    table = Table.build(law, 1e-5)
    assert table.axis.edges == (0.5, 0.75, 1.0) and worst(table, law, 400) <= 1e-5


@pytest.mark.parametrize("law", [GALIN, HERTZ], ids=lambda law: law.name)
def test_against_quadrature_with_chord_moments_by_gauss(law):
    """The builder takes elementary chord moments; here they are summed from W itself."""
    table = Table.build(law.name, 1e-8)
    rng = np.random.default_rng(14)
    phi, delta = rng.uniform(0.0, HALF, 200), table.delta_max * rng.random(200)
    plain = type(law)(law.name, law.weight)
    p = quadrature.integrals(phi, plain)
    mean_square = {"galin": 1 / 3, "hertz": 1 / 5}[law.name]
    truth = moment_balance(p, slip_direction(phi), delta / (4 * mean_square))
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    assert error.max() <= 1e-8


def test_default_table_against_quadrature_which_shares_no_code_with_it(table: Table):
    phi, delta = adversarial_points(table, 20_000, seed=99)
    pick = np.random.default_rng(1).choice(phi.size, 3000, replace=False)
    phi, delta = phi[pick], delta[pick]
    truth = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    assert error.max() <= 2e-11


def test_stated_accuracy_is_what_the_table_has(table: Table):
    phi, delta = adversarial_points(table, 200_000, seed=4)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(resultants(phi, delta)))
    np.testing.assert_allclose(error.max(axis=1), table.accuracy.largest, rtol=0.15)
    assert table.accuracy.order >= 3.8


def test_a_spoilt_value_fails_every_route(rough_table: Table):
    from dataclasses import replace

    spoilt = rough_table.values.copy()
    spoilt[5, 2, 1] += 1e-3
    report = replace(rough_table, values=spoilt).validate(points=2000)
    failed = {(check.name, check.function) for check in report.checks if not check.passed}
    assert {("closed forms", "perpendicular"), ("every node", "perpendicular"),
            ("direct quadrature", "perpendicular")} <= failed  # fmt: skip
    bold = replace(rough_table, tolerance=1e-9).validate(points=2000)
    names = {check.name for check in bold.checks if not check.passed}
    assert names >= {"direct quadrature", "closed forms"}


# ---- answers


def test_exact_at_phi_0_and_right_angle_at_every_delta(table: Table):
    delta = np.linspace(0.0, 1.0, 777)
    rho = table.resultants([[0.0], [HALF]], delta)
    expected = (
        [np.ones_like(delta), 9 / (9 + delta**2)],
        [delta / 4, 3 * delta / (9 + delta**2)],
        [(4 - delta**2) / 8, np.full_like(delta, 4 / 3)],
    )
    for got, wanted in zip(rho, expected, strict=True):
        np.testing.assert_allclose(got, wanted, rtol=0, atol=2e-15)


@pytest.mark.parametrize("name", ["uniform", "annulus:0.8"])
def test_even_in_phi_and_scalar_as_array(name):
    table = Table.build(name, cells=16)
    phi = np.random.default_rng(5).uniform(0, HALF, 500)
    for plus, minus in zip(table.resultants(phi, 0.7), table.resultants(-phi, 0.7), strict=True):
        np.testing.assert_array_equal(plus, minus)
    one = table.resultants(float(phi[3]), 0.7)
    assert one.spin.shape == ()
    assert float(one.spin) == float(table.resultants(phi, 0.7).spin[3])
    assert table.resultants(phi[:6].reshape(2, 3, 1), [0.1, 0.2]).parallel.shape == (2, 3, 2)
    assert table.resultants([], 0.5).spin.shape == (0,)


@pytest.mark.parametrize(
    ("phi", "delta"),
    [(0.1, 1.0 + 1e-15), (0.1, -1e-300), (1.6, 0.5), (np.nan, 0.5), (0.1, np.inf), ("x", 0.1)],
)
@pytest.mark.parametrize("name", ["uniform", "hertz"])
def test_nothing_is_extrapolated(name: str, phi: object, delta: object):
    with pytest.raises(InputError):
        ResultantTable.tabulated(law_of(name), 8).resultants(phi, delta)


def test_a_table_of_another_law_is_not_taken_for_a_plain_puck():
    """Hertz' law has the one edge of uniform pressure, and a table of the same shape."""
    hertz = Table.build("hertz", 1e-6)
    for asked in (
        lambda: table_friction(0.5, hertz),
        lambda: hertz.section(0.5),
        lambda: stop((1.0, 0.0), 1.0, delta=0.5, table=hertz),
    ):
        with pytest.raises(InputError, match="under the pressure law hertz, not uniform"):
            asked()


# ---- motions that read it


@pytest.mark.parametrize(
    ("law", "delta", "gyration"), [("annulus:0.8", 1.0, 0.9), ("hertz", 0.5, HOMOGENEOUS),
                                   ("uniform", 0.5, 0.9), ("cone", 0.3, HOMOGENEOUS)]
)  # fmt: skip
def test_motions_read_a_table_under_any_law(law: str, delta: float, gyration: float):
    pressure = profile_law([0.0, 1.0], [1.0, 0.0], name="cone") if law == "cone" else law_of(law)
    table = Table.build(pressure, 1e-9)
    kind = {"delta": delta, "pressure": pressure, "gyration": gyration}
    by_law, by_table = (
        simulate((1.0, 0.0), 5.0, **kind, tol=1e-7, table=one) for one in (None, table)
    )
    scale = math.hypot(1.0, 5.0)
    assert abs(by_table.stop_time - by_law.stop_time) <= 1e-7 * scale
    assert abs(by_table.stop_time - by_law.stop_time) > 0.0  # it is the table that was read
    np.testing.assert_allclose(by_table.stop_position, by_law.stop_position, atol=1e-7 * scale**2)
    spins = np.array([0.0, 0.5, 5.0])
    stops = pt.stop((1.0, 0.0), spins, **kind, tol=1e-7, table=table)
    truth = pt.stop((1.0, 0.0), spins, **kind, tol=1e-9)
    q = np.hypot(1.0, spins)
    assert np.all(np.abs(stops.stop_time - truth.stop_time) <= 1.1e-7 * q)
    swept = sweep(spin=spins, velocity=(1.0, 0.0), **kind, tol=1e-7, table=table)
    assert "memory" in swept.table
    assert np.all(np.abs(swept.stop_time - truth.stop_time) <= 1.1e-7 * q)


def test_motions_refuse_a_table_of_another_puck_or_too_coarse():
    table, motion = Table.build("hertz", 1e-6), ((1.0, 0.0), 5.0)
    for given, words in (
        ({"pressure": "ring", "delta": 0.5}, "law hertz, not ring"),
        ({"gyration": 0.9, "delta": 0.5}, "law hertz, not uniform"),
        ({"delta": 0.5}, "law hertz, not uniform"),
        ({"pressure": "hertz", "delta": 0.9}, "outside"),
        ({"pressure": "hertz", "delta": 0.5}, "out of reach.*give tol"),
    ):
        for call in (simulate, pt.stop):
            with pytest.raises(InputError, match=words):
                call(*motion, **given, table=table).stop_time  # noqa: B018 - stops come when asked
    odd = Table.build("hertz", cells=101)
    with pytest.raises(InputError, match="odd number of cells"):
        simulate(*motion, pressure="hertz", delta=0.5, tol=1e-3, table=odd)
    with pytest.raises(InputError, match="homogeneous puck under uniform pressure"):
        pt.stop(*motion, pressure="hertz", delta=0.5, table=Table.shipped("stops"))
    one = Table.build(profile_law([0.0, 1.0], [1.0, 0.5], name="a.csv"), 1e-4)
    changed = profile_law([0.0, 1.0], [1.0, 0.6], name="a.csv")
    with pytest.raises(InputError, match=r"not a\.csv as it is now"):
        simulate(*motion, pressure=changed, delta=0.5, tol=1e-2, table=one)
