"""Spline coefficients of a stop table: over the place on the axis of slip, and over the height."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.stopping.axes import HEIGHTS, height_polynomials
from puck_tables.stopping.lookup import STOP_POWERS, WIDTH
from puck_tables.stopping.state_nodes import InverseSolution
from puck_tables.table.spline_fit import clamped_coefficients


def by_power(nodes: FloatArray, powers: int = HEIGHTS) -> FloatArray:
    """Coefficients (powers, nodes + 2, 2, …) from values (2 sides, nodes, heights, …).

    Powers of 2δ² − 1, ascending; a sixth of the B-splines' weights, from one end of a side to φ =
    π/4.

    Examples
    --------
    >>> by_power(np.ones((2, 4, HEIGHTS))).shape
    (9, 6, 2)
    """
    splines = clamped_coefficients(np.moveaxis(nodes, 1, 0)) / 6.0  # node, side, height, …
    return height_polynomials(np.moveaxis(splines, 2, 0), powers)


def side_by_side(coefficients: FloatArray) -> FloatArray:
    """Coefficients (power, node, side, function) as (2 sides, nodes, powers × functions).

    Examples
    --------
    >>> side_by_side(np.zeros((9, 6, 2, 4))).shape
    (2, 6, 36)
    """
    ordered = coefficients.transpose(2, 1, 0, 3)
    return aligned(ordered.reshape(*ordered.shape[:2], -1))


def in_rows(coefficients: FloatArray, row: int, power_first: bool) -> FloatArray:
    """Coefficients (power, node, side, function) as (2 sides, nodes, row), filled up by zeros.

    ``power_first``: by power, and in each by function; else the other way round.

    Examples
    --------
    >>> in_rows(np.ones((9, 6, 2, 3)), 32, power_first=True).sum(axis=2).tolist()[0]
    [27.0, 27.0, 27.0, 27.0, 27.0, 27.0]
    """
    ordered = coefficients.transpose((2, 1, 0, 3) if power_first else (2, 1, 3, 0))
    flat = ordered.reshape(*ordered.shape[:2], -1)
    padded = np.zeros((*flat.shape[:2], row))
    padded[:, :, : flat.shape[2]] = flat
    return aligned(padded)


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


def inverse_splines(solution: InverseSolution, with_time: bool) -> FloatArray:
    """From the time that is left, or from Q, to the slip ratio, (2, cells + 3, 9)."""
    ratios = solution.ratios(with_time)
    return np.ascontiguousarray(by_power(ratios).transpose(2, 1, 0))


def inverse_solution_splines(solution: InverseSolution, with_time: bool) -> FloatArray:
    """The functions of an orbit over the place by time or Q: (power, node, side, function)."""
    return by_power(solution.splined(with_time))


def at_height(rows: FloatArray, delta: float) -> FloatArray:
    """T, along, δ · across and body at one height, (2, (cells + 3) × WIDTH): of no power any more.

    Examples
    --------
    >>> from puck_tables import Table
    >>> at_height(Table.shipped("stops").thinned(), 0.5).shape[0]
    2
    """
    powers = rows.reshape(2, -1, STOP_POWERS, WIDTH)
    result = np.zeros_like(powers[:, :, 0])
    for power in range(STOP_POWERS - 1, -1, -1):
        result = result * (2.0 * delta**2 - 1.0) + powers[:, :, power]
    result[..., 2] *= delta
    return np.ascontiguousarray(result.reshape(2, -1))
