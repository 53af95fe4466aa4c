"""Exported files compiled or interpreted, and launches to try them at."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.export.source import export_source

WIDTHS = {
    "stop": (6, 5), "state": (7, 6), "turn": (6, 1), "resultants": (2, 3), "wrench": (4, 3),
    "step": (8, 6),
}  # fmt: skip
Run = Callable[[str, np.ndarray], tuple[np.ndarray, np.ndarray]]


def compiled(text: str, folder: Path) -> Run:
    """C, by gcc, with every warning an error."""
    loops = "".join(
        f"void many_{name}(int n, const double *in, double *out, int *codes) {{\n"
        f"  for (int i = 0; i < n; i++, in += {wide}, out += {given})\n"
        f"    codes[i] = puck_{name}({', '.join(f'in[{k}]' for k in range(wide))}, out);\n}}\n"
        for name, (wide, given) in WIDTHS.items() if f"puck_{name}(" in text
    )  # fmt: skip
    (folder / "puck.c").write_text(text)
    (folder / "many.c").write_text(f'#include "puck.c"\n{loops}')
    command = "gcc -std=c99 -O2 -Wall -Wextra -Werror -shared -fPIC many.c -o many.so -lm"
    done = subprocess.run(command.split(), cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    library = ctypes.CDLL(str(folder / "many.so"))
    assert library.puck_self_test() == 0

    def run(name: str, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        out = np.empty((len(rows), WIDTHS[name][1]))
        codes = np.empty(len(rows), np.int32)
        pointers = (one.ctypes.data_as(ctypes.c_void_p) for one in (rows, out, codes))
        getattr(library, f"many_{name}")(len(rows), *pointers)
        return out, codes

    return run


_NODE = """
const fs = require("fs"), puck = require("./puck.js");
const [name, wide, given] = [process.argv[2], +process.argv[3], +process.argv[4]];
if (puck.self_test() !== 0 || globalThis.puckTables.self_test() !== 0) process.exit(9);
const bytes = fs.readFileSync("in.bin");
const rows = new Float64Array(bytes.buffer, bytes.byteOffset, bytes.length / 8);
const n = rows.length / wide, out = new Float64Array(n * given), codes = new Int32Array(n);
for (let i = 0; i < n; i++) {
  const to = out.subarray(i * given, (i + 1) * given);
  codes[i] = puck[name](...rows.subarray(i * wide, (i + 1) * wide), to);
}
fs.writeFileSync("out.bin", out);
fs.writeFileSync("codes.bin", codes);
"""


def by_node(text: str, folder: Path) -> Run:
    """JavaScript, by node."""
    (folder / "puck.js").write_text(text)
    (folder / "many.js").write_text(_NODE)

    def run(name: str, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rows.tofile(folder / "in.bin")
        command = ["node", "many.js", name, *map(str, WIDTHS[name])]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        out = np.fromfile(folder / "out.bin").reshape(len(rows), -1)
        return out, np.fromfile(folder / "codes.bin", np.int32)

    return run


def by_python(text: str, folder: Path) -> Run:
    """Python, here."""
    names: dict[str, Callable[..., int]] = {}
    exec(text, names)
    assert names["self_test"]() == 0

    def run(name: str, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        results, codes = [], []
        for row in rows.tolist():
            out = [0.0] * WIDTHS[name][1]
            codes.append(names[name](*row, out))
            results.append(out)
        return np.array(results), np.array(codes)

    return run


RUNNERS = {"c": (compiled, "gcc"), "js": (by_node, "node"), "python": (by_python, "python3")}


@cache
def text_of(language: str, what: str, tol: float) -> str:
    return export_source(language, what, tol).text


def runner(language: str, tol: float, folder: Path, what: str = "stop,state,resultants") -> Run:
    """What runs an exported file; a test that asks for one is skipped without its program."""
    make, program = RUNNERS[language]
    if shutil.which(program) is None:
        pytest.skip(f"there is no {program} here")
    return make(text_of(language, what, tol), folder)


def launches(count: int, seed: int) -> np.ndarray:
    """vx, vy, ω, δ, J, r: of all slip angles, many of them on and beside the singular lines."""
    rng = np.random.default_rng(seed)
    heading = rng.uniform(-np.pi, np.pi, count)
    ratio = np.exp(rng.normal(0.0, 3.0, count))  # r|ω|/v
    near = rng.integers(0, 4, count)
    ratio = np.where(near == 1, 1.0 + rng.normal(0.0, 1e-4, count), ratio)
    ratio = np.where(near == 2, 1.5 * np.exp(rng.normal(0.0, 0.02, count)), ratio)
    slip, decel, radius = 10.0 ** rng.uniform(-3.0, 3.0, (3, count))
    speed = slip / np.hypot(1.0, ratio)
    spin = rng.choice([-1.0, 1.0], count) * speed * ratio / radius
    delta = rng.uniform(0.0, 1.0, count)
    delta[::7], delta[1::7] = 0.0, 1.0
    spin[::11], speed[5::11] = 0.0, 0.0
    speed[::97] = spin[::97] = 0.0
    return np.column_stack(
        [speed * np.cos(heading), speed * np.sin(heading), spin, delta, decel, radius]
    )


def units(rows: np.ndarray, name: str) -> np.ndarray:
    """The units of errors: of each result of each launch."""
    edge = rows[:, 5] * rows[:, 2]
    slip = np.hypot(np.hypot(rows[:, 0], rows[:, 1]), edge)
    time, place = slip / rows[:, 4], slip / rows[:, 4] * slip
    if name == "stop":
        found = [time, place, place, place, place / rows[:, 5]]
    elif name == "state":
        found = [place, place, place / rows[:, 5], slip, slip, slip / rows[:, 5]]
    else:
        found = [np.ones_like(slip)]
    return np.maximum(np.column_stack(found), 1e-300)


def answers(
    rows: np.ndarray, rng: np.random.Generator, resultants: Any, tol: float = 1e-10, **puck: Any
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Arguments and answers of the library to launches, by function, for a kind of puck."""
    count = len(rows)
    kind = {"delta": rows[:, 3], "decel": rows[:, 4], "radius": rows[:, 5], **puck}
    stops = pt.stop(rows[:, :2], rows[:, 2], tol=tol, **kind)
    share = np.where(
        rng.random(count) < 0.3, 1.0 - 10.0 ** -rng.uniform(0.0, 8.0, count),
        rng.uniform(0.0, 1.02, count),
    )  # fmt: skip
    share[::50] = 0.0
    times = share * stops.stop_time
    there = pt.states(rows[:, :2], rows[:, 2], times, **kind)
    phi = rng.uniform(-0.5 * np.pi, 0.5 * np.pi, count)
    phi[::5] = 0.25 * np.pi * (1.0 + 1e-7 * rng.normal(0.0, 1.0, phi[::5].size))
    phi[:4] = 0.0, 0.5 * np.pi, -0.5 * np.pi, 0.25 * np.pi
    rho = resultants(phi, rows[:, 3])
    return {
        "stop": (rows, np.column_stack([
            stops.stop_time, stops.stop_position, stops.path_length, stops.body_angle,
        ])),
        "turn": (rows, stops.turn_angle[:, None]),
        "state": (np.column_stack([rows, times]), np.column_stack([
            there.x, there.y, there.orientation, there.vx, there.vy, there.spin,
        ])),
        "resultants": (np.column_stack([phi, rows[:, 3]]), np.column_stack(list(rho))),
    }  # fmt: skip
