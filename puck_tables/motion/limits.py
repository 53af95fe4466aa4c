"""The limit motion: the slip angle that every generic motion approaches, and the five regimes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.contact.closed_form import integrals
from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import ContactError, InputError
from puck_tables.kernels.closed_form import friction_ratios, resultants
from puck_tables.kernels.compile import kernel
from puck_tables.real import finite_array

FloatArray = npt.NDArray[np.float64]

# A start this close to the limit ratio (in ln(rω/v)) is the limit motion itself.
LIMIT_WIDTH = 1e-13

REGIMES = {
    "A": "rest",
    "B0": "pure spin",
    "C0": "pure translation",
    "D": "limit motion, r w/v constant",
    "B": "spin-rich, r w/v falls towards the limit ratio",
    "C": "spin-poor, r w/v grows towards the limit ratio",
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


def limit_ratio(delta: npt.ArrayLike) -> FloatArray:
    """The ratio rω/v that every generic motion approaches at its stop, tan φ₀(δ).

    Parameters
    ----------
    delta : array_like, dimensionless, in [0, 1]

    Returns
    -------
    array of the same shape

    Raises
    ------
    InputError
        If a height is not finite or negative.
    ContactError
        If a height is above 1, where full contact is not certain.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 7–8.

    Examples
    --------
    >>> float(limit_ratio(0.0).round(12))
    1.531389372174
    """
    height = checked_delta(delta)
    if not np.all(height <= 1.0):
        raise ContactError(
            f"delta = {height[height > 1.0].flat[0]:g}: the limit motion is known for full "
            "contact, 0 <= delta <= 1"
        )
    return np.vectorize(lambda d: math.exp(limit_log_ratio(d)), otypes=[float])(height)


def limit_angle(delta: npt.ArrayLike) -> FloatArray:
    """The slip angle φ₀ that every generic motion approaches at its stop: arctan of limit_ratio.

    Parameters
    ----------
    delta : array_like, dimensionless, in [0, 1]

    Returns
    -------
    array of the same shape, radians
        φ₀ with ρ_∥(φ₀) = ρ_ω(φ₀).

    Raises
    ------
    InputError, ContactError
        As :func:`limit_ratio`.

    Examples
    --------
    >>> float(limit_angle(0.5).round(12))
    0.987079101411
    """
    return np.arctan(limit_ratio(delta))


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
    InputError, ContactError
        As :func:`limit_ratio`.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2, result 8.

    Examples
    --------
    >>> curvature_slope([0.0, 0.5, 1.0]).round(8).tolist()
    [7.06673562, 7.09397854, 7.15668696]
    """
    angle = limit_angle(delta)
    slope: FloatArray = 2.0 / (np.sin(angle) * integrals(angle).b)
    return slope


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
        As :func:`limit_ratio`.

    Notes
    -----
    With s = −ln Q, du/ds = (1 − ρ_ω/ρ_∥)/(cos²φ + sin²φ ρ_ω/ρ_∥); at φ₀ the denominator is 1.  The
    derivative is a central difference of order 8.

    Examples
    --------
    >>> approach_exponent([0.0, 0.5, 1.0]).round(4).tolist()
    [0.6151, 0.6772, 0.8611]
    """
    u0 = np.log(limit_ratio(delta))
    step = 0.01
    slope = np.zeros_like(u0)
    for n, weight in enumerate((4 / 5, -1 / 5, 4 / 105, -1 / 280), start=1):
        slope += weight * (_spin_ratio(u0 + n * step, delta) - _spin_ratio(u0 - n * step, delta))
    return slope / step


def _spin_ratio(u: FloatArray, delta: npt.ArrayLike) -> FloatArray:
    """ρ_ω/ρ_∥ at u = ln(rω/v)."""
    rho = resultants(np.arctan(np.exp(u)), delta)
    ratio: FloatArray = rho.spin / rho.parallel
    return ratio


def regime(v0: npt.ArrayLike, w0: float, delta: float = 0.5, radius: float = 1.0) -> str:
    """Which of the six kinds of motion a launch starts.

    Parameters
    ----------
    v0 : (vx, vy), m/s
    w0 : spin, rad/s
    delta : dimensionless height, in [0, 1]
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
    velocity = finite_array("v0", v0, "m/s")
    if velocity.shape != (2,):
        raise InputError(f"v0 must be one velocity (vx, vy) in m/s, got shape {velocity.shape}")
    spin, r = finite_array("w0", w0, "rad/s"), finite_array("radius", radius, "m")
    if spin.shape != () or r.shape != () or not r > 0.0:
        raise InputError("w0 and radius must be numbers, radius greater than 0 m")
    limit = math.log(float(limit_ratio(delta)))
    return regime_of(math.hypot(*velocity.tolist()), float(r * abs(spin)), limit)


def elementary_stop_time(
    v0: npt.ArrayLike, w0: float, delta: float = 0.5, decel: float = 1.0, radius: float = 1.0
) -> float | None:
    """The stop time of a launch whose motion is elementary; None for a generic one (B or C).

    Parameters
    ----------
    v0, w0, delta, radius
        As :func:`regime`.
    decel : J = fg, m/s², > 0

    Returns
    -------
    float or None, s
        A: 0.  C0: v/J.  B0: ¾ r|ω|/J.  D: Q/(J ρ_∥(φ₀)), Q = hypot(v, rω).

    Raises
    ------
    InputError, ContactError
        If an argument is not finite or lies outside its range.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2.

    Examples
    --------
    >>> elementary_stop_time((3.0, 4.0), 0.0), elementary_stop_time((0.0, 0.0), -2.0, radius=0.5)
    (5.0, 0.75)
    """
    kind = regime(v0, w0, delta, radius)
    deceleration = float(finite_array("decel", decel, "m/s^2"))
    if not deceleration > 0.0:
        raise InputError(f"decel must be greater than 0 m/s^2, got {decel:g}")
    speed, rim = math.hypot(*np.asarray(v0, dtype=np.float64).tolist()), radius * abs(w0)
    if kind == "D":
        parallel = float(resultants(limit_angle(delta), delta).parallel)
        return math.hypot(speed, rim) / (deceleration * parallel)
    times = {"A": 0.0, "C0": speed / deceleration, "B0": 0.75 * rim / deceleration}
    return times.get(kind)


def regime_of(speed: float, rim_speed: float, limit: float) -> str:
    """The same from v and r|ω|, checked before.

    Parameters
    ----------
    speed : v ≥ 0
    rim_speed : r|ω| ≥ 0
    limit : ln tan φ₀ of the puck

    Returns
    -------
    str, a key of :data:`REGIMES`

    Examples
    --------
    >>> regime_of(1.0, 5.0, 0.42), regime_of(1.0, 0.0, 0.42)
    ('B', 'C0')
    """
    if speed == 0.0:
        return "A" if rim_speed == 0.0 else "B0"
    if rim_speed == 0.0:
        return "C0"
    gap = log_ratio(speed, rim_speed) - limit
    if abs(gap) <= LIMIT_WIDTH:
        return "D"
    return "B" if gap > 0.0 else "C"


@kernel
def log_ratio(speed: float, rim_speed: float) -> float:
    """ln(r|ω|/v), exact to the last digits also where the quotient would overflow."""
    ratio = rim_speed / speed
    if 1e-290 < ratio < 1e290:
        return math.log(ratio)
    return math.log(rim_speed) - math.log(speed)
