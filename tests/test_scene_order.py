"""The steps of a scene are of order 8, also where a slip stops, and keep what they promise."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate._ivp import dop853_coefficients as published

from puck_tables import Drag, Floor, Launch, Puck, Scene
from puck_tables.motion.steppers import DORMAND_PRINCE_8
from puck_tables.scene import steps

COARSE, FINE = 1e-5, 1e-11
EIGHTH, FIFTH = (COARSE / FINE) ** (1 / 8), (COARSE / FINE) ** (1 / 5)


def braked(tol: float) -> Scene:
    """Pulled down a slope without friction against a drag by the square of the speed."""
    return Scene(
        Puck(0.04, friction=0.0, mass=0.2), floor=Floor(slope=0.5, downhill=0.0),
        drag=Drag(quadratic=0.1), time=4.0, tol=tol,
    )  # fmt: skip


def speed_at(t: float) -> tuple[float, float]:
    """Speed and place of it: v′ = a − k v² from rest."""
    pull, drag = 9.80665 * math.sin(0.5), 0.1 / 0.2
    most, rate = math.sqrt(pull / drag), math.sqrt(pull * drag)
    return most * math.tanh(rate * t), math.log(math.cosh(rate * t)) / drag


def stopping(tol: float) -> Scene:
    """One that slides and spins till it stops on a slope."""
    return Scene(
        Puck(0.04, 0.02, friction=0.15, mass=0.2), floor=Floor(slope=0.1),
        launch=Launch((0.8, 0.5), spin=10.0), drag=Drag(sliding=0.02), tol=tol,
    )  # fmt: skip


def test_the_numbers_are_those_that_are_published() -> None:
    stages = steps.STAGES
    assert np.array_equal(steps._A[:, :stages], published.A[:stages, :stages])
    assert np.array_equal(steps._ERROR_5, published.E5)
    assert np.array_equal(steps._ERROR_3, published.E3)
    assert np.allclose(steps._C[:-1], published.C[: stages - 1], rtol=1e-14, atol=0.0)


def test_they_are_of_order_8_and_their_estimate_of_no_less_than_3() -> None:
    """Trees without branches: weights times powers of the nodes are 1/(k + 1)."""
    a, c, b = steps._A, steps._C, DORMAND_PRINCE_8.b
    for k in range(8):
        assert b @ c**k == pytest.approx(1.0 / (k + 1), rel=1e-13)
    tall = np.ones(steps.STAGES)
    for k in range(1, 9):  # the tall trees: b A^(k−1) 1 = 1/k!
        assert b @ tall == pytest.approx(1.0 / math.factorial(k), rel=1e-12)
        tall = a @ tall
    assert abs(b @ tall - 1.0 / math.factorial(9)) > 1e-8
    for error, order in ((steps._ERROR_5, 5), (steps._ERROR_3, 3)):
        for k in range(order):
            assert abs(error @ c**k) < 1e-13
        assert abs(error @ c**order) > 1e-6


@pytest.mark.parametrize("tol", [1e-4, 1e-7, 1e-10])
def test_a_drag_by_the_square_of_the_speed_has_its_closed_form(tol: float) -> None:
    run = braked(tol).simulate([])
    speed, place = speed_at(4.0)
    assert abs(run.last["x"] - place) <= tol * run.speed_scale**2 / run.rate_scale
    assert abs(run.last["vx"] - speed) <= tol * run.speed_scale
    assert run.error_estimate <= tol


@pytest.mark.parametrize("scene", [braked, stopping])
def test_finer_runs_take_as_many_more_steps_as_order_8_asks(scene: object) -> None:
    coarse, fine = (scene(tol).simulate([]).steps for tol in (COARSE, FINE))  # type: ignore[operator]
    assert fine / coarse < math.sqrt(EIGHTH * FIFTH)


def test_a_slip_stops_within_a_few_steps() -> None:
    """The last millionth of the time takes no step for each halving of what is left."""
    whole = stopping(1e-9).simulate([])
    cut = stopping(1e-9)
    before = Scene(
        cut.puck, floor=cut.floor, launch=cut.launch, drag=cut.drag,
        time=whole.end_time * (1.0 - 1e-3), tol=1e-9,
    ).simulate([])  # fmt: skip
    assert whole.steps - before.steps < 12  # by halves it would be 25
