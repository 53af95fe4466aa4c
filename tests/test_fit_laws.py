"""Pressure laws are told apart; pucks of other laws, heights and spreads of mass are fitted.

The truth comes from motions integrated to 1e-9 by the package's own ``states``, which other tests
judge against scipy and mpmath: what is tried here is the choice between laws.
"""

from __future__ import annotations

import numpy as np
import pytest
from rarely import few

import puck_tables as pt

LAWS = ("uniform", "hertz", "annulus:0.8", "ring")
NOISE = (0.3e-3, 5e-3)
TIMES = np.arange(200) / 120.0


def film(puck: pt.Puck, seed: int, speed: float = 2.0, spin: float = 50.0) -> pt.Track:
    rng = np.random.default_rng(seed)
    path = puck.states((speed, 0.3), spin, TIMES)
    place = np.stack([path.x, path.y], axis=1) + NOISE[0] * rng.normal(size=(TIMES.size, 2))
    return pt.Track(TIMES, place, path.orientation + NOISE[1] * rng.normal(size=TIMES.size))


def puck_of(law: str) -> pt.Puck:
    return pt.Puck(radius=0.04, height=0.02, friction=0.2, pressure=law)


@pytest.mark.parametrize("law", ["hertz", "annulus:0.8"])
def test_the_law_of_a_film_is_chosen(law):
    others = [law, "uniform"]
    found = pt.fit(film(puck_of(law), 1), pt.Puck(radius=0.04, pressure=law), laws=others)
    best, second = found.laws
    assert best.name == law and best.weight > 0.999
    assert second.chi2 > best.chi2 + 100.0
    assert found["friction"].value == pytest.approx(0.2, abs=4.0 * found["friction"].error)


@pytest.mark.nightly
@pytest.mark.parametrize("law", LAWS)
def test_the_law_of_many_films_is_chosen(law):
    right = 0
    for seed in range(10):
        found = pt.fit(film(puck_of(law), seed), pt.Puck(radius=0.04), laws=LAWS)
        right += found.laws[0].name == law
    assert right == 10


@pytest.mark.thorough
@pytest.mark.parametrize(("law", "words"), few(1, [
    ("annulus:0.8", "outside 0.8 r alone"), ("hertz", "as hertz"), ("ring", "as ring"),
]))  # fmt: skip
def test_another_pressure_is_named_where_uniform_does_not_fit(law, words):
    """A slope, a radius or air were blamed for it."""
    track = film(puck_of(law), 1)
    found = pt.fit(track, pt.Puck(radius=0.04))
    assert found.complaints and words in found.misfit.split("; or ")[0]
    name, _, free = found.misfit.split("--pressure ")[1].split(")")[0].partition(" --free ")
    known = pt.Puck(radius=0.04, pressure=name)
    found = pt.fit(track, known, free=free.split(",") if free else None)
    assert not found.complaints
    assert found["friction"].value == pytest.approx(0.2, abs=4.0 * found["friction"].error)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("puck", "known", "free"),
    [
        (pt.Puck(radius=0.03, height=0.04, friction=0.6), pt.Puck(radius=0.03), None),
        (
            pt.Puck(radius=0.04, height=0.02, friction=0.2, gyration=0.8), pt.Puck(radius=0.04),
            ("friction", "delta", "gyration"),
        ),
        (
            puck_of("annulus:0.6"), pt.Puck(radius=0.04, pressure="annulus:0.8"),
            ("friction", "delta", "inner"),
        ),
    ],
    ids=["tall", "gyration", "inner"],
)  # fmt: skip
def test_pucks_of_other_kinds_are_found(puck, known, free):
    found = pt.fit(film(puck, 3), known, free=free)
    truth = {
        "friction": puck.friction, "delta": puck.delta, "gyration": puck.gyration, "inner": 0.6,
    }  # fmt: skip
    for name in free or ("friction", "delta"):
        number = found[name]
        assert abs(number.value - truth[name]) < 4.5 * number.error, name
        assert number.error < 0.02 * truth[name], name
    assert found.complaints == ()
    assert found.puck.delta == pytest.approx(found["delta"].value)
