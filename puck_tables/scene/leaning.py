"""Sustained contact with straight cushions: what walls do to a puck that leans on them.

It is the limit of small rebounds: a reaction N ≥ 0 that takes the force towards the wall, and
Coulomb's friction at the rim, −μ N against its slip, or what keeps it still if that is less.

One wall bears the puck where it alone keeps it out of all others.  Else two do, in a corner, where
the centre can go nowhere: there the reactions N₁, N₂ and the rim forces T₁, T₂ have to balance the
force, and r (T₁ + T₂) bears a torque.  Of all (T₁, T₂) within |T_i| ≤ μ_i N_i, a convex region, the
corners tell what torques are borne, and the directions in which it is unbounded: there the rims
lock the puck between the walls.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.cushions import push_rim, rim_compliance, rim_slip
from puck_tables.scene.friction import SPIN, VX, VY, X, Y, size
from puck_tables.scene.ingredients import Body

# columns of a wall that the puck leans on: its normal, where its centre then is, the friction
# coefficient at the rim, and −1, 0, 1: the rim slides back, rolls, on
NX, NY, PLACE, GRIP, RIM = range(5)
LEAN_COLUMNS = 5
LOCKS = 1e12  # as good as an infinite friction coefficient

_LEVEL = 1e-15  # of a force: as good as none
_CLOSE = 1e-12  # of a force: what rounding in a corner may leave


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
def push_of(lean: FloatArray, mass: float, ax: float, ay: float, fx: float, fy: float) -> float:
    """The force on a wall; none where the puck, bound to go on at (ax, ay), leaves it."""
    if mass * (lean[NX] * ax + lean[NY] * ay) > _CLOSE * size(fx, fy, 0.0):
        return 0.0
    push = -(lean[NX] * fx + lean[NY] * fy)
    return push if push > _LEVEL * size(fx, fy, 0.0) else 0.0


@inlined
def wall_reaction(
    body: Body, leaning: FloatArray, ax: float, ay: float, fx: float, fy: float, torque: float
) -> tuple[float, float, float]:
    """Force and torque of the walls that the puck leans on, rows (n, 5), against what acts.

    (ax, ay): how the velocity changes where that is known, as for a puck at rest on its floor.
    """
    count, level = leaning.shape[0], _LEVEL * size(fx, fy, 0.0)
    pushed = 0
    for i in range(count):
        push = push_of(leaning[i], body.mass, ax, ay, fx, fy)
        if push == 0.0:
            continue
        pushed += 1
        nx, ny = leaning[i, NX], leaning[i, NY]
        along = _rim_force(body, leaning[i], push, fx, fy, torque)
        rx, ry = push * nx - along * ny, push * ny + along * nx
        free = True
        for j in range(count):
            other = leaning[j, NX] * (fx + rx) + leaning[j, NY] * (fy + ry)
            free = free and (j == i or other >= -level)
        if free:
            return rx, ry, -body.radius * along
    if pushed == 0:
        return 0.0, 0.0, 0.0
    for i in range(count):
        for j in range(i + 1, count):
            holds, turning = _corner(body, leaning[i], leaning[j], fx, fy, torque)
            if holds:
                return -fx, -fy, turning
    return -fx, -fy, 0.0  # between more walls than two: held


@inlined
def _corner(
    body: Body, one: FloatArray, other: FloatArray, fx: float, fy: float, torque: float
) -> tuple[bool, float]:
    """Whether two walls hold a puck in their corner, and their torque."""
    side = one[RIM] if one[RIM] != 0.0 else other[RIM]
    if side == 0.0:
        holds, low, high = still_torques(one, other, fx, fy)
        needed = torque / body.radius
        if not holds or low <= needed <= high:
            return holds, -torque
        side = -1.0 if needed > high else 1.0  # it turns on: both rims slide
        share = low if needed < low else high
    else:
        share = 0.0
    slides, first, second = _pressed(one, side, other, side, fx, fy)
    if slides:
        share = -side * (first + second)
    return slides or one[RIM] == other[RIM] == 0.0, -body.radius * share


@inlined
def _pressed(
    one: FloatArray, side: float, other: FloatArray, flank: float, fx: float, fy: float
) -> tuple[bool, float, float]:
    """Rim forces of two walls that hold a force while both rims are at their limit, slipping so.

    Whether both walls then push.
    """
    slide, glide = side * one[GRIP], flank * other[GRIP]
    first, second = size(1.0, slide, 0.0), size(1.0, glide, 0.0)
    ax, ay = (one[NX] + slide * one[NY]) / first, (one[NY] - slide * one[NX]) / first
    bx, by = (other[NX] + glide * other[NY]) / second, (other[NY] - glide * other[NX]) / second
    det = ax * by - ay * bx
    if abs(det) <= _CLOSE:
        return False, 0.0, 0.0
    push, press = (bx * fy - by * fx) / det, (ay * fx - ax * fy) / det
    slack = -_CLOSE * size(fx, fy, 0.0)
    return (
        push >= slack and press >= slack,
        max(push, 0.0) * (one[GRIP] / first),
        max(press, 0.0) * (other[GRIP] / second),
    )


@inlined
def _alone(lean: FloatArray, fx: float, fy: float) -> tuple[bool, float]:
    """Whether one wall holds a force within its friction, and its rim force."""
    push, along = -(lean[NX] * fx + lean[NY] * fy), lean[NY] * fx - lean[NX] * fy
    return abs(along) <= lean[GRIP] * push + _CLOSE * size(fx, fy, 0.0), along


@inlined
def still_torques(
    one: FloatArray, other: FloatArray, fx: float, fy: float
) -> tuple[bool, float, float]:
    """Whether two walls balance a force on a puck at rest, and T₁ + T₂, at least and at most."""
    holds, low, high = False, math.inf, -math.inf
    for i in range(4):
        side, flank = 1.0 - 2.0 * (i % 2), 1.0 - 2.0 * (i // 2)
        good, first, second = _pressed(one, side, other, flank, fx, fy)
        if good:
            both = -side * first - flank * second
            holds, low, high = True, min(low, both), max(high, both)
    for i in range(2):
        good, along = _alone(one if i == 0 else other, fx, fy)
        if good:
            holds, low, high = True, min(low, along), max(high, along)
    for i in range(4):  # a limit of one wall's friction against which the other can push
        wall, facing = (one, other) if i < 2 else (other, one)
        slide = (1.0 - 2.0 * (i % 2)) * wall[GRIP]
        whole = size(1.0, slide, 0.0)
        ex, ey = (wall[NX] + slide * wall[NY]) / whole, (wall[NY] - slide * wall[NX]) / whole
        push = -(facing[NX] * ex + facing[NY] * ey)
        along = facing[NY] * ex - facing[NX] * ey
        if push > _CLOSE and abs(along) <= facing[GRIP] * push:
            low = -math.inf if along < slide / whole else low
            high = math.inf if along > slide / whole else high
    return holds, low, high


@inlined
def keep_on(
    body: Body, leaning: FloatArray, first: tuple[float, float, float],
    last: tuple[float, float, float], level: float, y: FloatArray, dx: int,
) -> None:  # fmt: skip
    """Put a state in the laboratory back onto the walls that the puck leans on: it is rounding.

    ``first``, ``last``: accelerations ax, ay, α at both ends of the step; below ``level`` they are
    none, and the wall pushes, or the rim rolls.  ``dx``: where in ``y`` the way of the step stands.
    """
    held, corner, still = -1, False, False
    for i in range(leaning.shape[0]):
        nx, ny = leaning[i, NX], leaning[i, NY]
        lifts = max(nx * first[0] + ny * first[1], nx * last[0] + ny * last[1])
        speed = nx * y[VX] + ny * y[VY]
        if lifts <= level or speed < 0.0:
            y[VX] -= speed * nx
            y[VY] -= speed * ny
        if lifts > level:
            continue
        crosses = held >= 0 and abs(nx * leaning[held, NY] - ny * leaning[held, NX]) > _CLOSE
        held, corner = i, corner or crosses
        off = nx * y[X] + ny * y[Y] - leaning[i, PLACE]
        if abs(off) > 4e-16 * (abs(nx * y[X]) + abs(ny * y[Y]) + abs(leaning[i, PLACE])):
            y[X] -= off * nx
            y[Y] -= off * ny
            y[dx] -= off * nx
            y[dx + 1] -= off * ny
        if leaning[i, GRIP] > 0.0 and leaning[i, RIM] == 0.0:
            start = abs(rim_slip(body, nx, ny, first[0], first[1], first[2]))
            if max(start, abs(rim_slip(body, nx, ny, last[0], last[1], last[2]))) <= level:
                push_rim(body, nx, ny, -rim_slip(body, nx, ny, y[VX], y[VY], y[SPIN]), y)
                still = True
    if corner:  # there is nowhere to go, and a rim that rolls stands still
        y[VX] = y[VY] = 0.0
        y[SPIN] = 0.0 if still else y[SPIN]


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
