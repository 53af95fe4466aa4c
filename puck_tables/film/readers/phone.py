"""Sensors that the app Sensor Logger writes, a file each, which says in its name what it holds."""

from __future__ import annotations

from pathlib import Path

from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.film.film import NO_ACCELERATIONS, Reader

_BEGINS = b"time,seconds_elapsed,"  # as Sensor Logger writes
_LARGEST = 1 << 28  # bytes
_NAMES = {"x": "wx [rad/s]", "y": "wy [rad/s]", "z": "wz [rad/s]", "seconds_elapsed": "t [s]"}


def _as_csv(path: str | Path, head: bytes) -> bytes:
    """The file of a gyroscope with headings that say what its columns are."""
    name = Path(path).stem.lower()
    if "accel" in name or "gravity" in name:
        raise InputError(f"{path} {NO_ACCELERATIONS}")
    if "gyro" not in name:
        raise InputError(
            f"{path} is of the app Sensor Logger, whose files say in their names of which sensor "
            "they are: Gyroscope.csv is read, for the spin over time"
        )
    names, _, rows = read_whole(path, _LARGEST).partition(b"\n")
    headings = ",".join(_NAMES.get(one, "-") for one in names.decode().strip().split(","))
    return headings.encode() + b"\n" + rows


def _opens(path: str | Path, head: bytes) -> bool:
    names = head.split(b"\n")[0].strip().split(b",")
    return head.startswith(_BEGINS) and {b"x", b"y", b"z"} <= {*names}


READERS = (Reader(_opens, as_text=_as_csv),)
