"""Splines over the slip angle alone, as fine as asked: how friction and stops of one puck are kept.

The functions are known wherever they are asked for, at some cost.  The axis
(:mod:`puck_tables.table.slip_axis`) is refined by halving its cells, so that what was computed to
measure the error of one level, the functions in the middles of the cells, are nodes of the next.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import slip_direction
from puck_tables.errors import AccuracyError
from puck_tables.kernels.section_spline import (
    HEADER,
    INERTIA,
    INVERSE_EXTENT,
    LINE,
    LINE_COS,
    LINE_SIN,
    UPPER_COS,
    UPPER_SIN,
    fill_section,
)
from puck_tables.table.accuracy import Accuracy
from puck_tables.table.slip_axis import Side, graded
from puck_tables.table.spline_fit import sided_coefficients

Functions = Callable[[FloatArray], FloatArray]  # of φ (n,), as (n, functions)

COARSEST_CELLS, FINEST_CELLS = 16, 2048  # a side, doubled between


@dataclass(frozen=True)
class SlipSpline:
    """Functions of φ ∈ [0, π/2] by cubic splines between singular lines.

    Parameters
    ----------
    sides : tuple of Side
    values : array (sides, cells + 1, functions)
        At the nodes, from each line outwards.
    even : whether the functions are even about φ = 0 and π/2 (and these no singular lines)
    accuracy : Accuracy, optional
        The errors in the middles of the cells; none while they are not known.
    """

    sides: tuple[Side, ...]
    values: FloatArray = field(repr=False)
    even: bool
    accuracy: Accuracy | None = None

    @property
    def error(self) -> FloatArray:
        """The largest error of each function."""
        if self.accuracy is None:
            return np.full(self.values.shape[2], np.inf)
        return np.array(self.accuracy.largest)

    @property
    def cells(self) -> int:
        """Cells on each side."""
        return int(self.values.shape[1]) - 1

    @cached_property
    def coefficients(self) -> FloatArray:
        """The matrix that :mod:`puck_tables.kernels.section_spline` reads; inertia left 0."""
        rows = np.zeros((len(self.sides), HEADER + self.values.shape[2] * (self.cells + 3)))
        rows[:, HEADER:] = sided_coefficients(self.values, self.even).reshape(len(rows), -1) / 6.0
        for n, side in enumerate(self.sides):
            upper = max(side.line, side.end)
            rows[n, LINE_COS], rows[n, LINE_SIN] = _direction(side.line)
            rows[n, LINE] = _log_tangent(side.line)
            rows[n, UPPER_COS], rows[n, UPPER_SIN] = _direction(upper)
            rows[n, INVERSE_EXTENT] = 1.0 / abs(side.extent)
        return rows

    def at(self, phi: FloatArray) -> FloatArray:
        """The functions at slip angles (n,), radians, as (n, functions)."""
        direction = slip_direction(phi)
        out = np.empty((self.values.shape[2], phi.size))
        fill_section(
            self.coefficients, self.values.shape[2], direction.ratio, direction.fast_spin, out
        )
        return out.T

    def coarser(self) -> SlipSpline:
        """The spline through every other node."""
        return SlipSpline(self.sides, self.values[:, ::2], self.even)

    def with_inertia(self, square: float, factors: FloatArray) -> FloatArray:
        """Its :attr:`coefficients` with this inertia, the functions multiplied by ``factors``."""
        rows = self.coefficients.copy()
        rows[:, INERTIA] = square
        rows[:, HEADER:] *= np.tile(factors, self.cells + 3)
        return rows


def _direction(phi: float) -> tuple[float, float]:
    if phi == 0.25 * math.pi:
        return math.sqrt(0.5), math.sqrt(0.5)  # equal, so that their difference is exact there
    return (0.0, 1.0) if phi == 0.5 * math.pi else (math.cos(phi), math.sin(phi))


def _log_tangent(phi: float) -> float:
    cosine, sine = _direction(phi)
    if sine == 0.0 or cosine == 0.0:
        return math.copysign(math.inf, sine - cosine)
    return math.log(sine / cosine)


def slip_spline(
    functions: Functions, sides: tuple[Side, ...], accuracy: float, even: bool,
    counted: slice = slice(None), weights: Functions | None = None, finest: int = FINEST_CELLS,
) -> SlipSpline:  # fmt: skip
    """Splines of these functions, refined until they are as good as asked.

    Parameters
    ----------
    functions : callable, φ (n,) → (n, functions)
    sides : tuple of Side
    accuracy : the largest error allowed in the middle of a cell
    even : see :class:`SlipSpline`
    counted : of which functions it must hold
    weights : what the errors of the functions are multiplied with before they are judged
    finest : the most cells on a side

    Notes
    -----
    The error falls like cells⁻⁴.

    Examples
    --------
    >>> from puck_tables.table.slip_axis import sides_of
    >>> found = slip_spline(lambda phi: np.cos(phi)[:, None] ** 2, sides_of([1.0]), 1e-6, True)
    >>> found.cells, float(found.at(np.array([0.5]))[0, 0].round(6))
    (64, 0.770151)
    """
    for spline, xi, off in refinements(functions, sides, even, COARSEST_CELLS, finest):
        if weights is not None:
            off *= _at(weights, sides, xi)
        worst = float(off[..., counted].max())
        if worst <= accuracy:
            errors, phi = off.reshape(-1, off.shape[2]).T, graded(sides, xi).ravel()
            return replace(spline, accuracy=Accuracy.of(errors, phi, 0.0 * phi, None))
    raise AccuracyError(
        f"an accuracy of {accuracy:.1g} is out of reach for this puck: {spline.cells} cells give "
        f"{worst:.1e}; ask for less",
        reachable=worst,
    )


def refinements(
    functions: Functions, sides: tuple[Side, ...], even: bool, coarsest: int, finest: int
) -> Iterator[tuple[SlipSpline, FloatArray, FloatArray]]:
    """Splines of from ``coarsest`` to ``finest`` cells a side, doubled between.

    With the ξ of the middles of their cells, and how far off the functions are there, (sides,
    cells, functions).
    """
    cells = coarsest
    values = _at(functions, sides, np.arange(cells + 1) / cells)
    while True:
        spline = SlipSpline(sides, values, even)
        xi = (np.arange(cells) + 0.5) / cells
        between = _at(functions, sides, xi)
        guess = spline.at(graded(sides, xi).ravel()).reshape(between.shape)
        yield spline, xi, np.abs(guess - between)
        if 2 * cells > finest:
            return
        finer = np.empty((len(sides), 2 * cells + 1, values.shape[2]))
        finer[:, ::2], finer[:, 1::2] = values, between
        values, cells = finer, 2 * cells


def _at(functions: Functions, sides: tuple[Side, ...], xi: FloatArray) -> FloatArray:
    """The functions at ξ on every side, (sides, ξ, functions)."""
    phi = graded(sides, xi)
    return functions(phi.ravel()).reshape(*phi.shape, -1)
