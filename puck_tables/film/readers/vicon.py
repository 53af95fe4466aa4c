"""Trajectories that Vicon Nexus exports as CSV: marks of subjects in space, z up.

A word (``Trajectories``), the frames a second, names of marks (``subject:mark``) each over the
first of its three columns, names of columns, units, then the table; other sections may follow.

References
----------
Vicon, "Export data to an ASCII file"; files in public repositories.
"""

from __future__ import annotations

from pathlib import Path

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import number
from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_SECTION = "trajectories"
_LARGEST = 1 << 30  # bytes


def _film(path: str | Path, head: bytes) -> Film:
    """The film in an export of Vicon."""
    text = read_whole(path, _LARGEST).decode("utf-8-sig", "replace")
    lines = [line.strip() for line in text.splitlines()]
    start = next((n for n, line in enumerate(lines) if line.strip(",;\t").lower() == _SECTION), -1)
    if start < 0 or len(lines) < start + 6:
        raise InputError(f"{path} has no section 'Trajectories': export the trajectories as CSV")
    sign = next((one for one in ",;\t" if one in lines[start + 3]), ",")
    rate = number(lines[start + 1].strip(sign), True) or 0.0
    owners, _, units = ([cell.strip() for cell in lines[start + n].split(sign)] for n in (2, 3, 4))
    columns = [("", Heading("frame")), ("", Heading(""))]
    name = ""
    for n, unit in enumerate(units[2:], start=2):
        name = owners[n] if n < len(owners) and owners[n] else name
        subject, _, mark = name.rpartition(":")
        columns.append((subject, Heading("xyz"[(n - 2) % 3], mark, unit_word(unit, "length"))))
    end = next((n for n in range(start + 5, len(lines)) if not lines[n].strip(sign)), len(lines))
    content = "\n".join(lines[start + 5 : end]).encode()
    return film_below(path, content, 0, columns, "export of Vicon", "z", rate, content)


def _opens(path: str | Path, head: bytes) -> bool:
    text = head[:4000].decode("utf-8-sig", "replace").lower()
    return "sub frame" in text and "frame" in text


READERS = (Reader(_opens, _film),)
