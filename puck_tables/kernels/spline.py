"""Cubic B-splines on the graded axis of slip angles, compiled.

Coordinates: ``fast`` tells which side of φ = π/4 a point lies on, and

    η = |tan(φ − π/4)|^(1/4) = |(r|ω| − v)/(r|ω| + v)|^(1/4) ∈ [0, 1]

is uniform on the grid.  The resultants behave like x² ln|x| at φ = π/4; in η that is η⁸ ln η,
smooth enough for a cubic spline to keep order 4.  All slopes vanish at both ends of η (the
resultants are even about φ = 0 and π/2, and dφ/dη = 0 at π/4): each side is a clamped spline.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined


@inlined
def basis(t: float) -> tuple[float, float, float, float]:
    """Six times the four uniform cubic B-splines that overlap a cell, at t ∈ [0, 1]."""
    s = 1.0 - t
    return s * s * s, 4.0 + t * t * (3.0 * t - 6.0), 4.0 + s * s * (3.0 * s - 6.0), t * t * t


@inlined
def cell_at(place: float, cells: int) -> int:
    """The cell of a place in [0, cells]: always one of them, also for what is no number.

    Where a place is no number the weights are none either, and so is what is looked up.
    """
    inside = place if place > 0.0 else 0.0
    last = cells - 1.0
    return int(inside if inside < last else last)


@inlined
def side_and_eta(phi: float) -> tuple[int, float]:
    """Side and graded coordinate η of an angle |φ| ≤ π/2; tan by Lambert's continued fraction."""
    x = abs(phi) - 0.25 * math.pi
    y = x * x
    up = x * (34459425.0 - y * (4729725.0 - y * (135135.0 - y * (990.0 - y))))
    down = 34459425.0 - y * (16216200.0 - y * (945945.0 - y * (13860.0 - 45.0 * y)))
    return (1 if x > 0.0 else 0), min(math.sqrt(math.sqrt(abs(up / down))), 1.0)


@inlined
def row_sums(
    c: FloatArray, k: np.uint64, w0: float, w1: float, w2: float, w3: float
) -> tuple[float, float, float]:
    """Three functions at once from four neighbouring coefficients each."""
    return (
        w0 * c[k] + w1 * c[k + 3] + w2 * c[k + 6] + w3 * c[k + 9],
        w0 * c[k + 1] + w1 * c[k + 4] + w2 * c[k + 7] + w3 * c[k + 10],
        w0 * c[k + 2] + w1 * c[k + 5] + w2 * c[k + 8] + w3 * c[k + 11],
    )
