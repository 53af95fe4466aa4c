"""The five integrals by direct quadrature about the instantaneous centre of rotation.

With polar coordinates about the instantaneous centre (0, s), s = cot φ, the slip velocity at
distance R along the ray with angle a from −y is R (cos a, sin a) up to a factor, so the 1/w of the
integrands cancels against R dR da.  On the chord of the ray, with l measured from its foot (the
point nearest to the disc's centre, at distance d = s |sin a|), all integrands are polynomials of
degree ≤ 2 in l times the pressure weight; two chord moments M₀(d) = ∫W dl and M₂(d) = ∫W l² dl are
all that is left, and one integral over the ray.  Odd powers of l drop out, the signs of the two
halves of a chord through the centre of rotation cancel, and so the same integrals serve when the
centre of rotation lies inside the disc (variable a) and outside (variable χ, sin χ = s sin a).

Nothing here is shared with the closed forms, so that each can judge the other.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import PatchIntegrals, slip_direction
from puck_tables.contact.pressure import UNIFORM, PressureLaw

# Composite Gauss-Legendre rule on [0, π/2], panels halved towards π/2: near |φ| = π/4 the integrand
# has a branch point at any distance from the end, and every panel stays as far from it as it is
# long, so the error is below rounding at every φ: test_quadrature; an eighth of them are too few.
_PANELS = 32
_GAUSS_NODES = 14  # of Gauss's rule a panel


def _graded_rule() -> tuple[FloatArray, FloatArray]:
    """Distances from the end and weights of the rule."""
    node, weight = np.polynomial.legendre.leggauss(_GAUSS_NODES)
    edges = np.append(0.5 * np.pi * 0.5 ** np.arange(_PANELS), 0.0)
    half = 0.5 * (edges[:-1] - edges[1:])
    middle = 0.5 * (edges[:-1] + edges[1:])
    return (middle[:, None] + half[:, None] * node).ravel(), (half[:, None] * weight).ravel()


FROM_END, WEIGHT = _graded_rule()
_SIN, _COS = np.cos(FROM_END), np.sin(FROM_END)
_CHUNK = 64  # points at once: their rules fit the cache


def integrals(phi: npt.ArrayLike, law: PressureLaw = UNIFORM) -> PatchIntegrals:
    """The five integrals p_a … p_e by direct quadrature.

    Salnikova, Treschev, Gallyamov 2012, eq. 4.3–4.6.

    ``phi``: array_like, radians, any shape, in [−π/2, π/2]; ``law``: the axisymmetric pressure
    weight; uniform by default.  Returns PatchIntegrals: dimensionless, each of the shape of
    ``phi``; error at most 1e-14.  Raises InputError if an angle is not finite or lies outside
    [−π/2, π/2].

    >>> float(integrals(np.pi / 2).d.round(13))  # 2/3 for a puck that only spins
    0.6666666666667
    """
    direction = slip_direction(phi)
    ratio, fast = np.ravel(direction.ratio), np.ravel(direction.fast_spin)
    result = np.empty((5, ratio.size))
    for start in range(0, ratio.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        result[:, part] = np.where(
            fast[part], _centre_inside(ratio[part], law), _centre_outside(ratio[part], law)
        )
    return PatchIntegrals(*(row.reshape(np.shape(phi)) for row in result))


def _centre_inside(s: FloatArray, law: PressureLaw) -> FloatArray:
    """|φ| ≥ π/4: s = cot φ ≤ 1, integration over a ∈ [0, π/2] (doubled by symmetry)."""
    s = s[:, None]
    zeroth, second = law.chord_moments(s * _SIN)
    integrand = (
        _COS**2 * zeroth,
        _SIN**2 * (s**2 * _COS**2 * zeroth + second),
        _COS**2 * (s**2 * _SIN**2 * zeroth - second),
        second,
        (_SIN**2 - _COS**2) * second,
    )
    factor = 2.0 / np.pi * np.sqrt(1.0 + s[:, 0] ** 2)  # 2/(π sin φ)
    return np.stack([factor * (term @ WEIGHT) for term in integrand])


def _centre_outside(kappa: FloatArray, law: PressureLaw) -> FloatArray:
    """|φ| ≤ π/4: κ = tan φ = 1/s ≤ 1, integration over χ ∈ [0, π/2] (doubled by symmetry)."""
    zeroth, second = (moment * _COS * WEIGHT for moment in law.chord_moments(_SIN))
    kappa = kappa[:, None]
    cos_a = np.sqrt((1.0 - kappa * _SIN) * (1.0 + kappa * _SIN))
    integrand = (
        cos_a * zeroth,
        _SIN**2 * (cos_a * zeroth + kappa**2 / cos_a * second),
        cos_a * (_SIN**2 * zeroth - second),
        second / cos_a,
        second * (kappa**2 * _SIN**2 / cos_a - cos_a),
    )
    factor = 2.0 / np.pi * np.sqrt(1.0 + kappa[:, 0] ** 2)  # 2/(π cos φ)
    return np.stack([factor * term.sum(axis=-1) for term in integrand])
