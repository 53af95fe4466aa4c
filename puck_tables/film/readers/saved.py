"""Films in the files that this program saves: HDF5, JSON and JSON lines, beside CSV.

They have a column each of ``time``, ``x`` and ``y``, and perhaps ``orientation``, and ``name`` of
several pucks, with their units; JSON lines have none, which are then asked for.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.safe_read import read_whole
from puck_tables._core.units import unit_named
from puck_tables.errors import InputError
from puck_tables.film.column_roles import Layout
from puck_tables.film.film import Film, Reader, first_text
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_of_columns

_LARGEST = 1 << 29  # bytes of JSON
_NEEDED = ("time", "x", "y")
# what a column is, and of what kind its unit
_ROLES = {
    "time": ("time", "time"), "x": ("x", "length"), "y": ("y", "length"),
    "orientation": ("angle", "angle"), "name": ("id", ""),
}  # fmt: skip
_WRONG = (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError)


def film_of_saved(path: str | Path, columns: Mapping[str, tuple[Any, str]]) -> Film:
    """The film in columns of these names: the values (n,) and the unit of each, '' if none is said.

    Examples
    --------
    >>> columns = {"time": ([0, 1], "s"), "x": ([0, 2], "m"), "y": ([0, None], "m")}
    >>> film = film_of_saved("a.h5", columns)
    >>> film.unit, film.bodies[0].marks[""].tolist()
    ('m', [[0.0, 0.0], [2.0, nan]])
    """
    if not set(_NEEDED) <= set(columns):
        raise InputError(
            f"{path} has no columns time, x and y, as puck track saves them: save the table as CSV"
        )
    layout, values, words = Layout([], "file of saved tracks", likely=None), {}, {}
    for name, (role, kind) in _ROLES.items():
        if name not in columns:
            continue
        n, (told, unit) = len(layout.columns), columns[name]
        if kind:
            try:
                values[n] = np.array(told, np.float64)
            except _WRONG:
                raise InputError(f"{path}: its column {name} does not hold numbers") from None
            unit = unit_named(f"{path}: the unit of {name}", unit, kind) if unit else ""
        else:
            names = list(dict.fromkeys(map(str, told)))
            words[n] = np.array([names.index(str(one)) for one in told]), names
        layout.columns.append(("", Heading(role, "", unit)))
    rows = {one.shape for one in (*values.values(), *(codes for codes, _ in words.values()))}
    if len(rows) != 1 or len(size := rows.pop()) != 1 or not size[0]:
        raise InputError(f"{path} holds no table with a row for each frame of a track")
    return film_of_columns(path, layout, values, words)


def _film(path: str | Path, head: bytes) -> Film:
    """The film in a file of JSON, or of JSON lines."""
    content = read_whole(path, _LARGEST)
    try:
        rows = [json.loads(line) for line in content.splitlines() if line.strip()]
    except _WRONG:  # one object over several lines
        rows = []
    try:
        whole = json.loads(content) if len(rows) < 2 else {}
        if isinstance(whole.get("columns"), dict):
            columns = {
                name: (one["values"], str(one.get("unit") or ""))
                for name, one in whole["columns"].items() if name in _ROLES
            }  # fmt: skip
        else:
            first = rows[0] if rows else {}
            columns = {
                name: ([row.get(name) for row in rows], "")
                for name in first if name in _ROLES
            }  # fmt: skip
    except _WRONG:
        raise InputError(f"{path} looks like JSON and is none: save the table as CSV") from None
    try:
        return film_of_saved(path, columns)
    except InputError as error:
        raise InputError(f"{error} (it looks like JSON)") from None


READERS = (Reader(lambda path, head: first_text(path, head).startswith("{"), _film),)
