"""Splines of degree 5 on uniform nodes, and what they miss where every other node is left out."""

from __future__ import annotations

from functools import lru_cache
from math import comb

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.speed_spline import DEGREE

# the B-splines, times 120
_AT_NODE = (1.0, 26.0, 66.0, 26.0, 1.0)
_BAND = 6  # bands of the matrix beside its diagonal
# half-way between nodes
_AT_MIDDLE = (1.0 / 32, 237.0 / 32, 1682.0 / 32, 1682.0 / 32, 237.0 / 32, 1.0 / 32)


def quintic_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform spline of degree 5 with not-a-knot ends, along two axes.

    Parameters
    ----------
    values : array (n + 1, m + 1, functions), n, m ≥ 5

    Returns
    -------
    array (n + 5, m + 5, functions), over 120² as the kernel takes them

    Examples
    --------
    >>> bool(np.allclose(120**2 * quintic_coefficients(np.ones((6, 7, 1))), 1.0))
    True
    """
    along = _solved(values)
    return np.ascontiguousarray(_solved(along.swapaxes(0, 1)).swapaxes(0, 1))


def missed_by_half(values: FloatArray) -> FloatArray:
    """At the odd nodes of axis 0 (2n + 1, …): the spline through the even ones less the values.

    >>> float(np.abs(missed_by_half(np.arange(21.0)[:, None] ** 5)).max() / 21**5) < 1e-13
    True
    """
    c = _solved(values[::2])
    n = len(values) // 2
    spline = sum(weight * c[m : m + n] for m, weight in enumerate(_AT_MIDDLE))
    return np.asarray(spline - values[1::2])


def _solved(values: FloatArray) -> FloatArray:
    """From n + 1 values at the nodes to n + 5 coefficients over 120, along axis 0."""
    from scipy.linalg import solve_banded  # a fifth of a second that few commands need

    right = np.zeros((len(values) + 4, *values.shape[1:]))
    right[2:-2] = values
    flat = solve_banded((_BAND, _BAND), _system(len(values) - 1), right.reshape(len(right), -1))
    return np.asarray(flat).reshape(right.shape)


@lru_cache(maxsize=32)
def _system(n: int) -> FloatArray:
    """The conditions as bands: no jump of the fifth derivative, the values, no jump."""
    full = np.zeros((n + DEGREE, n + DEGREE))
    for node in range(n + 1):
        full[node + 2, node : node + DEGREE] = _AT_NODE
    jump = [(-1.0) ** k * comb(6, k) for k in range(7)]
    for row, start in ((0, 0), (1, 1), (n + 3, n - 3), (n + 4, n - 2)):
        full[row, start : start + 7] = jump
    bands = np.zeros((2 * _BAND + 1, n + DEGREE))
    for offset in range(-_BAND, _BAND + 1):
        diagonal = np.diagonal(full, offset)
        first = max(offset, 0)
        bands[_BAND - offset, first : first + diagonal.size] = diagonal
    return bands
