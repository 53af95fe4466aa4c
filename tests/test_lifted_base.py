"""A tall body on a base of which friction lifts a part: the floor pushes there and never pulls.

Truth: the judge of bases over edges, with none; round contact that opens; closed forms of a box.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from judges import edge_judge
from rarely import thorough
from test_base_over_edge import BOX, BY_GRIP, CORNERS, DECEL, WOOD, follow, thrown

from puck_tables import (
    Base,
    Floor,
    Force,
    Launch,
    Orthotropic,
    Puck,
    Scene,
    Strips,
    Wall,
    contact,
    push,
)
from puck_tables.errors import ContactError
from puck_tables.world.floor_forces import friction_at

NONE = [np.array([1.0, 0.0, -9.0])]  # an edge far away
LIFTED = replace(BOX, height=0.25)  # from 0.0994 m on it lifts


@pytest.mark.parametrize("seeds", [2, thorough(20)])
@pytest.mark.parametrize("grip", BY_GRIP)
def test_friction_is_that_of_the_judge(grip: Any, seeds: int):
    for times in (1.1, 2.0, 3.0):
        for seed in range(seeds):
            rng, base, about, _ = thrown(seed, 1)
            lever = times * base.highest_lever
            puck = Puck(base=base, friction=0.3, mass=2.0, height=lever / 0.15)
            state = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), *rng.normal(0.0, 0.3, 2), 0.0])
            state[5] = rng.choice([0.0, -1.0, 1.0, 10.0]) * rng.uniform(0.3, 2.0)
            scene = Scene(puck, BY_GRIP[grip], launch=Launch((9.0, 0.0)))
            told = friction_at(scene, state[None])[0] / (2.0 * 9.80665)
            told, arm = (told / 0.3, lever) if grip is None else (told, lever / 0.3)
            true = edge_judge.under(about, NONE, state, arm, grip)
            np.testing.assert_allclose(told, true, atol=1e-9, err_msg=f"{times} {seed}")


def test_a_disc_is_the_round_contact_that_opens():
    for delta in (1.5, 2.0, 3.5):
        for phi in (0.2, 0.5, 0.9, 1.3):
            more: Any = {"friction": 0.3, "mass": 1.0, "height": delta * 0.05 / 0.6}
            state = [0.0, 0.0, 0.7, math.cos(phi), 0.0, math.sin(phi) / 0.05]
            true = contact.one_sided_resultants(phi, delta)
            equal = Floor(orthotropic=Orthotropic((0.3, 0.3)))
            for puck, floor in (
                (Puck(base=Base.disc(0.05), **more), Floor()),
                (Puck(0.05, **more), equal),
            ):
                scene = Scene(puck, floor, launch=Launch((9.0, 0.0)))
                fx, fy, torque = friction_at(scene, np.array([state]))[0] / DECEL
                assert abs(fx + math.cos(phi) * true.parallel) < 1e-11
                assert abs(abs(fy) - math.sin(phi) * math.cos(phi) * true.perpendicular) < 1e-11
                assert abs(torque + 0.025 * math.sin(phi) * true.spin) < 1e-12


@pytest.mark.thorough
@pytest.mark.parametrize("grip", [None, WOOD])
def test_motion_is_that_of_the_judge(grip: Any):
    for seed, speed in ((0, 0.5), (1, 0.1)):
        state = np.array([0.0, 0.0, 0.3 + seed, speed, 0.1, 6.0])
        launch = Launch((speed, 0.1), spin=6.0, orientation=state[2])
        run: Any = Scene(LIFTED, BY_GRIP[grip], launch=launch).simulate()
        assert run.end == "at rest"
        assert run.energy_residual < 1e-9
        decel, lever = (DECEL, 0.15) if grip is None else (9.80665, 0.5)
        numbers = decel, BOX.gyration, state, lever * LIFTED.height, grip
        follow(run, *edge_judge.slide(CORNERS, NONE, *numbers), seed)


def test_it_lifts_where_its_pressure_has_come_to_nothing():
    ends = []
    highest = BOX.shape.highest_lever / 0.15  # type: ignore[union-attr]
    for share in (1.0 - 1e-9, 1.0 + 1e-9):
        launch = Launch((0.7, 0.3), spin=4.0)
        ends.append(Scene(replace(BOX, height=share * highest), launch=launch).simulate().last)
    for name in ("x", "y", "orientation"):
        assert abs(ends[0][name] - ends[1][name]) < 1e-7, name


def test_it_tips_where_its_load_leaves_the_base():
    """A box of 0.2 m by 0.1 m bears a load 0.06 m ahead along it, not across it."""
    tall = replace(BOX, height=0.4)
    along: Any = Scene(tall, launch=Launch((0.5, 0.0))).simulate()
    assert along.end == "at rest"
    assert abs(along.end_time - 0.5 / DECEL) < 1e-9
    across: Any = Scene(tall, launch=Launch((0.0, 0.5))).simulate()
    assert (across.end, across.end_time) == ("tipped over", 0.0)
    assert (across.events[-1].what, across.events[-1].partner) == ("tip", "floor")
    turned: Any = Scene(replace(BOX, height=0.5), launch=Launch((0.0, 0.5), spin=9.0)).simulate()
    assert turned.end == "tipped over"
    assert turned.end_time > 0.1
    assert "tipped over after" in str(turned)
    assert turned.energy_residual < 1e-9


@pytest.mark.parametrize("static", [1.0, 2.5])
@pytest.mark.parametrize("base", ["box:0.1x0.06", "disc:0.03"])
def test_what_stands_tips_where_a_push_or_its_tray_brings_its_load_to_its_border(base, static):
    """At 0.2 of its weight, where friction holds 0.5; in a slip on 0.2 it would be carried."""
    tall, g = Puck(base=base, height=0.3, friction=0.5 / static, mass=1.0), 9.80665
    for most, end in ((0.199, "at rest"), (0.4, "tipped over")):
        ramp = Force(over_time=[[0.0, 0.0, 0.0], [1.0, 0.0, most * g]])
        run: Any = Scene(tall, Floor(static_ratio=static), force=ramp, time=1.0).simulate()
        assert (run.end, run.last["y"]) == (end, 0.0)
    assert 0.498 < run.end_time < 0.5
    held, lost = 0.5 * 0.198 * g, 0.5 * 0.202 * g
    rows = [[0.0, 0.0, 0.0], [0.5, 0.0, held], [1.0, 0.0, held + lost]]
    run = Scene(tall, Floor(static_ratio=static, over_time=rows), time=1.0).simulate()
    assert run.end == "tipped over"
    assert abs(run.end_time - 0.5) < 1e-9 and abs(run.last["y"] - 0.25 * held) < 1e-9


def test_on_boards_and_floors_too():
    stone = replace(Puck(0.12, base=Base.box(0.2, 0.1), friction=0.3), height=0.25, name="a",
                    launch=Launch((0.9, 0.1), spin=2.0))  # fmt: skip
    run: Any = Scene(pucks=[stone], walls=[Wall((0.2, 0.0), normal=(-1.0, 0.0))]).simulate()
    assert any(event.what == "impact" for event in run.events)
    assert run.energy_residual < 1e-8
    for floor in (
        Floor(slope=0.1),
        Floor(strips=Strips((0.05,), (0.3, 0.2))),
        Floor(static_ratio=1.4),
    ):
        run = Scene(LIFTED, floor, Launch((0.5, 0.0), spin=3.0)).simulate()
        assert run.end == "at rest"
        assert run.energy_residual < 1e-8


def test_what_knows_no_lifted_base_says_so():
    asked: list[Any] = [
        lambda: LIFTED.stop((1.0, 0.0)), lambda: LIFTED.states((1.0, 0.0), 0.0, 0.1),
        lambda: LIFTED.simulate((1.0, 0.0)), lambda: LIFTED.sweep(spin=[0.0, 1.0]),
        lambda: LIFTED.wrench((1.0, 0.0), 0.0), lambda: LIFTED.twist((1.0, 0.0), 0.0),
        lambda: LIFTED.limit_surface(), lambda: LIFTED.holds((1.0, 0.0), 0.0),
        lambda: push(LIFTED, (-0.1, 0.0), (0.1, 0.0), 1.0),
    ]  # fmt: skip
    for call in asked:
        with pytest.raises(ContactError, match=r"would lift.*a Scene moves it"):
            call()
