"""Friction under a base on several frictions: against scans of the base, and closed answers."""

from __future__ import annotations

import math

import astride_judge
import numpy as np
import pytest

import puck_tables as pt
from puck_tables.kernels.base_friction import packed
from puck_tables.kernels.compile import kernel
from puck_tables.scene.base_balance import friction_on_floor
from puck_tables.scene.floor_map import PLACE_X, PLACE_Y, FloorMap
from puck_tables.scene.mixed_rest import mixed_yield

NO_PATCHES, NO_CORNERS = np.empty((0, 6)), np.empty((0, 2))


@kernel
def _friction(floor_map, ux, uy, w):
    return friction_on_floor(floor_map, ux, uy, w, 1.0)


def friction(floor_map: FloorMap, slip: tuple[float, float, float], x: float = 0.0, y: float = 0.0):
    """Of a base of radius 1 under a load of 1, against the puck: force and torque; and power."""
    there = floor_map.packed()
    there[PLACE_X], there[PLACE_Y] = x, y
    fx, fy, torque, power = _friction(there, *slip)
    return np.array([-fx, -fy, -torque]), power


def round_base(lever: float, inner: float = 0.0) -> np.ndarray:
    """``lever``: of the slope of the pressure over the force, as the judge has it."""
    base = pt.Base.annulus(1.0, inner) if inner > 0.0 else pt.Base.disc(1.0)
    return packed(base, 0.25 * lever * (1.0 + inner * inner))


def strips(borders, loads, lever=0.0, inner=0.0) -> FloorMap:
    base = round_base(lever, inner)
    return FloorMap(1.0, 0.0, np.array(borders), np.array(loads), NO_PATCHES, NO_CORNERS, base)


SLIPS = {
    "slides": (1.0, 0.4, 0.0), "turns little": (1.0, -0.3, 0.1),
    "slides and turns": (0.4, 0.9, 0.6),
    "centre of rotation on the rim": (0.6, 0.8, 1.0), "next to it": (0.6, 0.8, -1.0 + 1e-6),
    "centre on a border": (0.1, -0.2, 1.0), "turns": (0.0, 0.0, -1.0),
}  # fmt: skip
FLOORS = {
    "one": ([0.2], [0.3, 0.1]), "through the centre": ([0.0], [0.1, 0.5]),
    "several": ([-0.7, -0.1, 0.2, 0.95], [0.3, 0.1, 0.0, 0.6, 0.2]),
}  # fmt: skip


@pytest.mark.parametrize("floor", FLOORS)
@pytest.mark.parametrize(("lever", "inner"), [(0.0, 0.0), (0.5, 0.0), (0.4, 0.6)])
def test_strips_against_scans(floor, lever, inner):
    borders, loads = FLOORS[floor]
    for name, slip in SLIPS.items():
        found, power = friction(strips(borders, loads, lever, inner), slip)
        truth = astride_judge.friction(
            astride_judge.FloorMap(borders, loads), *slip, lever=lever, hole=inner
        )
        assert np.abs(found - truth).max() <= 3e-12, name
        assert power == pytest.approx(found @ slip, rel=1e-12)


CORNERS = np.array([[-0.5, -0.9], [1.4, -0.2], [0.1, 0.1], [0.3, 1.2]])


@pytest.mark.parametrize("lever", [0.0, 0.5])
@pytest.mark.parametrize(
    ("x", "y", "size"), [(0.5, -0.4, 0.7), (0.1, 0.2, 0.3), (-0.6, 0.9, 1.5), (0.3, 0.0, 0.7)]
)
def test_round_patches_against_scans(x, y, size, lever):
    floor_map = FloorMap(
        1.0, 0.0, np.array([-0.95]), np.array([0.2, 0.3]),
        np.array([[x, y, size, 0.0, 0.0, 0.05]]), NO_CORNERS, round_base(lever),
    )  # fmt: skip
    judge = astride_judge.FloorMap([-0.95], [0.2, 0.3], [(x, y, size, 0.05)])
    for name, slip in SLIPS.items():
        truth = astride_judge.friction(judge, *slip, lever=lever)
        assert np.abs(friction(floor_map, slip)[0] - truth).max() <= 3e-12, name


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (0.4, -0.3), (-0.8, 0.5), (0.1, 0.1)])
def test_polygons_against_scans(x, y):
    middle = 0.5 * (CORNERS.min(axis=0) + CORNERS.max(axis=0))
    reach = np.hypot(*(CORNERS - middle).T).max()
    floor_map = FloorMap(
        1.0, 0.0, np.empty(0), np.array([0.3]), np.array([[*middle, reach, 0.0, 4.0, 0.05]]),
        CORNERS, round_base(0.4),
    )  # fmt: skip
    judge = astride_judge.FloorMap([], [0.3], polygons=[(CORNERS - (x, y), 0.05)])
    for name, slip in SLIPS.items():
        truth = astride_judge.friction(judge, *slip, lever=0.4)
        assert np.abs(friction(floor_map, slip, x, y)[0] - truth).max() <= 3e-12, name


def test_a_spin_over_a_border_is_pushed_along_it():
    """The difference of the frictions over π; with f 0.78 and 0.67 and g 10: 0.3501 m/s²."""
    found, _ = friction(strips([0.0], [0.78, 0.67]), (0.0, 0.0, 1.0))
    assert 10.0 * np.abs(found[:2]) == pytest.approx([0.0, 0.11 * 10.0 / math.pi], abs=1e-14)
    assert round(10.0 * abs(found[1]), 4) == 0.3501
    assert found[2] == pytest.approx(2.0 / 3.0 * 0.725, rel=1e-14)


@pytest.mark.parametrize("place", [-0.8, 0.0, 0.3])
def test_a_slide_meets_every_part_and_is_turned_by_their_offset(place):
    """F = Σ f_i A_i σ; T of a slide along the border from the first moment of a segment."""
    beyond = (math.acos(place) - place * math.sqrt(1.0 - place * place)) / math.pi
    moment = 2.0 / 3.0 * (1.0 - place * place) ** 1.5 / math.pi
    for slip in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)):
        found, _ = friction(strips([place], [0.3, 0.1]), slip)
        force = 0.3 * (1.0 - beyond) + 0.1 * beyond
        assert found[:2] == pytest.approx(force * np.array(slip[:2]), abs=1e-14)
        assert found[2] == pytest.approx(slip[1] * (0.1 - 0.3) * moment, abs=1e-14)


def test_one_friction_is_that_of_the_closed_forms():
    """Salnikova, Treschev, Gallyamov 2012, table 6.1 at φ = π/4, δ = 1."""
    q = (45.0 * math.pi) ** 2 + 16.0**2
    found, _ = friction(strips([0.1], [1.0, 1.0], lever=1.0), (1.0, 0.0, 1.0))
    parallel, across = 5400.0 * math.sqrt(2.0) * math.pi / q, 7680.0 / q
    spin = 16.0 * math.sqrt(2.0) / (9.0 * math.pi) * ((45.0 * math.pi) ** 2 - 2.0 * 32.0**2) / q
    root = math.sqrt(0.5)
    assert found == pytest.approx([root * parallel, 0.5 * across, 0.5 * root * spin], rel=1e-13)


@kernel
def _yield(floor_map, most, fx, fy, torque, guided):
    return mixed_yield(floor_map, most, 1.0, 1.0, fx, fy, torque, guided)


@pytest.mark.parametrize("guided", [False, True])
@pytest.mark.parametrize("lever", [0.0, 0.4])
def test_what_friction_takes_up_in_a_slip_is_held_only_just(guided, lever):
    """Of a guided puck the guide bears what is across, but the load tilts by that, too."""
    borders, loads = FLOORS["several"]
    for ahead, turns in ((0.5, -1.9), (2.3, -0.6), (-1.2, 0.4), (0.2, 1.1)):
        east, north = math.cos(ahead), math.sin(ahead)
        slip = east * math.cos(turns), north * math.cos(turns), math.sin(turns)
        fx, fy, torque = astride_judge.friction(
            astride_judge.FloorMap(borders, loads), *slip, lever=lever, hole=0.0
        )
        if guided:
            along = fx * east + fy * north
            fx, fy = along * east, along * north
        there = strips(borders, loads, lever).packed()
        for share, excess in ((1.0, 0.0), (0.99, -0.01), (1.01, 0.01)):
            over, *way = _yield(there, max(loads), share * fx, share * fy, share * torque, guided)
            power = fx * slip[0] + fy * slip[1] + torque * slip[2]
            assert over == pytest.approx(
                excess * power, abs=3e-12 if share == 1.0 else 2e-3 * power
            )
        over, *way = _yield(there, max(loads), fx, fy, torque, guided)
        np.testing.assert_allclose(way, slip, atol=1e-6)
