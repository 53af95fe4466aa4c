"""What a field of a dataclass takes, beside its name and its default.

One walk over such dataclasses (:mod:`puck_tables._core.reading`) checks a puck or a whole scene,
and one lists what may stand in it.
"""

from __future__ import annotations

import dataclasses
import math
import unicodedata
from dataclasses import MISSING, dataclass, field
from functools import lru_cache
from typing import Any


class Unsaid(float):
    """A number that a part was not given but has: its default, or what the whole gave it.

    It stays so in copies and pickles; any sum of it is a plain number.

    >>> Unsaid(9.8) == 9.8, type(Unsaid(9.8) + 1.0)
    (True, <class 'float'>)
    """

    __slots__ = ()


class KeepsDefaults:
    """What holds no more in copies and pickles than it was given: the rest stays at its default."""

    def __getstate__(self) -> dict[str, Any]:
        """What is not the default itself, which is found at the class."""
        own = type(self)
        return {
            name: value for name, value in vars(self).items()
            if value is not getattr(own, name, MISSING)
        }  # fmt: skip


@dataclass(frozen=True)
class Kind:
    """What a field takes.

    ``shape``: number, pair, numbers, rows, text, choice, colour, part or parts.
    """

    shape: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    above: bool = False  # greater than ``low``, not equal to it
    below: bool = False
    usual: float = 0.0  # what is larger is questioned, see puck_tables._core.doubts
    choices: tuple[str, ...] = ()
    part: Any = None
    made: Any = None  # what is made of the entries of a part, if it is another class
    file: str | tuple[str, ...] | None = None  # a text that names a file where it ends so
    objects: tuple[type, ...] = ()  # taken as they are, in place of a text
    batch: bool = False  # a pair of which there may be many, one for each launch
    # name -> dataclass: a table whose 'kind' says which, in place of rows; of a number rows, too
    kinds: Any = None
    law: Any = None  # judges a text in place of a number; ``laws``: such texts, in words
    laws: str = ""

    def allowed(self) -> str:
        """What is allowed, in words.

        >>> Kind("number", "m", 0.0, above=True).allowed()
        'a number > 0 m'
        """
        if self.shape == "rows":
            named = f", or a table whose kind is {', '.join(self.kinds)}" if self.kinds else ""
            return f"the name of a CSV file, or a list of rows of numbers{named}"
        if self.shape == "text":
            return "a text without " + ("control characters" if self.file is None else "NUL")
        if self.shape == "colour":
            return "a colour, '#rrggbb' or a name of CSS such as 'steelblue'"
        if self.shape == "choice":
            return "one of " + ", ".join(self.choices)
        words = {"number": "a number", "pair": "two numbers [x, y]", "numbers": "a list of numbers"}
        if self.law is not None:
            plain = dataclasses.replace(self, law=None)
            return f"{plain.allowed()}, or {self.laws}"
        if self.kinds:
            plain = dataclasses.replace(self, kinds=None)
            named = f"rows of numbers, or a table whose kind is {', '.join(self.kinds)}"
            return f"{plain.allowed()}; in place of a number {named}"
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

    def names_file(self, text: Any) -> bool:
        """Whether a value is the name of a file.

        >>> Kind("text", file=".csv").names_file("rough.CSV"), Kind("text", file="").names_file("")
        (True, False)
        """
        named = self.file is not None and isinstance(text, str) and bool(text)
        return named and text.lower().endswith(self.file or "")


def of(
    shape: str, default: Any = MISSING, unit: str = "", doc: str = "", table: str = "",
    acts: str | None = None, **limits: Any,
) -> Any:  # fmt: skip
    """A dataclass field with what it allows.

    ``table``: its name in tables, if it is another; ``acts``: what acts where it is not left at its
    default, '' where it only tells how.
    """
    metadata = {"kind": Kind(shape, unit, **limits), "doc": doc, "table": table, "acts": acts}
    if isinstance(default, list | dict):
        return field(default_factory=lambda: type(default)(default), metadata=metadata)
    return (
        field(metadata=metadata)
        if default is MISSING
        else field(default=default, metadata=metadata)
    )


LISTED = "[]"  # at the end of a name in tables: of a list, beside a single part of that name


def in_tables(name: str) -> str:
    """A name of :func:`specs` as it stands in tables.

    >>> in_tables("puck[]"), in_tables("floor")
    ('puck', 'floor')
    """
    return name.removesuffix(LISTED)


def specs(kind: Any) -> dict[str, dataclasses.Field[Any]]:
    """The fields of a dataclass that can be read, by their names in tables."""
    return _specs(kind)


@lru_cache(maxsize=64)
def _specs(kind: Any) -> dict[str, dataclasses.Field[Any]]:
    known = [spec for spec in dataclasses.fields(kind) if "kind" in spec.metadata]
    return {spec.metadata["table"] or spec.name: spec for spec in known}


def described(kind: type, prefix: str = "") -> list[tuple[str, str, str]]:
    """Every entry of a dataclass and its parts: path, what is allowed and its default, what it is.

    >>> @dataclass(frozen=True)
    ... class Body:
    ...     mass: float = of("number", 1.0, "kg", low=0.0, above=True, doc="all of it")
    >>> described(Body)
    [('mass', 'a number > 0 kg  [1]', 'all of it')]
    """
    rows = []
    for name, spec in specs(kind).items():
        what: Kind = spec.metadata["kind"]
        path = prefix + in_tables(name)
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
        for law, part in (what.kinds or {}).items() if what.shape == "rows" else ():
            inner = described(part, f"{path}.")
            rows += [(entry, said, f"{law}: {doc}".rstrip(": ")) for entry, said, doc in inner]
    return rows
