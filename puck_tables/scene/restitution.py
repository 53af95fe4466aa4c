"""Restitution: how fast two rims part, over how fast they met.

A law is a small class.  What the engine needs of it is a row of numbers, the first of which says
whose formula holds (:mod:`puck_tables.scene.restitution_at`).  A plain number is the law of Newton,
restitution that does not depend on speed.  Whatever the law, what happens along the rims is
Walton's (tangential restitution and Coulomb's friction, see :mod:`puck_tables.motion.impact_law`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, real
from puck_tables._core.fields import of
from puck_tables._core.monotone import from_rest, monotone_cubic
from puck_tables._core.quantities import RESTITUTION, SPEED
from puck_tables._core.read_columns import numbers_of
from puck_tables._core.safe_read import is_number
from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.scene.restitution_at import PLASTIC, TABLE, VISCOELASTIC, restitution_at

MAX_BYTES = 1 << 24  # of a file of speeds: more is no law


@dataclass(frozen=True)
class Restitution:
    """A restitution that depends on the speed of approach."""

    source: ClassVar[str] = ""

    @property
    def name(self) -> str:
        """Its text in a scene file."""
        raise NotImplementedError

    @property
    def numbers(self) -> FloatArray:
        """What the engine needs."""
        raise NotImplementedError

    def __call__(self, speed: npt.ArrayLike) -> FloatArray:
        """The restitution at speeds of approach, m/s, ≥ 0, else InputError; NaN beyond a table.

        >>> Plastic(0.1)([0.05, 0.2]).round(6).tolist()
        [1.0, 0.930626]
        """
        speeds = finite_array("speed", speed, "m/s")
        if (speeds < 0.0).any():
            raise InputError(f"speed = {speeds.min():g} m/s must not be negative")
        numbers = self.numbers
        values = np.array([restitution_at(numbers, 0, one) for one in speeds.ravel().tolist()])
        return np.where(values < 0.0, np.nan, values).reshape(speeds.shape)


@dataclass(frozen=True)
class Viscoelastic(Restitution):
    """Viscoelastic spheres, or rims that touch in one point: e = 1 − C v^(1/5) + (3/5) C² v^(2/5)…

    With s = √(C v^(1/5)/1.15345),

        e = (1 + c s)/(1 + c s + 1.15345 s² + 0.577977 s³ + 0.532178 s⁴),   c = 0.501086,

    the Padé approximant of the whole series, within 0.009 of the equation of motion at all speeds.

    Parameters
    ----------
    loss : C, (s/m)^(1/5), > 0

    Examples
    --------
    >>> law = Viscoelastic(0.2)
    >>> law.name, law(1.0).round(6).item()
    ('viscoelastic:0.2', 0.824241)
    """

    loss: float
    source: ClassVar[str] = (
        "Ramirez, Poeschel, Brilliantov, Schwager 1999; Mueller, Poeschel 2011, Physical Review E"
    )

    def __post_init__(self) -> None:
        _positive(self, "loss", "(s/m)^(1/5)")

    @property
    def name(self) -> str:
        """Its text in a scene file."""
        return f"viscoelastic:{self.loss!r}"

    @property
    def numbers(self) -> FloatArray:
        """What the engine needs."""
        return np.array([VISCOELASTIC, self.loss])


@dataclass(frozen=True)
class Plastic(Restitution):
    """Spheres, or rims that touch in one point, that yield: 1 up to the yield speed V, above it

        e = (6√3/5)^½ (1 − q²/6)^½ (q/(q + 2 √(6/5 − q²/5)))^¼,   q = V/v,

    which falls like 1.185 (V/v)^¼.

    Parameters
    ----------
    yield_speed : V, m/s, > 0

    Examples
    --------
    >>> law = Plastic(0.05)
    >>> law.name, law(1.0).round(6).item()
    ('plastic:0.05', 0.557109)
    """

    yield_speed: float
    source: ClassVar[str] = "Thornton 1997, Journal of Applied Mechanics 64"

    def __post_init__(self) -> None:
        _positive(self, "yield_speed", "m/s")

    @property
    def name(self) -> str:
        """Its text in a scene file."""
        return f"plastic:{self.yield_speed!r}"

    @property
    def numbers(self) -> FloatArray:
        """What the engine needs."""
        return np.array([PLASTIC, self.yield_speed])


@dataclass(frozen=True, eq=False)
class RestitutionTable(Restitution):
    """Restitution against the speed of approach, through points that were measured.

    Between the points a cubic that rises and falls only where they do.  Nothing is known beyond the
    last: a run in which rims meet faster is refused.

    Parameters
    ----------
    speeds : array_like (k,), m/s, ascending, at least two
        Below a first speed above 0 its restitution holds.
    values : array_like (k,), from 0 to 1
        Of a speed given more than once the mean is taken.
    file : the file it comes from; left out, its points are its name

    Raises
    ------
    InputError
        If the points are not like that.

    Examples
    --------
    >>> law = RestitutionTable([0.0, 1.0, 3.0], [0.9, 0.8, 0.7])
    >>> law([0.0, 0.5, 3.0]).round(6).tolist()
    [0.9, 0.844071, 0.7]
    """

    speeds: npt.ArrayLike
    values: npt.ArrayLike
    file: str = ""
    source: ClassVar[str] = "measured"

    def __post_init__(self) -> None:
        speeds = finite_array("speeds", self.speeds, "m/s").copy()
        values = finite_array("values", self.values, "units of 1").copy()
        if speeds.ndim != 1 or speeds.shape != values.shape or speeds.size < 2:
            raise InputError(
                "a table of restitution must be two or more rows of the speed of approach, m/s, "
                "and the restitution"
            )
        speeds, values = from_rest(speeds, values, "the restitution")
        if values.min() < 0.0 or values.max() > 1.0:
            wrong = values[(values < 0.0) | (values > 1.0)][0]
            raise InputError(f"a restitution must be from 0 to 1, got {wrong:g}")
        object.__setattr__(self, "speeds", speeds)
        object.__setattr__(self, "values", values)

    def __eq__(self, other: object) -> bool:
        """Whether the points are the same."""
        if not isinstance(other, RestitutionTable):
            return NotImplemented
        return np.array_equal(self.numbers, other.numbers)

    __hash__ = None  # type: ignore[assignment]  # arrays

    @property
    def name(self) -> str:
        """Its text in a scene file."""
        points = zip(np.asarray(self.speeds), np.asarray(self.values), strict=True)
        return self.file or "table:" + ",".join(f"{float(v)!r}={float(e)!r}" for v, e in points)

    @property
    def numbers(self) -> FloatArray:
        """What the engine needs: how many points, their speeds, the cubics."""
        x, y = np.asarray(self.speeds), np.asarray(self.values)
        return np.concatenate([[TABLE, x.size], x, monotone_cubic(x, y).ravel()])


def _table_of(text: str) -> RestitutionTable:
    """The law of points 'V=E,V=E,...'."""
    pairs = [point.partition("=") for point in text.split(",")]
    if not all(is_number(speed) and is_number(value) for speed, _, value in pairs):
        raise InputError(
            f"'table:{text[:60]}': must be speeds, m/s, and restitutions, such as "
            "'table:0=0.9,2=0.7'"
        )
    return RestitutionTable([float(one) for one, *_ in pairs], [float(one) for *_, one in pairs])


NAMED = {"viscoelastic": Viscoelastic, "plastic": Plastic}
LISTED = "'viscoelastic:C', 'plastic:V', or the name of a CSV file of speed in m/s and restitution"


def restitution_law(law: str | Restitution) -> Restitution:
    """A law from its name, as ``"viscoelastic:0.2"``, or from a CSV file.

    Raises InputError if there is no such law or file, or a number of it is wrong.

    >>> restitution_law("plastic:0.05").yield_speed
    0.05
    >>> restitution_law("viscoelastik:0.1")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: there is no law of restitution 'viscoelastik:0.1' (did you mean \
'viscoelastic'?): give a number from 0 to 1, 'viscoelastic:C', 'plastic:V', or the name of a CSV \
file of speed in m/s and restitution
    """
    if isinstance(law, Restitution):
        return law
    if law.lower().endswith(".csv"):
        numbers = numbers_of(law, (SPEED, RESTITUTION), 2, MAX_BYTES)
        numbers.refuse_unless_ascending("the speeds", equal=True)
        try:
            points = from_rest(numbers.rows[:, 0], numbers.rows[:, 1], law)
            return RestitutionTable(*points, law)
        except InputError as error:
            raise InputError(f"{law}: {error}") from None
    name, _, number = law.partition(":")
    if name == "table":
        return _table_of(number)
    if name not in NAMED:
        raise InputError(
            f"there is no law of restitution {law[:60]!r}{meant(name.lower(), NAMED)}: give a "
            f"number from 0 to 1, {LISTED}"
        )
    if not is_number(number):
        raise InputError(f"{law[:60]!r}: the law needs a number, such as '{name}:0.1'")
    return NAMED[name](float(number))


def restitution_of(default: float | None, **how: Any) -> Any:
    """A field of a dataclass that takes a restitution, a number or a law.

    >>> restitution_of(1.0).default
    1.0
    """
    return of(
        "number", default, low=0.0, high=1.0, objects=(Restitution,), file=".csv",
        law=restitution_law, laws=LISTED, **how,
    )  # fmt: skip


def _positive(law: Restitution, field: str, unit: str) -> None:
    """Check the number of a law."""
    value = real(field, getattr(law, field), unit)
    if not value > 0.0:
        raise InputError(f"{field} must be greater than 0 {unit}, got {value:g}")
    object.__setattr__(law, field, value)
