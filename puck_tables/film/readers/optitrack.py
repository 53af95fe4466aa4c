"""Takes that OptiTrack Motive exports as CSV: rigid bodies or marks in space, y up.

The first line holds names and values by turns (``Length Units``, ``Rotation Type``, ``Capture Frame
Rate``); then rows of kinds, names, numbers and parents over the columns, ``Rotation`` or
``Position``, and the axes.  Marks of a rigid body that was solved are left out.

References
----------
OptiTrack, "Data Export: CSV"; format versions 1.2 to 1.25.
"""

from __future__ import annotations

import csv
from pathlib import Path

from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_FEWEST = 5  # lines over the table


def _film(path: str | Path, head: bytes) -> Film:
    """The film in an export of Motive."""
    lines = head.decode("utf-8-sig", "replace").replace("\r", "").split("\n")
    rows = list(csv.reader(lines[:40]))
    at = next((n for n, row in enumerate(rows) if row[:1] == ["Frame"]), -1)
    if at < _FEWEST - 1:
        raise InputError(f"{path} has no row 'Frame, Time' over its table: export it with headers")
    said = dict(zip(rows[0][::2], rows[0][1::2], strict=False))
    unit = unit_word(said.get("Length Units", ""), "length")
    over = [row for row in rows[1:at] if any(row)]
    kinds = next((row for row in over if {"Marker", "Rigid Body", "Bone"} & {*row}), [])
    names = over[over.index(kinds) + 1] if kinds else []
    what, axes = over[-1], rows[at]
    solid = "Rigid Body" in kinds
    if solid and said.get("Rotation Type", "Quaternion") != "Quaternion" and "Rotation" in what:
        raise InputError(
            f"{path} has rotations as {said['Rotation Type']}, which are turns about axes of the "
            "body: export them as Quaternion"
        )
    columns = []
    for n, axis in enumerate(axes):
        kind, name, told = (row[n] if n < len(row) else "" for row in (kinds, names, what))
        role = axis.lower()
        if role == "frame" or role.startswith("time (") or axis == "Time":
            columns.append(("", Heading("frame" if role == "frame" else "time", "", "s")))
        elif kind == ("Rigid Body" if solid else "Marker") and told in ("Position", "Rotation"):
            body, _, mark = (name, "", "") if solid else name.rpartition(":")
            role = f"q{role}" if told == "Rotation" else role
            columns.append((body, Heading(role, mark, unit if told == "Position" else "rad")))
        else:
            columns.append(("", Heading("")))
    return film_below(path, head, at + 1, columns, "export of OptiTrack", "y")


def _opens(path: str | Path, head: bytes) -> bool:
    return head.removeprefix(b"\xef\xbb\xbf").startswith(b"Format Version,")


READERS = (Reader(_opens, _film),)
