"""How 1000 drawn scenes of one puck, and those that come along, end by the engine of the day.

    PYTHONPATH=tests python tests/golden/make_scene_ends.py

writes ``tests/golden/scene_ends.npz``.  It is no truth: it holds a new engine to an old one.  Make
it anew only where the old ends were wrong, and say so.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from random_scenes import draw

from puck_tables import Scene
from puck_tables.scene.library import shipped_scenes

FILE = Path(__file__).resolve().parent / "scene_ends.npz"
COUNT = 1000
UNKNOWN = 1e-6  # m: what is stated to be further off is nobody's to judge


def ends_of(scene: Scene) -> np.ndarray:
    """Rows (pucks, 4): x, y, m; the end's time, s; the error that is stated of x and y, m."""
    run = scene.simulate()
    error = run.end_error
    places = [np.atleast_1d(run.last[name]) for name in ("x", "y")]
    return np.column_stack(np.broadcast_arrays(*places, run.end_time, error))


def apart(now: np.ndarray, before: np.ndarray) -> np.ndarray:
    """The gaps of places over three stated errors."""
    gaps = np.hypot(*(now - before)[:, :2].T)
    stated = now[:, 3] + before[:, 3]
    gaps[np.maximum(now[:, 3], before[:, 3]) > UNKNOWN] = 0.0
    return gaps / (3.0 * stated + 1e-12)


def all_ends() -> dict[str, np.ndarray]:
    """By the names of scenes; those drawn under 'drawn'."""
    drawn = [ends_of(Scene.from_tables(draw(seed))) for seed in range(COUNT)]
    return {"drawn": np.concatenate(drawn)} | {
        name: ends_of(Scene.load(name)) for name in shipped_scenes()
    }


if __name__ == "__main__":
    np.savez_compressed(FILE, **all_ends())
