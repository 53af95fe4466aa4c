"""Films whose time stamps jitter, or whose pictures are read line by line."""

from __future__ import annotations

import film_judge
import numpy as np
import pytest
from test_fit import DECEL, DELTA, KNOWN, NOISE, RADIUS, SPIN, TIMES, VELOCITY

import puck_tables as pt

JITTER, READOUT, ROWS = 0.4e-3, 7e-3, (1.0, -0.2)


def seen_at(times: np.ndarray, seed: int) -> pt.Track:
    true = film_judge.path(VELOCITY, SPIN, DECEL, DELTA, RADIUS, np.maximum(times, 0.0))
    return pt.Track(TIMES, *film_judge.noisy(np.random.default_rng(seed), true, NOISE))


def jittery(seed: int) -> pt.Track:
    noise = np.random.default_rng(1000 + seed).normal(size=TIMES.size)
    return seen_at(TIMES + JITTER * noise, seed)


def bound() -> np.ndarray:
    """Cramér–Rao of J and δ under C = diag(σ²) + σ_t² u uᵀ, by differences of the judge's films."""
    truth = np.array([*VELOCITY, SPIN, DECEL, DELTA, 0.0, 0.0, 0.0])
    rows = []
    for k in range(8):
        step, ends = 1e-3 * max(abs(truth[k]), 0.1), []
        for side in (1.0, -1.0):
            vx, vy, w, j, d, *place = (truth + side * step * (np.arange(8) == k)).tolist()
            path = film_judge.path((vx, vy), w, j, d, RADIUS, TIMES)
            ends.append(path + np.array(place)[:, None])
        rows.append((ends[0] - ends[1]) / (2.0 * step))
    true = film_judge.path(VELOCITY, SPIN, DECEL, DELTA, RADIUS, TIMES)
    rates = np.gradient(true, TIMES, axis=1)
    fisher = np.zeros((8, 8))
    for n in range(TIMES.size):
        slopes, u = np.array([row[:, n] for row in rows]), rates[:, n]
        noise = np.diag(np.square([NOISE[0], NOISE[0], NOISE[1]])) + JITTER**2 * np.outer(u, u)
        fisher += slopes @ np.linalg.inv(noise) @ slopes.T
    return np.sqrt(np.diag(np.linalg.inv(fisher)))[3:5]


def pulls(seeds: range) -> np.ndarray:
    out = []
    for seed in seeds:
        found = pt.fit(jittery(seed), KNOWN, free=["decel", "delta"], jitter="find")
        out.append([found["decel"].value - DECEL, found["delta"].value - DELTA])
    return np.array(out) / bound()


@pytest.mark.thorough
def test_jitter_is_found_and_errors_are_the_bound():
    found = pt.fit(jittery(1), KNOWN, free=["decel", "delta"], jitter="find")
    assert found.jitter == pytest.approx(JITTER, rel=0.2)
    assert found.noise == pytest.approx(NOISE, rel=0.2)
    given = pt.fit(jittery(1), KNOWN, free=["decel", "delta"], noise=NOISE, jitter=JITTER)
    errors = np.array([given["decel"].error, given["delta"].error])
    assert errors == pytest.approx(bound(), rel=0.02)
    assert np.all(np.abs(pulls(range(4))) < 4.0)
    blind = pt.fit(jittery(1), KNOWN)
    assert any("jitter" in text for text in blind.remarks)
    assert not any("jitter" in text for text in found.remarks)


@pytest.mark.nightly
def test_errors_under_jitter_are_the_bound_over_200_films():
    assert np.all(np.sqrt((pulls(range(100, 300)) ** 2).mean(axis=0)) < 1.15)


def test_an_angle_of_a_frame_whose_place_is_wrong_still_counts():
    track = jittery(2)
    place = track.place.copy()
    place[20:200:10] += 0.05
    found = pt.fit(pt.Track(TIMES, place, track.angle), KNOWN, jitter="find")
    assert found["delta"].value == pytest.approx(DELTA, abs=4.0 * found["delta"].error)
    assert 0.03 < found.outliers < 0.09


def rolled(
    velocity: tuple[float, float], spin: float, rows: tuple[float, float] = ROWS
) -> np.ndarray:
    """When the frames see the puck: farther down later."""
    times = TIMES
    for _ in range(30):
        y = film_judge.path(velocity, spin, DECEL, DELTA, RADIUS, np.maximum(times, 0.0))[1]
        times = TIMES + READOUT * (rows[0] - y) / (rows[0] - rows[1])
    return times


@pytest.mark.thorough
def test_what_a_track_without_angles_tells_under_a_rolling_shutter():
    inside, rows = [], (2.0, -2.0)
    for seed in range(8):
        way = 0.25 * np.pi * seed
        velocity = 1.9 * np.cos(way), 1.9 * np.sin(way)
        times = rolled(velocity, 70.0, rows)
        true = film_judge.path(velocity, 70.0, DECEL, DELTA, RADIUS, times)
        place = film_judge.noisy(np.random.default_rng(seed), true, NOISE)[0]
        found = pt.fit(pt.Track(TIMES, place), KNOWN, rows=rows)
        inside.append([found["decel"].low < DECEL < found["decel"].high,
                       found["delta"].low < DELTA < found["delta"].high])  # fmt: skip
        assert 0.0 < found["readout"].value < TIMES[1]
        assert abs(found["decel"].value - DECEL) < 4.0 * found["decel"].error
        assert found.blind[0].startswith("readout is not determined")
    assert np.all(np.sum(inside, axis=0) >= 7)  # fewer of eight at 95 %: p = 0.06 each


@pytest.mark.thorough
def test_what_the_tracks_do_not_tell_may_be_bounded():
    for seed in range(4):  # starts whose readout meets its bound still arrive
        true = film_judge.path((1.5, 0.4), 40.0, DECEL, DELTA, RADIUS, TIMES[:200])
        place = film_judge.noisy(np.random.default_rng(seed), true, NOISE)[0]
        track = pt.Track(TIMES[:200], place)
        found = pt.fit(track, KNOWN, rows=(1.0, 0.0), bounds={"readout": (-0.01, 0.01)})
        assert found.complaints == ()
        assert found["decel"].low < DECEL < found["decel"].high
        assert abs(found["decel"].value - DECEL) < 4.0 * found["decel"].error


@pytest.mark.thorough
def test_a_rolling_shutter_is_found():
    times = rolled(VELOCITY, SPIN)
    found = pt.fit(seen_at(times, 1), KNOWN, rows=ROWS)
    assert abs(found["readout"].value - READOUT) < 4.0 * found["readout"].error
    assert found["readout"].error < 1e-3 and found.complaints == ()
    assert abs(found["friction"].value - 0.15) < 4.0 * found["friction"].error
    assert "prior of 4.17 +- 4.17 ms" in found.explain()
    known = pt.fit(seen_at(times, 1), KNOWN, rows=ROWS, fixed={"readout": READOUT})
    assert known["friction"].error < found["friction"].error
    blind = pt.fit(seen_at(times, 1), KNOWN)
    assert any("pattern" in text for text in blind.complaints)
    assert any("too small" in text for text in blind.complaints)
