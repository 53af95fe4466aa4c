"""Pucks that touch and hardly move apart: few looks, and they do not creep into each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from boards import draw, puck_at

import puck_tables as pt
from puck_tables.world.engine_state import N_LOOKS

MOST_LOOKS = 100_000  # some 50 ms


def depth_and_looks(scene: pt.Scene, until: float = math.inf) -> tuple[float, int]:
    """The deepest overlap at 300 moments, over a radius, and how often gaps were looked at."""
    world = scene.world()
    world.advance(until)
    places = world.over(np.linspace(0.0, world.time, 300))[:, :, :2]
    radii = np.array([p.radius for p in scene.pucks])
    deepest = 0.0
    for i in range(len(radii)):
        for j in range(i):
            gaps = np.hypot(*(places[:, i] - places[:, j]).T) - radii[i] - radii[j]
            deepest = max(deepest, -float(gaps.min()) / min(radii[i], radii[j]))
        for wall in scene.walls:
            gaps = (places[:, i] - wall.point) @ np.array(wall.normal) - radii[i]
            deepest = max(deepest, -float(gaps.min()) / radii[i])
        for arc in scene.arcs:
            gaps = arc.radius - np.hypot(*(places[:, i] - arc.point).T) - radii[i]
            deepest = max(deepest, -float(gaps.min()) / radii[i])
    return deepest, int(world._engine.counts[N_LOOKS])


DRIFTS = [1e-12, 1e-9, 1e-6, 1e-3]


@pytest.mark.parametrize("drift", DRIFTS)
@pytest.mark.parametrize("way", [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.6, 0.8)])
def test_a_puck_that_spins_beside_one_at_rest(drift: float, way: tuple[float, float]):
    """Its friction is along its spin, so that it hardly slows down the little drift it has."""
    velocity = (drift * way[0], drift * way[1])
    for height in (0.0, 0.02):
        spins = puck_at(0.0, 0.0, velocity, 30.0, restitution=0.5, height=height)
        depth, looks = depth_and_looks(pt.Scene(pucks=[spins, puck_at(0.06, 0, restitution=0.5)]))
        assert depth <= 1e-12
        assert looks < MOST_LOOKS


@pytest.mark.parametrize("drift", DRIFTS)
def test_pucks_side_by_side_whose_frictions_hardly_differ(drift: float):
    other = puck_at(0.06, 0.0, (0.0, 1.0), friction=0.2 * (1.0 + drift))
    depth, looks = depth_and_looks(pt.Scene(pucks=[puck_at(0, 0, (0.0, 1.0)), other]))
    assert depth <= 1e-12
    assert looks < MOST_LOOKS


@pytest.mark.parametrize("drift", DRIFTS)
@pytest.mark.parametrize("cushion", [
    {"walls": [pt.Wall((0.0, -0.03), normal=(0.0, 1.0), restitution=0.5)]},
    {"posts": [pt.Post((0.0, -0.1), 0.07, restitution=0.5)]},
    {"arcs": [pt.Arc((0.0, 0.2), 0.23, restitution=0.5)]},
], ids=["wall", "post", "arc"])  # fmt: skip
def test_a_puck_that_spins_beside_a_cushion(drift: float, cushion: dict):
    for velocity in ((0.0, drift), (drift, 0.0), (0.0, -drift)):
        pucks = [puck_at(0.0, 0.0, velocity, 30.0), puck_at(0.0, 0.07, friction=0.5)]
        depth, looks = depth_and_looks(pt.Scene(pucks=pucks, **cushion))
        assert depth <= 1e-12
        assert looks < MOST_LOOKS


@pytest.mark.parametrize("count", [2, 5])
def test_a_row_beside_each_other_stays_one(count: int):
    row = [puck_at(0.06 * n, 0.0, (0.0, 1.0)) for n in range(count)]
    depth, looks = depth_and_looks(pt.Scene(pucks=row))
    assert depth <= 1e-12
    assert looks < MOST_LOOKS


def test_one_left_spinning_by_a_group_that_came_to_rest():
    """Board 253 of 23: 5e-12 m/s were left, and 32 million looks, and an overlap of 2e-11 R."""
    depth, looks = depth_and_looks(draw(253, 23, side=0.6, speed=2.0))
    assert depth <= 1e-12
    assert looks < MOST_LOOKS


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(300))
def test_no_board_is_looked_at_for_long(seed: int):
    depth, looks = depth_and_looks(
        draw(seed, 2 + seed % 29, side=0.6 + 0.4 * (seed % 29 > 24), speed=2.0)
    )
    assert depth <= 1e-12
    assert looks < MOST_LOOKS
