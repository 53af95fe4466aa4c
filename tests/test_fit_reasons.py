"""What a film is if its puck did not spin, why it does not fit, and what nobody would believe."""

from __future__ import annotations

import math
from dataclasses import replace

import film_judge
import impacts_judge
import numpy as np
import pytest
from disc_judge import slid
from film_judge import G
from rarely import few, thorough
from test_fit_speed import FLAT, RADIUS, TIMES, film

import puck_tables as pt
from puck_tables.fitting.problem import Problem

NOISE = (0.3e-3, 5e-3)


def way_of(rng: np.random.Generator, speed: float) -> tuple[float, float]:
    angle = rng.uniform(0.0, 2.0 * math.pi)
    return speed * math.cos(angle), speed * math.sin(angle)


@pytest.mark.parametrize("seed", few(3, range(24)))
def test_a_slide_without_marks_is_told_as_one_first(seed):
    """The commonest film: its friction hangs on a spin that nobody saw."""
    rng = np.random.default_rng([35, 10, seed])
    friction, velocity = rng.uniform(0.08, 0.5), np.array(way_of(rng, rng.uniform(0.8, 2.0)))
    end = math.hypot(*velocity) / (friction * G)
    times = np.linspace(0.0, 1.1 * end, int(rng.integers(60, 200)))
    moving = np.minimum(times, end)
    way = moving - 0.5 * moving**2 / end
    place = np.outer(way, velocity) + NOISE[0] * rng.normal(size=(times.size, 2))
    found = pt.fit(pt.Track(times, place), pt.Puck(radius=0.04))
    if found["friction"].determined:
        assert abs(found["friction"].value - friction) < 4.0 * found["friction"].error
        return
    first = found.blind[0]
    assert first.startswith("friction = ") and "--fix launch_spin=0" in first
    value, _, error = first.split()[2:5]
    assert abs(float(value) - friction) < 4.0 * float(error) + 1e-4 * friction
    assert not any("if it did not spin" in text for text in found.blind[1:])


def test_a_puck_that_spun_is_not_told_without_spin():
    rng = np.random.default_rng(3510)
    times = np.arange(180) / 120.0
    true = film_judge.path((1.5, 0.3), 90.0, 1.5, 0.3, 0.04, times)
    found = pt.fit(pt.Track(times, film_judge.noisy(rng, true, NOISE)[0]), pt.Puck(radius=0.04))
    assert not any("if it did not spin" in text for text in found.blind)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(1, range(8)))
def test_a_floor_whose_friction_falls_with_speed_is_named(seed):
    rng = np.random.default_rng([35, 100, seed])
    rest, fast, scale = rng.uniform(0.25, 0.35), rng.uniform(0.1, 0.15), rng.uniform(0.2, 1.0)
    path = slid(
        lambda u: fast + (rest - fast) * np.exp(-u / scale), RADIUS,
        way_of(rng, rng.uniform(1.2, 1.8)), rng.uniform(15.0, 40.0) * rng.choice([-1.0, 1.0]),
        TIMES,
    )  # fmt: skip
    found = pt.fit(film(path, seed), FLAT, fixed={"delta": 0.0})
    assert found.complaints
    assert "over slip speed" in found.misfit
    speeds = [float(u) for u in found.misfit.split("--slip-speeds ")[1].split(")")[0].split(",")]
    asked = pt.fit(film(path, seed), FLAT, fixed={"delta": 0.0}, slip_speeds=speeds)
    assert asked.chi2 / asked.degrees < 1.5 and asked.noise[0] < 0.5 * found.noise[0]


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(1, range(20)))
def test_a_mark_a_little_off_the_centre_is_named_first(seed):
    """Five times the noise: a level table was blamed for it."""
    rng = np.random.default_rng([35, 120, seed])
    friction, velocity = rng.uniform(0.1, 0.3), way_of(rng, rng.uniform(0.8, 2.0))
    spin = rng.uniform(10.0, 40.0)
    puck = pt.Puck(radius=0.04, height=0.02)
    end = replace(puck, friction=friction).stop(velocity, spin).stop_time
    times = np.linspace(0.0, 1.05 * float(end), 180)
    true = film_judge.path(velocity, spin, friction * G, friction, 0.04, times)
    true[:2] += 1.5e-3 * np.stack([np.cos(true[2]), np.sin(true[2])])
    found = pt.fit(pt.Track(times, *film_judge.noisy(rng, true, NOISE)), puck)
    assert abs(found["friction"].value - friction) < 4.0 * found["friction"].error
    assert "off the centre" in found.misfit.split("; or ")[0]


@pytest.mark.parametrize("seed", few(1, range(20)))
def test_angles_that_turn_the_other_way_are_named_first(seed):
    """As y grows down an image; a slope alone was blamed for the path, which follows the spin."""
    rng = np.random.default_rng([47, seed])
    times, delta = np.arange(96) / 160.0, rng.uniform(0.15, 0.3)
    velocity, spin = way_of(rng, rng.uniform(1.0, 2.0)), rng.uniform(25.0, 60.0)
    true = film_judge.path(velocity, spin, rng.uniform(1.5, 3.0), delta, 0.04, times)
    place, angle = film_judge.noisy(rng, true, NOISE)
    found = pt.fit(pt.Track(times, place, -angle), pt.Puck(radius=0.04))
    assert "grew the other way" in found.misfit.split("; or ")[0]
    assert any(text.startswith("delta") and "other way" in text for text in found.remarks)


@pytest.mark.parametrize(
    ("part", "words"), [(2, "half a turn"), thorough(4, "a quarter of a turn")]
)
def test_angles_of_a_bar_or_a_square_are_told(part, words):
    """As image libraries give them: some floor was blamed."""
    rng, times, period = np.random.default_rng(part), np.arange(96) / 160.0, 2.0 * math.pi / part
    true = film_judge.path((1.4, 0.3), 35.0, 2.0, 0.2, 0.04, times)
    place, angle = film_judge.noisy(rng, true, NOISE)
    angle = np.mod(angle, period)
    found = pt.fit(pt.Track(times, place, angle), pt.Puck(radius=0.04))
    assert words in found.misfit.split("; or ")[0]
    found = pt.fit(pt.Track(times, place, np.unwrap(angle, period=period)), pt.Puck(radius=0.04))
    assert not found.complaints
    assert abs(found["delta"].value - 0.2) < 4.0 * found["delta"].error


def test_a_height_that_no_puck_has_is_said():
    """A path on a floor that slopes sideways bends as that of a tall puck does."""
    rng = np.random.default_rng(3512)
    times = np.arange(200) / 120.0
    true = film_judge.path((1.2, 0.0), 30.0, 0.004 * G, 0.3, 0.013, times)
    track = pt.Track(times, *film_judge.noisy(rng, true, (1e-4, 2e-3)))
    found = pt.fit(track, pt.Puck(radius=0.013))
    height = found["height"]
    assert height.determined and height.value > 0.2
    assert any("times the radius, as no puck is" in text for text in found.remarks)


@pytest.mark.parametrize("seed", few(2, range(8)))
def test_what_impacts_tell_keeps_its_error_where_the_tilt_is_at_its_end(seed):
    """A flat puck: the tilt that fits best lies at 0, or would below, in half of all films."""
    rng = np.random.default_rng([35, 120, seed])
    times, wall = np.arange(200) / 120.0, [(0.3, 0.9)]
    start = np.array([0.0, 0.0, 2.2, 0.9, rng.uniform(20.0, 50.0), 0.3])
    true = impacts_judge.wall_film((1.5, 0.0, 0.04), start, wall, [0.41], (0.8, 0.12), times)
    track = pt.Track(times, *film_judge.noisy(rng, true, NOISE))
    found = pt.fit(track, pt.Puck(radius=0.04), impacts=True)
    assert found["delta"].at_bound or found["delta"].value < 0.02
    (hit,) = found.impacts
    at, (cosine, sine) = impacts_judge.state((1.5, 0.0, 0.04), start, hit.time), np.array(
        [math.cos(0.3), math.sin(0.3)])  # fmt: skip
    slip = at[3] * cosine - at[2] * sine + 0.04 * at[4]
    # where the spin is slow the rim stops on the wall, and rubs less: 1 + r²/k² = 3
    rim = min(0.12, slip / 3.0 / (1.8 * (at[2] * cosine + at[3] * sine)))
    for number, truth in ((hit.restitution, 0.8), (hit.rim, rim)):
        assert 0.0 < number.error < 0.05
        assert abs(number.value - truth) < 5.0 * number.error
    for launch in found.launches:
        assert all(math.isfinite(one.error) for one in launch.numbers.values())


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(1, range(8)))
@pytest.mark.parametrize("spinning", [False, True])
def test_what_slows_a_puck_is_named_before_jitter_radius_or_a_hand(seed, spinning):
    """Air, v' = -c v^2, that leaves the spin; or drag of speed and spin alike, v' = -c v."""
    rng = np.random.default_rng([35, 8, seed])
    times, speed = np.arange(120) / 60.0, rng.uniform(1.5, 3.0)
    spin, drag = rng.uniform(5.0, 12.0) * rng.choice([-1.0, 1.0]), rng.uniform(0.1, 0.3)
    if spinning:
        way, angle = (one * -np.expm1(-drag * times) / drag for one in (speed, spin))
    else:
        way, angle = np.log1p(drag * speed * times) / drag, spin * times
    place = np.outer(way, np.array(way_of(rng, 1.0)))
    place += NOISE[0] * rng.normal(size=place.shape)
    track = pt.Track(times, place, angle + NOISE[1] * rng.normal(size=times.size))
    found = pt.fit(track, pt.Puck(radius=0.04))
    assert found.complaints
    told = ("--free", "--slip-speeds") if spinning else ("air",)
    assert any(words in found.misfit for words in told), found.misfit
    assert not any("jitter" in text for text in found.remarks)


@pytest.mark.thorough
def test_other_readings_are_followed_about_as_far_as_they_tell(monkeypatch):
    """Angles without noise: a law over slip speed led along a valley for thousands of steps."""
    puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.15)
    times = np.arange(120) / 60.0
    path = puck.states((2.0, 0.5), 40.0, times)
    place = np.stack([path.x, path.y], axis=1)
    place += np.random.default_rng(1).normal(0.0, 3e-4, place.shape)
    steps, step = [], Problem.residuals_and_jacobian

    def counted(problem, x):
        steps.append(x)
        return step(problem, x)

    monkeypatch.setattr(Problem, "residuals_and_jacobian", counted)
    found = pt.fit(pt.Track(times, place, path.orientation), pt.Puck(radius=0.0381))
    assert found["friction"].value == pytest.approx(0.15, abs=1e-8)
    assert len(steps) < 1500
