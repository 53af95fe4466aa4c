"""Dry friction of a floor that is rougher one way than the other: brushed metal, felt, wood grain.

The local law is that of the largest dissipation within an ellipse (Michałowski, Mróz 1978; Goyal,
Ruina, Papadopoulos 1991): an element that slips in the direction e, in the axes of the floor, feels

    −σ (f_x² e_x, f_y² e_y)/√(f_x² e_x² + f_y² e_y²),

and one at rest holds what lies within the ellipse of the half axes σ f_x, σ f_y.  The simpler −σ
(f_x e_x, f_y e_y) has the same friction along the axes, but no cone at rest that belongs to it.

The directions of slip are those of a turn about the instantaneous centre c, so on a line through c
friction is the same all along, but for its sign; that makes of the integral over the base one over
the lines.  With θ from the direction to the middle of the base, p = s sin θ the distance of a line
(s = v/(r|ω|)), L = √(1 − p²) half its chord and D = s cos θ, in units of r,

    ∫ dA → 2LD dθ,   ∫ ρ dA → ⅔L³ dθ,   ∫ ρ² dA → ⅔L³D dθ    (ρ along the line from its middle)

whether c lies in the base or not.  For s > 1 sin q = s sin θ clears the ends.  Friction tilts the
load as everywhere, with F in both directions; while 2 max(f) h/r ≤ 1 the whole base stays loaded.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(14)
_GROWTH = 2.0  # of a panel, over its distance from what is nearly singular
_CLOSEST = 1e-9  # nearer than this nothing is singular that could be seen
_SETTLED = 4e-15  # rounding of a direction
LEAST_RATIO = 0.03  # of f in the two directions; below, steps are many


class Elliptic(NamedTuple):
    """Friction by an ellipse.

    ``along``, ``across``: f in the axes of the floor, the first of which is turned from x by the
    angle of ``cosine`` and ``sine``; ``height_ratio``: 2h/r; ``normal``: N.
    """

    along: float
    across: float
    cosine: float
    sine: float
    height_ratio: float
    normal: float


_NUMBERS = 4


@inlined
def is_elliptic(table: FloatArray) -> bool:
    """Whether the table of a friction law has the axes of an ellipse; those by speed are longer."""
    return len(table) == _NUMBERS


@inlined
def ellipse_in(table: FloatArray, height_ratio: float, normal: float) -> Elliptic:
    """The ellipse of such a table: f along, f across, cosine and sine."""
    return Elliptic(table[0], table[1], table[2], table[3], height_ratio, normal)


@inlined
def local_friction(law: Elliptic, ex: float, ey: float) -> tuple[float, float]:
    """What an element of the load 1 that slips along (ex, ey), in the axes of the floor, feels."""
    size = math.hypot(law.along * ex, law.across * ey)
    return -law.along * law.along * ex / size, -law.across * law.across * ey / size


@inlined
def _end_of_panel(start: float, last: float, place: float, near: float) -> float:
    """How far a panel may go that begins beside what is singular at the distance ``near``."""
    away = start - place
    if away >= 0.0:
        return min(last, start + max(near, _GROWTH * away))
    if -away <= near:
        return min(last, place)
    return min(last, start - _GROWTH / (1.0 + _GROWTH) * away)


@kernel
def mean_friction(
    law: Elliptic, vx: float, vy: float, rim: float
) -> tuple[float, float, float]:  # fmt: skip
    """Force over N and torque over N r, at a velocity in the axes of the floor and a rim speed.

    ``rim``: r ω; not all three are zero.
    """
    speed, fast = math.hypot(vx, vy), abs(rim)
    if rim == 0.0:
        fx, fy = local_friction(law, vx / speed, vy / speed)
        return fx, fy, 0.0
    way = 1.0 if rim > 0.0 else -1.0
    # from the instantaneous centre to the middle of the base
    ox, oy = (way * vy / speed, -way * vx / speed) if speed > 0.0 else (1.0, 0.0)
    inside = speed <= fast
    ratio = speed / fast if inside else fast / speed
    gap = (1.0 - ratio) * (1.0 + ratio)
    branch = math.sqrt(gap) / max(ratio, 0.1)
    # where the slip is along the axis of less friction, and how far the zero of the root lies
    least, most = min(law.along, law.across), max(law.along, law.across)
    sharp = math.atanh(least / most) if least < most else 10.0
    ax, ay = (0.0, 1.0) if law.along < law.across else (1.0, 0.0)
    sine, cosine = ax * oy - ay * ox, ax * ox + ay * oy
    place = -math.atan(sine / cosine) if cosine != 0.0 else 0.5 * math.pi
    if not inside:
        turn = math.cos(place) / ratio
        bend = math.sin(place) / ratio
        bend = min(max(bend, -1.0), 1.0)
        place = math.asin(bend)
        sharp *= turn / max(math.sqrt(1.0 - bend * bend), math.sqrt(sharp * turn))
    branch, sharp = max(branch, _CLOSEST), max(sharp, _CLOSEST)
    fx, fy, moment = 0.0, 0.0, 0.0
    xx, xy, yx, yy, mx, my = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
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
            # torque of friction about the middle of the line, and along it
            arm, along = -(nx * tx + ny * ty), nx * ty - ny * tx
            weight = half * _WEIGHTS[i]
            area, first, second = weight * area, weight * first, weight * second
            px, py = nx * first - off * ny * area, ny * first + off * nx * area
            fx, fy = fx + tx * area, fy + ty * area
            moment += off * arm * area + along * first
            xx, xy, yx, yy = xx + tx * px, xy + tx * py, yx + ty * px, yy + ty * py
            turning = off * first
            mx += (
                nx * (off * arm * first)
                - ny * (off * off * arm * area)
                + (nx * along * second - ny * turning * along)
            )
            my += (
                ny * (off * arm * first)
                + nx * (off * off * arm * area)
                + (ny * along * second + nx * turning * along)
            )
    g = law.height_ratio / math.pi
    a, b, c, d = 1.0 + g * xx, g * xy, g * yx, 1.0 + g * yy
    whole = a * d - b * c
    fx, fy = (d * fx - b * fy) / whole, (a * fy - c * fx) / whole
    return fx / math.pi, fy / math.pi, (moment - g * (fx * mx + fy * my)) / math.pi


@inlined
def elliptic_friction(
    law: Elliptic, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor."""
    vx, vy = law.cosine * ux + law.sine * uy, law.cosine * uy - law.sine * ux
    fx, fy, moment = mean_friction(law, vx, vy, radius * w)
    fx, fy = law.normal * fx, law.normal * fy
    torque = law.normal * radius * moment
    return (
        law.cosine * fx - law.sine * fy,
        law.sine * fx + law.cosine * fy,
        torque,
        -(fx * vx + fy * vy + torque * w),
    )


@inlined
def _narrowed(
    low: float, high: float, first: float, last: float, side: int, at: float, off: float
) -> tuple[float, float, float, float, int]:
    """A bracket of a zero after another look at it, by the Illinois rule."""
    if off < 0.0:
        return at, high, off, (0.5 * last if side < 0 else last), -1
    return low, at, (0.5 * first if side > 0 else first), off, 1


@kernel
def elliptic_demand(
    law: Elliptic, radius: float, fx: float, fy: float, torque: float, guided: bool
) -> tuple[float, float, float, float, float]:
    """As :func:`puck_tables.scene.rest.demand` has it, where friction is by an ellipse.

    The slip is sought whose friction is against the force and the torque: a share φ of it is spin,
    and the rest has a direction less than a right angle from the force, as friction brakes.
    """
    force = math.hypot(fx, fy)
    east, north = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    ex, ey = law.cosine * east + law.sine * north, law.cosine * north - law.sine * east
    way = 1.0 if torque >= 0.0 else -1.0
    cosine, sine = 1.0, 0.0
    bx, by = ex, ey
    if not guided:  # without spin
        bx, by = ex / law.along**2, ey / law.across**2
        size = math.hypot(bx, by)
        bx, by = bx / size, by / size
    if torque != 0.0:
        low, high, first, last, side = 0.0, 0.5 * math.pi, -1.0, 1.0, 0
        for _ in range(60):
            phi = (low * last - high * first) / (last - first)
            phi = phi if low < phi < high else 0.5 * (low + high)
            cosine, sine = math.cos(phi), way * math.sin(phi)
            if not guided and force > 0.0:
                bx, by = _direction_against(law, ex, ey, cosine, sine)
            rx, ry, turning = mean_friction(law, cosine * bx, cosine * by, sine)
            resist = -(rx * ex + ry * ey)
            more, less = force * abs(turning) * radius, abs(torque) * resist
            off = (more - less) / (more + less)
            if abs(off) <= _SETTLED or high - low <= _SETTLED:
                break
            low, high, first, last, side = _narrowed(low, high, first, last, side, phi, off)
        if force == 0.0:
            cosine, sine = 0.0, way
    rx, ry, turning = mean_friction(law, cosine * bx, cosine * by, sine)
    resist = -(rx * ex + ry * ey) if guided else math.hypot(rx, ry)
    if force == 0.0 and torque != 0.0:
        resist = 0.0
    share = math.hypot(force, torque / radius) / (law.normal * math.hypot(resist, turning))
    heat = -law.normal * (rx * cosine * bx + ry * cosine * by + turning * sine)
    return (
        share,
        heat,
        cosine * (law.cosine * bx - law.sine * by),
        cosine * (law.sine * bx + law.cosine * by),
        sine / radius,
    )


@inlined
def _direction_against(
    law: Elliptic, ex: float, ey: float, cosine: float, sine: float
) -> tuple[float, float]:
    """The direction of the slip beside such a spin whose friction is against (ex, ey)."""
    low, high, first, last, side = -0.5 * math.pi, 0.5 * math.pi, -1.0, 1.0, 0
    bx, by = ex, ey
    for _ in range(60):
        turn = (low * last - high * first) / (last - first)
        turn = turn if low < turn < high else 0.5 * (low + high)
        along, across = math.cos(turn), math.sin(turn)
        bx, by = along * ex - across * ey, along * ey + across * ex
        rx, ry, _ = mean_friction(law, cosine * bx, cosine * by, sine)
        off = (ey * rx - ex * ry) / math.hypot(rx, ry)
        if abs(off) <= _SETTLED or high - low <= _SETTLED:
            break
        low, high, first, last, side = _narrowed(low, high, first, last, side, turn, off)
    return bx, by
