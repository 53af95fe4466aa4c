"""The table of friction with f(slip speed) as compiled code reads it: splines in patches.

In the fastest slip U = v + r|ω| and the slip W = |v − r|ω|| at the opposite rim, the integrals are
singular only on straight lines: where U or W is a corner b_k of the law (a circle of that slip
touches the rim), and at W = 0 (the centre of rotation crosses it).  The lines cut the plane into
patches; on each lies a spline of degree 5 in coordinates ξ, ζ ∈ [0, 1] that clear the singular
edges:

    U ≤ b₁:               ξ = (U/b₁)^(1/g), ζ = (W/U)^(1/4)
    b_k ≤ U ≤ b_{k+1}:    U = b_k + (b_{k+1} − b_k) ξ^p  and for W
        0 … b₁/2:         W = ½ b₁ ζ⁴
        up to b_l ≤ b_k:  W = b_l − (b_l − left end)(1 − ζ)^p
        b_k … U:          U, W = b_k + (b_{k+1} − b_k) (ξ, ζ): one piece of the law, and even
                          about U = W

for half powers of the distance from U = b_k and W = b_l, and W² ln W at 0; p = 2, but 3 where for
r|ω| < v both meet one corner, l = k.  g is 1, for f that is smooth at slip zero; larger where f
leaves its value there with a power that is no whole number.  One set of patches for r|ω| <
v, one for r|ω| > v.

Under a load with edges within the rim a patch lies in a slab of U between two rays (v − r|ω|)/U
on which the centre of rotation crosses an edge; U = b_k + (b_{k+1} − b_k) ξ, and of the way from
one ray to the other ζ⁴/(ζ⁴ + (1 − ζ)⁴), which clears W² ln W at both.  Where a law has corners and
the load is that of discs, each is looked up in the table of one
(:mod:`puck_tables.contact.round_load`).
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience, weighted_rows
from puck_tables.kernels.quadratic import cell_at

DONE, TOO_FAST = 0, 1  # what a look-up ends as
DEGREE = 5  # of the patches
EDGE_POWER, CORNER_POWER = 2, 3  # of the grading of nodes at edges, and at corners of the law
_TINY = 1e-300  # m/s
_ROUNDING = 1.0 + 1e-8  # so little above the last speed the last piece goes on


def packed(
    breaks: FloatArray, rays: FloatArray, discs: FloatArray, cells: npt.NDArray[np.int64],
    coefficients: list[FloatArray], grade: int,
) -> FloatArray:  # fmt: skip
    """A table as one array: a loop that hands it on counts the references of one.

    The number of breaks, the breaks, the number of rays, the rays, the number of discs that are
    looked up, their radii and shares, for each patch where its coefficients begin and its cells
    along ξ and ζ, the coefficients, and g.
    """
    sizes = np.array([part.size for part in coefficients])
    header = 3 + len(breaks) + len(rays) + discs.size + 3 * len(cells)
    begins = header + np.concatenate([[0], np.cumsum(sizes)[:-1]])
    layout = np.concatenate([begins[:, None], cells], axis=1).ravel()
    return np.concatenate(
        [
            [len(breaks)],
            breaks,
            [len(rays)],
            rays,
            [len(discs)],
            discs.ravel(),
            layout,
            *[c.ravel() for c in coefficients],
            [grade],
        ]
    )


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
    for share in u:
        row = weighted_rows(coefficients, first, w, 4)
        a, b, d, e = a + share * row[0], b + share * row[1], d + share * row[2], e + share * row[3]
        first += width
    return a, b, d, e


@inlined
def _below(table: FloatArray, u: float, last: int) -> int:
    """The interval of the breaks in which a speed lies, at most ``last``."""
    low, high = 0, last + 1
    while high - low > 1:
        middle = (low + high) // 2
        if u >= table[1 + middle]:
            low = middle
        else:
            high = middle
    return low


@inlined
def _first_of(slab: int) -> int:
    """Number of the first patch of a slab, on one side of r|ω| = v."""
    return 0 if slab == 0 else 1 + (slab - 1) * slab // 2 + 2 * (slab - 1)


@inlined
def _between_rays(
    table: FloatArray, slabs: int, rays: int, k: int, U: float, across: float
) -> tuple[int, float, float]:
    """Patch, ξ and ζ in slab k of a table with rays; ``across``: v − r|ω|."""
    low, high, sector = -1.0, 1.0, 0
    while sector < rays:
        ray = table[3 + slabs + sector]
        if across < ray * U:
            high = ray
            break
        low = ray
        sector += 1
    begin, end = table[1 + k], table[2 + k]
    xi, grade = (U - begin) / (end - begin), table[table.size - 1]
    if k == 0 and grade != 1.0:
        xi = xi ** (1.0 / grade)
    ratio = across / max(U, _TINY)
    near = math.sqrt(math.sqrt(max(ratio - low, 0.0)))
    far = math.sqrt(math.sqrt(max(high - ratio, 0.0)))
    return k * (rays + 1) + sector, xi, near / (near + far)


@inlined
def patch_and_place(
    table: FloatArray, ratio: float, fast: bool, speed: float
) -> tuple[int, float, float]:
    """Number of the patch, ξ and ζ; a negative number beyond the last break.

    ``table``: see :func:`packed`; ``ratio``, ``fast``, ``speed``: as in
    :func:`speed_integrals_at`.
    """
    slabs = int(table[0]) - 1
    along = speed / math.sqrt(1.0 + ratio * ratio)
    U, W = along * (1.0 + ratio), along * (1.0 - ratio)
    if not (table[1 + slabs] * _ROUNDING >= U):
        return -1, 0.0, 0.0
    k, rays = _below(table, U, slabs - 1), int(table[2 + slabs])
    if rays > 0:
        return _between_rays(table, slabs, rays, k, U, -W if fast else W)
    first = _first_of(k) + (_first_of(slabs) if fast else 0)
    if k == 0:
        xi, grade = U / table[2], table[table.size - 1]
        xi = xi if grade == 1.0 else xi ** (1.0 / grade)
        return first, xi, math.sqrt(math.sqrt((1.0 - ratio) / (1.0 + ratio)))
    width = table[2 + k] - table[1 + k]
    if table[1 + k] <= W:
        return first + k + 1, (U - table[1 + k]) / width, (W - table[1 + k]) / width
    low = _below(table, W, k - 1)
    start, part = table[1 + low], low + 1
    if low == 0:
        share = 2.0 * W / table[2]
        if share <= 1.0:
            return first, math.sqrt((U - table[1 + k]) / width), math.sqrt(math.sqrt(share))
        start = 0.5 * table[2]
    x, z = (U - table[1 + k]) / width, (table[1 + part] - W) / (table[1 + part] - start)
    if part == k and not fast:
        return first + part, np.cbrt(x), 1.0 - np.cbrt(z)
    return first + part, math.sqrt(x), 1.0 - math.sqrt(z)


@inlined
def speed_integrals_at(
    table: FloatArray, ratio: float, fast: bool, speed: float
) -> tuple[float, float, float, float]:
    """p_a, p_b, p_d, p_e of :mod:`puck_tables.contact.speed_quadrature`; NaN beyond the table.

    ``ratio`` = min(v, r|ω|)/max(v, r|ω|) ∈ [0, 1], ``fast`` whether r|ω| > v, ``speed`` =
    Q = hypot(v, rω) in m/s.
    """
    breaks = int(table[0])
    at = 2 + breaks + int(table[1 + breaks])
    discs = int(table[at])
    layout = at + 1 + 2 * discs
    if discs == 0:
        return _looked_up(table, layout, ratio, fast, speed)
    small, large = ratio / math.sqrt(1.0 + ratio * ratio), 1.0 / math.sqrt(1.0 + ratio * ratio)
    alpha, beta = (small, large) if fast else (large, small)
    if not (table[breaks] * _ROUNDING >= speed * (alpha + beta)):
        return math.nan, math.nan, math.nan, math.nan
    a, b, d, e = 0.0, 0.0, 0.0, 0.0
    for n in range(discs):
        radius = table[at + 1 + 2 * n]
        rim, square = radius * beta, radius * radius
        norm = math.sqrt(alpha * alpha + rim * rim)
        inside = rim > alpha
        own = alpha / rim if inside else rim / alpha
        p = _looked_up(table, layout, own, inside, speed * norm)
        share = table[at + 2 + 2 * n] / norm
        a, b = a + share * p[0], b + share * square * p[1]
        d, e = d + share * square * p[2], e + share * square * p[3]
    return a, b, d, e


@inlined
def _looked_up(
    table: FloatArray, layout: int, ratio: float, fast: bool, speed: float
) -> tuple[float, float, float, float]:
    """The four of what the patches are of; ``layout``: where these are told."""
    patch, xi, zeta = patch_and_place(table, ratio, fast, speed)
    if patch < 0:
        return math.nan, math.nan, math.nan, math.nan
    place = layout + 3 * patch
    return _spline(table, int(table[place]), int(table[place + 1]), int(table[place + 2]), xi, zeta)


@kernel
def speed_ratios(
    table: FloatArray, height_ratio: float, ratio: float, fast: bool, speed: float
) -> tuple[float, float, float]:
    """F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ), the load tilted as 2h/r has it."""
    a, b, d, e = speed_integrals_at(table, ratio, fast, speed)
    small = ratio * ratio / (1.0 + ratio * ratio)
    large = 1.0 / (1.0 + ratio * ratio)
    cos2, sin2 = (small, large) if fast else (large, small)
    g = height_ratio
    parallel = a / (1.0 - g * g * sin2 * b * (b - d))
    across = g * parallel * b
    return parallel, across, 2.0 * (d + g * cos2 * across * e)


@kernel
def fill_speed(
    table: FloatArray, ratio: FloatArray, fast: npt.NDArray[np.bool_], speed: FloatArray,
    out: FloatArray,
) -> int:  # fmt: skip
    """p_a, p_b, p_d, p_e at flat arrays of points into ``out`` (4, n); a status."""
    status = DONE
    for n in range(ratio.size):
        patience(1)
        a, b, d, e = speed_integrals_at(table, ratio[n], fast[n], speed[n])
        out[0, n], out[1, n], out[2, n], out[3, n] = a, b, d, e
        if a != a:
            status = TOO_FAST
    return status


@kernel
def fill_patch(
    coefficients: FloatArray, cells_u: int, cells_w: int, xi: FloatArray, zeta: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """p_a, p_b, p_d, p_e at ξ and ζ within one patch, into ``out`` (n, 4)."""
    for n in range(xi.size):
        patience(1)
        a, b, d, e = _spline(coefficients, 0, cells_u, cells_w, xi[n], zeta[n])
        out[n, 0], out[n, 1], out[n, 2], out[n, 3] = a, b, d, e
