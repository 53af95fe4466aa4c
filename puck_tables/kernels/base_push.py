"""How a finger that moves past the floor pushes a base, so slowly that nothing but friction counts.

The push is along one force at the contact, so friction has no torque about it.  Where the finger
sticks that leaves one unknown, the spin: with the contact at r the slips t(w) that take it along
with the finger have dt/dw = g = (r_y, −r_x, 1), and the torque about it, g·P(t), is 0.  Of a flat
body it grows with w, as D is convex along that line.  If the force that this takes lies out of the
cone of friction at the contact the finger slides, the force is that edge of the cone, and the slip
its twist, as fast as the finger presses on.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import REACH
from puck_tables.kernels.base_hessian import grip_slopes
from puck_tables.kernels.base_twist import base_twist
from puck_tables.kernels.compile import inner, kernel, patience

STICKS, LEFT, RIGHT, APART = range(4)
UNKNOWN = -1  # no slip was found
_STEPS = 200  # of a search; Newton's steps are 3 to 8, what brackets and halves is the rest
_GOOD = 1e-15  # of f N times the reach
_WRONG = 1e-9  # of the speed: a finger that slides against its friction by more is no push


@inner
def _spin_that_sticks(
    base: FloatArray, ux: float, uy: float, rx: float, ry: float, slopes: FloatArray,
    force: FloatArray,
) -> float:  # fmt: skip
    """The spin with which the contact sticks, NaN if none was found; its wrench into ``force``."""
    low, high, w = -math.inf, math.inf, 0.0
    step = math.sqrt(ux * ux + uy * uy) / base[REACH]
    for _ in range(_STEPS):
        patience(1)
        fx, fy, torque = grip_slopes(base, ux + w * ry, uy - w * rx, w, slopes)
        left = ry * fx - rx * fy + torque
        force[0], force[1], force[2] = fx, fy, torque
        if left > 0.0:
            high = w
        else:
            low = w
        x = ry * slopes[0, 0] - rx * slopes[1, 0] + slopes[2, 0]
        y = ry * slopes[0, 1] - rx * slopes[1, 1] + slopes[2, 1]
        z = ry * slopes[0, 2] - rx * slopes[1, 2] + slopes[2, 2]
        slope = x * ry - y * rx + z
        new = w - left / slope if slope > 0.0 else math.inf
        if math.isinf(low) or math.isinf(high):
            # not farther than a step, which grows
            new = (
                min(max(new, w - step), w + step) if slope > 0.0 else w - math.copysign(step, left)
            )
            step *= 4.0
        elif not low < new < high:
            new = 0.5 * (low + high)
        if abs(left) <= _GOOD * base[REACH] or new == w or (new in (low, high)):
            return w
        w = new
    return math.nan


@kernel
def push_twist(
    base: FloatArray, ux: float, uy: float, rx: float, ry: float, nx: float, ny: float,
    friction: float, out: FloatArray, work: FloatArray, slopes: FloatArray,
) -> int:  # fmt: skip
    """The slip of a base under a finger, and the force over f N, (5,) into ``out``; how it touches.

    (ux, uy): velocity of the finger; (rx, ry): the contact, from the centre of mass; (nx, ny): the
    unit normal there into the base; all in the axes of the base.  ``work`` (3,), ``slopes`` (3, 3).
    STICKS; LEFT, RIGHT: it slides to there as seen along the normal; APART: it does not press.
    """
    for i in range(5):
        out[i] = 0.0
    tx, ty = -ny, nx
    w = _spin_that_sticks(base, ux, uy, rx, ry, slopes, work)
    if math.isnan(w):
        return UNKNOWN
    pressed, dragged = work[0] * nx + work[1] * ny, work[0] * tx + work[1] * ty
    if pressed > 0.0 and abs(dragged) <= friction * pressed:
        out[0], out[1], out[2], out[3], out[4] = ux + w * ry, uy - w * rx, w, work[0], work[1]
        return STICKS
    pressing = ux * nx + uy * ny
    if pressing <= 0.0:
        return APART
    side = math.copysign(friction, dragged)
    fx, fy = nx + side * tx, ny + side * ty
    many = base_twist(base, fx, fy, rx * fy - ry * fx, work, slopes)
    cx, cy = work[0] - work[2] * ry, work[1] + work[2] * rx
    ahead = cx * nx + cy * ny
    if math.isnan(many) or not ahead > 0.0:
        return UNKNOWN
    scale = pressing / ahead
    slides = (ux - scale * cx) * tx + (uy - scale * cy) * ty
    if friction > 0.0 and slides * dragged < -_WRONG * math.hypot(ux, uy) * abs(dragged):
        return UNKNOWN
    out[0], out[1], out[2] = scale * work[0], scale * work[1], scale * work[2]
    out[3], out[4] = many * fx, many * fy
    return LEFT if slides > 0.0 else RIGHT
