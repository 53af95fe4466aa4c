"""Tables altered by somebody who can make every digest right."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
from kinds_of_table import answers, small

from puck_tables import Table
from puck_tables.errors import InputError, TableError
from puck_tables.table.file import FORMAT, recipe_digest, sealed

Edit = Callable[[dict[str, object], dict[str, np.ndarray]], None]
AXES = ("phi", "delta", "node", "patch", "profile_radius", "profile_pressure")


def honest(kind: str, folder: Path) -> bytes:
    """The bytes of a small table of a kind."""
    path = folder / f"{kind}.h5"
    if not path.exists():
        small(kind).save(path)
    return path.read_bytes()


def forged(content: bytes, edit: Edit) -> bytes:
    """The same file with other attributes and arrays, every digest right."""
    with h5py.File(io.BytesIO(content), "r") as file:
        attributes = {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in file.attrs.items()
        }
        arrays = {name: np.array(file[name]) for name in file}
    edit(attributes, arrays)
    attributes.pop("content_digest", None)
    recipe_names = {
        "kind", "pressure_law", "algorithm", "phi_map", "delta_map", "splined", "map", "n_phi",
        "cells", "profile_rows", "law_kind", "law_speeds", "law_values", "breaks", "nodes",
        "patches", "largest_f", "delta", "cotangents", "gyration", "friction_error",
    }  # fmt: skip
    if "recipe_digest" in attributes:
        recipe = {name: value for name, value in attributes.items() if name in recipe_names}
        attributes["recipe_digest"] = recipe_digest(recipe)
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        for name, array in arrays.items():
            file.create_dataset(name, data=array)
        file.attrs.update(attributes)
        file.attrs["content_digest"] = content_digest(attributes, arrays)
    return sealed(buffer.getvalue())


def content_digest(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> str:
    """As a file has it: all attributes, then the arrays in the order of its kind."""
    import hashlib

    kinds = {
        "resultants": (
            "phi", "delta", "parallel", "perpendicular", "spin", "profile_radius",
            "profile_pressure",
        ),
        "stops": ("phi", "delta", "time", "along", "across", "length", "body", "curve", "turn"),
        "friction section": (
            "phi", "inverse_parallel", "perpendicular_share", "spin_share", "profile_radius",
            "profile_pressure",
        ),
        "stop section": (
            "phi", "time", "along", "across", "length", "body", "turn", "profile_radius",
            "profile_pressure",
        ),
        "speed": ("node", "p_a", "p_b", "p_d", "p_e", "patch", "halvings"),
    }  # fmt: skip
    digest = hashlib.sha256(json.dumps(attributes, sort_keys=True, default=str).encode())
    for name in kinds.get(str(attributes.get("kind")), ()):
        if name in arrays:
            digest.update(json.dumps(arrays[name].shape).encode())
            digest.update(np.ascontiguousarray(arrays[name], dtype="<f8").tobytes())
    return digest.hexdigest()


def random_edit(kind: str, rng: np.random.Generator) -> tuple[str, Edit]:
    """A change of values or of what the file says of itself, and what it is called."""
    factor = float(rng.choice([0.5, -1.0, 2.0, 0.0, 1.001, 1.0 - 1e-4, 1e308, 1e-308, np.nan]))
    share = rng.random(4)

    def functions(arrays: dict[str, np.ndarray]) -> list[str]:
        return [name for name in arrays if name not in AXES]

    def node(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = functions(arrays)
        array = arrays[names[int(share[0] * len(names))]]
        place = tuple(int(s * n) for s, n in zip(share[1:], array.shape, strict=False))
        array[place] *= factor
        if array[place] == 0.0:
            array[place] = factor

    def row(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = functions(arrays)
        array = arrays[names[int(share[0] * len(names))]]
        array[int(share[1] * len(array))] *= factor

    def bump(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = functions(arrays)
        array = arrays[names[int(share[0] * len(names))]]
        where = np.arange(len(array)) / len(array) - share[1]
        size = 10.0 ** -(1.0 + 3.0 * share[2])
        array += size * np.exp(-((4.0 * where) ** 2)).reshape(-1, *[1] * (array.ndim - 1))

    def everything(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        for name in functions(arrays):
            arrays[name] *= factor

    def exchanged(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = functions(arrays)
        one, other = names[int(share[0] * len(names))], names[int(share[1] * len(names))]
        arrays[one], arrays[other] = arrays[other], arrays[one]

    def turned(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        for name in functions(arrays):
            arrays[name] = arrays[name][::-1].copy()

    def claim(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        attributes["tolerance"] = float(rng.choice([1e-15, 1e-13, 1e-9, 0.5, 0.999]))
        arrays[functions(arrays)[0]][1] *= 1.0 + 1e-3 * share[0]

    def yardstick(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        stated = json.loads(str(attributes["achieved_accuracy"]))
        for key, value in stated.items():
            stated[key] = [1e9 for _ in value] if isinstance(value, list) else 10**9
        attributes["achieved_accuracy"] = json.dumps(stated)
        if "largest_f" in attributes:
            attributes["largest_f"] = 1e9
        arrays[functions(arrays)[-1]][len(arrays[functions(arrays)[-1]]) // 2] *= 1.01

    def number(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = sorted(n for n, v in attributes.items() if isinstance(v, int | float))
        name = names[int(share[0] * len(names))]
        new = rng.choice([0, 1, -1, 2, 0.5, 1.5, 1e300, 1e-300, np.nan, np.inf, 10.0**9])
        old = attributes[name]
        attributes[name] = type(old)(new) if abs(new) < 2.0**62 else float(new)

    def text(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = ["pressure_law", "achieved_accuracy", "kind", "format_version",
                 "law_speeds", "law_values", "law_kind", "breaks"]  # fmt: skip
        present = [name for name in names if name in attributes]
        attributes[present[int(share[0] * len(present))]] = str(rng.choice([
            "uniform", "ring", "hertz", "annulus:0.5", "", "[]", "{}", "null", "[0.5, 1.0]",
            "[0.0, 1.0, 2.0]", "[0.1, 0.2, 0.3]", "1.0", "9.9", "stops", "linear", "[[1]]", "\0",
        ]))  # fmt: skip

    def missing(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = sorted(attributes)
        del attributes[names[int(share[0] * len(names))]]

    def mistyped(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        names = sorted(set(attributes) - {"format"})
        name = names[int(share[0] * len(names))]
        attributes[name] = [7, 7.5, "seven", 2**62][int(share[1] * 4)]

    edits = [node, node, node, row, bump, everything, exchanged, turned, claim, yardstick, number,
             number, text, missing, mistyped]  # fmt: skip
    edit = edits[int(rng.integers(len(edits)))]
    return f"{kind}: {edit.__name__} {factor:g} {share.round(3).tolist()}", edit


def outcome(content: bytes, truth: Table, folder: Path) -> str:
    """What becomes of a forged table: refused, failed by validate, right, or WRONG and passed."""
    path = folder / "forged.h5"
    path.write_bytes(content)
    try:
        table = Table.load(path)
        found = answers(table)
    except (TableError, InputError):
        return "refused"
    same = type(table) is type(truth)
    allowed = min(table.tolerance, 0.01) + truth.tolerance
    scale = (
        100.0 if truth.kind in ("stops", "stop section") else 1.0
    )  # of the turn, which is less exact
    with np.errstate(invalid="ignore"):
        right = same and bool(np.all(np.abs(found - answers(truth)) <= scale * allowed))
    try:
        report = table.validate()
    except (TableError, InputError):
        return "refused"
    if not report.passed:
        return "failed"
    return "right" if right else "WRONG"


assert FORMAT == "puck-tables"
