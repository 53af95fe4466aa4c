"""Strips and patches that move with velocities of their own: known answers, rest, refusals."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import puck_tables as pt
from puck_tables.world.floor_forces import friction_at

G, STATE = 9.80665, ("x", "y", "orientation", "vx", "vy", "spin")
PUCKS: dict[str, dict[str, Any]] = {
    "flat": {"radius": 0.05},
    "tall": {"radius": 0.05, "height": 0.06},
    "hertz": {"radius": 0.05, "height": 0.03, "pressure": "hertz"},
    "annulus": {"radius": 0.05, "height": 0.03, "pressure": "annulus:0.7"},
    "ring": {"radius": 0.05, "height": 0.03, "pressure": "ring"},
    "box": {"base": "box:0.1x0.06", "height": 0.04},
}
SEVERAL = ("flat", "tall", "box")


def belts(*speeds: float, friction: Any = (0.2, 0.2), **more: Any) -> pt.Floor:
    """Belts side by side along y, or with ``ways`` = "across" one after the other along x."""
    ways = more.pop("ways", "along")
    return pt.Floor(
        strips=pt.Strips(more.pop("borders", (0.0,)), friction, **{ways: speeds}), **more
    )


def last_of(scene: pt.Scene) -> np.ndarray:
    run = scene.simulate([0.0])
    assert abs(run.energy_residual) < 1e-9
    return np.array([run.last[name] for name in STATE])


@pytest.mark.parametrize("name", SEVERAL)
def test_two_belts_of_one_velocity_are_one(name: str) -> None:
    puck = pt.Puck(**PUCKS[name], friction=0.2)
    launch = pt.Launch((0.3, 0.4), 8.0, (-0.1, 0.02), 0.3)
    one = pt.Scene(puck, pt.Floor(velocity=(0.5, 0.0)), launch, time=0.5, tol=1e-12)
    ends = [last_of(one)]
    # by themselves, and beside a third one of another velocity far away
    for borders, speeds in (((0.0,), (0.5, 0.5)), ((0.0, 5.0), (0.5, 0.5, -0.2))):
        floor = belts(*speeds, ways="across", borders=borders, friction=(0.2,) * len(speeds))
        ends.append(last_of(pt.Scene(puck, floor, launch, time=0.5, tol=1e-12)))
    assert np.abs(ends[1] - ends[0]).max() < 1e-12
    assert np.abs(ends[2] - ends[0]).max() < 1e-11


def test_a_box_goes_from_belt_to_belt_as_a_spring_would_lead_it() -> None:
    length, fast, slow, friction = 0.1, 0.5, 0.2, 0.2
    box = pt.Puck(base=f"box:{length}x0.06", friction=friction)
    floor = belts(fast, slow, ways="across")
    run = pt.Scene(box, floor, pt.Launch((fast, 0.0), position=(-0.2, 0.0)), time=1.0).simulate()
    # it holds on to the first belt to its middle; then a = -2 f g x/L, until all of it is over
    rate = math.sqrt(2.0 * friction * G / length)
    over = math.asin(rate * 0.5 * length / fast) / rate
    left = fast * math.cos(rate * over)
    stops = 0.4 + over + (left - slow) / (friction * G)
    told = {event.what: event.time for event in run.events}
    assert abs(told["slip"] - 0.4) < 1e-9 and abs(told["stick"] - stops) < 1e-9
    slides = (left**2 - slow**2) / (2.0 * friction * G)
    assert abs(run.last["x"] - (0.5 * length + slides + slow * (1.0 - stops))) < 1e-9
    assert abs(run.energy_residual) < 1e-9 and run.end == "carried by the floor"
    # on the way to its middle it rubs on the second belt, which takes that from the first
    share = 0.5 * friction * G * box.mass * (fast - slow)  # half the load, at last
    enters = 0.4 - 0.5 * length / fast
    heat = np.interp(0.4, run.time, run.heat_dry)
    assert abs(heat - 0.5 * share * (0.4 - enters)) < 1e-4


def rim_of(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of a base and the share of each in its area."""
    n = 200
    if name == "box":
        nodes, weights = np.polynomial.legendre.leggauss(n)
        x, y = np.meshgrid(0.05 * nodes, 0.03 * nodes)
        return x.ravel(), y.ravel(), (np.outer(weights, weights) / 4.0).ravel()
    nodes, weights = np.polynomial.legendre.leggauss(n)
    rho = 0.025 * (nodes + 1.0)
    turn = 2.0 * math.pi * (np.arange(2 * n) + 0.5) / (2 * n)
    x, y = np.outer(rho, np.cos(turn)), np.outer(rho, np.sin(turn))
    share = np.outer(0.025 * weights * rho, np.ones(2 * n)) * 2.0 / (2 * n * 0.05**2)
    return x.ravel(), y.ravel(), share.ravel()


def test_across_two_belts_that_run_apart_a_body_turns() -> None:
    radius, speed, friction = 0.05, 0.5, 0.2
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = 0.25 * math.pi * (nodes + 1.0)  # of the half beyond x = 0, of which the quarter y > 0
    rho = 0.5 * radius * (nodes + 1.0)
    area = np.outer(0.5 * radius * weights * rho, 0.25 * math.pi * weights)
    x, y = np.outer(rho, np.cos(half)), np.outer(rho, np.sin(half))

    def rates(_: float, state: np.ndarray) -> list[float]:
        ux, uy = -state[1] * y, state[1] * x - speed
        slip = np.hypot(ux, uy)
        torque = -4.0 * friction * G * (area * (x * uy - y * ux) / slip).sum()
        return [state[1], torque / (math.pi * radius**2) / (0.5 * radius**2)]

    judged = solve_ivp(rates, (0.0, 0.2), [0.0, 0.0], "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    for shape in ({"radius": radius}, {"base": f"disc:{radius}"}):
        puck = pt.Puck(**shape, friction=friction)  # type: ignore[arg-type]
        run = pt.Scene(puck, belts(-speed, speed), time=0.2).simulate([0.0])
        found = [run.last[name] for name in STATE]
        assert np.abs(np.array(found)[[0, 1, 3, 4]]).max() < 1e-9
        assert np.abs(np.array(found)[[2, 5]] - judged).max() < 1e-8
        gained = 0.25 * puck.mass * (radius * run.last["spin"]) ** 2
        assert abs(run.last["work_support"] - run.last["heat_dry"] - gained) < 1e-9


@pytest.mark.parametrize("name", SEVERAL)
def test_astride_from_the_start_on_a_belt_is_astride_on_a_floor_that_stands(name: str) -> None:
    puck, strips, ends = pt.Puck(**PUCKS[name]), pt.Strips((0.0,), (0.2, 0.1)), []
    for speed in (0.0, 0.3):  # along the border
        floor = pt.Floor(strips=strips, velocity=(0.0, speed))
        launch = pt.Launch((0.4, 0.1 + speed), 5.0, (-0.01, 0.0), 0.3)
        ends.append(
            last_of(pt.Scene(puck, floor, launch, time=0.2)) - [0, 0.2 * speed, 0, 0, speed, 0]
        )
    assert np.abs(ends[1] - ends[0]).max() < 1e-9


@pytest.mark.parametrize("name", SEVERAL)
def test_mirror_images(name: str) -> None:
    puck, turn = pt.Puck(**PUCKS[name], friction=0.2), np.array([1, -1, -1, 1, -1, -1])
    ends = []
    for sign in (1.0, -1.0):
        floor = belts(0.3 * sign, -0.5 * sign, friction=(0.2, 0.1))
        launch = pt.Launch((0.5, 0.1 * sign), 4.0 * sign, (-0.08, 0.0), 0.2 * sign)
        ends.append(last_of(pt.Scene(puck, floor, launch, time=0.3)))
    assert np.abs(ends[0] - turn * ends[1]).max() < 1e-9


WEIGHTS: dict[str, Any] = {
    "flat": lambda s: np.ones_like(s), "tall": lambda s: np.ones_like(s),
    "hertz": lambda s: np.sqrt(1.0 - s**2), "annulus": lambda s: 1.0 * (s > 0.7),
    "box": lambda s: np.ones_like(s),
}  # fmt: skip


@pytest.mark.parametrize("name", WEIGHTS)
def test_friction_is_that_of_a_grid_each_point_at_its_own_slip(name: str) -> None:
    puck = pt.Puck(**PUCKS[name], friction=0.2, gravity=1.0)
    speeds, coefficients, patch = (0.4, -0.3), (0.2, 0.1), (-0.5, 0.6)
    wet = [] if name == "box" else [pt.Patch(0.15, (0.06, 0.0), 0.04, velocity=patch)]
    floor = belts(*speeds, friction=coefficients, patches=wet)
    x, y, share = rim_of(name)
    if name != "box":
        share = share * WEIGHTS[name](np.hypot(x, y) / 0.05)
        share /= share.sum()
    states = np.array([[0.01, 0.01, 0.3, 0.2, 0.1, 4.0], [0.03, -0.01, 1.0, -0.1, 0.2, -9.0]])
    found = friction_at(pt.Scene(puck, floor), states)
    for state, force in zip(states, found, strict=True):
        c, s = math.cos(state[2]), math.sin(state[2])
        rx, ry = c * x - s * y, s * x + c * y
        px, py = state[0] + rx, state[1] + ry
        f = np.where(px < 0.0, *coefficients)
        bx, by = np.zeros_like(px), np.where(px < 0.0, *speeds)
        on = (np.hypot(px - 0.06, py) < 0.04) & bool(wet)
        f[on], bx[on], by[on] = 0.15, *patch
        ux, uy = state[3] - state[5] * ry - bx, state[4] + state[5] * rx - by
        slip = np.hypot(ux, uy)
        ex, ey = f * ux / slip, f * uy / slip
        rows = np.stack([np.ones_like(rx), rx, ry])
        balance = (rows * share) @ rows.T
        height = 0.5 * PUCKS[name].get("height", 0.0)
        pull = np.stack([np.zeros(3), -height * rows @ (share * ex), -height * rows @ (share * ey)])
        load = share * (np.linalg.solve(balance + pull, [1.0, 0.0, 0.0]) @ rows)
        wanted = -np.array([(load * ex).sum(), (load * ey).sum(),
                            (load * (rx * ey - ry * ex)).sum()])  # fmt: skip
        assert (np.abs(force - wanted) < 2e-3 * np.array([1.0, 1.0, 0.05])).all()


def test_a_diverter_leads_a_puck_off() -> None:
    floor = pt.Floor(patches=[
        pt.Patch(0.4, corners=[[0, -0.2], [0.3, -0.2], [0.3, 0.2], [0, 0.2]], velocity=(0.1, 0.5)),
    ])  # fmt: skip
    run = pt.Scene(
        pt.Puck(0.03, friction=0.3), floor, pt.Launch((1.0, 0.0), position=(-0.1, 0.0))
    ).simulate([0.0])
    assert run.end == "at rest" and run.last["y"] > 0.15
    assert abs(run.energy_residual) < 1e-9
    assert [event.what for event in run.events][-1] == "stick"


def test_a_puck_that_rests_beside_a_belt_that_rubs_it() -> None:
    floor = belts(0.0, 0.4, friction=(0.5, 0.1))
    run = pt.Scene(
        pt.Puck(0.05, friction=0.2), floor, pt.Launch(position=(-0.01, 0.0)), time=1.0
    ).simulate([0.0, 0.5])
    assert run.end == "at rest" and run.last["y"] == 0.0
    assert abs(run.last["heat_dry"] - run.last["work_support"]) < 1e-12
    part = (math.acos(0.2) - 0.2 * math.sqrt(1.0 - 0.04)) / math.pi  # of a disc beyond a chord
    heat = part * 0.1 * G * 0.4
    assert abs(run.heat_dry[1] - 0.5 * heat) < 1e-9 and abs(run.last["heat_dry"] - heat) < 1e-9


@pytest.mark.parametrize("name", SEVERAL)
def test_what_a_belt_carries_away_from_all_borders_has_its_end(name: str) -> None:
    puck, floor = pt.Puck(**PUCKS[name]), belts(0.3, 0.1, ways="across")
    run = pt.Scene(puck, floor, pt.Launch((1.0, 0.3), 10.0, (-0.3, 0.0))).simulate()
    assert run.end == "carried by the floor"
    assert run.last["x"] > 0.05 - 1e-9 and run.last["vx"] == 0.1


def test_what_a_belt_carries_on_to_a_third_goes_over() -> None:
    floor = belts(0.3, 0.1, 0.05, ways="across", borders=(0.0, 0.5), friction=(0.2, 0.3, 0.1))
    launch = pt.Launch((1.0, 0.3), 10.0, (-0.3, 0.0))
    run = pt.Scene(pt.Puck(**PUCKS["box"]), floor, launch).simulate()
    what = [event.what for event in run.events]
    assert what.count("entry") == what.count("exit") == 2 and run.last["vx"] == 0.05


def test_pucks_that_meet_on_belts() -> None:
    pucks = [
        pt.Puck(0.05, 0.02, launch=pt.Launch((0.5, 0.1), 3.0, (-0.3, 0.0)), name="a",
                 restitution=0.3),
        pt.Puck(0.05, 0.02, launch=pt.Launch((0.2, 0.0), 0.0, (0.02, 0.03)), name="b"),
        pt.Puck(0.05, launch=pt.Launch((0.2, 0.0), 0.0, (0.125, 0.03)), name="c",
                 restitution=0.0),
    ]  # fmt: skip
    walls = [pt.Wall((0.4, 0.0), normal=(-1.0, 0.0), restitution=0.2)]
    for count, speeds in ((3, (0.5, 0.2)), (2, (0.3, -0.3))):
        floor = belts(*speeds, ways="across", friction=(0.3, 0.2))
        run = pt.Scene(pucks=pucks[:count], walls=walls, floor=floor, time=1.5).simulate([0.0])
        assert abs(run.energy_residual) < 1e-8
        kinds = {event.what for event in run.events}
        assert {"impact", "entry", "stick"} <= kinds


def test_a_map_over_launches_has_the_runs_of_a_scene() -> None:
    floor = belts(0.5, 0.2, ways="across")
    scene = pt.Scene(pt.Puck(0.05, friction=0.2), floor, pt.Launch((0.6, 0.1), 3.0, (-0.1, 0.0)),
                     time=0.6)  # fmt: skip
    speeds = [0.6, 0.9]
    ends = pt.Scene(
        scene.puck, floor, pt.Launch([(v, 0.1) for v in speeds], 3.0, (-0.1, 0.0)), time=0.6
    ).sweep()
    for n, speed in enumerate(speeds):
        run = scene.at({"launch.velocity": [speed, 0.1]}).simulate([0.0])
        assert abs(ends.x[n] - run.last["x"]) < 1e-8 and abs(ends.y[n] - run.last["y"]) < 1e-8


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "too few": ({"floor": belts(0.5)}, "one number for each of 2 strips"),
    "two floors": ({"floor": belts(0.5, 0.1, velocity=(0.1, 0.0))}, "and floor.velocity"),
    "turntable": ({"floor": belts(0.5, 0.1, turning=1.0)}, "not on a floor that turns"),
    "drag": ({"floor": belts(0.5, 0.1), "drag": pt.Drag(sliding=0.1)}, "drag: not known on belts"),
    "rail": (
        {"floor": belts(0.5, 0.1), "constraint": pt.Constraint("rail")},
        "puck.constraint: not known on belts",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_known_is_refused(name: str) -> None:
    parts, words = REFUSED[name]
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(pt.Puck(0.05, friction=0.2), time=1.0, **parts)


def test_a_belt_rubs_what_rests_on_another_by_its_friction_at_that_slip():
    """By hand: f is 0.24 at 0.3 m/s; it slips where 0.24 s = 0.3 (1 − s).  It did at s = ½."""
    law = [[0.0, 0.3], [1.0, 0.1]]
    belts = pt.Floor(strips=pt.Strips((0.0,), (law, law), across=(0.5, 0.2)))
    box = pt.Puck(base="box:0.1x0.06")
    launch = pt.Launch((0.5, 0.0), position=(-0.2, 0.0))
    run = pt.Scene(box, belts, launch, time=1.0).simulate(times=[0.41])
    share = 0.3 / 0.54
    slips = next(event.time for event in run.events if event.what == "slip")
    assert abs(slips - (0.15 + 0.1 * share) / 0.5) <= 1e-9
    heat = 0.24 * 9.80665 * 0.3 * 0.5 * (0.41 - 0.3) ** 2 * 0.5 / 0.1  # s grows by 0.5/0.1 a second
    assert abs(run.heat_dry[0] - heat) <= 1e-9  # a step over the border that saw no error: 5e-8
