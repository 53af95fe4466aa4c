"""Quadratic drag of the spin, and an empirical lateral force, in scenes and among several pucks."""

import math

import numpy as np
import pytest
from commands import invoke

import puck_tables as pt
from puck_tables.motion.body import STANDARD_GRAVITY as G

MASS, RADIUS = 0.2, 0.05
INERTIA = 0.5 * MASS * RADIUS**2


def run_of(times=None, *, velocity=(0.0, 0.0), spin=0.0, friction=0.0, **more):
    puck = pt.Puck(RADIUS, friction=friction, mass=MASS)
    launch = pt.Launch(velocity, spin)
    return pt.Scene(puck, launch=launch, **more).simulate(times)


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_quadratic_drag_of_the_spin(friction):
    """I ω′ = −c ω² − ⅔ f m g r: ω₀/(1 + c ω₀ t/I), or a tangent, as for a speed."""
    c, spin = 2e-6, 80.0
    drag = pt.Drag(spinning_quadratic=c)
    if friction == 0.0:
        run = run_of(spin=spin, drag=drag, time=2.0)
        fall = 1.0 + c * spin * 2.0 / INERTIA
        assert run.last["spin"] == pytest.approx(spin / fall, rel=1e-10)
        assert run.last["orientation"] == pytest.approx(INERTIA / c * math.log(fall), rel=1e-10)
        assert run.last["heat_viscous"] == pytest.approx(
            0.5 * INERTIA * spin**2 * (1 - 1 / fall**2), rel=1e-9
        )
    else:
        run = run_of(spin=spin, friction=friction, drag=drag)
        brake = 2.0 / 3.0 * friction * MASS * G * RADIUS
        k = math.sqrt(c / brake)
        assert run.end_time == pytest.approx(math.atan(spin * k) / k * INERTIA / brake, rel=1e-9)
        turned = 0.5 * INERTIA / c * math.log1p(k * k * spin * spin)
        assert run.last["orientation"] == pytest.approx(turned, rel=1e-9)
    assert run.energy_residual < 1e-9


def test_a_stiff_quadratic_drag_settles():
    """A wake that takes the speed within a millionth of the run: v = v₀/(1 + c v₀ t/m)."""
    drag = pt.Drag(quadratic=2e5, spinning_quadratic=1e3)
    run = run_of(velocity=(1.0, 0.0), spin=5.0, drag=drag, time=1.0)
    assert run.last["x"] == pytest.approx(MASS / 2e5 * math.log1p(1e6), rel=1e-6)
    assert run.last["spin"] == pytest.approx(5.0 / (1.0 + 1e3 * 5.0 / INERTIA), rel=1e-6)


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_several_pucks_feel_drag_and_lateral_force_as_one_does(friction):
    drag = pt.Drag(sliding=0.01, quadratic=0.02, spinning=1e-6, spinning_quadratic=2e-6)
    lateral = pt.Lateral(0.05, 0.3, 0.5)
    times = [0.1, 0.3]
    for across in ({}, {"lateral": lateral}):
        one = run_of(
            times, velocity=(1.0, 0.2), spin=-60.0, friction=friction, drag=drag,
            time=0.4, **across,
        )  # fmt: skip
        launch = pt.Launch((1.0, 0.2), -60.0)
        puck = pt.Puck(RADIUS, friction=friction, mass=MASS, launch=launch)
        far = pt.Puck(RADIUS, friction=friction, mass=MASS, launch=pt.Launch(position=(0.0, 9.0)))
        board = pt.Scene(pucks=[puck, far], drag=drag, time=0.4, **across)
        many = board.simulate(times)
        for name in ("x", "y", "orientation", "spin"):
            unit = 1.0 / RADIUS if name in ("orientation", "spin") else 1.0
            assert getattr(many, name)[:2, 0] == pytest.approx(one.columns[name], abs=1e-8 * unit)
        assert many.energy_residual < 2e-8  # works of drag follow the steps of the motion


@pytest.mark.thorough
def test_turns_without_end_are_refused_by_name():
    """For k/r > 1/√2 the spin outlives the sliding, v → 0, and F/(m v) turns the way."""
    puck = pt.Puck(0.06, friction=0.05, gyration=2.0)
    launch = pt.Launch((0.3, 0.0), 5.0)
    with pytest.raises(pt.InputError, match=r"a million steps .* lateral.speed_exponent is below"):
        pt.Scene(puck, launch=launch, lateral=pt.Lateral(0.1), tol=1e-7).simulate()
    with_speed = pt.Scene(puck, launch=launch, lateral=pt.Lateral(0.1, 1.0), tol=1e-6).simulate()
    without = pt.Scene(puck, launch=launch, tol=1e-6).simulate()
    assert with_speed.end_time == pytest.approx(without.end_time, rel=1e-6)


def test_a_lateral_force_in_proportion_to_the_speed_is_a_circle_and_does_no_work():
    strength, turn = 0.1, 0.1 / MASS
    times = np.array([0.5, 2.0, 5.0])
    for spin, sign in ((3.0, 1.0), (-0.001, -1.0), (0.0, 0.0)):
        lateral = pt.Lateral(strength, speed_exponent=1.0)
        run = run_of(times, velocity=(0.6, 0.0), spin=spin, lateral=lateral, time=5.0)
        assert run.x == pytest.approx(
            0.6 / turn * np.sin(turn * times) if sign else 0.6 * times, abs=1e-9
        )
        assert run.y == pytest.approx(sign * 0.6 / turn * (1 - np.cos(turn * times)), abs=1e-9)
        assert run.kinetic_energy == pytest.approx(0.5 * MASS * 0.36 + 0.5 * INERTIA * spin**2)
        assert run.energy_residual < 1e-9
        assert np.all(run.work_given == 0.0)


def test_where_the_spin_turns_round_the_force_jumps_to_the_other_side():
    """Two arcs of a circle, joined where a torque has stopped the spin."""
    strength, torque, spin = 0.2, -2e-4, 2.0
    turns = -spin * INERTIA / torque
    rate = strength / MASS
    run = run_of(
        [1.5 * turns], velocity=(0.5, 0.0), spin=spin, lateral=pt.Lateral(strength, 1.0),
        force=pt.Force(torque=torque), time=2.0 * turns,
    )  # fmt: skip
    heading = rate * turns
    x = 2 * math.sin(heading) - math.sin(0.5 * heading)
    y = 1 - math.cos(heading) + math.cos(0.5 * heading) - math.cos(heading)
    assert run.x[0] == pytest.approx(0.5 / rate * x, abs=1e-9)
    assert run.y[0] == pytest.approx(0.5 / rate * y, abs=1e-9)


@pytest.mark.parametrize("exponents", [(0.0, 0.0), (0.2, 0.0), (0.5, 1.0)])
@pytest.mark.parametrize("strength", [0.05, -1.0])
def test_a_lateral_force_changes_no_stop_time_and_no_way(exponents, strength):
    """It is across the motion: speed, spin and length are those of the free puck, looked up."""
    lateral = pt.Lateral(strength, *exponents)
    run = run_of(velocity=(1.0, 0.5), spin=30.0, friction=0.2, lateral=lateral)
    free = pt.Puck(RADIUS, friction=0.2, mass=MASS).stop((1.0, 0.5), 30.0)
    unit = run.speed_scale / run.rate_scale
    allowed = max(1e-9, run.error_estimate)
    assert run.end == "at rest"
    assert run.end_time == pytest.approx(float(free.stop_time), abs=2 * allowed * unit + 1e-9)
    assert run.energy_residual < 1e-8
    straight = math.hypot(run.last["x"], run.last["y"])
    assert straight < float(free.path_length)


def test_on_a_belt_it_works_with_the_belt():
    run = run_of(
        velocity=(1.0, 0.5), spin=30.0, friction=0.2, lateral=pt.Lateral(0.1, 0.2),
        floor=pt.Floor(velocity=(0.0, 0.4)),
    )  # fmt: skip
    assert run.end == "carried by the floor"
    assert run.energy_residual < 1e-9


def test_what_is_refused_and_what_is_said():
    with pytest.raises(pt.InputError, match=r"lateral.speed_exponent = -0.5: must be"):
        run_of(lateral=pt.Lateral(0.1, -0.5))
    run = run_of(velocity=(1.0, 0.0), spin=1.0, friction=0.1, lateral=pt.Lateral(0.1))
    assert "lateral force (empirical)" in run.explain()
    assert "no dry friction over the contact explains it" in run.explain()
    words = "--v0 1,0 --w0 1 --radius 0.05 --friction 0.1 --mass 1 --set lateral.strength=0.1"
    said = invoke("simulate", *words.split())
    assert "lateral    strength 0.1 N; empirical: no dry friction over" in said.stdout
    puck = pt.Puck(RADIUS, friction=0.1, launch=pt.Launch((1.0, 0.0), 1.0))
    board = pt.Scene(pucks=[puck], lateral=pt.Lateral(0.1)).simulate()
    assert "no dry friction over the contact explains it" in board.explain()


@pytest.mark.parametrize("floor", [pt.Floor(), pt.Floor(velocity=(0.4, 0.0))])
def test_a_lateral_force_by_the_sign_of_a_spin_does_nothing_without_one(floor):
    """Rounding makes a spin of none, of either sign: such a run had no end."""
    stone = pt.Puck(0.145, base="annulus:0.0635x0.0555", friction=0.05, mass=20.0, height=0.1)
    launch, across = pt.Launch((2.0, 0.1)), pt.Lateral(0.16, 0.2)
    alone = pt.Scene(stone, floor, launch).simulate()
    run = pt.Scene(stone, floor, launch, lateral=across).simulate()
    assert run.steps < 2 * alone.steps + 20
    for name in ("x", "y", "orientation"):
        assert run.last[name] == pytest.approx(alone.last[name], abs=1e-9)
    slow = pt.Scene(stone, floor, pt.Launch((2.0, 0.1), spin=1e-6), lateral=across).simulate()
    assert slow.last["y"] > run.last["y"] + 1e-3
