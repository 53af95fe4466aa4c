"""Track row column files (.trc) of Motion Analysis Cortex and OpenSim: marks in space, y up.

References
----------
Motion Analysis, Cortex manual; OpenSim, "Marker (.trc) Files".
"""

from __future__ import annotations

from pathlib import Path

from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_BEGINS = b"PathFileType"


def _film(path: str | Path, head: bytes) -> Film:
    """The film in a .trc file."""
    rows = [line.rstrip("\r").split("\t") for line in head.decode("utf-8", "replace").split("\n")]
    at = next((n for n, row in enumerate(rows[:20]) if row[0].startswith("Frame")), -1)
    marks = [name.strip() for name in rows[at][2:] if name.strip()] if at > 2 else []
    if not marks:
        raise InputError(f"{path} has no row 'Frame#, Time' with names of marks: export it again")
    said = dict(zip(rows[1], rows[2], strict=False))
    unit = unit_word(said.get("Units", ""), "length")
    columns = [("", Heading("frame")), ("", Heading("time", "", "s"))]
    columns += [("", Heading(axis, mark, unit)) for mark in marks for axis in "xyz"]
    return film_below(path, head, at + 2, columns, "track row column file", "y")


READERS = (Reader(lambda _, head: head.startswith(_BEGINS), _film),)
