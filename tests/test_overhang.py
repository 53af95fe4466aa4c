"""A rim that comes over an edge is told, when and where; under a dome its motion is none other.

Straight slides and turns about a turntable are the truth: s = v t − J t²/2, and a circle.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from commands import invoke

from puck_tables import Edge, Floor, Launch, Post, Puck, Scene, Wall


def slide(seed: int) -> tuple[Puck, Launch, list[Edge], list[tuple[float, int]], bool]:
    """A puck without spin, edges ahead, when its rim comes over which, and whether it falls."""
    rng = np.random.default_rng(seed)
    radius, friction = rng.uniform(0.01, 0.1), rng.uniform(0.05, 0.5)
    speed, heading = rng.uniform(0.5, 3.0), rng.uniform(-math.pi, math.pi)
    decel = friction * 9.80665
    ahead, place = np.array([math.cos(heading), math.sin(heading)]), rng.uniform(-1.0, 1.0, 2)
    longest = speed * speed / (2.0 * decel)
    edges, met, falls = [], [], math.inf
    for k in range(int(rng.integers(1, 4))):
        turn = heading + math.pi + rng.uniform(-1.2, 1.2)
        normal = np.array([math.cos(turn), math.sin(turn)])
        closing, room = -float(normal @ ahead), rng.uniform(0.1, 1.5) * longest
        if k == 0 and seed % 3 == 0:
            room = rng.uniform(0.1, 0.9) * radius / closing  # it hangs over it from the start
        edges.append(Edge(tuple(place + room * ahead), normal=tuple(normal)))
        way = max(room - radius / closing, 0.0)  # at which the rim is there
        if room < longest:
            falls = min(falls, room)
        if way < longest:
            met.append((way, k))
    events = [
        ((speed - math.sqrt(max(speed**2 - 2.0 * decel * way, 0.0))) / decel, k)
        for way, k in sorted(met) if way < falls
    ]  # fmt: skip
    puck = Puck(radius=radius, friction=friction)
    launch = Launch(tuple(speed * ahead), position=tuple(place))
    return puck, launch, edges, events, falls < math.inf


def overhangs(run: Any) -> list[tuple[float, int]]:
    told = [event for event in run.events if event.what == "overhang"]
    return [(event.time, int(event.partner[5:])) for event in told]


@pytest.mark.parametrize("several", [False, True])
def test_it_is_told_when_a_rim_comes_over_an_edge(several: bool):
    seen = 0
    for seed in range(24):
        puck, launch, edges, events, falls = slide(seed)
        if several:
            piece = Puck(puck.radius, friction=puck.friction, name="a", launch=launch)
            run: Any = Scene(pucks=[piece], edges=edges).simulate()
            assert falls == any(event.what == "edge" for event in run.events)
        else:
            run = Scene(puck, launch=launch, edges=edges).simulate()
            assert falls == (run.end == "over the edge")
        found = overhangs(run)
        assert [k for _, k in found] == [k for _, k in events], seed
        np.testing.assert_allclose([t for t, _ in found], [t for t, _ in events], atol=1e-8)
        seen += len(events)
    assert seen > 20


def test_the_motion_of_a_dome_is_none_other():
    launch, puck = Launch((0.5, 0.1), 30.0), Puck(0.03, friction=0.2, pressure="hertz")
    piece = Puck(0.03, friction=0.2, pressure="hertz", launch=launch)
    boards: list[dict[str, Any]] = [
        {"puck": puck, "floor": Floor(slope=0.02), "launch": launch}, {"pucks": [piece]}
    ]  # fmt: skip
    for board in boards:
        far: Any = Scene(**board).simulate()
        x = float(np.ravel(far.last["x"])[0])
        near: Any = Scene(**board, edges=[Edge((x + 0.015, 0.0), normal=(-1.0, 0.0))]).simulate()
        assert len(overhangs(near)) == 1
        assert near.end_time == far.end_time
        for name, value in far.last.items():
            assert np.array_equal(near.last[name], value), name


def test_one_that_comes_back_is_told_of_again():
    edge, post = Edge((0.3, 0.0), normal=(-1.0, 0.0)), Post((0.355, 0.0), 0.03)
    piece = Puck(0.03, friction=0.02, launch=Launch((1.0, 0.0)))
    back = Wall((-0.2, 0.0), normal=(1.0, 0.0))
    run: Any = Scene(pucks=[piece], posts=[post], edges=[edge], walls=[back]).simulate()
    assert len(overhangs(run)) > 2
    up = Launch((0.0, 0.0), spin=0.0, position=(0.2, 0.0))
    table = Floor(turning=1.0, centre=(0.0, 0.0))
    puck = Puck(0.03, friction=0.5)
    run = Scene(puck, table, up, edges=[Edge((0.22, 0.0), normal=(-1.0, 0.0))]).simulate()
    assert run.end == "carried round"
    assert overhangs(run)


@pytest.mark.parametrize(
    "line",
    [
        ["--scene", "shuffleboard", "--v0", "4.5,0", "--w0", "0"],
        ["--scene", "shuffleboard-two-stones", "--set", "puck[0].launch.velocity=[9,0]"],
    ],
)
def test_the_report_says_so(line: list[str]):
    said = invoke("simulate", *line)
    assert said.exit_code == 0, said.stderr
    assert "carries nothing" in said.stdout
