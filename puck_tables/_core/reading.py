"""From plain values (TOML) or dataclasses to checked dataclasses, with every error at once."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass, field
from numbers import Real
from typing import Any, TypeVar

import numpy as np

from puck_tables._core.arrays import FloatArray, shown
from puck_tables._core.colours import COLOURS, is_colour
from puck_tables._core.doubts import question
from puck_tables._core.fields import LISTED, Kind, Unsaid, in_tables, specs
from puck_tables._core.units import SHOWN, UNIT_EACH, measured, quantity, unit_meant, without_unit
from puck_tables._core.wording import meant
from puck_tables.errors import PuckError

T = TypeVar("T")

RANGE = re.compile(r"([^:]+):([^:]+):([0-9]{1,9})")
MAX_COUNT = 1_000_000  # numbers of one range


@dataclass(frozen=True)
class Range:
    """START:STOP:COUNT or a list; its numbers are made when all ranges have been counted."""

    start: float
    stop: float
    count: int
    listed: tuple[float, ...] = ()

    def numbers(self) -> FloatArray:
        """The numbers, ends included, array (count,)."""
        return np.array(self.listed or np.linspace(self.start, self.stop, self.count))


@dataclass
class Reading:
    """What a walk gathers: errors, ranges by path, and pairs of which many were given, by path.

    ``ranges`` None: a number is one number.
    """

    errors: list[str]
    ranges: dict[str, Range] | None
    batches: dict[str, FloatArray] = field(default_factory=dict)

    def fault(self, path: str, value: Any, allowed: str) -> None:
        """Note an error."""
        self.errors.append(f"{path} = {_shown(value)}: must be {allowed}")


def _shown(value: Any) -> str:
    return "a table" if isinstance(value, Mapping) else shown(value)


def read_part(
    kind: type[T], data: Any, path: str, reading: Reading, made: type[T] | None = None
) -> T | None:
    """A dataclass from a table, or from an unchecked one; None if something in it is wrong.

    ``made``: what is made of the fields of ``kind``, which it has too.
    """
    if isinstance(data, kind):
        entered = entries_in(data, specs(made or kind))
        if (
            isinstance(data, made or kind)
            and "_checked" in vars(data)
            and entered.keys() <= (specs(kind).keys())
        ):
            return data
        data = entered
    if not isinstance(data, Mapping):
        one = ("an " if kind.__name__[0] in "AEIO" else "a ") + kind.__name__
        reading.fault(path or kind.__name__.lower(), data, f"a table or {one}")
        return None
    values = read_values(kind, data, path, reading)
    if values is None:
        return None
    try:
        part = (made or kind)(**values)
    except PuckError as error:  # one that judges itself; of a range one end may do
        last = {
            name: (reading.ranges or {})[f"{path}.{name}"].stop
            for name in values
            if f"{path}.{name}" in (reading.ranges or {})
        }
        try:
            if not last:
                raise
            part = (made or kind)(**{**values, **last})
        except PuckError:
            reading.errors.append(f"{path}: {error}")
            return None
    mark_checked(part)
    return part


def mark_checked(part: Any) -> None:
    """Note that a frozen dataclass holds what :func:`read_values` found, which stays so."""
    object.__setattr__(part, "_checked", True)


def entries_in(part: Any, names: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The values of a dataclass by their names in tables; what is left at its default is left out.

    Fields that are not among ``names``, if these are given, are told of whatever they hold.
    """
    return {
        name: value
        for name, spec in specs(type(part)).items()
        if (value := getattr(part, spec.name)) is not spec.default
        or (names is not None and name not in names)
    }


def written(value: Any) -> str:
    """A dataclass as a call that makes it again, its parts too; what is at its default is left out.

    >>> from puck_tables import Floor, Strips
    >>> written(Floor(slope=0.1, strips=Strips((0.5,), (0.3, 0.1))))
    'Floor(slope=0.1, strips=Strips(borders=(0.5,), friction=(0.3, 0.1)))'
    """
    if isinstance(value, tuple):
        parts = ", ".join(map(written, value))
        return f"({parts},)" if len(value) == 1 else f"({parts})"
    if not dataclasses.is_dataclass(value) or not (known := specs(type(value))):
        return repr(value)
    entries = (
        f"{known[name].name}={written(one)}" for name, one in entries_in(value).items()
        if not isinstance(one, Unsaid)
    )  # fmt: skip
    return f"{type(value).__name__}({', '.join(entries)})"


def read_values(
    kind: type, data: Mapping[str, Any], path: str, reading: Reading
) -> dict[str, Any] | None:
    """The values of a dataclass by field from a table; None if something in it is wrong."""
    names = specs(kind)
    prefix = f"{path}." if path else ""
    before = len(reading.errors)
    for name in data:
        if name not in names and name + LISTED not in names:
            near = ", ".join(dict.fromkeys(map(in_tables, names)))
            called = name[:60] if isinstance(name, str) and name.isprintable() else _shown(name)
            reading.errors.append(f"{prefix}{called}: no such entry (there are: {near})")
    values: dict[str, Any] = {}
    for name, spec in names.items():
        entries = _entry(data, name, names)
        if entries is not MISSING and not (entries is None and spec.default is None):
            values[spec.name] = _read(
                spec.metadata["kind"], entries, prefix + in_tables(name), reading, spec.default
            )
        elif spec.default is MISSING and spec.default_factory is MISSING:
            what: Kind = spec.metadata["kind"]
            needed = "a table" if what.shape == "part" else what.allowed()
            reading.errors.append(f"{prefix}{name} is missing: it must be {needed}")
    return values if len(reading.errors) == before else None


def _entry(data: Mapping[str, Any], name: str, names: Mapping[str, Any]) -> Any:
    """What stands under a name; a list where both a part and a list of parts have that name."""
    plain = in_tables(name)
    if name != plain and name not in data:
        entries = data.get(plain, MISSING)
        return entries if _items(entries) is not None else MISSING
    if name + LISTED in names and _items(data.get(name)) is not None:
        return MISSING
    return data.get(name, MISSING)


def _read(kind: Kind, value: Any, path: str, reading: Reading, default: Any) -> Any:
    if value is default or (kind.objects and isinstance(value, kind.objects)):
        return value
    if kind.shape == "part":
        return read_part(kind.part, value, path, reading, kind.made)
    if kind.shape in ("text", "choice") or (kind.shape == "rows" and isinstance(value, str)):
        good = isinstance(value, str) and kind.takes(value)
        if not good or (kind.choices and value not in kind.choices):
            reading.fault(path, value, kind.allowed())
        return str(value) if good else value  # a text of NumPy is one, too, and files hold none
    if kind.shape == "colour":
        if not isinstance(value, str) or (value and not is_colour(value)):
            hint = meant(value.lower(), COLOURS, 0.7) if isinstance(value, str) else ""
            reading.fault(path, value, kind.allowed() + hint)
        return value
    if kind.kinds and isinstance(value, (Mapping, *kind.kinds.values())):
        return _named(kind, value, path, reading)
    if kind.shape == "rows" or (kind.kinds and kind.shape == "number" and _is_table(value)):
        return _rows(kind, value, path, reading)
    if kind.shape == "number":
        return _number(kind, value, path, reading, default)
    items = _items(value)
    if kind.shape == "parts":
        if items is None:
            reading.fault(path, value, f"a list of tables, [[{path}]], or of {kind.part.__name__}")
            return ()
        return tuple(
            read_part(kind.part, item, f"{path}[{i}]", reading) for i, item in enumerate(items)
        )
    many = _pairs(value) if kind.batch and reading.ranges is not None else None
    if many is not None and np.isfinite(many).all():
        reading.batches[path] = many
        return (float(many[0, 0]), float(many[0, 1]))
    both = (
        kind.shape == "pair" and items is not None and all(_items(one) is not None for one in items)
    )
    if both and reading.ranges is not None:
        what = "or rows of two" if kind.batch else "not rows of them"
        reading.fault(path, value, f"{kind.allowed()}, {what} (a range is 'START:STOP:COUNT')")
        return (0.0, 0.0)
    count = 2 if kind.shape == "pair" else None
    if items is None or (count is not None and len(items) != count):
        several = " (or many of them, one for each launch)" if kind.batch else ""
        reading.fault(path, value, kind.allowed() + several)
        return (0.0, 0.0)
    _refuse_bare(kind, items, path, reading)
    one = dataclasses.replace(kind, shape="number")
    return tuple(_read(one, item, f"{path}[{i}]", reading, MISSING) for i, item in enumerate(items))


def _is_table(value: Any) -> bool:
    """Whether it is rows of numbers, or makes them."""
    if hasattr(value, "as_rows") or (isinstance(value, np.ndarray) and value.ndim == 2):
        return True
    items = _items(value)
    return bool(items) and all(_items(one) is not None for one in items or ())


def _refuse_bare(kind: Kind, items: Iterable[Any], path: str, reading: Reading) -> None:
    """Note numbers without a unit beside those that have one."""
    parts = [part for one in items for part in (_bounds(one) if isinstance(one, str) else [one])]
    if any(isinstance(one, str) for one in parts) and (bare := without_unit(parts, kind.unit)):
        reading.errors.append(f"{path}: {UNIT_EACH.format(bare)}")


def _bounds(text: str) -> list[str]:
    """A number, or the ends of a range."""
    match = RANGE.fullmatch(text.strip())
    return [text] if match is None else [match[1], match[2]]


def _named(kind: Kind, value: Any, path: str, reading: Reading) -> Any:
    """One of several dataclasses, itself or a table that says which by its ``kind``."""
    if not isinstance(value, Mapping):
        return read_part(type(value), value, path, reading)
    name = value.get("kind")
    if isinstance(name, str) and name in kind.kinds:
        return read_part(kind.kinds[name], value, path, reading)
    hint = meant(str(name).lower(), kind.kinds)
    reading.fault(f"{path}.kind", name, f"one of {', '.join(kind.kinds)}{hint}")
    return None


def _rows(kind: Kind, value: Any, path: str, reading: Reading) -> tuple[tuple[float, ...], ...]:
    """A table of numbers, as it may stand in a CSV file, or what can be one: a law with points."""
    try:
        entries = value.as_rows() if hasattr(value, "as_rows") else value
        rows = np.array(entries, dtype=np.float64)
    except PuckError as error:
        reading.errors.append(f"{path}: {error}")
        return ()
    except (TypeError, ValueError, OverflowError):
        rows = np.empty(0)
    if np.ma.is_masked(value) or rows.ndim != 2 or not rows.size or not np.isfinite(rows).all():
        reading.fault(path, value, kind.allowed())
        return ()
    return tuple(map(tuple, rows.tolist()))


def _pairs(value: Any) -> FloatArray | None:
    """Many pairs of numbers, array (n, 2), where a value is no single one."""
    items = list(value) if isinstance(value, np.ndarray) and value.ndim == 2 else _items(value)
    if not items or not all(isinstance(item, list | tuple | np.ndarray) for item in items):
        return None
    try:
        pairs = np.array(items)
    except ValueError:  # of different lengths: ranges
        return None
    fits = pairs.shape == (len(items), 2) and pairs.dtype.kind in "iuf"
    return pairs.astype(np.float64) if fits and not np.ma.is_masked(value) else None


def _items(value: Any) -> list[Any] | None:
    """What stands in a list, a tuple or an array of one dimension."""
    if isinstance(value, np.ndarray):
        return list(value) if value.ndim == 1 else None
    return list(value) if isinstance(value, list | tuple) else None


def _number(kind: Kind, value: Any, path: str, reading: Reading, default: Any) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0 and not np.ma.is_masked(value):
        value = value[()]
    if reading.ranges is not None and (items := _items(value)) is not None:
        return _listed(kind, items, path, reading)
    if isinstance(value, str) and kind.law is not None and not RANGE.fullmatch(value.strip()):
        try:
            kind.law(value)
        except PuckError as error:
            reading.errors.append(f"{path}: {error}")
        return value  # type: ignore[return-value]  # a law in place of a number
    said = isinstance(value, str) and (in_unit := quantity(value, kind.unit)) is not None
    if said:
        value = in_unit
    if isinstance(value, str) and reading.ranges is not None:
        match = RANGE.fullmatch(value.strip())
        _refuse_bare(kind, [value], path, reading)
        try:
            start, stop = (measured(match[n], kind.unit) for n in (1, 2))  # type: ignore[index]
            count = int(match[3])  # type: ignore[index]
        except (TypeError, ValueError):
            reading.fault(
                path, value, f"{_one(kind, value)}, or a range 'START:STOP:COUNT' of them"
            )
            return math.nan
        if not 2 <= count <= MAX_COUNT:
            reading.fault(path, value, f"a range of 2 to {MAX_COUNT} numbers")
        elif not (kind.holds(start) and kind.holds(stop) and math.isfinite(stop - start)):
            reading.fault(path, value, f"a range within: {_one(kind)}")
        else:
            reading.ranges[path] = Range(start, stop, count)
            if quantity(match[2], kind.unit) is None:  # type: ignore[index]
                question(path, max(start, stop, key=abs), kind.unit, kind.usual)
        return start
    if type(value) not in (float, int) and (
        isinstance(value, bool | np.timedelta64) or not isinstance(value, Real)
    ):
        reading.fault(path, value, _one(kind, value))
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
    elif number != default and not said:
        question(path, number, kind.unit, kind.usual)
    return number


def _listed(kind: Kind, items: list[Any], path: str, reading: Reading) -> float:
    """A range as a list; the first of its numbers."""
    alone, kind = Reading(reading.errors, None), dataclasses.replace(kind, law=None, objects=())
    if not 1 <= len(items) <= MAX_COUNT:
        reading.fault(path, items, f"{_one(kind)}, or a list of 1 to {MAX_COUNT} of them")
        return math.nan
    before = len(reading.errors)
    _refuse_bare(kind, items, path, reading)
    numbers = [_number(kind, n, f"{path}[{i}]", alone, None) for i, n in enumerate(items)]
    if reading.ranges is not None and len(reading.errors) == before:
        reading.ranges[path] = Range(numbers[0], numbers[-1], len(numbers), tuple(numbers))
    return numbers[0]


def _one(kind: Kind, value: Any = None) -> str:
    """A number that is allowed, in words; to who wrote a text, how units are written."""
    words = dataclasses.replace(kind, shape="number").allowed()
    if not (isinstance(value, str) and kind.unit in SHOWN):
        return words
    why = unit_meant(value[:40])
    return f"{words}, or with its unit, as '{SHOWN[kind.unit]}'{f' ({why})' if why else ''}"
