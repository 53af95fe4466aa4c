"""Skate blades on floors that turn, under forces, by an integrator of the tests."""

import pytest
from blade_judge import STEPS, draw, judged, known
from rarely import few


@pytest.mark.thorough
@pytest.mark.parametrize("index", few(3, [8, 32, 36, 3, *range(40)]))
def test_blades_on_turntables(index, tmp_path):
    scene = draw(1, index)
    radians = abs(scene["launch"]["spin"]) * scene["time"]  # a piece of a path is an eighth or so
    best = known(scene)
    for tol in (1e-6, 1e-9):
        word, share, why, steps = judged(scene, best, tol, tmp_path)
        assert word == "right", (tol, scene["class"], share, why)
        assert steps <= max(STEPS, 10.0 * radians)
