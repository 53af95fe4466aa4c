"""Numbers of a doubtful size are questioned at every door, once, and what has a unit is not."""

from __future__ import annotations

import math

import numpy as np
import pytest

import puck_tables as pt
from puck_tables import Scene
from puck_tables._core import own_folder
from puck_tables.errors import InputError
from puck_tables.scene.library import shipped_scenes

SIZES = {  # path: what is usual, what another unit would make of it, in words
    "puck.radius": (0.03, 1e3, "metres"), "puck.friction": (0.1, 1e2, "percent"),
    "floor.downhill": (1.2, 180.0 / math.pi, "degrees"), "post[0].radius": (0.02, 1e3, "metres"),
    "launch.position[0]": (0.5, 1e3, "metres"), "launch.velocity[1]": (1.0, 1e3, "m/s"),
}  # fmt: skip
TABLES = {
    "puck": {"radius": 0.03, "friction": 0.1}, "floor": {"slope": 0.02, "downhill": 0.1},
    "post": [{"point": [90.0, 90.0], "radius": 0.02}],
    "launch": {"velocity": [1.0, 0.1], "position": [0.1, 0.1]},
}  # fmt: skip


@pytest.fixture(autouse=True)
def nothing_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_folder, "_said", set())


def test_a_puck_in_units_of_its_own_may_have_any_size(capsys: pytest.CaptureFixture[str]):
    pt.Puck.similar(radius=1e4, delta=0.7)
    pt.export_source("js", "state", tol=1e-4)
    assert "beyond" not in capsys.readouterr().err


@pytest.mark.parametrize("path", SIZES)
def test_another_unit_is_asked_for(path: str, capsys: pytest.CaptureFixture[str]):
    usual, factor, words = SIZES[path]
    rng = np.random.default_rng([7, len(path)])
    scene = Scene.from_tables(TABLES)
    good = usual * float(rng.uniform(0.7, 1.3))
    scene.at({path: good})
    assert capsys.readouterr().err == ""
    scene.at({path: good * factor})
    said = capsys.readouterr().err
    assert words in said and said.count("\n") == 1
    scene.at({path: good * factor * 1.01})
    assert capsys.readouterr().err == ""  # once


def test_what_is_written_with_its_unit_is_not(capsys: pytest.CaptureFixture[str]):
    puck, wall = pt.Puck(0.03, friction=0.1), pt.Wall(("300 m", 0), normal=(-1.0, 0.0))
    Scene(puck, pt.Floor(slope=0.1, downhill="-90deg"), walls=[wall])
    assert capsys.readouterr().err == ""
    Scene(puck, pt.Floor(slope=0.1, downhill=-90))
    assert "degrees" in capsys.readouterr().err


def test_shipped_scenes_are_of_usual_sizes(capsys: pytest.CaptureFixture[str]):
    for name in shipped_scenes():
        Scene.load(name)
    assert capsys.readouterr().err == ""


def test_wide_angles_of_samples_are(capsys: pytest.CaptureFixture[str]):
    scene = Scene.from_tables(TABLES)
    scene.sample(2, 1, {"launch.orientation": pt.Normal(0.0, 0.1)})
    assert "scatters" not in capsys.readouterr().err
    scene.sample(2, 1, {"launch.orientation": pt.Normal(0.0, 5.0)})
    assert "orientation scatters by 5 rad" in capsys.readouterr().err


def test_spreads_have_units():
    assert pt.Normal("40mm", "1mm").mean == 0.04
    assert pt.Uniform("300rpm", "600rpm").low == pytest.approx(10.0 * math.pi)
    scene = Scene.from_tables(TABLES)
    with pytest.raises(InputError, match=r"launch.spin is in rad/s: its spread is in m"):
        scene.sample(2, 1, {"launch.spin": pt.Normal("40mm", "1mm")})
    for wrong in (("40mm", 1.0), ("40mm", "1s"), ("5g", "1g")):
        with pytest.raises(InputError, match="unit"):
            pt.Normal(*wrong)


def test_units_at_the_doors_of_a_puck():
    rng = np.random.default_rng(31)
    puck = pt.Puck(radius=0.04, friction=0.1)
    for _ in range(5):
        v, w = rng.uniform(1.0, 9.0), rng.uniform(10.0, 900.0)
        plain = puck.stop((v / 3.6, 0.0), w * math.pi / 30.0)
        written = puck.stop((f"{v!r} km/h", 0), f"{w!r} rpm")
        assert written.stop_time == pytest.approx(plain.stop_time, rel=1e-14)
    with pytest.raises(InputError, match="unit"):
        puck.stop(("2 km/h", 1), 0.0)
    with pytest.raises(InputError, match=r"seconds|spin"):
        puck.stop((1.0, 0.0), "3 s")


@pytest.mark.parametrize("text", ["40Mm", "40mM", "3 Ms"])
def test_capitals_that_say_another_unit_are_refused(text: str):
    with pytest.raises(InputError, match=r"unit|megametre"):
        pt.Puck(radius=text, friction=0.1)


def test_grads_are_no_degrees():
    with pytest.raises(InputError, match="gradian"):
        Scene(pt.Puck(0.03), pt.Floor(slope="5Grad"))
