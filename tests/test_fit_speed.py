"""A friction coefficient over slip speed is found from a film; the truth is a sum over the base."""

from __future__ import annotations

import math

import numpy as np
import pytest
from disc_judge import slid
from film_judge import noisy
from rarely import few
from scipy.interpolate import PchipInterpolator

import puck_tables as pt

RADIUS, NOISE = 0.04, (0.3e-3, 5e-3)
TIMES = np.arange(0.0, 1.4, 1.0 / 90.0)
SPEEDS, VALUES = [0.0, 1.0, 4.0], [0.20, 0.14, 0.17]
FLAT = pt.Puck(radius=RADIUS)


@pytest.fixture(scope="module")
def true() -> np.ndarray:
    """Under a law of straight lines."""
    return slid(lambda u: np.interp(u, SPEEDS, VALUES), RADIUS, (1.8, 0.4), 45.0, TIMES)


def film(true: np.ndarray, seed: int) -> pt.Track:
    return pt.Track(TIMES, *noisy(np.random.default_rng(seed), true, NOISE))


@pytest.mark.thorough
def test_friction_over_slip_speed_is_found(true, tmp_path):
    found = pt.fit(film(true, 1), FLAT, fixed={"delta": 0.0}, slip_speeds=SPEEDS, between="linear")
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
@pytest.mark.parametrize("seed", few(1, range(12)))
def test_a_law_of_rows_means_the_same_in_a_fit_and_in_a_scene(seed):
    """A cubic that rises and falls only where the rows do: scipy's."""
    rng = np.random.default_rng([35, 6, seed])
    speeds = np.concatenate([[0.0], np.cumsum(rng.uniform(0.3, 1.2, rng.integers(2, 5)))])
    speeds[-1] = max(speeds[-1], 3.5)
    values = rng.uniform(0.1, 0.3, speeds.size)
    way, spin = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(15.0, 40.0) * rng.choice([-1.0, 1.0])
    velocity = 1.5 * math.cos(way), 1.5 * math.sin(way)
    path = slid(PchipInterpolator(speeds, values), RADIUS, velocity, spin, TIMES)
    found = pt.fit(film(path, seed), FLAT, fixed={"delta": 0.0}, slip_speeds=speeds)
    _, f, errors = found.friction_over()
    told = np.array([found[f"friction_{k}"].determined for k in range(speeds.size)])
    assert told.sum() >= speeds.size - 1
    assert np.all(np.abs(f - values)[told] < 4.0 * errors[told])
    floor = pt.Floor(law=np.column_stack([speeds, values]).tolist())
    run = pt.Scene(
        pt.Puck(RADIUS), floor, pt.Launch(velocity, spin=spin), tol=1e-5
    ).simulate()  # fmt: skip
    states = run(np.minimum(TIMES, run.end_time))
    assert np.abs(np.stack([states.x, states.y]) - path[:2]).max() < 1e-4


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
        (
            {"slip_speeds": SPEEDS, "fixed": {"delta": 1.5}},
            "friction is largest delta = 2 f h/r is",
        ),
        ({"free": ["friction_1"]}, "slip_speeds="),
    ],
)
def test_speeds_that_make_no_law_are_refused(true, how, words):
    with pytest.raises(pt.InputError, match=words):
        pt.fit(film(true, 1), FLAT, **how)


def test_pressure_other_than_uniform_is_refused(true):
    with pytest.raises(pt.InputError, match="uniform pressure alone"):
        pt.fit(film(true, 1), pt.Puck(radius=RADIUS, pressure="ring"), slip_speeds=SPEEDS)
