"""A floor that moves carries a puck: where the run ends, and what comes on the way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import puck_tables as pt

PUCK = pt.Puck(radius=0.04, height=0.02, friction=0.2, mass=0.2)
LAUNCH = pt.Launch((0.3, 0.1), 10.0, (0.05, 0.0))
SPLIT = pt.Strips((0.1,), (0.2, 0.1))
POLYGON = pt.Patch(0.05, corners=[[0.2, -0.1], [0.5, 0.02], [0.3, 0.3], [0.3, 0.1]])
BEHIND = pt.Wall((0.5, 0.0), normal=(-1.0, 0.0))


@pytest.mark.parametrize(("floor", "walls"), [
    (pt.Floor(velocity=(0.0, 0.1), strips=SPLIT), ()),
    (pt.Floor(velocity=(0.1, 0.0), strips=pt.Strips((0.02,), (0.2, 0.1), math.pi / 2)), ()),
    (pt.Floor(velocity=(0.0, 0.1), patches=[POLYGON]), ()),
    (pt.Floor(velocity=(0.1, 0.0), patches=[pt.Patch(0.05, (-0.3, 0.0), 0.1)]), ()),
    (pt.Floor(velocity=(-0.1, 0.0)), (BEHIND,)),
    (pt.Floor(turning=1.0), (BEHIND,)),
    (pt.Floor(turning=1.0, patches=[POLYGON]), ()),
    (pt.Floor(turning=1.0, patches=[pt.Patch(0.1, (0.0, 0.0), 0.4)]), ()),
    (pt.Floor(turning=1.0, slope=0.1), ()),
])  # fmt: skip
def test_a_run_ends_when_nothing_lies_ahead(floor, walls):
    run = pt.Scene(PUCK, floor, LAUNCH, walls=walls).simulate()
    assert run.end == "carried by the floor"
    assert run.events[-1].what == "stick"
    assert run.end_time == run.events[-1].time < 0.5
    assert run.energy_residual < 1e-10
    later = run(np.array([0.5 * run.end_time]))
    assert later.end_time >= 0.5 * run.end_time


def test_a_belt_goes_on_to_what_lies_ahead_and_no_further():
    floor = pt.Floor(velocity=(0.2, 0.0), patches=[POLYGON])
    run = pt.Scene(PUCK, floor, LAUNCH).simulate()
    stick = next(e for e in run.events if e.what == "stick")
    last = run.events[-1]
    assert (last.what, run.end_time) == ("exit", last.time)
    assert last.x - stick.x == pytest.approx(0.2 * (last.time - stick.time), rel=1e-9)


def test_carried_round_is_one_whole_turn():
    floor = pt.Floor(turning=2.0, strips=SPLIT)
    scene = pt.Scene(PUCK, floor, LAUNCH)
    run = scene.simulate()
    assert run.end == "carried round"
    stick = next(e for e in run.events if e.what == "stick")
    assert run.end_time == pytest.approx(stick.time + math.pi, rel=1e-12)
    assert math.hypot(run.last["x"] - stick.x, run.last["y"] - stick.y) < 1e-9
    # the rim leaves the border, and comes over it again, where the circle is that far from it
    way, start = math.hypot(stick.x, stick.y), math.atan2(stick.y, stick.x)
    angles = [math.acos(0.06 / way), 2.0 * math.pi - math.acos(0.06 / way)]
    wanted = [stick.time + 0.5 * ((angle - start) % (2.0 * math.pi)) for angle in angles]
    found = [e.time for e in run.events if e.time > stick.time]
    assert found == pytest.approx(wanted, abs=1e-8)
    assert scene.at({"launch.spin": np.array([10.0])}).sweep().end[0] == 2


def test_a_tilted_turntable_carries_no_puck_that_it_loses_later():
    scene = pt.Scene(
        PUCK, pt.Floor(slope=0.15, turning=1.4), pt.Launch((0.0, -0.42), 1.4, (-0.3, 0.0))
    )
    assert scene.at({"time": 0.1}).simulate().end == "carried by the floor"
    with pytest.raises(pt.InputError, match=r"give a time"):
        scene.simulate()


def test_what_is_lost_in_the_middle_of_a_patch_is_seen():
    """Before and behind the floor holds the puck on the slope, over the ice in the middle not."""
    floor = pt.Floor(0.1, math.pi / 2, velocity=(0.2, 0.0),
                     patches=[pt.Patch(0.0, (0.3, 0.0), 0.037)])  # fmt: skip
    launch = pt.Launch((0.2, 0.0), 0.0)
    run = pt.Scene(PUCK, floor, launch, time=2.0).simulate()
    words = [e.what for e in run.events]
    slip = run.events[words.index("slip")]
    assert words.index("entry") < words.index("slip") < words.index("exit")
    assert 0.223 < slip.x < 0.3


def test_what_a_belt_leads_to_too_late_asks_for_a_time():
    edge = pt.Edge((1e6, 0.0), normal=(-1.0, 0.0))
    scene = pt.Scene(PUCK, pt.Floor(velocity=(0.01, 0.0)), LAUNCH, edges=(edge,))
    with pytest.raises(pt.InputError, match="still carries the puck towards"):
        scene.simulate()


def test_a_slip_that_grows_until_the_base_would_lift_is_not_blamed_on_the_height():
    """Viscous friction holds nothing on a turntable; at the launch the height is in order.

    Under uniform pressure it lifts, and tips where 0.2 s/m of 20 m/s times 0.01 m is the radius.
    """
    floor = pt.Floor(turning=1.0, law=pt.PowerLaw(a=0.2, exponent=1.0))
    scene = pt.Scene(replace(PUCK, pressure="hertz"), floor, LAUNCH, tol=1e-4)
    with pytest.raises(pt.InputError, match=r"at .* s the rim slips .* give a shorter time"):
        scene.at({"time": 100.0}).simulate()
    assert scene.at({"time": 1.0}).simulate().end == "time is up"
    run = scene.at({"puck.pressure": "uniform", "time": 100.0}).simulate()
    assert run.end == "tipped over"
    assert 19.9 < math.hypot(run.last["vx"] + run.last["y"], run.last["vy"] - run.last["x"]) < 20.0
