"""Cubic splines over the slip angle alone, compiled: a table cut down to one puck.

The axis of slip is that of :mod:`puck_tables.table.slip_axis`: sides that run from a singular line
outwards, tan(φ − line) = ± extent η⁴.  No angle is needed to find a place on it: with (c, s) in the
direction of (v, r|ω|),

    tan(φ − line) = (s cos line − c sin line)/(c cos line + s sin line) .

A section is a matrix with one row a side, in the order of φ: :data:`HEADER` numbers, then the
B-spline weights over 6 of its functions, node by node.  A plain puck has one line, φ = π/4, and
extents of 1 (:func:`puck_tables.kernels.quadratic.cut`): marked in the header, because then
η⁴ = |r|ω| − v|/(r|ω| + v) keeps more digits.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import basis, cell_at, row_sums

# Columns of the header: the singular line of a side (cos, sin, ln tan), where the side ends towards
# larger φ (cos, sin), 1/extent, and the same in all rows: the square of the gyration radius over r,
# and 1 for a plain puck.
LINE_COS, LINE_SIN, LINE, UPPER_COS, UPPER_SIN, INVERSE_EXTENT, INERTIA, PLAIN = range(8)
HEADER = 8
RATIOS = 3

NO_SECTION = np.empty((0, HEADER))  # closed forms


@inlined
def section_place(k: float, fast: bool, cut: FloatArray, functions: int) -> tuple[int, int, float]:
    """Side, first column and place in the cell of a slip ratio k = min/max of v and r|ω|."""
    if cut[0, PLAIN] > 0.0:
        side, extent = (1 if fast else 0), (1.0 - k) / (1.0 + k)
    else:
        c, s = (k, 1.0) if fast else (1.0, k)
        side, last = 0, cut.shape[0] - 1
        while side < last and s * cut[side, UPPER_COS] > c * cut[side, UPPER_SIN]:
            side += 1
        across = s * cut[side, LINE_COS] - c * cut[side, LINE_SIN]
        along = c * cut[side, LINE_COS] + s * cut[side, LINE_SIN]
        extent = abs(across / along) * cut[side, INVERSE_EXTENT]
    eta = math.sqrt(math.sqrt(extent))
    cells = (cut.shape[1] - HEADER) // functions - 3
    p = min(eta, 1.0) * cells
    cell = cell_at(p, cells)
    return side, HEADER + functions * cell, p - cell


@inlined
def section_ratios(k: float, fast: bool, cut: FloatArray) -> tuple[float, float, float]:
    """The three friction ratios at a slip ratio."""
    side, i, place = section_place(k, fast, cut, RATIOS)
    w0, w1, w2, w3 = basis(place)
    return row_sums(cut[side], np.uint64(i), w0, w1, w2, w3)


@kernel
def fill_section(
    cut: FloatArray, functions: int, ratio: FloatArray, fast: npt.NDArray[np.bool_], out: FloatArray
) -> None:
    """All functions of a section at slip ratios (n,) into ``out`` (functions, n)."""
    for n in range(ratio.size):
        side, i, place = section_place(ratio[n], fast[n], cut, functions)
        weights = basis(place)
        for f in range(functions):
            total = 0.0
            for m, w in enumerate(weights):
                total += w * cut[side, i + functions * m + f]
            out[f, n] = total
