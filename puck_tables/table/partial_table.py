"""A table of partial contact in memory: node values, passport and the splines through them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact import closed_form
from puck_tables.contact.integrals import checked_phi, slip_direction
from puck_tables.contact.one_sided import checked_height
from puck_tables.contact.opening import critical_delta
from puck_tables.contact.resultants import Resultants, moment_balance
from puck_tables.errors import ContactError
from puck_tables.real import broadcast
from puck_tables.table.fit import clamped_coefficients, half_clamped_coefficients
from puck_tables.table.partial_grid import (
    FAST_END,
    TOP_DELTA,
    UPPER_DELTA,
    ZETA_END,
    PartialAxes,
)
from puck_tables.table.table import Accuracy

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PartialTable:
    """Friction resultants of one-sided contact, δ_c(φ) ≤ δ ≤ 3.9, with the spline through them.

    Parameters
    ----------
    axes : PartialAxes
    values : array (*axes.shape, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes.
    tolerance : float
        The error the table promises; 0 while it is not known.
    accuracy : Accuracy or None
        The errors that were measured when it was built.
    passport : dict
        What else its file says.
    source : str
        Where it came from, for messages.
    """

    axes: PartialAxes
    values: FloatArray = field(repr=False)
    tolerance: float = 0.0
    accuracy: Accuracy | None = None
    passport: dict[str, Any] = field(default_factory=dict, repr=False)
    source: str = "memory"

    def __post_init__(self) -> None:
        values = self.values.view()
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    @cached_property
    def spline(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Coefficients, opening and ends as :mod:`puck_tables.kernels.partial_spline` reads them.

        Read-only; fitted at first use.  Slopes in η vanish at π/4 and at φ = 0, and those in ζ
        where contact opens; the other ends are not-a-knot.
        """
        phi, middle = self.axes.phi()[:, None], self.axes.cells
        full = moment_balance(closed_form.integrals(phi), slip_direction(phi), self.axes.delta())
        along_eta = _sided(self.values - np.stack(full, axis=-1))
        along_zeta = half_clamped_coefficients(np.moveaxis(along_eta, 2, 0))
        critical = critical_delta(phi[:, 0])
        ends = [1.0, FAST_END**0.25, ZETA_END, critical[middle], TOP_DELTA]
        fitted = (
            np.ascontiguousarray(along_zeta.transpose(1, 0, 2, 3)) / 36.0,
            _sided(critical**-2.0) / 6.0,
            np.array(ends),
        )
        for array in fitted:
            array.flags.writeable = False
        return fitted

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table.

        Raises
        ------
        InputError
            If a height is not finite or negative.
        ContactError
            If it is above 3.9, or so high that the puck tips.
        """
        height = checked_height(delta)
        if not np.all(height <= UPPER_DELTA):
            raise ContactError(
                f"delta = {height[height > UPPER_DELTA].flat[0]:g} is outside the table of partial "
                f"contact (0 <= delta <= {UPPER_DELTA:g}): next to tipping (delta = 4) use the "
                "balance itself (puck_tables.contact.one_sided)"
            )
        return height

    def resultants(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Resultants ρ_∥, ρ_⊥, ρ_ω of full and partial contact.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like, dimensionless, in [0, 3.9]
            Broadcast against ``phi``.

        Returns
        -------
        Resultants
            Dimensionless arrays of the broadcast shape: in partial contact as exact as
            ``accuracy`` says, in full contact by closed forms, 1e-14.

        Raises
        ------
        InputError, ContactError
            If an argument is not finite or outside its range; nothing is extrapolated.

        Notes
        -----
        Bicubic spline, see :mod:`puck_tables.kernels.partial_spline`.  The one-sided balance:
        :mod:`puck_tables.contact.one_sided`.

        Examples
        --------
        >>> from puck_tables.table.partial_file import load_partial_table
        >>> float(load_partial_table().resultants(0.5, 2.0).parallel.round(5))
        1.08132
        """
        from puck_tables.kernels.partial_spline import fill_partial

        angle, height = broadcast(phi=checked_phi(phi), delta=self.checked_range(delta))
        out = np.empty((3, angle.size))
        fill_partial(
            *self.spline,
            np.ascontiguousarray(angle).reshape(-1),
            np.ascontiguousarray(height).reshape(-1),
            out,
        )
        return Resultants(*(row.reshape(angle.shape) for row in out))


def _sided(values: FloatArray) -> FloatArray:
    """Coefficients along η of both sides of π/4: even about it, and about φ = 0."""
    middle = len(values) // 2
    return np.stack(
        [clamped_coefficients(values[middle::-1]), half_clamped_coefficients(values[middle:])]
    )
