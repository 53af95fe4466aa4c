"""Sums of friction over a base that is rougher one way than the other, along its contour.

The local friction T is that of the largest dissipation within an ellipse (Michałowski, Mróz 1978;
Goyal, Ruina, Papadopoulos 1991): of an element that slips at u, in the axes of the ellipse and over
the load, σ T is against it,

    T = A² u/|A u|,   A = diag(f_x, f_y).

With the spin ω and (x, y) from the instantaneous centre u = ω (−y, x), so that A u = ω (−y', x')
with x' = f_y x, y' = f_x y: T is A times the slip direction e' of a base that is stretched so, and

    ∫ T dA = A ∫ e' dA' / (f_x f_y),

along its contour as everywhere (:mod:`puck_tables.kernels.base_boundary`).  Circles become
ellipses; there Gauss's rule on panels that shrink to where A u vanishes, of complex angles, too.

Over a whole disc friction is summed along the chords through the instantaneous centre, on which T
is the same.  With θ from the direction to the middle of the disc, p = s sin θ
the distance of a chord (s = v/(r|ω|)), L = √(1 − p²) its half and D = s cos θ, in units of r,

    ∫ dA → 2LD dθ,   ∫ ρ dA → ⅔L³ dθ,   ∫ ρ² dA → ⅔L³D dθ    (ρ along the chord from its middle)

whether the centre lies in the disc or not.  For s > 1 sin q = s sin θ clears the ends.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_boundary import line_sums, sums_at
from puck_tables.kernels.base_sums import NOTHING, Sums, from_slip, moved, plus, scaled
from puck_tables.kernels.compile import inlined, inner, patience
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
)

# of Gauss's rule a panel, to 2e-12: test_resultants_are_those_of_a_grid_over_the_base
_COUNT = 14
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
# of a panel, over its distance from what is nearly singular; sums err by 7e-14, at 8 by 7e-11
_GROWTH = 2.0
_CLOSEST = 1e-9  # nearer than this nothing is singular that could be seen
_LONGEST = 1.0  # rad, of a panel
_LEAST = 1e-300  # what is less is nothing: of it a logarithm is taken
_WHOLE = 2.0 * math.pi  # rad: a whole turn


class Ellipse(NamedTuple):
    """Friction by an ellipse: f along its first axis, which is turned by an angle, and across."""

    along: float
    across: float
    cosine: float
    sine: float


@inlined
def local_friction(law: Ellipse, ex: float, ey: float) -> tuple[float, float]:
    """What keeps an element of the load 1 slipping along (ex, ey), in the axes of the ellipse."""
    size = math.hypot(law.along * ex, law.across * ey)
    return law.along * law.along * ex / size, law.across * law.across * ey / size


@inlined
def _sharpness(law: Ellipse) -> tuple[float, float, float]:
    """The axis of less friction, and the angle of slip beside it at which the root vanishes."""
    least, most = min(law.along, law.across), max(law.along, law.across)
    sharp = math.atanh(least / most) if least < most else 10.0
    if law.along < law.across:
        return law.cosine, law.sine, sharp
    return -law.sine, law.cosine, sharp


@inlined
def end_of_panel(start: float, last: float, place: float, near: float, growth: float) -> float:
    """How far a panel may go that begins beside what is singular at the distance ``near``.

    ``growth``: how long it may be, over how far that is.
    """
    away = start - place
    if away >= 0.0:
        return min(last, start + max(near, growth * away))
    if -away <= near:
        return min(last, place)
    return min(last, start - growth / (1.0 + growth) * away)


@inner
def disc_sums(law: Ellipse, vx: float, vy: float, rim: float) -> Sums:
    """Over a disc of radius 1, by the axes of the ellipse, at a velocity in them and a rim speed.

    ``rim``: r ω; not all three are zero.
    """
    speed, fast = math.sqrt(vx * vx + vy * vy), abs(rim)
    if rim == 0.0:
        fx, fy = local_friction(law, vx / speed, vy / speed)
        quarter = 0.25 * math.pi
        return math.pi * fx, math.pi * fy, 0.0, 0.0, 0.0, 0.0, quarter * fy, -quarter * fx
    sense = 1.0 if rim > 0.0 else -1.0
    # from the instantaneous centre to the middle of the disc
    ox, oy = (sense * vy / speed, -sense * vx / speed) if speed > 0.0 else (1.0, 0.0)
    inside = speed <= fast
    ratio = speed / fast if inside else fast / speed
    gap = (1.0 - ratio) * (1.0 + ratio)
    branch = math.sqrt(gap) / max(ratio, 0.1)
    # where the slip is along the axis of less friction, and how far the zero of the root lies
    ax, ay, sharp = _sharpness(Ellipse(law.along, law.across, 1.0, 0.0))
    ax, ay = -ay, ax
    sine, cosine = ax * oy - ay * ox, ax * ox + ay * oy
    place = -math.atan(sine / cosine) if cosine != 0.0 else 0.5 * math.pi
    if not inside:
        turn = math.cos(place) / ratio
        folded = math.sin(place) / ratio
        folded = min(max(folded, -1.0), 1.0)
        place = math.asin(folded)
        sharp *= turn / max(math.sqrt(1.0 - folded * folded), math.sqrt(sharp * turn))
    branch, sharp = max(branch, _CLOSEST), max(sharp, _CLOSEST)
    sums = NOTHING
    start, last = -0.5 * math.pi, 0.5 * math.pi
    while start < last:
        patience(1)
        end = end_of_panel(start, last, -0.5 * math.pi, branch, _GROWTH)
        end = end_of_panel(start, end, 0.5 * math.pi, branch, _GROWTH)
        end = end_of_panel(start, end, place, sharp, _GROWTH)
        end = min(end_of_panel(start, end, place + math.pi, sharp, _GROWTH), start + 1.0)
        end = end_of_panel(start, end, place - math.pi, sharp, _GROWTH)
        half, middle = 0.5 * (end - start), 0.5 * (end + start)
        start = end
        for i in range(len(_NODES)):
            q = middle + half * _NODES[i]
            sin_q, cos_q = math.sin(q), math.cos(q)
            if inside:
                sin_t, cos_t, off = sin_q, cos_q, ratio * sin_q
                chord = math.sqrt(gap + (ratio * cos_q) ** 2)
                area = 2.0 * chord * ratio * cos_t
                first = 2.0 / 3.0 * chord * chord * chord
                second = first * ratio * cos_t
            else:
                sin_t, off = ratio * sin_q, sin_q
                cos_t = math.sqrt(gap + (ratio * cos_q) ** 2)
                area = 2.0 * cos_q * cos_q
                second = area * cos_q * cos_q / 3.0
                first = second * ratio / cos_t
            nx, ny = cos_t * ox - sin_t * oy, cos_t * oy + sin_t * ox
            tx, ty = local_friction(law, -sense * ny, sense * nx)
            # torque of friction about the middle of the chord, and along it
            arm, along = -(nx * tx + ny * ty), nx * ty - ny * tx
            px, py = nx * first - off * ny * area, ny * first + off * nx * area
            turning = off * first
            here = (
                tx * area, ty * area, tx * px, tx * py, ty * px, ty * py,
                nx * (off * arm * first) - ny * (off * off * arm * area)
                + nx * along * second - ny * turning * along,
                ny * (off * arm * first) + nx * (off * off * arm * area)
                + ny * along * second + nx * turning * along,
            )  # fmt: skip
            sums = plus(sums, half * _WEIGHTS[i], here)
    return sums


class Stretched(NamedTuple):
    """A base in axes along A u of its origin, stretched as friction is, with lengths in its reach.

    ``along``, ``turning``: |A u| there and the spin, over the root of the sum of their squares;
    ``xx`` … ``yy``: what makes a place of the base one of it.
    """

    along: float
    turning: float
    xx: float
    xy: float
    yx: float
    yy: float


@inlined
def singular_angles(one: Stretched, x: float, y: float, size: float) -> tuple[
    float, float, float, float
]:  # fmt: skip
    """Of a circle of which (x, y) is the stretched middle: at which angles A u vanishes.

    Two complex ones, in z of the unit circle roots of p z² + g z + n = 0: each by its angle and how
    far it is off the circle.
    """
    half = 0.5 * one.turning * size
    px, py = half * (one.xx + one.yy), half * (one.yx - one.xy)
    nx, ny = half * (one.xx - one.yy), half * (one.yx + one.xy)
    gx, gy = one.turning * x, one.turning * y - one.along
    sx, sy = (
        gx * gx - gy * gy - 4.0 * (px * nx - py * ny),
        2.0 * (gx * gy - 2.0 * (px * ny + py * nx)),
    )
    root = math.sqrt(math.sqrt(sx * sx + sy * sy))
    turn = 0.5 * math.atan2(sy, sx)
    rx, ry = root * math.cos(turn), root * math.sin(turn)
    side = 1.0 if rx * gx + ry * gy >= 0.0 else -1.0
    hx, hy = -0.5 * (gx + side * rx), -0.5 * (gy + side * ry)
    whole, p, n = math.hypot(hx, hy), math.hypot(px, py), math.hypot(nx, ny)
    level = math.log(max(whole, math.sqrt(_LEAST)))
    return (
        math.atan2(hy, hx) - math.atan2(py, px), abs(level - math.log(max(p, _LEAST))),
        math.atan2(ny, nx) - math.atan2(hy, hx), abs(level - math.log(max(n, _LEAST))),
    )  # fmt: skip


@inlined
def panel_to(start: float, last: float, place: float, near: float, growth: float) -> float:
    """How far a panel of a circle may go beside what is singular at an angle of it."""
    turns = _WHOLE * math.floor((start - place) / _WHOLE)
    end = end_of_panel(start, last, place + turns, near, growth)
    return end_of_panel(start, end, place + turns + _WHOLE, near, growth)


@inner
def _along_arc(one: Stretched, row: FloatArray) -> Sums:
    """An arc of a contour, stretched: of an ellipse."""
    mx = one.xx * row[ABOUT_X] + one.xy * row[ABOUT_Y]
    my = one.yx * row[ABOUT_X] + one.yy * row[ABOUT_Y]
    first, near, second, close = singular_angles(one, mx, my, row[RADIUS])
    near, close = max(near, _CLOSEST), max(close, _CLOSEST)
    size, turn, sums = row[RADIUS], row[TURN], NOTHING
    start = row[START] if turn > 0.0 else row[START] + turn
    last = start + abs(turn)
    while start < last:
        patience(1)
        end = panel_to(start, min(last, start + _LONGEST), first, near, _GROWTH)
        end = panel_to(start, end, second, close, _GROWTH)
        half, middle = 0.5 * (end - start), 0.5 * (end + start)
        start = end
        for n in range(len(_NODES)):
            angle = middle + half * _NODES[n]
            c, s = size * math.cos(angle), size * math.sin(angle)
            here = sums_at(
                one.along, one.turning, mx + one.xx * c + one.xy * s, my + one.yx * c + one.yy * s,
                one.xy * c - one.xx * s, one.yy * c - one.yx * s,
            )  # fmt: skip
            sums = plus(sums, half * _WEIGHTS[n], here)
    return plus(NOTHING, 1.0 if turn > 0.0 else -1.0, sums)


@inlined
def _disc(law: Ellipse, row: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """A whole disc, or a hole, by its chords."""
    x, y, size, c, s = row[ABOUT_X], row[ABOUT_Y], row[RADIUS], law.cosine, law.sine
    vx, vy = ux - w * y, uy + w * x
    sums = disc_sums(law, c * vx + s * vy, c * vy - s * vx, size * w)
    sums = moved(scaled(from_slip(sums, c, s, 1.0), size), x, y)
    return plus(NOTHING, 1.0 if row[TURN] > 0.0 else -1.0, sums)


@inner
def elliptic_sums(
    room: FloatArray, first: int, last: int, reach: float, law: Ellipse, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    """Sums of T over what a contour bounds of a base, in its axes; not at rest.

    ``first``, ``last``: where its rows begin and end in ``room``; ``reach``: of the base, m.
    """
    most = max(law.along, law.across)
    p, q, c, s = law.along / most, law.across / most, law.cosine, law.sine
    vx, vy, rim = p * (c * ux + s * uy), q * (c * uy - s * ux), reach * abs(w)
    speed = math.sqrt(vx * vx + vy * vy)
    unit, sense = 1.0 / math.sqrt(speed * speed + rim * rim), -1.0 if w < 0.0 else 1.0
    ex, ey = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    x, y = q / reach, p / reach
    one = Stretched(
        unit * speed, unit * rim, ex * x * c - ey * y * s, ex * x * s + ey * y * c,
        sense * (-ey * x * c - ex * y * s), sense * (ex * y * c - ey * x * s),
    )  # fmt: skip
    sums, discs = NOTHING, NOTHING
    for at in range(first, last, PIECE_COLUMNS):
        row = room[at : at + PIECE_COLUMNS]
        if abs(row[TURN]) == _WHOLE:
            discs = plus(discs, 1.0, _disc(law, row, ux, uy, w))
        elif row[TURN] != 0.0:
            sums = plus(sums, sense, _along_arc(one, row))
        else:
            px, py, qx, qy = row[BEGIN_X], row[BEGIN_Y], row[END_X], row[END_Y]
            part = line_sums(
                one.along, one.turning, one.xx * px + one.xy * py, one.yx * px + one.yy * py,
                one.xx * qx + one.xy * qy, one.yx * qx + one.yy * qy,
            )  # fmt: skip
            sums = plus(sums, sense, part)
    fx, fy, xx, xy, yx, yy, gx, gy = from_slip(sums, ex, ey, sense)
    area = reach * reach / (p * q)
    third, fourth = area * reach * most, area * reach * reach * most
    sums = (
        area * law.along * fx, area * law.across * fy, third * p / q * xx, third * xy, third * yx,
        third * q / p * yy, fourth / q * gx, fourth / p * gy,
    )  # fmt: skip
    return plus(discs, 1.0, from_slip(sums, c, s, 1.0))
