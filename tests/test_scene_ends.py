"""Scenes end where the engine before ended them, within the errors that both state."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from golden.make_scene_ends import FILE, apart, ends_of
from random_scenes import draw

from puck_tables import Scene

BEFORE = np.load(FILE)
BLOCK = 20
# a blade that spins 230 turns over a border: 1e-13 of its launch moves its end by 5e-7 m, and the
# engine before, 1e-6 m away from all that followed it, said 1.6e-8
TOO_SURE = [249]


def lying(tables: dict[str, Any]) -> dict[str, Any]:
    """A scene in which what hangs over an edge is carried as if it lay, as it was then."""
    return tables | {"edge": [one | {"beyond": "floor"} for one in tables.get("edge", [])]}


@pytest.mark.parametrize(
    "first",
    [pytest.param(n, marks=[pytest.mark.thorough] * (n > 0)) for n in range(0, 1000, BLOCK)],
)
def test_drawn_scenes_of_one_puck(first: int):
    seeds = range(first, first + BLOCK)
    now = np.concatenate([ends_of(Scene.from_tables(lying(draw(seed)))) for seed in seeds])
    worst = apart(now, BEFORE["drawn"][first : first + BLOCK])
    worst[np.isin(seeds, TOO_SURE)] = 0.0
    assert worst.max() < 1.0, seeds[int(worst.argmax())]
    assert now[:, 2] == pytest.approx(BEFORE["drawn"][first : first + BLOCK, 2], rel=1e-5)


@pytest.mark.parametrize("name", sorted(set(BEFORE.files) - {"drawn"}))
def test_scenes_that_come_along(name: str):
    assert apart(ends_of(Scene.load(name)), BEFORE[name]).max() < 1.0


def test_a_gap_is_seen():
    """A thousandth of a millimetre off is no end as before."""
    before = BEFORE["drawn"][:BLOCK]
    assert (apart(before + np.array([1e-6, 0.0, 0.0, 0.0]), before) > 1.0).mean() > 0.9
