"""Rough walls: rims after rebounds that die out, corners, and floors that go into a wall."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from rarely import thorough
from scenes import simulate_scene

from puck_tables.scene.library import find_scene

G = 9.80665


def leaning_rim(restitution: float, tangential: float, tol: float) -> Any:
    return simulate_scene({
        "puck": {"radius": 0.05, "friction": 0.0},
        "launch": {"velocity": [0.5, -0.3], "spin": 10.0, "position": [0.0, 0.35]},
        "force": {"constant": [0.7, -1.5]},
        "wall": [{"point": [0, 0], "normal": [0, 1], "restitution": restitution,
                  "tangential": tangential}],
        "time": 4.0, "tol": tol, "frames": 1,
    })  # fmt: skip


def hand_summed(restitution: float, tangential: float) -> float:
    """x at 4 s: without a floor all hops are parabolas, and at the end the rim rolls."""
    m, r = 1.0, 0.05
    inertia = 0.5 * m * r * r
    compliance = 1.0 / m + r * r / inertia
    fall = (-0.3 + math.sqrt(0.09 + 2.0 * 1.5 * 0.3)) / 1.5
    t, x, vx, spin, vn = fall, 0.5 * fall + 0.35 * fall**2, 0.5 + 0.7 * fall, 10.0, 0.3 + 1.5 * fall
    while vn > 1e-13:
        # n = (0, 1): τ = (−1, 0)
        along = -(1.0 + tangential) * (-vx - r * spin) / compliance
        vx, spin, vn = vx - along / m, spin - r * along / inertia, restitution * vn
        hop = 2.0 * vn / 1.5
        t, x, vx = t + hop, x + vx * hop + 0.35 * hop**2, vx + 0.7 * hop
    roll = (m * vx - inertia * spin / r) / (m + inertia / (r * r))
    rest = 4.0 - t
    return x + roll * rest + 0.5 * 0.7 / (m + inertia / (r * r)) * rest**2


@pytest.mark.parametrize("tol", [1e-3, 1e-7, 1e-9, 1e-11])
@pytest.mark.parametrize(
    "case", [(0.025, -0.93), (0.0017, 0.9), (0.1, 0.5), (0.01, 0.335), (0.3, 0.5)]
)
def test_a_rough_rim_that_settles_is_where_all_rebounds_bring_it(case, tol):
    run = leaning_rim(*case, tol)
    error = abs(run.last["x"] - hand_summed(*case)) / (run.speed_scale**2 / run.rate_scale)
    # what is left of the rebounds is a contact, on which the rim slides instead of being rubbed
    assert error <= max(tol, 3e-8) and error <= 2.0 * run.error_estimate + 1e-12


@pytest.mark.thorough
@pytest.mark.parametrize("rim", [{}, {"tangential": 1.0, "friction": 1.0}, {"tangential": -0.5}])
@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9, 1e-11])
def test_a_turning_floor_carries_no_puck_into_a_wall(rim: dict[str, float], tol: float) -> None:
    wall = {"point": [0.0, 0.0], "normal": [0.0, 1.0], "restitution": 0.0, **rim}
    run = simulate_scene({
        "puck": {"radius": 0.1, "friction": 0.2}, "floor": {"turning": 0.77},
        "launch": {"velocity": [0.844, -0.148], "spin": 16.0, "position": [0.0, 0.3]},
        "force": {"constant": [-0.82, -2.8]}, "wall": [wall],
        "time": 3.0, "tol": tol,
    }, np.linspace(0.0, 3.0, 301))  # fmt: skip
    assert run.columns["y"].min() >= 0.1 - 1e-13
    assert run.end == "time is up"  # it leans, and the floor slips under it
    assert len([event for event in run.events if event.what == "contact"]) == 1
    assert run.energy_residual < max(1e-8, 0.1 * tol)


def test_a_floor_that_leads_off_a_wall_carries_a_puck_off() -> None:
    """The centre of the turntable is on the far side: the carried circle bends off the wall."""
    run = simulate_scene({
        "puck": {"radius": 0.1, "friction": 0.5}, "floor": {"turning": 1.0, "centre": [0.0, 1.0]},
        "launch": {"velocity": [0.9, 0.0], "spin": 1.0, "position": [0.0, 0.1]},
        "wall": [{"point": [0.0, 0.0], "normal": [0.0, 1.0]}], "time": 1.0,
    })  # fmt: skip
    assert run.end == "carried by the floor"
    assert run.last["x"] == pytest.approx(0.9 * math.sin(1.0), rel=1e-9)
    assert run.last["y"] == pytest.approx(1.0 - 0.9 * math.cos(1.0), rel=1e-9)


@pytest.mark.parametrize(
    ("slope", "downhill"),
    [
        (0.02, 0.3), (0.05, -0.8), (0.1, 0.3),
        *(thorough(slope, way) for slope in (0.02, 0.05, 0.1) for way in (-0.8, 2.0, 4.0)),
    ],
)  # fmt: skip
def test_a_tilted_air_hockey_table_ends_at_rest(slope: float, downhill: float) -> None:
    scene: dict[str, Any] = dict(find_scene("air-hockey"))
    scene["puck"]["friction"] = 0.01
    scene["floor"] = {**scene.get("floor", {}), "slope": slope, "downhill": downhill}
    scene |= {"time": 60.0, "frames": 1, "tol": 1e-6}
    assert simulate_scene(scene).end == "at rest"


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9])
def test_rough_walls_hold_a_puck_in_their_corner(tol: float) -> None:
    walls = [
        {"point": [0, 0], "normal": normal, "restitution": 0.0, "tangential": 0.5}
        for normal in ([1, 0], [0, 1])
    ]
    run = simulate_scene({
        "puck": {"radius": 0.05, "friction": 0.1},
        "launch": {"velocity": [0, -0.5], "spin": 10.0, "position": [0.4, 0.6]},
        "force": {"constant": [-1.5, -1.0]}, "wall": walls,
        "time": 3.0, "tol": tol, "frames": 1,
    })  # fmt: skip
    assert run.end == "at rest" and run.steps < 2000


def test_a_puck_that_leaves_a_wall_keeps_its_distance_to_it() -> None:
    """Pulled off at once after an impact without restitution; each impact is at its wall."""
    run = simulate_scene({
        "puck": {"radius": 0.1}, "launch": {"velocity": [0.3, -1.0], "position": [0.0, 0.5]},
        "force": {"constant": [0.0, 1.0]}, "time": 8.0,
        "wall": [
            {"point": [0.0, 0.0], "normal": [0.0, 1.0], "restitution": 0.0},
            {"point": [0.0, 1.0], "normal": [0.0, -1.0], "restitution": 0.0},
        ],
    })  # fmt: skip
    for event in run.events:
        if event.what in ("impact", "contact"):
            gap = event.y if event.partner == "wall 0" else 1.0 - event.y
            assert abs(gap) <= 1e-14
    assert run.last["y"] == pytest.approx(0.9, abs=1e-14)


@pytest.mark.parametrize("tol", [1e-3, 1e-5, 1e-7, 1e-9])
def test_what_a_turning_floor_loses_before_it_meets_a_wall(tol: float) -> None:
    slope, downhill, turning, centre = 0.2731, 2.957796, 1.8737, np.array([-0.777424, 0.116109])
    run = simulate_scene({
        "puck": {"radius": 0.062, "friction": 0.5}, "time": 2.4, "tol": tol,
        "floor": {
            "slope": slope, "downhill": downhill, "turning": turning,
            "centre": centre.tolist(),
        },
        "launch": {"velocity": [2.285891, -0.27714], "spin": 72.837},
        "wall": [
            {"point": [-0.509504, 2.343981], "normal": [-0.8626, -0.505887], "restitution": 0.9},
            {"point": [-0.509504, 2.343981], "normal": [0.994768, -0.102156], "restitution": 0.5},
        ],
    })  # fmt: skip
    rests = next(event for event in run.events if event.what == "stick")
    slips = next(event for event in run.events if event.what == "slip")
    arm = complex(*(np.array([rests.x, rests.y]) - centre))
    times = rests.time + np.linspace(0.0, 1.0, 1_000_001)
    down = G * math.sin(slope) * np.exp(1j * downhill)
    demand = np.abs(down + turning**2 * arm * np.exp(1j * turning * (times - rests.time)))
    lost = times[np.argmax(demand > 0.5 * G * math.cos(slope))]
    assert slips.time == pytest.approx(lost, abs=max(1e-5, 10.0 * tol))
