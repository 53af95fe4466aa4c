"""Aiming on a board: launches against formulas, and against an integrator of its own."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from boards import draw, puck_at
from scipy.constants import g

import puck_tables as pt
from puck_tables import InputError
from puck_tables.world.shots import Shots

R, J = 0.03, 0.2 * g  # of the pucks of ``puck_at``, without height: straight ways
FLAT = {"height": 0.0, "name": ""}


def two(x: float = 0.4, y: float = 0.0, **more: object) -> pt.Scene:
    """A cue at the origin and a red puck, smooth and elastic."""
    cue = puck_at(0.0, 0.0, **{**FLAT, "name": "cue"})
    return pt.Scene(pucks=[cue, puck_at(x, y, **{**FLAT, "name": "red"})], **more)


def test_a_cut_is_the_ghost_of_the_striker() -> None:
    """Smooth rims: red leaves along the line of centres with the speed along it."""
    target = np.array([0.7, 0.25])
    found = two().aim(target, striker="cue")
    red = np.array([0.4, 0.0])
    way = target - red
    ghost = red - 2.0 * R * way / np.hypot(*way)
    cut = way @ ghost / np.hypot(*way) / np.hypot(*ghost)
    speed = math.sqrt(2.0 * J * (np.hypot(*ghost) + np.hypot(*way) / cut**2))
    assert found.sequences == ("cue - red",) and found.answer.startswith("1 launch up to")
    assert found.launch_speed[0] == pytest.approx(speed, rel=1e-9)
    assert found.launch_heading[0] == pytest.approx(math.atan2(*ghost[::-1]), abs=1e-9)
    assert found.miss[0] < 1e-9
    turn = math.hypot(*found.run(0)["red"]["x"][-1:], found.run(0)["red"]["y"][-1])
    assert turn == pytest.approx(np.hypot(*target), abs=1e-8)


def test_launches_faster_than_that_of_the_scene_are_followed_together(monkeypatch) -> None:
    """Its friction law is known for all that are tried: one by one they took 13 s, not 0.4."""
    alone: list[int] = []
    monkeypatch.setattr(Shots, "_alone", lambda *run: alone.append(run[-1]))
    cue = pt.Puck(R, name="cue", launch=pt.Launch((0.3, 0.0)))
    board = pt.Scene(pucks=[cue], floor=pt.Floor(law=pt.StribeckLaw(0.25, 0.15, speed=0.2)))
    found = board.aim((0.5, 0.1), max_speed=2.0)
    assert not alone and len(found) == 1 and found.miss[0] < 1e-9


def test_a_cushion_is_a_mirror() -> None:
    """One puck alone, e = 1: it ends where it would end behind the mirror."""
    board = pt.Scene(
        pucks=[puck_at(0.0, 0.0, **FLAT)],
        walls=[pt.Wall((0.0, 0.5), normal=(0.0, -1.0), restitution=1.0)],
    )
    found = board.aim((0.6, 0.1), max_impacts=1)
    images = {"": (0.6, 0.1), "puck 0 - wall 0": (0.6, 2.0 * (0.5 - R) - 0.1)}
    assert set(found.sequences) == set(images)
    for sequence, speed, heading in zip(
        found.sequences, found.launch_speed, found.launch_heading, strict=True
    ):
        x, y = images[sequence]
        assert speed == pytest.approx(math.sqrt(2.0 * J * math.hypot(x, y)), rel=1e-9)
        assert heading == pytest.approx(math.atan2(y, x), abs=1e-9)


def test_the_striker_itself_ends_there_after_it_hit_one() -> None:
    """Equal smooth elastic pucks part at 90 degrees: a carom of the cue."""
    found = two().aim((0.5, 0.25), puck="cue", striker="cue", hits="red")
    assert len(found) == 1 and found.sequences == ("cue - red",)
    run = found.run(0)
    assert math.dist((run["cue"]["x"][-1], run["cue"]["y"][-1]), (0.5, 0.25)) < 1e-9
    meeting = next(event for event in run.events if event.what == "impact")
    red = np.array([run["red"]["x"][-1] - 0.4, run["red"]["y"][-1]])
    cue = np.array([0.5, 0.25]) - (np.array([meeting.x, meeting.y]) - R * red / np.hypot(*red))
    assert abs(red @ cue) < 1e-8
    free = two().aim((0.5, 0.25), puck="cue", striker="cue")
    assert sorted(free.sequences) == ["", "cue - red"]  # also past it


def test_a_pocket_has_a_width_and_a_least_speed() -> None:
    """A slide without spin at a hole: a wedge of headings, speeds from the rim on."""
    board = pt.Scene(pucks=[puck_at(0.0, 0.0, **FLAT)], pockets=[pt.Pocket((0.8, 0.6), 0.05)])
    found = board.aim(pocket=0, max_speed=4.0)
    assert len(found) == 1 and found.miss[0] == 0.0
    speed, heading = found.launch_speed[0], found.launch_heading[0]
    assert heading == pytest.approx(math.atan2(0.6, 0.8), abs=1e-5)
    assert found.heading_width[0] == pytest.approx(2.0 * math.asin(0.05), rel=1e-4)
    least = math.sqrt(2.0 * J * 0.95)
    assert found.speed_width[0] == pytest.approx(4.0 - least, rel=1e-4)
    assert speed == pytest.approx(0.5 * (4.0 + least), rel=1e-4)
    assert found.run(0).events[-1].partner == "pocket 0"


def test_speed_given_spin_is_looked_for_and_spins_are_each_asked() -> None:
    tall = [replace(one, height=0.02, tangential=0.0) for one in two().pucks]
    board = pt.Scene(pucks=tall)
    found = board.aim((0.7, 0.1), striker="cue", speed=1.8)
    assert len(found) >= 1
    np.testing.assert_allclose(found.launch_speed, 1.8, rtol=1e-14)
    for spin in found.launch_spin.tolist():
        again = board.aim((0.7, 0.1), striker="cue", spin=[0.0, spin], max_speed=2.5)
        assert {0.0, spin} == set(again.launch_spin.tolist())
        assert np.abs(again.launch_speed[again.launch_spin == spin] - 1.8).min() < 1e-9


def test_sensitivities_are_those_of_runs_and_order_the_launches() -> None:
    walls = [pt.Wall((0.0, 0.4), normal=(0.0, -1.0), restitution=0.8)]
    found = two(0.4, 0.1, walls=walls).aim((0.7, 0.2), striker="cue")
    assert len(found) >= 2
    size = np.hypot(found.per_degree, found.per_percent)
    assert (np.diff(size) >= 0.0).all()
    board = found.board(0)
    vx, vy = board.pucks[0].launch.velocity
    turn = math.radians(1e-3)
    moved = []
    for velocity in (
        (vx * math.cos(turn) - vy * math.sin(turn), vx * math.sin(turn) + vy * math.cos(turn)),
        (vx * 1.00001, vy * 1.00001),
    ):
        run = board.at({"puck[0].launch.velocity": list(velocity)}).simulate()
        moved.append(1e3 * math.dist((run["red"]["x"][-1], run["red"]["y"][-1]), (0.7, 0.2)))
    assert moved == pytest.approx([found.per_degree[0], found.per_percent[0]], rel=1e-2)


def test_that_none_was_found_is_said_as_such() -> None:
    behind = two().aim((-0.5, 0.0), puck="red", striker="cue")
    assert len(behind) == 0 and "no launch up to" in behind.answer
    assert "not proved" in behind.answer
    assert two().aim((0.4, 0.0), striker="cue").answer == (
        "red lies there: any launch that leaves it alone will do"
    )
    never = two().aim((0.7, 0.0), striker="cue", max_speed=1.1)
    needed = 0.75 * J * 0.1 * (0.4 - 2.0 * R + 0.3)
    assert "exists" in never.answer and f"{needed:.4g} J" in never.answer
    with pytest.raises(InputError, match="no launch 0: no launch up to"):
        behind.board(0)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"target": (0.7, 0.0), "puck": "rod"}, "did you mean 'red'"),
        ({"target": (0.7, 0.0), "striker": None}, "sends off none: name one"),
        ({}, "neither is given"),
        ({"target": (0.7, 0.0), "pocket": 0}, "both are given"),
        ({"target": (0.7, 0.5)}, "wall[0] in the way it reaches through it by 0.03 m"),
        ({"target": (0.5, 0.1)}, "post[0] in the way"),
        ({"target": (0.9, 0.2)}, "or ask for pocket 0"),
        ({"target": (0.7,)}, "one place (x, y)"),
        ({"target": (math.nan, 0.0)}, "target must be finite"),
        ({"pocket": 1}, "no pocket 1: the board has one, 0"),
        ({"pocket": -1}, "no pocket -1"),
        ({"target": (0.7, 0.0), "spin": 1.0, "speed": 1.0}, "give one of them"),
        ({"target": (0.7, 0.0), "max_speed": 0.0}, "max_speed must be greater"),
        ({"target": (0.7, 0.0), "spin": 9.0, "max_spin": 5.0}, "above max_spin"),
        ({"target": (0.7, 0.0), "max_impacts": -1}, "max_impacts must be a whole number"),
        ({"target": (0.7, 0.0), "count": 0}, "count must be a whole number"),
        ({"target": (0.7, 0.0), "puck": "cue", "hits": "cue"}, "the striker itself"),
    ],
)
def test_bad_aims(how: dict, words: str) -> None:
    board = two(
        walls=[pt.Wall((0.0, 0.5), normal=(0.0, -1.0))], posts=[pt.Post((0.5, 0.1), 0.01)],
        pockets=[pt.Pocket((0.9, 0.2), 0.05)],
    )  # fmt: skip
    with pytest.raises(InputError) as refused:
        board.aim(**{"striker": "cue", **how})
    assert words in str(refused.value)


def test_what_is_driven_or_ranges_cannot_be_aimed() -> None:
    mallet = pt.Puck(0.05, name="mallet", path=((0.0, 2.0, 0.0), (1.0, 2.0, 0.5)))
    board = pt.Scene(pucks=[*two().pucks, mallet])
    with pytest.raises(InputError, match="driven along its path and cannot be sent off"):
        board.aim((0.7, 0.0), puck="red", striker="mallet")
    with pytest.raises(InputError, match="give one number"):
        pt.Scene(pucks=two().pucks, ranges={"puck[0].launch.spin": [0.0, 1.0]}).aim((0.7, 0.0))
    free = [replace(one, friction=0.0) for one in two().pucks]
    with pytest.raises(InputError, match="nothing brings cue to rest"):
        pt.Scene(pucks=free).aim((0.7, 0.0), striker="cue")
    with pytest.raises(InputError, match="none; give a target"):
        two().aim(pocket=0, striker="cue")


def _asked_again(seed: int) -> tuple[int, bool]:
    """A random launch with one impact of a random board: whether its end leads back to it."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 5))
    drawn = draw(seed + 5000, count, speed=0.0, walls=bool(rng.random() < 0.7))
    still = [
        replace(one, launch=pt.Launch(position=one.launch.position), name=f"p{n}")
        for n, one in enumerate(drawn.pucks)
    ]
    board = replace(drawn, pucks=tuple(still))
    spin, puck = float(rng.normal() * 20.0), int(rng.integers(0, count))
    for _ in range(60):
        v, a = rng.uniform(0.2, 2.5), rng.uniform(-math.pi, math.pi)
        velocity = [v * math.cos(a), v * math.sin(a)]
        run = board.at({"puck[0].launch.velocity": velocity, "puck[0].launch.spin": spin}).simulate(
            [0.0]
        )
        met = [event for event in run.events if event.what != "stick"]
        if [event.what for event in met] == ["impact"] and f"p{puck}" in (
            met[0].puck,
            met[0].partner,
        ):
            break
    else:
        return 0, False
    target = run.last["x"][puck], run.last["y"][puck]
    found = board.aim(target, puck=puck, striker=0, spin=spin, max_speed=3.0, count=200)
    assert (found.miss < 1e-8).all()
    gaps = np.hypot(found.launch_vx - velocity[0], found.launch_vy - velocity[1])
    return 1, bool((gaps < 1e-5).any())


@pytest.mark.thorough
def test_ends_of_launches_lead_back_to_them() -> None:
    answers = [_asked_again(seed) for seed in range(1, 7)]
    assert sum(asked for asked, _ in answers) >= 3
    assert all(found for asked, found in answers if asked)


@pytest.mark.nightly
def test_of_many_launches_almost_all_are_found_again() -> None:
    answers = [_asked_again(seed) for seed in range(100, 320)]
    asked = sum(one for one, _ in answers)
    assert asked >= 120 and sum(found for _, found in answers) >= 0.99 * asked
