"""The five integrals in closed form (uniform pressure), without cancellation; friction from them.

With s = cot φ the integrals are combinations of complete elliptic integrals of modulus
k = min(s, 1/s).  In the basis

    B = ∫ cos²/√(1 − k² sin²),   D = ∫ sin²/√(1 − k² sin²),   G = (D − B)/k²

(so K = B + D and E = B + (1 − k²) D) the coefficients have one sign or stay small, and one run of
the arithmetic–geometric mean gives all three by sums of positive terms: K = π/(2 a_∞),
G = K Σ_{n≥1} 2ⁿ c_n²/k⁴, D = (K + k²G)/2, and B by Bulirsch's recursion (1965).  No digit is lost
for k → 0 or k → 1, and no series switch is needed.

The function is branch-free so that the same source runs on NumPy arrays and, compiled, on scalars.

From the five integrals, of this law or another, moment balance makes the friction resultants and
the contact regime.  A puck of height h decelerated by friction is loaded more in front.  The linear
pressure law with the moments balanced gives (Salnikova, Treschev, Gallyamov 2012, eq. 5.2 and
section 6), with δ = 2fh/r,

    Δ   = 1 − δ² sin²φ p_b p_c,     b̂ = δ cos φ p_a/Δ,   ĉ = δ sin φ p_b b̂,
    ρ_∥ = p_a/Δ,   ρ_⊥ = δ p_a p_b/Δ,   ρ_ω = 2 [p_d + δ² cos²φ p_a p_b p_e/Δ].

The friction on the puck is −fN cos φ ρ_∥ along its velocity, −fN sin φ cos φ ρ_⊥ across (to the
left), and the torque −(fNr/2) sin φ ρ_ω.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, real_array
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection, checked_phi, slip_direction
from puck_tables.errors import InputError

Elliptic = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]
ShapeIntegrals = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]

# six would leave 4e-7 next to φ = π/4, where the modulus reaches 1: test_uncompiled_closed_form
AGM_STEPS = 8


def elliptic_with(steps: int) -> Elliptic:
    """B, D and G after so many steps of the arithmetic–geometric mean, as a function of k.

    A constant number, so that the loop over it can be unrolled and the one around it vectorised.

    >>> few, all_ = elliptic_with(4)(0.5)[0], elliptic(0.5)[0]
    >>> bool(abs(few - all_) < 1e-15)
    True
    """

    def elliptic(ratio: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        m = ratio * ratio
        m1 = (1.0 - ratio) * (1.0 + ratio)
        # The first AGM step by hand: a₀ = 1, b₀ = √m1 (1e-32 stands for the limit k = 1),
        # c₁ = m/(4a₁).  (x, y) carries B along the way, c_over_m and total carry G.
        geometric = np.sqrt(m1 + 1e-32)
        x: FloatArray | float = 1.0
        y = geometric
        mean = 0.5 + 0.5 * geometric
        geometric = np.sqrt(geometric)
        inverse = 1.0 / mean
        c_over_m = 0.25 * inverse
        c = m * c_over_m
        power = 2.0
        total = 2.0 * c_over_m * c_over_m
        for _ in range(steps):
            x, y = x + y * inverse, y + x * geometric
            mean, geometric = 0.5 * (mean + geometric), np.sqrt(mean * geometric)
            inverse = 1.0 / mean
            c_over_m = 0.25 * c_over_m * c * inverse
            c = 0.25 * c * c * inverse
            power = 2.0 * power
            total = total + power * c_over_m * c_over_m
        K = (0.5 * np.pi) * inverse
        B = (0.25 * np.pi) * (x + y * inverse) * inverse / power
        G = K * total
        return B, 0.5 * (K + m * G), G

    return elliptic


elliptic = elliptic_with(AGM_STEPS)


def shape_integrals_by(elliptic: Elliptic) -> ShapeIntegrals:
    """p_a, p_b and p_d from B, D and G, as a function."""

    def shape_integrals(
        ratio: FloatArray, fast: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """p_a, p_b and p_d of a slip direction; the other two follow exactly from them.

        ``ratio`` is min(v, r|ω|)/max(v, r|ω|); ``fast`` is 1.0 where r|ω| > v, else 0.0.
        """
        m = ratio * ratio
        B, D, G = elliptic(ratio)
        m1_D = (1.0 - ratio) * (1.0 + ratio) * D

        factor = np.sqrt(1.0 + m) / np.pi
        p_a = (4.0 / 3.0) * factor * (2.0 * B + m1_D)
        # fast: instantaneous centre inside the disc; slow: outside
        fast_b = (36.0 - 4.0 * m) * B + (24.0 - 8.0 * m) * m1_D
        slow_b = 36.0 * B + 12.0 * m1_D + 4.0 * (G - D)
        fast_d = (12.0 - 4.0 * m) * B + (12.0 - 8.0 * m) * m1_D
        slow_d = 12.0 * B + 4.0 * (G - D)
        slow = 1.0 - fast
        p_b = factor * (fast * fast_b + slow * slow_b) / 45.0
        p_d = factor * (fast * fast_d + slow * slow_d) / 9.0
        return p_a, p_b, p_d

    return shape_integrals


shape_integrals = shape_integrals_by(elliptic)


def integrals(phi: npt.ArrayLike) -> PatchIntegrals:
    """The five integrals p_a … p_e by elliptic integrals, uniform pressure.

    The integrals: Salnikova, Treschev, Gallyamov 2012, eq. 4.3–4.6.

    ``phi``: array_like, radians, any shape, in [−π/2, π/2].  Returns PatchIntegrals: dimensionless,
    each of the shape of ``phi``; error about 2e-15.  Raises InputError if an angle is not finite or
    lies outside [−π/2, π/2].

    >>> float(integrals(np.pi / 4).a.round(14))  # 8√2/(3π)
    1.20042175487614
    """
    direction = slip_direction(phi)
    a, b, d = shape_integrals(direction.ratio, direction.fast_spin.astype(np.float64))
    return PatchIntegrals(a, b, b - d, d, d - 2.0 * b)


def by_closed_form(phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
    """Resultants by elliptic integrals, uncompiled.

    >>> float(by_closed_form(0.0, 1.0).spin)
    0.375
    """
    return moment_balance(integrals(phi), slip_direction(phi), delta)


def is_full_contact(phi: npt.ArrayLike, delta: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Whether the whole base stays loaded: where the linear pressure law is nowhere negative.

    Parameters
    ----------
    phi : array_like, radians, in [−π/2, π/2]
    delta : array_like
        Dimensionless height δ = 2fh/r ≥ 0, broadcast against ``phi``.

    Returns
    -------
    array of bool, of the broadcast shape

    Raises
    ------
    InputError
        If an angle or a height is not finite or outside its range.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, Prop. 4: full contact at every φ exactly when δ ≤ 1.

    Examples
    --------
    >>> is_full_contact([0.0, np.pi / 4], 1.1).tolist()  # the limit at π/4 is δ = 1.15914
    [False, True]
    """
    angle, height = broadcast(phi=checked_phi(phi), delta=checked_delta(delta))
    direction = slip_direction(angle)
    rho = moment_balance(integrals(angle), direction, height)
    return np.asarray(pressure_tilt(rho, direction, height) <= 1.0 + CONTACT_SLACK)


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

    ``direction``: the direction the integrals belong to, of the same shape; ``delta``: array_like,
    dimensionless height δ = 2fh/r, broadcast against ``p``.  Returns Resultants: dimensionless, of
    the broadcast shape.

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

    b̂ = δ cos φ ρ_∥ and ĉ = δ cos φ sin φ ρ_⊥, so the tilt is δ times the friction force over fN
    (Salnikova, Treschev, Gallyamov 2012, Prop. 4).

    ``rho``, ``direction``: resultants and the slip direction they belong to; ``delta``: array_like,
    dimensionless height, broadcast.

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
