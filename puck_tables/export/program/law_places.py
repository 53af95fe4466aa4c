"""Under another pressure law: places beside all lines of it, stops and friction there.

These functions stand in for those of the same names in :mod:`puck_tables.export.program.stop` and
:mod:`puck_tables.export.program.resultant_formulas`; the places are those of
:mod:`puck_tables.export.law_values`.
"""

from __future__ import annotations

from math import sqrt

from puck_tables.export.program.intrinsics import (
    BORDERS,
    ORIGINS,
    PATCH,
    PATCH_DEGREE,
    PATCH_QUANTUM,
    PATCH_ROWS,
    SCALES,
    SIDES,
    STEEP,
    STOP,
    STOP_DEGREE,
    STOP_POWERS,
    STOP_QUANTUM,
    STOP_ROWS,
    Numbers,
    Out,
    Rows,
)
from puck_tables.export.program.places import look_up
from puck_tables.export.program.stop import STOP_FUNCTIONS

PATCH_FUNCTIONS = 3  # ρ_∥, ρ_⊥, ρ_ω


def look_beside(
    table: Numbers, rows: Rows, degree: int, powers: int, functions: int, quantum: float, c: float,
    s: float, found: Out,
) -> None:  # fmt: skip
    """The functions of a table beside the mark of a side, xi = 0, up to the next side, xi = 1."""
    side: int = 0
    for n in range(SIDES - 1):
        side += 1 if c >= BORDERS[n] else 0
    look_up(
        table, rows[side] * powers * functions, rows[side + 1] - rows[side] - degree, degree,
        powers, functions, quantum, sqrt(sqrt((c - ORIGINS[side]) * SCALES[side])), s, found,
    )  # fmt: skip


def table_at(side: int, share: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle by look-up; side 1 where r|w| > v."""
    look_beside(
        STOP, STOP_ROWS, STOP_DEGREE, STOP_POWERS, STOP_FUNCTIONS, STOP_QUANTUM,
        1.0 - share if side == 1 else share - 1.0, STEEP * delta * delta - 1.0, f,
    )  # fmt: skip


def shape_integrals(ratio: float, fast: bool, p: Out) -> None:
    """p_a, p_b and p_d, by look-up."""
    c: float = (1.0 - ratio) / (1.0 + ratio)
    look_beside(
        PATCH,
        PATCH_ROWS,
        PATCH_DEGREE,
        1,
        PATCH_FUNCTIONS,
        PATCH_QUANTUM,
        c if fast else -c,
        0.0,
        p,
    )
