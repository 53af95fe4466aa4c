"""States of many pucks of one kind, looked up, against scipy on truth friction."""

from __future__ import annotations

import math

import numpy as np
import pytest
from any_puck import motion_by_truth

from puck_tables import Puck
from puck_tables.motion.body import body_of
from puck_tables.stopping.state_section import MANY, state_section

NAMES = ("x", "y", "heading", "orientation", "speed", "spin")
USUAL = [("hertz", 0.8, 0.6), ("uniform", 0.5, 0.3)]  # one with a limit, one that ends sliding
MORE = [
    ("uniform", 2.0, 0.5**0.5), ("uniform", 3.5, 0.5**0.5), ("uniform", 0.9, 1.0),
    ("uniform", 0.5, 0.1), ("annulus:0.5", 0.7, 0.75), ("ring", 0.8, 0.9),
    ("hertz", 0.8, 2.0), ("galin", 1.0, 0.7),
]  # fmt: skip


def many(*columns: list[float]) -> list[np.ndarray]:
    """The same numbers again and again, until splines are made for them."""
    return [np.resize(column, MANY) for column in columns]


@pytest.mark.parametrize("kind, every", [
    *((one, 4) for one in USUAL),
    *(pytest.param(one, 1, marks=pytest.mark.thorough) for one in USUAL + MORE),
])  # fmt: skip
def test_states_by_truth_friction(kind: tuple[str, float, float], every: int):
    law, delta, gyration = kind
    puck = Puck.similar(delta=delta, pressure=law, gyration=gyration)
    limit = math.log(puck.limit_ratio) if 0.0 < puck.limit_ratio < math.inf else 1.0
    starts = [-20.0, -3.0, 0.0, 1e-6, limit - 0.5, limit + 1e-3, limit + 1e-9, 2.0, 20.0]
    rows, truths = [], []
    for u in starts[::every]:
        large = -0.5 * math.log1p(math.exp(-2.0 * abs(u)))
        v, w = math.exp(large - max(u, 0.0)), math.exp(large + min(u, 0.0))
        states = motion_by_truth(law, delta, gyration, u)[1]
        states = states[states[:, [0, 2]].max(axis=1) > 1e-7]  # later truth knows no direction
        rows += [(v, w, time) for time in states[:, 3]]
        truths += list(states)
    v, w, times = many(*np.transpose(rows).tolist())
    found = puck.states(np.stack([0.0 * v, v], axis=-1), -w, times)
    assert found.explain().startswith(f"{MANY} pucks looked up, to 1e-9")
    speed, turn, rim, _, x, y, angle = np.resize(truths, (MANY, 7)).T
    apart = {
        "x": found.x - y, "y": found.y - x, "body": found.orientation + angle,
        "v": found.speed - speed, "w": found.spin + rim,
        "heading": speed * (found.heading - 0.5 * math.pi + turn),
    }  # fmt: skip
    assert {name: off for name, row in apart.items() if (off := np.abs(row).max()) > 1e-9} == {}


@pytest.mark.parametrize("kind", [
    USUAL[0], *(pytest.param(one, marks=pytest.mark.thorough) for one in USUAL[1:] + MORE),
])  # fmt: skip
def test_a_state_launched_anew_goes_on_as_it_would_have(kind: tuple[str, float, float]):
    """At all moments, from 1e-14 of the way on to as near to the stop."""
    law, delta, gyration = kind
    rng, n = np.random.default_rng(7), 20_000
    puck = Puck.similar(delta=delta, pressure=law, gyration=gyration)
    limit = math.log(puck.limit_ratio) if 0.0 < puck.limit_ratio < math.inf else 0.0
    u = rng.uniform(-8.0, 8.0, n)
    u[::3] = limit + rng.choice([-1.0, 1.0], u[::3].size) * 10.0 ** -rng.uniform(0, 14, u[::3].size)
    phi, heading = np.arctan(np.exp(u)), rng.uniform(-3.0, 3.0, n)
    velocity = np.cos(phi)[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    spin, share = np.sin(phi) * rng.choice([-1.0, 1.0], n), rng.random(n)
    share[::5] = 10.0 ** -rng.uniform(1.0, 14.0, share[::5].size)
    share[1::5] = 1.0 - 10.0 ** -rng.uniform(1.0, 14.0, share[1::5].size)
    end = share * puck.stop(velocity, spin, tol=1e-8).stop_time
    middle = end * rng.random(n)
    whole, first = puck.states(velocity, spin, end), puck.states(velocity, spin, middle)
    then = puck.states(np.stack([first.vx, first.vy], axis=1), first.spin, end - middle)
    for name in ("x", "y", "orientation"):
        both = getattr(first, name) + getattr(then, name)
        assert np.abs(both - getattr(whole, name)).max() < 1e-9
    for name in ("vx", "vy", "spin"):
        assert np.abs(getattr(then, name) - getattr(whole, name)).max() < 1e-9


def test_launches_that_neither_slide_nor_spin_and_all_sizes():
    puck = Puck.similar(delta=0.8, pressure="hertz", gyration=0.6)
    speed = [0.0, 1.0, 0.0, 1.0, 1.0, 3e-140, 5e-324, 1e100, 1e-300, 1.0, 1.0]
    spin = [0.0, 0.0, -2.0, -1e-200, -0.7, 2e-140, 0.0, 1e100, -3.0, 3.0, 3.0]
    shares = [0.0, 0.3, 0.5, 0.2, 2.0, 0.4, 0.4, 0.1, 0.3, 0.0, 1.0]
    ends = [float(puck.stop((v, 0.0), w).stop_time) for v, w in zip(speed, spin, strict=True)]
    times = [share * end for share, end in zip(shares, ends, strict=True)]
    v, w, moments = many(speed, spin, times)
    velocity = np.stack([0.6 * v, -0.8 * v], axis=-1)
    found = puck.states(velocity, w, moments)
    again = puck.states(velocity, w, moments, threads=1)
    for n in range(len(speed)):
        alone = puck.states(velocity[n], w[n], moments[n])
        slip = float(np.hypot(v[n], w[n]))
        for name, unit in zip(NAMES, (slip**2, slip**2, 1.0, slip**2, slip, slip), strict=True):
            got, wanted = getattr(found, name)[n], float(getattr(alone, name))
            assert got == pytest.approx(wanted, abs=2e-9 * unit, rel=1e-15), (n, name)
    for name in NAMES:
        np.testing.assert_array_equal(getattr(again, name), getattr(found, name))


def test_few_of_a_height_are_integrated():
    heights = np.where(np.arange(MANY + 5) < 5, 1.7, 1.5)
    puck = {"delta": heights, "radius": 1.0, "decel": 1.0}
    from puck_tables import states

    found = states(np.tile([1.0, 0.0], (heights.size, 1)), 1.5, 0.5, **puck)
    assert found.explain().startswith(f"{MANY} pucks looked up and 5 pucks integrated")
    alone = states((1.0, 0.0), 1.5, 0.5, delta=1.7)
    assert set(found.x[:5]) == {float(alone.x)}


@pytest.mark.parametrize("kind", [
    ("ring", 0.8, 1.0),  # its limit is a line of the friction
    ("uniform", 0.5, 0.4842),  # it hardly leaves pure sliding
    pytest.param(("uniform", 3.9, 0.1), marks=pytest.mark.thorough),  # too steep
])  # fmt: skip
def test_where_splines_are_not_good_there_are_none(kind: tuple[str, float, float]):
    assert state_section(body_of(*kind)) is None
