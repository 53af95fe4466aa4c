"""Films that are drawn: nothing wrong is called determined, no free frame is left out unsaid."""

from __future__ import annotations

import math

import film_judge
import numpy as np
import pytest
from disc_judge import slid
from drawn_films import KINDS, cut, drawn, wrong
from rarely import thorough

import puck_tables as pt
from puck_tables.fitting.numbers import Number
from puck_tables.fitting.remarks import taken_for_granted
from puck_tables.fitting.residuals import SideForces

# a drag, or a soft push, in few frames may look like friction
UNSEEN = ("drag", "hand", "push")
GOOD = ("marked", "unmarked", "straight", "straight unmarked", "fast", "few", "grid")


def misleads(film, found: pt.results.Fit) -> dict[str, float]:
    """What is wrong, but for what a table out of level by so much is said to do, unseen."""
    said = any("A level table is taken for granted" in text for text in found.remarks)
    return {} if film.slope and said else wrong(film, found)


def cases() -> list[pytest.param]:
    """One film of some kinds for every run, one of each with the thorough ones."""
    quick = ("marked", "fast", "few", "air table", "grid", "push")
    return [
        pytest.param(kind, seed, marks=[] if seed == 1 and kind in quick else pytest.mark.thorough)
        for kind in KINDS for seed in (1, 3)
    ] + [thorough("sloped unmarked", 225)]  # fmt: skip


@pytest.mark.parametrize(("kind", "seed"), cases())
def test_nothing_wrong_is_called_determined(kind, seed):
    film = drawn(kind, seed)
    found = pt.fit(film.track, film.puck)
    assert misleads(film, found) == {}
    assert cut(film, found) <= 0.1 or found.cut_off
    if film.foreign == 0 and not kind.startswith("push"):
        assert cut(film, found) <= 0.02


@pytest.mark.parametrize(("level", "said"), [(0.02, "0.02"), (0.4, "0.1"), (0.005, None)])
def test_a_slope_that_is_told_counts_by_what_is_left_of_it(level, said):
    friction = Number(0.15, 1e-4, 0.1498, 0.1502, "1", "found")
    forces = SideForces(level=level, by_slope={"friction": 0.0017})
    sentences = taken_for_granted(forces, {"friction": friction})
    assert len(sentences) == (said is not None)
    assert all(f"out of level by {said} degrees" in one for one in sentences)


@pytest.mark.nightly
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_wrong_is_called_determined_in_250_films(kind):
    bad, shares, complaints = {}, [], 0
    for seed in range(200, 210):
        film = drawn(kind, seed)
        try:
            found = pt.fit(film.track, film.puck)
        except pt.InputError as error:
            assert "too few to judge" in str(error) and kind == "few"
            continue
        shares.append(cut(film, found))
        assert shares[-1] <= 0.1 or found.cut_off
        complaints += bool(found.complaints)
        if off := misleads(film, found):
            bad[seed] = off
    assert len(bad) <= (kind in UNSEEN), bad
    if not kind.startswith("push"):
        assert np.mean(shares) <= (0.05 if kind in ("hand", "wall") else 0.01)
    if kind in GOOD:
        assert complaints <= 1


@pytest.mark.parametrize("seed", [8, *map(thorough, (5, 7))])
def test_no_good_frame_of_few_is_left_out_and_a_stray_is(seed):
    """What is left out must not make the noise less than it is, by which more would be left out."""
    film = drawn("few", 200 + seed)
    found = pt.fit(film.track, film.puck)
    assert found.outliers == 0.0 and wrong(film, found) == {}
    place = film.track.place.copy()
    place[4] += 0.2
    stray = pt.fit(pt.Track(film.track.time, place, film.track.angle), film.puck)
    assert 0.0 < stray.outliers < 0.1 and wrong(film, stray) == {}


@pytest.mark.parametrize("seed", [2, thorough(5)])
def test_a_start_at_the_truth_is_followed(seed):
    """At the noise that is told, of few frames between which the puck turns more than half."""
    film = drawn("few", seed)
    names = ("friction", "delta", "launch_spin")
    start = {name: float(film.truth[name]) for name in names}
    found = pt.fit(film.track, film.puck, noise=film.noise, start=start)
    assert wrong(film, found) == {} and found.complaints == ()
    assert found.launch().spin == pytest.approx(film.truth["launch_spin"], rel=0.05)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [1, 2])
def test_spins_are_slow_unless_that_is_excluded_in_joint_fits_too(seed):
    """Two pucks on a floor of hardly any friction, where whole turns a frame are hardly told."""
    rng = np.random.default_rng([9, seed])
    times, tracks, spins = np.arange(60) / 100.0, [], rng.uniform(2.0, 9.0, 2)
    for n, spin in enumerate(spins):
        angle, speed = rng.uniform(0.0, 6.28), rng.uniform(0.1, 0.4)
        velocity = speed * math.cos(angle), speed * math.sin(angle)
        true = slid(lambda u: 2e-4 + 0.01 * u, 0.025, velocity, spin, times)
        place = true[:2].T + 3e-5 * rng.normal(size=(60, 2)) + 2.0 * n
        tracks.append(pt.Track(times, place, true[2] + 1e-3 * rng.normal(size=60), f"puck {n}"))
    found = pt.fit(tracks, pt.Puck(radius=0.025))
    for launch, spin in zip(found.launches, spins, strict=True):
        assert launch.spin == pytest.approx(spin, abs=0.5)
        assert launch.numbers["launch_spin"].determined or any(
            launch.name in text and "Another motion" in text for text in found.blind
        )


def test_frames_are_left_out_where_a_hand_touches_and_that_is_said():
    film = drawn("hand", 2)
    found = pt.fit(film.track, film.puck)
    ((_, first, last),) = found.left_out
    assert film.foreign <= first <= 1.2 * film.foreign + 5 and last == 0
    assert "--keep-all" in found.cut_off and "friction" in found.cut_off


def test_first_frames_that_are_off_but_not_cut_are_said():
    """A hand that keeps the speed and lets go without a jerk."""
    rng, before = np.random.default_rng(5), np.arange(-10.0, 0.0) / 60.0
    after = np.arange(80) / 60.0
    true = slid(lambda _: 0.15, 0.0381, (1.5, 0.3), 25.0, after)
    held = np.stack([1.5 * before, 0.3 * before, 25.0 * before * np.linspace(0.0, 1.0, 10)])
    x, y, angle = np.concatenate([held, true[:3]], axis=1)
    noise = rng.normal(size=(90, 3)) * [3e-4, 3e-4, 5e-3]
    place = np.stack([x, y], axis=1) + noise[:, :2]
    track = pt.Track(np.append(before, after), place, angle + noise[:, 2], "held")
    puck = pt.Puck(radius=0.0381, height=0.0)
    found = pt.fit(track, puck)
    assert "first 8 frames of held are off" in found.cut_off and "--since -0.033" in found.cut_off
    assert abs(found.numbers["friction"].value - 0.15) < 4.0 * found.numbers["friction"].error
    assert not pt.fit(track, puck, since=-1.0).cut_off


@pytest.mark.thorough
@pytest.mark.parametrize("how", [{"keep_all": True}, {"since": -1.0}])
def test_frames_that_a_hand_touches_are_kept_if_asked(how):
    film = drawn("hand", 2)
    kept = pt.fit(film.track, film.puck, **how)
    assert kept.left_out[0][1:] == (0, 0) and kept.complaints and not kept.cut_off


def test_what_no_motion_comes_near_determines_nothing():
    times, rng = np.arange(120) / 60.0, np.random.default_rng(4)
    place = np.stack([np.sin(5.0 * times), np.cos(4.0 * times)], axis=1)
    track = pt.Track(times, place + 1e-4 * rng.normal(size=(120, 2)))
    found = pt.fit(track, pt.Puck(radius=0.04), noise=(1e-4, None))
    assert not found["friction"].determined and "Nothing is determined" in found.blind[0]
    assert not found.launch().numbers["launch_vx"].determined


@pytest.mark.parametrize("seed", [1, thorough(4)])
def test_a_table_out_of_level_is_named_or_said_with_its_size(seed):
    """A slide straight down, and one that spins, on a table out of level by half a degree."""
    rng = np.random.default_rng([35, 1, seed])
    friction, down = rng.uniform(0.08, 0.2), rng.uniform(0.0, 6.28)
    decel = friction * film_judge.G
    for spin, seen, way in ((0.0, 0.5, math.atan2(0.2, 1.5)), (40.0, 0.9, down)):
        pull = film_judge.G * math.radians(0.5) * np.array([math.cos(way), math.sin(way), 0.0])
        times = np.linspace(0.0, seen * 1.5 / decel, 120)
        true = film_judge.path(
            (1.5, 0.2), spin, decel, 0.3, 0.04, times, besides=lambda t, v, w, pull=pull: pull
        )
        track = pt.Track(times, *film_judge.noisy(rng, true, (3e-4, 5e-3)))
        found = pt.fit(track, pt.Puck(radius=0.04))
        if spin:
            assert found.complaints and "out of level by 0." in found.misfit, found.misfit
            continue
        (text,) = [text for text in found.remarks if "A level table" in text]
        change = float(text.split("friction by up to ")[1].split()[0].strip(","))
        assert change == pytest.approx(math.radians(0.1), rel=0.1)  # a slide straight down
        number = found["friction"]
        assert abs(number.value - friction) < 5.5 * change + 4.0 * number.error


@pytest.mark.nightly
def test_errors_of_rounded_places_are_those_of_many_films():
    away = []
    for seed in range(600, 680):
        film = drawn("grid", seed)
        number = pt.fit(film.track, film.puck)["friction"]
        if number.determined and not number.at_bound:
            away.append((number.value - film.truth["friction"]) / number.error)
    assert 0.6 < math.sqrt(np.mean(np.square(away))) < 1.2
