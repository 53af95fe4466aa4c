"""Sums of friction by the slip speed along a contour that the instantaneous centre is far from.

There the sums from it (:mod:`puck_tables.kernels.law_sums`) cancel: the inner integral along a ray
runs from the distance of C to the contour, about the centre of mass.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner, summed
from puck_tables.kernels.elementary import cosine_sine_of
from puck_tables.kernels.elliptic_sums import Ellipse
from puck_tables.kernels.law_axes import against
from puck_tables.kernels.law_panels import (
    NODE,
    NODES,
    WEIGHT,
    Nearest,
    begin_of,
    far_point,
    points_far_off,
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

# of Gauss's rule along a ray:
# test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum
_RAY = 5
_NODE, _WEIGHT = np.polynomial.legendre.leggauss(_RAY)
_POWERS = DEGREE + 1  # coefficients of a moment on a piece


@inlined
def _along_ray(
    law: FloatArray, piece: int, speed: float, spin: float, deep: float
) -> tuple[float, float, float]:
    """∫ f u sᵏ ds for k = 0, 1, 2 from 0, in a piece, to ``deep``, with u = speed + spin s."""
    begin, last, out = min(deep, 0.0), max(deep, 0.0), 1.0 if deep > 0.0 else -1.0
    k0, k1, k2 = 0.0, 0.0, 0.0
    while piece > 1 and speed + spin * begin < law[piece]:
        piece -= 1
    while begin < last:
        low, high, end = law[piece], law[piece + 1], last
        if piece < int(law[0]) and high < speed + spin * last:
            end = max(min((high - speed) / spin, last), begin)
        first = 2 + int(law[0]) + (piece - 1) * MOMENTS * _POWERS
        half, scale, shift = 0.5 * (end - begin), 2.0 / (high - low), (low + high) / (high - low)
        for n in range(_RAY):
            s = begin + half * (1.0 + _NODE[n])
            u = speed + spin * s
            t, f = scale * u - shift, 0.0
            for power in range(_POWERS - 1, -1, -1):
                f = f * t + law[first + power]
            part = out * half * _WEIGHT[n] * f * u
            k0, k1, k2 = summed(k0, part), summed(k1, part * s), summed(k2, part * s * s)
        begin, piece = end, piece + 1
    return k0, k1, k2


@inlined
def _from_far(
    law: FloatArray, piece: int, axes: Ellipse, ux: float, uy: float, w: float, qx: float,
    qy: float, dx: float, dy: float,
) -> Sums:  # fmt: skip
    """What a point q of the contour adds, about the centre of mass; (dx, dy): dr there.

    ``piece``: of the law, in which the slip of the centre of mass lies.
    """
    speed, spin, sign = math.sqrt(ux * ux + uy * uy), abs(w), -1.0 if w < 0.0 else 1.0
    vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
    k0, k1, k2 = _along_ray(law, piece, speed, spin, deep)
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
def on_far_panel(
    law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float, place: Nearest, begin: float,
    half: float, side: float, arc: bool,
) -> Sums:  # fmt: skip
    """A panel of 2 ``half`` of a piece of the contour, on its ``side`` of where it is nearest."""
    sums, piece = NOTHING, begin_of(law, math.sqrt(ux * ux + uy * uy))
    for n in range(NODES):
        at, weight = begin + half * (1.0 + NODE[n]), half * WEIGHT[n]
        c, s = place.x, place.y
        if arc:
            turn, weight = side * at, weight * place.size
            c, s = (
                c * math.cos(turn) - s * math.sin(turn), s * math.cos(turn) + c * math.sin(turn)
            )  # fmt: skip
            qx, qy = place.from_x + place.size * c, place.from_y + place.size * s
        else:
            along = side * abs(place.off) * math.sinh(at) - place.begin
            weight *= abs(place.off) * math.cosh(at)
            qx, qy = place.from_x - along * s, place.from_y + along * c
        part = _from_far(law, piece, axes, ux, uy, w, qx, qy, -weight * s, weight * c)
        sums = plus(sums, 1.0, part)
    return sums


@inner
def far_sums(
    room: FloatArray, first: int, last: int, law: FloatArray, axes: Ellipse, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    """Over what a contour bounds, where friction bends nowhere under the base."""
    sums, piece = NOTHING, begin_of(law, math.sqrt(ux * ux + uy * uy))
    for i in range(first, last, PIECE_COLUMNS):
        turn = room[i + TURN]
        for k in range(points_far_off(turn)):
            share, weight = far_point(turn, k)
            if turn == 0.0:
                dx, dy = (
                    room[i + LENGTH] * room[i + TANGENT_X],
                    room[i + LENGTH] * room[i + TANGENT_Y],
                )
                qx, qy = room[i + BEGIN_X] + share * dx, room[i + BEGIN_Y] + share * dy
            else:
                c, s = cosine_sine_of(room[i + START] + share * turn)
                cx, cy = room[i + RADIUS] * c, room[i + RADIUS] * s
                qx, qy = room[i + ABOUT_X] + cx, room[i + ABOUT_Y] + cy
                dx, dy = -turn * cy, turn * cx
            part = _from_far(law, piece, axes, ux, uy, w, qx, qy, dx, dy)
            sums = plus(sums, weight, part)
    return sums
