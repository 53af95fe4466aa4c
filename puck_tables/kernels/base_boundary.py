"""Sums of the slip direction over parts of a base: along pieces of their boundary.

With the slip velocity u = (α − β y, β x) in units of Q, x along the slip of the centre and lengths
in radii, w = |u| and e = u/w, it is β e = (−∂w/∂y, ∂w/∂x): every sum of e, x e, … over a part of
the base is an integral along its boundary (Green).  With h = (w − α)/β, which has a limit where β
vanishes, and the part's boundary counter-clockwise,

    ∫ e dA = ∮ h (dx, dy),   ∫ h dA = ⅓ ∮ [h (x dy − y dx) + α k dx],   k = (h + y)/β,

and so on for one power of x and y more, which a tilted pressure needs.  On a straight piece these
are elementary; of a whole disc the sums are closed forms.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from puck_tables.contact import closed_form
from puck_tables.kernels.base_sums import NOTHING, Sums, added, from_slip, moved
from puck_tables.kernels.closed_form_kernel import few_elliptic
from puck_tables.kernels.compile import inlined, inner

_NODES = 16  # of Gauss's rule a piece: test_friction_is_that_of_points_over_the_base
_NODE, _WEIGHT = np.polynomial.legendre.leggauss(_NODES)
_FAR = 2.0  # radii from which on the centre of rotation is no trouble for Gauss's rule
# of the whole disc; up to a ratio of the two rates few steps are exact to rounding
_full_integrals: Any = inlined(closed_form.shape_integrals)
_few_integrals: Any = inlined(closed_form.shape_integrals_by(few_elliptic))
_FEW = 0.99  # of the smaller rate over the larger: up to it few steps do


@inlined
def disc_sums(alpha: float, beta: float, size: float) -> Sums:
    """The whole disc of a radius about the centre of the base, by the closed forms."""
    rim = beta * size
    fast = rim > alpha
    ratio = alpha / rim if fast else rim / alpha
    side = 1.0 if fast else 0.0
    a, b, d = _few_integrals(ratio, side) if ratio < _FEW else _full_integrals(ratio, side)
    length = math.sqrt(alpha * alpha + rim * rim)
    area = math.pi * size * size
    slides, turns = area * alpha / length, area * size * rim / length
    return (
        slides * a, 0.0, 0.0, turns * (b - d), turns * b, 0.0, 0.0,
        slides * size * size * (d - 2.0 * b),
    )  # fmt: skip


@inlined
def disc_at(cx: float, cy: float, size: float, ux: float, uy: float, w: float) -> Sums:
    """A disc about a place: by the closed forms about its own middle, turned and moved."""
    ux, uy = ux - w * cy, uy + w * cx
    speed = math.sqrt(ux * ux + uy * uy)
    c, s = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    sums = disc_sums(speed, abs(w), size)
    return moved(from_slip(sums, c, s, -1.0 if w < 0.0 else 1.0), cx, cy)


@inlined
def _combined(
    tx: float, ty: float, a: float, h: float, hx: float, hy: float, k: float, kx: float,
    ky: float, q: float,
) -> Sums:  # fmt: skip
    """The integrands of a piece of boundary.

    (tx, ty): its direction; a = x ty − y tx; h, hx, hy: h and its products with x and y; k, kx, ky:
    the same of α k; q: what is left of α k, over β, where its divergence is taken.
    """
    mass = (a * h + tx * k) / 3.0  # of ∫ h
    first = 0.25 * (a * hx + tx * kx)  # of ∫ x h
    second = 0.25 * (a * hy + tx * ky) + (a * k + tx * q) / 12.0  # of ∫ y h
    return (
        tx * h, ty * h, tx * hx, tx * hy + mass, ty * hx - mass, ty * hy,
        a * hx - 3.0 * first, a * hy - 3.0 * second,
    )  # fmt: skip


@inlined
def _potentials(alpha: float, beta: float, x: float, y: float) -> tuple[float, float, float]:
    """H, α k and what is left of that at a place (x, y)."""
    up = alpha - beta * y
    w = math.sqrt(up * up + beta * beta * x * x)
    if _FAR * beta > alpha:
        inverse = 1.0 / beta
        c = alpha * inverse
        h = (w - alpha) * inverse
        k = c * (h + y)
        return h, k, c * k
    below = 1.0 / (w + alpha)
    square = x * x + y * y
    h = (beta * square - 2.0 * alpha * y) * below
    k = alpha * (square + y * h) * below
    return h, k, alpha * (y * k - 0.5 * h * x * x) * below


@inlined
def sums_at(alpha: float, beta: float, x: float, y: float, tx: float, ty: float) -> Sums:
    """The integrands at a point of the boundary, with its direction (tx, ty)."""
    h, k, q = _potentials(alpha, beta, x, y)
    return _combined(tx, ty, x * ty - y * tx, h, x * h, y * h, k, x * k, y * k, q)


@inner
def line_sums(
    alpha: float, beta: float, x: float, y: float, to_x: float, to_y: float
) -> Sums:  # fmt: skip
    """A straight piece of boundary from (x, y) to (to_x, to_y)."""
    length = math.sqrt((to_x - x) * (to_x - x) + (to_y - y) * (to_y - y))
    if length == 0.0:
        return NOTHING
    tx, ty = (to_x - x) / length, (to_y - y) / length
    if not _FAR * beta > alpha:
        sums, half = NOTHING, 0.5 * length
        mx, my = 0.5 * (x + to_x), 0.5 * (y + to_y)
        for i in range(_NODES):
            offset = half * _NODE[i]
            weight = half * _WEIGHT[i]
            here = sums_at(alpha, beta, mx + offset * tx, my + offset * ty, tx, ty)
            sums = added(sums, weight, here)
        return sums
    # s along it from the foot (x0, y0) of the disc's centre; w/β = hypot(s − place, off)
    begin = x * tx + y * ty
    end = begin + length
    x0, y0 = x - begin * tx, y - begin * ty
    c = alpha / beta
    place, off = (c - y0) * ty - x0 * tx, (c - y0) * tx + x0 * ty
    one, two = begin - place, end - place
    far, near = math.sqrt(two * two + off * off), math.sqrt(one * one + off * off)
    w0 = 0.5 * (two * far - one * near)
    if off != 0.0:
        size = abs(off)
        w0 += 0.5 * off * off * (math.asinh(two / size) - math.asinh(one / size))
    w1 = length * (one + two) * (far * far + far * near + near * near) / (3.0 * (far + near))
    w1 += place * w0
    l1 = 0.5 * length * (begin + end)
    l2 = length * (begin * begin + begin * end + end * end) / 3.0
    h0, h1 = w0 - c * length, w1 - c * l1
    hx, hy = x0 * h0 + tx * h1, y0 * h0 + ty * h1
    k = c * (h0 + y0 * length + ty * l1)
    kx = c * (hx + x0 * y0 * length + (x0 * ty + y0 * tx) * l1 + tx * ty * l2)
    ky = c * (hy + y0 * y0 * length + 2.0 * y0 * ty * l1 + ty * ty * l2)
    return _combined(tx, ty, x0 * ty - y0 * tx, h0, hx, hy, k, kx, ky, c * k)
