"""Films with impacts on walls: slides by scipy, the impact by its law written out here."""

from __future__ import annotations

import math

import film_judge
import numpy as np
import pytest
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


def test_an_impact_not_asked_for_is_noticed():
    whole = pt.fit(film(bank(0.6), 2), KNOWN, noise=NOISE)
    assert whole.complaints or sum(whole.left_out[0]) > 50


def test_outliers_are_no_impacts():
    true = film_judge.path((1.9, 0.6), 60.0, DECEL, DELTA, RADIUS, _LONG)
    for seed in range(3):
        found = pt.fit(film(true, seed, wrong=0.05), KNOWN, impacts=True)
        assert found.impacts == () and len(found.launches) == 1


def test_errors_of_restitution_are_those_that_repeated_films_show():
    true, pulls = bank(0.3347), []
    for seed in range(12):
        (impact,) = pt.fit(film(true, 50 + seed), KNOWN, impacts=True).impacts
        pulls.append((impact.restitution.value - RESTITUTION) / impact.restitution.error)
    assert 0.4 < math.sqrt(np.mean(np.square(pulls))) < 1.7
