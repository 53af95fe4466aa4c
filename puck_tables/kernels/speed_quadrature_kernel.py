"""The integrals of :mod:`puck_tables.contact.speed_quadrature`, compiled, for f in polynomials.

With one integral left over the circles about the instantaneous centre of rotation, Gauss panels lie
between the circles on which the slip speed is that of an end of a piece of the law: inside each f
is one polynomial.  For s = cot φ → 1 a root has a branch point at the distance √|1 − s| of τ = 0;
the panels grow from there by threes.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, inner, patience

PARTS = 4  # p_a, p_b, p_d, p_e

# nodes of a panel, the fewer the farther it is from the branch point: to 1e-14, or 3e-11, as
# test_the_compiled_integrals_are_those_of_numpy tells
_RULES = (14, 8, 5, 12, 7, 5)
_FAR, _FARTHER = 8.0, 20.0  # half widths
_NODES = [np.polynomial.legendre.leggauss(n) for n in _RULES]
GAUSS = np.concatenate([nodes for nodes, _ in _NODES])
WEIGHTS = np.concatenate([weights for _, weights in _NODES])
ENDS = (0, *np.cumsum(_RULES).tolist())
FINE, COARSE = 0, 3  # which rules to take
_GROWTH = 3.0  # each edge is so many times farther from the branch point
GRADED = 40  # edges at most: 3^-34 is below any difference from 1
_FACTORIALS = np.array([(-1.0) ** k / math.factorial(2 * k + 3) for k in range(10)])
_TINY = 1e-300  # the least that is divided by
ORIGIN, SCALE, FIRST_POWER = range(3)  # columns of a piece
FEW_POWERS = FIRST_POWER + 4  # up to cubics a law may have corners
_SAME_PIECE = 0.05  # of half a smooth piece: so far it may be taken beyond its ends


@inlined
def part_at(breaks: FloatArray, u: float) -> int:
    """The cubic piece in which a speed lies; the last one goes on."""
    low, high = 0, len(breaks) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if u >= breaks[middle]:
            low = middle
        else:
            high = middle
    return low


@inlined
def _value(pieces: FloatArray, k: int, u: float) -> float:
    t, total = (u - pieces[k, ORIGIN]) * pieces[k, SCALE], 0.0
    for power in range(pieces.shape[1] - 1, FIRST_POWER - 1, -1):
        total = total * t + pieces[k, power]
    return total


@inlined
def is_smooth(pieces: FloatArray) -> bool:
    """Whether pieces are of a high degree, of a law that bends nowhere."""
    return pieces.shape[1] > FEW_POWERS


@inlined
def _short(x: float) -> float:
    """(x − sin x)/x³ for 0 ≤ x ≤ π."""
    if x < 1.2:
        square, total = x * x, 0.0
        for k in range(9, -1, -1):
            total = total * square + _FACTORIALS[k]
        return total
    return (x - math.sin(x)) / (x * x * x)


@inlined
def rule_for(
    middle: float, half: float, branch: float, smooth: bool, rules: int
) -> tuple[int, int]:
    """First and last of the nodes to take in a panel."""
    away, square, which = middle * middle + branch * branch, half * half, rules
    if away > _FAR * _FAR * square:
        which += 2 if away > _FARTHER * _FARTHER * square and not smooth else 1
    return ENDS[which], ENDS[which + 1]


@inlined
def sorted_edges(edges: FloatArray, count: int, last: float, branch: float) -> int:
    """Panel edges: 0, ``last``, the corners that are there, and those that grow from the branch."""
    edges[count], edges[count + 1] = 0.0, last
    count += 2
    edge = branch if branch > 0.0 else last  # at s = 1 nothing branches
    while edge < 0.7 * last:
        edges[count] = edge
        count += 1
        edge *= _GROWTH
    for i in range(1, count):  # by insertion: they are few
        value, j = edges[i], i - 1
        while j >= 0 and edges[j] > value:
            edges[j + 1] = edges[j]
            j -= 1
        edges[j + 1] = value
    return count


@inner
def integrals_at(
    breaks: FloatArray, pieces: FloatArray, ratio: float, fast: bool, speed: float,
    rules: int, edges: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """p_a, p_b, p_d, p_e into ``out`` (4,).

    ``breaks`` (k + 1,): speeds, m/s; ``pieces`` (k, 2 + n): see
    :mod:`puck_tables.contact.friction_laws`;
    ``ratio`` = min(v, r|ω|)/max(v, r|ω|), ``fast`` whether r|ω| > v, ``speed`` = hypot(v, rω);
    ``rules``: FINE or COARSE; ``edges``: room for k + 45 numbers.
    """
    if fast:
        _centre_inside(breaks, pieces, ratio, speed, rules, edges, out)
    else:
        _centre_outside(breaks, pieces, ratio, speed, rules, edges, out)


@inlined
def _centre_inside(
    breaks: FloatArray, pieces: FloatArray, s: float, speed: float, rules: int,
    edges: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """|φ| > π/4, s = cot φ < 1: whole circles R ≤ 1 − s, then arcs R = 1 − s cos τ."""
    corners, sine = len(breaks) - 2, 1.0 / math.sqrt(1.0 + s * s)
    smooth = is_smooth(pieces)
    disc = rules if smooth else FINE + 2  # a polynomial
    rim = speed * sine
    whole, first = 0.0, 0.0
    for k in range(corners + 1):
        last = 1.0 - s
        if k < corners and rim * last > breaks[k + 1]:
            last = breaks[k + 1] / rim
        half, middle = 0.5 * (last - first), 0.5 * (last + first)
        if half > 0.0:
            for i in range(ENDS[disc], ENDS[disc + 1]):
                R = middle + half * GAUSS[i]
                whole += half * WEIGHTS[i] * _value(pieces, k, rim * R) * R * R
        first = last
    count = 0
    if s > 0.0 and rim > 0.0:
        for k in range(1, corners + 1):
            away = (breaks[k] / rim - (1.0 - s)) / (2.0 * s)  # sin²(τ/2)
            if 0.0 < away < 1.0:
                edges[count] = 2.0 * math.asin(math.sqrt(away))
                count += 1
    branch = math.sqrt(1.0 - s)
    count = sorted_edges(edges, count, math.pi, branch)
    parallel, across, spin, tilted = 0.0, 0.0, 0.0, 0.0
    for panel in range(count - 1):
        half = 0.5 * (edges[panel + 1] - edges[panel])
        middle = 0.5 * (edges[panel + 1] + edges[panel])
        if half <= 0.0:
            continue
        k = part_at(breaks, rim * ((1.0 - s) + 2.0 * s * math.sin(0.5 * middle) ** 2))
        rule = rule_for(middle, half, branch, smooth, rules)
        for i in range(rule[0], rule[1]):
            tau = middle + half * GAUSS[i]
            h, g = math.sin(0.5 * tau), math.cos(0.5 * tau)
            c, sin_tau = 1.0 - 2.0 * h * h, 2.0 * h * g
            R = (1.0 - s) + 2.0 * s * h * h
            k = part_at(breaks, rim * R) if smooth else k
            weight = half * WEIGHTS[i] * _value(pieces, k, rim * R) * sin_tau
            root = math.sqrt((R + 1.0 - s) * (R + 1.0 + s))
            if R < _TINY:
                R = _TINY
            sin_a = 0.5 * sin_tau * root / R
            cos_a = 0.5 * (s * (1.0 + c * c) - 2.0 * c) / R
            a = math.atan2(sin_a, cos_a)
            parallel += weight * 2.0 * R * sin_a
            across += weight * R * R * (a - sin_a * cos_a)
            spin += weight * 2.0 * R * (R * a - s * sin_a)
            tilted += (
                weight
                * R
                * (2.0 * R * s * a - 2.0 * (R * R + s * s) * sin_a + s * R * (a + sin_a * cos_a))
            )
    unit = 1.0 / (math.pi * sine)  # s/α = 1/β
    out[0] = unit * parallel
    out[1] = unit * (math.pi * whole + s * across)
    out[2] = unit * (2.0 * math.pi * whole + s * spin)
    out[3] = unit * (3.0 * math.pi * whole + tilted)


@inlined
def both(
    pieces: FloatArray, far: int, near: int, centre: float, step: float
) -> tuple[float, float, float]:
    """f(centre + step), f(centre − step), and their difference over 2 step.

    In one piece without subtracting: by Horner's scheme for P(t ± h) = even ± h odd.
    """
    if far != near and is_smooth(pieces) and step * pieces[near, SCALE] < _SAME_PIECE:
        far = near
    if far == near:
        t, h = (centre - pieces[far, ORIGIN]) * pieces[far, SCALE], step * pieces[far, SCALE]
        even, odd = 0.0, 0.0
        for power in range(pieces.shape[1] - 1, FIRST_POWER - 1, -1):
            even, odd = even * t + h * h * odd + pieces[far, power], odd * t + even
        return even + h * odd, even - h * odd, odd * pieces[far, SCALE]
    f_far = _value(pieces, far, centre + step)
    f_near = _value(pieces, near, max(centre - step, 0.0))
    return f_far, f_near, 0.5 * (f_far - f_near) / step


@inlined
def _centre_outside(
    breaks: FloatArray, pieces: FloatArray, kappa: float, speed: float, rules: int,
    edges: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """|φ| ≤ π/4, κ = tan φ = 1/s ≤ 1: the circles R = s ± cos τ together, as nothing cancels."""
    cosine, smooth = 1.0 / math.sqrt(1.0 + kappa * kappa), is_smooth(pieces)
    centre = speed * cosine
    reach, count = centre * kappa, 0
    for k in range(1, len(breaks) - 1):
        away = abs(breaks[k] - centre)
        if away < reach:
            edges[count] = 2.0 * math.asin(math.sqrt(0.5 * (reach - away) / reach))
            count += 1
    branch = math.sqrt(2.0 * (1.0 - kappa))
    count = sorted_edges(edges, count, 0.5 * math.pi, branch)
    parallel, across, spin, tilted = 0.0, 0.0, 0.0, 0.0
    for panel in range(count - 1):
        half = 0.5 * (edges[panel + 1] - edges[panel])
        middle = 0.5 * (edges[panel + 1] + edges[panel])
        if half <= 0.0:
            continue
        step = reach * math.cos(middle)
        far, near = part_at(breaks, centre + step), part_at(breaks, centre - step)
        rule = rule_for(middle, half, branch, smooth, rules)
        for i in range(rule[0], rule[1]):
            tau = middle + half * GAUSS[i]
            h = math.sin(0.5 * tau)
            sin_tau, c = math.sin(tau), math.cos(tau)
            weight = half * WEIGHTS[i] * sin_tau
            step = reach * c
            if smooth:  # next to slip zero rounding may put a node into the next piece
                far, near = part_at(breaks, centre + step), part_at(breaks, centre - step)
            f_far, f_near, slope = both(pieces, far, near, centre, step)
            slope *= centre
            # T² = (2 ± κc)² − κ², by factors that do not cancel for κ, c → 1
            outer, inner = 2.0 + kappa * c, 2.0 * (1.0 - kappa) + 2.0 * kappa * h * h
            roots = (
                math.sqrt((outer - kappa) * (outer + kappa)),
                math.sqrt(inner * (2.0 - kappa * c + kappa)),
            )
            total = roots[0] + roots[1]
            spin += weight * sin_tau * c * c * (4.0 * (f_far + f_near) / total + total * slope)
            for side in range(2):
                value, root = (f_far, roots[0]) if side == 0 else (f_near, roots[1])
                q = 1.0 + kappa * c if side == 0 else (1.0 - kappa) + 2.0 * kappa * h * h
                if q < _TINY:
                    q = _TINY
                chord = 0.5 * sin_tau * root  # q sin a/κ
                sin_a = min(kappa * chord / q, 1.0)
                a = math.asin(sin_a)
                arc = a / kappa if sin_a > 1e-8 else chord / q  # a/κ
                once, twice = _short(a), _short(2.0 * a)
                bulk = weight * value * q * q * arc * arc * arc
                parallel += weight * 2.0 * value * chord
                across += 4.0 * bulk * twice
                spin += 2.0 * bulk * once
                tilted += 4.0 * bulk * (once - twice) - weight * 2.0 * c * c * value * chord
    unit = 1.0 / (math.pi * cosine)
    out[0], out[1] = unit * parallel, unit * across
    out[2], out[3] = unit * spin, unit * tilted


@allocating
def fill_integrals(
    breaks: FloatArray, pieces: FloatArray, ratio: FloatArray, fast: npt.NDArray[np.bool_],
    speed: FloatArray, rules: int, out: FloatArray,
) -> None:  # fmt: skip
    """The four at flat arrays of points into ``out`` (n, 4)."""
    patience(ratio.size)
    edges = np.empty(len(breaks) + GRADED)
    for n in range(ratio.size):
        patience(1)
        integrals_at(breaks, pieces, ratio[n], fast[n], speed[n], rules, edges, out[n])
