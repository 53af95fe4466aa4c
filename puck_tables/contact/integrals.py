"""The five integrals of the contact patch: what they are and how a direction of motion is given.

On the unit disc, with α = cos φ, β = sin φ and w = |slip velocity|,

    α p_a = (1/π) ∫ (α − βρ sin θ)/w             β p_b = (1/π) ∫ βρ² cos²θ / w
    β p_c = (1/π) ∫ (α − βρ sin θ) ρ sin θ / w   β p_d = (1/π) ∫ (βρ − α sin θ) ρ / w
    α p_e = (1/π) ∫ (βρ − α sin θ) ρ² sin θ / w

(Salnikova, Treschev, Gallyamov 2012, eq. 4.3–4.6), for uniform pressure; another axisymmetric law
enters as a weight W(ρ).  All five are even in φ, and p_c = p_b − p_d, p_e = p_d − 2 p_b.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables.errors import InputError


class PatchIntegrals(NamedTuple):
    """p_a … p_e, dimensionless, all of one shape."""

    a: FloatArray
    b: FloatArray
    c: FloatArray
    d: FloatArray
    e: FloatArray


class SlipDirection(NamedTuple):
    """The slip angle φ without loss of digits near 0, π/4 and π/2.

    ``ratio`` is min(v, r|ω|)/max(v, r|ω|) ∈ [0, 1]; ``fast_spin`` tells r|ω| > v (|φ| > π/4).
    """

    ratio: FloatArray
    fast_spin: npt.NDArray[np.bool_]

    @property
    def cos_squared(self) -> FloatArray:
        """cos²φ = v²/(v² + r²ω²)."""
        return np.where(self.fast_spin, self.ratio**2, 1.0) / (1.0 + self.ratio**2)

    @property
    def sin_squared(self) -> FloatArray:
        """sin²φ = r²ω²/(v² + r²ω²)."""
        return np.where(self.fast_spin, 1.0, self.ratio**2) / (1.0 + self.ratio**2)


def checked_phi(phi: npt.ArrayLike) -> FloatArray:
    """``phi`` as an array of angles, refused unless all lie in [−π/2, π/2].

    Raises InputError if an angle is not a real number or lies outside [−π/2, π/2].

    >>> float(checked_phi(0.5))
    0.5
    """
    angle = real_array("phi", phi, "radians")
    allowed = np.abs(angle) <= 0.5 * np.pi
    if not allowed.all():
        raise InputError(
            "phi must lie in [-pi/2, pi/2] radians (phi = atan2(r*omega, v)), "
            f"got {angle[~allowed].flat[0]}"
        )
    return angle


def slip_direction(phi: npt.ArrayLike) -> SlipDirection:
    """The slip direction of an angle φ = atan2(rω, v).

    ``phi``: array_like, radians, any shape, in [−π/2, π/2].  Raises InputError if an angle is not a
    real number or lies outside [−π/2, π/2].

    >>> float(slip_direction(0.5).ratio.round(12))
    0.546302489844
    """
    angle = np.abs(checked_phi(phi))
    cosine, sine = np.cos(angle), np.sin(angle)
    fast = sine > cosine
    return SlipDirection(np.where(fast, cosine, sine) / np.where(fast, sine, cosine), fast)
