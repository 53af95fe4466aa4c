"""Marks on the floor from a file: the pixels and the place of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from puck_tables._core.safe_read import read_whole
from puck_tables._core.text import look_at
from puck_tables._core.text_rows import read_columns
from puck_tables._core.units import PIXEL, factor, unit_in
from puck_tables.errors import InputError
from puck_tables.film.plane import Marks, Plane, plane_of

_LARGEST = 1 << 20  # bytes: a file of marks has some hundred


def plane_from(marks: Marks) -> Plane:
    """The homography that marks fix, given as rows or in a CSV file.

    Parameters
    ----------
    marks : str, Path or array_like (n, 4)
        A file of columns u, v (pixels) and x, y, whose header says the unit of the last two; or
        rows of the same in pixels and metres.

    Raises
    ------
    InputError
        If the file cannot be read or does not say the unit, or as :func:`plane_of`.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "marks.csv")
    ...     rows = ["u,v,x [cm],y [cm]", "0,0,0,0", "100,0,50,0", "90,70,50,40", "10,70,0,40"]
    ...     _ = file.write_text(chr(10).join(rows))
    ...     plane_from(file).place(np.array([[50.0, 0.0]]))[0, 0].round(9).item()
    0.25
    """
    if not isinstance(marks, str | Path):
        return plane_of(marks)
    try:
        look = look_at(marks, read_whole(marks, _LARGEST))
    except OSError as error:
        raise InputError(f"cannot read {marks}: {error.strerror or error}") from None
    form = f"{marks} must have the columns u, v, x, y: the pixels and the place of each mark"
    if look.width != 4:
        raise InputError(f"{form}; it has {look.width}")
    units = {unit_in(cell) for cell in look.header[-1][2:]} if look.header else {""}
    if len(units) > 1 or not units - {"", PIXEL}:
        raise InputError(f"{form}, with the unit of the places in the header, as in x [cm], y [cm]")
    values, _ = read_columns(marks, look, range(4), ())
    size = factor(units.pop(), "length")
    rows = np.column_stack([values[0], values[1], values[2] * size, values[3] * size])
    if not np.isfinite(rows).all():
        raise InputError(f"{form}, none of them left empty")
    return plane_of(rows)
