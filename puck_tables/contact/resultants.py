"""Moment balance: from the five integrals to the friction resultants and the contact regime.

A puck of height h decelerated by friction is loaded more in front.  The linear pressure law with
the moments balanced gives (Salnikova, Treschev, Gallyamov 2012, eq. 5.2 and section 6), with
δ = 2fh/r,

    Δ   = 1 − δ² sin²φ p_b p_c,     b̂ = δ cos φ p_a/Δ,   ĉ = δ sin φ p_b b̂,
    ρ_∥ = p_a/Δ,   ρ_⊥ = δ p_a p_b/Δ,   ρ_ω = 2 [p_d + δ² cos²φ p_a p_b p_e/Δ].

The friction on the puck is −fN cos φ ρ_∥ along its velocity, −fN sin φ cos φ ρ_⊥ across (to the
left), and the torque −(fNr/2) sin φ ρ_ω.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection
from puck_tables.errors import InputError

# How far rounding may push the pressure below zero where it just touches it (δ = 1, φ = 0).
CONTACT_SLACK = 1e-12

# Beyond this its fourth power in the balance would overflow.
MAX_DELTA = 1e70


class Resultants(NamedTuple):
    """Dimensionless friction resultants: along the velocity, across it, about the vertical."""

    parallel: FloatArray
    perpendicular: FloatArray
    spin: FloatArray


def moment_balance(p: PatchIntegrals, direction: SlipDirection, delta: npt.ArrayLike) -> Resultants:
    """Resultants of full contact from the five integrals (uniform pressure).

    Parameters
    ----------
    p : PatchIntegrals
    direction : SlipDirection
        The direction the integrals belong to, of the same shape.
    delta : array_like
        Dimensionless height δ = 2fh/r, broadcast against ``p``.

    Returns
    -------
    Resultants
        Dimensionless, of the broadcast shape.

    Examples
    --------
    >>> from puck_tables.contact import quadrature
    >>> from puck_tables.contact.integrals import slip_direction
    >>> phi = np.pi / 2
    >>> rho = moment_balance(quadrature.integrals(phi), slip_direction(phi), 1.0)
    >>> float(rho.parallel.round(14)), float(rho.spin.round(14))
    (0.9, 1.33333333333333)
    """
    height = np.asarray(delta, dtype=np.float64)
    denominator = 1.0 - height**2 * direction.sin_squared * p.b * p.c
    parallel = p.a / denominator
    perpendicular = height * parallel * p.b
    spin = 2.0 * (p.d + height**2 * direction.cos_squared * parallel * p.b * p.e)
    return Resultants(*np.broadcast_arrays(parallel, perpendicular, spin))


def pressure_tilt(rho: Resultants, direction: SlipDirection, delta: npt.ArrayLike) -> FloatArray:
    """Relative tilt of the pressure, hypot(b̂, ĉ): contact is full while it is at most 1.

    Parameters
    ----------
    rho, direction
        Resultants and the slip direction they belong to.
    delta : array_like
        Dimensionless height, broadcast.

    Notes
    -----
    b̂ = δ cos φ ρ_∥ and ĉ = δ cos φ sin φ ρ_⊥, so the tilt is δ times the friction force over fN
    (Salnikova, Treschev, Gallyamov 2012, Prop. 4).

    Examples
    --------
    >>> from puck_tables.contact import closed_form
    >>> from puck_tables.contact.integrals import slip_direction
    >>> rho = moment_balance(closed_form.integrals(0.0), slip_direction(0.0), 1.0)
    >>> float(pressure_tilt(rho, slip_direction(0.0), 1.0))
    1.0
    """
    force = np.hypot(rho.parallel, np.sqrt(direction.sin_squared) * rho.perpendicular)
    return np.asarray(delta) * np.sqrt(direction.cos_squared) * force


def checked_delta(delta: npt.ArrayLike) -> FloatArray:
    """``delta`` as an array, refused unless finite and not negative.

    >>> float(checked_delta(0.5))
    0.5
    """
    height = real_array("delta", delta, "units of 2 f h / r")
    allowed = (height >= 0.0) & (height <= MAX_DELTA)
    if not allowed.all():
        raise InputError(
            "delta = 2 f h / r must be finite and not negative "
            f"(and at most {MAX_DELTA:g}), got {height[~allowed].flat[0]}"
        )
    return height
