"""Where errors of a launch that was aimed lead: against differences of runs, and a Monte Carlo."""

from __future__ import annotations

import numpy as np
import pytest

from puck_tables import Puck, Scene
from puck_tables.results import Aim

PUCK = Puck(radius=0.04, height=0.05, friction=0.2)
TARGET = (0.9, -0.4)
STEP = 1e-4  # m/s, rad, rad/s: differences err by its square, and by the 1e-12 of a run over it


def ends(puck: Puck, launch: np.ndarray) -> np.ndarray:
    """Place and body angle where an integration of a launch (speed, heading, spin) stops."""
    speed, heading, spin = launch.tolist()
    velocity = (speed * np.cos(heading), speed * np.sin(heading))
    run = puck.simulate(velocity, spin, frames=2, tol=1e-11)
    return np.array([*run.stop_position, run.orientation[-1]])


def launches_of(found: Aim) -> np.ndarray:
    return np.stack([found.launch_speed, found.launch_heading, found.launch_spin], axis=1)


@pytest.mark.parametrize("puck", [PUCK, Puck(0.04, height=0.3, friction=0.2)], ids=["flat", "tall"])
def test_derivatives_are_those_of_runs(puck: Puck):
    found = puck.aim(TARGET, spin=14.0)
    assert found.launch_spin.size == 1
    for n, launch in enumerate(launches_of(found)):
        truth = [
            (ends(puck, launch + move) - ends(puck, launch - move)) / (2.0 * STEP)
            for move in STEP * np.eye(3)
        ]
        np.testing.assert_allclose(found.jacobian[n], np.transpose(truth), rtol=1e-5, atol=1e-6)


def test_the_spread_is_that_of_runs_drawn_at_random():
    """Three hundred runs: a deviation of theirs is known to some 4 %, so 16 % is allowed."""
    found = PUCK.aim(TARGET, spin=14.0)
    errors = np.array([0.01, 0.005, 0.3])
    drawn = launches_of(found)[0] + errors * np.random.default_rng(5).normal(size=(300, 3))
    stops = np.array([ends(PUCK, launch) for launch in drawn])
    out = found.spread(np.diag(errors**2), samples=4000)
    np.testing.assert_allclose(out.deviation[0], stops.std(axis=0, ddof=1), rtol=0.16)
    linear = out.covariance[0] / np.outer(out.deviation[0], out.deviation[0])
    np.testing.assert_allclose(linear, np.corrcoef(stops.T), atol=0.15)
    assert out.is_linear.all()


def test_it_agrees_with_the_odds_of_a_board():
    """The share of stops within a circle, of the linear covariance and of runs of the board."""
    heading, share, within = 0.01, 0.02, 0.03
    odds = Scene(pucks=[PUCK]).aim(TARGET, spin=14.0).odds(
        heading=heading, speed=share, within=within
    )  # fmt: skip
    found = PUCK.aim(TARGET, spin=14.0)
    errors = np.diag([share * found.launch_speed[0], heading]) ** 2
    covariance = found.spread(errors, of=("launch_speed", "launch_heading")).covariance[0, :2, :2]
    off = np.random.default_rng(1).multivariate_normal((0.0, 0.0), covariance, 200_000)
    near = (np.hypot(*off.T) <= within).mean()
    assert 0.2 < near < 0.9
    assert odds.nominal.low - 0.02 < near < odds.nominal.high + 0.02


def test_of_many_targets_and_of_none():
    many = PUCK.aim([TARGET, (0.5, 0.5)], spin=[14.0, -3.0])
    assert many.jacobian.shape == (2, 3, 3)
    np.testing.assert_allclose(many[1].jacobian, many.jacobian[1:], rtol=1e-12)
    none = PUCK.aim(TARGET, max_speed=0.5, max_spin=0.1)
    assert none.jacobian.shape == (0, 3, 3)
    assert none.spread(np.eye(3)).covariance.shape == (0, 3, 3)
