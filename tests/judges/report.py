"""What the judges share: scenes as dicts, the engine of this checkout."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np


def written(scene: dict[str, Any], folder: Path, **run: Any) -> dict[str, Any]:
    """A scene as the engine takes it: rows of ``drive`` in a file."""
    whole = {key: part for key, part in scene.items() if key not in ("drive", "class", "limit")}
    whole |= run
    if scene.get("drive"):
        path = folder / "drive.csv"
        rows = [",".join(repr(float(cell)) for cell in row) for row in scene["drive"]]
        path.write_text("\n".join(rows) + "\n")
        whole["force"] = {**scene.get("force", {}), "over_time": str(path)}
    return whole


def engine(
    scene: dict[str, Any], tol: float, folder: Path, times: np.ndarray | None = None
) -> tuple[Any, str]:
    """The engine's run, or None and its words."""
    from scenes import simulate_scene

    from puck_tables.errors import PuckError

    try:
        return simulate_scene(written(scene, folder, tol=tol), times), ""
    except (PuckError, ArithmeticError, ValueError) as error:
        return None, f"{type(error).__name__}: {error}"


def lines(scene: dict[str, Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Walls (n, 6) moved in by the radius, edges (n, 3), borders (n, 3) as n_x, n_y, c, …."""

    def line(part: dict[str, Any]) -> list[float]:
        size = math.hypot(*part["normal"])
        nx, ny = part["normal"][0] / size, part["normal"][1] / size
        return [nx, ny, nx * part["point"][0] + ny * part["point"][1]]

    walls = []
    for wall in scene.get("wall", []):
        nx, ny, c = line(wall)
        walls.append([
            nx, ny, c + scene["puck"]["radius"], wall.get("restitution", 1.0),
            wall.get("tangential", -1.0), min(wall.get("friction", math.inf), 1e300),
        ])  # fmt: skip
    edges = [line(edge) for edge in scene.get("edge", [])]
    strips, borders = scene.get("floor", {}).get("strips"), []
    if strips:
        angle = strips.get("direction", 0.0)
        borders = [[math.cos(angle), math.sin(angle), place] for place in strips["borders"]]
    return (
        np.array(walls).reshape(-1, 6), np.array(edges).reshape(-1, 3),
        np.array(borders).reshape(-1, 3),
    )  # fmt: skip
