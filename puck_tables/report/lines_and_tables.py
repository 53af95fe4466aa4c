"""How reports are laid out: names with what is said of them, and tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec


def listed(entries: Mapping[str, str], width: int = 0) -> str:
    """Names and what is said of them, a line each.

    >>> print(listed({"puck": "r = 1 m", "contact": "full"}))
    puck    r = 1 m
    contact full
    """
    width = max(width, *map(len, entries))
    return "\n".join(f"{name:<{width}} {text}" for name, text in entries.items())


def columns(heads: Mapping[str, str], rows: Iterable[Iterable[Any]], most: int = 60) -> str:
    """A table: headings with the formats of their columns; texts stand left, numbers right.

    ``most``: signs of a text.  None and nan are shown as a dash.

    >>> print(columns({"file": "", "time s": ".3f"}, [("one.csv", 0.5), ("b", None)]))
    file     time s
    one.csv   0.500
    b             -
    """
    cells = [list(heads)]
    for row in rows:
        cells.append([
            "-" if one is None or one != one else
            format(one, form) if form else one if len(one) <= most else f"{one[: most - 3]}..."
            for one, form in zip(row, heads.values(), strict=True)
        ])  # fmt: skip
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    sides = [">" if form else "<" for form in heads.values()]
    return "\n".join(
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in
                  zip(line, sides, widths, strict=True)).rstrip()
        for line in cells
    )  # fmt: skip


def puck_words(puck: PuckSpec) -> str:
    """What the motion of a puck depends on.

    >>> from puck_tables import Puck
    >>> puck_words(Puck.similar())
    'r = 1 m, delta = 0.5, f g = 1 m/s^2'
    """
    if puck.shape is not None:
        high = f"h = {puck.height:g} m, " if puck.height > 0.0 else ""
        return (
            f"base {puck.shape.name}, k = {puck.inertia_radius:.6g} m, {high}f = {puck.friction:g},"
            f" f g = {puck.decel:.6g} m/s^2"
        )
    kind = f", {puck.body.kind}" if puck.body.kind else ""
    return f"r = {puck.radius:g} m, delta = {puck.delta:.6g}, f g = {puck.decel:.6g} m/s^2{kind}"
