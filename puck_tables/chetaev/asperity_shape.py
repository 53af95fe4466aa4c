"""The wavy support of Chetaev's model: its shape, and how it presses on the point."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast, finite_array, positive, real
from puck_tables.errors import InputError


@dataclass(frozen=True)
class Asperity:
    """The support and the point on it.

    Parameters
    ----------
    amplitude : float, a > 0, m
    length : float, b > 0, m: the wavelength is 2πb
    load : float, −Y > 0, N
    mass : float, m > 0, kg
    pull : float, X, N

    Raises
    ------
    InputError
        If a number is not finite or not positive.

    Examples
    --------
    >>> bumps = Asperity(amplitude=1e-6, length=4e-6, load=1.0, mass=0.1)
    >>> bumps.slope, round(bumps.lift_speed, 6)  # leaves the crest: x′² = −Y b²/(m a)
    (0.25, 0.012649)
    """

    amplitude: float
    length: float
    load: float
    mass: float
    pull: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("amplitude", "m"), ("length", "m"), ("load", "N"), ("mass", "kg")):
            object.__setattr__(self, name, positive(name, getattr(self, name), unit))
        object.__setattr__(self, "pull", real("pull", self.pull, "N"))

    @property
    def slope(self) -> float:
        """κ = a/b: the steepest slope, and Coulomb's coefficient of the crude law."""
        return self.amplitude / self.length

    @property
    def lift_speed(self) -> float:
        """V₀ = b √(−Y/(m a)), m/s: a point that is not pulled leaves the crest above it."""
        return self.length * math.sqrt(self.load / (self.mass * self.amplitude))

    def height(self, x: npt.ArrayLike) -> FloatArray:
        """−a cos(x/b), m, at places x in m."""
        return np.asarray(self._height(finite_array("x", x, "m")))

    def incline(self, x: npt.ArrayLike) -> FloatArray:
        """dy/dx of the support, κ sin(x/b), at places x in m."""
        return np.asarray(self._incline(finite_array("x", x, "m")))

    def press(self, x: npt.ArrayLike, speed: npt.ArrayLike) -> FloatArray:
        """The numerator of λ, N: negative where the support falls away under a flying point."""
        place, rate = broadcast(
            x=finite_array("x", x, "m"), speed=finite_array("speed", speed, "m/s")
        )
        with np.errstate(over="ignore", invalid="ignore"):
            press = np.asarray(self._press(place, rate))
        if not np.isfinite(press).all():
            raise InputError("x and speed give a press too large for floating point")
        return press

    def multipliers(self, x: npt.ArrayLike, speed: npt.ArrayLike) -> tuple[FloatArray, ...]:
        """λ exact, by its leading terms, and crude, in N, not cut at 0: below there is no contact.

        Parameters
        ----------
        x : array_like, m
        speed : array_like, x′ in m/s, broadcast

        Examples
        --------
        >>> bumps = Asperity(amplitude=1.0, length=1.0, load=2.0, mass=1.0)
        >>> [float(lam.round(6)) for lam in bumps.multipliers(np.pi / 4, 1.0)]
        [1.804738, 2.707107, 2.0]
        """
        press = self.press(x, speed)
        pulled = self.pull * self._incline(np.asarray(x))
        exact = press / (1.0 + self._incline(np.asarray(x)) ** 2)
        return exact, press - pulled, np.full(press.shape, self.load)

    def _height(self, x: Any) -> Any:
        return -self.amplitude * np.cos(x / self.length)

    def _incline(self, x: Any) -> Any:
        return self.slope * np.sin(x / self.length)

    def _press(self, x: Any, speed: Any) -> Any:
        bend = self.mass * self.amplitude / self.length**2 * speed**2 * np.cos(x / self.length)
        return self.load + bend + self.pull * self._incline(x)
