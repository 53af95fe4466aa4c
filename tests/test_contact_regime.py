"""Where contact is full, and arguments that are refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from puck_tables import resultants
from puck_tables.contact import closed_form, is_full_contact, quadrature
from puck_tables.contact.one_sided import critical_delta
from puck_tables.errors import ContactError, InputError
from puck_tables.motion import limit_angle

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi


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
    line = float(critical_delta(phi))
    assert abs(line - critical) <= 5e-9
    assert is_full_contact(phi, line - 1e-11) and not is_full_contact(phi, line + 1e-11)
    # the compiled resultants draw the same line
    resultants([phi, -phi], line - 1e-11)
    with pytest.raises(ContactError):
        resultants(phi, line + 1e-11)


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
        (np.nextafter(HALF, 2.0), 0.5),
        ([0.1, math.nan], 0.5),
        (0.5, math.nan),
        (0.5, math.inf),
        (0.5, -1e-9),
        (0.5, [0.1, -0.1]),
        (0.5, "high"),
        (0.5, None),
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
