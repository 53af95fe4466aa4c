"""Sums of the slip direction over parts of a round base, under any pressure that is round, too.

Over a part that no arc about the centre of the base enters by the centre of rotation C they are

    ∫ W e dA = −∮ W P ρ dρ

along its boundary (:mod:`puck_tables.kernels.round_paths`), of which the rim takes nothing.  Where
it crosses the ray from the centre through C, what lies under the circles through the ray up to
there is added: the whole base less ∫ W F ρ dρ beyond.

Arcs may begin next to C instead: that P differs by half of F, which leaves nothing between two
places of one ρ.  It does not jump on the ray, but on the circle through C, and away from C.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import ROWS
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.elementary import angle_of, log_of
from puck_tables.kernels.round_paths import (
    GAP,
    NEXT_TO_C,
    NONE,
    WHOLE,
    Path,
    between,
    find_kinks,
    room_of,
)

_FARTHEST = 20.0  # radii: a C farther away is as good as there
_BEYOND = 1.2  # of a distance: a path that is as far inside or outside of C's circle
_AT_RIM = 2e-15  # of 1 − ρ²: an end that is as close to the rim is on it
_CONCENTRIC = 1e-15  # radii: a circle about a point as close to the centre is one about that
_TOUCHES = 1e-30  # of ρ²: a patch that enters no farther, or by rounding less than not at all
_AT_ENDS = 1e-9  # rad: rounding says of what is closer to an end of an arc whether it is in
_NO_SEAM = 1e-8  # rad: a patch as close to the rim touches it


@inlined
def _inverse_sinh(x: float) -> float:
    """Of x ≥ 0."""
    return log_of(x + math.sqrt(1.0 + x * x))


@inlined
def _inverse_sine(x: float, y: float) -> tuple[float, float]:
    """The real part of asin(x + iy), and its imaginary part without its sign."""
    size = x * x + y * y - 1.0
    root = math.sqrt(size * size + 4.0 * y * y)
    if size > 0.0:
        square = 0.5 * (size + root)
        cosine = abs(y) / math.sqrt(square)
    else:
        square = 2.0 * y * y / (root - size) if y != 0.0 else 0.0
        cosine = math.sqrt(0.5 * (root - size))
    return angle_of(x / math.sqrt(1.0 + square), cosine), _inverse_sinh(math.sqrt(square))


@inlined
def _angle_whose_sine(x: float) -> float:
    """Of one beyond ±1 of ±1."""
    return angle_of(x, math.sqrt(max((1.0 - x) * (1.0 + x), 0.0)))


@inlined
def _is_on_rim(x: float, y: float) -> bool:
    return 1.0 - x * x - y * y < _AT_RIM


@inlined
def _beyond(base: FloatArray, alpha: float, beta: float, low: float) -> Sums:
    """What lies over the circles about the centre through the ray beyond a distance."""
    place, gap = _inverse_sine(alpha / beta if alpha < _FARTHEST * beta else _FARTHEST, 0.0)
    other = max(gap, GAP)
    path = Path(
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0,
        (place, -place, math.pi - place, 0.0, 0.0), (gap, other, other, NONE, NONE),
    )  # fmt: skip
    find_kinks(base, path)
    return between(base, alpha, beta, path, _angle_whose_sine(low), 0.5 * math.pi, 1.0)


@inner
def pressed_whole(base: FloatArray, alpha: float, beta: float) -> Sums:
    """The sums over a whole base, kept for those over its parts at the same slip."""
    sums, at = _beyond(base, alpha, beta, 0.0), room_of(base) + int(base[ROWS]) + WHOLE
    base[at], base[at + 1], base[at + 2], base[at + 3] = sums[0], sums[3], sums[4], sums[7]
    return sums


@inlined
def _below(base: FloatArray, alpha: float, beta: float, side: float, height: float) -> Sums:
    """What lies under the circles about the centre through the ray to C, up to a height > 0."""
    if height <= 0.0:
        return NOTHING
    at, sums = room_of(base) + int(base[ROWS]) + WHOLE, NOTHING
    if height < 1.0:
        sums = _beyond(base, alpha, beta, height)
    return (
        side * (base[at] - sums[0]), 0.0, 0.0, side * (base[at + 1] - sums[3]),
        side * (base[at + 2] - sums[4]), 0.0, 0.0, side * (base[at + 3] - sums[7]),
    )  # fmt: skip


@inner
def _along(
    base: FloatArray, alpha: float, beta: float, path: Path, low: float, high: float, one: float,
    two: float, before: float, after: float,
) -> Sums:  # fmt: skip
    """A border between two θ, that crosses the ray at ``one`` and ``two``.

    ``before``, ``after``: the side up to ``one`` and after that.
    """
    find_kinks(base, path)
    one, two = min(max(one, low), high), min(max(two, low), high)
    sums = between(base, alpha, beta, path, low, one, before)
    sums = plus(sums, 1.0, between(base, alpha, beta, path, one, two, after))
    return plus(sums, 1.0, between(base, alpha, beta, path, two, high, after))


@inlined
def _is_free(alpha: float, beta: float, path: Path) -> bool:
    """Whether a path is well inside or well outside the circle through C."""
    return beta * path.near > _BEYOND * alpha or alpha > _BEYOND * beta


@inner
def pressed_line(
    base: FloatArray, alpha: float, beta: float, px: float, py: float, qx: float, qy: float
) -> Sums:
    """A straight border from p to q, what is to its left, and beyond it on the ray through C."""
    dx, dy = qx - px, qy - py
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return NOTHING
    tx, ty = dx / length, dy / length
    off, begin = px * ty - py * tx, px * tx + py * ty
    room = max((1.0 - off) * (1.0 + off), 1e-300)
    half = math.sqrt(room)
    first, second = -1.0 if px < 0.0 else 1.0, -1.0 if qx < 0.0 else 1.0
    split, above = half, 0.0
    if first != second:
        share = -px / dx
        above = py + share * dy
        if above > 0.0:
            split = begin + share * length
        else:  # it passes below, and is above on one side at most
            first = first if py > qy else second
    c = alpha / beta if alpha < _FARTHEST * beta else _FARTHEST
    x, y, near = off * ty, -off * tx, abs(off)
    ahead, aside = (c - y) * ty - x * tx, (c - y) * tx + x * ty
    place, gap = _inverse_sine(ahead / half, aside / half)
    own = _inverse_sinh(near / half) if near > GAP else NONE
    path = Path(
        x, y, tx, ty, half, 0.0, 0.0, near, room, 0.0, (place, 0.0, 0.0, 0.0, 0.0),
        (gap, own, NONE, NONE, NONE),
    )  # fmt: skip
    # a piece of no length may have both ends on one side of the rim
    from_rim = _is_on_rim(px, py) and begin < 0.0
    to_rim = _is_on_rim(qx, qy) and begin + length > 0.0
    low = -0.5 * math.pi if from_rim else _angle_whose_sine(begin / half)
    high = 0.5 * math.pi if to_rim else _angle_whose_sine((begin + length) / half)
    if above > 0.0 and from_rim and to_rim and _is_free(alpha, beta, path):
        sums, first, split = _below(base, alpha, beta, first, 1.0), NEXT_TO_C, half
    else:
        sums = _below(base, alpha, beta, first, above)
    split = _angle_whose_sine(split / half)
    more = _along(base, alpha, beta, path, low, high, split, high, first, second)
    return plus(sums, 1.0, more)


@inlined
def _depth(angle: float, start: float, turn: float) -> float:
    """How far from the ends of an arc an angle is in it, or less than 0: outside."""
    whole, sign = 2.0 * math.pi, 1.0 if turn > 0.0 else -1.0
    past = sign * (angle - start)
    past -= whole * math.floor(past / whole)
    rest = abs(turn) - past
    return min(past, rest) if rest >= 0.0 else -min(-rest, whole - past)


@inlined
def _arc_path(alpha: float, beta: float, cx: float, cy: float, radius: float) -> Path:
    """The path of an arc about (cx, cy), not about the centre, where its ends are on the rim."""
    apart = math.sqrt(cx * cx + cy * cy)
    tx, ty = -cx / apart, -cy / apart
    room, span = (1.0 - apart + radius) * (1.0 + apart - radius), 4.0 * apart * radius
    room = max(room, _TOUCHES)
    size = math.sqrt(room / span) if span - room > _AT_RIM else 1.0
    spare = room - span if room - span > _AT_RIM else 0.0
    near, room = abs(apart - radius), min(room, span)
    c = alpha / beta if alpha < _FARTHEST * beta else _FARTHEST
    ahead, aside = ((c - cy) * ty - cx * tx) / radius, ((c - cy) * tx + cx * ty) / radius
    ratio = max(math.sqrt(ahead * ahead + aside * aside), 1e-6)
    turn, root = 0.5 * math.atan2(aside, ahead), 2.0 * size * math.sqrt(ratio)
    place, gap = _inverse_sine(
        math.sin(turn) * (ratio + 1.0) / root, math.cos(turn) * (ratio - 1.0) / root
    )
    own = _inverse_sinh(near / math.sqrt(room)) if near > GAP else NONE
    # no root is of the angle of a circle as the sine of its half is
    seam = _inverse_sinh(
        math.sqrt(spare / room if size == 1.0 else (1.0 - size) * (1.0 + size)) / size
    )
    seam = seam if seam > _NO_SEAM else NONE
    other = place - math.copysign(math.pi, place)
    other_gap = max(gap, GAP) if size == 1.0 else NONE
    return Path(
        cx + radius * tx, cy + radius * ty, -ty, tx, 2.0 * radius * size, size,
        2.0 * radius * size * size, near, room, spare,
        (place, 0.0, 0.5 * math.pi, -0.5 * math.pi, other), (gap, own, seam, seam, other_gap),
    )  # fmt: skip


@inner
def pressed_arc(
    base: FloatArray, alpha: float, beta: float, cx: float, cy: float, radius: float, start: float,
    turn: float, px: float, py: float, qx: float, qy: float, on_rim: bool,
) -> Sums:  # fmt: skip
    """An arc about (cx, cy) from an angle over a turn, from p to q, as a straight border."""
    sign = 1.0 if turn > 0.0 else -1.0
    apart = math.sqrt(cx * cx + cy * cy)
    tx, ty = (-cx / apart, -cy / apart) if apart > 0.0 else (1.0, 0.0)
    middle = start + 0.5 * turn - math.atan2(ty, tx)
    middle -= 2.0 * math.pi * math.floor(middle / (2.0 * math.pi) + 0.5)
    middle = 0.0 if abs(turn) >= 2.0 * math.pi else middle
    low, high = middle - 0.5 * abs(turn), middle + 0.5 * abs(turn)
    one, two, above, below = high, high, 0.0, 0.0  # where it crosses C's ray
    jumps = False  # where it crosses that away from C
    if abs(cx) < radius:
        root = math.sqrt((radius - cx) * (radius + cx))
        up, down = math.atan2(root, -cx), math.atan2(-root, -cx)
        up_in, down_in = _depth(up, start, turn), _depth(down, start, turn)
        if max(abs(up_in), abs(down_in)) < _AT_ENDS:  # an end counts as its neighbours have it
            left = cx + radius * math.cos(start + 0.5 * turn) < 0.0
            first = 1.0 if (px < 0.0) != left else 0.0
            last = 1.0 if (qx < 0.0) != left else 0.0
            up_in, down_in = (first, last) if py > qy else (last, first)
        elif (px < 0.0) == (qx < 0.0):  # as its neighbours have it
            up_in = down_in = up_in + down_in  # both or none
        else:
            up_in, down_in = up_in - down_in, down_in - up_in
        if up_in > 0.0 and cy + root > 0.0:
            above, one = cy + root, math.atan2(-cx * -ty + root * tx, -cx * tx + root * ty)
        if down_in > 0.0 and cy - root > 0.0:
            below, two = cy - root, math.atan2(-cx * -ty - root * tx, -cx * tx - root * ty)
        jumps = (up_in > 0.0 and above == 0.0) or (down_in > 0.0 and below == 0.0)
    if on_rim or apart < _CONCENTRIC:
        sums = _below(base, alpha, beta, sign, above)
        return plus(sums, 1.0, _below(base, alpha, beta, -sign, below))
    path = _arc_path(alpha, beta, cx, cy, radius)
    from_rim, to_rim = _is_on_rim(px, py), _is_on_rim(qx, qy)
    if turn < 0.0:
        from_rim, to_rim = to_rim, from_rim
    from_rim, to_rim = from_rim and low < 0.0, to_rim and high > 0.0
    closed, side = (from_rim and to_rim) or abs(turn) >= 2.0 * math.pi, 0.0
    if closed and not jumps and _is_free(alpha, beta, path):
        above, below = (1.0 if above > 0.0 else 0.0), (1.0 if below > 0.0 else 0.0)
        one, two, side = high, high, NEXT_TO_C
    sums = _below(base, alpha, beta, sign, above)
    sums = plus(sums, 1.0, _below(base, alpha, beta, -sign, below))
    low = -0.5 * math.pi if from_rim else _on_path(path, low)
    high = 0.5 * math.pi if to_rim else _on_path(path, high)
    one, two = _on_path(path, min(one, two)), _on_path(path, max(one, two))
    more = _along(base, alpha, beta, path, low, high, one, two, side, side)
    return plus(sums, sign, more)


@inlined
def _on_path(path: Path, angle: float) -> float:
    """The θ of an angle of an arc, from −π to π."""
    sine = math.sin(0.5 * min(max(angle, -math.pi), math.pi)) / path.bent
    return _angle_whose_sine(min(max(sine, -1.0), 1.0))
