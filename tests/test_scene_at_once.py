"""Two lines that are met at the same moment: the same answer in any order, or none, by name."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene

import puck_tables as pt
from puck_tables import Scene
from puck_tables.errors import InputError
from puck_tables.scene.outcome import ENDS

ROUGH = {"tangential": 0.0, "friction": 0.2}


def right_angle(ahead: float = 0.0, tol: float = 1e-9, **rim: float) -> dict[str, Any]:
    """Along the diagonal into a corner; ``ahead``: m by which the first wall is met before."""
    return {
        "puck": {"radius": 0.04, "height": 0.02, "friction": 0.15, "mass": 0.2},
        "launch": {"velocity": [2.0, 2.0]},
        "wall": [
            {"point": [1.0 - ahead, 0.0], "normal": [-1.0, 0.0], "restitution": 0.5, **rim},
            {"point": [0.0, 1.0], "normal": [0.0, -1.0], "restitution": 0.7},
        ],
        "tol": tol,
    }  # fmt: skip


def renumbered(scene: dict[str, Any]) -> dict[str, Any]:
    other = copy.deepcopy(scene)
    other["wall"].reverse()
    return other


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9, 1e-12])
def test_what_depends_on_the_order_is_refused_by_name(tol: float) -> None:
    scene = right_angle(tol=tol, **ROUGH)
    words = (
        r"meets wall\[0\] and wall\[1\] at the same moment, 0\.56218577\d* s, .* move the launch"
    )
    for numbered in (scene, renumbered(scene)):
        with pytest.raises(InputError, match=words):
            simulate_scene(numbered)


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("ahead", [1e-3, 1e-6, 1e-9, -1e-9, -1e-6, -1e-3])
def test_the_order_is_found_where_it_can_be(ahead: float, tol: float) -> None:
    """Just before or after: the limits from both sides, by hand.

    The rim of the wall at x = 1 rolls off (e_τ = 0, 2/3 of the slip v_y is lost unless that is more
    than 0.2 · 1.5 v_x); whether v_y is +v or −0.7 v then makes the difference.
    """
    scene = right_angle(ahead=ahead, tol=tol, **ROUGH)
    run, other = simulate_scene(scene), simulate_scene(renumbered(scene))
    unit = run.speed_scale / run.rate_scale
    assert abs(run.end_time - other.end_time) <= tol * unit
    assert run.error_estimate <= tol
    hits = [int(event.partner[5:]) for event in run.events if event.what == "impact"]
    assert hits[:2] == ([0, 1] if ahead > 0.0 else [1, 0])
    first = simulate_scene(scene, [run.events[0].time])
    v = math.sqrt(8.0 - 2.0 * 0.15 * 9.80665 * math.hypot(first.x[0], first.y[0])) / math.sqrt(2.0)
    r, after = 0.04, simulate_scene(scene, [run.events[1].time * (1 + 1e-12)])
    along = v if ahead > 0.0 else -0.7 * v  # of the rim on the wall at x = 1, n = (−1, 0)
    change = min(abs(along) / 3.0, 0.2 * 1.5 * v)
    spin = math.copysign(change / (0.5 * r), -along)  # I = m r²/2: ω = −r P/I
    assert after.columns["spin"][0] == pytest.approx(spin, rel=5e-3)


@pytest.mark.parametrize("rims", [({}, {}), ({"tangential": -1.0}, {"friction": 0.0})])
def test_smooth_cushions_at_a_right_angle_need_no_order(rims: Any) -> None:
    scene = right_angle()
    for wall, rim in zip(scene["wall"], rims, strict=True):
        wall |= rim
    run, other = simulate_scene(scene), simulate_scene(renumbered(scene))
    assert run.end_time == pytest.approx(other.end_time, rel=1e-14)
    v0, f = math.sqrt(8.0), 0.15 * 9.80665
    way = math.hypot(0.96, 0.96)
    v = math.sqrt(v0 * v0 - 2.0 * f * way)
    back = math.hypot(0.5, 0.7) * v / math.sqrt(2.0)
    assert run.end_time == pytest.approx((v0 - v + back) / f, rel=1e-9)


def wedge(half: float, restitution: float, slope: float = 0.0, tol: float = 1e-9) -> dict[str, Any]:
    """Along the x-axis into cushions that go off it by ``half`` at (1, 0)."""
    return {
        "puck": {"radius": 0.04, "height": 0.02, "friction": 0.1, "mass": 0.2},
        "floor": {"slope": slope}, "launch": {"velocity": [2.0, 0.0]},
        "wall": [
            {"point": [1.0, 0.0], "normal": [-math.sin(half), side * math.cos(half)],
             "restitution": restitution} for side in (1.0, -1.0)
        ],
        "tol": tol, "time": 20.0,
    }  # fmt: skip


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("degrees", [20.0, 45.0, 50.0, 80.0])
def test_along_the_bisector_it_goes_back(degrees: float, restitution: float) -> None:
    half = math.radians(degrees)
    run = simulate_scene(wedge(half, restitution))
    rate, way = 0.1 * 9.80665, 1.0 - 0.04 / math.sin(half)
    hit = math.sqrt(4.0 - 2.0 * rate * way)
    back = restitution * hit
    assert run.end_time == pytest.approx((2.0 - hit + back) / rate, rel=1e-9)
    assert run.last["x"] == pytest.approx(way - back * back / (2.0 * rate), abs=1e-9)
    assert abs(run.last["y"]) <= 1e-12
    assert run.last["spin"] == 0.0 and run.error_estimate <= 1e-9
    assert abs(run.energy_residual) <= 1e-9


@pytest.mark.parametrize("tol", [1e-4, 1e-9])
@pytest.mark.parametrize("restitution", [0.3, 0.9, 0.99])
def test_rebounds_along_the_bisector_are_a_series(restitution: float, tol: float) -> None:
    """It lands with v √(down/up) after each hop, so hops are a geometric series."""
    run = simulate_scene(wedge(0.7, restitution, slope=0.3, tol=tol))
    down, up = (9.80665 * (math.sin(0.3) + s * 0.1 * math.cos(0.3)) for s in (-1.0, 1.0))
    hit = math.sqrt(4.0 + 2.0 * down * (1.0 - 0.04 / math.sin(0.7)))
    first, ratio = (hit - 2.0) / down, restitution * math.sqrt(down / up)
    hop = restitution * hit * (1.0 / up + 1.0 / math.sqrt(up * down))
    unit = run.speed_scale / run.rate_scale
    assert run.end == "at rest"
    assert abs(run.end_time - first - hop / (1.0 - ratio)) <= tol * unit
    assert run.last["x"] == pytest.approx(1.0 - 0.04 / math.sin(0.7), abs=1e-12)


def test_along_the_bisector_one_puck_is_as_one_of_several() -> None:
    tables = wedge(0.6, 0.7)
    alone = simulate_scene(tables)
    one = pt.Piece(0.04, height=0.02, friction=0.1, mass=0.2, launch=pt.Launch((2.0, 0.0)))
    other = pt.Piece(0.04, friction=0.1, launch=pt.Launch(position=(-5.0, 0.0)))
    walls = [
        pt.Wall(tuple(w["point"]), normal=tuple(w["normal"]), restitution=0.7)
        for w in tables["wall"]
    ]
    last = pt.Scene(pucks=[one, other], walls=walls).simulate().last
    assert last["x"][0] == pytest.approx(alone.last["x"], rel=1e-9)
    assert last["y"][0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("part", [
    {"restitution": 0.5}, {"tangential": 0.0}, {"tangential": -0.5, "friction": 0.1},
])  # fmt: skip
def test_a_wedge_that_is_no_mirror_of_itself_is_refused(part: dict[str, float]) -> None:
    scene = wedge(0.6, 0.7)
    scene["wall"][0] |= part
    with pytest.raises(InputError, match="at the same moment"):
        simulate_scene(scene)


def test_beside_the_bisector_there_are_two_motions() -> None:
    scene, ends = wedge(0.6, 0.7), []
    for aside in (1e-8, -1e-8):
        scene["launch"]["velocity"] = [2.0, aside]
        ends.append(simulate_scene(scene).last)
    assert abs(ends[0]["y"] - ends[1]["y"]) > 0.01
    assert ends[0]["y"] == pytest.approx(-ends[1]["y"], abs=1e-6)


def test_hard_cushions_at_sixty_degrees_need_no_order() -> None:
    """Three reflections make one and the same in both orders, but not each two of them."""
    walls = [
        {"point": [1.0, 0.0], "normal": [-math.sin(a), s * math.cos(a)], "restitution": 1.0}
        for a, s in ((math.pi / 6, 1.0), (math.pi / 6, -1.0))
    ]
    tip = 1.0 - 0.04 / math.sin(math.pi / 6)
    scene = {
        "puck": {"radius": 0.04}, "wall": walls,
        "launch": {"velocity": [2.0 * math.cos(0.2), 2.0 * math.sin(0.2)],
                   "position": [tip - math.cos(0.2), -math.sin(0.2)]},
        "time": 1.0,
    }  # fmt: skip
    for numbered in (scene, renumbered(scene)):
        run = simulate_scene(numbered)
        assert run.last["vx"] == pytest.approx(-2.0 * math.cos(0.2), rel=1e-9)
        assert run.last["vy"] == pytest.approx(2.0 * math.sin(0.2), rel=1e-9)


def test_an_edge_beside_a_wall_is_refused_too() -> None:
    """Over the edge, or back off the wall at the last moment."""
    scene = right_angle()
    scene["wall"] = [{"point": [1.0, 0.0], "normal": [-1.0, -1.0], "restitution": 0.9}]
    place = (1.0 - 0.04 * math.sqrt(2.0)) / 2.0
    scene["edge"] = [{"point": [place, 0.0], "normal": [-1.0, 0.0]}]
    with pytest.raises(InputError, match=r"meets wall\[0\] and edge\[0\] at the same moment"):
        simulate_scene(scene)
    scene["edge"] = [{"point": [place + 1e-6, 0.0], "normal": [-1.0, 0.0]}]
    assert simulate_scene(scene).end == "at rest"
    scene["edge"] = [{"point": [place - 1e-6, 0.0], "normal": [-1.0, 0.0]}]
    assert simulate_scene(scene).end == "over the edge"


def test_a_launch_from_a_corner_into_it_is_refused() -> None:
    scene = right_angle(**ROUGH)
    scene["launch"]["position"] = [0.96, 0.96]
    with pytest.raises(InputError, match=r"at the same moment, 0 s"):
        simulate_scene(scene)


def test_a_run_of_a_sweep_is_refused_alone() -> None:
    scene = right_angle(**ROUGH)
    scene["launch"]["velocity"] = [2.0, [1.9, 2.0, 2.0 + 1e-7, 2.1]]
    ends = Scene.from_tables(scene).sweep()
    assert [ENDS[code] for code in ends.end] == ["at rest", "undecided", "at rest", "at rest"]
    assert np.isnan(ends.columns["x"][1])
    told = ends.without_end()
    assert len(told) == 1 and "launch.velocity[1] = 2:" in told[0] and "move the launch" in told[0]
    alone = right_angle(**ROUGH)
    for i, speed in ((0, 1.9), (2, 2.0 + 1e-7), (3, 2.1)):
        alone["launch"]["velocity"] = [2.0, speed]
        assert ends.end_time[i] == pytest.approx(simulate_scene(alone).end_time, rel=1e-8)


@pytest.mark.parametrize("gap", [0.0, 1e-10, 1e-8, 1e-6])
@pytest.mark.parametrize("seed", range(4))
def test_curved_ways_into_a_corner(seed: int, gap: float) -> None:
    """Walls put where a spinning puck just comes, one of them further off by ``gap``."""
    rng = np.random.default_rng([4, seed])
    scene: dict[str, Any] = {
        "puck": {"radius": 0.04, "height": 0.02, "friction": 0.1, "mass": 0.2},
        "floor": {"slope": 0.1, "downhill": float(rng.uniform(-3.0, 3.0))},
        "launch": {"velocity": [1.5, float(rng.normal())], "spin": float(rng.choice([40, -60]))},
        "time": 2.0, "tol": 1e-12,
    }  # fmt: skip
    free = simulate_scene(scene, [0.2])
    place = np.array([free.columns["x"][0], free.columns["y"][0]])
    way = math.atan2(free.columns["vy"][0], free.columns["vx"][0])
    scene["wall"] = []
    for side in (rng.uniform(0.2, 1.0), -rng.uniform(0.2, 1.0)):
        ahead = np.array([math.cos(way + side), math.sin(way + side)])
        far = 0.04 + (gap if side < 0.0 else 0.0)
        scene["wall"].append({
            "point": (place + far * ahead).tolist(), "normal": (-ahead).tolist(),
            "restitution": 0.6, "tangential": 0.2, "friction": 0.3,
        })  # fmt: skip
    if gap == 0.0:
        for tol in (1e-4, 1e-9):
            scene["tol"] = tol
            with pytest.raises(InputError, match="at the same moment"):
                simulate_scene(scene)
        return
    best = simulate_scene(scene)
    for tol in (1e-4, 1e-7, 1e-9):
        scene["tol"] = tol
        for numbered in (scene, renumbered(scene)):
            run = simulate_scene(numbered)
            late = abs(run.end_time - best.end_time) * run.rate_scale / run.speed_scale
            assert late <= 2.0 * run.error_estimate + best.error_estimate
            assert run.error_estimate <= tol
