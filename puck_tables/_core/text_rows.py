"""Columns of a table in a text file, block by block, where it is known how it is written."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import opened
from puck_tables._core.text import (
    COMMENTS,
    MINUS,
    POINT,
    THOUSAND,
    TextForm,
    is_row,
    number,
    refuse_groups,
    split,
    whole_names,
)
from puck_tables._core.units import is_unit
from puck_tables.errors import InputError

LARGEST = 1 << 32  # bytes of a text file
_BLOCK = 1 << 22  # characters read at a time
_LINE = 1 << 16  # characters of a line


def read_columns(
    path: str | Path, form: TextForm, numbers: Sequence[int], texts: Sequence[int],
    content: bytes | None = None,
) -> tuple[dict[int, FloatArray], dict[int, tuple[Any, list[str]]]]:  # fmt: skip
    r"""Columns of a table, without its header, comments and empty lines.

    ``path``: the file; ``form``: how it is written; ``numbers``, ``texts``: which columns, from 0;
    ``content``: of the file, if it has been read.  Returns ``numbers``: dict of ndarray (n,);
    ``texts``: dict of (codes ndarray (n,), list of the texts that they stand for).

    >>> import tempfile
    >>> from puck_tables._core.text import text_form_of
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file, content = Path(folder, "a.csv"), b"t,x\n0,3\n1,\n"
    ...     _ = file.write_bytes(content)
    ...     read_columns(file, text_form_of(file, content), [1], [])[0][1].tolist()
    [3.0, nan]
    """
    parts: list[FloatArray] = []
    codes: dict[int, list[Any]] = {column: [] for column in texts}
    words: dict[int, dict[str, int]] = {column: {} for column in texts}
    raw = opened(path, LARGEST) if content is None else io.BytesIO(content)
    with raw, io.TextIOWrapper(raw, form.encoding, "replace") as file:
        line = 1
        for _ in range(form.skip):
            file.readline(_LINE)
            line += 1
        for block in _blocks(path, file):
            fast = _fast(block, form, numbers, texts)
            values, cells = fast or _slow(path, block, form, numbers, texts, line)
            for column in texts:
                known = words[column]
                codes[column].append(
                    np.array([known.setdefault(one, len(known)) for one in cells[column]], int)
                )
            parts.append(values)
            line += block.count("\n")
    whole = np.concatenate(parts) if parts else np.empty((0, len(numbers)))
    coded = {
        column: np.concatenate([np.zeros(0, int), *parts_of]) for column, parts_of in codes.items()
    }
    return (
        {column: whole[:, n] for n, column in enumerate(numbers)},
        {column: (code, list(words[column])) for column, code in coded.items()},
    )


def _blocks(path: str | Path, file: IO[str]) -> Iterator[str]:
    """The rest of a file in blocks of whole lines."""
    while block := file.read(_BLOCK):
        if not block.endswith("\n"):
            rest = file.readline(_LINE)
            if len(rest) >= _LINE:
                raise InputError(f"{path} has a line of more than {_LINE} characters: no table")
            block += rest
        yield block.replace(MINUS, "-")


def _fast(
    block: str, form: TextForm, numbers: Sequence[int], texts: Sequence[int]
) -> tuple[FloatArray, dict[int, list[str]]] | None:
    """Rows of a block whose columns of numbers hold nothing else; None for any other."""
    separator = form.separator
    if texts and separator is None:
        return None
    count = block.count("\n") + (not block.endswith("\n"))
    if '"' in block or any(sign in block for sign in COMMENTS):
        return None
    if separator is not None and block.count(separator) != count * (_written(form) - 1):
        return None
    text = block.replace(",", ".") if form.comma else block
    if separator is not None:  # nothing between two separators
        empty, filled = separator + separator, f"{separator}nan{separator}"
        if empty in text:
            text = text.replace(empty, filled).replace(empty, filled)
        text = text.replace(separator + "\n", separator + "nan\n")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of blocks without rows
            rows = np.loadtxt(
                io.StringIO(text), delimiter=separator, comments=None, ndmin=2,
                usecols=None if separator is None else numbers,
            )  # fmt: skip
            cells = {
                column: np.loadtxt(
                    io.StringIO(block), str, delimiter=separator, comments=None, ndmin=1,
                    usecols=column,
                ) for column in texts
            }  # fmt: skip
    except ValueError:
        return None
    if rows.shape[0] != count or (form.comma and "." in block):
        return None
    if any(one.size != count for one in cells.values()):
        return None
    if separator is None:
        return (rows[:, list(numbers)], {}) if rows.shape[1] == form.width else None
    return rows, {column: [text.strip() for text in one.tolist()] for column, one in cells.items()}


def _written(form: TextForm) -> int:
    """Cells in a line as it is written, with those behind a last separator."""
    return max(len(row) for row in form.rows)


def _slow(
    path: str | Path, block: str, form: TextForm, numbers: Sequence[int], texts: Sequence[int],
    line: int,
) -> tuple[FloatArray, dict[int, list[str]]]:  # fmt: skip
    """Rows of a block with gaps, texts or comments, or a sentence on what is wrong in them."""
    rows = []
    pointed, doubtful = False, ""
    cells: dict[int, list[str]] = {column: [] for column in texts}
    for n, text in enumerate(block.split("\n"), start=line):
        if not is_row(text):
            continue
        row = split(text, form.separator)
        while len(row) > form.width and not row[-1]:
            row.pop()
        if len(row) != form.width:
            raise InputError(
                f"{path}, line {n}: {len(row)} cells where other rows have {form.width}: columns "
                "must be equally long, leave cells empty where there is none"
            )
        values = [number(row[column], form.comma) for column in numbers]
        if None in values:
            column = numbers[values.index(None)]
            refuse_groups(f"{path}, line {n}, column {column + 1}", [[row[column]]])
            if form.comma and POINT.fullmatch(row[column]):
                raise InputError(
                    f"{path}, line {n}, column {column + 1}: '{row[column]:.30}' has a point, "
                    "other numbers a comma: save the table with one decimal mark and no thousands "
                    "separators"
                )
            raise InputError(
                f"{path}, line {n}, column {column + 1}: '{row[column]:.30}' is no number"
                + (f" with {'a comma' if form.comma else 'a point'} as its decimal mark"
                   if row[column][:1].isdigit() else "")
                + "; leave cells empty where there is none"
            )  # fmt: skip
        for column in numbers if form.comma else ():
            pointed = pointed or bool(POINT.fullmatch(row[column]) and "." in row[column])
            if not doubtful and THOUSAND.fullmatch(row[column]):
                doubtful = f"line {n}, column {column + 1}: '{row[column]}'"
        rows.append(values)
        for column in texts:
            cells[column].append(row[column])
    if pointed and doubtful:
        raise InputError(
            f"{path}, {doubtful} has a comma, other numbers a point: save the table with one "
            "decimal mark and no thousands separators"
        )
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(numbers)), cells


def header_of(form: TextForm, names: Callable[[list[str]], bool]) -> list[list[str]]:
    """The rows of names over the columns of a table; the last has their units in brackets.

    ``form``: how it is written; ``names``: whether cells are names of columns: those of the last
    comment may be, where there are no others.  Returns list of list of str: each as long as the
    table is wide; empty if there are none.

    >>> form = TextForm("utf-8", ",", False, [["t", "x"], ["s", "cm"]], [], [["0", "1"]], 2, 2)
    >>> header_of(form, bool)
    [['t [s]', 'x [cm]']]
    """
    header = [row[: form.width] + [""] * (form.width - len(row)) for row in form.header]
    if not header:
        for line in reversed(form.said):
            cells = split(re.sub(r"^[#%/\s]+", "", line), form.separator)
            cells = cells if form.separator else whole_names(cells)
            if len(cells) == form.width and names(cells):
                return [cells]
    if len(header) > 1 and _are_units(header[-1]):
        units = header.pop()
        header[-1] = [
            f"{name} [{unit.strip('[]() ')}]" if is_unit(unit) else name
            for name, unit in zip(header[-1], units, strict=True)
        ]
    return header


def _are_units(row: Sequence[str]) -> bool:
    """Whether a row holds units: some that are known, and others in brackets."""
    return any(map(is_unit, row)) and all(
        is_unit(cell) or cell in ("", "-") or re.fullmatch(r"[\[(].*[\])]", cell) for cell in row
    )
