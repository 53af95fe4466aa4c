"""Floors that are no constant friction: slopes, belts, laws over slip speed; what a film supports.

Films are made by an integrator of its own, which sums friction over the points of a flat disc.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import puck_tables as pt

G, R = 9.80665, 0.04
PUCK = pt.Puck(R, height=0.0)
NOISE = (3e-4, 4e-3)
_X, _W = np.polynomial.legendre.leggauss(16)
_RHO = 0.5 * (_X + 1.0)
_ANGLE = (np.arange(40) + 0.5) * 2.0 * np.pi / 40
_AT = np.stack([np.outer(_RHO, np.cos(_ANGLE)), np.outer(_RHO, np.sin(_ANGLE))]).reshape(2, -1)
_SHARE = (np.outer(_W * _RHO, np.ones(40)) / 40).ravel()  # of the pressure on each point


def film(seed: int, law, push=(0.0, 0.0), belt=(0.0, 0.0), drag=0.0, v=1.6, spin=35.0, frames=150):
    """A film of a disc under friction law(u) on a floor that slopes or moves."""
    rng = np.random.default_rng(seed)
    belt, push = np.array(belt), np.array(push)

    def rates(_, y):
        along = y[3:5] - belt
        slip = along[:, None] + R * y[5] * np.stack([-_AT[1], _AT[0]])
        speed = np.hypot(*slip)
        force = -G * _SHARE * law(speed) / np.sqrt(speed**2 + 1e-6) * slip
        torque = R * (_AT[0] * force[1] - _AT[1] * force[0]).sum() / (0.5 * R * R)
        return [*y[3:], *(force.sum(axis=1) + push - drag * along), torque - drag * y[5]]

    t = np.arange(frames) / 120.0
    way = rng.uniform(0.0, 2.0 * math.pi)
    start = [0.0, 0.0, 0.0, v * math.cos(way), v * math.sin(way), spin]
    y = solve_ivp(rates, (0.0, t[-1]), start, "DOP853", t, rtol=1e-7, atol=1e-9).y
    place = y[:2].T + rng.normal(0.0, NOISE[0], (frames, 2))
    return pt.Track(t, place, y[2] + rng.normal(0.0, NOISE[1], frames), "film")


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


def test_a_law_with_more_numbers_leaves_no_more_than_one_friction():
    """What is fitted again under the common noise is begun anew, and may not arrive."""
    track = film(6, lambda u: 0.15 + 0.15 * np.exp(-u / 0.2), v=1.5, spin=20.0, frames=129)
    laws = ["uniform", "uniform+stribeck", "uniform+hyperbola"]
    result = pt.fit(track, PUCK, free="friction", laws=laws, keep_all=True)
    left = {one.name: one.chi2 for one in result.laws}
    assert left["uniform+stribeck"] < left["uniform+hyperbola"] < 0.5 * left["uniform"]


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
