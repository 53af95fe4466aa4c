"""Track row column files (.trc) of Motion Analysis Cortex and OpenSim: marks in space, y up.

References
----------
Motion Analysis, Cortex manual; OpenSim, "Marker (.trc) Files".
"""

from __future__ import annotations

from pathlib import Path

from puck_tables._core.beginning import beginning
from puck_tables._core.text_rows import LARGEST
from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import film_below

_BEGINS = b"PathFileType"


def film_of_trc(path: str | Path) -> Film:
    r"""The film in a .trc file.

    Raises
    ------
    InputError
        If it names no marks.

    Examples
    --------
    >>> import tempfile
    >>> said = "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tUnits\n60\tmm\nFrame#\tTime\thub\t\t\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "a.trc").write_text(
    ...         said + "\t\tX1\tY1\tZ1\n\n1\t0\t7\t8\t9\n2\t.1\t7\t8\t8\n")
    ...     film = film_of_trc(Path(folder, "a.trc"))
    >>> film.unit, film.up, film.bodies[0].marks["hub"].tolist()
    ('mm', 'y', [[7.0, 8.0, 9.0], [7.0, 8.0, 8.0]])
    """
    head = beginning(path, LARGEST)
    rows = [line.rstrip("\r").split("\t") for line in head.decode("utf-8", "replace").split("\n")]
    at = next((n for n, row in enumerate(rows[:20]) if row[0].startswith("Frame")), -1)
    marks = [name.strip() for name in rows[at][2:] if name.strip()] if at > 2 else []
    if not marks:
        raise InputError(f"{path} has no row 'Frame#, Time' with names of marks: export it again")
    said = dict(zip(rows[1], rows[2], strict=False))
    unit = unit_word(said.get("Units", ""), "length")
    columns = [("", Heading("frame")), ("", Heading("time", "", "s"))]
    columns += [("", Heading(axis, mark, unit)) for mark in marks for axis in "xyz"]
    film = film_below(path, head, at + 2, columns, "track row column file")
    film.bodies[0].frame = None
    film.up = "y"
    return film


READERS = (Reader(lambda _, head: head.startswith(_BEGINS), film_of_trc),)
