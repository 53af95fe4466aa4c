"""Friction by direction, by slip speed or by both on strips and patches: a judge, known answers."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from rarely import thorough
from rays_judge import border, by_ellipse, friction_of, sides, where_it_bends, within
from scenes import end_of, two_ends_as_alone
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize

import puck_tables as pt
from puck_tables.scene.library import as_toml
from puck_tables.world.floor_forces import friction_at

BOX, ROUND = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)], 0.06
WOOD = pt.Orthotropic((0.1, 0.35), 0.7)
SOLE = pt.Orthotropic((0.3, 0.12), -0.4, fixed_to="body")
FELT = pt.Orthotropic((0.25, 0.15), 2.0)
STRIBECK = pt.StribeckLaw(0.3, 0.1, speed=0.3)
STEEP = pt.CurlingLaw(0.02, 0.1, 0.05)
KINKED = ((0.0, 0.3), (0.2, 0.35), (0.4, 0.15), (90.0, 0.15))
ICY = pt.Orthotropic((1.0, 0.4), 0.7, law=STRIBECK)
GROOVED = pt.Orthotropic((0.3, 1.1), -0.4, fixed_to="body", law=KINKED)


HOOK = [(0.0, 0.0), (0.09, -0.02), (0.08, 0.05), (0.03, 0.03), (0.02, 0.09)]
# where rays are cut: next to slip zero laws bend most
BENDS = {STRIBECK: [0.2, 0.7, 2.0], STEEP: [0.03, 0.1, 0.3, 1.0], KINKED: [0.2, 0.4]}


def law_of(one: Any) -> Any:
    """What goes by the slip speed in a friction, or nothing."""
    return one.law if isinstance(one, pt.Orthotropic) else None if isinstance(one, float) else one


def axes_of(one: Any, turn: float) -> float:
    return float(one.direction + (turn if one.fixed_to == "body" else 0.0))


def friction_on(one: Any, turn: float, ex: np.ndarray, ey: np.ndarray, slip: np.ndarray) -> Any:
    if isinstance(one, float):
        return one * ex, one * ey
    law = pt.SpeedLaw(*zip(*KINKED, strict=True)) if law_of(one) == KINKED else law_of(one)
    f = law(slip) if law else 1.0
    if not isinstance(one, pt.Orthotropic):
        return f * ex, f * ey
    tx, ty = by_ellipse(one.friction, axes_of(one, turn), ex, ey)
    return f * tx, f * ty


class Judge:
    """A floor of one border and one patch under a box or a disc, at the places of states."""

    def __init__(self, shape: str, strips: Any, patch: Any, height: float) -> None:
        self.shape, self.strips, self.patch, self.lever = shape, strips, patch, 0.5 * height
        self.cut = (0.02, 0.3) if len(strips) > 1 else None

    def forces(self, state: Any, panels: int = 4) -> np.ndarray:
        px, py, turn, *velocity = state
        c, s = math.cos(turn), math.sin(turn)
        corners = [(c * x - s * y, s * x + c * y) for x, y in BOX]
        curves: list[Any] = sides(corners) if self.shape == "box" else [(0.0, 0.0, ROUND)]
        if self.cut is not None:
            place, angle = self.cut
            place -= px * math.cos(angle) + py * math.sin(angle)
            curves.append(border(angle, place))
        if self.patch is not None and self.patch.corners:
            curves += sides([(x - px, y - py) for x, y in HOOK])
        elif self.patch is not None:
            (mx, my), radius = self.patch.centre, self.patch.radius
            curves.append((mx - px, my - py, radius))
        own = [*self.strips, *([] if self.patch is None else [self.patch.friction])]
        laws = [one for one in own if law_of(one)]
        speeds = [speed for one in laws for speed in BENDS[law_of(one)]]
        axes = [axes_of(one, turn) for one in laws if isinstance(one, pt.Orthotropic)]
        bent = where_it_bends(velocity, speeds, axes)
        curves = [*bent, *curves] if laws else curves

        def inside(x: np.ndarray, y: np.ndarray) -> np.ndarray:
            if self.shape != "box":
                return np.hypot(x, y) < ROUND
            return (abs(c * x + s * y) < 0.1) & (abs(c * y - s * x) < 0.05)

        def local(x: np.ndarray, y: np.ndarray, ex: np.ndarray, ey: np.ndarray) -> Any:
            slip = np.hypot(velocity[0] - velocity[2] * y, velocity[1] + velocity[2] * x)
            tx, ty = friction_on(self.strips[0], turn, ex, ey, slip)
            choice = []
            if self.cut is not None:
                beyond = x * math.cos(angle) + y * math.sin(angle) > place
                choice.append((beyond, self.strips[1]))
            if self.patch is not None and self.patch.corners:
                choice.append((within([HOOK])(x + px, y + py), self.patch.friction))
            elif self.patch is not None:
                choice.append((np.hypot(x - mx + px, y - my + py) < radius, self.patch.friction))
            for where, one in choice:
                ox, oy = friction_on(one, turn, ex, ey, slip)
                tx, ty = np.where(where, ox, tx), np.where(where, oy, ty)
            return tx, ty

        panels, inner = (min(panels, 6), 12) if laws else (panels, 3)
        return friction_of(curves, inside, local, velocity, self.lever, panels, inner)


FLOORS: dict[str, tuple[list[Any], Any]] = {
    "wood beside a number": ([WOOD, 0.2], None),
    "a sole on half of it, felt on the other": ([SOLE, FELT], None),
    "a round patch of wood": ([0.2], pt.Patch(WOOD, (0.03, 0.01), 0.04)),
    "a round patch of a number on felt": ([FELT], pt.Patch(0.3, (0.02, 0.01), 0.05)),
    "felt in a sole beside wood": ([SOLE, WOOD], pt.Patch(FELT, (-0.05, 0.0), 0.04)),
    "ice": ([ICY], None),
    "grooves on ice, a number around them": ([GROOVED, ICY], pt.Patch(0.2, (-0.05, 0.0), 0.04)),
    "grooves": ([GROOVED], None),
    "a patch of grooves on wood": ([WOOD], pt.Patch(GROOVED, (0.03, 0.01), 0.04)),
    "a law beside a number": ([STRIBECK, 0.2], None),
    "a law beside another": ([STEEP, STRIBECK], None),
    "a hook of one law in another": ([STRIBECK], pt.Patch(STEEP, corners=HOOK)),
}


def floor_of(strips: list[Any], patch: Any) -> pt.Floor:
    patches = () if patch is None else (patch,)
    if len(strips) == 1:
        own = strips[0]
        if isinstance(own, float):
            return pt.Floor(patches=patches)
        if own == STRIBECK:
            return pt.Floor(law=own, patches=patches)
        return pt.Floor(orthotropic=own, patches=patches)
    return pt.Floor(strips=pt.Strips((0.02,), tuple(strips), direction=0.3), patches=patches)


def body(shape: str, height: float) -> pt.Puck:
    base: Any = {"base": "box:0.2x0.1"} if shape == "box" else {"radius": ROUND}
    base |= {"pressure": shape} if shape.startswith("annulus") else {}
    return pt.Puck(**base, friction=0.2, height=height, mass=1.0, gravity=1.0)


@pytest.mark.parametrize("height", [thorough(0.0), 0.04])
@pytest.mark.parametrize(
    ("name", "shape", "seed"),
    [
        *((name, ("box", "round")[n % 2], 11) for n, name in enumerate(FLOORS)),
        *(thorough(name, ("round", "box")[n % 2], 12) for n, name in enumerate(FLOORS)),
    ],
)
def test_friction_is_that_of_points_on_rays(name, shape, seed, height):
    rng, (strips, patch) = np.random.default_rng(seed), FLOORS[name]
    judge = Judge(shape, strips, patch, height)
    states = rng.normal(size=(6, 6)) * [0.04, 0.03, 3.0, 1.0, 1.0, 1.0]
    states[:, 5] = np.tile([-1.0, 1.0], 3) * 10.0 ** rng.uniform(-0.5, 2.5, 6)
    quick = pt.Launch((50.0, 0.0))  # laws are looked at as far as a launch slips
    found = friction_at(pt.Scene(body(shape, height), floor_of(strips, patch), quick), states)
    for state, forces in zip(states, found, strict=True):
        gap = np.abs(forces - judge.forces(state, 24)) / [1.0, 1.0, 0.1]
        assert gap.max() < 1e-10, state


MOTIONS = [("a sole on half of it, felt on the other", "round", 0.03),
           ("ice", "round", 0.03),
           thorough("a law beside another", "round", 0.0),
           thorough("a law beside a number", "round", 0.0),
           thorough("felt in a sole beside wood", "box", 0.02),
           thorough("grooves", "box", 0.0)]  # fmt: skip


@pytest.mark.parametrize(("name", "shape", "height"), MOTIONS)
def test_a_motion_is_that_of_scipy_with_points_on_rays(name, shape, height):
    strips, patch = FLOORS[name]
    judge, thrown = Judge(shape, strips, patch, height), body(shape, height)
    inertia = thrown.inertia_radius**2 * thrown.mass

    def rates(_: float, y: np.ndarray) -> list[float]:
        fx, fy, torque = judge.forces(y, 2)
        return [*y[3:], fx, fy, torque / inertia]

    start, times = [-0.1, 0.02, 0.3, 0.45, -0.1, 4.0], [0.1, 0.3, 0.5]
    truth = solve_ivp(rates, (0.0, 0.5), start, "DOP853", times, rtol=1e-11, atol=1e-12).y
    launch = pt.Launch((0.45, -0.1), spin=4.0, position=(-0.1, 0.02), orientation=0.3)
    run = pt.Scene(thrown, floor_of(strips, patch), launch, tol=1e-10).simulate(times)
    for key, row in zip(("x", "y", "orientation", "vx", "vy", "spin"), truth, strict=True):
        unit = 1.0 / ROUND if key in ("orientation", "spin") else 1.0
        assert run.columns[key] == pytest.approx(row, abs=1e-9 * unit), key


def ends(floor: pt.Floor, shape: str) -> np.ndarray:
    return end_of(body(shape, 0.03), floor, pt.Launch((0.6, 0.2), spin=8.0))


@pytest.mark.parametrize(
    ("shape", "one"), [*product(("box", "round"), (WOOD, STRIBECK, ICY)), ("annulus:0.6", STRIBECK)]
)
def test_stretches_of_one_friction_are_one_floor(shape: str, one: Any) -> None:
    alone = floor_of([one], None)
    strips = pt.Floor(strips=pt.Strips((0.1, 0.3), (one, one, one), direction=0.3))
    patch = replace(alone, patches=[pt.Patch(one, (0.15, 0.03), 0.07)])
    for floor in (strips, patch):
        assert np.abs(ends(floor, shape) - ends(alone, shape)).max() < 3e-9


def test_equal_frictions_of_a_stretch_are_its_number() -> None:
    for shape in ("box", "round"):
        found = [
            ends(pt.Floor(strips=pt.Strips((0.1,), (0.2, one), direction=0.2)), shape)
            for one in (0.1, pt.Orthotropic((0.1, 0.1), 0.8))
        ]
        assert np.abs(np.subtract(*found)).max() < 3e-9


def test_a_law_may_stand_beside_a_direction() -> None:
    """Where nothing reaches the law of the other strip it changes nothing."""
    ice = pt.StribeckLaw(0.3, 0.1, speed=0.3)
    found = [
        ends(pt.Floor(strips=pt.Strips((5.0,), (WOOD, other))), "round") for other in (ice, 0.2)
    ]
    assert np.abs(np.subtract(*found)).max() < 3e-9
    both = pt.Floor(strips=pt.Strips((0.1,), (ice, WOOD), direction=0.2))
    assert ends(both, "box")[0] > 0.0


@pytest.mark.parametrize("shape", ["box", "round"])
def test_a_patch_holds_by_the_friction_along_the_slope(shape: str) -> None:
    """All of it on the patch: the slope is held by the friction of the axis along it."""
    for direction, friction in ((0.0, 0.1), (0.5 * math.pi, 0.35)):
        patch = pt.Patch(pt.Orthotropic((0.1, 0.35), direction), radius=1.0)
        for off, rests in ((-1e-9, True), (1e-6, False)):
            floor = pt.Floor(slope=math.atan(friction) + off, patches=[patch])
            run = pt.Scene(body(shape, 0.0), floor, time=0.3).simulate([0.0])
            assert (run.end == "at rest") == rests, (direction, off)


@pytest.mark.parametrize("shape", ["box", "round"])
def test_a_turntable_carries_what_its_ellipse_holds(shape: str) -> None:
    """Radially by f along the axis that lies so under it, wherever that has turned to."""
    turning = 2.0
    for bearing, friction in ((0.0, 0.1), (0.5 * math.pi, 0.35)):
        for share, end in ((0.999, "carried by the floor"), (1.001, "time is up")):
            away = share * friction / turning**2
            place = away * math.cos(bearing), away * math.sin(bearing)
            launch = pt.Launch((-turning * place[1], turning * place[0]), turning, place)
            floor = pt.Floor(orthotropic=pt.Orthotropic((0.1, 0.35)), turning=turning)
            run = pt.Scene(body(shape, 0.0), floor, launch, time=4.0).simulate([0.0])
            assert run.end == end, (bearing, share)


# of a tray: t, velocity and spin; it is as at first until 0.1, and its spin jumps at no time
TRAY = np.array([[0.1, 0.1, 0.0, 2.0], [0.4, -0.2, 0.3, 4.0], [0.9, 0.1, 0.3, -1.0]])
TURNTABLE = np.array([[0.0, 0.0, 0.0, 2.5], [1.0, 0.0, 0.0, 2.5]])


@pytest.mark.parametrize(
    ("shape", "height", "wood", "rows"),
    [
        ("box", 0.02, WOOD, TRAY), ("round", 0.0, WOOD, TRAY),
        *(thorough(*one, TURNTABLE) for one in (("box", 0.0, WOOD), ("round", 0.03, WOOD))),
        thorough("round", 0.0, ICY, TURNTABLE),
    ],
)  # fmt: skip
def test_axes_of_a_floor_turn_with_it(shape: str, height: float, wood: Any, rows: Any) -> None:
    """Its angle is an unknown of the judge, beside the six of the puck."""
    thrown, cx = body(shape, height), 0.1
    inertia = thrown.inertia_radius**2 * thrown.mass

    def rates(t: float, y: np.ndarray) -> list[float]:
        bx, by, turning = (np.interp(t, rows[:, 0], rows[:, k]) for k in (1, 2, 3))
        now = replace(wood, direction=wood.direction + y[6])
        ux, uy = y[3] - bx + turning * y[1], y[4] - by - turning * (y[0] - cx)
        state = [0.0, 0.0, y[2], ux, uy, y[5] - turning]
        fx, fy, torque = Judge(shape, [now], None, height).forces(state, 2)
        return [*y[3:6], fx, fy, torque / inertia, turning]

    state, times, truth = np.array([-0.1, 0.02, 0.3, 0.55, -0.1, 9.0, 0.0]), [0.1, 0.4, 0.8], []
    for begin, end in zip([0.0, *times], times, strict=False):
        state = solve_ivp(rates, (begin, end), state, "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
        truth.append(state)
    launch = pt.Launch((0.55, -0.1), spin=9.0, position=(-0.1, 0.02), orientation=0.3)
    moves: Any = {"over_time": rows} if rows is TRAY else {"turning": 2.5}
    floor = pt.Floor(orthotropic=wood, centre=(cx, 0.0), **moves)
    run = pt.Scene(thrown, floor, launch, time=0.9, tol=1e-10).simulate(times)
    keys = ("x", "y", "orientation", "vx", "vy", "spin")
    for key, row in zip(keys, np.transpose(truth), strict=False):
        unit = 1.0 / ROUND if key in ("orientation", "spin") else 1.0
        assert run.columns[key] == pytest.approx(row, abs=2e-9 * unit), key
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("shape", ["box", "round"])
def test_a_tray_holds_by_the_axis_that_has_turned_under_the_pull(shape: str) -> None:
    """At its centre: from t = 1 on, when that has turned by 0.3 rad."""
    rows = [[0.5, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 1.2]]
    floor = pt.Floor(orthotropic=pt.Orthotropic((0.1, 0.35), 0.5 * math.pi), over_time=rows)
    pull = pt.Force(over_time=[[1.0, 0.2, 0.0], [2.0, 0.2, 0.0]])
    run = pt.Scene(body(shape, 0.0), floor, force=pull, time=2.0).simulate([0.0])
    # the ellipse holds 1/hypot(cos/0.35, sin/0.1) there, as its axis has turned by that angle
    angle = math.asin(math.sqrt((0.2**-2 - 0.35**-2) / (0.1**-2 - 0.35**-2)))
    slips = [event.time for event in run.events if event.what == "slip"]
    assert slips[0] == pytest.approx(1.0 + (angle - 0.3) / 1.2, abs=1e-8)
    assert run.energy_residual < 1e-9


def held(pull: float, torque: float, angle: float, friction: tuple[float, float]) -> float:
    """What a disc takes up of a force and a torque at the load 1, less them, as a share."""
    node, weight = np.polynomial.legendre.leggauss(16)
    rho, turn = 0.5 * (1.0 + node)[:, None], 2.0 * math.pi * np.arange(64) / 64
    x, y, area = rho * np.cos(turn), rho * np.sin(turn), weight[:, None] * rho / 64
    c, s = math.cos(angle), math.sin(angle)

    def most(slip: np.ndarray) -> float:
        ux, uy = 1.0 - slip[1] * y, slip[0] + slip[1] * x
        along, across = friction[0] * (c * ux + s * uy), friction[1] * (c * uy - s * ux)
        return float((area * np.hypot(along, across)).sum()) / (pull + torque * slip[1] / ROUND)

    return float(minimize(most, [0.0, 0.0], method="Nelder-Mead", tol=1e-10).fun) - 1.0


def test_a_tray_that_spins_up_loses_a_puck_where_an_axis_comes_by() -> None:
    """Pulled by a force all the time it lies, until the smooth axis comes along that: 9 rad/s²."""
    puck = pt.Puck(ROUND, friction=0.2, mass=1.0, gravity=1.0, gyration=0.1)
    rows = [[0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 18.0]]
    axes = pt.Orthotropic((0.1, 0.35), 0.5 * math.pi)
    floor = pt.Floor(orthotropic=axes, over_time=rows)
    run = pt.Scene(puck, floor, force=pt.Force((0.13, 0.0)), time=2.0).simulate([0.0])
    slips = next(event.time for event in run.events if event.what == "slip")
    torque = 9.0 * (0.1 * ROUND) ** 2

    def spare(t: float) -> float:
        return held(0.13, -torque, axes.direction + 4.5 * t * t, axes.friction)

    assert slips == pytest.approx(brentq(spare, 0.2, 0.6, xtol=1e-12), abs=1e-7)


FILE = """
[puck]
radius = 0.05
[launch]
velocity = [1.0, 0.2]
[floor]
patch = [{friction = {kind = "orthotropic", friction = [0.1, 0.3]}, centre = [0.3, 0.0], radius = 0.1}]
[floor.strips]
borders = [0.1]
friction = [0.2, {kind = "orthotropic", friction = [0.1, 0.3], fixed_to = "body"}]
"""  # noqa: E501


def test_it_stands_in_files_reports_pictures_and_sweeps() -> None:
    scene = pt.Scene.from_tables(tomllib.loads(FILE))
    assert scene.floor.patches[0].friction == pt.Orthotropic((0.1, 0.3))
    assert pt.Scene.from_tables(tomllib.loads(as_toml(scene))) == scene
    run = scene.simulate([0.0])
    told = str(run)
    assert "by direction, floor.strips.friction[1], floor.patch[0].friction, f g =" in told
    assert "0.980665 along and 2.94199 across" in told and "orthotropic friction" in told
    labels = {text.get_text() for ax in run.plot().axes for text in ax.get_legend().get_texts()}
    assert "f = 0.1 along, 0.3 across" in labels
    tables = tomllib.loads(FILE)
    tables["floor"]["patch"][0]["friction"]["direction"] = [0.0, 1.0]
    two_ends_as_alone(pt.Scene.from_tables(tables))


@pytest.mark.parametrize(
    ("puck", "floor", "said"),
    [
        ({}, {"patches": [pt.Patch(pt.Orthotropic((0.3, 0.001)), radius=1.0)]},
         r"floor.patch\[0\].friction.friction = \[0.3, 0.001\]: one must be at least 0.03"),
        ({}, {"patches": [pt.Patch(WOOD, radius=1.0)], "turning": 1.0},
         r"floor.patch\[0\].friction: not on a floor that turns"),
        ({}, {"strips": pt.Strips((0.0,), (0.1, WOOD)), "over_time": TRAY},
         r"floor.strips.friction\[1\]: not on a floor that turns"),
        ({}, {"orthotropic": WOOD, "strips": pt.Strips((0.0,), (0.1, 0.2))},
         "floor.orthotropic and floor.strips: strips say all friction"),
        ({"pressure": "hertz"}, {"strips": pt.Strips((0.0,), (0.1, WOOD))},
         "known under uniform pressure only, over any base, not with puck.pressure = 'hertz'"),
        ({"pressure": "hertz"}, {"orthotropic": WOOD}, "floor.orthotropic: known under uniform"),
    ],
)  # fmt: skip
def test_what_is_not_known_is_refused(puck, floor, said):
    with pytest.raises(pt.InputError, match=said):
        pt.Scene(pt.Puck(0.05, **puck), pt.Floor(**floor), time=1.0)
    with pytest.raises(pt.InputError, match="one of curling, power, stribeck, orthotropic"):
        pt.Scene.from_tables({
            "puck": {"radius": 1.0}, "floor": {"patch": [{"friction": {"kind": "wood"}}]},
        })  # fmt: skip
