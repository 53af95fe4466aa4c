"""A board as one file of JavaScript: the engine in WebAssembly, the scene, and a small host."""

from __future__ import annotations

import base64
import gzip
import importlib.util
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from puck_tables._core.real import instance
from puck_tables._core.safe_write import write_bytes
from puck_tables._core.wording import counted
from puck_tables._version import __version__
from puck_tables.errors import InputError, MissingExtraError, PuckError
from puck_tables.export.licence import LICENCE
from puck_tables.export.source import checked_ending
from puck_tables.scene.entries import tables_of
from puck_tables.scene.pucks_and_posts import called_line
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world import setting_off
from puck_tables.world.lasting import LEADS_ON, NEVER_ENDS
from puck_tables.world.layout import LIGHTNESS, RADIUS
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.segment import GONE
from puck_tables.world.shipped import (
    FAILED,
    FASTEST,
    NOTHING_HAPPENS,
    TOO_FAST,
    Shipped,
    play_shipped,
    see_shipped,
    shipped,
)
from puck_tables.world.stored import FOUND_COLUMNS, LACKS_PIECES, LED, LET_GO
from puck_tables.world.worlds import Worlds

_MACHINE, _SYSTEM = "wasm32-unknown-unknown", "wasm32-wasi"  # of LLVM, and of the libraries
_FULL = (setting_off.FULL, setting_off.PAUSED, LACKS_PIECES)  # shorter calls may do
_FAILURES = {
    setting_off.OFF_TABLE: "an impact is faster than its table of restitution goes",
    setting_off.TOO_SHORT: "no step is short enough to follow a puck",
    setting_off.PUSHING: "a slip is faster than its friction law is known",
    NEVER_ENDS: "a puck still moves, and may never stop: give a time",
    LEADS_ON: "the floor still carries a puck to where it may slip again: give a time",
}


@dataclass(frozen=True)
class BoardSource:
    """A file of JavaScript that plays a board.

    Parameters
    ----------
    text : its content
    title : of the scene
    pucks : their names
    """

    text: str
    title: str
    pucks: tuple[str, ...]

    def __repr__(self) -> str:
        title = f"{self.title}, " if self.title else ""
        pucks = counted(len(self.pucks), "puck")
        return f"BoardSource({title}{pucks}, {len(self.text)} bytes)"

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the file.

        Parameters
        ----------
        path : ending in .js, .mjs or .cjs
        overwrite : whether an existing file may be replaced

        Raises
        ------
        InputError
            If the ending is another one.
        OutputError
            If the file exists or cannot be written.
        """
        instance("path", path, str, Path)
        checked_ending(path, "js")
        write_bytes(path, self.text.encode(), overwrite)


def export_board(scene: SceneSpec) -> BoardSource:
    """A file of JavaScript that plays a scene as :class:`puck_tables.World` does.

    For browsers and Node.  The engine is in it, in WebAssembly: it needs nothing else, no server
    and no network.  The first file takes a minute, for the engine is compiled; others a second.
    ``await puckBoard.load()`` gives a board: ``strike``, ``place``, ``remove``, ``drive``,
    ``advance``, ``state``, ``copy``.

    Parameters
    ----------
    scene : Scene
        Without ranges, on a floor at rest, without constraints.

    Returns
    -------
    BoardSource

    Raises
    ------
    InputError
        If the scene is another one, or what links the code is not installed.

    Notes
    -----
    The machine code is IEEE arithmetic without fused or reordered operations and one mathematics
    library, musl's, so that the same calls give the same bits wherever it runs.  Against this
    package, which takes the mathematics library of its machine, last digits differ; impacts of
    round pucks multiply that as they multiply everything.

    Examples
    --------
    >>> from puck_tables import Floor, Puck, Scene, export_board
    >>> export_board(Scene(Puck(0.03, friction=0.1), Floor(turning=1.0)))
    Traceback (most recent call last):
        ...
    puck_tables.errors.InputError: a floor that moves, or a puck that a constraint leads, goes...
    """
    if not isinstance(scene, SceneSpec):
        raise InputError(f"scene must be a Scene, got a {type(scene).__name__}")
    ship, board = shipped(scene.single())
    if importlib.util.find_spec("ziglang") is None:
        raise MissingExtraError("boards are linked by zig: pip install ziglang")
    code = base64.b64encode(gzip.compress(_webassembly(ship), mtime=0)).decode()
    text = (files("puck_tables.export") / "board.js").read_text(encoding="utf-8")
    parts = {
        "title": _as_json(scene.title or "A board")[1:-1], "version": __version__,
        "licence": "".join(f"// {line}".rstrip() + "\n" for line in LICENCE.splitlines()),
        "puck": _as_json(next(iter(_free(board)), board.names[0])),
        "scene": _as_json(_described(ship, board)), "code": code,
    }  # fmt: skip
    for name, value in parts.items():
        text = text.replace(f"/*{name}*/", value)
    return BoardSource(text, scene.title, board.names)


def _free(board: Worlds) -> list[str]:
    """The names of pucks that nobody drives."""
    driven = board._first._engine.discs[board._place, LIGHTNESS] == 0.0
    return [name for name, led in zip(board.names, driven, strict=True) if not led]


def _as_json(value: Any) -> str:
    """A value for a script, which no text of it ends."""
    return json.dumps(value).replace("<", "\\u003c")


def _named(ship: Shipped) -> dict[str, Any]:
    """The arrays that the host reads and writes, by the names that it has for them."""
    orders, store, room = ship.orders, ship.store, ship.bench.room
    return {
        "row": orders.rows, "disc": orders.discs, "time": orders.time, "after": orders.after,
        "numbers": store.numbers, "whole": store.whole, "pieces": store.pieces, "due": store.due,
        "found": ship.found, "states": ship.states, "moving": ship.moving,
        "contacts": room.contacts, "depth": room.work,
    }  # fmt: skip


def _described(ship: Shipped, board: Worlds) -> dict[str, Any]:
    """What the host must know of a board, and of the engine."""
    engine, order = board._first._engine, ship.bench.order
    wholes = [ship.bench.whole.ctypes.data, ship.bench.engine.counts.ctypes.data]
    orders = {"letGo": LET_GO, "led": LED, "struck": g.STRUCK, "placed": g.PLACED,
              "removed": g.REMOVED}  # fmt: skip
    codes = {
        "nothing": NOTHING_HAPPENS, "fast": TOO_FAST, "full": [FAILED - how for how in _FULL],
        "misplaced": FAILED - setting_off.MISPLACED, "gone": GONE,
    }  # fmt: skip
    layout = {
        "numbers": ship.bench.numbers.size, "whole": ship.bench.whole.size,
        "pieces": ship.store.pieces[0].size, "columns": PIECE_COLUMNS, "found": ship.found.size,
        "event": FOUND_COLUMNS, "shared": ship.bench.shared,
        "used": (wholes[1] - wholes[0]) // 8 + g.N_PIECES,
    }  # fmt: skip
    lines = len(board.scene.lines)
    return {
        "title": board.scene.title, "parts": tables_of(board.scene), "pucks": board.names,
        "order": order.tolist(),
        "radii": engine.discs[board._place, RADIUS].tolist(),
        "driven": (engine.discs[board._place, LIGHTNESS] == 0.0).tolist(),
        "obstacles": board._first._obstacles,
        "lines": [called_line(board.scene.lines, k) for k in range(lines)],
        "events": g.EVENTS, "fastest": float(ship.limits[FASTEST]),
        "failures": {FAILED - how: text for how, text in _FAILURES.items()},
        "orders": orders, "codes": codes, "layout": layout,
    }  # fmt: skip


def _webassembly(ship: Shipped) -> bytes:
    """The engine of a board and its arrays as one module, which imports nothing."""
    from puck_tables.kernels.ahead import Outside, code_for
    from puck_tables.kernels.memory_image import arrays_for

    doors = (Outside("play", play_shipped, (0, 0.0)), Outside("see", see_shipped, (0.0,)))
    named = _named(ship)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "engine.o").write_bytes(code_for(_MACHINE, ship, doors))
        Path(folder, "board.o").write_bytes(arrays_for(_MACHINE, ship, named))
        _run_zig(
            folder, "cc", "-target", _SYSTEM, "-mexec-model=reactor", "-O2", "-s", "engine.o",
            "board.o", "-lm", "-o", "board.wasm",
            *(f"-Wl,--export={name}" for name in (*named, "play", "see")),
        )  # fmt: skip
        return Path(folder, "board.wasm").read_bytes()


def _run_zig(folder: str, *arguments: str) -> None:
    run: Sequence[str] = [sys.executable, "-m", "ziglang", *arguments]
    done = subprocess.run(run, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise PuckError(f"zig cannot link the board: {done.stderr.strip()[:500]}")
