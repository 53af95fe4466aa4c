"""Columns of numbers, given as rows or from a text file, by what their headings say: in SI units.

Friction laws, profiles, forces, paths, corners, restitutions and targets are read here; tracks and
logs of engines, which hold more, by the same reader of text (:mod:`puck_tables._core.text`).
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.doubts import MOST_FRICTION
from puck_tables._core.own_folder import say
from puck_tables._core.quantities import (
    ALL,
    FRICTION,
    InputColumn,
    is_frame,
    known_as,
    measures,
    unit_of,
    with_names,
)
from puck_tables._core.safe_read import content_of, refuse_no_text, refuse_others
from puck_tables._core.text import HEAD, MINUS, TextForm, encoding_of, is_row, number, text_form_of
from puck_tables._core.text_rows import header_of, read_columns
from puck_tables._core.units import EXAMPLES, unit_size
from puck_tables.errors import InputError

_SHOWN = 8  # headings in a message
_KEPT = 1 << 16  # bytes of a file whose numbers are kept


@dataclass(frozen=True)
class Numbers:
    """Rows of numbers in SI units, and where they stand.

    ``rows``: array (n, k), a column for each that was wanted and is there; ``units``: of each, as
    its heading says it, '' if it says none.
    """

    rows: FloatArray
    units: tuple[str, ...]
    path: str = ""
    line: Callable[[int], int] | None = None

    def where(self, row: int) -> str:
        """A row in a message, by its line in the file."""
        return f"{self.path}, line {self.line(row)}" if self.line else f"row {row + 1}"

    def refuse_unless_ascending(self, what: str, equal: bool = False) -> None:
        """Refuse a first column that does not ascend, or of one row alone.

        ``what``: what stands in it, for the message: 'the speeds'; ``equal``: whether neighbours
        may be equal.
        """
        first = self.rows[:, 0]
        if first.size < 2:
            raise InputError(f"{self.where(0)} is the only row of numbers: two or more are needed")
        wrong = np.flatnonzero(np.diff(first) < 0.0 if equal else np.diff(first) <= 0.0)
        if wrong.size:
            n = int(wrong[0])
            how = "again" if first[n + 1] == first[n] else f"after {first[n]:.9g}"
            raise InputError(f"{self.where(n + 1)}: {first[n + 1]:.9g} {how}: {what} must ascend")


def numbers_of(
    entries: str | Path | Sequence[Sequence[float]], columns: Sequence[InputColumn], needed: int,
    most: int, name: str = "",
) -> Numbers:  # fmt: skip
    r"""Columns of numbers, given as rows or in a text file of any separator and decimal mark.

    Columns are known by their headings, in any order, beside others; where the headings are not
    known, or there are none, they must be just these in their order.

    ``entries``: name of a file, or rows in SI units; ``columns``: those that are wanted;
    ``needed``: how many of them, the first, must be there; ``most``: bytes that a file may have;
    ``name``: of rows that are given, for messages.  Raises InputError if it cannot be read, a
    column is missing or its unit is not known, or a cell is no number; with its line.

    >>> from puck_tables._core.quantities import FRICTION, SPEED
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "law.csv")
    ...     _ = file.write_text("COF;slip speed (mm/s)\n0,3;0\n0,2;500\n")
    ...     numbers_of(file, (SPEED, FRICTION), 2, 1000).rows.tolist()
    [[0.0, 0.3], [0.5, 0.2]]
    """
    if not isinstance(entries, str | Path):
        return Numbers(_checked(entries, columns, needed, name), ("",) * len(columns))
    content = content_of(entries, most)
    read = _read if len(content) <= _KEPT else _read.__wrapped__
    return read(str(entries), content, tuple(columns), needed)


@lru_cache(maxsize=16)  # a scene asks for its law again and again
def _read(path: str, content: bytes, columns: tuple[InputColumn, ...], needed: int) -> Numbers:
    """Columns of numbers from the content of a file."""
    head = content[:HEAD]
    refuse_others(path, head)
    refuse_no_text(path, head)
    form = text_form_of(path, head)
    header = header_of(form, lambda cells: all(known_as(cell, columns) for cell in cells[:needed]))
    headings = header[-1] if header and sum(map(bool, header[-1])) > 1 else []  # a title is none
    if form.header and 1 < len(form.header[-1]) < form.width:
        raise InputError(
            f"{path} has {len(form.header[-1])} names for {form.width} columns, so none can be told"
            " from another: name all of them"
        )
    if not headings:
        _refuse_unit_in_words(path, form, columns)
    headings = with_names(headings, columns)
    taken = _taken(path, form, headings, columns, needed)
    sizes, units = [], []
    for column, n in taken.items():
        unit, size = unit_of(path, headings[n] if headings else "", column)
        sizes.append(size)
        units.append(unit)
    _tell_unread(path, [text for n, text in enumerate(headings) if n not in taken.values()])
    by_place, _ = read_columns(path, form, list(taken.values()), (), content)
    rows = np.column_stack([by_place[n] for n in taken.values()]) * sizes
    rows.flags.writeable = False
    numbers = Numbers(rows, tuple(units), path, partial(_line, form, content))
    wrong = np.argwhere(~np.isfinite(rows))
    if len(wrong):
        row, column = wrong[0].tolist()
        name, where = list(taken)[column].name, numbers.where(row)
        if np.isinf(rows[row, column]):
            raise InputError(f"{where}: its {name} is too large a number")
        raise InputError(f"{where}: it has no {name}: every row needs one")
    for n, (column, unit) in enumerate(zip(taken, units, strict=True)):
        if column is FRICTION and not unit and len(rows) and rows[:, n].max() > MOST_FRICTION:
            say(
                f"{path}: its friction coefficients go up to {rows[:, n].max():.6g}, more than dry "
                "surfaces have: if they are percent write mu [%] over them"
            )
    return numbers


def _tell_unread(path: str, headings: Sequence[str]) -> None:
    """Say which columns of a file were not read."""
    if headings:
        names = ", ".join(
            repr(text[:40]) if text else "one without a name" for text in headings[:_SHOWN]
        )
        more = f" and {len(headings) - _SHOWN} more" if len(headings) > _SHOWN else ""
        say(f"{path}: column{'s' if len(headings) > 1 else ''} {names}{more} not read")


def list_of(path: str | Path, column: InputColumn, most: int) -> FloatArray | None:
    r"""The numbers of a file that has one a line, perhaps under a heading, in SI units.

    None for a file of several columns.

    >>> from puck_tables._core.quantities import TIME
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "a.txt")
    ...     _ = file.write_text("t [ms]\n0\n12,5\n")
    ...     list_of(file, TIME, 1000).tolist()
    [0.0, 0.0125]
    """
    content = content_of(path, most)
    refuse_others(path, content[:HEAD])
    refuse_no_text(path, content[:HEAD])
    encoding = encoding_of(path, content[:HEAD])
    text = content.decode(encoding, "replace").replace(MINUS, "-")
    lines = [line.strip(" \t;,|\0") for line in text.splitlines() if is_row(line)]
    comma = not any("." in line for line in lines[1:])
    numbers = [number(line, comma) for line in lines]
    heading = lines[0] if lines and numbers[0] is None else ""
    numbers = numbers[1:] if heading else numbers
    if not numbers or None in numbers or set(",;\t") & set(heading):
        return None
    if not np.isfinite(values := np.array(numbers, float)).all():
        return None
    return values * unit_of(str(path), heading, column)[1]


def _checked(entries: Any, columns: Sequence[InputColumn], needed: int, name: str) -> FloatArray:
    """Rows that somebody gave."""
    try:
        rows = np.array([[float(cell) for cell in row] for row in entries])
    except (TypeError, ValueError, OverflowError):
        rows = np.empty((0, 0))
    if rows.ndim != 2 or not needed <= rows.shape[1] <= len(columns) or not np.isfinite(rows).all():
        raise InputError(f"{name} must be rows of {_listed(columns, needed)}".lstrip())
    return rows


def _listed(columns: Sequence[InputColumn], needed: int) -> str:
    """Columns in words, with those that may be left out."""
    names = [one.written for one in columns]
    text = f"{', '.join(names[: needed - 1])} and {names[needed - 1]}"
    return text + "".join(f", and perhaps {name}" for name in names[needed:])


def _taken(
    path: str, form: TextForm, headings: Sequence[str], columns: Sequence[InputColumn], needed: int
) -> dict[InputColumn, int]:
    """Where the columns stand that are wanted, in the order in which they are."""
    known = [known_as(text, columns) for text in headings]
    for column in columns:
        if known.count(column) > 1:
            both = ", ".join(f"'{headings[n]:.40}'" for n, one in enumerate(known) if one == column)
            raise InputError(f"{path} has {known.count(column)} columns of {column.name}: {both}; "
                             "leave one")  # fmt: skip
    if all(column in known for column in columns[:needed]):
        return {column: known.index(column) for column in columns if column in known}
    fits = needed <= form.width <= len(columns)
    strange = any(known) or any(known_as(text, ALL) or measures(text) for text in headings)
    said = ", ".join(f"'{text:.40}'" for text in headings[:_SHOWN])
    if fits and not strange:
        if headings:
            taken = ", ".join(one.written for one in columns[: form.width])
            say(f"{path}: its columns {said} are taken as {taken}")
        return dict(zip(columns, range(form.width), strict=False))
    frames = any(map(is_frame, headings))
    hint = "; of frames write their times, frame / frames a second" if frames else ""
    raise InputError(
        f"{path} must hold the columns {_listed(columns, needed)}: name them so (its columns are "
        f"{said or f'{form.width}, without names'}){hint}"
    )


def _refuse_unit_in_words(path: str, form: TextForm, columns: Sequence[InputColumn]) -> None:
    """Refuse a unit in a comment, or a line over numbers, that is no heading: whose is it?"""
    lines = [*form.said, *(" ".join(row) for row in form.header)]
    for unit in re.findall(r"[\[(]([^\[\]()]+)[\])]|(\S+/\S+)", " ".join(lines)):
        text = "".join(unit).strip()
        sizes = {unit_size(text, column.kind) for column in columns if column.kind in EXAMPLES}
        if sizes - {None, 1.0}:
            raise InputError(
                f"{path} says {text!r:.40} over its numbers, but not of which column: give it a "
                f"line of headings, such as {', '.join(one.written for one in columns)}"
            )


def _line(form: TextForm, content: bytes, row: int) -> int:
    """The line of a file at which a row of numbers stands."""
    with io.TextIOWrapper(io.BytesIO(content), form.encoding, "replace") as file:
        rows = [n for n, text in enumerate(file, 1) if n > form.skip and is_row(text)]
    return rows[row]
