"""Covariance of launches to covariance of results, beside samples and closed answers."""

from __future__ import annotations

import numpy as np
import pytest

from puck_tables import Puck, states, stop
from puck_tables.errors import InputError

SMALL = np.diag([1e-3, 2e-3, 5e-3]) ** 2


def test_a_slide_has_a_closed_answer():
    """Without spin t = v/J, x = v²/(2J)."""
    speed, decel = 2.0, 0.7
    found = stop((speed, 0.0), 0.0, decel=decel, jacobian=True)
    out = found.spread([[0.01, 0.002], [0.002, 0.0004]], of=("vx", "decel"))
    one = np.array([1.0 / decel, -speed / decel**2])
    two = np.array([speed / decel, -0.5 * (speed / decel) ** 2])
    given = np.array([[0.01, 0.002], [0.002, 0.0004]])
    assert out.covariance[0, 0] == pytest.approx(one @ given @ one, rel=1e-9)
    assert out.covariance[0, 1] == pytest.approx(one @ given @ two, rel=1e-9)
    assert out.deviation[1] == pytest.approx(np.sqrt(two @ given @ two), rel=1e-9)


def test_samples_agree_where_the_scatter_is_small():
    found = stop([(1.0, 0.0), (0.3, 0.4)], [2.0, -1.0], delta=0.6, jacobian=True)
    out = found.spread(SMALL, samples=4000, seed=3)
    assert out.covariance.shape == (2, 5, 5)
    assert out.is_linear.all()
    assert np.abs(out.ratio - 1.0).max() < 0.06
    again = found.spread(SMALL, samples=4000, seed=3)
    assert np.array_equal(again.sampled_covariance, out.sampled_covariance)
    # correlations, too
    for linear, sampled in zip(out.covariance, out.sampled_covariance, strict=True):
        scale = np.sqrt(np.outer(np.diag(linear), np.diag(linear)))
        assert np.abs((linear - sampled) / scale).max() < 0.1


def test_samples_tell_where_it_is_not_linear():
    """A puck next to pure spin may go anywhere: its way is |v|."""
    found = stop((1e-3, 0.0), 5.0, jacobian=True)
    out = found.spread(np.diag([0.1, 0.1, 0.01]) ** 2, samples=2000)
    assert not out.is_linear
    assert "0 of 1 launches" in out.explain()


def test_states_scatter_too():
    found = states((1.0, 0.2), 3.0, [0.5, 1.0, 9.0], delta=0.3, jacobian=True)
    given = np.diag([1e-3, 1e-3, 3e-3, 1e-3, 1e-3]) ** 2
    out = found.spread(given, of=("vx", "vy", "spin", "delta", "time"), samples=3000)
    assert out.deviation.shape == (3, 6)
    assert out.is_linear.all()
    assert not out.deviation[2, 3:].any()  # it rests


def test_one_covariance_for_each_launch():
    found = Puck.similar().stop(np.ones((2, 2)), 1.0, jacobian=True)
    out = found.spread(np.stack([SMALL, 4.0 * SMALL]))
    assert out.deviation[1] == pytest.approx(2.0 * out.deviation[0])


@pytest.mark.parametrize(
    ("covariance", "how", "message"),
    [
        (np.eye(2), {}, r"shape \(3, 3\)"),
        ([[1.0, 2.0], [2.0, 1.0]], {"of": ("vx", "vy")}, "negative variances"),
        ([[1.0, 0.5], [0.0, 1.0]], {"of": ("vx", "vy")}, "symmetric"),
        (np.eye(1), {"of": ("mass",)}, "of must name arguments of vx, vy, spin"),
        (np.eye(2), {"of": ("vx", "vx")}, "different arguments"),
        (np.full((3, 3), np.nan), {}, "finite"),
        (np.eye(1), {"of": ("delta",), "samples": 100}, "samples of delta reach"),
        (np.eye(3), {"samples": 1}, "samples must be 0 or"),
        (np.eye(3), {"samples": 10**10}, "give fewer"),
    ],
)
def test_refusals(covariance: object, how: dict, message: str):
    with pytest.raises(InputError, match=message):
        stop((1.0, 0.0), 1.0, jacobian=True).spread(covariance, **how)


def test_it_needs_derivatives():
    with pytest.raises(InputError, match="jacobian=True"):
        stop((1.0, 0.0), 1.0).spread(SMALL)
    with pytest.raises(InputError, match="no samples"):
        _ = stop((1.0, 0.0), 1.0, jacobian=True).spread(SMALL).ratio
