"""What is compiled ahead is not compiled again by a game or a service."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SERVED = """
import numpy as np, puck_tables as pt
rng = np.random.default_rng({seed})
r, f = rng.uniform(0.02, 0.1, 2)
for puck in (pt.Puck(r, 0.3 * r, f), pt.Puck(r, 0.3 * r, f, pressure="ring")):
    v, w = rng.uniform(0.2, 2.0, (100, 2)), rng.uniform(-40.0, 40.0, 100)
    run = puck.simulate(v[0], w[0])
    stops, states = puck.stop(v, w), puck.states(v, w, rng.uniform(0.0, 1.0, 100))
    aim = puck.aim(0.3 * v[0])
names = ["incline", "skate-blade", "carrom-break", "newtons-row", "bowling-row", "wet-patch"]
rng.shuffle(names)
for name in names:
    pt.Scene.load(name).simulate()
world = pt.Scene.load("curling-take-out").world()
for frame in range(60):
    world.advance(1.0 / 60.0)
    world.state()
many = pt.Worlds(pt.Scene.load("shuffleboard-two-stones"), 100)
many.advance(0.5)
many.state()
"""


def run(code: str, **environment: str) -> str:
    """What Python says on stderr."""
    command = [sys.executable, "-c", code]
    return subprocess.run(
        command, env={**os.environ, **environment}, capture_output=True, text=True, check=True
    ).stderr


@pytest.mark.nightly
def test_what_is_warm_compiles_nothing(tmp_path: Path) -> None:
    kept = {"XDG_CACHE_HOME": str(tmp_path), "NUMBA_DISABLE_JIT": "0"}
    said = run("import puck_tables as pt; pt.warm_up()", **kept).splitlines()
    parts = [line for line in said if line.startswith("warming up, ")]
    assert len(parts) >= 5
    assert f"{len(parts)} of {len(parts)}" in parts[-1]
    for seed in np.random.default_rng().integers(1000, size=2):
        assert run(SERVED.format(seed=seed), **kept) == "", seed
    again = run("import puck_tables as pt; pt.warm_up()", **kept).splitlines()
    assert again == parts
