"""Building a table to an asked accuracy: grids refined until what is measured is good enough."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

from puck_tables._core.arrays import rounded_up
from puck_tables.errors import AccuracyError, InputError
from puck_tables.table.check import Accuracy
from puck_tables.table.table import Table

AnyTable = TypeVar("AnyTable", bound=Table)

COARSEST = 0.01  # what a table may promise at most
_LEAST_CELLS = 8  # a side


def checked_accuracy(
    accuracy: float | None, default: float, finest: float, units: str
) -> float:  # fmt: skip
    """The accuracy that is asked of a table, in these units, or the default.

    Raises AccuracyError if it is out of range.

    >>> checked_accuracy(None, 1e-9, 1e-12, "an absolute error")
    1e-09
    """
    wanted = default if accuracy is None else accuracy
    if not finest <= wanted <= COARSEST:
        raise AccuracyError(
            f"accuracy must be from {finest:g} to {COARSEST:g} ({units}), got {wanted:g}"
        )
    return wanted


@dataclass(frozen=True)
class Goal:
    """What a kind of table on a grid can reach: errors fall like cells⁻⁴.

    ``default`` and ``finest`` accuracy in these ``units``; ``constant``: error × cells⁴, measured;
    ``most_cells``: where a grid becomes too large; ``safety``: how much larger errors may be where
    they were not measured.
    """

    default: float
    finest: float
    units: str
    constant: float
    most_cells: int
    safety: float = 1.0


def built(
    at: Callable[[int], AnyTable], measured: Callable[[AnyTable], Accuracy], goal: Goal,
    accuracy: float | None, cells: int | None,
) -> AnyTable:  # fmt: skip
    """A table as exact as asked, or on a grid as fine as asked, with what was measured.

    ``at``: the table with so many cells on each side of a singular line; ``measured``: the errors
    of such a table; ``goal``: what the kind can reach; ``accuracy``, ``cells``: one of them, or
    none for the default accuracy.  Raises InputError if both are given or the number of cells is
    out of range; AccuracyError if the accuracy is out of reach.
    """
    if cells is not None:
        if accuracy is not None:
            raise InputError(
                f"accuracy = {accuracy:g} and cells = {cells} both fix the grid: give one of them"
            )
        table = at(cells)
        errors = measured(table)
        promised = rounded_up(max(1.25 * errors.worst, goal.finest), 2)
        return replace(table, accuracy=errors, tolerance=promised)
    wanted = checked_accuracy(accuracy, goal.default, goal.finest, goal.units)
    # even, so that every other node is a grid as well: it tells the order
    cells = max(_LEAST_CELLS, 2 * math.ceil(0.5 * (goal.constant / wanted) ** 0.25))
    while cells <= goal.most_cells:
        table = at(cells)
        errors = measured(table)
        if goal.safety * errors.worst <= wanted:
            return replace(table, accuracy=errors, tolerance=wanted)
        cells = 2 * math.ceil(0.55 * cells)
    raise AccuracyError(
        f"an accuracy of {wanted:g} would take more than {goal.most_cells} cells: "
        f"{errors.worst:.1e} is what so many about give",
        reachable=errors.worst,
    )
