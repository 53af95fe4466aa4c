"""Films in the files that this program saves: HDF5, JSON and JSON lines, beside CSV.

They have a column each of ``time``, ``x`` and ``y``, and perhaps ``orientation``, and ``name`` of
several pucks, with their units; JSON lines have none, which are then asked for.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.safe_read import read_whole
from puck_tables._core.units import factor, unit_given
from puck_tables.errors import InputError
from puck_tables.film.film import Film, TrackedBody

_LARGEST = 1 << 29  # bytes of JSON
_NEEDED = ("time", "x", "y")
_KINDS = {"time": "time", "x": "length", "y": "length", "orientation": "angle"}
_WRONG = (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError)


class Quantity(NamedTuple):
    """Values (n,) and their unit, '' where the file does not say it."""

    values: Any
    unit: str


def film_of_columns(path: str | Path, columns: Mapping[str, Quantity]) -> Film:
    """The film in columns of these names.

    Raises
    ------
    InputError
        If there are none, or they are no rows of one frame each.

    Examples
    --------
    >>> columns = {"time": ([0, 1], "s"), "x": ([0, 2], "m"), "y": ([0, None], "m")}
    >>> film = film_of_columns("a.h5", {name: Quantity(*one) for name, one in columns.items()})
    >>> film.unit, film.bodies[0].marks[""].tolist()
    ('m', [[0.0, 0.0], [2.0, nan]])
    """
    if not set(_NEEDED) <= set(columns):
        raise InputError(
            f"{path} has no columns time, x and y, as puck track saves them: save the table as CSV"
        )
    numbers, units = {}, {}
    for name, kind in _KINDS.items():
        if name in columns:
            try:
                numbers[name] = np.array(columns[name].values, np.float64)
            except _WRONG:
                raise InputError(f"{path}: its column {name} does not hold numbers") from None
            unit = columns[name].unit
            units[name] = unit_given(f"{path}: the unit of {name}", unit, kind) if unit else ""
    names = [str(one) for one in columns["name"].values] if "name" in columns else []
    size = numbers["time"].size
    rows = {one.shape for one in numbers.values()} | ({(len(names),)} if names else set())
    if rows != {(size,)} or not size:
        raise InputError(f"{path} holds no table with a row for each frame of a track")
    if units["x"] != units["y"]:
        raise InputError(f"{path}: its columns x and y are not in one unit: save the table as CSV")
    film = Film(
        "file of saved tracks", [], units["x"], units.get("orientation", ""),
        timed=bool(units["time"]),
    )  # fmt: skip
    numbers["time"] *= factor(units["time"] or "s", "time")
    owners = np.array(names or [""] * size)
    for owner in dict.fromkeys(owners.tolist()):
        mine = owners == owner
        place = np.column_stack([numbers["x"][mine], numbers["y"][mine]])
        body = TrackedBody(owner, {"": place}, time=numbers["time"][mine])
        if "orientation" in numbers:
            body.angles[""] = numbers["orientation"][mine]
        film.bodies.append(body)
    return film


def film_of_json(path: str | Path) -> Film:
    """The film in a file of JSON, or of JSON lines.

    Raises
    ------
    InputError
        If it is none.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     lines = '{"time": 0.0, "x": 1.0, "y": 2.0}' + chr(10)
    ...     _ = Path(folder, "a.jsonl").write_text(lines)
    ...     film_of_json(Path(folder, "a.jsonl")).bodies[0].marks[""].tolist()
    [[1.0, 2.0]]
    """
    content = read_whole(path, _LARGEST)
    try:
        rows = [json.loads(line) for line in content.splitlines() if line.strip()]
    except _WRONG:  # one object over several lines
        rows = []
    try:
        whole = json.loads(content) if len(rows) < 2 else {}
        if isinstance(whole.get("columns"), dict):
            columns = {
                name: Quantity(one["values"], str(one.get("unit") or ""))
                for name, one in whole["columns"].items() if name in (*_KINDS, "name")
            }  # fmt: skip
        else:
            first = rows[0] if rows else {}
            columns = {
                name: Quantity([row.get(name) for row in rows], "")
                for name in first if name in (*_KINDS, "name")
            }  # fmt: skip
    except _WRONG:
        raise InputError(f"{path} looks like JSON and is none: save the table as CSV") from None
    try:
        return film_of_columns(path, columns)
    except InputError as error:
        raise InputError(f"{error} (it looks like JSON)") from None
