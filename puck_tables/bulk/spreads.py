"""Numbers that scatter: what they are drawn from, the same bits for any cutting of the work.

A sample is drawn from its number: the generator is Philox, whose counter can be set (Salmon et al.
2011), and one uniform number makes one of the spread, by the inverse of its distribution.
"""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, real, shown, whole
from puck_tables._core.doubts import question_spread
from puck_tables._core.units import (
    KIND_OF,
    SHOWN,
    UNIT_EACH,
    measured,
    measured_kinds,
    quantity,
    unit_meant,
    without_unit,
)
from puck_tables.errors import InputError

_LARGEST_SEED = 1 << 64  # a seed is kept in files as an integer of 64 bits
_AT_ONCE = 4  # numbers a step of the counter gives


class Spread(ABC):
    """A distribution of a number."""

    unit: ClassVar[str] = ""  # of SI, if its numbers were written with one

    def checked_for(self, name: str, unit: str) -> None:
        """Refuse it for a number of another unit; say so if it is of a doubtful size.

        >>> Normal("40mm", "1mm").checked_for("spin", "rad/s")
        Traceback (most recent call last):
        ...
        puck_tables.errors.InputError: spin is in rad/s: its spread is in m
        """
        if self.unit and self.unit != unit:
            raise InputError(f"{name} is in {unit or '1'}: its spread is in {self.unit}")
        if not self.unit:
            question_spread(name, *self._widths, unit)

    @property
    @abstractmethod
    def _widths(self) -> tuple[float, float]:
        """Its standard deviation, or its width; the other 0."""

    def _read(self, **names: str) -> None:
        """Its two numbers, by what they are called; the unit is noted if they have one."""
        values = tuple(getattr(self, one) for one in names)
        if any(isinstance(one, str) for one in values):
            kinds = [measured_kinds(one) if isinstance(one, str) else {} for one in values]
            for name, one, kind in zip(names.values(), values, kinds, strict=True):
                if kind or (not isinstance(one, str) and real(f"the {name}", one, "") == 0.0):
                    continue
                why = unit_meant(str(one)[:40]) or "give both a unit, as '25mm', or neither"
                raise InputError(f"{type(self).__name__}: {shown(one)} has no known unit: {why}")
            both = [unit for unit in KIND_OF if all(not kind or unit in kind for kind in kinds)]
            if len(both) != 1:
                what = f"may be in {' or '.join(both)}" if both else "are of two kinds"
                raise InputError(f"{values[0]!r} and {values[1]!r} {what}: write SI units")
            object.__setattr__(self, "unit", both[0])
            values = tuple(kind.get(both[0], 0.0) for kind in kinds)
        for (own, name), one in zip(names.items(), values, strict=True):
            object.__setattr__(self, own, real(f"the {name}", one, "in the unit of the number"))

    @abstractmethod
    def of(self, uniform: FloatArray) -> FloatArray:
        """Its values at which the distribution function has these, inside (0, 1)."""

    def drawn(self, name: str, seed: int, start: int, stop: int) -> FloatArray:
        """The numbers of some samples; each name has a stream of its own.

        >>> spin = Normal(5.0, 0.2)
        >>> bool((spin.drawn("spin", 7, 0, 9)[3:5] == spin.drawn("spin", 7, 3, 5)).all())
        True
        """
        stream = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little")
        generator = np.random.Philox(key=seed | stream << 64)
        skipped = start % _AT_ONCE
        generator.advance(start // _AT_ONCE)
        raw = generator.random_raw(stop - start + skipped)[skipped:]
        return self.of((np.right_shift(raw, np.uint64(11)) + 0.5) * 2.0**-53)


@dataclass(frozen=True)
class Normal(Spread):
    """A number that scatters normally.

    Parameters
    ----------
    mean, deviation : in SI units, or texts with their unit; the standard deviation > 0

    Raises
    ------
    InputError

    Examples
    --------
    >>> Normal(5.0, 0.2).of(np.array([0.5])).tolist()
    [5.0]
    >>> Normal("40mm", "1mm")
    Normal(mean=0.04, deviation=0.001)
    """

    mean: float
    deviation: float

    def __post_init__(self) -> None:
        self._read(mean="mean of a normal spread", deviation="deviation of a normal spread")
        if not self.deviation > 0.0:
            raise InputError(
                f"the deviation of a normal spread must be greater than 0, got {self.deviation:g}: "
                "give the number alone to hold it fixed"
            )

    def of(self, uniform: FloatArray) -> FloatArray:
        """Its quantiles."""
        from scipy.special import ndtri

        values: FloatArray = self.mean + self.deviation * ndtri(uniform)
        return values

    @property
    def _widths(self) -> tuple[float, float]:
        return self.deviation, 0.0

    def __str__(self) -> str:
        return f"normal:{self.mean!r}:{self.deviation!r}"


@dataclass(frozen=True)
class Uniform(Spread):
    """A number that is equally likely anywhere between two ends.

    Parameters
    ----------
    low, high : in SI units, or texts with their unit; low < high

    Raises
    ------
    InputError

    Examples
    --------
    >>> Uniform(0.9, 1.1).of(np.array([0.5])).round(9).tolist()
    [1.0]
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        self._read(low="low end of a uniform spread", high="high end of a uniform spread")
        if not 0.0 < self.high - self.low < float("inf"):
            raise InputError(
                f"a uniform spread must go from a lower to a higher end, got {self.low:g} to "
                f"{self.high:g}: give the number alone to hold it fixed"
            )

    def of(self, uniform: FloatArray) -> FloatArray:
        """Its quantiles."""
        return self.low + (self.high - self.low) * uniform

    @property
    def _widths(self) -> tuple[float, float]:
        return 0.0, self.high - self.low

    def __str__(self) -> str:
        return f"uniform:{self.low!r}:{self.high!r}"


KINDS = {"normal": Normal, "uniform": Uniform}


def spread_named(text: str, unit: str = "") -> Spread:
    """The spread that a text such as 'normal:5:0.2' names.

    ``unit``: the SI unit of what scatters; another may stand behind each number.

    Raises InputError.

    >>> spread_named("uniform:0.9:1.1"), spread_named("normal:30rpm:1rpm", "rad/s").mean > 3.14
    (Uniform(low=0.9, high=1.1), True)
    """
    name, *numbers = text.split(":")
    if bare := without_unit(numbers, unit):
        raise InputError(f"'{text}': {UNIT_EACH.format(bare)}")
    try:
        if name not in KINDS or len(numbers) != 2:
            raise ValueError
        first, second = (measured(number, unit) for number in numbers)
    except ValueError:
        hint = f", numbers or with a unit as {SHOWN[unit]}" if unit in SHOWN else ""
        raise InputError(
            f"'{text}' is no spread: write normal:MEAN:DEVIATION or uniform:LOW:HIGH{hint}"
        ) from None
    result: Spread = KINDS[name](first, second)
    if all(quantity(number, unit) is not None for number in numbers):
        object.__setattr__(result, "unit", unit)
    return result


def checked_samples(count: int, seed: int) -> tuple[int, int]:
    """A number of samples, and a seed.

    >>> checked_samples(1000, 7)
    (1000, 7)
    """
    return whole("samples", count, 2, 10**9), checked_seed(seed)


def checked_seed(seed: int) -> int:
    """A seed.

    >>> checked_seed(7)
    7
    """
    return whole("seed", seed, 0, _LARGEST_SEED - 1)
