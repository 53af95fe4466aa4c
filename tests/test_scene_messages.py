"""What scenes say when they refuse: true, in a sentence, and nothing a terminal would obey."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from click.testing import Result
from commands import invoke
from scenes import simulate_scene

from puck_tables.errors import InputError
from puck_tables.scene.library import find_scene

HEAD = "[puck]\nradius = 0.04\nmass = 0.2\nfriction = 0.2\n[launch]\nvelocity = [1.0, 0.0]\n"


def puck(*arguments: str) -> Result:
    result = invoke(*arguments)
    assert "Traceback" not in result.stderr
    assert all(sign.isprintable() or sign == "\n" for sign in result.stdout + result.stderr)
    return result


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"[puck]\nradius = " + b"1" * 5000, "a number in it has thousands of digits"),
        (b"[launch]\nvelocity = [0x" + b"f" * 5000 + b", 1]", "launch.velocity[0] = a whole numb"),
        (b"a = " + b"[" * 5000, "nested too deeply"),
        (b'title = "\xff"', "is not text in UTF-8: see its byte 9"),
        (b'title = "\\u001b[2J"\n[puck]\nradius = 1', "title = '\\x1b[2J': must be"),
        (b'[puck]\nradius = 1\n"\\u009b2J" = 1', "puck.'\\x9b2J': no such entry"),
    ],
)
def test_a_scene_file_that_is_none(text: bytes, said: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_bytes(text)
    for command in (("scene", "check"), ("simulate", "--scene"), ("sweep", "--scene")):
        result = puck(*command, str(file))
        assert result.exit_code == 2
        assert said in result.stderr


@pytest.mark.parametrize(
    "change", ["title='a\udcff'", 'title="a\\nb"', 'title="\\u0000"', f"launch.spin=0x{'f' * 5000}"]
)
def test_a_change_that_is_none(change: str) -> None:
    assert puck("simulate", "--scene", "incline", "--set", change).exit_code == 2


def test_a_title_is_any_line_of_text(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(f"title = '$x_1^{{ ünïcode \N{SNOWMAN} a\N{NO-BREAK SPACE}b'\n{HEAD}")
    outputs = ("-o", str(tmp_path / "run.h5"), "--plot", str(tmp_path / "run.png"))
    assert puck("simulate", "--scene", str(file), *outputs).exit_code == 0


def test_a_field_of_a_csv_file_that_is_too_long(tmp_path: Path) -> None:
    file = tmp_path / "wide.csv"
    heads = {"force.over_time": "t,Fx", "floor.law": "v,f", "puck.pressure": "rho,W"}
    for entry, head in heads.items():
        file.write_text(f"{head},Fy\n0," + "1" * 200_000 + ",0\n1,0,0\n")
        result = puck("simulate", "--v0", "1,0", "--set", f"{entry}={file}")
        assert result.exit_code == 2
        assert "is too large a number" in result.stderr
        assert len(result.stderr) < 500


def test_a_puck_that_rests_does_not_still_move(tmp_path: Path) -> None:
    force = tmp_path / "force.csv"
    force.write_text("t,Fx,Fy\n0,0.3,0\n0.5,0,0\n1e6,0,0\n")
    scene = tmp_path / "scene.toml"
    scene.write_text(HEAD + '[force]\nover_time = "force.csv"\n')
    assert "at rest after 0.70105" in puck("simulate", "--scene", str(scene)).stdout
    with pytest.raises(InputError, match="still moves after"):
        simulate_scene({"puck": {"radius": 1.0, "friction": 0.1}, "floor": {"slope": 0.3}})


def test_what_cannot_be_read_is_no_result_that_cannot_be_written() -> None:
    for name in ("a" * 5000, "a\0b"):
        with pytest.raises(InputError, match=r"^cannot read a"):
            find_scene(name)
    result = puck("scene", "check", "a" * 5000)
    assert result.exit_code == 2 and "File name too long" in result.stderr


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root may read all")
def test_a_folder_that_may_not_be_entered(tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0)
    with pytest.raises(InputError, match=r"^cannot read"):
        find_scene(str(closed / "scene.toml"))


def test_events_name_where_they_happen() -> None:
    said = invoke("simulate", "--scene", "wet-patch").stdout
    assert "entry (border 0) at " in said and "stick (strip 2) at " in said
    assert "J given by launches" in said and "-0 J" not in said
