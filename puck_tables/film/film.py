"""What a file holds before anything is done to it: marks on bodies, frame by frame."""

from __future__ import annotations

import codecs
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.text import encoding_of

Flags = npt.NDArray[np.bool_]


@dataclass
class TrackedBody:
    """The rows of one body: a puck, or marks of which each is one.

    ``name``: '' where the file has none; ``marks``: places (n, 2) or (n, 3) by the names of the
    marks, in the unit and along the axes of the file; ``frame`` (n,): numbers; ``time`` (n,): s;
    ``angles`` (n,) of the body that a mark is of, in the unit of the file, under '' of all; the
    same for how likely a place is, whether it is one, and quaternions (n, 4) x, y, z, w.
    """

    name: str
    marks: dict[str, FloatArray]
    frame: FloatArray | None = None
    time: FloatArray | None = None
    angles: dict[str, FloatArray] = field(default_factory=dict)
    likelihoods: dict[str, FloatArray] = field(default_factory=dict)
    seen: dict[str, Flags] = field(default_factory=dict)
    turns: dict[str, FloatArray] = field(default_factory=dict)


@dataclass
class Film:
    """All bodies of a file, and what it says of them.

    ``kind``: of file, for messages; ``unit``, ``angle_unit``: '' where it does not say; ``y_down``:
    whether y grows downwards, None where it does not say; ``jointed``: whether the marks of a body
    are parts of it rather than pucks of their own; ``timed``: whether it names the unit of its
    times; ``likely``: the likelihood below which the writer of such files takes a place for none;
    ``up``: the axis of places in space that points up, '' where it does not say; ``rates``: whether
    velocities, or spins, stand in place of places and angles; ``notes``: what was found.
    """

    kind: str
    bodies: list[TrackedBody]
    unit: str = ""
    angle_unit: str = ""
    y_down: bool | None = None
    jointed: bool = False
    timed: bool = True
    likely: float | None = None
    up: str = ""
    rates: str = ""
    notes: list[str] = field(default_factory=list)

    def note(self, text: str) -> None:
        """Put a sentence to its notes, once."""
        if text not in self.notes:
            self.notes.append(text)


class Reader(NamedTuple):
    """A format of tracks that is no table of text.

    By the path of a file and how it begins, ``opens``: whether it is of it; ``film_of``: what it
    holds; or ``as_text``: a table of text that holds the same, which is then read as any other.
    """

    opens: Callable[[str | Path, bytes], bool]
    film_of: Callable[[str | Path, bytes], Film] | None = None
    as_text: Callable[[str | Path, bytes], bytes] | None = None


def first_text(path: str | Path, head: bytes) -> str:
    """What a file begins with, where it is a text that begins with a sign of XML or JSON.

    >>> first_text("a.trk", b" <object/>"), first_text("a.csv", b"t,x,y")
    ('<object/>', '')
    """
    signs = (b"<", b"{", b"[", codecs.BOM_UTF8, b"\xff\xfe", b"\xfe\xff")
    if not head[:400].lstrip().startswith(signs):
        return ""
    return head[:400].decode(encoding_of(path, head), errors="ignore").lstrip("\ufeff \t\r\n")
