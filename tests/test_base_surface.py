"""The limit surfaces of bases: their normals, their convexity, the forms that stand for them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from commands import invoke

import puck_tables as pt

TRIANGLE = pt.Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)])
FEET = pt.Base.feet([(0.05, 0.0), (-0.03, 0.04), (-0.03, -0.05)], 0.005)
SHAPES = pytest.mark.parametrize("shape", [pt.Base.box(0.2, 0.1), TRIANGLE, FEET])


def surface_of(shape: pt.Base, share: float = 0.0, n: int = 31):
    height = 2.0 * share * shape.highest_lever / 0.4
    return pt.Puck(base=shape, friction=0.4, mass=2.0, height=height).limit_surface(n)


def points_of(surface) -> tuple[np.ndarray, np.ndarray]:
    """Points over f m g and k, and normals, (m, n, 3)."""
    length = surface.puck.inertia_radius * surface.unit_force
    points = (surface.force_x / surface.unit_force, surface.force_y / surface.unit_force,
              surface.torque / length)  # fmt: skip
    normals = (surface.normal_x, surface.normal_y, surface.normal_torque)
    return np.stack(points, axis=-1), np.stack(normals, axis=-1)


@SHAPES
def test_normals_are_across_the_surface(shape: pt.Base):
    """The finer the mesh, the more so: half the step, a quarter of the error or less."""
    worst = []
    for n in (161, 321):
        points, normals = points_of(surface_of(shape, 0.9, n))
        np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0, atol=1e-12)
        assert (np.einsum("mni,mni->mn", points, normals) > 0.0).all()
        steps = points[2:, 1:-1] - points[:-2, 1:-1], points[1:-1, 2:] - points[1:-1, :-2]
        lengths = [np.linalg.norm(one, axis=-1) for one in steps]
        off = [
            np.abs(np.einsum("mni,mni->mn", one, normals[1:-1, 1:-1])) / np.maximum(size, 1e-3)
            for one, size in zip(steps, lengths, strict=True)
        ]
        worst.append(np.mean(off))
    assert worst[0] < 2e-3 and worst[1] < 0.35 * worst[0]


@SHAPES
def test_of_a_flat_body_the_twist_is_the_normal_and_the_surface_convex(shape: pt.Base):
    surface = surface_of(shape)
    phi = surface.slip_angle
    np.testing.assert_allclose(
        surface.normal_torque, np.sin(phi) + 0.0 * surface.torque, atol=1e-12
    )
    along = np.cos(phi) * np.cos(surface.heading)[:, None]
    np.testing.assert_allclose(surface.normal_x, along, atol=1e-12)
    points, normals = (one.reshape(-1, 3) for one in points_of(surface))
    beyond = points @ normals.T - np.einsum("ni,ni->n", points, normals)
    assert beyond.max() < 1e-12 and surface.is_convex
    # what is just held is the surface
    force = np.stack([surface.force_x, surface.force_y], axis=-1)
    np.testing.assert_allclose(surface.puck.holds(force, surface.torque).margin, 1.0, atol=1e-9)


@SHAPES
@pytest.mark.parametrize("share", [0.0, 0.9])
def test_forms_are_convex_and_as_far_off_as_they_say(shape: pt.Base, share: float):
    surface = surface_of(shape, share)
    length = surface.puck.inertia_radius
    rng = np.random.default_rng(3)
    one, two = rng.normal(size=(2, 4000, 3)) * [1.0, 1.0, length]
    margin = surface.puck.holds(one[:, :2], one[:, 2]).margin
    for form in (surface.ellipsoid, surface.quartic):
        off = np.abs(1.0 / form.gauge(one[:, :2], one[:, 2]) / margin - 1.0).max()
        assert off == pytest.approx(form.error, rel=0.05)
        both = [form.gauge(w[:, :2], w[:, 2]) for w in (one, two, 0.5 * (one + two))]
        assert (both[2] <= 0.5 * (both[0] + both[1]) * (1.0 + 1e-9)).all()
        velocity, spin = form.twist(one[:, :2], one[:, 2])
        slip = surface.puck.twist(-one[:, :2], -one[:, 2])
        if share == 0.0:
            a = np.column_stack([velocity, length * spin])
            b = np.column_stack([slip.velocity, length * slip.spin])
            cosine = np.einsum("ni,ni->n", a, b) / np.linalg.norm(a, axis=1)
            turned = np.arccos(np.minimum(cosine, 1.0)).max()
            assert turned == pytest.approx(form.normal_error, rel=0.15)
    assert surface.quartic.error < surface.ellipsoid.error < 0.2


def test_a_round_base_has_the_surface_of_a_round_puck():
    on_base = surface_of(pt.Base.disc(0.05))
    other = pt.Puck(0.05, friction=0.4, mass=2.0).limit_surface()
    torque = np.linspace(0.0, 0.9, 7) * other.torque.max()
    force = np.stack([np.cos(np.arange(7.0)), np.sin(np.arange(7.0))], axis=-1)
    one, two = (surface.ellipsoid.gauge(force, torque) for surface in (on_base, other))
    np.testing.assert_allclose(one, two, rtol=0.03)
    one, two = (surface.quartic.gauge(force, torque) for surface in (on_base, other))
    np.testing.assert_allclose(one, two, rtol=0.01)


def test_files_words_and_bad_input(tmp_path: Path):
    surface = surface_of(TRIANGLE, n=5)
    assert surface.force.shape == (9, 5) and "flat; convex" in surface.explain()
    surface.save(tmp_path / "surface.csv")
    head = (tmp_path / "surface.csv").read_text().splitlines()[0]
    assert head.startswith(
        "heading[rad],slip_angle[rad],force_x[N],force_y[N],torque[N m],normal_x"
    )
    surface.save(tmp_path / "surface.h5")
    assert surface.ellipsoid.gauge((0.0, 0.0), 0.0) == 0.0
    with pytest.raises(pt.InputError, match="from 5 to 1001"):
        surface.puck.limit_surface(1002)
    with pytest.raises(pt.InputError, match="friction = 0"):
        pt.Puck(base=TRIANGLE).limit_surface()
    with pytest.raises(pt.InputError, match="force"):
        surface.quartic.gauge((math.nan, 0.0), 0.0)


def test_the_command(tmp_path: Path):
    picture = tmp_path / "surface.png"
    command = ["limit-surface", "--base", "box:20cmx10cm", "--friction", "0.3", "--points", "5"]
    done = invoke(*command, "--plot", picture)
    assert done.exit_code == 0, done.stderr
    assert "quartic: off by" in done.stderr and picture.stat().st_size > 10_000
    printed = invoke(*command)
    assert len(printed.stdout.splitlines()) == 1 + 5 * 9
    both = invoke(*command, "--radius", "0.1")
    assert both.exit_code != 0 and "--base and --radius clash" in both.stderr
