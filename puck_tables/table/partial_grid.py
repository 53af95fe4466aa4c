"""Axes of the table of partial contact, fitted to where contact opens and where the puck tips.

Slip axis.  As in full contact the nodes crowd at φ = π/4, where the instantaneous centre of
rotation crosses the rim (it stays under load up to tipping, so the x² ln|x| stays too):

    tan(φ − π/4) = −ξ⁴ for φ ≤ π/4,   0.45 ξ⁴ beyond,   ξ = i/n from π/4.

The axis ends at φ = 1.208: beyond it contact is full for every δ of the table.

Height axis.  Partial contact lies between δ_c(φ), where contact opens, and the upper end of the
table.  Across δ_c the resultants of partial and full contact part like (δ − δ_c)^(5/2), so partial
contact is smooth in ζ with δ − δ_c ∝ ζ² near it; towards tipping things change over lengths like
4 − δ.  Both is served by

    top − δ = (top − δ_c) exp(−ζ²),   top = 4 max(1, δ_c(φ)/δ_c(π/4)),

with ζ uniform from 0 to √ln 30, the place of δ = 3.9 at φ = 0.  Up to π/4 the top is where the puck
tips; beyond π/4 it never does, and the top rises with δ_c: the rectangle does not pinch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.contact.opening import critical_delta
from puck_tables.errors import InputError

FloatArray = npt.NDArray[np.float64]

UPPER_DELTA = 3.9
TOP_DELTA = 4.0
FAST_END = 0.45  # tan(φ − π/4) at the last node, where δ_c = 4.07
ZETA_END = math.log((TOP_DELTA - 1.0) / (TOP_DELTA - UPPER_DELTA)) ** 0.5
MAX_CELLS = 1024


@dataclass(frozen=True)
class PartialAxes:
    """The nodes of the table of partial contact.

    Parameters
    ----------
    cells : int
        Cells in ζ and on either side of φ = π/4, even and at least 8.

    Examples
    --------
    >>> PartialAxes(8).phi().round(4).tolist()[:5]
    [0.0, 0.2552, 0.479, 0.634, 0.723]
    """

    cells: int

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= MAX_CELLS or self.cells % 2:
            raise InputError(
                f"cells of a table of partial contact must be even and from 8 to {MAX_CELLS}, "
                f"got {self.cells}"
            )

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes in φ and ζ."""
        return 2 * self.cells + 1, self.cells + 1

    def phi(self) -> FloatArray:
        """φ at the nodes, radians, ascending from 0."""
        xi = np.arange(self.cells + 1) / self.cells
        slow = 0.25 * np.pi - np.arctan(xi[::-1] ** 4)
        slow[0] = 0.0
        return np.concatenate([slow, 0.25 * np.pi + np.arctan(FAST_END * xi[1:] ** 4)])

    def zeta(self) -> FloatArray:
        """ζ at the nodes, ascending from 0."""
        return np.linspace(0.0, ZETA_END, self.shape[1])

    def delta(self) -> FloatArray:
        """δ at the nodes, an array of ``shape``."""
        return height_at(critical_delta(self.phi())[:, None], self.zeta())


def height_at(critical: FloatArray, zeta: FloatArray) -> FloatArray:
    """The height δ at ζ, where contact opens at ``critical``.

    Examples
    --------
    >>> height_at(np.array([1.0, 1.1]), np.array([0.0, ZETA_END])).round(6).tolist()
    [1.0, 3.903333]
    """
    top = top_delta(critical)
    return top - (top - critical) * np.exp(-(zeta**2))


def top_delta(critical: FloatArray) -> FloatArray:
    """The height that ζ → ∞ tends to.

    Examples
    --------
    >>> top_delta(np.array([1.0, 2.0])).round(6).tolist()
    [4.0, 6.901677]
    """
    return TOP_DELTA * np.maximum(1.0, critical / critical_delta(0.25 * np.pi))
