"""The smallest tables of an error: uniform B-splines in ξ, polynomials in 2δ² − 1, whole numbers.

Values on each side of the marks of a law (:mod:`puck_tables.export.law_values`) are fitted with the
degree, the cells, the powers and the digits that cost least.  The B-splines are a partition of
unity: coefficients rounded to whole quanta err by no more than half a quantum.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev
from scipy.interpolate import BSpline, make_lsq_spline

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import AccuracyError
from puck_tables.stopping.lookup import heights, series_to_powers

DEGREES = range(3, 8)
CELLS = (*range(4, 28), *range(28, 48, 2), *range(48, 97, 4), *range(104, 129, 8))
_POWERS = 0.65  # of a share: what dropped powers may take
# quanta that are tried, of the largest that rounding alone would allow; cells beyond the fewest
_QUANTA, _MORE_CELLS = (0.15, 0.25, 0.4, 0.5, 0.65, 0.8, 1.0), 3
_OUT_OF_REACH = "no table to export keeps an error of {:.1e} in some function: ask for a larger tol"


@dataclass(frozen=True)
class SplineFit:
    """A table of whole numbers as the programs read it.

    ``cells``: of each side; ``numbers``: array (rows, powers, functions), cells + degree rows for
    each side; times ``quantum``, without the factorial of the degree that unscaled B-splines carry,
    they are coefficients.
    """

    cells: tuple[int, ...]
    degree: int
    quantum: float
    numbers: npt.NDArray[np.int64]

    @property
    def powers(self) -> int:
        """How many powers of 2δ² − 1."""
        return int(self.numbers.shape[1])

    @property
    def rows(self) -> list[int]:
        """Where the rows of each side begin, and where all end."""
        return [0, *np.cumsum(np.array(self.cells) + self.degree).tolist()]


def spline_fit(
    values: FloatArray, error: float, haste: int = 1, degrees: Iterable[int] = DEGREES
) -> SplineFit:
    """The cheapest table that is wrong by no more than ``error`` at any node and height.

    Cheapest is the least product of the signs that write it and, to the power of ``haste``, of how
    many rows are read for one look-up.

    ``values``: array (sides, nodes, heights, functions), nodes uniform in ξ from 0 to 1; ``error``:
    in the unit of the values; ``haste``: how much speed counts against size; ``degrees``: that are
    tried.

    >>> xi = np.linspace(0.0, 1.0, 101)[None, :, None, None]
    >>> wave = np.cos(3.0 * xi) * (1.0 + heights()[:, None] ** 2) * np.ones((2, 1, 1, 1))
    >>> result = spline_fit(wave, 1e-6)
    >>> result.cells, result.degree, result.powers, result.rows
    ((6, 6), 5, 2, [0, 11, 22])
    """
    fits = _Fits(values, error)
    sides = range(len(values))
    best: tuple[float, SplineFit] | None = None
    for degree in degrees:
        tried = [fits.cells_to_try(side, degree) for side in sides]
        for quantum in fits.quanta(degree):
            parts = [fits.shortest(side, degree, tried[side], quantum) for side in sides]
            if not all(part.size for part in parts):
                continue
            cost = sum(map(_signs, parts)) * (degree + 1.0) ** haste
            if best is None or cost < best[0]:
                cells = tuple(len(numbers) - degree for numbers in parts)
                best = cost, SplineFit(cells, degree, quantum, np.concatenate(parts))
    if best is None:
        raise AccuracyError(_OUT_OF_REACH.format(error))
    return best[1]


def spline_fits(values: FloatArray, error: float) -> list[SplineFit]:
    """A table for each side, of powers and digits of its own; all of one degree, the cheapest.

    >>> xi = np.linspace(0.0, 1.0, 101)[:, None, None]
    >>> flat, high = np.cos(xi) + 0.0 * heights()[:, None], np.cos(xi) * heights()[:, None] ** 4
    >>> [(one.cells, one.powers) for one in spline_fits(np.stack([flat, high]), 1e-6)]
    [((4,), 1), ((4,), 3)]
    """
    best: list[SplineFit] = []
    for degree in DEGREES:
        try:
            result = [spline_fit(side[None], error, degrees=[degree]) for side in values]
        except AccuracyError:
            continue
        if not best or _cost(result) < _cost(best):
            best = result
    if not best:
        raise AccuracyError(_OUT_OF_REACH.format(error))
    return best


def _cost(tables: list[SplineFit]) -> float:
    return sum(_signs(table.numbers) * (table.degree + 1.0) for table in tables)


def _knots(cells: int, degree: int) -> FloatArray:
    """Uniform knots of B-splines over 0 to ``cells``, no end among them repeated."""
    return np.arange(-degree, cells + degree + 1.0)


class _Fits:
    """Fits of values within an error."""

    def __init__(self, values: FloatArray, error: float) -> None:
        self._values, self._error = values, error
        sides, nodes, count = values.shape[:3]
        s = 2.0 * heights(count) ** 2 - 1.0
        by_height = np.moveaxis(values, 2, 0).reshape(count, -1)
        series = chebyshev.chebfit(s, by_height, count - 1)
        dropped = np.abs(series)[::-1].cumsum(axis=0)[::-1].max(axis=1)
        powers = int(np.argmax(np.append(dropped, 0.0) <= _POWERS * error))
        if dropped[-1] ** 2 > _POWERS * error * dropped[-2]:  # the next power would be missed
            raise AccuracyError(_OUT_OF_REACH.format(error))
        by_power = (series_to_powers(powers) @ series[:powers]).reshape(powers, sides, nodes, -1)
        self._wanted = by_power.transpose(2, 1, 0, 3)  # nodes, sides, powers, functions
        self._at_heights = s ** np.arange(powers)[:, None]
        # between fewer nodes a spline may err by more than at them
        self._sizes = [one for one in CELLS if one <= nodes // 8]
        self._solved: dict[tuple[int, int], FloatArray] = {}

    def quanta(self, degree: int) -> list[float]:
        """What is tried: short numbers when the factorial of the degree is taken out."""
        whole = math.factorial(degree)
        largest = 2.0 * self._error / len(self._at_heights) / whole
        return [whole * float(f"{share * largest:.2g}") for share in _QUANTA]

    def cells_to_try(self, side: int, degree: int) -> list[int]:
        """The fewest cells that are good enough, and the next: the more cells, the better."""
        low, high = -1, len(self._sizes)
        while high - low > 1:
            middle = (low + high) // 2
            exact = self._solution(degree, self._sizes[middle])
            if self._is_good(degree, exact[:, side], side):
                high = middle
            else:
                low = middle
        return self._sizes[high : high + _MORE_CELLS]

    def shortest(
        self, side: int, degree: int, tried: list[int], quantum: float
    ) -> npt.NDArray[np.int64]:
        """The numbers of a side with the fewest signs; none if none are good."""
        good = []
        for cells in tried:
            exact = self._solution(degree, cells)
            whole = np.rint(exact[:, side] / quantum)
            if self._is_good(degree, quantum * whole, side):
                good.append(whole.astype(np.int64))
        return min(good, key=_signs, default=np.empty(0, np.int64))

    def _solution(self, degree: int, cells: int) -> FloatArray:
        """The best coefficients (cells + degree, sides, powers, functions) in least squares."""
        if (degree, cells) not in self._solved:
            nodes = np.linspace(0.0, cells, len(self._wanted))
            wanted = self._wanted.reshape(len(nodes), -1)
            best = make_lsq_spline(nodes, wanted, _knots(cells, degree), degree).c
            self._solved[degree, cells] = best.reshape(-1, *self._wanted.shape[1:])
        return self._solved[degree, cells]

    def _is_good(self, degree: int, coefficients: FloatArray, side: int) -> bool:
        """Whether a spline of one side is within the error at all nodes and heights."""
        cells = len(coefficients) - degree
        spline = BSpline(_knots(cells, degree), coefficients, degree)
        at_nodes = spline(np.linspace(0.0, cells, len(self._wanted)))
        result = np.einsum("npf,ph->nhf", at_nodes, self._at_heights)
        return bool(np.abs(result - self._values[side]).max() <= self._error)


def _signs(numbers: npt.NDArray[np.int64]) -> int:
    """How many signs write numbers, each with its comma."""
    return sum(len(str(number)) + 1 for number in numbers.ravel().tolist())


def fit_constants(constants: FloatArray, error: float) -> SplineFit:
    """Polynomials (rows, powers) in 2δ² − 1 cut to the powers and digits that an error needs.

    As a table without cells: numbers (rows, powers, 1).
    """
    rows, count = constants.shape
    series = np.linalg.solve(series_to_powers(count), constants.T).T
    dropped = np.abs(series)[:, ::-1].cumsum(axis=1)[:, ::-1].max(axis=0)
    powers = max(int(np.argmax(np.append(dropped, 0.0) <= 0.5 * error)), 1)
    kept = series[:, :powers] @ series_to_powers(powers).T
    quantum = _quantum(error / count)
    whole = np.rint(kept / quantum).astype(np.int64)
    return SplineFit((), 0, quantum, whole.reshape(rows, powers, 1))


def _quantum(largest: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not larger: it prints short."""
    power = 10.0 ** math.floor(math.log10(largest))
    return float(max(n * power for n in (1.0, 2.0, 5.0) if n * power <= largest))
