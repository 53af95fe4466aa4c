"""Floors whose motion changes over time: trays that shake, turntables that speed up."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from reference import friction as disc_friction
from scipy.integrate import solve_ivp

import puck_tables as pt

G, STATE = 9.80665, ("x", "y", "orientation", "vx", "vy", "spin")
PUCKS: dict[str, dict[str, Any]] = {
    "flat": {"radius": 0.05},
    "tall": {"radius": 0.05, "height": 0.06},
    "hertz": {"radius": 0.05, "height": 0.03, "pressure": "hertz"},
    "box": {"base": "box:0.1x0.06", "height": 0.04},
}
WHILE = 0.2  # s: between the turns of a tray


def shakes(rate: float, turns: int = 3) -> pt.Floor:
    """A tray that is at rest, and speeds up and slows down again and again."""
    rows = [[0.0, 0.0, 0.0]]
    for n in range(turns):
        rows.append([WHILE * (n + 1), rate * WHILE * (1 - n % 2), 0.0])
    return pt.Floor(over_time=rows)


def run_of(puck: pt.Puck, floor: pt.Floor, **parts: Any) -> pt.results.Run:
    run = pt.Scene(puck, floor, **parts).simulate([0.0, 0.1])
    assert abs(run.energy_residual) < 1e-9
    return run


@pytest.mark.parametrize("name", PUCKS)
def test_a_tray_carries_what_friction_holds(name: str) -> None:
    puck = pt.Puck(**PUCKS[name], friction=0.2)
    for rate in (0.5 * 0.2 * G, (1.0 - 1e-9) * 0.2 * G):
        run = run_of(puck, shakes(rate), time=0.8)
        assert not run.events
        way = rate * WHILE**2 * 2.5  # up, down, up, and on
        assert abs(run.last["x"] - way) < 1e-13 and abs(run.last["vx"] - rate * WHILE) < 1e-14
        assert run.last["y"] == run.last["spin"] == 0.0 and abs(run.last["heat_dry"]) < 1e-14


@pytest.mark.parametrize("name", ["flat", "box"])
def test_above_that_it_slips_as_the_closed_form_says(name: str) -> None:
    rate, brake = 2.5, 0.2 * G
    one = 2.0 * rate * WHILE / (brake + rate)  # behind the tray until it is as slow
    two = 2.0 * (brake * one + rate * WHILE) / (rate + brake)  # ahead of it
    speed = rate * (two - 2.0 * WHILE)
    stops = two + (rate * WHILE - speed) / brake
    way = brake * one**2 / 2.0 + brake * one * (two - one) - brake * (two - one) ** 2 / 2.0
    way += speed * (stops - two) + brake * (stops - two) ** 2 / 2.0
    way += rate * WHILE * (0.8 - stops)
    run = run_of(pt.Puck(**PUCKS[name], friction=0.2), shakes(rate), time=0.8)
    told = [(event.what, event.time) for event in run.events]
    assert told[-1][0] == "stick" and abs(told[-1][1] - stops) < 1e-9
    assert abs(run.last["x"] - way) < 1e-9


@pytest.mark.parametrize("name", PUCKS)
def test_a_tray_that_speeds_up_is_a_force_in_its_frame(name: str) -> None:
    rate, until, puck = 1.1, 0.4, pt.Puck(**PUCKS[name], friction=0.25)
    launch = pt.Launch((0.8, 0.3), 9.0, orientation=0.4)
    tray = pt.Floor(over_time=[[0.0, 0.0, 0.0], [1.0, rate, 0.5 * rate]])
    moved = run_of(puck, tray, launch=launch, time=until).last
    force = pt.Force((-rate * puck.mass, -0.5 * rate * puck.mass))
    pulled = run_of(puck, pt.Floor(), launch=launch, force=force, time=until).last
    speeds = np.array([rate * until, 0.5 * rate * until])
    shift = np.array([*(0.5 * until * speeds), 0.0, *speeds, 0.0])
    gap = [moved[name] - pulled[name] for name in STATE] - shift
    assert np.abs(gap).max() < 1e-9


def test_rows_that_change_nothing_are_a_belt() -> None:
    puck, launch = pt.Puck(0.05, 0.04, friction=0.2), pt.Launch((0.5, 0.3), 7.0)
    rows = [[0.0, 0.3, -0.1, 0.8], [1.0, 0.3, -0.1, 0.8]]
    centre = (0.1, 0.05)
    over = run_of(puck, pt.Floor(over_time=rows, centre=centre), launch=launch, time=0.6, tol=1e-12)
    plain = run_of(
        puck, pt.Floor(velocity=(0.3, -0.1), turning=0.8, centre=centre), launch=launch, time=0.6,
        tol=1e-12,
    )  # fmt: skip
    assert max(abs(over.last[name] - plain.last[name]) for name in STATE) < 1e-11


def test_a_turntable_loses_a_coin_where_its_rim_gets_too_fast() -> None:
    gains, place, friction = 2.0, 0.2, 0.2
    table = pt.Floor(over_time=[[0.0, 0.0, 0.0, 0.0], [3.0, 0.0, 0.0, 3.0 * gains]])
    coin = pt.Puck(1e-4, friction=friction)
    run = run_of(coin, table, launch=pt.Launch(position=(place, 0.0)), time=1.6)
    slips = ((friction * G / place) ** 2 - gains**2) ** 0.25 / gains
    told = next(event for event in run.events if event.what == "slip")
    assert abs(told.time - slips) < 1e-7
    # until then it goes round with the table
    early = run_of(coin, table, launch=pt.Launch(position=(place, 0.0)), time=1.5).last
    angle = 0.5 * gains * 1.5**2
    assert abs(early["x"] - place * math.cos(angle)) < 1e-9
    assert abs(early["y"] - place * math.sin(angle)) < 1e-9
    assert abs(early["orientation"] - angle) < 1e-9


def test_a_puck_on_a_turntable_that_speeds_up_as_another_program_has_it() -> None:
    radius, friction, until, centre = 0.05, 0.2, 0.35, (0.1, -0.1)

    def rates(t: float, y: np.ndarray) -> list[float]:
        vx, vy, omega = 0.4 * t, 0.2 - 0.3 * t, 1.0 + 2.0 * t
        ux = y[3] - vx + omega * (y[1] - centre[1])
        uy = y[4] - vy - omega * (y[0] - centre[0])
        ax, ay, turning = disc_friction(ux, uy, radius * (y[5] - omega), 0.0)
        return [*y[3:], friction * G * ax, friction * G * ay, friction * G * turning / radius]

    start = [0.0, 0.0, 0.0, 1.5, 0.4, 3.0]
    judged = solve_ivp(rates, (0.0, until), start, "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    table = pt.Floor(
        centre=centre,
        over_time=[[0.0, 0.0, 0.2, 1.0], [0.5, 0.2, 0.05, 2.0], [1.0, 0.4, -0.1, 3.0]],
    )
    launch = pt.Launch((1.5, 0.4), 3.0)
    run = run_of(pt.Puck(radius, friction=friction), table, launch=launch, time=until)
    assert np.abs([run.last[name] for name in STATE] - judged).max() < 1e-8


def test_pucks_on_a_tray_meet_and_are_carried_together() -> None:
    def pucks(*launches: pt.Launch) -> list[pt.Puck]:
        return [pt.Puck(0.05, 0.02, 0.2, launch=one, restitution=0.6) for one in launches]

    rest = pucks(pt.Launch(position=(0.0, 0.0)), pt.Launch(position=(0.1, 0.0)))
    run = pt.Scene(pucks=rest, floor=shakes(1.5), time=0.8).simulate([0.0])
    assert np.abs(np.array(run.last["x"]) - [0.15, 0.25]).max() < 1e-13
    assert abs(run.energy_residual) < 1e-9
    wall = pt.Wall((0.16, 0.0), normal=(-1.0, 0.0), restitution=0.5)
    pushed = pt.Scene(pucks=rest, floor=shakes(1.5, 1), walls=[wall], time=0.6).simulate([0.0])
    assert abs(pushed.last["x"][1] - 0.11) < 1e-9 and abs(pushed.last["x"][0] - 0.01) < 1e-9
    assert abs(pushed.energy_residual) < 1e-9
    hit = pucks(pt.Launch((1.0, 0.05), 3.0), pt.Launch(position=(0.2, 0.02)))
    played = pt.Scene(pucks=hit, floor=shakes(2.5), time=1.0).simulate([0.0])
    assert "impact" in {event.what for event in played.events}
    assert abs(played.energy_residual) < 1e-9


def test_the_motion_from_a_file_and_beside_grips(tmp_path: Path) -> None:
    file = tmp_path / "tray.csv"
    file.write_text("t [ms],vx [cm/s],vy [cm/s]\n0,0,0\n200,50,0\n400,0,0\n600,50,0\n")
    puck, grip = pt.Puck(0.05, friction=0.4), pt.Grip([[0.0, 0.5], [1.0, 0.5]])
    last = run_of(puck, pt.Floor(over_time=str(file), grips=[grip]), time=0.8).last
    plain = run_of(pt.Puck(0.05, friction=0.2), shakes(2.5), time=0.8).last
    assert max(abs(last[name] - plain[name]) for name in STATE) < 1e-9


def test_when_the_tray_stops_its_puck_comes_to_rest() -> None:
    floor = pt.Floor(over_time=[[0.0, 0.0, 0.0], [0.2, 0.5, 0.0], [0.3, 0.0, 0.0]])
    run = run_of(pt.Puck(0.05, friction=0.2), floor)
    assert run.end == "at rest" and run.events[-1].what == "stick"
    speed = 0.2 * G * 0.2
    meets = 0.2 + (0.5 - speed) / (0.2 * G + 5.0)
    speed += 0.2 * G * (meets - 0.2)
    assert abs(run.end_time - meets - speed / (0.2 * G)) < 1e-9


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "back": ({"over_time": [[1, 0, 0], [0, 0, 0]]}, "the times must ascend"),
    "no rows": ({"over_time": [[0, 1]]}, "must be rows of"),
    "a belt": ({"over_time": [[0, 0, 0], [1, 1, 0]], "velocity": (1.0, 0.0)}, "and floor.velocity"),
    "belts": (
        {"over_time": [[0, 0, 0], [1, 1, 0]],
         "strips": pt.Strips((0.0,), (0.1, 0.1), across=(0.1, 0.2))},
        "strips or patches with velocities",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_wrong_is_said(name: str) -> None:
    floor, words = REFUSED[name]
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(pt.Puck(0.05, friction=0.2), pt.Floor(**floor), time=1.0)


def test_a_rail_beside_it_is_refused() -> None:
    with pytest.raises(pt.InputError, match="not known beside floor"):
        pt.Scene(
            pt.Puck(0.05, friction=0.2), shakes(1.0), constraint=pt.Constraint("rail"), time=1.0
        )


@pytest.mark.parametrize("name", PUCKS)
def test_a_run_ends_when_the_tray_that_carries_stops(name: str) -> None:
    puck, rows = pt.Puck(**PUCKS[name], friction=0.2), ((0, 0, 0), (0.2, 0.3, 0), (0.4, 0, 0))
    for time in (None, 0.6):
        run = run_of(puck, pt.Floor(over_time=rows), time=time)
        assert (run.end, run.end_time) == ("at rest", 0.4) and not run.events
        assert abs(run.last["x"] - 0.06) < 1e-12
    goes_on = run_of(puck, pt.Floor(over_time=rows[:2]), time=0.6)
    assert goes_on.end == "carried by the floor" and abs(goes_on.last["x"] - 0.15) < 1e-12
