"""A path in pieces: polynomials of degree five through place, velocity and acceleration.

What is integrated, or given by a film, is kept so: a piece is a row of start, duration, and at both
ends x, y, angle with their first and second derivatives.  Its error falls with the sixth power of
the duration.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined

START, DURATION, FIRST = range(3)  # FIRST: nine numbers at its start, nine at its end
PIECE_COLUMNS = FIRST + 18  # all
FOR_EVER = 1e9  # s: what lasts as long has no end; its places are still good to 1e-16 of the way
_ROUNDED = 1e-15  # of a place
_CLOSED = 1e-12  # m or rad: by so much at most a place is put right at the end of a step
_SMOOTH = 0.1  # of how far velocities bend: the most that places tell beyond these


@inlined
def piece_at(pieces: FloatArray, first: int, last: int, t: float) -> int:
    """The row of the pieces first … last − 1, one after the other, in which t lies."""
    low, high = first, last - 1
    while low < high:
        middle = (low + high + 1) // 2
        if pieces[middle, START] <= t:
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
    s = (t - piece[START]) / h
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
