"""Round pucks so tall that friction lifts a part of their base, on floors of several frictions.

Truth: points on rays from the instantaneous centre, cut where the pressure ends, whose three
numbers scipy finds; plain pucks, which are looked up; closed forms.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from rarely import thorough
from rays_judge import border, points_on_rays
from scenes import end_of
from scipy.optimize import root

import puck_tables as pt
from puck_tables.world.floor_forces import friction_at

RADIUS, G = 0.05, 9.80665
PLACE, TURNED = 0.02, 0.4  # of the border of strips
HALVES = pt.Strips((PLACE,), (0.4, 0.25), direction=TURNED)
SPOT = pt.Patch(0.3, (0.01, 0.02), 0.03)


def judged(state: Any, puck: pt.Puck, inner: float, floor: pt.Floor) -> np.ndarray:
    """Force and torque at N = 1 under p = max(0, a + b x + c y)."""
    lever = 0.5 * puck.height
    px, py, _, vx, vy, w = state
    east, north = math.cos(TURNED), math.sin(TURNED)
    place = PLACE - px * east - py * north
    curves: list[Any] = [(0.0, 0.0, RADIUS), border(TURNED, place)]
    if inner > 0.0:
        curves.append((0.0, 0.0, inner))
    for patch in floor.patches:
        curves.append((patch.centre[0] - px, patch.centre[1] - py, patch.radius))

    def load(law: np.ndarray) -> tuple[np.ndarray, ...]:
        a, b, c = law
        ends = [border(math.atan2(c, b), -a / math.hypot(b, c))] if b or c else []
        x, y, area = points_on_rays([*curves, *ends], (-vy / w, vx / w), 6)
        keep = (np.hypot(x, y) < RADIUS) & (np.hypot(x, y) > inner) & (area > 0.0)
        keep &= a + b * x + c * y > 0.0
        x, y, area = x[keep], y[keep], area[keep] * (a + b * x + c * y)[keep]
        f = np.full_like(x, puck.friction)
        if floor.strips is not None:
            f = np.where(x * east + y * north > place, *reversed(floor.strips.friction))
        for patch in floor.patches:
            there = np.hypot(x - patch.centre[0] + px, y - patch.centre[1] + py) < patch.radius
            f = np.where(there, patch.friction, f)
        ux, uy = vx - w * y, vy + w * x
        f = f * area / np.hypot(ux, uy)
        return x, y, area, f * ux, f * uy

    def missed(scaled: np.ndarray) -> list[float]:
        x, y, part, tx, ty = load(scaled * unit)
        return [part.sum() - 1.0, (part * x - lever * tx).sum() / RADIUS,
                (part * y - lever * ty).sum() / RADIUS]  # fmt: skip

    unit = np.array([1.0, 1.0 / RADIUS, 1.0 / RADIUS]) / (math.pi * (RADIUS**2 - inner**2))
    found = root(missed, [1.0, 0.5 * np.sign(vx), 0.5 * np.sign(vy)], tol=1e-13)
    assert np.abs(missed(found.x)).max() < 1e-10
    x, y, _, tx, ty = load(found.x * unit)
    return -np.array([tx.sum(), ty.sum(), (x * ty - y * tx).sum()])


@pytest.mark.parametrize(
    ("on", "inner"),
    [("strips", 0.0), ("patch", 0.03), thorough("strips", 0.03), thorough("patch", 0.0)],
)
def test_friction_is_that_of_points_on_rays(on: str, inner: float) -> None:
    rng = np.random.default_rng(7)
    floor = pt.Floor(strips=HALVES) if on == "strips" else pt.Floor(patches=[SPOT])
    pressure = f"annulus:{inner / RADIUS}" if inner else "uniform"
    for height in (0.16, 0.2, 0.23):
        puck = pt.Puck(RADIUS, height, 0.14, mass=1.0, gravity=1.0, pressure=pressure)
        states = rng.normal(size=(6, 6)) * [0.02, 0.02, 3.0, 1.0, 1.0, 1.0]
        states[:, 5] = rng.choice([-1.0, 1.0], 6) * 10.0 ** rng.uniform(0.0, 1.6, 6)
        found = friction_at(pt.Scene(puck, floor), states)
        for state, forces in zip(states, found, strict=True):
            gap = np.abs(forces - judged(state, puck, inner, floor)) / [1.0, 1.0, RADIUS]
            assert gap.max() < 1e-9, (height, state)


LAUNCH = pt.Launch((0.7, 0.2), spin=14.0)


@pytest.mark.parametrize("height", [0.17, 0.3])
def test_where_all_frictions_are_one_it_is_the_plain_puck(height: float) -> None:
    """That is looked up, by tables of the contact that opens."""
    puck = pt.Puck(RADIUS, height, 0.3)
    stop = puck.stop((0.7, 0.2), 14.0)
    truth = [float(stop.stop_time), *stop.stop_position, float(stop.body_angle)]
    for floor in (
        pt.Floor(strips=pt.Strips((0.04,), (0.3, 0.3))),
        pt.Floor(patches=[pt.Patch(0.3, (0.1, 0.0), 0.04)]),
        pt.Floor(grips=[pt.Grip([[0.0, 1.0], [1.0, 1.0]])]),
        pt.Floor(static_ratio=1.2),
        pt.Floor(law=[[0.0, 0.3], [9.0, 0.3]]),
    ):
        assert np.abs(end_of(puck, floor, LAUNCH, tol=1e-9) - truth).max() < 2e-8, floor


def test_it_is_the_puck_on_a_base_that_is_a_disc() -> None:
    for floor in (
        pt.Floor(strips=HALVES), pt.Floor(patches=[SPOT]),
        pt.Floor(law=pt.StribeckLaw(0.4, 0.25, speed=0.3)),
    ):  # fmt: skip
        one, two = pt.Puck(RADIUS, 0.24, 0.3), pt.Puck(base="disc:0.05", height=0.24, friction=0.3)
        found, truth = (end_of(each, floor, LAUNCH, tol=1e-9) for each in (one, two))
        assert np.abs(found - truth).max() < 1e-9


def test_it_tips_on_the_rough_strip_where_that_bears_it_no_more() -> None:
    """On f = 0.3 its load is 0.03 m ahead, on 0.4 it is 0.04 m, and on 0.6 beyond its rim."""
    puck = pt.Puck(RADIUS, 0.2, 0.3)
    for rough, end in ((0.4, "at rest"), (0.6, "tipped over")):
        floor = pt.Floor(strips=pt.Strips((0.1,), (0.3, rough)))
        run = pt.Scene(puck, floor, pt.Launch((1.5, 0.0))).simulate([0.0])
        assert run.end == end and abs(run.energy_residual) < 1e-9
    assert (run.events[-1].what, run.events[-1].partner) == ("tip", "floor")
    assert 0.05 < run.last["x"] < 0.1


def test_friction_that_grows_tips_it() -> None:
    """Its load is 0.2 (1 + 4 t) 0.08 m ahead, and tips it a little before that is its radius."""
    puck = pt.Puck(RADIUS, 0.16, 0.2)
    floor = pt.Floor(grips=[pt.Grip([[0.0, 1.0], [1.0, 5.0]])])
    run = pt.Scene(puck, floor, pt.Launch((4.0, 0.0))).simulate([0.0])
    assert run.end == "tipped over"
    assert run.end_time == pytest.approx((RADIUS / (0.2 * 0.08) - 1.0) / 4.0, rel=2e-3)


def test_static_friction_holds_a_puck_of_which_it_lifts_a_part() -> None:
    """μ_s = 0.35, and a load that is up to 0.044 m ahead."""
    puck, firm = pt.Puck(RADIUS, 0.25, 0.2), pt.Floor(static_ratio=1.75)
    for push, end in ((0.3499, "at rest"), (0.3501, "time is up")):
        force = pt.Force((push * puck.mass * G, 0.0))
        run = pt.Scene(puck, firm, force=force, time=1.0).simulate([0.0])
        assert run.end == end
    assert run.last["x"] == pytest.approx(0.5 * (0.3501 - 0.2) * G, rel=1e-9)


def test_with_others_on_a_board() -> None:
    tall = pt.Puck(RADIUS, 0.24, 0.3, name="tall", launch=pt.Launch((1.2, 0.05), 4.0))
    low = pt.Puck(RADIUS, 0.02, 0.3, name="low", launch=pt.Launch(position=(0.2, 0.02)))
    scene = pt.Scene(pucks=[tall, low], floor=pt.Floor(strips=HALVES))
    run = scene.simulate([0.0])
    assert run.impacts == 1 and run.energy_residual < 1e-8
    assert "tall" in run.why and "integrated" in run.why


@pytest.mark.parametrize("floor", [pt.Floor(strips=HALVES), pt.Floor(static_ratio=2.0)])
def test_under_other_pressures_it_is_refused(floor: pt.Floor) -> None:
    said = r"known under puck.pressure = 'hertz' while that is loaded everywhere.*give uniform"
    with pytest.raises(pt.InputError, match=said):
        pt.Scene(pt.Puck(RADIUS, 0.06, 0.3, pressure="hertz"), floor)
