"""Sums of the slip direction over a polygon, along its sides.

With C the instantaneous centre, R the distance from it and (R, t) polar coordinates about it, the
slip direction e = sgn w (−sin t, cos t) is the same all along a ray.  So the integral over the area
is one along its boundary, ∫ e g dA = ∮ e [∫ g R dR] dt, and on a straight side that is elementary.
With the unit tangent t and outward normal n of a side, d, s₀ and s₁ its place along n and its ends
along t from C, R₀ and R₁ how far these are, L its length,

    A₀ = ln((R₀ + R₁ + L)/(R₀ + R₁ − L)),  A₁ = R₁ − R₀,  A₂ = ([sR] − d² A₀)/2,
    B₀ = ([sR] + d² A₀)/2,  B₁ = (R₁³ − R₀³)/3,

    ∫ e dA = ½ Σ d (d A₀ t − A₁ n),  ∫ R dA = ⅓ Σ d B₀,  ∫ R r dA = ¼ Σ d (d B₀ n + B₁ t),
    ∫ e ⊗ r dA = ⅓ Σ d [(d A₀ t − A₁ n) ⊗ d n + (d A₁ t − A₂ n) ⊗ t]     (r from C, sgn w = 1):

the last without a trace, as e is across r, and yx − xy = ∫ R dA.  So seven sums are all, with one
logarithm and two roots a side, of four sides at once.  Where C lies far away these cancel; there
the inner integral runs from the distance of C instead of 0, which is a short polynomial, and
Gauss's rule along a side is exact to rounding.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, Sums
from puck_tables.kernels.compile import inlined, summed
from puck_tables.kernels.elementary import log_of

# of a piece of contour: where it begins; of a straight one its unit tangent with the base to the
# left, its length, and whether it begins where the one before ends (0) or not (1), of an arc in
# place of these its middle, its radius, and from which angle; where it ends, and by which angle it
# turns (0: it is straight)
BEGIN_X, BEGIN_Y, TANGENT_X, TANGENT_Y, LENGTH, ANEW, END_X, END_Y, TURN = range(9)
ABOUT_X, ABOUT_Y, RADIUS, START = TANGENT_X, TANGENT_Y, LENGTH, ANEW
PIECE_COLUMNS = 9
# times the reach of the base: closer, closed forms lose less than 1e-13; the rule errs at a quarter
# of it, as test_friction_is_that_of_the_judge tells
FAR = 6.0
NODES = 8  # of Gauss's rule on a side that far away: 6e-16, told by the same test
NODE, WEIGHT = np.polynomial.legendre.leggauss(NODES)
_LANES = 4  # sides at once: as many as a box has, and as registers of most machines hold
_SHORT = 0.05  # of the sum of the distances of its ends: a series of six terms is exact
LEAST = 1e-17  # of a length: C on a side; what the logarithm loses is multiplied by d² = 0


@inlined
def ray_to(
    ux: float, uy: float, w: float, qx: float, qy: float
) -> tuple[float, float, float, float]:
    """The slip at a point of the boundary, its size, and how much farther than |c| that is from C.

    |c| is how far the origin is from C.
    """
    vx, vy = ux - w * qy, uy + w * qx
    slip, speed = math.sqrt(vx * vx + vy * vy), math.sqrt(ux * ux + uy * uy)
    sign = -1.0 if w < 0.0 else 1.0
    deep = sign * (2.0 * (uy * qx - ux * qy) + w * (qx * qx + qy * qy)) / (slip + speed)
    return vx, vy, slip, deep


@inlined
def polygon_sums(
    base: FloatArray, first: int, count: int, reach: float, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    """Sums over what sides bound, about the origin, at a slip (ux, uy) and a spin, not both 0.

    ``base``: where ``count`` sides stand from ``first`` on; ``reach``: no corner lies farther from
    the origin.
    """
    if math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w):
        return _far(base, first, count, ux, uy, w)
    return _near(base, first, count, ux, uy, w)


@inlined
def _second(q: float, across: float, both: float) -> float:
    """A₂ of a side that is short for its distance, where [sR] and d² A₀ cancel.

    With q = L/(R₀ + R₁): ¼ ((s₀ + s₁)² (2q − g) + (R₀ + R₁)² g), g = q − (1 − q²) atanh q.
    """
    square = q * q
    series = 2.0 / 63.0 + square * (2.0 / 99.0 + square * (2.0 / 143.0))
    g = q * square * (2.0 / 3.0 + square * (2.0 / 15.0 + square * (2.0 / 35.0 + square * series)))
    return 0.25 * (across * across * (2.0 * q - g) + both * both * g)


@inlined
def _near(base: FloatArray, first: int, count: int, ux: float, uy: float, w: float) -> Sums:
    cx, cy = -uy / w, ux / w
    ex, ey, size, rx, ry, xx, mean = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for block in range(0, count, _LANES):
        for lane in range(_LANES):  # beyond the last side: one on which C lies adds nothing
            there = block + lane < count
            i = first + PIECE_COLUMNS * (block + lane if there else block)
            px, py = base[i + BEGIN_X] - cx, base[i + BEGIN_Y] - cy
            tx, ty, length = base[i + TANGENT_X], base[i + TANGENT_Y], base[i + LENGTH]
            d, begin = (px * ty - py * tx if there else 0.0), px * tx + py * ty
            end = begin + length
            near, far = math.sqrt(d * d + begin * begin), math.sqrt(d * d + end * end)
            both = near + far
            a0 = log_of((both + length) / max(both - length, LEAST * length))
            share = length / both
            a1 = share * (begin + end)
            product, square = end * far - begin * near, d * d * a0
            short = _second(share, begin + end, both)
            a2 = short if share < _SHORT else 0.5 * (product - square)
            b0 = 0.5 * (product + square)
            b1 = (1.0 / 3.0) * a1 * (far * far + far * near + near * near)
            across, turns = d * a1, d * d * b0
            ex, ey = summed(ex, square * tx - across * ty), summed(ey, square * ty + across * tx)
            size = summed(size, d * b0)
            rx, ry = summed(rx, turns * ty + d * b1 * tx), summed(ry, d * b1 * ty - turns * tx)
            # e ⊗ r by twice the angle of t
            one, other = d * across, d * (square - a2)
            cosine, sine = tx * tx - ty * ty, tx * ty
            xx = summed(xx, one * cosine + other * sine)
            mean = summed(mean, 2.0 * one * sine - 0.5 * other * cosine)
    sign = 1.0 if w > 0.0 else -1.0
    ex, ey, size = 0.5 * sign * ex, 0.5 * sign * ey, sign * size / 3.0
    xx, mean = sign * xx / 3.0, sign * mean / 3.0
    xy, yx = mean - 0.5 * size, mean + 0.5 * size
    swing = size + cx * ey - cy * ex
    return (
        ex, ey, xx + ex * cx, xy + ex * cy, yx + ey * cx, ey * cy - xx,
        0.25 * sign * rx + cx * yx - cy * xx + swing * cx,
        0.25 * sign * ry - cx * xx - cy * xy + swing * cy,
    )  # fmt: skip


@inlined
def _far(base: FloatArray, first: int, count: int, ux: float, uy: float, w: float) -> Sums:
    """From the distance of C to the boundary, s from there, at (V + |w| s)/|w| from C."""
    speed, spin, sign = math.sqrt(ux * ux + uy * uy), abs(w), -1.0 if w < 0.0 else 1.0
    ex, ey, xx, xy, yx, yy, gx, gy = NOTHING
    for i in range(first, first + PIECE_COLUMNS * count, PIECE_COLUMNS):
        half = 0.5 * base[i + LENGTH]
        hx, hy = half * base[i + TANGENT_X], half * base[i + TANGENT_Y]
        mx, my = base[i + BEGIN_X] + hx, base[i + BEGIN_Y] + hy
        for node in range(NODES):
            qx, qy = mx + NODE[node] * hx, my + NODE[node] * hy
            vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
            inverse = 1.0 / slip
            k0 = deep * (speed + 0.5 * spin * deep)
            k1 = deep * deep * (0.5 * speed + spin * deep / 3.0)
            k2 = deep * deep * deep * (speed / 3.0 + 0.25 * spin * deep)
            weight = WEIGHT[node] * (vx * hx + vy * hy) * inverse * inverse
            # along the ray: from (bx, by) at s = 0 towards the boundary, r × e = sign (lever + s)
            dx, dy = sign * vy * inverse, -sign * vx * inverse
            bx, by = qx - deep * dx, qy - deep * dy
            lever = qx * dx + qy * dy - deep
            side = sign * weight * inverse
            fx, fy = side * vx, side * vy
            px, py = bx * k0 + dx * k1, by * k0 + dy * k1
            ex, ey = summed(ex, fx * k0), summed(ey, fy * k0)
            xx, xy = summed(xx, fx * px), summed(xy, fx * py)
            yx, yy = summed(yx, fy * px), summed(yy, fy * py)
            gx = summed(gx, weight * (lever * px + bx * k1 + dx * k2))
            gy = summed(gy, weight * (lever * py + by * k1 + dy * k2))
    return ex, ey, xx, xy, yx, yy, gx, gy
