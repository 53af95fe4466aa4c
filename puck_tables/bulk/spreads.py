"""Numbers that scatter: what they are drawn from, the same bits for any cutting of the work.

A sample is drawn from its number: the generator is Philox, whose counter can be set (Salmon et al.
2011), and one uniform number makes one of the spread, by the inverse of its distribution.
"""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import real, shown
from puck_tables._core.units import SHOWN, UNIT_EACH, measured, without_unit
from puck_tables.errors import InputError

_LARGEST_SEED = 1 << 64  # a seed is kept in files as an integer of 64 bits
_AT_ONCE = 4  # numbers a step of the counter gives


class Spread(ABC):
    """A distribution of a number."""

    @abstractmethod
    def of(self, uniform: FloatArray) -> FloatArray:
        """Its values at which the distribution function has these, inside (0, 1)."""

    def drawn(self, name: str, seed: int, start: int, stop: int) -> FloatArray:
        """The numbers of some samples.

        Parameters
        ----------
        name : what scatters; each name has a stream of its own
        seed, start, stop : of the samples

        Examples
        --------
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
    mean, deviation : in the unit of the number; the standard deviation > 0

    Raises
    ------
    InputError

    Examples
    --------
    >>> Normal(5.0, 0.2).of(np.array([0.5])).tolist()
    [5.0]
    """

    mean: float
    deviation: float

    def __post_init__(self) -> None:
        mean = real("the mean of a normal spread", self.mean, "in the unit of the number")
        deviation = real("the deviation of a normal spread", self.deviation, "the same unit")
        if not deviation > 0.0:
            raise InputError(
                f"the deviation of a normal spread must be greater than 0, got {deviation:g}: "
                "give the number alone to hold it fixed"
            )
        object.__setattr__(self, "mean", mean)
        object.__setattr__(self, "deviation", deviation)

    def of(self, uniform: FloatArray) -> FloatArray:
        """Its quantiles."""
        from scipy.special import ndtri

        values: FloatArray = self.mean + self.deviation * ndtri(uniform)
        return values

    def __str__(self) -> str:
        return f"normal:{self.mean!r}:{self.deviation!r}"


@dataclass(frozen=True)
class Uniform(Spread):
    """A number that is equally likely anywhere between two ends.

    Parameters
    ----------
    low, high : in the unit of the number, low < high

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
        low = real("the low end of a uniform spread", self.low, "in the unit of the number")
        high = real("the high end of a uniform spread", self.high, "the same unit")
        if not (high > low and high - low < float("inf")):
            raise InputError(
                f"a uniform spread must go from a lower to a higher end, got {low:g} to {high:g}: "
                "give the number alone to hold it fixed"
            )
        object.__setattr__(self, "low", low)
        object.__setattr__(self, "high", high)

    def of(self, uniform: FloatArray) -> FloatArray:
        """Its quantiles."""
        return self.low + (self.high - self.low) * uniform

    def __str__(self) -> str:
        return f"uniform:{self.low!r}:{self.high!r}"


KINDS = {"normal": Normal, "uniform": Uniform}


def spread_named(text: str, unit: str = "") -> Spread:
    """The spread that a text such as 'normal:5:0.2' names.

    ``unit``: the SI unit of what scatters; another may stand behind each number.

    Raises
    ------
    InputError

    Examples
    --------
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
    return result


def checked_samples(count: int, seed: int) -> None:
    """Refuse a number of samples, or a seed, that is none.

    Raises
    ------
    InputError

    Examples
    --------
    >>> checked_samples(1000, 7)
    """
    _checked_whole("samples", count, 2, 10**9)
    checked_seed(seed)


def checked_seed(seed: int) -> None:
    """Refuse a seed that is none.

    Raises
    ------
    InputError

    Examples
    --------
    >>> checked_seed(7)
    """
    _checked_whole("seed", seed, 0, _LARGEST_SEED - 1)


def _checked_whole(name: str, value: int, low: int, high: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise InputError(f"{name} must be a whole number from {low} to {high}, got {shown(value)}")
