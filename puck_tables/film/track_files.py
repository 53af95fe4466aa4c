"""Tracks from the files that people have: which kind a file is, and from its numbers to SI."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from puck_tables._core.arrays import instance
from puck_tables._core.safe_read import beginning, refuse_no_text
from puck_tables._core.text import HEAD, text_form_of
from puck_tables._core.text_rows import LARGEST
from puck_tables.errors import InputError
from puck_tables.film.column_roles import layout_of
from puck_tables.film.film import Film, Track, first_text
from puck_tables.film.plane import Marks
from puck_tables.film.reader_options import ReaderOptions
from puck_tables.film.readers import readers
from puck_tables.film.text_tables import film_in_text
from puck_tables.film.to_tracks import to_si


def read_tracks(
    path: str | Path, *, fps: float | None = None, unit: str | None = None,
    scale: str | float | None = None, angle_unit: str | None = None, y_down: bool | None = None,
    columns: str | None = None, marks: Marks | None = None,
    centre: str | Sequence[str] | None = None, toward: str | None = None,
    likelihood: float | None = None, pucks: str | Sequence[str] | None = None,
    up: str | None = None,
) -> tuple[Track, ...]:  # fmt: skip
    r"""The tracks of all pucks in a file.

    Read are tables in text files (CSV and the like: any header, separator, encoding and decimal
    mark) and spreadsheets (.xlsx, .ods), the files and exports of Tracker (.trk, .trz), the tables
    of trackpy, DeepLabCut and SLEAP, the HDF5 files of the latter two, exports of Qualisys, Vicon
    and OptiTrack, .trc and C3D files, tables of ROS, and what ``puck track`` saves (HDF5, JSON,
    JSON lines).  What a file does not say is asked for, never guessed; what was found and done
    stands in the ``notes`` of a track.

    Parameters
    ----------
    path : the file
    fps : float, optional
        Frames a second, for frame numbers; where a file has times, too, they are then not used.
    unit : str, optional
        Of the places, where the file does not say: m, cm, mm, in, px, ...
    scale : str or float, optional
        The size of a pixel: '0.5mm', or in metres; or a scale bar in the picture, '240px=30cm'.
    angle_unit : {'rad', 'deg', 'turn'}, optional
        Of a column of angles, where its heading does not say.
    y_down : bool, optional
        Whether y grows downwards in the file, as in pictures; it does by default where places
        are in pixels.  Angles turn from x to y of the file.
    columns : str, optional
        Headings for all columns of a table in place of its own, '-' for those to leave out:
        't,x,y', 'frame,red_x [px],red_y [px],-', 'x [cm],y [cm],dt [ms]'.
    marks : str, Path or array_like (n, 4), optional
        Four marks or more on the floor, rows of their pixels u, v and their places x, y in m (or a
        CSV file of them, with a header that says the unit): a tilted camera.
    centre : str or sequence of str, optional
        The marks on a puck in whose middle its centre lies: 'hub', 'red,blue'.  Where several
        pucks have marks alike (cm1, ed1, cm2, ed2), what these have in common: 'cm'.
    toward : str, optional
        The mark on a puck that its angle points to from the centre.
    likelihood : float, optional
        Places less likely are taken as not seen.
        Default: 0.6 as in DeepLabCut; of SLEAP's scores none.
    pucks : str or sequence of str, optional
        Those to read, by name.
    up : {'x', 'y', 'z'}, optional
        The axis that points up, of places in space.  Default: as the file says, z where it does
        not; refused where the puck would go up and down.

    Returns
    -------
    tuple of Track
        Times in s, places in m, angles in rad as the file has them, counter-clockwise.

    Raises
    ------
    InputError
        If the file cannot be read, is none of these, or leaves something open.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "a.csv").write_text("frame;x [cm];y [cm]\n0;0,5;1\n1;0,7;1\n")
    ...     track, = read_tracks(Path(folder, "a.csv"), fps=100)
    >>> track.time.tolist(), track.place.round(9).tolist()
    ([0.0, 0.01], [[0.005, 0.01], [0.007, 0.01]])
    """
    instance("path", path, str, Path)
    instance("columns", columns, str, type(None))
    if "\0" in str(path):
        raise InputError("path must be the name of a file, it holds a NUL")
    how = ReaderOptions(
        fps, unit, scale, angle_unit, y_down, marks, centre, toward, likelihood, pucks, up
    )
    try:
        film = film_of(path, columns)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    return to_si(path, film, how)


def film_of(path: str | Path, columns: str | None = None) -> Film:
    """What a file holds, by how it begins.

    Raises InputError if it is none that is known, or damaged; OSError if it cannot be read.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "a.csv")
    ...     _ = file.write_text("frame,x_px,y_px" + chr(10) + "0,3,1")
    ...     film_of(file).unit
    'px'
    """
    head = beginning(path, LARGEST)
    for reader in readers():
        if reader.opens(path, head):
            if reader.as_text is not None:
                content = reader.as_text(path, head)
                form = text_form_of(path, content[:HEAD])
                return film_in_text(path, form, layout_of(path, form, columns), content)
            assert reader.film_of is not None
            film = reader.film_of(path, head)
            if columns is None:
                return film
            raise InputError(f"{path} is a {film.kind}, not a table: leave columns (--columns) out")
    if first_text(path, head):
        refuse_no_text(path, head)
    form = text_form_of(path, head)
    return film_in_text(path, form, layout_of(path, form, columns))
