"""Measured pressure profiles: noise, steps, thin rings; what cannot be is refused in a sentence."""

from __future__ import annotations

import pickle
import re
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from pucks import simulate
from rarely import thorough
from scipy.integrate import quad, solve_ivp

import puck_tables as pt
from puck_tables.errors import AccuracyError, InputError
from puck_tables.table import friction_section
from puck_tables.table.slip_spline import slip_spline

RADII = np.linspace(0.0, 1.0, 21)


def measured(seed: int, noise: float = 0.03):
    rng = np.random.default_rng(seed)
    return pt.profile_law(RADII, (1.0 - 0.5 * RADII**2) * (1.0 + noise * rng.standard_normal(21)))


@pytest.mark.thorough
def test_a_profile_with_noise_works_at_the_default_tolerance():
    """Against an integrator that has friction straight from the law."""
    law = measured(0)
    run = simulate((1.0, 0.0), 5.0, delta=0.5, pressure=law)

    def rates(_, y):
        log_v, turn, log_w = y[:3]
        phi = np.arctan(np.exp(log_w - log_v))
        rho, Q = law.friction(phi, 0.5), np.hypot(np.exp(log_v), np.exp(log_w))
        v = np.exp(log_v)
        return [
            -float(rho.parallel), -np.sin(phi) * float(rho.perpendicular), -float(rho.spin),
            Q, Q * v * np.cos(turn), Q * v * np.sin(turn),
        ]  # fmt: skip

    start = [0.0, 0.0, np.log(5.0), 0.0, 0.0, 0.0]
    truth = solve_ivp(rates, (0.0, 50.0), start, "DOP853", rtol=1e-11, atol=1e-13).y[3:, -1]
    unit = np.hypot(1.0, 5.0)
    assert run.stop_time == pytest.approx(truth[0], abs=1e-9 * unit)
    assert run.stop_position == pytest.approx(truth[1:], abs=1e-9 * unit**2)


def test_integrals_of_a_rough_profile_by_their_definition():
    """Rings of radius ρ: the mean of the slip direction round each, then over the load."""
    rng = np.random.default_rng(4)
    radii = np.array([0.2, 0.3, 0.300001, 0.7, 0.75, 1.0])
    pressure = rng.random(6)
    law = pt.profile_law(radii, pressure)
    angle = (np.arange(4096) + 0.5) * (2.0 * np.pi / 4096)

    def load(rho):
        return np.interp(rho, radii, pressure) * rho

    def along(rho, phi):
        ahead = np.cos(phi) - np.sin(phi) * rho * np.sin(angle)
        return (ahead / np.hypot(ahead, np.sin(phi) * rho * np.cos(angle))).mean()

    for phi in (0.3, 1.45):  # the centre of rotation outside of all rings, and inside
        total, mean = 0.0, 0.0
        for low, high in pairwise(radii):
            total += quad(load, low, high, epsabs=1e-13)[0]
            mean += quad(lambda rho, phi=phi: load(rho) * along(rho, phi), low, high,
                         epsabs=1e-11)[0]  # fmt: skip
        found = float(law.integrals(phi).a) * np.cos(phi)
        assert found == pytest.approx(mean / total, abs=1e-9)


def test_a_tolerance_out_of_reach_is_refused_with_one_that_is_not(monkeypatch):
    monkeypatch.setattr(friction_section, "slip_spline", partial(slip_spline, finest=64))
    law = measured(1, noise=0.3)
    with pytest.raises(AccuracyError, match="--tol") as refused:
        simulate((1.0, 0.0), 5.0, delta=0.2, pressure=law)
    tol = float(re.search(r"--tol\) of (\S+) or more", str(refused.value)).group(1))
    assert 1e-9 < tol < 1e-4
    assert simulate((1.0, 0.0), 5.0, delta=0.2, pressure=law, tol=tol).stop_time > 0.0


@pytest.mark.parametrize("pressure", [[1.0, 0.2, 0.3], thorough([0.1, 1.0, 0.0])])
def test_a_tip_in_the_middle_costs_no_order(pressure):
    """A load that is not flat at the centre: its section halves its error sixteenfold."""
    law = pt.profile_law([0.0, 0.5, 1.0], pressure)
    errors = [friction_section.friction_section(law, 0.2, tol).error for tol in (1e-6, 1e-9)]
    cells = [friction_section.friction_section(law, 0.2, tol).spline.cells for tol in (1e-6, 1e-9)]
    assert np.log(errors[0] / errors[1]) / np.log(cells[1] / cells[0]) > 3.5
    assert simulate((1.0, 0.0), 5.0, delta=0.2, pressure=law, tol=1e-11).stop_time > 0.0


@pytest.mark.parametrize(
    ("radii", "pressure", "words"),
    [
        ([1.0 - 2.0**-53, 1.0], [1.0, 1.0], "nearer than 1e-12"),
        ([0.0, 1.0 - 2.0**-53, 1.0], [0.0, 0.0, 1.0], "nearer than 1e-12"),
        ([0.0, 0.5, 0.5 + 2.0**-53, 1.0], [1.0, 1.0, 0.0, 0.0], "nearer than 1e-12"),
        ([0.0, 1e-320, 1.0], [0.0, 1.0, 1.0], "nearer than 1e-12"),
        ([1.0 - 1e-10, 1.0], [1.0, 1.0], "thinner than"),
        ([0.0, 1.0 - 1e-9, 1.0], [0.0, 0.0, 1.0], "thinner than"),
        ([0.0, 1e-9, 1.0], [1.0, 0.0, 0.0], "thinner than"),
        ([0.0, 1e-9, 1.0], [1.0, 0.0, 1e-40], "thinner than"),
    ],
)
def test_profiles_thinner_than_rounding_are_refused(radii, pressure, words):
    with pytest.raises(InputError, match=words):
        pt.profile_law(radii, pressure)


@pytest.mark.parametrize("thin", [2e-6, 1e-4, 1e-2])
def test_thin_rings_are_nearly_the_ring(thin):
    law = pt.profile_law([1.0 - thin, 1.0], [1.0, 1.0])
    found = simulate((1.0, 0.0), 1.0, pressure=law, tol=1e-6, gyration=1.0).stop_time
    ring = simulate((1.0, 0.0), 1.0, pressure="ring", tol=1e-6, gyration=1.0).stop_time
    assert found == pytest.approx(ring, abs=2.0 * thin + 2e-6)


@pytest.mark.parametrize("name", ["uniform", "galin", "hertz", "ring", "annulus:0.5"])
def test_every_law_and_its_results_go_to_other_processes(name):
    law = pickle.loads(pickle.dumps(pt.law_of(name)))
    assert float(law.integrals(0.3).b) == float(pt.law_of(name).integrals(0.3).b)
    run = simulate((1.0, 0.0), 1.0, pressure=name, delta=0.1, tol=1e-6)
    assert pickle.loads(pickle.dumps(run)).stop_time == run.stop_time


def test_a_profile_pickles_too():
    law = measured(2)
    again = pickle.loads(pickle.dumps(law))
    assert float(again.integrals(0.3).b) == float(law.integrals(0.3).b)
