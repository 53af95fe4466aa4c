"""The limit motion: the slip angle that every generic motion approaches, and the five regimes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import ContactError
from puck_tables.kernels.closed_form import friction_ratios
from puck_tables.kernels.compile import kernel

FloatArray = npt.NDArray[np.float64]

# A start this close to the limit ratio (in ln(rω/v)) is the limit motion itself.
LIMIT_WIDTH = 1e-12

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


def limit_angle(delta: npt.ArrayLike) -> FloatArray:
    """The slip angle φ₀ that every generic motion approaches at its stop.

    Parameters
    ----------
    delta : array_like, dimensionless, in [0, 1]

    Returns
    -------
    array of the same shape, radians
        φ₀ with ρ_∥(φ₀) = ρ_ω(φ₀); tan φ₀ = rω/v is the limit ratio.

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
    >>> float(limit_angle(0.5).round(12))
    0.987079101411
    """
    height = checked_delta(delta)
    if not np.all(height <= 1.0):
        raise ContactError(
            f"delta = {height[height > 1.0].flat[0]:g}: the limit angle is known for full contact, "
            "0 <= delta <= 1"
        )
    return np.vectorize(lambda d: math.atan(math.exp(limit_log_ratio(d))), otypes=[float])(height)


def regime_of(speed: float, rim_speed: float, limit: float) -> str:
    """Which of the six kinds of motion a launch starts.

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
