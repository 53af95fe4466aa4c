"""A friction coefficient that depends on the slip speed: f(|u|) through given points."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, instance, positive, real, shown
from puck_tables._core.monotone import from_rest, monotone_cubic
from puck_tables._core.quantities import FRICTION, SPEED
from puck_tables._core.read_columns import numbers_of
from puck_tables._core.safe_write import write_bytes
from puck_tables.errors import InputError

KINDS = ("cubic", "linear")
HEADER = ("speed[m/s]", "f[1]")
_LARGEST = 1 << 24  # bytes of a file


@dataclass(frozen=True, eq=False)
class SpeedLaw:
    """Friction coefficient f against slip speed, through points.

    Parameters
    ----------
    speeds : array_like (k,), m/s
        Ascending, at least two.  Below a first speed above 0 its f holds.
    values : array_like (k,)
        f ≥ 0 at these speeds; of a speed given more than once the mean is taken.
    kind : 'cubic' or 'linear'
        Between the points: a cubic with a continuous slope that rises and falls only where the
        points do (no overshoot), or straight lines.

    Raises
    ------
    InputError
        If the points are not like that.

    Notes
    -----
    The cubic is that of :func:`puck_tables._core.monotone.monotone_cubic`.

    Examples
    --------
    >>> law = SpeedLaw([0.0, 1.0, 2.0], [0.3, 0.2, 0.2])
    >>> law([0.0, 0.5, 1.5]).round(6).tolist()
    [0.3, 0.23125, 0.2]
    """

    speeds: npt.ArrayLike
    values: npt.ArrayLike
    kind: str = "cubic"

    def __post_init__(self) -> None:
        speeds = finite_array("speeds", self.speeds, "m/s").copy()
        values = finite_array("values", self.values, "units of 1").copy()
        if speeds.ndim != 1 or speeds.shape != values.shape or speeds.size < 2:
            raise InputError(
                "speeds and values must be two lists of one length, at least 2, got the shapes "
                f"{speeds.shape} and {values.shape}"
            )
        speeds, values = from_rest(speeds, values, "the friction law")
        if values.min() < 0.0:
            raise InputError(
                f"a friction coefficient must not be negative, got {values.min():g} at the speed "
                f"{speeds[values.argmin()]:g} m/s"
            )
        instance("kind", self.kind, str)
        if self.kind not in KINDS:
            raise InputError(f"kind must be cubic or linear, got {shown(self.kind)}")
        object.__setattr__(self, "speeds", speeds)
        object.__setattr__(self, "values", values)

    def __eq__(self, other: object) -> bool:
        """Whether the points and what is between them are the same."""
        if not isinstance(other, SpeedLaw):
            return NotImplemented
        return self.kind == other.kind and all(
            np.array_equal(np.asarray(one), np.asarray(two))
            for one, two in ((self.speeds, other.speeds), (self.values, other.values))
        )

    def __hash__(self) -> int:
        return hash((self.kind, np.asarray(self.speeds).tobytes()))

    @property
    def top_speed(self) -> float:
        """The last speed, m/s; nothing is known beyond it."""
        return float(np.asarray(self.speeds)[-1])

    def as_rows(self) -> FloatArray:
        """Rows (k, 2) of speed and f, of which ``floor.law`` of a scene makes the same law.

        Raises
        ------
        InputError
            If it is one of straight lines: a floor's is cubic between its rows.
        """
        if self.kind != "cubic":
            raise InputError(
                f"a {self.kind} SpeedLaw is none of a floor, whose law is cubic between its points:"
                " give its values at more of them, as SpeedLaw(u, law(u))"
            )
        return np.stack([np.asarray(self.speeds), np.asarray(self.values)], axis=1)

    @cached_property
    def coefficients(self) -> FloatArray:
        """Powers 0 to 3 of (speed − left end) in each interval, array (k − 1, 4)."""
        x, y = np.asarray(self.speeds), np.asarray(self.values)
        if self.kind == "linear":
            rise = np.diff(y) / np.diff(x)
            return np.stack([y[:-1], rise, 0.0 * rise, 0.0 * rise], axis=-1)
        return monotone_cubic(x, y)

    def __call__(self, speed: npt.ArrayLike) -> FloatArray:
        """The friction coefficient at slip speeds.

        Parameters
        ----------
        speed : array_like, m/s, from 0 to ``top_speed``

        Raises
        ------
        InputError
            If a speed lies outside; nothing is extrapolated.

        Examples
        --------
        >>> SpeedLaw([0.0, 1.0], [0.3, 0.2])(2.0)
        Traceback (most recent call last):
        ...
        puck_tables.errors.InputError: speed = 2 m/s is outside this friction law (0 to 1 m/s)
        """
        u = finite_array("speed", speed, "m/s")
        outside = (u < 0.0) | (u > self.top_speed)
        if outside.any():
            raise InputError(
                f"speed = {u[outside].flat[0]:g} m/s is outside this friction law "
                f"(0 to {self.top_speed:g} m/s)"
            )
        return self.extended(u)

    def extended(self, speed: FloatArray) -> FloatArray:
        """Friction at speeds not checked: the last piece goes on for what rounding puts beyond."""
        x = np.asarray(self.speeds)
        cell = np.clip(np.searchsorted(x, speed, side="right") - 1, 0, x.size - 2)
        c, t = self.coefficients[cell], speed - x[cell]
        return np.asarray(c[..., 0] + t * (c[..., 1] + t * (c[..., 2] + t * c[..., 3])))

    grade: ClassVar[int] = 1  # nodes of a table need not crowd at slip zero

    def largest(self, top: float) -> float:
        """The largest f up to a speed, 0 included: it does not overshoot its points."""
        speeds, last = np.asarray(self.speeds), real("top", top, "m/s")
        if not last >= 0.0:
            raise InputError(f"top must not be negative (m/s), got {last:g}")
        return float(self.extended(np.append(speeds[speeds < last], last)).max())

    def pieces(self, top: float) -> tuple[FloatArray, FloatArray]:
        """The law in pieces up to a speed, see :mod:`puck_tables.contact.friction_laws`."""
        speeds, last = np.asarray(self.speeds), positive("top", top, "m/s")
        count = int(np.count_nonzero(speeds[:-1] < last))  # a corner at the top is not yet passed
        origins = np.stack([speeds[:count], np.ones(count)], axis=1)
        return speeds[: count + 1], np.concatenate([origins, self.coefficients[:count]], axis=1)

    @classmethod
    def from_csv(cls, path: str | Path, kind: str = "cubic") -> SpeedLaw:
        """Read a law: columns of speed and f, in m/s or in the unit that its heading says.

        Columns are known by names (speed, v; mu, f, COF), in any order and beside others; without
        headings they are speed and f.  Any separator and decimal mark, comments.

        Raises
        ------
        InputError
            If the file cannot be read or holds something else.

        Examples
        --------
        >>> SpeedLaw.from_csv("/nowhere/law.csv")
        Traceback (most recent call last):
        ...
        puck_tables.errors.InputError: cannot read /nowhere/law.csv: No such file or directory
        """
        numbers = numbers_of(path, (SPEED, FRICTION), 2, _LARGEST)
        numbers.refuse_unless_ascending("the speeds", equal=True)
        try:
            return cls(*from_rest(numbers.rows[:, 0], numbers.rows[:, 1], str(path)), kind)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None

    def to_csv(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the points to a CSV file that :meth:`from_csv` reads; the kind is not kept.

        Raises
        ------
        OutputError
            If the file exists (without ``overwrite``) or cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> law = SpeedLaw([0.0, 1.0], [0.3, 0.2])
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     law.to_csv(folder + "/law.csv")
        ...     float(SpeedLaw.from_csv(folder + "/law.csv")(0.25).round(6))
        0.275
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(HEADER)
        rows = zip(np.asarray(self.speeds).tolist(), np.asarray(self.values).tolist(), strict=True)
        writer.writerows(rows)
        write_bytes(path, text.getvalue().encode(), overwrite)
