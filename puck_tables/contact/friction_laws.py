"""Friction laws over the slip speed that go by a name and a few numbers, as people fit them.

A law is one class here, with its formula, its numbers and what they may be; it stands in
:data:`NAMED`, and in nothing else.  Its table, scenes, sweeps and files follow from that.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, positive, real
from puck_tables._core.fields import of, specs
from puck_tables._core.reading import Reading, mark_checked, read_values
from puck_tables.errors import InputError

# below, f is too steep at rest for a table; above, it is a step
_LEAST_EXPONENT, _LARGEST_EXPONENT = 0.5, 8.0
_SMOOTH = 6.0  # a table of degree 5 sees no singularity of this power and above
_LARGEST_TOP = 1e100  # m/s
_LOOKS = 513  # speeds at which the largest f is looked for
# of Chebyshev's series of a piece: its degree, its nodes, and places that judge it between them
_DEGREE = 15
_ANGLES = np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1)
_NODES = np.cos(_ANGLES)
_PROBES = np.linspace(-1.0, 1.0, 37)
_ROUNDING = 4e-15  # of the largest f: what a piece may miss
# half a piece at least, of the top and of its place: what is left of a root at slip zero
_SHORTEST, _NARROWEST = 1e-26, 1e-6


class FrictionLaw:
    """A friction coefficient f over the slip speed u ≥ 0, by a formula that holds at all speeds.

    Numbers are checked when a scene or a table is made of it, or f is asked.
    """

    kind: str  # its name
    source: ClassVar[str] = ""

    def formula(self, u: FloatArray) -> FloatArray:
        """F at speeds in m/s, unchecked."""
        raise NotImplementedError

    @property
    def scales(self) -> tuple[float, ...]:
        """Speeds, m/s, over which f changes; a table is divided there."""
        return ()

    @property
    def root(self) -> float | None:
        """The power with which f leaves its value at slip zero where that is no whole number."""
        return None

    def faults(self) -> list[str]:
        """What is wrong between numbers that are each in range."""
        return []

    # what follows from these

    @property
    def grade(self) -> int:
        """How strongly the nodes of a table crowd at slip zero: with this power f is smooth."""
        return 1 if self.root is None else math.ceil(_SMOOTH / self.root)

    @property
    def numbers(self) -> list[float]:
        """Its numbers in their order."""
        named = [spec.name for name, spec in specs(type(self)).items() if name != "kind"]
        return [float(getattr(self, name)) for name in named]

    def checked(self) -> FrictionLaw:
        """Itself, with plain numbers; InputError if one is out of range: all of them are named."""
        numbers = {name: getattr(self, spec.name) for name, spec in specs(type(self)).items()}
        reading = Reading([], None)
        values = read_values(type(self), numbers, "", reading)
        if values is None:
            raise InputError(f"friction law {self.kind}: {'; '.join(reading.errors)}")
        law = type(self)(**values)
        if faults := law.faults():
            raise InputError(f"friction law {self.kind}: {'; '.join(faults)}")
        mark_checked(law)
        return law

    def __call__(self, speed: npt.ArrayLike) -> FloatArray:
        """The friction coefficient at slip speeds ≥ 0, m/s; InputError if one is out of range."""
        law = self if "_checked" in vars(self) else self.checked()
        speeds = finite_array("speed", speed, "m/s")
        if (speeds < 0.0).any():
            raise InputError(f"speed = {speeds.min():g} m/s must not be negative")
        return np.asarray(law.formula(speeds))

    def largest(self, top: float) -> float:
        """The largest f up to a speed, 0 included."""
        last = real("top", top, "m/s")
        last = last and _checked_top(last)
        speeds = np.concatenate([[0.0], last * np.linspace(0.0, 1.0, _LOOKS), self.scales])
        return float(self.formula(speeds[speeds <= last]).max())

    def pieces(self, top: float) -> tuple[FloatArray, FloatArray]:
        """The law in pieces up to a speed, see :func:`pieces_of_function`."""
        return _pieces(self, _checked_top(top))


def _checked_top(top: float) -> float:
    """Up to which speed, m/s: one of which shares are still numbers."""
    last = positive("top", top, "m/s")
    if not 1.0 / _LARGEST_TOP <= last <= _LARGEST_TOP:
        raise InputError(
            f"top must be from {1.0 / _LARGEST_TOP:g} to {_LARGEST_TOP:g} m/s, got {last:g}"
        )
    return last


@lru_cache(maxsize=64)  # each slab of a table has a top of its own
def _pieces(law: FrictionLaw, top: float) -> tuple[FloatArray, FloatArray]:
    """Worked out once for all patches of a table."""
    inner = sorted({speed for speed in law.scales if 0.0 < speed < top})
    return pieces_of_function(law.formula, np.array([0.0, *inner, top]))


def _kind(name: str) -> Any:
    """The entry by which a table in a scene says which law it is."""
    return of("choice", name, doc="which law", choices=(name,), acts="")


@dataclass(frozen=True)
class StribeckLaw(FrictionLaw):
    """Stribeck's curve: f = kinetic + (static − kinetic) exp(−(u/speed)^exponent) + viscous u.

    Parameters
    ----------
    static, kinetic : f at slip zero, and far above ``speed``, both ≥ 0
    speed : m/s, > 0
    exponent : 1 (Tustin) or 2 (Gauss), any from 0.5 to 8
    viscous : s/m, ≥ 0

    Examples
    --------
    >>> StribeckLaw(0.3, 0.1, speed=0.2)([0.0, 0.2, 2.0]).round(6).tolist()
    [0.3, 0.173576, 0.100009]
    """

    static: float = of("number", low=0.0, doc="f at slip zero", acts="")
    kinetic: float = of("number", low=0.0, doc="f far above 'speed'", acts="")
    speed: float = of("number", unit="m/s", low=0.0, above=True, doc="of the change", acts="")
    exponent: float = of(
        "number", 1.0, low=_LEAST_EXPONENT, high=_LARGEST_EXPONENT, doc="1: Tustin, 2: Gauss",
        acts="",
    )  # fmt: skip
    viscous: float = of("number", 0.0, "s/m", low=0.0, doc="f grows by it with the speed", acts="")
    kind: str = _kind("stribeck")

    source: ClassVar[str] = "Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica 30(7)"

    def formula(self, u: FloatArray) -> FloatArray:
        """F at speeds in m/s."""
        with np.errstate(over="ignore", under="ignore"):
            fall = np.exp(-((u / self.speed) ** self.exponent))
        return self.kinetic + (self.static - self.kinetic) * fall + self.viscous * u

    @property
    def scales(self) -> tuple[float, ...]:
        """The speed of the change."""
        return (self.speed,)

    @property
    def root(self) -> float | None:
        """The exponent, where it is no whole number."""
        whole = float(self.exponent).is_integer() or self.static == self.kinetic
        return None if whole else self.exponent


@dataclass(frozen=True)
class CurlingLaw(FrictionLaw):
    """The law of simulators of curling: f = a/(u + b) + c.

    Parameters
    ----------
    a : m/s, ≥ 0
    b : m/s, > 0
    c : ≥ 0

    Examples
    --------
    >>> CurlingLaw(0.002, 0.064, 0.006)([0.0, 2.0]).round(6).tolist()
    [0.03725, 0.006969]
    """

    a: float = of("number", unit="m/s", low=0.0, doc="f = a/(u + b) + c", acts="")
    b: float = of("number", unit="m/s", low=0.0, above=True, doc="f at rest is a/b + c", acts="")
    c: float = of("number", 0.0, low=0.0, doc="f at great speed", acts="")
    kind: str = _kind("curling")

    source: ClassVar[str] = "the simulator FCV1 of Digital Curling"

    def formula(self, u: FloatArray) -> FloatArray:
        """F at speeds in m/s."""
        return np.asarray(self.a / (u + self.b) + self.c)

    @property
    def scales(self) -> tuple[float, ...]:
        """The offset of the speed."""
        return (self.b,)


@dataclass(frozen=True)
class PowerLaw(FrictionLaw):
    """A power of the slip speed: f = a (u + b)^exponent, speeds in m/s.

    f at rest is a b^exponent.  Without an offset ``b`` it would have no bound there (exponent < 0)
    or a root that no stop comes through in good order (other exponents than 0, 1, 2 …): both are
    refused, give b.  Ice is fitted with an exponent of −½.

    Parameters
    ----------
    a : f at u + b = 1 m/s, ≥ 0
    exponent : −8 to 8
    b : m/s, ≥ 0

    Examples
    --------
    >>> PowerLaw(0.008, -0.5, b=0.01)([0.0, 0.99]).round(6).tolist()
    [0.08, 0.008]
    """

    a: float = of("number", low=0.0, doc="f at u + b = 1 m/s", acts="")
    exponent: float = of("number", low=-_LARGEST_EXPONENT, high=_LARGEST_EXPONENT, acts="")
    b: float = of("number", 0.0, "m/s", low=0.0, doc="f at rest is a b^exponent", acts="")
    kind: str = _kind("power")

    source: ClassVar[str] = "Leaney 2020, GeoConvention: curling stones, exponent -1/2"

    def formula(self, u: FloatArray) -> FloatArray:
        """F at speeds in m/s."""
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.asarray(self.a * (u + self.b) ** self.exponent)

    @property
    def scales(self) -> tuple[float, ...]:
        """The offset of the speed."""
        return (self.b,) if self.b > 0.0 else ()

    def faults(self) -> list[str]:
        """Whether there is an f at rest."""
        if self.b == 0.0 and not (self.exponent >= 0.0 and float(self.exponent).is_integer()):
            what = "no bound" if self.exponent < 0.0 else "a root"
            return [
                f"exponent = {self.exponent:g} with b = 0: f has {what} at slip zero; give b > 0 "
                "m/s, the speed below which it levels off"
            ]
        if not np.isfinite(self.formula(np.zeros(1))).all():
            return [f"b = {self.b:g} m/s: f has no bound at slip zero, give a larger b"]
        return []


NAMED: dict[str, type[FrictionLaw]] = {
    "curling": CurlingLaw, "power": PowerLaw, "stribeck": StribeckLaw,
}  # fmt: skip


def law_of_numbers(kind: str, numbers: list[float]) -> FrictionLaw:
    """A law by its name and its numbers in their order, as a file has them.

    Raises InputError if it is none.

    >>> law_of_numbers("power", [0.1, 1.0, 0.0])
    PowerLaw(a=0.1, exponent=1.0, b=0.0, kind='power')
    """
    law: Any = NAMED.get(kind)
    if law is None or len(numbers) != len(specs(law)) - 1:
        raise InputError(f"{kind!r} with {len(numbers)} numbers is no friction law")
    made: FrictionLaw = law(*numbers)
    return made.checked()


def pieces_of_function(
    law: Callable[[FloatArray], FloatArray], speeds: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Ends (k + 1,) and polynomials (k, 18) of a smooth law between speeds, good to rounding.

    A row is the origin o and the scale s of a piece and then the powers of t = (u − o) s.

    ``law``: callable, f at speeds in m/s; ``speeds``: array, m/s, ascending from 0 to the top;
    where the law has a scale of its own pieces end.

    >>> ends, pieces = pieces_of_function(np.exp, np.array([0.0, 1.0]))
    >>> t = (0.3 - pieces[0, 0]) * pieces[0, 1]
    >>> float(np.polynomial.polynomial.polyval(t, pieces[0, 2:]) - np.exp(0.3)) < 1e-15
    True
    """
    waiting = [(float(a), float(b)) for a, b in pairwise(speeds)][::-1]
    largest = float(np.abs(law(np.concatenate([speeds, np.linspace(0.0, speeds[-1], 99)]))).max())
    ends, rows = [0.0], []
    while waiting:
        low, high = waiting.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        series = np.polynomial.chebyshev.chebfit(_NODES, law(middle + half * _NODES), _DEGREE)
        powers = np.polynomial.chebyshev.cheb2poly(series)
        powers = np.pad(powers, (0, _DEGREE + 1 - len(powers)))
        missed = np.polynomial.polynomial.polyval(_PROBES, powers) - law(middle + half * _PROBES)
        shortest = max(_SHORTEST * speeds[-1], _NARROWEST * middle)
        if np.abs(missed).max() > _ROUNDING * largest and half > shortest:
            waiting += [(middle, high), (low, middle)]
            continue
        ends.append(high)
        rows.append([middle, 1.0 / half, *powers])
    return np.array(ends), np.array(rows)
