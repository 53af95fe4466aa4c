"""Friction by direction under bases of any shape, in axes of the floor and of the body."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from rarely import thorough
from rays_judge import by_ellipse, friction_of, sides, within

from puck_tables import Base, Floor, InputError, Launch, Orthotropic, Puck, Scene
from puck_tables.world.floor_forces import friction_at

L_SHAPE = [(0, 0), (0.2, 0), (0.2, 0.05), (0.05, 0.05), (0.05, 0.1), (0, 0.1)]
BASES = {
    "box": Base.box(0.2, 0.1), "bar": Base.box(0.3, 0.02), "L": Base.polygon(L_SHAPE),
    "frame": Base.polygon(
        [(0, 0), (0.2, 0), (0.2, 0.1), (0, 0.1)],
        holes=[[(0.05, 0.02), (0.15, 0.02), (0.15, 0.08), (0.05, 0.08)]],
    ),
}  # fmt: skip


def puck(base: Base | str, height: float = 0.0) -> Puck:
    return Puck(base=base, height=height, friction=0.2, gravity=1.0, gyration=0.06)


def judge(base: Base, axes: Orthotropic, height: float, state: Any) -> np.ndarray:
    """Force and torque at N = 1 by points on rays from the instantaneous centre."""
    _, _, angle, *slip = state
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    outlines = [((np.array(one) - base.middle) @ turn.T).tolist() for one in base.outlines]
    way = axes.direction + (angle if axes.fixed_to == "body" else 0.0)
    curves = [side for corners in outlines for side in sides(corners)]
    return friction_of(
        curves, within(outlines), lambda x, y, ex, ey: by_ellipse(axes.friction, way, ex, ey), slip,
        height / 2, 24,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "fixed_to"),
    [
        ("L", "floor"), ("frame", "body"), thorough("box", "floor"), thorough("bar", "body"),
        *map(thorough, ("box", "bar", "L", "frame"), ("body", "floor") * 2),
    ],
)  # fmt: skip
def test_friction_is_that_of_points_over_the_base(name: str, fixed_to: str) -> None:
    rng, base = np.random.default_rng(5), BASES[name]
    corner = base.points()[0] - np.array(base.middle)
    for pair in ((0.3, 0.2), (0.1, 0.4), (0.4, 0.04)):
        axes = Orthotropic(pair, direction=float(rng.uniform(0.0, 3.0)), fixed_to=fixed_to)
        height = float(rng.choice([0.0, 1.9 * base.highest_lever / 0.4]))
        states = np.zeros((8, 6))
        states[:, 2] = rng.uniform(0.0, 6.0, 8)
        states[:, 3:5] = rng.normal(size=(8, 2))
        states[:, 5] = rng.choice([-1.0, 1.0], 8) * 10.0 ** rng.uniform(0.3, 2.5, 8)
        states[6] = [0, 0, 0, -corner[1], corner[0], -1]  # C opposite to a corner
        states[7] = [0, 0, 0, 0.0, 0.0, 1.0]
        found = friction_at(Scene(puck(base, height), Floor(orthotropic=axes)), states)
        for state, forces in zip(states, found, strict=True):
            gap = np.abs(forces - judge(base, axes, height, state)) / [1.0, 1.0, base.reach]
            assert gap.max() < 1e-10, (pair, state)


def test_equal_frictions_are_no_direction() -> None:
    rng = np.random.default_rng(6)
    states = rng.normal(size=(40, 6)) * [0.0, 0.0, 3.0, 1.0, 1.0, 30.0]
    for base in BASES.values():
        floor = Floor(orthotropic=Orthotropic((0.2, 0.2), direction=0.4))
        one, two = (
            friction_at(Scene(puck(base, 0.001), each), states) for each in (floor, Floor())
        )
        assert np.abs(one - two).max() < 1e-12


@pytest.mark.thorough
@pytest.mark.parametrize("height", [0.0, 0.04])
def test_a_disc_by_its_base_is_the_round_puck(height: float) -> None:
    floor = Floor(orthotropic=Orthotropic((0.3, 0.15), direction=0.5), slope=0.05)
    ends = []
    for one in (Puck(0.05, height, 0.2), Puck(base="disc:0.05", height=height, friction=0.2)):
        run = Scene(one, floor, launch=Launch(velocity=(1.0, 0.2), spin=12.0)).simulate([0.0])
        ends.append([run.end_time, *(run.last[key] for key in ("x", "y", "orientation"))])
        assert abs(run.energy_residual) < 1e-12
    assert np.abs(np.subtract(*ends)).max() < 1e-9


@pytest.mark.thorough
def test_grooves_turn_with_the_body() -> None:
    """Without a spin a puck feels them as it lies; what turns it turns its friction, too."""
    launch = Launch(velocity=(1.0, 0.0), orientation=0.3)
    ends = []
    for axes in (
        Orthotropic((0.3, 0.15), direction=0.9), Orthotropic((0.3, 0.15), 0.6, fixed_to="body"),
    ):  # fmt: skip
        run = Scene(Puck(0.05), Floor(orthotropic=axes), launch=launch).simulate([0.0])
        ends.append([run.end_time, run.last["x"], run.last["y"], run.last["spin"]])
    assert np.abs(np.subtract(*ends)).max() < 1e-9
    assert ends[0][2] < -0.05  # most of the force is along the rougher axis
    turning = Launch(velocity=(1.0, 0.0), spin=60.0)
    run = Scene(Puck(0.05), Floor(orthotropic=axes), launch=turning).simulate([0.0])
    assert run.end == "at rest" and abs(run.energy_residual) < 1e-12
    assert abs(run.last["y"]) < 0.02  # all ways take turns


def test_a_block_holds_on_a_slope_by_the_friction_across_its_grooves() -> None:
    block = Puck(base="box:0.1x0.06", friction=0.2)
    for angle, friction in ((0.0, 0.1), (0.5 * math.pi, 0.4)):
        axes = Orthotropic((0.1, 0.4), fixed_to="body")
        launch = Launch(orientation=angle)
        for off, rests in ((-1e-9, True), (1e-6, False)):
            floor = Floor(slope=math.atan(friction) + off, orthotropic=axes)
            run = Scene(block, floor, launch=launch, time=0.5).simulate([0.0])
            assert (run.end == "at rest") == rests, (angle, off)


def test_what_is_not_known_is_refused() -> None:
    with pytest.raises(InputError, match="fixed_to"):
        Scene(Puck(0.1), Floor(orthotropic=Orthotropic((0.2, 0.1), fixed_to="table")))
