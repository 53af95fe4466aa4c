"""Tables in spreadsheets: Excel (.xlsx) and OpenDocument (.ods), which are archives of XML.

The first sheet with numbers is read as a CSV file of its cells would be.  A formula counts as what
it gave when the file was saved.

References
----------
ECMA-376 (SpreadsheetML: cells ``c`` with a place ``r``, a type ``t``, a value ``v``); OASIS Open
Document 1.3 (``table:table-cell`` with ``office:value``, repeated as they say).
"""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from puck_tables._core.safe_read import ZIP
from puck_tables._core.text import number
from puck_tables.errors import InputError
from puck_tables.film.film import Reader
from puck_tables.film.text_tables import csv_of

_LARGEST = 1 << 28  # bytes of XML
_WIDEST, _LONGEST = 4096, 1 << 21  # cells of a row, rows
_SHEETS, _ODS = "xl/worksheets/", "content.xml"
_DAMAGE = (zipfile.BadZipFile, zlib.error, ElementTree.ParseError, KeyError, ValueError, IndexError,
           NotImplementedError, RuntimeError, EOFError, OSError)  # fmt: skip


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """The cells of the first sheet that holds numbers, as a CSV file (UTF-8)."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = set(archive.namelist())
            sheets = [_ods(_xml(path, archive, _ODS))] if _ODS in names else _xlsx(path, archive)
            for sheet in sheets:
                rows = list(sheet)
                if any(number(cell, False) is not None and cell for row in rows for cell in row):
                    break
            else:
                raise InputError(f"{path} holds no sheet with numbers")
    except _DAMAGE as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} is a damaged spreadsheet ({error}): save it as CSV") from None
    return csv_of(rows)


def _xml(path: str | Path, archive: zipfile.ZipFile, name: str) -> Element:
    with archive.open(name) as file:
        content = file.read(_LARGEST + 1)
    if len(content) > _LARGEST:
        raise InputError(f"{path} is too large a spreadsheet: save its table as CSV")
    if b"<!ENTITY" in content:
        raise InputError(f"{path} defines entities, which no spreadsheet does: it is not read")
    return ElementTree.fromstring(content)


def _xlsx(path: str | Path, archive: zipfile.ZipFile) -> Iterator[Iterator[list[str]]]:
    names = set(archive.namelist())
    texts = []
    if "xl/sharedStrings.xml" in names:
        shared = _xml(path, archive, "xl/sharedStrings.xml")
        texts = ["".join(t.text or "" for t in si.iter() if _tag(t) == "t") for si in shared]
    sheets = [name for name in names if name.startswith(_SHEETS) and name.endswith(".xml")]
    for name in sorted(sheets, key=lambda one: (len(one), one)):
        yield _xlsx_rows(_xml(path, archive, name), texts)


def _xlsx_rows(sheet: Element, texts: list[str]) -> Iterator[list[str]]:
    for row in (one for one in sheet.iter() if _tag(one) == "row"):
        cells: list[str] = []
        for cell in row:
            at = _column(cell.get("r", "")) if cell.get("r") else len(cells)
            if at >= _WIDEST:
                break
            cells += [""] * (at + 1 - len(cells))
            value = next((one.text or "" for one in cell if _tag(one) == "v"), "")
            if cell.get("t") == "s":
                value = texts[int(value)]
            elif cell.get("t") == "inlineStr":
                value = "".join(one.text or "" for one in cell.iter() if _tag(one) == "t")
            elif cell.get("t") == "e":
                value = ""
            cells[at] = value
        yield cells


def _column(place: str) -> int:
    """The column, from 0, of a place such as 'AB12'.

    >>> _column("A1"), _column("AB12")
    (0, 27)
    """
    result = 0
    for letter in place.rstrip("0123456789"):
        result = 26 * result + ord(letter) - 64
    return result - 1


def _ods(document: Element) -> Iterator[list[str]]:
    tables, count = (one for one in document.iter() if _tag(one) == "table"), 0
    for row in next(tables, ElementTree.Element("")).iter():
        if _tag(row) != "table-row":
            continue
        cells: list[str] = []
        for cell in row:
            text = _said(cell, "value") or "".join(cell.itertext())
            times = min(int(_said(cell, "number-columns-repeated") or 1), _WIDEST)
            cells += [text] * (times if text else min(times, _WIDEST - len(cells)))
        while cells and not cells[-1]:
            cells.pop()
        times = int(_said(row, "number-rows-repeated") or 1) if cells else 1
        for _ in range(min(times, _LONGEST - count)):
            count += 1
            yield cells


def _tag(one: Element) -> str:
    return one.tag.rpartition("}")[2] if isinstance(one.tag, str) else ""


def _said(one: Element, name: str) -> str:
    return next((value for key, value in one.attrib.items() if key.rpartition("}")[2] == name), "")


def _opens(path: str | Path, head: bytes) -> bool:
    """Whether an archive is a spreadsheet: by its list of contents, else by its ending."""
    if not head.startswith(ZIP):
        return False
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except _DAMAGE:
        return Path(path).suffix.lower() in (".xlsx", ".ods")
    return any(name.startswith("xl/") for name in names) or _ODS in names


READERS = (Reader(_opens, as_text=_as_csv),)
