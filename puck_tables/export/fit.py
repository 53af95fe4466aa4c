"""The smallest tables of an error: uniform B-splines in ξ, polynomials in 2δ² − 1, whole numbers.

What the stop table holds is fitted again on its own axes (:mod:`puck_tables.stopping.axes`), on
either side of φ = π/4, with the degree, the cells and the powers that cost least.  The B-splines
are a partition of unity: coefficients rounded to whole quanta err by no more than half a quantum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import AccuracyError
from puck_tables.stopping.axes import HEIGHTS, heights
from puck_tables.stopping.stop_table import StopTable

DEGREES = range(3, 8)
CELLS = (
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    11,
    12,
    14,
    16,
    18,
    20,
    22,
    24,
    27,
    30,
    33,
    36,
    40,
    45,
    50,
    56,
    64,
    72,
    80,
    90,
)
# Of the error asked for: of the functions of a stop, and of the curve and its inverse, so that what
# is made of all of them keeps it (measured, tests/test_export_error.py).
STOP_SHARE, CURVE_SHARE, CONSTANT_SHARE = 0.5, 0.3, 0.02
LAW_STOP_SHARE, ORBIT_SHARE, PATCH_SHARE = 0.7, 0.6, 0.25
# Of a share: what whole quanta may take, in a file whose tables are many, and dropped powers.
ROUNDING, COARSE_ROUNDING, _POWERS = 0.1, 0.45, 0.65
_OUT_OF_REACH = "no table to export keeps an error of {:.1e}: ask for a larger one"
# in the order of the programs
STOP_COLUMNS = [0, 1, 2, 3, 4]  # time, along, across, length, body
CURVE_COLUMNS = [5, 6]  # κR and S/δ


@dataclass(frozen=True)
class Fitted:
    """A table of whole numbers as the programs read it.

    ``numbers``: array (sides, cells + degree, powers, functions); times ``quantum``, without the
    factorial of the degree that unscaled B-splines carry, they are coefficients.
    """

    cells: int
    degree: int
    quantum: float
    numbers: npt.NDArray[np.int64]

    @property
    def powers(self) -> int:
        """How many powers of 2δ² − 1."""
        return int(self.numbers.shape[2])


def weights(xi: FloatArray, cells: int, degree: int) -> FloatArray:
    """The B-splines at places ξ, array (places, cells + degree).

    Examples
    --------
    >>> weights(np.array([0.0, 0.5, 1.0]), 2, 3).sum(axis=1).round(12).tolist()
    [1.0, 1.0, 1.0]
    """
    place = xi * cells
    cell = np.minimum(place.astype(np.int64), cells - 1)
    t = place - cell
    here = [np.ones_like(t)]
    for d in range(1, degree + 1):
        parts = [part / d for part in here]
        right = [(r + 1 - t) * part for r, part in enumerate(parts)]
        left = [(t + d - 1 - r) * part for r, part in enumerate(parts)]
        zero = np.zeros_like(t)
        here = [a + b for a, b in zip([*right, zero], [zero, *left], strict=True)]
    matrix = np.zeros((xi.size, cells + degree))
    for r, weight in enumerate(here):
        matrix[np.arange(xi.size), cell + r] = weight
    return matrix


def functions_of(table: StopTable) -> tuple[FloatArray, FloatArray, FloatArray]:
    """What is fitted, at the nodes: stop, curve and inverse, each (2, nodes, heights, functions).

    Both sides from k = 0 to k = 1.
    """
    n = table.axis.cells
    sides = np.stack([table.values[: n + 1], table.values[: n - 1 : -1]])
    splines = table.time_inverse  # (2, nodes + 2, powers)
    at_nodes = splines[:, :-2] + 4.0 * splines[:, 1:-1] + splines[:, 2:]
    s = 2.0 * heights() ** 2 - 1.0
    inverse = at_nodes @ (s ** np.arange(HEIGHTS)[:, None])
    return sides[..., STOP_COLUMNS], sides[..., CURVE_COLUMNS], inverse[..., None]


def fitted(values: FloatArray, error: float, haste: int = 1, rounding: float = ROUNDING) -> Fitted:
    """The cheapest table that is wrong by no more than ``error`` at any node and height.

    Cheapest is the least product of the numbers on an axis and, to the power of ``haste``, of how
    many of them are read for one look-up.

    Parameters
    ----------
    values : array (sides, nodes, heights, functions), nodes uniform in ξ from 0 to 1
    error : in the unit of the values
    haste : how much speed counts against size
    rounding : share of the error that whole quanta may take

    Raises
    ------
    AccuracyError
        If none is good enough.

    Examples
    --------
    >>> xi = np.linspace(0.0, 1.0, 101)[None, :, None, None]
    >>> wave = np.cos(3.0 * xi) * (1.0 + heights()[:, None] ** 2) * np.ones((2, 1, 1, 1))
    >>> found = fitted(wave, 1e-6)
    >>> found.cells, found.degree, found.powers
    (6, 5, 2)
    """
    sides, nodes, count = values.shape[:3]
    xi = np.arange(nodes) / (nodes - 1.0)
    s = 2.0 * heights(count) ** 2 - 1.0
    by_height = np.moveaxis(values, 2, 0).reshape(count, -1)
    series = chebyshev.chebfit(s, by_height, count - 1)
    dropped = np.abs(series)[::-1].cumsum(axis=0)[::-1].max(axis=1)
    powers = int(np.argmax(np.append(dropped, 0.0) <= _POWERS * error))
    if dropped[-1] ** 2 > _POWERS * error * dropped[-2]:  # the next power would be missed
        raise AccuracyError(_OUT_OF_REACH.format(error))
    to_powers = np.zeros((powers, powers))
    for m in range(powers):
        to_powers[: m + 1, m] = chebyshev.cheb2poly(np.eye(powers)[m, : m + 1])
    by_power = (to_powers @ series[:powers]).reshape(powers, sides, nodes, -1)
    wanted = by_power.transpose(1, 2, 0, 3).reshape(sides, nodes, -1)
    quantum = _quantum(rounding * error / powers)
    sizes = np.array([one for one in CELLS if one < nodes // 4])

    def numbers_of(cells: int, degree: int) -> npt.NDArray[np.int64] | None:
        """Those of a table, if it is good enough."""
        matrix = weights(xi, cells, degree)
        solved = np.linalg.lstsq(matrix, np.concatenate(list(wanted), axis=1), rcond=None)[0]
        numbers = np.rint(np.stack(np.split(solved, sides, axis=1)) / quantum)
        got = (matrix @ (quantum * numbers)).reshape(sides, nodes, powers, -1)
        found = np.einsum("snpf,ph->snhf", got, s ** np.arange(powers)[:, None])
        if np.abs(found - values).max() > error:
            return None
        return numbers.astype(np.int64).reshape(sides, cells + degree, powers, -1)

    best: tuple[float, Fitted] | None = None
    for degree in DEGREES:
        low, high = -1, sizes.size  # the more cells, the better the fit
        while high - low > 1:
            middle = (low + high) // 2
            cells = int(sizes[middle])
            numbers = numbers_of(cells, degree)
            if numbers is None:
                low = middle
                continue
            high, cost = middle, (cells + degree) * (degree + 1.0) ** haste
            if best is None or cost < best[0]:
                best = cost, Fitted(cells, degree, quantum, numbers)
    if best is None:
        raise AccuracyError(_OUT_OF_REACH.format(error))
    return best[1]


def fitted_constants(constants: FloatArray, error: float) -> Fitted:
    """Polynomials (rows, powers) in 2δ² − 1 cut to the powers and digits that an error needs.

    As a table of no cells: numbers (rows, 1, powers, 1).
    """
    rows, count = constants.shape
    series = np.zeros((rows, count))
    for row in range(rows):
        polynomial = chebyshev.poly2cheb(constants[row])
        series[row, : polynomial.size] = polynomial
    dropped = np.abs(series)[:, ::-1].cumsum(axis=1)[:, ::-1].max(axis=0)
    powers = max(int(np.argmax(np.append(dropped, 0.0) <= 0.5 * error)), 1)
    kept = np.zeros((rows, powers))
    for row in range(rows):
        polynomial = chebyshev.cheb2poly(series[row, :powers])
        kept[row, : polynomial.size] = polynomial
    quantum = _quantum(error / count)
    whole = np.rint(kept / quantum).astype(np.int64)
    return Fitted(0, 0, quantum, whole.reshape(rows, 1, powers, 1))


def _quantum(largest: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not larger: it prints short."""
    power = 10.0 ** math.floor(math.log10(largest))
    return float(max(n * power for n in (1.0, 2.0, 5.0) if n * power <= largest))
