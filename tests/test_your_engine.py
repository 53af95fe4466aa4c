"""The lines of docs/your-engine.md, run in the engines that are installed, and their order."""

from __future__ import annotations

import importlib.util
import math
import os
import re
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import puck_tables as pt

PAGE = (ROOT / "docs" / "your-engine.md").read_text(encoding="utf-8")
PUCK = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)
ENGINES = {  # heading: language, module, how far the place may be off, m
    "pymunk": ("python", "pymunk", 1e-6), "Box2D": ("python", "Box2D", 2e-5),
    "planck.js": ("js", "planck", 2e-5), "matter.js": ("js", "matter-js", 2e-5),
}  # fmt: skip
MODULES = Path(os.environ.get("NODE_MODULES", "node_modules"))  # where npm put them


@pytest.mark.parametrize("engine", ENGINES)
def test_the_lines_run_and_are_right(engine: str, tmp_path: Path):
    language, module, near = ENGINES[engine]
    section = PAGE.split(f"\n## {engine}\n")[1].split("\n## ")[0]
    (lines,) = re.findall(r"```(?:py|js)\n(.*?)```", section, re.DOTALL)
    if language == "python":
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"{module} is not installed")
        pt.export_source("python", "state", tol=1e-6).save(tmp_path / "puck.py")
        script, program = tmp_path / "play.py", sys.executable
    else:
        if not (MODULES / module).is_dir() or shutil.which("node") is None:
            pytest.skip(f"{module} is not installed")
        pt.export_source("js", "state", tol=1e-6).save(tmp_path / "puck.js")
        (tmp_path / "node_modules").symlink_to(MODULES.resolve())
        script, program = tmp_path / "play.mjs", "node"
    script.write_text(lines, encoding="utf-8")
    ended = subprocess.run(
        [program, str(script)], capture_output=True, text=True, cwd=tmp_path, check=True
    )
    x, y, angle = map(float, ended.stdout.split())
    truth = PUCK.simulate((2.0, 0.0), 30.0, exact=True)
    assert math.hypot(x - truth.stop_position[0], y - truth.stop_position[1]) < near
    assert abs(angle - truth.body_angle) < near / PUCK.radius


def test_velocities_of_the_middle_of_a_step_are_of_second_order():
    """What the page says of engines that move a body by the velocity that they are given."""
    after = PUCK.simulate((2.0, 0.0), 30.0, times=[1.5], exact=True)
    truth, errors = (after.x[0], after.y[0]), []
    for steps in (30, 60, 120):
        dt, place, velocity, spin = 1.0 / steps, np.zeros(2), (2.0, 0.0), 30.0
        for n in range(3 * steps // 2):
            state = PUCK.states(velocity, spin, [dt if n else dt / 2])
            velocity, spin = (state.vx[0], state.vy[0]), state.spin[0]
            place += dt * np.array(velocity)
        errors.append(math.dist(place, truth))
    assert errors[1] < 1e-5
    assert [one / two for one, two in pairwise(errors)] == pytest.approx([4.0, 4.0], abs=0.4)
