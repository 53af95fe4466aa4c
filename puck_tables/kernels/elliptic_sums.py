"""Sums of friction over a base that is rougher one way than the other, along its contour.

The local friction T is that of the largest dissipation within an ellipse (Michałowski, Mróz 1978;
Goyal, Ruina, Papadopoulos 1991): of an element that slips in the direction e, in the axes of the
ellipse and over the load, σ T is against it,

    T = (f_x² e_x, f_y² e_y)/√(f_x² e_x² + f_y² e_y²).

All along a ray from the instantaneous centre C the slip is in one direction, so that T stands
before the integral along the ray.  With (R, t) polar coordinates about C and r from there,

    ∫ T dA = ½ ∮ T R² dt,   ∫ T ⊗ r dA = ⅓ ∮ T ⊗ r R² dt,   ∫ r (r × T) dA = ¼ ∮ r (r × T) R² dt.

On a side at the distance d from C, R² dt = d ds, and y = asinh(s/|d|); Gauss's rule on panels that
shrink to where the slip is along the axis of less friction, next to which the root has a zero.
Where C lies far away the inner integral runs from the distance of C.  Over a disc friction is
summed along the chords through C.  With θ from the direction to the middle of the disc, p = s sin θ
the distance of a chord (s = v/(r|ω|)), L = √(1 − p²) its half and D = s cos θ, in units of r,

    ∫ dA → 2LD dθ,   ∫ ρ dA → ⅔L³ dθ,   ∫ ρ² dA → ⅔L³D dθ    (ρ along the chord from its middle)

whether C lies in the disc or not.  For s > 1 sin q = s sin θ clears the ends.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import DISCS, HEAD, REACH, SIDES, disc_in
from puck_tables.kernels.base_sums import NOTHING, Sums, from_slip, moved, plus, scaled
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.kernels.polygon_sums import (
    BEGIN_X,
    BEGIN_Y,
    FAR,
    LENGTH,
    PIECE_COLUMNS,
    TANGENT_X,
    TANGENT_Y,
    ray_to,
)

# of Gauss's rule a panel, to 2e-12: test_resultants_are_those_of_a_grid_over_the_base
_COUNT = 14
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
# of a panel, over its distance from what is nearly singular; sums err by 7e-14, at 8 by 7e-11
_GROWTH = 2.0
_CLOSEST = 1e-9  # nearer than this nothing is singular that could be seen
_PANEL = 1.8  # of y: at twice that sums err by 4e-13
_ON_SIDE = 1e-14  # of the reach: closer, C lies on a side, and nothing is left of it
_NOWHERE = 1e9  # of the length of a side: so far away nothing is singular
_STEEP = 1.0 - 1e-15  # of tanh 2y


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
def _friction_along(law: Ellipse, ex: float, ey: float) -> tuple[float, float]:
    """What keeps an element of the load 1 slipping along (ex, ey), in axes of the base."""
    c, s = law.cosine, law.sine
    one, two = local_friction(law, c * ex + s * ey, c * ey - s * ex)
    return c * one - s * two, s * one + c * two


@inlined
def _sharpness(law: Ellipse) -> tuple[float, float, float]:
    """The axis of less friction, and the angle of slip beside it at which the root vanishes."""
    least, most = min(law.along, law.across), max(law.along, law.across)
    sharp = math.atanh(least / most) if least < most else 10.0
    if law.along < law.across:
        return law.cosine, law.sine, sharp
    return -law.sine, law.cosine, sharp


@inlined
def _end_of_panel(start: float, last: float, place: float, near: float) -> float:
    """How far a panel may go that begins beside what is singular at the distance ``near``."""
    away = start - place
    if away >= 0.0:
        return min(last, start + max(near, _GROWTH * away))
    if -away <= near:
        return min(last, place)
    return min(last, start - _GROWTH / (1.0 + _GROWTH) * away)


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
    way = 1.0 if rim > 0.0 else -1.0
    # from the instantaneous centre to the middle of the disc
    ox, oy = (way * vy / speed, -way * vx / speed) if speed > 0.0 else (1.0, 0.0)
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
        bend = math.sin(place) / ratio
        bend = min(max(bend, -1.0), 1.0)
        place = math.asin(bend)
        sharp *= turn / max(math.sqrt(1.0 - bend * bend), math.sqrt(sharp * turn))
    branch, sharp = max(branch, _CLOSEST), max(sharp, _CLOSEST)
    sums = NOTHING
    start, last = -0.5 * math.pi, 0.5 * math.pi
    while start < last:
        patience(1)
        end = _end_of_panel(start, last, -0.5 * math.pi, branch)
        end = _end_of_panel(start, end, 0.5 * math.pi, branch)
        end = _end_of_panel(start, end, place, sharp)
        end = min(_end_of_panel(start, end, place + math.pi, sharp), start + 1.0)
        end = _end_of_panel(start, end, place - math.pi, sharp)
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
            tx, ty = local_friction(law, -way * ny, way * nx)
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


@inner
def _along_side(
    law: Ellipse, px: float, py: float, tx: float, ty: float, length: float, least: float
) -> Sums:  # fmt: skip
    """A straight side that begins at p from C, about C, of a spin > 0."""
    d, begin, sums = px * ty - py * tx, px * tx + py * ty, NOTHING
    away = abs(d)
    if away <= least:
        return sums
    low, last = math.asinh(begin / away), math.asinh((begin + length) / away)
    # where the root is 0, of complex y: tanh y is the sine of the angle of the ray from the normal
    ax, ay, sharp = _sharpness(law)
    over, along = ax * tx + ay * ty, ax * ty - ay * tx
    sine = -along if (d > 0.0) == (over > 0.0) else along
    one, two = sine * math.cosh(sharp), abs(over) * math.sinh(sharp)
    square = one * one + two * two
    place = 0.5 * math.atanh(min(max(2.0 * one / (1.0 + square), -_STEEP), _STEEP))
    near = max(0.5 * math.atan2(2.0 * two, 1.0 - square), _CLOSEST)
    while low < last:
        patience(1)
        high = _end_of_panel(low, min(low + _PANEL, last), place, near)
        half, middle = 0.5 * (high - low), 0.5 * (high + low)
        low = high
        for n in range(len(_NODES)):
            up = math.exp(middle + half * _NODES[n])
            s, distance = 0.5 * away * (up - 1.0 / up), 0.5 * away * (up + 1.0 / up)
            rx, ry = d * ty + s * tx, s * ty - d * tx
            fx, fy = _friction_along(law, -ry / distance, rx / distance)
            one = half * _WEIGHTS[n] * d * distance
            two, four = one / 3.0, 0.25 * one * (rx * fy - ry * fx)
            here = (
                0.5 * one * fx, 0.5 * one * fy, two * fx * rx, two * fx * ry, two * fy * rx,
                two * fy * ry, four * rx, four * ry,
            )  # fmt: skip
            sums = plus(sums, 1.0, here)
    return sums


@inner
def _from_far(
    law: Ellipse, ux: float, uy: float, w: float, px: float, py: float, tx: float, ty: float,
    length: float,
) -> Sums:  # fmt: skip
    """A straight side that begins at p, about the centre of mass, with C far away."""
    speed, spin, sign = math.sqrt(ux * ux + uy * uy), abs(w), -1.0 if w < 0.0 else 1.0
    # across the axis of less friction the slip changes along the side at one rate: where it is 0
    ax, ay, sharp = _sharpness(law)
    vx, vy = ux - w * py, uy + w * px
    off, rate = ax * vy - ay * vx, w * (ax * tx + ay * ty)
    place, near, low, sums = _NOWHERE * length, length, 0.0, NOTHING
    if abs(rate) * length > 1e-12 * speed:
        place = -off / rate
        along = ax * vx + ay * vy + w * place * (ay * tx - ax * ty)
        near = max(math.tanh(sharp) * abs(along / rate), _CLOSEST * length)
    while low < length:
        patience(1)
        high = _end_of_panel(low, length, place, near)
        half, middle = 0.5 * (high - low), 0.5 * (high + low)
        low = high
        for n in range(len(_NODES)):
            s = middle + half * _NODES[n]
            qx, qy = px + s * tx, py + s * ty
            vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
            k0 = deep * (speed + 0.5 * spin * deep)
            k1 = deep * deep * (0.5 * speed + spin * deep / 3.0)
            k2 = deep * deep * deep * (speed / 3.0 + 0.25 * spin * deep)
            weight = sign * half * _WEIGHTS[n] * (vx * tx + vy * ty) / (slip * slip)
            dx, dy = sign * vy / slip, -sign * vx / slip
            bx, by = qx - deep * dx, qy - deep * dy
            fx, fy = _friction_along(law, vx / slip, vy / slip)
            lever, more = bx * fy - by * fx, dx * fy - dy * fx
            x, y = bx * k0 + dx * k1, by * k0 + dy * k1
            here = (
                fx * k0, fy * k0, fx * x, fx * y, fy * x, fy * y,
                lever * x + more * (bx * k1 + dx * k2), lever * y + more * (by * k1 + dy * k2),
            )  # fmt: skip
            sums = plus(sums, weight, here)
    return sums


@kernel
def elliptic_sums(base: FloatArray, law: Ellipse, ux: float, uy: float, w: float) -> Sums:
    """Sums of T over a base, in its axes; not at rest."""
    sums, spin = NOTHING, abs(w)
    far = math.sqrt(ux * ux + uy * uy) > FAR * base[REACH] * spin
    cx, cy = (0.0, 0.0) if far else (-uy / w, ux / w)
    for at in range(HEAD, HEAD + PIECE_COLUMNS * int(base[SIDES]), PIECE_COLUMNS):
        px, py, length = base[at + BEGIN_X] - cx, base[at + BEGIN_Y] - cy, base[at + LENGTH]
        tx, ty = base[at + TANGENT_X], base[at + TANGENT_Y]
        if far:
            part = _from_far(law, ux, uy, w, px, py, tx, ty, length)
        else:
            part = _along_side(law, px, py, tx, ty, length, _ON_SIDE * base[REACH])
        sums = plus(sums, 1.0, part)
    if not far:
        sums = plus(NOTHING, 1.0 if w > 0.0 else -1.0, moved(sums, cx, cy))
    c, s = law.cosine, law.sine
    for k in range(int(base[DISCS])):
        x, y, size, sign = disc_in(base, k)
        vx, vy = ux - w * y, uy + w * x
        one = disc_sums(law, c * vx + s * vy, c * vy - s * vx, size * w)
        sums = plus(sums, sign, moved(scaled(from_slip(one, c, s, 1.0), size), x, y))
    return sums
