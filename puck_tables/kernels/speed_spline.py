"""The table of friction with f(slip speed) as compiled code reads it: splines in patches.

In the fastest slip U = v + r|ω| and the slip W = |v − r|ω|| at the opposite rim, the integrals are
singular only on straight lines: where U or W is a corner b_k of the law (a circle of that slip
touches the rim), and at W = 0 (the centre of rotation crosses it).  The lines cut the plane into
patches; on each lies a spline of degree 5 in coordinates ξ, ζ ∈ [0, 1] that clear the singular
edges:

    U ≤ b₁:               ξ = U/b₁ (a cubic in ξ), ζ = (W/U)^(1/4)
    b_k ≤ U ≤ b_{k+1}:    U = b_k + (b_{k+1} − b_k) ξ^p  and for W
        0 … b₁/2:         W = ½ b₁ ζ⁴
        up to b_l ≤ b_k:  W = b_l − (b_l − left end)(1 − ζ)^p
        b_k … U:          U, W = b_k + (b_{k+1} − b_k) (ξ, ζ): one piece of the law, and even
                          about U = W

for half powers of the distance from U = b_k and W = b_l, and W² ln W at 0; p = 2, but 3 where for
r|ω| < v both meet one corner, l = k.  One set of patches for r|ω| <
v, one for r|ω| > v.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import cell_at

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

DONE, TOO_FAST = 0, 1
DEGREE = 5
EDGE_POWER, CORNER_POWER = 2, 3
OFFSET, CELLS_U, CELLS_W = range(3)  # columns of a layout: first coefficient, cells
_ROUNDING = 1.0 + 1e-12


@inlined
def quintic(t: float) -> tuple[float, float, float, float, float, float]:
    """The six uniform B-splines of degree 5 that overlap a cell, times 120, at t ∈ [0, 1]."""
    s = 1.0 - t
    t2, s2 = t * t, s * s
    return (
        s2 * s2 * s,
        26.0 + t * (-50.0 + t * (20.0 + t * (20.0 + t * (-20.0 + 5.0 * t)))),
        66.0 + t2 * (-60.0 + t2 * (30.0 - 10.0 * t)),
        66.0 + s2 * (-60.0 + s2 * (30.0 - 10.0 * s)),
        26.0 + s * (-50.0 + s * (20.0 + s * (20.0 + s * (-20.0 + 5.0 * s)))),
        t2 * t2 * t,
    )


@inlined
def _spline(
    coefficients: FloatArray, offset: int, cells_u: int, cells_w: int, xi: float, zeta: float
) -> tuple[float, float, float, float]:
    """Four functions at ξ, ζ in one patch; what rounding puts outside goes to the edge."""
    p = min(max(xi, 0.0), 1.0) * cells_u
    q = min(max(zeta, 0.0), 1.0) * cells_w
    i, j = cell_at(p, cells_u), cell_at(q, cells_w)
    u, w = quintic(p - i), quintic(q - j)
    width = 4 * (cells_w + DEGREE)
    first = offset + i * width + 4 * j
    a, b, d, e = 0.0, 0.0, 0.0, 0.0
    for m, share in enumerate(u):
        c = coefficients[first + m * width : first + m * width + 24]
        a += share * (
            w[0] * c[0] + w[1] * c[4] + w[2] * c[8] + w[3] * c[12] + w[4] * c[16] + w[5] * c[20]
        )
        b += share * (
            w[0] * c[1] + w[1] * c[5] + w[2] * c[9] + w[3] * c[13] + w[4] * c[17] + w[5] * c[21]
        )
        d += share * (
            w[0] * c[2] + w[1] * c[6] + w[2] * c[10] + w[3] * c[14] + w[4] * c[18] + w[5] * c[22]
        )
        e += share * (
            w[0] * c[3] + w[1] * c[7] + w[2] * c[11] + w[3] * c[15] + w[4] * c[19] + w[5] * c[23]
        )
    return a, b, d, e


@inlined
def _below(breaks: FloatArray, u: float, last: int) -> int:
    """The interval of the breaks in which a speed lies, at most ``last``."""
    low, high = 0, last + 1
    while high - low > 1:
        middle = (low + high) // 2
        if u >= breaks[middle]:
            low = middle
        else:
            high = middle
    return low


@inlined
def patch_and_place(
    breaks: FloatArray, patches: int, ratio: float, fast: bool, speed: float
) -> tuple[int, float, float]:
    """Number of the patch, ξ and ζ; a negative number beyond the last break.

    ``patches``: how many there are on both sides of r|ω| = v; ``ratio``, ``fast``, ``speed``: as in
    :func:`speed_integrals_at`.
    """
    along = speed / math.sqrt(1.0 + ratio * ratio)
    U, W = along * (1.0 + ratio), along * (1.0 - ratio)
    if not (breaks[-1] * _ROUNDING >= U):
        return -1, 0.0, 0.0
    first = patches // 2 if fast else 0
    k = _below(breaks, U, len(breaks) - 2)
    if k == 0:
        return first, U / breaks[1], math.sqrt(math.sqrt((1.0 - ratio) / (1.0 + ratio)))
    first += 1 + (k - 1) * k // 2 + 2 * (k - 1)
    width = breaks[k + 1] - breaks[k]
    if breaks[k] <= W:
        return first + k + 1, (U - breaks[k]) / width, (W - breaks[k]) / width
    low = _below(breaks, W, k - 1)
    start, part = breaks[low], low + 1
    if low == 0:
        share = 2.0 * W / breaks[1]
        if share <= 1.0:
            return first, math.sqrt((U - breaks[k]) / width), math.sqrt(math.sqrt(share))
        start = 0.5 * breaks[1]
    x, z = (U - breaks[k]) / width, (breaks[part] - W) / (breaks[part] - start)
    if part == k and not fast:
        return first + part, np.cbrt(x), 1.0 - np.cbrt(z)
    return first + part, math.sqrt(x), 1.0 - math.sqrt(z)


@inlined
def speed_integrals_at(
    coefficients: FloatArray, layout: IntArray, breaks: FloatArray,
    ratio: float, fast: bool, speed: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """p_a, p_b, p_d, p_e of :mod:`puck_tables.contact.speed_quadrature`; NaN beyond the table.

    ``ratio`` = min(v, r|ω|)/max(v, r|ω|) ∈ [0, 1], ``fast`` whether r|ω| > v, ``speed`` =
    Q = hypot(v, rω) in m/s.
    """
    patch, xi, zeta = patch_and_place(breaks, len(layout), ratio, fast, speed)
    if patch < 0:
        return math.nan, math.nan, math.nan, math.nan
    return _spline(
        coefficients, layout[patch, OFFSET], layout[patch, CELLS_U], layout[patch, CELLS_W],
        xi, zeta,
    )  # fmt: skip


@inlined
def speed_ratios(
    coefficients: FloatArray, layout: IntArray, breaks: FloatArray, height_ratio: float,
    ratio: float, fast: bool, speed: float,
) -> tuple[float, float, float]:  # fmt: skip
    """F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ), the load tilted as 2h/r has it."""
    a, b, d, e = speed_integrals_at(coefficients, layout, breaks, ratio, fast, speed)
    small = ratio * ratio / (1.0 + ratio * ratio)
    large = 1.0 / (1.0 + ratio * ratio)
    cos2, sin2 = (small, large) if fast else (large, small)
    g = height_ratio
    parallel = a / (1.0 - g * g * sin2 * b * (b - d))
    across = g * parallel * b
    return parallel, across, 2.0 * (d + g * cos2 * across * e)


@kernel
def fill_speed(
    coefficients: FloatArray, layout: IntArray, breaks: FloatArray,
    ratio: FloatArray, fast: npt.NDArray[np.bool_], speed: FloatArray, out: FloatArray,
) -> int:  # fmt: skip
    """p_a, p_b, p_d, p_e at flat arrays of points into ``out`` (4, n); a status."""
    status = DONE
    for n in range(ratio.size):
        a, b, d, e = speed_integrals_at(coefficients, layout, breaks, ratio[n], fast[n], speed[n])
        out[0, n], out[1, n], out[2, n], out[3, n] = a, b, d, e
        if a != a:
            status = TOO_FAST
    return status


@kernel
def fill_patch(
    coefficients: FloatArray, cells_u: int, cells_w: int, xi: FloatArray, zeta: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """The same by ξ and ζ within one patch, into ``out`` (n, 4)."""
    for n in range(xi.size):
        a, b, d, e = _spline(coefficients, 0, cells_u, cells_w, xi[n], zeta[n])
        out[n, 0], out[n, 1], out[n, 2], out[n, 3] = a, b, d, e
