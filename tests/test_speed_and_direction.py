"""Friction by the slip speed and the direction at one place: a judge, known answers, refusals."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rarely import thorough
from rays_judge import by_ellipse, points_on_rays, sides, where_it_bends
from scenes import end_of, two_ends_as_alone

import puck_tables as pt
from puck_tables.contact.base import Base
from puck_tables.contact.law_moments import law_moments, packed_law
from puck_tables.kernels.base_clipping import whole_contour
from puck_tables.kernels.base_friction import REACH, packed
from puck_tables.kernels.elliptic_sums import Ellipse, elliptic_sums
from puck_tables.kernels.law_sums import law_sums
from puck_tables.scene.library import as_toml

TOP = 60.0  # m/s
STRIBECK = pt.StribeckLaw(0.3, 0.1, speed=0.3, exponent=2.0)
KINKED = pt.SpeedLaw([0.0, 0.1, 0.3, 0.4, TOP], [0.3, 0.35, 0.2, 0.12, 0.12])
STEEP = pt.SpeedLaw([0.0, 0.3, 0.31, TOP], [0.4, 0.4, 0.1, 0.1])
# and where rays are cut
LAWS = {STRIBECK: [0.2, 0.5], KINKED: [0.1, 0.3, 0.4], STEEP: [0.3, 0.31]}
CORNERS = [(0.0, 0.0), (0.1, 0.0), (0.1, 0.04), (0.04, 0.04), (0.04, 0.1), (0.0, 0.1)]
FEET = [(-0.05, -0.03), (0.05, -0.03), (0.0, 0.06)]
BASES = {
    "box": Base.box(0.2, 0.1), "L": Base.polygon(CORNERS), "disc": Base.disc(0.06),
    "annulus": Base.annulus(0.06, 0.04), "feet": Base.feet(FEET, 0.02),
}  # fmt: skip
BOX, PUCK = pt.Puck(base="box:0.2x0.1", height=0.02), pt.Puck(0.06, height=0.02)
ICE = pt.Orthotropic((1.0, 0.4), 0.7, law=pt.StribeckLaw(0.3, 0.1, speed=0.3))
THROWN = pt.Launch((0.6, 0.2), spin=8.0, orientation=0.2)


def outline(name: str) -> tuple[list[Any], Any]:
    """The curves around a base about its centre of mass, and what lies inside."""
    mx, my = BASES[name].middle
    if name == "box":
        corners = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]
        return sides(corners), lambda x, y: (abs(x) < 0.1) & (abs(y) < 0.05)
    if name == "L":
        return sides([(x - mx, y - my) for x, y in CORNERS]), lambda x, y: (
            (x + mx > 0.0) & (y + my > 0.0) & (x + mx < 0.1) & (y + my < 0.1)
            & ((y + my < 0.04) | (x + mx < 0.04))
        )  # fmt: skip
    if name == "feet":
        feet = [(x - mx, y - my) for x, y in FEET]
        return [(*foot, 0.02) for foot in feet], lambda x, y: np.any(
            [np.hypot(x - a, y - b) < 0.02 for a, b in feet], axis=0
        )
    inner = 0.04 if name == "annulus" else -1.0
    return [
        (0.0, 0.0, 0.06),
        (0.0, 0.0, max(inner, 0.001)),
    ], lambda x, y: (np.hypot(x, y) < 0.06) & (np.hypot(x, y) > inner)


def judged(name: str, law: Any, pair: Any, angle: float, slip: Any) -> np.ndarray:
    """Sums over a base by points on rays."""
    (vx, vy, w), (curves, inside) = slip, outline(name)
    bent = where_it_bends(slip, LAWS[law], [angle])
    x, y, area = points_on_rays([*curves, *bent], (-vy / w, vx / w), 6, 24)
    ux, uy = vx - w * y, vy + w * x
    speed = np.hypot(ux, uy)
    keep = inside(x, y) & (area > 0.0) & (speed > 0.0)
    x, y, area, ux, uy, speed = (one[keep] for one in (x, y, area, ux, uy, speed))
    tx, ty = by_ellipse(pair, angle, ux / speed, uy / speed)
    f, turning = law(speed) * area, x * ty - y * tx
    return np.array([f @ tx, f @ ty, f @ (x * tx), f @ (y * tx), f @ (x * ty), f @ (y * ty),
                     f @ (x * turning), f @ (y * turning)])  # fmt: skip


def whole(base: Base) -> tuple[Any, int, int, float]:
    shape = packed(base, 0.0)
    return shape, *whole_contour(shape, 0), shape[REACH]


def units(base: Base) -> np.ndarray:
    """Of sums: f N, times as many lengths as they have."""
    return 0.3 * base.area * np.array([1.0] * 2 + [base.reach] * 4 + [base.reach**2] * 2)


def slip_about(rng: np.random.Generator, base: Base, number: int) -> tuple[float, float, float]:
    """One with its instantaneous centre inside, beside, on a corner, or far away."""
    w, turn = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(0.0, 1.5)), rng.uniform(0.0, 7.0)
    away = 10.0 ** rng.uniform(0.0, 2.0) if number % 2 else rng.uniform(0.0, 1.3)
    cx, cy = base.reach * away * math.cos(turn), base.reach * away * math.sin(turn)
    if number % 5 == 0 and not base.discs:
        cx, cy = base.points()[number % len(base.points())] - base.middle
    if base.reach * away * abs(w) > 30.0:
        w *= 20.0 / (base.reach * away * abs(w))
    return w * cy, -w * cx, w


@pytest.mark.parametrize("numbers", [range(4), thorough(range(4, 40))])
@pytest.mark.parametrize("name", BASES)
def test_sums_are_those_of_points_on_rays(name: str, numbers: range) -> None:
    """The largest gap of 200 is 8e-11 of f N, where the moments of a law are good to 1e-11."""
    rng, base = np.random.default_rng([3, len(numbers)]), BASES[name]
    packs = {law: packed_law(*law_moments(law, law.pieces(TOP)[0])) for law in LAWS}
    for number in numbers:
        law, ratio = list(LAWS)[number % 3], 10.0 ** rng.uniform(-1.52, 1.52)
        ratio = (0.03, 1.0 / 0.03, ratio, 1.0)[number % 4]
        pair, angle = (min(1.0, ratio), min(1.0, 1.0 / ratio)), float(rng.uniform(0.0, math.pi))
        slip = slip_about(rng, base, number)
        axes = Ellipse(*pair, math.cos(angle), math.sin(angle))
        found = law_sums(*whole(base), packs[law], axes, *slip)
        gap = np.abs(found - judged(name, law, pair, angle, slip)) / units(base)
        assert gap.max() < 1e-10, (number, slip)


@pytest.mark.parametrize("name", BASES)
def test_a_constant_law_is_the_ellipse_and_one_without_axes_the_law(name: str) -> None:
    rng, base = np.random.default_rng(5), BASES[name]
    constant = packed_law(*law_moments(lambda u: 0.3 + 0.0 * u, np.array([0.0, TOP])))
    stribeck = packed_law(*law_moments(STRIBECK, STRIBECK.pieces(TOP)[0]))
    plain = Ellipse(1.0, 1.0, 1.0, 0.0)
    slips = [slip_about(rng, base, number) for number in range(30)] + [(0.6, -0.8, 0.0)]
    for slip in slips:
        axes = Ellipse(1.0, float(rng.uniform(0.03, 1.0)), 0.8, 0.6)
        one = law_sums(*whole(base), constant, axes, *slip)
        ellipse = np.array(elliptic_sums(*whole(base), axes, *slip))
        assert (np.abs(one - 0.3 * ellipse) < 2e-11 * units(base)).all(), slip
        law = np.array(law_sums(*whole(base), stribeck, plain, *slip))
        for nearly in (plain, Ellipse(1.0, 1.0 - 1e-14, 0.8, 0.6)):
            gap = np.abs(law_sums(*whole(base), stribeck, nearly, *slip) - law)
            assert (gap < 2e-11 * units(base)).all(), slip
        halved = law_sums(*whole(base), stribeck, Ellipse(0.5, 0.5, 0.8, 0.6), *slip)
        assert (np.abs(halved - 0.5 * law) < 1e-15 * units(base)).all()


@pytest.mark.parametrize("puck", [BOX, PUCK], ids=["box", "round"])
def test_what_equals_another_floor_moves_alike(puck: pt.Puck) -> None:
    law: Any = ICE.law
    one = end_of(puck, pt.Floor(orthotropic=ICE), THROWN)
    twice = replace(ICE, friction=(2.0, 0.8))
    halved = pt.Floor(orthotropic=twice, grips=[pt.Grip([[0.0, 0.5], [1.0, 0.5]])])
    assert np.abs(end_of(puck, halved, THROWN) - one).max() < 3e-9
    plain = end_of(puck, pt.Floor(law=law), THROWN)
    alike = pt.Floor(orthotropic=pt.Orthotropic((1.0, 1.0), 0.4, law=law))
    assert np.abs(end_of(puck, alike, THROWN) - plain).max() < 3e-9
    ellipse = end_of(puck, pt.Floor(orthotropic=pt.Orthotropic((0.3, 0.12), 0.7)), THROWN)
    rows = [[0.0, 0.3], [9.0, 0.3]]
    floor = pt.Floor(orthotropic=pt.Orthotropic((1.0, 0.4), 0.7, law=rows))
    assert np.abs(end_of(puck, floor, THROWN) - ellipse).max() < 3e-9
    turned = replace(THROWN, velocity=(-0.2, 0.6), orientation=0.2 + math.pi / 2)
    floor = pt.Floor(orthotropic=replace(ICE, direction=0.7 + math.pi / 2))
    time, x, y, angle = end_of(puck, floor, turned)
    assert np.abs([time, y, -x, angle - math.pi / 2] - one).max() < 3e-9


@pytest.mark.parametrize("puck", [BOX, PUCK], ids=["box", "round"])
def test_at_rest_it_holds_by_the_ellipse_of_the_law_at_slip_zero(puck: pt.Puck) -> None:
    for direction, friction in ((0.0, 0.3), (0.5 * math.pi, 0.12)):
        for ratio in (1.0, 1.2):
            floor = pt.Floor(orthotropic=replace(ICE, direction=direction), static_ratio=ratio)
            for off, rests in ((-1e-9, True), (1e-6, False)):
                tilted = replace(floor, slope=math.atan(ratio * friction) + off)
                run = pt.Scene(replace(puck, height=0.0), tilted, time=0.2).simulate([0.0])
                assert (run.end == "at rest") == rests, (direction, ratio, off)


def test_pucks_of_a_board_feel_it_as_one_does() -> None:
    pucks = [replace(PUCK, launch=THROWN, mass=1.0),
             replace(PUCK, launch=replace(THROWN, position=(0.0, 5.0)), mass=2.0)]  # fmt: skip
    board: Any = pt.Scene(pucks=pucks, floor=pt.Floor(orthotropic=ICE)).simulate()
    alone = end_of(PUCK, pt.Floor(orthotropic=ICE), THROWN)
    found = np.array([board.stop_times, *(board.last[k] for k in ("x", "y", "orientation"))])
    for number, off in enumerate((0.0, 5.0)):
        assert np.abs(found[:, number] - [0.0, 0.0, off, 0.0] - alone).max() < 3e-9


FILE = """
puck.radius = 0.05
launch.velocity = [1.0, 0.2]
[floor.orthotropic]
friction = [1.0, 0.5]
law = "ice.csv"
[[floor.patch]]
corners = "spot.csv"
[floor.patch.friction]
kind = "orthotropic"
friction = [1.0, 2.0]
law = {kind = "stribeck", static = 0.3, kinetic = 0.1, speed = 0.2}
"""


def test_it_stands_in_files_reports_and_pictures(tmp_path: Path) -> None:
    (tmp_path / "ice.csv").write_text("speed,f\n0,0.2\n5,0.1\n")
    (tmp_path / "spot.csv").write_text("x,y\n0.2,-0.1\n0.4,-0.1\n0.4,0.1\n0.2,0.1\n")
    (tmp_path / "ice.toml").write_text(FILE)
    scene = pt.Scene.load(str(tmp_path / "ice.toml"))
    assert pt.Scene.from_tables(tomllib.loads(as_toml(scene))) == scene
    assert scene.floor.patches[0].friction == pt.Orthotropic(
        (1.0, 2.0), law=pt.StribeckLaw(0.3, 0.1, speed=0.2)
    )
    run = scene.simulate()
    assert "by slip speed, floor.orthotropic.law, floor.patch[0].friction.law; by dir" in str(run)
    assert "or goes by both: it is summed over every base" in run.explain()
    labels = {text.get_text() for ax in run.plot().axes for text in ax.get_legend().get_texts()}
    assert "f = 0.3 along, 0.6 across at rest" in labels
    assert "law=StribeckLaw(" in repr(scene) and "friction law" in run.explain()
    tables = {**tomllib.loads(FILE), "floor": {"orthotropic": {
        "friction": [1.0, [0.5, 1.0]], "law": {"kind": "power", "a": 0.1, "exponent": 1.0, "b": 1},
    }}}  # fmt: skip
    two_ends_as_alone(pt.Scene.from_tables(tables))


@pytest.mark.parametrize(
    ("puck", "floor", "said"),
    [
        ({}, {"orthotropic": pt.Orthotropic((1.0, 0.5)), "law": STRIBECK},
         "floor.orthotropic and floor.law: friction by speed and direction is floor.orthotropic.l"),
        ({}, {"orthotropic": replace(ICE, law="stribeck")},
         "floor.orthotropic.law = 'stribeck': a law by name is a table, floor.orthotropic.law.k"),
        ({}, {"patches": [pt.Patch(replace(ICE, law=[[0, 1, 2]]), radius=1.0)]},
         r"floor.patch\[0\].friction.law: each row must be two numbers"),
        ({}, {"orthotropic": replace(ICE, law=pt.PowerLaw(0.1, -0.5))},
         "floor.orthotropic.law: exponent = -0.5 with b = 0"),
        ({}, {"orthotropic": replace(ICE, law=3.0)},
         "floor.orthotropic.law = 3.0: must be the name of a CSV file, or a list of rows"),
        ({}, {"orthotropic": replace(ICE, friction=(1.0, 0.01))}, "must be at least 0.03 of"),
        ({"pressure": "hertz"}, {"orthotropic": ICE}, "floor.orthotropic: known under uniform"),
        ({}, {"orthotropic": replace(ICE, law="none.csv")}, "none.csv"),
        ({}, {"orthotropic": replace(ICE, law=[[0.0, 0.2], [0.5, 0.1]])},
         r"faster than the friction law floor.orthotropic.law goes \(0.5 m/s\)"),
    ],
)  # fmt: skip
def test_what_is_not_known_is_refused(puck, floor, said):
    with pytest.raises(pt.InputError, match=said):
        pt.Scene(pt.Puck(0.05, **puck), pt.Floor(**floor), pt.Launch((1.0, 0.0))).simulate()
