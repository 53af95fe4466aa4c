"""A cubic through points that rises and falls only where the points do."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.own_folder import say
from puck_tables.errors import InputError

_STEEPEST = 3.0  # times the difference, at an end


def monotone_cubic(x: FloatArray, y: FloatArray) -> FloatArray:
    """Powers 0 to 3 of (x − left end) in each interval between points, array (k − 1, 4).

    The slopes are the weighted harmonic means of the neighbouring differences, 0 where these change
    sign (Fritsch, Butland 1984); at the ends the three-point formula, limited so that no extremum
    appears (Fritsch, Carlson 1980).

    >>> monotone_cubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))[:, 1].tolist()
    [1.5, 0.0]
    """
    width = np.diff(x)
    rise = np.diff(y) / width
    slope = _slopes(width, rise)
    left, right = slope[:-1], slope[1:]
    return np.stack([
        y[:-1], left, (3.0 * rise - 2.0 * left - right) / width,
        (left + right - 2.0 * rise) / width**2,
    ], axis=-1)  # fmt: skip


def _slopes(width: FloatArray, rise: FloatArray) -> FloatArray:
    """Slopes at the points that keep every interval monotone."""
    if rise.size == 1:
        return np.repeat(rise, 2)
    slope = np.zeros(rise.size + 1)
    same = rise[1:] * rise[:-1] > 0.0
    first, second = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    safe = np.where(same, rise[:-1], 1.0), np.where(same, rise[1:], 1.0)
    mean = (first + second) / (first / safe[0] + second / safe[1])
    slope[1:-1] = np.where(same, mean, 0.0)
    slope[0] = _end_slope(width[0], width[1], rise[0], rise[1])
    slope[-1] = _end_slope(width[-1], width[-2], rise[-1], rise[-2])
    return slope


def _end_slope(near: float, last: float, first: float, second: float) -> float:
    slope = ((2.0 * near + last) * first - near * second) / (near + last)
    if slope * first <= 0.0:
        return 0.0
    if first * second <= 0.0 and abs(slope) > _STEEPEST * abs(first):
        return _STEEPEST * first
    return slope


def from_rest(speeds: FloatArray, values: FloatArray, name: str) -> tuple[FloatArray, FloatArray]:
    """Measured points over a speed, from 0 on, each speed once; what is done to them is said.

    Below the first speed the value there holds; of a speed that is given more than once the mean of
    its values is taken.

    ``speeds``, ``values``: ndarray (k,); ``name``: of the points, for what is said.

    >>> xs, ys = from_rest(np.array([0.0, 1.0, 1.0]), np.array([0.3, 0.2, 0.4]), "this law")
    >>> xs.tolist(), ys.round(9).tolist()
    ([0.0, 1.0], [0.3, 0.3])
    """
    if speeds[0] < 0.0 or (np.diff(speeds) < 0.0).any():
        raise InputError("speeds must ascend, from 0 m/s or more")
    if speeds[0] == 0.0 and (np.diff(speeds) > 0.0).all():
        return speeds, values
    each, first, count = np.unique(speeds, return_index=True, return_counts=True)
    if each.size < speeds.size:
        twice = each[count > 1]
        values = np.add.reduceat(values, first) / count
        which = f"{twice[0]:g} m/s" + (f" and {twice.size - 1} more" if twice.size > 1 else "")
        said = "is a speed" if twice.size == 1 else "are speeds"
        say(f"{name}: {which} {said} given more than once: the mean is taken")
    if each[0] > 0.0:
        say(f"{name}: below its first speed, {each[0]:g} m/s, the {values[0]:.6g} there is taken")
        each, values = np.append(0.0, each), np.append(values[0], values)
    return each, values
