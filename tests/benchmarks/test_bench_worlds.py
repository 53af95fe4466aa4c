"""Many boards at once, and as many single worlds in a loop of Python."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import puck_tables as pt

STEPS = pytest.mark.benchmark(group="air-hockey-goals, 1/60 s a step, all cores")
BREAKS = pytest.mark.benchmark(group="carrom-break, strikes until rest, all cores")

N, FRAMES, FRAME = 4096, 30, 1.0 / 60.0
FEW = 64  # single worlds


def shots(n: int, speed: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(39)
    angle = rng.uniform(0.0, 2.0 * math.pi, n)
    return speed * np.column_stack([np.cos(angle), np.sin(angle)]), 10.0 * rng.normal(size=n)


def led(n: int) -> np.ndarray:
    """Velocities (frames, n, 2) of mallets that go to and fro before the goal, off its walls."""
    rng = np.random.default_rng(40)
    phase, t = rng.uniform(0.0, 6.0, (n, 2)), FRAME * np.arange(FRAMES)[:, None, None]
    return 0.6 * np.cos(9.0 * t + phase)


def table() -> pt.Scene:
    """The table that comes along, its mallet led by hand."""
    scene = pt.Scene.load("air-hockey-goals")
    mallet = pt.Puck(0.0508, path=[[0.0, 1.9, 0.55]], restitution=0.9, name="mallet")
    return pt.Scene(
        pucks=[scene.pucks[0], mallet], walls=scene.walls, edges=scene.edges, lines=scene.lines,
        drag=scene.drag, time=3.0,
    )  # fmt: skip


@STEPS
@pytest.mark.parametrize("driven", [False, True])
def test_steps(measure: Any, driven: bool) -> None:
    worlds, velocities = pt.Worlds(table(), N), led(N)

    def play() -> None:
        worlds.reset()
        worlds.strike(0, *shots(N, 3.0))
        for frame in range(FRAMES):
            if driven:
                worlds.drive("mallet", velocities[frame])
            worlds.advance(FRAME)

    name = f"{N} boards, mallets led every frame" if driven else f"{N} boards"
    measure(name, play, items=N * FRAMES, unit="step")


@STEPS
@pytest.mark.parametrize("driven", [False, True])
def test_rival_single_worlds(measure: Any, driven: bool) -> None:
    start, velocities = table().world(), led(FEW)
    pushes, spins = shots(FEW, 3.0)

    def play() -> None:
        for n in range(FEW):
            world = start.copy()
            world.strike(0, pushes[n], spins[n])
            for frame in range(FRAMES):
                if driven:
                    world.drive("mallet", velocities[frame, n])
                world.advance(FRAME)

    name = "rival: World one by one, mallets led" if driven else "rival: World one by one"
    measure(name, play, items=FEW * FRAMES, unit="step")


def strikes(n: int) -> np.ndarray:
    """Up the board, within some degrees, from 2 to 4 m/s."""
    rng = np.random.default_rng(41)
    angle, speed = rng.normal(0.0, 0.1, n), rng.uniform(2.0, 4.0, n)
    return speed[:, None] * np.column_stack([np.sin(angle), np.cos(angle)])


@BREAKS
def test_breaks(measure: Any) -> None:
    worlds, pushes = pt.Worlds(pt.Scene.load("carrom-break"), N), strikes(N)

    def play() -> None:
        worlds.reset()
        worlds.strike("striker", pushes)
        worlds.advance(math.inf)

    play()
    measure.benchmark.extra_info["events"] = len(worlds.events["time"]) / N
    measure(f"{N} boards", play, items=N, unit="break")


@BREAKS
def test_rival_single_breaks(measure: Any) -> None:
    start, pushes = pt.Scene.load("carrom-break").world(), strikes(FEW)

    def play() -> None:
        for push in pushes:
            world = start.copy()
            world.strike("striker", push)
            world.advance(math.inf)

    measure("rival: World one by one", play, items=FEW, unit="break")
