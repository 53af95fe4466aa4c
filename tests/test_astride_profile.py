"""Friction under a tabulated pressure on several frictions, against circles."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pressure_judge
import pytest
from astride_judge import FloorMap
from rarely import nightly, thorough
from scipy.integrate import quad

import puck_tables as pt
from puck_tables.kernels.circle_arcs import arc_to, circle_at
from puck_tables.world.floor_forces import friction_at

CORNERS = np.array([[-0.5, -0.9], [1.4, -0.2], [0.1, 0.1], [0.3, 1.2]])


def strips(borders, values):
    return FloorMap(borders, values), pt.Floor(strips=pt.Strips(tuple(borders), tuple(values)))


def disc(x, y, radius):
    floor_map = FloorMap([], [0.3], [(x, y, radius, 0.05)])
    return floor_map, pt.Floor(patches=[pt.Patch(0.05, (x, y), radius)])


FLOORS = {
    "strips": strips([-0.3, 0.4], [0.3, 0.1, 0.2]),
    "through the centre": strips([0.0], [0.3, 0.1]),
    "beside the centre": strips([0.01], [0.3, 0.1]),
    "round": disc(0.5, -0.4, 0.7),
    "round, within": disc(0.2, -0.1, 0.5),
    "round, about the centre": disc(0.0, 0.0, 0.5),
    "round, of most of it": disc(5.0, 0.0, 5.2),
    "polygon": (FloorMap([], [0.3], polygons=[(CORNERS, 0.05)]),
                pt.Floor(patches=[pt.Patch(0.05, corners=CORNERS.tolist())])),
}  # fmt: skip
ROUGH = np.random.default_rng(5)


def rough(rows):
    radii = np.concatenate([[0.0], np.sort(ROUGH.uniform(0.02, 0.98, rows - 2)), [1.0]])
    return list(zip(radii.tolist(), ROUGH.uniform(0.2, 2.0, rows).tolist(), strict=True))


PROFILES = {
    "two rows": [(0.0, 2.0), (1.0, 0.3)], "with a hole": [(0.2, 1.0), (0.6, 2.0), (1.0, 0.5)],
    "0 at some": [(0.0, 0.0), (0.1, 1.0), (0.3, 0.0), (0.5, 0.0), (0.7, 0.4), (1.0, 0.0)],
    "a step": [(0.0, 1.0), (0.5, 1.0), (0.500001, 0.2), (1.0, 0.2)],
    "a thin ring": [(0.999, 1.0), (1.0, 1.0)], "rough": rough(14), "sixty rows": rough(60),
}  # fmt: skip
BESIDE_A_BORDER, AT_THE_RIM, OUTSIDE = (0.1, 0.39, -1.0), (0.6, 0.8, 1.0 - 1e-6), (1.0, 0.4, 0.3)
SLIPS = [
    (1.0, 0.4, 0.0), (1.0, 0.3, 1e-5), OUTSIDE, AT_THE_RIM, (0.4, 0.9, -0.6), (0.3, -0.4, 1.0),
    BESIDE_A_BORDER, (0.1, 0.4, -1.0), (0.0, 0.5, 1.0), (1e-7, 0.0, 1.0), (0.0, 0.0, 1.0),
]  # fmt: skip


def against_circles(path, rows, floor, slip):
    """How far friction under a profile, straight between its rows, is from the judge's."""
    path.write_text("rho,W\n" + "".join(f"{rho!r},{w!r}\n" for rho, w in rows))
    radii, heights = np.array(rows).T
    load, square = 0.0, 0.0  # ∫ W ρ dρ and ½ ∫ W ρ³ dρ by Gauss's rule, exact on each piece
    node, weight = np.polynomial.legendre.leggauss(4)
    for low, high in pairwise(radii):
        rho = 0.5 * (low + high) + 0.5 * (high - low) * node
        part = 0.5 * (high - low) * weight * np.interp(rho, radii, heights) * rho
        load, square = load + part.sum(), square + 0.5 * (part * rho**2).sum()
    square /= load

    def law(at: float, _: float) -> float:
        return float(np.interp(at, radii, heights)) * 0.5 / load if at >= radii[0] else 0.0

    floor_map, surface = FLOORS[floor]
    # also where the circle is as close to a border as the centre of rotation of one slip
    bends = (math.hypot(0.4, 0.1), *(float(rho) for rho in radii if 0.0 < rho < 1.0))
    truth = pressure_judge.friction(floor_map, slip, law, 0.4, square, bends)
    puck = pt.Puck(1.0, height=0.8, friction=0.3, gravity=1.0, pressure=str(path))
    state = np.array([[0.0, 0.0, 0.0, *slip]])
    return np.abs(-friction_at(pt.Scene(puck, surface), state)[0] - truth).max()


@pytest.mark.parametrize("rates", [
    (1.0, 0.5), (0.3, 1.0), (0.7, 1.0 - 1e-5), (1.0, 1e-6), (1e-6, 1.0), (1.0, 0.0), (0.0, 1.0),
])  # fmt: skip
def test_arcs_against_quadrature(rates):
    """From opposite to the centre of rotation on, from there, and whole; also close to it."""
    (alpha, beta), rho = rates, 0.7

    def value(angle, which):
        x, y = rho * math.sin(angle), -rho * math.cos(angle)
        ux, uy = alpha - beta * y, beta * x
        ex, ey = ux / math.hypot(ux, uy), uy / math.hypot(ux, uy)
        m = x * ey - y * ex
        return (ex, ey, x * ex, y * ex, x * ey, y * ey, x * m, y * m)[which]

    for end in (-3.0, -1.6, 0.4, 2.2):
        point = rho * math.sin(end), -rho * math.cos(end), rho
        found = arc_to(alpha, beta, *point, 1.0)
        truth = [quad(value, 0.0, end, (k,), epsabs=2e-14, epsrel=1e-12)[0] for k in range(8)]
        np.testing.assert_allclose(found, truth, atol=1e-13)
        half = [0.0] * 8
        for k in (0, 3, 4, 7):
            close = [math.pi - 10.0**-n for n in range(1, 8)]
            parts = pairwise([0.0, *close, math.pi])
            half[k] = sum(quad(value, *part, (k,), epsabs=2e-14, epsrel=1e-12)[0] for part in parts)
        rest = np.array(truth) - math.copysign(1.0, end) * np.array(half)
        np.testing.assert_allclose(arc_to(alpha, beta, *point, -1.0), rest, atol=2e-13)
    np.testing.assert_allclose(circle_at(alpha, beta, rho), 2.0 * np.array(half), atol=4e-13)


@pytest.mark.parametrize("profile, floor, slip", [
    ("with a hole", "strips", (0.4, 0.9, -0.6)), ("two rows", "round", BESIDE_A_BORDER),
    thorough("0 at some", "polygon", (0.3, -0.4, 1.0)), ("a step", "strips", AT_THE_RIM),
])  # fmt: skip
def test_against_circles(tmp_path, profile, floor, slip):
    assert against_circles(tmp_path / "p.csv", PROFILES[profile], floor, slip) <= 2e-11


@pytest.mark.thorough
@pytest.mark.parametrize("floor", FLOORS)
def test_a_centre_of_rotation_anywhere(tmp_path, floor):
    """On a border and beside one, at the rim, at the centre of the base, far outside."""
    for slip in SLIPS:
        wrong = against_circles(tmp_path / "p.csv", PROFILES["with a hole"], floor, slip)
        assert wrong <= 2e-11, slip


@pytest.mark.thorough
@pytest.mark.parametrize("floor", ["strips", "round", "polygon"])
@pytest.mark.parametrize("profile", ["0 at some", "a thin ring", "rough", nightly("sixty rows")])
def test_profiles(tmp_path, profile, floor):
    for slip in (BESIDE_A_BORDER, AT_THE_RIM):
        wrong = against_circles(tmp_path / "p.csv", PROFILES[profile], floor, slip)
        assert wrong <= 2e-11, slip


def test_a_profile_of_too_many_rows_is_refused(tmp_path):
    path = tmp_path / "fine.csv"
    path.write_text("rho,W\n" + "".join(f"{rho},{1.0 + rho}\n" for rho in np.linspace(0, 1, 61)))
    puck = pt.Puck(0.04, friction=0.2, pressure=str(path))
    with pytest.raises(pt.InputError, match="it has 61: give fewer"):
        pt.Scene(puck, pt.Floor(strips=pt.Strips((0.15,), (0.2, 0.1))))
