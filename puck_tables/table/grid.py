"""Graded axes of the table: an explicit map between node number and value, no search.

φ axis.  With τ = tan(φ − π/4) = (r|ω| − v)/(r|ω| + v) ∈ [−1, 1], the 2n + 1 nodes are

    τ_i = sign(ξ_i) ξ_i⁴,   ξ_i = (i − n)/n,   i = 0 … 2n:   φ_0 = 0, φ_n = π/4, φ_2n = π/2.

The resultants behave like x² ln|x| at φ = π/4 (the instantaneous centre of rotation crosses the
rim) and are analytic elsewhere.  The fourth power crowds the nodes there, so that a cubic spline
in ξ on either side keeps order 4; a square is not enough (its slope tends to 4 only like
4 − 1/ln n), a cube needs a cube root.

δ axis.  Uniform: in full contact the splined ratios are polynomials of degree ≤ 2 in δ, exact on
the four nodes that a cubic needs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import SlipDirection
from puck_tables.errors import InputError

FloatArray = npt.NDArray[np.float64]

GRADING_POWER = 4
MAX_NODES = 1 << 22
MAX_DELTA_NODES = 1025


@dataclass(frozen=True)
class PhiAxis:
    """The graded axis of slip angles, φ from 0 to π/2.

    Parameters
    ----------
    size : int
        Number of nodes, odd (π/4 is the middle one) and at least 9.

    Examples
    --------
    >>> PhiAxis(9).nodes().round(4).tolist()
    [0.0, 0.479, 0.723, 0.7815, 0.7854, 0.7893, 0.8478, 1.0918, 1.5708]
    """

    size: int

    def __post_init__(self) -> None:
        if self.size < 9 or self.size % 2 == 0 or self.size > MAX_NODES:
            raise InputError(
                f"n_phi must be odd (pi/4 is the middle node), from 9 to {MAX_NODES - 1}, "
                f"got {self.size}"
            )

    @property
    def cells_per_side(self) -> int:
        """n: cells on either side of π/4."""
        return self.size // 2

    def tau(self) -> FloatArray:
        """tan(φ − π/4) at the nodes."""
        n = self.cells_per_side
        xi = np.arange(-n, n + 1) / n
        tau: FloatArray = np.sign(xi) * np.abs(xi) ** GRADING_POWER
        return tau

    def nodes(self) -> FloatArray:
        """φ at the nodes, radians, ascending; 0, π/4 and π/2 exactly."""
        phi = 0.25 * np.pi + np.arctan(self.tau())
        phi[0], phi[-1] = 0.0, 0.5 * np.pi
        return phi

    def slip_direction(self) -> SlipDirection:
        """The nodes as slip directions, without rounding through an angle."""
        tau = self.tau()
        return SlipDirection((1.0 - np.abs(tau)) / (1.0 + np.abs(tau)), tau > 0.0)


@dataclass(frozen=True)
class DeltaAxis:
    """The uniform axis of dimensionless heights, δ from 0 to ``upper``.

    Parameters
    ----------
    size : int
        Number of nodes, at least 4.
    upper : float
        The largest δ of the table.

    Examples
    --------
    >>> DeltaAxis(5).nodes().tolist()
    [0.0, 0.25, 0.5, 0.75, 1.0]
    """

    size: int
    upper: float = 1.0

    def __post_init__(self) -> None:
        if not 4 <= self.size <= MAX_DELTA_NODES:
            raise InputError(f"n_delta must be from 4 to {MAX_DELTA_NODES}, got {self.size}")

    def nodes(self) -> FloatArray:
        """δ at the nodes, ascending."""
        return np.linspace(0.0, self.upper, self.size)


def checked_size(n_phi: int, n_delta: int, limit_bytes: int = 1 << 30) -> None:
    """Refuse a grid whose table would not fit, before anything is allocated.

    Examples
    --------
    >>> checked_size(1025, 4)
    """
    size = n_phi * n_delta * 3 * 8
    if size > limit_bytes:
        raise InputError(
            f"a table of {n_phi} x {n_delta} nodes would take {size / 2**20:.0f} MiB; "
            f"at most {limit_bytes >> 20} MiB are allowed: choose fewer nodes"
        )
