"""Tables of numbers in text files of any encoding, separator and decimal mark, block by block."""

from __future__ import annotations

import codecs
import contextlib
import csv
import io
import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import opened
from puck_tables.errors import InputError

LARGEST = 1 << 32  # bytes of a text file
HEAD = 1 << 18  # bytes from which encoding, separator and header are told
_BLOCK = 1 << 22  # characters read at a time
_LINE = 1 << 16  # characters of a line
_SAMPLE, _HEADER_ROWS = 100, 20
_COMMENTS = ("#", "%", "//")
_MISSING = {"", "nan", "na", "n/a", "none", "null", "-", "--", "nil", "?", "<na>"}
_POINT = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_COMMA = re.compile(r"[-+]?(?:[0-9]+,[0-9]*|,[0-9]+)(?:[eE][-+]?[0-9]+)?")
# thousands in groups: with a decimal mark, in two groups or more, or by what is no decimal mark
_GROUPED = re.compile(
    r"[-+]?[0-9]{1,3}(?:(?:,[0-9]{3})+\.[0-9]*|(?:\.[0-9]{3})+,[0-9]*|(?:,[0-9]{3}){2,}"
    r"|(?:\.[0-9]{3}){2,}|(?:['\u2019 \u00a0\u2009\u202f][0-9]{3})+(?:[.,][0-9]*)?)"
)
_THOUSANDS = re.compile(r"[-+]?[1-9][0-9]{0,2}(?:\.[0-9]{3})+")  # or with a decimal point
_THOUSAND = re.compile(r"[-+]?[1-9][0-9]{0,2},[0-9]{3}")  # or with a decimal comma
MINUS = "\N{MINUS SIGN}"  # of typesetters
_SEPARATORS = ("\t", ";", ",", "|", None)  # the last: blanks


@dataclass
class Look:
    """How a table is written.

    ``header``: the rows of names over the numbers, ``said``: comments before them, ``rows``: the
    first rows of numbers, ``skip``: lines before the first row of numbers, ``width``: columns.
    """

    encoding: str
    separator: str | None
    comma: bool
    header: list[list[str]]
    said: list[str]
    rows: list[list[str]] = field(default_factory=list)
    skip: int = 0
    width: int = 0


def look_at(path: str | Path, head: bytes) -> Look:
    r"""How the table in a text file is written, from how it begins.

    Raises
    ------
    InputError
        If it is no text, or no table of numbers.

    Examples
    --------
    >>> look = look_at("a.csv", b"t;x;y\n0;0,5;1\n0,1;0,6;1\n")
    >>> look.separator, look.comma, look.header, look.width
    (';', True, [['t', 'x', 'y']], 3)
    """
    encoding = encoding_of(path, head)
    text = head.decode(encoding, errors="ignore").replace("\0", "").replace(MINUS, "-")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if len(head) >= HEAD:
        lines = lines[:-1]  # cut
    if not lines:
        raise InputError(f"{path} is no table of numbers: its first line does not end")
    said, separator = [], ""
    numbered = []
    for n, line in enumerate(lines):
        if n == 0 and (told := re.fullmatch(r"sep=(.)\s*", line)):
            separator = told[1]
        elif line.lstrip().startswith(_COMMENTS):
            said.append(line.strip())
        elif line.strip(" \t;,|"):
            numbered.append((n, line))
        if len(numbered) >= _SAMPLE:
            break
    if not numbered:
        raise InputError(f"{path} holds no rows of numbers: give a table of numbers")
    sample = [line for _, line in numbered]
    chosen = separator or _separator(path, sample)
    rows = [split(line, chosen) for line in sample]
    if chosen is None:
        rows = [whole_names(row) for row in rows]
    _refuse_groups(path, rows)
    comma = any(_COMMA.fullmatch(cell) for row in rows for cell in row)
    names = [n for n, row in enumerate(rows[:_HEADER_ROWS]) if _is_names(row)]
    start = names[-1] + 1 if names else 0
    first = next((n for n in range(start, len(rows)) if _is_data(rows[n])), None)
    if first is None or first > _HEADER_ROWS:
        raise InputError(f"{path} has no rows of numbers: its first line is '{sample[0]:.60}'")
    sizes = [_filled(row) for row in rows[first:]]
    width = max(set(sizes), key=lambda size: (sizes.count(size), size))
    if first and chosen is not None:
        width = max(width, _filled(rows[first - 1]))  # of rows whose last cells are empty
    return Look(
        encoding, chosen, comma, rows[:first], said, rows[first:], numbered[first][0], width
    )


def encoding_of(path: str | Path, head: bytes) -> str:
    r"""The encoding of a text.

    Raises
    ------
    InputError
        If it is no text.

    Examples
    --------
    >>> encoding_of("a.csv", "t,x".encode("utf-16")), encoding_of("a.csv", b"x [\xb5m]")
    ('utf-16', 'cp1252')
    """
    for mark, name in (
        (b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe\0\0", "utf-32"), (b"\0\0\xfe\xff", "utf-32"),
        (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"),
    ):  # fmt: skip
        if head.startswith(mark):
            return name
    pairs = head[: len(head) // 2 * 2]
    if b"\0" in head:
        for name, at in (("utf-16-le", 1), ("utf-16-be", 0)):
            if pairs and pairs[at::2].count(0) > 0.9 * len(pairs) / 2 and b"\0\0" not in head[:4]:
                return name
        raise InputError(f"{path} is no text but a binary file: save the table as CSV")
    odd = sum(head.count(code) for code in range(32) if code not in (9, 10, 12, 13, 27))
    if odd > 0.01 * len(head):
        raise InputError(f"{path} is no text but a binary file: save the table as CSV")
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head, final=len(head) < HEAD)
    except UnicodeDecodeError:
        return "cp1252"  # of Windows; it holds latin-1's letters
    return "utf-8"


def split(line: str, separator: str | None) -> list[str]:
    """The cells of a line.

    Examples
    --------
    >>> split('0.1, "a, b"', ","), split(" 1  2", None)
    (['0.1', 'a, b'], ['1', '2'])
    """
    if separator is None:
        return line.split()
    if '"' in line:
        with contextlib.suppress(csv.Error):  # of cells without end
            found = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
            return [cell.strip() for cell in found]
    return [cell.strip() for cell in line.split(separator)]


def number(cell: str, comma: bool) -> float | None:
    """The number in a cell; NaN where it says that there is none; None for a text.

    Examples
    --------
    >>> number("0,5", True), number("0.25", True), number("1.234", True), number("red", False)
    (0.5, 0.25, None, None)
    """
    if _POINT.fullmatch(cell) and not (comma and _THOUSANDS.fullmatch(cell)):
        return float(cell)
    if comma and _COMMA.fullmatch(cell):
        return float(cell.replace(",", "."))
    return float("nan") if cell.lower() in _MISSING else None


def is_row(line: str) -> bool:
    """Whether a line is neither empty nor a comment.

    Examples
    --------
    >>> is_row("0,1"), is_row("# by hand"), is_row(";;")
    (True, False, False)
    """
    return bool(line.strip(" \t;,|\0\r\n")) and not line.lstrip().startswith(_COMMENTS)


def _filled(row: Sequence[str]) -> int:
    """Cells without empty ones behind: lines may end with separators."""
    return next((n for n in range(len(row), 0, -1) if row[n - 1]), 0)


def whole_names(row: list[str]) -> list[str]:
    """Cells with units that a blank cut off put back to their names.

    Examples
    --------
    >>> whole_names(["v", "[mm/s]", "mu"])
    ['v [mm/s]', 'mu']
    """
    whole: list[str] = []
    for cell in row:
        if whole and re.fullmatch(r"[\[(].*[\])]", cell) and not _POINT.fullmatch(whole[-1]):
            whole[-1] += " " + cell
        else:
            whole.append(cell)
    return whole


def _is_data(row: Sequence[str]) -> bool:
    """Whether a row holds numbers rather than names."""
    filled = [cell for cell in row if cell]
    numbers = [
        cell for cell in filled if _POINT.fullmatch(cell) or _COMMA.fullmatch(cell)
    ]  # fmt: skip
    return bool(numbers) and 2 * len(numbers) >= len(filled)


def _is_names(row: Sequence[str]) -> bool:
    """Whether a row holds two names or more, and no numbers."""
    filled = [cell for cell in row if cell]
    return len(filled) > 1 and not any(
        _POINT.fullmatch(cell) or _COMMA.fullmatch(cell) or cell.lower() in _MISSING
        for cell in filled
    )  # fmt: skip


def _refuse_groups(path: str | Path, rows: Sequence[Sequence[str]]) -> None:
    """Refuse a table whose numbers have thousands separators.

    Raises
    ------
    InputError
    """
    grouped = next((cell for row in rows for cell in row if _GROUPED.fullmatch(cell)), None)
    if grouped is not None:
        raise InputError(
            f"{path}: {grouped!r} has a thousands separator: save the table without them"
        )


def _separator(path: str | Path, lines: Sequence[str]) -> str | None:
    """What stands between the cells: with it most are numbers, and lines have equally many."""
    best: tuple[float, int, str | None] = (0.0, 0, None)
    tail = lines[len(lines) // 2 :] if len(lines) > 2 else lines[-1:]
    for separator in _SEPARATORS:
        rows = [split(line, separator) for line in tail]
        sizes = [len(row) for row in rows]
        if max(sizes) < 2:
            continue
        cells = [cell for row in rows for cell in row]
        alike = sizes.count(max(set(sizes), key=sizes.count)) / len(sizes)
        good = sum(
            number(cell, False) is not None
            or bool(_COMMA.fullmatch(cell) or _GROUPED.fullmatch(cell))
            for cell in cells
        ) / len(cells)  # fmt: skip
        flags = sum(cell.isalpha() for cell in cells) / len(cells)
        score = round(alike * (good + 0.5 * flags), 6)
        if score > best[0] + 1e-9:
            best = (score, max(sizes), separator)
    if best[0] < 0.2 and len(lines) == 1:
        raise InputError(f"{path} has no rows below its header, '{lines[0].strip():.60}'")
    if best[0] < 0.2:
        raise InputError(
            f"{path} is no table of numbers with two or more columns: a line of it is "
            f"'{tail[0].strip():.60}'"
        )
    names = split(lines[0], best[2])
    if best[2] == "," and best[1] >= 2 * len(names) > 2 and not _is_data(names):
        raise InputError(
            f"{path} has {len(names)} names and {best[1]} cells in a row: commas separate and are "
            "decimal marks, too; save it with semicolons between the columns"
        )
    return best[2]


def read_columns(
    path: str | Path, look: Look, numbers: Sequence[int], texts: Sequence[int],
    content: bytes | None = None,
) -> tuple[dict[int, FloatArray], dict[int, tuple[Any, list[str]]]]:  # fmt: skip
    r"""Columns of a table, without its header, comments and empty lines.

    Parameters
    ----------
    path : the file
    look : how it is written
    numbers, texts : which columns, from 0
    content : of the file, if it has been read

    Returns
    -------
    numbers : dict of ndarray (n,)
    texts : dict of (codes ndarray (n,), list of the texts that they stand for)

    Raises
    ------
    InputError
        If a cell of a column of numbers is a text, or a row has too few cells or too many.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file, content = Path(folder, "a.csv"), b"t,x\n0,3\n1,\n"
    ...     _ = file.write_bytes(content)
    ...     read_columns(file, look_at(file, content), [1], [])[0][1].tolist()
    [3.0, nan]
    """
    parts: list[FloatArray] = []
    codes: dict[int, list[Any]] = {column: [] for column in texts}
    words: dict[int, dict[str, int]] = {column: {} for column in texts}
    raw = opened(path, LARGEST) if content is None else io.BytesIO(content)
    with raw, io.TextIOWrapper(raw, look.encoding, "replace") as file:
        line = 1
        for _ in range(look.skip):
            file.readline(_LINE)
            line += 1
        for block in _blocks(path, file):
            fast = _fast(block, look, numbers, texts)
            found, cells = fast or _slow(path, block, look, numbers, texts, line)
            for column in texts:
                known = words[column]
                codes[column].append(
                    np.array([known.setdefault(one, len(known)) for one in cells[column]], int)
                )
            parts.append(found)
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
    block: str, look: Look, numbers: Sequence[int], texts: Sequence[int]
) -> tuple[FloatArray, dict[int, list[str]]] | None:
    """Rows of a block whose columns of numbers hold nothing else; None for any other."""
    separator = look.separator
    if texts and separator is None:
        return None
    count = block.count("\n") + (not block.endswith("\n"))
    if '"' in block or any(sign in block for sign in _COMMENTS):
        return None
    if separator is not None and block.count(separator) != count * (_written(look) - 1):
        return None
    text = block.replace(",", ".") if look.comma else block
    if separator is not None:  # nothing between two separators
        empty, filled = separator + separator, f"{separator}nan{separator}"
        if empty in text:
            text = text.replace(empty, filled).replace(empty, filled)
        text = text.replace(separator + "\n", separator + "nan\n")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of blocks without rows
            found = np.loadtxt(
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
    if found.shape[0] != count or (look.comma and "." in block):
        return None
    if any(one.size != count for one in cells.values()):
        return None
    if separator is None:
        return (found[:, list(numbers)], {}) if found.shape[1] == look.width else None
    return found, {column: [text.strip() for text in one.tolist()] for column, one in cells.items()}


def _written(look: Look) -> int:
    """Cells in a line as it is written, with those behind a last separator."""
    return max(len(row) for row in look.rows)


def _slow(
    path: str | Path, block: str, look: Look, numbers: Sequence[int], texts: Sequence[int],
    line: int,
) -> tuple[FloatArray, dict[int, list[str]]]:  # fmt: skip
    """Rows of a block with gaps, texts or comments, or a sentence on what is wrong in them."""
    rows = []
    pointed, doubtful = False, ""
    cells: dict[int, list[str]] = {column: [] for column in texts}
    for n, text in enumerate(block.split("\n"), start=line):
        if not is_row(text):
            continue
        row = split(text, look.separator)
        while len(row) > look.width and not row[-1]:
            row.pop()
        if len(row) != look.width:
            raise InputError(
                f"{path}, line {n}: {len(row)} cells where other rows have {look.width}: columns "
                "must be equally long, leave cells empty where there is none"
            )
        values = [number(row[column], look.comma) for column in numbers]
        if None in values:
            column = numbers[values.index(None)]
            _refuse_groups(f"{path}, line {n}, column {column + 1}", [[row[column]]])
            if look.comma and _POINT.fullmatch(row[column]):
                raise InputError(
                    f"{path}, line {n}, column {column + 1}: '{row[column]:.30}' has a point, "
                    "other numbers a comma: save the table with one decimal mark and no thousands "
                    "separators"
                )
            raise InputError(
                f"{path}, line {n}, column {column + 1}: '{row[column]:.30}' is no number"
                + (f" with {'a comma' if look.comma else 'a point'} as its decimal mark"
                   if row[column][:1].isdigit() else "")
                + "; leave cells empty where there is none"
            )  # fmt: skip
        for column in numbers if look.comma else ():
            pointed = pointed or bool(_POINT.fullmatch(row[column]) and "." in row[column])
            if not doubtful and _THOUSAND.fullmatch(row[column]):
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
