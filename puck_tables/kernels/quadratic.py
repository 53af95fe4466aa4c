"""The table of friction resultants as compiled code reads it: five splines over the slip angle.

In full contact the *friction ratios* are polynomials of the height under every pressure law,

    1/ρ_∥ = a₀ + a₂ δ²,    ρ_⊥/ρ_∥ = b₁ δ,    ρ_ω/ρ_∥ = c₀ + c₂ δ² ,

with functions of φ alone.  They are also what the equations of motion need.  Five cubic splines in
η then do what three bicubic ones do, with 20 products a point instead of 48 and a fifth of the
memory.

Coefficients: array (sides, η cells + 3, 5) of B-spline weights over 6, in the order a₀, a₂, b₁, c₀,
c₂; sides: rows of line, end and extent as in :mod:`puck_tables.table.slip_spline`.

A section is a table cut down to one puck, over the slip angle alone.  Its axis of slip is that of
:mod:`puck_tables.table.slip_spline`: sides that run from a singular line outwards,
tan(φ − line) = ± extent η⁴.  No angle is needed to find a place on it: with (c, s) in the direction
of (v, r|ω|),

    tan(φ − line) = (s cos line − c sin line)/(c cos line + s sin line) .

A section is a matrix with one row a side, in the order of φ: :data:`HEADER` numbers, then the
B-spline weights over 6 of its functions, node by node.  A plain puck has one line, φ = π/4, and
extents of 1 (:func:`section_at`): marked in the header, because then η⁴ = |r|ω| − v|/(r|ω| + v)
keeps more digits.

Splines are cubic on the graded axis of slip angles.  ``fast`` tells which side of φ = π/4 a point
lies on, and

    η = |tan(φ − π/4)|^(1/4) = |(r|ω| − v)/(r|ω| + v)|^(1/4) ∈ [0, 1]

is uniform on the grid.  The resultants behave like x² ln|x| at φ = π/4; in η that is η⁸ ln η,
smooth enough for a cubic spline to keep order 4.  All slopes vanish at both ends of η (the
resultants are even about φ = 0 and π/2, and dφ/dη = 0 at π/4): each side is a clamped spline.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, kernel, patience

# Columns of the header: the singular line of a side (cos, sin, ln tan), where the side ends towards
# larger φ (cos, sin), 1/extent, and the same in all rows: the square of the gyration radius over r,
# and 1 for a plain puck.
LINE_COS, LINE_SIN, LINE, UPPER_COS, UPPER_SIN, INVERSE_EXTENT, INERTIA, PLAIN = range(8)
HEADER = 8  # the eight above
RATIOS = 3  # 1/ρ_∥, ρ_⊥/ρ_∥ and ρ_ω/ρ_∥
SLOPES = 6  # functions of a section that also holds the derivatives of the ratios by the height
_LEAST = 0.5  # cells from a line: nearer the quotient of slopes is 0/0

NO_SECTION = np.empty((0, HEADER))  # closed forms
TERMS = 5  # of the ratios over δ (table.fit.height_terms)
NO_COLUMNS = np.empty((2, 0, TERMS))  # closed forms; read-only like those of a table
NO_COLUMNS.flags.writeable = False
_BLOCK = 128  # points at once: their numbers fit the first cache
_HALF_ROOT = math.sqrt(0.5)


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


@inlined
def section_place(
    k: float, fast: bool, section: FloatArray, functions: int
) -> tuple[int, int, float]:
    """Side, first column and place in the cell of a slip ratio k = min/max of v and r|ω|."""
    if section[0, PLAIN] > 0.0:
        side, extent = (1 if fast else 0), (1.0 - k) / (1.0 + k)
    else:
        c, s = (k, 1.0) if fast else (1.0, k)
        side, last = 0, section.shape[0] - 1
        while side < last and s * section[side, UPPER_COS] > c * section[side, UPPER_SIN]:
            side += 1
        across = s * section[side, LINE_COS] - c * section[side, LINE_SIN]
        along = c * section[side, LINE_COS] + s * section[side, LINE_SIN]
        extent = abs(across / along) * section[side, INVERSE_EXTENT]
    eta = math.sqrt(math.sqrt(extent))
    cells = (section.shape[1] - HEADER) // functions - 3
    p = min(eta, 1.0) * cells
    cell = cell_at(p, cells)
    return side, HEADER + functions * cell, p - cell


@inlined
def section_ratios(k: float, fast: bool, section: FloatArray) -> tuple[float, float, float]:
    """The three friction ratios at a slip ratio."""
    side, i, place = section_place(k, fast, section, RATIOS)
    w0, w1, w2, w3 = basis(place)
    return row_sums(section[side], np.uint64(i), w0, w1, w2, w3)


@inlined
def section_slopes(
    k: float, fast: bool, section: FloatArray
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """The friction ratios at a slip ratio, their derivatives by u = ln tan φ and by the height.

    Those by u are of the spline itself.  Within a cell of a line they are wrong by its own size:
    steps there must be short.
    """
    side, i, place = section_place(k, fast, section, SLOPES)
    row = section[side]
    cells = (section.shape[1] - HEADER) // SLOPES - 3
    eta = max((i - HEADER) // SLOPES + place, _LEAST) / cells
    c, s = (k, 1.0) if fast else (1.0, k)
    across = s * row[LINE_COS] - c * row[LINE_SIN]
    eta3, extent = eta * eta * eta, 1.0 / row[INVERSE_EXTENT]
    dphi_deta = 4.0 * extent * eta3 / (1.0 + extent * extent * eta3 * eta3 * eta * eta)  # dφ/dη
    by_u = 3.0 * cells * c * s / ((c * c + s * s) * dphi_deta)  # three: of the weights below
    by_u = by_u if across > 0.0 or (across == 0.0 and 2 * (side // 2) != side) else -by_u
    w0, w1, w2, w3 = basis(place)
    t, r = place, 1.0 - place
    d0, d1 = -r * r, t * (3.0 * t - 4.0)
    d2, d3 = -r * (3.0 * r - 4.0), t * t
    return (
        w0 * row[i] + w1 * row[i + 6] + w2 * row[i + 12] + w3 * row[i + 18],
        w0 * row[i + 1] + w1 * row[i + 7] + w2 * row[i + 13] + w3 * row[i + 19],
        w0 * row[i + 2] + w1 * row[i + 8] + w2 * row[i + 14] + w3 * row[i + 20],
        by_u * (d0 * row[i] + d1 * row[i + 6] + d2 * row[i + 12] + d3 * row[i + 18]),
        by_u * (d0 * row[i + 1] + d1 * row[i + 7] + d2 * row[i + 13] + d3 * row[i + 19]),
        by_u * (d0 * row[i + 2] + d1 * row[i + 8] + d2 * row[i + 14] + d3 * row[i + 20]),
        w0 * row[i + 3] + w1 * row[i + 9] + w2 * row[i + 15] + w3 * row[i + 21],
        w0 * row[i + 4] + w1 * row[i + 10] + w2 * row[i + 16] + w3 * row[i + 22],
        w0 * row[i + 5] + w1 * row[i + 11] + w2 * row[i + 17] + w3 * row[i + 23],
    )


@kernel
def fill_section(
    section: FloatArray,
    functions: int,
    ratio: FloatArray,
    fast: npt.NDArray[np.bool_],
    out: FloatArray,
) -> None:
    """All functions of a section at slip ratios (n,) into ``out`` (functions, n)."""
    for n in range(ratio.size):
        patience(1)
        side, i, place = section_place(ratio[n], fast[n], section, functions)
        weights = basis(place)
        for f in range(functions):
            total = 0.0
            for m, w in enumerate(weights):
                total += w * section[side, i + functions * m + f]
            out[f, n] = total


@inlined
def _side_and_eta(phi: float, sides: FloatArray) -> tuple[int, float]:
    """Side and η ∈ [0, 1] of an angle |φ| ≤ π/2."""
    angle = abs(phi)
    side = 0
    while side < len(sides) - 1 and angle > max(sides[side, 0], sides[side, 1]):
        side += 1
    _, eta = side_and_eta(0.25 * np.pi + angle - sides[side, 0])
    return side, min(eta / abs(sides[side, 2]) ** 0.25, 1.0)


@allocating
def fill_resultants(
    coefficients: FloatArray, sides: FloatArray, phi: FloatArray, delta: FloatArray, out: FloatArray
) -> None:
    """ρ_∥, ρ_⊥, ρ_ω at flat arrays of points into ``out`` (3, n); arguments already checked.

    In blocks of three loops: where and with which weights (vectorised where π/4 is the only line),
    the sums (short dependency chains: one point does not wait for another), the division.
    """
    patience(phi.size)
    n_eta = coefficients.shape[1] - 3
    c = coefficients.reshape(-1)
    side_stride = TERMS * (n_eta + 3)
    one_line = len(sides) == 2
    first = np.empty(_BLOCK, np.int64)
    w0, w1, w2, w3 = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, phi.size, _BLOCK):
        angle = phi[start : start + _BLOCK]
        height = delta[start : start + _BLOCK]
        parallel = out[0, start : start + _BLOCK]
        perpendicular = out[1, start : start + _BLOCK]
        spin = out[2, start : start + _BLOCK]
        if one_line:
            for n in range(angle.size):
                side, eta = side_and_eta(angle[n])
                p = eta * n_eta
                i = cell_at(p, n_eta)
                first[n] = side * side_stride + TERMS * i
                w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        else:
            for n in range(angle.size):
                side, eta = _side_and_eta(angle[n], sides)
                p = eta * n_eta
                i = cell_at(p, n_eta)
                first[n] = side * side_stride + TERMS * i
                w0[n], w1[n], w2[n], w3[n] = basis(p - i)
        for n in range(angle.size):
            k = np.uint64(first[n])  # unsigned: no test for negative indices
            f = c[k : k + np.uint64(4 * TERMS)]
            a, b, d, e = w0[n], w1[n], w2[n], w3[n]
            h = height[n]
            h2 = h * h
            parallel[n] = (
                a * (f[0] + h2 * f[1])
                + b * (f[5] + h2 * f[6])
                + d * (f[10] + h2 * f[11])
                + e * (f[15] + h2 * f[16])
            )
            perpendicular[n] = h * (a * f[2] + b * f[7] + d * f[12] + e * f[17])
            spin[n] = (
                a * (f[3] + h2 * f[4])
                + b * (f[8] + h2 * f[9])
                + d * (f[13] + h2 * f[14])
                + e * (f[18] + h2 * f[19])
            )
        for n in range(angle.size):
            parallel[n] = 1.0 / parallel[n]
            perpendicular[n] *= parallel[n]
            spin[n] *= parallel[n]


@kernel
def section_at(coefficients: FloatArray, delta: float, out: FloatArray) -> None:
    """The section of plain pucks at one height into ``out``, of :func:`room_for_section`."""
    for side in range(coefficients.shape[0]):
        k = HEADER
        for i in range(coefficients.shape[1]):
            row = coefficients[side, i]
            out[side, k] = row[0] + delta * delta * row[1]
            out[side, k + 1] = delta * row[2]
            out[side, k + 2] = row[3] + delta * delta * row[4]
            k += 3


@allocating
def room_for_section(coefficients: FloatArray) -> FloatArray:
    """A section with the header of plain pucks; no rows where there are no coefficients."""
    sides, nodes = coefficients.shape[0], coefficients.shape[1]
    out = np.zeros((sides if nodes > 0 else 0, HEADER + RATIOS * nodes))
    for side in range(out.shape[0]):
        out[side, LINE_COS], out[side, LINE_SIN] = _HALF_ROOT, _HALF_ROOT  # φ = π/4, LINE = 0
        out[side, UPPER_COS] = _HALF_ROOT if side == 0 else 0.0
        out[side, UPPER_SIN] = _HALF_ROOT if side == 0 else 1.0
        out[side, INVERSE_EXTENT], out[side, INERTIA], out[side, PLAIN] = 1.0, 0.5, 1.0
    return out
