"""No entry of a scene is dropped, in reading, planning, running or writing."""

from __future__ import annotations

import copy
import pickle
import re
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene

from puck_tables import Puck
from puck_tables._core.fields import described, of
from puck_tables.errors import InputError, PuckError
from puck_tables.scene import parts
from puck_tables.scene.entries import set_path, tables_of
from puck_tables.scene.library import as_toml, shipped_scenes
from puck_tables.world.plan import plan_of
from puck_tables.world.scene import Scene

FREE: dict[str, Any] = {
    "puck": {"radius": 0.04, "height": 0.03, "mass": 0.2, "friction": 0.2},
    "launch": {"velocity": [0.8, 0.3], "spin": 30.0},
}
MOVING = {"floor": {"turning": 2.0, "centre": [0.1, 0.2]}, "time": 0.5}
GRAINED = {"floor": {"orthotropic": {"friction": [0.2, 0.3]}}}
STRIBECK = {"kind": "stribeck", "static": 0.3, "kinetic": 0.1, "speed": 0.2}
BY_NAME = {"floor": {"law": STRIBECK}, "tol": 1e-5}
BY_CURLING = {"floor": {"law": {"kind": "curling", "a": 0.01, "b": 0.1}}, "tol": 1e-5}
BY_POWER = {
    "floor": {"law": {"kind": "power", "a": 0.1, "exponent": 1.0, "b": 0.1}}, "tol": 1e-5,
}  # fmt: skip
BY_BOTH = {
    kind: {"floor": {"orthotropic": {"friction": [1.0, 0.5], "law": law["floor"]["law"]}},
           "tol": 1e-5}
    for kind, law in (("stribeck", BY_NAME), ("curling", BY_CURLING), ("power", BY_POWER))
}  # fmt: skip
STRIPS = {"floor": {"strips": {"borders": [0.03], "friction": [0.2, 0.1]}}}
ROUND = {"floor": {"patch": [{"friction": 0.1, "centre": [0.15, 0.05], "radius": 0.05}]}}
POLYGON = {"floor": {"patch": [
    {"friction": 0.1, "corners": [[0.06, -0.1], [0.2, -0.1], [0.1, 0.2]]},
]}}  # fmt: skip
WET = {"floor": {**STRIPS["floor"], "grip": [
    {"over_time": [[0.0, 1.0], [0.1, 0.5]], "where": "strip 0"},
]}}  # fmt: skip
BELTS = {"floor": {"strips": {
    "borders": [0.03], "friction": [0.2, 0.1], "across": [0.1, -0.2], "along": [0.3, 0.0],
}}, "time": 0.5}  # fmt: skip
WALL = {"wall": [{"point": [0.1, 0.0], "normal": [-1.0, 0.1], "tangential": 0.2}]}
PIECE = {"wall": [{"start": [0.1, -0.1], "end": [0.1, 0.1]}]}
ISLAND = {"wall": [{"corners": [[0.1, -0.1], [0.2, -0.1], [0.1, 0.1]]}]}
EDGE = {"edge": [{"point": [0.05, 0.0], "normal": [-1.0, 0.0]}]}
HELD = {"launch": {"velocity": None}, "time": 0.5}
RAIL = {**HELD, "constraint": {"kind": "rail", "velocity": [0.0, 0.1]}}
PIVOT = {**HELD, "constraint": {"kind": "pivot", "reach": 0.02}}
BLADE = {**HELD, "constraint": {"kind": "blade"}, "launch": {"velocity": [0.8, 0.0]}}

# a scene in which an entry matters, and another value for it
CASES: dict[str, tuple[dict[str, Any], Any]] = {
    "puck.radius": ({}, 0.05), "puck.height": ({}, 0.01), "puck.mass": ({}, 0.3),
    "puck.gyration": ({}, 0.9), "puck.pressure": ({}, "ring"), "puck.friction": ({}, 0.3),
    "puck.gravity": ({}, 3.7), "gravity": ({}, 3.7), "floor.slope": ({}, 0.1),
    "floor.static_ratio": ({**HELD, "floor": {"slope": 0.25}}, 1.5),
    "floor.downhill": ({"floor": {"slope": 0.1}}, 1.0), "floor.velocity": ({}, [0.1, 0.2]),
    "floor.turning": (MOVING, 1.0), "floor.centre": (MOVING, [0.3, 0.2]),
    "floor.strips.borders": (STRIPS, [0.06]), "floor.strips.friction": (STRIPS, [0.2, 0.3]),
    "floor.strips.direction": (STRIPS, 1.0), "floor.strips.across": (BELTS, [0.1, 0.1]),
    "floor.strips.along": (BELTS, [0.1, 0.1]), "floor.patch[0].velocity": (ROUND, [0.0, 0.5]),
    "floor.patch[0].friction": (ROUND, 0.3), "floor.patch[0].centre": (ROUND, [0.3, 0.05]),
    "floor.patch[0].radius": (ROUND, 0.07),
    "floor.patch[0].corners": (POLYGON, [[0.05, -0.1], [0.2, -0.1], [0.1, 0.2]]),
    "floor.grip[0].over_time": (WET, [[0.0, 1.0], [0.1, 0.2]]),
    "floor.grip[0].where": (WET, "floor"), "floor.orthotropic.friction": (GRAINED, [0.2, 0.4]),
    "floor.orthotropic.direction": (GRAINED, 1.0), "floor.orthotropic.fixed_to": (GRAINED, "body"),
    "floor.law.static": (BY_NAME, 0.4), "floor.law.kinetic": (BY_NAME, 0.2),
    "floor.law.speed": (BY_NAME, 0.4), "floor.law.viscous": (BY_NAME, 0.1),
    "floor.law.a": (BY_CURLING, 0.02), "floor.law.b": (BY_CURLING, 0.2),
    "floor.law.c": (BY_CURLING, 0.1), "floor.law.exponent": (BY_POWER, 0.5),
    "floor.orthotropic.law.static": (BY_BOTH["stribeck"], 0.4),
    "floor.orthotropic.law.kinetic": (BY_BOTH["stribeck"], 0.2),
    "floor.orthotropic.law.speed": (BY_BOTH["stribeck"], 0.4),
    "floor.orthotropic.law.viscous": (BY_BOTH["stribeck"], 0.1),
    "floor.orthotropic.law.a": (BY_BOTH["curling"], 0.02),
    "floor.orthotropic.law.b": (BY_BOTH["curling"], 0.2),
    "floor.orthotropic.law.c": (BY_BOTH["curling"], 0.1),
    "floor.orthotropic.law.exponent": (BY_BOTH["power"], 0.5), "launch.velocity": ({}, [0.8, 0.4]),
    "launch.spin": ({}, 20.0), "launch.position": ({}, [1.0, 0.0]), "launch.orientation": ({}, 1.0),
    "drag.sliding": ({}, 0.1), "drag.quadratic": ({}, 0.1), "drag.spinning": ({}, 1e-4),
    "drag.spinning_quadratic": ({}, 1e-6), "lateral.strength": ({}, 0.1),
    "lateral.speed_exponent": ({"lateral": {"strength": 0.1}}, 0.5),
    "lateral.spin_exponent": ({"lateral": {"strength": 0.01}}, 1.0),
    "force.constant": ({}, [0.1, 0.0]), "force.torque": ({}, 1e-3),
    "wall[0].point": (WALL, [0.15, 0.0]), "wall[0].normal": (WALL, [-1.0, -0.1]),
    "wall[0].start": (PIECE, [0.12, -0.1]), "wall[0].end": (PIECE, [0.12, 0.1]),
    "wall[0].corners": (ISLAND, [[0.11, -0.1], [0.2, -0.1], [0.11, 0.1]]),
    "wall[0].restitution": (WALL, 0.5), "wall[0].tangential": (WALL, 0.5),
    "wall[0].friction": (WALL, 0.05), "edge[0].point": (EDGE, [0.04, 0.0]),
    "edge[0].normal": (EDGE, [-1.0, -1.0]), "edge[0].beyond": (EDGE, "floor"),
    "constraint.kind": (BLADE, "rail"),
    "constraint.angle": ({**BLADE, **HELD, "floor": {"slope": 0.1}}, 1.0),
    "constraint.reach": (PIVOT, 0.03), "constraint.velocity": (RAIL, [0.0, 0.3]),
    "constraint.side_slip": ({**BLADE, **HELD}, 0.1), "time": ({}, 0.1),
}  # fmt: skip
FILES = {
    "floor.law": ({"puck": {"friction": 0.0}}, "speed,f\n0,0.2\n5,0.1\n"),
    "floor.orthotropic.law": (GRAINED, "speed,f\n0,0.2\n5,0.1\n"),
    "floor.over_time": ({}, "t,vx,vy,spin\n0,0,0,0\n1,0.1,0,1\n2,0,0,0\n"),
    "force.over_time": ({}, "t,Fx,Fy\n0,0.1,0\n1,0,0\n"),
}
# a board on which every entry matters, and another value for each
ON_BOARD: dict[str, Any] = {
    "puck": [
        {"name": "a", "radius": 0.03, "friction": 0.2, "mass": 0.1, "height": 0.01,
         "tangential": 0.0, "rim": 0.3, "launch": {"velocity": [1.5, 0.02], "spin": 20.0}},
        {"name": "b", "radius": 0.03, "friction": 0.2, "mass": 0.1, "tangential": 0.0,
         "launch": {"position": [0.1, 0.01]}},
        {"name": "c", "radius": 0.03, "friction": 0.2,
         "launch": {"position": [0.0, 0.3], "velocity": [2.0, 0.0]}},
        {"radius": 0.03, "friction": 0.2,
         "launch": {"position": [0.0, -0.3], "velocity": [2.0, 0.0]}},
        {"radius": 0.03, "friction": 0.2, "launch": {"position": [1.0, 0.0], "velocity": [2.0, 0.3],
                                                     "spin": 20.0}},
    ],
    "post": [{"point": [0.2, 0.31], "radius": 0.02, "tangential": 0.0, "friction": 0.2}],
    "pocket": [{"point": [0.3, -0.3], "radius": 0.05}],
    "arc": [{"point": [1.0, 0.0], "radius": 0.3, "start": -2.0, "span": 4.0, "tangential": 0.0,
             "friction": 0.2}],
}  # fmt: skip
RIM = {"puck": "a", "partner": "b", "restitution": 0.9, "tangential": 0.1, "friction": 0.25}
BOARD: dict[str, Any] = {
    "launch.time": None, "puck[0].name": None, "puck[0].colour": None,
    "puck[0].radius": 0.025, "puck[0].height": 0.0, "puck[0].friction": 0.3, "puck[0].mass": 0.2,
    "puck[0].gravity": None, "puck[0].gyration": 0.9, "puck[0].pressure": "ring",
    "puck[0].launch.velocity": [1.4, 0.0], "puck[0].launch.spin": 10.0,
    "puck[0].launch.position": [0.005, 0.01], "puck[0].launch.orientation": 1.0,
    "puck[0].launch.time": 0.5, "puck[0].restitution": 0.5, "puck[0].tangential": -0.5,
    "puck[0].rim": 0.01, "puck[3].path": [[0.0, 0.0, -0.3], [1.0, 1.0, -0.3]],
    "post[0].point": [0.25, 0.31], "post[0].radius": 0.015, "post[0].restitution": 0.5,
    "post[0].tangential": 0.5, "post[0].friction": 0.01,
    "pocket[0].point": [0.35, -0.3], "pocket[0].radius": 0.04,
    "arc[0].point": [1.05, 0.0], "arc[0].radius": 0.35, "arc[0].start": 1.0, "arc[0].span": 1.0,
    "arc[0].restitution": 0.5, "arc[0].tangential": 0.5, "arc[0].friction": 0.01,
    "rim[0].puck": "c", "rim[0].partner": "c", "rim[0].restitution": 0.5,
    "rim[0].tangential": -0.5, "rim[0].friction": 0.01,
    "puck[0].force.constant": [0.05, 0.0], "puck[0].force.torque": 1e-3,
    "puck[0].force.over_time": [[0.0, 0.05, 0.0], [1.0, 0.0, 0.0]],
    "puck[2].constraint.kind": "blade", "puck[2].constraint.angle": 0.5,
    "puck[2].constraint.reach": 0.03, "puck[2].constraint.velocity": [0.0, 0.3],
    "puck[2].constraint.side_slip": 0.1,
}  # fmt: skip
# how a puck of it is led, where that matters to an entry
LED = {"kind": {"kind": "rail"}, "angle": {"kind": "rail"}, "velocity": {"kind": "rail"},
       "reach": {"kind": "pivot", "reach": 0.02}, "side_slip": {"kind": "blade"}}  # fmt: skip
NO_PHYSICS = {"title", "frames", "tol", "floor.law.kind", "floor.orthotropic.kind",
              "floor.orthotropic.law.kind"}  # fmt: skip
# change nothing: see tests/test_lines.py
LINES = {f"line[0].{name}" for name in ("start", "end", "centre", "radius", "name", "colour")}
BASES = {"puck.base", "puck[0].base"}  # in place of a radius: see tests/test_base_scenes.py


def whole(more: dict[str, Any]) -> dict[str, Any]:
    tables = {name: dict(part) for name, part in FREE.items()}
    for name, part in more.items():
        tables[name] = {**tables.get(name, {}), **part} if isinstance(part, dict) else part
    return tables


def end_of(tables: dict[str, Any]) -> dict[str, float]:
    run = simulate_scene(tables, [0.0])
    return {**run.last, "end_time": run.end_time}


def test_the_cases_below_are_all_entries() -> None:
    on_board = {re.sub(r"puck\[\d\]", "puck[0]", path) for path in BOARD}
    assert {path for path, _, _ in described(Scene)} == {
        *CASES, *FILES, *NO_PHYSICS, *LINES, *BASES, *on_board
    }  # fmt: skip


@pytest.mark.parametrize("path", [path for path, value in BOARD.items() if value is not None])
def test_every_entry_of_a_board_changes_the_motion(path: str) -> None:
    board = {**ON_BOARD, "rim": [RIM]} if path.startswith("rim") else ON_BOARD
    if ".constraint." in path:
        board = copy.deepcopy(board) | {"time": 0.3}
        board["puck"][2] |= {
            "constraint": LED[path.rpartition(".")[2]], "force": {"constant": [40.0, 10.0]},
            "launch": {"position": [0.0, 0.3], "spin": 10.0},
        }  # fmt: skip
    changed = copy.deepcopy(board)
    set_path(changed, path, BOARD[path])
    if path == "puck[3].path":
        del changed["puck"][3]["launch"]
    ends = [Scene.from_tables(one).simulate([0.0]) for one in (board, changed)]
    before, after = ({**one.last, "end_time": one.end_time} for one in ends)
    assert any(not np.array_equal(before[name], after[name]) for name in before), path


@pytest.mark.parametrize("path", CASES)
def test_every_entry_changes_the_motion(path: str) -> None:
    tables, value = CASES[path]
    changed = tables_of(Scene.from_tables(whole(tables)))
    set_path(changed, path, value)
    assert end_of(changed) != end_of(whole(tables))


@pytest.mark.parametrize("path", FILES)
def test_every_file_changes_the_motion(path: str, tmp_path: Path) -> None:
    tables, text = FILES[path]
    file = tmp_path / "given.csv"
    file.write_text(text)
    changed = whole(tables)
    set_path(changed, path, str(file))
    assert end_of(changed) != end_of(whole({**tables, "time": 1.0}))


@dataclass(frozen=True)
class Bumps:
    height: float = of("number", 0.0, "m")


@dataclass(frozen=True)
class BumpyFloor(parts.Floor):
    bumps: float = of("number", 0.0, "m")


@dataclass(frozen=True)
class BumpyWall(parts.Wall):
    bumps: float = of("number", 0.0, "m")


@dataclass(frozen=True, eq=False)
class BumpyScene(Scene):
    bumps: Bumps | None = of("part", None, part=Bumps)


@dataclass(frozen=True, eq=False)
class SceneOfBumpyFloor(Scene):
    floor: BumpyFloor = of("part", BumpyFloor(), part=BumpyFloor)


@dataclass(frozen=True, eq=False)
class SceneOfBumpyWalls(Scene):
    walls: tuple[BumpyWall, ...] = of("parts", (), part=BumpyWall, table="wall")


@pytest.mark.parametrize(
    ("kind", "path"),
    [
        (BumpyScene, "bumps.height"), (SceneOfBumpyFloor, "floor.bumps"),
        (SceneOfBumpyWalls, "wall.bumps"),
    ],
)  # fmt: skip
def test_an_ingredient_that_the_plan_does_not_know_is_an_error(kind: Any, path: str) -> None:
    scene = kind(Puck(1.0, friction=0.1))  # whether it is there or not
    for ask in (plan_of, Scene.simulate):
        with pytest.raises(PuckError, match=rf"^{path}: the plan of a run knows no such"):
            ask(scene)


def test_an_ingredient_that_a_scene_does_not_have_is_an_error() -> None:
    wall = BumpyWall((9.0, 0.0), normal=(-1.0, 0.0))
    for made, path in (
        ({"floor": BumpyFloor(slope=0.1, bumps=0.1)}, "floor.bumps"),
        ({"walls": (wall,)}, r"wall\[0\].bumps"),
    ):
        with pytest.raises(InputError, match=rf"{path}: no such entry"):
            Scene(Puck(1.0), **made)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_scene_written_as_toml_is_the_scene(name: str) -> None:
    scene = Scene.load(name)
    assert Scene.from_tables(tomllib.loads(as_toml(scene))) == scene


def test_texts_and_ranges_survive_in_toml() -> None:
    tables = whole({"floor": {"slope": "0.1:0.30000000000000004:7"}})
    tables["title"] = 'A "puck" \\ ünïcode \N{SNOWMAN} $x_1$'
    scene = Scene.from_tables(tables)
    again = Scene.from_tables(tomllib.loads(as_toml(scene)))
    assert again == scene
    assert again.ranges["floor.slope"].tolist() == scene.ranges["floor.slope"].tolist()


def test_numpy_numbers_arrays_and_tuples_are_numbers_and_lists() -> None:
    plain = whole(WALL)
    numpy: dict[str, Any] = {
        "puck": Puck(np.float64(0.04), np.array(0.03), np.float64(0.2), mass=0.2),
        "launch": {"velocity": np.array([0.8, 0.3]), "spin": np.int64(30)},
        "wall": (parts.Wall((np.float64(0.1), 0), normal=np.array([-1.0, 0.1]), tangential=0.2),),
    }
    assert Scene.from_tables(numpy) == Scene.from_tables(plain)
    numpy["walls"] = numpy.pop("wall")
    assert Scene(**numpy).simulate([0.0]).last == simulate_scene(plain, [0.0]).last


def test_a_scene_made_from_dataclasses_is_checked_like_a_file() -> None:
    with pytest.raises(InputError) as caught:
        Scene(
            {"radius": -1.0, "height": np.nan, "pressure": 7},  # type: ignore[arg-type]
            launch=parts.Launch(velocity=np.zeros((2, 1)), spin=np.bool_(True)),  # type: ignore[arg-type]
            walls=[
                parts.Wall((1.0, 0.0), normal=(1.0,)),  # type: ignore[arg-type]
                parts.Edge((0.0, 0.0), normal=(0.0, 1.0)),  # type: ignore[list-item]
            ],
            force=parts.Force(constant=np.ma.array([1.0, 2.0], mask=[False, True])),
            drag=None,  # type: ignore[arg-type]
        )
    lines = [line.strip() for line in str(caught.value).splitlines()]
    assert lines[0] == "scene: 9 errors"
    for said in (
        "puck.radius = -1.0: must be a number > 0 m", "puck.height = nan:", "puck.pressure = 7:",
        "launch.velocity = array(", "launch.spin = True", "wall[0].normal = (1.0,)",
        "wall[1] = Edge(", "force.constant[1] = masked:", "drag = None: must be a table",
    ):  # fmt: skip
        assert any(line.startswith(said) for line in lines), (said, lines)


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_copies_and_pickles_hold_what_was_given(again: Any) -> None:
    puck = Puck(radius=0.04, height=0.02, friction=0.15)
    assert repr(again(puck)) == repr(puck) and again(puck) == puck
    assert again(puck).stop((1.0, 0.2), 5.0) == puck.stop((1.0, 0.2), 5.0)
    with pytest.raises(InputError, match="this puck has a force"):
        again(replace(puck, force=parts.Force(torque=0.01))).stop((1.0, 0.2), 5.0)
    scene = Scene.load("incline")
    assert "Drag" not in repr(again(scene)) and again(scene) == scene


def test_what_disagrees_in_dataclasses_is_told_too() -> None:
    good = Scene.from_tables(whole({}))
    with pytest.raises(InputError, match=r"wall\[0\]: the puck at \[0\.0, 0\.0\] reaches through"):
        replace(good, walls=(parts.Wall((0.0, 0.0), normal=(1.0, 0.0)),))


def test_no_scene_at_all_is_a_sentence() -> None:
    for wrong in (7, None, [1, 2], b"incline"):
        with pytest.raises(InputError, match="scene: a scene is a table of tables, got"):
            Scene.from_tables(wrong)  # type: ignore[arg-type]
        with pytest.raises(InputError, match="must be a table"):
            Scene(wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"puck": {"radius": 10**5000}}, "puck.radius = a whole number of thousands of digits"),
        ({"launch": {"velocity": [10**5000]}}, "launch.velocity = a list: must be two numbers"),
        ({"puck": {"radius": 1.0}, "title": "a\0b"}, r"title = 'a\x00b': must be a text without"),
        ({"puck": {"radius": 1.0}, "title": "\udcff"}, "title = "),
        ({"puck": {"radius": 1.0, "pressure": "\0.csv"}}, "puck.pressure = "),
        ({"puck": {"radius": 1.0, "\x1b[31m": 1.0}}, r"puck.'\x1b[31m': no such entry"),
    ],
)
def test_what_cannot_be_shown_is_told_nevertheless(tables: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as caught:
        Scene.from_tables(tables)
    assert said in str(caught.value)
    assert all(sign.isprintable() or sign == "\n" for sign in str(caught.value))


def test_ranges_are_counted_before_they_are_made() -> None:
    wall = {"point": ["1:2:1000000", "1:2:1000000"], "normal": ["-1:1:1000000", 1.0]}
    with pytest.raises(InputError, match=r"3000 ranges \(wall\[0\]\.point.* than 1e\+09"):
        Scene.from_tables({"puck": {"radius": 0.01}, "wall": [wall] * 1000})  # 24 GB if made
