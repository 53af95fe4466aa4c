"""Every kind of table there is: read, described and judged by one call each."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from puck_tables import store
from puck_tables.errors import TableError
from puck_tables.similarity import check as stop_check
from puck_tables.similarity import file as stop_file
from puck_tables.similarity.stop_table import StopTable
from puck_tables.table import check, file, law_file, partial_file, speed_file
from puck_tables.table.check import CheckReport
from puck_tables.table.container import read_content, read_table
from puck_tables.table.law_check import validate_law
from puck_tables.table.law_table import LawTable
from puck_tables.table.partial_check import validate_partial
from puck_tables.table.partial_table import PartialTable
from puck_tables.table.speed_check import validate_speed
from puck_tables.table.speed_table import INTEGRALS, SpeedTable
from puck_tables.table.table import FUNCTIONS, Table

AnyTable = Table | StopTable | PartialTable | LawTable | SpeedTable
Progress = Callable[[int, int], None]

_KINDS = {
    module.KIND: module.STORED for module in (file, stop_file, partial_file, law_file, speed_file)
}


def load_any_table(path: str | Path) -> AnyTable:
    """Read a table file of any kind.

    Raises
    ------
    TableError
        As :func:`puck_tables.load_table`.

    Examples
    --------
    >>> load_any_table("/nowhere/table.h5")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: there is no table file /nowhere/table.h5: build one with \
'puck build-tables -o FILE', or leave --table out to use the tables that come along
    """
    return _table_in(read_content(path), str(path))


def _table_in(content: bytes, source: str) -> AnyTable:
    table: AnyTable = read_table(content, source, _KINDS)
    return table


def tables_that_come_along() -> list[AnyTable]:
    """The tables of the package.

    Examples
    --------
    >>> [table.tolerance for table in tables_that_come_along()]
    [2e-11, 1e-10, 1e-06]
    """
    return [file.load_table(), stop_file.load_stop_table(), partial_file.load_partial_table()]


class Entry(NamedTuple):
    """A table file in a list: its passport in short; the blanks of a damaged one are None."""

    name: str
    place: str
    kind: str | None
    pressure_law: str | None
    valid_range: str | None
    accuracy: float | None
    bytes: int
    date: str
    whole: bool


def shipped_and_kept() -> list[Entry]:
    """The table files that come along, and those kept in the user's cache.

    Examples
    --------
    >>> [entry.name for entry in shipped_and_kept() if entry.place == "comes along"]
    ['partial.h5', 'resultants.h5', 'stops.h5']
    """
    folder = files("puck_tables.tables")
    names = sorted(path.name for path in folder.iterdir() if path.name.endswith(".h5"))
    shipped = [_entry(name, "comes along", (folder / name).read_bytes(), "") for name in names]
    return shipped + [entry for path in store.kept_files() if (entry := _kept(path)) is not None]


def _kept(path: Path) -> Entry | None:
    """None if another process has just removed it."""
    try:
        date = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
        return _entry(path.name, str(path.parent), read_content(path), date)
    except FileNotFoundError:
        return None
    except TableError:
        return Entry(path.name, str(path.parent), None, None, None, None, 0, date, False)


def _entry(name: str, place: str, content: bytes, date: str) -> Entry:
    try:
        table = _table_in(content, name)
    except TableError:
        return Entry(name, place, None, None, None, None, len(content), date, False)
    said = table.passport
    return Entry(
        name, place, said["kind"], said["pressure_law"], said["valid_range"], table.tolerance,
        len(content), said["created"], True,
    )  # fmt: skip


def functions_and_grid(table: AnyTable) -> tuple[tuple[str, ...], str]:
    """What a table tabulates, and on how many nodes.

    Examples
    --------
    >>> functions_and_grid(tables_that_come_along()[0])
    (('parallel', 'perpendicular', 'spin'), '991 phi x 4 delta nodes')
    """
    if isinstance(table, StopTable):
        return stop_check.NAMES, f"{table.axis.size} phi x {table.values.shape[1]} delta nodes"
    if isinstance(table, LawTable):
        sides, nodes, heights = table.values.shape[:3]
        return FUNCTIONS, f"{sides} sides of {nodes} phi x {heights} delta nodes"
    if isinstance(table, SpeedTable):
        return INTEGRALS, f"{len(table.values)} nodes in {len(table.cells)} patches"
    nodes, heights = table.values.shape[:2]
    return FUNCTIONS, f"{nodes} phi x {heights} delta nodes"


def judge(table: AnyTable, progress: Progress | None = None) -> CheckReport:
    """The report of the check that belongs to the kind of a table.

    Raises
    ------
    InputError
        If the table is of a pressure profile, from before files held it.
    """
    if isinstance(table, Table):
        return check.validate(table, progress)
    if isinstance(table, StopTable):
        return stop_check.validate_stops(table, progress)
    if isinstance(table, SpeedTable):
        return validate_speed(table)
    return validate_law(table) if isinstance(table, LawTable) else validate_partial(table)
