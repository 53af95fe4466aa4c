"""Integrals by quadrature under Hertz's and Galin's pressure: identities, ends, definition."""

from __future__ import annotations

import math

import numpy as np
import pytest

from puck_tables.contact import quadrature
from puck_tables.contact.pressure import UNIFORM, PressureLaw

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi


def hertz_weight(rho):
    return 1.5 * np.sqrt(np.maximum(1.0 - rho**2, 0.0))


def galin_weight(rho):
    # The floor catches only radii that rounding has moved onto the rim; see the plain form below.
    return 0.5 / np.sqrt(np.maximum(1.0 - rho**2, 1e-17))


HERTZ = PressureLaw("hertz", hertz_weight)
GALIN = PressureLaw("galin", galin_weight)
LAWS = pytest.mark.parametrize("law", [UNIFORM, HERTZ, GALIN], ids=lambda law: law.name)


@LAWS
def test_identities_of_every_axisymmetric_law(law, scattered, corners):
    """p_c = p_b − p_d and p_e = p_d − 2p_b: the first pointwise, the second by parts in θ."""
    phi = np.concatenate([scattered[:500], corners])
    p = quadrature.integrals(phi, law)
    # Galin's weight amplifies the rounding of 1 − ρ² next to the rim
    tolerance = 1e-12 if law is GALIN else 1e-14
    np.testing.assert_allclose(p.c, p.b - p.d, rtol=0.0, atol=tolerance)
    np.testing.assert_allclose(p.e, p.d - 2.0 * p.b, rtol=0.0, atol=tolerance)


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


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("phi", [0.0, 0.6, QUARTER])
def test_weight_that_is_infinite_at_the_rim(phi):
    """W(ρ) is promised ρ in [0, 1) only; Galin's law as everybody would write it."""
    plain = PressureLaw("galin", lambda rho: 0.5 / np.sqrt((1.0 - rho) * (1.0 + rho)))
    guarded = np.array(quadrature.integrals(phi, GALIN))
    np.testing.assert_allclose(
        np.array(quadrature.integrals(phi, plain)), guarded, rtol=0.0, atol=1e-10
    )
