"""Scenes with answers in closed form: states to 1e-9, times of events to 1e-10."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pucks import simulate
from scenes import simulate_scene

from puck_tables import resultants
from puck_tables.scene.run import Run

G = 9.80665


def scene(**parts: Any) -> dict[str, Any]:
    """A puck of 1 m and 1 kg on f = 0.2, launched along x, and what else there is."""
    whole: dict[str, Any] = {
        "puck": {"radius": 1.0, "friction": 0.2},
        "launch": {"velocity": [3.0, 0.0]}, "tol": 1e-11,
    }  # fmt: skip
    for part, values in parts.items():
        whole[part] = {**whole.get(part, {}), **values} if isinstance(values, dict) else values
    return whole


def event(run: Run, what: str, count: int = 0) -> float:
    return [e[0] for e in run.events if e[1] == what][count]


@pytest.mark.parametrize("slope", [0.1, math.atan(0.2) - 0.01])
def test_down_an_incline_to_rest(slope: float) -> None:
    brake = G * (0.2 * math.cos(slope) - math.sin(slope))
    run = simulate_scene(scene(floor={"slope": slope}))
    assert run.end == "at rest"
    assert run.end_time == pytest.approx(3.0 / brake, rel=1e-10)
    assert run.last["x"] == pytest.approx(4.5 / brake, rel=1e-9)
    assert run.last["y"] == 0.0 and run.last["orientation"] == 0.0


def test_up_an_incline_and_down_again() -> None:
    slope = 0.5
    up = G * (math.sin(slope) + 0.2 * math.cos(slope))
    down = G * (math.sin(slope) - 0.2 * math.cos(slope))
    turn, top = 3.0 / up, 4.5 / up
    times = np.array([0.5 * turn, turn, turn + 0.5, turn + 2.0])
    launch = {"velocity": [-3.0, 0.0]}
    run = simulate_scene(scene(floor={"slope": slope}, launch=launch, time=turn + 2.0), times)
    late = times[2:] - turn
    assert np.abs(run.columns["x"][2:] - (0.5 * down * late**2 - top)).max() <= 1e-9
    assert np.abs(run.columns["vx"][2:] - down * late).max() <= 1e-9
    assert run.columns["x"][1] == pytest.approx(-top, abs=1e-9)
    assert np.all(run.columns["y"] == 0.0)


def test_just_below_the_threshold_nothing_creeps() -> None:
    launch = {"velocity": [0.0, 0.0]}
    times = [0.0, 1.0, 1e6]
    run = simulate_scene(scene(floor={"slope": math.atan(0.2) - 1e-9}, launch=launch), times)
    assert run.end == "at rest" and run.end_time == 0.0
    for name in ("x", "y", "orientation", "vx", "vy", "spin"):
        assert np.all(run.columns[name] == 0.0)


def test_position_is_constant_to_the_bit_after_rest() -> None:
    run = simulate_scene(scene(floor={"slope": 0.1}, launch={"spin": 2.0}), [5.0, 50.0, 1e5])
    assert run.end_time < 5.0
    for name in ("x", "y", "orientation"):
        assert len(set(run.columns[name].tolist())) == 1


def test_just_above_the_threshold_it_slides_for_ever() -> None:
    slope = math.atan(0.2) + 1e-9
    pull = G * (math.sin(slope) - 0.2 * math.cos(slope))
    run = simulate_scene(scene(floor={"slope": slope}, time=100.0))
    assert run.end == "time is up" and run.end_time == 100.0
    assert run.last["vx"] == pytest.approx(3.0 + 100.0 * pull, abs=3e-9)
    still = simulate_scene(
        scene(floor={"slope": slope}, launch={"velocity": [0.0, 0.0]}, time=100.0)
    )
    assert still.end == "time is up"
    assert still.last["x"] == pytest.approx(0.5e4 * pull, rel=1e-6)


def test_drag_and_friction_stop_a_slide() -> None:
    c, brake = 0.8, 0.2 * G
    run = simulate_scene(scene(drag={"sliding": c}))
    stop = math.log(1.0 + c * 3.0 / brake) / c
    assert run.end_time == pytest.approx(stop, rel=1e-10)
    assert run.last["x"] == pytest.approx(3.0 / c - brake / c * stop, rel=1e-9)


def test_drag_and_friction_stop_a_spin() -> None:
    c, inertia = 0.3, 0.5
    torque = 2.0 / 3.0 * 0.2 * G
    run = simulate_scene(scene(drag={"spinning": c}, launch={"velocity": [0.0, 0.0], "spin": 5.0}))
    stop = inertia / c * math.log(1.0 + c * 5.0 / torque)
    assert run.end_time == pytest.approx(stop, rel=1e-10)
    turned = 5.0 * inertia / c - torque / c * stop
    assert run.last["orientation"] == pytest.approx(turned, rel=1e-9)
    assert run.last["x"] == 0.0 and run.last["y"] == 0.0


def test_a_belt_shifts_the_frame() -> None:
    belt, drag, times = (1.5, -0.5), {"sliding": 0.1}, [0.2, 0.5, 0.9]
    here = scene(launch={"velocity": [2.0, 1.0], "spin": 4.0}, drag=drag)
    there = scene(
        launch={"velocity": [3.5, 0.5], "spin": 4.0}, drag=drag, floor={"velocity": list(belt)}
    )
    at, moved = simulate_scene(here, times), simulate_scene(there, times)
    for i, name in enumerate(("x", "y")):
        shift = belt[i] * np.array(times)
        assert np.abs(moved.columns[name] - at.columns[name] - shift).max() <= 1e-9
        assert np.abs(moved.columns["v" + name] - at.columns["v" + name] - belt[i]).max() <= 1e-9
    ends = simulate_scene(here), simulate_scene(there)
    assert ends[1].end == "carried by the floor"
    assert ends[1].end_time == pytest.approx(ends[0].end_time, rel=1e-10)


@pytest.mark.parametrize("height", [0.0, 2.0])
def test_a_rail_bears_the_force_across(height: float) -> None:
    """Friction along the path does not notice the rail; only ρ_⊥ bends a free path."""
    angle, spin, delta = 0.7, 4.0, 0.4 * height
    launch = {"velocity": [3.0 * math.cos(angle), 3.0 * math.sin(angle)], "spin": spin}
    run = simulate_scene(
        scene(puck={"height": height}, launch=launch, constraint={"kind": "rail", "angle": angle})
    )
    free = simulate((3.0, 0.0), spin, delta=delta, decel=0.2 * G, tol=1e-11)
    assert run.end_time == pytest.approx(free.stop_time, rel=1e-9)
    assert math.hypot(run.last["x"], run.last["y"]) == pytest.approx(free.path_length, rel=1e-9)
    phi = math.atan2(spin, 3.0)
    across = 0.2 * G * math.sin(phi) * math.cos(phi) * float(resultants(phi, delta).perpendicular)
    assert run.columns["lambda_1"][0] == pytest.approx(across, abs=1e-9)


def test_a_rail_that_moves_with_the_belt_is_a_rail_on_the_floor() -> None:
    here = scene(launch={"spin": 3.0}, constraint={"kind": "rail"})
    there = scene(
        launch={"velocity": [4.0, 0.5], "spin": 3.0}, floor={"velocity": [1.0, 0.5]},
        constraint={"kind": "rail", "velocity": [0.0, 0.5]},
    )  # fmt: skip
    at, moved = simulate_scene(here, [0.3, 0.8]), simulate_scene(there, [0.3, 0.8])
    for name, shift in (("x", 1.0), ("y", 0.5)):
        moves = moved.columns[name] - at.columns[name] - shift * np.array([0.3, 0.8])
        assert np.abs(moves).max() <= 1e-9


@pytest.mark.parametrize("tol", [1e-2, 1e-4, 1e-7])
def test_a_rail_that_is_led_across_the_floor_lets_no_puck_rest(tol: float) -> None:
    """A slip of 4 mm/s across is left when that along the rail has died out."""
    run = simulate_scene(
        scene(
            launch={"velocity": [3.0, 0.004], "spin": 0.5},
            tol=tol,
            time=9.0,
            constraint={"kind": "rail", "velocity": [0.0, 0.004]},
        )
    )
    unit = 3.0**2 / (0.2 * G)
    assert run.end == "time is up"
    assert abs(run.last["y"] - 0.004 * 9.0) <= tol * unit
    assert abs(run.last["vx"]) <= 3.0 * tol and run.last["vy"] == pytest.approx(0.004, rel=1e-12)


@pytest.mark.parametrize("tol", [1e-2, 1e-4, 1e-7])
def test_a_puck_follows_the_pivot_that_pulls_it_slowly(tol: float) -> None:
    reach, speed = 0.1, 0.02
    run = simulate_scene(
        scene(
            puck={"radius": 0.1},
            tol=tol,
            time=200.0,
            launch={"velocity": [speed, -reach * 6.0], "spin": 6.0},
            constraint={"kind": "pivot", "reach": reach, "velocity": [speed, 0.0]},
        )
    )
    assert run.end == "time is up"
    assert run.last["x"] == pytest.approx(speed * 200.0, abs=tol * 0.2)
    assert abs(run.last["y"]) <= tol * 0.2 and run.last["vx"] == pytest.approx(speed, rel=tol)


def test_a_pivot_brakes_at_constant_rate() -> None:
    """The slip angle is atan(r/d) for ever, so is the torque."""
    reach, spin = 0.6, 5.0
    phi = math.atan2(1.0, reach)
    rho = resultants(phi, 0.0)
    force = 0.2 * G * math.cos(phi) * float(rho.parallel)
    torque = 0.5 * 0.2 * G * math.sin(phi) * float(rho.spin)
    rate = (torque + reach * force) / (0.5 + reach**2)
    run = simulate_scene(
        scene(launch={"velocity": None, "spin": spin}, constraint={"kind": "pivot", "reach": reach})
        | {"launch": {"spin": spin}},
        [0.0, 1.0],
    )
    assert run.end_time == pytest.approx(spin / rate, rel=1e-10)
    assert run.columns["spin"][1] == pytest.approx(spin - rate, rel=1e-9)
    turned = 0.5 * spin**2 / rate
    assert run.last["orientation"] == pytest.approx(turned, rel=1e-9)
    assert math.hypot(run.last["x"] - reach, run.last["y"]) == pytest.approx(reach, rel=1e-13)
    # at the launch the centre is at the origin, the pivot at (d, 0), v = (0, −ω d)
    assert run.columns["lambda_1"][0] == pytest.approx(reach * spin**2, rel=1e-9)
    assert run.columns["lambda_2"][0] == pytest.approx(rate * reach - force, rel=1e-9)


def test_a_blade_without_spin_is_a_rail() -> None:
    angle = 0.4
    launch = {"velocity": [3.0 * math.cos(angle), 3.0 * math.sin(angle)]}
    run = simulate_scene(scene(launch=launch, constraint={"kind": "blade", "angle": angle}))
    assert run.end_time == pytest.approx(3.0 / (0.2 * G), rel=1e-10)
    way = 4.5 / (0.2 * G)
    assert run.last["x"] == pytest.approx(way * math.cos(angle), rel=1e-9)
    assert run.last["y"] == pytest.approx(way * math.sin(angle), rel=1e-9)


def test_a_blade_on_ice_goes_in_circles() -> None:
    """No friction: speed and spin are constant, the radius is v/ω, the reaction m v ω."""
    run = simulate_scene(
        scene(
            puck={"friction": 0.0}, launch={"spin": 2.0}, constraint={"kind": "blade"},
            time=4.0,
        ),
        [1.0, 2.5],
    )  # fmt: skip
    turn = 2.0 * np.array([1.0, 2.5])
    assert np.abs(run.columns["x"] - 1.5 * np.sin(turn)).max() <= 1e-9
    assert np.abs(run.columns["y"] - 1.5 * (1.0 - np.cos(turn))).max() <= 1e-9
    assert np.abs(run.columns["lambda_1"] - 6.0).max() <= 1e-9


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_turntable_carries_up_to_its_limit(side: float) -> None:
    turning = 1.4
    limit = 0.2 * G / turning**2
    place = limit * (1.0 + side * 1e-9)
    run = simulate_scene(
        scene(
            floor={"turning": turning},
            launch={"velocity": [0.0, turning * place], "spin": turning, "position": [place, 0.0]},
            time=3.0,
        ),
        [1.0, 2.0, 3.0],
    )
    if side < 0.0:
        assert np.all(run.columns["carried"] == 1.0)
        turn = turning * np.array([1.0, 2.0, 3.0])
        assert np.abs(run.columns["x"] - place * np.cos(turn)).max() <= 1e-9
        assert np.abs(run.columns["y"] - place * np.sin(turn)).max() <= 1e-9
        assert np.abs(run.columns["orientation"] - turn).max() <= 1e-9
    else:
        assert np.all(run.columns["carried"] == 0.0)
        assert math.hypot(run.last["x"], run.last["y"]) > place


def test_a_triangle_of_force_moves_and_stops_it(tmp_path: Any) -> None:
    """F = a t up to t = 1 and back: slips at F = f N, then piecewise polynomials of degree 3."""
    hold, peak = 0.2 * G, 4.0
    path = tmp_path / "force.csv"
    np.savetxt(path, [[0, 0, 0], [1, peak, 0], [2, 0, 0]], delimiter=",")
    run = simulate_scene(scene(launch={"velocity": [0.0, 0.0]}, force={"over_time": str(path)}))
    slips = hold / peak
    assert event(run, "slip") == pytest.approx(slips, rel=1e-10)
    fast = 0.5 * peak * (1.0 - slips) ** 2  # the speed at t = 1
    way = peak * (1.0 - slips) ** 3 / 6.0
    # v = fast + (peak − hold) s − ½ peak s² for s = t − 1 in [0, 1], then − hold
    at_two = fast + (peak - hold) - 0.5 * peak
    assert at_two > 0.0
    way += fast + 0.5 * (peak - hold) - peak / 6.0
    assert run.end_time == pytest.approx(2.0 + at_two / hold, rel=1e-9)
    assert run.last["x"] == pytest.approx(way + 0.5 * at_two**2 / hold, rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_quadratic_drag(friction: float) -> None:
    """m v′ = −c v² − f m g: v0/(1 + c v0 t/m), or atan(v0 k)/(k f g) with k² = c/(m f g)."""
    drag, mass, v0 = 0.3, 0.2, 3.0
    tables = scene(drag={"quadratic": drag}, time=2.0, puck={"friction": friction})
    tables["puck"]["mass"] = mass
    run = simulate_scene(tables)
    if friction == 0.0:
        fall = 1.0 + drag * v0 * 2.0 / mass
        assert run.last["vx"] == pytest.approx(v0 / fall, abs=1e-10)
        assert run.last["x"] == pytest.approx(mass / drag * math.log(fall), abs=1e-10)
    else:
        k2 = drag / (mass * friction * G)
        assert run.end_time == pytest.approx(math.atan(v0 * math.sqrt(k2)) / (
            math.sqrt(k2) * friction * G), abs=1e-10)  # fmt: skip
        far = mass / (2.0 * drag) * math.log(1.0 + k2 * v0 * v0)
        assert run.last["x"] == pytest.approx(far, abs=1e-10)
    assert run.energy_residual < 1e-10
    assert run.last["heat_viscous"] > 0.0
