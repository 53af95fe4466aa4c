"""Friction laws over the slip speed beside strips and patches: known answers, refusals."""

import math
import tomllib
from typing import Any

import numpy as np
import pytest
from scenes import end_of

import puck_tables as pt
from puck_tables.scene.library import as_toml
from puck_tables.world.floor_forces import friction_at
from puck_tables.world.plan import plan_of

G = 9.80665
ICE = pt.StribeckLaw(0.3, 0.1, speed=0.3)
STEEP = pt.CurlingLaw(0.02, 0.1, 0.05)
LAUNCH = pt.Launch((1.0, 0.2), spin=10.0)
FAST = pt.Launch((300.0, 0.0))  # up to which slip laws are tabulated
PUCKS: dict[str, dict[str, Any]] = {
    "round": {"radius": 0.05, "height": 0.03},
    "box": {"base": "box:0.1x0.06", "height": 0.03},
}


def ends(floor: pt.Floor, name: str, launch: pt.Launch = LAUNCH) -> np.ndarray:
    return end_of(pt.Puck(**PUCKS[name], friction=0.2), floor, launch)


@pytest.mark.parametrize("name", PUCKS)
def test_a_law_that_is_constant_is_the_number(name: str) -> None:
    points = [[0.0, 0.1], [50.0, 0.1]]
    two = [pt.Floor(strips=pt.Strips((0.1,), (0.2, one), direction=0.2)) for one in (0.1, points)]
    assert np.abs(np.subtract(*(ends(floor, name) for floor in two))).max() < 3e-9
    hook = [(0.1, -0.1), (0.3, -0.1), (0.2, 0.02), (0.3, 0.2), (0.1, 0.2)]
    two = [pt.Floor(patches=[pt.Patch(one, corners=hook)]) for one in (0.1, points)]
    assert np.abs(np.subtract(*(ends(floor, name) for floor in two))).max() < 3e-9


def test_mirror_images() -> None:
    found = []
    for side in (1.0, -1.0):
        floor = pt.Floor(
            strips=pt.Strips((0.1,), (ICE, 0.2), direction=side * 0.4),
            patches=[pt.Patch(STEEP, (0.25, side * 0.05), 0.05)],
        )
        end = ends(floor, "box", pt.Launch((1.0, side * 0.2), spin=side * 10.0))
        found.append(end * [1.0, 1.0, side, side])
    assert np.abs(np.subtract(*found)).max() < 3e-9


def drawn(seed: int, size: float) -> np.ndarray:
    """States with the instantaneous centre in the base, beside it and far away."""
    rng = np.random.default_rng(seed)
    states = rng.normal(size=(24, 6)) * [size, size, 2.0, 1.0, 1.0, 1.0]
    states[:, 5] *= np.tile([200.0, 20.0, 1.0], 8)
    states[0, 5] = 0.0
    return states


@pytest.mark.parametrize("patch", [None, (0.06, 0.03, 0.05), (0.0, 0.0, 0.02)])
def test_a_viscous_stretch_is_told_by_its_moments(patch: Any) -> None:
    """Where f grows as the slip speed, forces are integrals of 1, x, y over a part of the base."""
    viscous, length, width, f = pt.PowerLaw(0.4, 1.0), 0.2, 0.1, 0.4
    states = drawn(1, 0.04)
    if patch is None:
        states[:, 2] = 0.0
        floor = pt.Floor(strips=pt.Strips((0.03,), (viscous, 0.0)))
    else:
        states[:, :2] *= 0.2
        floor = pt.Floor(patches=[pt.Patch(viscous, patch[:2], patch[2])])
    body = pt.Puck(base="box:0.2x0.1", friction=0.0, gravity=1.0, mass=1.0)
    if patch is not None and patch[0] > 0.0:  # the patch lies inside
        body = pt.Puck(base="disc:0.3", friction=0.0, gravity=1.0, mass=1.0)
    found = friction_at(pt.Scene(body, floor, FAST, time=1.0), states)
    for (x, y, _, vx, vy, w), forces in zip(states.tolist(), found, strict=True):
        if patch is None:
            right = min(max(0.03 - x, -0.5 * length), 0.5 * length)
            wide = right + 0.5 * length
            share = wide / length
            mx, my = 0.5 * (right - 0.5 * length), 0.0
            square = wide * wide / 12.0 + width * width / 12.0
        else:
            area = math.pi * 0.09 if patch[0] > 0.0 else length * width
            share = math.pi * patch[2] ** 2 / area
            mx, my, square = patch[0] - x, patch[1] - y, 0.5 * patch[2] ** 2
        ux, uy = vx - w * my, vy + w * mx
        force = -f * share * np.array([ux, uy])
        torque = mx * force[1] - my * force[0] - f * share * square * w
        scale = f * share * (math.hypot(vx, vy) + 0.3 * abs(w)) + 1e-300
        assert np.abs(forces[:2] - force).max() < 1e-9 * scale
        assert abs(forces[2] - torque) < 1e-9 * scale * 0.3


def test_what_holds_at_rest_is_the_law_at_slip_zero() -> None:
    for off, rests in ((-1e-6, True), (1e-6, False)):
        slope = math.atan(0.25) + off  # the mean of 0.3 and 0.2 under halves of the box
        floor = pt.Floor(slope=slope, strips=pt.Strips((0.0,), (ICE, 0.2)))
        run = pt.Scene(pt.Puck(base="box:0.1x0.06"), floor, time=0.3).simulate([0.0])
        assert (run.end == "at rest") == rests


def test_it_stands_in_a_file() -> None:
    text = """
[puck]
base = "box:0.1x0.06"
[floor.strips]
borders = [0.1]
friction = [{kind = "stribeck", static = 0.3, kinetic = 0.1, speed = 0.3}, 0.2]
[[floor.patch]]
friction = [[0.0, 0.1], [5.0, 0.2]]
centre = [0.3, 0.0]
radius = 0.05
[launch]
velocity = [1.0, 0.2]
spin = 10.0
"""
    scene = pt.Scene.from_tables(tomllib.loads(text))
    assert scene == pt.Scene.from_tables(tomllib.loads(as_toml(scene)))
    patch = pt.Patch([[0.0, 0.1], [5.0, 0.2]], (0.3, 0.0), 0.05)
    floor = pt.Floor(strips=pt.Strips((0.1,), (ICE, 0.2)), patches=[patch])
    assert scene == pt.Scene(pt.Puck(base="box:0.1x0.06"), floor, LAUNCH)
    run = scene.at({"floor.strips.friction[0].static": 0.5}).simulate([0.0])
    assert run.scene.floor.strips.friction[0].static == 0.5
    assert "by slip speed, floor.strips.friction[0], floor.patch[0].friction" in str(run)
    assert "summed over every base wherever it lies" in plan_of(scene)[1]


def test_what_is_not_known_is_refused() -> None:
    strips = pt.Strips((0.1,), (ICE, 0.2))
    with pytest.raises(pt.InputError, match="strips say all friction of the floor"):
        pt.Scene(pt.Puck(0.05), pt.Floor(law=ICE, strips=strips))
    with pytest.raises(pt.InputError, match="under uniform pressure only"):
        pt.Scene(pt.Puck(0.05, pressure="hertz"), pt.Floor(strips=strips))
    with pytest.raises(pt.InputError, match=r"patch\[0\].friction: each row must be two numbers"):
        pt.Scene(pt.Puck(0.05), pt.Floor(patches=[pt.Patch([[0.0, 0.1, 1.0]], radius=1.0)]))
    with pytest.raises(pt.InputError, match=r"strips.friction\[1\] = 'wet'"):
        pt.Scene(pt.Puck(0.05), pt.Floor(strips=pt.Strips((0.1,), (0.2, "wet"))))
    with pytest.raises(pt.InputError, match=r"strips.friction\[0\].kind"):
        pt.Scene(pt.Puck(0.05), pt.Floor(strips=pt.Strips((0.1,), ({"kind": "wet"}, 0.2))))
    short = pt.Floor(strips=pt.Strips((0.1,), ([[0.0, 0.1], [0.5, 0.2]], 0.2)))
    with pytest.raises(pt.InputError, match=r"strips.friction\[0\] goes \(0.5 m/s\)"):
        pt.Scene(pt.Puck(0.05), short, LAUNCH).simulate()
    with pytest.raises(pt.InputError, match="is 0 at slip zero"):
        viscous = pt.Patch(pt.PowerLaw(0.4, 1.0), radius=0.5)
        pt.Scene(pt.Puck(0.05), pt.Floor(patches=[viscous]), LAUNCH).simulate()
