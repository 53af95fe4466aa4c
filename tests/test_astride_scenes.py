"""Pucks over borders of two frictions: events, motion against scipy, rest, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from astride_judge import FloorMap, Motion, sums
from rarely import thorough

import puck_tables as pt
from puck_tables.world.contact_search import arc_step

PUCK = pt.Puck(radius=0.04, height=0.03, friction=0.3, mass=0.2)
LAUNCH = pt.Launch((1.5, 0.3), spin=-40.0)
NARROW = pt.Strips((0.4, 0.43), (0.3, 0.06, 0.2), 0.4)
ROUND = pt.Patch(0.05, (0.3, 0.05), 0.1)
POLYGON = pt.Patch(0.05, corners=[[0.2, -0.1], [0.5, 0.02], [0.3, 0.3], [0.3, 0.1]])
FLOORS = {
    "two borders at once": (pt.Floor(strips=NARROW), ["entry", "entry", "exit", "exit"]),
    "a round patch": (pt.Floor(patches=[ROUND]), ["entry", "exit", "entry", "exit"]),
    "a polygon": (pt.Floor(patches=[POLYGON]), ["entry", "exit", "entry", "exit"]),
    "on a belt": (pt.Floor(velocity=(0.3, 0.1), strips=NARROW), ["entry"] * 2 + ["exit"] * 2),
}


def apart(scene: pt.Scene, share: float = 0.97) -> float:
    """How far a run is from scipy's, in units of Q²/J."""
    run = scene.simulate()
    times = np.linspace(0.0, share * run.end_time, 6)
    states, truth = run(times), Motion(scene).states(scene, times)
    gaps = states.x - truth[0], states.y - truth[1], 0.04 * (states.orientation - truth[2])
    return float(np.abs(gaps).max() / (run.speed_scale**2 / run.rate_scale))


@pytest.mark.parametrize(
    "floor", ["two borders at once", "a polygon", *map(thorough, ("a round patch", "on a belt"))]
)
def test_a_crossing_is_that_of_scipy(floor):
    scene = pt.Scene(PUCK, FLOORS[floor][0], LAUNCH, time=0.6)
    run = scene.simulate()
    assert [event.what for event in run.events] == FLOORS[floor][1]
    assert run.energy_residual <= 1e-10
    assert apart(scene) <= 1e-9


@pytest.mark.parametrize("launch", [
    pt.Launch((0.3, 0.1), 30.0, (0.39, 0.0)), thorough(pt.Launch((0.0, 0.0), 60.0, (0.41, 0.0))),
    thorough(pt.Launch((0.06, 0.5), 20.0, (0.33, 0.0))),
], ids=["starts astride", "spins in place", "grazes"])  # fmt: skip
def test_a_puck_that_starts_or_stays_astride(launch):
    floor = pt.Floor(strips=replace(NARROW, borders=(0.4, 0.9), direction=0.0))
    scene = pt.Scene(replace(PUCK, pressure="annulus:0.5"), floor, launch)
    assert apart(scene, 0.9) <= 1e-9


@pytest.mark.parametrize("pressure", [thorough("uniform"), "annulus:0.5"])
def test_fast_crossings_at_once_are_those_of_scipy(pressure):
    """In a step from one kink of friction to the next; also where a hole meets a border."""
    puck = pt.Puck(0.04, height=0.02, mass=0.2, friction=0.1, pressure=pressure)
    floor, time = pt.Floor(strips=pt.Strips((0.2,), (0.1, 0.06))), 0.2
    speed, spins = (1.699, -0.0072), [20.621, -40.0]
    found = pt.Scene(puck, floor, pt.Launch(speed, spins), time=time, tol=1e-9).sweep()
    for n, spin in enumerate(spins):
        scene = pt.Scene(puck, floor, pt.Launch(speed, spin), time=time, tol=1e-9)
        truth = Motion(scene).states(scene, np.array([time]))[:, -1]
        unit = (speed[0] ** 2 + (0.04 * spin) ** 2) / (0.1 * 9.81)
        assert np.hypot(found.x[n] - truth[0], found.y[n] - truth[1]) <= 1e-9 * unit


def test_the_rim_meets_a_border_a_radius_before_the_centre():
    floor = pt.Floor(strips=pt.Strips((0.3,), (0.2, 0.1)))
    entry, away, _ = pt.Scene(PUCK, floor, pt.Launch((1.5, 0.0))).simulate().events
    assert (entry.what, away.what) == ("entry", "exit")
    assert (entry.x, away.x) == pytest.approx((0.26, 0.34), abs=1e-12)


@pytest.mark.parametrize(("height", "at", "downhill"), [
    thorough(0.0, 0.5, 1.0), thorough(0.5, 0.0, math.pi / 2), (0.5, 0.5, 1.0),
])  # fmt: skip
def test_what_holds_at_rest(height, at, downhill):
    """Held while no slip gains energy; the pressure is tilted by the pull."""
    floor, values = pt.Strips((at,), (0.2, 0.4)), [0.2, 0.4]
    puck, floor_map = pt.Puck(radius=1.0, height=height, gravity=10.0), FloorMap([at], values)

    def gain(slope: float) -> float:
        pull = math.tan(slope) * np.array([math.cos(downhill), math.sin(downhill), 0.0])
        tilt = 2.0 * height * pull[:2]

        def over(a: float, b: float) -> float:
            way = downhill + a
            n = np.array([math.cos(b) * math.cos(way), math.cos(b) * math.sin(way), math.sin(b)])
            m = sums(floor_map, *n) / math.pi
            held = np.array([
                m[0] + tilt @ m[2:4], m[1] + tilt @ m[4:6], m[4] - m[3] + tilt @ m[6:8]
            ])  # fmt: skip
            return float((pull - held) @ n)

        best, centre, span = -1.0, (0.0, 0.1), 0.9
        for _ in range(9):
            ways = np.linspace(-span, span, 7)
            trials = [(over(centre[0] + a, centre[1] + b + 1e-6), a, b) for a in ways for b in ways]
            best, a, b = max(trials)
            centre, span = (centre[0] + a, centre[1] + b), 0.4 * span
        return best

    low, high = 0.1, 0.4
    for _ in range(8):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gain(middle) < 0.0 else (low, middle)
    for slope, holds in ((low - 1e-3, True), (high + 1e-3, False)):
        scene = pt.Scene(puck, pt.Floor(slope, downhill, strips=floor), time=1e-3)
        run = scene.simulate([0.0])
        assert (run.end == "at rest") == holds, slope


@pytest.mark.parametrize(("puck", "floor", "words"), [
    ({"height": 0.06, "friction": 0.2, "pressure": "hertz"}, {"strips": NARROW},
     "loaded everywhere, delta = 2 f h / r up to 0.8"),
    ({}, {"patches": [ROUND, POLYGON]}, "overlap"),
    ({"height": 0.0}, {"patches": [replace(ROUND, friction=1e6)]}, "give at most 1000"),
    ({}, {"patches": [ROUND], "strips": pt.Strips((0.3,), (0.1, 0.2))}, "lies over floor.strips"),
    ({}, {"patches": [pt.Patch(0.1)]}, "give a radius > 0 m, or corners"),
    ({}, {"patches": [replace(ROUND, corners=POLYGON.corners)]}, "not both"),
    ({}, {"patches": [pt.Patch(0.1, corners=[[0, 0], [1, 1], [1, 0], [0, 1]])]}, "meet"),
    ({}, {"patches": [pt.Patch(0.1, corners=[[0, 0], [1, 1], [2, 2]])]}, "on a line"),
    ({}, {"patches": [pt.Patch(0.1, corners=[[0, 0], [1, 0], [1, 0], [1, 1]])]}, "2 repeats"),
    ({}, {"strips": NARROW, "law": [[0.0, 0.1], [9.0, 0.1]]}, "floor.law and floor.strips"),
])  # fmt: skip
def test_what_is_refused(puck, floor, words):
    with pytest.raises(pt.InputError, match="error") as caught:
        pt.Scene(replace(PUCK, **puck), pt.Floor(**floor), LAUNCH)
    assert words in str(caught.value)


def test_many_launches_end_where_runs_alone_do():
    """Within ``tol``: a run alone is followed closer where its check runs miss."""
    floor = pt.Floor(patches=[ROUND])
    scene = pt.Scene(PUCK, floor, pt.Launch((1.5, 0.3), [20.0, -40.0]), tol=1e-6)
    ends = scene.sweep()
    one = scene.at({"launch.spin": -40.0}).simulate()
    allowed = scene.tol * one.speed_scale**2 / one.rate_scale
    assert abs(ends.columns["x"][1] - one.last["x"]) < allowed


@pytest.mark.parametrize("corners", [(), POLYGON.corners])
def test_a_long_free_flight_steps_over_no_part_of_a_crossing(corners):
    """Without friction before the patch: the same motion from near and from afar, only later."""
    smooth = replace(PUCK, friction=0.0, height=0.0)
    patch = pt.Patch(0.2, corners=corners) if corners else pt.Patch(0.2, (0.3, 0.0), 0.1)
    ends = []
    for start in (-3.0, 0.0, 0.1):
        launch = pt.Launch((0.5, 0.0), 20.0, (start, 0.0))
        run = pt.Scene(smooth, pt.Floor(patches=[patch]), launch, time=8.0).simulate()
        assert run.energy_residual < run.scene.tol
        entry = run.events[0].time
        ends.append([run.events[1].time - entry, run.events[1].x, run.events[1].y])
    assert np.ptp(np.array(ends), axis=0).max() < 2e-9


def test_a_polygon_may_close_itself():
    closed = replace(POLYGON, corners=[*POLYGON.corners, POLYGON.corners[0]])
    ends = [
        pt.Scene(PUCK, pt.Floor(patches=[patch]), LAUNCH).simulate().end_time
        for patch in (POLYGON, closed)
    ]
    assert ends[0] == ends[1]


def test_corners_from_a_file(tmp_path):
    """The same run, the file kept with the result, and drawn; a file that is none is named."""
    path = tmp_path / "spot.csv"
    rows = "\n".join(f"{x!r},{y!r}" for x, y in POLYGON.corners)
    path.write_text(f"x,y\n{rows}\n")
    named = pt.Floor(patches=[replace(POLYGON, corners=str(path))])
    run = pt.Scene(PUCK, named, LAUNCH).simulate()
    assert run.end_time == pt.Scene(PUCK, pt.Floor(patches=[POLYGON]), LAUNCH).simulate().end_time
    assert list(run.files.values()) == [path.read_text()]
    run.plot(tmp_path / "run.png")
    for text, words in (
        ("x,y\n1,2\n", "from 3 to 200"),
        ("x,y\n1,x\n", "is no number"),
        (None, "cannot read"),
    ):
        path.write_text(text) if text else path.unlink()
        with pytest.raises(pt.InputError, match="corners") as caught:
            pt.Scene(PUCK, named, LAUNCH)
        assert words in str(caught.value) and str(path) in str(caught.value)


def test_no_arc_is_met_within_a_step_and_no_step_is_needlessly_short():
    """Of constant accelerations, also where the bound along the velocity is worth nothing."""
    rng = np.random.default_rng(4)
    for _ in range(2000):
        size, gap, speed = rng.uniform(0.01, 1.0, 3)
        angle, way = rng.uniform(0.0, 2.0 * np.pi, 2)
        v = speed * np.array([math.cos(angle), math.sin(angle)])
        half = size * v[0]
        out = (math.hypot(half, speed * math.sqrt((size + gap) ** 2 - size**2)) - half) / speed**2
        bend = 2.0 * gap / out**2 * rng.choice([1.0 - 1e-12, 1.0 - 1e-6, 0.3, 3.0])
        step = arc_step(gap, size, 0.0, *v, bend)
        least = 2.0 * gap / (speed + math.hypot(speed, math.sqrt(2.0 * bend * gap)))
        assert step >= least * (1.0 - 1e-12)
        times = np.linspace(0.0, step, 50)[:, None]
        a = bend * np.array([math.cos(way), math.sin(way)])
        place = np.array([size, 0.0]) + times * v + 0.5 * times**2 * a
        assert np.hypot(*place.T).max() <= (size + gap) * (1.0 + 1e-12)


def test_a_puck_that_stays_over_an_edge_does_not_leave_it(tmp_path):
    (tmp_path / "load.csv").write_text("rho,p\n0,1\n0.4,0.9\n0.7,0.2\n1,0.5\n")
    puck = pt.Puck(0.04, height=0.02, friction=0.1, mass=0.2, pressure=str(tmp_path / "load.csv"))
    patch = pt.Patch(0.05, corners=[[0.2, -0.1], [0.4, -0.1], [0.4, 0.15], [0.2, 0.15]])
    launch = pt.Launch((0.2817774039336951, 0.03674065143074734), -44.97283878350552)
    scene = pt.Scene(puck, pt.Floor(patches=[patch]), launch, tol=1e-8)
    assert [event.what for event in scene.world().advance(3.0)] == ["entry"]
