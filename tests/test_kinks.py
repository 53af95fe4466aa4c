"""When friction bends next under a base on several frictions, and the graded time between."""

from __future__ import annotations

import math

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import SPIN, VX, X, Y
from puck_tables.scene.grading import between, paced, powers_of, towards_stop
from puck_tables.scene.ingredients import Surface
from puck_tables.scene.kinks import next_kink
from puck_tables.scene.regions import regions_of

STILL = Surface(0.0, 0.0, 0.0, 0.0, 0.0)
RADIUS, V, A, W = 0.1, 1.0, -0.5, 40.0


def foreseen(
    floor: pt.Floor, place: tuple[float, float], spin: float, pressure: str = "uniform"
) -> float:
    """In what time, of a puck at V along x that slows down by A."""
    puck = pt.Puck(RADIUS, friction=0.2, pressure=pressure)
    ground = regions_of(pt.Scene(puck, floor)).ground
    y, first = np.zeros(SIZE), np.zeros(SIZE)
    y[X], y[Y] = place
    y[VX], y[SPIN] = V, spin
    first[X], first[VX] = V, A
    return float(next_kink(ground, RADIUS, STILL, y, first, 0.0))


def after(way: float) -> float:
    """The time until so much of the way is done."""
    return (-V + math.sqrt(V * V + 2.0 * A * way)) / A


STRIPS = pt.Floor(strips=pt.Strips((0.0,), (0.2, 0.1)))
DISC = pt.Floor(patches=[pt.Patch(0.1, (0.0, 0.0), 0.3)])
SQUARE = pt.Floor(patches=[pt.Patch(0.1, corners=[(0, -0.3), (0.6, -0.3), (0.6, 0.3), (0, 0.3)])])


@pytest.mark.parametrize(
    ("floor", "place", "spin", "due"),
    [
        (STRIPS, (-0.05, 0.0), 0.0, after(0.15)),  # the rim leaves
        (STRIPS, (-0.25, 0.0), 0.0, after(0.15)),  # the rim comes
        (DISC, (-0.25, 0.0), 0.0, after(0.05)),  # the rim is all within
        (DISC, (0.25, 0.0), 0.0, after(0.15)),
        (SQUARE, (-0.05, 0.0), 0.0, after(0.15)),
        (SQUARE, (-0.25, 0.3), 0.0, after(0.15)),  # a corner
    ],
)
def test_the_rim_meets_a_border(floor: pt.Floor, place, spin: float, due: float):
    assert foreseen(floor, place, spin) == pytest.approx(due, rel=2e-5)


@pytest.mark.parametrize(
    ("floor", "place", "way"),
    [
        (STRIPS, (-0.09, 0.0), 0.04),  # its rim comes
        (STRIPS, (-0.02, 0.0), 0.07),  # and leaves
        (DISC, (-0.38, 0.0), 0.03),
        (SQUARE, (-0.09, 0.0), 0.04),
        (SQUARE, (-0.09, 0.3), 0.04),  # a corner
    ],
)
def test_the_rim_of_a_hole_meets_a_border(floor: pt.Floor, place, way: float):
    assert foreseen(floor, place, 0.0, "annulus:0.5") == pytest.approx(after(way), rel=2e-5)


def test_the_centre_of_rotation_passes_a_border():
    """At (x, y + v/ω): it goes along with the centre, as v/ω gets less."""
    border = pt.Floor(strips=pt.Strips((0.01,), (0.2, 0.1)))
    assert foreseen(border, (0.0, 0.0), W) == pytest.approx(0.01 / V, rel=2e-5)
    assert foreseen(border, (0.02, 0.0), W) > 0.05  # it is past it: the rim leaves later
    beside = V / (1.1 * RADIUS)  # by a tenth of a radius of the base
    assert foreseen(border, (0.0, 0.0), beside) < 0.03 < foreseen(border, (0.0, 0.0), 0.5 * beside)


def test_both_ends_of_a_graded_time_are_smooth():
    """From kink to kink in paces: steps meet, and pass the share 3u² − 2u³."""
    whole, pace, since, u = 0.7, 0.09, 0.0, 0.0
    while since < whole:
        length = paced(since, whole - since, pace)
        place, bend = between(since, whole - since, length)
        assert place == pytest.approx(u, abs=1e-8)
        one, two, three, four = powers_of((place, bend))
        assert one + two + three + four == pytest.approx(1.0)
        half = place + 0.5 * bend
        passed = whole * (3.0 * half**2 - 2.0 * half**3) - since
        middle = length * (0.5 * one + 0.25 * two + 0.125 * three + 0.0625 * four)
        assert middle == pytest.approx(passed, rel=1e-7)
        since, u = since + length, u + bend
    assert since == pytest.approx(whole)


def test_a_step_towards_a_stop_takes_its_share():
    place, bend = towards_stop(0.6)
    assert (1.0 - bend) ** 4 == pytest.approx(0.4)
    assert sum(powers_of((place, bend))) == pytest.approx(1.0)
