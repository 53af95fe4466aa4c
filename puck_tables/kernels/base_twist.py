"""Which way a base slips under a force and a torque: the inverse of its friction.

With lengths over ℓ, √(∫ x² dA/∫ dA), W = (F_x, F_y, T/ℓ) and t = (u_x, u_y, ℓ w), a slip t with
W·t = 1 has a friction against W where the part across W of P(t), what keeps it going, vanishes.  Of
a flat base P is the gradient of what friction dissipates, D(t) = P·t, and that is where the convex
D is least on this plane.  Newton's method finds it, from the slip of an ellipsoid, or from one
about a foot that alone could hold what is left.  By Newton's step D falls at first; it is shortened
while D rises steeply at its end.

A tall base has no such D: Newton's method goes on from the flat base, by heights as large as it
converges for.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import (
    AREA,
    DISCS,
    LEVER,
    SECOND_XX,
    SECOND_YY,
    SIDES,
    disc_in,
    grip,
    pressure_on,
)
from puck_tables.kernels.base_hessian import Wrench, grip_slopes
from puck_tables.kernels.base_sums import NOTHING
from puck_tables.kernels.compile import inlined, inner, patience

Plane = tuple[float, float, float, float, float, float]  # two unit vectors across W
_STEPS = 60  # of Newton's method; it takes 3 to 12
_HALVINGS = 30  # of one step
_SLOPE = 0.5  # of the fall at its beginning: a step at whose end D rises more steeply is cut
_GOOD = 1e-15  # of f N: across W less is rounding
_MOST = 1e-11  # of f N: across W more is not found
_STAGES = 200  # of the height


@inlined
def _across(x: float, y: float, z: float) -> Plane:
    """Two unit vectors across a unit vector and each other (Duff et al. 2017)."""
    sign = 1.0 if z >= 0.0 else -1.0
    a = -1.0 / (sign + z)
    b = x * y * a
    return 1.0 + sign * x * x * a, sign * b, -sign * x, b, sign + y * y * a, -y


@inlined
def _start(base: FloatArray, size: float, x: float, y: float, z: float) -> Wrench:
    """A slip to begin with, under the unit wrench (x, y, z), torque over ``size``."""
    sides, discs = base[SIDES], int(base[DISCS])
    if discs > 0 and sides + discs > 1.0:
        a, bx, by = pressure_on(base, NOTHING)  # with the height 0: as it is now
        for k in range(discs):
            cx, cy, radius, sign = disc_in(base, k)
            lever = size * z - cx * y + cy * x  # torque about the foot
            load = sign * math.pi * radius * radius * (a + bx * cx + by * cy)
            if sign < 0.0 or lever == 0.0:
                continue
            w = 1.0 if lever > 0.0 else -1.0
            fx, fy, torque = grip(base, w * cy, -w * cx, w)
            many = (torque - cx * fy + cy * fx) / lever
            fx, fy = many * x - fx, many * y - fy
            rest = math.sqrt(fx * fx + fy * fy)
            if many > 0.0 and rest < load:
                share = radius / load if rest > 0.0 else 0.0
                return w * cy + share * fx, -w * cx + share * fy, size * w
    return x, y, z


@inlined
def _scaled(
    base: FloatArray, size: float, x: float, y: float, z: float, slopes: FloatArray
) -> Wrench:
    """P of a slip, and its derivatives, with lengths over ``size``."""
    fx, fy, torque = grip_slopes(base, x, y, z / size, slopes)
    for i in range(2):
        slopes[i, 2] /= size
        slopes[2, i] /= size
    slopes[2, 2] /= size * size
    return fx, fy, torque / size


@inlined
def _step(slopes: FloatArray, plane: Plane, along: float, across: float) -> tuple[float, float]:
    """Newton's step in the plane, where the part of P in it is (along, across)."""
    ax, ay, az, bx, by, bz = plane
    px = slopes[0, 0] * ax + slopes[0, 1] * ay + slopes[0, 2] * az
    py = slopes[1, 0] * ax + slopes[1, 1] * ay + slopes[1, 2] * az
    pz = slopes[2, 0] * ax + slopes[2, 1] * ay + slopes[2, 2] * az
    qx = slopes[0, 0] * bx + slopes[0, 1] * by + slopes[0, 2] * bz
    qy = slopes[1, 0] * bx + slopes[1, 1] * by + slopes[1, 2] * bz
    qz = slopes[2, 0] * bx + slopes[2, 1] * by + slopes[2, 2] * bz
    aa, ab = ax * px + ay * py + az * pz, ax * qx + ay * qy + az * qz
    ba, bb = bx * px + by * py + bz * pz, bx * qx + by * qy + bz * qz
    turn = 1.0 / (aa * bb - ab * ba)
    return -turn * (bb * along - ab * across), -turn * (aa * across - ba * along)


@inner
def _newton(
    base: FloatArray, size: float, wx: float, wy: float, wz: float, slip: FloatArray,
    slopes: FloatArray,
) -> float:  # fmt: skip
    """Newton's method from a slip with W·t = 1, into it; how much of P is left across W."""
    plane = _across(wx, wy, wz)
    ax, ay, az, bx, by, bz = plane
    flat = base[LEVER] == 0.0
    x, y, z = slip[0], slip[1], slip[2]
    fx, fy, fz = _scaled(base, size, x, y, z, slopes)
    along, across = ax * fx + ay * fy + az * fz, bx * fx + by * fy + bz * fz
    left = math.sqrt(along * along + across * across)
    for _ in range(_STEPS):
        patience(1)
        p, q = _step(slopes, plane, along, across)
        if not left > _GOOD or not math.isfinite(p + q):
            break
        before, begin, share, better = left, along * p + across * q, 1.0, False
        for _ in range(_HALVINGS):
            dx, dy, dz = p * ax + q * bx, p * ay + q * by, p * az + q * bz
            nx, ny, nz = x + share * dx, y + share * dy, z + share * dz
            fx, fy, fz = _scaled(base, size, nx, ny, nz, slopes)
            along, across = ax * fx + ay * fy + az * fz, bx * fx + by * fy + bz * fz
            left = math.sqrt(along * along + across * across)
            end = along * p + across * q
            better = left < _MOST or (end <= -_SLOPE * begin if flat else left < before)
            if better:
                break
            share *= max(0.1, min(0.5, begin / (begin - end))) if flat else 0.5
        if not better or (before < _MOST and left >= before):  # it gets no better
            left = before
            break
        x, y, z = nx, ny, nz
    slip[0], slip[1], slip[2] = x, y, z
    return left


@inner
def base_twist(
    base: FloatArray, fx: float, fy: float, torque: float, slip: FloatArray, slopes: FloatArray
) -> float:
    """The slip (u_x, u_y, w) that a force and a torque over f N keep going, in the axes of a base.

    Into ``slip`` (3,), of any length; ``slopes``: (3, 3) to work in.  Returns by what they must be
    multiplied for it, NaN where it was not found.  Force and torque: not all 0; the height in
    ``base`` is changed on the way, and put back.
    """
    size = math.sqrt((base[SECOND_XX] + base[SECOND_YY]) / base[AREA])
    wz = torque / size
    length = math.sqrt(fx * fx + fy * fy + wz * wz)
    wx, wy, wz = fx / length, fy / length, wz / length
    highest, height, rise = base[LEVER], 0.0, base[LEVER]
    base[LEVER] = 0.0
    slip[0], slip[1], slip[2] = _start(base, size, wx, wy, wz)
    left = _onto(base, size, wx, wy, wz, slip, slopes)
    for _ in range(_STAGES):
        if not left <= _MOST or height == highest:
            break
        x, y, z = slip[0], slip[1], slip[2]
        base[LEVER] = min(height + rise, highest)
        if _onto(base, size, wx, wy, wz, slip, slopes) <= _MOST:
            height = base[LEVER]
        else:
            slip[0], slip[1], slip[2] = x, y, z
            rise *= 0.5
    base[LEVER] = highest
    slip[2] /= size
    if not left <= _MOST or height != highest:
        return math.nan
    ux, uy, w = slip[0], slip[1], slip[2]
    gx, gy, gz = grip(base, ux, uy, w)
    power = gx * ux + gy * uy + gz * w
    return power / (fx * ux + fy * uy + torque * w)


@inlined
def _onto(
    base: FloatArray, size: float, wx: float, wy: float, wz: float, slip: FloatArray,
    slopes: FloatArray,
) -> float:  # fmt: skip
    power = wx * slip[0] + wy * slip[1] + wz * slip[2]
    for i in range(3):
        slip[i] /= power
    return _newton(base, size, wx, wy, wz, slip, slopes)
