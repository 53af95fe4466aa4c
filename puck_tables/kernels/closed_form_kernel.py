"""The closed forms, compiled: exact resultants in bulk and exact friction ratios for the loop."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast
from puck_tables.contact import closed_form
from puck_tables.contact.closed_form import CONTACT_SLACK, Resultants, checked_delta
from puck_tables.contact.integrals import checked_phi
from puck_tables.errors import ContactError
from puck_tables.kernels.compile import allocating, inlined, patience

_BLOCK = 256  # points at once: their numbers fit the first cache
_HALF_PI_REST = 6.123233995736766e-17  # of π/2 beyond its double


# of the arithmetic-geometric mean: exact to rounding from a modulus k² ≤ 63/64 on:
# test_compiled_resultants
_FEW_STEPS = 4
_NEAR_QUARTER = 1.0 / 64.0  # of 1 − k²: nearer to φ = π/4 it takes more steps


def _friction_ratios_with(shape_integrals: Any) -> Any:
    """:func:`friction_ratios` from p_a, p_b and p_d."""

    def friction_ratios(ratio: float, fast: float, delta: float) -> tuple[float, float, float]:
        """1/ρ_∥, ρ_⊥/ρ_∥ and ρ_ω/ρ_∥ at a slip direction (:mod:`puck_tables.kernels.quadratic`)."""
        p_a, p_b, p_d = shape_integrals(ratio, fast)
        m = ratio * ratio
        share = 1.0 / (1.0 + m)
        cos2 = share * (fast * m + 1.0 - fast)
        sin2 = share * (fast + (1.0 - fast) * m)
        inverse = (1.0 - delta * delta * sin2 * p_b * (p_b - p_d)) / p_a
        spin = 2.0 * (p_d * inverse + delta * delta * cos2 * p_b * (p_d - 2.0 * p_b))
        return inverse, delta * p_b, spin

    return inlined(friction_ratios)


full_elliptic: Any = inlined(closed_form.elliptic)
few_elliptic: Any = inlined(closed_form.elliptic_with(_FEW_STEPS))
full_integrals: Any = inlined(closed_form.shape_integrals)
friction_ratios = _friction_ratios_with(full_integrals)
_far_ratios = _friction_ratios_with(inlined(closed_form.shape_integrals_by(few_elliptic)))


@inlined
def _slip_ratio(phi: float) -> tuple[float, float]:
    """The slip ratio of |φ| ≤ π/2 and 1.0 for r|ω| > v; tan by Lambert's continued fraction."""
    x = abs(phi)
    fast = 1.0 if x > 0.25 * math.pi else 0.0
    x = fast * ((0.5 * math.pi - x) + _HALF_PI_REST) + (1.0 - fast) * x
    y = x * x
    up = x * (34459425.0 - y * (4729725.0 - y * (135135.0 - y * (990.0 - y))))
    down = 34459425.0 - y * (16216200.0 - y * (945945.0 - y * (13860.0 - 45.0 * y)))
    return min(up / down, 1.0), fast


@inlined
def _lifted(ratio: float, fast: float, delta: float, parallel: float, perpendicular: float) -> bool:
    """Whether part of the base would be pulled."""
    m = ratio * ratio
    cos2 = (fast * m + 1.0 - fast) / (1.0 + m)
    tilt = delta * delta * cos2 * (parallel**2 + (1.0 - cos2) * perpendicular**2)
    return tilt > 1.0 + CONTACT_SLACK


@allocating
def _fill(phi: FloatArray, delta: FloatArray, out: FloatArray) -> int:
    """Resultants at flat arrays of points; returns the first point out of full contact, or -1.

    In blocks, both loops without a branch, so that they are vectorised; the few points next to
    φ = π/4 anew, with all steps of the arithmetic-geometric mean.
    """
    patience(phi.size)
    ratio = np.empty(_BLOCK)
    fast = np.empty(_BLOCK)
    which = np.empty(_BLOCK, np.int64)
    first_bad = -1
    for start in range(0, phi.size, _BLOCK):
        angle = phi[start : start + _BLOCK]
        height = delta[start : start + _BLOCK]
        parallel = out[0, start : start + _BLOCK]
        perpendicular = out[1, start : start + _BLOCK]
        spin = out[2, start : start + _BLOCK]
        near, high = 0, 0
        for i in range(angle.size):
            k, side = _slip_ratio(angle[i])
            ratio[i], fast[i] = k, side
            near += 1 if 1.0 - k * k < _NEAR_QUARTER else 0
            high += 1 if height[i] > 1.0 else 0  # up to 1 the whole base is loaded
        for i in range(angle.size):
            inverse, across, turning = _far_ratios(ratio[i], fast[i], height[i])
            along = 1.0 / inverse
            parallel[i] = along
            perpendicular[i] = across * along
            spin[i] = turning * along
        if near > 0:
            count = 0
            for i in range(angle.size):
                if 1.0 - ratio[i] * ratio[i] < _NEAR_QUARTER:
                    which[count] = i
                    count += 1
            for n in range(count):  # a list, or all points would be computed and most thrown away
                i = which[n]
                inverse, across, turning = friction_ratios(ratio[i], fast[i], height[i])
                along = 1.0 / inverse
                parallel[i] = along
                perpendicular[i] = across * along
                spin[i] = turning * along
        bad = 0
        if high > 0:
            for i in range(angle.size):
                bad += (
                    1 if _lifted(ratio[i], fast[i], height[i], parallel[i], perpendicular[i]) else 0
                )
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
    flat_angle, flat_height = (np.array(a).reshape(-1) for a in (angle, height))
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
