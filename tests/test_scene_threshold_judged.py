"""Coming to rest and leaving it next to the limit of friction, by the tests' own solutions."""

import pytest
from rarely import few
from threshold_judge import draw, judged, truth


@pytest.mark.parametrize("index", few(3, [2, 4, 11, 0, 1, 3, 15, 16]))
def test_next_to_the_limit(index, tmp_path):
    scene = draw(1, index)
    word, share, why, steps = judged(scene, truth(scene), 1e-6, tmp_path)
    assert word == "right", (scene["class"], scene["limit"]["share"], share, why)
    assert steps <= 20_000


@pytest.mark.parametrize("index", few(1, [1203, 105]))
def test_a_millionth_below_the_limit(index, tmp_path):
    """Rounding of what friction leaves of the force, a millionth, shortens no step."""
    scene = draw(1, index)
    word, share, why, steps = judged(scene, truth(scene), 1e-9, tmp_path)
    assert word == "right", (share, why)
    assert steps <= 15_000


@pytest.mark.nightly
@pytest.mark.parametrize("index", range(200))
def test_next_to_the_limit_in_many_ways(index, tmp_path):
    scene = draw(2, index)
    best = truth(scene)
    for tol in (1e-4, 1e-6, 1e-9):
        word, share, why, steps = judged(scene, best, tol, tmp_path)
        assert word == "right", (tol, scene["class"], scene["limit"]["share"], share, why)
        assert steps <= 20_000
