"""From plain values (TOML) or dataclasses to checked dataclasses, with every error at once.

What a field allows stands in its metadata, beside its name and its default; one walk over the
dataclasses checks a whole scene, wherever it comes from.
"""

from __future__ import annotations

import dataclasses
import math
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field
from functools import lru_cache
from numbers import Real
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
T = TypeVar("T")

RANGE = re.compile(r"([^:]+):([^:]+):([0-9]{1,9})")
DEGREES = re.compile(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?) ?deg")
MAX_COUNT = 1_000_000  # numbers of one range
_SHOWN = 60  # characters of a value in a message


@dataclass(frozen=True)
class Kind:
    """What a field takes: ``shape`` number, pair, numbers, text, choice, part, parts."""

    shape: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    above: bool = False  # greater than ``low``, not equal to it
    below: bool = False
    choices: tuple[str, ...] = ()
    part: Any = None
    file: str | None = None  # a text that names a file where it ends so

    def allowed(self) -> str:
        """What is allowed, in words.

        Examples
        --------
        >>> Kind("number", "m", 0.0, above=True).allowed()
        'a number > 0 m'
        """
        if self.shape == "text":
            return "a text without " + ("control characters" if self.file is None else "NUL")
        if self.shape == "choice":
            return "one of " + ", ".join(self.choices)
        words = {"number": "a number", "pair": "two numbers [x, y]", "numbers": "a list of numbers"}
        unit = f" {self.unit}" if self.unit else ""
        low = f"{'>' if self.above else '>='} {self.low:g}"
        high = f"{'<' if self.below else '<='} {self.high:g}"
        if self.low > -math.inf and self.high < math.inf:
            return f"{words[self.shape]} {low} and {high}{unit}"
        if self.low > -math.inf:
            return f"{words[self.shape]} {low}{unit}"
        if self.high < math.inf:
            return f"{words[self.shape]} {high}{unit}"
        return f"{words[self.shape]}{f' in{unit}' if unit else ''}"

    def holds(self, value: float) -> bool:
        """Whether a number is allowed."""
        above = value > self.low if self.above else value >= self.low
        below = value < self.high if self.below else value <= self.high
        return above and below and not math.isnan(value)

    def takes(self, text: str) -> bool:
        """Whether a text holds no control codes and halves of pairs; a name of a file no NUL."""
        if self.file is not None:
            return "\0" not in text
        return text.isprintable() or not any(
            unicodedata.category(sign) in ("Cc", "Cs") for sign in text
        )

    def names_file(self, text: str) -> bool:
        """Whether a text is the name of a file.

        Examples
        --------
        >>> Kind("text", file=".csv").names_file("rough.CSV"), Kind("text", file="").names_file("")
        (True, False)
        """
        return self.file is not None and bool(text) and text.lower().endswith(self.file)


def of(shape: str, default: Any = MISSING, unit: str = "", doc: str = "", **limits: Any) -> Any:
    """A dataclass field with what it allows."""
    metadata = {"kind": Kind(shape, unit, **limits), "doc": doc}
    if isinstance(default, list | dict):
        return field(default_factory=lambda: type(default)(default), metadata=metadata)
    return (
        field(metadata=metadata)
        if default is MISSING
        else field(default=default, metadata=metadata)
    )


@dataclass(frozen=True)
class Range:
    """START:STOP:COUNT; its numbers are made when all ranges of a scene have been counted."""

    start: float
    stop: float
    count: int

    def numbers(self) -> FloatArray:
        """The numbers, ends included, array (count,)."""
        return np.linspace(self.start, self.stop, self.count)


@dataclass
class Reading:
    """What a walk gathers: errors, and the numbers that were given as ranges."""

    errors: list[str]
    ranges: dict[str, Range]

    def fault(self, path: str, value: Any, allowed: str) -> None:
        """Note an error."""
        self.errors.append(f"{path} = {_shown(value)}: must be {allowed}")


def _shown(value: Any) -> str:
    """A value in a message, however large, deep or odd it is."""
    if isinstance(value, Mapping):
        return "a table"
    plain = value.item() if isinstance(value, np.generic) else value
    try:
        shown = repr(plain)
    except (ValueError, RecursionError):  # integers of thousands of digits, lists without end
        shown = "a whole number of thousands of digits" if isinstance(value, int) else "a list"
    return shown if len(shown) <= _SHOWN else shown[: _SHOWN - 3] + "..."


@lru_cache(maxsize=64)
def _specs(kind: type) -> dict[str, dataclasses.Field[Any]]:
    return {spec.name: spec for spec in dataclasses.fields(kind)}


def read_part(kind: type[T], data: Any, path: str, reading: Reading) -> T | None:
    """A dataclass from a table, or from an unchecked one; None if something in it is wrong."""
    this: Any = kind
    known = _specs(this)
    if isinstance(data, kind):
        theirs: Any = type(data)
        data = {  # what is left at its default needs no check
            name: getattr(data, name)
            for name, spec in _specs(theirs).items()
            if name not in known or getattr(data, name) is not spec.default
        }
    if not isinstance(data, Mapping):
        wrong = f"a table or a {kind.__name__}" if dataclasses.is_dataclass(data) else "a table"
        reading.fault(path or kind.__name__.lower(), data, wrong)
        return None
    prefix = f"{path}." if path else ""
    for name in data:
        if name not in known:
            near = ", ".join(known)
            shown = name if isinstance(name, str) and name.isprintable() else _shown(name)
            reading.errors.append(f"{prefix}{shown[:_SHOWN]}: no such entry (there are: {near})")
    before = len(reading.errors)
    values: dict[str, Any] = {}
    for name, spec in known.items():
        if name in data and not (data[name] is None and spec.default is None):
            values[name] = _read(
                spec.metadata["kind"], data[name], prefix + name, reading, spec.default
            )
        elif spec.default is MISSING and spec.default_factory is MISSING:
            what: Kind = spec.metadata["kind"]
            needed = "a table" if what.shape == "part" else what.allowed()
            reading.errors.append(f"{prefix}{name} is missing: it must be {needed}")
    return kind(**values) if len(reading.errors) == before else None


def _read(kind: Kind, value: Any, path: str, reading: Reading, default: Any) -> Any:
    if kind.shape == "part":
        return read_part(kind.part, value, path, reading)
    if kind.shape in ("text", "choice"):
        good = isinstance(value, str) and kind.takes(value)
        if not good or (kind.choices and value not in kind.choices):
            reading.fault(path, value, kind.allowed())
        return value
    if kind.shape == "number":
        return _number(kind, value, path, reading, default)
    items = _items(value)
    if kind.shape == "parts":
        if items is None:
            reading.fault(path, value, f"a list of tables, [[{path}]]")
            return ()
        return tuple(
            read_part(kind.part, item, f"{path}[{i}]", reading) for i, item in enumerate(items)
        )
    count = 2 if kind.shape == "pair" else None
    if items is None or (count is not None and len(items) != count):
        reading.fault(path, value, kind.allowed())
        return (0.0, 0.0)
    return tuple(_number(kind, item, f"{path}[{i}]", reading, None) for i, item in enumerate(items))


def _items(value: Any) -> list[Any] | None:
    """What stands in a list, a tuple or an array of one dimension."""
    if isinstance(value, np.ndarray):
        return list(value) if value.ndim == 1 else None
    return list(value) if isinstance(value, list | tuple) else None


def _number(kind: Kind, value: Any, path: str, reading: Reading, default: Any) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0 and not np.ma.is_masked(value):
        value = value[()]
    if isinstance(value, str) and kind.unit == "rad" and DEGREES.fullmatch(value.strip()):
        value = _angle(value.strip(), kind)
    if isinstance(value, str):
        match = RANGE.fullmatch(value.strip())
        try:
            start, stop = (_angle(match[n], kind) for n in (1, 2))  # type: ignore[index]
            count = int(match[3])  # type: ignore[index]
        except (TypeError, ValueError):
            reading.fault(path, value, f"{_one(kind)}, or a range 'START:STOP:COUNT' of them")
            return math.nan
        if not 2 <= count <= MAX_COUNT:
            reading.fault(path, value, f"a range of 2 to {MAX_COUNT} numbers")
        elif not (kind.holds(start) and kind.holds(stop) and math.isfinite(stop - start)):
            reading.fault(path, value, f"a range within: {_one(kind)}")
        else:
            reading.ranges[path] = Range(start, stop, count)
        return start
    if type(value) not in (float, int) and (
        isinstance(value, bool | np.timedelta64) or not isinstance(value, Real)
    ):
        reading.fault(path, value, _one(kind))
        return math.nan
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if number != default and not (kind.holds(number) and math.isfinite(number)):
        allowed = _one(kind)
        if kind.unit == "rad" and kind.holds(math.radians(number)):
            allowed += f" (if degrees are meant write '{number:g}deg')"
        reading.fault(path, value, allowed)
    return number


def _angle(text: str, kind: Kind) -> float:
    """A number; an angle may be in degrees.

    Examples
    --------
    >>> _angle("180deg", Kind("number", "rad")), _angle("2", Kind("number", "m"))
    (3.141592653589793, 2.0)
    """
    degrees = kind.unit == "rad" and DEGREES.fullmatch(text.strip())
    return math.radians(float(degrees[1])) if degrees else float(text)


def _one(kind: Kind) -> str:
    return dataclasses.replace(kind, shape="number").allowed()


def described(kind: type, prefix: str = "") -> list[tuple[str, str, str]]:
    """Every entry of a dataclass and its parts: path, what is allowed and its default, what it is.

    Examples
    --------
    >>> @dataclass(frozen=True)
    ... class Body:
    ...     mass: float = of("number", 1.0, "kg", low=0.0, above=True, doc="all of it")
    >>> described(Body)
    [('mass', 'a number > 0 kg  [1]', 'all of it')]
    """
    rows = []
    for spec in dataclasses.fields(kind):
        what: Kind = spec.metadata["kind"]
        path = prefix + spec.name
        if what.shape in ("part", "parts"):
            rows += described(what.part, f"{path}[0]." if what.shape == "parts" else f"{path}.")
            continue
        default = ""
        if spec.default is MISSING:
            default = "  (needed)"
        elif spec.default not in (None, ""):
            value = spec.default
            numbers = value if isinstance(value, tuple) else (value,)
            shown = ", ".join(f"{n:g}" if isinstance(n, float) else str(n) for n in numbers)
            default = f"  [{shown}]"
        rows.append((path, what.allowed() + default, spec.metadata["doc"]))
    return rows
