"""Sums of the slip direction over parts of a base, and how such are added.

A :data:`Sums` is ∫ of e_x, e_y, x e_x, y e_x, x e_y, y e_y, x (x e_y − y e_x), y (x e_y − y e_x).
"""

from __future__ import annotations

from puck_tables.kernels.compile import inlined, summed

Sums = tuple[float, float, float, float, float, float, float, float]
NOTHING: Sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)  # over no part

# laws of pressure; those but the first under round bases alone
UNIFORM, RING, HERTZ, GALIN, TABLE = range(5)


@inlined
def plus(sums: Sums, weight: float, more: Sums) -> Sums:
    """Sums and so many times others."""
    return (
        sums[0] + weight * more[0], sums[1] + weight * more[1], sums[2] + weight * more[2],
        sums[3] + weight * more[3], sums[4] + weight * more[4], sums[5] + weight * more[5],
        sums[6] + weight * more[6], sums[7] + weight * more[7],
    )  # fmt: skip


@inlined
def added(sums: Sums, weight: float, more: Sums) -> Sums:
    """Sums and so many times others, in any order."""
    return (
        summed(sums[0], weight * more[0]), summed(sums[1], weight * more[1]),
        summed(sums[2], weight * more[2]), summed(sums[3], weight * more[3]),
        summed(sums[4], weight * more[4]), summed(sums[5], weight * more[5]),
        summed(sums[6], weight * more[6]), summed(sums[7], weight * more[7]),
    )  # fmt: skip


@inlined
def from_slip(sums: Sums, c: float, s: float, mirrored: float) -> Sums:
    """Sums in axes along (c, s) and across, ``mirrored`` −1: to its right, in other axes."""
    ex, ey = sums[0], mirrored * sums[1]
    xx, xy, yx, yy = sums[2], mirrored * sums[3], mirrored * sums[4], sums[5]
    gx, gy = mirrored * sums[6], sums[7]
    cc, cs, ss = c * c, c * s, s * s
    return (
        c * ex - s * ey, s * ex + c * ey,
        cc * xx - cs * (xy + yx) + ss * yy, cc * xy + cs * (xx - yy) - ss * yx,
        cc * yx + cs * (xx - yy) - ss * xy, cc * yy + cs * (xy + yx) + ss * xx,
        c * gx - s * gy, s * gx + c * gy,
    )  # fmt: skip


@inlined
def moved(sums: Sums, cx: float, cy: float) -> Sums:
    """Sums about (cx, cy) as sums about the origin."""
    ex, ey, xx, xy, yx, yy = sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]
    swing = yx - xy + cx * ey - cy * ex
    return (
        ex, ey, xx + ex * cx, xy + ex * cy, yx + ey * cx, yy + ey * cy,
        sums[6] + cx * yx - cy * xx + swing * cx, sums[7] + cx * yy - cy * xy + swing * cy,
    )  # fmt: skip


@inlined
def scaled(sums: Sums, unit: float) -> Sums:
    """Sums with lengths in a unit, m, as sums in m."""
    area, third = unit * unit, unit * unit * unit
    return (
        area * sums[0], area * sums[1], third * sums[2], third * sums[3], third * sums[4],
        third * sums[5], area * area * sums[6], area * area * sums[7],
    )  # fmt: skip
