"""Friction under other pressures on several frictions: against circles, and scenes with them."""

from __future__ import annotations

import math

import numpy as np
import pressure_judge
import pytest
from rarely import thorough
from test_astride_profile import FLOORS as PROFILED
from test_astride_profile import disc, strips

import puck_tables as pt
from puck_tables.world.floor_forces import friction_at

FLOORS = {name: PROFILED[name] for name in ("strips", "round", "polygon")}
LAWS = {
    "ring": (None, 0.5, ()),
    "hertz": (lambda _, short: 1.5 * math.sqrt(short * (2.0 - short)), 0.2, ()),
    "galin": (lambda _, short: 0.5 / math.sqrt(short * (2.0 - short)), 1.0 / 3.0, ()),
}
SLIPS = [
    (1.0, 0.4, 0.0), (0.4, 0.9, -0.6), (0.3, -0.2, 0.8), (0.6, 0.8, 0.999), (0.0, 0.0, 1.0),
]  # fmt: skip


def found(pressure: str, floor: pt.Floor, slip: tuple[float, float, float], height: float):
    puck = pt.Puck(1.0, height=height, friction=0.3, gravity=1.0, pressure=pressure)
    state = np.array([[0.0, 0.0, 0.0, *slip]])
    return -friction_at(pt.Scene(puck, floor), state)[0]


@pytest.mark.parametrize(
    ("pressure", "floor"),
    [("ring", "strips"), ("hertz", "round"), ("galin", "polygon"),
     *(thorough("ring", floor) for floor in ("round", "polygon"))],
)  # fmt: skip
def test_resultants_against_circles(pressure, floor):
    law, square, bends = LAWS[pressure]
    floor_map, surface = FLOORS[floor]
    for slip in SLIPS if pressure == "ring" else SLIPS[1:4]:
        truth = pressure_judge.friction(floor_map, slip, law, 0.5 * 0.8, square, bends)
        assert np.abs(found(pressure, surface, slip, 0.8) - truth).max() <= 1e-10, slip


@pytest.mark.thorough
@pytest.mark.parametrize("pressure", ["hertz", "galin"])
def test_a_centre_of_rotation_anywhere(pressure):
    """Far, on a border, beside one, on the rim; patches within the base and most of it."""
    law, square, bends = LAWS[pressure]
    rounds = [(0.2, -0.1, 0.5), (0.1, 0.05, 1.0), (0.0, 0.3, 0.4), (0.05, 0.0, 0.8)]
    floors = [*FLOORS.values(), *(disc(*one) for one in rounds)]
    slips = [
        (1.0, 0.4, 0.0), (1.0, 0.3, 0.05), (0.3, -0.4, 1.0), (0.1, 0.4 - 1e-7, -1.0),
        (0.0, 0.0, 1.0), (0.7, 0.7, -0.97), (0.6, 0.8, -1.0), (0.0, 0.7, 1.0),
    ]  # fmt: skip
    for floor_map, surface in floors:
        for slip in slips:
            also = (*bends, 0.5, math.hypot(0.4, 0.1))
            truth = pressure_judge.friction(floor_map, slip, law, 0.5 * 0.8, square, also)
            assert np.abs(found(pressure, surface, slip, 0.8) - truth).max() <= 2e-11, slip


@pytest.mark.parametrize("pressure, within", [("hertz", 1e-10), ("galin", 1e-8)])
@pytest.mark.parametrize("place", [0.0, 0.3])
def test_a_centre_of_rotation_where_a_border_meets_the_rim(place, pressure, within):
    """And beside that, and on a border through the centre of the base."""
    law, square, bends = LAWS[pressure]
    floor_map, surface = strips([place], [0.3, 0.1])
    end = math.sqrt(1.0 - place * place)
    for x, y in ((place, end), (place + 1e-4, end - 1e-4), (place - 1e-3, end + 2e-3), (0.0, 0.5)):
        slip = (y, -x, 1.0)
        truth = pressure_judge.friction(floor_map, slip, law, 0.5 * 0.8, square, bends)
        assert np.abs(found(pressure, surface, slip, 0.8) - truth).max() <= within, slip


def test_a_patch_that_touches_the_rim_from_inside():
    """Where Galin's pressure has no bound."""
    floor_map, surface = disc(0.6, 0.0, 0.4)
    law, square, bends = LAWS["galin"]
    for slip in SLIPS[1:3]:
        truth = pressure_judge.friction(floor_map, slip, law, 0.5 * 0.8, square, bends)
        assert np.abs(found("galin", surface, slip, 0.8) - truth).max() <= 1e-9, slip


@pytest.mark.parametrize("pressure", LAWS)
def test_a_border_between_equal_frictions_is_none(pressure):
    puck = pt.Puck(0.04, height=0.02, friction=0.2, mass=0.2, pressure=pressure)
    launch = pt.Launch((1.2, 0.1), 30.0)
    ends = [
        pt.Scene(puck, pt.Floor(slope=0.02, strips=one), launch, tol=1e-7).simulate([0.0])
        for one in (None, pt.Strips((0.15,), (0.2, 0.2)))
    ]
    unit = ends[0].speed_scale ** 2 / ends[0].rate_scale
    assert abs(ends[1].last["x"] - ends[0].last["x"]) <= 1e-7 * unit
    assert [e.what for e in ends[1].events] == ["entry", "exit", "stick"]
    assert ends[1].energy_residual < 1e-8


@pytest.mark.parametrize("pressure", ["hertz", "galin"])
def test_a_patch_that_reaches_from_the_centre_to_the_rim(pressure):
    """It touches the rim to the last bit: the limit of those that are a little smaller."""
    close, touching = (
        found(pressure, pt.Floor(patches=[pt.Patch(0.05, (0.5, 0.0), r)]), SLIPS[1], 0.8)
        for r in (0.5 - 1e-9, 0.5)
    )
    np.testing.assert_allclose(touching, close, atol=1e-8)


@pytest.mark.parametrize("pressure", ["uniform", *LAWS, "profile"])
def test_a_border_that_touches_the_rim_but_for_rounding(pressure):
    """A strip, a round patch from inside and outside, a corner: friction as close beside that."""
    law = pt.profile_law([0.0, 0.5, 1.0], [1.0, 0.8, 0.2]) if pressure == "profile" else pressure
    puck = pt.Puck(1.0, height=0.5, friction=0.3, gravity=1.0, pressure=law)
    rng = np.random.default_rng(5)
    corners = [(0.3, 0.2), (9.0, -3.0), (9.0, 6.0)]
    floors = {
        (0.0, 0.0, 1.0): pt.Floor(strips=pt.Strips((0.0,), (0.3, 0.1))),
        (0.3, 0.2, 1.5): pt.Floor(patches=[pt.Patch(0.05, (0.3, 0.2), 2.5)]),
        (0.3, 0.2, 3.5): pt.Floor(patches=[pt.Patch(0.05, (0.3, 0.2), 2.5)]),
        (*corners[0], 1.0): pt.Floor(patches=[pt.Patch(0.05, corners=corners)]),
    }
    for (x, y, distance), floor in floors.items():
        angle, slip = rng.uniform(0.0, 2.0 * np.pi, 3000), rng.normal(size=(3000, 3))
        angle = np.where(angle < np.pi, 0.0, np.pi) if floor.strips else angle

        def states(apart, angle=angle, slip=slip, x=x, y=y):
            place = x + apart * np.cos(angle), y + apart * np.sin(angle), 0.0 * angle
            return np.concatenate([np.stack(place, axis=-1), slip], axis=-1)

        at = friction_at(
            pt.Scene(puck, floor), states(distance + rng.integers(-2, 3, 3000) * 1e-16)
        )
        beside = friction_at(pt.Scene(puck, floor), states(distance - 1e-9))
        assert np.abs(at - beside).max() < (1e-4 if pressure == "ring" else 1e-7), distance
