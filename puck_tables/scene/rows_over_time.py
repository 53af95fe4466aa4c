"""Rows over time from a function: of a driven body, a floor that moves, a force, a factor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray, positive
from puck_tables.errors import InputError
from puck_tables.scene.parts import Rows

MOST_ROWS = 100_000  # more is no smooth function, or too fine an accuracy
_FIRST = 64  # intervals at first
_LOOKED_AT = (0.5, 0.2265, 0.7149)  # of an interval: no multiples of one another
_SHORTEST = 1e-9  # of the whole time: what happens faster is a jump


def rows_over_time(
    function: Callable[[float], Any], until: float, accuracy: float = 1e-6
) -> Rows:  # fmt: skip
    """Rows of t and what a function of time gives then, wherever rows over time may stand.

    That is ``Puck.path`` (x, y in m, perhaps the angle in rad) and ``over_time`` of a
    :class:`Floor` (vx, vy in m/s, perhaps the spin in rad/s), a :class:`Force` (Fx, Fy in N,
    perhaps the torque in N m) and a :class:`Grip` (a factor).

    Parameters
    ----------
    function : callable
        From t, s, to a number, or to two or three of them.
    until : s, > 0
        From 0 to when; after that the last row holds.
    accuracy : in the units of the numbers, > 0
        How far the straight lines between the rows may be from the function, as looked at in three
        places of each.  The slope of a line is that of its chord: off by up to √(2 a accuracy)
        where the second derivative is a.

    Returns
    -------
    tuple of tuples
        At most 100,000 rows, closer where the function bends more.

    Raises
    ------
    InputError
        If the function gives no such numbers, it jumps, or 100,000 rows do not resolve it.

    Examples
    --------
    A tray that shakes to and fro by 2 cm, once a second:

    >>> import math
    >>> import puck_tables as pt
    >>> speed = 0.02 * 2 * math.pi
    >>> rows = pt.rows_over_time(lambda t: (speed * math.cos(2 * math.pi * t), 0.0), 2.0, 1e-4)
    >>> len(rows), rows[0]
    (193, (0.0, 0.12566370614359174, 0.0))
    >>> pt.Scene(pt.Puck(0.05, friction=0.2), pt.Floor(over_time=rows), time=2.0).simulate().end
    'carried by the floor'
    """
    if not callable(function):
        raise InputError(f"function must be one of time, got a {type(function).__name__}")
    end, close = positive("until", until, "s"), positive("accuracy", accuracy, "")
    width = len(_numbers(function, 0.0, None))
    times = np.linspace(0.0, end, _FIRST + 1)
    values = np.stack([_numbers(function, t, width) for t in times.tolist()])
    bent = np.arange(_FIRST)
    while True:
        bent = bent[[_is_bent(function, times, values, n, close) for n in bent.tolist()]]
        if not len(bent):
            break
        if len(times) + len(bent) > MOST_ROWS:
            raise InputError(
                f"{MOST_ROWS} rows do not resolve the function to {close:g} around "
                f"{times[bent[0]]:.6g} s: give a larger accuracy, or a smoother function"
            )
        shortest = bent[np.argmin(times[bent + 1] - times[bent])]
        if times[shortest + 1] - times[shortest] < _SHORTEST * end:
            size = np.abs(values[shortest + 1] - values[shortest]).max()
            raise InputError(
                f"the function jumps by {size:.3g} at {times[shortest]:.6g} s: give rows in its "
                "place"
            )
        middles = 0.5 * (times[bent] + times[bent + 1])
        more = np.stack([_numbers(function, t, width) for t in middles.tolist()])
        times = np.insert(times, bent + 1, middles)
        values = np.insert(values, bent + 1, more, axis=0)
        first = bent + np.arange(len(bent))
        bent = np.sort(np.concatenate([first, first + 1]))
    rows = np.hstack([times[:, None], values])
    return tuple(map(tuple, rows.tolist()))


def _numbers(function: Callable[[float], Any], time: float, width: int | None) -> FloatArray:
    """What the function says, as one to three finite numbers."""
    value = function(time)
    try:
        numbers = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    numbers = np.atleast_1d(numbers)
    if numbers.shape not in ((1,), (2,), (3,)) or not np.isfinite(numbers).all():
        raise InputError(
            f"the function must give one, two or three finite numbers; at {time:g} s it gives "
            f"{value!r}"
        )
    if width is not None and len(numbers) != width:
        raise InputError(
            f"the function gives {width} numbers at 0 s and {len(numbers)} at {time:g} s"
        )
    return numbers


def _is_bent(
    function: Callable[[float], Any], times: FloatArray, values: FloatArray, n: int, close: float
) -> bool:
    """Whether the function is too far from the line between two rows."""
    start, step = float(times[n]), float(times[n + 1] - times[n])
    for share in _LOOKED_AT:
        line = values[n] + share * (values[n + 1] - values[n])
        if np.abs(_numbers(function, start + share * step, len(line)) - line).max() > close:
            return True
    return False
