"""The rows of names over the columns of a table, with their units."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from puck_tables._core.text import TextForm, split, whole_names
from puck_tables._core.units import is_unit


def header_of(form: TextForm, names: Callable[[list[str]], bool]) -> list[list[str]]:
    """The rows of names over the columns of a table; the last has their units in brackets.

    Parameters
    ----------
    form : how it is written
    names : whether cells are names of columns: those of the last comment may be, where there are no
        others

    Returns
    -------
    list of list of str
        Each as long as the table is wide; empty if there are none.

    Examples
    --------
    >>> form = TextForm("utf-8", ",", False, [["t", "x"], ["s", "cm"]], [], [["0", "1"]], 2, 2)
    >>> header_of(form, bool)
    [['t [s]', 'x [cm]']]
    """
    header = [row[: form.width] + [""] * (form.width - len(row)) for row in form.header]
    if not header:
        for line in reversed(form.said):
            cells = split(re.sub(r"^[#%/\s]+", "", line), form.separator)
            cells = cells if form.separator else whole_names(cells)
            if len(cells) == form.width and names(cells):
                return [cells]
    if len(header) > 1 and _are_units(header[-1]):
        units = header.pop()
        header[-1] = [
            f"{name} [{unit.strip('[]() ')}]" if is_unit(unit) else name
            for name, unit in zip(header[-1], units, strict=True)
        ]
    return header


def _are_units(row: Sequence[str]) -> bool:
    """Whether a row holds units: some that are known, and others in brackets."""
    return any(map(is_unit, row)) and all(
        is_unit(cell) or cell in ("", "-") or re.fullmatch(r"[\[(].*[\])]", cell) for cell in row
    )
