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

A piece is summed from its point nearest to C, both ways at once as far as it goes both ways: R and
r × dr are alike there.  On a straight side at the distance d from C, r × dr = d ds, and with
y = asinh(s/|d|) the integrands are entire but for the law and 1/|A e|: Gauss's rule on panels of y.
On an arc panels of its angle shrink to C.  None goes across two pieces of the law
(:mod:`puck_tables.kernels.law_panels`), so that all nodes of one are had at once.  Where C lies far
away these cancel: :mod:`puck_tables.kernels.law_far_sums`.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import NOTHING, Sums, from_slip, moved, plus
from puck_tables.kernels.compile import arrays_at_first, inlined, inner, kernel, summed
from puck_tables.kernels.elementary import cosine_sine_of, exp_of
from puck_tables.kernels.elliptic_sums import Ellipse
from puck_tables.kernels.law_axes import PLAIN, Square, by_axes, square_about
from puck_tables.kernels.law_far_sums import far_sums, on_far_panel
from puck_tables.kernels.law_panels import (
    FAR,
    NODE,
    NODES,
    WEIGHT,
    Nearest,
    begin_of,
    branches_of,
    distance_at,
    interval_of,
    is_smooth_between,
    law_sums_at_first,
    nearest_to,
    panel_end,
)
from puck_tables.kernels.polygon_sums import PIECE_COLUMNS, TURN

_POWERS = DEGREE + 1  # coefficients of a moment on a piece
_FAR_OF_AXES = 2.5  # times the reach, over the ratio of the axes: a rule goes across the base


@inlined
def coefficient_at_rest(law: FloatArray) -> float:
    """F at slip zero."""
    first, f = 2 + int(law[0]), 0.0
    for power in range(_POWERS - 1, -1, -1):
        f = law[first + power] - f
    return f


@inlined
def _on_panel(
    law: FloatArray, spin: float, piece: int, begin: float, half: float, place: Nearest,
    even: float, odd: float, square: Square, arc: bool, directed: bool,
) -> Sums:  # fmt: skip
    """Sums over a panel of 2 ``half``, about C in axes from it to where it is nearest, and across.

    ``even``, ``odd``: the weights of both ways and their difference; ``arc``, ``directed``:
    constants.
    """
    first = 2 + int(law[0]) + (piece - 1) * MOMENTS * _POWERS + _POWERS
    low, high = law[piece], law[piece + 1]
    scale, shift = 2.0 * spin / (high - low), (low + high) / (high - low)
    off, size = place.off, place.size
    gap, away, spread = size - off, 0.5 * abs(off), 2.0 * off * size
    a, b, c, d, e, f, g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(NODES):
        at = begin + half * (1.0 + NODE[n])
        if arc:
            cosine, sine = cosine_sine_of(0.5 * at)
            rise = 2.0 * sine * sine
            x, y = gap - size * rise, 2.0 * size * sine * cosine
            distance = math.sqrt(gap * gap + spread * rise)
            area = half * WEIGHT[n] * size * (gap + off * rise) / distance
        else:
            up = exp_of(at)
            down = 1.0 / up
            x, y, distance = off, away * (up - down), away * (up + down)
            area = half * WEIGHT[n] * off
        t = scale * distance - shift
        h1, h2, h3 = 0.0, 0.0, 0.0
        for power in range(_POWERS - 1, -1, -1):
            h1 = h1 * t + law[first + power]
            h2 = h2 * t + law[first + _POWERS + power]
            h3 = h3 * t + law[first + 2 * _POWERS + power]
        h1, h2, h3 = area * h1, area * h2, area * distance * distance * h3
        if directed:
            whole = math.sqrt(x * (x * square.xx + y * square.xy) + y * y * square.yy) / distance
            h1, h2, h3 = h1 / whole, h2 / whole, h3 * whole
        a, b, f, g = summed(a, h1 * y), summed(b, h1 * x), summed(f, h3 * x), summed(g, h3 * y)
        h2x, h2y = h2 * x, h2 * y
        c, d, e = summed(c, h2x * y), summed(d, h2x * x), summed(e, h2y * y)
    return -odd * a, even * b, -odd * c, -even * e, even * d, odd * c, even * f, odd * g


@inlined
def _along(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, place: Nearest, arc: bool,
    far: bool,
) -> Sums:  # fmt: skip
    """A piece of the contour, about C; ``far``, a constant as ``arc``: about the centre of mass."""
    spin, sums, directed = abs(w), NOTHING, axes.along != axes.across
    for sense in range(2 if directed or far else 1):
        side = 1.0 - 2.0 * sense
        branches = branches_of(place, axes, side, arc)
        for k in range(3 if arc else 2):
            begin, last, ahead, back = interval_of(k, place, arc)
            if directed or far:
                ahead, back = (ahead, 0.0) if sense == 0 else (0.0, back)
            if not begin < last or ahead + back == 0.0:
                continue
            even, odd = ahead + back, ahead - back
            piece = begin_of(law, spin * distance_at(place, begin, arc))
            while begin < last:
                end, after = panel_end(law, spin, place, piece, begin, last, branches, arc)
                half = 0.5 * (end - begin)
                if far:
                    part = on_far_panel(law, axes, ux, uy, w, place, begin, half, side, arc)
                elif directed:
                    square = square_about(axes, place.x, place.y, side)
                    part = _on_panel(
                        law, spin, piece, begin, half, place, even, odd, square, arc, True
                    )
                else:
                    part = _on_panel(
                        law, spin, piece, begin, half, place, even, odd, PLAIN, arc, False
                    )
                sums = plus(sums, 1.0, part)
                begin, piece = end, after
    return sums if far else by_axes(axes, from_slip(sums, place.x, place.y, 1.0))


@inner
def _along_piece(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, place: Nearest, arc: bool,
    far: bool,
) -> Sums:  # fmt: skip
    if far and arc:
        return _along(law, axes, ux, uy, w, place, True, True)
    if far:
        return _along(law, axes, ux, uy, w, place, False, True)
    if arc:
        return _along(law, axes, ux, uy, w, place, True, False)
    return _along(law, axes, ux, uy, w, place, False, False)


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
    return turns or not is_smooth_between(law, speed - rim, speed + rim)


@inlined
def _as_written(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, axes: Ellipse,
    ux: float, uy: float, w: float, far: bool,
) -> Sums:  # fmt: skip
    """The sums; ``far``: C is far away, and friction bends between the slips under the base."""
    if not far and math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w):
        return far_sums(room, first, last, law, axes, ux, uy, w)
    sums, cx, cy = NOTHING, -uy / w, ux / w
    for i in range(first, last, PIECE_COLUMNS):
        turn, place = room[i + TURN], nearest_to(room, i, cx, cy, reach)
        part = _along_piece(law, axes, ux, uy, w, place, turn != 0.0, far)
        sums = plus(sums, 1.0 if turn >= 0.0 else -1.0, part)
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
