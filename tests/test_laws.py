"""Pressure laws: known answers, definitions, singular lines, and what is refused."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipk

from puck_tables.contact import closed_form
from puck_tables.contact.laws import law_of, limit_ratio, profile_law
from puck_tables.errors import InputError

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
NAMES = ("uniform", "galin", "hertz", "ring", "annulus:0.3", "annulus:0.8", "annulus:0.99")


def washer_gyration(inner: float) -> float:
    return math.sqrt(0.5 * (1.0 + inner**2))


# --- known answers -------------------------------------------------------------------------------


def test_limit_ratios():
    uniform = limit_ratio(law_of("uniform"))
    assert abs(uniform - 1.53138937217390986) < 1e-13
    assert abs(limit_ratio(law_of("ring"), 0.0, 1.0) - 1.0) < 1e-14
    assert abs(limit_ratio(law_of("uniform"), 1.0) - math.tan(0.975464553235532779)) < 1e-13
    # pressure towards the rim: below the uniform puck's; towards the centre: above
    assert abs(limit_ratio(law_of("galin")) - 1.0) < 1e-12
    assert limit_ratio(law_of("hertz")) == math.inf
    cone, bowl = profile_law([0.0, 1.0], [1.2, 1.0]), profile_law([0.0, 1.0], [1.0, 1.2])
    assert limit_ratio(bowl) < uniform < limit_ratio(cone) < math.inf


def test_washers_go_from_the_disc_to_the_ring():
    inner = np.array([1e-6, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0 - 1e-6])
    ratio = [limit_ratio(law_of(f"annulus:{a:.7f}"), 0.0, washer_gyration(a)) for a in inner]
    assert np.all(np.diff(ratio) < 0.0)
    assert abs(ratio[0] - 1.53138937217391) < 1e-9 and abs(ratio[-1] - 1.0) < 1e-6


def test_galin_and_hertz_are_elementary_while_the_centre_is_inside():
    """Galin: v-force linear in s = cot φ; Hertz: cubic; torques likewise."""
    phi = np.append(np.linspace(QUARTER, HALF, 200), QUARTER + 1e-9)
    s, sine = np.cos(phi) / np.sin(phi), np.sin(phi)
    galin, hertz = law_of("galin").integrals(phi), law_of("hertz").integrals(phi)
    for got, truth in (
        (galin.a, 0.25 * math.pi),
        (galin.d, 0.25 * math.pi * (1 - s**2 / 2)),
        (hertz.a, 0.375 * math.pi * (1 - s**2 / 4)),
        (hertz.d, 0.1875 * math.pi * (1 - s**2 + 0.375 * s**4)),
    ):
        np.testing.assert_allclose(got * sine, truth, rtol=0.0, atol=2e-14)


def test_mean_squares_and_heights_of_full_contact():
    for name, mean_square in {
        "uniform": 1 / 4, "galin": 1 / 3, "hertz": 1 / 5, "ring": 1 / 2,
        "annulus:0.8": 0.41, "annulus:0.3": 0.2725,
    }.items():  # fmt: skip
        law = law_of(name)
        assert abs(law.mean_square - mean_square) < 1e-14
        phi = np.linspace(0.0, HALF, 301)
        rho = law.resultants(phi, law.delta_max)
        tilt = np.cos(phi) * np.hypot(rho.parallel, np.sin(phi) * rho.perpendicular)
        assert tilt.max() <= 1.0 + 1e-13 and tilt[0] >= 1.0 - 1e-13, name
        assert rho.spin.min() >= -1e-15
    truth = closed_form.integrals(0.4)
    np.testing.assert_array_equal(law_of("uniform").integrals(0.4), truth)


# --- definitions ---------------------------------------------------------------------------------


def by_definition(phi: float, radius: float) -> list[float]:
    """The five integrals of a thin ring of this radius and load 1, by scipy."""
    alpha, beta = math.cos(phi), math.sin(phi)
    terms = (
        lambda x, y: (alpha - beta * y) / alpha,
        lambda x, y: x * x,
        lambda x, y: (alpha - beta * y) * y / beta,
        lambda x, y: (beta * radius**2 - alpha * y) / beta,
        lambda x, y: (beta * radius**2 - alpha * y) * y / alpha,
    )

    def integrand(t: float, k: int) -> float:  # t from the point nearest to the centre of rotation
        half = math.sin(0.5 * t)
        w = math.hypot(alpha - beta * radius, 2.0 * math.sqrt(alpha * beta * radius) * half)
        return terms[k](radius * math.sin(t), radius * math.cos(t)) / w / math.pi

    points = [10.0**-k for k in range(1, 7)]
    return [
        quad(integrand, 0.0, math.pi, (k,), points=points, epsabs=1e-13, limit=400)[0]
        for k in range(5)
    ]


@pytest.mark.parametrize("phi", [0.3, 0.78, 0.9, 1.4])
def test_ring_by_definition(phi):
    got = law_of("ring").integrals(phi)
    np.testing.assert_allclose(np.array(got), by_definition(phi, 1.0), rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("phi", [0.3, 0.86, 1.3])
@pytest.mark.parametrize("name", ["uniform", "galin", "hertz", "annulus:0.5", "annulus:0.8"])
def test_every_law_is_a_pile_of_rings(name, phi):
    """Of radius sin q, with 2 W(ρ) ρ dρ as a function of q."""
    got, inner = law_of(name).integrals(phi), float(name.partition(":")[2] or 0.0)
    centre = 1.0 / math.tan(phi)
    radii = [inner, *([centre] if inner < centre < 1.0 else []), 1.0]
    node, weight = np.polynomial.legendre.leggauss(32)
    total = np.zeros(5)
    for low, high in pairwise(np.arcsin(radii)):
        # graded to both ends, where the centre of rotation may lie on the ring
        u = 0.5 * (1 + node)
        q = low + (high - low) * u**3 * (10 - 15 * u + 6 * u * u)
        element = (high - low) * 30 * u**2 * (1 - u) ** 2 * 0.5 * weight
        s, c = np.sin(q), np.cos(q)
        load = {"galin": s, "hertz": 3 * s * c * c}.get(name, 2 * s * c / (1 - inner**2))
        for r, w in zip(s, load * element, strict=True):
            total += w * np.array(by_definition(phi, r))
    np.testing.assert_allclose(np.array(got), total, rtol=0.0, atol=1e-9)


def test_thin_washers_tend_to_the_ring():
    phi = np.linspace(0.0, HALF, 101)
    ring = np.array(law_of("ring").integrals(phi))
    gap = np.array([1e-3, 1e-4, 1e-5])
    apart = [
        np.abs(np.array(law_of(f"annulus:{float(1 - g)!r}").integrals(phi)) - ring) for g in gap
    ]
    away = np.abs(phi - QUARTER) > 0.1
    error = np.array([a[:, away].max() for a in apart])
    np.testing.assert_allclose(np.diff(np.log10(error)), -1.0, atol=0.02)
    assert max(a.max() for a in apart[1:]) < 3e-4  # also at the rim, like gap ln(gap)


# --- profiles ------------------------------------------------------------------------------------


def test_profiles_that_are_other_laws():
    phi = np.concatenate([np.linspace(0.0, HALF, 41), [QUARTER, 0.8960553845713439]])
    flat = profile_law([0.0, 0.3, 1.0], [7.0, 7.0, 7.0])
    washer = profile_law([0.8, 0.9, 1.0], [2.0, 2.0, 2.0])
    for law, name in ((flat, "uniform"), (washer, "annulus:0.8")):
        got, truth = np.array(law.integrals(phi)), np.array(law_of(name).integrals(phi))
        np.testing.assert_allclose(got, truth, rtol=0.0, atol=1e-13)
    assert washer.edges == (0.8, 1.0) and flat.edges == (1.0,)


CENTRES = (3.0, 1.16, 0.8, 0.54, 0.5 + 1e-6, 0.4, 0.28, 0.1)  # of rotation: how far from the middle


@pytest.mark.parametrize("phi", [math.atan(1.0 / c) for c in CENTRES])
def test_a_profile_is_its_rings_by_elliptic_integrals(phi):
    """C outside, between rows, beside a row, in the hole: the mean slip along v of each ring."""
    radii, pressure = np.array([0.2, 0.3, 0.5, 0.7, 1.0]), [0.9, 0.2, 0.7, 0.3, 0.6]
    found = float(profile_law(radii, pressure).integrals(phi).a) * math.cos(phi)
    centre = 1.0 / math.tan(phi)

    def along(rho: float) -> float:
        a, b = math.cos(phi), rho * math.sin(phi)
        m = min(4.0 * a * b / (a + b) ** 2, 1.0)
        k = ellipk(m) if m < 1.0 else 0.0  # times a − b
        return ((a + b) * ellipe(m) + (a - b) * k) / (math.pi * a)

    def summed(of) -> float:
        return sum(
            quad(lambda rho: float(np.interp(rho, radii, pressure)) * rho * of(rho), *ends,
                 epsabs=1e-14, epsrel=1e-14, limit=200)[0]
            for ends in pairwise(np.unique([*radii, *([centre] if 0.2 < centre < 1.0 else [])]))
        )  # fmt: skip

    assert found == pytest.approx(summed(along) / summed(lambda _: 1.0), abs=2e-13)


def test_a_tabulated_law_converges_with_its_rows():
    """W = 1 − ρ²: order 2 in the spacing, towards ⟨x²⟩ = 1/6 and the integrals at a middle φ."""
    errors = []
    fine = np.array(profile_law(t := np.linspace(0, 1, 513), 1 - t**2).integrals(0.9))
    rows = [8, 16, 32, 64]
    for n in rows:
        rho = np.linspace(0.0, 1.0, n + 1)
        law = profile_law(rho, 1.0 - rho**2)
        errors.append(
            [abs(law.mean_square - 1 / 6), np.abs(np.array(law.integrals(0.9)) - fine).max()]
        )
    slopes = np.polyfit(np.log(rows), np.log(errors), 1)[0]
    np.testing.assert_allclose(slopes, -2.0, atol=0.1)


def test_profile_from_a_file(tmp_path: Path):
    path = tmp_path / "cone.csv"
    path.write_text("rho,W\n# a cone\n0,2\n0.5,1\n1,0\n", encoding="utf-8")
    law = law_of(str(path))
    assert law.name == "cone.csv" and abs(law.mean_square - 0.15) < 1e-13
    path.write_text("0,2\n1,0\n", encoding="utf-8")
    assert abs(law_of(str(path)).mean_square - 0.15) < 1e-13


# --- singular lines -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "power"), [("galin", 1.5), ("hertz", 2.5), ("uniform", 2.0), ("ring", 1.0)]
)
def test_singularity_at_the_rim(name, power):
    """High differences of p_a towards π/4 from the sliding side fall like the power of |x|."""
    x = 2.0 ** -np.arange(5, 12)
    signs = np.array([1.0, -5.0, 10.0, -10.0, 5.0, -1.0])

    def exponents(side):
        phi = QUARTER + side * x[:, None] * np.arange(6)
        difference = np.abs(law_of(name).integrals(phi).a @ signs)
        return np.log2(difference[:-1] / difference[1:])

    assert np.abs(exponents(-1.0)[-3:] - power).max() < 0.15
    if name in ("galin", "hertz"):  # beyond π/4 they are elementary
        assert exponents(1.0)[:4].min() > 4.0


def test_washer_is_singular_at_both_edges_only():
    law = law_of("annulus:0.6")
    x, signs = 2.0 ** -np.arange(7, 12), np.array([1.0, -4.0, 6.0, -4.0, 1.0])

    def order(phi):
        around = phi + x[:, None] * np.arange(-2, 3)
        difference = np.abs(law.integrals(around).a @ signs)
        return np.log2(difference[:-1] / difference[1:]).mean()

    edges = [math.atan(1 / edge) for edge in law.edges]
    assert all(abs(order(phi) - 2.0) < 0.1 for phi in edges)
    assert all(order(phi) > 3.5 for phi in (0.5, 0.9, 1.25))


# --- refusals ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("rubber", "no pressure law is called 'rubber': choose uniform"),
        ("annulus", "choose"),
        ("annulus:", "between 0 and 1"),
        ("annulus:1", "1 is 'ring'"),
        ("annulus:-0.1", "between 0 and 1"),
        ("annulus:nan", "between 0 and 1"),
        ("annulus:x", "between 0 and 1"),
        ("/nowhere/at/all.csv", "cannot read"),
    ],
)
def test_unknown_laws_are_refused(text, words):
    with pytest.raises(InputError, match=words):
        law_of(text)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "is empty"),
        ("rho,W\n", "no rows of numbers"),
        ("0,1,2\n1,1,2\n", r"must hold the columns r and p: .* \(its columns are 3"),
        ("0,1\n1,x\n", "line 2, column 2: 'x' is no number"),
        ("1,1\n", "line 1 is the only row of numbers: two or more"),
        ("0,1\n0.5,1\n", "ascend from 0 or more to 1"),
        ("0,1\n0.5,1\n0.5,2\n1,1\n", "line 3: 0.5 again: the radii must ascend"),
        ("-0.1,1\n1,1\n", "ascend"),
        ("0,1\n1,-1\n", "nowhere negative"),
        ("0,0\n1,0\n", "not all zero"),
        ("0,1\n1,nan\n", "line 2: it has no pressure"),
    ],
)
def test_bad_profiles_are_refused(content, words, tmp_path: Path):
    path = tmp_path / "p.csv"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=words):
        law_of(str(path))


def test_out_of_range():
    with pytest.raises(InputError, match="outside full contact under the pressure law hertz"):
        law_of("hertz").resultants(0.3, 0.9)
    with pytest.raises(InputError, match="phi"):
        law_of("ring").resultants(2.0, 0.5)
    for gyration in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="gyration"):
            limit_ratio(law_of("ring"), 0.0, gyration)


@pytest.mark.parametrize("size", [1e308, 1e-320])
def test_only_the_shape_of_a_profile_matters(size: float):
    flat = profile_law([0.0, 1.0], [size, size]).resultants([0.1, 0.9], 0.5)
    even = profile_law([0.0, 1.0], [1.0, 1.0]).resultants([0.1, 0.9], 0.5)
    np.testing.assert_array_equal(np.stack(flat), np.stack(even))


def test_words_where_numbers_belong_are_said():
    with pytest.raises(InputError, match="radii must be real numbers"):
        profile_law("a", "b")
    with pytest.raises(InputError, match="must be a str"):
        law_of(3)
