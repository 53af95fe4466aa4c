"""A board as machine code: its engine and its arrays for a machine, and a library to call in C."""

from __future__ import annotations

import importlib.util
import platform
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import shown
from puck_tables._version import __version__
from puck_tables.errors import InputError, MissingExtraError, PuckError
from puck_tables.export.licence import LICENCE
from puck_tables.scene.pucks_and_posts import called_line
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
)
from puck_tables.world.stored import FOUND_COLUMNS, LACKS_PIECES, LED, LET_GO
from puck_tables.world.worlds import Worlds


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
        "found": ship.found, "states": ship.states, "moving": ship.moving,
        "contacts": room.contacts, "depth": room.work,
    }  # fmt: skip


def sizes_of(ship: Shipped) -> dict[str, int]:
    """Sizes of what a host reads and writes, and where in ``whole`` the pieces in use are told."""
    wholes = [ship.bench.whole.ctypes.data, ship.bench.engine.counts.ctypes.data]
    return {
        "numbers": ship.bench.numbers.size, "whole": ship.bench.whole.size,
        "pieces": ship.store.pieces[0].size, "columns": PIECE_COLUMNS, "event": FOUND_COLUMNS,
        "events": len(ship.found),
        "shared": ship.bench.shared, "used": (wholes[1] - wholes[0]) // 8 + g.N_PIECES,
    }  # fmt: skip


def lines_of(board: Worlds) -> list[str]:
    """The names of its lines."""
    return [called_line(board.scene.lines, k) for k in range(len(board.scene.lines))]


def discs_of(board: Worlds) -> tuple[FloatArray, Any]:
    """The radius of each puck, m, and whether it is driven."""
    discs = board._first._engine.discs[board._place]
    return discs[:, RADIUS], discs[:, LIGHTNESS] == 0.0


def objects(folder: str, triple: str, ship: Shipped, known: list[Any], symbol: str) -> list[str]:
    """Object files in a folder: the engine, and a board with a table of what is known outside."""
    from puck_tables.kernels.ahead import Outside, code_for
    from puck_tables.kernels.memory_image import arrays_for

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
