"""What the judges share: scenes as dicts, the engine of this checkout, tables of verdicts."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import numpy as np


def arguments(words: str, tols: list[float]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=words, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200, help="scenes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tol", type=float, action="append", help="may be given more than once")
    parser.add_argument("--show", type=int, default=5, help="offending scenes to print, per class")
    args = parser.parse_args()
    args.tol = args.tol or tols
    return args


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


def table(
    head: list[str], rows: list[list[Any]], faults: list[tuple[str, str, dict[str, Any]]], show: int
) -> None:
    """Print a table, then the offending scenes by class."""
    print("| " + " | ".join(head) + " |")
    print("| " + " | ".join("---" for _ in head) + " |")
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    for kind in sorted({fault[0] for fault in faults}):
        those = [fault for fault in faults if fault[0] == kind]
        print(f"\n{kind}: {len(those)}")
        for _, why, scene in those[:show]:
            print(f"  {why}\n    {scene}")
