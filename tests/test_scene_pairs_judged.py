"""Scenes of several ingredients, and rebounds that settle, by an integrator of the tests."""

import math

import numpy as np
import pytest
from pairs_judge import draw
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


def faults(scenes, tols, folder):
    found = []
    for scene in scenes:
        best = known(scene, limit=3_000_000)
        if best is None or not best["stable"] or best["amplification"] > 1e5:
            continue
        for tol in tols:
            word, share, why = judged(scene, best, tol, folder)
            if word != "right":
                found.append(f"{scene['class']}: tol {tol:g}: {word}, {share:.3g}: {why}")
    return found


@pytest.mark.thorough
def test_pairs_and_triples(tmp_path):
    scenes = [(1, i) for i in (0, 3, 5)] + [(2, 285), (12, 79)]
    assert faults([draw(*scene) for scene in scenes], [1e-6, 1e-9], tmp_path) == []


@pytest.mark.thorough
def test_friction_of_a_table_that_hundreds_of_rebounds_add_up(tmp_path):
    """Forces and torques that are off by the same share hardly change where they lead."""
    assert faults([draw_rebounds(2, 94)], [1e-6], tmp_path) == []


@pytest.mark.thorough
def test_rebounds_that_settle(tmp_path):
    scenes = [(1, i) for i in (0, 1, 4, 5, 6, 9)] + [(3, 27), (3, 37), (3, 44), (3, 112), (11, 23)]
    assert faults([draw_rebounds(*scene) for scene in scenes], [1e-9], tmp_path) == []


@pytest.mark.nightly
def test_pairs_and_triples_by_the_hundred(tmp_path):
    assert faults([draw(2, i) for i in range(200)], [1e-4, 1e-6, 1e-9], tmp_path) == []


@pytest.mark.nightly
def test_many_rebounds_that_settle(tmp_path):
    scenes = [draw_rebounds(2, i) for i in range(100)]
    assert faults(scenes, [1e-6, 1e-9], tmp_path) == []


@pytest.mark.nightly
def test_thousands_of_rebounds(tmp_path):
    """2285 of them add up what friction errs by, that of a puck with its mass at the rim, too."""
    assert faults([draw_rebounds(2, 78)], [1e-6], tmp_path) == []
