"""Friction over the slip speed under thin circles, and under loads that are piles of them.

On the circle of radius ρ, t the angle from the centre of rotation, α = cos φ, β = sin φ, the slip
is u∓ = √((α − βρ)² + 4αβρ sin²(t/2)) at t and, with cos²(t/2), at π − t.  With c = cos t, g = f/u
and the means over t from 0 to π/2, Σ = g₊ + g₋ and Δ = 4 c² (g₊ − g₋)/((u₊ − u₋)(u₊ + u₋))

    p_a: Σ + (βρ)² Δ      p_b: ρ² sin²t Σ      p_d: ρ² (Σ + α² Δ)      p_e: −ρ² (c² Σ + (βρ)² Δ),

in which nothing cancels where α or β vanishes.  Over ρ they are like x ln|x| where the circle
passes the centre of rotation, ρ = cot φ: nodes crowd there.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.round_load import ALONE, PROFILE
from puck_tables.kernels.compile import allocating, inlined, inner, patience
from puck_tables.kernels.speed_quadrature_kernel import (
    FINE,
    GAUSS,
    GRADED,
    WEIGHTS,
    both,
    is_smooth,
    part_at,
    rule_for,
    sorted_edges,
)

_RULES = [np.polynomial.legendre.leggauss(n) for n in (20, 14)]
_TAU = [0.5 * (1.0 + nodes) for nodes, _ in _RULES]
# S = τ⁴ (5 − 4τ): x ln x at the first end is τ⁷ ln τ there, half powers at the last are whole ones;
# S = τ² (3 − 2τ) clears half powers at both ends
_CROWDED = np.concatenate([t**4 * (5.0 - 4.0 * t) for t in _TAU])
_CLEARED = np.concatenate([t**2 * (3.0 - 2.0 * t) for t in _TAU])
_CROWDED_SHARES = np.concatenate(
    [10.0 * t**3 * (1.0 - t) * w for t, (_, w) in zip(_TAU, _RULES, strict=True)]
)
_CLEARED_SHARES = np.concatenate(
    [3.0 * t * (1.0 - t) * w for t, (_, w) in zip(_TAU, _RULES, strict=True)]
)
_COUNT = len(_TAU[0])  # of the fine rule, which stands first
_BENT = 2.0  # radians: sines bend like that without a branch, too
_LEAST = 1e-300  # that is divided by


@inner
def _add_circle(
    breaks: FloatArray, pieces: FloatArray, kinks: FloatArray, alpha: float, beta: float,
    speed: float, rho: float, share: float, rules: int, edges: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """What a circle adds to p_a, p_b, p_d, p_e that has a share of the load."""
    smooth, rim = is_smooth(pieces), beta * rho
    gap, product, count = alpha - rim, 4.0 * alpha * rim, 0
    for k in range(len(kinks)):
        if product > 0.0 and speed > 0.0:
            part = (kinks[k] / speed) ** 2 - gap * gap
            part = min(part, product - part) / product  # sin²(t/2), of either half
            if 0.0 < part < 0.5:
                edges[count] = 2.0 * math.asin(math.sqrt(part))
                count += 1
    branch = math.inf
    if product > 0.0:  # on the circle through the centre of rotation f alone bends
        slow = 0.0 if speed == 0.0 or not smooth else breaks[1] / speed
        branch = max(abs(gap), slow if gap == 0.0 else 0.0) / math.sqrt(product)
    count = sorted_edges(edges, count, 0.5 * math.pi, branch)
    a, b, d, e = 0.0, 0.0, 0.0, 0.0
    for panel in range(count - 1):
        half = 0.5 * (edges[panel + 1] - edges[panel])
        middle = 0.5 * (edges[panel + 1] + edges[panel])
        if half <= 0.0:
            continue
        cosine = math.cos(middle)
        near = part_at(breaks, speed * math.sqrt(gap * gap + 0.5 * product * (1.0 - cosine)))
        far = part_at(breaks, speed * math.sqrt(gap * gap + 0.5 * product * (1.0 + cosine)))
        rule = rule_for(middle, half, min(branch, _BENT), smooth, rules)
        for i in range(rule[0], rule[1]):
            t = middle + half * GAUSS[i]
            h, sine, c = math.sin(0.5 * t), math.sin(t), math.cos(t)
            low = max(math.sqrt(gap * gap + product * h * h), _LEAST)
            high = math.sqrt(gap * gap + product * (1.0 - h * h))
            mean = 0.5 * (high + low)
            step = 0.5 * product * c / (high + low)  # half of what they differ by
            if smooth:
                far, near = part_at(breaks, speed * high), part_at(breaks, speed * low)
            f_far, f_near, slope = both(pieces, far, near, speed * mean, speed * step)
            both_over = f_far / high + f_near / low
            apart = mean * speed * slope - 0.5 * (f_far + f_near)
            curvature = 4.0 * c * c * apart / (high * low * (high + low))
            weight = half * WEIGHTS[i]
            a += weight * (both_over + rim * rim * curvature)
            b += weight * sine * sine * both_over
            d += weight * (both_over + alpha * alpha * curvature)
            e -= weight * (c * c * both_over + rim * rim * curvature)
    share, square = share / math.pi, rho * rho
    out[0] += share * a
    out[1] += share * square * b
    out[2] += share * square * d
    out[3] += share * square * e


@inlined
def _sorted_in(places: FloatArray, count: int, place: float, low: float, high: float) -> int:
    """With one more place where it lies between two."""
    if not low < place < high:
        return count
    j = count - 1
    while j >= 0 and places[j] > place:
        places[j + 1] = places[j]
        j -= 1
    places[j + 1] = place
    return count + 1


@inner
def _load_at(
    breaks: FloatArray, pieces: FloatArray, kinks: FloatArray, power: float, parts: FloatArray,
    reach: float, alpha: float, beta: float, speed: float, rules: int, edges: FloatArray,
    places: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """p_a, p_b, p_d, p_e of a load into ``out`` (4,)."""
    out[:] = 0.0
    if power == ALONE:
        _add_circle(breaks, pieces, kinks, alpha, beta, speed, reach, 1.0, rules, edges, out)
        return
    curved, rim, fine = power != PROFILE, beta * reach, rules == FINE
    centre = alpha / max(rim, _LEAST)
    for k in range(len(parts)):
        low, high = parts[k, 0], parts[k, 1]
        at = centre
        if curved:  # how far beyond the rim it is in the plane of complex θ
            at = math.asin(centre) if centre < 1.0 else 0.5 * math.pi + math.acosh(centre)
        count = _sorted_in(places, 0, at, low, high)
        if speed * rim > 0.0:
            for n in range(len(kinks)):
                for direction in range(3):
                    corner = (kinks[n] / speed * (1.0 if direction < 2 else -1.0)
                              + (alpha if direction > 0 else -alpha)) / rim  # fmt: skip
                    inside = curved and 0.0 < corner < 1.0
                    corner = math.asin(corner) if inside else corner
                    if inside or not curved:
                        count = _sorted_in(places, count, corner, low, high)
        begin = low
        for n in range(count + 1):
            end = places[n] if n < count else high
            # from the end that is nearer to the centre of rotation
            first, length = begin, end - begin
            if abs(end - at) < abs(begin - at):
                first, length = end, begin - end
            crowded = abs(first - at) < abs(length)
            for i in range(0 if fine else _COUNT, _COUNT if fine else len(_CROWDED)):
                q = first + length * (_CROWDED[i] if crowded else _CLEARED[i])
                weight = abs(length) * (_CROWDED_SHARES[i] if crowded else _CLEARED_SHARES[i])
                if curved:
                    rho = math.sin(q)
                    weight *= (power + 1.0) * rho * math.cos(q) ** power
                else:
                    rho = q
                    slope = (parts[k, 3] - parts[k, 2]) / (high - low)
                    weight *= (parts[k, 2] + slope * (q - low)) * q
                _add_circle(
                    breaks,
                    pieces,
                    kinks,
                    alpha,
                    beta,
                    speed,
                    reach * rho,
                    weight,
                    rules,
                    edges,
                    out,
                )
            begin = end


@allocating
def fill_load(
    breaks: FloatArray, pieces: FloatArray, kinks: FloatArray, power: float, parts: FloatArray,
    reach: float, ratio: FloatArray, fast: npt.NDArray[np.bool_], speed: FloatArray, rules: int,
    out: FloatArray,
) -> None:  # fmt: skip
    """The four at flat arrays of points into ``out`` (n, 4).

    ``kinks``: speeds, m/s, at which the law has a corner, or bends much; ``power``, ``parts``: as
    :attr:`puck_tables.contact.round_load.RoundLoad.circles`; the rest as
    :func:`puck_tables.kernels.speed_quadrature_kernel.fill_integrals`.
    """
    patience(ratio.size)
    edges, places = np.empty(len(kinks) + GRADED + 4), np.empty(3 * len(kinks) + 4)
    for n in range(ratio.size):
        patience(1)
        small = ratio[n] / math.sqrt(1.0 + ratio[n] * ratio[n])
        large = 1.0 / math.sqrt(1.0 + ratio[n] * ratio[n])
        alpha, beta = (small, large) if fast[n] else (large, small)
        _load_at(
            breaks, pieces, kinks, power, parts, reach, alpha, beta, speed[n], rules, edges, places,
            out[n],
        )  # fmt: skip
