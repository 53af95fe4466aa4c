"""Pressure laws: how the load is spread over the base before friction tilts it.

The contact pressure of a sliding puck is σ = (N/πr²) W(ρ) (1 + b̂ x/r + ĉ y/r) with W an
axisymmetric weight normalised to ∫₀¹ W ρ dρ = 1/2.  The friction integrals need W only through
its chord moments.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray

# Half of the Gauss-Legendre rule for χ ∈ [-π/2, π/2]; the integrands are even in χ.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_CHI = 0.5 * np.pi * _NODES[24:]
_CHI_WEIGHT = np.pi * _WEIGHTS[24:]


@dataclass(frozen=True)
class PressureLaw:
    """An axisymmetric pressure law on the unit disc.

    ``name``: the name a table file carries; ``weight``: W(ρ), shape-preserving, for ρ in [0, 1);
    normalised to ∫ W ρ dρ = 1/2; ``moments``: the chord moments as functions of L² = 1 − distance²,
    where they are elementary.

    >>> UNIFORM.name
    'uniform'
    """

    name: str
    weight: Callable[[FloatArray], FloatArray]
    moments: Callable[[FloatArray], tuple[FloatArray, FloatArray]] | None = None

    def chord_moments(self, distance: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Moments ∫ W dl and ∫ W l² dl along the chord at a distance from the centre.

        l = L sin χ with L² = 1 − distance² removes the square-root ends of every law that is
        smooth in ρ² and √(1 − ρ²).

        ``distance``: array, any shape, distance of the chord from the centre of the unit disc, in
        [0, 1].  Returns tuple of two arrays of the same shape.

        >>> zeroth, second = UNIFORM.chord_moments(np.array([0.6]))
        >>> float(zeroth[0].round(12)), float(second[0].round(12))
        (1.6, 0.341333333333)
        """
        square = (1.0 - distance) * (1.0 + distance)
        if self.moments is not None:
            return self.moments(square)
        half_length = np.sqrt(square)[..., None]
        position = half_length * np.sin(_CHI)
        radius = np.sqrt(distance[..., None] ** 2 + position**2)
        radius = np.minimum(radius, 1.0 - 2.0**-53)  # rounding must not reach the rim
        element = self.weight(radius) * half_length * np.cos(_CHI) * _CHI_WEIGHT
        return element.sum(axis=-1), (element * position**2).sum(axis=-1)


UNIFORM = PressureLaw("uniform", np.ones_like)


def _galin(rho: FloatArray) -> FloatArray:
    return np.asarray(0.5 / np.sqrt((1.0 - rho) * (1.0 + rho)))


def _galin_moments(square: FloatArray) -> tuple[FloatArray, FloatArray]:
    return np.full_like(square, 0.5 * np.pi), 0.25 * np.pi * square


def _hertz(rho: FloatArray) -> FloatArray:
    return np.asarray(1.5 * np.sqrt((1.0 - rho) * (1.0 + rho)))


def _hertz_moments(square: FloatArray) -> tuple[FloatArray, FloatArray]:
    return 0.75 * np.pi * square, 0.1875 * np.pi * square**2


# The pressure under a rigid flat punch on an elastic floor, infinite at the rim (Galin 1953), and
# under a ball of large radius (Hertz 1881); ∫ l² dl/√(L² − l²) = π L²/2 and its like.  Functions
# with names: a law goes to other processes.
GALIN = PressureLaw("galin", _galin, _galin_moments)
HERTZ = PressureLaw("hertz", _hertz, _hertz_moments)
