"""What every table is: functions over the slip angle and at most one second axis.

A table is node values, splined between, judged against a truth.  What is particular to a kind (its
axes, how a node is computed, what is splined, its truth) stands with the kind, a subclass; how
tables are built, saved, read and refused is the same for all.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Self, cast

from puck_tables._core.real import instance, shown
from puck_tables.errors import InputError
from puck_tables.table import file
from puck_tables.table.check import CheckReport
from puck_tables.table.metadata import KINDS, Progress, Record, kind_named


@dataclass(frozen=True, eq=False, repr=False)
class Table(Record):
    """A table: build one, save it, load it, ask it, judge it.

    Parameters
    ----------
    values : array (nodes of φ, nodes of the second axis, functions)
        At the nodes; read-only.
    tolerance : float
        The error the table promises; 0 while it is not known.
    accuracy : Accuracy or None
        The errors that were measured when it was built.
    metadata : dict
        What its file says of it.
    source : str
        Where it came from, for messages.

    Examples
    --------
    >>> table = Table.build("annulus:0.8", accuracy=1e-5)
    >>> table
    <Table of resultants: annulus:0.8 pressure, 89 phi x 4 delta nodes, to 1e-05, memory>
    >>> float(table.resultants(0.0, 1.0).perpendicular.round(6)), table.validate().passed
    (0.25, True)
    """

    @classmethod
    def build(cls, of: Any = "uniform", accuracy: float | None = None, **how: Any) -> Self:
        """Tabulate, and measure how exact the result is.

        Parameters
        ----------
        of : what it is a table of
            A pressure law (:class:`puck_tables.Law`, or as :func:`puck_tables.law_of` takes it):
            the friction resultants in full contact.  ``"stops"``: stops and the way to them.  A
            :class:`puck_tables.SpeedLaw`, a law by name (:class:`puck_tables.StribeckLaw` and its
            like), or a function from speeds in m/s to f: friction with a coefficient that depends
            on the slip speed.  A pair of a pressure law and a height δ:
            the friction of one puck, under uniform pressure also where part of its base lifts;
            with a radius of gyration (in units of r) as a third, its stops.
        accuracy : float, optional
            Largest error wanted, up to 0.01.  Resultants (dimensionless): from 1e-13, default
            2e-11, under another law than uniform pressure 1e-11 and 1e-9.  Stops (in units of
            Q/J, Q²/J and Q²/(J r)): from 1e-11, default 1e-10.  Speed (over the largest f): from
            1e-13, default 1e-6.  One puck (of its friction ratios): from 5e-13, default 1e-9; of
            its stops, as above, from 1e-10, default 1e-8.
        cells : int, optional
            Resultants and stops: grid size by hand instead, cells on each side of each singular
            line, from 4 (stops: 8) on.
        top_speed, scale : float, optional
            Speed: the fastest slip v + r|ω|, m/s, and the speed below which a function is nearly a
            cubic; a function, and a law by name, need the first.
        progress : callable (done, total), optional

        Returns
        -------
        Table
            With ``accuracy`` measured at random and adversarial points.

        Raises
        ------
        InputError
            If it is none of these or a number is out of range.
        AccuracyError
            If the accuracy is out of reach.

        Notes
        -----
        The error falls like cells⁻⁴; under a friction law over the slip speed with order 4 and
        more, 2 to 4 where the law itself has corners.

        References
        ----------
        Salnikova, Treschev, Gallyamov 2012, sections 3, 5, 6 and 7.

        Examples
        --------
        >>> table = Table.build(accuracy=1e-6)
        >>> table.grid, table.accuracy.worst <= 1e-6
        ('69 phi x 4 delta nodes', True)
        """
        for kind in map(kind_named, KINDS) if cls is Table else (cls,):
            if kind.is_of(of):
                return cast(Self, kind.built(of, accuracy, **how))
        raise InputError(
            f"a table is built of a pressure law, a friction law over the slip speed or 'stops', "
            f"not of {of!r}"
        )

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a table file.

        Parameters
        ----------
        path : path of an HDF5 table file

        Raises
        ------
        TableError
            If the file is missing, not a table, of another kind or format, or altered: its digest
            is checked at every load.

        Examples
        --------
        >>> Table.load("/nowhere/table.h5")
        Traceback (most recent call last):
        ...
        puck_tables.errors.TableError: there is no table file /nowhere/table.h5: build one with \
'puck build-tables -o FILE', or leave --table out to use the tables that come along
        """
        return cls.read(file.read_content(path), str(path))

    @classmethod
    def shipped(cls, kind: str = "resultants") -> Self:
        """A table that comes with the package.

        Parameters
        ----------
        kind : ``"resultants"`` (uniform pressure) or ``"stops"``

        Raises
        ------
        InputError
            If none of that kind does.

        Examples
        --------
        >>> Table.shipped().tolerance, Table.shipped("stops").tolerance
        (2e-11, 1e-10)
        """
        instance("kind", kind, str)
        found: Self = _shipped(kind if cls is Table else cls.kind)
        return found

    @classmethod
    def read(cls, content: bytes, source: str) -> Self:
        """The table in the bytes of a file from a source; see :meth:`load`."""
        kinds = tuple(KINDS) if cls is Table else (cls.kind,)
        return cast(Self, file.decode(content, source, kinds))

    def save(
        self, path: str | Path, overwrite: bool = False, command: str = "library call"
    ) -> Self:
        """Write the table to an HDF5 file, read it back, and only then give it its name.

        Parameters
        ----------
        path : path of the file
        overwrite : whether an existing file may be replaced
        command : how it was made, for the record

        Returns
        -------
        Table
            As loaded from what was written.

        Raises
        ------
        OutputError
            If the file exists (without ``overwrite``) or cannot be written, or the table has no
            measured accuracy, a value that is not finite, or a law that no file can hold.
        TableError
            If what was written does not read back as the same table.

        Examples
        --------
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     saved = Table.build(accuracy=1e-6).save(folder + "/rough.h5")
        >>> saved.metadata["pressure_law"]
        'uniform'
        """
        return cast(Self, file.save(self, path, overwrite, command))

    @abstractmethod
    def validate(self, progress: Progress | None = None) -> CheckReport:
        """Judge the table by truths that share no code with it.

        The points are other ones at every call, and the bounds are the kind's own: what a file
        says of itself is no yardstick.
        """


def refuse_other_kind(table: Table | None, *kinds: type[Table]) -> None:
    """Refuse a table, if one is given, that is not of these kinds.

    Raises
    ------
    InputError

    Examples
    --------
    >>> refuse_other_kind(Table.shipped("stops"), type(Table.shipped()))
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: table must be a Table of resultants, got one of stops
    """
    if table is not None and not isinstance(table, kinds):
        wanted = " or ".join(kind.kind for kind in kinds)
        got = f"one of {table.kind}" if isinstance(table, Table) else f"a {type(table).__name__}"
        raise InputError(f"table must be a Table of {wanted}, got {got}")


@cache
def _shipped(kind: str) -> Any:
    place = files("puck_tables.tables").joinpath(f"{kind}.h5")
    if kind not in KINDS or not place.is_file():
        raise InputError(
            f"no table of {shown(kind)} comes along: there are 'resultants' and 'stops'"
        )
    return cast("type[Table]", kind_named(kind)).read(
        place.read_bytes(), f"default table of {kind}"
    )
