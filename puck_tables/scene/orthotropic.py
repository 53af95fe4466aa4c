"""Dry friction of a floor that is rougher one way than the other: brushed metal, felt, wood grain.

The local law is that of :mod:`puck_tables.kernels.elliptic_sums`, and an element at rest holds what
lies within the ellipse of the half axes σ f_x, σ f_y.  The simpler −σ (f_x e_x, f_y e_y) has the
same friction along the axes, but no cone at rest that belongs to it.  Friction tilts the load as
everywhere, with F in both directions; while 2 max(f) h/r ≤ 1 a round base stays loaded everywhere.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.elliptic_sums import Ellipse, disc_sums

_CONVERGED = 4e-15  # rounding of a direction
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


_NUMBERS = 4  # in the table of an ellipse: f along and across, cosine, sine


@inlined
def is_elliptic(table: FloatArray) -> bool:
    """Whether the table of a friction law has the axes of an ellipse; those by speed are longer."""
    return len(table) == _NUMBERS


@inlined
def ellipse_in(table: FloatArray, height_ratio: float, normal: float) -> Elliptic:
    """The ellipse of such a table: f along, f across, cosine and sine."""
    return Elliptic(table[0], table[1], table[2], table[3], height_ratio, normal)


@kernel
def mean_friction(
    law: Elliptic, vx: float, vy: float, rim: float
) -> tuple[float, float, float]:  # fmt: skip
    """Force over N and torque over N r, at a velocity in the axes of the floor and a rim speed.

    ``rim``: r ω; not all three are zero.
    """
    sums = disc_sums(Ellipse(law.along, law.across, 1.0, 0.0), vx, vy, rim)
    fx, fy, xx, xy, yx, yy, mx, my = sums
    g = law.height_ratio / math.pi
    a, b, c, d = 1.0 - g * xx, -g * xy, -g * yx, 1.0 - g * yy
    whole = a * d - b * c
    fx, fy = (d * fx - b * fy) / whole, (a * fy - c * fx) / whole
    return -fx / math.pi, -fy / math.pi, -(yx - xy + g * (fx * mx + fy * my)) / math.pi


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
    """The share of friction by an ellipse that a force and a torque take up; W and the slip.

    The slip is sought whose friction is against the force and the torque: a share φ of it is spin,
    and the rest has a direction less than a right angle from the force, as friction brakes.
    """
    force = math.hypot(fx, fy)
    east, north = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    ex, ey = law.cosine * east + law.sine * north, law.cosine * north - law.sine * east
    sense = 1.0 if torque >= 0.0 else -1.0
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
            cosine, sine = math.cos(phi), sense * math.sin(phi)
            if not guided and force > 0.0:
                bx, by = _direction_against(law, ex, ey, cosine, sine)
            rx, ry, turning = mean_friction(law, cosine * bx, cosine * by, sine)
            resist = -(rx * ex + ry * ey)
            more, less = force * abs(turning) * radius, abs(torque) * resist
            off = (more - less) / (more + less)
            if abs(off) <= _CONVERGED or high - low <= _CONVERGED:
                break
            low, high, first, last, side = _narrowed(low, high, first, last, side, phi, off)
        if force == 0.0:
            cosine, sine = 0.0, sense
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
        if abs(off) <= _CONVERGED or high - low <= _CONVERGED:
            break
        low, high, first, last, side = _narrowed(low, high, first, last, side, turn, off)
    return bx, by
