"""What the user has: a puck, a floor, a launch; checked once, at the door."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError
from puck_tables.real import finite_array, refuse_mask

STANDARD_GRAVITY = 9.80665


def positive(name: str, value: float, unit: str) -> float:
    """A finite number greater than zero.

    Raises
    ------
    InputError

    Examples
    --------
    >>> positive("radius", 0.04, "m")
    0.04
    """
    number = real(name, value, unit)
    if not number > 0.0:
        raise InputError(f"{name} must be greater than 0 ({unit}), got {number:g}")
    return number


def real(name: str, value: float, unit: str) -> float:
    """A finite number.

    Raises
    ------
    InputError

    Examples
    --------
    >>> real("w0", 5, "rad/s")
    5.0
    """
    refuse_mask(name, value)
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must be a number ({unit}), got {value!r:.60}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be a finite number ({unit}), got {number}")
    return number


def similarity_parameters(
    radius: float, height: float, friction: float, gravity: float = STANDARD_GRAVITY
) -> tuple[float, float]:
    """δ and J of a real puck: the two numbers its motion depends on besides its radius.

    Parameters
    ----------
    radius, height : metres
    friction : Coulomb coefficient f
    gravity : m/s²

    Returns
    -------
    delta, decel
        δ = 2fh/r (dimensionless height) and J = fg (m/s²).

    Raises
    ------
    InputError
        If a number is not finite or not greater than zero, or δ or J is out of range.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 1.

    Examples
    --------
    >>> similarity_parameters(radius=0.0381, height=0.0254, friction=0.1)  # ice-hockey puck
    (0.13333333333333333, 0.980665)
    """
    r, h = positive("radius", radius, "m"), positive("height", height, "m")
    f, g = positive("friction", friction, "dimensionless"), positive("gravity", gravity, "m/s^2")
    delta, decel = 2.0 * f * h / r, f * g
    if not math.isfinite(delta) or not math.isfinite(decel) or decel == 0.0:
        raise InputError(
            f"radius {r:g} m, height {h:g} m, friction {f:g} and gravity {g:g} m/s^2 give "
            f"delta = {delta:g} and J = {decel:g} m/s^2: out of the range of floating point"
        )
    return delta, decel


def velocity_array(v0: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Velocities of shape (…, 2), m/s.

    Raises
    ------
    InputError

    Examples
    --------
    >>> velocity_array((1, 0))
    array([1., 0.])
    """
    velocity = finite_array("v0", v0, "m/s")
    if velocity.ndim == 0 or velocity.shape[-1] != 2:
        raise InputError(
            f"v0 must have two components (vx, vy) in m/s, got an array of shape {velocity.shape}"
        )
    return velocity
