"""Stops and states of pucks by friction and height: values and derivatives against integrations."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from puck_tables import Puck, state_arrays, states, stop, stop_arrays
from puck_tables.errors import InputError

NUMBERS = {"radius": 0.04, "friction": 0.22, "height": 0.05, "gravity": 9.7}
VELOCITY, SPIN, TIME = (1.0, 0.4), 9.0, 0.2
STEP = 1e-4  # of each number: differences err by its square, and by 1e-12 over it
BOTH = "friction, height, gravity stand in place of delta and decel: give the ones or the others"
ALONE = "height and gravity need a friction: give it, or delta and decel alone"


def integrated(numbers: dict[str, float]) -> np.ndarray:
    """Stop time and place, state at a moment, of a run of a puck."""
    run = Puck(**numbers).simulate(VELOCITY, SPIN, times=[TIME], tol=1e-13)
    state = (run.x[0], run.y[0], run.orientation[0], run.vx[0], run.vy[0], run.spin[0])
    return np.array([run.stop_time, *run.stop_position, *state])


def test_derivatives_are_those_of_runs():
    found = stop(VELOCITY, SPIN, **NUMBERS, jacobian=True)
    moved = states(VELOCITY, SPIN, TIME, **NUMBERS, jacobian=True)
    columns = ["vx", "vy", "spin", "friction", "height", "radius"]
    assert list(found.JACOBIAN_COLUMNS) == columns
    assert list(moved.JACOBIAN_COLUMNS) == [*columns, "time"]
    for name in ("friction", "height", "radius"):
        less, more = (
            integrated({**NUMBERS, name: NUMBERS[name] * (1.0 + sign * STEP)})
            for sign in (-1.0, 1.0)
        )
        truth = (more - less) / (2.0 * STEP * NUMBERS[name])
        mine = [found.derivative(of, name) for of in ("stop_time", "stop_x", "stop_y")]
        mine += [moved.derivative(of, name) for of in moved.JACOBIAN_ROWS]
        np.testing.assert_allclose(mine, truth, rtol=2e-6, atol=1e-6)


def test_pucks_broadcast_and_are_those_of_one_by_one():
    """Also tall ones, which are integrated, and by time after the stop."""
    friction, height = np.array([[0.1], [0.5]]), np.array([0.0, 0.03, 0.11])
    kind: dict[str, Any] = {"radius": 0.04, "jacobian": True}
    found = stop(VELOCITY, SPIN, friction=friction, height=height, **kind)
    moved = states(VELOCITY, SPIN, TIME, friction=friction, height=height, **kind)
    assert found.jacobian.shape == (2, 3, 5, 6)
    for n, f in enumerate(friction[:, 0].tolist()):
        for m, h in enumerate(height.tolist()):
            own = Puck(0.04, height=h, friction=f)
            one = own.stop(VELOCITY, SPIN, jacobian=True)
            assert one.stop_time == found.stop_time[n, m]
            assert own.states(VELOCITY, SPIN, TIME).x == moved.x[n, m]
            by = {name: one.derivative("stop_x", name) for name in ("delta", "decel", "radius")}
            mine = [found.derivative("stop_x", name)[n, m]
                    for name in ("friction", "height", "radius")]  # fmt: skip
            np.testing.assert_allclose(mine, [
                2.0 * h / 0.04 * by["delta"] + 9.80665 * by["decel"],
                2.0 * f / 0.04 * by["delta"],
                by["radius"] - 2.0 * f * h / 0.04**2 * by["delta"],
            ], rtol=1e-12)  # fmt: skip
            alone = states(VELOCITY, SPIN, TIME, friction=f, height=h, **kind)
            np.testing.assert_allclose(alone.jacobian, moved.jacobian[n, m], rtol=1e-9, atol=1e-12)


def test_errors_of_friction_scatter_stops():
    found = stop(VELOCITY, SPIN, **NUMBERS, jacobian=True)
    out = found.spread(np.diag([0.002, 0.001]) ** 2, of=("friction", "height"), samples=4000)
    assert out.is_linear
    moved = states(VELOCITY, SPIN, TIME, **NUMBERS, jacobian=True)
    assert moved.spread([[4e-6]], of=("friction",), samples=4000).is_linear
    with pytest.raises(InputError, match="samples of friction reach"):
        found.spread([[0.04]], of=("friction",), samples=4000)


def test_functions_of_arrays_take_them():
    friction = np.array([0.1, 0.2])
    got = stop_arrays(1.0, 0.4, SPIN, friction=friction, height=0.02, radius=0.05)
    truth = stop(VELOCITY, SPIN, friction=friction, height=0.02, radius=0.05)
    np.testing.assert_allclose(got[0], truth.stop_time, rtol=1e-7)
    x = state_arrays(1.0, 0.4, SPIN, TIME, friction=friction, height=0.02, radius=0.05)[0]
    there = states(VELOCITY, SPIN, TIME, friction=friction, height=0.02, radius=0.05).x
    np.testing.assert_array_equal(x, there)


@pytest.mark.parametrize(("given", "words"), [
    ({"friction": 0.2, "delta": 0.5}, BOTH),
    ({"friction": 0.2, "decel": [1.0, 2.0]}, BOTH),
    ({"height": 0.1}, ALONE),
    ({"gravity": 9.8, "delta": 0.5}, ALONE),
    ({"friction": 0.0}, "friction must be greater than 0, got 0"),
    ({"friction": 0.2, "height": -1.0}, "height must not be negative, in m, got -1"),
    ({"friction": 0.2, "gravity": 0.0}, "gravity must be"),
    ({"friction": [0.2, 0.3], "height": [0.1, 0.1, 0.1]}, "friction"),
    ({"friction": 0.2, "radius": 0.0}, "radius must be greater than 0 m"),
])  # fmt: skip
def test_what_clashes_is_refused(given: dict[str, Any], words: str):
    for call in (
        lambda: stop(VELOCITY, SPIN, **given),
        lambda: states(VELOCITY, SPIN, 1.0, **given),
    ):
        with pytest.raises(InputError, match=re.escape(words)):
            call()
