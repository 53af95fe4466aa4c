"""Tables in JSON: rows, or a list for each column, as programs write them and as are saved here.

What this program saves has columns with their units (.json), or a row a line (.jsonl) without any,
which are then asked for.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.film.film import Reader, first_text
from puck_tables.film.text_tables import csv_of

_LARGEST = 1 << 29  # bytes
_BEGINS = re.compile(r"\[\s*\{|\{")


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """A JSON table as a CSV file (UTF-8) with the names of its entries as headings."""
    content = read_whole(path, _LARGEST)
    try:
        data: Any
        try:
            data = json.loads(content)
        except ValueError:  # a value a line
            data = [json.loads(line) for line in content.splitlines() if line.strip()]
        if isinstance(data, dict):
            if isinstance(data.get("columns"), dict):
                data = {
                    f"{name}[{one['unit']}]" if one["unit"] else name: one["values"]
                    for name, one in data["columns"].items()
                }
            names = [name for name, one in data.items() if isinstance(one, list)]
            rows = [list(row) for row in zip(*(data[name] for name in names), strict=True)]
        else:
            names = list(dict.fromkeys(name for row in data for name in row))
            rows = [[row.get(name) for name in names] for row in data]
        if not names or not rows:
            raise ValueError
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise InputError(
            f"{path} looks like JSON and is no table: give a list of rows with the same names, or "
            "a list for each column, equally long"
        ) from None
    return csv_of([names, *rows])


READERS = (Reader(lambda path, head: bool(_BEGINS.match(first_text(path, head))), as_text=_as_csv),)
