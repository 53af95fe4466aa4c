"""Feet with loads of their own: friction, slides and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from rays_judge import friction_of
from scipy.integrate import solve_ivp

import puck_tables as pt
from puck_tables import InputError
from puck_tables.errors import ContactError

PLACES = np.array([(0.08, 0.05), (-0.06, 0.05), (-0.06, -0.05), (0.08, -0.05)])
LOADS = np.array([3.0, 1.0, 2.0, 0.5])
RADIUS, FRICTION = 0.01, 0.3
MIDDLE = LOADS @ PLACES / LOADS.sum()


def feet(**more: float) -> pt.Puck:
    base = pt.Base.feet(PLACES, RADIUS, loads=LOADS)
    return pt.Puck(base=base, friction=FRICTION, mass=2.0, **more)


def one_foot(slip: tuple[float, float, float], x: float, y: float) -> np.ndarray:
    """Force and torque about the centre of mass over f times the load of a foot."""
    ux, uy, w = slip
    fx, fy, torque = friction_of(  # about its own middle, where its load is level
        [(0.0, 0.0, RADIUS)], lambda px, py: np.hypot(px, py) < RADIUS,
        lambda px, py, ex, ey: (ex, ey), (ux - w * y, uy + w * x, w),
    )  # fmt: skip
    return np.array([fx, fy, torque + x * fy - y * fx])


@pytest.mark.parametrize("slip", [(0.3, 0.1, 4.0), (-0.05, 0.2, -9.0), (1.0, 0.0, 0.1)])
def test_friction_is_that_of_each_foot_under_its_load(slip: tuple[float, float, float]) -> None:
    puck = feet()
    shares = LOADS / LOADS.sum()
    truth = sum(
        share * one_foot(slip, *(place - MIDDLE))
        for share, place in zip(shares, PLACES, strict=True)
    )
    found = puck.wrench(slip[:2], slip[2], jacobian=True)
    load = FRICTION * 2.0 * puck.gravity
    np.testing.assert_allclose([*found.force, found.torque], load * truth, atol=1e-10 * load)
    back = puck.twist(found.force, found.torque)
    unit = math.hypot(*slip[:2], puck.inertia_radius * slip[2])
    np.testing.assert_allclose([*back.velocity, back.spin], np.array(slip) / unit, atol=1e-9)
    step = 1e-6
    for n in range(3):
        more, less = (np.array(slip) + way * step * np.eye(3)[n] for way in (1.0, -1.0))
        up, down = puck.wrench(more[:2], more[2]), puck.wrench(less[:2], less[2])
        slope = (np.array([*up.force, up.torque]) - [*down.force, down.torque]) / (2.0 * step)
        np.testing.assert_allclose(found.jacobian[:, n], slope, atol=1e-6 * load)


def test_equal_loads_are_none() -> None:
    plain = pt.Puck(base=pt.Base.feet(PLACES, RADIUS), friction=FRICTION)
    alike = pt.Puck(base=pt.Base.feet(PLACES, RADIUS, loads=[2.0] * 4), friction=FRICTION)
    one, other = plain.stop((0.5, 0.2), 9.0), alike.stop((0.5, 0.2), 9.0)
    np.testing.assert_array_equal(one.stop_position, other.stop_position)


def test_a_slide_by_an_independent_integrator() -> None:
    """Point feet with their loads; feet of 0.1 mm are those to 1e-6."""
    base = pt.Base.feet(PLACES, 1e-4, loads=LOADS)
    puck = pt.Puck(base=base, friction=FRICTION)
    arms, shares, k = PLACES - MIDDLE, LOADS / LOADS.sum(), puck.inertia_radius

    def rates(_: float, y: np.ndarray) -> list[float]:
        c, s = math.cos(y[2]), math.sin(y[2])
        x, z = arms @ [c, -s], arms @ [s, c]
        vx, vy = y[3] - y[5] * z, y[4] + y[5] * x
        pull = -FRICTION * puck.gravity * shares / np.hypot(vx, vy)
        ax, ay = pull * vx, pull * vy
        return [*y[3:], ax.sum(), ay.sum(), float((x * ay - z * ax).sum()) / k**2]

    launch, spin, late = (0.6, 0.2), 12.0, 0.2
    truth = solve_ivp(
        rates, (0.0, late), [0.0, 0.0, 0.0, *launch, spin], "DOP853", rtol=1e-11, atol=1e-12
    ).y[:, -1]
    run = puck.simulate(launch, spin)([late])
    found = [run.x[0], run.y[0], run.orientation[0], run.vx[0], run.vy[0], run.spin[0]]
    np.testing.assert_allclose(found, truth, atol=2e-6)


def test_a_scene_and_a_text_have_them_too() -> None:
    base = "feet:1cm;8cm,5cm,3;-6cm,5cm,1;-6cm,-5cm,2;8cm,-5cm,0.5"
    puck, alone = pt.Puck(base=base, friction=FRICTION), feet()
    np.testing.assert_allclose(puck.shape.middle, MIDDLE, atol=1e-15)
    launch = pt.Launch((0.5, 0.2), spin=9.0)
    run = pt.Scene(puck, pt.Floor(slope=0.1, downhill=-1.0), launch).simulate()
    assert run.end == "at rest" and run.energy_residual < 1e-9
    level = pt.Scene(puck, launch=launch).simulate()
    truth = alone.stop((0.5, 0.2), 9.0).stop_position
    np.testing.assert_allclose([level.last["x"], level.last["y"]], truth, atol=1e-8)


def test_the_height_shifts_loads() -> None:
    """Three balances: the loads of the feet are those of a linear pressure times their own."""
    tall = feet(height=0.02)
    slow = tall.wrench((1.0, 0.0), 0.0)
    np.testing.assert_allclose(slow.force, [-FRICTION * 2.0 * tall.gravity, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"loads": [1.0, 2.0]}, "loads must be 4 numbers above 0"),
        ({"loads": [1.0, 2.0, 0.0, 1.0]}, "loads must be 4 numbers above 0"),
        ({"loads": LOADS, "centre": (0.0, 0.0)}, "leave centre out"),
    ],
)
def test_loads_that_are_none_are_refused(given: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        pt.Base.feet(PLACES, RADIUS, **given)


def test_what_is_not_known_with_them_is_refused() -> None:
    strips = pt.Floor(strips=pt.Strips((0.0,), (0.1, 0.2)))
    with pytest.raises(InputError, match="known on a floor of one coefficient"):
        pt.Scene(feet(), strips).simulate()
    with pytest.raises(InputError, match="known while none lifts"):
        pt.Scene(feet(height=0.6)).simulate()
    with pytest.raises(ContactError):
        feet(height=0.6).stop((1.0, 0.0), 1.0)
    with pytest.raises(InputError, match="X,Y,LOAD"):
        pt.Puck(base="feet:1cm;8cm,5cm,3;-6cm,5cm")
