"""Scenes of several ingredients, and rebounds that settle, by an integrator of the tests."""

import pytest
from pairs_judge import draw
from rarely import nightly, thorough
from rebound_judge import draw as draw_rebounds
from verdicts import judged, known


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
