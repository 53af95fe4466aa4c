"""Moments of a friction law over the slip speed, as integrals under a base of any shape read them.

With F_k(s) = ∫₀ˢ f(u) uᵏ du, the functions H_k(s) = F_k(s)/sᵏ⁺¹ for k = 1, 2, 3 are bounded, and
f(0)/(k + 1) at s = 0: no digit is lost as s → 0.  They and f stand in polynomials of one degree on
pieces, halved until they are good to a tenth of what integrals of them may err by.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from puck_tables._core.arrays import FloatArray

MOMENTS = 4  # f, H₁, H₂, H₃
DEGREE = 9  # of a piece
_NODES = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
_PROBES = np.linspace(-1.0, 1.0, 23)
_AT_PROBES = np.vander(_PROBES, DEGREE + 1, increasing=True).T  # (10, 23), of powers of t
_POWERS = [np.polynomial.chebyshev.cheb2poly(row) for row in np.eye(DEGREE + 1)]
# (10, 10), from values at the nodes to powers of t
_THROUGH = np.linalg.inv(np.polynomial.chebyshev.chebvander(_NODES, DEGREE)).T @ [
    np.pad(row, (0, DEGREE + 1 - len(row))) for row in _POWERS
]
_MISS = 1e-11  # of the largest f: what a piece may miss
_OCTAVES = 40  # that pieces get shorter towards slip zero, at least where f bends there
_LEAST = 1e-7  # of its place: the shortest piece
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(DEGREE + 3)


def law_moments(
    law: Callable[[FloatArray], FloatArray], speeds: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Ends (n + 1,) of pieces, m/s, their polynomials (n, 4, 10) in t from −1 to 1, and corners.

    ``law``: f at speeds, m/s; ``speeds``: ascending from 0 to the top, m/s; between them the law is
    smooth.

    >>> ends, rows, corners = law_moments(lambda u: 0.3 + 0.0 * u, np.array([0.0, 1.0]))
    >>> rows[0, :, 0].round(12).tolist()
    [0.3, 0.15, 0.1, 0.075]
    """
    largest = float(np.abs(law(np.linspace(0.0, speeds[-1], 257))).max())
    done, ends, rows = np.zeros(MOMENTS - 1), [0.0], []  # F_k at the beginning of the next piece
    waiting = [(float(a), float(b)) for a, b in pairwise(speeds)][::-1]
    while waiting:
        low, high = waiting.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        nodes, probes = (np.minimum(middle + half * at, high) for at in (_NODES, _PROBES))
        powers = _parts(law, low, done, nodes) @ _THROUGH  # rounding may lead beyond a law's end
        missed = powers @ _AT_PROBES - _parts(law, low, done, probes)
        shortest = speeds[-1] * 2.0**-_OCTAVES if low == 0.0 else _LEAST * low
        if np.abs(missed).max() > _MISS * largest and high - low > shortest:
            waiting += [(middle, high), (low, middle)]
            continue
        ends.append(high)
        rows.append(powers)
        done = done + _between(law, low, np.array([high]))[:, 0]
    return np.array(ends), np.array(rows), np.asarray(speeds)[1:-1]


def _between(law: Callable[[FloatArray], FloatArray], low: float, to: FloatArray) -> FloatArray:
    """∫ f uᵏ du from ``low`` to each of (n,), (3, n)."""
    half = 0.5 * (to - low)
    u = 0.5 * (to + low) + half * _GAUSS[:, None]
    weighted = _WEIGHTS[:, None] * half * law(u)
    return np.stack([(weighted * u**k).sum(axis=0) for k in range(1, MOMENTS)])


def _parts(
    law: Callable[[FloatArray], FloatArray], low: float, done: FloatArray, u: FloatArray
) -> FloatArray:
    """F, H₁, H₂, H₃ at speeds in a piece that begins at ``low``."""
    safe = np.where(u > 0.0, u, 1.0)
    moments = done[:, None] + _between(law, low, u)
    ratios = [
        np.where(u > 0.0, row / safe ** (k + 1), law(u) / (k + 1))
        for k, row in enumerate(moments, 1)
    ]
    return np.stack([law(u), *ratios])


def packed_law(ends: FloatArray, rows: FloatArray, corners: FloatArray) -> FloatArray:
    """Pieces in one array: how many, their ends and polynomials, how many corners, and these.

    >>> len(packed_law(*law_moments(lambda u: 0.3 + 0.0 * u, np.array([0.0, 1.0]))))
    44
    """
    return np.concatenate([[len(rows)], ends, rows.ravel(), [len(corners)], corners])
