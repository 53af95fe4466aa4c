"""Boards as libraries for C, beside the same boards in WebAssembly: the same bits; and `World`."""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from conftest import ROOT

import puck_tables as pt

NEEDS = shutil.which("node") is None or importlib.util.find_spec("ziglang") is None
WITH_TOOLS = pytest.mark.skipif(NEEDS, reason="no Node or no zig here")
SCENES = ("carrom-break", "crokinole", "air-hockey-mallet", "air-hockey-goals", "bumper-pool")
# both read lines: what is done, to which puck, six numbers; and write all bits that they then see
IN_C = r"""
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "board.h"

static void bits(const double *numbers, int count) {
  for (int n = 0; n < count; n++) {
    uint64_t all;
    memcpy(&all, numbers + n, 8);
    printf(" %016llx", (unsigned long long)all);
  }
}

int main(void) {
  puck_board *board = puck_board_new(&board_scene), *other = puck_board_new(&board_scene);
  puck_motion pucks[64];
  const puck_event *events;
  char what[16];
  int k;
  double x, y, angle, vx, vy, spin;
  if (puck_scene_find(&board_scene, puck_scene_name(&board_scene, 1)) != 1) return 1;
  if (puck_scene_find(&board_scene, "nobody") != -1) return 1;
  while (scanf("%15s %d %lf %lf %lf %lf %lf %lf", what, &k, &x, &y, &angle, &vx, &vy, &spin) == 8) {
    puck_board *ahead = puck_board_copy(board);  /* what is seen ahead changes nothing */
    puck_board_strike(ahead, 0, 1.0, 0.5, 3.0);
    puck_board_advance(ahead, 0.3, 0);
    puck_board_become(other, ahead);
    puck_board_free(ahead);
    int done = 0;
    if (!strcmp(what, "advance")) done = puck_board_advance(board, x, &events);
    if (!strcmp(what, "strike")) done = puck_board_strike(board, k, vx, vy, spin);
    if (!strcmp(what, "drive")) done = puck_board_drive(board, k, vx, vy, spin);
    if (!strcmp(what, "place")) done = puck_board_place(board, k, x, y, angle, vx, vy, spin);
    if (!strcmp(what, "remove")) done = puck_board_remove(board, k);
    if (done < 0) printf("refused%s", strlen(puck_board_error()) > 9 ? "" : " in silence");
    for (int n = 0; n < done; n++) {
      printf("%d %s/%s", events[n].what, puck_scene_name(&board_scene, events[n].puck),
             puck_scene_name(&board_scene, events[n].partner));
      bits(&events[n].time, 1);
      bits(&events[n].x, 7);
    }
    puck_board_state(board, pucks);
    for (int n = 0; n < puck_scene_count(&board_scene); n++) {
      bits(&pucks[n].x, 6);
      printf(" %d%d", pucks[n].moving, pucks[n].in_play);
    }
    double now = puck_board_time(board);
    bits(&now, 1);
    printf("\n");
  }
  puck_board_free(board);
  puck_board_free(other);
  puck_board_free(0);
  return 0;
}
"""
IN_NODE = r"""
const { load, scene } = require("./board.js");
const lines = require("fs").readFileSync(0, "utf8").trim().split("\n");
const view = new DataView(new ArrayBuffer(8));
const bits = (numbers) => numbers.map((one) => {
  view.setFloat64(0, one);
  return " " + view.getBigUint64(0).toString(16).padStart(16, "0");
}).join("");
load().then((board) => {
  for (const line of lines) {
    const [what, who, ...numbers] = line.split(" ");
    const puck = Number(who);
    const [x, y, angle, vx, vy, spin] = numbers.map((n) => n === "inf" ? Infinity : Number(n));
    let events = [], said = "";
    try {
      if (what === "advance") events = board.advance(x);
      if (what === "strike") board.strike(puck, { velocity: [vx, vy], spin });
      if (what === "drive") board.drive(puck, [vx, vy], spin);
      const velocity = [vx, vy];
      if (what === "place") board.place(puck, { position: [x, y], angle, velocity, spin });
      if (what === "remove") board.remove(puck);
    } catch (error) { said = "refused"; }
    for (const e of events) {
      said += `${scene.events.indexOf(e.what)} ${e.puck}/${e.partner}` +
        bits([e.time, e.x, e.y, e.approach, e.slip, e.impulse, e.rub, e.lost]);
    }
    for (const s of board.state()) {
      said += bits([s.x, s.y, s.angle, s.vx, s.vy, s.spin]) + ` ${+s.moving}${+s.inPlay}`;
    }
    console.log(said + bits([board.time]));
  }
});
"""


def drawn(scene: pt.Scene, count: int, seed: int) -> list[str]:
    """Calls by chance, some of which are refused; first one that is followed without impact."""
    rng, world = np.random.default_rng(seed), scene.world()
    places = world.state()[:, :2]
    low, high = places.min(axis=0) - 0.2, places.max(axis=0) + 0.2
    lines = ["strike 0 0 0 0 0.3 0.1 2.0", "advance 0 0.002 0 0 0 0 0"]
    for _ in range(count):
        what = rng.choice(["strike", "drive", "place", "remove"], p=[0.5, 0.3, 0.17, 0.03])
        numbers = [*rng.uniform(low, high), *rng.normal(size=3), 20.0 * rng.normal()]
        lines.append(
            " ".join(map(repr, [str(what), int(rng.integers(len(places)))])).replace("'", "")
        )
        lines[-1] += "".join(f" {float(one)!r}" for one in numbers)
        duration = float("inf") if rng.random() < 0.1 else float(rng.choice([1 / 60, 0.1, 0.7]))
        lines.append(f"advance 0 {duration!r} 0 0 0 0 0")
    return lines


def run(folder: Path, *command: str, given: str = "") -> list[str]:
    ended = subprocess.run(
        command, cwd=folder, input=given, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.splitlines()


@pytest.mark.thorough
@WITH_TOOLS
@pytest.mark.parametrize("name", SCENES)
def test_c_and_webassembly_give_the_same_bits(name: str, tmp_path: Path) -> None:
    """All that is seen after hundreds of drawn calls."""
    scene = pt.Scene.load(name)
    pt.export_board(scene).save(tmp_path / "board.js")
    pt.export_board(scene, "c").save(tmp_path / "board.h")
    (tmp_path / "play.c").write_text(IN_C)
    (tmp_path / "play.cjs").write_text(IN_NODE)
    zig = (sys.executable, "-m", "ziglang", "cc", "-std=c99", "-Wall", "-Werror", "-O1")
    run(tmp_path, *zig, "play.c", "libboard.a", "-lm", "-o", "play")
    lines = drawn(scene, 150, seed=7)
    given = "\n".join(lines) + "\n"
    in_c, in_node = (
        run(tmp_path, "./play", given=given),
        run(tmp_path, "node", "play.cjs", given=given),
    )
    assert len(in_c) == len(in_node) == len(lines)
    for n, (one, other) in enumerate(zip(in_c, in_node, strict=True)):
        assert one == other, lines[n]
    refused = sum(one.startswith("refused") for one in in_c)
    assert 0 < refused < len(lines) / 2
    assert sum("/" in one for one in in_c) > 20  # events
    world = scene.world()
    world.strike(world.names[0], (0.3, 0.1), 2.0)
    world.advance(0.002)
    words = in_c[1].split()[: 7 * len(world.names)]
    rows = [int(word, 16) for n, word in enumerate(words) if n % 7 < 6]
    state = np.array(rows, np.uint64).view(np.float64).reshape(-1, 6)
    np.testing.assert_allclose(state, world.state(), rtol=1e-12, atol=1e-13)


@pytest.mark.thorough
@WITH_TOOLS
def test_two_boards_in_one_program_of_cpp(tmp_path: Path) -> None:
    """Of two scenes, by their names."""
    for name in ("crokinole", "bumper_pool"):
        scene = pt.Scene.load(name.replace("_", "-"))
        pt.export_board(scene, "c", name=name).save(tmp_path / f"{name}.h")
    (tmp_path / "play.cpp").write_text(
        '#include <cmath>\n#include <cstdio>\n#include "crokinole.h"\n#include "bumper_pool.h"\n'
        "int main() {\n"
        "  puck_board *one = puck_board_new(&crokinole_scene);\n"
        "  puck_board *other = puck_board_new(&bumper_pool_scene);\n"
        "  if (puck_board_become(one, other) == 0) return 1;\n"
        "  puck_board_strike(one, 0, 0.5, 0.0, 1.0);\n"
        "  puck_board_strike(other, 0, 0.5, 0.0, 1.0);\n"
        "  puck_board_advance(one, HUGE_VAL, nullptr);\n"
        "  puck_board_advance(other, HUGE_VAL, nullptr);\n"
        '  std::printf("%d %s\\n", puck_scene_count(&crokinole_scene), puck_board_error());\n'
        "}\n"
    )
    zig = (sys.executable, "-m", "ziglang", "c++", "play.cpp", "libcrokinole.a", "libbumper_pool.a")
    run(tmp_path, *zig, "-lm", "-o", "play")
    (said,) = run(tmp_path, "./play")
    count = len(pt.Scene.load("crokinole").world().names)
    assert said == f"{count} the boards are of two scenes"


@pytest.mark.thorough
@WITH_TOOLS
def test_the_program_of_the_page(tmp_path: Path) -> None:
    """As it stands there, from the command on."""
    page = (ROOT / "docs" / "export.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"```c\n(.*?)```", page, re.DOTALL)
    (tmp_path / "play.c").write_text(program)
    asked = ["export", "--language", "c", "--scene", "carrom-break", "-o"]
    done = invoke(*asked, tmp_path / "carrom.h")
    assert done.exit_code == 0, done.stderr
    assert f"wrote {tmp_path / 'libcarrom.a'}" in done.stderr
    again = invoke(*asked, tmp_path / "carrom.h")
    assert again.exit_code == 1 and "exists already" in again.stderr
    zig = (sys.executable, "-m", "ziglang", "cc", "-Wall", "-Werror", "play.c", "libcarrom.a")
    run(tmp_path, *zig, "-lm", "-o", "play")
    *told, place = run(tmp_path, "./play")
    world = pt.Scene.load("carrom-break").world()
    world.strike("striker", (0.5, 2.0), 30.0)
    world.advance(1.0 / 60.0)
    assert list(map(float, place.split())) == pytest.approx(
        world.state()[world.names.index("striker"), :2], rel=1e-5
    )
    assert told == [f"{event.time:g} s: {event.puck}" for event in world.advance(float("inf"))]


def test_refusals() -> None:
    scene = pt.Scene.load("crokinole")
    for given, words in (
        ({"language": "rust"}, "exported to c and js, got 'rust'"),
        ({"language": "c", "target": "z80"}, "no machine is called 'z80': choose x86_64-linux"),
        ({"target": "x86_64-linux"}, "target is for c"),
        ({"language": "c", "name": "a-b"}, "letters, digits and _"),
    ):  # fmt: skip
        with pytest.raises(pt.InputError, match=words):
            pt.export_board(scene, **given)
