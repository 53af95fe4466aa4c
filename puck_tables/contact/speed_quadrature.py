"""Friction of a base whose coefficient depends on the local slip speed, by direct quadrature.

With f = f(|u|) under the integrals, in units of r, w = |u|/Q and σ = (N/πr²)(1 + b̂ x + ĉ y),

    α p_a = (1/π)∫ f (α − βy)/w     β p_b = (1/π)∫ f β x²/w     β p_c = (1/π)∫ f (α − βy) y/w
    β p_d = (1/π)∫ f (βρ² − αy)/w   α p_e = (1/π)∫ f (βρ² − αy) y/w ,       α, β = cos φ, sin φ,

the rest being odd in x.  The load is tilted until its moments balance, with f inside:
∫σx = (h/2) F_∥ and ∫σy = (h/2) F_⊥ give, for g = 2h/r,

    b̂ = g (α p_a + ĉ β p_c),  ĉ = g b̂ β p_b;   F_∥ = (N/g) b̂,  F_⊥ = (N/g) ĉ,
    M = N r (β p_d + ĉ α p_e) :

the moment balance of a constant coefficient with f inside the p and g in the place of δ.

On a circle of radius R about the instantaneous centre of rotation (0, s), s = cot φ, the slip has
one speed, |u| = QβR, and the directions add up in closed form over the arc within the base, half of
it being a, cos a = (s² + R² − 1)/(2sR):

    α p_a: 2R sin a      β p_b: R²(a − sin a cos a)      β p_d: 2R(Ra − s sin a)
    α p_e: R[2Rsa − 2(R² + s²) sin a + sR(a + sin a cos a)]      p_c = p_b − p_d for every f

each times f(QβR) dR/π.  One integral is left.  R = 1 − s cos τ (s ≤ 1) and R = s ± cos τ (s ≥ 1)
take the roots from its ends, and what cancels for s → ∞ is cancelled on paper.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, real, real_array, shown
from puck_tables.contact.closed_form import Resultants, moment_balance, pressure_tilt
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection, checked_phi, slip_direction
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import ContactError, InputError

SpeedFunction = Callable[[FloatArray], npt.ArrayLike]

# of Gauss's rule a panel, to 1e-14: test_a_constant_coefficient_gives_the_closed_forms
_GAUSS_NODES = 12
_NODE, _WEIGHT = np.polynomial.legendre.leggauss(_GAUSS_NODES)
# Panels halved towards τ = 0, where for s → 1 a root has its branch point.
_EDGES = np.append(0.5 ** np.arange(34), 0.0)[::-1]
_HIGHEST = 1e100  # 2h/r: its square is still a number
_DEFAULT_BREAKS = 16  # halvings of the speed at which a function that names none is cut
_CHUNK = 64  # points at once: their rules fit the cache
_LEAST_STEP = 1e-5  # relative, of the difference quotient that stands for f′ as φ → 0
_SERIES = np.array([1.0 / np.prod(np.arange(2.0, 2 * k + 4)) * (-1.0) ** k for k in range(11)])
CONTACT_SLACK = 1e-9  # of the tilt: rounding of an input that just does not lift


def speed_integrals(
    phi: npt.ArrayLike, speed: npt.ArrayLike, law: SpeedLaw | SpeedFunction
) -> PatchIntegrals:
    """The five integrals with a friction coefficient inside that depends on the slip speed.

    ``phi``: array_like, radians, in [−π/2, π/2]; ``speed``: array_like, m/s, Q = hypot(v, rω),
    broadcast against ``phi``; ``law``: SpeedLaw, or callable from speeds in m/s to f, a callable
    must be smooth on scales above 1e-4 of the fastest slip.  Returns PatchIntegrals: p_a … p_e with
    f inside; error about 1e-13 of the largest f (for φ → 0 and p_c, p_d 1e-10).  Raises InputError
    if an argument is out of range; the fastest slip v + r|ω| must lie within a ``SpeedLaw``.

    >>> viscous = speed_integrals(0.7, 2.0, lambda u: 0.1 * u)  # linear: p_b = f Q/4 exactly
    >>> float(viscous.a.round(12)), float(viscous.b.round(12)), float(viscous.d.round(12))
    (0.2, 0.05, 0.1)
    """
    angle, Q = broadcast(phi=checked_phi(phi), speed=checked_speed(speed))
    direction = slip_direction(angle)
    evaluate, breaks = _evaluation(law, Q, direction)
    ratio, fast, flat_Q = np.ravel(direction.ratio), np.ravel(direction.fast_spin), np.ravel(Q)
    integrals = np.empty((4, ratio.size))
    for inside, integrate in ((True, _centre_inside), (False, _centre_outside)):
        chosen = np.flatnonzero(fast == inside)
        for start in range(0, chosen.size, _CHUNK):
            part = chosen[start : start + _CHUNK]
            integrals[:, part] = integrate(ratio[part], flat_Q[part], evaluate, breaks)
    a, b, d, e = (row.reshape(angle.shape) for row in integrals)
    return PatchIntegrals(a, b, b - d, d, e)


def speed_resultants(
    phi: npt.ArrayLike,
    speed: npt.ArrayLike,
    law: SpeedLaw | SpeedFunction,
    height_ratio: float = 0.0,
) -> Resultants:
    """Friction force and torque where the coefficient depends on the slip speed, in full contact.

    Parameters
    ----------
    phi : array_like, radians, in [−π/2, π/2]
    speed : array_like, m/s
        Q = hypot(v, rω), broadcast against ``phi``.
    law : SpeedLaw, or callable from speeds in m/s to f
    height_ratio : float
        2h/r ≥ 0; times a constant f it is δ.

    Returns
    -------
    Resultants
        F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ): f ρ_∥, f ρ_⊥, f ρ_ω for a constant f.

    Raises
    ------
    InputError
        If an argument is out of range.
    ContactError
        If part of the base would have to be pulled down.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 5, with f(|u|) kept under the integrals.

    Examples
    --------
    >>> rho = speed_resultants(np.pi / 2, 1.0, lambda u: 0.3 + 0.0 * u, 2.0)
    >>> float(rho.spin.round(12))  # f 4/3
    0.4
    """
    g = checked_height_ratio(height_ratio)
    p = speed_integrals(phi, speed, law)
    direction = slip_direction(np.broadcast_to(checked_phi(phi), p.a.shape))
    rho = moment_balance(p, direction, g)
    refuse_lifting(pressure_tilt(rho, direction, g), g)
    return rho


def refuse_lifting(tilt: FloatArray, height_ratio: float) -> None:
    """Refuse a load that tilts by more than 1: part of the base would have to be pulled down.

    Raises ContactError.
    """
    if not (tilt <= 1.0 + CONTACT_SLACK).all():
        raise ContactError(
            f"2h/r = {height_ratio:g} is too high for this friction law: part of the base would "
            f"lift (the pressure tilts by {float(tilt.max()):g} > 1); choose a lower puck or less "
            "friction"
        )


def checked_speed(speed: npt.ArrayLike) -> FloatArray:
    """Slip speeds as an array, refused unless finite and not negative."""
    Q = real_array("speed", speed, "m/s")
    if not (np.isfinite(Q) & (Q >= 0.0)).all():
        raise InputError(
            "speed Q = hypot(v, r omega) must be finite and not negative, in m/s, got "
            f"{Q[~(np.isfinite(Q) & (Q >= 0.0))].flat[0]}"
        )
    return Q


def checked_height_ratio(height_ratio: float) -> float:
    """2h/r as a number, refused unless finite and not negative."""
    g = real("height_ratio", height_ratio, "2h/r")
    if not 0.0 <= g <= _HIGHEST:
        raise InputError(f"height_ratio = 2h/r must be from 0 to {_HIGHEST:g}, got {g:g}")
    return g


def fastest(direction: SlipDirection, speed: FloatArray) -> FloatArray:
    """The largest slip speed of the base, v + r|ω|, m/s."""
    return np.asarray(speed * (1.0 + direction.ratio) / np.sqrt(1.0 + direction.ratio**2))


def _evaluation(
    law: SpeedLaw | SpeedFunction, speed: FloatArray, direction: SlipDirection
) -> tuple[SpeedFunction, FloatArray]:
    """How f is evaluated, and the speeds between which it is smooth."""
    top = float(fastest(direction, speed).max(initial=0.0))
    if isinstance(law, SpeedLaw):
        if top > law.top_speed * (1.0 + 1e-12):
            raise InputError(
                f"the fastest slip v + r|omega| = {top:g} m/s is outside this friction law "
                f"(0 to {law.top_speed:g} m/s)"
            )
        return law.extended, np.asarray(law.speeds)[1:-1]
    if not callable(law):
        raise InputError(f"law must be a friction law or a function of speeds, got {shown(law)}")

    def evaluate(u: FloatArray) -> FloatArray:
        values = np.asarray(law(u), dtype=np.float64)
        if values.shape != u.shape or not np.isfinite(values).all():
            raise InputError(
                "the friction law must give a finite f for each speed, an array for an array"
            )
        return values

    return evaluate, top * 0.5 ** np.arange(1.0, _DEFAULT_BREAKS)


def _panels(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights of panels between sorted edges (n, k) → (n, points)."""
    half = 0.5 * np.diff(edges)[..., None]
    middle = 0.5 * (edges[:, 1:] + edges[:, :-1])[..., None]
    size = len(edges), -1
    return (middle + half * _NODE).reshape(size), (half * _WEIGHT).reshape(size)


def _with_breaks(last: float, breaks: FloatArray) -> FloatArray:
    """Edges halved towards 0, with further breaks (n, k) between it and the last."""
    graded = last * _EDGES
    every = np.broadcast_to(graded, (len(breaks), graded.size))
    return np.sort(np.concatenate([every, np.clip(breaks, 0.0, last)], axis=1), axis=1)


def _centre_inside(
    s: FloatArray, speed: FloatArray, law: SpeedFunction, breaks: FloatArray
) -> FloatArray:
    """|φ| > π/4, s = cot φ < 1: p_a, p_b, p_d, p_e."""
    sine = 1.0 / np.sqrt(1.0 + s * s)
    s, rim = s[:, None], (speed * sine)[:, None]
    with np.errstate(divide="ignore"):
        circles = np.where(rim > 0.0, breaks / np.where(rim > 0.0, rim, 1.0), np.inf)
    # whole circles, R ≤ 1 − s
    ends = np.concatenate([np.zeros_like(s), np.minimum(circles, 1.0 - s), 1.0 - s], axis=1)
    R, weight = _panels(np.sort(ends, axis=1))
    whole = (weight * np.asarray(law(rim * R)) * R * R).sum(axis=1)
    # arcs, R = 1 − s cos τ
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.where(s > 0.0, (1.0 - circles) / s, 1.0)
    tau, weight = _panels(_with_breaks(np.pi, np.arccos(np.clip(cosine, -1.0, 1.0))))
    c, sin_tau = np.cos(tau), np.sin(tau)
    R = (1.0 - s) + 2.0 * s * np.sin(0.5 * tau) ** 2
    weight = weight * np.asarray(law(rim * R)) * sin_tau
    root = np.sqrt((R + 1.0 - s) * (R + 1.0 + s))
    R = np.maximum(R, np.finfo(float).tiny)
    sin_a = 0.5 * sin_tau * root / R
    cos_a = 0.5 * (s * (1.0 + c * c) - 2.0 * c) / R
    a = np.arctan2(sin_a, cos_a)
    s0 = s[:, 0]
    parallel = (weight * 2.0 * R * sin_a).sum(axis=1)
    across = np.pi * whole + s0 * (weight * R * R * (a - sin_a * cos_a)).sum(axis=1)
    spin = 2.0 * np.pi * whole + s0 * (weight * 2.0 * R * (R * a - s * sin_a)).sum(axis=1)
    term = 2.0 * R * s * a - 2.0 * (R * R + s * s) * sin_a + s * R * (a + sin_a * cos_a)
    tilted = 3.0 * np.pi * whole + (weight * R * term).sum(axis=1)
    # s/α = 1/β
    return np.stack([parallel, across, spin, tilted]) / (np.pi * sine)


def _centre_outside(
    kappa: FloatArray, speed: FloatArray, law: SpeedFunction, breaks: FloatArray
) -> FloatArray:
    """|φ| ≤ π/4, κ = tan φ = 1/s ≤ 1: p_a, p_b, p_d, p_e, the circles R = s ± cos τ together."""
    cosine = 1.0 / np.sqrt(1.0 + kappa * kappa)
    kappa, centre = kappa[:, None], (speed * cosine)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.abs(breaks - centre) / (centre * kappa)
    away = np.where(np.isfinite(away), away, 1.0)
    tau, weight = _panels(_with_breaks(0.5 * np.pi, np.arccos(np.minimum(away, 1.0))))
    c, sin_tau = np.cos(tau), np.sin(tau)
    weight = weight * sin_tau
    f = [np.asarray(law(centre * (1.0 + sign * kappa * c))) for sign in (1.0, -1.0)]
    # (f₊ − f₋)/(2κc), over a step that does not vanish
    step = np.maximum(kappa * c, _LEAST_STEP)
    apart = [np.asarray(law(centre * (1.0 + sign * step))) for sign in (1.0, -1.0)]
    slope = 0.5 * (apart[0] - apart[1]) / step
    # T² = (2 ± κc)² − κ², by factors that do not cancel for κ, c → 1
    near = 2.0 * (1.0 - kappa) + 2.0 * kappa * np.sin(0.5 * tau) ** 2
    far = 2.0 + kappa * c
    roots = [
        np.sqrt((far - kappa) * (far + kappa)), np.sqrt(near * (2.0 - kappa * c + kappa))
    ]  # fmt: skip
    total = roots[0] + roots[1]
    cross = sin_tau * c * c * (4.0 * (f[0] + f[1]) / total + total * slope)
    parallel, across, spin, tilted = 0.0 * c, 0.0 * c, cross, 0.0 * c
    for sign, value, root in zip((1.0, -1.0), f, roots, strict=True):
        q = (1.0 - kappa) + kappa * (1.0 - c) if sign < 0.0 else 1.0 + kappa * c
        chord = 0.5 * sin_tau * root  # q sin a/κ
        with np.errstate(divide="ignore", invalid="ignore"):
            sin_a = np.where(q > 0.0, np.minimum(kappa * chord / np.where(q > 0, q, 1.0), 1.0), 1.0)
        a = np.arcsin(sin_a)
        # a/κ; for κ → 0 it is sin a/κ = chord/q
        arc = np.where(sin_a > 1e-8, a / np.where(kappa > 0.0, kappa, 1.0), chord / q)
        once, twice = _short(a), _short(2.0 * a)
        bulk = value * q * q * arc**3
        parallel = parallel + 2.0 * value * chord
        across = across + 4.0 * bulk * twice
        spin = spin + 2.0 * bulk * once
        tilted = tilted - 2.0 * c * c * value * chord + 4.0 * bulk * (once - twice)
    terms = np.stack([parallel, across, spin, tilted])
    return np.asarray((weight * terms).sum(axis=-1) / (np.pi * cosine))


def _short(x: FloatArray) -> FloatArray:
    """(x − sin x)/x³ for 0 ≤ x ≤ π."""
    square = x * x
    series = np.polynomial.polynomial.polyval(square, _SERIES)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(x < 1.0, series, (x - np.sin(x)) / (square * x)))
