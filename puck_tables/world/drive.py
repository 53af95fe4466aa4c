"""The way along which a body is driven, from a table of its places."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.quantities import ANGLE, TIME, X, Y
from puck_tables._core.read_columns import numbers_of
from puck_tables.errors import InputError
from puck_tables.kernels.compile import inlined
from puck_tables.scene.parts import Rows
from puck_tables.world.paths import DURATION, FIRST, PIECE_COLUMNS, START

MAX_BYTES = 1 << 26  # of a file of a path: more is none


def rows_of(path: str | Rows) -> FloatArray:
    """Rows (n, 4) of t, x, y, angle, given or from a CSV file; they may lack the angle.

    One row, of t = 0, is a body that is led by hand.

    Raises InputError if it cannot be read, or is no such table.

    >>> rows_of(((0.0, 1.0, 2.0), (0.5, 1.0, 3.0)))[1].tolist()
    [0.5, 1.0, 3.0, 0.0]
    """
    numbers = numbers_of(path, (TIME, X, Y, ANGLE), 3, MAX_BYTES)
    rows = numbers.rows
    if len(rows) != 1:
        numbers.refuse_unless_ascending("the times")
    if rows[0, 0] != 0.0:
        raise InputError(f"must begin at t = 0, not at {rows[0, 0]:g} s")
    return np.hstack([rows, np.zeros((len(rows), 4 - rows.shape[1]))])


def pieces_along(rows: FloatArray) -> FloatArray:
    """Straight pieces (n − 1, 21) between rows of t, x, y, angle; of one a piece of no duration.

    >>> pieces_along(np.array([[0.0, 0.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0]]))[0, 5].item()
    0.5
    """
    pieces = np.zeros((max(len(rows) - 1, 1), PIECE_COLUMNS))
    if len(rows) == 1:
        pieces[0, FIRST : FIRST + 3] = pieces[0, FIRST + 9 : FIRST + 12] = rows[0, 1:]
        return pieces
    times = np.diff(rows[:, 0])
    rates = np.diff(rows[:, 1:], axis=0) / times[:, None]
    pieces[:, START], pieces[:, DURATION] = rows[:-1, 0], times
    pieces[:, FIRST : FIRST + 3], pieces[:, FIRST + 9 : FIRST + 12] = rows[:-1, 1:], rows[1:, 1:]
    pieces[:, FIRST + 3 : FIRST + 6] = pieces[:, FIRST + 12 : FIRST + 15] = rates
    return pieces


@inlined
def fill_straight(start: float, duration: float, state: FloatArray, piece: FloatArray) -> None:
    """Write one straight piece from a state (6,) on into a row (21,)."""
    for column in range(PIECE_COLUMNS):
        piece[column] = 0.0
    piece[START], piece[DURATION] = start, duration
    for i in range(3):
        piece[FIRST + i], piece[FIRST + 3 + i] = state[i], state[3 + i]
        piece[FIRST + 9 + i] = state[i] + duration * state[3 + i]
        piece[FIRST + 12 + i] = state[3 + i]
