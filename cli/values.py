"""What users type as values: numbers with units, vectors, ranges, times."""

from __future__ import annotations

import math
import re
from typing import Any

import click

MAX_COUNT = 1_000_000_000  # values of a range


class NumberParam(click.ParamType):
    """A finite number, in an SI unit; another unit may stand behind it."""

    name = "number"

    def __init__(self, unit: str = "") -> None:
        self.unit = unit

    def convert(self, value: Any, param: Any, ctx: Any) -> float:
        """Parse a finite number."""
        return finite(str(value), self, param, ctx, self.unit)


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
        return tuple(all_finite(parts, self, param, ctx))


class RangeParam(NumberParam):
    """A number, START:STOP:COUNT or A,B,...; a tuple of three for a range, a list for several."""

    name = "NUMBER|START:STOP:COUNT|A,B,..."

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """Parse a number, a range or a list."""
        if isinstance(value, float | tuple | list):
            return value
        if "," in str(value):
            return all_finite(str(value).split(","), self, param, ctx)
        parts = str(value).split(":")
        if len(parts) == 1:
            return finite(parts[0], self, param, ctx, self.unit)
        if len(parts) != 3:
            self.fail(
                f"'{value}' must be a number, START:STOP:COUNT like 0:10:101, or numbers with "
                "commas",
                param,
                ctx,
            )
        start, stop = all_finite(parts[:2], self, param, ctx)
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
            return tuple(all_finite(str(value).split(","), self, param, ctx))
        start, stop, count = RangeParam(self.unit).convert(value, param, ctx)
        if count > 10_000_000:
            self.fail(f"'{value}' asks for too many states: at most 1e7", param, ctx)
        return tuple(start + (stop - start) * i / (count - 1) for i in range(count))


def all_finite(parts: list[str], kind: NumberParam, param: Any, ctx: Any) -> list[float]:
    """Finite numbers that stand beside each other, each with its unit or none of them."""
    from puck_tables._core.units import UNIT_EACH, without_unit

    if bare := without_unit(parts, kind.unit):
        kind.fail(UNIT_EACH.format(bare), param, ctx)
    return [finite(part, kind, param, ctx, kind.unit) for part in parts]


def finite(text: str, kind: click.ParamType, param: Any, ctx: Any, unit: str = "") -> float:
    """A finite number, in an SI unit where another stands behind it, or click's error."""
    from puck_tables._core.units import SHOWN, measured, unit_meant

    try:
        number = measured(text, unit)
    except ValueError:
        why = unit_meant(text[:40])
        example = f", or one with a unit as {SHOWN[unit]}" if unit else ""
        kind.fail(f"'{text}' is not a number{example}{f' ({why})' if why else ''}", param, ctx)
    if not math.isfinite(number):
        kind.fail(f"'{text}' is not a finite number", param, ctx)
    return number
