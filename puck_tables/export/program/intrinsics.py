"""The words of programs that every language has its own for.

The numbers of a table are whole; times its quantum they are the coefficients of uniform B-splines
in ξ (:mod:`puck_tables.export.compact_tables`), a row a node: the powers of 2δ² − 1, ascending, and
within a power the functions.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence

Numbers = Sequence[float]
Out = MutableSequence[float]
Room = list[float]
Rows = Sequence[int]  # where the rows of each side begin, and where all end; how many they are


def room(size: int) -> Room:
    """An array to work in."""
    return [0.0] * size
