"""Several pucks feel strips, patches and laws of friction as one does: each under its own base."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from boards import puck_at
from pucks_judge import Disc, Floor, play
from scipy.integrate import quad
from scipy.optimize import brentq

import puck_tables as pt

PUCK = {"radius": 0.04, "height": 0.03, "friction": 0.3, "mass": 0.2}
LAUNCH = pt.Launch((1.5, 0.3), spin=-40.0)
STRIPS = pt.Strips((0.4, 0.43), (0.3, 0.06, 0.2), 0.4)
WIDE = pt.Strips((0.4, 0.9), (0.3, 0.06, 0.2))
CORNERS = [[0.2, -0.1], [0.5, 0.02], [0.3, 0.3], [0.3, 0.1]]
STRIBECK = pt.StribeckLaw(0.3, 0.2, 0.5)
ROWS = [[0.0, 0.3], [1.0, 0.2], [6.0, 0.35]]
FLOORS = {
    "two borders at once": (pt.Floor(strips=STRIPS), LAUNCH),
    "a round patch": (pt.Floor(patches=[pt.Patch(0.05, (0.3, 0.05), 0.1)]), LAUNCH),
    "within a round patch": (pt.Floor(patches=[pt.Patch(0.05, (0.4, 0.05), 0.2)]), LAUNCH),
    "a polygon on a belt": (
        pt.Floor(velocity=(0.3, 0.1), patches=[pt.Patch(0.05, corners=CORNERS)]), LAUNCH,
    ),
    "strips that slope": (pt.Floor(0.1, strips=STRIPS), LAUNCH),
    "starts astride": (pt.Floor(strips=WIDE), pt.Launch((0.3, 0.1), 30.0, (0.39, 0.0))),
    "spins over a border": (pt.Floor(strips=WIDE), pt.Launch(None, 60.0, (0.41, 0.0))),
    "carried until it slips": (
        pt.Floor(0.12, velocity=(0.2, 0.1), strips=WIDE),
        pt.Launch((0.2, 0.1), 0.0, (0.32, 0.0)),
    ),
    "thrown off a turntable": (
        pt.Floor(turning=2.2, strips=pt.Strips((0.0,), (0.05, 0.25))),
        pt.Launch((0.0, 0.66), 2.2, (0.3, 0.0)),
    ),
    "a law by rows": (pt.Floor(law=ROWS), LAUNCH),
    "a law by name on a slope": (pt.Floor(0.1, law=STRIBECK), LAUNCH),
    "by direction on a belt": (
        pt.Floor(velocity=(0.1, 0.0), orthotropic=pt.Orthotropic((0.3, 0.15), 0.3)), LAUNCH,
    ),
}  # fmt: skip


def entered(run: pt.results.Run) -> list[tuple[str, float]]:
    """What happened to the first puck on the floor."""
    found = [event for event in run.events if event.what in ("entry", "exit")]
    return [(e.what, e.time) for e in found if e.puck == "puck 0"]


@pytest.mark.parametrize("case", FLOORS)
def test_beside_another_far_away_a_puck_moves_as_alone(case: str):
    floor, launch = FLOORS[case]
    tol = 1e-9 if floor.law else 1e-11
    alone = pt.Scene(pt.Puck(**PUCK), floor, launch, time=0.8, tol=tol)
    far = puck_at(-0.5, 0.7, (0.0, 0.5))
    board = pt.Scene(
        pucks=[pt.Puck(**PUCK, launch=launch), far], floor=floor, time=alone.time, tol=alone.tol
    )
    one, two = alone.simulate(), board.simulate()
    times = np.linspace(0.0, min(one.end_time, two.end_time), 31)
    states, first = one(times), two(times)["puck 0"]
    for name in ("x", "y"):
        np.testing.assert_allclose(first[name], getattr(states, name), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(first["spin"], states.spin, rtol=0.0, atol=1e-7)
    crossings, others = entered(one), entered(two)
    assert [what for what, _ in others] == [what for what, _ in crossings]
    for (_, time), (_, moment) in zip(others, crossings, strict=True):
        assert time == pytest.approx(moment, abs=3e-8)  # exits may graze
    assert two.energy_residual < 1e-9


@pytest.mark.thorough
def test_each_has_its_own_pressure_over_a_border(tmp_path: Path):
    """Their grounds are of different lengths: one has rows of a tabulated pressure."""
    floor, launch = pt.Floor(strips=WIDE), pt.Launch((0.6, 0.1), 20.0, (0.37, 0.0))
    ring, rows = {**PUCK, "pressure": "ring"}, tmp_path / "rows.csv"
    rows.write_text("rho,W\n0,1\n0.5,0.8\n1,0.3\n")
    alone = pt.Scene(pt.Puck(**ring), floor, launch, time=0.2, tol=1e-9)
    pucks = [pt.Puck(**ring, launch=launch), puck_at(0.1, 0.5, pressure=str(rows))]
    one = alone.simulate()
    two = pt.Scene(pucks=pucks, floor=floor, time=alone.time, tol=alone.tol).simulate()
    for name in ("x", "y"):
        assert two["puck 0"][name][-1] == pytest.approx(one.last[name], abs=1e-9)


def test_two_that_meet_astride_a_patch_are_judged_by_another_integrator():
    spot = (0.1, 0.0, 0.05, 0.6)
    pucks = [
        puck_at(-0.1, 0.01, (1.5, 0.0), 20.0, restitution=0.8, tangential=0.3, rim=0.25),
        puck_at(0.06, -0.01, None, restitution=0.8, tangential=0.3, rim=0.25, mass=0.2),
    ]
    floor = pt.Floor(patches=[pt.Patch(spot[3], spot[:2], spot[2])])
    run = pt.Scene(pucks=pucks, floor=floor, time=0.12).simulate()
    assert [event.what for event in run.events] == ["impact", "exit"]
    hit = next(event.time for event in run.events if event.what == "impact")
    rows = [np.array([*p.launch.position, 0.0, *(p.launch.velocity or (0.0, 0.0)), p.launch.spin])
            for p in pucks]  # fmt: skip
    discs = [
        Disc(p.radius, p.mass, p.friction, p.height, row, 0.8, 0.3, 0.25)
        for p, row in zip(pucks, rows, strict=True)
    ]
    truth = play(Floor(spots=(spot,)), discs, [], 0.12)
    assert [time for time, *_ in truth.impacts] == pytest.approx([hit], abs=1e-9)
    for number in range(2):
        ends = run[f"puck {number}"]
        ours = [ends[name][-1] for name in ("x", "y", "vx", "vy")]
        np.testing.assert_allclose(ours[:2], truth.states[number, :2], rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(ours[2:], truth.states[number, 3:5], rtol=0.0, atol=1e-8)
    assert run.last["heat_dry"] == pytest.approx(truth.heat, rel=1e-8)
    assert run.energy_residual < 1e-10


def test_one_that_brakes_on_a_rough_strip_is_pushed_by_the_one_behind():
    """Along the border's normal, without spin, f is the mean over the areas; the two go as one."""
    radius, border, low, high, speed = 0.03, 0.1, 0.1, 0.5, 0.9

    def mean(x: float) -> float:
        d = min(max((border - x) / radius, -1.0), 1.0)
        beyond = (math.acos(d) - d * math.sqrt(1.0 - d * d)) / math.pi
        return low + (high - low) * beyond

    def left(way: float) -> float:
        kinks = [border - radius, border + radius, border - 3 * radius, border - radius]
        taken, _ = quad(
            lambda x: 0.5 * (mean(x) + mean(x + 2 * radius)), 0.0, way, points=kinks,
            epsabs=1e-13, epsrel=1e-13, limit=400,
        )  # fmt: skip
        return 0.5 * speed**2 - 9.80665 * taken

    way = brentq(left, 0.0, 1.0, xtol=1e-13)
    pucks = [
        puck_at(x, 0.0, (speed, 0.0), height=0.0, restitution=0.0, rim=0.0) for x in (0.0, 0.06)
    ]
    floor = pt.Floor(strips=pt.Strips((border,), (low, high)))
    run = pt.Scene(pucks=pucks, floor=floor).simulate()
    assert run.last["x"] == pytest.approx([way, way + 2 * radius], abs=1e-9)
    assert np.abs(run.last["y"]).max() < 1e-12
    assert {e.what for e in run.events if e.what != "contact"} == {"entry", "exit", "stick"}
    assert run.energy_residual < 1e-9


def test_who_lies_astride_is_held_by_all_that_is_under_it():
    """Half on f = 0.1, half on 0.5 holds 0.3 across the border, without a height."""
    strips, ends = pt.Strips((0.0,), (0.1, 0.5)), []
    for slope in (0.29, 0.31):
        floor = pt.Floor(math.atan(slope), strips=strips)
        far = puck_at(1.0, 0.0, height=0.0)
        board = pt.Scene(pucks=[puck_at(0.0, 0.0, height=0.0), far], floor=floor, time=0.05)
        ends.append(board.simulate().last["x"][0])
    assert ends[0] == 0.0
    assert ends[1] > 1e-5


def test_copies_and_what_was_saved_go_on_alike_and_apart():
    board = pt.Scene(
        pucks=[pt.Puck(**PUCK, launch=LAUNCH), puck_at(0.45, 0.1)],
        floor=FLOORS["strips that slope"][0],
    )
    world = board.world()
    world.advance(0.27)  # astride
    others = world.copy(), pickle.loads(pickle.dumps(world))
    ends = []
    for one in (world, *others):
        one.advance(0.1)
        ends.append(one.state())
    assert (ends[0] == ends[1]).all()
    assert (ends[0] == ends[2]).all()


def test_a_sweep_over_strips_is_the_runs_one_by_one():
    board = pt.Scene(
        pucks=[pt.Puck(**PUCK, launch=LAUNCH), puck_at(0.45, 0.1)],
        floor=FLOORS["a round patch"][0],
        ranges={"puck[0].launch.spin": np.array([20.0, -40.0])},
    )
    ends = board.sweep()
    one = board.at({"puck[0].launch.spin": -40.0}).simulate()
    # a run is looked at when the last one comes to rest, which is a moment rounded: one last digit
    np.testing.assert_allclose(ends.columns["x"][1], one.last["x"], rtol=4e-16)


def test_a_law_by_name_goes_on_as_they_slip_and_rows_end_with_a_sentence():
    light = puck_at(0.2, 0.01, mass=0.02)
    striker = pt.Puck(**PUCK, launch=pt.Launch((2.0, 0.0), 10.0))
    named = pt.Scene(pucks=[striker, light], floor=pt.Floor(law=STRIBECK), time=0.5)
    rows = pt.Scene(pucks=[striker, light], floor=pt.Floor(law=[[0.0, 0.3], [3.0, 0.35]]), time=0.5)
    assert named.simulate().impacts == 1
    with pytest.raises(
        pt.InputError, match=r"the rim of puck 1 slips at .*floor.law ends at 3 m/s"
    ):
        rows.simulate()
    world = rows.world()
    with pytest.raises(pt.InputError, match="strike more softly"):
        world.strike(0, (5.0, 0.0))
    assert world.state()[0, 3] == 2.0


def test_whose_base_does_not_fit_a_floor_is_named():
    high = puck_at(0.3, 0.0, height=0.06, friction=0.2, pressure="hertz")
    with pytest.raises(pt.InputError, match=r"puck 1: floor.strips: .*loaded everywhere"):
        pt.Scene(pucks=[puck_at(0.0, 0.0), high], floor=pt.Floor(strips=WIDE))
