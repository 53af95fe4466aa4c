"""Friction of one puck: its three friction ratios over the slip angle, straight from truth.

For a pressure law and a height δ the ratios 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ are functions of φ alone.  They
are singular on a few lines: where the instantaneous centre of rotation crosses an edge of the load,
tan φ = 1/edge, and where contact opens, δ_c(φ) = δ, across which partial and full contact part like
x^(5/2).  Between them they are analytic.  (That in partial contact the centre of rotation crosses
the edge of the loaded part is not felt: the pressure is zero there.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from puck_tables.contact import one_sided
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.contact.opening import critical_delta
from puck_tables.errors import ContactError
from puck_tables.kernels.slice_spline import LINE
from puck_tables.table.slip_axis import sides_of
from puck_tables.table.slip_spline import SlipSpline, slip_spline

FloatArray = npt.NDArray[np.float64]

FINEST_ACCURACY = 5e-13  # truth itself is good to 1e-13
_AT_THE_LIMIT = 1e-6
_SAME_LINE = 1e-12  # radians
_SHARP_DELTA = 3.6


@dataclass(frozen=True)
class FrictionSlice:
    """The friction ratios of a puck over its slip angle.

    Parameters
    ----------
    law : Law
    delta : dimensionless height 2fh/r
    opening : the slip angle up to which part of the base is lifted, radians; 0 where none ever is
    spline : of 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥
    """

    law: Law
    delta: float
    opening: float
    spline: SlipSpline = field(repr=False)

    @property
    def error(self) -> float:
        """The largest error of a ratio, measured."""
        return float(self.spline.error.max())

    @property
    def lines(self) -> tuple[float, ...]:
        """The singular lines, radians, ascending."""
        return tuple(side.line for side in self.spline.sides[::2])

    @cached_property
    def cut(self) -> FloatArray:
        """What compiled code reads: the pure ratios, for no motion in particular."""
        return self.spline.with_inertia(0.5, np.ones(3))

    def for_motion(self, gyration: float, coarser: bool = False) -> FloatArray:
        """The same for the motion of a puck with radius of gyration k (in units of r).

        The third ratio is multiplied by r²/(2k²): only r ω' = −(r²/2k²) J sin φ ρ_ω feels how the
        mass is spread.

        Parameters
        ----------
        gyration : k/r > 0
        coarser : by every other node only, to see what the spline contributes to an error
        """
        spline = self.spline.coarser() if coarser else self.spline
        # exactly 1 and ½ for a homogeneous puck
        square = 0.5 if gyration == HOMOGENEOUS else gyration * gyration
        cut = spline.with_inertia(square, np.array([1.0, 1.0, 0.5 / square]))
        # a line that is the limit of the motion is never crossed: rounding would, again and again
        limit = np.abs(self.spline.values[:, 0, 2] * (0.5 / square) - 1.0) < _AT_THE_LIMIT
        cut[limit, LINE] = math.inf
        return cut

    def ratios(self, phi: FloatArray) -> FloatArray:
        """1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ at slip angles (n,), (n, 3)."""
        return self.spline.at(phi)

    def at_ends(self) -> FloatArray:
        """The same at φ = 0 and π/2, (2, 3), as tabulated: without an error of the spline."""
        return np.stack([self.spline.values[0, -1], self.spline.values[-1, -1]])


def refuse_height(law: Law, delta: float) -> None:
    """Refuse a height at which the friction is not known at every slip angle.

    Raises
    ------
    InputError
        If it is not a height, or beyond full contact under another law than uniform pressure.
    ContactError
        If the puck tips, or its contact is not determined.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> refuse_height(law_of("ring"), 2.0)
    """
    law.friction(0.0, delta)
    if law.can_lift and delta > one_sided.FOLD_DELTA:
        raise ContactError(
            f"delta = {delta:g}: beyond {one_sided.FOLD_DELTA:g} the balance of moments has more "
            "than one solution just below phi = pi/4, and the motion is not determined; choose a "
            "lower or broader puck or less friction"
        )


def opening_angle(delta: float) -> float:
    """The slip angle φ_c with δ_c(φ_c) = δ, up to which part of the base is lifted; 0 if δ ≤ 1.

    Examples
    --------
    >>> round(opening_angle(1.15913851), 6)  # π/4
    0.785398
    """
    if delta <= 1.0:
        return 0.0
    low, high = 0.0, 0.5 * math.pi
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return high
        if critical_delta(middle) < delta:
            low = middle
        else:
            high = middle


def _sharpest_bend(delta: float) -> float:
    """Where just below π/4 the ratios of a puck next to tipping bend most; 0 for lower ones.

    They are analytic there, but towards the fold of the balance (δ = 3.9638) on a scale that
    shrinks to nothing.  Nodes crowded there make the spline at δ = 3.9 240 times as good.
    """
    if delta < _SHARP_DELTA:
        return 0.0
    low, high = 0.25 * math.pi - 0.1, 0.25 * math.pi - 0.002
    while high - low > 1e-6:
        phi = np.linspace(low, high, 33)
        rho = one_sided.resultants(phi, delta)
        n = int(np.abs(np.diff(rho.perpendicular / rho.parallel, 2)).argmax())
        low, high = float(phi[max(n - 2, 0)]), float(phi[min(n + 3, 32)])
    return low


@lru_cache(maxsize=64)
def friction_slice(law: Law, delta: float, accuracy: float = 1e-9) -> FrictionSlice:
    """Tabulate the friction of one puck.

    Parameters
    ----------
    law : Law
    delta : dimensionless height 2fh/r
        Up to 3.9637 under uniform pressure, to ``law.delta_max`` under another.
    accuracy : the largest error of a friction ratio

    Returns
    -------
    FrictionSlice
        Kept: the same call again costs nothing.

    Raises
    ------
    InputError, ContactError
        If the height is out of range.
    AccuracyError
        If the accuracy is out of reach.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 6; beyond full contact the same balance of moments
    with σ = max(0, a + b x + c y).

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> found = friction_slice(law_of("uniform"), 2.0, 1e-7)
    >>> inverse, across, spin = found.ratios(np.array([0.5]))[0]
    >>> round(float(spin / inverse), 6)  # ρ_ω
    0.219633
    """
    refuse_height(law, delta)
    opening = opening_angle(delta) if law.can_lift else 0.0
    cotangents = list(law.edges[::-1])
    for line in (opening, _sharpest_bend(delta) if law.can_lift else 0.0):
        if line > 0.0 and all(abs(line - math.atan2(1.0, e)) > _SAME_LINE for e in law.edges):
            cotangents = sorted([*cotangents, 1.0 / math.tan(line)], reverse=True)

    def ratios(phi: FloatArray) -> FloatArray:
        rho = law.friction(phi, delta)
        return np.stack([1.0 / rho.parallel, rho.perpendicular / rho.parallel,
                         rho.spin / rho.parallel], axis=-1)  # fmt: skip

    return FrictionSlice(
        law, delta, opening, slip_spline(ratios, sides_of(cotangents), accuracy, even=True)
    )
