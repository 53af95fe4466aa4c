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

    Parameters
    ----------
    name : str
        '' where the file has none.
    marks : dict of ndarray (n, 2) or (n, 3)
        Places by the names of the marks, in the unit and along the axes of the file.
    frame, time : ndarray (n,), optional
        Frame numbers; times in s.
    angles : dict of ndarray (n,)
        Of the body that a mark is of, in the unit of the file; under '' of all.
    likelihoods, seen : dict of ndarray (n,)
        The same for how likely a place is, and whether it is one.
    turns : dict of ndarray (n, 4)
        The same of quaternions x, y, z, w.
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

    Parameters
    ----------
    kind : str
        Of file, for messages.
    bodies : list of Body
    unit, angle_unit : str
        Of places and angles; '' where the file does not say.
    y_down : bool, optional
        Whether y grows downwards in it; None where it does not say.
    jointed : bool
        Whether the marks of a body are parts of it rather than pucks of their own.
    timed : bool
        Whether it names the unit of its times.
    likely : float, optional
        The likelihood below which the writer of such files takes a place for none.
    up : str
        The axis of places in space that points up; '' where it does not say.
    rates : str
        Whether velocities, or spins, stand in place of places and angles.
    notes : list of str
        What was found, in sentences.
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

    Examples
    --------
    >>> first_text("a.trk", b" <object/>"), first_text("a.csv", b"t,x,y")
    ('<object/>', '')
    """
    signs = (b"<", b"{", b"[", codecs.BOM_UTF8, b"\xff\xfe", b"\xfe\xff")
    if not head[:400].lstrip().startswith(signs):
        return ""
    return head[:400].decode(encoding_of(path, head), errors="ignore").lstrip("\ufeff \t\r\n")
