"""Sums of the slip direction over what a contour bounds of a base, under its pressure.

Of a base under uniform pressure the contour is all that counts.  A round one may be pressed by
another law, W over its area with a mean of 1; then what the contour takes along the rim and inside
it is had in ways of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_boundary import arc_sums, disc_at, line_sums
from puck_tables.kernels.base_friction import HEAD, PRESSURE, REACH, base_sums
from puck_tables.kernels.base_sums import (
    NOTHING,
    RING,
    UNIFORM,
    Sums,
    from_slip,
    plus,
    scaled,
)
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    BEGIN_X,
    BEGIN_Y,
    END_X,
    END_Y,
    PIECE_COLUMNS,
    RADIUS,
    START,
    TURN,
    polygon_sums,
)
from puck_tables.kernels.round_sums import pressed_arc, pressed_line, pressed_whole


class Slip(NamedTuple):
    """A slip: v and r ω over Q, ω without its sign, the direction of v, and −1 of a ω < 0."""

    along: float
    turning: float
    cosine: float
    sine: float
    mirrored: float


@inlined
def _slip_of(base: FloatArray, ux: float, uy: float, w: float) -> Slip:
    speed, rim = math.sqrt(ux * ux + uy * uy), base[REACH] * abs(w)
    unit = 1.0 / math.sqrt(speed * speed + rim * rim)
    c, s = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    return Slip(unit * speed, unit * rim, c, s, -1.0 if w < 0.0 else 1.0)


@inner
def look_at(base: FloatArray, ux: float, uy: float, w: float) -> None:
    """What all sums at a slip have in common, into the room of a base."""
    if base[PRESSURE] > RING:
        slip = _slip_of(base, ux, uy, w)
        pressed_whole(base, slip.along, slip.turning)


@inlined
def _arc_under(
    alpha: float, beta: float, cx: float, cy: float, radius: float, start: float, turn: float
) -> Sums:
    """Under uniform pressure: of more than half a circle all of it less the rest."""
    if abs(turn) <= math.pi:
        return arc_sums(alpha, beta, cx, cy, radius, start, turn, UNIFORM)
    way = 1.0 if turn > 0.0 else -1.0
    rest = 2.0 * math.pi * way - turn
    rest_sums = arc_sums(alpha, beta, cx, cy, radius, start + turn, rest, UNIFORM)
    sums = plus(NOTHING, way, disc_at(cx, cy, radius, alpha, 0.0, beta))
    return plus(sums, -1.0, rest_sums)


@inlined
def _under(base: FloatArray, room: FloatArray, at: int, slip: Slip) -> Sums:
    """Of a piece, in axes along the slip in which the spin is not negative, and radii."""
    law, unit, alpha, beta = int(base[PRESSURE]), 1.0 / base[REACH], slip.along, slip.turning
    c, s, mirrored = unit * slip.cosine, unit * slip.sine, slip.mirrored
    bx, by, ex, ey = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
    px, py = c * bx + s * by, mirrored * (c * by - s * bx)
    qx, qy = c * ex + s * ey, mirrored * (c * ey - s * ex)
    turn = mirrored * room[at + TURN]
    if turn == 0.0:
        if law == UNIFORM:
            return line_sums(alpha, beta, px, py, qx, qy)
        return NOTHING if law == RING else pressed_line(base, alpha, beta, px, py, qx, qy)
    ax, ay, own = room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS]
    cx, cy, radius = c * ax + s * ay, mirrored * (c * ay - s * ax), unit * own
    start = mirrored * (room[at + START] - math.atan2(s, c))
    if law == UNIFORM:
        return _arc_under(alpha, beta, cx, cy, radius, start, turn)
    on_rim = ax == 0.0 and ay == 0.0 and own == base[REACH]
    if law == RING:
        if not on_rim:
            return NOTHING
        return plus(NOTHING, 0.5, arc_sums(alpha, beta, 0.0, 0.0, 1.0, start, turn, RING))
    radius = 1.0 if on_rim else radius
    return pressed_arc(base, alpha, beta, cx, cy, radius, start, turn, px, py, qx, qy, on_rim)


@inner
def contour_sums(
    base: FloatArray, room: FloatArray, first: int, last: int, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    """Sums over what a contour bounds of a base, at a slip and a spin, not both 0."""
    straight = base[PRESSURE] == UNIFORM
    for at in range(first, last, PIECE_COLUMNS):
        straight = straight and room[at + TURN] == 0.0
    if straight:
        count = (last - first) // PIECE_COLUMNS
        return polygon_sums(room, first, count, base[REACH], ux, uy, w)
    slip, sums = _slip_of(base, ux, uy, w), NOTHING
    for at in range(first, last, PIECE_COLUMNS):
        sums = plus(sums, slip.mirrored, _under(base, room, at, slip))
    return from_slip(scaled(sums, base[REACH]), slip.cosine, slip.sine, slip.mirrored)


@inlined
def whole_sums(base: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """Sums over a base, at a slip and a spin, not both 0."""
    if base[PRESSURE] == UNIFORM:
        return base_sums(base, ux, uy, w)
    return contour_sums(base, base, HEAD, HEAD + PIECE_COLUMNS, ux, uy, w)
