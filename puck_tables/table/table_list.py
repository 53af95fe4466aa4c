"""The tables that there are: those that come along, and those kept on this machine."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from puck_tables.errors import TableError
from puck_tables.table.file import read_content
from puck_tables.table.table import Table
from puck_tables.table.table_cache import kept_files


class KeptTable(NamedTuple):
    """A table file in a list: its metadata in short; the blanks of a damaged one are None."""

    name: str
    place: str
    kind: str | None
    pressure_law: str | None
    valid_range: str | None
    accuracy: float | None
    bytes: int
    date: str
    whole: bool


def shipped_and_kept() -> list[KeptTable]:
    """The table files that come along, and those kept in the user's cache.

    Examples
    --------
    >>> [entry.name for entry in shipped_and_kept() if entry.place == "comes along"]
    ['resultants.h5', 'stops.h5']
    """
    folder = files("puck_tables.tables")
    names = sorted(path.name for path in folder.iterdir() if path.name.endswith(".h5"))
    shipped = [_entry(name, "comes along", (folder / name).read_bytes(), "") for name in names]
    return shipped + [entry for path in kept_files() if (entry := _kept(path)) is not None]


def _kept(path: Path) -> KeptTable | None:
    """None if another process has just removed it."""
    try:
        date = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
        return _entry(path.name, str(path.parent), read_content(path), date)
    except FileNotFoundError:
        return None
    except TableError:
        return KeptTable(path.name, str(path.parent), None, None, None, None, 0, date, False)


def _entry(name: str, place: str, content: bytes, date: str) -> KeptTable:
    try:
        table = Table.read(content, name)
    except TableError:
        return KeptTable(name, place, None, None, None, None, len(content), date, False)
    return KeptTable(
        name, place, table.kind, table.pressure_law, table.valid_range, table.tolerance,
        len(content), table.metadata["created"], True,
    )  # fmt: skip
