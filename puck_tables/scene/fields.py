"""From plain values (TOML) to dataclasses, with every error at once.

What a field allows stands in its metadata, beside its name and its default; one walk over the
dataclasses checks a whole scene.
"""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import MISSING, dataclass, field
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
T = TypeVar("T")

RANGE = re.compile(r"([^:]+):([^:]+):([0-9]{1,9})")
MAX_COUNT = 1_000_000


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

    def allowed(self) -> str:
        """What is allowed, in words.

        Examples
        --------
        >>> Kind("number", "m", 0.0, above=True).allowed()
        'a number > 0 m'
        """
        if self.shape == "text":
            return "a text"
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


@dataclass
class Reading:
    """What a walk gathers: errors, and the numbers that were given as ranges."""

    errors: list[str]
    ranges: dict[str, FloatArray]

    def fault(self, path: str, value: Any, allowed: str) -> None:
        """Note an error."""
        shown = repr(value) if not isinstance(value, dict) else "a table"
        shown = shown if len(shown) <= 60 else shown[:57] + "..."
        self.errors.append(f"{path} = {shown}: must be {allowed}")


def read_part(kind: type[T], data: Any, path: str, reading: Reading) -> T | None:
    """A dataclass from a table; None if something in it is wrong."""
    if not isinstance(data, dict):
        reading.fault(path, data, "a table")
        return None
    known = {f.name: f for f in dataclasses.fields(kind)}  # type: ignore[arg-type]
    prefix = f"{path}." if path else ""
    for name in data:
        if name not in known:
            near = ", ".join(known)
            reading.errors.append(f"{prefix}{name}: no such entry (there are: {near})")
    before = len(reading.errors)
    values: dict[str, Any] = {}
    for name, spec in known.items():
        if name in data:
            values[name] = _read(spec.metadata["kind"], data[name], prefix + name, reading)
        elif spec.default is MISSING and spec.default_factory is MISSING:
            what: Kind = spec.metadata["kind"]
            needed = "a table" if what.shape == "part" else what.allowed()
            reading.errors.append(f"{prefix}{name} is missing: it must be {needed}")
    return kind(**values) if len(reading.errors) == before else None


def _read(kind: Kind, value: Any, path: str, reading: Reading) -> Any:
    if kind.shape == "part":
        return read_part(kind.part, value, path, reading)
    if kind.shape == "parts":
        if not isinstance(value, list):
            reading.fault(path, value, f"a list of tables, [[{path}]]")
            return ()
        return tuple(
            read_part(kind.part, item, f"{path}[{i}]", reading) for i, item in enumerate(value)
        )
    if kind.shape in ("text", "choice"):
        if not isinstance(value, str) or (kind.choices and value not in kind.choices):
            reading.fault(path, value, kind.allowed())
        return value
    if kind.shape == "number":
        return _number(kind, value, path, reading)
    count = 2 if kind.shape == "pair" else None
    if not isinstance(value, list) or (count is not None and len(value) != count):
        reading.fault(path, value, kind.allowed())
        return (0.0, 0.0)
    return tuple(_number(kind, item, f"{path}[{i}]", reading) for i, item in enumerate(value))


def _number(kind: Kind, value: Any, path: str, reading: Reading) -> float:
    if isinstance(value, str):
        match = RANGE.fullmatch(value.strip())
        try:
            start, stop = float(match[1]), float(match[2])  # type: ignore[index]
            count = int(match[3])  # type: ignore[index]
        except (TypeError, ValueError):
            reading.fault(path, value, f"{_one(kind)}, or a range 'START:STOP:COUNT' of them")
            return math.nan
        if not 2 <= count <= MAX_COUNT:
            reading.fault(path, value, f"a range of 2 to {MAX_COUNT} numbers")
        elif not (kind.holds(start) and kind.holds(stop) and math.isfinite(start + stop)):
            reading.fault(path, value, f"a range within: {_one(kind)}")
        else:
            reading.ranges[path] = np.linspace(start, stop, count)
        return start
    if isinstance(value, bool) or not isinstance(value, int | float):
        reading.fault(path, value, _one(kind))
        return math.nan
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not kind.holds(number) or not math.isfinite(number):
        reading.fault(path, value, _one(kind))
    return number


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
