"""A puck against straight cushions: impacts, and sustained contact.

With n the unit normal of the wall, into the field, and τ = (−n_y, n_x), the rim touches the wall at
−r n and slides along it with u = v·τ − r ω.  The impulses of an impact are

    P_n = −(1 + e) m v·n,    P_τ = −(1 + e_τ) u/(1/m + r²/I),   |P_τ| ≤ μ P_n,

e the restitution, e_τ the tangential one (−1: a smooth wall, 0: the rim rolls off, 1: u reversed),
μ the friction of the cushion.  They act at the rim, so v and ω change by P/m and −r P_τ/I.

Sustained contact is the limit of small rebounds: a reaction N ≥ 0 that takes the force towards the
wall, and Coulomb's friction at the rim, −μ N against u, or what keeps u = 0 if that is less.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined
from puck_tables.scene.friction import SPIN, VX, VY, size
from puck_tables.scene.ingredients import Body

FloatArray = npt.NDArray[np.float64]

# columns of a wall (its place moved in by the radius), and of a wall that the puck leans on
NX, NY, PLACE, RESTITUTION, TANGENTIAL, FRICTION = range(6)
GRIP, RIM = 2, 3  # the friction coefficient at the rim; −1, 0, 1: the rim slides back, rolls, on
LEAN_COLUMNS = 4

_LEVEL = 1e-15  # of a force: as good as none


@inlined
def rebound(body: Body, wall: FloatArray, y: FloatArray) -> None:
    """Velocity and spin of the state ``y``, in the laboratory, after the impact."""
    nx, ny = wall[NX], wall[NY]
    normal = (1.0 + wall[RESTITUTION]) * body.mass * max(-(nx * y[VX] + ny * y[VY]), 0.0)
    slip = rim_slip(body, nx, ny, y[VX], y[VY], y[SPIN])
    along = -(1.0 + wall[TANGENTIAL]) * slip / rim_compliance(body)
    along = min(max(along, -wall[FRICTION] * normal), wall[FRICTION] * normal)
    y[VX] += (normal * nx - along * ny) / body.mass
    y[VY] += (normal * ny + along * nx) / body.mass
    y[SPIN] -= body.radius * along / body.inertia


@inlined
def rim_slip(body: Body, nx: float, ny: float, vx: float, vy: float, spin: float) -> float:
    """How fast the rim slides along a wall."""
    return nx * vy - ny * vx - body.radius * spin


@inlined
def rim_compliance(body: Body) -> float:
    """Change of the rim's slip for each unit of impulse along the wall."""
    return 1.0 / body.mass + body.radius * body.radius / body.inertia


@inlined
def _rim_force(
    body: Body, lean: FloatArray, push: float, fx: float, fy: float, torque: float
) -> float:
    """Friction along a wall that pushes with ``push`` while (fx, fy, torque) act on the puck."""
    most = lean[GRIP] * push
    if lean[RIM] != 0.0:
        return -lean[RIM] * most
    along = lean[NX] * fy - lean[NY] * fx
    rolls = body.radius * torque / body.inertia - along / body.mass
    return min(max(rolls / rim_compliance(body), -most), most)


@inlined
def wall_reaction(
    body: Body, leaning: FloatArray, fx: float, fy: float, torque: float
) -> tuple[float, float, float]:
    """Force and torque of the walls that the puck leans on, rows (n, 4), against what acts.

    One wall, if it alone keeps the puck out of all; else two, which hold it.
    """
    count, level = leaning.shape[0], _LEVEL * size(fx, fy, 0.0)
    pushed = False
    for i in range(count):
        nx, ny = leaning[i, NX], leaning[i, NY]
        push = -(nx * fx + ny * fy)
        if push <= 0.0:
            continue
        pushed = True
        along = _rim_force(body, leaning[i], push, fx, fy, torque)
        rx, ry = push * nx - along * ny, push * ny + along * nx
        free = True
        for j in range(count):
            other = leaning[j, NX] * (fx + rx) + leaning[j, NY] * (fy + ry)
            free = free and (j == i or other >= -level)
        if free:
            return rx, ry, -body.radius * along
    if not pushed:
        return 0.0, 0.0, 0.0
    for i in range(count):
        for j in range(i + 1, count):
            first, second = _corner(leaning[i], leaning[j], fx, fy)
            if first >= -level and second >= -level:
                grip = leaning[i, GRIP] * max(first, 0.0) + leaning[j, GRIP] * max(second, 0.0)
                side = leaning[i, RIM]
                if side == 0.0:  # it neither moves nor turns, up to what the rim can bear
                    turning = min(max(-torque, -body.radius * grip), body.radius * grip)
                else:
                    turning = side * body.radius * grip
                return -fx, -fy, turning
    return -fx, -fy, 0.0  # between more walls than two: held


@inlined
def _corner(one: FloatArray, other: FloatArray, fx: float, fy: float) -> tuple[float, float]:
    """Reactions of two walls that hold a puck against a force, friction at both rims included."""
    slide, glide = one[RIM] * one[GRIP], other[RIM] * other[GRIP]
    ax, ay = one[NX] + slide * one[NY], one[NY] - slide * one[NX]
    bx, by = other[NX] + glide * other[NY], other[NY] - glide * other[NX]
    det = ax * by - ay * bx
    if abs(det) <= _LEVEL * size(ax, ay, 0.0) * size(bx, by, 0.0):
        return -1.0, -1.0
    return (bx * fy - by * fx) / det, (ay * fx - ax * fy) / det


@inlined
def keep_out(leaning: FloatArray, y: FloatArray) -> None:
    """Take the velocity, in the laboratory, into walls that the puck leans on: it is rounding."""
    for i in range(leaning.shape[0]):
        off = min(leaning[i, NX] * y[VX] + leaning[i, NY] * y[VY], 0.0)
        y[VX] -= off * leaning[i, NX]
        y[VY] -= off * leaning[i, NY]


@inlined
def come_to_lean(leaning: FloatArray, y: FloatArray) -> None:
    """Take the velocity, in the laboratory, towards and away from walls that the puck leans on."""
    nx, ny = leaning[0, NX], leaning[0, NY]
    off = nx * y[VX] + ny * y[VY]
    y[VX] -= off * nx
    y[VY] -= off * ny
    for i in range(1, leaning.shape[0]):
        if abs(nx * leaning[i, NY] - ny * leaning[i, NX]) > 1e-12:  # a corner: nowhere to go
            y[VX] = y[VY] = 0.0
