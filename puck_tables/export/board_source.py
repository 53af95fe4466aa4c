"""A board as a file of JavaScript, or as a library for C: the engine, the scene, a small host."""

from __future__ import annotations

import base64
import gzip
import importlib.util
import json
import platform
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray, instance, shown
from puck_tables._core.safe_write import check_target, write_bytes
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
from puck_tables.world.bench import LACKS_PIECES, LED, LET_GO, REPORT_COLUMNS
from puck_tables.world.lasting import LEADS_ON, NEVER_ENDS
from puck_tables.world.layout import INV_MASS, RADIUS
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
from puck_tables.world.worlds import Worlds

_MACHINE, _SYSTEM = "wasm32-unknown-unknown", "wasm32-wasi"  # of LLVM, and of the libraries
_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)


class Machine(NamedTuple):
    """What LLVM calls a machine, and what zig does."""

    triple: str
    system: str


TARGETS = {
    "x86_64-linux": Machine("x86_64-unknown-linux-gnu", "x86_64-linux-gnu"),
    "aarch64-linux": Machine("aarch64-unknown-linux-gnu", "aarch64-linux-gnu"),
    "x86_64-macos": Machine("x86_64-apple-macosx11.0.0", "x86_64-macos"),
    "aarch64-macos": Machine("arm64-apple-macosx11.0.0", "aarch64-macos"),
    "x86_64-windows": Machine("x86_64-w64-windows-gnu", "x86_64-windows-gnu"),
    "aarch64-windows": Machine("aarch64-w64-windows-gnu", "aarch64-windows-gnu"),
}
_FULL = {"FULL": setting_off.FULL, "PAUSED": setting_off.PAUSED, "LACKS_PIECES": LACKS_PIECES}
# what a host says to the engine, and what it hears; of the last three shorter calls may do
CODES = {
    "LET_GO": LET_GO, "LED": LED, "STRUCK": g.STRUCK, "PLACED": g.PLACED, "REMOVED": g.REMOVED,
    "GONE": GONE, "FASTEST": FASTEST, "NOTHING_HAPPENS": NOTHING_HAPPENS, "TOO_FAST": TOO_FAST,
    "MISPLACED": FAILED - setting_off.MISPLACED,
    **{name: FAILED - how for name, how in _FULL.items()},
}  # fmt: skip
FAILURES = {
    FAILED - setting_off.OFF_TABLE: "an impact is faster than its table of restitution goes",
    FAILED - setting_off.TOO_SHORT: "no step is short enough to follow a puck",
    FAILED - setting_off.PUSHING: "a slip is faster than its friction law is known",
    FAILED - NEVER_ENDS: "a puck still moves, and may never stop: give a time",
    FAILED - LEADS_ON: "the floor still carries a puck to where it may slip again: give a time",
}


def named(ship: Shipped) -> dict[str, Any]:
    """The arrays that a host reads and writes, by the names that it has for them, in its order."""
    orders, store, room = ship.orders, ship.store, ship.bench.room
    return {
        "row": orders.rows, "disc": orders.discs, "time": orders.time, "after": orders.after,
        "numbers": store.numbers, "whole": store.whole, "pieces": store.pieces, "due": store.due,
        "found": ship.reports, "states": ship.states, "moving": ship.moving,
        "contacts": room.contacts, "depth": room.work,
    }  # fmt: skip


def sizes_of(ship: Shipped) -> dict[str, int]:
    """Sizes of what a host reads and writes, and where in ``whole`` the pieces in use are told."""
    wholes = [ship.bench.whole.ctypes.data, ship.bench.engine.counts.ctypes.data]
    return {
        "numbers": ship.bench.numbers.size, "whole": ship.bench.whole.size,
        "pieces": ship.store.pieces[0].size, "columns": PIECE_COLUMNS, "event": REPORT_COLUMNS,
        "events": len(ship.reports),
        "shared": ship.bench.shared, "used": (wholes[1] - wholes[0]) // 8 + g.N_PIECES,
    }  # fmt: skip


def lines_of(board: Worlds) -> list[str]:
    """The names of its lines."""
    return [called_line(board.scene.lines, k) for k in range(len(board.scene.lines))]


def discs_of(board: Worlds) -> tuple[FloatArray, Any]:
    """The radius of each puck, m, and whether it is driven."""
    discs = board._first._engine.discs[board._place]
    return discs[:, RADIUS], discs[:, INV_MASS] == 0.0


def objects(folder: str, triple: str, ship: Shipped, known: list[Any], symbol: str) -> list[str]:
    """Object files in a folder: the engine, and a board with a table of what is known outside."""
    from puck_tables.kernels.ahead import Outside, arrays_for, code_for

    doors = (Outside("play", play_shipped, (0, 0.0)), Outside("see", see_shipped, (0.0,)))
    Path(folder, "engine.o").write_bytes(code_for(triple, ship, doors))
    Path(folder, f"{symbol}.o").write_bytes(arrays_for(triple, ship, known, symbol))
    return ["engine.o", f"{symbol}.o"]


def checked_target(target: str | None) -> Machine:
    """A machine by its name; None: this one.

    >>> checked_target("riscv64-linux")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: no machine is called 'riscv64-linux': choose x86_64-linux, ...
    """
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower())
    system = {"darwin": "macos", "win32": "windows"}.get(sys.platform, sys.platform)
    name = target or f"{machine or platform.machine()}-{system}"
    if name not in TARGETS:
        raise InputError(f"no machine is called {shown(name)}: choose {', '.join(TARGETS)}")
    return TARGETS[name]


def library(
    ship: Shipped, board: Worlds, described: str, name: str, target: Machine
) -> tuple[str, bytes]:
    """A header, and a static library of the engine, the board and its host in C.

    ``described``: the scene as JSON; ``name``: of the scene in C, before ``_scene``.
    """
    (radii, driven), sizes, lines = discs_of(board), sizes_of(ship), lines_of(board)
    things = [*board._first._obstacles, *lines]
    at_first = [array[:1].copy() for array in ship.store]
    used = int(ship.store.whole[0, sizes["used"]]) - ship.bench.shared
    at_first[2] = ship.store.pieces[0, : used + 1].copy()
    for array in ship.store:
        array[...] = 0  # it is put there
    known = [
        *named(ship).values(), *at_first, ship.bench.order, board._place.copy(),
        driven.astype(np.int64), radii.copy(), ship.limits,
        np.array([len(board.names), len(things), len(lines), *sizes.values()]),
        _text("\0".join([*board.names, *things])), _text(described),
    ]  # fmt: skip
    failures = ", ".join(f'{{{code}, "{text}"}}' for code, text in FAILURES.items())
    striker = int(np.argmin(driven))
    parts = {
        "name": name, "version": __version__, "licence": LICENCE, "number": str(striker),
        "puck": board.names[striker].replace("*/", "* /"), "failures": failures,
        "events": ", ".join(f"PUCK_{what.upper()}" for what in g.EVENTS),
        "codes": ", ".join(f"{code} = {value}" for code, value in CODES.items()),
    }  # fmt: skip
    header, host = (filled(of, parts) for of in ("board.h", "board.c"))
    with tempfile.TemporaryDirectory() as folder:
        members = objects(folder, target.triple, ship, known, f"{name}_scene")
        Path(folder, "board.h").write_text(header, encoding="utf-8")
        Path(folder, "board.c").write_text(host, encoding="utf-8")
        run_zig(
            folder, "cc", "-target", target.system, "-std=c99", "-O2", "-fPIC", "-ffp-contract=off",
            "-fno-stack-protector", "-c", "board.c", "-o", "board.o",
        )  # fmt: skip
        run_zig(folder, "ar", "rcs", "board.a", "board.o", *members)
        return header, Path(folder, "board.a").read_bytes()


def _text(text: str) -> Any:
    return np.frombuffer(text.encode() + b"\0", np.uint8).copy()


def filled(host: str, parts: Mapping[str, str]) -> str:
    """A host as its file has it, with what is of one board."""
    text = (files("puck_tables.export") / host).read_text(encoding="utf-8")
    for name, value in parts.items():
        text = text.replace(f"/*{name}*/", value)
    return text


def require_zig() -> None:
    """Refuse where what links boards is not installed."""
    if importlib.util.find_spec("ziglang") is None:
        raise MissingExtraError("boards are linked by zig: pip install ziglang")


def run_zig(folder: str, *arguments: str) -> None:
    """Run zig in a folder."""
    run = [sys.executable, "-m", "ziglang", *arguments]
    done = subprocess.run(run, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise PuckError(f"zig cannot link the board: {done.stderr.strip()[:500]}")


@dataclass(frozen=True)
class BoardSource:
    """What plays a board without Python: a file of JavaScript, or a header and a library for C.

    Parameters
    ----------
    text : the file of JavaScript, or the header
    title : of the scene
    pucks : their names
    language : "js" or "c"
    name : of the scene in C, before ``_scene``, and of its library
    companion : what the file beside it holds: the library, or of JavaScript the types
    """

    text: str
    title: str
    pucks: tuple[str, ...]
    language: str = "js"
    name: str = ""
    companion: bytes = field(default=b"", repr=False)

    def __repr__(self) -> str:
        title = f"{self.title}, " if self.title else ""
        pucks = counted(len(self.pucks), "puck")
        return f"BoardSource({title}{pucks}, {len(self.text) + len(self.companion)} bytes)"

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the file, and beside it the library of a header, or types for TypeScript.

        Parameters
        ----------
        path : ending in .js, beside it goes .d.ts (.mjs, .cjs: .d.mts, .d.cts), or of a header in
            .h, beside it libNAME.a
        overwrite : whether existing files may be replaced

        Raises
        ------
        InputError
            If the ending is another one.
        OutputError
            If a file exists or cannot be written.
        """
        instance("path", path, str, Path)
        companion = companion_path(path, self.language, self.name)
        check_target(path, overwrite)
        write_bytes(companion, self.companion, overwrite)
        write_bytes(path, self.text.encode(), overwrite)


def companion_path(path: str | Path, language: str, name: str) -> Path:
    """Where library or types go; a file is refused whose ending is not its language's."""
    checked_ending(path, language)
    ending = Path(path).suffix
    if language == "js":
        return Path(path).with_suffix(".d" + ending.replace("js", "ts"))
    if ending != ".h":
        raise InputError(f"{path}: a board in C is a header, which ends in .h, and a library")
    return Path(path).with_name(f"lib{name}.a")


def export_board(
    scene: SceneSpec, language: str = "js", *, target: str | None = None, name: str = "board"
) -> BoardSource:
    """A file of JavaScript, or a library for C, that plays a scene as :class:`World` does.

    JavaScript is for browsers and Node.  The engine is in it, in WebAssembly: it needs nothing
    else, no server and no network.  ``await puckBoard.load()`` gives a board: ``strike``,
    ``place``, ``remove``, ``drive``, ``advance``, ``state``, ``copy``.  C is a header and a static
    library of machine code, for C++, Rust, C# as well: ``puck_board_new(&NAME_scene)`` and the
    same calls.  The first of a machine takes a minute, for the engine is compiled; others a second.

    Parameters
    ----------
    scene : Scene
        Without ranges, on a floor at rest, without constraints.
    language : "js" or "c"
    target : for C
        The machine: x86_64- or aarch64- before linux, macos or windows; this one if not given.
    name : for C
        What the scene is called there, before ``_scene``: letters, digits and _.

    Raises
    ------
    InputError
        If the scene is another one, there is no such machine, or what links is not installed.

    Notes
    -----
    The machine code is IEEE arithmetic without fused or reordered operations, with a mathematics
    library of its own, so that the same calls give the same bits wherever it runs, in WebAssembly
    as on every processor.  Against this package, which takes the library of its machine, last
    digits differ; impacts of round pucks multiply that as they multiply everything.

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
    if language not in ("c", "js"):
        raise InputError(f"boards are exported to c and js, got {shown(language)}")
    if target is not None and language == "js":
        raise InputError("target is for c: js runs on every machine")
    if _NAME.fullmatch(name) is None:
        raise InputError(f"name must be letters, digits and _, a letter first, got {shown(name)}")
    machine = checked_target(target) if language == "c" else None
    ship, board = shipped(scene.single())
    require_zig()
    if machine is not None:
        text, content = library(ship, board, json.dumps(tables_of(board.scene)), name, machine)
        return BoardSource(text, scene.title, board.names, language, name, content)
    described = _described(ship, board)
    code = base64.b64encode(gzip.compress(_webassembly(ship), mtime=0)).decode()
    free = [puck for puck, led in zip(board.names, described["driven"], strict=True) if not led]
    parts = {
        "title": _as_json(scene.title or "A board")[1:-1], "version": __version__,
        "licence": "".join(f"// {line}".rstrip() + "\n" for line in LICENCE.splitlines()),
        "puck": _as_json(next(iter(free), board.names[0])), "scene": _as_json(described),
        "code": code,
    }  # fmt: skip
    types = filled("board.d.ts", {}).encode()
    return BoardSource(filled("board.js", parts), scene.title, board.names, companion=types)


def _as_json(value: Any) -> str:
    """A value for a script, which no text of it ends."""
    return json.dumps(value).replace("<", "\\u003c")


def _described(ship: Shipped, board: Worlds) -> dict[str, Any]:
    """What the host in JavaScript must know of a board, and of the engine."""
    radii, driven = discs_of(board)
    return {
        "title": board.scene.title, "parts": tables_of(board.scene), "pucks": board.names,
        "order": ship.bench.order.tolist(),
        "radii": radii.tolist(), "driven": driven.tolist(), "obstacles": board._first._obstacles,
        "lines": lines_of(board), "events": g.EVENTS, "fastest": float(ship.limits[FASTEST]),
        "failures": FAILURES, "codes": CODES, "layout": sizes_of(ship), "arrays": [*named(ship)],
    }  # fmt: skip


def _webassembly(ship: Shipped) -> bytes:
    """The engine of a board and its arrays as one module, which imports nothing."""
    with tempfile.TemporaryDirectory() as folder:
        known = [*named(ship).values()]
        run_zig(
            folder, "cc", "-target", _SYSTEM, "-mexec-model=reactor", "-O2", "-s",
            *objects(folder, _MACHINE, ship, known, "board"), "-o", "board.wasm",
            *(f"-Wl,--export={name}" for name in ("board", "puck_play", "puck_see")),
        )  # fmt: skip
        return Path(folder, "board.wasm").read_bytes()
