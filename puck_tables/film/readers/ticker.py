"""Dots of a ticker or spark timer: places along a line in one column, a row a tick."""

from __future__ import annotations

from pathlib import Path

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import COMMENTS, encoding_of, number
from puck_tables.errors import InputError
from puck_tables.film.film import Reader, first_text
from puck_tables.film.headings import headings, on_a_line

_LARGEST = 1 << 24  # bytes
_LOOKED_AT = 4  # rows that tell


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """A table of dots with the number of the tick beside each place (UTF-8, semicolons)."""
    content = read_whole(path, _LARGEST)
    name, *dots = _lines(content.decode(encoding_of(path, content), "replace"))
    return "".join(
        [f"frame;{name}\n", *(f"{n};{dot}\n" for n, dot in enumerate(dots))]
    ).encode()  # fmt: skip


def _lines(text: str) -> list[str]:
    bare = (line.strip(" \t;,\r\ufeff") for line in text.split("\n"))
    return [line for line in bare if line and not line.startswith(COMMENTS)]


def _opens(path: str | Path, head: bytes) -> bool:
    if first_text(path, head):
        return False
    try:
        name, *dots = _lines(head[:2000].decode(encoding_of(path, head), "replace"))
        if any(sign in name for sign in "\t;,"):
            return False
        names = ["frame", name]
        line = on_a_line(names, headings(names))
    except (InputError, ValueError):  # no text, an empty one, or another heading
        return False
    return line is not None and len(dots) > 1 and all(
        number(dot, "," in dot) is not None for dot in dots[:_LOOKED_AT]
    )  # fmt: skip


READERS = (Reader(_opens, as_text=_as_csv),)
