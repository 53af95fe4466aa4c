"""What the direction of a slip changes in sums of friction under a law of the slip speed.

T = f A² e/|A e|, e along the slip and A = diag(p, q) in the axes of an :class:`Ellipse`, is the
same all along a ray from the instantaneous centre C, but for f
(:mod:`puck_tables.kernels.law_sums`).

1/|A e| branches at complex places: where the slip is i atanh(least/most) off the smoother axis.  Of
a side at the distance d from C, on which that axis lies at an angle θ from its tangent, it does at
y = ± asinh(sin θ/√(S² + cos² θ)) + i atan2(S, ± cos θ), S = least/√(most² − least²), where
y = asinh(s/|d|).  There panels shrink.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elliptic_sums import Ellipse, Stretched, local_friction, singular_angles

LEAST_GAP = 1e-9  # of an angle: closer, C lies on the circle


@inlined
def against(axes: Ellipse, ex: float, ey: float) -> tuple[float, float]:
    """What keeps an element of f N = 1 slipping along a unit vector."""
    if axes.along == axes.across:
        return axes.along * ex, axes.along * ey
    c, s = axes.cosine, axes.sine
    x, y = local_friction(axes, c * ex + s * ey, c * ey - s * ex)
    return c * x - s * y, s * x + c * y


class BranchPoints(NamedTuple):
    """Where 1/|A e| branches beside a side, in y, or a circle, in its angle: two places.

    ``near`` and ``close``: how far off the first and the second are; inf: nowhere.
    """

    first: float
    near: float
    second: float
    close: float


@inlined
def branches_of_side(axes: Ellipse, d: float, tx: float, ty: float) -> BranchPoints:
    """Of a side along (tx, ty) that C lies d to the left of; y grows along it."""
    least, most = min(axes.along, axes.across), max(axes.along, axes.across)
    if least == most:
        return BranchPoints(0.0, math.inf, 0.0, math.inf)
    ax, ay = axes.cosine, axes.sine
    if axes.along > axes.across:
        ax, ay = -ay, ax
    sharp = least / math.sqrt((most - least) * (most + least))
    c, s = ax * tx + ay * ty, ay * tx - ax * ty
    near = math.atan2(sharp, abs(c))
    place = math.asinh(s / math.sqrt(sharp * sharp + c * c))
    place = place if c * d >= 0.0 else -place
    return BranchPoints(place, near, -place, math.pi - near)


@inlined
def branches_of_circle(
    axes: Ellipse, gx: float, gy: float, size: float, nearest: float, side: float
) -> BranchPoints:
    """Of a circle whose middle is at g from C, by its angle from ``nearest``; ``side`` −1: back."""
    p, q, c, s = axes.along, axes.across, axes.cosine, axes.sine
    if p == q:
        return BranchPoints(0.0, math.inf, 0.0, math.inf)
    one = Stretched(0.0, 1.0, q * c, q * s, -p * s, p * c)
    first, near, second, close = singular_angles(
        one, q * (c * gx + s * gy), p * (c * gy - s * gx), size
    )
    return BranchPoints(
        side * (first - nearest), max(near, LEAST_GAP), side * (second - nearest),
        max(close, LEAST_GAP),
    )  # fmt: skip


class Square(NamedTuple):
    """|A e|² R² at (x, y) from C: ``xx`` x² + ``xy`` x y + ``yy`` y²."""

    xx: float
    xy: float
    yy: float


PLAIN = Square(0.0, 0.0, 0.0)  # of no direction


@inlined
def by_axes(axes: Ellipse, sums: Sums) -> Sums:
    """Sums of e/|A e| as those of T, whose last two are."""
    if axes.along == axes.across:
        return plus(NOTHING, axes.along, sums)
    p, q, c, s = axes.along, axes.across, axes.cosine, axes.sine
    xx, yy = c * c * p * p + s * s * q * q, s * s * p * p + c * c * q * q
    xy = c * s * (p * p - q * q)
    return (
        xx * sums[0] + xy * sums[1], xy * sums[0] + yy * sums[1], xx * sums[2] + xy * sums[4],
        xx * sums[3] + xy * sums[5], xy * sums[2] + yy * sums[4], xy * sums[3] + yy * sums[5],
        sums[6], sums[7],
    )  # fmt: skip


@inlined
def square_about(axes: Ellipse, nx: float, ny: float, side: float) -> Square:
    """In axes along the unit vector n and to its left, or to its right: ``side`` −1."""
    near, normal = axes.cosine * nx + axes.sine * ny, axes.sine * nx - axes.cosine * ny
    one, two = axes.along * normal, axes.across * near
    three, four = axes.along * near, axes.across * normal
    mixed = 2.0 * side * (two * four - one * three)
    return Square(one * one + two * two, mixed, three * three + four * four)
