"""Scenes of several ingredients, and rebounds that settle, by an integrator of the tests."""

import math

import numpy as np
import pytest
from pairs_judge import draw
from rarely import nightly, thorough
from rebound_judge import draw as draw_rebounds
from scene_truth import LEANS, truth
from verdicts import judged, known


@pytest.mark.thorough
def test_the_judge_sums_rebounds_on_a_slope():
    scene = {
        "puck": {"radius": 0.04, "friction": 0.1}, "floor": {"slope": 0.4},
        "launch": {"velocity": [0.5, 0.0]}, "time": 3.0,
        "wall": [{"point": [0.2, 0.0], "normal": [-1.0, 0.0], "restitution": 0.9}],
    }  # fmt: skip
    found = truth(scene)
    down, up = (9.80665 * (math.sin(0.4) + s * 0.1 * math.cos(0.4)) for s in (-1.0, 1.0))
    hit = math.sqrt(0.25 + 2.0 * down * 0.16)
    # every hop goes up v/up and comes down; it lands with v √(down/up)
    first, ratio = (hit - 0.5) / down, 0.9 * math.sqrt(down / up)
    hop = 0.9 * hit * (1.0 / up + 1.0 / math.sqrt(up * down))
    rests = first + hop / (1.0 - ratio)
    assert abs(found["events"][found["events"][:, 1] == LEANS][0, 0] - rests) <= 1e-8


@pytest.mark.thorough
@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_the_judge_lets_a_leaning_rim_feel_friction(restitution):
    mass, radius, mu, push = 2.0, 0.1, 0.2, 3.0
    scene = {
        "puck": {"radius": radius, "mass": mass}, "floor": {},
        "launch": {"velocity": [0.0, 4.0]}, "force": {"constant": [push, 0.0]},
        "wall": [{
            "point": [0.2, 0.0], "normal": [-1.0, 0.0], "restitution": restitution,
            "tangential": 0.0, "friction": mu,
        }],
        "time": 8.0,
    }  # fmt: skip
    early, late = truth(scene, np.array([4.0, 8.0]))["states"]
    if restitution < 0.5:  # it leans by then: all normal impulses are what the force has given
        assert abs(early[4] - (4.0 - mu * push * 4.0 / mass)) <= 1e-9
    # at last the rim rolls, and the angular momentum about the wall is that of the launch
    assert abs(late[4] - 4.0 / (1.0 + 0.5)) <= 1e-9
    assert abs(abs(late[5]) * radius - late[4]) <= 1e-9


@pytest.mark.parametrize(
    ("scenes", "tols"),
    [
        thorough([(draw, 1, 0), (draw, 1, 3), (draw, 1, 5), (draw, 2, 285), (draw, 12, 79)],
                 [1e-6, 1e-9]),
        # hundreds of rebounds add up what friction of a table errs by
        thorough([(draw_rebounds, 2, 94)], [1e-6]),
        thorough([*((draw_rebounds, 1, i) for i in (0, 1, 4, 5, 6, 9)), (draw_rebounds, 11, 23),
                  *((draw_rebounds, 3, i) for i in (27, 37, 44, 112))], [1e-9]),
        nightly([(draw, 2, i) for i in range(200)], [1e-4, 1e-6, 1e-9]),
        nightly([(draw_rebounds, 2, i) for i in range(100)], [1e-6, 1e-9]),
        nightly([(draw_rebounds, 2, 78)], [1e-6]),  # 2285 of them, with its mass at the rim
    ],
    ids=["pairs", "hundreds", "settle", "many pairs", "many settle", "thousands"],
)  # fmt: skip
def test_as_the_judge_has_it(scenes, tols, tmp_path):
    """Forces and torques that are off by the same share hardly change where they lead."""
    found = []
    for drawn, *numbers in scenes:
        scene = drawn(*numbers)
        best = known(scene, limit=3_000_000)
        if best is None or not best["stable"] or best["amplification"] > 1e5:
            continue
        for tol in tols:
            word, share, why = judged(scene, best, tol, tmp_path)
            if word != "right":
                found.append(f"{scene['class']}: tol {tol:g}: {word}, {share:.3g}: {why}")
    assert found == []
