"""Static friction above that in a slip: until when it holds, and what then is."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

import puck_tables as pt

G, F, S = 9.80665, 0.2, 1.5  # what slips has F, what rests S F
BODIES: dict[str, dict[str, Any]] = {
    "flat": {"radius": 0.05},
    "tall": {"radius": 0.05, "height": 0.03},
    "hertz": {"radius": 0.05, "height": 0.02, "pressure": "hertz"},
    "box": {"base": "box:0.1x0.06", "height": 0.02},
}
FIRM = pt.Floor(static_ratio=S)


def run_of(puck: pt.Puck, floor: pt.Floor = FIRM, **parts: Any) -> pt.results.Run:
    run = pt.Scene(puck, floor, tol=1e-9, **parts).simulate([0.0, 0.1])
    assert abs(run.energy_residual) < 1e-9
    return run


def told(run: pt.results.Run) -> list[tuple[str, float]]:
    return [(event.what, event.time) for event in run.events]


def close(found: list[tuple[str, float]], *wanted: tuple[str, float]) -> bool:
    same = [what for what, _ in found] == [what for what, _ in wanted]
    return same and all(abs(a - b) < 2e-9 for (_, a), (_, b) in zip(found, wanted, strict=True))


@pytest.mark.parametrize("name", BODIES)
def test_a_force_that_grows_moves_a_body_at_the_static_limit(name: str) -> None:
    """F = 4 N/s t until 1 s, then none: slips at S F m g, then F m g brakes."""
    puck = pt.Puck(**BODIES[name], friction=F, mass=1.0)
    run = run_of(puck, force=pt.Force(over_time=((0.0, 0.0, 0.0), (1.0, 4.0, 0.0))))
    begins = S * F * G / 4.0
    speed = 2.0 * (1.0 - begins**2) - F * G * (1.0 - begins)
    way = 2.0 * (1.0 - begins**3) / 3.0 - 2.0 * begins**2 * (1.0 - begins)
    way += speed**2 / (2.0 * F * G) - F * G * (1.0 - begins) ** 2 / 2.0
    assert close(told(run), ("slip", begins), ("stick", 1.0 + speed / (F * G)))
    assert abs(run.last["x"] - way) < 2e-9 and abs(run.last["y"]) < 1e-12


@pytest.mark.parametrize("name", ["flat", "tall", "box"])
def test_a_slope_beside_the_static_angle(name: str) -> None:
    puck = pt.Puck(**BODIES[name], friction=F)
    for beyond in (-1e-6, -1e-9, 1e-9, 1e-6):
        slope = math.atan(S * F * (1.0 + beyond))
        run = run_of(puck, pt.Floor(slope=slope, static_ratio=S), time=0.5)
        pull = G * (math.sin(slope) - F * math.cos(slope)) if beyond > 0.0 else 0.0
        assert abs(run.last["x"] - 0.125 * pull) < 1e-9
        assert run.end == ("time is up" if beyond > 0.0 else "at rest")


@pytest.mark.parametrize("name", ["flat", "box"])
def test_what_is_thrown_up_a_slope_stays_there_if_it_stops(name: str) -> None:
    """Steeper than F, less than S F."""
    slope, puck = math.atan(1.2 * F), pt.Puck(**BODIES[name], friction=F)
    up = pt.Launch((-0.6, 0.0))
    run = run_of(puck, pt.Floor(slope=slope, static_ratio=S), launch=up)
    brake = G * (math.sin(slope) + F * math.cos(slope))
    assert close(told(run), ("stick", 0.6 / brake))
    assert abs(run.last["x"] + 0.18 / brake) < 1e-9
    back = run_of(puck, pt.Floor(slope=slope, static_ratio=1.1), launch=up, time=1.0)
    pull, left = G * (math.sin(slope) - F * math.cos(slope)), 1.0 - 0.6 / brake
    assert abs(back.last["x"] + 0.18 / brake - 0.5 * pull * left**2) < 1e-9


def test_down_that_slope_it_slides_for_ever() -> None:
    slope = math.atan(1.2 * F)
    down = run_of(
        pt.Puck(0.05, friction=F), pt.Floor(slope=slope, static_ratio=S),
        launch=pt.Launch((0.1, 0.0)), time=2.0,
    )  # fmt: skip
    pull = G * (math.sin(slope) - F * math.cos(slope))
    assert not down.events and abs(down.last["vx"] - 0.1 - 2.0 * pull) < 1e-9


@pytest.mark.parametrize("name", BODIES)
def test_a_belt_that_starts_carries_or_slips(name: str) -> None:
    """At 2.5 m/s^2 for 0.2 s, then stopped as fast; F g is 1.96 m/s^2."""
    puck, rows = pt.Puck(**BODIES[name], friction=F), ((0, 0, 0), (0.2, 0.5, 0), (0.4, 0, 0))
    held = run_of(puck, pt.Floor(over_time=rows, static_ratio=1.3), time=0.6)
    assert abs(held.last["x"] - 0.1) < 1e-12 and not held.events
    assert held.end == "at rest" and held.end_time == 0.4
    slid = run_of(puck, pt.Floor(over_time=rows, static_ratio=1.2))
    brake, rate = F * G, 2.5
    one = 2.0 * rate * 0.2 / (brake + rate)  # as slow as the belt, which loses it at once
    speed, way = brake * one, 0.5 * brake * one**2
    assert abs(slid.end_time - 2.0 * one) < 1e-9
    assert abs(slid.last["x"] - way - speed**2 / (2.0 * brake)) < 1e-9


def test_a_torque_that_grows_turns_it_at_the_static_limit() -> None:
    for base, arm in (({"radius": 0.05}, 2.0 / 3.0 * 0.05), (
        {"base": "box:0.1x0.1"}, 0.1 * (math.sqrt(2.0) + math.asinh(1.0)) / 6.0
    )):  # fmt: skip
        puck = pt.Puck(**base, friction=F, mass=1.0)
        force = pt.Force(over_time=((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.2)))
        run = run_of(puck, force=force, time=1.0)
        begins = S * F * G * arm / 0.2
        assert close(told(run), ("slip", begins))
        inertia = puck.mass * (0.00125 if "radius" in base else 0.01 / 6.0)
        spin = (0.1 * (1.0 - begins**2) - F * G * arm * (1.0 - begins)) / inertia
        assert abs(run.last["spin"] - spin) < 1e-8 * spin
        assert abs(run.last["x"]) < 1e-12


def test_a_force_beside_a_torque_as_the_power_of_all_slips_has_it() -> None:
    """Flat box: it holds while no slip gains power, friction summed over a grid of its own."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    x, y = np.meshgrid(0.05 * nodes, 0.03 * nodes)
    share = np.outer(weights, weights) / 4.0
    push = np.array([1.2, 0.9])

    def gain(slip: np.ndarray, torque: float) -> float:
        vx, vy, w = slip / math.hypot(slip[0], slip[1], 0.04 * slip[2])
        rub = S * F * G * (share * np.hypot(vx - w * y, vy + w * x)).sum()
        return float(push @ (vx, vy) + torque * w - rub)

    def best(torque: float) -> float:
        start = [*push, 30.0]
        return -minimize(lambda s: -gain(s, torque), start, method="Nelder-Mead", tol=1e-12).fun

    limit = brentq(best, 0.0, 0.2)
    force = pt.Force(tuple(push), over_time=((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.2)))
    run = run_of(pt.Puck(base="box:0.1x0.06", friction=F, mass=1.0), force=force, time=0.9)
    assert run.events[0].what == "slip" and abs(0.2 * run.events[0].time - limit) < 2e-6


@pytest.mark.parametrize("ratio", [1.0, S])
def test_a_tall_box_on_a_pivot_holds_by_the_static_load(ratio: float) -> None:
    """Its load leans with the friction that holds; summed over a grid of its own."""
    nodes, weights = np.polynomial.legendre.leggauss(100)
    x, y = np.meshgrid(0.05 * nodes, 0.03 * nodes)
    share, arm = np.outer(weights, weights) / 4.0, np.hypot(x - 0.08, y)
    lean = np.zeros(2)
    for _ in range(100):
        load = share * (1.0 + lean[0] * x + lean[1] * y)
        force = ratio * F * np.array([(load * y / arm).sum(), (load * (0.08 - x) / arm).sum()])
        lean = 0.015 * force * 12.0 / np.array([0.01, 0.0036])
    begins = ratio * F * G * (load * arm).sum() / 0.6
    run = run_of(
        pt.Puck(base="box:0.1x0.06", height=0.03, friction=F, mass=1.0),
        pt.Floor(static_ratio=ratio),
        constraint=pt.Constraint("pivot", reach=0.08), time=0.6,
        force=pt.Force(over_time=((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.6))),
    )  # fmt: skip
    assert run.events[0].what == "slip" and abs(run.events[0].time - begins) < 1e-10


@pytest.mark.parametrize("friction", [{"law": pt.StribeckLaw(static=0.2, kinetic=0.1, speed=0.2)},
                                      {"orthotropic": pt.Orthotropic((0.2, 0.3))},
                                      {"grips": [pt.Grip([[0.0, 0.5], [9.0, 0.5]])]},
                                      {"strips": pt.Strips((0.0,), (0.2, 0.2))}])  # fmt: skip
def test_it_is_a_factor_of_every_friction(friction: dict[str, Any]) -> None:
    """Along x all have 0.2 at rest, or half of 0.4."""
    for body in ({"radius": 0.05, "height": 0.02}, BODIES["box"]):
        puck = pt.Puck(**body, friction=0.4 if "grips" in friction else 0.2, mass=1.0)
        force = pt.Force(over_time=((0.0, 0.0, 0.0), (1.0, 4.0, 0.0)))
        run = pt.Scene(
            puck, pt.Floor(**friction, static_ratio=S), force=force, time=0.8, tol=1e-5
        ).simulate([0.0])
        first = run.events[0]
        assert first.what == "slip" and abs(first.time - S * 0.2 * G / 4.0) < 1e-6


def test_one_belt_holds_by_static_friction_what_another_rubs_by_kinetic() -> None:
    """A bar, 3/5 of it on a belt at rest, the other across one that runs.

    The rubbed part has 2/5 F N, halfway along it.  The part that rests, P = 3/5 s F N over l, bears
    it about a point d off its middle: P 2 d/l = 2/5 F N, P (l/4 - d^2/l) = its moment.
    """
    least = (10.0 + math.sqrt(136.0)) / 9.0
    floor = {"strips": pt.Strips((0.0,), (0.2, 0.2), along=(0.0, 0.5))}
    box = pt.Puck(base="box:0.1x0.0002", friction=F)
    parts: dict[str, Any] = {"launch": pt.Launch(position=(-0.01, 0.0)), "time": 0.3}
    still = run_of(box, pt.Floor(**floor, static_ratio=least + 1e-3), **parts)
    assert not [event for event in still.events if event.what == "slip"]
    assert abs(still.last["vy"]) < 1e-12
    goes = run_of(box, pt.Floor(**floor, static_ratio=least - 1e-3), **parts)
    assert goes.last["spin"] > 0.01


def test_pucks_that_lean_on_each_other_are_moved_when_all_of_them_are() -> None:
    """A force on the first of three in a row: all break away at S F g of all their masses."""
    masses, rows = (1.0, 0.5, 0.7), ((0.0, 0.0, 0.0), (1.0, 12.0, 0.0))
    row = [
        pt.Puck(0.05, friction=F, mass=mass, launch=pt.Launch(position=(0.1 * n, 0.0)),
                force=pt.Force(over_time=rows) if n == 0 else pt.Force())
        for n, mass in enumerate(masses)
    ]  # fmt: skip
    run = pt.Scene(pucks=row, floor=FIRM, time=0.8).simulate([0.0])
    whole = sum(masses)
    begins = S * F * G * whole / 12.0
    slips = [event.time for event in run.events if event.what == "slip"]
    assert len(slips) == 3 and np.abs(np.array(slips) - begins).max() < 1e-8
    left = 0.8 - begins
    speed = (6.0 * (0.64 - begins**2) - F * G * whole * left) / whole
    assert np.abs(np.array(run.last["vx"]) - speed).max() < 1e-7
    assert abs(run.energy_residual) < 1e-9


def test_on_a_slope_two_rest_and_a_third_that_hits_them_moves_both() -> None:
    slope = math.atan(1.2 * F)
    pucks = [
        pt.Puck(0.05, friction=F, launch=pt.Launch(position=(x, 0.0))) for x in (0.0, 0.1)
    ]  # fmt: skip
    hits = pt.Puck(0.05, friction=F, launch=pt.Launch((0.5, 0.0), position=(-0.2, 0.0)))
    floor = pt.Floor(slope=slope, static_ratio=S)
    assert pt.Scene(pucks=pucks, floor=floor, time=1.0).simulate([0.0]).end == "at rest"
    run = pt.Scene(pucks=[*pucks, hits], floor=floor, time=1.0).simulate([0.0])
    assert run.last["vx"][1] > 0.5  # nothing holds what slides there


def test_from_a_file_a_sweep_and_what_is_told() -> None:
    tables = {
        "puck": {"radius": 0.05, "friction": 0.2}, "floor": {"slope": 0.25, "static_ratio": 1.5},
        "time": 0.5,
    }  # fmt: skip
    scene = pt.Scene.from_tables(tables)
    run = scene.simulate([0.0])
    assert run.end == "at rest" and "holds 1.5 times what it brakes" in run.explain()
    ends = pt.Scene(pt.Puck(0.05, friction=0.2), pt.Floor(slope=0.25, static_ratio=[1.0, 1.2, 1.4]),
                    time=0.5).sweep()  # fmt: skip
    assert (ends.x == 0.0).tolist() == [False, False, True]


def test_what_is_wrong_is_said() -> None:
    with pytest.raises(pt.InputError, match=r"floor\.static_ratio"):
        pt.Scene(pt.Puck(0.05), pt.Floor(static_ratio=0.9))
    body = pt.Puck(0.05, height=0.09, friction=0.2, pressure="hertz")
    pt.Scene(body)
    with pytest.raises(pt.InputError, match=r"floor\.static_ratio: .*height"):
        pt.Scene(body, pt.Floor(static_ratio=1.5))


def test_static_friction_may_lift_a_base() -> None:
    """A push tips it where that times the height of the centre is what m g bears to a side."""
    body = pt.Puck(base="box:0.1x0.06", height=0.3, friction=0.2)
    firm = pt.Floor(static_ratio=2.5)
    for push, end in ((0.199, "at rest"), (0.21, "tipped over")):
        force = pt.Force((0.0, push * body.gravity))
        assert pt.Scene(body, firm, force=force, time=1.0).simulate().end == end
