"""A path of a driven body from a function of time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray, positive
from puck_tables.errors import InputError
from puck_tables.scene.parts import Rows

MOST_ROWS = 100_000  # of a path: more is no smooth function, or too fine an accuracy
_FIRST = 64  # intervals at first
_LOOKED_AT = (0.5, 0.2265, 0.7149)  # of an interval: no multiples of one another
_SHORTEST = 1e-9  # of the whole time: what happens faster is a jump


def path_along(place: Callable[[float], Any], until: float, accuracy: float = 1e-6) -> Rows:
    """Rows t, x, y (and angle) of a body that a function of time drives, for ``Puck.path``.

    Parameters
    ----------
    place : callable
        From t, s, to x, y (m) and perhaps the angle (rad).
    until : s, > 0
        From 0 to when; there the body stays.
    accuracy : m (and rad), > 0
        How far the straight lines between the rows may be from the function, as looked at in three
        places of each.  The speed on a line is that of its chord: off by up to √(2 a accuracy)
        where the acceleration is a.

    Returns
    -------
    tuple of tuples
        At most 100,000 rows, closer where the path bends more.

    Raises
    ------
    InputError
        If the function gives no such numbers, it jumps, or 100,000 rows do not resolve it.

    Examples
    --------
    >>> import math
    >>> rows = path_along(lambda t: (0.2 * math.cos(t), 0.2 * math.sin(t)), 2.0, 1e-4)
    >>> len(rows), rows[0]
    (65, (0.0, 0.2, 0.0))
    >>> path_along(lambda t: (0.0 if t < 0.3 else 1.0, 0.0), 1.0)
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: path jumps by 1 at 0.3 s: a driven body cannot
    """
    if not callable(place):
        raise InputError(f"place must be a function of time, got a {type(place).__name__}")
    end, close = positive("until", until, "s"), positive("accuracy", accuracy, "m")
    width = len(_place(place, 0.0, None))
    times = np.linspace(0.0, end, _FIRST + 1)
    values = np.stack([_place(place, t, width) for t in times.tolist()])
    bent = np.arange(_FIRST)
    while True:
        bent = bent[[_coefficients(place, times, values, n, close) for n in bent.tolist()]]
        if not len(bent):
            break
        if len(times) + len(bent) > MOST_ROWS:
            raise InputError(
                f"path: {MOST_ROWS} rows do not resolve it to {close:g} m around "
                f"{times[bent[0]]:.6g} s: give a larger accuracy, or a smoother function"
            )
        shortest = bent[np.argmin(times[bent + 1] - times[bent])]
        if times[shortest + 1] - times[shortest] < _SHORTEST * end:
            size = np.abs(values[shortest + 1] - values[shortest]).max()
            raise InputError(
                f"path jumps by {size:.3g} at {times[shortest]:.6g} s: a driven body cannot"
            )
        middles = 0.5 * (times[bent] + times[bent + 1])
        more = np.stack([_place(place, t, width) for t in middles.tolist()])
        times = np.insert(times, bent + 1, middles)
        values = np.insert(values, bent + 1, more, axis=0)
        first = bent + np.arange(len(bent))
        bent = np.sort(np.concatenate([first, first + 1]))
    rows = np.hstack([times[:, None], values])
    return tuple(map(tuple, rows.tolist()))


def _place(place: Callable[[float], Any], time: float, width: int | None) -> FloatArray:
    """What the function says, as two or three finite numbers."""
    given = place(time)
    try:
        numbers = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.shape not in ((2,), (3,)) or not np.isfinite(numbers).all():
        raise InputError(
            f"path: the function must give x, y and perhaps the angle, finite numbers; at {time:g} "
            f"s it gives {given!r}"
        )
    if width is not None and len(numbers) != width:
        raise InputError(
            f"path: the function gives {width} numbers at 0 s and {len(numbers)} at {time:g} s"
        )
    return numbers


def _coefficients(
    place: Callable[[float], Any], times: FloatArray, values: FloatArray, n: int, close: float
) -> bool:
    """Whether the function is too far from the line between two rows."""
    start, step = float(times[n]), float(times[n + 1] - times[n])
    for share in _LOOKED_AT:
        line = values[n] + share * (values[n + 1] - values[n])
        if np.abs(_place(place, start + share * step, len(line)) - line).max() > close:
            return True
    return False
