"""Sums of the slip direction over what sides and arcs bound, along these.

With C the instantaneous centre, R the distance from it and (R, t) polar coordinates about it, the
slip direction e = sgn w (−sin t, cos t) is the same all along a ray.  So the integral over the area
is one along its boundary, ∫ e g dA = ∮ e [∫ g R dR] dt, and on a straight side that is elementary.
With the unit tangent t and outward normal n of a side, d, s₀ and s₁ its place along n and its ends
along t from C, R₀ and R₁ how far these are, L its length,

    A₀ = ln((R₀ + R₁ + L)/(R₀ + R₁ − L)),  A₁ = R₁ − R₀,  A₂ = ([sR] − d² A₀)/2,
    B₀ = ([sR] + d² A₀)/2,  B₁ = (R₁³ − R₀³)/3,

    ∫ e dA = ½ Σ d (d A₀ t − A₁ n),  ∫ R r dA = ¼ Σ d (d B₀ n + B₁ t),
    ∫ e ⊗ r dA = ⅓ Σ d [(d A₀ t − A₁ n) ⊗ d n + (d A₁ t − A₂ n) ⊗ t]     (r from C, sgn w = 1):

the last without a trace, as e is across r, and yx − xy = ∫ R dA; where a base is narrow its parts
across are as exact as it is narrow, which a tall one needs.  So seven sums are all, with
one logarithm and two roots a side, of four sides at once.  Those of arcs are elliptic
(:mod:`puck_tables.kernels.circle_arcs`).  Where C lies far away these cancel; there the integral
of e along a ray runs from the distance of C instead of 0, which is a short polynomial, and Gauss's
rule along a side or an arc is exact to rounding.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, Sums, added
from puck_tables.kernels.circle_arcs import along_arc, slips_along
from puck_tables.kernels.compile import inlined, inner, summed
from puck_tables.kernels.elementary import cosine_sine_of, log_of

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
_ARC_NODES = 16  # and on an arc that turns no farther: test_strips_against_scans
_PANEL = 2.6  # rad
_ARC_NODE, _ARC_WEIGHT = np.polynomial.legendre.leggauss(_ARC_NODES)
_LANES = 4  # sides at once: as many as a box has, and as registers of most machines hold
_WHOLE = 2.0 * math.pi  # rad: a whole turn
_SHORT = 0.05  # of the sum of the distances of its ends: a series of six terms is exact
LEAST = 1e-17  # of a length: C on a side; what the logarithm loses is multiplied by d² = 0


# ∫ e, 4 ∫ R r, and of 3 ∫ e ⊗ r the first, xy and yx; about C
Parts = tuple[float, float, float, float, float, float, float]
_NO_PARTS: Parts = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


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
        return _far_sides(base, first, count, ux, uy, w)
    cx, cy = -uy / w, ux / w
    return _about_origin(_sides(base, first, count, cx, cy), cx, cy, w)


@inlined
def piece_sums(
    base: FloatArray, first: int, count: int, reach: float, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    """Sums over what sides and arcs bound, as :func:`polygon_sums`; whole circles are left out."""
    far = math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w)
    if far:
        sums = _far_sides(base, first, count, ux, uy, w)
        for at in range(first, first + PIECE_COLUMNS * count, PIECE_COLUMNS):
            if base[at + TURN] != 0.0 and abs(base[at + TURN]) != _WHOLE:
                sums = added(sums, 1.0, _far_arc(base, at, ux, uy, w))
        return sums
    cx, cy = -uy / w, ux / w
    parts = _sides(base, first, count, cx, cy)
    for at in range(first, first + PIECE_COLUMNS * count, PIECE_COLUMNS):
        if base[at + TURN] != 0.0 and abs(base[at + TURN]) != _WHOLE:
            parts = _summed(parts, _arc(base, at, cx, cy))
    return _about_origin(parts, cx, cy, w)


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
def _summed(one: Parts, two: Parts) -> Parts:
    return (
        summed(one[0], two[0]), summed(one[1], two[1]), summed(one[2], two[2]),
        summed(one[3], two[3]), summed(one[4], two[4]), summed(one[5], two[5]),
        summed(one[6], two[6]),
    )  # fmt: skip


@inlined
def _sides(base: FloatArray, first: int, count: int, cx: float, cy: float) -> Parts:
    parts = _NO_PARTS
    for block in range(0, count, _LANES):
        for lane in range(_LANES):  # beyond the last side nothing is added, nor of an arc
            i = first + PIECE_COLUMNS * (block + lane if block + lane < count else block)
            there = block + lane < count and base[i + TURN] == 0.0
            px, py = base[i + BEGIN_X] - cx, base[i + BEGIN_Y] - cy
            tx, ty, length = base[i + TANGENT_X], base[i + TANGENT_Y], base[i + LENGTH]
            d, begin = (px * ty - py * tx if there else 0.0), px * tx + py * ty
            end = begin + length
            near, far = math.sqrt(d * d + begin * begin), math.sqrt(d * d + end * end)
            both, sum_of = near + far, begin + end
            square = d * d * log_of((both + length) / max(both - length, LEAST * length))
            share = length / both
            across = d * share * sum_of
            product = 0.5 * share * (both * both + sum_of * sum_of)
            short = _second(share, sum_of, both)
            a2 = short if share < _SHORT else 0.5 * (product - square)
            b0, b1 = (
                0.5 * (product + square),
                share * sum_of * (far * far + far * near + near * near) / 3.0,
            )
            lever, cosine, sine = d * b0, tx * tx - ty * ty, tx * ty
            twice = 2.0 * across * sine
            parts = _summed(parts, (
                0.5 * (square * tx - across * ty), 0.5 * (square * ty + across * tx),
                d * (lever * ty + b1 * tx), d * (b1 * ty - lever * tx),
                d * ((square - a2) * sine + across * cosine),
                d * (twice - square * tx * tx - a2 * ty * ty),
                d * (twice + square * ty * ty + a2 * tx * tx),
            ))  # fmt: skip
    return parts


@inner
def _arc(base: FloatArray, at: int, cx: float, cy: float) -> Parts:
    """Of an arc; its angles are from the direction from C to its middle."""
    mx, my = base[at + ABOUT_X], base[at + ABOUT_Y]
    radius, turn = base[at + RADIUS], base[at + TURN]
    ox, oy = mx - cx, my - cy
    apart = math.sqrt(ox * ox + oy * oy)
    ox, oy = (ox / apart, oy / apart) if apart > 0.0 else (1.0, 0.0)
    px, py, qx, qy = base[at + BEGIN_X], base[at + BEGIN_Y], base[at + END_X], base[at + END_Y]
    if turn < 0.0:
        px, py, qx, qy = qx, qy, px, py
    per = 1.0 / radius
    px, py, qx, qy = per * (px - mx), per * (py - my), per * (qx - mx), per * (qy - my)
    long, short = max(apart, radius), min(apart, radius)
    whole, first, second, aside, both = slips_along(along_arc(
        short / long, (long - short) / long, px * ox + py * oy, py * ox - px * oy,
        qx * ox + qy * oy, qy * ox - qx * oy, abs(turn),
    ))  # fmt: skip
    scale = math.copysign(long * radius, turn)
    ex, ey = -scale * aside, scale * first
    product = apart * radius
    rx = scale * (product * (whole + second) + (radius * radius + apart * apart) * first)
    ry = scale * radius * (radius * aside + apart * both)
    xx = -scale * (0.5 * apart * aside + radius * both)
    mean = 0.5 * scale * (apart * first + radius * (2.0 * second - whole))
    cosine, sine = ox * ox - oy * oy, 2.0 * ox * oy
    size = 0.5 * scale * (radius * whole + apart * first)
    xx, mean = 3.0 * (xx * cosine - mean * sine), 3.0 * (mean * cosine + xx * sine)
    parts = (
        ox * ex - oy * ey, oy * ex + ox * ey, ox * rx - oy * ry, oy * rx + ox * ry, xx,
        mean - size, mean + size,
    )  # fmt: skip
    begin = _end_terms(base[at + BEGIN_X] - cx, base[at + BEGIN_Y] - cy)
    end = _end_terms(base[at + END_X] - cx, base[at + END_Y] - cy)
    return _summed(_summed(parts, begin), (
        -end[0], -end[1], 0.0, 0.0, -end[4], -end[5], -end[6]
    ))  # fmt: skip


@inlined
def _end_terms(x: float, y: float) -> Parts:
    """Of what R dr and R dr ⊗ r are more than as sides have them: ½ R r and R r ⊗ r at an end."""
    r = math.sqrt(x * x + y * y)
    return 0.5 * r * x, 0.5 * r * y, 0.0, 0.0, 0.5 * r * (x * x - y * y), r * x * y, r * x * y


@inlined
def _about_origin(parts: Parts, cx: float, cy: float, w: float) -> Sums:
    """Sums about the origin from those about C, of a spin that is not negative."""
    sign = 1.0 if w > 0.0 else -1.0
    ex, ey, xx = sign * parts[0], sign * parts[1], sign * parts[4] / 3.0
    xy, yx = sign * parts[5] / 3.0, sign * parts[6] / 3.0
    size = yx - xy
    swing = size + cx * ey - cy * ex
    return (
        ex, ey, xx + ex * cx, xy + ex * cy, yx + ey * cx, ey * cy - xx,
        0.25 * sign * parts[2] + cx * yx - cy * xx + swing * cx,
        0.25 * sign * parts[3] - cx * xx - cy * xy + swing * cy,
    )  # fmt: skip


@inlined
def _far_sides(
    base: FloatArray, first: int, count: int, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    sums = NOTHING
    for i in range(first, first + PIECE_COLUMNS * count, PIECE_COLUMNS):
        if base[i + TURN] != 0.0:
            continue
        half = 0.5 * base[i + LENGTH]
        hx, hy = half * base[i + TANGENT_X], half * base[i + TANGENT_Y]
        mx, my = base[i + BEGIN_X] + hx, base[i + BEGIN_Y] + hy
        for node in range(NODES):
            qx, qy = mx + NODE[node] * hx, my + NODE[node] * hy
            sums = added(sums, WEIGHT[node], _far_at(ux, uy, w, qx, qy, hx, hy))
    return sums


@inner
def _far_arc(base: FloatArray, at: int, ux: float, uy: float, w: float) -> Sums:
    mx, my = base[at + ABOUT_X], base[at + ABOUT_Y]
    radius, turn = base[at + RADIUS], base[at + TURN]
    sums, panels = NOTHING, 1 + int(abs(turn) / _PANEL)
    half = 0.5 * turn / panels
    for panel in range(panels):
        c, s = cosine_sine_of(base[at + START] + (2.0 * panel + 1.0) * half)
        for node in range(_ARC_NODES // 2):
            # of a node, and of the one as far on the other side of the middle of the panel
            across, along = cosine_sine_of(half * _ARC_NODE[node])
            weight, cc, ss, cs, sc = _ARC_WEIGHT[node], c * across, s * along, c * along, s * across
            px, py = radius * (cc - ss), radius * (sc + cs)
            qx, qy = radius * (cc + ss), radius * (sc - cs)
            one = _far_at(ux, uy, w, mx + px, my + py, -half * py, half * px)
            other = _far_at(ux, uy, w, mx + qx, my + qy, -half * qy, half * qx)
            sums = added(added(sums, weight, one), weight, other)
    return sums


@inlined
def _far_at(
    ux: float, uy: float, w: float, qx: float, qy: float, hx: float, hy: float
) -> Sums:  # fmt: skip
    """At a point of the boundary of which (hx, hy) is a piece, from the distance of C to there.

    With s from there, at (V + |w| s)/|w| from C.
    """
    speed, spin, sign = math.sqrt(ux * ux + uy * uy), abs(w), -1.0 if w < 0.0 else 1.0
    vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
    inverse = 1.0 / slip
    k0 = deep * (speed + 0.5 * spin * deep)
    k1 = deep * deep * (0.5 * speed + spin * deep / 3.0)
    k2 = deep * deep * deep * (speed / 3.0 + 0.25 * spin * deep)
    weight = (vx * hx + vy * hy) * inverse * inverse
    # along the ray: from (bx, by) at s = 0 towards the boundary, r × e = sign (lever + s)
    dx, dy = sign * vy * inverse, -sign * vx * inverse
    bx, by = qx - deep * dx, qy - deep * dy
    lever = qx * dx + qy * dy - deep
    side = sign * weight * inverse
    fx, fy = side * vx, side * vy
    px, py = bx * k0 + dx * k1, by * k0 + dy * k1
    return (
        fx * k0, fy * k0, fx * px, fx * py, fy * px, fy * py,
        weight * (lever * px + bx * k1 + dx * k2), weight * (lever * py + by * k1 + dy * k2),
    )  # fmt: skip
