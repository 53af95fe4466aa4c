"""Scenes given as tables, run or swept in one call."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from puck_tables import Floor, Launch, Puck, Scene
from puck_tables.results import Map, Run


def simulate_scene(tables: Any, times: Any = None) -> Run:
    """A run of a scene: its tables, itself, or the name of one that is shipped."""
    return made(tables).simulate(times)


def sweep_scene(tables: Any, **how: Any) -> Map:
    """The map over its ranges."""
    return made(tables).sweep(**how)


def made(tables: Any) -> Scene:
    if isinstance(tables, Scene):
        return tables
    return Scene.load(tables) if isinstance(tables, str | Path) else Scene.from_tables(tables)


def end_of(
    puck: Puck, floor: Floor | None = None, launch: Launch | None = None, **parts: Any
) -> np.ndarray:
    """When, where and how turned it comes to rest; the ledger closes."""
    run = Scene(puck, floor or Floor(), launch or Launch(), **parts).simulate([0.0])
    assert run.end == "at rest" and abs(run.energy_residual) < 1e-9
    return np.array([run.end_time, *(run.last[name] for name in ("x", "y", "orientation"))])


def two_ends_as_alone(ranged: Scene) -> None:
    """A sweep over two numbers ends as each of its scenes alone, and not twice alike."""
    ends = ranged.sweep()
    for number in range(2):
        alone = ranged.at(ends.numbers(number)).simulate([0.0])
        assert ends.x[number] == pytest.approx(alone.last["x"], abs=1e-6)
    assert ends.x[0] != ends.x[1]
