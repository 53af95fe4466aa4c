"""Where a disc is at what stands: the gap, the normal, its curvature, and where it ends.

Walls and edges go on for ever, sides between two ends at which corners stand; posts and pockets are
circles from outside, arcs parts of circles from within.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.world.layout import (
    ARC,
    CORNER,
    EDGE,
    END_X,
    END_Y,
    FROM,
    KIND,
    OVERHANG,
    POCKET,
    SIDE,
    SPAN,
    START_X,
    START_Y,
    WALL,
    A,
    B,
    C,
)

TOUCH = 1e-12  # of the radius: a gap as small is none
ROUNDED = 1e-15  # of the places: a gap as small is none


@inlined
def in_span(angle: float, start: float, span: float) -> bool:
    """Whether an angle lies in [start, start + span]."""
    turns = (angle - start) / (2.0 * math.pi)
    return 2.0 * math.pi * (turns - float(np.floor(turns))) <= span


@inlined
def beyond_ends(obstacle: FloatArray, x: float, y: float) -> tuple[float, float, float]:
    """How far a centre is beyond where a side or a corner is met, less than 0 within; its gradient.

    The same sums decide about a side and about the corners at its ends.
    """
    if obstacle[KIND] == SIDE:
        ux, uy = obstacle[B], -obstacle[A]
        before = (obstacle[START_X] - x) * ux + (obstacle[START_Y] - y) * uy
        after = (x - obstacle[END_X]) * ux + (y - obstacle[END_Y]) * uy
        return (before, -ux, -uy) if before > after else (after, ux, uy)
    dx, dy = x - obstacle[A], y - obstacle[B]
    one = dx * obstacle[START_X] + dy * obstacle[START_Y]
    other = dx * obstacle[END_X] + dy * obstacle[END_Y]
    if one > other:
        return one, obstacle[START_X], obstacle[START_Y]
    return other, obstacle[END_X], obstacle[END_Y]


@inlined
def slack_of(radius: float, x: float, y: float) -> float:
    """How far sides reach beyond their ends: no rounding leaves a gap between them and corners.

    Of what touches it is then a side, no corner.  What runs off a side does so twice as far away.
    """
    return TOUCH * radius + 4.0 * ROUNDED * (abs(x) + abs(y))


@inlined
def normal_to(
    obstacle: FloatArray, radius: float, x: float, y: float, slack: float
) -> tuple[float, float, float, bool]:
    """The gap of a disc to an obstacle, the unit normal towards it, and whether it is there.

    ``slack``: see :func:`slack_of`, or 0.
    """
    kind = int(obstacle[KIND])
    if kind in (WALL, EDGE, OVERHANG):
        margin = 0.0 if kind == EDGE else radius
        gap = obstacle[A] * x + obstacle[B] * y - obstacle[C] - margin
        return gap, -obstacle[A], -obstacle[B], True
    if kind == SIDE:
        away = obstacle[A] * x + obstacle[B] * y - obstacle[C]
        face = -1.0 if away < 0.0 else 1.0
        there = beyond_ends(obstacle, x, y)[0] <= slack
        return face * away - radius, -face * obstacle[A], -face * obstacle[B], there
    dx, dy = obstacle[A] - x, obstacle[B] - y
    size = math.hypot(dx, dy)
    nx, ny = (dx / size, dy / size) if size > 0.0 else (1.0, 0.0)
    if kind == CORNER:
        return size - radius, nx, ny, beyond_ends(obstacle, x, y)[0] < -slack
    if kind == ARC:
        there = in_span(math.atan2(-ny, -nx), obstacle[FROM], obstacle[SPAN])
        return obstacle[C] - radius - size, -nx, -ny, there
    return size - obstacle[C] - (0.0 if kind == POCKET else radius), nx, ny, True


@inlined
def curvature(obstacle: FloatArray, radius: float, gap: float) -> float:
    """κ, 1/m: a slip v along an obstacle opens the gap of a disc with κ v²."""
    shape = int(obstacle[KIND])
    if shape in (WALL, SIDE):
        return 0.0
    if shape == ARC:
        return -1.0 / (obstacle[C] - radius - gap)
    return 1.0 / (obstacle[C] + radius + gap)


@inlined
def to_end(obstacle: FloatArray, radius: float, x: float, y: float) -> float:
    """How far a disc is within the ends: m at a side or a corner, rad at an arc; inf: has none."""
    shape = int(obstacle[KIND])
    if shape == SIDE:
        return 2.0 * slack_of(radius, x, y) - beyond_ends(obstacle, x, y)[0]
    if shape == CORNER:
        return -beyond_ends(obstacle, x, y)[0]
    if shape != ARC or obstacle[SPAN] >= 2.0 * math.pi:
        return math.inf
    half = 0.5 * obstacle[SPAN]
    off = math.atan2(y - obstacle[B], x - obstacle[A]) - obstacle[FROM] - half
    off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
    return half - abs(off)
