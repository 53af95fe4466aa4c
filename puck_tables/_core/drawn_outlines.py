"""Closed outlines: the corners that rows or a file give, and what is drawn in an SVG file."""

from __future__ import annotations

import io
import math
from functools import lru_cache
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray, number_in
from puck_tables._core.own_folder import say
from puck_tables._core.quantities import X, Y
from puck_tables._core.read_columns import numbers_of
from puck_tables._core.safe_read import content_of, is_number
from puck_tables.errors import InputError

SUFFIXES = (".csv", ".svg")  # of files of outlines
_MOST_BYTES = 1 << 24  # of a file: more is no outline of a puck or a board
_MOST_CHORDS = 1000  # of an arc: more are none that anybody sees
_SAME = 1e-9  # of the size: corners that are one
_OFF = 1e-4  # of the size of an outline: how far the chords of its arcs may be off


def outlines_of(entries: Any) -> list[FloatArray]:
    """Corners (n, 2), m, of one outline that rows or a CSV file give, or of those that are drawn.

    Of these the largest comes first, and all are counter-clockwise.

    In a drawing x goes to the right and y upwards from the lower left corner of the page; curves
    are taken as chords, and said to be.

    Raises InputError if a file cannot be read, or of a drawing nothing, or an open line, or no size
    in mm, cm or in is given.

    >>> import tempfile
    >>> from pathlib import Path
    >>> drawing = ('<svg xmlns="http://www.w3.org/2000/svg" width="8cm" height="4cm" '
    ...            'viewBox="0 0 80 40"><rect x="10" y="30" width="20" height="10"/></svg>')
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "base.svg")
    ...     _ = file.write_text(drawing)
    ...     outlines_of(str(file))[0].round(9).tolist()
    [[0.01, 0.0], [0.03, 0.0], [0.03, 0.01], [0.01, 0.01]]
    """
    if isinstance(entries, str) and entries.lower().endswith(".svg"):
        return _drawn(entries, content_of(entries, _MOST_BYTES))
    return [numbers_of(entries, (X, Y), 2, _MOST_BYTES, "corners").rows]


@lru_cache(maxsize=16)  # a scene asks for its outlines again and again
def _drawn(path: str, content: bytes) -> list[FloatArray]:
    """The outlines of a drawing."""
    try:
        import svgelements
    except ImportError:
        raise InputError(
            f"{path} is a drawing: install what reads it (pip install svgelements), or give its "
            "corners as CSV"
        ) from None
    try:
        drawing = svgelements.SVG.parse(io.BytesIO(content))
        shapes = [one for one in drawing.elements() if isinstance(one, svgelements.Shape)]
        lines = [svgelements.Path(line) for one in shapes
                 for line in svgelements.Path(one).as_subpaths()]  # fmt: skip
    except Exception as error:  # of whatever a file holds
        raise InputError(f"{path} is a damaged SVG file: {error}") from None
    sizes = [str(drawing.values.get(side) or "") for side in ("width", "height")]
    if any(is_number(text) or not text or text.endswith(("%", "px")) for text in sizes):
        raise InputError(
            f"{path}: the page has no size: give <svg> a width and a height in mm, cm or in"
        )
    scale = number_in(f"{path}: width", sizes[0], "m") / float(drawing.width)
    outlines, arcs = [], 0
    for line in lines:
        if (box := line.bbox()) is None:  # a point
            continue
        if not isinstance(line[-1], svgelements.Close) and line[0].end != line[-1].end:
            raise InputError(f"{path}: a line in it is not closed: close or remove it")
        size = math.hypot(box[2] - box[0], box[3] - box[1])
        places: list[complex] = []
        for part in line:
            straight = isinstance(part, svgelements.Move | svgelements.Line | svgelements.Close)
            arcs += not straight
            places += [_place(part.end)] if straight else _chords(part, _OFF * size)
        page = np.array(places)
        rows = np.stack([page.real, float(drawing.height) - page.imag], axis=1) * scale
        ahead = np.roll(rows, -1, axis=0)
        apart = np.hypot(*(ahead - rows).T) > _SAME * size * scale
        if np.count_nonzero(apart) < 3:
            raise InputError(f"{path}: a line in it goes round nothing: remove it")
        left = float((rows[:, 0] * ahead[:, 1] - rows[:, 1] * ahead[:, 0]).sum()) >= 0.0
        outlines.append(rows[apart][:: 1 if left else -1])
    if not outlines:
        raise InputError(f"{path}: nothing is drawn in it: draw a closed outline")
    if arcs:
        say(f"{path}: its curves are taken as chords, off by at most {_OFF:g} of its size")
    return sorted(outlines, key=lambda rows: -float(np.ptp(rows, axis=0).prod()))


def _place(point: Any) -> complex:
    return complex(float(point.x), float(point.y))


def _chords(arc: Any, off: float) -> list[complex]:
    """The ends of chords that are so far from an arc at most."""
    count = 4
    while True:
        places = np.array([_place(arc.point(0.5 * k / count)) for k in range(2 * count + 1)])
        ends = places[::2]
        worst = float(np.abs(places[1::2] - 0.5 * (ends[1:] + ends[:-1])).max())
        if worst <= off or count > _MOST_CHORDS:
            points: list[complex] = ends[1:].tolist()
            return points
        count = math.ceil(1.01 * count * math.sqrt(worst / off))
