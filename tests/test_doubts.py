"""Numbers of a doubtful size are questioned at every door, once, and what has a unit is not."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from puck_tables.cli.options import PUCK_NUMBERS
from puck_tables.cli.simulate import simulate

import puck_tables as pt
from puck_tables import Scene
from puck_tables._core import own_folder
from puck_tables._core.fields import specs
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
    pt.export_source("js", "state", tol=1e-2)
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


BASES = ("box:20x10", "disc:40", "polygon:0,0;20,0;0,10", "feet:1;50,0;-50,50;-50,-50")


@pytest.mark.parametrize("base", [*BASES, pt.Base.box(40.0, 10.0)])
def test_a_base_in_centimetres_is(base: str | pt.Base, capsys: pytest.CaptureFixture[str]):
    pt.Puck(base="box:20cmx10cm", friction=0.1)
    pt.Puck(base=pt.Base.box(0.4, 0.1), friction=0.1)
    pt.Puck(base="polygon:0,0;2000cm,0;0,1000cm", friction=0.1)  # said to be so large
    assert capsys.readouterr().err == ""
    pt.Puck(base=base, friction=0.1)
    said = capsys.readouterr().err
    assert said.startswith("a base beyond 10 m: lengths are in metres") and said.count("\n") == 1


def test_a_base_in_a_file_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for n, (head, factor) in enumerate((("x [mm],y [mm]", 1.0), ("x,y", 1.0), ("x,y", 1e-3))):
        rows = [f"{factor * x},{factor * y}" for x, y in ((0, 0), (90, 0), (0, 60))]
        (tmp_path / f"{n}.csv").write_text("\n".join([head, *rows]))
        pt.Puck(base=str(tmp_path / f"{n}.csv"), friction=0.1)
        assert ("metres" in capsys.readouterr().err) == (n == 1)


@pytest.mark.parametrize(("command", "words"), [
    ("simulate --v0 1,0 --base box:20x10", "a base beyond 10 m"),
    ("simulate --v0 1,0 --radius 32", "a radius beyond 10 m"),
    ("simulate --v0 1,0 --radius 32 --height 10 --friction 0.3", "a radius beyond 10 m"),
    ("simulate --v0 1000,0", "a v0 beyond 300 m/s"),
    ("simulate --scene incline --radius 40", "a radius beyond 10 m"),
    ("sweep --radius 30:40:3 --speed 1", "a radius beyond 10 m"),
    ("sweep --speed 1 --heading 90", "a heading beyond 6.283 rad"),
    ("aim --target 2,0 --w0 0 --radius 32", "a radius beyond 10 m"),
    ("limit-surface --base box:20x10", "a base beyond 10 m"),
])  # fmt: skip
def test_commands_ask_once_for_another_unit(command: str, words: str):
    result = invoke(*command.split())
    assert result.exit_code == 0 and result.stderr.count(words) == 1, result.stderr


@pytest.mark.parametrize("command", [
    "simulate --v0 500m/s,0 --radius 32m --height 12m --friction 0.1 --mass 200kg",
    "simulate --scene incline --radius 40m", "sweep --radius 30m:40m:3 --speed 1",
    "sweep --scene incline --set launch.orientation=0deg:720deg:2",
    "aim --target 300m,0 --w0 0 --radius 32m",
])  # fmt: skip
def test_commands_ask_of_nothing_that_has_its_unit(command: str):
    result = invoke(*command.split())
    assert result.exit_code == 0 and "beyond" not in result.stderr, result.stderr


@pytest.mark.parametrize("name", PUCK_NUMBERS)
def test_options_of_a_puck_have_the_units_of_its_fields(name: str):
    option = next(one for one in simulate.params if one.name == name)
    kind = specs(pt.Puck)[name].metadata["kind"]
    assert (option.type.unit, option.type.usual) == (kind.unit, kind.usual)


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


def test_wrong_usage_is_said_alone():
    ended = invoke("simulate", "--mass", "2e48")
    assert ended.exit_code == 2 and "Missing option '--v0'" in ended.stderr
    assert "beyond" not in ended.stderr
