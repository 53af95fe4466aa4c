"""Sums of the slip direction over what a contour bounds of a base, under its pressure.

Of a base under uniform pressure the contour is all that counts.  A round one may be pressed by
another law, W over its area with a mean of 1; then what the contour takes along the rim and inside
it is had in ways of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_boundary import disc_at
from puck_tables.kernels.base_friction import HEAD, PRESSURE, REACH, base_sums
from puck_tables.kernels.base_sums import NOTHING, RING, UNIFORM, Sums, from_slip, plus, scaled
from puck_tables.kernels.circle_arcs import along_arc, slips_under
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
    piece_sums,
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
def _under(base: FloatArray, room: FloatArray, at: int, slip: Slip) -> Sums:
    """Of a piece, in axes along the slip in which the spin is not negative, and radii."""
    unit, alpha, beta = 1.0 / base[REACH], slip.along, slip.turning
    c, s, mirrored = unit * slip.cosine, unit * slip.sine, slip.mirrored
    bx, by, ex, ey = room[at + BEGIN_X], room[at + BEGIN_Y], room[at + END_X], room[at + END_Y]
    px, py = c * bx + s * by, mirrored * (c * by - s * bx)
    qx, qy = c * ex + s * ey, mirrored * (c * ey - s * ex)
    turn = mirrored * room[at + TURN]
    ring = base[PRESSURE] == RING
    if turn == 0.0:
        return NOTHING if ring else pressed_line(base, alpha, beta, px, py, qx, qy)
    ax, ay, own = room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS]
    on_rim = ax == 0.0 and ay == 0.0 and own == base[REACH]
    if ring:
        return _on_ring(alpha, beta, px, py, qx, qy, turn) if on_rim else NOTHING
    cx, cy, radius = c * ax + s * ay, mirrored * (c * ay - s * ax), unit * own
    start = mirrored * (room[at + START] - math.atan2(s, c))
    radius = 1.0 if on_rim else radius
    return pressed_arc(base, alpha, beta, cx, cy, radius, start, turn, px, py, qx, qy, on_rim)


@inlined
def _on_ring(
    alpha: float, beta: float, px: float, py: float, qx: float, qy: float, turn: float
) -> Sums:
    """Of an arc of the rim itself, by the angle from opposite to C, which is along −y."""
    if turn < 0.0:
        px, py, qx, qy = qx, qy, px, py
    long = max(alpha, beta)
    a, b = alpha / long, beta / long
    arc = along_arc(min(a, b), abs(alpha - beta) / long, -py, px, -qy, qx, abs(turn))
    whole, first, second, aside, both = slips_under(arc)
    half = math.copysign(0.5, turn)  # of the mean pressure
    return (
        half * (a * whole + b * first), half * b * aside, half * (a * aside + b * both),
        -half * (a * first + b * second), half * b * (whole - second), -half * b * both,
        half * (b * aside + a * both), -half * (b * first + a * second),
    )  # fmt: skip


@inner
def contour_sums(
    base: FloatArray, room: FloatArray, first: int, last: int, ux: float, uy: float, w: float
) -> Sums:  # fmt: skip
    """Sums over what a contour bounds of a base, at a slip and a spin, not both 0."""
    if base[PRESSURE] == UNIFORM:
        count = (last - first) // PIECE_COLUMNS
        sums = piece_sums(room, first, count, base[REACH], ux, uy, w)
        for at in range(first, last, PIECE_COLUMNS):
            if abs(room[at + TURN]) == 2.0 * math.pi:
                x, y, radius = room[at + ABOUT_X], room[at + ABOUT_Y], room[at + RADIUS]
                sense = math.copysign(1.0, room[at + TURN])
                sums = plus(sums, sense, disc_at(x, y, radius, ux, uy, w))
        return sums
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
