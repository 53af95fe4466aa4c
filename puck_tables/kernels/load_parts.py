"""Sums of the slip direction along borders under a base, under Hertz's or Galin's pressure.

As in :mod:`puck_tables.kernels.base_boundary`, of W = (3/2) √(1 − ρ²) or 1/(2 √(1 − ρ²)).  On a
line through the centre of rotation C the slip direction e is the same everywhere: with p = x·e and
the place s along it, ρ² = p² + s², and powers of s times W have elementary primitives J_k.  With
the angle τ of e and c the distance of C,

    ∫ W s^k e dA = ∮ e (J_{k+1} + c e_x J_k) dτ ,   dτ = β (e·dx)/w ,

along the boundary of a part.  J_k may begin next to the centre, not at C: what lies between is odd
in e, and leaves nothing of a whole turn.

A border that ends at the rim is a sine of an angle θ there, so that nothing is a root.  Next to C
the direction turns at once, as the hyperbolic sine of a variable says that θ is of; what is left
singular are rays that touch the base.  Gauss's rule on panels that are so short that an ellipse
about their ends, of which what is singular is not inside, has axes of a given ratio.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables.kernels.base_sums import GALIN, NOTHING, Sums, added, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.elementary import angle_of, cosine_sine_of, exp_of, log_of

# of the half of a panel behind its middle
_NODE, _WEIGHT = (both[8:] for both in np.polynomial.legendre.leggauss(16))
_REACH = 1.25  # of the ellipse about a panel, its long axis over the distance of its foci
_LONGEST, _SHORTEST = 2.4, 1e-5  # of a panel
_ROUND = 1.0  # rad: of the half angle of a circle
_WIDEST = 3.0  # of the map about C
_FARTHEST = 20.0  # radii: a C farther away is as good as there
_INSIDE = 0.4  # radii: of a C closer to the centre no ray all but touches the base
_ON = 1e-14  # radii: a C as close is not on a border
_THIRD = 1.0 / 3.0  # a product is quicker than a quotient


class BorderPart(NamedTuple):
    """A piece of a border.

    Straight from (x, y) on along (tx, ty), by ``size`` sin θ; with a radius of a circle about (x,
    y), from the direction (tx, ty) on, half whose angle has the sine ``size`` sin θ.  ``depth`` cos
    θ and ``spare`` are the legs of a triangle over √(1 − ρ²).
    """

    x: float
    y: float
    tx: float
    ty: float
    radius: float
    size: float
    depth: float
    spare: float


@inlined
def powers_along(law: int, s: float, q: float) -> tuple[float, float, float, float]:
    """Primitives of W s^k, k = 0 … 3, with q = √(1 − ρ²)."""
    turn, square = angle_of(s, q), s * s + q * q
    if law == GALIN:
        return (
            0.5 * turn,
            -0.5 * q,
            0.25 * (square * turn - s * q),
            0.5 * q * (_THIRD * q * q - square),
        )
    cube = q * q * q
    return (
        0.75 * (s * q + square * turn),
        -0.5 * cube,
        0.1875 * (square * square * turn + s * q * (2.0 * s * s - square)),
        cube * (0.3 * q * q - 0.5 * square),
    )


@inlined
def loaded_at(
    alpha: float, beta: float, x: float, y: float, ux: float, uy: float, along: float, q: float,
    law: int,
) -> Sums:  # fmt: skip
    """The integrands at a point where the slip is u; ``along``: that along the boundary."""
    inverse = 1.0 / math.sqrt(ux * ux + uy * uy)
    ex, ey = ux * inverse, uy * inverse
    s, p = x * ey - y * ex, x * ex + y * ey
    j0, j1, j2, j3 = powers_along(law, s, q)
    far, share = alpha * ex, along * inverse * inverse
    a0, a1, a2 = (
        share * (beta * j1 + far * j0),
        share * (beta * j2 + far * j1),
        share * (beta * j3 + far * j2),
    )
    at_x, at_y = p * ex * a0 + ey * a1, p * ey * a0 - ex * a1
    return (
        ex * a0, ey * a0, ex * at_x, ex * at_y, ey * at_x, ey * at_y,
        p * ex * a1 + ey * a2, p * ey * a1 - ex * a2,
    )  # fmt: skip


@inlined
def _inverse_sinh(x: float) -> float:
    """To rounding of 1, or of a large value."""
    size = abs(x)
    value = log_of(size + math.sqrt(1.0 + size * size))
    return value if x > 0.0 else -value


@inlined
def _inverse_sine(x: float, y: float) -> tuple[float, float, float, float]:
    """Sine and cosine of the real part of asin(x + iy), cosh and sinh of its imaginary part ≥ 0."""
    size = x * x + y * y - 1.0
    root = math.sqrt(size * size + 4.0 * y * y)
    if size > 0.0:
        square = 0.5 * (size + root)
        cosine = abs(y) / math.sqrt(square)
    else:
        square = 2.0 * y * y / (root - size) if y != 0.0 else 0.0
        cosine = math.sqrt(0.5 * (root - size))
    cosh = math.sqrt(1.0 + square)
    return x / cosh, cosine, cosh, math.sqrt(square)


@inlined
def _angle_whose_sine(x: float) -> float:
    return angle_of(x, math.sqrt(max((1.0 - x) * (1.0 + x), 0.0)))


@inlined
def _panel_to(a: float, place: float, gap: float) -> float:
    """How long a panel from a on may be next to what is singular at place ± i gap."""
    off = place - a
    return 2.0 * (_REACH * math.sqrt(off * off + gap * gap) - off) / (_REACH * _REACH - 1.0)


@inlined
def _stretched(turn: float, gap: float) -> tuple[float, float]:
    """Where asinh(turn ± i gap) is, of a small gap."""
    root = math.sqrt(1.0 + turn * turn)
    return math.copysign(log_of(abs(turn) + root), turn), gap / root


@inlined
def _point(border: BorderPart, sine: float) -> tuple[float, float]:
    """The point at an angle θ."""
    if border.radius == 0.0:
        return border.x + border.size * sine * border.tx, border.y + border.size * sine * border.ty
    part = border.size * sine
    ahead = border.radius * (1.0 - 2.0 * part * part)
    aside = 2.0 * border.radius * part * math.sqrt((1.0 - part) * (1.0 + part))
    x, y = border.x + ahead * border.tx, border.y + ahead * border.ty
    return x - aside * border.ty, y + aside * border.tx


@inlined
def _from_touch(alpha: float, beta: float, border: BorderPart, sine: float) -> float:
    """How far an end of a piece at the rim is from where a ray touches the base, by √(1 − ρ²)."""
    x, y = _point(border, sine)
    ux, uy = alpha - beta * y, beta * x
    return abs(x * uy - y * ux) / (border.depth * math.sqrt(max(ux * ux + uy * uy, 1e-300)))


@inlined
def _line_node(
    alpha: float, beta: float, border: BorderPart, u0: float, v0: float, sine: float, cosine: float,
    turn: float, law: int,
) -> tuple[Sums, float]:  # fmt: skip
    """The integrands by θ, the angle ``turn`` behind one where the slip is (u0, v0)."""
    c2, s2 = cosine_sine_of(0.5 * turn)
    c1, s1 = 1.0 - 2.0 * s2 * s2, 2.0 * s2 * c2
    gone = 2.0 * beta * border.size * s2 * (cosine * c2 - sine * s2)
    at, q = (
        border.size * (sine * c1 + cosine * s1),
        border.depth * max(cosine * c1 - sine * s1, 0.0),
    )
    return loaded_at(
        alpha, beta, border.x + at * border.tx, border.y + at * border.ty, u0 - gone * border.ty,
        v0 + gone * border.tx, u0 * border.tx + v0 * border.ty, q, law,
    ), q  # fmt: skip


@inlined
def _arc_node(
    alpha: float, beta: float, border: BorderPart, u0: float, v0: float, sine: float, cosine: float,
    turn: float, law: int,
) -> tuple[Sums, float]:  # fmt: skip
    """The same of a round one; the angle from the one point to the other by its quarter."""
    c2, s2 = cosine_sine_of(0.5 * turn)
    c1, s1 = 1.0 - 2.0 * s2 * s2, 2.0 * s2 * c2
    leg = max(cosine * c1 - sine * s1, 0.0)
    sb, sa = border.size * sine, border.size * (sine * c1 + cosine * s1)
    rest, full = (1.0 - border.size) * (1.0 + border.size), border.size * border.size
    cb, ca = math.sqrt(rest + full * cosine * cosine), math.sqrt(rest + full * leg * leg)
    ca = max(ca, 1e-300)  # 0 at the end of a circle that touches the rim
    quarter = 2.0 * border.size * s2 * (cosine * c2 - sine * s2) / (ca + cb)
    gone = 4.0 * beta * border.radius * quarter / (1.0 + quarter * quarter)
    c3, s3 = ca * cb - sa * sb, sa * cb + ca * sb  # of the mean of both
    u = u0 - gone * (c3 * border.tx - s3 * border.ty)
    v = v0 - gone * (c3 * border.ty + s3 * border.tx)
    c4, s4 = 1.0 - 2.0 * sa * sa, 2.0 * sa * ca
    dx = border.radius * (c4 * border.tx - s4 * border.ty)
    dy = border.radius * (c4 * border.ty + s4 * border.tx)
    q = math.sqrt(border.spare + border.depth * border.depth * leg * leg)
    return loaded_at(
        alpha, beta, border.x + dx, border.y + dy, u, v, v * dx - u * dy, q, law
    ), 2.0 * border.size * leg / ca  # fmt: skip


@inlined
def _grazed(
    alpha: float, beta: float, border: BorderPart, half: float, c: float, tangent: float
) -> tuple[float, float]:
    """Where a ray from C, ``tangent`` radii of it away, touches a circle, and 1 − p² is least.

    By θ, and how far from there 1 − p² vanishes.
    """
    whole = math.sin(half)
    sine = math.copysign(whole, whole * math.cos(half)) / border.size
    if abs(sine) >= 1.0:
        return 0.0, math.inf
    x, y = _point(border, sine)
    ux, uy = alpha - beta * y, beta * x
    place = min(abs(x * ux + y * uy) / math.sqrt(max(ux * ux + uy * uy, 1e-300)), 1.0)
    gap = 2.0 * (1.0 - place) * tangent / math.sqrt(max((c - place) * (c + place), 1e-300))
    cosine, part = math.sqrt((1.0 - sine) * (1.0 + sine)), border.size * sine
    return angle_of(sine, cosine), 0.5 * math.sqrt(gap * (1.0 - part * part)) / (
        border.size * cosine
    )


@inner
def _along(
    alpha: float, beta: float, border: BorderPart, low: float, high: float, across: float,
    apart: float, seam: float, one: float, one_gap: float, two: float, two_gap: float, law: int,
) -> Sums:  # fmt: skip
    """A piece between two sines of θ; across + i apart is the sine of θ at C.

    ``seam``: how far off its ends are where they are not roots, or what ends there is not smooth;
    ``one``, ``two``: where something else is singular so far off.
    """
    sine, cosine, _, sinh = _inverse_sine(across, apart)
    middle, off = angle_of(sine, cosine), _inverse_sinh(sinh)
    scale = min(off, _WIDEST)
    x, y = _point(border, sine)
    u0, v0 = alpha - beta * y, beta * x
    tx, ty = border.tx, border.ty  # along the piece
    if border.radius > 0.0:
        tx, ty = (border.y - y) / border.radius, (x - border.x) / border.radius
    along = u0 * tx + v0 * ty
    if abs(along) < _ON * beta:
        u0, v0 = u0 + (_ON * beta - along) * tx, v0 + (_ON * beta - along) * ty
    a = _inverse_sinh((_angle_whose_sine(low) - middle) / scale)
    end = _inverse_sinh((_angle_whose_sine(high) - middle) / scale)
    # what is singular: where rays touch the base, at its rim and unseen, and the ends of pieces
    first, last = -0.5 * math.pi - middle, 0.5 * math.pi - middle
    first_gap, last_gap, touch, touch_gap = seam, seam, 0.0, math.inf
    if border.spare > 0.0:  # C is next to both ends of a whole circle
        other = math.sqrt(min(-first, last) ** 2 + off * off)
        first_gap, last_gap = min(seam, other), min(seam, other)
    elif alpha >= beta:
        first_gap = min(seam, _from_touch(alpha, beta, border, -1.0))
        last_gap = min(seam, _from_touch(alpha, beta, border, 1.0))
    if _INSIDE * beta < alpha < beta:
        c, whole = beta / alpha, u0 * u0 + v0 * v0
        down = whole * (2.0 * c * c - 1.0) - (u0 - v0) * (u0 + v0)
        more = 2.0 * sinh / (off * max(down, 1e-300))
        turn = math.copysign(more * u0 * v0, u0 * v0 * along)
        s1, c1, _, up = _inverse_sine(more * c * math.sqrt((c - 1.0) * (c + 1.0)) * whole, turn)
        touch, touch_gap = math.copysign(_inverse_sinh(up), turn), angle_of(s1, c1)
    first, first_gap = _stretched(first / scale, first_gap / scale)
    last, last_gap = _stretched(last / scale, last_gap / scale)
    one, one_gap = _stretched((one - middle) / scale, one_gap / scale)
    two, two_gap = _stretched((two - middle) / scale, two_gap / scale)
    sums = NOTHING
    while a < end:
        size = min(_panel_to(a, first, first_gap), _panel_to(a, last, last_gap))
        size = min(size, _panel_to(a, one, one_gap), _panel_to(a, two, two_gap))
        size = max(min(size, _LONGEST, _panel_to(a, touch, touch_gap)), _SHORTEST)
        if border.radius > 0.0:
            grown = exp_of(a)
            size = min(
                size,
                _inverse_sinh(0.5 * (grown - 1.0 / grown) + _ROUND / (border.size * scale)) - a,
            )
        if size > 0.5 * (end - a):
            size = end - a if size >= end - a else 0.5 * (end - a)
        grown = 0.5 * scale * exp_of(a + 0.5 * size)
        fallen = 0.25 * scale * scale / grown
        if border.radius == 0.0:
            for i in range(_NODE.size):
                grows = exp_of(0.5 * size * _NODE[i])
                falls = 1.0 / grows
                weight = 0.5 * size * _WEIGHT[i]
                rise, fall = grown * grows, fallen * falls
                here, by = _line_node(alpha, beta, border, u0, v0, sine, cosine, rise - fall, law)
                sums = added(sums, weight * (rise + fall) * by, here)
                rise, fall = grown * falls, fallen * grows
                here, by = _line_node(alpha, beta, border, u0, v0, sine, cosine, rise - fall, law)
                sums = added(sums, weight * (rise + fall) * by, here)
        else:
            for i in range(_NODE.size):
                grows = exp_of(0.5 * size * _NODE[i])
                falls = 1.0 / grows
                weight = 0.5 * size * _WEIGHT[i]
                rise, fall = grown * grows, fallen * falls
                here, by = _arc_node(alpha, beta, border, u0, v0, sine, cosine, rise - fall, law)
                sums = added(sums, weight * (rise + fall) * by, here)
                rise, fall = grown * falls, fallen * grows
                here, by = _arc_node(alpha, beta, border, u0, v0, sine, cosine, rise - fall, law)
                sums = added(sums, weight * (rise + fall) * by, here)
        a = a + size if size < end - a else end
    return sums


@inner
def loaded_line(
    alpha: float, beta: float, x: float, y: float, to_x: float, to_y: float, law: int
) -> Sums:
    """A straight piece from (x, y) to (to_x, to_y)."""
    length = math.sqrt((to_x - x) * (to_x - x) + (to_y - y) * (to_y - y))
    if length == 0.0:
        return NOTHING
    tx, ty = (to_x - x) / length, (to_y - y) / length
    begin = x * tx + y * ty
    x0, y0 = x - begin * tx, y - begin * ty
    off = y0 * tx - x0 * ty
    half = math.sqrt(max((1.0 - off) * (1.0 + off), 0.0))
    if half == 0.0:
        return NOTHING
    c = alpha / beta if alpha < _FARTHEST * beta else _FARTHEST
    apart = c * tx - off
    apart = apart if abs(apart) > _ON else _ON
    border = BorderPart(x0, y0, tx, ty, 0.0, half, half, 0.0)
    return _along(
        alpha, beta, border, begin / half, (begin + length) / half, c * ty / half, apart / half,
        math.inf, 0.0, math.inf, 0.0, math.inf, law,
    )  # fmt: skip


@inner
def loaded_arc(
    alpha: float, beta: float, cx: float, cy: float, radius: float, start: float, turn: float,
    law: int,
) -> Sums:  # fmt: skip
    """Of a circle about (cx, cy) all, or an arc in the base from an angle over a turn."""
    apart = math.sqrt(cx * cx + cy * cy)
    tx, ty = (-cx / apart, -cy / apart) if apart > 0.0 else (1.0, 0.0)
    room = (1.0 - apart + radius) * (1.0 + apart - radius)  # 1 − ρ² where it is next to the centre
    span = 4.0 * apart * radius
    size = math.sqrt(room / span) if room < span else 1.0
    spare = 0.0 if room < span else room - span
    c = alpha / beta if alpha < _FARTHEST * beta else _FARTHEST
    ahead, aside = ((c - cy) * ty - cx * tx) / radius, ((c - cy) * tx + cx * ty) / radius
    ratio = math.sqrt(ahead * ahead + aside * aside)
    if abs(ratio - 1.0) * radius < _ON:
        ratio = 1.0 + _ON / radius
    middle = start + 0.5 * turn - math.atan2(ty, tx)
    middle -= 2.0 * math.pi * math.floor(middle / (2.0 * math.pi) + 0.5)
    low, high = 0.5 * middle - 0.25 * abs(turn), 0.5 * middle + 0.25 * abs(turn)
    low, high = max(math.sin(low) / size, -1.0), min(math.sin(high) / size, 1.0)
    if abs(turn) >= 2.0 * math.pi:
        low, high = -1.0, 1.0
    way = 1.0 if turn > 0.0 else -1.0
    turn, root = 0.5 * math.atan2(aside, ahead), 2.0 * size * math.sqrt(max(ratio, 1e-6))
    # no root is of the angle of a circle as the sine of its half is
    far = 1.0 / size if spare == 0.0 else math.sqrt(room / max(span, _ON))
    border = BorderPart(cx, cy, tx, ty, radius, size, math.sqrt(min(room, span)), spare)
    one, one_gap, two, two_gap = 0.0, math.inf, 0.0, math.inf
    if ratio > 1.0:
        tangent = math.sqrt((ratio - 1.0) * (ratio + 1.0))
        off = 0.5 * math.atan2(tangent, 1.0)
        one, one_gap = _grazed(alpha, beta, border, turn + off, c, tangent)
        two, two_gap = _grazed(alpha, beta, border, turn - off, c, tangent)
    across, apart = math.sin(turn) * (ratio + 1.0) / root, math.cos(turn) * (ratio - 1.0) / root
    seam = _inverse_sinh(math.sqrt(max((far - 1.0) * (far + 1.0), 0.0)))
    sums = _along(
        alpha, beta, border, low, high, across, apart, seam, one, one_gap, two, two_gap, law
    )
    return plus(NOTHING, way, sums)
