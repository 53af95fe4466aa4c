"""Constraints of discs: what they leave of an impulse and of a force, and what they forbid.

With A V = e of the velocities V = (vx, vy, ω): a rail has A = (n, 0), a blade, which grips the
floor, the normal of its edge; a pivot leaves only the turn about it, V = v + ω w with
w = (R sin, −R cos, 1) for an arm R from the centre.  See
:func:`puck_tables.scene.ingredients.held`.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    BLADE,
    FREE,
    PIVOT,
    RAIL,
    Surface,
    VelocityConstraint,
    floor_acceleration,
    floor_velocity,
)
from puck_tables.world.layout import (
    HOLD,
    HOLD_ANGLE,
    HOLD_PLACE,
    HOLD_REACH,
    HOLD_VX,
    HOLD_VY,
    HOLD_X,
    HOLD_Y,
    INV_INERTIA,
    INV_MASS,
)


@inlined
def constraint_on(disc: FloatArray) -> VelocityConstraint:
    """The constraint of a disc."""
    return VelocityConstraint(
        int(disc[HOLD]), disc[HOLD_X], disc[HOLD_Y], disc[HOLD_REACH], disc[HOLD_ANGLE],
        disc[HOLD_VX], disc[HOLD_VY],
    )  # fmt: skip


@inlined
def edge_of(disc: FloatArray, state: FloatArray) -> tuple[float, float]:
    """The way that a rail or a blade leaves free; of a pivot from the centre to it."""
    if int(disc[HOLD]) == RAIL:
        return disc[HOLD_Y], -disc[HOLD_X]
    return math.cos(state[THETA] + disc[HOLD_ANGLE]), math.sin(state[THETA] + disc[HOLD_ANGLE])


@inlined
def response(
    disc: FloatArray, state: FloatArray, px: float, py: float, turn: float
) -> tuple[float, float, float]:
    """The change of velocity and spin by an impulse and a moment of it."""
    light, turns, kind = disc[INV_MASS], disc[INV_INERTIA], int(disc[HOLD])
    if kind == FREE:
        return light * px, light * py, turns * turn
    ex, ey = edge_of(disc, state)
    if kind != PIVOT:
        along = light * (px * ex + py * ey)
        return along * ex, along * ey, turns * turn
    reach = disc[HOLD_REACH]
    spin = (turn + reach * (ey * px - ex * py)) / (1.0 / turns + reach * reach / light)
    return spin * reach * ey, -spin * reach * ex, spin


@inlined
def work_of_hold(
    disc: FloatArray, surface: Surface, state: FloatArray, px: float, py: float, turn: float
) -> float:
    """What a constraint that moves, or grips a floor that does, works where an impulse acts, J.

    What the puck gets beside the impulse is the constraint's, and A V is as before.
    """
    kind = int(disc[HOLD])
    if kind == FREE:
        return 0.0
    dx, dy, _ = response(disc, state, px, py, turn)
    wx, wy = disc[HOLD_VX], disc[HOLD_VY]
    if kind == BLADE:  # what it grips, and its own side slip across it
        ex, ey = edge_of(disc, state)
        sx, sy, _ = floor_velocity(surface, state[X], state[Y])
        wx, wy = sx - disc[HOLD_VX] * ey, sy + disc[HOLD_VX] * ex
    return (dx / disc[INV_MASS] - px) * wx + (dy / disc[INV_MASS] - py) * wy


@inlined
def led(
    disc: FloatArray, surface: Surface, state: FloatArray, ax: float, ay: float, turn: float
) -> tuple[float, float, float]:
    """Accelerations with the constraint, from those without it."""
    kind = int(disc[HOLD])
    if kind == FREE:
        return ax, ay, turn
    ex, ey = edge_of(disc, state)
    if kind == PIVOT:
        light, turns, reach = disc[INV_MASS], disc[INV_INERTIA], disc[HOLD_REACH]
        whole = 1.0 / turns + reach * reach / light
        alpha = (turn / turns + reach * (ey * ax - ex * ay) / light) / whole
        towards = reach * state[SPIN] * state[SPIN]
        return alpha * reach * ey + towards * ex, -alpha * reach * ex + towards * ey, alpha
    along, across = ax * ex + ay * ey, 0.0
    if kind == BLADE:
        across = _swing(surface, state, ex, ey)
    return along * ex - across * ey, along * ey + across * ex, turn


@inlined
def _swing(surface: Surface, state: FloatArray, ex: float, ey: float) -> float:
    """The acceleration across a blade, by which its side slip over the floor stays."""
    sx, sy, _ = floor_velocity(surface, state[X], state[Y])
    cx, cy = floor_acceleration(surface, state[X], state[Y], state[VX], state[VY])
    return state[SPIN] * (ex * (state[VX] - sx) + ey * (state[VY] - sy)) + ex * cy - ey * cx


@inlined
def forbid(
    disc: FloatArray, surface: Surface, t: float, state: FloatArray, rows: FloatArray,
    off: FloatArray,
) -> int:  # fmt: skip
    """The constraint of a disc as equations; how many, 0 to 2.

    ``rows`` (2, 3): A; ``off`` (2, 3): by how much the place is off it, A V − e, and what A V′ is
    to be.
    """
    kind = int(disc[HOLD])
    if kind == FREE:
        return 0
    ex, ey = edge_of(disc, state)
    wx, wy = disc[HOLD_VX], disc[HOLD_VY]
    if kind == PIVOT:
        reach, spin = disc[HOLD_REACH], state[SPIN]
        rows[0, 0], rows[0, 1], rows[0, 2] = 1.0, 0.0, -reach * ey
        rows[1, 0], rows[1, 1], rows[1, 2] = 0.0, 1.0, reach * ex
        off[0, 0] = state[X] + reach * ex - disc[HOLD_X] - wx * t
        off[1, 0] = state[Y] + reach * ey - disc[HOLD_Y] - wy * t
        off[0, 1] = state[VX] - reach * ey * spin - wx
        off[1, 1] = state[VY] + reach * ex * spin - wy
        off[0, 2], off[1, 2] = reach * ex * spin * spin, reach * ey * spin * spin
        return 2
    rows[0, 0], rows[0, 1], rows[0, 2] = -ey, ex, 0.0
    if kind == RAIL:
        drift = ex * wy - ey * wx
        off[0, 0] = ex * state[Y] - ey * state[X] - disc[HOLD_PLACE] - drift * t
        off[0, 1] = ex * state[VY] - ey * state[VX] - drift
        off[0, 2] = 0.0
        return 1
    sx, sy, _ = floor_velocity(surface, state[X], state[Y])
    off[0, 0] = 0.0  # a blade may be anywhere
    off[0, 1] = ex * (state[VY] - sy) - ey * (state[VX] - sx) - wx
    off[0, 2] = _swing(surface, state, ex, ey)
    return 1
