"""Walls with ends elsewhere: in files, messages, hands of a game, sweeps, aims and pictures."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from commands import invoke

import puck_tables as pt
from puck_tables.plot.animation import film_of
from puck_tables.scene.library import find_scene

BOARD = """
time = 2.0

[[puck]]
radius = 0.05
friction = 0.1
[puck.launch]
velocity = [-2.0, 0.1]

[[wall]]
start = [-0.5, -0.3]
end = [-0.5, 0.3]
restitution = 0.8

[[wall]]
corners = "island.csv"
restitution = "plastic:0.2"

[[wall]]
point = [1.0, 0.0]
normal = [-1.0, 0.0]
"""
ISLAND = "x (mm),y (mm)\n300,-200\n500,-200\n500,200\n300,200\n"


@pytest.fixture
def board(tmp_path: Path) -> Path:
    (tmp_path / "island.csv").write_text(ISLAND)
    file = tmp_path / "board.toml"
    file.write_text(BOARD)
    return file


def test_a_file_says_the_same_as_python(board: Path) -> None:
    told = pt.Scene.load(board)
    said = pt.Scene(
        pucks=[pt.Puck(0.05, friction=0.1, launch=pt.Launch((-2.0, 0.1)))],
        walls=[
            pt.Wall((-0.5, -0.3), (-0.5, 0.3), restitution=0.8),
            pt.Wall(corners=[[0.3, -0.2], [0.5, -0.2], [0.5, 0.2], [0.3, 0.2]],
                    restitution="plastic:0.2"),
            pt.Wall((1.0, 0.0), normal=(-1.0, 0.0)),
        ],
        time=2.0,
    )  # fmt: skip
    one, two = told.simulate(), said.simulate()
    assert one.last["x"].tobytes() == two.last["x"].tobytes()
    assert [event.partner for event in one.events][:2] == ["wall 0", "wall 1"]
    again = pt.Scene.from_tables(_toml(said))
    assert again.walls == said.walls and again == said


def _toml(scene: pt.Scene) -> dict[str, Any]:
    import tomllib

    from puck_tables.scene.library import as_toml

    return tomllib.loads(as_toml(scene))


def test_the_command_runs_sweeps_and_draws_it(board: Path, tmp_path: Path) -> None:
    run = invoke("simulate", "--scene", board, "--explain")
    assert run.exit_code == 0 and "3 walls" in run.output
    args = ["sweep", "--scene", str(board), "--set", 'wall[0].end[1]="0.0:0.4:9"', "-o",
            str(tmp_path / "ends.csv")]  # fmt: skip
    sweep = invoke(*args)
    assert sweep.exit_code == 0, sweep.output
    with open(tmp_path / "ends.csv") as file:
        ends = [float(row["x[m]"]) for row in csv.DictReader(file)]
    assert len(ends) == 9 and len(set(ends)) >= 2  # the end itself, and the side


@pytest.mark.parametrize(
    ("wall", "why"),
    [
        ({"start": [0, 1]}, "give a point with the normal into the field, a start and an end"),
        ({"point": [0, 1], "end": [1, 1]}, "give a point with the normal into the field"),
        ({"start": [0, 1], "end": [0, 1]}, r"end = \(0.0, 1.0\): must lie elsewhere"),
        ({"start": [0, 1], "end": [1, 1], "corners": [[0, 0], [1, 0], [0, 1]]}, "give a point"),
        ({"corners": [[0, 0], [1, 0]]}, "corners must be from 3 to 200 rows of x and y, got 2"),
        ({"corners": [[0, 0], [1, 1], [1, 0], [0, 1]]}, "the edges from corners 0 and 2 meet"),
        ({"corners": "nowhere.csv"}, "cannot read nowhere.csv"),
        ({"start": [0, 0.02], "end": [1, 0.02]}, "reaches through it by 0.03 m: move one of them"),
        ({"start": [-0.9, 0.01], "end": [-0.03, 0.01]}, r"reaches through it by 0.0184 m"),
        ({"corners": [[0.02, 0.02], [1, 0.02], [1, 1]]}, "reaches through it by 0.0217 m"),
        ({"start": [0, math.nan], "end": [1, 0]}, "must be a number in m"),
    ],
)
def test_what_is_no_wall_is_refused(wall: dict[str, Any], why: str) -> None:
    with pytest.raises(pt.InputError, match=rf"wall\[0\].*{why}"):
        pt.Scene.from_tables({"puck": {"radius": 0.05, "friction": 0.1}, "wall": [wall]})


def test_a_mallet_is_not_driven_through_it() -> None:
    puck = pt.Puck(0.03, friction=0.1, launch=pt.Launch(position=(0.0, 1.0)))
    wall = pt.Wall((0.3, -0.2), (0.3, 0.2))
    through = pt.Puck(0.05, path=[[0, 0, 0], [1, 0.6, 0.1], [2, 0.6, 0.4]])
    with pytest.raises(pt.InputError, match=re.escape("wall[0]: puck 1 is driven through it")):
        pt.Scene(pucks=[puck, through], walls=[wall], time=3.0)
    around = pt.Puck(0.05, path=[[0, 0, 0], [1, 0.3, 0.28], [2, 0.6, 0.0]])
    pt.Scene(pucks=[puck, around], walls=[wall], time=3.0).simulate()


def game() -> Any:
    """A mallet below a wall that ends on its right, and a disc."""
    mallet = pt.Puck(0.05, path=[[0, 0.0, -0.3]], name="mallet")
    disc = pt.Puck(0.03, friction=0.1, name="disc", launch=pt.Launch(position=(0.0, 0.5)))
    return pt.Scene(pucks=[mallet, disc], walls=[pt.Wall((-0.2, 0.0), (0.2, 0.0))]).world()


@pytest.mark.parametrize(
    ("x", "stops"),
    [(0.0, -0.05), (0.19, -0.05), (0.22, -math.sqrt(0.05**2 - 0.02**2)), (0.26, 0.3)],
)
def test_a_hand_stops_at_it(x: float, stops: float) -> None:
    world = game()
    world.drive("mallet", towards=(x, -0.3), speed=1.0)
    world.advance(1.0)
    world.drive("mallet", towards=(x, 0.3), speed=1.0)
    world.advance(2.0)
    assert world.state()[0, :2] == pytest.approx([x, stops], abs=1e-9)


def test_nothing_is_put_into_it() -> None:
    world = game()
    for place in ((0.1, 0.02), (0.1, -0.02), (0.21, 0.01), (-0.22, -0.02)):
        with pytest.raises(pt.InputError, match=r"disc would reach through wall 0 by 0\.0"):
            world.place("disc", place)
    for place in ((0.1, 0.0301), (0.1, -0.0301), (0.2301, 0.0), (-0.22, -0.023)):
        world.place("disc", place)
    assert [event.what for event in world.events_since(0.0)] == ["placed"] * 4


def test_a_rim_law_of_a_wall_is_that_of_its_ends() -> None:
    def off_the_end(**how: Any) -> Any:
        puck = pt.Puck(
            0.05, friction=0.1, name="puck", launch=pt.Launch((0, -1), position=(0.42, 0.5))
        )
        return pt.Scene(
            pucks=[puck], walls=[pt.Wall((0.0, 0.0), (0.4, 0.0), restitution=0.9)], **how
        ).simulate()  # fmt: skip

    rim = pt.Rim("puck", "wall 0", restitution=0.3)
    shots = off_the_end(), off_the_end(rims=[rim])
    lost = [run.events[0].lost / (0.5 * run.events[0].approach ** 2) for run in shots]
    assert lost == pytest.approx([1.0 - 0.9**2, 1.0 - 0.3**2], rel=1e-9)


def test_an_aim_goes_around_the_end_and_off_it() -> None:
    cue = pt.Puck(0.03, friction=0.1, name="cue")
    wall = pt.Wall((0.3, -0.1), (0.3, 0.1), restitution=0.8)
    cushion = pt.Wall((0.0, 0.4), (0.8, 0.4), restitution=0.8)
    found = pt.Scene(pucks=[cue], walls=[wall, cushion]).aim(
        (0.6, 0.0), striker="cue", max_speed=3.0
    )
    assert "cue - wall 1" in found.sequences and bool((found.miss < 1e-9).all())
    assert "cue" not in found.sequences  # straight it does not get there


def test_pictures_and_movies_show_all_of_it(board: Path, tmp_path: Path) -> None:
    run = pt.Scene.load(board).simulate()
    film = film_of(run)
    assert [line.kind for line in film.lines].count("wall") == 6
    assert film.box.right > 0.5 and film.box.high > 0.3  # also what no puck comes near
    run.plot(str(tmp_path / "run.png"))
    run.movie(str(tmp_path / "run.html"))
    page = (tmp_path / "run.html").read_text()
    assert json.dumps([-0.5, -0.5])[1:-1].replace(" ", "") in page.replace(" ", "")
    one = dict(find_scene("air-hockey"), wall=[{"start": [0.2, 0.0], "end": [0.2, 1.0]}])
    lone = pt.Scene.from_tables(one).simulate()
    lone.plot(str(tmp_path / "lone.png"))
    assert (tmp_path / "lone.png").stat().st_size > 10_000
