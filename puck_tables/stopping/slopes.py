"""Slopes of what a stop table holds, over the slip angle: exact at the nodes, splines between.

With s = sin φ, c = cos φ, u = ln tan φ, and ρ, N, h of :mod:`puck_tables.stopping.similarity`, the
equations of motion say what the derivatives by u are, M = N/ρ_∥, H = h/(δ s):

    T_u = (T − M)/ρ,    α_u = (2α − δ² s² H β − M)/ρ + s² α,    β_u = (2β + H α)/ρ − (c² − s²) β,
    λ_u = (2λ − M)/ρ + s² λ,    μ_u = (2μ − M)/ρ − c² μ

(α: ``along``, β: ``across``, λ: ``length``, μ: ``body``).  Nothing is lost by differentiating a
spline: a cubic through values that are good to h⁴ has slopes good to h³ only, and at φ = π/4, where
dφ/dξ = 0, none at all.  What is splined is

    D_f = f_u/(s c²),

regular at both ends, where the Jacobian needs f_u/s and f_u/c².  At nodes next to the limit angle
(ρ = 0) the derivative is the difference of order 8 along ξ; next to φ = 0 and π/2, where f_u is the
difference of nearly equal numbers, the first terms of its expansion take over from farther nodes.

H needs no spline: H = (ρ (β_u + (c² − s²) β) − 2β)/α, with α > 0.4.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.stopping.lookup import HEIGHTS, SlipAxis, by_power, heights, ratio_at
from puck_tables.stopping.similarity import limits, rates_of_ratio, regular_slopes

STOP_FUNCTIONS = 5  # T, along, across, body, length; then the slopes of each
STOP_WIDTH = 12  # all, padded to whole registers
STOP_POWERS = 7  # of 2δ² − 1, enough for derivatives to 1e-9
STATE_WIDTH = 8  # T, along, across, body; κR, S/δ, (κR)_u, S_u/δ
RATE_WIDTH = 4  # slopes of the first four
_TIME, _ALONG, _ACROSS, _BODY, _LENGTH = range(STOP_FUNCTIONS)
_NEAR_LIMIT = 0.02  # of ρ: nearer the quotient is nearly 0/0
_SLOW_NODES, _FAST_NODES = (6, 12), (24, 36)  # of 282: farther, the quotient keeps its digits
_CELLS = 282  # a side, of the file
_DIFFERENCE = np.array([1.0 / 280.0, -4.0 / 105.0, 0.2, -0.8, 0.0, 0.8, -0.2, 4.0 / 105.0,
                        -1.0 / 280.0])  # fmt: skip


class Slopes(NamedTuple):
    """Spline coefficients, powers of 2δ² − 1 ascending, functions within a power side by side.

    ``stops`` (2, cells + 3, 7 · 12): T, along, across, body, length, D of each, and zeros;
    ``states`` (2, cells + 3, 9 · 8): T, along, across, body, κR, S/δ, and the derivatives of both
    by u; ``rates`` (2, cells + 3, 7 · 4): D of the first four of these.
    """

    stops: FloatArray
    states: FloatArray
    rates: FloatArray


def slopes_of(axis: SlipAxis, values: FloatArray) -> Slopes:
    """The slopes of a stop table.

    ``axis``: SlipAxis; ``values``: array (2 cells + 1, 9, 7), as in
    :class:`puck_tables.stopping.stop_table.StopTable`.
    """
    n = axis.cells
    sides = np.stack([values[: n + 1], values[: n - 1 : -1]])  # both from k = 0 to k = 1
    own = sides[..., [0, 1, 2, 4, 3]]
    by_u = np.stack([_slopes_at_nodes(axis, own[fast], fast == 1) for fast in range(2)])
    stops = np.concatenate([own, by_u], axis=-1)
    functions = np.concatenate([sides[..., [5, 6]], _similarity_slopes(axis)], axis=-1)
    of_stops, of_functions = (
        by_power(one, powers).transpose(2, 1, 0, 3)  # side, node, power, function
        for one, powers in ((stops, STOP_POWERS), (functions, HEIGHTS))
    )
    states = np.zeros((*of_functions.shape[:3], STATE_WIDTH))
    states[:, :, :STOP_POWERS, :4], states[..., 4:] = of_stops[..., :4], of_functions
    rates = of_stops[..., STOP_FUNCTIONS : STOP_FUNCTIONS + RATE_WIDTH]
    padded = np.zeros((*of_stops.shape[:3], STOP_WIDTH))
    padded[..., : of_stops.shape[3]] = of_stops
    # all numbers of a node side by side
    return Slopes(*(aligned(one.reshape(*one.shape[:2], -1)) for one in (padded, states, rates)))


def _slopes_at_nodes(axis: SlipAxis, values: FloatArray, fast: bool) -> FloatArray:
    """D (cells + 1, 9, 5) on one side."""
    xi = np.arange(axis.cells + 1) / axis.cells
    k, delta = ratio_at(xi)[:, None], heights()
    large = 1.0 / np.hypot(1.0, k)
    s, c = (large, k * large) if fast else (k * large, large)
    rate, norm, turning = rates_of_ratio(k, fast, delta)
    time, along, across, body, length = np.moveaxis(values, -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        by_u = np.stack([
            (time - norm) / rate,
            (2.0 * along - delta**2 * s**2 * turning * across - norm) / rate + s**2 * along,
            (2.0 * across + turning * along) / rate - (c**2 - s**2) * across,
            (2.0 * body - norm) / rate - c**2 * body,
            (2.0 * length - norm) / rate + s**2 * length,
        ], axis=-1)  # fmt: skip
        by_u /= (s * c**2)[..., None]
        by_difference = _by_difference(values, xi, fast) / (s * c**2)[..., None]
    near = (np.abs(rate) < _NEAR_LIMIT)[..., None]
    by_u = np.where(near, by_difference, by_u)
    _expand(by_u, k[:, 0], delta, fast, axis.cells)
    return by_u


def _by_difference(values: FloatArray, xi: FloatArray, fast: bool) -> FloatArray:
    """Derivatives by u from nine neighbouring nodes; beyond the ends the even continuation."""
    around = np.concatenate([values[4:0:-1], values, values[-2:-6:-1]])
    count = len(values)
    by_xi = sum(w * around[j : j + count] for j, w in enumerate(_DIFFERENCE)) / xi[1]
    q = xi * (2.0 - xi)
    scale = 16.0 * (1.0 - xi) * q**3 / (2.0 - q**4) ** 2 / ratio_at(xi)  # d ln k/dξ
    slope: FloatArray = by_xi / (-scale if fast else scale)[:, None, None]
    return slope


def _expand(by_u: FloatArray, k: FloatArray, delta: FloatArray, fast: bool, cells: int) -> None:
    """Next to the end, D by its first terms there, fitted to farther nodes; in place.

    Next to pure sliding T = 1 + a k^(1/A) + b k² + …, the others have b k² and the power 2/A
    (along, length) or 2/A − 1 (across, body); next to pure spin all are even but T, which carries
    k^(1/B).
    """
    d2 = delta**2
    first, last = (round(n * cells / _CELLS) for n in (_FAST_NODES if fast else _SLOW_NODES))
    slow_power, fast_power = 8.0 / (4.0 + d2), (36.0 + 4.0 * d2) / (9.0 + 4.0 * d2)
    own = (slow_power, 2 * slow_power, 2 * slow_power - 1.0, 2 * slow_power - 1.0, 2 * slow_power)
    for j in range(HEIGHTS):
        for f in range(STOP_FUNCTIONS):
            if fast:
                powers = [0.0, 2.0] + ([float(fast_power[j]) - 2.0] if f == _TIME else [])
            else:
                powers = [1.0, float(own[f][j]) - 1.0]
            scaled = k[: last + 1] / k[last]
            terms = np.stack([scaled**power for power in powers], axis=-1)
            known = by_u[first : last + 1, j, f]
            coefficients = np.linalg.lstsq(terms[first:], known, rcond=None)[0]
            by_u[:first, j, f] = terms[:first] @ coefficients


def _similarity_slopes(axis: SlipAxis) -> FloatArray:
    """d(κR)/du and dS/du over δ at the nodes, (2, cells + 1, 9, 2)."""
    out = np.zeros((2, axis.cells + 1, HEIGHTS, 2))
    u = np.log(ratio_at(np.arange(1, axis.cells + 1) / axis.cells))
    for j, delta in enumerate(heights()):
        kappa = limits(float(delta)).kappa
        for fast in range(2):
            regular, turn = regular_slopes(-u if fast else u, float(delta))
            out[fast, 1:, j] = np.stack([kappa * regular, turn / delta], axis=-1)
    return out
