"""Scenes end where the engine before ended them, within the errors that both state."""

from __future__ import annotations

import numpy as np
import pytest
from golden.make_scene_ends import FILE, ends_of
from random_scenes import draw

from puck_tables import Scene

BEFORE = np.load(FILE)
UNKNOWN = 1e-6  # m: what is stated to be further off is nobody's to judge
BLOCK = 100


def apart(now: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The gaps of places over three stated errors."""
    gaps = np.hypot(*(now - before)[:, :2].T)
    stated = now[:, 3] + before[:, 3]
    gaps[np.maximum(now[:, 3], before[:, 3]) > UNKNOWN] = 0.0
    return gaps / (3.0 * stated + 1e-12)


@pytest.mark.parametrize(
    "first",
    [pytest.param(n, marks=[pytest.mark.thorough] * (n > 0)) for n in range(0, 1000, BLOCK)],
)
def test_drawn_scenes_of_one_puck(first: int):
    seeds = range(first, first + BLOCK)
    now = np.concatenate([ends_of(Scene.from_tables(draw(seed))) for seed in seeds])
    worst = apart(now, BEFORE["drawn"][first : first + BLOCK])
    assert worst.max() < 1.0, seeds[int(worst.argmax())]
    assert now[:, 2] == pytest.approx(BEFORE["drawn"][first : first + BLOCK, 2], rel=1e-5)


@pytest.mark.parametrize("name", sorted(set(BEFORE.files) - {"drawn"}))
def test_scenes_that_come_along(name: str):
    assert apart(ends_of(Scene.load(name)), BEFORE[name]).max() < 1.0


def test_a_gap_is_seen():
    """A thousandth of a millimetre off is no end as before."""
    before = BEFORE["drawn"][:BLOCK]
    assert (apart(before + np.array([1e-6, 0.0, 0.0, 0.0]), before) > 1.0).mean() > 0.9


def test_a_far_post_changes_nothing():
    """It makes the scene one of several bodies; within three errors and what ``tol`` allows."""
    for seed in range(30):
        alone = draw(seed)
        if "constraint" in alone and "turning" in alone["floor"]:
            continue  # refused among several bodies
        scene = Scene.from_tables(alone)
        far = Scene.from_tables(alone | {"post": [{"point": [900.0, 900.0], "radius": 0.01}]})
        now, before = ends_of(far), ends_of(scene)
        run = scene.simulate()
        before[:, 3] += scene.tol * run.speed_scale**2 / run.rate_scale
        assert apart(now, before).max() < 1.0, seed
