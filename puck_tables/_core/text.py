"""How a table of numbers in a text file is written: encoding, separator, decimal mark, header."""

from __future__ import annotations

import codecs
import contextlib
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from puck_tables.errors import InputError

HEAD = 1 << 18  # bytes from which encoding, separator and header are told
_SAMPLE, _HEADER_ROWS = 100, 20  # lines that tell the form of a table; of them a header
COMMENTS = ("#", "%", "//")
_MISSING = {"", "nan", "na", "n/a", "none", "null", "-", "--", "nil", "?", "<na>"}
POINT = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_COMMA = re.compile(r"[-+]?(?:[0-9]+,[0-9]*|,[0-9]+)(?:[eE][-+]?[0-9]+)?")
# thousands in groups: with a decimal mark, in two groups or more, or by what is no decimal mark
_GROUPED = re.compile(
    r"[-+]?[0-9]{1,3}(?:(?:,[0-9]{3})+\.[0-9]*|(?:\.[0-9]{3})+,[0-9]*|(?:,[0-9]{3}){2,}"
    r"|(?:\.[0-9]{3}){2,}|(?:['\u2019 \u00a0\u2009\u202f][0-9]{3})+(?:[.,][0-9]*)?)"
)
_THOUSANDS = re.compile(r"[-+]?[1-9][0-9]{0,2}(?:\.[0-9]{3})+")  # or with a decimal point
THOUSAND = re.compile(r"[-+]?[1-9][0-9]{0,2},[0-9]{3}")  # or with a decimal comma
MINUS = "\N{MINUS SIGN}"  # of typesetters
_SEPARATORS = ("\t", ";", ",", "|", None)  # the last: blanks


@dataclass
class TextForm:
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


def text_form_of(path: str | Path, head: bytes) -> TextForm:
    r"""How the table in a text file is written, from how it begins.

    Raises InputError if it is no text, or no table of numbers.

    >>> form = text_form_of("a.csv", b"t;x;y\n0;0,5;1\n0,1;0,6;1\n")
    >>> form.separator, form.comma, form.header, form.width
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
        if n == 0 and (match := re.fullmatch(r"sep=(.)\s*", line)):
            separator = match[1]
        elif line.lstrip().startswith(COMMENTS):
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
    refuse_groups(path, rows)
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
    return TextForm(
        encoding, chosen, comma, rows[:first], said, rows[first:], numbered[first][0], width
    )


def encoding_of(path: str | Path, head: bytes) -> str:
    r"""The encoding of a text.

    Raises InputError if it is no text.

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

    >>> split('0.1, "a, b"', ","), split(" 1  2", None)
    (['0.1', 'a, b'], ['1', '2'])
    """
    if separator is None:
        return line.split()
    if '"' in line:
        with contextlib.suppress(csv.Error):  # of cells without end
            cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
            return [cell.strip() for cell in cells]
    return [cell.strip() for cell in line.split(separator)]


def number(cell: str, comma: bool) -> float | None:
    """The number in a cell; NaN where it says that there is none; None for a text.

    >>> number("0,5", True), number("0.25", True), number("1.234", True), number("red", False)
    (0.5, 0.25, None, None)
    """
    if POINT.fullmatch(cell) and not (comma and _THOUSANDS.fullmatch(cell)):
        return float(cell)
    if comma and _COMMA.fullmatch(cell):
        return float(cell.replace(",", "."))
    return float("nan") if cell.lower() in _MISSING else None


def is_row(line: str) -> bool:
    """Whether a line is neither empty nor a comment.

    >>> is_row("0,1"), is_row("# by hand"), is_row(";;")
    (True, False, False)
    """
    return bool(line.strip(" \t;,|\0\r\n")) and not line.lstrip().startswith(COMMENTS)


def _filled(row: Sequence[str]) -> int:
    """Cells without empty ones behind: lines may end with separators."""
    return next((n for n in range(len(row), 0, -1) if row[n - 1]), 0)


def whole_names(row: list[str]) -> list[str]:
    """Cells with units that a blank cut off put back to their names.

    >>> whole_names(["v", "[mm/s]", "mu"])
    ['v [mm/s]', 'mu']
    """
    whole: list[str] = []
    for cell in row:
        if whole and re.fullmatch(r"[\[(].*[\])]", cell) and not POINT.fullmatch(whole[-1]):
            whole[-1] += " " + cell
        else:
            whole.append(cell)
    return whole


def _is_data(row: Sequence[str]) -> bool:
    """Whether a row holds numbers rather than names."""
    filled = [cell for cell in row if cell]
    numbers = [
        cell for cell in filled if POINT.fullmatch(cell) or _COMMA.fullmatch(cell)
    ]  # fmt: skip
    return bool(numbers) and 2 * len(numbers) >= len(filled)


def _is_names(row: Sequence[str]) -> bool:
    """Whether a row holds two names or more, and no numbers."""
    filled = [cell for cell in row if cell]
    return len(filled) > 1 and not any(
        POINT.fullmatch(cell) or _COMMA.fullmatch(cell) or cell.lower() in _MISSING
        for cell in filled
    )  # fmt: skip


def refuse_groups(path: str | Path, rows: Sequence[Sequence[str]]) -> None:
    """Refuse a table whose numbers have thousands separators."""
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
