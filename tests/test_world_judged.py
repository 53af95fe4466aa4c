"""Random boards, judged: by scipy, by brute-force sampling, by energy, and bit by bit."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from boards import draw, draw_pucks, judged
from pucks_judge import Floor, Straight, play
from rarely import few

import puck_tables as pt

STEP = 1e-5  # s, of the sampling by brute force


def board(seed: int) -> pt.Scene:
    """Two to five pucks, or in later seeds two to thirty."""
    return draw(seed, 2 + seed % 4 if seed < 1000 else 2 + seed % 29)


def number_of(scene: pt.Scene, name: str) -> int:
    """A puck as n, a wall as −1 − n."""
    kind, number = name.split()
    return int(number) if kind == "puck" else -1 - int(number)


def first_impacts(scene: pt.Scene, most: int = 3) -> list[tuple[float, int, int]]:
    found = []
    for event in scene.world().advance(math.inf):
        if event.what == "impact":
            pair = number_of(scene, event.puck), number_of(scene, event.partner)
            ordered = pair if pair[1] < 0 else (min(pair), max(pair))
            found.append((event.time, *ordered))
    return found[:most]


def agree_with_the_judge(scene: pt.Scene) -> None:
    ours = first_impacts(scene)
    discs, lines = judged(scene)
    # beyond our last one it need not look; one that is missed lies before, or is not among ours
    until = ours[2][0] + 1e-3 if len(ours) == 3 else ours[-1][0] + 0.05 if ours else 0.5
    truth = play(Floor(), discs, lines, until, most=len(ours) + (len(ours) < 3)).impacts
    assert [row[1:] for row in truth] == [row[1:] for row in ours]
    for (time, *_), (other, *_) in zip(truth, ours, strict=True):
        assert abs(time - other) < 1e-9


@pytest.mark.parametrize("seed", few(12, [*range(2, 312), 0, 1]))
def test_the_first_three_impacts_are_those_of_another_integrator(seed: int):
    agree_with_the_judge(board(seed))


@pytest.mark.parametrize("seed", few(10, range(2, 162)))
def test_the_first_three_impacts_among_walls_with_ends(seed: int):
    agree_with_the_judge(draw_pucks(seed, 2 + seed % 3))


class Film:
    """States of a board at many moments of its run until the end."""

    def __init__(self, scene: pt.Scene, moments: int | None, seed: int = 0) -> None:
        """Random moments with both sides of every event, or without a number every STEP."""
        self.scene, world = scene, scene.world()
        self.events = world.advance(math.inf)
        times = np.array([event.time for event in self.events])
        if moments is None:
            self.times = np.arange(0.0, world.time, STEP)
        else:
            rng = np.random.default_rng(seed)
            drawn = rng.uniform(0.0, world.time, moments)
            around = np.concatenate([drawn, times, times + 1e-12, times - 1e-12])
            self.times = np.sort(np.clip([0.0, world.time, *around], 0.0, world.time))
        self.states = world.over(self.times)
        self.radii = np.array([p.radius for p in scene.pucks])
        self.masses = np.array([p.mass for p in scene.pucks])

    def deepest(self) -> float:
        """The deepest overlap of two pucks, or of one and a wall, over the radius of one."""
        places, worst = self.states[:, :, :2], 0.0
        for i, j in itertools.combinations(range(len(self.radii)), 2):
            apart = np.hypot(*(places[:, i] - places[:, j]).T) - self.radii[i] - self.radii[j]
            worst = max(worst, -float(apart.min()) / min(self.radii[i], self.radii[j]))
        for wall in judged(self.scene)[1]:
            if isinstance(wall, Straight):
                nearest = wall.nearest(places.reshape(-1, 2).T).T.reshape(places.shape)
                gaps = np.hypot(*np.moveaxis(places - nearest, 2, 0)) - self.radii
            else:
                gaps = places @ np.array(wall.normal) - wall.place - self.radii
            worst = max(worst, -float((gaps / self.radii).min()))
        return worst

    def energy(self) -> np.ndarray:
        """At every moment, J; all are homogeneous discs."""
        v2 = self.states[:, :, 3] ** 2 + self.states[:, :, 4] ** 2
        rims2 = (self.radii * self.states[:, :, 5]) ** 2
        return (0.5 * v2 + 0.25 * rims2) @ self.masses

    def unexplained(self) -> list[tuple[float, int]]:
        """Where a velocity changes within a step by more than friction can do, without an event."""
        told = np.zeros((len(self.times), len(self.radii)), bool)
        for event in self.events:
            for name in (event.puck, event.partner):
                number = number_of(self.scene, name)
                if number >= 0:
                    told[np.searchsorted(self.times, event.time) - 1, number] = True
        change = np.hypot(*np.moveaxis(np.diff(self.states[:, :, 3:5], axis=0), 2, 0))
        most = 1.0001 * STEP * np.array([p.decel for p in self.scene.pucks]) + 1e-9
        return [
            (float(self.times[row]), int(number))
            for row, number in np.argwhere((change > most) & ~told[:-1])
        ]


@pytest.mark.parametrize("seed", [2, 3, 9])
def test_no_contact_is_missed_by_brute_force(seed: int):
    film = Film(board(seed), None)
    assert film.deepest() < 1e-12
    assert film.unexplained() == []


@pytest.mark.parametrize("seed", few(6, range(2000, 2306)))
def test_no_puck_reaches_into_another_or_a_wall(seed: int):
    assert Film(board(seed), 1000, seed).deepest() <= 1e-12


@pytest.mark.parametrize("seed", range(2000, 2012))
def test_no_puck_reaches_into_a_wall_with_ends(seed: int):
    assert Film(draw_pucks(seed, 2 + seed % 6), 1000, seed).deepest() <= 1e-12


def energy_is_kept(scene: pt.Scene, seed: int) -> None:
    run = scene.simulate()
    assert run.energy_residual <= 1e-9
    energy = Film(scene, 1000, seed).energy()
    assert np.diff(energy).max() <= scene.tol * energy[0]  # states are promised to that
    assert energy[0] == pytest.approx(run.last["energy_given"], rel=1e-12)
    assert energy[-1] <= 1e-20 * energy[0]
    assert run.last["heat_impact"] == pytest.approx(
        sum(event.lost for event in run.events), rel=1e-12
    )
    heat = run.last["heat_dry"] + run.last["heat_rims"] + run.last["heat_impact"]
    assert heat == pytest.approx(energy[0], rel=1e-9)


@pytest.mark.parametrize("seed", few(20, range(1000, 1320)))
def test_where_the_energy_goes(seed: int):
    energy_is_kept(board(seed), seed)


@pytest.mark.parametrize("seed", range(1000, 1040))
def test_where_the_energy_goes_among_walls_with_ends(seed: int):
    energy_is_kept(draw_pucks(seed, 2 + seed % 6), seed)


@pytest.mark.parametrize("seed", range(1000, 1006))
def test_steps_of_a_game_change_no_bit(seed: int):
    once, stepped = board(seed).world(), board(seed).world()
    for _ in range(90):
        stepped.advance(1.0 / 60.0)
    once.advance(stepped.time)
    assert once.time == stepped.time
    assert once.state().tobytes() == stepped.state().tobytes()
    assert once.events_since(0.0) == stepped.events_since(0.0)


@pytest.mark.parametrize("seed", range(1000, 1006))
def test_a_copy_goes_on_to_the_bit(seed: int):
    """Also when pucks are struck, some of them on their way, and the copy is left alone before."""
    world, rng = board(seed).world(), np.random.default_rng(seed)
    world.advance(0.1)
    ahead = world.copy()
    ahead.advance(0.3)  # looks ahead, and must not touch what it came from
    twin = world.copy()
    for _ in range(8):
        puck, velocity = int(rng.integers(len(world.names))), rng.normal(size=2)
        spin, wait = float(rng.normal() * 30.0), float(rng.uniform(0.0, 0.2))
        for one in (world, twin):
            one.strike(puck, velocity, spin)
            one.advance(wait)
        assert world.state().tobytes() == twin.state().tobytes()
    assert world.events_since(0.0) == twin.events_since(0.0)
    assert ahead.time != world.time
    assert ahead.events_since(0.0) != world.events_since(0.0)
