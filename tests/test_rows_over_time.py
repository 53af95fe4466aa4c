"""Rows over time from a function: how close they are, and what moves by them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from boards import puck_at
from scipy.optimize import brentq

import puck_tables as pt
from puck_tables import InputError


def swing(t: float) -> tuple[float, float, float]:
    return -0.3 + 0.2 * math.sin(3.0 * t), 0.05 * math.cos(7.0 * t), 0.5 * t


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_rows_keep_the_accuracy_between_them(accuracy: float) -> None:
    rows = np.array(pt.rows_over_time(swing, 1.5, accuracy))
    times = np.random.default_rng(3).uniform(0.0, 1.5, 4000)
    truth = np.array([swing(t) for t in times])
    lines = np.stack([np.interp(times, rows[:, 0], rows[:, c]) for c in (1, 2, 3)], axis=1)
    assert np.abs(lines - truth).max() < 1.05 * accuracy
    assert len(rows) < 12.0 / math.sqrt(accuracy)
    assert rows[0, 0] == 0.0 and rows[-1, 0] == 1.5


def test_a_mallet_by_a_function_hits_as_one_by_rows() -> None:
    """A heavy elastic body at speed u sends a puck at rest off at 2 u."""

    def body(path: pt.Puck) -> pt.Scene:
        return pt.Scene(pucks=[pt.Puck(0.05, name="mallet", path=path), puck_at(0.0, 0.0)])

    run = body(pt.rows_over_time(lambda t: (-0.5 + 0.8 * t, 0.0), 0.6)).simulate()
    plain = body(((0.0, -0.5, 0.0), (0.6, -0.02, 0.0))).simulate()
    first, truth = run.events[0], plain.events[0]
    assert first.time == pytest.approx(0.42 / 0.8, rel=1e-12) and first.what == "impact"
    assert first.approach == pytest.approx(0.8, rel=1e-9)
    assert truth.time == pytest.approx(first.time, rel=1e-12)
    assert run.last["x"][1] == pytest.approx(plain.last["x"][1], abs=1e-9)


def test_a_tray_by_a_function_drags_its_puck_as_the_function_itself() -> None:
    """It slips once the tray asks for more than friction, and sticks again; by its closed path."""
    turn, far, grip = 2.0 * math.pi, 0.1, 0.2 * 9.80665

    def speed(t: float) -> float:
        return far * turn * math.cos(turn * t)

    slip = math.asin(grip / (far * turn * turn)) / turn  # the tray slows down by more than that
    stick = brentq(lambda t: speed(slip) - grip * (t - slip) - speed(t), slip + 0.05, 0.7)
    assert far * turn * turn * abs(math.sin(turn * stick)) > grip  # so that it slips on, forward
    again = brentq(lambda t: speed(stick) + grip * (t - stick) - speed(t), stick + 0.05, 1.4)
    place = far * math.sin(turn * slip)
    for time, until, accel in ((slip, stick, -grip), (stick, again, grip)):
        place += speed(time) * (until - time) + 0.5 * accel * (until - time) ** 2
    for accuracy, close in ((1e-3, 1e-3), (1e-5, 1e-5)):
        floor = pt.Floor(over_time=pt.rows_over_time(lambda t: (speed(t), 0.0), 2.0, accuracy))
        launch = pt.Launch((speed(0.0), 0.0))
        run = pt.Scene(pt.Puck(0.05, friction=0.2), floor, launch, time=again).simulate()
        assert run.events[0].what == "slip"
        assert run.last["x"] == pytest.approx(place, abs=close)


def test_a_factor_and_a_force_by_a_function() -> None:
    """∫ of a force alone, and friction that falls as the rows of it say."""
    push = pt.Force(over_time=pt.rows_over_time(lambda t: (math.sin(t), 0.0), 2.0, 1e-7))
    run = pt.Scene(pt.Puck(0.05, friction=0.0, mass=2.0), force=push, time=2.0).simulate()
    assert run.last["vx"] == pytest.approx(0.5 * (1.0 - math.cos(2.0)), abs=2e-7)
    grip = pt.Grip(pt.rows_over_time(lambda t: math.exp(-t), 2.0, 1e-7))
    scene = pt.Scene(
        pt.Puck(0.05, friction=0.1), pt.Floor(grips=[grip]), pt.Launch((5.0, 0.0)), time=1.0
    )
    slowed = 5.0 - 0.1 * 9.80665 * (1.0 - math.exp(-1.0))
    assert scene.simulate().last["vx"] == pytest.approx(slowed, abs=2e-7)


@pytest.mark.parametrize(
    ("function", "until", "words"),
    [
        (lambda t: (0.0 if t < 0.3 else 1.0, 0.0), 1.0, "the function jumps by 1 at 0.3 s"),
        (lambda t: (math.sin(1e7 * t), 0.0), 1.0, "100000 rows do not resolve the function"),
        (lambda t: (t, math.nan), 1.0, "at 0 s it gives"),
        (lambda t: (t, 0.0) if t < 0.5 else (t, 0.0, 0.0), 1.0, "2 numbers at 0 s and 3"),
        (lambda t: "here", 1.0, "must give one, two or three finite numbers"),
        (lambda t: (t, 0.0), 0.0, "until must be greater"),
        (((0.0, 0.0, 0.0),), 1.0, "must be one of time, got a tuple"),
    ],
)
def test_what_is_no_function_of_time_is_refused(function: object, until: float, words: str) -> None:
    with pytest.raises(InputError) as refused:
        pt.rows_over_time(function, until)
    assert words in str(refused.value)
