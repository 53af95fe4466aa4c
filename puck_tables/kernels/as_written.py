"""Kernels as they are written, in Python: a hundred times slower, but at once.

Where ``NUMBA_DISABLE_JIT=1``, numba's own switch, is set as the package is imported, nothing is
compiled and numba not even imported.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray

BLOCK = 136  # numbers in a row of a block: rows a power of two apart would share cache lines
LINE = 8  # numbers in a line of the cache

# kernels that only kernels call, and whether they are pasted into every caller
behind: dict[Any, bool] = {}


def as_written() -> bool:
    """Whether kernels are to run as they are written."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def weighted_rows(c: FloatArray, k: int, weights: Sequence[float], width: int) -> Any:
    """The sums a·c[k + m] + b·c[k + width + m] + …, m < width, with weights a, b, ….

    >>> weighted_rows(np.arange(6.0), 0, (1.0, 10.0), 3)
    (30.0, 41.0, 52.0)
    """
    rows = c[k : k + len(weights) * width].reshape(-1, width).tolist()
    return tuple(_weighted(weights, rows))


def _weighted(weights: Sequence[float], rows: list[list[float]]) -> list[float]:
    """Weighted rows, added in their order, as compiled code does."""
    total = [weights[0] * one for one in rows[0]]
    for weight, row in zip(weights[1:], rows[1:], strict=True):
        total = [sum_ + weight * one for sum_, one in zip(total, row, strict=True)]
    return total


def _by_powers(
    rows: list[list[float]], s: float, width: int, powers: int
) -> tuple[list[float], list[float]]:
    """Polynomials in s of rows of coefficients, one a power, and their derivatives by s."""
    value, slope = rows[-1], [0.0] * width
    for power in range(powers - 2, -1, -1):
        slope = [one * s + more for one, more in zip(slope, value, strict=True)]
        value = [one * s + more for one, more in zip(value, rows[power], strict=True)]
    return value, slope


def spline_polynomials(
    c: FloatArray, k: int, weights: Sequence[float], s: float, width: int, powers: int
) -> Any:
    """Polynomials in s of weighted rows, as many as width, then their derivatives by s.

    Each row holds ``powers`` times ``width`` coefficients, powers ascending.

    >>> spline_polynomials(np.array([1.0, 2.0, 3.0, 4.0]), 0, (1.0,), 10.0, 2, 2)
    (31.0, 42.0, 3.0, 4.0)
    """
    whole = weighted_rows(c, k, weights, width * powers)
    rows = [list(whole[at : at + width]) for at in range(0, width * powers, width)]
    value, slope = _by_powers(rows, s, width, powers)
    return (*value, *slope)


def spline_slopes(
    c: FloatArray, k: int, weights: Sequence[float], s: float, width: int, powers: int
) -> Any:
    """Splined polynomials in s and their derivatives by s: rows are evaluated, then weighted.

    >>> spline_slopes(np.array([1.0, 2.0, 3.0, 4.0]), 0, (1.0,), 10.0, 2, 2)
    (31.0, 42.0, 3.0, 4.0)
    """
    rows = c[k : k + len(weights) * width * powers].reshape(len(weights), powers, width).tolist()
    result = [_by_powers(row, s, width, powers) for row in rows]
    values, slopes = ([one[n] for one in result] for n in (0, 1))
    return (*_weighted(weights, values), *_weighted(weights, slopes))


def spline_values(
    c: FloatArray, k: int, weights: Sequence[float], s: float, width: int, powers: int
) -> Any:
    """The values alone of :func:`spline_slopes`, from double or single precision.

    >>> spline_values(np.array([1.0, 2.0, 3.0, 4.0]), 0, (1.0,), 10.0, 2, 2)
    (31.0, 42.0)
    """
    return spline_slopes(c, k, weights, s, width, powers)[:width]


def summed(total: float, more: float) -> float:
    """A sum whose order does not matter.

    >>> summed(1.0, 2.0)
    3.0
    """
    return total + more


def bits_of(number: float) -> Any:
    """The integer of the same bits.

    >>> hex(bits_of(1.0))
    '0x3ff0000000000000'
    """
    return struct.unpack("<q", struct.pack("<d", number))[0]


def number_of(bits: int) -> Any:
    """The number of the same bits.

    >>> number_of(0x3FF0000000000000)
    1.0
    """
    return struct.unpack("<d", struct.pack("<q", bits))[0]


def row_of(block: FloatArray, row: int, n: int) -> Any:
    """Number n of a row of a flat array of rows of ``BLOCK`` numbers."""
    return block[row * BLOCK + n].item()


def into_row(block: FloatArray, row: int, n: int, value: float) -> Any:
    """Make the value number n of a row, see :func:`row_of`."""
    block[row * BLOCK + n] = value


def rows_of(block: FloatArray, row: int, count: int, n: int) -> Any:
    """Number n of so many rows from one on, as a tuple."""
    return tuple(block[row * BLOCK + n : (row + count) * BLOCK : BLOCK].tolist())


def into_rows(block: FloatArray, row: int, n: int, values: Sequence[float]) -> Any:
    """Make a tuple number n of so many rows from one on."""
    block[row * BLOCK + n : (row + len(values)) * BLOCK : BLOCK] = values


def into_line(out: FloatArray, at: int, values: Sequence[float]) -> Any:
    """The numbers of a tuple side by side, from one on; as many as fill registers of four."""
    out[at : at + len(values)] = values


def turn_square(
    source: FloatArray, at: int, step: int, out: FloatArray, goal: int, further: int
) -> Any:
    """Four by four numbers turned: rows ``step`` apart to columns, ``further`` apart.

    >>> out = np.zeros(16)
    >>> turn_square(np.arange(24.0), 1, 6, out, 0, 4)
    >>> out.astype(int).tolist()
    [1, 7, 13, 19, 2, 8, 14, 20, 3, 9, 15, 21, 4, 10, 16, 22]
    """
    square = np.stack([source[at + k * step : at + k * step + 4] for k in range(4)])
    for k in range(4):
        out[goal + k * further : goal + k * further + 4] = square[:, k]


def stream_line(source: FloatArray, begin: int, out: FloatArray, at: int) -> Any:
    """Eight numbers from one flat array into another, past the cache where that can be."""
    out[at : at + LINE] = source[begin : begin + LINE]
