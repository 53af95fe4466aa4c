"""What every table is: functions over the slip angle and at most one second axis.

A table is node values, splined between, judged against a truth.  What is particular to a kind (its
axes, how a node is computed, what is splined, its truth) stands with the kind, a subclass; how
tables are saved, read, judged and refused is the same for all.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, ClassVar, Self, cast

import numpy as np

from puck_tables._core.arrays import FloatArray, instance, shown
from puck_tables._core.lazy import above, names_above
from puck_tables._core.safe_write import write_bytes
from puck_tables._core.waiting import Progress
from puck_tables.errors import InputError, OutputError, TableError
from puck_tables.io.columns import Variable
from puck_tables.table.check import Accuracy, CheckReport
from puck_tables.table.file import AGAIN, decode, encode, read_content

_KIND = "table of "  # how the package says where the class of a kind stands


@dataclass(frozen=True, eq=False, repr=False)
class Table(ABC):
    """A table: build one, save it, load it, ask it, judge it.

    A kind adds, as fields, what its values follow from: a law, lines, a grid; files hold them.

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

    values: FloatArray
    tolerance: float = field(default=0.0, kw_only=True)
    accuracy: Accuracy | None = field(default=None, kw_only=True)
    metadata: dict[str, Any] = field(default_factory=dict, kw_only=True)
    source: str = field(default="memory", kw_only=True)

    # what a kind is, as its files have it
    kind: ClassVar[str]
    algorithm: ClassVar[str]
    functions: ClassVar[Mapping[str, str]]  # names, and what they are
    second: ClassVar[str]  # the second axis, in words for a report
    errors: ClassVar[str] = "absolute errors"  # what they are, in such words
    quantities: ClassVar[tuple[str, ...]]  # what has them
    words: ClassVar[Mapping[str, str]]  # title, interpretation, method, maps of the axes

    def __post_init__(self) -> None:
        values = self.values.view()
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    def __repr__(self) -> str:
        return (
            f"<Table of {self.kind}: {self.pressure_law} pressure, {self.grid}, "
            f"to {self.tolerance:g}, {self.source}>"
        )

    def __str__(self) -> str:
        """What it holds and how good it is, as ``puck info`` prints it."""
        return str(above("report of Table")(self))

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
            Q/(fg), Q²/(fg) and Q²/(fg r)): from 1e-11, default 1e-10.  Speed (over the largest f):
            from 1e-13, under an annulus or ring 1e-9, galin, hertz and profiles 1e-8, default 1e-6.
            One puck (of its friction ratios): from 5e-13, default 1e-9; of its stops, as above,
            from 1e-10, default 1e-8.
        cells : int, optional
            Resultants and stops: grid size by hand instead, cells on each side of each singular
            line, from 4 (stops: 8) on.
        top_speed, scale : float, optional
            Speed: the fastest slip v + r|ω|, m/s, and the speed below which a function is nearly a
            cubic; a function, and a law by name, need the first.
        pressure, reach : optional
            Speed: a pressure law as above, default uniform, and the part of the radius r on which
            it stands, default 1.
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
        for kind in map(_kind_named, kinds()) if cls is Table else (cls,):
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
        return cls.read(read_content(path), str(path))

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
        table: Self = _shipped(kind if cls is Table else cls.kind)
        return table

    @classmethod
    def read(cls, content: bytes, source: str) -> Self:
        """The table in the bytes of a file from a source; see :meth:`load`."""
        served = kinds() if cls is Table else [cls.kind]
        try:
            said, arrays, made_of = decode(content, source)
            if said["kind"] not in served:
                raise TableError(
                    f"{source} holds '{said['kind']}', not a table of "
                    f"{' or '.join(map(repr, served))}: give a file made by 'puck build-tables'"
                )
            kind = _kind_named(said["kind"])
            if said["algorithm"] != kind.algorithm:
                raise TableError(f"{source} was made by a recipe that this program does not know")
            if made_of:
                from puck_tables.table.law_record import from_plain  # not for stops: 25 ms

                made_of = {name: from_plain(one) for name, one in made_of.items()}
            return cast(Self, kind(
                np.stack([arrays[name] for name in kind.functions], axis=-1), **made_of,
                tolerance=said["tolerance"], accuracy=Accuracy.read(said["achieved_accuracy"]),
                metadata=said, source=source,
            ))  # fmt: skip
        except (KeyError, ValueError, TypeError, OSError) as error:  # under a right seal
            raise TableError(
                f"{source} cannot be read as a table ({type(error).__name__}: {error}): {AGAIN}"
            ) from None

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
            measured accuracy, no tolerance below 1, a value that is not finite, or a law that no
            file can hold.
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
        if self.accuracy is None or not np.all(np.isfinite(self.values)):
            raise OutputError(
                "a table without measured accuracy or with a non-finite value is not saved"
            )
        if not 0.0 < self.tolerance < 1.0:
            raise OutputError(
                f"a table that promises an error of {self.tolerance:g} is not saved: it must be "
                "between 0 and 1"
            )
        from puck_tables.table.law_record import plain

        own = [one.name for one in fields(self)[len(fields(Table)) :]]
        said = {
            "kind": self.kind, "pressure_law": self.pressure_law, "algorithm": self.algorithm,
            **self.words, "valid_range": self.valid_range, "tolerance": self.tolerance,
            "achieved_accuracy": self.accuracy.text(), "command": command,
        }  # fmt: skip
        functions = {
            name: Variable(self.values[..., number], tuple(self.axes), "1", long_name)
            for number, (name, long_name) in enumerate(self.functions.items())
        }
        content = encode(
            self.axes, functions, said, {name: plain(getattr(self, name)) for name in own}
        )
        written = type(self).read(content, str(path))
        if not np.array_equal(written.values, self.values):
            raise TableError(f"{path}: the table does not read back as it was written")
        write_bytes(path, content, overwrite)
        return written

    @abstractmethod
    def validate(self, progress: Progress | None = None) -> CheckReport:
        """Judge the table by truths that share no code with it.

        The points are other ones at every call, and the bounds are the kind's own: what a file
        says of itself is no yardstick.
        """

    # what a kind says

    @classmethod
    @abstractmethod
    def is_of(cls, of: object) -> bool:
        """Whether tables of this kind are built of such a thing."""

    @classmethod
    @abstractmethod
    def built(cls, of: Any, accuracy: float | None, **how: Any) -> Self:
        """Such a table, see :meth:`build`."""

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return "uniform"

    @property
    def grid(self) -> str:
        """How many nodes it has, in words."""
        return " x ".join(f"{len(one.values)} {n}" for n, one in self.axes.items()) + " nodes"

    @property
    @abstractmethod
    def valid_range(self) -> str:
        """Where it holds, in words; beyond it look-ups are refused."""

    @property
    @abstractmethod
    def axes(self) -> dict[str, Variable]:
        """The axes of the functions, in their order."""


def kinds() -> list[str]:
    """The names of the kinds of tables; the package says where their classes stand.

    >>> kinds()[:2]
    ['resultants', 'stops']
    """
    return [name.removeprefix(_KIND) for name in names_above(_KIND)]


def _kind_named(name: str) -> type[Table]:
    """The class, loaded when it is asked for."""
    kind: type[Table] = above(_KIND + name)
    return kind


def refuse_other_kind(table: Table | None, *kinds: type[Table]) -> None:
    """Refuse a table, if one is given, that is not of these kinds.

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
    if kind not in kinds() or not place.is_file():
        raise InputError(
            f"no table of {shown(kind)} comes along: there are 'resultants' and 'stops'"
        )
    return _kind_named(kind).read(place.read_bytes(), f"default table of {kind}")
