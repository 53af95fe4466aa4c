"""A path in pieces: polynomials of degree five through place, velocity and acceleration.

What is integrated is kept so, and the way of a driven body, from a table of its places.  A piece is
a row of start, duration, and at both ends x, y, angle with their first and second derivatives.  Its
error falls with the sixth power of the duration.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.quantities import ANGLE, TIME, X, Y
from puck_tables._core.read_columns import numbers_of
from puck_tables.errors import InputError
from puck_tables.kernels.compile import inlined
from puck_tables.scene.parts import Rows

BEGINS, DURATION, FIRST = range(3)  # FIRST: nine numbers at its start, nine at its end
PIECE_COLUMNS = FIRST + 18  # all
MAX_BYTES = 1 << 26  # of a file of a path: more is none
FOR_EVER = 1e9  # s: what lasts as long has no end; its places are still good to 1e-16 of the way
_ROUNDED = 1e-15  # of a place
_CLOSED = 1e-12  # m or rad: by so much at most a place is put right at the end of a step
_SMOOTH = 0.1  # of how far velocities bend: the most that places tell beyond these


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
    pieces[:, BEGINS], pieces[:, DURATION] = rows[:-1, 0], times
    pieces[:, FIRST : FIRST + 3], pieces[:, FIRST + 9 : FIRST + 12] = rows[:-1, 1:], rows[1:, 1:]
    pieces[:, FIRST + 3 : FIRST + 6] = pieces[:, FIRST + 12 : FIRST + 15] = rates
    return pieces


@inlined
def fill_straight(start: float, duration: float, state: FloatArray, piece: FloatArray) -> None:
    """Write one straight piece from a state (6,) on into a row (21,)."""
    for column in range(PIECE_COLUMNS):
        piece[column] = 0.0
    piece[BEGINS], piece[DURATION] = start, duration
    for i in range(3):
        piece[FIRST + i], piece[FIRST + 3 + i] = state[i], state[3 + i]
        piece[FIRST + 9 + i] = state[i] + duration * state[3 + i]
        piece[FIRST + 12 + i] = state[3 + i]


@inlined
def piece_at(pieces: FloatArray, first: int, last: int, t: float) -> int:
    """The row of the pieces first … last − 1, one after the other, in which t lies."""
    low, high = first, last - 1
    while low < high:
        middle = (low + high + 1) // 2
        if pieces[middle, BEGINS] <= t:
            low = middle
        else:
            high = middle - 1
    return low


@inlined
def _coefficients(piece: FloatArray, i: int) -> tuple[float, float, float, float]:
    """The coefficients of s³, s⁴ and s⁵ of a place or the angle, s from 0 to 1, and what is left.

    That is a way of which velocities know nothing: what a gap was closed by, and rounding, on a
    piece so short that they would be spoilt by it.
    """
    h = piece[DURATION]
    x0, v0, a0 = piece[FIRST + i], h * piece[FIRST + 3 + i], h * h * piece[FIRST + 6 + i]
    x1, v1, a1 = piece[FIRST + 9 + i], h * piece[FIRST + 12 + i], h * h * piece[FIRST + 15 + i]
    # what is left of place, velocity and acceleration at the end of a parabola from the start
    gap, rate, accel = x1 - x0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0
    moved = 0.5 * rate - accel / 12.0
    left = gap - moved
    if abs(left) > _CLOSED or _ROUNDED * (abs(x0) + abs(x1)) < abs(left) <= _SMOOTH * (
        abs(rate) + abs(accel)
    ):
        moved, left = gap, 0.0
    return (
        10.0 * moved - 4.0 * rate + 0.5 * accel, -15.0 * moved + 7.0 * rate - accel,
        6.0 * moved - 3.0 * rate + 0.5 * accel, left,
    )  # fmt: skip


@inlined
def on_piece(piece: FloatArray, t: float, out: FloatArray) -> None:
    """X, y, angle, their rates, and the rates of these, at t, into ``out`` (9,)."""
    h = piece[DURATION]
    s = (t - piece[BEGINS]) / h
    s = min(max(s, 0.0), 1.0)
    for i in range(3):
        x0, v0, a0 = piece[FIRST + i], h * piece[FIRST + 3 + i], h * h * piece[FIRST + 6 + i]
        c3, c4, c5, left = _coefficients(piece, i)
        out[i] = x0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
        out[i] += left * s**3 * (10.0 - s * (15.0 - 6.0 * s))
        out[3 + i] = (v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h
        out[6 + i] = (a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (h * h)


@inlined
def jerk_on(piece: FloatArray) -> float:
    """The most by which the acceleration of the place changes per second."""
    total = 0.0
    for i in range(2):
        c3, c4, c5, _ = _coefficients(piece, i)
        total += 6.0 * abs(c3) + 24.0 * abs(c4) + 60.0 * abs(c5)
    return total / piece[DURATION] ** 3


@inlined
def bounds_of(piece: FloatArray) -> tuple[float, float]:
    """The largest speed and acceleration of the place on a piece, at most.

    By the control points of both as polynomials of Bernstein, between which they stay.
    """
    h, speed, accel = piece[DURATION], 0.0, 0.0
    x3, x4, _, _ = _coefficients(piece, 0)
    y3, y4, _, _ = _coefficients(piece, 1)
    vx0, vy0, ax0, ay0 = piece[FIRST + 3], piece[FIRST + 4], piece[FIRST + 6], piece[FIRST + 7]
    vx1, vy1, ax1, ay1 = piece[FIRST + 12], piece[FIRST + 13], piece[FIRST + 15], piece[FIRST + 16]
    for vx, vy in (
        (vx0, vy0),
        (vx0 + 0.25 * h * ax0, vy0 + 0.25 * h * ay0),
        (vx0 + 0.5 * (h * ax0 + x3 / h), vy0 + 0.5 * (h * ay0 + y3 / h)),
        (vx1 - 0.25 * h * ax1, vy1 - 0.25 * h * ay1),
        (vx1, vy1),
    ):
        speed = max(speed, math.hypot(vx, vy))
    square = h * h
    for ax, ay in (
        (ax0, ay0),
        (ax0 + 2.0 * x3 / square, ay0 + 2.0 * y3 / square),
        (ax0 + 4.0 * (x3 + x4) / square, ay0 + 4.0 * (y3 + y4) / square),
        (ax1, ay1),
    ):
        accel = max(accel, math.hypot(ax, ay))
    return speed, accel
