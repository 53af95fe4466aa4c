"""A scene of one puck is the same in both engines: alone, and beside a post that nothing meets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from golden.make_scene_ends import apart, ends_of
from random_scenes import draw

import puck_tables as pt
from puck_tables import Scene
from puck_tables.world import groups

POST = {"post": [{"point": [900.0, 900.0], "radius": 0.01}]}
BLOCK = 40


def varied(seed: int, folder: Path) -> dict[str, Any]:
    """A drawn scene, half of them with what only some floors and forces have."""
    scene = draw(seed, folder)
    rng = np.random.default_rng([seed, 8530])
    puck, floor = scene["puck"], scene["floor"]
    friction, weight = puck["friction"], 9.80665 * puck["mass"]
    kind = str(rng.choice(["", "", "", "", "patches", "drag", "lateral", "law", "direction"]))
    if kind == "patches":
        floor.pop("strips", None)
        floor["patch"] = [
            {"friction": 0.5 * friction, "centre": [1.0, 0.3], "radius": 0.4 + puck["radius"]},
            {"friction": 0.7 * friction, "corners": [[-3.0, -3.0], [-1.0, -3.0], [-1.0, -1.2]]},
        ]  # fmt: skip
    elif kind == "drag":
        scene.setdefault("drag", {})["quadratic"] = puck["mass"] * rng.uniform(0.0, 1.0)
    elif kind == "lateral":
        strength = 0.1 * friction * weight * rng.uniform(-1.0, 1.0)
        scene["lateral"] = {"strength": strength, "speed_exponent": 1.0, "spin_exponent": 0.0}
    elif kind in ("law", "direction"):
        floor.pop("strips", None)
        puck["height"] = 0.5 * puck.get("height", 0.0)
    if kind == "law":
        floor["law"] = {"kind": "stribeck", "static": friction, "kinetic": 0.7 * friction,
                        "speed": 0.3}  # fmt: skip
    elif kind == "direction" and "constraint" not in scene:
        floor.pop("turning", None)
        floor["orthotropic"] = {"friction": [0.6 * friction, friction], "direction": 0.4}
    return scene


@pytest.mark.parametrize(
    "first",
    [pytest.param(n, marks=[pytest.mark.thorough] * (n > 0)) for n in range(0, 400, BLOCK)],
)
def test_a_far_post_changes_nothing(first: int, tmp_path: Path):
    """It makes the scene one of several bodies; within three errors and what ``tol`` allows."""
    compared = 0
    for seed in range(first, first + BLOCK):
        alone = varied(seed, tmp_path)
        if "constraint" in alone and "turning" in alone["floor"]:
            continue  # refused among several bodies
        scene = Scene.from_tables(alone)
        now, before = ends_of(Scene.from_tables(alone | POST)), ends_of(scene)
        run = scene.simulate()
        before[:, 3] += scene.tol * run.speed_scale**2 / run.rate_scale
        assert apart(now, before).max() < 1.0, seed
        compared += 1
    assert compared > 0.7 * BLOCK


def test_pucks_that_never_press_are_not_sent_off_one_by_one(monkeypatch: pytest.MonkeyPatch):
    """Whatever acts on them: only groups leave compiled code."""
    monkeypatch.setattr(groups, "push_on", lambda *_: pytest.fail("a group was sent off"))
    rng = np.random.default_rng(8530)
    wall = pt.Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=0.8, friction=0.2)
    for _ in range(5):
        fast = pt.Launch(tuple(rng.normal(size=2).tolist()), float(rng.normal() * 30.0))
        slow = pt.Launch(tuple((0.1 * rng.normal(size=2)).tolist()), 0.0, (-0.5, 0.6))
        force = pt.Force(over_time=[[0.0, 0.0, 0.0], [0.2, 0.1, 0.05], [0.4, 0.0, 0.0]])
        pucks = [
            pt.Piece(0.04, 0.02, 0.3, launch=fast),
            pt.Piece(0.05, 0.0, 0.2, launch=slow, force=force),
        ]
        board = Scene(pucks=pucks, walls=[wall], floor=pt.Floor(0.1, float(rng.uniform(2.0, 4.0))))
        run = board.simulate()
        assert run.end == "at rest"
        assert run.energy_residual < 1e-9
