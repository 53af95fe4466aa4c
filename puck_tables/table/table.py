"""A table in memory: axes, node values, passport and the spline through them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import checked_phi
from puck_tables.contact.resultants import Resultants, checked_delta
from puck_tables.errors import InputError
from puck_tables.real import broadcast
from puck_tables.table.fit import quadratic_coefficients, table_coefficients
from puck_tables.table.grid import DeltaAxis, PhiAxis

FloatArray = npt.NDArray[np.float64]

FUNCTIONS = ("parallel", "perpendicular", "spin")


@dataclass(frozen=True)
class Accuracy:
    """Errors of a table that were measured, not promised; dimensionless.

    One entry a function in the order of :data:`FUNCTIONS`: largest, root mean square and 99.9 %
    error over random and adversarial points, where the largest stands, the largest residual at
    the closed-form entries φ = 0, π/4, π/2, and the order against a grid of half as many cells.
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    p999: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_delta: tuple[float, ...]
    entry_residual: float
    order: float
    points: int

    @property
    def worst(self) -> float:
        """The largest error of the three resultants."""
        return max(self.largest)


@dataclass(frozen=True)
class Table:
    """Friction resultants on a (φ, δ) grid with the bicubic spline through them.

    Parameters
    ----------
    phi_axis, delta_axis
        The axes.
    values : array (n_phi, n_delta, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes.
    tolerance : float
        The error the table promises; 0 while it is not known.
    accuracy : Accuracy or None
        The errors that were measured when it was built.
    passport : dict
        What else its file says: format, pressure law, provenance, digests.
    source : str
        Where it came from, for messages.
    """

    phi_axis: PhiAxis
    delta_axis: DeltaAxis
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
    def coefficients(self) -> FloatArray:
        """Spline coefficients as the kernels read them, fitted at first use; read-only."""
        fitted = table_coefficients(self.values)
        fitted.flags.writeable = False
        return fitted

    @cached_property
    def quadratic(self) -> FloatArray | None:
        """The same where the height enters as a polynomial of degree 2, else None; read-only."""
        fitted = quadratic_coefficients(self.values, self.delta_axis.nodes())
        if fitted is not None:
            fitted.flags.writeable = False
        return fitted

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table.

        Raises
        ------
        InputError
            If a height is not finite, negative or above the largest of the table.
        """
        height = checked_delta(delta)
        if not np.all(height <= self.delta_axis.upper):
            raise InputError(
                f"delta = {height[height > self.delta_axis.upper].flat[0]!s} is outside this table "
                f"(0 <= delta <= {self.delta_axis.upper:g}): the linear pressure law of full "
                "contact holds at every phi only up to 1; where it still holds beyond, "
                "use the closed forms (--exact)"
            )
        return height

    def resultants(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Interpolated resultants ρ_∥, ρ_⊥, ρ_ω.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like, dimensionless, in the table's range
            Broadcast against ``phi``.

        Returns
        -------
        Resultants
            Dimensionless arrays of the broadcast shape; ``accuracy`` says how exact.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range; nothing is extrapolated.

        Notes
        -----
        Cubic splines in φ times polynomials of degree 2 in δ where the nodes allow it, as those of
        full contact do (:mod:`puck_tables.kernels.quadratic`), else bicubic
        (:mod:`puck_tables.kernels.spline`).  The resultants: Salnikova, Treschev, Gallyamov 2012,
        section 6.

        Examples
        --------
        >>> from puck_tables import load_table
        >>> float(load_table().resultants(0.0, 0.5).perpendicular.round(12))
        0.125
        """
        from puck_tables.kernels.quadratic import fill_resultants_quadratic
        from puck_tables.kernels.spline import fill_resultants

        angle, height = broadcast(phi=checked_phi(phi), delta=self.checked_range(delta))
        out = np.empty((3, angle.size))
        phi_, delta_ = (np.ascontiguousarray(axis).reshape(-1) for axis in (angle, height))
        if self.quadratic is not None:
            fill_resultants_quadratic(self.quadratic, phi_, delta_, out)
        else:
            fill_resultants(self.coefficients, self.delta_axis.upper, phi_, delta_, out)
        return Resultants(*(row.reshape(angle.shape) for row in out))
