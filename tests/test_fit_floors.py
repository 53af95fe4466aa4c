"""Floors that are no constant friction: slopes, belts, laws over slip speed; what a film supports.

Films are made by an integrator of its own (:mod:`disc_judge`).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from disc_judge import slid
from film_judge import G
from rarely import thorough

import puck_tables as pt
from puck_tables.fitting.checked_spec import spec_of, with_law
from puck_tables.fitting.fit_spec import LAW_NUMBERS
from puck_tables.fitting.forward_model import RADIUS, SPIN, VX, VY, states_and_slopes
from puck_tables.fitting.speed_motion import law_named

R = 0.04
PUCK = pt.Puck(R, height=0.0)
NOISE = (3e-4, 4e-3)


def film(seed: int, law, v=1.6, spin=35.0, frames=150, **how):
    """A film of a disc under friction law(u) on a floor that slopes or moves."""
    rng = np.random.default_rng(seed)
    t, way = np.arange(frames) / 120.0, rng.uniform(0.0, 2.0 * math.pi)
    x, y, angle = slid(law, R, (v * math.cos(way), v * math.sin(way)), spin, t, **how)
    place = np.stack([x, y], axis=1) + rng.normal(0.0, NOISE[0], (frames, 2))
    return pt.Track(t, place, angle + rng.normal(0.0, NOISE[1], frames), "film")


def even(u):
    return 0.12 + 0.0 * u


def stribeck(u):
    return 0.1 + 0.12 * np.exp(-u / 0.3)


def two_valued(u):
    return np.clip(0.1 + 0.1 * (0.5 + (1.0 - u / 0.6) / 0.1), 0.1, 0.2)


def near(number, value: float) -> bool:
    return number.determined and abs(number.value - value) < 5.0 * number.error + 1e-4


def test_a_slope_and_its_direction():
    result = pt.fit(film(1, even, push=(0.01 * G, -0.02 * G)), PUCK,
                    free=["friction", "slope_x", "slope_y"])  # fmt: skip
    for name, value in (("friction", 0.12), ("slope_x", 0.01), ("slope_y", -0.02)):
        assert near(result[name], value), (name, result[name])
    assert result["slope_x"].error < 1e-3
    assert not result.forces.by_slope  # its slope is found, not taken for granted


def test_the_speed_of_a_belt():
    result = pt.fit(film(2, even, belt=(0.3, 0.2)), PUCK, free=["friction", "belt_x", "belt_y"])
    for name, value in (("friction", 0.12), ("belt_x", 0.3), ("belt_y", 0.2)):
        assert near(result[name], value), (name, result[name])


@pytest.mark.parametrize(
    ("name", "law", "numbers"),
    [("stribeck", stribeck, (0.1, 0.22, 0.3)), ("two-valued", two_valued, (0.1, 0.2, 0.6))],
)
def test_laws_by_their_names(name, law, numbers):
    result = pt.fit(film(3, law, frames=110), PUCK, free="friction", law=name, keep_all=True)
    for one, value in zip(("friction", "friction_rest", "law_speed"), numbers, strict=True):
        assert near(result[one], value) and result[one].error < 0.2 * value, (one, result[one])


@pytest.mark.parametrize("law", ["stribeck", "hyperbola"])
def test_a_law_by_its_name_holds_however_fast_the_puck_slips(law):
    """Between its rows, and a hundred times faster than its speed."""
    u = np.concatenate([np.linspace(0.0, 0.2, 400), np.geomspace(0.2, 4.0, 400)])
    fast = {"stribeck": np.exp(-u / 0.03), "hyperbola": 1.0 / (1.0 + u / 0.03)}[law]
    assert np.abs(law_named(law, 0.1, 0.2, 0.03)(u) - 0.1 - 0.1 * fast).max() < 3e-4


@pytest.mark.parametrize("how", [{}, {"push": (0.2, 0.1)}, {"belt": (0.4, -0.3)}, {"drag": 0.5}])
@pytest.mark.parametrize(("v", "spin"), [(1.6, 35.0), thorough(0.3, 60.0), thorough(1.2, 8.0)])
def test_motions_and_their_slopes_are_those_of_the_judge(how, v, spin):
    """By launch, radius and the numbers of a law."""
    times = np.linspace(0.0, 1.0, 30)
    truth = np.array([v, 0.2, spin, R, 0.1, 0.22, 0.3])

    def judged(numbers):
        vx, vy, w, radius, fast, rest, speed = numbers
        law = law_named("stribeck", fast, rest, speed).extended  # its rows, not its formula
        return slid(law, radius, (vx, vy), w, times, until=1e-5, **how)

    spec = with_law(spec_of(pt.Puck(R, height=0.0), ["friction"], {}, {}, {}, {}), "stribeck")
    push, belt = how.get("push", (0.0, 0.0)), how.get("belt", (0.0, 0.0))
    floor = dict(zip(("slope_x", "slope_y", "belt_x", "belt_y"),
                     (push[0] / G, push[1] / G, *belt), strict=True))  # fmt: skip
    floor["drag"] = how.get("drag", 0.0)
    numbers = dict(zip(("friction", *LAW_NUMBERS), truth[4:].tolist(), strict=True)) | floor
    step = 1e-6
    beside = [spec.moving({**numbers, name: numbers[name] + step}, False)
              for name in ("friction", *LAW_NUMBERS)]  # fmt: skip
    launch = np.array([0.0, 0.0, *truth[:3], 0.0])
    states, slopes, differ = states_and_slopes(spec.moving(numbers, False), launch, times, beside)
    seen = judged(truth)
    assert np.all(np.abs(states[:3] - seen).max(axis=1) < 2e-5 * np.ptp(seen, axis=1).max())
    found = [*(slopes[:, :3, k].T for k in (VX, VY, SPIN, RADIUS)), *(differ[:, :3] / step)]
    for k, one in enumerate(found):
        by = 3e-3 * truth[k] * (np.arange(truth.size) == k)
        expected = (judged(truth + by) - judged(truth - by)) / (6e-3 * truth[k])
        assert np.abs(one - expected).max() < 5e-3 * np.abs(expected).max(), k


def test_a_puck_that_comes_to_rest_on_a_belt():
    track = film(2, even, belt=(0.3, 0.1), frames=250)
    result = pt.fit(track, PUCK, free=["friction", "belt_x", "belt_y"])
    assert result.complaints == ()
    for name, value in (("friction", 0.12), ("belt_x", 0.3), ("belt_y", 0.1)):
        assert near(result[name], value), (name, result[name])


FLOORS = {
    "uniform": {"law": even}, "uniform+drag": {"law": even, "drag": 0.4},
    "uniform+slope": {"law": even, "push": (0.2, 0.1)},
    "uniform+belt": {"law": even, "belt": (0.3, -0.2)},
    "uniform+stribeck": {"law": stribeck}, "uniform+two-valued": {"law": two_valued},
}  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("floor", FLOORS)
def test_which_floor_a_film_supports(floor: str):
    track = film(4, **FLOORS[floor], frames=110)
    result = pt.fit(track, PUCK, free="friction", laws=["floors"], keep_all=True)
    assert result.verdict.startswith(floor + " is "), (result.verdict, result.laws)


def drawn_floor(seed: int) -> tuple[str, float, pt.Track]:
    """A floor of each kind in turn, a radius, and a film whose angles can be followed."""
    rng, floor = np.random.default_rng([40, seed]), list(FLOORS)[seed % len(FLOORS)]
    radius, f, v = rng.uniform(0.02, 0.06), np.exp(rng.uniform(-2.8, -1.05)), rng.uniform(0.8, 2.2)
    spin, more, share = rng.choice([-1, 1]) * rng.uniform(0.3, 1.3) * v / radius, *rng.random(2)
    at = more * 2.0 * math.pi
    towards, how = np.array([math.cos(at), math.sin(at)]), {}
    rest, scale = f * rng.uniform(0.3, 1.2), rng.uniform(0.1, 0.6)
    if floor == "uniform+stribeck":
        law = lambda u: f + rest * np.exp(-u / scale)  # noqa: E731
    elif floor == "uniform+two-valued":
        law = lambda u: f + rest * np.clip(0.5 + (1.0 - u / (scale * v)) / 0.1, 0.0, 1.0)  # noqa: E731
    else:
        law = lambda u: f + 0.0 * u  # noqa: E731
    if floor == "uniform+drag":
        how["drag"] = 0.1 + 0.7 * share
    elif floor == "uniform+slope":
        how["push"] = tuple(G * min(0.003 + 0.037 * share, 0.5 * f) * towards)
    elif floor == "uniform+belt":
        how["belt"] = tuple((0.05 + 0.45 * share) * towards)
    lasts = v / (f * G) * (1.0 + 0.3 * abs(radius * spin / v)) * rng.uniform(0.7, 1.1)
    frames = max(int(rng.integers(80, 200)), int(lasts * abs(spin) / 1.5))
    t, noise = np.linspace(0.0, lasts, frames), (rng.uniform(1e-4, 5e-4), rng.uniform(2e-3, 8e-3))
    x, y, angle = slid(law, radius, (v, 0.0), spin, t, **how)
    place = np.stack([x, y], axis=1) + rng.normal(0.0, noise[0], (frames, 2))
    return floor, radius, pt.Track(t, place, angle + rng.normal(0.0, noise[1], frames), "film")


@pytest.mark.nightly
def test_the_floor_of_many_films_is_found_where_they_tell():
    """The right one of six where no other leaves as little but for 20 of χ²; one by chance."""
    told, wrong = 0, []
    for seed in range(120):
        floor, radius, track = drawn_floor(seed)
        result = pt.fit(track, pt.Puck(radius, height=0.0), free="friction", laws=list(FLOORS),
                        keep_all=True)  # fmt: skip
        left = {one.name: one.chi2 for one in result.laws}
        if floor == "uniform" or min(left[n] for n in left if n != floor) > left[floor] + 20.0:
            told += 1
            if not result.verdict.startswith(floor + " is "):
                wrong.append((seed, result.verdict))
    assert told > 70 and len(wrong) <= 1, wrong


@pytest.mark.thorough
def test_a_law_with_more_numbers_leaves_no_more_than_one_friction():
    """What is fitted again under the common noise is begun anew, and may not arrive."""
    track = film(6, lambda u: 0.15 + 0.15 * np.exp(-u / 0.2), v=1.5, spin=20.0, frames=129)
    laws = ["uniform", "uniform+stribeck", "uniform+hyperbola"]
    result = pt.fit(track, PUCK, free="friction", laws=laws, keep_all=True)
    left = {one.name: one.chi2 for one in result.laws}
    assert left["uniform+stribeck"] < left["uniform+hyperbola"] < 0.5 * left["uniform"]


@pytest.mark.parametrize("spin", [70.0, 84.0])
def test_a_step_that_parts_of_the_base_pass_at_other_moments_is_found(spin):
    """One slip for all of a base that spins leads a fit astray, to a law that seems to fit."""
    track = film(8, lambda u: np.clip(0.067 + 0.113 * (0.5 + (1.0 - u / 0.85) / 0.1), 0.067, 0.18),
                 v=2.45, spin=spin, frames=300)  # fmt: skip
    result = pt.fit(track, PUCK, free="friction", law="two-valued", keep_all=True)
    for name, value in (("friction", 0.067), ("friction_rest", 0.18), ("law_speed", 0.85)):
        assert near(result[name], value), (name, result[name])


@pytest.mark.parametrize(("how", "lost"), [({"drag": 0.6}, "friction"), ({}, "friction_rest")])
def test_a_law_whose_speed_ends_on_its_bound_is_not_determined(how, lost):
    """All slips of the film are far below, or above, the speed of such a law."""
    bounds = {"law_speed": (4.0, 9.0) if how else (1e-4, 0.02)}
    free = ["friction", "friction_rest", "law_speed"]
    result = pt.fit(film(7, even, frames=110, **how), PUCK, free=free, law="stribeck",
                    keep_all=True, bounds=bounds)  # fmt: skip
    assert not result["law_speed"].determined and not result[lost].determined
    assert any("law_speed is not determined" in text for text in result.blind)
    assert result.summary()["numbers"]["law_speed"]["determined"] is False


def test_what_is_wrong_with_floors_is_said():
    track = film(5, even, frames=60)
    for how, words in (
        ({"laws": ["uniform+mud"]}, "behind . may stand drag, air"),
        ({"law": "mud"}, "law must be one of stribeck"),
        ({"free": ["friction", "law_speed"]}, "name it"),
    ):  # fmt: skip
        with pytest.raises(pt.InputError, match=words):
            pt.fit(track, PUCK, **{"free": "friction", **how})
    blind = pt.Track(track.time, track.place, None, "blind")
    with pytest.raises(pt.InputError, match="film a mark"):
        pt.fit(blind, PUCK, free=["friction", "slope_x", "slope_y"])
