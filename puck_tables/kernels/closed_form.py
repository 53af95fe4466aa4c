"""The closed forms, compiled: exact resultants in bulk and exact friction ratios for the loop."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact import closed_form
from puck_tables.contact.integrals import checked_phi
from puck_tables.contact.resultants import (
    CONTACT_SLACK,
    Resultants,
    checked_delta,
)
from puck_tables.errors import ContactError
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.real import broadcast

FloatArray = npt.NDArray[np.float64]

_shape_integrals: Any = inlined(closed_form.shape_integrals)
_BLOCK = 256


@inlined
def friction_ratios(ratio: float, fast: float, delta: float) -> tuple[float, float, float]:
    """1/ρ_∥, ρ_⊥/ρ_∥ and ρ_ω/ρ_∥ at a slip direction (see :mod:`puck_tables.kernels.spline`)."""
    p_a, p_b, p_d = _shape_integrals(ratio, fast)
    m = ratio * ratio
    share = 1.0 / (1.0 + m)
    cos2 = share * (fast * m + 1.0 - fast)
    sin2 = share * (fast + (1.0 - fast) * m)
    inverse = (1.0 - delta * delta * sin2 * p_b * (p_b - p_d)) / p_a
    spin = 2.0 * (p_d * inverse + delta * delta * cos2 * p_b * (p_d - 2.0 * p_b))
    return inverse, delta * p_b, spin


@kernel
def _fill(phi: FloatArray, delta: FloatArray, out: FloatArray) -> int:
    """Resultants at flat arrays of points; returns the first point out of full contact, or -1.

    In blocks: the branch-free second loop is vectorised, the sines of the first are not.
    """
    ratio = np.empty(_BLOCK)
    fast = np.empty(_BLOCK)
    first_bad = -1
    for start in range(0, phi.size, _BLOCK):
        angle = phi[start : start + _BLOCK]
        height = delta[start : start + _BLOCK]
        parallel = out[0, start : start + _BLOCK]
        perpendicular = out[1, start : start + _BLOCK]
        spin = out[2, start : start + _BLOCK]
        for i in range(angle.size):
            cosine, sine = abs(math.cos(angle[i])), abs(math.sin(angle[i]))
            fast[i] = 1.0 if sine > cosine else 0.0
            ratio[i] = min(sine, cosine) / max(sine, cosine)
        bad = 0
        for i in range(angle.size):
            inverse, across, turning = friction_ratios(ratio[i], fast[i], height[i])
            parallel[i] = 1.0 / inverse
            perpendicular[i] = across / inverse
            spin[i] = turning / inverse
            m = ratio[i] * ratio[i]
            cos2 = (fast[i] * m + 1.0 - fast[i]) / (1.0 + m)
            tilt = height[i] * height[i] * cos2 * (1.0 + (1.0 - cos2) * across * across)
            bad += 1 if tilt > (1.0 + CONTACT_SLACK) * inverse * inverse else 0
        if first_bad < 0 and bad > 0:
            first_bad = start
    return first_bad


def resultants(phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
    """Friction resultants ρ_∥, ρ_⊥, ρ_ω of a puck in full contact, in closed form.

    Parameters
    ----------
    phi : array_like, radians, in [−π/2, π/2]
        Slip angle φ = atan2(rω, v); any shape, broadcast against ``delta``.
    delta : array_like, dimensionless, ≥ 0
        Height δ = 2fh/r.

    Returns
    -------
    Resultants
        ``parallel``, ``perpendicular``, ``spin``: dimensionless arrays of the broadcast shape;
        error ≤ 1e-14.

    Raises
    ------
    InputError
        If an argument is not finite or outside its range.
    ContactError
        If at some point part of the base would be lifted: the linear pressure law ends there
        (possible for δ > 1 only).

    Notes
    -----
    F_∥ = fN cos φ ρ_∥, F_⊥ = fN sin φ cos φ ρ_⊥, M = (fNr/2) sin φ ρ_ω; the force on the puck is
    −F_∥ e_∥ − F_⊥ e_⊥ with e_⊥ to the left of the velocity, the torque −M.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 6.

    Examples
    --------
    >>> import numpy as np
    >>> rho = resultants([0.0, np.pi / 2], 1.0)
    >>> rho.parallel.round(12).tolist(), rho.spin.round(12).tolist()
    ([1.0, 0.9], [0.375, 1.333333333333])
    """
    angle, height = broadcast(phi=checked_phi(phi), delta=checked_delta(delta))
    flat_angle, flat_height = (np.ascontiguousarray(a).reshape(-1) for a in (angle, height))
    out = np.empty((3, flat_angle.size))
    bad = _fill(flat_angle, flat_height, out)
    if bad >= 0:
        for i in range(bad, flat_angle.size):
            if _fill(flat_angle[i : i + 1], flat_height[i : i + 1], np.empty((3, 1))) >= 0:
                raise outside_full_contact(float(flat_angle[i]), float(flat_height[i]))
    return Resultants(*(row.reshape(angle.shape) for row in out))


def outside_full_contact(phi: float, delta: float) -> ContactError:
    """The error for a state where the linear pressure law would pull on part of the base."""
    return ContactError(
        f"at phi = {phi:.6g}, delta = {delta:.6g} part of the base is lifted: the linear pressure "
        "law of full contact ends there (delta <= 1 is inside it at every phi)"
    )
