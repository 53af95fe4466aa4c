"""Sums of the slip direction over parts of a base, and how such are added.

A :data:`Sums` is ∫ of e_x, e_y, x e_x, y e_x, x e_y, y e_y, x (x e_y − y e_x), y (x e_y − y e_x).
"""

from __future__ import annotations

from puck_tables.kernels.compile import inlined, summed

Sums = tuple[float, float, float, float, float, float, float, float]
NOTHING: Sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

UNIFORM, RING, HERTZ, GALIN, TABLE = range(5)  # laws of pressure


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
