"""The contact patch: integrals, resultants and regime, against truth at 32 digits and by identity.

The golden values come from tests/golden/make_golden.py.  Formulas and numbers of tables 4.6 and 6.1
(Salnikova, Treschev, Gallyamov 2012) are written out here, not taken from the package.
"""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import dblquad

from puck_tables import is_full_contact, limit_angle, resultants
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.pressure import UNIFORM, PressureLaw
from puck_tables.contact.resultants import moment_balance
from puck_tables.errors import ContactError, InputError

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
INTEGRALS = "abcde"
RESULTANTS = ("parallel", "perpendicular", "spin")
CLOSED_TOLERANCE = 1e-14
QUADRATURE_TOLERANCE = 2e-14


def hertz_weight(rho):
    return 1.5 * np.sqrt(np.maximum(1.0 - rho**2, 0.0))


def galin_weight(rho):
    # The floor catches only radii that rounding has moved onto the rim; see the plain form below.
    return 0.5 / np.sqrt(np.maximum(1.0 - rho**2, 1e-17))


HERTZ = PressureLaw("hertz", hertz_weight)
GALIN = PressureLaw("galin", galin_weight)
LAWS = pytest.mark.parametrize("law", [UNIFORM, HERTZ, GALIN], ids=lambda law: law.name)


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


def near(point):
    """Doubles on both sides of a point, ever closer, inside [0, π/2]."""
    gap = 10.0 ** -np.linspace(0.5, 16.0, 63)
    around = np.concatenate([point - gap, [np.nextafter(point, -1.0), point], point + gap])
    return around[(around >= 0.0) & (around <= HALF)]


@pytest.fixture(scope="module")
def corners():
    """Angles where double precision is hardest, both signs."""
    tiny = [5e-324, 2.2e-308, 1e-300, 1e-155, 1e-100, 1e-30]
    phi = np.concatenate([tiny, near(0.0), near(QUARTER), near(HALF)])
    return np.concatenate([phi, -phi])


@pytest.fixture(scope="module")
def scattered():
    return np.random.default_rng(46).uniform(-HALF, HALF, 2000)


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


def test_compiled_resultants_one_by_one(golden):
    for i in range(0, golden["phi"].size, 7):
        got = resultants(float(golden["phi"][i]), float(golden["delta"][i]))
        np.testing.assert_allclose(
            np.array(got), golden["rho"][:, i], rtol=0.0, atol=CLOSED_TOLERANCE
        )


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


@LAWS
def test_identities_of_every_axisymmetric_law(law, scattered, corners):
    """p_c = p_b − p_d and p_e = p_d − 2p_b: the first pointwise, the second by parts in θ."""
    phi = np.concatenate([scattered[:500], corners])
    p = quadrature.integrals(phi, law)
    # Galin's weight amplifies the rounding of 1 − ρ² next to the rim
    tolerance = 1e-12 if law is GALIN else 1e-14
    assert_close([p.c, p.e], [p.b - p.d, p.d - 2.0 * p.b], tolerance, ["p_c", "p_e"], phi=phi)


def test_sliding_force_is_symmetric_in_speed_and_spin(scattered, corners):
    phi = np.abs(np.concatenate([scattered[:500], corners]))
    mirrored = HALF - phi  # exact to rounding; p_a is flat enough not to care
    p_a, twin = quadrature.integrals(phi).a, quadrature.integrals(mirrored).a
    assert_close([p_a], [twin], QUADRATURE_TOLERANCE, ["p_a"], phi=phi)


@pytest.mark.parametrize("way", [closed_form, quadrature])
def test_elementary_integrals(way):
    root2 = math.sqrt(2.0)
    table = {
        0.0: (1.0, 1 / 4, 0.0, 1 / 4, -1 / 4),
        QUARTER: (
            8 * root2 / (3 * math.pi),
            32 * root2 / (45 * math.pi),
            -8 * root2 / (45 * math.pi),
            8 * root2 / (9 * math.pi),
            -8 * root2 / (15 * math.pi),
        ),
        HALF: (1.0, 1 / 3, -1 / 3, 2 / 3, 0.0),
    }
    for phi, entries in table.items():
        np.testing.assert_allclose(np.array(way.integrals(phi)), entries, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("delta", [0.0, 1e-8, 0.3, 0.5, 1.0 - 2.0**-53, 1.0])
def test_elementary_resultants(delta):
    root2 = math.sqrt(2.0)
    q = (45 * math.pi) ** 2 + (16 * delta) ** 2
    spin = 16 * root2 / (9 * math.pi) * ((45 * math.pi) ** 2 - 2 * (32 * delta) ** 2) / q
    table = {
        0.0: (1.0, delta / 4, (4 - delta**2) / 8),
        QUARTER: (5400 * root2 * math.pi / q, 7680 * delta / q, spin),
        HALF: (9 / (9 + delta**2), 3 * delta / (9 + delta**2), 4 / 3),
    }
    for phi, entries in table.items():
        for sign in (1.0, -1.0):
            got = np.array(resultants(sign * phi, delta))
            np.testing.assert_allclose(got, entries, rtol=0.0, atol=1e-14)
            by_quadrature = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
            np.testing.assert_allclose(np.array(by_quadrature), entries, rtol=0.0, atol=2e-14)


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


@pytest.mark.parametrize("way", [closed_form, quadrature])
def test_signs_of_the_integrals(way, scattered, corners):
    p = way.integrals(np.concatenate([scattered, corners]))
    assert p.a.min() > 0.0 and p.b.min() > 0.0 and p.d.min() > 0.0
    # p_c vanishes at φ = 0, where it is a difference of equal numbers
    assert p.c.max() <= (0.0 if way is closed_form else 1e-15)


def test_friction_always_opposes_the_motion(scattered, corners):
    phi = np.concatenate([scattered, corners])[:, None]
    rho = resultants(phi, np.linspace(0.0, 1.0, 21))
    assert rho.parallel.min() > 0.0
    assert rho.spin.min() > 0.0
    assert rho.perpendicular[:, 1:].min() > 0.0
    np.testing.assert_array_equal(rho.perpendicular[:, 0], 0.0)


# --- contact regime --------------------------------------------------------------------------


def test_contact_is_full_up_to_delta_one(scattered, corners):
    phi = np.concatenate([scattered, corners])[:, None]
    heights = [0.0, 5e-324, 0.5, 1.0 - 2.0**-53, 1.0]
    assert is_full_contact(phi, heights).all()
    resultants(phi, heights)  # raises nothing


@pytest.mark.parametrize(
    ("phi", "critical"),
    [(0.0, 1.0), (math.pi / 8, 1.01728890), (QUARTER, 1.15913851), (math.pi / 3, 1.95391704)],
)
def test_critical_height(phi, critical):
    low, high = 0.0, 3.0
    assert is_full_contact(phi, low) and not is_full_contact(phi, high)
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_full_contact(phi, middle) else (low, middle)
    assert abs(low - critical) <= 1e-8
    # the compiled resultants draw the same line
    resultants([phi, -phi], low - 1e-11)
    with pytest.raises(ContactError):
        resultants(phi, high + 1e-11)


def test_pure_spin_never_loses_contact():
    delta = np.linspace(0.0, 100.0, 401)
    for phi in (HALF, -HALF):
        assert is_full_contact(phi, delta).all()
        rho = resultants(phi, delta)
        np.testing.assert_allclose(rho.parallel, 9 / (9 + delta**2), rtol=0.0, atol=1e-14)
        np.testing.assert_allclose(rho.spin, 4 / 3, rtol=0.0, atol=1e-14)


def test_contact_error_names_the_first_bad_point():
    with pytest.raises(ContactError, match=r"phi = 0, delta = 1\.1 "):
        resultants(0.0, 1.1)
    phi = np.full(1000, 1.5)
    phi[[700, 900]] = 0.25, 0.0
    with pytest.raises(ContactError, match=r"phi = 0\.25, delta = 1\.2 "):
        resultants(phi, 1.2)
    with pytest.raises(ContactError):
        limit_angle([0.5, 4.0])


@pytest.mark.parametrize("function", [resultants, is_full_contact])
@pytest.mark.parametrize(
    ("phi", "delta"),
    [
        (math.nan, 0.5),
        (math.inf, 0.5),
        (-math.inf, 0.5),
        (np.nextafter(HALF, 2.0), 0.5),
        (-1.6, 0.5),
        ([0.1, math.nan], 0.5),
        (0.5, math.nan),
        (0.5, math.inf),
        (0.5, -1e-9),
        (0.5, -math.inf),
        (0.5, [0.1, -0.1]),
        ("slow", 0.5),
        (0.5, "high"),
        (None, 0.5),
        (0.5, None),
        (0.5 + 0.1j, 0.5),
        ([[0.1], [0.2, 0.3]], 0.5),
        ({"phi": 0.1}, 0.5),
    ],
)
def test_refused(function, phi, delta):
    with pytest.raises(InputError) as caught:
        function(phi, delta)
    assert not isinstance(caught.value, ContactError)


@pytest.mark.parametrize("way", [closed_form, quadrature])
@pytest.mark.parametrize("phi", [math.nan, math.inf, 1.5708, "slow"])
def test_integrals_refuse(way, phi):
    with pytest.raises(InputError):
        way.integrals(phi)


# --- other pressure laws -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("law", "mean_x2", "mean_radius"),
    [(UNIFORM, 1 / 4, 2 / 3), (HERTZ, 1 / 5, 3 * math.pi / 16), (GALIN, 1 / 3, math.pi / 4)],
    ids=lambda value: getattr(value, "name", None),
)
def test_laws_at_pure_translation_and_pure_spin(law, mean_x2, mean_radius):
    """Elementary: w is constant at φ = 0 and ρ at φ = π/2; ∫Wρ³dρ and 2∫Wρ²dρ are left."""
    slide = quadrature.integrals(0.0, law)
    expected = (1.0, mean_x2, 0.0, mean_x2, -mean_x2)
    np.testing.assert_allclose(np.array(slide), expected, rtol=0.0, atol=1e-10)
    spin = quadrature.integrals(HALF, law)
    expected = (mean_radius / 2, -mean_radius / 2, mean_radius, 0.0)
    np.testing.assert_allclose(np.array(spin)[1:], expected, rtol=0.0, atol=1e-10)


@LAWS
@pytest.mark.parametrize("phi", [0.6, 1.1])  # centre of rotation outside and inside the disc
def test_laws_against_the_definition(law, phi):
    """The defining double integrals, ρ = sin u, by scipy's adaptive quadrature."""
    alpha, beta = math.cos(phi), math.sin(phi)
    p = quadrature.integrals(phi, law)
    corner = [0.0, HALF] if alpha > beta else [0.0, math.asin(alpha / beta), HALF]

    def by_definition(numerator):
        def integrand(theta, u):
            rho, sine = math.sin(u), math.sin(theta)
            w = math.hypot(beta * rho - alpha * sine, alpha * math.cos(theta))
            return numerator(rho, sine) / w * float(law.weight(rho)) * rho * math.cos(u)

        pieces = [
            dblquad(integrand, lower, upper, -HALF, HALF, epsabs=1e-11, epsrel=1e-11)[0]
            for lower, upper in pairwise(corner)
        ]
        return 2.0 * sum(pieces) / math.pi  # both halves of the disc

    truth = (
        by_definition(lambda rho, sine: alpha - beta * rho * sine) / alpha,
        by_definition(lambda rho, sine: rho**2 * (1.0 - sine**2)),
        by_definition(lambda rho, sine: (alpha - beta * rho * sine) * rho * sine) / beta,
        by_definition(lambda rho, sine: (beta * rho - alpha * sine) * rho) / beta,
        by_definition(lambda rho, sine: (beta * rho - alpha * sine) * rho**2 * sine) / alpha,
    )
    np.testing.assert_allclose(np.array(p), truth, rtol=0.0, atol=1e-9)


# --- known defects: each marker goes when the package is mended --------------------------------


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("phi", [0.0, 0.6, QUARTER])
def test_weight_that_is_infinite_at_the_rim(phi):
    """W(ρ) is promised ρ in [0, 1) only; Galin's law as everybody would write it."""
    plain = PressureLaw("galin", lambda rho: 0.5 / np.sqrt((1.0 - rho) * (1.0 + rho)))
    guarded = np.array(quadrature.integrals(phi, GALIN))
    np.testing.assert_allclose(
        np.array(quadrature.integrals(phi, plain)), guarded, rtol=0.0, atol=1e-10
    )


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("delta", [1e80, 1e160, 1e300])
def test_absurd_height_is_refused(delta):
    with pytest.raises(InputError):
        is_full_contact(0.5, delta)
    with pytest.raises(InputError):
        resultants(0.5, delta)


@pytest.mark.parametrize("value", ["0.5", b"0.5", np.array(["0.5"]), np.array([0.5j]), 10**400])
def test_not_real_numbers(value):
    with pytest.raises(InputError):
        resultants(value, 0.5)


def test_shapes_that_do_not_fit():
    with pytest.raises(InputError):
        resultants(np.zeros(3), np.zeros(2))
