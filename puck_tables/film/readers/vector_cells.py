"""Tables with several numbers in a cell, as places and quaternions are logged: one to a column."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import COMMENTS, POINT, encoding_of, number
from puck_tables.errors import InputError
from puck_tables.film.film import Reader, first_text
from puck_tables.film.text_tables import csv_of

_LARGEST = 1 << 28  # bytes of such a file
_AXES = {2: "xy", 3: "xyz", 4: "xyzw"}
_LOOKED_AT = 4  # rows that tell
_THOUSANDS = re.compile(r"[-+]?[1-9][0-9]{0,2}(?:\s[0-9]{3})+")


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """A table of vectors (UTF-8, commas) with a column for each number of a cell."""
    form = _form_of(path, head)
    content = read_whole(path, _LARGEST)
    if form is None:
        return content
    encoding, separator, counts = form
    rows = _rows(content.decode(encoding, "replace"), separator)
    table = [[
        name if count not in _AXES else f"{name}_{axis}"
        for name, count in zip(rows[0], counts, strict=True)
        for axis in _AXES.get(count, " ")
    ]]  # fmt: skip
    for row in rows[1:]:
        cells: list[str] = []
        for cell, count in zip(row, counts, strict=False):
            numbers = _numbers(cell) if count in _AXES else [cell]
            cells += numbers if len(numbers) == max(count, 1) else [""] * count
        table.append(cells)
    return csv_of(table)


def _form_of(path: str | Path, head: bytes) -> tuple[str, str, list[int]] | None:
    """Encoding, separator and how many numbers each column holds; None if none holds several."""
    if first_text(path, head):
        return None
    try:
        encoding = encoding_of(path, head)
    except InputError:  # no text
        return None
    lines = head[:40_000].decode(encoding, "replace").split("\n")
    text = "\n".join(line for line in lines if not line.startswith(COMMENTS))
    for separator in "\t;,":
        rows = _rows(text, separator)[:_LOOKED_AT]
        if len(rows) < 2 or len(rows[0]) < 2 or len({len(row) for row in rows}) > 1:
            continue
        counts = [len(_numbers(cell)) for cell in rows[1]]
        if any(count in _AXES for count in counts) and not any(map(_numbers, rows[0])):
            return encoding, separator, counts
        if not any(counts) and all(number(cell, True) is not None for cell in rows[1]):
            return None
    return None


def _rows(text: str, separator: str) -> list[list[str]]:
    lines = csv.reader(io.StringIO(text), delimiter=separator, skipinitialspace=True)
    try:
        return [[cell.strip() for cell in row] for row in lines if any(row)]
    except csv.Error:  # of cells without end
        return []


def _numbers(cell: str) -> list[str]:
    """The numbers of a cell that holds two or more and nothing else."""
    bare = cell.strip()
    if _THOUSANDS.fullmatch(bare):
        return []
    within = bare.strip("[](){}")  # where a comma may be a decimal mark it separates in brackets
    words = re.split(r"[\s,;]+" if within != bare else r"[\s;]+", within.strip())
    return words if len(words) > 1 and all(map(POINT.fullmatch, words)) else []


READERS = (Reader(lambda path, head: _form_of(path, head) is not None, as_text=_as_csv),)
