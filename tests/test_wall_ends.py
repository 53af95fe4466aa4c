"""Walls with ends: known answers, and what may not depend on how a wall is put."""

from __future__ import annotations

import itertools
import math
from typing import Any

import bounce_judge
import numpy as np
import pytest
from rarely import nightly
from scipy.integrate import solve_ivp

import puck_tables as pt

R, F = 0.05, 0.1
DECEL = F * 9.80665
MOST = 20  # impacts: one that is wedged between two walls has hundreds, in the end at once


def thrown(place: Any, velocity: Any, walls: list[pt.Wall], **how: Any) -> pt.Scene:
    spin = how.pop("spin", 0.0)
    puck = pt.Puck(R, friction=F, mass=0.2, launch=pt.Launch(velocity, spin, place))
    return pt.Scene(pucks=[puck], walls=walls, **how)


def drawn(seed: int) -> tuple[list[tuple[np.ndarray, np.ndarray, float]], np.ndarray, np.ndarray]:
    """Pieces of walls anywhere around a puck, in a frame, and its launch."""
    rng = np.random.default_rng([seed, 11])
    heading = rng.uniform(-math.pi, math.pi)
    velocity = rng.uniform(1.5, 3.0) * np.array([math.cos(heading), math.sin(heading)])
    pieces = []
    while len(pieces) < 8:
        a = rng.uniform(-1.0, 1.0, 2)
        b = a + rng.uniform(0.02, 0.8) * rng.normal(size=2)
        near = np.linalg.norm(bounce_judge.nearest(a, b, np.zeros(2)))
        if near > 1.1 * R:
            pieces.append((a, b, float(rng.choice([1.0, rng.uniform(0.2, 1.0)]))))
    frame = [np.array(place) for place in ((-1.2, -1.2), (1.2, -1.2), (1.2, 1.2), (-1.2, 1.2))]
    pieces += [(a, b, 0.9) for a, b in zip(frame, frame[1:] + frame[:1], strict=True)]
    if seed % 3 == 0:  # the rim only just meets an end, or only just passes it
        a = pieces[0][0]
        off = R * (1.0 + rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-7.0, -2.0))
        ahead = a / np.linalg.norm(a)
        turn = math.asin(off / np.linalg.norm(a))
        c, s = math.cos(turn), math.sin(turn)
        way = np.array([ahead[0] * c - ahead[1] * s, ahead[0] * s + ahead[1] * c])
        velocity = float(np.linalg.norm(velocity)) * way
    return pieces, np.zeros(2), velocity


def compare_with_geometry(seed: int) -> int:
    """How many impacts agree with rays and circles."""
    pieces, place, velocity = drawn(seed)
    walls = [pt.Wall(a.tolist(), b.tolist(), restitution=e) for a, b, e in pieces]
    run = thrown(place.tolist(), velocity.tolist(), walls).simulate()
    ours = [event for event in run.events if event.what == "impact"]
    truth = bounce_judge.play(place, velocity, R, DECEL, pieces, MOST)
    nudge = 1e-9 * np.array([-velocity[1], velocity[0]])
    beside = bounce_judge.play(place, velocity + nudge, R, DECEL, pieces, MOST)
    agreed = 0
    for event, (which, where), (other, there) in zip(ours, truth.hits, beside.hits, strict=False):
        grown = float(np.linalg.norm(there - where)) if which == other else math.inf
        if grown > 1e-3:  # chaos: nobody knows what comes next
            return agreed
        assert event.partner == f"wall {which}"
        assert math.dist((event.x, event.y), where) < 1e-11 + 0.1 * grown
        agreed += 1
    if agreed < MOST:
        assert len(ours) == len(truth.hits)
        grown = float(np.linalg.norm(beside.stop - truth.stop))
        last = run.last["x"][0], run.last["y"][0]
        assert math.dist(last, truth.stop) < 1e-10 + 0.1 * grown
        assert run.energy_residual < 1e-9
    return agreed


@pytest.mark.parametrize("seeds", [range(100), nightly(range(100, 6400))])
def test_drawn_walls_agree_with_rays_and_circles(seeds: range) -> None:
    assert sum(map(compare_with_geometry, seeds)) > 2 * len(seeds)


def square(ends: float, **rim: Any) -> tuple[list[pt.Wall], list[pt.Wall]]:
    """Four walls around the origin without ends, and with ends so far away."""
    lines, pieces = [], []
    for nx, ny in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
        x, y = -0.5 * nx, -0.5 * ny
        lines.append(pt.Wall((x, y), normal=(nx, ny), **rim))
        start, end = (x - ends * ny, y + ends * nx), (x + ends * ny, y - ends * nx)
        pieces.append(pt.Wall(start, end, **rim))
    return lines, pieces


@pytest.mark.parametrize("ends", [0.5, 7.0])
def test_far_ends_change_no_bit(ends: float) -> None:
    """Also where the ends are the corners of the board."""
    rim = {"restitution": 0.8, "tangential": 0.3, "friction": 0.4}
    rng = np.random.default_rng(7)
    for _ in range(40):
        place, velocity = rng.uniform(-0.4, 0.4, 2).tolist(), (3.0 * rng.normal(size=2)).tolist()
        spin = float(20.0 * rng.normal())
        one, two = (
            thrown(place, velocity, walls, spin=spin).simulate() for walls in square(ends, **rim)
        )
        assert one.last["x"].tobytes() == two.last["x"].tobytes()
        assert one.last["orientation"].tobytes() == two.last["orientation"].tobytes()
        assert one.events == two.events


def test_an_end_is_a_post_of_radius_zero_in_the_limit() -> None:
    """The difference to a post of radius ε falls as ε."""
    place, velocity = (0.031, 0.4), (0.02, -2.0)
    rim = {"restitution": 0.7, "tangential": 0.0, "friction": 0.3}
    wall = thrown(place, velocity, [pt.Wall((0.0, 0.0), (-0.4, -0.3), **rim)], spin=9.0).simulate()
    assert wall.events[0].partner == "wall 0"
    away = []
    for radius in (1e-4, 1e-5, 1e-6):
        scene = thrown(place, velocity, [], spin=9.0, posts=[pt.Post((0.0, 0.0), radius, **rim)])
        away.append(abs(scene.simulate().last["x"][0] - wall.last["x"][0]))
    np.testing.assert_allclose(np.array(away[:-1]) / away[1:], 10.0, rtol=0.02)
    assert away[-1] < 1e-4


@pytest.mark.parametrize("v", [0.1, 0.2, 0.3])
def test_a_puck_that_slides_off_an_end_rolls_over_it_and_flies(v: float) -> None:
    """Down a slope without friction: as a bead on a sphere it leaves at cos θ = 2/3 + v²/3gR."""
    g, slope = 9.80665, 0.3
    pull = g * math.sin(slope)
    puck = pt.Puck(R, friction=0.0, mass=0.2,
                    launch=pt.Launch((v, 0.0), position=(-0.1, R)))  # fmt: skip
    scene = pt.Scene(
        pucks=[puck], walls=[pt.Wall((-1.0, 0.0), (0.0, 0.0), restitution=0.5)],
        floor=pt.Floor(slope=slope, downhill=-math.pi / 2.0), time=2.0,
    )  # fmt: skip
    run = scene.simulate(times=np.linspace(0.0, 2.0, 25))

    def swing(_: float, y: Any) -> list[float]:
        return [y[1], pull / R * math.sin(y[0])]

    def leaves(_: float, y: Any) -> float:
        return pull * math.cos(y[0]) - R * y[1] ** 2

    leaves.terminal = True  # type: ignore[attr-defined]
    begin = [0.0, v / R]
    ride = solve_ivp(swing, (0.0, 9.0), begin, "DOP853", rtol=1e-12, atol=1e-14, events=leaves)
    angle, rate = ride.y_events[0][0]
    assert math.cos(angle) == pytest.approx(2.0 / 3.0 + v**2 / (3.0 * pull * R), abs=1e-10)
    flies = 2.0 - 0.1 / v - ride.t_events[0][0]
    vx, vy = R * rate * math.cos(angle), -R * rate * math.sin(angle)
    x = R * math.sin(angle) + vx * flies
    y = R * math.cos(angle) + vy * flies - 0.5 * pull * flies**2
    assert run.last["x"][0] == pytest.approx(x, abs=1e-8)
    assert run.last["y"][0] == pytest.approx(y, abs=1e-8)
    assert run.energy_residual < 1e-9


def leaning(walls: list[pt.Wall], spin: float = 30.0) -> Any:
    """A puck that slides along rough walls, pressed onto them, and rolls."""
    return thrown(
        (-0.8, 0.2), (1.6, -1.0), walls, spin=spin, floor=pt.Floor(slope=0.2, downhill=-1.2),
        time=4.0,
    ).simulate()  # fmt: skip


def pieces_of_a_wall(cuts: list[float], **rim: Any) -> list[pt.Wall]:
    places = [-1.0, *cuts, 99.0]
    return [pt.Wall((a, 0.0), (b, 0.0), **rim) for a, b in itertools.pairwise(places)]


@pytest.mark.parametrize("restitution", [0.0, 0.6])
def test_a_wall_in_pieces_is_the_wall(restitution: float) -> None:
    rim = {"restitution": restitution, "tangential": 0.0, "friction": 0.2}
    whole = leaning(pieces_of_a_wall([], **rim))
    endless = leaning([pt.Wall((0.0, 0.0), normal=(0.0, 1.0), **rim)])
    cut = leaning(pieces_of_a_wall([-0.7, -0.55, -0.5, -0.1, 0.0], **rim))
    for column in ("x", "y", "vx", "spin"):
        assert whole.last[column][0] == endless.last[column][0]
        assert cut.last[column][0] == pytest.approx(whole.last[column][0], abs=1e-9)
    assert whole.last["y"][0] == pytest.approx(R, abs=1e-12)
    assert "contact" in [event.what for event in whole.events]


def test_what_stands_on_the_other_side_of_a_wall_is_not_felt() -> None:
    """A wall that ends on another one has no end to meet, from neither side."""
    rim = {"restitution": 0.0, "tangential": 0.0, "friction": 0.2}
    stem = pt.Wall((0.0, 0.0), (0.2, -0.4), **rim)
    for wall in (pieces_of_a_wall([], **rim)[0], pt.Wall((0.0, 0.0), normal=(0.0, 1.0), **rim)):
        one, two = leaning([wall]), leaning([wall, stem])
        assert one.last["x"].tobytes() == two.last["x"].tobytes()
        assert len(one.events) == len(two.events)


def test_both_faces_are_alike() -> None:
    """What is mirrored in a wall goes its mirrored way, to the bit."""
    wall = [pt.Wall((-0.3, 0.0), (0.2, 0.0), restitution=0.7, tangential=0.2, friction=0.5)]
    for n in range(20):
        place, velocity, spin = (0.02 * n - 0.2, 0.3), (0.1, -2.0), 4.0 * n
        one = thrown(place, velocity, wall, spin=spin).simulate().last
        mirrored = (place[0], -place[1]), (velocity[0], -velocity[1])
        two = thrown(*mirrored, wall, spin=-spin).simulate().last
        for column, sign in (("x", 1.0), ("y", -1.0), ("orientation", -1.0)):
            assert one[column][0] == sign * two[column][0]


def test_a_puck_aimed_straight_at_an_end_meets_it_once() -> None:
    """Where side and corner share the blame: walls at any angle, the foot on the end itself."""
    for angle in np.linspace(0.0, 2.0 * math.pi, 61).tolist():
        ux, uy = math.cos(angle), math.sin(angle)
        end = (0.37 * ux + 0.1, 0.37 * uy - 0.2)
        wall = pt.Wall((end[0] - ux, end[1] - uy), end)
        place = (end[0] - 0.6 * uy, end[1] + 0.6 * ux)
        run = thrown(place, (1.6 * uy, -1.6 * ux), [wall]).simulate()
        assert [event.what for event in run.events] == ["impact", "stick"]
        assert math.dist((run.events[0].x, run.events[0].y), end) < 1e-9
        left = 1.6**2 / (2.0 * DECEL) - 0.55  # back the way that it came
        place = end[0] - (R + left) * uy, end[1] + (R + left) * ux
        assert math.dist((run.last["x"][0], run.last["y"][0]), place) < 1e-9


@pytest.mark.parametrize("aim", np.linspace(-0.3, 0.3, 25).tolist())
def test_two_walls_that_meet_have_one_corner(aim: float) -> None:
    """Off a right angle from outside: one impact, of the velocity along its normal."""
    walls = [pt.Wall((0.0, 0.0), (-0.5, -0.5)), pt.Wall((0.5, -0.5), (0.0, 0.0))]
    run = thrown((aim * R, 0.4), (0.0, -1.5), walls).simulate()
    impacts = [event for event in run.events if event.what == "impact"]
    assert len(impacts) == 1 and impacts[0].partner == "wall 0"
    truth = bounce_judge.play(
        np.array([aim * R, 0.4]), np.array([0.0, -1.5]), R, DECEL,
        [(np.zeros(2), np.array([-0.5, -0.5]), 1.0), (np.array([0.5, -0.5]), np.zeros(2), 1.0)],
    )  # fmt: skip
    assert math.dist((run.last["x"][0], run.last["y"][0]), truth.stop) < 1e-9


def star(points: int, outer: float, inner: float) -> list[list[float]]:
    turns = np.arange(2 * points) * math.pi / points
    sizes = np.where(np.arange(2 * points) % 2 == 0, outer, inner)
    return np.column_stack([sizes * np.cos(turns), sizes * np.sin(turns)]).tolist()


@pytest.mark.parametrize("inside", [True, False])
def test_a_closed_outline_lets_nobody_through(inside: bool) -> None:
    """Five spikes: its corners stick out where it is met from outside, and five more inside."""
    corners = star(5, 0.5, 0.3) if inside else star(5, 0.2, 0.1)
    shape = pt.Wall(corners=corners, restitution=0.9)
    frame = [] if inside else [pt.Wall(corners=[[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]],
                                       restitution=0.9)]  # fmt: skip
    places = np.array(corners)
    for seed in range(30):
        rng = np.random.default_rng([seed, 5])
        heading = rng.uniform(0.0, 2.0 * math.pi)
        far = 0.0 if inside else 0.4
        place = [far * math.cos(heading + 1.0), far * math.sin(heading + 1.0)]
        velocity = [4.0 * math.cos(heading), 4.0 * math.sin(heading)]
        spin = float(30.0 * rng.normal())
        run = thrown(place, velocity, [shape, *frame], spin=spin).simulate()
        assert run.impacts > 3 and run.energy_residual < 1e-9
        way = np.column_stack([run["puck 0"]["x"], run["puck 0"]["y"]])
        gaps = [
            np.linalg.norm(bounce_judge.nearest(a, b, p) - p)
            for a, b in zip(places, np.roll(places, -1, axis=0), strict=True) for p in way
        ]  # fmt: skip
        assert min(gaps) > R * (1.0 - 1e-11)
        assert (np.hypot(*way.T) < 0.5).all() if inside else (np.hypot(*way.T) > 0.1).all()
