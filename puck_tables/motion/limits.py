"""The limit motion: the slip angle that every generic motion approaches, and the five regimes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, instance, one_velocity, positive, real
from puck_tables.contact.closed_form import checked_delta, integrals
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of
from puck_tables.contact.laws import limit_ratio as law_limit_ratio
from puck_tables.errors import ContactError
from puck_tables.kernels.closed_form_kernel import friction_ratios, resultants
from puck_tables.kernels.compile import kernel
from puck_tables.motion.body import checked_gyration

# A start this close to the limit ratio (in ln(rω/v)) is the limit motion itself.
LIMIT_WIDTH = 1e-13

REGIMES = {
    "A": "rest",
    "B0": "pure spin",
    "C0": "pure translation",
    "D": "limit motion, v/(r w) constant",
    "B": "spin-rich, v/(r w) grows towards its limit",
    "C": "spin-poor, v/(r w) falls towards its limit",
}


@kernel
def limit_log_ratio(delta: float) -> float:
    """Ln tan φ₀, the only zero of ρ_ω/ρ_∥ − 1, by bisection on the closed forms."""
    low, high = -40.0, 40.0
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            return middle
        k = math.exp(-abs(middle))
        _, _, spin = friction_ratios(k, 1.0 if middle > 0.0 else 0.0, delta)
        if spin < 1.0:
            low = middle
        else:
            high = middle


def limit_ratio(
    delta: npt.ArrayLike, pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS
) -> FloatArray:
    """The ratio rω/v that every generic motion approaches at its stop, tan φ₀.

    Parameters
    ----------
    delta : array_like, dimensionless height 2fh/r
        Below 4 under uniform pressure, up to the full contact of another law.
    pressure : a pressure law, as :func:`puck_tables.law_of` takes it, or a Law
    gyration : radius of gyration about the vertical axis over r; √½ for a homogeneous puck

    Returns
    -------
    array of the same shape
        0 where the spin dies out before the sliding, inf where the sliding does.

    Raises
    ------
    InputError
        If a height or the radius of gyration is out of range, or the law not known.
    ContactError
        If the puck tips.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 3 and 7–8.

    Examples
    --------
    >>> float(limit_ratio(0.0).round(12)), float(limit_ratio(2.0).round(9))
    (1.531389372174, 1.403443712)
    >>> float(limit_ratio(0.0, "ring", 1.0).round(12))
    1.0
    """
    height, radius = checked_delta(delta), checked_gyration(gyration)
    instance("pressure", pressure, str, Law)
    if pressure == "uniform" and radius == HOMOGENEOUS and np.all(height <= 1.0):
        return np.vectorize(lambda d: math.exp(limit_log_ratio(d)), otypes=[float])(height)
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    return np.vectorize(lambda d: law_limit_ratio(law, d, radius), otypes=[float])(height)


def limit_angle(
    delta: npt.ArrayLike, pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS
) -> FloatArray:
    """The slip angle φ₀ that every generic motion approaches at its stop: arctan of limit_ratio.

    Parameters
    ----------
    delta, pressure, gyration
        As :func:`limit_ratio`.

    Returns
    -------
    array of the shape of ``delta``, radians
        φ₀ with ρ_∥(φ₀) = (r²/2k²) ρ_ω(φ₀); 0 or π/2 where there is none between.

    Raises
    ------
    InputError, ContactError
        As :func:`limit_ratio`.

    Examples
    --------
    >>> float(limit_angle(0.5).round(12))
    0.987079101411
    """
    return np.arctan(limit_ratio(delta, pressure, gyration))


def _full_contact(delta: npt.ArrayLike) -> FloatArray:
    height = checked_delta(delta)
    if not np.all(height <= 1.0):
        raise ContactError(
            f"delta = {height[height > 1.0].flat[0]:g}: this is known for full contact, "
            "0 <= delta <= 1"
        )
    return height


def curvature_slope(delta: npt.ArrayLike) -> FloatArray:
    """Λ(δ): at the stop the radius of curvature of the path falls by Λ/δ for each unit of path.

    Parameters
    ----------
    delta : array_like, dimensionless, in [0, 1]

    Returns
    -------
    array of the same shape
        Λ = 2/(sin φ₀ p_b(φ₀)), dR/ds = −Λ/δ, near 7 for every δ.

    Raises
    ------
    InputError
        If a height is not finite or negative.
    ContactError
        If a height is above 1, where full contact is not certain.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2, result 8.

    Examples
    --------
    >>> curvature_slope([0.0, 0.5, 1.0]).round(8).tolist()
    [7.06673562, 7.09397854, 7.15668696]
    """
    angle = limit_angle(_full_contact(delta))
    return 2.0 / (np.sin(angle) * integrals(angle).b)


def approach_exponent(delta: npt.ArrayLike) -> FloatArray:
    """κ(δ): next to the stop |φ − φ₀| falls like Q^κ.

    Parameters
    ----------
    delta : array_like, dimensionless, in [0, 1]

    Returns
    -------
    array of the same shape
        κ = d(ρ_ω/ρ_∥)/du at the limit ratio, u = ln(rω/v); error about 1e-12.

    Raises
    ------
    InputError, ContactError
        As :func:`curvature_slope`.

    Notes
    -----
    With s = −ln Q, du/ds = (1 − ρ_ω/ρ_∥)/(cos²φ + sin²φ ρ_ω/ρ_∥); at φ₀ the denominator is 1.  The
    derivative is a central difference of order 8.

    Examples
    --------
    >>> approach_exponent([0.0, 0.5, 1.0]).round(4).tolist()
    [0.6151, 0.6772, 0.8611]
    """
    u0 = np.log(limit_ratio(_full_contact(delta)))
    step = 0.01
    slope = np.zeros_like(u0)
    for n, weight in enumerate((4 / 5, -1 / 5, 4 / 105, -1 / 280), start=1):
        slope += weight * (_spin_ratio(u0 + n * step, delta) - _spin_ratio(u0 - n * step, delta))
    return slope / step


def _spin_ratio(u: FloatArray, delta: npt.ArrayLike) -> FloatArray:
    """ρ_ω/ρ_∥ at u = ln(rω/v)."""
    rho = resultants(np.arctan(np.exp(u)), delta)
    return rho.spin / rho.parallel


def regime(
    velocity: npt.ArrayLike,
    spin: float,
    delta: float = 0.5,
    radius: float = 1.0,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
) -> str:
    """Which of the six kinds of motion a launch starts.

    Parameters
    ----------
    velocity : (vx, vy), m/s
    spin : rad/s
    delta, pressure, gyration
        As :func:`limit_ratio`, a number each.
    radius : m, > 0

    Returns
    -------
    str
        A rest, B0 pure spin, C0 pure translation, D the limit motion (rω/v constant), B generic
        with more spin than that, C generic with less.

    Raises
    ------
    InputError, ContactError
        If an argument is not finite or lies outside its range.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2.

    Examples
    --------
    >>> regime((1.0, 0.0), 5.0), regime((3.0, 4.0), 0.0)
    ('B', 'C0')
    """
    components = one_velocity(velocity)
    turning, r = real("spin", spin, "rad/s"), positive("radius", radius, "m")
    ratio = float(limit_ratio(real("delta", delta, "2 f h / r"), pressure, gyration))
    limit = math.log(ratio) if ratio > 0.0 else -math.inf
    return regime_of(math.hypot(*components), r * abs(turning), limit)


def regime_of(speed: float, rim_speed: float, limit: float, width: float = LIMIT_WIDTH) -> str:
    """The regime of a launch from v and r|ω|, checked before.

    ``speed``: v ≥ 0; ``rim_speed``: r|ω| ≥ 0; ``limit``: ln tan φ₀ of the puck, −inf and inf where
    there is none between 0 and π/2; ``width``: a start this close to it is the limit motion.
    Returns a key of :data:`REGIMES`.

    >>> regime_of(1.0, 5.0, 0.42), regime_of(1.0, 0.0, 0.42)
    ('B', 'C0')
    """
    if speed == 0.0:
        return "A" if rim_speed == 0.0 else "B0"
    if rim_speed == 0.0:
        return "C0"
    gap = log_ratio(speed, rim_speed) - limit
    if abs(gap) <= width:
        return "D"
    return "B" if gap > 0.0 else "C"


@kernel
def log_ratio(speed: float, rim_speed: float) -> float:
    """ln(r|ω|/v), exact to the last digits also where the quotient would overflow."""
    ratio = rim_speed / speed
    if 1e-290 < ratio < 1e290:
        return math.log(ratio)
    return math.log(rim_speed) - math.log(speed)
