"""Films with impacts on walls: slides by scipy, the impact by its law written out here."""

from __future__ import annotations

import math

import film_judge
import impacts_judge
import numpy as np
import pytest
from rarely import few
from test_fit import DECEL, DELTA, KNOWN, NOISE, RADIUS, film

import puck_tables as pt

RESTITUTION, RIM, WALL = 0.8, 0.12, 0.3
_LONG, _SHORT = np.arange(200) / 120.0, 1e-5


def bank(hit: float) -> np.ndarray:
    """Places and angles (3, n) of a puck that meets a wall after ``hit`` s."""
    velocity, spin = (2.2, 0.9), 40.0
    ends = film_judge.path(
        velocity, spin, DECEL, DELTA, RADIUS, np.array([hit - _SHORT, hit, hit + _SHORT])
    )
    state, rate = ends[:, 1], (ends[:, 2] - ends[:, 0]) / (2.0 * _SHORT)
    normal = np.array([math.cos(WALL), math.sin(WALL)])
    tangent = np.array([-normal[1], normal[0]])
    push = (1.0 + RESTITUTION) * float(rate[:2] @ normal)
    slip = float(rate[:2] @ tangent) + RADIUS * rate[2]
    rub = math.copysign(min(RIM * push, abs(slip) / 3.0), slip)  # 1 + r²/k² = 3
    away = rate[:2] - push * normal - rub * tangent
    spin_after = rate[2] - 2.0 * rub / RADIUS
    before = film_judge.path(velocity, spin, DECEL, DELTA, RADIUS, _LONG)
    later = np.maximum(_LONG - hit, 0.0)
    after = film_judge.path((away[0], away[1]), spin_after, DECEL, DELTA, RADIUS, later)
    return np.where(hit > _LONG, before, state[:, None] + after)


def test_restitution_and_rim_friction_follow_from_an_impact():
    found = pt.fit(film(bank(0.3347), 1), KNOWN, impacts=True)
    (impact,) = found.impacts
    assert impact.time == pytest.approx(0.3347, abs=1e-3)
    assert impact.wall == pytest.approx(WALL, abs=5e-3)
    for number, truth in ((impact.restitution, RESTITUTION), (impact.rim, RIM)):
        assert abs(number.value - truth) < 4.5 * number.error
        assert number.error < 5e-3
    assert abs(found["decel"].value - DECEL) < 4.5 * found["decel"].error
    assert found["decel"].error < 3e-3 and found.complaints == ()
    assert [launch.name for launch in found.launches] == ["film, slide 1", "film, slide 2"]
    assert found.summary()["impacts"][0]["restitution"]["value"] == impact.restitution.value


def test_walls_that_are_never_met_are_named():
    wall = ((5.0, 0.0), (5.0, 1.0))
    found = pt.fit(film(bank(0.3347), 1), KNOWN, walls=[wall])
    assert len(found.impacts) == 1
    assert [text for text in found.remarks if "(5, 0) and (5, 1)" in text]
    free = film_judge.path((1.9, 0.6), 60.0, DECEL, DELTA, RADIUS, _LONG)
    assert "No impact was found" in pt.fit(film(free, 3), KNOWN, walls=[wall]).remarks[0]


def test_an_impact_not_asked_for_is_noticed():
    whole = pt.fit(film(bank(0.6), 2), KNOWN, noise=NOISE)
    assert whole.complaints or sum(whole.left_out[0][1:]) > 50


@pytest.mark.thorough
def test_outliers_are_no_impacts():
    true = film_judge.path((1.9, 0.6), 60.0, DECEL, DELTA, RADIUS, _LONG)
    for seed in range(3):
        found = pt.fit(film(true, seed, wrong=0.05), KNOWN, impacts=True)
        assert found.impacts == () and len(found.launches) == 1


MOTION = DECEL, DELTA, RADIUS
TIMES = np.arange(240) / 120.0
WALLS, HITS = [(0.3, 0.9), (-2.17, -0.269)], [0.4167, 0.8167]
TRUTH = np.array([DECEL, DELTA, 0.0, 0.0, 2.2, 0.9, 40.0, 0.3, *WALLS[0], *WALLS[1], 0.8, 0.12])
STEPS = np.array([1e-3, 2e-3, 1e-4, 1e-4, 1e-3, 1e-3, 1e-2, 1e-3, *[1e-4] * 4, 1e-3, 1e-3])
GIVEN = [((0.9 * math.cos(a) - s * math.sin(a), 0.9 * math.sin(a) + s * math.cos(a)))
         for a, s in ((0.3, 0.0), (0.3, 1.0))]  # fmt: skip


def two_walls(p: np.ndarray) -> np.ndarray:
    walls = [(p[8], p[9]), (p[10], p[11])]
    return impacts_judge.wall_film((p[0], p[1], RADIUS), p[2:8], walls, HITS, (p[12], p[13]), TIMES)


@pytest.fixture(scope="module")
def banked() -> np.ndarray:
    return two_walls(TRUTH)


def seen(true: np.ndarray, seed: int, name: str = "film") -> pt.Track:
    return pt.Track(TIMES, *film_judge.noisy(np.random.default_rng(seed), true, NOISE), name)


def scatter(true: np.ndarray, seeds: range) -> tuple[np.ndarray, np.ndarray, pt.results.Fit]:
    """Errors of e and the rim's friction over their bounds, whether within 95 %; the last fit."""
    bound = impacts_judge.bound(two_walls, TRUTH, STEPS, NOISE)[12:]
    off, inside = [], []
    for seed in seeds:
        found = pt.fit(seen(true, seed), KNOWN, impacts=True)
        numbers = found["restitution"], found["rim_friction"]
        assert len(found.impacts) == 2 and found.untied == ""
        off.append([one.value - t for one, t in zip(numbers, TRUTH[12:], strict=True)] / bound)
        inside.append([one.low < t < one.high for one, t in zip(numbers, TRUTH[12:], strict=True)])
    return np.array(off), np.array(inside), found


@pytest.mark.thorough
def test_the_error_of_restitution_is_its_bound(banked):
    off, inside, last = scatter(banked, range(3))
    assert np.all(np.sqrt((off**2).mean(axis=0)) < 2.2)  # p = 0.002 of three
    assert np.all(inside.sum(axis=0) >= 2)
    one, two = last.impacts
    assert one.rim.value == pytest.approx(0.12, abs=1e-3)
    assert abs(two.rim.value) < 0.119  # the rim stops on the wall


@pytest.mark.nightly
def test_the_error_of_restitution_is_its_bound_over_200_films(banked):
    off, inside, _ = scatter(banked, range(1000, 1200))
    assert np.all(np.sqrt((off**2).mean(axis=0)) < 1.2)
    assert np.all(np.abs(inside.mean(axis=0) - 0.95) < 0.045)


@pytest.mark.thorough
def test_a_wall_that_is_given_tells_more(banked):
    found = pt.fit(seen(banked, 1), KNOWN, walls=[GIVEN])
    alone = pt.fit(seen(banked, 1), KNOWN, impacts=True)
    assert found.impacts[0].wall == pytest.approx(0.3, abs=1e-12)
    assert found["restitution"].error < 0.99 * alone["restitution"].error
    assert abs(found["restitution"].value - 0.8) < 4.0 * found["restitution"].error


@pytest.mark.thorough
def test_walls_of_different_restitution_are_not_made_one(banked):
    hard = impacts_judge.wall_film(MOTION, TRUTH[2:8], WALLS[:1], HITS[:1], (0.8, 0.12), TIMES)
    start = impacts_judge.state(MOTION, TRUTH[2:8], 0.0)
    one = impacts_judge.after_wall(MOTION, start, WALLS[0], HITS[0], (0.8, 0.12))
    since, launch = one
    soft = impacts_judge.wall_film(
        MOTION, launch, WALLS[1:], [HITS[1] - since], (0.6, 0.12), np.maximum(TIMES - since, 0.0)
    )
    found = pt.fit(seen(np.where(since > TIMES, hard, soft), 3), KNOWN, impacts=True)
    assert "not joined" in found.untied and found.untied in found.complaints
    for impact, truth in zip(found.impacts, (0.8, 0.6), strict=True):
        assert abs(impact.restitution.value - truth) < 4.5 * impact.restitution.error


def pair(second: list[float], rims: tuple[float, float, float], about: float, seed: int):
    launches = np.array([0.0, 0.0, 2.0, 0.1, 30.0, 0.3]), np.array(second)
    films = impacts_judge.pair_film(MOTION, launches, about, rims, TIMES)
    return [seen(true, seed + n, f"puck {n + 1}") for n, true in enumerate(films)]


@pytest.mark.thorough
def test_two_pucks_that_meet_tell_their_restitution_and_masses():
    tracks = pair([0.7, 0.02, -0.3, 0.05, -10.0, 1.0], (0.9, 0.1, 1.6), 0.3333, 1)
    free = ["friction", "delta", "mass_ratio"]
    found = pt.fit(tracks, KNOWN, free=free, impacts=True)
    for name, truth in (("pair_restitution", 0.9), ("pair_friction", 0.1), ("mass_ratio", 1.6),
                        ("friction", 0.15)):  # fmt: skip
        assert abs(found[name].value - truth) < 4.0 * found[name].error, name
        assert found[name].error < 2e-3
    (impact,) = found.impacts
    assert (impact.track, impact.partner) == ("puck 1", "puck 2") and found.complaints == ()


@pytest.mark.thorough
def test_a_puck_at_rest_may_be_hit():
    tracks = pair([0.5, 0.0, 0.0, 0.0, 0.0, 1.0], (0.9, 0.15, 1.0), 0.2333, 5)
    found = pt.fit(tracks, KNOWN, impacts=True)
    assert abs(found["pair_restitution"].value - 0.9) < 4.0 * found["pair_restitution"].error
    assert abs(found["pair_friction"].value - 0.15) < 4.0 * found["pair_friction"].error
    assert found.launch("puck 2, slide 1").spin == 0.0
    assert found.launch("puck 2, slide 2").velocity[0] > 1.0


def one_wall(seed: int) -> pt.Track:
    """Places alone of a puck that meets a wall at x = 0.6 m: e = 0.7, friction of the rim 0.05."""
    rng = np.random.default_rng([7, seed])
    spin = rng.uniform(20.0, 60.0) * rng.choice([-1.0, 1.0])
    launch = np.array([0.0, 0.0, rng.uniform(1.5, 2.5), rng.uniform(-1.5, 1.5), spin, 0.0])
    times, look = np.arange(180) / 240.0, np.linspace(0.0, 0.7, 400)
    hit = look[int(np.argmax(impacts_judge.path(MOTION, launch, look)[0] > 0.6 - RADIUS))]
    true = impacts_judge.wall_film(MOTION, launch, [(0.0, 0.6)], [hit], (0.7, 0.05), times)
    return pt.Track(times, film_judge.noisy(rng, true, NOISE)[0])


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(2, [4, 7, 12]))
def test_without_angles_no_wrong_spin_is_told_alone(seed):
    """A spin three times as fast, with more friction of floor and rim, fits about as well."""
    found = pt.fit(one_wall(seed), KNOWN, impacts=True)
    for name, truth in (("friction", 0.15), ("delta", DELTA), ("restitution", 0.7),
                        ("rim_friction", 0.05)):  # fmt: skip
        number = found[name]
        assert not number.determined or abs(number.value - truth) < 4.0 * number.error, name
    assert found["friction"].low < 0.16
    assert any("Another motion" in text for text in found.blind)


@pytest.mark.thorough
def test_an_impact_that_slides_and_one_that_grips_have_one_law():
    """The first rubs nearly as much as would stop its rim: both seemed to grip."""
    at = impacts_judge.state(MOTION, TRUTH[2:8], HITS[0])
    n = np.array([math.cos(WALLS[0][0]), math.sin(WALLS[0][0])])
    slip = float(at[3] * n[0] - at[2] * n[1]) + RADIUS * at[4]
    rim = 0.985 * slip / 3.0 / (1.8 * float(at[2:4] @ n))
    true = impacts_judge.wall_film(MOTION, TRUTH[2:8], WALLS, HITS, (0.8, rim), TIMES)
    found = pt.fit(seen(true, 1), KNOWN, impacts=True, noise=NOISE)
    assert found.untied == "" and found.complaints == ()
    for name, truth in (("restitution", 0.8), ("rim_friction", rim), ("friction", 0.15)):
        assert abs(found[name].value - truth) < 4.0 * found[name].error, name
    assert abs(found.impacts[1].rim.value) < 0.99 * rim
