"""A board as a file of JavaScript, or as a library for C: the engine, the scene, a small host."""

from __future__ import annotations

import base64
import gzip
import json
import re
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from puck_tables._core.real import instance, shown
from puck_tables._core.safe_write import check_target, write_bytes
from puck_tables._core.wording import counted
from puck_tables._version import __version__
from puck_tables.errors import InputError
from puck_tables.export.board_library import (
    CODES,
    FAILURES,
    checked_target,
    discs_of,
    filled,
    library,
    lines_of,
    named,
    objects,
    require_zig,
    run_zig,
    sizes_of,
)
from puck_tables.export.licence import LICENCE
from puck_tables.export.source import checked_ending
from puck_tables.scene.entries import tables_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import EVENTS
from puck_tables.world.shipped import FASTEST, Shipped, shipped
from puck_tables.world.worlds import Worlds

_MACHINE, _SYSTEM = "wasm32-unknown-unknown", "wasm32-wasi"  # of LLVM, and of the libraries
_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)


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
        beside = companion_path(path, self.language, self.name)
        check_target(path, overwrite)
        write_bytes(beside, self.companion, overwrite)
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
        "lines": lines_of(board), "events": EVENTS, "fastest": float(ship.limits[FASTEST]),
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
