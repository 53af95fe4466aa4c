"""Sums of friction whose coefficient depends on the slip speed, along the contour of a base.

Or of a part of it: a contour is rows of straight pieces and arcs
(:mod:`puck_tables.kernels.base_clipping`), those of a base itself its sides and circles.

With C the instantaneous centre, R and (R, t) polar coordinates about it, W = |ω| and H_k the
moments of the law (:mod:`puck_tables.contact.law_moments`) at W R, along a piece dr of the contour

    ∫ f e dA = ∮ e H₁ (r × dr),  ∫ f R dA = ∮ R H₂ (r × dr),  ∫ f R r dA = ∮ R r H₃ (r × dr),
    ∫ f e ⊗ r dA = ∮ e ⊗ r H₂ (r × dr)      (r from C).

Where it depends on the direction of the slip, too, T = f A² e/|A e| stands in place of f e, with
A = diag(p, q) in axes (:mod:`puck_tables.kernels.elliptic_sums`).  All along a ray from C e is the
same, so that the H_k are: in the first of these and the last e becomes A² e/|A e|, and the third,
of r × T = R f |A e|, has R r |A e| in place of R r.

On a straight side at the distance d from C, r × dr = d ds, and with y = asinh(s/|d|) the integrands
are entire but for the law and 1/|A e|: Gauss's rule on panels of y.  On an arc panels shrink to
C.  Panels end where the law bends, those of a side with each of its pieces
(:mod:`puck_tables.kernels.law_panels`), so that all nodes of one are had at once.  Where C lies far
away these cancel: there the inner integral runs from the distance of C to the contour.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import NOTHING, Sums, moved, plus
from puck_tables.kernels.compile import arrays_at_first, inlined, inner, kernel, summed
from puck_tables.kernels.elementary import exp_of, log_of
from puck_tables.kernels.elliptic_sums import Ellipse
from puck_tables.kernels.law_axes import (
    PLAIN,
    Square,
    against,
    branches_of_circle,
    branches_of_side,
    by_axes,
    square_along,
)
from puck_tables.kernels.law_panels import (
    FAR,
    NODE,
    NODES,
    ON_SIDE,
    WEIGHT,
    arc_from_nearest,
    begin_of,
    circle_end,
    law_sums_at_first,
    next_end,
    panels_far_off,
    side_panel,
)
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    BEGIN_X,
    BEGIN_Y,
    LENGTH,
    PIECE_COLUMNS,
    RADIUS,
    START,
    TANGENT_X,
    TANGENT_Y,
    TURN,
    ray_to,
)

_POWERS = DEGREE + 1  # coefficients of a moment on a piece
_FAR_OF_AXES = 2.5  # times the reach, over the ratio of the axes: a rule goes across the base


@inlined
def _polynomials_at(law: FloatArray, u: float) -> tuple[int, float]:
    """Where the polynomials of a slip speed begin, and its t."""
    low = begin_of(law, u)
    begin, end = law[low], law[low + 1]
    first = 2 + int(law[0]) + (low - 1) * MOMENTS * _POWERS
    return first, (2.0 * u - begin - end) / (end - begin)


@inlined
def _moments(law: FloatArray, u: float) -> tuple[float, float, float]:
    """H₁, H₂ and H₃ at a slip speed."""
    first, t = _polynomials_at(law, u)
    h1, h2, h3 = 0.0, 0.0, 0.0
    for power in range(_POWERS - 1, -1, -1):
        h1 = h1 * t + law[first + _POWERS + power]
        h2 = h2 * t + law[first + 2 * _POWERS + power]
        h3 = h3 * t + law[first + 3 * _POWERS + power]
    return h1, h2, h3


@inlined
def coefficient_at(law: FloatArray, u: float) -> float:
    """F at a slip speed."""
    first, t = _polynomials_at(law, u)
    f = 0.0
    for power in range(_POWERS - 1, -1, -1):
        f = f * t + law[first + power]
    return f


@inner
def _at(
    law: FloatArray, axes: Ellipse, spin: float, rx: float, ry: float, distance: float, area: float
) -> Sums:
    """What a point of the contour adds, about C, with r × dr = ``area``; e for ω > 0."""
    h1, h2, h3 = _moments(law, spin * distance)
    ex, ey = against(axes, -ry / distance, rx / distance)
    one, two, three = area * h1, area * h2, area * (rx * ey - ry * ex) * h3
    return (
        one * ex, one * ey, two * ex * rx, two * ex * ry, two * ey * rx, two * ey * ry,
        three * rx, three * ry,
    )  # fmt: skip


@inlined
def _on_panel(
    law: FloatArray, spin: float, away: float, piece: int, y: float, half: float, square: Square,
    directed: bool,
) -> tuple[float, float, float, float, float, float, float]:  # fmt: skip
    """∫ of H₁, H₁ s, H₂, H₂ s, H₂ s², H₃ R² and H₃ R² s over y, from y over 2 ``half``.

    ``directed``, a constant: those of H₁ and H₂ by 1/|A e|, the others by |A e|.
    """
    first = 2 + int(law[0]) + (piece - 1) * MOMENTS * _POWERS + _POWERS
    begin, end = law[piece], law[piece + 1]
    scale, shift = 2.0 * spin / (end - begin), (begin + end) / (end - begin)
    a, b, c, d, e, f, g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(NODES):
        up = exp_of(y + half * (1.0 + NODE[n]))
        down = 1.0 / up
        s, distance = 0.5 * away * (up - down), 0.5 * away * (up + down)
        t = scale * distance - shift
        h1, h2, h3 = 0.0, 0.0, 0.0
        for power in range(_POWERS - 1, -1, -1):
            h1 = h1 * t + law[first + power]
            h2 = h2 * t + law[first + _POWERS + power]
            h3 = h3 * t + law[first + 2 * _POWERS + power]
        weight = half * WEIGHT[n]
        h1, h2, h3 = weight * h1, weight * h2, weight * distance * distance * h3
        if directed:
            whole = math.sqrt(square.one + s * (square.s + s * square.ss)) / distance
            h1, h2, h3 = h1 / whole, h2 / whole, h3 * whole
        a, b, c, d = summed(a, h1), summed(b, h1 * s), summed(c, h2), summed(d, h2 * s)
        e, f, g = summed(e, h2 * s * s), summed(f, h3), summed(g, h3 * s)
    return a, b, c, d, e, f, g


@inner
def _along_side(
    law: FloatArray, axes: Ellipse, spin: float, px: float, py: float, tx: float, ty: float,
    length: float, least: float,
) -> Sums:  # fmt: skip
    """A straight side that begins at p from C, about C: both ways from where it is nearest."""
    d, begin = px * ty - py * tx, px * tx + py * ty
    away = abs(d)
    if away <= least:
        return NOTHING
    end = begin + length
    near, far = math.sqrt(d * d + begin * begin), math.sqrt(d * d + end * end)
    low = math.copysign(log_of((abs(begin) + near) / away), begin)
    high = math.copysign(log_of((abs(end) + far) / away), end)
    one, one_s, two, two_s, two_ss, three, three_s = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    directed = axes.along != axes.across
    for way in range(2):
        y, last, side, distance = low, high, 1.0, near
        if way == 1:
            y, last, side, distance = -high, -low, -1.0, far
        if y < 0.0:
            y, distance = 0.0, away
        piece = begin_of(law, spin * distance) if y < last else 1
        branches = branches_of_side(axes, side * d, tx, ty)
        while y < last:
            to, after = side_panel(law, spin, away, piece, y, last, branches)
            half = 0.5 * (to - y)
            if directed:
                square = square_along(axes, side * d, tx, ty)
                a, b, c, e, f, g, h = _on_panel(law, spin, away, piece, y, half, square, True)
            else:
                a, b, c, e, f, g, h = _on_panel(law, spin, away, piece, y, half, PLAIN, False)
            one, one_s, two, two_s = one + a, one_s + side * b, two + c, two_s + side * e
            two_ss, three, three_s = two_ss + f, three + g, three_s + side * h
            y, piece = to, after
    product = tx * ty
    both = product * (two_ss - d * d * two) + d * (ty * ty - tx * tx) * two_s
    across, twice = 2.0 * d * product * two_s, d * d * two
    sums = (
        d * (d * tx * one - ty * one_s), d * (d * ty * one + tx * one_s), -d * both,
        -d * (tx * tx * twice - across + ty * ty * two_ss),
        d * (ty * ty * twice + across + tx * tx * two_ss), d * both,
        d * (d * ty * three + tx * three_s), d * (ty * three_s - d * tx * three),
    )  # fmt: skip
    return by_axes(axes, sums)


@inner
def _along_far_side(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, px: float, py: float,
    tx: float, ty: float, length: float,
) -> Sums:  # fmt: skip
    """A straight side that begins at p, far from C, about the centre of mass, as where it bends."""
    spin, cx, cy, sums = abs(w), -uy / w, ux / w, NOTHING
    d, begin = (px - cx) * ty - (py - cy) * tx, (px - cx) * tx + (py - cy) * ty
    away = abs(d)
    if away == 0.0:
        return sums
    low, high = math.asinh(begin / away), math.asinh((begin + length) / away)
    for way in range(2):
        y, last, side = max(low, 0.0), high, 1.0
        if way == 1:
            y, last, side = max(-high, 0.0), -low, -1.0
        piece = begin_of(law, spin * away * math.cosh(y)) if y < last else 1
        branches = branches_of_side(axes, side * d, tx, ty)
        while y < last:
            end, piece = side_panel(law, spin, away, piece, y, last, branches)
            half = 0.5 * (end - y)
            for n in range(NODES):
                at = y + half * (1.0 + NODE[n])
                s, weight = side * away * math.sinh(at) - begin, half * WEIGHT[n]
                weight *= away * math.cosh(at)
                part = _from_far(
                    law, axes, ux, uy, w, px + s * tx, py + s * ty, weight * tx, weight * ty
                )  # fmt: skip
                sums = plus(sums, 1.0, part)
            y = end
    return sums


@inner
def _along_arc(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, far: bool, x: float, y: float,
    size: float, start: float, turn: float,
) -> Sums:  # fmt: skip
    """An arc about a place, from half-turn to half-turn away from where it is nearest to C."""
    spin, gx, gy, sums = abs(w), x + uy / w, y - ux / w, NOTHING
    off, nearest = math.sqrt(gx * gx + gy * gy), math.atan2(-gy, -gx)
    low, high = arc_from_nearest(start, turn, nearest)
    number = float(math.floor(low / math.pi))
    while low < high:
        edge = min(math.pi * (number + 1.0), high)
        side, begin, last = 1.0, low - math.pi * number, edge - math.pi * number
        if number % 2.0 == 1.0:  # it leads back
            side = -1.0
            begin = math.pi * (number + 1.0) - edge
            last = math.pi * (number + 1.0) - low
        branches = branches_of_circle(axes, gx, gy, size, nearest, side)
        while begin < last:
            end = circle_end(law, spin, off, size, begin, last, branches)
            half = 0.5 * (end - begin)
            for n in range(NODES):
                angle = nearest + side * (begin + half * (1.0 + NODE[n]))
                c, s, weight = math.cos(angle), math.sin(angle), half * WEIGHT[n] * size
                if far:
                    part = _from_far(
                        law, axes, ux, uy, w, x + size * c, y + size * s, -weight * s, weight * c
                    )  # fmt: skip
                else:
                    rx, ry = gx + size * c, gy + size * s
                    distance = math.sqrt(rx * rx + ry * ry)
                    area = weight * (size + gx * c + gy * s)
                    part = _at(law, axes, spin, rx, ry, distance, area)
                sums = plus(sums, 1.0, part)
            begin = end
        low = edge
        number += 1.0
    return plus(NOTHING, 1.0 if turn > 0.0 else -1.0, sums)


@inner
def _from_far(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, qx: float, qy: float,
    dx: float, dy: float,
) -> Sums:  # fmt: skip
    """What a point q of the contour adds, about the centre of mass; (dx, dy): dr there."""
    speed, spin, sign = math.sqrt(ux * ux + uy * uy), abs(w), -1.0 if w < 0.0 else 1.0
    vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
    k0, k1, k2 = 0.0, 0.0, 0.0
    begin, last, out = min(deep, 0.0), max(deep, 0.0), 1.0 if deep > 0.0 else -1.0
    while begin < last:
        low = speed + spin * begin
        cut, end = next_end(law, low), last
        if cut < speed + spin * last:
            end = min(begin + (cut - low) / spin, last)
        half = 0.5 * (end - begin)
        for n in range(NODES):
            s = begin + half * (1.0 + NODE[n])
            u = speed + spin * s
            part = out * half * WEIGHT[n] * coefficient_at(law, u) * u
            k0, k1, k2 = k0 + part, k1 + part * s, k2 + part * s * s
        begin = end
    weight = sign * (vx * dx + vy * dy) / (slip * slip)
    outx, outy = sign * vy / slip, -sign * vx / slip
    bx, by = qx - deep * outx, qy - deep * outy
    tx, ty = against(axes, vx / slip, vy / slip)
    lever, turning = bx * ty - by * tx, outx * ty - outy * tx
    fx, fy = weight * tx, weight * ty
    ax, ay = bx * k0 + outx * k1, by * k0 + outy * k1
    return (
        fx * k0, fy * k0, fx * ax, fx * ay, fy * ax, fy * ay,
        weight * (lever * ax + turning * (bx * k1 + outx * k2)),
        weight * (lever * ay + turning * (by * k1 + outy * k2)),
    )  # fmt: skip


@inner
def _far_sums(
    room: FloatArray, first: int, last: int, law: FloatArray, axes: Ellipse, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    sums = NOTHING
    for i in range(first, last, PIECE_COLUMNS):
        turn = room[i + TURN]
        if turn == 0.0:
            half = 0.5 * room[i + LENGTH]
            hx, hy = half * room[i + TANGENT_X], half * room[i + TANGENT_Y]
            mx, my = room[i + BEGIN_X] + hx, room[i + BEGIN_Y] + hy
            for n in range(NODES):
                part = _from_far(law, axes, ux, uy, w, mx + NODE[n] * hx, my + NODE[n] * hy, hx, hy)
                sums = plus(sums, WEIGHT[n], part)
            continue
        cx = room[i + ABOUT_X]
        cy = room[i + ABOUT_Y]
        size = room[i + RADIUS]
        panels = panels_far_off(turn)
        half = 0.5 * turn / panels
        for k in range(panels * NODES):
            n = k % NODES
            angle = room[i + START] + half * (2.0 * (k // NODES) + 1.0 + NODE[n])
            c, s = math.cos(angle), math.sin(angle)
            part = _from_far(
                law, axes, ux, uy, w, cx + size * c, cy + size * s, -size * s, size * c
            )  # fmt: skip
            sums = plus(sums, half * WEIGHT[n], part)
    return sums


def _at_first(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, axes: Ellipse,
    ux: float, uy: float, w: float,
) -> Sums:  # fmt: skip
    """By arrays, but where friction bends and C is far away."""
    if _has_kinks_far_away(reach, law, axes, ux, uy, w):
        return _as_written(room, first, last, reach, law, axes, ux, uy, w, True)
    return law_sums_at_first(room, first, last, reach, law, axes, ux, uy, w)


@inlined
def _has_kinks_far_away(
    reach: float, law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float
) -> bool:
    """Whether C is far away, and friction bends between the slips under the base.

    By the law, or by the direction.
    """
    speed, rim = math.sqrt(ux * ux + uy * uy), reach * abs(w)
    if not speed > FAR * rim:
        return False
    least, most = min(axes.along, axes.across), max(axes.along, axes.across)
    turns = least < most and least * speed < _FAR_OF_AXES * most * rim
    return turns or next_end(law, speed - rim) < speed + rim


@inlined
def _as_written(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, axes: Ellipse,
    ux: float, uy: float, w: float, far: bool,
) -> Sums:  # fmt: skip
    """The sums; ``far``: C is far away, and friction bends between the slips under the base."""
    if not far and math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w):
        return _far_sums(room, first, last, law, axes, ux, uy, w)
    sums, cx, cy, least = NOTHING, -uy / w, ux / w, ON_SIDE * reach
    for i in range(first, last, PIECE_COLUMNS):
        if room[i + TURN] != 0.0:
            x, y, size = room[i + ABOUT_X], room[i + ABOUT_Y], room[i + RADIUS]
            part = _along_arc(
                law, axes, ux, uy, w, far, x, y, size, room[i + START], room[i + TURN]
            )  # fmt: skip
            sums = plus(sums, 1.0, part)
            continue
        px = room[i + BEGIN_X]
        py = room[i + BEGIN_Y]
        tx = room[i + TANGENT_X]
        ty = room[i + TANGENT_Y]
        if far:
            part = _along_far_side(law, axes, ux, uy, w, px, py, tx, ty, room[i + LENGTH])
        else:
            part = _along_side(
                law, axes, abs(w), px - cx, py - cy, tx, ty, room[i + LENGTH], least
            )  # fmt: skip
        sums = plus(sums, 1.0, part)
    if far:
        return sums
    return plus(NOTHING, 1.0 if w > 0.0 else -1.0, moved(sums, cx, cy))


@arrays_at_first(_at_first)
@kernel
def law_sums(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, axes: Ellipse,
    ux: float, uy: float, w: float,
) -> Sums:  # fmt: skip
    """Sums of T, by the slip speed and the direction, over what a contour bounds; not at rest.

    ``first``, ``last``: where its rows begin and end in ``room``; ``reach``: of the base, m;
    ``axes``: the factors of the law along and across.
    """
    far = _has_kinks_far_away(reach, law, axes, ux, uy, w)
    return _as_written(room, first, last, reach, law, axes, ux, uy, w, far)
