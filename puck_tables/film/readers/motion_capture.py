"""Marks and bodies in space that motion capture exports as text: tables below other lines.

Qualisys Track Manager (TSV, z up): a header of a name and values in each line, then, if asked for,
a row of names of columns, then the table, in mm and degrees; a mark that was not seen is 0, 0, 0,
or null.  Vicon Nexus (CSV, z up): a word (``Trajectories``), the frames a second, names of marks
(``subject:mark``) each over the first of its three columns, names of columns, units, the table;
other sections may follow.  OptiTrack Motive (CSV, y up): a line of names and values by turns
(``Length Units``, ``Rotation Type``), then rows of kinds, names, numbers and parents over the
columns, ``Rotation`` or ``Position``, and the axes; marks of a rigid body that was solved are left
out.  Track row column files (.trc, y up) of Motion Analysis Cortex and OpenSim.

References
----------
Qualisys, "Motion data (.tsv)" and "Rotation angles in QTM": FILE_VERSION from 2.0.0 on.  Vicon,
"Export data to an ASCII file".  OptiTrack, "Data Export: CSV"; versions 1.2 to 1.25.  Motion
Analysis, Cortex manual; OpenSim, "Marker (.trc) Files".
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import number
from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_BEGINS = ("FILE_VERSION", "NO_OF_FRAMES", "NO_OF_CAMERAS", "NO_OF_MARKERS", "NO_OF_BODIES")
_WORDS = ("FREQUENCY", "DESCRIPTION", "EVENT")  # over the table, without a _
_POSE = ("x", "y", "z", "", "", "angle")  # X Y Z Roll Pitch Yaw, then residual and matrix
_POSE_WIDTH = 16  # columns of a body: the six, the residual, nine of the matrix
_SECTION = "trajectories"
_LARGEST = 1 << 30  # bytes
_FEWEST = 5  # lines over a table of Motive


def _qualisys(path: str | Path, head: bytes) -> Film:
    """The film in a motion data file of Qualisys."""
    said: dict[str, list[str]] = {}
    names: list[str] = []
    count = 0
    for line in head.decode("utf-8", "replace").split("\n"):
        cells = [cell.strip() for cell in line.rstrip("\r\n").split("\t")]
        if (cells[0].isupper() and "_" in cells[0]) or cells[0] in _WORDS:
            said.setdefault(cells[0], cells[1:])
        elif any(cells):
            if all(number(cell, "," in cell) is not None for cell in cells):
                break
            names = cells
        count += 1
    rate = number((said.get("FREQUENCY") or [""])[0], False) or 0.0
    unit = unit_word((said.get("UNITS") or ["mm"])[0], "length") or "mm"
    columns = [("", Heading("frame"))] if names[:1] == ["Frame"] else []
    columns += [("", Heading("time", "", "s"))] if names[1:2] == ["Time"] else []
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


def _vicon(path: str | Path, head: bytes) -> Film:
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


def _optitrack(path: str | Path, head: bytes) -> Film:
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
        kind, name, quantity = (row[n] if n < len(row) else "" for row in (kinds, names, what))
        role = axis.lower()
        if role == "frame" or role.startswith("time (") or axis == "Time":
            columns.append(("", Heading("frame" if role == "frame" else "time", "", "s")))
        elif kind == ("Rigid Body" if solid else "Marker") and quantity in ("Position", "Rotation"):
            body, _, mark = (name, "", "") if solid else name.rpartition(":")
            role = f"q{role}" if quantity == "Rotation" else role
            columns.append((body, Heading(role, mark, unit if quantity == "Position" else "rad")))
        else:
            columns.append(("", Heading("")))
    return film_below(path, head, at + 1, columns, "export of OptiTrack", "y")


def _trc(path: str | Path, head: bytes) -> Film:
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


def _text(head: bytes) -> str:
    return head[:4000].decode("utf-8-sig", "replace")


READERS = (
    Reader(lambda _, head: _text(head).partition("\t")[0] in _BEGINS, _qualisys),
    Reader(lambda _, head: "sub frame" in _text(head).lower(), _vicon),
    Reader(lambda _, head: _text(head).startswith("Format Version,"), _optitrack),
    Reader(lambda _, head: _text(head).startswith("PathFileType"), _trc),
)
