"""tol holds for stops and states of every puck, and the error estimate is honest: by truth."""

from __future__ import annotations

import math

import numpy as np
import pytest
from any_puck import motion_by_truth
from pucks import simulate
from rarely import few
from test_any_puck import launch

from puck_tables import law_of, states, stop
from puck_tables.errors import AccuracyError
from puck_tables.motion import limit_ratio

JUDGE = 3e-12  # of the longest motion: what scipy is off


def judged(law: str, delta: float, gyration: float, u: float, tol: float) -> None:
    v0, w0 = launch(u)
    truth, states = motion_by_truth(law, delta, gyration, u)
    v, psi, rim, time, x, y, theta = states.T
    options = {"delta": delta, "pressure": law, "gyration": gyration}
    run = simulate(v0, w0, times=time, tol=tol, **options)
    slack = JUDGE * max(1.0, truth[0])
    found = [run.stop_time, *run.stop_position, run.path_length, run.body_angle]
    errors = [
        np.abs(np.array(found) - truth), run.speed - v, run.spin - rim, run.x - x, run.y - y,
        run.orientation - theta, np.minimum(run.speed, v) * (run.heading - psi),
    ]  # fmt: skip
    worst = max(float(np.abs(error).max()) for error in errors)
    assert worst <= tol + slack, (law, delta, gyration, u, tol, worst)
    assert worst <= 2.0 * run.error_estimate + slack, (law, delta, gyration, u, tol, worst)
    assert run.error_estimate <= tol
    stops = stop(v0, w0, tol=tol, **options)
    off = np.array([stops.stop_time, *stops.stop_position]) - truth[:3]
    assert np.abs(off).max() <= tol + slack


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("puck", "phi", "tol"),
    few(2, [
        (("uniform", 0.5, 10.0), 1e-10, 1e-9), (("uniform", 0.3, 0.1), 0.5 * math.pi - 1e-9, 1e-8),
        (("annulus:0.3", 0.5, 7.0), 1e-8, 1e-7), (("uniform", 0.0, 5.0), 3e-11, 1e-5),
        (("uniform", 2.0, 8.0), 7.4e-9, 1e-7),
    ]),
)  # fmt: skip
def test_next_to_pure_motions_of_much_and_little_inertia(puck, phi, tol):
    """A puck of much inertia slides to a crawl with hardly any spin, and then spins for long."""
    judged(*puck, math.log(math.tan(phi)), tol)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("puck", "u"),
    few(1, [
        (("annulus:0.7", 0.5, 0.4), 1.0), (("ring", 1.0, 4.0), -0.5), (("uniform", 0.5, 0.15), 0.3),
        (("ring", 1.0, 0.7), 1.0986), (("hertz", 0.3, 0.2), 0.8), (("uniform", 1.5, 0.3), 2.0),
    ]),
)  # fmt: skip
def test_states_between_launch_and_stop_keep_tol(puck: tuple[str, float, float], u: float):
    for tol in (1e-4, 1e-7, 1e-10):
        judged(*puck, u, tol)


@pytest.mark.thorough
def test_states_of_other_pucks_is_as_exact_as_it_says():
    for puck in (("annulus:0.7", 0.5, 0.4), ("uniform", 0.5, 0.15)):
        v0, w0 = launch(0.5)
        _, true = motion_by_truth(*puck, 0.5)
        found = states(v0, w0, true[:, 3], pressure=puck[0], delta=puck[1], gyration=puck[2])
        for got, at in ((found.speed, 0), (found.spin, 2), (found.x, 4), (found.y, 5)):
            assert np.abs(got - true[:, at]).max() <= 1e-9


def test_the_limit_motion_and_pure_motions_report_what_they_are_off():
    for puck in (("annulus:0.7", 0.5, 0.4), ("uniform", 2.5, 0.3), ("uniform", 0.5, 3.0)):
        law, delta, gyration = puck
        options = {"delta": delta, "pressure": law, "gyration": gyration, "tol": 1e-6}
        run = simulate((0.0, 0.0), 1.0, **options)
        turning = 2.0 * gyration**2 / float(law_of(law).friction(0.5 * math.pi, 0.0).spin)
        assert abs(run.stop_time - turning) <= 2.0 * run.error_estimate
        ratio = float(limit_ratio(delta, law, gyration))
        if 0.0 < ratio < math.inf:
            limit = simulate((1.0, 0.0), ratio, **options)  # D, or by rounding next to it
            along = float(law_of(law).friction(math.atan(ratio), delta).parallel)
            off = abs(limit.stop_time / math.hypot(1.0, ratio) - 1.0 / along)
            assert off <= 2.0 * limit.error_estimate


@pytest.mark.nightly
def test_everywhere_for_every_law():
    rng = np.random.default_rng(13)
    for _ in range(12):
        kind = str(rng.choice(["uniform", "ring", "hertz", "galin", "annulus:0.6"]))
        highest = 3.5 if kind == "uniform" else law_of(kind).delta_max
        puck = (kind, float(rng.uniform(0.0, highest)), float(10.0 ** rng.uniform(-1.0, 1.0)))
        near = 10.0 ** -rng.uniform(0.0, 12.0)
        for u in (math.log(near), -math.log(near), float(rng.uniform(-3.0, 3.0))):
            for tol in (1e-3, 1e-6, 1e-9):
                try:
                    judged(*puck, u, tol)
                except AccuracyError:  # said, not wrong
                    continue
