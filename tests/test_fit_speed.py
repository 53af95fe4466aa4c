"""A friction coefficient over slip speed is found from a film; the truth is a sum over the base."""

from __future__ import annotations

import math

import numpy as np
import pytest
from film_judge import G, noisy
from scipy.integrate import solve_ivp

import puck_tables as pt

RADIUS, NOISE = 0.04, (0.3e-3, 5e-3)
TIMES = np.arange(0.0, 1.4, 1.0 / 90.0)
SPEEDS, VALUES = [0.0, 1.0, 4.0], [0.20, 0.14, 0.17]
FLAT = pt.Puck(radius=RADIUS)


@pytest.fixture(scope="module")
def true() -> np.ndarray:
    """x, y, angle (3, n) of a flat puck: rings of the base, their elements one by one."""
    rho = RADIUS * np.sqrt((np.arange(64) + 0.5) / 64)
    theta = 2.0 * math.pi * (np.arange(128) + 0.5) / 128
    px, py = (np.outer(rho, trig).ravel() for trig in (np.cos(theta), np.sin(theta)))

    def rates(_: float, z: np.ndarray) -> list[float]:
        ux, uy = z[3] - z[5] * py, z[4] + z[5] * px
        u = np.hypot(ux, uy)
        pull = G * np.interp(u, SPEEDS, VALUES) / np.maximum(u, 1e-9)
        turn = -2.0 / RADIUS**2 * np.mean(pull * (px * uy - py * ux))
        return [*z[3:], -np.mean(pull * ux), -np.mean(pull * uy), turn]

    stop = lambda _, z: math.hypot(z[3], z[4], RADIUS * z[5]) - 1e-3  # noqa: E731
    stop.terminal = True
    start = [0.0, 0.0, 0.0, 1.8, 0.4, 45.0]
    found = solve_ivp(
        rates, (0.0, 3.0), start, "RK45", rtol=1e-6, atol=1e-8, dense_output=True, events=stop
    )
    return found.sol(np.minimum(TIMES, found.t[-1]))[:3]


def film(true: np.ndarray, seed: int) -> pt.Track:
    return pt.Track(TIMES, *noisy(np.random.default_rng(seed), true, NOISE))


@pytest.mark.thorough
def test_friction_over_slip_speed_is_found(true, tmp_path):
    found = pt.fit(film(true, 1), FLAT, fixed={"delta": 0.0}, slip_speeds=SPEEDS)
    speeds, values, errors = found.friction_over()
    assert speeds.tolist() == SPEEDS
    assert np.all(np.abs(values - VALUES) < 4.0 * errors) and np.all(errors < 3e-3)
    assert found["friction_1"].error == pytest.approx(errors[1], rel=0.1)
    _, middle, band = found.friction_over(np.array([0.5]))
    assert middle[0] == pytest.approx(0.17, abs=4.0 * band[0])
    assert found.constant_chi2 > found.chi2 + 500.0
    assert len(found.plot(tmp_path / "fit.png").axes) == 6
    for wrong in (lambda: found.simulate(), lambda: found.friction_over(np.array([5.0]))):
        with pytest.raises(pt.InputError):
            wrong()


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"slip_speeds": [0.0]}, "2 to 8 speeds"),
        ({"slip_speeds": [0.1, 1.0]}, "ascend from 0"),
        ({"slip_speeds": 3.0}, "list of speeds"),
        ({"slip_speeds": SPEEDS, "between": "quintic"}, "cubic or linear"),
        ({"slip_speeds": SPEEDS, "free": ["friction", "drag"]}, "drag"),
        ({"slip_speeds": SPEEDS, "fixed": {"friction": 0.2}}, "do not give the friction"),
        ({"slip_speeds": [0.0, 1.0]}, "give speeds up to 3.7"),
        ({"slip_speeds": SPEEDS, "fixed": {"delta": 1.5}}, "delta = 2 f h/r is 1.5"),
        ({"free": ["friction_1"]}, "slip_speeds="),
    ],
)
def test_speeds_that_make_no_law_are_refused(true, how, words):
    with pytest.raises(pt.InputError, match=words):
        pt.fit(film(true, 1), FLAT, **how)


def test_pressure_other_than_uniform_is_refused(true):
    with pytest.raises(pt.InputError, match="uniform pressure alone"):
        pt.fit(film(true, 1), pt.Puck(radius=RADIUS, pressure="ring"), slip_speeds=SPEEDS)
