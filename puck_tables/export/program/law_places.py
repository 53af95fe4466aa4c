"""Under another pressure law: places beside all lines of it, stops and friction there.

These functions stand in for those of the same names in :mod:`puck_tables.export.program.stop` and
:mod:`puck_tables.export.program.resultants`; the places are those of
:mod:`puck_tables.export.law_values`.
"""

from __future__ import annotations

from math import sqrt

from puck_tables.export.program.given import (
    INVERSE_EXTENTS,
    MARKS,
    PATCH,
    PATCH_CELLS,
    PATCH_DEGREE,
    PATCH_QUANTUM,
    SIDES,
    SPIN_TIME,
    STEEP,
    STOP,
    STOP_CELLS,
    STOP_DEGREE,
    STOP_POWERS,
    STOP_QUANTUM,
    Out,
)
from puck_tables.export.program.places import look_up
from puck_tables.export.program.stop import ALONG, BODY, LENGTH, STOP_FUNCTIONS, TIME

PATCH_FUNCTIONS = 3


def side_at(fast: bool, share: float) -> int:
    """The side of c = 1 - share where r|w| > v, share - 1 elsewhere: each mark has two."""
    c: float = 1.0 - share if fast else share - 1.0
    mark: int = 1
    while 2 * mark < SIDES and c >= MARKS[mark]:
        mark = mark + 1
    return 2 * mark - 1 if 2.0 * c >= MARKS[mark - 1] + MARKS[mark] else 2 * mark - 2


def place_at(side: int, fast: bool, share: float) -> float:
    """The place xi on a side: at the mark 0, at its other end 1."""
    gap: float = share
    if side > 0 and side < SIDES - 1:
        gap = abs((1.0 - share if fast else share - 1.0) - MARKS[int(0.5 * side + 0.5)])
    gap = gap * INVERSE_EXTENTS[side]
    return sqrt(sqrt(gap)) if gap < 1.0 else 1.0


def stop_functions(side: int, share: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle; side 1 where r|w| > v."""
    fast: bool = side == 1
    here: int = side_at(fast, share)
    look_up(
        STOP, STOP_CELLS, STOP_DEGREE, STOP_POWERS, STOP_FUNCTIONS, STOP_QUANTUM, here,
        place_at(here, fast, share), STEEP * delta * delta - 1.0, f,
    )  # fmt: skip
    if share == 0.0 and side == 0:
        f[TIME] = 1.0
        f[ALONG] = 0.5
        f[LENGTH] = 0.5
    elif share == 0.0:
        f[TIME] = SPIN_TIME
        f[BODY] = 0.5 * SPIN_TIME


def shape_integrals(ratio: float, fast: bool, p: Out) -> None:
    """p_a, p_b and p_d, by look-up."""
    share: float = 2.0 * ratio / (1.0 + ratio)
    here: int = side_at(fast, share)
    place: float = place_at(here, fast, share)
    look_up(
        PATCH, PATCH_CELLS, PATCH_DEGREE, 1, PATCH_FUNCTIONS, PATCH_QUANTUM, here, place, 0.0, p
    )
