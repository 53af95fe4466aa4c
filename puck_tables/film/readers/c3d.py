"""Marks in C3D files of motion capture, read by the package c3d, or ezc3d (extra 'films').

References
----------
The C3D file format, https://www.c3d.org: parameters POINT:LABELS, UNITS, RATE; the up axis of
POINT:Y_SCREEN, '+Z' in most.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader, TrackedBody

_KEY = b"\x50"  # the second byte of all C3D files


def _film(path: str | Path, head: bytes) -> Film:
    """The film in a C3D file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of parts of a file that nothing here needs
            names, points, rate, unit, up = _points(path)
    except ImportError:
        raise InputError(
            f"{path} is a C3D file: install what reads it (pip install c3d), or export it as CSV"
        ) from None
    except Exception as error:  # of either package, of whatever a file holds
        raise InputError(f"{path} is a damaged C3D file: {error}") from None
    if not names or not points.size:
        raise InputError(f"{path} holds no marks")
    by_subject: dict[str, TrackedBody] = {}
    for k, name in enumerate(names):
        subject, _, mark = name.rpartition(":")
        body = by_subject.setdefault(
            subject, TrackedBody(subject, {}, time=np.arange(len(points)) / rate)
        )
        body.marks[mark] = points[:, k]
    return Film(
        "C3D file", list(by_subject.values()), unit_word(unit, "length"), jointed=True, up=up,
        notes=[f"{rate:.9g} frames a second, as it says"],
    )  # fmt: skip


def _points(path: str | Path) -> tuple[list[str], Any, float, str, str]:
    """Names, places (frames, marks, 3) with NaN where one was not seen, rate, unit, up axis."""
    try:
        import c3d
    except ImportError:
        import ezc3d

        file = ezc3d.c3d(str(path))
        group = file["parameters"]["POINT"]
        said = {
            key: (group[key]["value"] or [""])[0] for key in ("UNITS", "Y_SCREEN") if key in group
        }
        points = np.moveaxis(file["data"]["points"][:3], 0, 2).swapaxes(0, 1)
        rate = float(group["RATE"]["value"][0])
        return list(group["LABELS"]["value"]), points, rate, str(said.get("UNITS", "")), _up(said)
    with open(path, "rb") as handle:
        reader = c3d.Reader(handle)
        names = [label.strip() for label in reader.point_labels]
        frames = [points[:, :4] for _, points, _ in reader.read_frames(copy=True)]
        said = {}
        for key in ("UNITS", "Y_SCREEN"):
            if (parameter := reader.get(f"POINT:{key}")) is not None:
                said[key] = parameter.string_value.strip("\0 ")
        every = np.array(frames, np.float64)
        every[every[..., 3] < 0.0] = np.nan
        return names, every[..., :3], float(reader.point_rate), said.get("UNITS", ""), _up(said)


def _up(said: dict[str, Any]) -> str:
    axis = str(said.get("Y_SCREEN", "")).strip("+- ").lower()
    return axis if axis in ("x", "y", "z") else "z"


READERS = (
    Reader(lambda _, head: head[1:2] == _KEY and 1 < head[0] < 40 and b"\0" in head[:512], _film),
)
