"""Spline coefficients of a stop table: over the place on the axis of slip, and over the height."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.stopping.axes import HEIGHTS, height_polynomials
from puck_tables.stopping.lookup import STOP_POWERS, WIDTH
from puck_tables.table.spline_fit import clamped_coefficients


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
