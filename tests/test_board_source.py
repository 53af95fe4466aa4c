"""Boards as files of JavaScript, played in Node, beside the World that they stand for."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.results import BoardSource

WITH_TOOLS = pytest.mark.skipif(shutil.which("node") is None, reason="no Node here")
# what is done to both, one after the other: a name, and what it is given
STEPS = [
    ("advance", 0.05), ("strike", "black", {"velocity": [1.9, -0.7], "spin": 40.0}),
    ("advance", 0.4), ("drive", "mallet", [0.6, -0.2]), ("advance", 1 / 60), ("advance", 0.3),
    ("drive", "mallet", [0.0, 0.0]),
    ("place", "white", {"position": [0.2, 0.0], "velocity": [-1.5, 1.4]}), ("advance", 0.7),
    ("remove", "queen"), ("strike", "black", {"spin": 30.0}), ("advance", 1e9),
    ("place", "queen", {"position": [0.05, -0.2], "angle": 1.0}),
    ("strike", "first", {"velocity": [1.5, 0.0]}), ("advance", 2.0),
]  # fmt: skip


def a_board() -> pt.Scene:
    """A row that touches and pushes, a mallet, a pocket, a line, a post, walls with ends."""

    def man(name: str, x: float, y: float, **more: object) -> pt.Puck:
        return pt.Puck(
            0.03, friction=0.04, name=name, height=0.01, launch=pt.Launch(position=(x, y)), **more
        )

    row = [man(name, 0.061 * k - 0.2, -0.05, restitution=0.0)
           for k, name in enumerate(("first", "second", "third"))]  # fmt: skip
    men = [man("black", -0.3, 0.2), man("white", 0.1, 0.25, restitution=0.8), man("queen", 0, 0.1)]
    mallet = pt.Puck(0.05, path=[[0, 0.35, 0.35]], name="mallet")
    corners = ((-0.5, -0.4), (0.5, -0.4), (0.5, 0.5), (-0.5, 0.5))
    return pt.Scene(
        pucks=[*row, *men, mallet], walls=[pt.Wall(corners=corners, restitution=0.7)],
        posts=[pt.Post((0.3, -0.1), 0.02)], pockets=[pt.Pocket((0.46, 0.46), 0.05)],
        lines=[pt.Line((-0.5, 0.0), (0.5, 0.0))], title="All that boards have",
    )  # fmt: skip


def played(world: pt.World) -> list[dict[str, object]]:
    """What World says to the steps."""
    found = []
    for name, *given in STEPS:
        if isinstance(given[-1], dict):
            events = getattr(world, name)(*given[:-1], **given[-1])
        else:
            events = getattr(world, name)(*given)
        found.append({
            "events": [[e.what, e.puck, e.partner, e.time, e.impulse] for e in events or []],
            "time": world.time, "state": world.state().tolist(),
        })  # fmt: skip
    return found


HOST = """
const { load } = require("./board.js");
const steps = JSON.parse(process.argv[2]);
const rows = (board) => board.state().map((s) => [s.x, s.y, s.angle, s.vx, s.vy, s.spin]);
const refused = (call) => { try { call(); } catch (error) { return String(error); } };
(async () => {
  const board = await load(), start = board.copy();
  const found = steps.map(([name, ...given]) => {
    const events = board[name](...given) ?? [];
    return { events: events.map((e) => [e.what, e.puck, e.partner, e.time, e.impulse]),
             time: board.time, state: rows(board) };
  });
  const again = start.copy();
  const events = steps.flatMap(([name, ...given]) => again[name](...given) ?? []);
  const same = JSON.stringify(rows(again)) === JSON.stringify(rows(board));
  const fresh = start.copy(), before = JSON.stringify(rows(fresh));
  const refusals = [
    () => fresh.strike("nobody", {}), () => fresh.strike("mallet", { spin: 1 }),
    () => fresh.strike(0, { velocity: [NaN, 0] }), () => fresh.strike(0, { velocity: [1e9, 0] }),
    () => fresh.place("first", { position: [-0.139, 0.0] }), () => fresh.advance(-1),
    () => fresh.drive("first", [1, 0]), () => { fresh.copy().remove(7); },
    () => fresh.drive("mallet"), () => fresh.strike("first", [1, 0]),
    () => fresh.place("first", { positon: [0, 0] }),
  ].map(refused);
  const gone = fresh.copy(), { x, y } = gone.state()[5];
  gone.remove("queen");
  gone.place("queen", { position: [x, y] });
  const squeezing = start.copy();
  squeezing.place("queen", { position: [0.46, 0.1] });
  squeezing.place("mallet", { position: [0.35, 0.1] });
  squeezing.drive("mallet", [1, 0]);
  refusals.push(refused(() => squeezing.advance(0.2)));
  const unchanged = before === JSON.stringify(rows(fresh));
  const back = gone.state()[5].inPlay, names = board.names;
  const kind = (one) => Array.isArray(one) ? kind(one[0]) + "[]" : typeof one;
  const kinds = (one) => JSON.parse(JSON.stringify(one, (key, its) => key ? kind(its) : its));
  const methods = Object.entries(Object.getOwnPropertyDescriptors(Object.getPrototypeOf(board)));
  const typed = {
    puckBoard: kinds(puckBoard), State: board.state().map(kinds), Event: events.map(kinds),
    Scene: kinds(puckBoard.scene), Board: Object.fromEntries(methods.slice(1).map(
      ([name, { value }]) => [name, value ? value.length : kind(board[name])])),
  };
  console.log(JSON.stringify({ found, same, unchanged, back, refusals, names, typed }));
})();
"""


@pytest.fixture(scope="module")
def in_node(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """What Node says of the board."""
    folder = tmp_path_factory.mktemp("board")
    pt.export_board(a_board()).save(folder / "board.js")
    Path(folder, "host.cjs").write_text(HOST)
    command = ["node", "host.cjs", json.dumps(STEPS)]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return {"types": (folder / "board.d.ts").read_text(), **json.loads(ended.stdout)}


@pytest.mark.thorough
@WITH_TOOLS
def test_it_plays_as_the_world_does(in_node: dict):
    """The same events, and states to what rounding leaves after dozens of impacts."""
    truth = played(a_board().world())
    assert [len(one["events"]) for one in in_node["found"]] == [len(o["events"]) for o in truth]
    assert sum(len(one["events"]) for one in truth) > 30
    for mine, theirs in zip(truth, in_node["found"], strict=True):
        assert [one[:3] for one in mine["events"]] == [one[:3] for one in theirs["events"]]
        for one, other in zip(mine["events"], theirs["events"], strict=True):
            assert other[3:] == pytest.approx(one[3:], rel=1e-9, abs=1e-9)
        assert theirs["time"] == pytest.approx(mine["time"], rel=1e-12)
        np.testing.assert_allclose(theirs["state"], mine["state"], rtol=1e-9, atol=1e-9)
    first = np.array(in_node["found"][1]["state"]), np.array(truth[1]["state"])
    np.testing.assert_allclose(*first, rtol=1e-12, atol=1e-13)  # before any impact


@pytest.mark.thorough
@WITH_TOOLS
def test_copies_go_on_by_themselves_and_refusals_change_nothing(in_node: dict):
    assert in_node["same"]
    assert in_node["unchanged"]
    assert in_node["back"]
    assert in_node["names"] == ["first", "second", "third", "black", "white", "queen", "mallet"]
    words = ["no puck nobody", "use drive", "velocity must be a finite number", "faster than",
             "first would overlap second by", "must not be negative", "not led by hand",
             "no puck 7", "velocity must be [x, y]", "give an object of velocity, spin",
             "there is no positon, there are position",
             "mallet, which is driven, squeezes queen"]  # fmt: skip
    for word, sentence in zip(words, in_node["refusals"], strict=True):
        assert word in sentence


def declared(types: str, name: str) -> dict[str, str | int]:
    """What a .d.ts says of a name: of a method how many arguments it must have, else the type."""
    within = re.search(rf" {name} {{(.*?)(?:}}\n|interface)", types, re.DOTALL)
    text = re.sub(r"//.*|/\*\*.*?\*/", "", within[1]).replace("function ", "")
    methods = {called: len(re.findall(r"\w: ", given))
               for called, given in re.findall(r"(\w+)\((.*?)\):", text)}  # fmt: skip
    return methods | dict(re.findall(r"(\w+)\??: ([^;]+);", re.sub(r"\w+\(.*", "", text)))


@pytest.mark.thorough
@WITH_TOOLS
def test_its_types_are_what_there_is(in_node: dict):
    """Names, types and arguments of the .d.ts beside it, as Node finds them."""
    types, typed = in_node["types"], in_node["typed"]
    assert declared(types, "puckBoard") == {"load": 0, "scene": "Scene"}
    assert typed["puckBoard"] == {"load": "function", "scene": "object"}
    assert declared(types, "Board") == typed["Board"]
    for name in ("State", "Event"):
        assert typed[name] and all(one == declared(types, name) for one in typed[name])
    assert {**declared(types, "Scene"), "parts": "object"}.items() <= typed["Scene"].items()
    strike, place = (", ".join(declared(types, name)) for name in ("Strike", "Place"))
    assert f"an object of {strike}, got" in in_node["refusals"][9]
    assert in_node["refusals"][10].endswith(f"there are {place}")


def test_types_go_beside_it_or_nothing_is_written(tmp_path: Path):
    board = BoardSource("text", "", (), companion=b"types")
    (tmp_path / "a.d.ts").touch()
    with pytest.raises(pt.PuckError, match=r"a\.d\.ts exists already"):
        board.save(tmp_path / "a.js")
    board.save(tmp_path / "b.mjs")
    written = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert written == {"a.d.ts": "", "b.mjs": "text", "b.d.mts": "types"}


def test_what_moves_with_its_floor_is_refused():
    belt = pt.Scene(pt.Puck(0.03, friction=0.1), pt.Floor(velocity=(0.1, 0.0)))
    with pytest.raises(pt.InputError, match="a floor that moves, or"):
        pt.export_board(belt)
    with pytest.raises(pt.InputError, match="scene must be a Scene, got a str"):
        pt.export_board("carrom-break")
