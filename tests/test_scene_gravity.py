"""The gravity of a scene is that of all its pucks."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from commands import invoke
from puck_tables.cli.values import NumberParam

import puck_tables as pt
from puck_tables.scene.entries import tables_of
from puck_tables.scene.library import as_toml

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
    quick = pt.Scene.from_tables({**tables, "gravity": f"{4.0 * 980.665} cm/s^2"}).simulate()
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


def board(rng: np.random.Generator, said: object = None, which: int = 0) -> dict[str, Any]:
    """Two to four pucks side by side, of which one may say its gravity, as tables."""
    pucks: list[dict[str, Any]] = [
        {"radius": rng.uniform(0.02, 0.04), "launch": {"position": [0.2 * n, 0.0]}}
        for n in range(rng.integers(2, 5))
    ]
    if said is not None:
        pucks[which]["gravity"] = said
    return {"puck": pucks}


def test_one_scene_has_one_gravity_and_what_a_puck_says_is_never_overridden():
    """Also where the standard one is said, with a unit, as a range, or comes from a copy."""
    rng = np.random.default_rng(61)
    scenes_gravity = r"gravity.*: the scene's gravity, 1\.62 m"
    for said in (9.80665, 3.0, "980.665 cm/s^2", np.float64(9.80665), [9.80665, 3.0], "1.62:3:4"):
        tables = board(rng, said, which=int(rng.integers(2)))
        with pytest.raises(pt.InputError, match=r"puck\[\d\]\." + scenes_gravity):
            pt.Scene.from_tables({**tables, "gravity": 1.62})
        with pytest.raises(pt.InputError, match=r"puck\." + scenes_gravity):
            pt.Scene({"radius": 0.03, "gravity": said}, gravity=1.62)
        if said in (9.80665, "980.665 cm/s^2"):
            assert {puck.gravity for puck in pt.Scene.from_tables(tables).pucks} == {9.80665}
            continue
        with pytest.raises(pt.InputError, match="write it once above all, as gravity"):
            pt.Scene.from_tables(tables)
    alike = pt.Scene.from_tables({**board(rng, 1.62), "gravity": "162 cm/s²"})
    for gravity in (2.0, [1.62, 2.0]):
        with pytest.raises(pt.InputError, match=r"puck\[0\]\.gravity = 1\.62: the scene's gravity"):
            replace(alike, gravity=gravity)
    wrong = ["simulate", "--scene", "carrom-break", "--set", "puck.gravity=3"]
    assert "write --gravity 3" in invoke(*wrong).stderr


def test_a_scene_without_its_gravity_is_on_the_earth_again():
    plain = pt.Scene.from_tables(board(np.random.default_rng(62)))
    for ranges in ({}, {"puck[0].launch.velocity[0]": [1.0, 2.0]}):
        moon = replace(plain, gravity=1.62, ranges=ranges)
        for copy in (moon, pickle.loads(pickle.dumps(moon)), replace(moon, frames=7)):
            back = replace(copy, gravity=None, frames=101)
            assert {puck.gravity for puck in back.pucks} == {9.80665}
            assert back == replace(plain, ranges=ranges)
    kept = pt.Scene(pucks=moon.pucks)  # what they were on before
    assert {puck.gravity for puck in kept.pucks} == {1.62}
    assert pt.Scene.from_tables(tables_of(kept)) == kept
    assert plain.at({"gravity": 1.62}) == replace(plain, gravity=1.62)


def test_accelerations_have_units():
    rng = np.random.default_rng(63)
    sizes = {"m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "cm/s**2": 0.01, "m s^-2": 1.0,
             "ft/s^2": 0.3048, "mm·s⁻²": 1e-3, "m/s/s": 1.0, "km/h/s": 1 / 3.6,
             "g": 9.80665}  # fmt: skip
    for unit, size in sizes.items():
        text = f"{rng.uniform(0.5, 2.0):.6g}{['', ' '][rng.integers(2)]}{unit}"
        value = float(text.removesuffix(unit)) * size
        assert pt.Puck(0.04, gravity=text).gravity == pytest.approx(value, rel=1e-12)
        assert pt.Scene(PUCK, gravity=text).gravity == pytest.approx(value, rel=1e-12)
        assert NumberParam("m/s^2").convert(text, None, None) == pytest.approx(value, rel=1e-12)
    for text in ("1.62 m/s", "1.62 m", "1.62 m/s^3", "1.62 s^2", "1.62 rad/s^2"):
        with pytest.raises(pt.InputError, match=r"must be a number > 0 m/s\^2, or with its unit"):
            pt.Puck(0.04, gravity=text)
