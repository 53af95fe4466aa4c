"""Tables in JSON as programs write them: a list of rows, or a list for each column."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path
from typing import Any

from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.film.film import Reader, first_text

_LARGEST = 1 << 28  # bytes
_BEGINS = re.compile(r"\[\s*\{|\{\s*\"[^\"]*\"\s*:\s*\[\s*[-0-9n]")


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """The same as a CSV file (UTF-8) with the names of its entries as headings."""
    try:
        data: Any = json.loads(read_whole(path, _LARGEST))
        if isinstance(data, dict):
            names = [name for name, one in data.items() if isinstance(one, list)]
            rows = [list(row) for row in zip(*(data[name] for name in names), strict=True)]
        else:
            names = list(dict.fromkeys(name for row in data for name in row))
            rows = [[row.get(name) for name in names] for row in data]
    except (ValueError, TypeError, AttributeError, RecursionError):
        raise InputError(
            f"{path} looks like JSON and is no table: give a list of rows with the same names, or "
            "a list for each column, equally long"
        ) from None
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(names)
    for row in rows:
        table.writerow(["" if one is None else one for one in row])
    return text.getvalue().encode()


def _opens(path: str | Path, head: bytes) -> bool:
    return _BEGINS.match(first_text(path, head)) is not None


READERS = (Reader(_opens, as_text=_as_csv),)
