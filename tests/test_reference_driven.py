"""Benchmark cases that forces, slopes or floors drive: by closed forms, scipy and other judges."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from base_judge import Judge
from reference import friction
from scipy.integrate import dblquad, solve_ivp
from scipy.optimize import root
from test_reference_astride import shares_off

from puck_tables import reference_case
from puck_tables.reference.answer import Answer
from puck_tables.reference.cases import case_named

BOX = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]
LOAD, MASS, G = 0.3 * 0.5 * 9.81, 0.5, 9.81
GYRATION = math.sqrt((0.04 + 0.01) / 12.0)
NOT_YET = 0.97  # of the way to the stop, where scipy still has its digits


def test_a_force_that_grows_breaks_the_box_away() -> None:
    """Newton's law in one dimension: cubes of the time since the slip, then a parabola."""
    answer = reference_case("break-away-force")
    slip = 0.5 * LOAD
    left = 1.0 - slip  # s, until the force ends: it is 2 t, less what friction takes
    speed, place = left**2 / MASS, left**3 / (3.0 * MASS)
    stop = 1.0 + speed / (0.3 * G)
    place += 0.5 * speed**2 / (0.3 * G)
    assert answer.run.events[0].what == "slip"
    assert abs(answer.run.events[0].time - slip) < answer.time_bound
    assert abs(answer.end_time - stop) < answer.time_bound
    assert abs(answer.last()["x"] - place) < answer.place_bound
    before = answer([0.5])  # the floor has all of the force
    assert before.floor_fx.item() == pytest.approx(1.0, rel=1e-12)
    assert before.floor_torque.item() == 0.0
    assert np.isnan(before.epsilon) and np.isinf(answer([0.9]).epsilon)  # no ratio of rounding


def test_a_torque_that_grows_breaks_the_box_away() -> None:
    """As the force, with the mean distance of the base from its middle, by quadrature."""
    answer = reference_case("break-away-torque")
    arm = dblquad(math.hypot, 0.0, 0.05, 0.0, 0.1, epsabs=1e-13, epsrel=1e-13)[0] / 0.005
    held, inertia = LOAD * arm, MASS * GYRATION**2
    slip = held / 0.1
    left = 1.0 - slip
    spin, angle = 0.05 * left**2 / inertia, 0.05 * left**3 / (3.0 * inertia)
    stop = 1.0 + spin * inertia / held
    angle += 0.5 * spin**2 * inertia / held
    assert abs(answer.run.events[0].time - slip) < answer.time_bound
    assert abs(answer.end_time - stop) < answer.time_bound
    assert abs(answer.last()["orientation"] - 0.5 - angle) < answer.place_bound / 0.1
    assert answer([0.5]).floor_torque.item() == pytest.approx(0.05, rel=1e-12)


def disc_on_the_turntable() -> tuple[float, float, float, float]:
    """R, J, δ and how fast its floor turns ever faster."""
    puck = case_named("turntable-speeds-up").tables["puck"]
    j = puck["friction"] * puck["gravity"]
    return puck["radius"], j, 2.0 * puck["friction"] * puck["height"] / puck["radius"], 4.0


def test_a_turntable_that_speeds_up_loses_its_disc() -> None:
    """When force and torque together reach the limit surface, by elliptic integrals of scipy."""
    answer = reference_case("turntable-speeds-up")
    r, j, delta, alpha = disc_on_the_turntable()

    def lacks(z: np.ndarray) -> list[float]:
        """Over friction, at a time and a slip (φ, heading): it moves the disc as the floor does."""
        time, phi, heading = z
        rim, v = math.sin(phi), math.cos(phi)
        ax, ay, aw = friction(v * math.cos(heading), v * math.sin(heading), rim, delta)
        return [
            j * ax + (alpha * time) ** 2 * 0.2, j * ay - alpha * 0.2, j * aw - alpha * r,
        ]  # fmt: skip

    # the floor, ahead of it, slips inwards and forwards under the disc, which so slips backwards
    found = root(lacks, [0.745, -0.2, -0.4], tol=1e-13)
    assert found.success, found.message
    assert abs(answer.run.events[0].time - found.x[0]) < 10.0 * answer.time_bound
    held = answer([0.5])  # m a of where it is carried
    speed = alpha * 0.5
    pull = 0.1 * 0.2 * math.hypot(speed * speed, alpha)
    assert math.hypot(held.floor_fx.item(), held.floor_fy.item()) == pytest.approx(pull, rel=1e-9)
    torque = -0.5 * 0.1 * r * r * alpha
    assert held.floor_torque.item() == pytest.approx(torque, rel=1e-9)


@pytest.mark.parametrize("tol", [1e-4, 1e-6, 1e-9])
def test_what_is_carried_does_not_stick(tol: float) -> None:
    """Between pieces of its path a slip is only what these err by, within ``tol``."""
    scene = replace(case_named("turntable-speeds-up").scene(), tol=tol)
    assert [event.what for event in scene.simulate().events] == ["slip"]


def follow(answer: Answer, rates, start: float, times: np.ndarray) -> None:
    """Hold it against an integration of its own, from one of its states."""
    first = answer([start])
    state = [getattr(first, n).item() for n in ("x", "y", "orientation", "vx", "vy", "spin")]
    truth = solve_ivp(
        rates, (start, times[-1]), state, "DOP853", t_eval=times, rtol=1e-12, atol=1e-13
    ).y
    assert shares_off(answer, times, truth).max() < 3e-9


def on_floor(name: str, turning=lambda t: 0.0):
    """Newton's law at velocities relative to the floor, friction by elliptic integrals of scipy."""
    tables = case_named(name).tables
    puck, floor = tables["puck"], tables.get("floor", {})
    r, f, g = puck["radius"], puck["friction"], puck["gravity"]
    slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
    delta, belt = 2.0 * f * puck["height"] / r, np.array(floor.get("velocity", (0.0, 0.0)))
    pull = g * math.sin(slope) * np.array([math.cos(down), math.sin(down)])
    j = f * g * math.cos(slope)

    def rates(t: float, y: np.ndarray) -> list[float]:
        turns = floor.get("turning", 0.0) + turning(t)
        ux, uy = y[3:5] - belt - turns * np.array([-y[1], y[0]])
        ax, ay, aw = friction(ux, uy, r * (y[5] - turns), delta)
        return [*y[3:], pull[0] + j * ax, pull[1] + j * ay, j * aw / r]

    return rates


def test_a_disc_on_a_turntable_that_speeds_up_by_an_independent_integrator() -> None:
    rates = on_floor("turntable-speeds-up", lambda t: 4.0 * t)
    follow(reference_case("turntable-speeds-up"), rates, 0.8, np.linspace(0.85, 1.5, 5))


@pytest.mark.parametrize(
    "name", ["incline-below", "incline-at", "incline-above", "belt", "turntable"]
)
def test_slopes_and_moving_floors_by_an_independent_integrator(name: str) -> None:
    answer = reference_case(name)
    launch, first = case_named(name).tables["launch"], answer([0.0])
    assert (first.vx.item(), first.vy.item()) == pytest.approx(launch["velocity"], rel=1e-15)
    assert first.spin.item() == launch.get("spin", 0.0)
    share = 1.0 if answer.end == "time is up" else NOT_YET
    follow(answer, on_floor(name), 0.0, np.linspace(0.1, share, 5) * answer.end_time)


@pytest.mark.parametrize(
    ("name", "tangent", "until"), [("below", 0.285, 4.0), ("at", 0.3, 2.0), ("above", 0.315, 2.0)]
)
def test_a_box_beside_the_angle_of_its_friction(name: str, tangent: float, until: float) -> None:
    answer = reference_case(f"box-slope-{name}")
    judge = Judge([BOX], [], 0.0, GYRATION)
    slope = math.atan(tangent)
    load, down = 0.3 * G * math.cos(slope), G * math.sin(slope)

    def rates(_: float, y: np.ndarray) -> list[float]:
        c, s = math.cos(y[2]), math.sin(y[2])
        ux, uy = c * y[3] + s * y[4], c * y[4] - s * y[3]
        (ax, ay), torque = judge.friction(ux, uy, y[5])
        return [
            *y[3:], load * (c * ax - s * ay), load * (s * ax + c * ay) - down,
            load * torque / GYRATION**2,
        ]  # fmt: skip

    follow(answer, rates, 0.0, np.linspace(0.2, 1.0, 4) * until)
    assert answer.end == ("at rest" if name == "below" else "time is up")
