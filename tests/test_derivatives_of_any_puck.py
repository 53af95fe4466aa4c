"""Derivatives of tall pucks, other laws and other spreads of mass, against a judge of their own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from slope_truth import WAYS, next_to, state_slopes, stop_slopes

from puck_tables import states, stop
from puck_tables.errors import InputError
from puck_tables.motion.body import body_of
from puck_tables.stopping import variational

BOUND = 1e-7  # in units of Q, J and r of the launch, as promised
# what the judge itself errs by where slides cross φ = π/4: friction of a ring has a logarithm there
REACH = {"ring": 1e-5}
AWAY = np.array([0.12, 0.35, 0.6, 1.2, 1.42])  # from all that is singular
USUAL = [("uniform", 2.0, 0.5**0.5), ("hertz", 0.5, 0.6)]
MORE = [
    ("uniform", 1.3, 0.5**0.5), ("uniform", 3.2, 0.5**0.5), ("uniform", 0.6, 1.5),
    ("uniform", 0.5, 0.4), ("uniform", 1.7, 0.9), ("hertz", 0.3, 1.1), ("ring", 1.0, 0.8),
]  # fmt: skip


def kind(case: tuple[str, float, float]) -> dict:
    law, delta, gyration = case
    return {"pressure": law, "delta": delta, "gyration": gyration}


def stop_errors(case: tuple[str, float, float], phi: np.ndarray, *ways: dict) -> np.ndarray:
    """Largest errors of the derivatives by v, rω, δ of stops, (3,); of several judges the nearest.

    None of them shares anything with what is judged: where one agrees to 1e-7, it is right.
    """
    velocity = np.stack([np.cos(phi), 0.0 * phi], axis=-1)
    found = stop(velocity, np.sin(phi), **kind(case), jacobian=True).jacobian[..., [0, 2, 3]]
    found = np.moveaxis(found, (2, 1), (0, 1))
    off = [np.abs(found - stop_slopes(*case, phi, **way)[[0, 1, 3]]) for way in ways or ({},)]
    return np.min(off, axis=0).max(axis=(1, 2))


def state_errors(case: tuple[str, float, float], phi: np.ndarray, *ways: dict) -> np.ndarray:
    """The same of states, and by time, (4,)."""
    moments = np.array([0.2, 1.0, 3.0]) * min(1.0, 2.0 * case[2] ** 2)
    judged = [state_slopes(*case, phi, moments, **way) for way in ways]
    times = judged[0][0]
    velocity = np.stack([np.cos(phi), 0.0 * phi], axis=-1)
    found = states(velocity, np.sin(phi), times, **kind(case), jacobian=True)
    slopes = np.moveaxis(found.jacobian[..., [0, 2, 3, 6]], (3, 2), (0, 1))
    off = [np.abs(slopes - truth[[0, 1, 3, 4]]) for _, _, truth in judged]
    return np.min(off, axis=0).max(axis=(1, 2, 3))


@pytest.mark.thorough
@pytest.mark.parametrize("case", USUAL)
def test_stops_and_states(case: tuple[str, float, float]):
    assert stop_errors(case, AWAY[::2], WAYS[0]).max() <= BOUND
    assert state_errors(case, AWAY[::2], WAYS[0]).max() <= BOUND


@pytest.mark.nightly
@pytest.mark.parametrize("case", USUAL + MORE)
def test_next_to_all_that_is_singular(case: tuple[str, float, float]):
    limit = math.atan(body_of(*[case[0], case[1], case[2]]).limit_ratio)
    phi = next_to(0.0, 0.25 * math.pi, limit, 0.5 * math.pi)
    bound = REACH.get(case[0], BOUND)
    assert stop_errors(case, phi, *WAYS).max() <= bound
    assert stop_errors(case, AWAY).max() <= BOUND
    assert state_errors(case, AWAY, WAYS[0], {}).max() <= bound


def test_many_launches_are_looked_up_and_the_few_too_steep_are_not():
    """Splines over φ against each launch by itself, next to both ends and the lines, too."""
    rng = np.random.default_rng(3)
    phi = np.concatenate([rng.uniform(0.0, 0.5 * math.pi, 60), next_to(0.0, 0.25 * math.pi),
                          [0.0, 0.5 * math.pi]])  # fmt: skip
    way, slip = rng.uniform(0.0, 6.3, phi.size), np.exp(rng.normal(size=phi.size))
    speed = slip * np.where(phi == 0.5 * math.pi, 0.0, np.cos(phi))
    velocity = np.stack([speed * np.cos(way), speed * np.sin(way)], axis=-1)
    how = {"pressure": "hertz", "delta": 0.5, "gyration": 0.6, "decel": 1.4, "jacobian": True}
    few = stop(velocity, slip * np.sin(phi), **how).jacobian
    times = variational.MANY // phi.size + 1
    many = stop(np.tile(velocity, (times, 1)), np.tile(slip * np.sin(phi), times), **how).jacobian
    off = np.abs(many[: phi.size] - few) / np.maximum(slip, slip**2)[:, None, None]
    assert np.nanmax(off) <= 0.5 * BOUND
    assert np.array_equal(np.isnan(many[: phi.size]), np.isnan(few))
    assert np.isnan(few[-1, 3, :2]).all()  # the path of pure spin grows like |v|


def test_heights_of_all_kinds_in_one_call():
    """Plain ones get what they get alone, tall ones too."""
    velocity, spin = np.array([[1.0, 0.2], [0.4, -1.0], [0.3, 0.3]]), np.array([2.0, -1.0, 0.5])
    heights = np.array([0.5, 2.0, 0.9])
    whole = stop(velocity, spin, delta=heights, jacobian=True).jacobian
    times = [0.3, 0.6]
    moving = states(velocity[:, None], spin[:, None], times, delta=heights[:, None], jacobian=True)
    for n in range(3):
        one = stop(velocity[n], spin[n], delta=heights[n], jacobian=True)
        assert np.array_equal(one.jacobian, whole[n])
        alone = states(velocity[n], spin[n], times, delta=heights[n], jacobian=True)
        assert np.array_equal(alone.jacobian, moving.jacobian[n])
        assert np.array_equal(alone.x, moving.x[n])


def test_the_way_from_a_plain_puck_to_others_is_continuous():
    """A gyration beside that of a plain puck: the stop table against variational equations."""
    velocity, spin = np.random.default_rng(5).normal(size=(12, 2)), np.linspace(-2.0, 2.0, 12)
    velocity[3], spin[5] = 0.0, 0.0
    beside = 0.5**0.5 * (1.0 + 1e-12)
    for height in (0.0, 1.0):
        how = {"delta": height, "decel": 1.3, "radius": 0.8, "jacobian": True}
        one, two = (stop(velocity, spin, **how, gyration=k).jacobian for k in (0.5**0.5, beside))
        assert np.allclose(one, two, atol=1e-7, rtol=1e-7, equal_nan=True)
        time = np.array([0.0, 0.4, 1.0, 30.0])
        one, two = (
            states(velocity[:, None], spin[:, None], time, **how, gyration=k).jacobian
            for k in (0.5**0.5, beside)
        )
        assert np.allclose(one, two, atol=1e-7, rtol=1e-7)


def test_a_slide_without_spin_in_elementary_functions():
    """Under every law x = vt − Jt²/2; by the spin it begins to turn."""
    found = states((1.0, 0.0), 0.0, [0.4, 9.0], pressure="ring", delta=1.5, jacobian=True)
    assert found.derivative("x", "vx") == pytest.approx([0.4, 1.0], abs=1e-9)
    assert found.derivative("x", "decel") == pytest.approx([-0.08, -0.5], abs=1e-9)
    assert found.derivative("vx", "time") == pytest.approx([-1.0, 0.0], abs=1e-9)
    assert found.derivative("y", "vy") == pytest.approx([0.32, 0.5], abs=1e-9)
    assert found.derivative("y", "spin")[0] < 0.0


def test_errors_of_a_launch_of_a_tall_puck():
    """Covariance in, covariance out, beside samples."""
    small = np.diag([1e-3, 2e-3, 5e-3]) ** 2
    out = stop((1.0, 0.3), 1.5, delta=2.0, jacobian=True).spread(small, samples=400, seed=2)
    assert out.is_linear
    assert np.abs(out.ratio - 1.0).max() < 0.15
    found = states((1.0, 0.3), 1.5, 0.4, pressure="hertz", gyration=0.6, jacobian=True)
    out = found.spread(small, samples=60, seed=2)
    assert np.abs(out.ratio - 1.0).max() < 0.4


def test_what_has_no_derivative_is_refused():
    with pytest.raises(InputError, match="the launch is at rest"):
        stop((0.0, 0.0), 0.0, delta=2.0, jacobian=True)
    assert not states((0.0, 0.0), 0.0, [0.0, 1.0], delta=2.0, jacobian=True).jacobian.any()
    law = {"pressure": "ring", "gyration": 1.0}
    with pytest.raises(InputError, match="r w/v = 1, the limit of this puck"):
        stop((0.6, 0.8), -1.0, **law, jacobian=True)
    with pytest.raises(InputError, match="r w/v = 1, the limit of this puck"):
        states((0.6, 0.8), 1.0, 0.3, **law, jacobian=True)
    assert np.isfinite(stop((0.6, 0.8), 1.0001, **law, jacobian=True).jacobian).all()
    with pytest.raises(InputError, match="by must be one of vx, vy, spin"):
        stop((1.0, 0.0), 1.0, delta=2.0, jacobian=True).derivative("stop_x", "height")
