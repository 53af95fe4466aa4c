"""Angles of a body from frame to frame: without leaps, and from two marks on it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array, real_array
from puck_tables.errors import InputError

_TURN = 2.0 * np.pi


def unwrap(angle: npt.ArrayLike, time: npt.ArrayLike, spin: npt.ArrayLike = 0.0) -> FloatArray:
    """The angle of a body without leaps of whole turns, from what its spin is known to be.

    From each frame where the angle was seen to the next one, the turn is taken that is nearest to
    the one that the spin makes, ``angle' - angle - spin (t' - t)`` within half a turn.  With the
    spin known to better than half a turn a frame this also holds where the body makes more than
    half a turn from frame to frame; without it the turns are less than half a turn.

    Parameters
    ----------
    angle : array_like (n,), rad
        NaN where it was not seen.
    time : array_like (n,), s
    spin : float or array_like (n,), rad/s
        At those times; between two of them it is taken as their mean.

    Returns
    -------
    ndarray (n,), rad
        The first angle seen is as it was.

    Raises
    ------
    InputError
        If shapes differ, or times and spins are not finite.

    Examples
    --------
    >>> seen = [0.0, 5.0, 10.0 - 2 * np.pi]          # 50 rad/s at 10 frames a second
    >>> unwrap(seen, [0.0, 0.1, 0.2], 49.0).round(6).tolist()
    [0.0, 5.0, 10.0]
    """
    angles, times = real_array("angle", angle, "rad"), finite_array("time", time, "s")
    spins = finite_array("spin", spin, "rad/s")
    if angles.ndim != 1 or times.shape != angles.shape or spins.shape not in ((), angles.shape):
        raise InputError(
            f"angle and time must be (n,), spin a number or (n,); got {angles.shape}, "
            f"{times.shape} and {spins.shape}"
        )
    known = np.flatnonzero(np.isfinite(angles))
    steps = np.diff(times) * np.broadcast_to(spins, angles.shape)[:-1]
    if spins.ndim:
        steps = 0.5 * np.diff(times) * (spins[1:] + spins[:-1])
    turned = np.concatenate([[0.0], np.cumsum(steps)])[known] if known.size else np.zeros(0)
    rest = np.diff(angles[known] - turned)
    rest -= _TURN * np.round(rest / _TURN)
    result = angles.copy()
    if known.size:
        result[known[1:]] = angles[known[0]] + turned[1:] - turned[0] + np.cumsum(rest)
    return result


def direction(start: FloatArray, end: FloatArray) -> FloatArray:
    """The angle of the line from one mark to another, counter-clockwise from x, (n,) in rad.

    Examples
    --------
    >>> direction(np.array([[0.0, 0.0]]), np.array([[0.0, 2.0]])).round(6).tolist()
    [1.570796]
    """
    apart = end - start
    angle: FloatArray = np.arctan2(apart[:, 1], apart[:, 0])
    angle[(apart == 0.0).all(axis=1)] = np.nan  # two marks at one place have no direction
    return angle
