"""Sums of the slip direction over parts of a round base, under a tabulated pressure.

Of the whole base they are those of :mod:`puck_tables.kernels.cone_sums`, of a part what its borders
say (:mod:`puck_tables.kernels.profile_border`) and, where it holds a stretch of the ray from the
centre of the base through C, what lies under the circles about the centre through that stretch.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import HEAD, ROWS
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.cone_sums import pile_up, piled
from puck_tables.kernels.polygon_sums import PIECE_COLUMNS
from puck_tables.kernels.profile_border import Border, border_sums

# behind the contour of a base: the radii, and of the pieces of W = A + B ρ before and after each A
# and B, flat; then room to work, first for piles
_FIRST = HEAD + PIECE_COLUMNS


@inlined
def _room_of(base: FloatArray) -> int:
    return _FIRST + 3 * int(base[ROWS]) + 2


@inlined
def profile_piles(base: FloatArray, alpha: float, beta: float) -> None:
    """What all sums at a slip have in common."""
    room = _room_of(base)
    pile_up(base[_FIRST:room], base[room:], int(base[ROWS]), alpha, beta)


@inlined
def _below(base: FloatArray, alpha: float, beta: float, side: float, height: float) -> Sums:
    """What lies under the circles about the centre through the ray to C, up to a height."""
    room = _room_of(base)
    four = piled(
        base[_FIRST:room], base[room:], int(base[ROWS]), alpha, beta, min(height, 1.0)
    )  # fmt: skip
    return side * four[0], 0.0, 0.0, side * four[1], side * four[2], 0.0, 0.0, side * four[3]


@inlined
def _along(base: FloatArray, alpha: float, beta: float, border: Border) -> Sums:
    room, count = _room_of(base), int(base[ROWS])
    return border_sums(base[_FIRST:room], base[room + 8 * count :], count, alpha, beta, border)


@inner
def profile_line(
    base: FloatArray, alpha: float, beta: float, px: float, py: float, qx: float, qy: float
) -> Sums:
    """A straight border from p to q, what is to its left, and beyond it on the ray through C."""
    dx, dy = qx - px, qy - py
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return NOTHING
    tx, ty = dx / length, dy / length
    off, begin = px * ty - py * tx, px * tx + py * ty
    end, half = begin + length, math.sqrt(max((1.0 - off) * (1.0 + off), 0.0))
    low, high = max(begin, -half), min(end, half)
    first, second = -1.0 if px < 0.0 else 1.0, -1.0 if qx < 0.0 else 1.0
    sums, split, above = NOTHING, high, 0.0
    if first != second:
        share = -px / dx
        above = py + share * dy
        split = begin + share * length if above > 0.0 else high
        if above <= 0.0:  # it passes below, and is above on one side at most
            first = first if py > qy else second
    if above > 0.0:
        sums = _below(base, alpha, beta, first, above)
    if low < high:
        split = min(max(split, low), high)
        border = Border(off * ty, -off * tx, tx, ty, 0.0, low, high, split, high, first, second)
        sums = plus(sums, 1.0, _along(base, alpha, beta, border))
    return sums


@inlined
def _depth(angle: float, start: float, turn: float) -> float:
    """How far from the ends of an arc an angle is in it, or less than 0: outside."""
    whole, sign = 2.0 * math.pi, 1.0 if turn > 0.0 else -1.0
    past = sign * (angle - start)
    past -= whole * math.floor(past / whole)
    rest = abs(turn) - past
    return min(past, rest) if rest >= 0.0 else -min(-rest, whole - past)


@inner
def profile_arc(
    base: FloatArray, alpha: float, beta: float, cx: float, cy: float, radius: float, start: float,
    turn: float, from_left: bool, to_left: bool, on_rim: bool,
) -> Sums:  # fmt: skip
    """An arc about (cx, cy) from an angle over a turn, as that of a straight border.

    ``from_left``, ``to_left``: whether it begins and ends left of C, as its neighbours have it.
    """
    sums, sign = NOTHING, 1.0 if turn > 0.0 else -1.0
    apart = math.sqrt(cx * cx + cy * cy)
    tx, ty = (-cx / apart, -cy / apart) if apart > 0.0 else (1.0, 0.0)
    middle = start + 0.5 * turn - math.atan2(ty, tx)
    middle -= 2.0 * math.pi * math.floor(middle / (2.0 * math.pi) + 0.5)
    middle = 0.0 if abs(turn) >= 2.0 * math.pi else middle
    low, high = middle - 0.5 * abs(turn), middle + 0.5 * abs(turn)
    one, two = high, high  # where it crosses C's ray
    if abs(cx) < radius:
        root = math.sqrt((radius - cx) * (radius + cx))
        up, down = math.atan2(root, -cx), math.atan2(-root, -cx)
        up_in, down_in = _depth(up, start, turn), _depth(down, start, turn)
        if from_left == to_left:
            up_in = down_in = up_in + down_in  # both or none
        else:
            up_in, down_in = up_in - down_in, down_in - up_in
        if up_in > 0.0 and cy + root > 0.0:
            sums = plus(sums, 1.0, _below(base, alpha, beta, sign, cy + root))
            one = math.atan2(-cx * -ty + root * tx, -cx * tx + root * ty)
        if down_in > 0.0 and cy - root > 0.0:
            sums = plus(sums, 1.0, _below(base, alpha, beta, -sign, cy - root))
            two = math.atan2(-cx * -ty - root * tx, -cx * tx - root * ty)
    if on_rim or apart == 0.0:
        return sums
    one, two = min(max(min(one, two), low), high), min(max(one, two, low), high)
    border = Border(cx, cy, tx, ty, radius, low, high, one, two, 0.0, 0.0)
    return plus(sums, sign, _along(base, alpha, beta, border))
