"""A table of friction with a coefficient that depends on the slip speed, and its look-up."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import PatchIntegrals, checked_phi, slip_direction
from puck_tables.contact.resultants import Resultants, moment_balance, pressure_tilt
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import (
    checked_height_ratio,
    checked_speed,
    fastest,
    refuse_lifting,
)
from puck_tables.errors import InputError
from puck_tables.kernels.speed_spline import DONE, fill_speed, packed
from puck_tables.real import broadcast
from puck_tables.table.speed_fit import quintic_coefficients
from puck_tables.table.speed_grid import Patch, patches_of

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

INTEGRALS = ("p_a", "p_b", "p_d", "p_e")


@dataclass(frozen=True)
class SpeedAccuracy:
    """Errors of a table against quadrature, measured, in units of the largest f of the law.

    One entry for each of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e: largest, root mean square
    and 99.9 % error over random points in every patch, and where the largest stands (φ, and
    v + r|ω| in m/s).
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    p999: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_speed: tuple[float, ...]
    points: int

    @property
    def worst(self) -> float:
        """The largest of the four largest errors."""
        return max(self.largest)


@dataclass(frozen=True)
class SpeedTable:
    """The friction integrals at all slips of one law f(|u|), for pucks of every height.

    Parameters
    ----------
    breaks : array (k + 1,), m/s
        Speeds from 0 to the top between which the patches lie.
    cells : integer array (patches, 2)
        Cells along ξ and ζ of every patch, see :mod:`puck_tables.kernels.speed_spline`.
    values : array (nodes, 4)
        p_a, p_b, p_d, p_e at the nodes of all patches, one after the other, ζ running fastest.
    largest_f : float
        Largest f of the law up to the top, the unit of the errors.
    law : SpeedLaw, optional
        The friction law; none if it was given as a function.
    tolerance, accuracy, passport, source
        As in :class:`puck_tables.table.table.Table`; errors in units of ``largest_f``.
    """

    breaks: FloatArray
    cells: IntArray = field(repr=False)
    values: FloatArray = field(repr=False)
    largest_f: float
    law: SpeedLaw | None = None
    tolerance: float = 0.0
    accuracy: SpeedAccuracy | None = None
    passport: dict[str, Any] = field(default_factory=dict, repr=False)
    source: str = "memory"

    @property
    def top(self) -> float:
        """The fastest slip v + r|ω| of the table, m/s."""
        return float(self.breaks[-1])

    @cached_property
    def patches(self) -> tuple[Patch, ...]:
        """Its patches, in the order of ``cells``."""
        return patches_of(self.breaks)

    @cached_property
    def compiled(self) -> FloatArray:
        """As :func:`puck_tables.kernels.speed_spline.packed` has it."""
        return packed(self.breaks, self.cells, [quintic_coefficients(v) for v in self.by_patch()])

    def by_patch(self) -> list[FloatArray]:
        """Node values of every patch, (ξ nodes, ζ nodes, 4)."""
        sizes = (self.cells + 1).prod(axis=1)
        parts = np.split(self.values, np.cumsum(sizes)[:-1])
        shapes = (self.cells + 1).tolist()
        return [part.reshape(u, w, 4) for part, (u, w) in zip(parts, shapes, strict=True)]

    def integrals(self, phi: npt.ArrayLike, speed: npt.ArrayLike) -> PatchIntegrals:
        """The interpolated integrals, see :func:`puck_tables.contact.speed_quadrature`.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        speed : array_like, m/s
            Q = hypot(v, rω), broadcast against ``phi``; v + r|ω| within the table.

        Raises
        ------
        InputError
            If an argument is out of range; nothing is extrapolated.
        """
        angle, Q = broadcast(phi=checked_phi(phi), speed=checked_speed(speed))
        direction = slip_direction(angle)
        out = np.empty((4, angle.size))
        status = fill_speed(
            self.compiled, np.ravel(direction.ratio), np.ravel(direction.fast_spin),
            np.ravel(Q).copy(), out,
        )  # fmt: skip
        if status != DONE:
            raise InputError(
                f"the fastest slip v + r|omega| = {float(fastest(direction, Q).max()):g} m/s is "
                f"outside this table (0 to {self.top:g} m/s)"
            )
        a, b, d, e = (row.reshape(angle.shape) for row in out)
        return PatchIntegrals(a, b, b - d, d, e)

    def resultants(
        self, phi: npt.ArrayLike, speed: npt.ArrayLike, height_ratio: float = 0.0
    ) -> Resultants:
        """Interpolated friction.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        speed : array_like, m/s
            Q = hypot(v, rω), broadcast against ``phi``; v + r|ω| within the table.
        height_ratio : float
            2h/r ≥ 0; times a constant f it is δ.

        Returns
        -------
        Resultants
            F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ), f included.

        Raises
        ------
        InputError
            If an argument is out of range; nothing is extrapolated.
        ContactError
            If part of the base would have to be pulled down.

        Examples
        --------
        >>> from puck_tables import build_speed_table
        >>> table = build_speed_table(lambda u: 0.2 + 0.1 * u, top_speed=2.0, accuracy=1e-4)
        >>> float(table.resultants(0.0, 1.0).parallel.round(4))  # a puck that only slides: f(v)
        0.3
        """
        g = checked_height_ratio(height_ratio)
        p = self.integrals(phi, speed)
        direction = slip_direction(np.broadcast_to(checked_phi(phi), p.a.shape))
        rho = moment_balance(p, direction, g)
        refuse_lifting(pressure_tilt(rho, direction, g), g)
        return rho

    def refuse_height(self, height_ratio: float) -> None:
        """Refuse a puck part of whose base would lift anywhere in the table.

        Raises
        ------
        ContactError
        """
        cells = self.cells.tolist()
        tilts = []
        for patch, values, (u, w) in zip(self.patches, self.by_patch(), cells, strict=True):
            xi, zeta = np.arange(u + 1)[:, None] / u, np.arange(w + 1) / w
            direction, _ = patch.place(xi, zeta)
            a, b, d, e = np.moveaxis(values, -1, 0)
            rho = moment_balance(PatchIntegrals(a, b, b - d, d, e), direction, height_ratio)
            tilts.append(pressure_tilt(rho, direction, height_ratio).max())
        refuse_lifting(np.array(tilts), height_ratio)
