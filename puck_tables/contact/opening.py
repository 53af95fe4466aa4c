"""Where contact first opens: the height at which the tilted pressure touches zero.

The linear pressure of full contact is nowhere negative while b̂² + ĉ² ≤ 1.  With δ = 2fh/r and
Δ = 1 − δ² sin²φ p_b p_c (Salnikova, Treschev, Gallyamov 2012, eq. 5.2 and 5.3) that is

    Δ² ≥ δ² cos²φ p_a² (1 + δ² sin²φ p_b²),

a quadratic equation in Y = 1/δ² at its limit.  Towards φ = π/2 it has no positive root: a puck that
spins fast enough keeps its whole base loaded at every height.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import integrals
from puck_tables.contact.integrals import slip_direction


def critical_delta(phi: npt.ArrayLike) -> FloatArray:
    """The height δ_c(φ) up to which the whole base stays loaded (uniform pressure).

    Parameters
    ----------
    phi : array_like, radians, any shape, in [−π/2, π/2]

    Returns
    -------
    array of the shape of ``phi``
        Dimensionless; inf where contact never opens.

    Raises
    ------
    InputError
        If an angle is not finite or lies outside [−π/2, π/2].

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 5.3 (the square there stands under sin φ too).

    Examples
    --------
    >>> critical_delta([0.0, np.pi / 4, np.pi / 2]).round(8).tolist()
    [1.0, 1.15913851, inf]
    """
    p = integrals(phi)
    direction = slip_direction(phi)
    stiffening = -direction.sin_squared * p.b * p.c
    along = direction.cos_squared * p.a**2
    across = direction.sin_squared * p.b**2
    # (Y + stiffening)² = along (Y + across): Y² − 2 half Y + product = 0, the larger root
    half = 0.5 * along - stiffening
    product = stiffening**2 - along * across
    discriminant = half**2 - product
    opens = (discriminant >= 0.0) & ((half > 0.0) | (product < 0.0))
    root = np.sqrt(np.where(opens, discriminant, 1.0))
    larger = np.where(half > 0.0, half + root, -product / np.where(half > 0.0, 1.0, root - half))
    return np.where(opens, 1.0 / np.sqrt(np.where(opens, larger, 1.0)), np.inf)
