"""How likely launches on a board do it, where nobody hits them exactly."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
import pytest

import puck_tables as pt

FRICTION, GRAVITY = 0.1, 9.80665


def chance_beside_an_edge(aimed: float, low: float, high: float, share: float) -> float:
    """That v²/2fg lies between, where v scatters by a share of what is aimed at."""
    normal = NormalDist(aimed, share * aimed)
    near, far = (math.sqrt(2.0 * FRICTION * GRAVITY * place) for place in (low, high))
    return normal.cdf(far) - normal.cdf(near)


def test_a_slide_that_must_not_go_over_an_edge():
    """The chance of the exact launch, and the aim short of it that is best, in closed form."""
    table = pt.Scene(
        pucks=[pt.Puck(0.03, friction=FRICTION)], edges=[pt.Edge((0.82, 0.0), normal=(-1, 0))]
    )
    found = table.aim((0.8, 0.0), spin=0.0)
    odds = found.odds(speed=0.05, within=0.1, count=600, seed=3)
    aims = np.linspace(1.1, 1.3, 2001)
    chances = [chance_beside_an_edge(aim, 0.7, 0.82, 0.05) for aim in aims.tolist()]
    exact = chance_beside_an_edge(found.launch_speed[0], 0.7, 0.82, 0.05)
    assert odds.nominal.low - 0.01 < exact < odds.nominal.high + 0.01
    assert odds.best.low - 0.01 < max(chances) < odds.best.high + 0.01
    assert max(chances) - exact > 0.07  # else there is nothing to be seen
    assert math.hypot(*odds.velocity) == pytest.approx(aims[int(np.argmax(chances))], abs=0.02)
    assert (odds.spin, odds.failed) == (0.0, 0)


def test_a_man_into_a_pocket_beside_runs_of_their_own():
    """The share of single worlds in which it falls, and at least as good beside it."""
    rim: dict = {"friction": FRICTION, "restitution": 0.9}
    board = pt.Scene(
        pucks=[pt.Puck(0.03, name="striker", **rim),
               pt.Puck(0.03, name="man", launch=pt.Launch(position=(0.3, 0.05)), **rim)],
        pockets=[pt.Pocket((0.6, 0.1), 0.035)],
    )  # fmt: skip
    found = board.aim(puck="man", pocket=0, striker="striker", count=1)
    odds = found.odds(heading=0.04, speed=0.05, count=400)
    assert found.odds(heading=0.04, speed=0.05, count=400) == odds
    rng, fallen = np.random.default_rng(11), []
    for turn, share in rng.normal(size=(100, 2)) * (0.04, 0.05):
        heading, speed = found.launch_heading[0] + turn, found.launch_speed[0] * (1.0 + share)
        world = board.world()
        world.strike(
            found.striker, (speed * math.cos(heading), speed * math.sin(heading)),
            float(found.launch_spin[0]),
        )  # fmt: skip
        events = [(e.what, e.puck, e.partner) for e in world.advance(math.inf)]
        fallen.append(("pocket", "man", "pocket 0") in events)
    share = float(np.mean(fallen))
    assert 0.2 < share < 0.9
    margin = 4.0 * math.sqrt(0.25 / 100)
    assert odds.nominal.value == pytest.approx(share, abs=margin)
    assert odds.best.value >= odds.nominal.value


def test_refusals():
    table = pt.Scene(pucks=[pt.Puck(0.03, friction=FRICTION)])
    found = table.aim((0.8, 0.0), spin=0.0)
    for given, words in (
        ({"within": 0.1}, "one of them by more"), ({"speed": 0.1}, "give within"),
        ({"speed": -0.1, "within": 0.1}, "0 or more"), ({"speed": math.nan}, "speed"),
        ({"number": 5, "speed": 0.1, "within": 0.1}, "no launch 5"),
        ({"speed": 0.1, "within": 0.1, "count": 5}, "count must be"),
    ):  # fmt: skip
        with pytest.raises(pt.InputError, match=words):
            found.odds(**given)
