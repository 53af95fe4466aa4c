"""Trajectories that Kinovea exports as text: blocks of times, x and y, one for each.

Times are hours:minutes:seconds:hundredths, so coarse that frames a second are the better clock.

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
_ROW = re.compile(r"(?:(\d+):)?(\d+):(\d+):(\d+)\s+(\S+)\s+(\S+)\s*")


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """A file of Kinovea as a table (UTF-8, semicolons) of trajectory, time, x and y."""
    content = read_whole(path, _LARGEST)
    rows, track, apart = ["track;t [s];x;y"], 0, True
    for n, line in enumerate(content.decode(encoding_of(path, content)).splitlines(), start=1):
        bare = line.strip()
        if not bare or bare.startswith("#"):
            apart = True
            continue
        row = _ROW.fullmatch(bare)
        if row is None:
            raise InputError(
                f"{path}, line {n}: '{bare:.40}' is no time h:mm:ss:hundredths with x and y: "
                "export it from Kinovea once more, or as CSV"
            )
        track, apart = track + apart, False
        hours, minutes, secs, part, x, y = row.groups()
        whole = 3600 * int(hours or 0) + 60 * int(minutes) + int(secs)
        places = (place.replace(",", ".") for place in (x, y))
        rows.append(";".join([str(track), f"{whole}.{int(part):02d}", *places]))
    return ("\n".join(rows) + "\n").encode()


READERS = (Reader(lambda _, head: head.startswith(_BEGINS), as_text=_as_csv),)
