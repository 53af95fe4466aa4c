"""The contact patch: integrals, resultants and regime, against truth at 32 digits and by identity.

The golden values come from tests/golden/make_golden.py.  Formulas and numbers of tables 4.6 and 6.1
(Salnikova, Treschev, Gallyamov 2012) are written out here, not taken from the package.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from puck_tables import resultants
from puck_tables.contact import closed_form, is_full_contact, quadrature
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.motion import limit_angle

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
INTEGRALS = "abcde"
RESULTANTS = ("parallel", "perpendicular", "spin")
CLOSED_TOLERANCE = 1e-14
QUADRATURE_TOLERANCE = 2e-14


@pytest.fixture(scope="module")
def golden():
    """The file as arrays: phi, p (5, n) of its angles; phi, delta, rho (3, m) of its resultants."""
    path = Path(__file__).parent / "golden" / "resultants.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    angles = content["angles"]
    rows = [(entry["phi"], row) for entry in angles for row in entry["resultants"]]
    return {
        "angle": np.array([float.fromhex(entry["phi"]) for entry in angles]),
        "p": np.array([[float(entry["p"][name]) for entry in angles] for name in INTEGRALS]),
        "phi": np.array([float.fromhex(phi) for phi, _ in rows]),
        "delta": np.array([float.fromhex(row["delta"]) for _, row in rows]),
        "rho": np.array([[float(row[name]) for _, row in rows] for name in RESULTANTS]),
        "limit_delta": [float.fromhex(row["delta"]) for row in content["limit_angles"]],
        "limit_phi": [float(row["phi"]) for row in content["limit_angles"]],
    }


def assert_close(got, truth, tolerance, names, **where):
    """All rows within an absolute tolerance; a failure names the worst point exactly."""
    got, truth = np.stack(got), np.stack(np.broadcast_arrays(*truth))
    assert got.shape == truth.shape
    error = np.abs(got - truth)
    row, point = np.unravel_index(np.argmax(np.where(np.isnan(error), np.inf, error)), error.shape)
    place = ", ".join(f"{key} = {float(value[point])!r}" for key, value in where.items())
    assert error[row, point] <= tolerance, (
        f"{names[row]} off by {error[row, point]:.3g} > {tolerance:g} at {place}: "
        f"{got[row, point]!r}, truth {truth[row, point]!r}"
    )


# --- golden values ---------------------------------------------------------------------------


def test_golden_file_holds_the_hard_points(golden):
    phi, delta = golden["phi"], golden["delta"]
    assert phi.size >= 600 and golden["angle"].size >= 150
    for point in (0.0, 5e-324, 1e-300, QUARTER, np.nextafter(QUARTER, 0.0), HALF, -QUARTER, -HALF):
        assert point in phi
    for height in (0.0, 5e-324, 1.0 - 2.0**-53, 1.0):
        assert (delta == height).sum() > 50


def test_compiled_resultants(golden):
    phi, delta = golden["phi"], golden["delta"]
    got = resultants(phi, delta)
    assert_close(got, golden["rho"], CLOSED_TOLERANCE, RESULTANTS, phi=phi, delta=delta)


def test_uncompiled_closed_form(golden):
    angle, phi, delta = golden["angle"], golden["phi"], golden["delta"]
    p = closed_form.integrals(angle)
    assert_close(p, golden["p"], CLOSED_TOLERANCE, INTEGRALS, phi=angle)
    rho = moment_balance(closed_form.integrals(phi), slip_direction(phi), delta)
    assert_close(rho, golden["rho"], CLOSED_TOLERANCE, RESULTANTS, phi=phi, delta=delta)


def test_quadrature(golden):
    angle, phi, delta = golden["angle"], golden["phi"], golden["delta"]
    p = quadrature.integrals(angle)
    assert_close(p, golden["p"], QUADRATURE_TOLERANCE, INTEGRALS, phi=angle)
    rho = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    assert_close(rho, golden["rho"], QUADRATURE_TOLERANCE, RESULTANTS, phi=phi, delta=delta)


def test_limit_angle(golden):
    delta, truth = np.array(golden["limit_delta"]), np.array(golden["limit_phi"])
    assert delta.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert_close([limit_angle(delta)], [truth], 1e-14, ["phi0"], delta=delta)


# --- the two ways to the integrals, and exact identities -----------------------------------------


def test_quadrature_agrees_with_closed_form(scattered, corners):
    phi = np.concatenate([scattered, corners])
    truth = closed_form.integrals(phi)
    assert_close(quadrature.integrals(phi), truth, QUADRATURE_TOLERANCE, INTEGRALS, phi=phi)


def test_compiled_agrees_with_uncompiled(scattered, corners):
    phi = np.concatenate([scattered, corners])
    delta = np.random.default_rng(61).random(phi.size)
    truth = moment_balance(closed_form.integrals(phi), slip_direction(phi), delta)
    assert_close(resultants(phi, delta), truth, CLOSED_TOLERANCE, RESULTANTS, phi=phi, delta=delta)


def test_sliding_force_is_symmetric_in_speed_and_spin(scattered, corners):
    phi = np.abs(np.concatenate([scattered[:500], corners]))
    mirrored = HALF - phi  # exact to rounding; p_a is flat enough not to care
    p_a, twin = quadrature.integrals(phi).a, quadrature.integrals(mirrored).a
    assert_close([p_a], [twin], QUADRATURE_TOLERANCE, ["p_a"], phi=phi)


# --- shapes and signs ------------------------------------------------------------------------


def test_even_in_phi(scattered, corners):
    phi = np.concatenate([scattered, corners])
    delta = np.random.default_rng(5).random(phi.size)
    for one, other in zip(resultants(phi, delta), resultants(-phi, delta), strict=True):
        np.testing.assert_array_equal(one, other)
    for way in (closed_form, quadrature):
        for one, other in zip(way.integrals(phi[::5]), way.integrals(-phi[::5]), strict=True):
            np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(is_full_contact(phi, 1.3), is_full_contact(-phi, 1.3))


def test_shapes():
    column, row = np.array([[0.1], [0.8], [-1.5]]), np.array([0.0, 0.2, 0.7, 1.0])
    grid = resultants(column, row)
    for name in RESULTANTS:
        assert getattr(grid, name).shape == (3, 4)
        assert getattr(grid, name).dtype == np.float64
    for i, phi in enumerate(column[:, 0]):
        for j, delta in enumerate(row):
            single = resultants(float(phi), float(delta))
            assert all(np.shape(value) == () for value in single)
            np.testing.assert_allclose(
                np.array(single), [value[i, j] for value in grid], rtol=0.0, atol=1e-14
            )
    assert is_full_contact(column, row).shape == (3, 4)
    assert is_full_contact(0.3, 0.5).shape == ()
    assert resultants(column, 0.5).spin.shape == (3, 1)
    assert resultants([0.1, 0.2], [0.5, 0.6]).spin.shape == (2,)
    assert resultants(1, 1).spin.shape == ()  # integers are numbers too
    assert slip_direction(column).ratio.shape == (3, 1)
    for way in (closed_form, quadrature):
        assert all(value.shape == (3, 1) for value in way.integrals(column))
        assert all(np.shape(value) == () for value in way.integrals(0.3))


def test_empty_arrays():
    for shape in ((0,), (3, 0), (0, 2)):
        empty = np.empty(shape)
        assert all(value.shape == shape for value in resultants(empty, 0.5))
        assert is_full_contact(empty, 0.5).shape == shape
        for way in (closed_form, quadrature):
            assert all(value.shape == shape for value in way.integrals(empty))
    assert limit_angle([]).shape == (0,)


def test_arguments_are_left_alone_in_any_memory_layout():
    rng = np.random.default_rng(3)
    phi, delta = rng.uniform(-HALF, HALF, (40, 30)), rng.random((40, 30))
    truth = resultants(phi.ravel(), delta.ravel())
    kept = phi.copy(), delta.copy()
    views = resultants(np.asfortranarray(phi)[::-1, ::3], delta[::-1, ::3])
    for got, flat in zip(views, truth, strict=True):
        expected = flat.reshape(40, 30)[::-1, ::3]
        np.testing.assert_allclose(got, expected, rtol=0.0, atol=1e-14)
    phi.setflags(write=False)
    resultants(phi, delta)
    np.testing.assert_array_equal(phi, kept[0])
    np.testing.assert_array_equal(delta, kept[1])


def test_friction_always_opposes_the_motion(scattered, corners):
    phi = np.concatenate([scattered, corners])[:, None]
    rho = resultants(phi, np.linspace(0.0, 1.0, 21))
    assert rho.parallel.min() > 0.0
    assert rho.spin.min() > 0.0
    assert rho.perpendicular[:, 1:].min() > 0.0
    np.testing.assert_array_equal(rho.perpendicular[:, 0], 0.0)
