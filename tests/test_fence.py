"""A straight fence that pushes slowly: votes, balance, flush sides that stay so, mirror images."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

import puck_tables as pt

SHAPES = {
    "box": pt.Base.box(0.2, 0.1),
    "off centre": pt.Base.box(0.2, 0.1, centre=(0.02, 0.005)),
    "triangle": pt.Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)]),
    "hook": pt.Base.polygon(
        [(0.0, 0.0), (0.12, 0.0), (0.12, 0.03), (0.03, 0.03), (0.03, 0.1), (0.0, 0.1)]
    ),
    "feet and box": pt.Base.union([pt.Base.box(0.1, 0.05), pt.Base.feet([(0.2, 0.0)], 0.01)]),
}


def points_of(base: pt.Base) -> np.ndarray:
    """Where a fence may touch, from the centre of mass, and radii of rims."""
    corners = [(x, y, 0.0) for outline in base.outlines for x, y in outline]
    found = np.array(corners + [disc[:3] for disc in base.discs])
    return found - [*base.middle, 0.0]


@pytest.mark.parametrize("name", SHAPES)
def test_forces_balance_and_nothing_goes_into_the_fence(name: str) -> None:
    base, rng, seen = SHAPES[name], np.random.default_rng(3), set()
    puck = pt.Puck(base=base, friction=0.3, height=0.005, gyration=0.06)
    points = points_of(base)
    for _ in range(12):
        friction, facing, lean = rng.uniform(0.05, 0.8), rng.uniform(-3.0, 3.0), rng.uniform(-1, 1)
        n = np.array([math.cos(facing), math.sin(facing)])
        t = np.array([-n[1], n[0]])
        way = math.cos(lean) * n + math.sin(lean) * t
        run = pt.push(
            puck, pt.Fence(facing), 0.1 * way, friction, angle=rng.uniform(-3.0, 3.0),
            duration=4.0, frames=23,
        )  # fmt: skip
        assert run.end == "time is up"
        moved = np.stack([run.vx, run.vy], axis=-1)
        force = np.stack([run.push_x, run.push_y], axis=-1)
        floor = puck.wrench(moved, run.spin, run.orientation)
        np.testing.assert_allclose(floor.force, -force, atol=1e-8)
        places = np.stack([run.finger_x - run.x, run.finger_y - run.y], axis=-1)
        torque = places[:, 0] * force[:, 1] - places[:, 1] * force[:, 0]
        np.testing.assert_allclose(floor.torque, -torque, atol=1e-9)
        pressed, dragged = force @ n, force @ t
        assert (pressed > 0.0).all() and (abs(dragged) <= friction * pressed * (1 + 1e-9)).all()
        for k, told in enumerate(run.contact):
            turn = np.exp(1j * run.orientation[k])
            there = turn * (points[:, 0] + 1j * points[:, 1])
            along = np.stack([there.real, there.imag], axis=-1)
            if k == 0:
                begun = (along @ n - points[:, 2]).min()
            fence = begun + 0.1 * run.time[k] * (way @ n) - np.array([run.x[k], run.y[k]]) @ n
            gaps = along @ n - points[:, 2] - fence
            assert gaps.min() == pytest.approx(0.0, abs=2e-9)
            # what touches does not come nearer, and the force acts between what touches
            spin = run.spin[k] * np.stack([-along[:, 1], along[:, 0]], axis=-1)
            comes = (spin + moved[k]) @ n - 0.1 * way @ n
            touching = gaps < 1e-8
            assert comes[touching].min() > -1e-9
            reach = along[touching] @ t
            assert reach.min() - 1e-8 < places[k] @ t < reach.max() + 1e-8
            flush = told.startswith("flush")
            assert flush == (reach.max() - reach.min() > 1e-3 and abs(run.spin[k]) == 0.0)
            seen.add(told)
    assert {"sticks", "flush, sticks"} <= seen and len(seen) >= 5


@pytest.mark.parametrize("name", ["box", "triangle", "hook"])
def test_it_turns_as_two_of_three_votes_have_it(name: str) -> None:
    """Edges of the cone and the push, by the side on which they pass the centre (Mason 1986)."""
    base, rng = SHAPES[name], np.random.default_rng(5)
    puck, points, seen = pt.Puck(base=base, friction=0.3), points_of(base), set()
    for _ in range(60):
        friction, angle, lean = rng.uniform(0, 0.8), rng.uniform(-3, 3), rng.uniform(-1.2, 1.2)
        run = pt.push(puck, pt.Fence(), (math.cos(lean), math.sin(lean)), friction, angle=angle)
        there = np.exp(1j * angle) * (points[:, 0] + 1j * points[:, 1])
        arm = there[there.real.argmin()]
        ways = np.array([1.0 - 1j * friction, 1.0 + 1j * friction, np.exp(1j * lean)])
        votes = np.sign((arm.conjugate() * ways).imag)
        assert np.sign(run.spin[0]) == np.sign(votes.sum())
        seen.add(np.sign(run.spin[0]))
    assert seen == {-1.0, 1.0}


@pytest.mark.parametrize("friction", [0.2, 0.9])
def test_flush_is_stable_while_the_centre_lies_between(friction: float) -> None:
    """The line through the centre of mass along the motion meets the side, 0.12 m behind it, up to
    its corner, 0.045 m beside it (Lynch and Mason 1996); beyond, the box turns about that."""
    puck, limit = pt.Puck(base=SHAPES["off centre"], friction=0.3, gyration=0.06), 0.045 / 0.12
    for slope, stays in ((-limit + 1e-6, True), (-limit - 1e-6, False)):
        run = pt.push(puck, pt.Fence(), (0.1, 0.1 * slope), friction, duration=0.5)
        sticks = friction > limit
        if stays or not sticks:  # with little friction it slides along the edge of the cone
            assert run.contact[-1] == ("flush, sticks" if sticks else "flush, slides right")
            assert abs(run.orientation).max() == 0.0
            assert run.y[-1] == pytest.approx(0.05 * (slope if sticks else -friction), rel=1e-12)
            assert run.x[-1] == pytest.approx(0.05, rel=1e-12)
            assert np.hypot(run.push_x, run.push_y) == pytest.approx(0.3 * puck.mass * 9.80665)
        else:
            assert run.contact[0] == "sticks" and run.spin[0] > 0.0


def test_a_smooth_fence_turns_a_box_as_the_least_dissipation_has_it() -> None:
    """Of all motions that the fence leaves, friction summed over a grid of its own."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    x, y = np.meshgrid(0.1 * nodes, 0.05 * nodes)
    share, last = np.outer(weights, weights), np.array([0.0, 0.0])

    def spin(angle: float) -> float:
        nonlocal last
        corners = np.exp(1j * angle) * np.array([-0.1 + 0.05j, -0.1 - 0.05j])
        arm = corners[corners.real.argmin()]
        px, py = (
            math.cos(angle) * x - math.sin(angle) * y,
            math.sin(angle) * x + math.cos(angle) * y,
        )

        def power(free: np.ndarray) -> tuple[float, np.ndarray]:
            w = free[1] / 0.1
            ux, uy = 1.0 + w * (arm.imag - py), free[0] + w * px
            slip = np.hypot(ux, uy)
            turns = (ux * (arm.imag - py) + uy * px) / slip
            slopes = np.array([(share * uy / slip).sum(), (share * turns).sum() / 0.1])
            return float((share * slip).sum()), slopes

        last = minimize(power, last, jac=True, method="BFGS", options={"gtol": 1e-9}).x
        return float(last[1] / 0.1)

    angle, step = 0.3, 0.003
    for _ in range(10):  # 0.03 m
        one = spin(angle)
        two = spin(angle + 0.5 * step * one)
        three = spin(angle + 0.5 * step * two)
        angle += step / 6.0 * (one + 2.0 * two + 2.0 * three + spin(angle + step * three))
    puck = pt.Puck(base=SHAPES["box"], friction=0.3)
    run = pt.push(puck, pt.Fence(), (0.1, 0.02), 0.0, angle=0.3, duration=0.3)
    assert 0.05 < angle < 0.2 and run.orientation[-1] == pytest.approx(angle, abs=1e-5)


def test_mirror_images_and_turned_floors() -> None:
    puck = pt.Puck(base=SHAPES["box"], friction=0.3, height=0.02)
    how: dict[str, Any] = {"duration": 6.0, "frames": 21}
    run = pt.push(puck, pt.Fence(), (0.1, 0.04), 0.25, angle=0.4, **how)
    over = pt.push(puck, pt.Fence(), (0.1, -0.04), 0.25, angle=-0.4, **how)
    np.testing.assert_allclose(over.y, -run.y, atol=1e-9)
    np.testing.assert_allclose(over.orientation, -run.orientation, atol=1e-9)
    way = (0.1 + 0.04j) * np.exp(2.1j)
    turned = pt.push(puck, pt.Fence(2.1), (way.real, way.imag), 0.25, angle=2.5, **how)
    np.testing.assert_allclose(turned.orientation - 2.1, run.orientation, atol=1e-9)
    gone = (run.x + 1j * run.y) * np.exp(2.1j)
    np.testing.assert_allclose(turned.x + 1j * turned.y, gone, atol=1e-9)


def test_a_disc_goes_on_as_a_finger_pushes_it_at_first() -> None:
    puck = pt.Puck(0.05, friction=0.3)
    run = pt.push(puck, pt.Fence(), (0.1, 0.08), 0.3, duration=3.0)
    first = pt.push(puck, (-0.05, 0.0), (0.1, 0.08), 0.3)
    assert set(run.contact) == set(first.contact)
    for name in ("vx", "vy", "spin", "push_x", "push_y"):
        np.testing.assert_allclose(getattr(run, name), getattr(first, name)[0], rtol=1e-9)


def test_what_is_told(tmp_path) -> None:
    puck = pt.Puck(base=SHAPES["box"], friction=0.3, mass=1.0)
    run = pt.push(puck, pt.Fence(), (0.1, 0.0), 0.3, angle=0.3, duration=6.0)
    assert "The fence: sticks, then slides right, then flush, sticks; its force" in str(run)
    run.plot(tmp_path / "fence.png")
    run.save(tmp_path / "fence.csv")
    assert (tmp_path / "fence.csv").read_text().splitlines()[-1].endswith('flush, sticks"')
    with pytest.raises(pt.InputError, match="the fence faces along 0 rad and does not move"):
        pt.push(puck, pt.Fence(), (-0.1, 0.2), 0.3)
    with pytest.raises(pt.InputError, match="facing"):
        pt.Fence(math.nan)


def test_a_fence_of_a_width_is_an_endless_one_while_nothing_is_at_its_ends() -> None:
    puck = pt.Puck(base=SHAPES["box"], friction=0.3)
    run = pt.push(puck, pt.Fence(), (0.1, 0.02), 0.4, angle=0.3, duration=3.0)
    wide = pt.push(puck, pt.Fence(width=0.4), (0.1, 0.02), 0.4, angle=0.3, duration=3.0)
    np.testing.assert_allclose(wide.orientation, run.orientation, atol=1e-12)
    assert wide.contact == run.contact and wide.contact[-1] == "flush, sticks"


def test_flush_on_a_narrow_fence_while_the_line_meets_it() -> None:
    """A side of 0.1 m on a fence of 0.04 m, 0.01 m to the left: from -0.01 to 0.03 m."""
    puck, fence = pt.Puck(base=SHAPES["box"], friction=0.3), pt.Fence(width=0.04, offset=0.01)
    for slope in (0.09, -0.29):  # through the centre, 0.1 m ahead
        run = pt.push(puck, fence, (0.1, 0.1 * slope), 0.5, duration=2.0)
        assert run.contact[-1] == "flush, sticks" and run.end == "time is up"
    for slope in (0.11, -0.31):
        with pytest.raises(pt.InputError, match="turns about that at once"):
            pt.push(puck, fence, (0.1, 0.1 * slope), 0.5, duration=2.0)
    # with little friction the box slides along it until the force, 0.1 of 1 aside, is at its end
    run = pt.push(puck, fence, (0.1, -0.03), 0.1, duration=9.0)
    assert run.end == "the puck turns about an end of the fence"
    assert run.contact[-1] == "flush, slides right"
    # the force acts at 0.1 * 0.1 beside the centre; the end, from 0.03, comes 0.02 m/s nearer
    assert run.time[-1] == pytest.approx((0.03 - 0.01) / 0.02, rel=1e-9)
    assert run.finger_y[-1] == pytest.approx(run.fence_y[-1] + 0.02, abs=1e-9)


def test_a_corner_that_comes_to_the_end_of_a_fence_ends_the_push() -> None:
    puck = pt.Puck(base=SHAPES["box"], friction=0.3)
    angle = math.atan(0.5) + 0.02  # nearly behind the centre
    run = pt.push(puck, pt.Fence(width=0.06), (0.1, 0.15), 0.05, angle=angle, duration=5.0)
    assert run.end == "the puck comes to an end of the fence"
    aside = math.hypot(run.finger_x[-1] - run.fence_x[-1], run.finger_y[-1] - run.fence_y[-1])
    assert aside == pytest.approx(0.03, abs=1e-8)


@pytest.mark.parametrize("name", ["hook", "feet and box"])
def test_a_fence_of_a_width_is_refused_at_what_is_not_convex(name: str) -> None:
    puck = pt.Puck(base=SHAPES[name], friction=0.3, gyration=0.05)
    with pytest.raises(pt.InputError, match="convex polygons and discs"):
        pt.push(puck, pt.Fence(width=0.1), (0.1, 0.0), 0.3)
    with pytest.raises(pt.InputError, match="touches with an end"):
        pt.push(pt.Puck(0.05, friction=0.3), pt.Fence(width=0.02, offset=0.02), (0.1, 0.0), 0.3)
