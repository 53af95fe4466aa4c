"""Angles of two marks, and what a track must be."""

from __future__ import annotations

import numpy as np
import pytest

from puck_tables import InputError
from puck_tables.film.film import Track
from puck_tables.film.to_tracks import direction


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
