"""Axes of the stop table: graded in the slip ratio, polynomial in the height.

Slip axis.  On either side of φ = π/4 let k = min(v, r|ω|)/max(v, r|ω|) and 2k/(1 + k) = q⁴.  The
nodes are uniform in ξ ∈ [0, 1] with

    q = ξ (2 − ξ),   so   k ∝ ξ⁴ at φ = 0 and π/2,   1 − k ∝ (1 − ξ)² at π/4.

What is tabulated carries k^(8/(4 + δ²)) and k² ln k at φ = 0, a power between 2 and 4 at π/2, and
x³ ln|x| at π/4; in ξ all of it is smooth enough for a cubic spline with zero end slopes to keep
order 4.  No angle is needed to find the place of a launch: square roots are enough.

Height axis.  Everything tabulated is analytic in δ², for 0 ≤ δ ≤ 1, and held at nine Chebyshev
points of δ².  For the stop itself a polynomial of degree 7 in δ² is enough (1e-12); the curve takes
degree 8 (5e-11).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.errors import InputError
from puck_tables.stopping.lookup import STOP_POWERS, WIDTH
from puck_tables.table.spline_fit import clamped_coefficients

# nodes over δ: the polynomials through them err by 5e-12; and, to 1e-12, for what depends on δ
# alone, as next to the limit its error is magnified:
# test_polynomials_of_the_height_are_as_exact_as_they_say
HEIGHTS = 9
CONSTANT_HEIGHTS = 14
MAX_CELLS = 1 << 16  # of an axis: more is a damaged file


def by_power(nodes: FloatArray, powers: int = HEIGHTS) -> FloatArray:
    """Coefficients (powers, nodes + 2, 2, …) from values (2 sides, nodes, heights, …).

    Powers of 2δ² − 1, ascending; a sixth of the B-splines' weights, from one end of a side to φ =
    π/4.
    """
    splines = clamped_coefficients(np.moveaxis(nodes, 1, 0)) / 6.0  # node, side, height, …
    return height_polynomials(np.moveaxis(splines, 2, 0), powers)


def side_by_side(coefficients: FloatArray) -> FloatArray:
    """Coefficients (power, node, side, function) as (2 sides, nodes, powers × functions)."""
    ordered = coefficients.transpose(2, 1, 0, 3)
    return aligned(ordered.reshape(*ordered.shape[:2], -1))


def section_rows(sides: FloatArray, powers: int) -> FloatArray:
    """Rows (2, nodes + 2, powers × WIDTH) of T, along, across, body (2 sides, nodes, heights, 4).

    All but T have one power fewer.
    """
    times = by_power(sides[..., 0], powers)  # power, node, side
    places = by_power(sides[..., 1:], powers - 1)
    result = np.zeros((2, times.shape[1], powers, WIDTH))
    result[..., 0] = times.transpose(2, 1, 0)
    result[:, :, :-1, 1:] = places.transpose(2, 1, 0, 3)
    return aligned(result.reshape(2, -1, powers * WIDTH))


def at_height(rows: FloatArray, delta: float) -> FloatArray:
    """T, along, δ · across and body at one height, (2, (cells + 3) × WIDTH): of no power."""
    powers = rows.reshape(2, -1, STOP_POWERS, WIDTH)
    result = np.zeros_like(powers[:, :, 0])
    for power in range(STOP_POWERS - 1, -1, -1):
        result = result * (2.0 * delta**2 - 1.0) + powers[:, :, power]
    result[..., 2] *= delta
    return np.ascontiguousarray(result.reshape(2, -1))


@dataclass(frozen=True)
class SlipAxis:
    """The nodes of slip, from pure sliding (φ = 0) over φ = π/4 to pure spin (φ = π/2).

    Parameters
    ----------
    cells : int
        Cells on either side of π/4, at least 8; the axis has ``2 cells + 1`` nodes.

    Examples
    --------
    >>> SlipAxis(8).phi().round(4).tolist()[:5]
    [0.0, 0.0015, 0.0187, 0.0739, 0.1858]
    """

    cells: int

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= MAX_CELLS:
            raise InputError(f"cells must be from 8 to {MAX_CELLS}, got {self.cells}")

    @property
    def size(self) -> int:
        """Number of nodes."""
        return 2 * self.cells + 1

    def ratio(self) -> FloatArray:
        """K at the nodes of one side, from 0 to 1 (φ = π/4)."""
        return ratio_at(np.arange(self.cells + 1) / self.cells)

    def phi(self) -> FloatArray:
        """φ at all nodes, radians, ascending from 0 to π/2."""
        slow = np.arctan(self.ratio())
        return np.concatenate([slow, 0.5 * np.pi - slow[-2::-1]])


def ratio_at(xi: FloatArray) -> FloatArray:
    """The slip ratio k at ξ.

    >>> ratio_at(np.array([0.0, 0.5, 1.0])).round(6).tolist()
    [0.0, 0.187935, 1.0]
    """
    q4 = (xi * (2.0 - xi)) ** 4
    return q4 / (2.0 - q4)


def heights(count: int = HEIGHTS) -> FloatArray:
    """The heights δ at which the stop table holds values: Chebyshev points of δ² on [0, 1].

    >>> heights().round(4).tolist()
    [0.0872, 0.2588, 0.4226, 0.5736, 0.7071, 0.8192, 0.9063, 0.9659, 0.9962]
    """
    return np.sin(0.25 * np.pi * (2.0 * np.arange(count) + 1.0) / count)


def height_polynomials(values: FloatArray, count: int = HEIGHTS) -> FloatArray:
    """Coefficients in powers of 2δ² − 1 from values at the n points of :func:`heights`, axis 0.

    Of the interpolating Chebyshev series the first ``count`` terms are kept, nearly the best
    polynomial of that degree.

    >>> height_polynomials(heights() ** 2, 2).round(12).tolist()
    [0.5, 0.5]
    """
    n = len(values)
    nodes = 2.0 * heights(n) ** 2 - 1.0
    series = chebyshev.chebfit(nodes, values.reshape(n, -1), n - 1)[:count]
    return (series_to_powers(count) @ series).reshape(count, *values.shape[1:])


def series_to_powers(count: int) -> FloatArray:
    """What makes the coefficients of a polynomial from those of its Chebyshev series.

    >>> series_to_powers(3).tolist()  # 1, x, 2x² − 1
    [[1.0, 0.0, -1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]
    """
    matrix = np.zeros((count, count))
    for m, one in enumerate(np.eye(count)):
        matrix[: m + 1, m] = chebyshev.cheb2poly(one[: m + 1])
    return matrix
