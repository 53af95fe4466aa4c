"""Forces on a puck besides dry friction, walls and constraints: given, drag, lateral.

Zero where a scene lacks them.  A new force over the floor is its entries in
:mod:`puck_tables.scene.parts`, and here its column, what it does, how strong it is at most, and
whether a motion under it has closed forms.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.over_time import prescribed_by
from puck_tables.scene.parts import Drag, Lateral

# numbers of what acts over the floor, over mass or inertia: drag by speed and spin, 1/s, by their
# squares, 1/m and 1; a lateral force at 1 m/s and 1 rad/s, m/s², and its exponents
SLIDING, SPINNING, QUADRATIC, SPIN_QUADRATIC, ACROSS, BY_SPEED, BY_SPIN = range(7)
DRAGS = 7  # how many
_FAINT = 1e-12  # 1/m: spin over speed that rounding makes of a launch without spin; has no sign
_STRAIGHT = 1e-12  # of a slowing by the square of the speed: less is none, log(1 + x)/x is 1


class Forces(NamedTuple):
    """Numbers of the forces.

    ``x``, ``y`` N, ``torque`` N m: constant, with gravity along the slope; ``drive``: rows of
    force and torque over time, and of friction (:mod:`puck_tables.scene.over_time`);
    ``drags`` (7,): of :func:`drags_of`.
    """

    x: float
    y: float
    torque: float
    drive: FloatArray
    drags: FloatArray


def drags_of(
    drag: Drag, lateral: Lateral, mass: float, inertia: float
) -> tuple[float, float, float, float, float, float, float]:
    """The numbers (7,) of what acts over the floor on a puck.

    >>> drags_of(Drag(sliding=0.1), Lateral(), 0.5, 1e-3)
    (0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """
    return (
        drag.sliding / mass, drag.spinning / inertia, drag.quadratic / mass,
        drag.spinning_quadratic / inertia, lateral.strength / mass, lateral.speed_exponent,
        lateral.spin_exponent,
    )  # fmt: skip


def is_stepped(drag: Drag, lateral: Lateral) -> bool:
    """Whether a motion under what acts over the floor has no closed form, as under drag it has.

    >>> is_stepped(Drag(), Lateral(0.1)), is_stepped(Drag(sliding=0.1), Lateral())
    (True, False)
    """
    return lateral.strength != 0.0


@inlined
def acts(row: FloatArray) -> bool:
    """Whether anything acts over the floor."""
    return (
        row[SLIDING] + row[QUADRATIC] + row[SPINNING] + row[SPIN_QUADRATIC] + abs(row[ACROSS]) > 0.0
    )


@inlined
def per_speed(row: FloatArray, speed: float) -> float:
    """Drag over mass and speed, 1/s."""
    return row[SLIDING] + row[QUADRATIC] * speed


@inlined
def per_change(row: FloatArray, speed: float) -> float:
    """How fast drag over mass grows with the speed, 1/s; more at higher speeds."""
    return row[SLIDING] + 2.0 * row[QUADRATIC] * speed


@inlined
def damping(row: FloatArray) -> float:
    """How fast, at most, drag that is no longer strong settles a slip, 1/s."""
    return row[SLIDING] + row[SPINNING]


@inlined
def farthest(row: FloatArray, speed: float) -> float:
    """How far drag alone lets a puck go at most, m."""
    return speed / row[SLIDING] if row[SLIDING] > 0.0 else math.inf


@inlined
def _damped(start: float, damping: float, wake: float, time: float) -> tuple[float, float]:
    """What v′ = −γ v − w |v| v leaves of a speed, as a share, and its path over that speed."""
    grown, start = -math.expm1(-damping * time) / damping if damping > 0.0 else time, abs(start)
    slowed = 1.0 + wake * start * grown
    length = math.log(slowed) / (wake * start) if wake * start * grown > _STRAIGHT else grown
    return math.exp(-damping * time) / slowed, length


@inlined
def damped(
    row: FloatArray, speed: float, w: float, time: float
) -> tuple[float, float, float, float]:
    """What drag alone leaves of a speed and the path over it, s; the same of a spin."""
    left, length = _damped(speed, row[SLIDING], row[QUADRATIC], time)
    turns, angle = _damped(w, row[SPINNING], row[SPIN_QUADRATIC], time)
    return left, length, turns, angle


@inlined
def dragged(
    row: FloatArray, ux: float, uy: float, w: float
) -> tuple[float, float, float, float, float]:
    """Accelerations by all that acts over the floor, and the power it takes over mass and inertia.

    Of drag (Chetaev's 2f₂); a lateral force takes none.
    """
    speed = math.sqrt(ux * ux + uy * uy)
    drag, turn_drag = per_speed(row, speed), row[SPINNING] + row[SPIN_QUADRATIC] * abs(w)
    side = sideways(row[ACROSS], row[BY_SPEED], row[BY_SPIN], speed, w)
    return (
        -drag * ux - side * uy,
        -drag * uy + side * ux,
        -turn_drag * w,
        drag * speed * speed,
        turn_drag * w * w,
    )


@inlined
def sideways(strength: float, by_speed: float, by_spin: float, speed: float, w: float) -> float:
    """A lateral force over the speed, to the left; none of what does not move, or not spin."""
    if strength == 0.0 or speed == 0.0 or not has_sign(w, speed):
        return 0.0
    side = math.copysign(1.0, w) * strength * speed**by_speed / speed
    return side if by_spin == 0.0 else side * abs(w) ** by_spin


@inlined
def has_sign(w: float, speed: float) -> bool:
    """Whether a spin, 1/s, of what slides at a speed, m/s, is more than rounding makes of none."""
    return abs(w) > _FAINT * speed


@inlined
def jumps(row: FloatArray) -> bool:
    """Whether a force jumps where the spin changes its sign."""
    return row[ACROSS] != 0.0 and row[BY_SPIN] < 1.0


@inlined
def prescribed_force(forces: Forces, piece: int, t: float) -> tuple[float, float, float]:
    """Given force and torque at a time, on the piece of the drive that ``piece`` rows precede."""
    fx, fy, torque = prescribed_by(forces.drive, piece, t)
    return forces.x + fx, forces.y + fy, forces.torque + torque
