"""A body driven by a function of time: its rows, and what they hit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from boards import puck_at

import puck_tables as pt
from puck_tables import InputError


def swing(t: float) -> tuple[float, float, float]:
    return -0.3 + 0.2 * math.sin(3.0 * t), 0.05 * math.cos(7.0 * t), 0.5 * t


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_rows_keep_the_accuracy_between_them(accuracy: float) -> None:
    rows = np.array(pt.path_along(swing, 1.5, accuracy))
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

    run = body(pt.path_along(lambda t: (-0.5 + 0.8 * t, 0.0), 0.6)).simulate()
    plain = body(((0.0, -0.5, 0.0), (0.6, -0.02, 0.0))).simulate()
    first, truth = run.events[0], plain.events[0]
    assert first.time == pytest.approx(0.42 / 0.8, rel=1e-12) and first.what == "impact"
    assert first.approach == pytest.approx(0.8, rel=1e-9)
    assert truth.time == pytest.approx(first.time, rel=1e-12)
    assert run.last["x"][1] == pytest.approx(plain.last["x"][1], abs=1e-9)


@pytest.mark.parametrize(
    ("place", "until", "words"),
    [
        (lambda t: (0.0 if t < 0.3 else 1.0, 0.0), 1.0, "path jumps by 1 at 0.3 s"),
        (lambda t: (math.sin(1e7 * t), 0.0), 1.0, "100000 rows do not resolve it"),
        (lambda t: (t, math.nan), 1.0, "at 0 s it gives"),
        (lambda t: (t, 0.0) if t < 0.5 else (t, 0.0, 0.0), 1.0, "2 numbers at 0 s and 3"),
        (lambda t: "here", 1.0, "must give x, y"),
        (lambda t: (t, 0.0), 0.0, "until must be greater"),
        (((0.0, 0.0, 0.0),), 1.0, "must be a function of time, got a tuple"),
    ],
)
def test_what_cannot_be_driven_is_refused(place: object, until: float, words: str) -> None:
    with pytest.raises(InputError) as refused:
        pt.path_along(place, until)
    assert words in str(refused.value)
