"""Walls, strips and edges with answers in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pucks import simulate
from scenes import simulate_scene
from test_scene_known import G, event, scene

WALL = {"point": [2.0, 0.0], "normal": [-1.0, 0.0]}


def test_a_smooth_hard_wall_is_a_mirror() -> None:
    launch = {"velocity": [4.0, 1.0], "spin": 3.0}
    run = simulate_scene(scene(wall=[WALL], launch=launch, puck={"height": 2.0}))
    hit = event(run, "impact")
    times = np.array([0.05, 0.6, 0.9]) * run.end_time
    late = times > hit
    assert late.any() and not late.all()
    run = simulate_scene(scene(wall=[WALL], launch=launch, puck={"height": 2.0}), times)
    free = simulate((4.0, 1.0), 3.0, delta=0.8, decel=0.2 * G, times=times, tol=1e-12)
    before = ~late
    assert np.abs(run.columns["x"] - free.x)[before].max() <= 1e-9
    # after it a puck that spins the same way, not the mirror's: only without height a mirror image
    flat = simulate_scene(scene(wall=[WALL], launch=launch), times)
    free = simulate((4.0, 1.0), 3.0, delta=0.0, decel=0.2 * G, times=times, tol=1e-12)
    assert np.abs(flat.columns["x"] - np.where(late, 2.0 - free.x, free.x)).max() <= 1e-9
    assert np.abs(flat.columns["y"] - free.y).max() <= 1e-9
    assert np.abs(flat.columns["spin"] - free.spin).max() <= 1e-9
    assert flat.last["heat_impact"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("friction", [0.05, 10.0])
def test_impulses_of_a_rough_wall(friction: float) -> None:
    """P_n = (1 + e) m v_n, P_τ = −(1 + e_τ) u/(1/m + r²/I) or the friction limit."""
    wall = {"point": [0.0, 1.0], "normal": [0.0, -1.0], "restitution": 0.5, "tangential": 0.2,
            "friction": friction}  # fmt: skip
    run = simulate_scene(
        scene(
            wall=[wall], time=1.0,
            puck={"mass": 2.0, "radius": 0.3, "friction": 0.0},
            launch={"velocity": [1.0, 2.0], "spin": 4.0},
        )
    )  # fmt: skip
    assert event(run, "impact") == pytest.approx(0.35, rel=1e-12)
    # the wall is above; its rim point is at (0, r): slides along it with v_x − r ω
    slide = 1.0 - 0.3 * 4.0
    inertia = 0.5 * 2.0 * 0.09
    push = -1.2 * slide / (0.5 + 0.09 / inertia)
    limit = friction * 1.5 * 2.0 * 2.0
    push = math.copysign(min(abs(push), limit), push)
    assert run.last["vy"] == pytest.approx(-1.0, rel=1e-12)
    assert run.last["vx"] == pytest.approx(1.0 + push / 2.0, rel=1e-12)
    assert run.last["spin"] == pytest.approx(4.0 - 0.3 * push / inertia, rel=1e-12)


def test_strips_by_pieces() -> None:
    """v² = v₀² − 2 Σ f_i g l_i for pure translation straight across, of all parts on the mean."""
    strips = {"borders": [1.5, 4.0], "friction": [0.1, 0.0, 0.3]}
    given = scene(floor={"strips": strips})
    run, radius = simulate_scene(given), given["puck"]["radius"]
    first = (3.0 - math.sqrt(9.0 - 2.0 * 0.1 * G * (1.5 - radius))) / (0.1 * G)
    assert event(run, "entry", 0) == pytest.approx(first, rel=1e-10)
    between = math.sqrt(9.0 - 2.0 * 0.1 * G * 1.5)  # the work is that of the centre's way
    free = event(run, "entry", 1) - event(run, "exit", 0)
    assert free == pytest.approx((2.5 - 2.0 * radius) / between, rel=1e-9)
    assert [e[1] for e in run.events] == ["entry", "exit", "entry", "exit", "stick"]
    assert run.last["x"] == pytest.approx(4.0 + 0.5 * between**2 / (0.3 * G), rel=1e-9)


def test_an_edge_ends_it() -> None:
    edge = {"point": [2.0, 0.0], "normal": [-1.0, 0.0]}
    run = simulate_scene(scene(edge=[edge]))
    fall = (3.0 - math.sqrt(9.0 - 4.0 * 0.2 * G)) / (0.2 * G)
    assert run.end == "over the edge"
    assert run.end_time == pytest.approx(fall, rel=1e-10)
    assert run.last["x"] == pytest.approx(2.0, rel=1e-12)


ABSENT = {
    "drag": {"drag": {"sliding": 0.0, "spinning": 0.0}},
    "slope": {"floor": {"slope": 0.0, "downhill": 1.0}},
    "force": {"force": {"constant": [0.0, 0.0], "torque": 0.0}},
    "belt": {"floor": {"velocity": [0.0, 0.0], "turning": 0.0, "centre": [3.0, 1.0]}},
    "walls out of reach": {"wall": [{"point": [90.0, 0.0], "normal": [-1.0, 0.1]}]},
    "an edge out of reach": {"edge": [{"point": [90.0, 0.0], "normal": [-1.0, 0.1]}]},
    "borders out of reach": {"floor": {"strips": {"borders": [60.0], "friction": [0.2, 0.1]}}},
}


@pytest.mark.parametrize("more", ABSENT.values(), ids=ABSENT)
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_what_is_absent_changes_no_bit(more: dict[str, Any], slope: float) -> None:
    """Both for the free puck, and on an incline, which is integrated."""
    if slope and "slope" in more.get("floor", {}):
        return
    base = scene(launch={"velocity": [2.0, 1.0], "spin": 3.0}, puck={"height": 1.0})
    base["floor"] = {"slope": slope}
    whole = {**base, **more, "floor": {**base["floor"], **more.get("floor", {})}}
    plain, run = simulate_scene(base), simulate_scene(whole)
    assert run.end_time == plain.end_time
    for name, column in plain.columns.items():
        assert np.array_equal(column, run.columns[name]), name
