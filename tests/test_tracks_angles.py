"""Angles from frame to frame, also where a puck turns more than half a turn between two."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from puck_tables import InputError
from puck_tables.film.angles import direction, unwrap
from puck_tables.film.puck_track import Track


def wrapped(angle: np.ndarray) -> np.ndarray:
    return np.angle(np.exp(1j * angle))


def test_without_a_spin_it_is_the_usual_one():
    time = np.linspace(0.0, 2.0, 200)
    angle = 0.3 + 40.0 * np.sin(time)
    assert_allclose(unwrap(wrapped(angle), time), angle, atol=1e-9)


def test_less_than_two_frames_a_turn_with_a_spin_that_is_roughly_known():
    rng = np.random.default_rng(9)
    time = np.sort(rng.uniform(0.0, 2.0, 60))  # 30 frames a second, uneven
    true_spin = 260.0 - 100.0 * time  # up to 1.4 turns a frame on average
    angle = 260.0 * time - 50.0 * time**2 + 1.0
    angle -= np.round(angle[0] / (2 * np.pi)) * 2 * np.pi
    known = true_spin + 3.0
    assert np.abs(np.diff(angle)).max() > 2 * np.pi
    assert_allclose(unwrap(wrapped(angle), time, known), angle, atol=1e-9)
    assert np.abs(unwrap(wrapped(angle), time) - angle).max() > 6.0


def test_frames_without_an_angle_are_passed_over():
    time = np.arange(8) * 0.1
    angle = 25.0 * time
    seen = wrapped(angle)
    seen[[0, 3, 4, 7]] = np.nan
    found = unwrap(seen, time, 24.0)
    assert np.isnan(found[[0, 3, 4, 7]]).all()
    assert_allclose(found[[1, 2, 5, 6]], angle[[1, 2, 5, 6]])
    assert np.isnan(unwrap(np.full(3, np.nan), [0.0, 1.0, 2.0])).all()
    assert unwrap([], []).size == 0


def test_what_does_not_fit_is_refused():
    for arguments in (([0.0], [0.0, 1.0]), ([0.0], [0.0], [1.0, 2.0]), ([0.0], [np.nan])):
        with pytest.raises(InputError):
            unwrap(*arguments)


def test_two_marks_at_one_place_have_no_direction():
    found = direction(np.zeros((2, 2)), np.array([[0.0, 0.0], [-1.0, 0.0]]))
    assert np.isnan(found[0])
    assert found[1] == np.pi


@pytest.mark.parametrize(
    ("time", "place", "angle", "words"),
    [
        ([0.0, 1.0], [[0, 0]], None, "must be"), ([0.0, 0.0], [[0, 0]] * 2, None, "must increase"),
        ([0.0, np.nan], [[0, 0]] * 2, None, "finite"), ([0.0, 1.0], [[0, 0]] * 2, [1.0], "angle"),
        ([0.0, 1.0], [[0, np.nan], [0, 0]], None, "two frames"),
        ([], np.empty((0, 2)), None, "two frames"),
        ([0.0, 1.0], [[0, np.inf], [0, 0]], None, "is infinite"),
        ([0.0, 1.0], [[0, 0]] * 2, [0.0, np.inf], "is infinite"), (["a"], [[0, 0]], None, "time"),
    ],
)  # fmt: skip
def test_a_track_is_checked_when_it_is_made(time, place, angle, words: str):
    with pytest.raises(InputError, match=words):
        Track(time, place, angle)
