"""Scenes given as tables, run or swept in one call."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from puck_tables import Scene
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
