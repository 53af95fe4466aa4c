"""The universal curve: how Q and the heading go with the slip angle, in regular parts.

Along every generic motion ln Q and the heading ψ are functions of u = ln(rω/v) alone, up to a
constant.  With c = tanh(u/2) = (rω − v)/(rω + v), c₀ its limit, and

    du/d ln Q = −ρ(u),    ρ = (1 − ρ_ω/ρ_∥) N,    N = 1/(cos²φ + sin²φ ρ_ω/ρ_∥),
    dψ/d ln Q = h(u) = sin φ (ρ_⊥/ρ_∥) N,

ln Q has poles of dlnQ/du at u₀ and straight ends, all known:

    ln Q = (1/κ) ln|c − c₀| − (1/A) ln(1 + c) − (1/B) ln(1 − c) + R(u)
    ψ = h₀ ln Q + (h₀/A) ln(1 + c) + ((h₀ − h₁)/B) ln(1 − c) + S(u)

with κ = −ρ′(u₀), A = ρ(−∞) = ½ + δ²/8, B = −ρ(+∞), h₀ = h(u₀), h₁ = h(+∞).  R and S/δ are bounded,
smooth across u₀ and zero at u = 0 (φ = π/4); they are what the table holds.

Source: Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7, where the motion is found in quadratures.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import shape_integrals
from puck_tables.contact.laws import law_of, limit_ratio
from puck_tables.stopping.axes import SlipAxis, ratio_at

# half width in u of the neighbourhood of u₀ that is treated by polynomials, and their degree: both
# ways to the slopes meet to 4e-12, as test_regular_slopes_pass_the_limit_smoothly tells
_NEAR_LIMIT = 0.15
_DEGREE = 23
_COUNT = 10  # of Gauss's rule a cell: test_parts_are_the_integrals_of_their_slopes
_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)


class Limits(NamedTuple):
    """u₀, κ, A, B, h₀, h₁ of the module's docstring, at one δ."""

    u: float
    kappa: float
    slow: float
    fast: float
    turn: float
    spin_turn: float


def rates(u: FloatArray, delta: float) -> tuple[FloatArray, FloatArray]:
    """ρ(u) and h(u), from the closed forms.

    >>> rho, _ = rates(np.array([-np.inf, np.inf]), 1.0)
    >>> rho.round(12).tolist()
    [0.625, -0.325]
    """
    k = np.exp(-np.abs(u))
    rho, _, turning = rates_of_ratio(k, u > 0.0, delta)
    sine = np.where(u > 0.0, 1.0, k) / np.hypot(1.0, k)
    return rho, sine * delta * turning


def rates_of_ratio(
    k: FloatArray, fast: npt.ArrayLike, delta: npt.ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """ρ, N/ρ_∥ and h/(δ sin φ) at ratios k of the slower to the faster of v and r|ω|.

    ``fast``: where r|ω| is the faster.

    >>> [float(one.round(6)) for one in rates_of_ratio(np.array(0.0), False, 1.0)]
    [0.625, 1.0, 0.25]
    """
    rotates = np.broadcast_to(np.asarray(fast, np.float64), k.shape)
    p_a, p_b, p_d = shape_integrals(k, rotates)
    share = 1.0 / (1.0 + k * k)
    cos2 = share * np.where(rotates > 0.0, k * k, 1.0)
    sin2 = share * np.where(rotates > 0.0, 1.0, k * k)
    d2 = np.square(delta)
    inverse = (1.0 - d2 * sin2 * p_b * (p_b - p_d)) / p_a
    spin = 2.0 * (p_d * inverse + d2 * cos2 * p_b * (p_d - 2.0 * p_b))
    norm = 1.0 / (cos2 + sin2 * spin)
    return (1.0 - spin) * norm, inverse * norm, p_b * norm


def limits(delta: float) -> Limits:
    """The constants of the curve.

    >>> [round(x, 6) for x in limits(0.5)]
    [0.414767, 0.677204, 0.53125, 0.27027, 0.140965, 0.121622]
    """
    return _near_limit(delta)[0]


def _near_limit(delta: float) -> tuple[Limits, Any, Any]:
    """The constants, and next to u₀ the regular parts of dlnQ/du and dψ/du as Chebyshev series.

    ρ and h − h₀ vanish at u₀; dividing their series by u − u₀ loses no digits.
    """
    u0 = math.log(limit_ratio(law_of("uniform"), delta))

    def at(x: FloatArray) -> FloatArray:
        return u0 + _NEAR_LIMIT * x

    def over_x(series: Any) -> Any:
        return chebyshev.chebdiv(series, [0.0, 1.0])[0]

    nodes = chebyshev.chebpts1(_DEGREE + 1)
    x = _NEAR_LIMIT * nodes
    rho, h = rates(at(nodes), delta)
    slope = over_x(chebyshev.chebfit(nodes, rho, _DEGREE)) / _NEAR_LIMIT  # ρ/(u − u₀)
    turning = chebyshev.chebfit(nodes, h, _DEGREE)
    kappa = -float(chebyshev.chebval(0.0, slope))
    h0 = float(chebyshev.chebval(0.0, turning))
    divided = chebyshev.chebval(nodes, slope)
    # (u − u₀) × [−1/ρ − c′/(κ (c − c₀))], which is zero at u₀
    numerator = -1.0 / divided - x * _limit_pole(at(nodes), u0) / kappa
    pole_free = over_x(chebyshev.chebfit(nodes, numerator, _DEGREE)) / _NEAR_LIMIT
    turning[0] -= h0
    turn = -chebyshev.chebval(nodes, over_x(turning)) / _NEAR_LIMIT / divided
    ends, h_ends = rates(np.array([-math.inf, math.inf]), delta)
    constants = Limits(u0, kappa, float(ends[0]), -float(ends[1]), h0, float(h_ends[1]))
    return constants, pole_free, chebyshev.chebfit(nodes, turn, _DEGREE)


def _limit_pole(u: FloatArray, u0: float) -> FloatArray:
    """c′/(c − c₀), c′ = dc/du."""
    pole: FloatArray = 0.5 * np.cosh(0.5 * u0) / (np.cosh(0.5 * u) * np.sinh(0.5 * (u - u0)))
    return pole


def regular_slopes(u: FloatArray, delta: float) -> tuple[FloatArray, FloatArray]:
    """dR/du and dS/du at finite u.

    >>> [float(x.round(6)) for x in regular_slopes(np.array(-1.0), 0.5)]
    [-0.570145, -0.006117]
    """
    constants, pole_free, turning = _near_limit(delta)
    u0, kappa, slow, fast, h0, h1 = constants
    near = np.abs(u - u0) < _NEAR_LIMIT
    away = np.where(near, u0 + 1.0, u)
    rho, h = rates(away, delta)
    x = np.where(near, (u - u0) / _NEAR_LIMIT, 0.0)
    pole = chebyshev.chebval(x, pole_free)
    pole = np.where(near, pole, -1.0 / rho - _limit_pole(away, u0) / kappa)
    turn = np.where(near, chebyshev.chebval(x, turning), -(h - h0) / rho)
    to_left = 1.0 / (1.0 + np.exp(u))  # (1 − c)/2 = c′/(1 + c)
    to_right = 1.0 / (1.0 + np.exp(-u))
    return (
        pole + to_left / slow - to_right / fast,
        turn - (h0 / slow) * to_left + ((h0 - h1) / fast) * to_right,
    )


def regular_parts(axis: SlipAxis, delta: float) -> FloatArray:
    """R and S at the nodes of the axis, shape (2 cells + 1, 2).

    Gauss quadrature of the slopes over the cells, outwards from φ = π/4.

    >>> regular_parts(SlipAxis(8), 0.5)[0].round(6).tolist()
    [1.200562, 0.026914]
    """
    n = axis.cells
    left = np.arange(n) / n
    xi = left[:, None] + (0.5 + 0.5 * _GAUSS_NODES) / n
    k = ratio_at(xi)
    # du/dξ = ±(dk/dξ)/k,  k = q⁴/(2 − q⁴)
    q = xi * (2.0 - xi)
    stretch = 8.0 * q**3 * 2.0 * (1.0 - xi) / (2.0 - q**4) ** 2 / k
    weight = stretch * _GAUSS_WEIGHTS * 0.5 / n
    sides = []
    for sign in (1.0, -1.0):  # u = ln k below π/4, −ln k above
        slopes = np.stack(regular_slopes(sign * np.log(k), delta), axis=-1)
        cells = sign * np.sum(slopes * weight[:, :, None], axis=1)
        parts = np.zeros((n + 1, 2))  # from k = 1 back to each node
        parts[:-1] = -np.cumsum(cells[::-1], axis=0)[::-1]
        sides.append(parts)
    return np.concatenate([sides[0], sides[1][-2::-1]])
