"""A scene of one puck is the same alone and beside a post that nothing meets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from golden.make_scene_ends import apart, ends_of
from random_scenes import draw
from rarely import thorough

import puck_tables as pt
from puck_tables import Scene
from puck_tables.world import groups

POST = {"post": [{"point": [900.0, 900.0], "radius": 0.01}]}
BLOCK = 4


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
    [
        pytest.param(n, marks=[pytest.mark.thorough] * (n > 0) + [pytest.mark.nightly] * (n >= 20))
        for n in range(0, 160, BLOCK)
    ],
)
def test_a_far_post_changes_nothing(first: int, tmp_path: Path):
    """Within three errors and what ``tol`` allows."""
    for seed in range(first, first + BLOCK):
        alone = varied(seed, tmp_path)
        scene = Scene.from_tables(alone)
        now, before = ends_of(Scene.from_tables(alone | POST)), ends_of(scene)
        run = scene.simulate()
        before[:, 3] += scene.tol * run.speed_scale**2 / run.rate_scale
        assert apart(now, before).max() < 1.0, seed


def told(run: pt.results.Run, length: float) -> list[tuple[Any, ...]]:
    """The events of a run but those at walls and at its start."""
    return [
        (event.what, event.partner, event.time, event.x / length, event.y / length)
        for event in run.events
        if event.what not in ("impact", "contact") and event.time > 0.0
    ]


@pytest.mark.parametrize(
    "first",
    [
        0,
        thorough(9),
        *[pytest.param(n, marks=[pytest.mark.thorough, pytest.mark.nightly]) for n in (60, 90)],
    ],
)
def test_a_run_gives_the_same_beside_a_far_post(first: int, tmp_path: Path):
    """Its columns, end, stop, events that no wall makes; also without a time."""
    ends = set()
    for seed in range(first, first + (5 if first == 0 else 30)):
        tables = varied(seed, tmp_path)
        tables.pop("wall", None)
        beside = Scene.from_tables(tables | POST)
        if not {"slope", "law", "strips"} & {*tables["floor"]} and "force" not in tables:
            untimed = {name: one for name, one in tables.items() if name != "time"}
            try:
                Scene.from_tables(untimed).simulate()
                tables, beside = untimed, Scene.from_tables(untimed | POST)
            except pt.PuckError:  # it never comes to rest
                pass
        one, two = Scene.from_tables(tables).simulate(), beside.simulate()
        unit = one.speed_scale / one.rate_scale
        length, far = one.speed_scale * unit, 1e-6 + 3.0 * (one.error_estimate + two.error_estimate)
        assert (one.end, set(one.columns)) == (two.end, set(two.columns)), seed
        assert abs(one.end_time - two.end_time) < far * unit
        if one.end != "over the edge":
            np.testing.assert_allclose(two.stop_times, one.stop_times, atol=far * unit)
        for name in set(one.columns) - {"carried"}:
            scale = max(np.abs(one.columns[name]).max(), 1e-2)
            gaps = np.append(one.columns[name], one.last[name]) - [
                *two.columns[name],
                two.last[name],
            ]
            assert np.abs(gaps).max() < 1e-5 * scale, (seed, name)
        both = told(one, length), told(two, length)
        assert [event[:2] for event in both[0]] == [event[:2] for event in both[1]], seed
        for before, now in zip(*both, strict=True):
            np.testing.assert_allclose(now[2:], before[2:], atol=max(far, 1e-6) * max(unit, 1.0))
        ends.add(one.end)
    assert len(ends) > 1


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
            pt.Puck(0.04, 0.02, 0.3, launch=fast),
            pt.Puck(0.05, 0.0, 0.2, launch=slow, force=force),
        ]
        board = Scene(pucks=pucks, walls=[wall], floor=pt.Floor(0.1, float(rng.uniform(2.0, 4.0))))
        run = board.simulate()
        assert run.end == "at rest"
        assert run.energy_residual < 1e-9
