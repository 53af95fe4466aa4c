"""``puck track`` as a person types it: what it says, writes, draws and refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from commands import invoke
from numpy.testing import assert_array_equal

from puck_tables import read_tracks
from puck_tables.film.film import Track
from puck_tables.film.report import described


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    time = np.arange(40) / 20.0
    rows = [f"{t!r},{100 * t!r},{5 * t * t!r},{400 * t % 360!r}" for t in time.tolist()]
    rows[7] = rows[7].split(",")[0] + ",,,"
    rows[20] = "1.004,100.4,5.04,41.6"
    Path("a.csv").write_text("t [s],x [cm],y [cm],angle [deg]\n" + "\n".join(rows))
    Path("b.csv").write_text("frame,red_x,red_y,blue_x,blue_y\n0,1,2,3,4\n1,2,2,4,4\n2,3,2,5,4\n")
    return tmp_path


def puck(*arguments: str) -> Result:
    return invoke("track", *arguments)


def test_it_says_what_was_read():
    result = puck("a.csv")
    assert result.exit_code == 0
    for words in (
        "a.csv\n", "40 from 0 s to 1.95 s, 20 a second; the puck is seen in 39 (97.5 %)",
        "x from 0 m to 1.95 m, y from 0 m to 0.190125 m", "seen in 39 frames",
        "1 frame in 1 stretch, the longest from 0.35 s to 0.35 s", "vary by", "places in cm",
    ):  # fmt: skip
        assert words in result.stdout, words


def test_several_files_and_pucks_with_one_set_of_options():
    result = puck("b.csv", "b.csv", "--fps", "10", "--scale", "1mm", "--pucks", "red")
    assert result.exit_code == 0
    assert result.stdout.count("b.csv: red\n") == 2
    assert "blue" not in result.stdout
    assert "y grows downwards" in result.stdout
    up = puck("b.csv", "--fps", "10", "--scale", "1mm", "--y-up")
    assert "downwards" not in up.stdout
    assert "y from 0.002 m" in up.stdout


def test_what_is_saved_is_read_back_bit_by_bit():
    assert puck("a.csv", "b.csv", "--fps", "10", "--unit", "cm", "-o", "o.csv").exit_code == 2
    assert puck("a.csv", "-o", "one.csv").exit_code == 0
    assert Path("one.csv").read_text().startswith("time[s],x[m],y[m],orientation[rad]\n")
    for before, after in zip(read_tracks("a.csv"), read_tracks("one.csv"), strict=True):
        assert_array_equal(before.time, after.time)
        assert_array_equal(before.place, after.place)
        assert_array_equal(before.angle, after.angle)
    how = ("--fps", "10", "--unit", "cm")
    assert puck("b.csv", *how, "-o", "two.csv").exit_code == 0
    for before, after in zip(
        read_tracks("b.csv", fps=10, unit="cm"), read_tracks("two.csv"), strict=True
    ):
        assert after.name == f"two.csv: {before.name}"
        assert_array_equal(before.place, after.place)


@pytest.mark.parametrize("ending", ["h5", "json", "jsonl"])
def test_every_format_that_is_saved_is_read_back(ending):
    how = ("--fps", "10", "--unit", "cm")
    said = {"unit": "m", "angle_unit": "rad"} if ending == "jsonl" else {}
    for name, given in (("a.csv", ()), ("b.csv", how)):
        assert puck(name, *given, "-o", f"saved.{ending}", "--overwrite").exit_code == 0
        assert puck(name, *given, "-o", "saved.csv", "--overwrite").exit_code == 0
        before, after = read_tracks("saved.csv"), read_tracks(f"saved.{ending}", **said)
        for one, other in zip(before, after, strict=True):
            assert other.name == one.name.replace(".csv", f".{ending}", 1)
            assert_array_equal(one.time, other.time)
            assert_array_equal(one.place, other.place)
            assert (one.angle is None) is (other.angle is None)
            if one.angle is not None:
                assert_array_equal(one.angle, other.angle)
    if ending == "jsonl":
        assert "does not say the unit" in puck("saved.jsonl").stderr
    assert "has 4 columns" in puck(f"saved.{ending}", "--columns", "t,x,y").stderr
    assert puck(f"saved.{ending}", "--columns", "id,t [s],x [m],y [m]").exit_code == 0


def test_the_picture_is_drawn():
    for arguments in (["a.csv", "--plot", "a.png"],
                      ["b.csv", "--unit", "m", "--fps", "9", "--plot", "b.svg"]):  # fmt: skip
        assert puck(*arguments).exit_code == 0
        assert Path(arguments[-1]).stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["b.csv"], 2, "give unit (--unit cm)"), (["b.csv", "--unit", "cm"], 2, "--fps"),
        (["b.csv", "--unit", "cms", "--fps", "9"], 2, "did you mean 'cm'"),
        (["no.csv"], 2, "No such"), (["."], 2, "regular file"),
        (["a.csv", "--fps", "x"], 2, "'x' is not a number"),
        (["a.csv", "-o", "a.csv", "--overwrite"], 2, "read by this command"),
        (["a.csv", "-o", "o.txt"], 2, "ending"), (["a.csv", "--plot", "o.doc"], 2, "ending"),
        (["a.csv", "-o", "b.csv"], 1, "exists already"), ([], 2, "Missing argument"),
        (["a.csv", "--marks", "no.csv"], 2, "no.csv"), (["a.csv", "--scale", "0mm"], 2, "scale"),
    ],
)  # fmt: skip
def test_what_is_refused_costs_nothing(arguments: list[str], code: int, words: str):
    before = {path.name: path.read_bytes() for path in Path().iterdir()}
    result = puck(*arguments)
    assert result.exit_code == code, result.output
    assert words in result.stderr
    assert "Traceback" not in result.output
    assert result.stdout == ""
    assert {path.name: path.read_bytes() for path in Path().iterdir()} == before


def test_control_characters_in_a_file_never_reach_the_terminal():
    Path("c.csv").write_text("t,x_\x1b[31m,y_\x1b[31m\n0,1,2\n1,2,3\n")
    assert "\x1b" not in puck("c.csv", "--unit", "m").output


def test_a_mark_where_none_has_a_name():
    Path("t.csv").write_text("t [s],x [m],y [m]\n0,1,2\n1,2,3\n")
    result = puck("t.csv", "--centre", "red")
    assert "t.csv has no mark 'red'. Its marks: none with a name" in result.output


def test_gaps_and_leaps_are_named():
    time = np.concatenate([np.arange(20), np.arange(30, 50)]) / 100.0
    place = np.column_stack([time, np.zeros(40)])
    place[33] = [-1.0, -1.0]
    words = "\n".join(described(Track(time, place)))
    assert "1 gap in its times, the longest of 0.11 s after 0.19 s" in words
    assert "2 leaps" in words
    quiet = "\n".join(described(Track(np.arange(40) / 100.0, np.zeros((40, 2)))))
    assert "odd" not in quiet


@pytest.mark.parametrize("turns", [0.05, 0.4])  # a frame
def test_marks_that_are_taken_for_each_other_are_named(turns: float):
    time = np.arange(40) / 100.0
    place, angle = np.column_stack([time, 0.0 * time]), 2.0 * np.pi * turns * np.arange(40)
    assert "marks" not in "\n".join(described(Track(time, place, angle)))
    angle[[4, 20, 21]] += np.pi
    words = "\n".join(described(Track(time, place, angle)))
    assert ("1 angle half a turn off those beside, the first at 0.04 s" in words) == (turns < 0.1)
