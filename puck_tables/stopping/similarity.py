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

The curve is inverted at the nodes of a stop table, for all of them at once: from the place by the
time that is left, or by Q, back to the ratio of speed and spin, and what stands there; what it is
see :mod:`puck_tables.stopping.similarity_lookup`.  Arrays (2 sides, nodes, heights).

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
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping.lookup import HEIGHTS, SlipAxis, heights, ratio_at
from puck_tables.stopping.similarity_lookup import TINY, end_rates
from puck_tables.table.spline_fit import clamped_coefficients

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
    slope = 8.0 * q**3 * 2.0 * (1.0 - xi) / (2.0 - q**4) ** 2 / k
    weight = slope * _GAUSS_WEIGHTS * 0.5 / n
    sides = []
    for sign in (1.0, -1.0):  # u = ln k below π/4, −ln k above
        slopes = np.stack(regular_slopes(sign * np.log(k), delta), axis=-1)
        cells = sign * np.sum(slopes * weight[:, :, None], axis=1)
        parts = np.zeros((n + 1, 2))  # from k = 1 back to each node
        parts[:-1] = -np.cumsum(cells[::-1], axis=0)[::-1]
        sides.append(parts)
    return np.concatenate([sides[0], sides[1][-2::-1]])


_TIME, _ALONG, _ACROSS, _LENGTH, _BODY, _LOG_RATIO, _TURN = range(7)  # as the table has them
_FAST = np.array([False, True])[:, None, None]  # the side of r|ω| > v
_ROUNDING = 2e-16  # of a double
_LOOKS = 100  # at most


class InverseSolution:
    """Functions of a stop table at its nodes (2, cells + 1, 9, 7), and constants of its heights."""

    def __init__(self, constants: FloatArray, sides: FloatArray) -> None:
        delta = heights()
        self.delta, self.cells = delta, sides.shape[1] - 1
        self.slow, self.fast, self.spin_turn = end_rates(delta)  # type: ignore[arg-type]
        powers = (2.0 * delta * delta - 1.0) ** np.arange(constants.shape[1])[:, None]
        self.c0, self.kappa, turning, self.quarter = constants @ powers
        self.turning = delta * turning
        splines = clamped_coefficients(np.moveaxis(sides, 1, 0)) / 6.0
        self.splines = np.ascontiguousarray(splines.transpose(3, 1, 0, 2))

    def at(self, function: int, xi: FloatArray) -> FloatArray:
        """One function at places on the axis of slip (2, n, heights)."""
        place = xi * self.cells
        cell = np.clip(place.astype(np.int64), 0, self.cells - 1)
        weights = basis(place - cell)
        spline = self.splines[function]
        rows = (np.take_along_axis(spline, cell + k, axis=1) for k in range(4))
        return np.asarray(sum(w * row for w, row in zip(weights, rows, strict=True)))

    def ratios(self, with_time: bool) -> FloatArray:
        """2w/y at the nodes (2, cells + 1, heights), by the time that is left or by Q.

        By secants in a bracket, on the splines themselves, so that forward and back agree.
        """
        nodes = np.maximum(np.arange(self.cells) / self.cells, 1e-6)  # at the end a limit
        target = (4.0 * np.log(nodes * (2.0 - nodes)))[None, :, None]
        shape = (2, self.cells, HEIGHTS)
        place = np.broadcast_to(nodes[None, :, None], shape).copy()
        low, high = np.zeros(shape), np.ones(shape)
        before, off_before = np.full(shape, np.nan), np.full(shape, np.nan)
        result = np.zeros(shape, np.bool_)
        for _ in range(_LOOKS):
            error = self._log_y(place, with_time) - target
            low, high = np.where(error < 0.0, place, low), np.where(error < 0.0, high, place)
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = (error - off_before) / (place - before)
                usual = 8.0 * (1.0 - place) / (place * (2.0 - place))  # were the ratio a constant
                slope = np.where(np.isfinite(slope), slope, usual)
                following = place - error / slope
            inside = (slope > 0.0) & (low < following) & (following < high)
            following = np.where(inside, following, 0.5 * (low + high))
            result |= np.abs(error) <= _ROUNDING * (1.0 - target)
            result |= ~((low < following) & (following < high))
            if result.all():
                break
            before, off_before = place, np.where(result, off_before, error)
            place = np.where(result, place, following)
        ratios = np.ones((2, self.cells + 1, HEIGHTS))
        ratios[:, :-1] = np.exp(4.0 * np.log(place * (2.0 - place)) - target)
        return ratios

    def _log_y(self, xi: FloatArray, with_time: bool) -> FloatArray:
        """Ln y at places on the axis of slip."""
        share = (xi * (2.0 - xi)) ** 4
        c, (plus, minus) = np.where(_FAST, 1.0 - share, share - 1.0), _end_logs(share)
        log_n = np.log(np.abs((c - self.c0) / self.c0)) + self.at(_LOG_RATIO, xi)
        log_n -= self.kappa * (plus / self.slow + minus / self.fast)
        if with_time:
            log_n += self.kappa * (np.log(self.at(_TIME, xi)) - self.quarter)
        power = np.exp(-np.abs(log_n))
        large = _FAST & (c > self.c0) & (log_n > 1.0)
        sign = np.where(_FAST & (c > self.c0), 1.0, -1.0)
        moderate = np.log1p(1.0 + sign * np.exp(np.minimum(log_n, np.where(_FAST, 1.0, 0.0))))
        fast = np.where(large, log_n + np.log1p(2.0 * power), moderate)
        return np.asarray(np.where(_FAST, -self.fast * fast, -self.slow * log_n) / self.kappa)

    def splined(self, with_time: bool) -> FloatArray:
        """2w/y, T, along, across, body angle, and the heading's regular part at the nodes.

        (2, cells + 1, heights, 6).
        """
        ratios, xi = self.ratios(with_time), np.arange(self.cells + 1) / self.cells
        share = np.minimum((xi * (2.0 - xi))[None, :, None] ** 4 * ratios, 1.0)
        q = np.sqrt(np.sqrt(share))
        place = 1.0 - np.sqrt((1.0 - share) / ((1.0 + q) * (1.0 + q * q)))
        functions = [self.at(f, place) for f in (_TIME, _ALONG, _ACROSS, _BODY)]
        by_slow, by_fast = self.turning / self.slow, (self.turning - self.spin_turn) / self.fast
        plus, minus = _end_logs(np.maximum(share, TINY))
        log = np.log(ratios)  # what is singular of the log of the share is taken out
        regular = np.where(_FAST, by_slow * plus + by_fast * log, by_slow * log + by_fast * minus)
        if with_time:
            regular -= self.turning * np.log(functions[0])
        regular = regular / self.delta + self.at(_TURN, place)
        return np.stack([ratios, *functions, regular], axis=-1)


def _end_logs(share: FloatArray) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """ln(1 + c) and ln(1 − c) from 2w."""
    small, large = np.log(share), np.log1p(1.0 - share)
    return np.where(_FAST, large, small), np.where(_FAST, small, large)
