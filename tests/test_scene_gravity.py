"""The gravity of a scene is that of all its pucks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.scene.entries import tables_of
from puck_tables.scene.scene_text import as_toml

PUCK = pt.Puck(0.04, height=0.02, friction=0.15)
ROW = pt.Scene.load("curling-take-out")


@pytest.mark.parametrize(
    "scene", [pt.Scene(PUCK, launch=pt.Launch((0.8, 0.1), spin=20.0)), ROW], ids=["one", "several"]
)
def test_on_another_planet_the_same_paths_are_run_at_another_pace(scene: pt.Scene):
    """Four times the gravity and twice the velocities: all paths as before, in half the time."""
    run, tables = scene.simulate(), tables_of(scene)
    for puck in tables["puck"] if scene.pucks else [tables]:
        launch = puck["launch"]
        launch["velocity"] = [2.0 * v for v in launch.get("velocity", (0.0, 0.0))]
        launch["spin"] = 2.0 * launch["spin"]
    for puck in tables["puck"] if scene.pucks else [tables["puck"]]:
        gravity = puck.pop("gravity")
    quick = pt.Scene.from_tables({**tables, "gravity": 4.0 * gravity}).simulate()
    assert quick.end_time == pytest.approx(0.5 * run.end_time, rel=1e-9)
    for name in ("x", "y", "orientation"):
        np.testing.assert_allclose(quick.last[name], run.last[name], rtol=1e-7, atol=1e-9)


def test_it_is_kept_by_copies_files_and_ranges():
    moon = replace(ROW, gravity=1.62)
    assert {puck.gravity for puck in moon.pucks} == {1.62}
    assert {puck.gravity for puck in replace(moon, gravity=3.0).pucks} == {3.0}
    assert pt.Scene.from_tables(tables_of(moon)) == moon
    assert "\ngravity = 1.62\n" in as_toml(moon) and as_toml(moon).count("gravity") == 1
    ends = replace(ROW, gravity=[1.62, 9.0]).sweep()
    assert ends.end_time[0] == moon.simulate().end_time


def test_two_gravities_are_refused():
    with pytest.raises(pt.InputError, match=r"puck\[1\]\.gravity = 3: the scene's gravity, 2 m/s"):
        pt.Scene(pucks=[pt.Piece(0.1), pt.Piece(0.1, gravity=3.0)], gravity=2.0)
