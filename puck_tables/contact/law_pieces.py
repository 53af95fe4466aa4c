"""A friction coefficient over the slip speed as compiled quadrature reads it: in polynomials.

A row is the origin o and the scale s of a piece and then the powers of t = (u − o) s.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from puck_tables._core.arrays import FloatArray

# of Chebyshev's series of a piece: its degree, its nodes, and places that judge it between them
_DEGREE = 15
_ANGLES = np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1)
_NODES = np.cos(_ANGLES)
_PROBES = np.linspace(-1.0, 1.0, 37)
_ROUNDING = 4e-15  # of the largest f: what a piece may miss
# half a piece at least, of the top and of its place: what is left of a root at slip zero
_SHORTEST, _NARROWEST = 1e-26, 1e-6


def pieces_of_function(
    law: Callable[[FloatArray], FloatArray], speeds: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Ends (k + 1,) and polynomials (k, 18) of a smooth law between speeds, good to rounding.

    Parameters
    ----------
    law : callable, f at speeds in m/s
    speeds : array, m/s
        Ascending from 0 to the top; where the law has a scale of its own pieces end.

    Examples
    --------
    >>> ends, pieces = pieces_of_function(np.exp, np.array([0.0, 1.0]))
    >>> t = (0.3 - pieces[0, 0]) * pieces[0, 1]
    >>> float(np.polynomial.polynomial.polyval(t, pieces[0, 2:]) - np.exp(0.3)) < 1e-15
    True
    """
    waiting = [(float(a), float(b)) for a, b in pairwise(speeds)][::-1]
    largest = float(np.abs(law(np.concatenate([speeds, np.linspace(0.0, speeds[-1], 99)]))).max())
    ends, rows = [0.0], []
    while waiting:
        low, high = waiting.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        series = np.polynomial.chebyshev.chebfit(_NODES, law(middle + half * _NODES), _DEGREE)
        powers = np.polynomial.chebyshev.cheb2poly(series)
        powers = np.pad(powers, (0, _DEGREE + 1 - len(powers)))
        missed = np.polynomial.polynomial.polyval(_PROBES, powers) - law(middle + half * _PROBES)
        shortest = max(_SHORTEST * speeds[-1], _NARROWEST * middle)
        if np.abs(missed).max() > _ROUNDING * largest and half > shortest:
            waiting += [(middle, high), (low, middle)]
            continue
        ends.append(high)
        rows.append([middle, 1.0 / half, *powers])
    return np.array(ends), np.array(rows)
