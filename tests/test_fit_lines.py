"""Tracks along a line: what was not measured across it sets no noise, and tells no spin."""

from __future__ import annotations

import math

import film_judge
import numpy as np
import pytest
from film_judge import G
from rarely import few

import puck_tables as pt

RADIUS = 0.04


def slide(rng: np.random.Generator, friction: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Times, and the way of a puck that does not spin, to the end or nearly."""
    speed = rng.uniform(0.5, 2.5)
    end = speed / (friction * G)
    times = np.linspace(0.0, rng.uniform(0.7, 1.3) * end, count)
    moving = np.minimum(times, end)
    return times, speed * moving - 0.5 * friction * G * moving**2


def drawn(seed: int) -> tuple[pt.Track, float, float]:
    """A track along a line, its friction and the noise along it."""
    rng = np.random.default_rng([35, 9, seed])
    friction, noise = rng.uniform(0.05, 0.9), 10.0 ** rng.uniform(-4.0, -3.0)
    times, way = slide(rng, friction, int(rng.integers(30, 150)))
    seen = way + noise * rng.normal(size=way.size)
    angle = [0.0, 0.5 * math.pi, rng.uniform(0.0, 6.28), 0.0][seed % 4]
    if seed % 4 < 2:  # exactly along an axis, as of a column that nobody measured
        place = np.full((way.size, 2), 0.0 if seed % 8 < 4 else 0.37)
        place[:, seed % 4] = seen
    else:
        place = np.outer(seen, [math.cos(angle), math.sin(angle)]) + rng.uniform(-1.0, 1.0, 2)
    if seed % 4 == 3:  # rounded to less than the noise
        place[:, 1] = 0.2 + 0.3 * noise * rng.integers(-1, 2, way.size)
    return pt.Track(times, place, name="line"), friction, noise


@pytest.mark.parametrize("seed", few(8, range(24)))
def test_a_track_along_a_line_tells_the_friction_of_a_slide(seed):
    track, friction, noise = drawn(seed)
    found = pt.fit(track, pt.Puck(radius=RADIUS))
    number = found["friction"]
    assert number.determined and abs(number.value - friction) < 4.0 * number.error
    assert found.noise[0] == pytest.approx(noise, rel=0.5)
    assert "without spin" in found.remarks[0] and not found["delta"].determined
    assert found.launch().spin == 0.0 and found.outliers < 0.1
    assert found.degrees == pytest.approx(track.time.size - 3, abs=4)


@pytest.mark.thorough
def test_errors_of_tracks_along_a_line_are_right():
    pulls = []
    for seed in range(60):
        track, friction, _ = drawn(100 + seed)
        number = pt.fit(track, pt.Puck(radius=RADIUS))["friction"]
        pulls.append((number.value - friction) / number.error)
    assert 0.75 < np.sqrt(np.mean(np.square(pulls))) < 1.25  # of 60: 0.82 to 1.18 at 95 %


@pytest.mark.parametrize("seed", few(2, range(8)))
def test_angles_on_a_line_tell_the_spin(seed):
    rng = np.random.default_rng([35, 90, seed])
    times = np.arange(160) / 120.0
    friction, spin = rng.uniform(0.1, 0.3), rng.uniform(10.0, 60.0) * rng.choice([-1.0, 1.0])
    true = film_judge.path((1.6, 0.0), spin, friction * G, 0.0, RADIUS, times)
    place, angle = film_judge.noisy(rng, true, (3e-4, 5e-3))
    place[:, 1] = 0.0
    found = pt.fit(pt.Track(times, place, angle), pt.Puck(radius=RADIUS), fixed={"delta": 0.0})
    assert abs(found["friction"].value - friction) < 4.0 * found["friction"].error
    launch = found.launch().numbers["launch_spin"]
    assert launch.determined and abs(launch.value - spin) < 4.0 * launch.error


def test_of_a_tall_puck_that_spins_a_y_is_missed():
    times = np.arange(80) / 60.0
    true = film_judge.path((1.4, 0.5), 40.0, 0.18 * G, 0.24, RADIUS, times)
    place, angle = film_judge.noisy(np.random.default_rng(35), true, (3e-4, 1e-2))
    place[:, 1] = 0.0
    found = pt.fit(pt.Track(times, place, angle, name="film"), pt.Puck(radius=RADIUS))
    assert found.misfit.endswith("are both x and y in the file?")


def test_a_spin_that_is_told_is_looked_for():
    track, friction, _ = drawn(4)
    bounds = {"launch_spin": (-100.0, 100.0)}
    found = pt.fit(track, pt.Puck(radius=RADIUS), bounds=bounds)
    number = found["friction"]
    assert not any("without spin" in text for text in found.remarks)
    assert not number.determined or abs(number.value - friction) < 4.0 * number.error
    held = pt.fit(track, pt.Puck(radius=RADIUS), fixed={"launch_spin": 0.0})
    assert held["friction"].value == pytest.approx(friction, abs=4.0 * held["friction"].error)
