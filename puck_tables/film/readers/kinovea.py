"""Trajectories that Kinovea exports as text: blocks of times, x and y, one for each.

Times are numbers, or of an older version hours:minutes:seconds:hundredths, so coarse that frames a
second are the better clock.

References
----------
Kinovea, exporter of trajectories to text (GNU Plot format).
"""

from __future__ import annotations

import re
from pathlib import Path

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import encoding_of
from puck_tables.errors import InputError
from puck_tables.film.film import Reader

_LARGEST = 1 << 26  # bytes
_BEGINS = b"#Kinovea Trajectory"
_ROW = re.compile(r"(?:(?:(\d+):)?(\d+):(\d+):(\d+)|(-?\d[\d.,]*))\s+(\S+)\s+(\S+)")


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """A file of Kinovea as a table (UTF-8, semicolons) of trajectory, time, x and y."""
    content = read_whole(path, _LARGEST)
    rows, track, apart, unit = [], 0, True, ""
    for n, line in enumerate(content.decode(encoding_of(path, content)).splitlines(), start=1):
        bare = line.strip()
        if not bare or bare.startswith("#"):
            apart = True
            continue
        row = _ROW.fullmatch(bare)
        if row is None:
            raise InputError(
                f"{path}, line {n}: '{bare:.40}' is no time, a number or h:mm:ss:hundredths, with "
                "x and y: export it from Kinovea once more, or as CSV"
            )
        track, apart = track + apart, False
        hours, minutes, secs, part, *cells = row.groups("")
        if secs:
            unit = " [s]"
            cells[0] = f"{3600 * int(hours or 0) + 60 * int(minutes) + int(secs)}.{int(part):02d}"
        rows.append(";".join([str(track), *(cell.replace(",", ".") for cell in cells)]))
    lines = [f"track;t{unit};x;y", *rows]
    if track == 1:  # as the columns that somebody sees who opens the file
        lines = [line.partition(";")[2] for line in lines]
    return "\n".join([*lines, ""]).encode()


READERS = (Reader(lambda _, head: head.startswith(_BEGINS), as_text=_as_csv),)
