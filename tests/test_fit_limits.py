"""Whatever is asked of a fit or a forecast: numbers within limits, or a sentence."""

from __future__ import annotations

import math

import film_judge
import numpy as np
import pytest
from film_judge import G
from rarely import few

import puck_tables as pt
from puck_tables.fitting.numbers import puck_and_launch

NOISE = (0.3e-3, 5e-3)


@pytest.mark.parametrize("seed", few(3, range(16)))
def test_any_noise_may_be_given_of_any_track(seed):
    """All of it known: of a track without angles there was nothing left to look for."""
    rng = np.random.default_rng([35, 11, seed])
    times = np.arange(60) / rng.uniform(60.0, 240.0)
    puck = pt.Puck(radius=0.04, height=0.02, friction=rng.uniform(0.1, 0.3))
    path = puck.states((1.0, 0.4), rng.uniform(-40.0, 40.0), times)
    place = np.stack([path.x, path.y], axis=1) + NOISE[0] * rng.normal(size=(60, 2))
    angled = seed % 3 == 2
    angle = path.orientation + NOISE[1] * rng.normal(size=60) if angled else None
    noise = (NOISE[0], NOISE[1] if angled or seed % 2 else None)
    jitter = rng.choice([1e-4, 1e-3])
    found = pt.fit(pt.Track(times, place, angle), pt.Puck(radius=0.04), noise=noise, jitter=jitter)
    assert found.noise[0] == NOISE[0] and found.jitter == jitter
    friction = found["friction"]
    assert not friction.determined or abs(friction.value - puck.friction) < 4.5 * friction.error


@pytest.mark.parametrize("seed", few(3, range(40)))
def test_a_puck_that_is_flat_or_nearly_has_a_height_within_its_film(seed):
    """δ is bound by the film and h = δ r/2f with it, also where δ ends at 0."""
    rng = np.random.default_rng([35, 12, seed])
    height = 0.0 if seed % 2 else rng.uniform(0.0, 2e-3)
    times = np.arange(90) / 60.0
    path = pt.Puck(radius=0.0381, friction=0.1, height=height).states((2.0, 0.3), 20.0, times)
    place = np.stack([path.x, path.y], axis=1) + NOISE[0] * rng.normal(size=(90, 2))
    angle = path.orientation + 3e-3 * rng.normal(size=90)
    found = pt.fit(pt.Track(times, place, angle), pt.Puck(radius=0.0381))
    told, delta = found["height"], found["delta"]
    half = 0.0381 / (2.0 * found["friction"].value)
    assert 0.0 <= told.low < told.high and delta.high < 1.0
    assert told.high == pytest.approx(delta.high * half, rel=0.05)
    assert told.low - 1e-3 < height < told.high + 1e-3  # some 3 errors beside the interval


def test_a_forecast_of_anything_is_a_forecast_or_a_sentence():
    rng = np.random.default_rng(3511)
    puck, told, refused = pt.Puck(radius=0.04, height=0.02, friction=0.2), 0, 0
    for _ in range(60):
        wide = rng.choice([1.0, 8.0, 300.0])
        speed, spin, fps, place, angle, duration = 10.0 ** rng.uniform(-wide, wide, 6)
        try:
            camera = pt.Camera(
                fps, place, None if rng.random() < 0.3 else angle,
                None if rng.random() < 0.5 else duration,
            )  # fmt: skip
            if duration * fps > 1e3:
                continue
            forecast = pt.fisher(puck, pt.Launch((speed, 0.0), spin=spin), camera)
        except pt.InputError:
            refused += 1
            continue
        told += 1
        assert not np.isnan(forecast.errors).any()
    assert told > 3 and refused > 20


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(1, range(8)))
def test_a_law_that_the_film_does_not_tell_runs_nowhere(seed):
    """Drag slows a puck that next to no friction does; slip speeds are asked beyond those seen."""
    rng = np.random.default_rng([35, 12, seed])
    drag, friction, speed = rng.uniform(0.02, 0.1), rng.uniform(0.002, 0.02), rng.uniform(1.0, 4.0)
    times = np.arange(120) / 60.0
    # v' = -f g - c v^2
    limit = math.sqrt(friction * G / drag)
    turn = math.atan(speed / limit)
    phase = np.maximum(turn - times * math.sqrt(friction * G * drag), 0.0)
    x = np.log(np.cos(phase) / math.cos(turn)) / drag
    place = np.stack([x, 0.2 * x], axis=1) + 5e-4 * rng.normal(size=(120, 2))
    track = pt.Track(times, place, 5e-3 * rng.normal(size=120))
    try:
        found = pt.fit(
            track, pt.Puck(radius=0.03), fixed={"delta": 0.0},
            slip_speeds=[0.0, 0.3 * speed, 1.3 * speed, 2.0 * speed],
        )  # fmt: skip
    except pt.InputError:
        return
    for name, number in found.numbers.items():
        assert math.isfinite(number.value), name
        assert not name.startswith("friction_") or 0.0 < number.value <= 10.0


def far_spun(seed: int) -> pt.Track:
    """A film without angles of a puck that spins ever so fast: v = v0 (1 - t/T)^(3/4)."""
    rng = np.random.default_rng([35, 1, seed])
    times, speed = np.arange(60) / rng.uniform(60.0, 120.0), rng.uniform(0.5, 2.0)
    end, heading = rng.uniform(1.1, 3.0) * times[-1], rng.uniform(0.0, 2.0 * math.pi)
    way = speed * end / 1.75 * (1.0 - (1.0 - times / end) ** 1.75)
    place = np.outer(way, [math.cos(heading), math.sin(heading)])
    return pt.Track(times, place + 2e-4 * rng.normal(size=(60, 2)), None, "far")


@pytest.mark.parametrize("seed", few(1, [6, *range(6), *range(7, 10)]))
def test_a_fit_that_runs_away_is_no_answer(seed, tmp_path):
    """More spin and more friction look alike without end."""
    track = far_spun(seed)
    found = pt.fit(track, pt.Puck(radius=0.04))
    fastest = np.hypot(*np.diff(track.place, axis=0).T).max() / np.diff(track.time).max()
    launch = found.launch()
    assert abs(launch.spin) * 0.04 <= 101.0 * fastest
    assert math.hypot(*launch.velocity) <= 10.1 * fastest
    if not found.astray:
        assert found["friction"].value < 10.0
        return
    assert found.astray in " ".join(found.blind) and "runs away" in found.astray
    assert not any(number.determined for number in found.numbers.values() if number.how == "found")
    with pytest.raises(pt.InputError, match="nothing to play"):
        found.simulate()
    found.save(tmp_path / "fit.json")
    with pytest.raises(pt.InputError, match="nothing to play"):
        puck_and_launch(tmp_path / "fit.json")
    bound = pt.fit(track, pt.Puck(radius=0.04), bounds={"launch_spin": (-60.0, 60.0)})
    assert not bound.astray and abs(bound.launch().spin) <= 60.0


@pytest.mark.parametrize("seed", few(1, range(40)))
def test_places_on_a_grid_are_no_noise_and_that_is_said(seed):
    rng = np.random.default_rng([35, 6, seed])
    radius, friction = rng.uniform(0.02, 0.05), rng.uniform(0.05, 0.4)
    velocity, spin = np.array([rng.uniform(0.8, 2.0), rng.uniform(-0.3, 0.3)]), 0.0
    spin = rng.uniform(0.4, 1.5) * rng.choice([-1.0, 1.0]) * velocity[0] / radius
    times = np.linspace(0.0, rng.uniform(0.6, 1.3) * velocity[0] / (friction * G), 110)
    true = film_judge.path(tuple(velocity), spin, friction * G, 0.4, radius, times)
    place = true[:2].T + 1e-4 * rng.normal(size=(110, 2))
    step = rng.uniform(2e-3, 10e-3)
    found = pt.fit(pt.Track(times, step * np.round(place / step)), pt.Puck(radius=radius))
    assert any(f"rounded to {step:.3g} m" in text for text in found.remarks), found.remarks
    grid = step * np.round(place / step)
    near = pt.fit(
        pt.Track(times, np.nextafter(grid, rng.normal(size=grid.shape))), pt.Puck(radius=radius)
    )
    assert near["friction"].value == pytest.approx(found["friction"].value, rel=1e-6)
    number, most = found["friction"], 1.0
    if any("taken for a slide without spin" in text for text in found.remarks):
        most = 1.6  # times as much, if it spun: that is said
    low, high = number.value - 4.0 * number.error, most * number.value + 4.0 * number.error
    assert not number.determined or low < friction < high
    assert not any("no noise" in text for text in found.complaints)
    fine = pt.fit(pt.Track(times, 1e-5 * np.round(place / 1e-5)), pt.Puck(radius=radius))
    assert not any("rounded" in text for text in fine.remarks)
