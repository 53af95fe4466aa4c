"""A cubic through points that rises and falls only where the points do."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.own_folder import say
from puck_tables.errors import InputError


def monotone_cubic(x: FloatArray, y: FloatArray) -> FloatArray:
    """Powers 0 to 3 of (x − left end) in each interval between points, array (k − 1, 4).

    As Fritsch and Butland 1984 have it, with scipy.

    >>> monotone_cubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))[:, 1].tolist()
    [1.5, 0.0]
    """
    from scipy.interpolate import PchipInterpolator

    return np.ascontiguousarray(PchipInterpolator(x, y).c[::-1].T)


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
