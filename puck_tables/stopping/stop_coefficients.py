"""What a stop table holds as compiled code reads it: coefficients of splines, made when asked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.stopping.axes import (
    CONSTANT_HEIGHTS,
    HEIGHTS,
    SlipAxis,
    height_polynomials,
    heights,
)
from puck_tables.stopping.lookup import CURVE_ROW, STOP_POWERS, STOP_ROW
from puck_tables.stopping.similarity import limits
from puck_tables.stopping.slopes import Slopes, slopes_of
from puck_tables.stopping.state_nodes import InverseSolution
from puck_tables.stopping.state_splines import ORBIT_WIDTH, REGULAR, TURN_POWERS, TURN_STEP
from puck_tables.stopping.stop_splines import (
    by_power,
    in_rows,
    inverse_solution_splines,
    inverse_splines,
    section_rows,
    side_by_side,
)
from puck_tables.table.table import Table


@dataclass(frozen=True, eq=False, repr=False)
class StopCoefficients(Table):
    """Coefficients of a stop table, ``values`` (2 cells + 1, 9, 7)."""

    @cached_property
    def axis(self) -> SlipAxis:
        """The slip angles of its nodes."""
        return SlipAxis(len(self.values) // 2)

    @cached_property
    def stop_coefficients(self) -> FloatArray:
        """T, along, across as the kernels of curve_lookup read them."""
        result = by_power(self._sides([0, 1, 2]), STOP_POWERS)
        return in_rows(result, STOP_ROW, power_first=True)

    @cached_property
    def similarity_coefficients(self) -> FloatArray:
        """Body angle, S/δ, path length, κR as the kernels of curve_lookup read them."""
        return in_rows(by_power(self._sides([4, 6, 3, 5])), CURVE_ROW, power_first=False)

    @cached_property
    def constants(self) -> FloatArray:
        """c₀, κ, h₀/δ and ln T(π/4) as polynomials in 2δ² − 1, (4, 14)."""
        rows = []
        for delta in heights(CONSTANT_HEIGHTS):
            at = limits(float(delta))
            rows.append([math.tanh(0.5 * at.u), at.kappa, at.turn / delta])
        polynomials = np.zeros((4, CONSTANT_HEIGHTS))
        polynomials[:3] = height_polynomials(np.array(rows), CONSTANT_HEIGHTS).T
        quarter = np.log(self.values[self.axis.cells, :, 0])
        polynomials[3, :HEIGHTS] = height_polynomials(quarter)
        return polynomials

    @cached_property
    def height_constants(self) -> FloatArray:
        """The same, those of a power side by side, (14, 4)."""
        return np.ascontiguousarray(self.constants.T)

    @cached_property
    def time_inverse(self) -> FloatArray:
        """From the time that is left to the slip ratio."""
        return inverse_splines(self._inverse, with_time=True)

    @cached_property
    def turn_inverse(self) -> FloatArray:
        """From Q to the slip ratio."""
        return inverse_splines(self._inverse, with_time=False)

    @cached_property
    def slopes(self) -> Slopes:
        """What derivatives of stops and states need."""
        return slopes_of(self.axis, self.values)

    @cached_property
    def launch_coefficients(self) -> FloatArray:
        """Body angle, S/δ, κR, path length: as :mod:`known` reads them."""
        return side_by_side(by_power(self._sides([4, 6, 5, 3])))

    @cached_property
    def state_coefficients(self) -> FloatArray:
        """What :mod:`puck_tables.stopping.state_lookup` reads."""
        values = inverse_solution_splines(self._inverse, with_time=True)
        padded = np.zeros((*values.shape[:3], ORBIT_WIDTH))
        padded[..., : values.shape[3]] = values
        return side_by_side(padded)

    @cached_property
    def turn_coefficients(self) -> FloatArray:
        """The heading's regular part over the place by Q, (2, cells + 3, 12)."""
        parts = inverse_solution_splines(self._inverse, with_time=False)[..., REGULAR:]
        return in_rows(parts, TURN_STEP * TURN_POWERS, power_first=True)

    @cached_property
    def _inverse(self) -> InverseSolution:
        return InverseSolution(
            self.axis.cells, self.constants, self.stop_coefficients, self.similarity_coefficients
        )

    def _sides(self, functions: list[int], thinning: int = 1) -> FloatArray:
        """Some functions at the nodes (2, cells + 1, heights, functions), from k = 0 to k = 1."""
        n, values = self.axis.cells // thinning, self.values[::thinning, :, functions]
        return np.stack([values[: n + 1], values[: n - 1 : -1]])

    @cached_property
    def _thinned_tables(self) -> dict[tuple[int, int], FloatArray]:
        return {}

    def thinned(self, powers: int = STOP_POWERS, thinning: int = 1) -> FloatArray:
        """What :func:`puck_tables.stopping.lookup.stops_kernel` reads, as coarse as wanted.

        Parameters
        ----------
        powers : powers of 2δ² − 1 to keep for T; the others keep one fewer, enough for them
        thinning : keep every so many nodes of the slip axis; divides ``axis.cells``

        Returns
        -------
        array (2, cells/thinning + 3, powers × WIDTH)
        """
        if (powers, thinning) in self._thinned_tables:
            return self._thinned_tables[powers, thinning]
        kept = section_rows(self._sides([0, 1, 2, 4], thinning), powers)
        self._thinned_tables[powers, thinning] = kept
        return kept
