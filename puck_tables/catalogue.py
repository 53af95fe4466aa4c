"""Every kind of table there is: read, described and judged by one call each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from puck_tables.similarity import check as stop_check
from puck_tables.similarity import file as stop_file
from puck_tables.similarity.stop_table import StopTable
from puck_tables.table import check, file, law_file, partial_file, speed_file
from puck_tables.table.check import CheckReport
from puck_tables.table.container import decode, read_content
from puck_tables.table.law_check import validate_law
from puck_tables.table.law_table import LawTable
from puck_tables.table.partial_check import validate_partial
from puck_tables.table.partial_table import PartialTable
from puck_tables.table.speed_check import validate_speed
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import FUNCTIONS, Table

AnyTable = Table | StopTable | PartialTable | LawTable | SpeedTable
Progress = Callable[[int, int], None]

_FILES = {module.KIND: module for module in (file, stop_file, partial_file, law_file, speed_file)}


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
    source = str(path)
    kinds = {kind: module.shapes for kind, module in _FILES.items()}
    contents = decode(read_content(path), source, kinds)
    table: AnyTable = _FILES[contents.attributes["kind"]].table_of(contents, source)
    return table


def tables_that_come_along() -> list[AnyTable]:
    """The tables of the package.

    Examples
    --------
    >>> [table.tolerance for table in tables_that_come_along()]
    [2e-11, 1e-10, 1e-06]
    """
    return [file.load_table(), stop_file.load_stop_table(), partial_file.load_partial_table()]


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
    nodes, heights = table.values.shape[:2]
    if isinstance(table, SpeedTable):
        return FUNCTIONS, f"{nodes} phi x {heights} speed nodes"
    return FUNCTIONS, f"{nodes} phi x {heights} delta nodes"


def judge(table: AnyTable, progress: Progress | None = None) -> CheckReport:
    """The report of the check that belongs to the kind of a table.

    Raises
    ------
    InputError
        If the table is one of a pressure profile: its file does not hold the profile.
    """
    if isinstance(table, Table):
        return check.validate(table, progress)
    if isinstance(table, StopTable):
        return stop_check.validate_stops(table, progress)
    if isinstance(table, SpeedTable):
        return validate_speed(table)
    return validate_law(table) if isinstance(table, LawTable) else validate_partial(table)
