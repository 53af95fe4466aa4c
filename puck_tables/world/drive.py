"""The way along which a body is driven, from a table of its places."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.quantities import ANGLE, TIME, X, Y
from puck_tables._core.read_columns import numbers_of
from puck_tables.errors import InputError
from puck_tables.scene.parts import Rows
from puck_tables.world.paths import DURATION, FIRST, PIECE_COLUMNS, START

MAX_BYTES = 1 << 26


def rows_of(given: str | Rows) -> FloatArray:
    """Rows (n, 4) of t, x, y, angle, given or from a CSV file; they may lack the angle.

    Raises
    ------
    InputError
        If it cannot be read, or is no such table.

    Examples
    --------
    >>> rows_of(((0.0, 1.0, 2.0), (0.5, 1.0, 3.0)))[1].tolist()
    [0.5, 1.0, 3.0, 0.0]
    """
    numbers = numbers_of(given, (TIME, X, Y, ANGLE), 3, MAX_BYTES)
    numbers.refuse_unless_ascending("the times")
    rows = numbers.rows
    if rows[0, 0] != 0.0:
        raise InputError(f"must begin at t = 0, not at {rows[0, 0]:g} s")
    return np.hstack([rows, np.zeros((len(rows), 4 - rows.shape[1]))])


def pieces_along(rows: FloatArray) -> FloatArray:
    """Straight pieces (n − 1, 20) between rows of t, x, y, angle.

    Examples
    --------
    >>> pieces_along(np.array([[0.0, 0.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0]]))[0, 5].item()
    0.5
    """
    pieces = np.zeros((len(rows) - 1, PIECE_COLUMNS))
    times = np.diff(rows[:, 0])
    rates = np.diff(rows[:, 1:], axis=0) / times[:, None]
    pieces[:, START], pieces[:, DURATION] = rows[:-1, 0], times
    pieces[:, FIRST : FIRST + 3], pieces[:, FIRST + 9 : FIRST + 12] = rows[:-1, 1:], rows[1:, 1:]
    pieces[:, FIRST + 3 : FIRST + 6] = pieces[:, FIRST + 12 : FIRST + 15] = rates
    return pieces
