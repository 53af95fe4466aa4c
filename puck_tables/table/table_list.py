"""The tables that there are: those that come along, and those kept on this machine."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

from puck_tables.errors import TableError
from puck_tables.table.table import Table
from puck_tables.table.table_store import kept_files

_OF_A_WHOLE_ONE = ("kind", "pressure_law", "valid_range", "accuracy")


def shipped_and_kept() -> list[dict[str, Any]]:
    """The table files that come along, and those kept in the user's cache.

    Of each its name, place, what it holds in short (None of a damaged one), bytes, date, and
    whether it is whole.

    Examples
    --------
    >>> [entry["name"] for entry in shipped_and_kept() if entry["place"] == "comes along"]
    ['resultants.h5', 'stops.h5']
    """
    along = [Path(str(one)) for one in files("puck_tables.tables").iterdir()]
    places = {path: "comes along" for path in sorted(along) if path.suffix == ".h5"}
    entries = []
    for path, place in (places | {path: str(path.parent) for path in kept_files()}).items():
        try:
            about = path.stat()
        except FileNotFoundError:  # another process has just removed it
            continue
        date = datetime.fromtimestamp(about.st_mtime, UTC).isoformat(timespec="seconds")
        holds: tuple[Any, ...] = (None,) * len(_OF_A_WHOLE_ONE)
        try:
            table = Table.load(path)
            holds = table.kind, table.pressure_law, table.valid_range, table.tolerance
            date, whole = table.metadata["created"], True
        except TableError:
            whole = False
        entries.append({
            "name": path.name, "place": place, **dict(zip(_OF_A_WHOLE_ONE, holds, strict=True)),
            "bytes": about.st_size, "date": date, "whole": whole,
        })  # fmt: skip
    return entries
