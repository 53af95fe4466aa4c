"""The limit surface against a sum over patches and the theory of flat sliders; what it holds."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from scenes import simulate_scene

import puck_tables as pt

LAWS = ["uniform", "hertz", "galin", "ring", "annulus:0.5"]
G = 9.80665
every_law = pytest.mark.parametrize("law", LAWS)


@every_law
def test_its_points_are_friction_of_slips(law: str):
    """By slip angles from −π/2 to π/2; what other tests judge of every law."""
    surface = pt.Puck.similar(delta=0.4, pressure=law).limit_surface(7)
    phi = surface.slip_angle
    rho, (cosine, sine) = pt.law_of(law).friction(phi, 0.4), (np.cos(phi), np.sin(phi))
    np.testing.assert_allclose(surface.force_x, cosine * rho.parallel, atol=1e-9)
    np.testing.assert_allclose(surface.force_y, cosine * sine * rho.perpendicular, atol=1e-9)
    np.testing.assert_allclose(surface.torque, 0.5 * sine * rho.spin, atol=1e-9)


@every_law
def test_a_flat_slider_has_a_convex_surface_and_its_twist_for_normal(law: str):
    """No other wrench takes more power from a twist than its own: convex, and normal to it."""
    surface = pt.Puck.similar(delta=0.0, pressure=law).limit_surface(202)
    cosine, sine = np.cos(surface.slip_angle), np.sin(surface.slip_angle)
    assert surface.is_convex and not np.any(surface.force_y)
    np.testing.assert_allclose(surface.normal_x, cosine, atol=1e-6)
    np.testing.assert_allclose(surface.normal_torque, sine, atol=1e-6)
    power = np.outer(cosine, surface.force_x) + np.outer(sine, surface.torque)
    assert np.all(power <= np.diag(power)[:, None] + 1e-12)
    assert np.all(np.diag(power) > 0.0)


def test_known_points_of_a_tilted_load():
    """Elementary resultants at φ = 0, π/4, π/2 (Salnikova et al. 2012, table 6.1), δ = 1."""
    surface = pt.Puck(0.5, 0.5, 0.5, mass=2.0).limit_surface(5)
    assert surface.puck.delta == 1.0
    unit, q = 2.0 * 0.5 * G, (45.0 * math.pi) ** 2 + 16.0**2
    half = math.sqrt(0.5)
    along = [1.0, half * 5400.0 * math.sqrt(2.0) * math.pi / q, 0.0]
    across = [0.0, 0.5 * 7680.0 / q, 0.0]
    spin = 16.0 * math.sqrt(2.0) / (9.0 * math.pi) * ((45.0 * math.pi) ** 2 - 2.0 * 32.0**2) / q
    turning = [0.0, 0.5 * half * spin, 2.0 / 3.0]
    np.testing.assert_allclose(surface.force_x[2:], unit * np.array(along), atol=1e-13)
    np.testing.assert_allclose(surface.force_y[2:], unit * np.array(across), atol=1e-13)
    np.testing.assert_allclose(surface.torque[2:], 0.5 * unit * np.array(turning), atol=1e-13)
    np.testing.assert_allclose(surface.torque, -surface.torque[::-1], atol=1e-13)
    assert surface.unit_force == pytest.approx(unit)


@pytest.mark.parametrize(("delta", "turned"), [(0.0, 0.0), (0.5, 0.3), (2.0, 3.0)])
def test_normals_are_those_of_the_curve_of_size_and_torque(delta: float, turned: float):
    """By differences along it; friction that is turned from the slip turns them with it."""
    surface = pt.Puck.similar(delta=delta, pressure="uniform").limit_surface(1001)
    force, torque = np.hypot(surface.force_x, surface.force_y), surface.torque
    curve = np.stack([np.gradient(torque), -np.gradient(force)])[:, 1:-1]
    curve = np.arctan2(curve[1], curve[0])
    along = (surface.normal_x * surface.force_x + surface.normal_y * surface.force_y)[1:-1]
    normal = np.arctan2(surface.normal_torque[1:-1], along / force[1:-1])
    assert np.quantile(np.abs(normal - curve), 0.99) < 1e-3
    twist = np.arctan2(surface.normal_torque, np.hypot(surface.normal_x, surface.normal_y))
    off = np.degrees(np.abs(twist - surface.slip_angle).max())
    assert off == pytest.approx(turned, rel=0.5, abs=1e-4)


@pytest.mark.parametrize("delta", [0.0, 0.8, 3.5])
def test_models_are_convex_and_as_far_off_as_they_say(delta: float):
    surface = pt.Puck.similar(delta=delta, radius=0.1, decel=3.0).limit_surface(720)
    rng = np.random.default_rng(3)
    one, two = rng.normal(0.0, 1.0, (2, 3, 20_000)) * np.array([[1.0], [1.0], [0.1]])
    forces = np.stack([surface.force_x, surface.force_y], axis=-1)
    normals = np.stack([surface.normal_x, surface.normal_y, surface.normal_torque], axis=-1)
    for model in (surface.ellipsoid, surface.quartic):
        found = np.abs(1.0 / model.gauge(forces, surface.torque) - 1.0).max()
        assert found == pytest.approx(model.error, rel=1e-3)
        sizes = [model.gauge(w[:2].T, w[2]) for w in (one, two, 0.5 * (one + two))]
        assert np.all(sizes[2] <= 0.5 * (sizes[0] + sizes[1]) * (1.0 + 1e-12))
        v, w = model.twist(forces, surface.torque)
        way = np.column_stack([v, 0.1 * w])
        across = np.linalg.norm(np.cross(way, normals), axis=1)
        off = np.arctan2(across, np.einsum("ni,ni->n", way, normals)).max()
        assert off == pytest.approx(model.normal_error, rel=1e-2)
        turned = model.gauge(forces[:, ::-1] * [1.0, -1.0], surface.torque)  # round as the puck is
        np.testing.assert_allclose(turned, model.gauge(forces, surface.torque), rtol=1e-12)
    assert surface.quartic.error < surface.ellipsoid.error


def test_an_ellipsoid_is_the_best_of_its_kind():
    surface = pt.Puck.similar(delta=0.0).limit_surface(2001)
    angle = np.arctan2(surface.torque / surface.torque.max(), surface.force)
    weight = np.gradient(angle)

    def off(a: float, b: float) -> float:
        size = np.sqrt((surface.force / a) ** 2 + (surface.torque / b) ** 2)
        return float(np.sum(weight * (1.0 / size - 1.0) ** 2))

    a, b = (
        1.0 / float(surface.ellipsoid.gauge(*wrench))
        for wrench in (((1.0, 0.0), 0.0), ((0.0, 0.0), 1.0))
    )
    for da, db in ((1.002, 1.0), (0.998, 1.0), (1.0, 1.002), (1.0, 0.998)):
        assert off(a, b) < off(da * a, db * b)


ROUND = {"radius": 1.0}, (0.0, 2.5), (0.0, 0.4, -3.0)
BOX = {"base": "box:0.2x0.1"}, (0.0, 0.12), (0.0, 0.02, -0.15)


@pytest.mark.parametrize(
    ("body", "height", "ratio"),
    [(body, *pair) for body, heights, ratios in (ROUND, BOX) for pair in product(heights, ratios)],
)
def test_scenes_hold_what_holds(body: dict, height: float, ratio: float):
    """The puck of a scene stays just below the margin and slips just above; sums over the borders
    of a base share no code with Newton's method."""
    body = body | {"height": height, "friction": 0.2, "mass": 1.0 / (0.2 * G)}
    margin = float(pt.Puck(**body).holds((0.8, 0.6), ratio).margin)
    for share, end in ((1.0 - 1e-8, "at rest"), (1.0 + 1e-8, "time is up")):
        size = share * margin
        run = simulate_scene({
            "puck": body, "force": {"constant": [0.8 * size, 0.6 * size], "torque": ratio * size},
            "time": 1e-3,
        })  # fmt: skip
        assert run.end == end


@pytest.mark.parametrize("law", ["uniform", "ring"])
def test_the_surface_is_what_is_just_held(law: str):
    puck = pt.Puck(0.3, 0.2, 0.4, mass=3.0, pressure=law)
    surface = puck.limit_surface(41)
    forces = np.stack([surface.force_x, surface.force_y], axis=-1)
    margin = puck.holds(forces, surface.torque).margin
    np.testing.assert_allclose(margin, 1.0, atol=1e-8)
    turned = puck.holds(-forces[:, ::-1], surface.torque).margin
    np.testing.assert_allclose(turned, 1.0, atol=1e-8)
    assert puck.holds(0.999 * forces, 0.999 * surface.torque).held.all()
    assert not puck.holds(1.001 * forces, 1.001 * surface.torque).held.any()


def test_wrenches_of_any_size():
    puck = pt.Puck.similar(delta=0.5)
    sizes = 10.0 ** np.array([-300.0, -160.0, 0.0, 160.0, 300.0])
    found = puck.holds(sizes[:, None] * [0.3, -0.4], 0.2 * sizes)
    np.testing.assert_allclose(found.margin * sizes, found.margin[2], rtol=1e-12)
    assert found.held.tolist() == [True, True, True, False, False]
    small = pt.Puck(radius=0.04, friction=0.1, mass=0.2)
    most = [small.holds((0.0, 0.0), torque).margin * torque for torque in (1.0, 1e307, 1.7e308)]
    np.testing.assert_allclose(most, most[0], rtol=1e-6)  # the margin itself is less than 1e-308
    nothing = puck.holds((0.0, 0.0))
    assert bool(nothing) and nothing.margin == math.inf


def test_a_count_may_be_a_small_whole_number_of_numpy() -> None:
    box = pt.Puck(base="box:0.2x0.1", friction=0.3)
    few, same = box.limit_surface(np.int8(70)), box.limit_surface(70)  # type: ignore[arg-type]
    np.testing.assert_array_equal(few.torque, same.torque)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda p: p.limit_surface(4), "from 5"),
        (lambda p: p.limit_surface(7.5), "whole number"),
        (lambda p: p.limit_surface(math.nan), "n must be"),
        (lambda p: p.holds((1.0, math.inf)), "force"),
        (lambda p: p.holds(1.0), r"force must have two components \(fx, fy\) in N"),
        (lambda p: p.holds((1.0, 0.0), "strong"), "torque"),
        (lambda p: p.holds(np.zeros((3, 2)), np.zeros(2)), "torque"),
        (lambda p: p.limit_surface().ellipsoid.gauge((math.nan, 0.0), 1.0), "force"),
        (lambda p: pt.Puck(1.0).limit_surface(), "friction = 0"),
        (lambda p: pt.Puck(1.0).holds((1.0, 0.0)), "friction = 0"),
    ],
)
def test_bad_input_is_one_sentence(ask, words: str):
    with pytest.raises(pt.InputError, match=words):
        ask(pt.Puck.similar())


def test_what_is_printed_has_its_units():
    puck = pt.Puck(radius=0.1, friction=0.2, mass=1.0)
    load = 0.2 * 9.80665
    assert str(puck.wrench((1.0, 0.0), 0.0)) == f"force [{-load:.6g}  0.     ] N, torque 0.0 N m"
    assert str(puck.twist((-load, 0.0), 0.0)) == "velocity [1. 0.] m/s, spin 0.0 rad/s"
    written = puck.holds((f"{500.0 * load} mN", "0 mN"), "0 mN m")
    assert str(written).startswith("held: True; it slips at 2.0")
    with pytest.raises(pt.InputError, match=r"force must be a number \(N\), .* as '5mN'"):
        puck.holds(("2km/h", 0.0), 0.0)


def test_the_command(tmp_path: Path):
    out, picture = tmp_path / "surface.csv", tmp_path / "surface.png"
    command = ["limit-surface", "--delta", "0", "--points", "9", "-o", str(out)]
    done = invoke(*command, "--plot", picture)
    assert done.exit_code == 0, done.stderr
    assert picture.stat().st_size > 10_000
    said = str(pt.Puck.similar(delta=0.0).limit_surface(9))
    assert said in done.stderr and "convex; up to 1 N and 0.666667 N m\nellipsoid" in said
    rows = out.read_text().splitlines()
    assert rows[0].startswith("slip_angle[rad],force_x[N],force_y[N],torque[N m]")
    assert len(rows) == 10
    printed = invoke(*command[:-2])
    assert printed.stdout.splitlines() == rows
    few = invoke("limit-surface", "--points", "2")
    assert few.exit_code == 2 and "'--points': 2 is not in the range 5<=x" in few.stderr
