"""``puck aim --scene``: reports, files, pictures, and what is refused."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from commands import invoke

from puck_tables import Edge, Launch, Post, Puck, Scene
from puck_tables.world import aimed, targets

CURLING = ("--scene", "curling-take-out", "--puck", "yellow", "--target", "0.5,-0.5")
BOX = ("--base", "box:20cmx10cm", "--friction", "0.3")


def aim(*arguments: str) -> Result:
    return invoke("aim", *arguments)


def test_a_take_out_is_reported_saved_and_drawn(tmp_path: Path) -> None:
    table, picture = tmp_path / "aim.csv", tmp_path / "aim.png"
    shown = aim(*CURLING, "-o", str(table), "--plot", str(picture))
    assert shown.exit_code == 0, shown.stderr
    assert "wanted   yellow at (0.5, -0.5) m, red sent off up to" in shown.stdout
    assert "1 launch up to" in shown.stdout and shown.stdout.rstrip().endswith("red - yellow")
    assert picture.read_bytes().startswith(b"\x89PNG")
    (row,) = csv.DictReader(table.read_text().splitlines())
    assert row["sequence"] == "red - yellow" and float(row["miss[m]"]) < 1e-8
    launch = [float(row["launch_vx[m/s]"]), float(row["launch_vy[m/s]"])]
    run = Scene.load("curling-take-out").at({"puck[0].launch.velocity": launch}).simulate()
    ended = run["yellow"]["x"][-1], run["yellow"]["y"][-1]
    assert math.dist(ended, (0.5, -0.5)) < 1e-7


def test_json_carries_units_and_the_scene() -> None:
    told = json.loads(aim(*CURLING, "--json", "--count", "1").stdout)
    assert told["target"] == [0.5, -0.5] and told["puck"] == "yellow"
    assert told["units"]["per_degree"] == "m" and told["sequences"] == ["red - yellow"]
    assert told["scene"]["puck"][0]["name"] == "red"


def test_none_found_is_an_answer_without_a_picture(tmp_path: Path) -> None:
    picture = tmp_path / "none.png"
    told = aim(*CURLING, "--max-speed", "2.4", "--plot", str(picture))
    assert told.exit_code == 0 and "no launch up to 2.4 m/s" in told.stdout
    assert "not proved" in told.stdout and not picture.exists()
    told = aim(*CURLING, "--max-speed", "1.5")
    assert told.exit_code == 0 and "at -1.6 rad/s exists: friction takes" in told.stdout


def test_odds_are_those_of_the_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[Any, ...]] = []  # what the library computes once, and the command asks for

    def answered(*given: Any) -> Any:
        asked.append(given[2:])
        return targets.odds_of(*given[:-2], 60, given[-1]) if len(asked) == 1 else odds

    monkeypatch.setattr(aimed, "odds_of", answered)
    monkeypatch.setattr(targets, "_TRIED", 60)
    board = Scene(pucks=[Puck(0.03, friction=0.1)], edges=[Edge((0.82, 0.0), normal=(-1, 0))])
    (tmp_path / "table.toml").write_text(
        "[[puck]]\nradius = 0.03\nfriction = 0.1\n"
        "[[edge]]\npoint = [0.82, 0.0]\nnormal = [-1.0, 0.0]\n"
    )
    words = ("--scene", str(tmp_path / "table.toml"), "--target", "0.8,0", "--w0", "0",
             "--odds", "speed=0.05", "--odds", "heading=1deg", "--within", "10cm")  # fmt: skip
    found = board.aim((0.8, 0.0), spin=0.0)
    odds = found.odds(speed=0.05, heading=math.radians(1.0), within=0.1)
    told = json.loads(aim(*words, "--json").stdout)["odds"]
    assert told["nominal"] == odds.nominal._asdict() and told["best"] == odds.best._asdict()
    assert told["velocity"] == list(odds.velocity)
    said = aim(*words).stdout.rstrip().splitlines()[-2:]
    for given in asked[1:]:
        assert all(np.array_equal(one, other) for one, other in zip(given, asked[0], strict=True))
    assert len(asked) == 3 and said == str(odds).splitlines()
    assert said[0].startswith("scattered so, the launch does it with a chance of 0.")
    assert said[1].startswith(f"the best aim found, {math.hypot(*odds.velocity):.6g} m/s, heading")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((*CURLING, "--odds", "heading=1deg"), "--within, how near the puck is to end, is for"),
        ((*CURLING, "--within", "1cm"), "--within, how near the puck is to end, is for"),
        ((*CURLING, "--odds", "mass=1", "--within", "1cm"), "give heading, speed, w0"),
        ((*CURLING, "--odds", "speed=fast", "--within", "1cm"), "--odds speed must be a number"),
        (("--target", "2,0.1", "--odds", "speed=0.1"), "--odds is for a board"),
        ((*CURLING, "--target", "1,0"), "--target is given 2 times"),
        ((*CURLING, "--pocket", "0"), "both are given"),
        (("--scene", "curling-take-out", "--pocket", "0"), "puck: which is to end there?"),
        (("--scene", "curling-take-out", "--puck", "yellow", "--pocket", "0"), "has none"),
        ((*CURLING[:2], "--puck", "yelow", "--target", "1,0"), "did you mean 'yellow'"),
        ((*CURLING, "--time", "3"), "--time has no place in a scene"),
        ((*CURLING, "--delta", "1"), "--delta has no place in a scene"),
        ((*CURLING, "-o", "aim.txt"), ".csv"),
        (("--scene", "curling-take-ou", "--target", "1,0"), "curling-take-out"),
        (("--target", "2,0.1", "--puck", "red"), "--puck is for a board"),
        (("--target", "2,0.1", "--target", "2,0.2"), "--target is given 2 times"),
        ((), "Missing option '--target'"),
        ((*BOX, "--target", "1,0", "--time", "2"), "--time has no place with --base"),
        ((*BOX[:2], "--target", "1,0", "--delta", "1"), "--delta is of round pucks"),
        (BOX, "target"),
    ],
)
def test_refusals_are_one_sentence(arguments: tuple[str, ...], words: str) -> None:
    ended = aim(*arguments)
    assert ended.exit_code == 2 and words in ended.stderr
    assert "Traceback" not in ended.stderr and ended.stdout == ""


def test_a_box_that_cannot_get_there_is_told_so() -> None:
    told = aim(*BOX, "--target", "5,0", "--max-speed", "1")
    assert told.exit_code == 0 and told.stdout.startswith("puck    base box:0.2x0.1, k = 0.06454")
    assert "(5, 0) m\nanswer  no launch up to 1 m/s without spin exists: friction" in told.stdout


@pytest.mark.parametrize("more", [{}, {"height": 0.05}, {"gyration": 0.08}])
def test_a_box_stops_where_it_was_aimed(more: dict[str, float]) -> None:
    """By the engine of boards, which the search does not use."""
    flags = [text for name, value in more.items() for text in (f"--{name}", str(value))]
    told = json.loads(aim(*BOX, *flags, "--target", "0.5,0.1", "--w0", "10", "--json").stdout)
    ((speed,), (heading,)) = told["launch_speed"], told["launch_heading"]
    puck = Puck(base="box:0.2x0.1", friction=0.3, **more)
    launch = Launch((speed * math.cos(heading), speed * math.sin(heading)), 10.0)
    last = Scene(puck, launch=launch, tol=1e-9).simulate().last_of(0)
    assert math.dist((last["x"], last["y"]), (0.5, 0.1)) < 1e-8
    assert abs(heading - math.atan2(0.1, 0.5)) > 1e-5  # it bends


@pytest.mark.thorough
def test_a_box_is_aimed_as_on_a_board_with_a_post_far_away() -> None:
    """From another place, turned: there every launch runs on the board."""
    puck = Puck(base="box:0.2x0.1", friction=0.3, radius=0.12)
    start = Launch(spin=8.0, position=(0.1, -0.2), orientation=0.7)
    free, board = (
        Scene(puck, launch=start, posts=posts).aim((0.6, 0.1))
        for posts in ((), (Post((50.0, 0.0), 0.01),))
    )
    assert len(free) == len(board) == 1
    assert free.launch_vx[0] == pytest.approx(board.launch_vx[0], abs=1e-7)
    assert free.launch_vy[0] == pytest.approx(board.launch_vy[0], abs=1e-7)
