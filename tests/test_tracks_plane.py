"""A tilted camera: places and angles on the floor from four marks, against a pinhole camera."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from puck_tables import InputError, read_tracks
from puck_tables.film.plane import plane_of

FLOOR = [(0.0, 0.0), (1.2, 0.1), (1.1, 0.9), (-0.1, 0.8)]
RIG = [(0.3, -1.0, 1.5), (-2.0, 0.5, 0.6), (0.5, 0.5, 3.0)]  # places of the camera in m


def seen_from(camera: tuple[float, float, float], points: np.ndarray) -> np.ndarray:
    """Pixels (v down) of floor points, by a pinhole that looks at (0.5, 0.4, 0)."""
    eye = np.array(camera)
    ahead = np.array([0.5, 0.4, 0.0]) - eye
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 1.0, 0.1])
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    rays = np.column_stack([points, np.zeros(len(points))]) - eye
    depth = rays @ ahead
    return np.column_stack(
        [960 + 1400 * (rays @ right) / depth, 540 + 1400 * (rays @ down) / depth]
    )


def marks_of(camera: tuple[float, float, float], floor: list[tuple[float, float]]) -> np.ndarray:
    return np.hstack([seen_from(camera, np.array(floor)), np.array(floor)])


@pytest.mark.parametrize("camera", RIG)
def test_places_come_back_through_a_pinhole(camera):
    places = np.random.default_rng(7).uniform([-0.2, -0.2], [1.4, 1.1], (50, 2))
    for floor in (FLOOR, [*FLOOR, (0.4, 0.5), (0.7, 0.2)]):
        plane = plane_of(marks_of(camera, floor))
        assert_allclose(plane.place(seen_from(camera, places)), places, rtol=0, atol=1e-11)
        assert plane.residual < 1e-12


@pytest.mark.parametrize("camera", RIG)
def test_directions_come_back_through_a_pinhole(camera):
    rng = np.random.default_rng(8)
    places, angles = rng.uniform(0.1, 0.9, (30, 2)), rng.uniform(-3.1, 3.1, 30)
    ahead = places + 1e-6 * np.column_stack([np.cos(angles), np.sin(angles)])
    pixels, shift = seen_from(camera, places), seen_from(camera, ahead)
    apart = shift - pixels
    found = plane_of(marks_of(camera, FLOOR)).angle(pixels, np.arctan2(apart[:, 1], apart[:, 0]))
    assert_allclose(found, angles, rtol=0, atol=1e-5)


def test_marks_that_do_not_fit_leave_a_residual():
    marks = marks_of(RIG[0], [*FLOOR, (0.4, 0.5), (0.7, 0.2)])
    marks[4, 2] += 0.01
    assert 0.001 < plane_of(marks).residual < 0.01


def test_a_film_of_a_tilted_camera(tmp_path: Path):
    places = np.column_stack([np.linspace(0.1, 1.0, 10), np.linspace(0.7, 0.2, 10)])
    angles = np.linspace(0.0, 5.0, 10)
    rim = places + 0.03 * np.column_stack([np.cos(angles), np.sin(angles)])
    hub_px, rim_px = seen_from(RIG[0], places), seen_from(RIG[0], rim)
    rows = ["frame,hub_x,hub_y,rim_x,rim_y"]
    rows += [f"{n},{a!r},{b!r},{c!r},{d!r}" for n, (a, b, c, d) in enumerate(
        np.hstack([hub_px, rim_px]).tolist()
    )]  # fmt: skip
    film, marks = tmp_path / "film.csv", tmp_path / "marks.csv"
    film.write_text("\n".join(rows))
    given = marks_of(RIG[0], FLOOR) * [1, 1, 100, 100]
    marks.write_text("u;v;x [cm];y [cm]\n" + "\n".join(
        ";".join(map(repr, row)).replace(".", ",") for row in given.tolist()
    ))  # fmt: skip
    for how in (marks, str(marks), marks_of(RIG[0], FLOOR).tolist()):
        (track,) = read_tracks(film, fps=10, marks=how, centre="hub", toward="rim")
        assert_allclose(track.place, places, rtol=0, atol=1e-9)
        assert_allclose(np.unwrap(track.angle), angles, rtol=0, atol=1e-8)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([(0, 0, 0, 0), (1, 1, 1, 0), (2, 2, 1, 1), (3, 3, 0, 1)], "on a line in the picture"),
        ([(0, 0, 0, 0), (1, 0, 1, 0), (1, 1, 2, 0), (0, 1, 0, 1)], "on a line on the floor"),
        ([(0, 0, 0, 0), (1, 0, 1, 0), (1, 1, 1, 1)], "four rows"), ([(1, 2), (3, 4)], "four rows"),
        ([(0, 0, 0, 0), (1, 0, 1, 0), (1, 1, 0, 1), (0, 1, 1, 1)], "horizon"),
        ([(0, 0, 0, 0)] * 4, "on a line"), ([(0, 0, 0, math.nan)] * 4, "finite"),
    ],
)  # fmt: skip
def test_marks_that_fix_no_plane_are_refused(rows: list, words: str):
    with pytest.raises(InputError, match=words):
        plane_of(rows)


def test_pixels_beyond_the_horizon_are_refused():
    plane = plane_of([(0, 0, 0, 0), (100, 0, 1, 0), (80, 60, 1, 1), (20, 60, 0, 1)])
    with pytest.raises(InputError, match="horizon"):
        plane.place(np.array([[50.0, 60.0], [50.0, 1e4]]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("u,v,x,y\n0,0,0,0\n1,0,1,0\n1,1,1,1\n0,1,0,1\n", "with the unit of the places"),
        ("0,0,0,0\n1,0,1,0\n1,1,1,1\n0,1,0,1\n", "with the unit of the places"),
        ("u,v,x [m]\n0,0,0\n1,0,1\n", "it has 3"), ("", "first line|no lines|no rows"),
        ("u,v,x [m],y [m]\n0,0,0,\n1,0,1,0\n1,1,1,1\n0,1,0,1\n", "none of them left empty"),
    ],
)  # fmt: skip
def test_files_of_marks_that_lack_something(tmp_path: Path, text: str, words: str):
    marks, film = tmp_path / "marks.csv", tmp_path / "film.csv"
    marks.write_text(text)
    film.write_text("t,x,y\n0,1,2\n0.1,2,3\n")
    with pytest.raises(InputError, match=words):
        read_tracks(film, marks=marks)
    for how, said in (
        ({"marks": tmp_path / "no.csv"}, "cannot read"), ({"marks": FLOOR, "y_down": True}, "axes"),
        ({"marks": FLOOR, "scale": 1}, "one of them"), ({"marks": FLOOR, "unit": "m"}, "pixels"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=said):
            read_tracks(film, **how)
