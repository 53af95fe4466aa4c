"""Launches that end at a place and at an angle of the body."""

from __future__ import annotations

import math

import numpy as np
import pytest
from rarely import few
from reference import states

import puck_tables as pt

PLAIN = pt.Puck.similar()
PUCKS = {
    "plain": pt.Puck(radius=0.04, height=0.02, friction=0.15),
    "hertz": pt.Puck(radius=0.04, height=0.02, friction=0.15, pressure="hertz"),
    "tall": pt.Puck.similar(delta=3.9),
    "heavy rim": pt.Puck(radius=0.1, friction=0.2, gyration=0.95),
}


def off(angle: np.ndarray, wanted: np.ndarray | float) -> np.ndarray:
    """How far an angle is from one that is wanted, but for whole turns."""
    return np.abs(np.mod(angle - wanted + math.pi, 2.0 * math.pi) - math.pi)


def test_the_body_rests_at_the_angle_by_scipy():
    """All of the motion but its last second by an independent integrator."""
    found = PLAIN.aim((2.0, 0.1), angle=1.0, max_spin=5.0)
    assert found.launch_spin.size == 3
    for velocity, spin, time, angle in zip(
        found.launch_velocity, found.launch_spin, found.stop_time, found.body_angle, strict=True
    ):
        sense = math.copysign(1.0, spin)
        start = (velocity[0], sense * velocity[1]), abs(spin)  # the mirror image
        vx, vy, rim, x, y, turned = states(*start, 0.5, np.array([0.0, time - 1.0]))[:, -1]
        rest = PLAIN.simulate((vx, vy), rim, exact=True)
        assert abs(x + rest.stop_position[0] - 2.0) < 1e-9
        assert abs(sense * (y + rest.stop_position[1]) - 0.1) < 1e-9
        assert abs(sense * (turned + rest.body_angle) - angle) < 1e-9
        assert off(angle, 1.0) < 1e-12


@pytest.mark.parametrize("name", few(1, PUCKS))
def test_none_is_left_out(name: str):
    """Against a scan over all spins that a bound allows."""
    puck, target, wanted = PUCKS[name], np.array([0.6, -0.2]), 2.3
    most = 8.0 * math.sqrt(puck.decel * 0.63) / puck.radius
    found = puck.aim(target, angle=wanted, max_spin=most, count=1000)
    spins = np.linspace(-most, most, 40_001)
    family = puck.aim(target, spin=spins)
    assert (family.launches == 1).all() or name == "tall"
    crossed = 0
    for sense in (-1.0, 1.0):
        mine = np.sign(family.launch_spin) == sense
        turns = np.floor((family.body_angle[mine] - wanted) / (2.0 * math.pi))
        crossed += int(np.abs(np.diff(turns)).sum())
    assert found.launch_spin.size == crossed
    ends = puck.stop(found.launch_velocity, found.launch_spin, tol=1e-10)
    assert np.hypot(ends.stop_x - target[0], ends.stop_y - target[1]).max() < 1e-8
    assert off(ends.body_angle, wanted).max() < 1e-8 * (1.0 + np.abs(ends.body_angle).max())
    assert (np.abs(found.launch_spin) <= most * (1.0 + 1e-9)).all()


@pytest.mark.parametrize("name", few(2, PUCKS))
def test_many_targets_are_one_after_the_other(name: str):
    puck, rng = PUCKS[name], np.random.default_rng(39)
    targets, wanted = rng.uniform(-1.0, 1.0, (30, 2)), rng.uniform(-7.0, 7.0, 30)
    many = puck.aim(targets, angle=wanted, count=3)
    assert many.launches.tolist() == [6] * 30
    for n in range(0, 30, 7):
        one, mine = puck.aim(targets[n], angle=wanted[n], count=3), many.target_index == n
        np.testing.assert_allclose(many.launch_spin[mine], one.launch_spin, rtol=1e-7)
        np.testing.assert_allclose(many.body_angle[mine], one.body_angle, rtol=1e-12)
    assert off(many.body_angle, wanted[many.target_index]).max() < 1e-12
    assert many.miss.max() < 1e-8


def test_the_fewest_turns_come_first_within_a_speed():
    free, slow = (
        PLAIN.aim((2.0, 0.1), angle=1.0, count=3, **by) for by in ({}, {"max_speed": 0.9})
    )
    assert np.sort(np.abs(free.body_angle)).max() < 6.0 * math.pi
    assert slow.launch_speed.max() <= 0.9 and slow.launch_spin.size == 6
    more = PLAIN.aim((2.0, 0.1), angle=1.0, count=12)
    taken = np.sort(np.abs(more.launch_spin[more.launch_speed <= 0.9]))[:6]
    np.testing.assert_allclose(np.sort(np.abs(slow.launch_spin)), taken, rtol=1e-9)


def test_no_turn_is_the_slide_without_spin():
    found = PLAIN.aim((2.0, 0.0), angle=0.0, count=2)
    assert (found.launch_spin == 0.0).sum() == 1
    assert found.body_angle.tolist() == pytest.approx([-2.0 * math.pi, 0.0, 2.0 * math.pi])
    assert found.launch_velocity[1].tolist() == pytest.approx([2.0, 0.0])


def test_on_the_spot_it_only_turns():
    found = PLAIN.aim((0.0, 0.0), angle=0.5, count=2)
    turned = PLAIN.stop(np.zeros((4, 2)), found.launch_spin).body_angle
    assert found.body_angle.tolist() == pytest.approx(turned.tolist(), abs=1e-12)
    assert off(turned, 0.5).max() < 1e-12
    none = PLAIN.aim((0.0, 0.0), angle=0.5, max_spin=0.1)
    assert none.launch_spin.size == 0 and "above the bound of 0.1 rad/s" in none.answer


def test_what_cannot_be_is_said():
    none = PLAIN.aim((2.0, 0.1), angle=1.0, max_speed=0.5, max_spin=3.0)
    assert none.launch_spin.size == 0 and none.answer.endswith("out of the bounds")
    with pytest.raises(pt.InputError, match="spin and angle both pick a launch"):
        PLAIN.aim((2.0, 0.1), angle=1.0, spin=3.0)
    with pytest.raises(pt.InputError, match="angle"):
        PLAIN.aim((2.0, 0.1), angle=math.nan)
    with pytest.raises(pt.InputError, match="within 1e\\+06 rad"):
        PLAIN.aim((2.0, 0.1), angle=[0.0, -1e30])
