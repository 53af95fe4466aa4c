"""The tables that there are: those that come along, and those kept on this machine."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from puck_tables.errors import TableError
from puck_tables.table.table import Table
from puck_tables.table.table_store import kept_files


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
    along = [Path(str(one)) for one in files("puck_tables.tables").iterdir()]
    shipped = sorted(path for path in along if path.suffix == ".h5")
    found = [_entry(path, "comes along") for path in shipped]
    found += [_entry(path, str(path.parent)) for path in kept_files()]
    return [entry for entry in found if entry is not None]


def _entry(path: Path, place: str) -> KeptTable | None:
    """None if another process has just removed it."""
    try:
        about = path.stat()
    except FileNotFoundError:
        return None
    date = datetime.fromtimestamp(about.st_mtime, UTC).isoformat(timespec="seconds")
    try:
        table = Table.load(path)
    except TableError:
        return KeptTable(path.name, place, None, None, None, None, about.st_size, date, False)
    return KeptTable(
        path.name, place, table.kind, table.pressure_law, table.valid_range, table.tolerance,
        about.st_size, table.metadata["created"], True,
    )  # fmt: skip
