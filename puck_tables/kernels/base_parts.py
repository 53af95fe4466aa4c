"""Sums of the slip direction over a disc, and over what of it lies beyond a line or in a circle.

Put together from the pieces of their boundary, see :mod:`puck_tables.kernels.base_boundary`.
"""

from __future__ import annotations

import math
from typing import Any

from puck_tables.contact import closed_form
from puck_tables.kernels.base_boundary import arc_sums, line_sums
from puck_tables.kernels.base_sums import NOTHING, RING, UNIFORM, Sums, plus
from puck_tables.kernels.closed_form_kernel import few_elliptic
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.load_parts import loaded_arc
from puck_tables.kernels.load_rim import loaded_rim, loaded_whole

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


@inner
def rim_sums(alpha: float, beta: float, size: float, start: float, turn: float, law: int) -> Sums:
    """An arc of a disc about the centre of the base; of a long one the rest, and the whole disc."""
    if law > RING:
        return loaded_rim(alpha, beta, start, turn, law)
    if law != UNIFORM or abs(turn) <= math.pi:
        return arc_sums(alpha, beta, 0.0, 0.0, size, start, turn, law, True)
    way = 1.0 if turn > 0.0 else -1.0
    rest = arc_sums(
        alpha, beta, 0.0, 0.0, size, start + turn, 2.0 * math.pi * way - turn, law, True
    )
    return plus(plus(NOTHING, way, disc_sums(alpha, beta, size)), -1.0, rest)


@inlined
def whole_sums(alpha: float, beta: float, size: float, law: int) -> Sums:
    """The whole base, or of a ring its rim."""
    if law > RING:
        return loaded_whole(alpha, beta, law)
    if law == UNIFORM:
        return disc_sums(alpha, beta, size)
    return rim_sums(alpha, beta, size, 0.0, 2.0 * math.pi, law)


@inner
def beyond_sums(
    alpha: float, beta: float, size: float, nx: float, ny: float, place: float, law: int
) -> Sums:
    """What of a disc, or of a ring on its rim, lies beyond the line n·x = place ≥ 0."""
    if place >= size:
        return NOTHING
    half = math.acos(place / size)
    end = math.sqrt((size - place) * (size + place))
    sums = rim_sums(alpha, beta, size, math.atan2(ny, nx) - half, 2.0 * half, law)
    if law == RING:
        return sums
    px, py = place * nx, place * ny
    chord = line_sums(
        alpha, beta, px - end * ny, py + end * nx, px + end * ny, py - end * nx, law
    )  # fmt: skip
    return plus(sums, 1.0, chord)


@inner
def common_sums(
    alpha: float, beta: float, size: float, cx: float, cy: float, radius: float, law: int
) -> Sums:
    """What of a disc, or of a ring on its rim, lies in a circle about (cx, cy)."""
    apart = math.sqrt(cx * cx + cy * cy)
    if apart >= size + radius:
        return NOTHING
    if apart + size <= radius:
        return whole_sums(alpha, beta, size, law)
    if apart + radius <= size:
        if law == RING:
            return NOTHING
        if law != UNIFORM:
            return loaded_arc(alpha, beta, cx, cy, radius, law)
        way = math.atan2(cy, cx)  # where it is next to the rim
        return arc_sums(alpha, beta, cx, cy, radius, way, 2.0 * math.pi, law, False)
    # half angles under which the two circles cut each other, by the half tangent
    short = (radius - apart + size) * (radius + apart - size)
    long = (apart + size + radius) * (apart + size - radius)
    own = 2.0 * math.atan2(math.sqrt(max(short, 0.0)), math.sqrt(max(long, 0.0)))
    way = math.atan2(cy, cx)
    sums = rim_sums(alpha, beta, size, way - own, 2.0 * own, law)
    if law == RING:
        return sums
    if law != UNIFORM:
        return plus(sums, 1.0, loaded_arc(alpha, beta, cx, cy, radius, law))
    short = (size - apart + radius) * (size + apart - radius)
    long = (apart + size + radius) * (apart - size + radius)
    other = 2.0 * math.atan2(math.sqrt(max(short, 0.0)), math.sqrt(max(long, 0.0)))
    back = arc_sums(alpha, beta, cx, cy, radius, way + math.pi - other, 2.0 * other, law, False)
    return plus(sums, 1.0, back)


@inlined
def turn_between(x: float, y: float, to_x: float, to_y: float) -> float:
    """The angle from one point to another as seen from the centre."""
    return math.atan2(x * to_y - y * to_x, x * to_x + y * to_y)


@inlined
def inside_disc(size: float, x: float, y: float, to_x: float, to_y: float) -> tuple[float, float]:
    """The shares of a straight piece between which it lies in a disc; low ≥ high: nowhere."""
    dx, dy = to_x - x, to_y - y
    square = dx * dx + dy * dy
    if square == 0.0:
        return 1.0, 0.0
    along = -(x * dx + y * dy) / square
    px, py = x + along * dx, y + along * dy
    room = size * size - (px * px + py * py)
    if room <= 0.0:
        return 1.0, 0.0
    half = math.sqrt(room / square)
    return max(along - half, 0.0), min(along + half, 1.0)
