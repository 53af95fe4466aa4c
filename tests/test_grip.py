"""Friction that changes over time, by factors on it: known answers, rest, and what is refused."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from reference import friction as disc_friction
from scenes import end_of
from scipy.integrate import solve_ivp

import puck_tables as pt

G = 9.80665
STATE = ("x", "y", "orientation")
ANGLE = 3  # of the time and these
LAW = pt.StribeckLaw(0.3, 0.1, speed=0.3, exponent=1.0)
WET = pt.Strips((0.1, 0.18), (0.2, 0.05, 0.4), direction=0.4)
SPOT = pt.Patch(0.05, centre=(0.1, 0.02), radius=0.06)
SPIN = pt.Launch((1.0, 0.2), spin=12.0)


def fades(factor: float, *more: list[float], where: str = "floor") -> pt.Grip:
    return pt.Grip([[0.0, factor], *(more or [[1.0, factor]])], where=where)


def spun(puck: pt.Puck, floor: pt.Floor, **parts: Any) -> np.ndarray:
    return end_of(puck, floor, SPIN, **parts)


@pytest.mark.parametrize("base", [{"radius": 0.05}, {"base": "box:0.2x0.1"}])
def test_a_puck_without_spin_stops_where_the_cubic_says(base: dict[str, Any]) -> None:
    rate, decel, speed = 0.5, 0.1 * G, 0.3
    puck = pt.Puck(**base, friction=0.1)
    floor = pt.Floor(grips=[fades(1.0, [1.0, 1.0 - rate])])
    run = pt.Scene(puck, floor, launch=pt.Launch((speed, 0.0))).simulate([0.0])
    time = (1.0 - math.sqrt(1.0 - 2.0 * rate * speed / decel)) / rate
    way = speed * time - decel * (time**2 / 2.0 - rate * time**3 / 6.0)
    assert run.end == "at rest"
    assert abs(run.end_time - time) < 1e-13 and abs(run.last["x"] - way) < 1e-13
    assert abs(run.last["heat_dry"] - 0.5 * puck.mass * speed**2) < 1e-13
    assert "friction over time" in run.explain()


KINDS: dict[str, Any] = {  # a puck and a floor by the factor on their friction
    "flat": lambda k: (pt.Puck(0.05, friction=0.2 * k), {}),
    "tall": lambda k: (pt.Puck(0.05, 0.05, 0.2 * k), {}),
    "hertz": lambda k: (pt.Puck(0.05, 0.03, 0.2 * k, pressure="hertz"), {}),
    "ring": lambda k: (pt.Puck(0.05, 0.03, 0.2 * k, pressure="annulus:0.8"), {}),
    "base": lambda k: (pt.Puck(base="box:0.2x0.1", height=0.05, friction=0.2 * k), {}),
    "strips": lambda k: (
        pt.Puck(0.05, 0.05),
        {"strips": pt.Strips(WET.borders, tuple(k * f for f in WET.friction), WET.direction)},
    ),
    "base on strips": lambda k: (
        pt.Puck(base="box:0.2x0.1", height=0.05),
        {"strips": pt.Strips(WET.borders, tuple(k * f for f in WET.friction), WET.direction)},
    ),
    "patch": lambda k: (
        pt.Puck(0.05, 0.05, 0.2 * k),
        {"patches": [pt.Patch(k * SPOT.friction, centre=SPOT.centre, radius=SPOT.radius)]},
    ),
    "law": lambda k: (
        pt.Puck(0.05, 0.04), {"law": pt.StribeckLaw(0.3 * k, 0.1 * k, speed=0.3, exponent=1.0)},
    ),
    "base under a law": lambda k: (
        pt.Puck(base="box:0.2x0.1", height=0.04),
        {"law": pt.StribeckLaw(0.3 * k, 0.1 * k, speed=0.3, exponent=1.0)},
    ),
    "by direction": lambda k: (
        pt.Puck(0.05, 0.04), {"orthotropic": pt.Orthotropic((0.3 * k, 0.2 * k), 0.3)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_constant_factor_is_other_friction(kind: str) -> None:
    puck, floor = KINDS[kind](1.0)
    other, scaled = KINDS[kind](0.75)
    tol = {"law": 1e-9}.get(kind, 1e-12)
    found = spun(puck, pt.Floor(**floor, grips=[fades(0.75)]), tol=tol)
    wanted = spun(other, pt.Floor(**scaled), tol=tol)
    near = {"law": 1e-10, "patch": 1e-11}.get(kind, 1e-12)  # a law stands in a table
    # on borders, and where a law bends, steps fall otherwise: of 40 factors the angle was 4e-12
    # apart, at most 7e-11
    otherwise = ("strips", "base on strips", "patch", "base under a law")
    turned = 1e-10 if kind in otherwise else near
    apart = np.abs(found - wanted)
    assert apart[ANGLE] < turned and np.delete(apart, ANGLE).max() < near


def test_a_jump_is_two_runs_one_after_the_other() -> None:
    when, puck, poor = 0.15, pt.Puck(0.05, 0.03, 0.2), pt.Puck(0.05, 0.03, 0.08)
    floor = pt.Floor(grips=[fades(1.0, [when, 1.0], [when, 0.4], [1.0, 0.4])])
    whole = spun(puck, floor, tol=1e-11)
    first = pt.Scene(puck, launch=SPIN, time=when, tol=1e-11).simulate([0.0]).last
    launch = pt.Launch(
        (first["vx"], first["vy"]), first["spin"], (first["x"], first["y"]), first["orientation"]
    )
    second = end_of(poor, pt.Floor(), launch, tol=1e-11)
    assert np.abs(whole - second - [when, 0.0, 0.0, 0.0]).max() < 1e-10


def test_a_puck_slips_off_when_its_slope_gets_slippery() -> None:
    slope, friction, rate = 0.1, 0.3, 0.5
    starts = (1.0 - math.tan(slope) / friction) / rate  # f (1 - rate t) = tan
    until = 1.7
    for base in ({"radius": 0.05}, {"base": "box:0.2x0.1"}):
        floor = pt.Floor(slope=slope, grips=[fades(1.0, [1.8, 1.0 - 1.8 * rate])])
        scene = pt.Scene(pt.Puck(**base, friction=friction), floor, time=until)  # type: ignore[arg-type]
        run = scene.simulate([0.0])
        slip = next(event for event in run.events if event.what == "slip")
        assert abs(slip.time - starts) < 1e-9
        gains = 0.5 * rate * friction * G * math.cos(slope)
        assert abs(run.last["vx"] - gains * (until - starts) ** 2) < 1e-9
        assert abs(run.last["x"] - gains * (until - starts) ** 3 / 3.0) < 1e-9
        assert abs(run.energy_residual) < 1e-9


def test_a_tall_puck_as_another_program_integrates_it() -> None:
    radius, height, friction = 0.05, 0.05, 0.25
    rows = np.array([[0.0, 0.4], [0.1, 1.2], [0.35, 0.3], [2.0, 0.9]])

    def rates(t: float, y: np.ndarray) -> list[float]:
        f = friction * np.interp(t, rows[:, 0], rows[:, 1])
        ax, ay, turning = disc_friction(y[3], y[4], radius * y[5], 2.0 * f * height / radius)
        return [*y[3:], f * G * ax, f * G * ay, f * G * turning / radius]

    until = 0.5
    judged = solve_ivp(
        rates, (0.0, until), [0.0, 0.0, 0.0, 1.0, 0.2, 12.0], "DOP853", rtol=1e-9, atol=1e-11,
        max_step=0.02,
    ).y[:, -1]  # fmt: skip
    floor = pt.Floor(grips=[pt.Grip(rows.tolist())])
    run = pt.Scene(pt.Puck(radius, height, friction), floor, launch=SPIN, time=until)
    last = run.simulate([0.0]).last
    found = [last[name] for name in (*STATE, "vx", "vy", "spin")]
    assert np.abs(np.subtract(found, judged) * [1, 1, radius, 1, 1, radius]).max() < 1e-8


def test_a_stretch_has_factors_of_its_own() -> None:
    puck = pt.Puck(0.05, friction=0.2)
    for plain, changed, where in (
        ({"strips": pt.Strips((0.1,), (0.2, 0.1))}, {"strips": pt.Strips((0.1,), (0.2, 0.4))},
         "strip 1"),
        ({"patches": [pt.Patch(0.4, (0.2, 0.0), 0.1)]},
         {"patches": [pt.Patch(0.1, (0.2, 0.0), 0.1)]}, "patch 0"),
    ):  # fmt: skip
        ratio = 4.0 if where == "strip 1" else 0.25
        found = spun(puck, pt.Floor(**plain, grips=[fades(ratio, where=where)]), tol=1e-11)
        assert np.abs(found - spun(puck, pt.Floor(**changed), tol=1e-11)).max() < 1e-10


def test_pucks_that_meet_on_a_floor_that_gets_wet() -> None:
    def board(friction: float, **floor: Any) -> pt.Scene:
        pucks = [
            pt.Puck(0.05, 0.03, friction, launch=pt.Launch((1.5, 0.1), 5.0), name="a"),
            pt.Puck(0.05, 0.03, friction, launch=pt.Launch(position=(0.2, 0.03)), name="b"),
        ]
        walls = [pt.Wall((0.5, 0.0), normal=(-1.0, 0.0), restitution=0.5)]
        return pt.Scene(pucks=pucks, walls=walls, floor=pt.Floor(**floor))

    wet = board(0.4, grips=[fades(0.5)]).simulate([0.0])
    dry = board(0.2, grips=[fades(1.0)]).simulate([0.0])
    plain = board(0.2).simulate([0.0])
    for name in ("x", "y", "orientation"):
        assert np.abs(wet.last[name] - dry.last[name]).max() < 1e-11
        assert np.abs(wet.last[name] - plain.last[name]).max() < 1e-7
    assert [e.what for e in wet.events] == [e.what for e in plain.events]
    fading = board(0.4, grips=[fades(1.0, [1.0, 0.2])]).simulate([0.0])
    assert abs(fading.energy_residual) < 1e-9


def test_two_that_lean_on_each_other_slip_when_it_gets_slippery() -> None:
    slope, friction = 0.1, 0.3
    pucks = [
        pt.Puck(0.05, friction=friction, launch=pt.Launch(position=(0.1 * n, 0.0)))
        for n in range(2)
    ]
    scene = pt.Scene(
        pucks=pucks, floor=pt.Floor(slope=slope, grips=[fades(1.0, [1.8, 0.1])]), time=1.7
    )
    run = scene.simulate([0.0])
    starts = (1.0 - math.tan(slope) / friction) / 0.5
    gains = 0.25 * friction * G * math.cos(slope)
    assert np.abs(np.array(run.last["vx"]) - gains * (1.7 - starts) ** 2).max() < 1e-8
    assert abs(run.energy_residual) < 1e-9


def test_factors_from_a_file_and_in_a_toml_file(tmp_path: Path) -> None:
    file = tmp_path / "sweep.csv"
    file.write_text("t [ms],factor [%]\n0,100\n500,40\n")
    floor = pt.Floor(grips=[pt.Grip(str(file))])
    rows = pt.Floor(grips=[pt.Grip([[0.0, 1.0], [0.5, 0.4]])])
    puck = pt.Puck(0.05, friction=0.2)
    assert (spun(puck, floor) == spun(puck, rows)).all()
    scene = pt.Scene.from_tables({
        "puck": {"radius": 0.05, "friction": 0.2},
        "floor": {"grip": [{"over_time": [[0, 1], [0.5, 0.4]]}]},
        "launch": {"velocity": [1.0, 0.2], "spin": 12.0},
    })  # fmt: skip
    assert scene.floor.grips == (pt.Grip(((0.0, 1.0), (0.5, 0.4))),)
    assert scene.simulate([0.0]).end == "at rest"


REFUSED = {
    "below 0": ([pt.Grip([[0, 1], [1, -1]])], "row 2: a factor of -1"),
    "back": ([pt.Grip([[1, 1], [0, 1]])], "the times must ascend"),
    "one row": ([pt.Grip([[0, 1]])], "only row"),
    "no strip": ([pt.Grip([[0, 1], [1, 1]], "strip 0")], "where = 'strip 0': must be 'floor'"),
    "twice": ([fades(1.0), fades(0.5)], "stands twice"),
    "lifts": ([fades(1.0, [1.0, 9.0])], "floor.grip: friction that is summed"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_wrong_is_said(name: str) -> None:
    grips, words = REFUSED[name]
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(pt.Puck(0.05, 0.05, 0.3, pressure="hertz"), pt.Floor(grips=grips))


def test_a_floor_without_friction_in_the_end_needs_a_time() -> None:
    floor = pt.Floor(grips=[fades(1.0, [0.05, 0.0])])
    scene = pt.Scene(pt.Puck(0.05, friction=0.2), floor, launch=SPIN)
    with pytest.raises(pt.InputError, match="friction is 0 in the end"):
        scene.simulate([0.0])
    for more in ({}, {"floor.law": [[0.0, 0.2], [20.0, 0.3]]}):
        run = scene.at({"time": 1.0, **more}).simulate([0.0])
        assert run.end == "time is up" and abs(run.energy_residual) < 1e-9
