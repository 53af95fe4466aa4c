"""Motion data of Qualisys Track Manager (TSV): marks in space (3D), or bodies (6D).

A header of a name and values in each line, then, if asked for, a row of names of columns, then the
table, in mm and degrees, z up.  A mark that was not seen is 0, 0, 0, or null.

References
----------
Qualisys, "Motion data (.tsv)" and "Rotation angles in QTM": FILE_VERSION from 2.0.0 on.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from puck_tables._core.text import number
from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_BEGINS = ("FILE_VERSION", "NO_OF_FRAMES", "NO_OF_CAMERAS", "NO_OF_MARKERS", "NO_OF_BODIES")
_WORDS = ("FREQUENCY", "DESCRIPTION", "EVENT")  # over the table, without a _
_POSE = ("x", "y", "z", "", "", "angle")  # X Y Z Roll Pitch Yaw, then residual and matrix
_POSE_WIDTH = 16


def _film(path: str | Path, head: bytes) -> Film:
    """The film in a motion data file of Qualisys."""
    said: dict[str, list[str]] = {}
    names: list[str] = []
    count = 0
    for line in head.decode("utf-8", "replace").split("\n"):
        cells = [cell.strip() for cell in line.rstrip("\r\n").split("\t")]
        if (cells[0].isupper() and "_" in cells[0]) or cells[0] in _WORDS:
            said.setdefault(cells[0], cells[1:])
        elif any(cells):
            if all(_is_number(cell) for cell in cells):
                break
            names = cells
        count += 1
    rate = number((said.get("FREQUENCY") or [""])[0], False) or 0.0
    unit = unit_word((said.get("UNITS") or ["mm"])[0], "length") or "mm"
    clocks = [Heading("frame")] if names[:1] == ["Frame"] else []
    clocks += [Heading("time", "", "s")] if names[1:2] == ["Time"] else []
    columns = [("", one) for one in clocks]
    if marks := [name for name in said.get("MARKER_NAMES", []) if name]:
        if "2D" in said.get("DATA_INCLUDED", []):
            raise InputError(f"{path} has places on the pictures of cameras (2D): export 3D data")
        columns += [("", Heading(axis, mark, unit)) for mark in marks for axis in "xyz"]
    elif bodies := [name for name in said.get("BODY_NAMES", []) if name]:
        for body in bodies:
            columns += [
                (body, Heading(role, "", {"": "", "angle": "deg"}.get(role, unit)))
                for role in (*_POSE, *[""] * (_POSE_WIDTH - len(_POSE)))
            ]
    else:
        raise InputError(
            f"{path} names no marks and no bodies: export it with its header (Include TSV header)"
        )
    film = film_below(path, head, count, columns, "file of Qualisys", "z", rate)
    for one in film.bodies:
        for mark, points in one.marks.items():
            lost = (points == 0.0).all(axis=1)
            one.marks[mark] = np.where(lost[:, None], np.nan, points)
    return film


def _is_number(cell: str) -> bool:
    return number(cell, False) is not None or number(cell, True) is not None


def _opens(path: str | Path, head: bytes) -> bool:
    text = head[:400].decode("utf-8-sig", "replace")
    return text.partition("\t")[0] in _BEGINS


READERS = (Reader(_opens, _film),)
