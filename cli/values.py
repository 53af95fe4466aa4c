"""What users type as values: numbers with units, vectors, ranges, times, names with numbers.

And what a shell offers at the Tab key where click alone cannot know it: scenes, cases, laws.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from typing import Any

import click
from click.shell_completion import CompletionItem

from puck_tables.errors import InputError

MAX_COUNT = 1_000_000_000  # values of a range
MAX_TIMES = 10_000_000  # states of a run
# the numbers of a command without a unit, to question, and those with one: in its context's meta
DOUBTS, SAID = "puck_tables.doubts", "puck_tables.said"


class NumberParam(click.ParamType):
    """A finite number, in an SI unit; another unit may stand behind it."""

    name = "number"

    def __init__(self, unit: str = "", usual: float = 0.0) -> None:
        self.unit, self.usual = unit, usual  # up to which it is, see puck_tables._core.doubts

    def convert(self, value: Any, param: Any, ctx: Any) -> float:
        """Parse a finite number."""
        return self.numbers([str(value)], param, ctx)[0]

    def numbers(self, parts: list[str], param: Any, ctx: Any) -> list[float]:
        """Finite numbers that stand beside each other, each with its unit or none of them.

        One without a unit that is of a doubtful size is questioned at the end of the command.
        """
        from puck_tables._core.units import (
            SHOWN,
            UNIT_EACH,
            measured,
            quantity,
            unit_meant,
            without_unit,
        )

        if bare := without_unit(parts, self.unit):
            self.fail(UNIT_EACH.format(bare), param, ctx)
        numbers = []
        for text in parts:
            try:
                numbers.append(measured(text, self.unit))
            except ValueError:
                why = unit_meant(text[:40])
                like = f", or one with a unit as {SHOWN[self.unit]}" if self.unit else ""
                self.fail(f"'{text}' is not a number{like}{f' ({why})' if why else ''}", param, ctx)
            if not math.isfinite(numbers[-1]):
                self.fail(f"'{text}' is not a finite number", param, ctx)
            if param is not None:
                where = DOUBTS if quantity(text, self.unit) is None else SAID
                what = param.opts[0].strip("-"), numbers[-1], self.unit, self.usual
                ctx.meta.setdefault(where, []).append(what)
        return numbers


class Vector(NumberParam):
    """Two finite numbers: X,Y."""

    name = "X,Y"

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """Parse 'X,Y'."""
        if isinstance(value, tuple):
            return value
        parts = str(value).split(",")
        if len(parts) != 2:
            self.fail(f"'{value}' must be two numbers with a comma, like 1,0", param, ctx)
        return tuple(self.numbers(parts, param, ctx))


class RangeParam(NumberParam):
    """A number, START:STOP:COUNT or A,B,...; a tuple of three for a range, a list for several."""

    name = "NUMBER|START:STOP:COUNT|A,B,..."

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """Parse a number, a range or a list."""
        if isinstance(value, float | tuple | list):
            return value
        parts = str(value).split(":")
        if "," in str(value):
            return self.numbers(str(value).split(","), param, ctx)
        if len(parts) == 1:
            return self.numbers(parts, param, ctx)[0]
        if len(parts) != 3:
            self.fail(f"'{value}' must be a number, START:STOP:COUNT like 0:10:101, or numbers "
                      "with commas", param, ctx)  # fmt: skip
        start, stop = self.numbers(parts[:2], param, ctx)
        if not re.fullmatch(r"[0-9]{1,10}", parts[2]) or not 2 <= int(parts[2]) <= MAX_COUNT:
            self.fail(f"the COUNT of '{value}' must be a whole number from 2 to 1e9", param, ctx)
        if not stop > start:
            self.fail(f"in '{value}' STOP must be greater than START", param, ctx)
        if not math.isfinite(stop - start):
            self.fail(f"the range of '{value}' is too wide for floating point", param, ctx)
        return start, stop, int(parts[2])


class Times(NumberParam):
    """Times in seconds with commas, or START:STOP:COUNT."""

    name = "T1,T2,...|START:STOP:COUNT"

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """Parse a list of times or a range."""
        if ":" not in str(value):
            return tuple(self.numbers(str(value).split(","), param, ctx))
        start, stop, count = RangeParam(self.unit).convert(value, param, ctx)
        if count > MAX_TIMES:
            self.fail(f"'{value}' asks for too many states: at most 1e7", param, ctx)
        return tuple(start + (stop - start) * i / (count - 1) for i in range(count))


def not_none(values: dict[str, Any]) -> dict[str, Any]:
    """The values that were given, without those that are None."""
    return {name: value for name, value in values.items() if value is not None}


def read_as(read: Callable[[Any, str], Any]) -> Callable[..., Any]:
    """The callback of an option whose value is read by a function of it and of its flag."""

    def callback(ctx: click.Context, param: click.Parameter, value: Any) -> Any:
        return value if value is None else read(value, param.opts[0])

    return callback


def names(text: str, option: str) -> list[str]:
    """Names with commas."""
    parts = [name.strip() for name in text.split(",")]
    if not all(parts):
        raise InputError(f"{option} '{text}' must be names with commas")
    return parts


def named(
    texts: Iterable[str], option: str, form: str = "NAME=VALUE, like friction=0.2"
) -> dict[str, str]:
    """NAME=VALUE, several times."""
    result: dict[str, str] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise InputError(f"{option} '{text}' must be {form}")
        if name in result:
            raise InputError(f"{option} names {name} twice: give it once")
        result[name] = value
    return result


def number_or_text(text: str) -> Any:
    """A number; with its unit behind it a text, which the library measures.

    >>> number_or_text("0.2"), number_or_text("4cm")
    (0.2, '4cm')
    """
    from puck_tables._core.units import measured

    try:
        return measured(text, "")
    except ValueError:
        return text.strip()


def parted(text: str, sign: str, option: str) -> list[Any]:
    """Numbers parted by a sign, each with its unit or none of them.

    >>> parted("0.2:0.05", ":", "--prior friction")
    [0.2, 0.05]
    """
    numbers = [number_or_text(part) for part in text.split(sign)]
    bare = [one for one in numbers if isinstance(one, float) and one]
    # what is no number at all the library refuses
    if bare and any(isinstance(one, str) and one.lstrip("+-.")[:1].isdigit() for one in numbers):
        from puck_tables._core.units import UNIT_EACH

        raise InputError(f"{option} {text}: {UNIT_EACH.format(f'{bare[0]:g}')}")
    return numbers


_LAWS = ("uniform", "galin", "hertz", "ring", "annulus:")


def scenes(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of the scenes that come along, with their titles; and files, where those go."""
    from puck_tables.scene.library import shipped_scenes

    named = shipped_scenes().items()
    result = [CompletionItem(name, help=title) for name, title in named if name.startswith(begun)]
    return result if param.metavar is None else [*result, CompletionItem(begun, type="file")]


def cases(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of benchmark cases, with their titles."""
    from puck_tables.reference.cases import CASES

    return [CompletionItem(c.name, help=c.title) for c in CASES if c.name.startswith(begun)]


def laws(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of pressure laws, and files."""
    result = [CompletionItem(name) for name in _LAWS if name.startswith(begun)]
    return [*result, CompletionItem(begun, type="file")]
