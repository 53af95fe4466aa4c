"""What of a base lies beyond a line, in a circle or in a triangle: the contour of that part.

A contour is a set of straight pieces and arcs in no order, each with the part to its left, that
begin where others end.  To cut it, what lies outside is left out of every piece.  Where one comes
out or in, a piece of the cut itself is added, from there to one point of the cut or back; what
they have in common cancels.  So nothing has to be put in order, and whatever has a contour can be
cut again.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import DISCS, HEAD, SIDES
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.elementary import cosine_sine_of, direction_of
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    ANEW,
    BEGIN_X,
    BEGIN_Y,
    END_X,
    END_Y,
    LENGTH,
    PIECE_COLUMNS,
    RADIUS,
    START,
    TANGENT_X,
    TANGENT_Y,
    TURN,
)

_A_SIDE, _AN_ARC = 8, 32  # pieces that three cuts make of one at most
_A_FEW, _MORE = 16, 160  # pieces: room for more cuts of the parts of most bases, by corners
_WHOLE = 2.0 * math.pi  # rad: a whole turn
_ROUNDING = 1e-7  # rad: a cut that touches a circle is off by the root of what rounding is
_SLIVER = 1e-9  # of a circle: a base that has less of it, or all but that, is told by its middle

Angles = tuple[int, float, float, float, float]


def room_to_clip(base: FloatArray, lines: int, by_corners: bool) -> int:
    """How many numbers the contours of two parts of a base take where so many lines cut it.

    ``by_corners``: whether patches with corners cut them, too.
    """
    sides, discs = int(base[SIDES]), int(base[DISCS])
    # each may double the pieces, and adds three at most to a disc; there is room for three cuts
    more = 2 ** max(lines - 3, 0) if sides + discs > 1 else 1
    pieces = _A_SIDE * sides + _AN_ARC * discs + (_MORE if by_corners else _A_FEW)
    return 2 * PIECE_COLUMNS * pieces * more


@inlined
def whole_contour(base: FloatArray, first: int) -> tuple[int, int]:
    """Where the contour of a base begins and ends that begins at a place itself."""
    begin = first + HEAD
    return begin, begin + PIECE_COLUMNS * (int(base[SIDES]) + int(base[DISCS]))


@inlined
def _straight(
    room: FloatArray, end: int, px: float, py: float, qx: float, qy: float
) -> int:  # fmt: skip
    """Put a straight piece from p to q at a place; where the next goes."""
    tx, ty = qx - px, qy - py
    length = math.sqrt(tx * tx + ty * ty)
    if not length > 0.0:
        return end
    room[end + BEGIN_X], room[end + BEGIN_Y], room[end + END_X], room[end + END_Y] = px, py, qx, qy
    room[end + TANGENT_X], room[end + TANGENT_Y] = tx / length, ty / length
    room[end + LENGTH], room[end + ANEW], room[end + TURN] = length, 1.0, 0.0
    return end + PIECE_COLUMNS


@inlined
def _arc(
    room: FloatArray, end: int, cx: float, cy: float, radius: float, start: float, turn: float,
    px: float, py: float, qx: float, qy: float,
) -> int:  # fmt: skip
    """Put an arc from p to q at a place, clockwise where turn < 0; where the next goes."""
    if turn == 0.0:
        return end
    room[end + BEGIN_X], room[end + BEGIN_Y], room[end + END_X], room[end + END_Y] = px, py, qx, qy
    room[end + TURN], room[end + START], room[end + RADIUS] = turn, start, radius
    room[end + ABOUT_X], room[end + ABOUT_Y] = cx, cy
    return end + PIECE_COLUMNS


@inlined
def _past(angle: float) -> float:
    """An angle from 0 up to a whole turn."""
    return angle - _WHOLE * math.floor(angle / _WHOLE)


@inlined
def _at_an_end(angle: float, turn: float) -> float:
    """An angle from 0 up to a whole turn that rounding has taken off an arc, put back on it."""
    if angle <= turn:
        return angle
    return turn if angle - turn < _WHOLE - angle else 0.0


@inlined
def _rounded(angle: float, turn: float) -> float:
    """An angle, put back on an arc that it is off by no more than rounding takes it."""
    off = min(angle - turn, _WHOLE - angle)
    return _at_an_end(angle, turn) if off < _ROUNDING else angle


@inner
def _inside(
    room: FloatArray, at: int, begins: bool, ends: bool, middle: float, cosine: float
) -> Angles:
    """Which of an arc lies on that part of its circle about an angle whose half has a cosine.

    ``begins``, ``ends``: whether its ends do.  How many pieces, and the angles from its beginning
    where they begin and end, both ways counted from 0.
    """
    turn = abs(room[at + TURN])
    half = direction_of(math.sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)), cosine)
    off = room[at + START] - middle
    off = off if room[at + TURN] > 0.0 else -off
    out, back = _past(half - off), _past(-half - off)
    if turn == _WHOLE:  # it begins nowhere
        if abs(cosine) < 1.0:
            return 1, back - turn, back - turn + 2.0 * half, 0.0, 0.0
        return (1 if cosine < 0.0 else 0), 0.0, turn, 0.0, 0.0
    if begins and ends:
        out, back = _rounded(out, turn), _rounded(back, turn)
        if out < back and back <= turn and abs(cosine) < 1.0:
            return 2, 0.0, out, back, turn
        return 1, 0.0, turn, 0.0, 0.0
    if begins:
        return 1, 0.0, _at_an_end(out, turn), 0.0, 0.0
    if ends:
        return 1, _at_an_end(back, turn), turn, 0.0, 0.0
    out, back = _rounded(out, turn), _rounded(back, turn)
    if back < out and out <= turn and abs(cosine) < 1.0:
        return 1, back, out, 0.0, 0.0
    return 0, 0.0, 0.0, 0.0, 0.0


@inlined
def _point_of(room: FloatArray, at: int, angle: float) -> tuple[float, float]:
    """The point of an arc at an angle from its beginning; its ends to the bit."""
    turn = room[at + TURN]
    if angle == 0.0:
        return room[at + BEGIN_X], room[at + BEGIN_Y]
    if angle == abs(turn):
        return room[at + END_X], room[at + END_Y]
    there = room[at + START] + (angle if turn > 0.0 else -angle)
    c, s = cosine_sine_of(there)
    return room[at + ABOUT_X] + room[at + RADIUS] * c, room[at + ABOUT_Y] + room[at + RADIUS] * s


@inlined
def _part_of_arc(
    room: FloatArray, at: int, end: int, low: float, high: float
) -> tuple[int, float, float, float, float]:
    """Put a part of an arc at a place; where the next goes, and its two ends."""
    px, py = _point_of(room, at, low)
    qx, qy = _point_of(room, at, high)
    sign = 1.0 if room[at + TURN] > 0.0 else -1.0
    end = _arc(
        room, end, room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS],
        room[at + START] + sign * low, sign * (high - low), px, py, qx, qy,
    )  # fmt: skip
    return end, px, py, qx, qy


@inlined
def _part_of_circle(
    room: FloatArray, at: int, end: int, nx: float, ny: float, away: float
) -> tuple[int, float, float, float, float]:
    """Put what of a whole circle lies beyond a line so far from its middle at a place.

    Where the next goes, and its two ends, which do not wait for their angles.
    """
    mx, my, radius = room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS]
    sign = 1.0 if room[at + TURN] > 0.0 else -1.0
    half = sign * math.sqrt((radius - away) * (radius + away))
    fx, fy = mx + away * nx, my + away * ny
    px, py, qx, qy = fx + half * ny, fy - half * nx, fx - half * ny, fy + half * nx
    angle = direction_of(half, away)
    start = direction_of(ny, nx) - angle
    end = _arc(room, end, mx, my, radius, start, 2.0 * angle, px, py, qx, qy)
    return end, px, py, qx, qy


@inlined
def _first_met(fx: float, fy: float, x: float, y: float) -> tuple[float, float]:
    """The point of a cut from which all its pieces begin: that given, or the first that is met."""
    return (fx, fy) if fx < math.inf else (x, y)


@inner
def beyond_line(
    room: FloatArray, first: int, last: int, to: int, nx: float, ny: float, place: float,
    fx: float, fy: float,
) -> int:  # fmt: skip
    """Put what of a contour lies beyond the line n·x = place at a place; where it ends.

    ``fx``, ``fy``: from which point of the line its pieces begin; inf: from the first that is met.
    """
    end = to
    for at in range(first, last, PIECE_COLUMNS):
        px, py, qx, qy = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
        one, two = nx * px + ny * py - place, nx * qx + ny * qy - place
        begins, ends = one >= 0.0, two >= 0.0
        if room[at + TURN] == 0.0:
            if begins and ends:
                end = _straight(room, end, px, py, qx, qy)
            elif begins or ends:
                share = one / (one - two)
                x, y = px + share * (qx - px), py + share * (qy - py)
                fx, fy = _first_met(fx, fy, x, y)
                if begins:
                    end = _straight(room, end, px, py, x, y)
                    end = _straight(room, end, x, y, fx, fy)
                else:
                    end = _straight(room, end, fx, fy, x, y)
                    end = _straight(room, end, x, y, qx, qy)
            continue
        away = place - nx * room[at + ABOUT_X] - ny * room[at + ABOUT_Y]
        if abs(room[at + TURN]) == _WHOLE and abs(away) < room[at + RADIUS]:
            end, px, py, qx, qy = _part_of_circle(room, at, end, nx, ny, away)
            fx, fy = _first_met(fx, fy, px, py)
            end = _straight(room, end, fx, fy, px, py)
            end = _straight(room, end, qx, qy, fx, fy)
            continue
        pieces, low, high, again, until = _inside(
            room, at, begins, ends, direction_of(ny, nx), away / room[at + RADIUS]
        )
        for k in range(pieces):
            if k > 0:
                low, high = again, until
            end, px, py, qx, qy = _part_of_arc(room, at, end, low, high)
            if low != 0.0 or not begins:
                fx, fy = _first_met(fx, fy, px, py)
                end = _straight(room, end, fx, fy, px, py)
            if high != abs(room[at + TURN]) or not ends:
                fx, fy = _first_met(fx, fy, qx, qy)
                end = _straight(room, end, qx, qy, fx, fy)
    return end


@inlined
def _chord_in(
    px: float, py: float, qx: float, qy: float, radius: float, begins: bool, ends: bool
) -> tuple[float, float]:
    """The shares of a straight piece between which it lies in a circle about the origin."""
    dx, dy = qx - px, qy - py
    square = dx * dx + dy * dy
    along = -(px * dx + py * dy) / square
    across = px * dy - py * dx
    half = math.sqrt(max(radius * radius - across * across / square, 0.0) / square)
    low = 0.0 if begins else min(max(along - half, 0.0), 1.0)
    high = 1.0 if ends else min(max(along + half, 0.0), 1.0)
    return low, high


@inlined
def _round_to(
    room: FloatArray, end: int, mx: float, my: float, radius: float, ref: float, fx: float,
    fy: float, x: float, y: float, out: bool,
) -> tuple[int, float, float, float]:  # fmt: skip
    """Put an arc of a circle from (x, y) to f at an angle, or back, never by its far side.

    Where the next goes, and the angle and the place of f: of the first point that is met.
    """
    near = direction_of(-my, -mx)
    angle = near + _past(direction_of(y - my, x - mx) - near + math.pi) - math.pi
    if fx == math.inf:
        return end, angle, x, y
    if out:
        return _arc(room, end, mx, my, radius, angle, ref - angle, x, y, fx, fy), ref, fx, fy
    return _arc(room, end, mx, my, radius, ref, angle - ref, fx, fy, x, y), ref, fx, fy


@inner
def in_circle(
    room: FloatArray, first: int, last: int, to: int, mx: float, my: float, radius: float
) -> int:  # fmt: skip
    """Put what of a contour lies in a circle about m at a place; where it ends."""
    end, ref, fx, fy = to, 0.0, math.inf, math.inf
    for at in range(first, last, PIECE_COLUMNS):
        px, py, qx, qy = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
        ox, oy, ax, ay = px - mx, py - my, qx - mx, qy - my
        begins = ox * ox + oy * oy <= radius * radius
        ends = ax * ax + ay * ay <= radius * radius
        if room[at + TURN] == 0.0:
            low, high = _chord_in(ox, oy, ax, ay, radius, begins, ends)
            if low >= high:
                continue
            sx, sy = px + low * (qx - px), py + low * (qy - py)
            ex, ey = px + high * (qx - px), py + high * (qy - py)
            if begins:
                sx, sy = px, py
            else:
                end, ref, fx, fy = _round_to(
                    room, end, mx, my, radius, ref, fx, fy, sx, sy, False
                )  # fmt: skip
            if ends:
                ex, ey = qx, qy
            else:
                end, ref, fx, fy = _round_to(room, end, mx, my, radius, ref, fx, fy, ex, ey, True)
            end = _straight(room, end, sx, sy, ex, ey)
            continue
        dx, dy, own = mx - room[at + ABOUT_X], my - room[at + ABOUT_Y], room[at + RADIUS]
        apart = math.sqrt(dx * dx + dy * dy)
        cosine = (apart * apart + own * own - radius * radius) / (2.0 * max(apart, 1e-300) * own)
        pieces, low, high, again, until = _inside(
            room, at, begins, ends, direction_of(dy, dx), cosine
        )  # fmt: skip
        for k in range(pieces):
            if k > 0:
                low, high = again, until
            end, px, py, qx, qy = _part_of_arc(room, at, end, low, high)
            if low != 0.0 or not begins:
                end, ref, fx, fy = _round_to(
                    room, end, mx, my, radius, ref, fx, fy, px, py, False
                )  # fmt: skip
            if high != abs(room[at + TURN]) or not ends:
                end, ref, fx, fy = _round_to(room, end, mx, my, radius, ref, fx, fy, qx, qy, True)
    # ways that leave out its far side leave out the circle itself, where that is in the base
    whole = math.pi * radius * radius
    area = _area(room, to, end, mx, my)
    if area < -_SLIVER * whole or (area < _SLIVER * whole and _holds(room, first, last, mx, my)):
        end = _arc(room, end, mx, my, radius, 0.0, _WHOLE, mx, my, mx, my)
    return end


@inlined
def _area(room: FloatArray, first: int, last: int, mx: float, my: float) -> float:
    """The area that a contour bounds, ½ ∮ (x − m) × dx."""
    area = 0.0
    for at in range(first, last, PIECE_COLUMNS):
        turn = room[at + TURN]
        if turn == 0.0:
            px, py = room[at + BEGIN_X] - mx, room[at + BEGIN_Y] - my
            qx, qy = room[at + END_X] - mx, room[at + END_Y] - my
            area += 0.5 * (px * qy - py * qx)
        else:
            start, size = room[at + START], room[at + RADIUS]
            dx = size * (math.cos(start + turn) - math.cos(start))
            dy = size * (math.sin(start + turn) - math.sin(start))
            cx, cy = room[at + ABOUT_X] - mx, room[at + ABOUT_Y] - my
            area += 0.5 * (size * size * turn + cx * dy - cy * dx)
    return area


@inlined
def _holds(room: FloatArray, first: int, last: int, x: float, y: float) -> bool:
    """Whether a contour goes around a point: it passes upwards on its right, less downwards."""
    turns = 0
    for at in range(first, last, PIECE_COLUMNS):
        px, py, qx, qy = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
        begins, ends = py >= y, qy >= y
        if room[at + TURN] == 0.0:
            if begins != ends and px + (y - py) / (qy - py) * (qx - px) > x:
                turns += 1 if ends else -1
            continue
        away = (y - room[at + ABOUT_Y]) / room[at + RADIUS]
        pieces, low, high, again, until = _inside(room, at, begins, ends, 0.5 * math.pi, away)
        for k in range(pieces):
            if k > 0:
                low, high = again, until
            if (low != 0.0 or not begins) and _point_of(room, at, low)[0] > x:
                turns += 1
            if (high != abs(room[at + TURN]) or not ends) and _point_of(room, at, high)[0] > x:
                turns -= 1
    return turns > 0
