"""Forces on a puck besides dry friction, walls and constraints: given, drag, lateral.

All of them in one record, zero where a scene lacks them.  A new force is its entries in
:mod:`puck_tables.scene.parts`, and here its numbers, what it does, and how strong it is at most.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.over_time import given_by

_FAINT = 1e-12  # 1/m: spin over speed that rounding makes of a launch without spin; has no sign


class Forces(NamedTuple):
    """Numbers of the forces.

    ``x``, ``y`` N, ``torque`` N m: constant, with gravity along the slope; ``drive``: rows of
    force and torque over time, and of friction (:mod:`puck_tables.scene.over_time`);
    ``sliding`` kg/s, ``spinning`` N m s: drag per relative speed and spin; ``quadratic`` kg/m,
    ``quadratic_spin`` N m s²: per their squares; ``across`` N, ``by_speed``, ``by_spin``: strength
    and exponents of a lateral force.
    """

    x: float
    y: float
    torque: float
    drive: FloatArray
    sliding: float
    spinning: float
    quadratic: float
    quadratic_spin: float
    across: float
    by_speed: float
    by_spin: float


@inlined
def damping(forces: Forces, mass: float, inertia: float) -> float:
    """How fast, at most, drag settles a slip, 1/s."""
    return forces.sliding / mass + forces.spinning / inertia


@inlined
def drag_force(forces: Forces, ux: float, uy: float, w: float) -> tuple[float, float, float, float]:
    """Force, torque and the power they take (Chetaev's 2f₂) at velocities relative to the floor.

    Of drag, and of a lateral force, which takes none.
    """
    squared = ux * ux + uy * uy
    sliding = forces.sliding + forces.quadratic * math.sqrt(squared)
    spinning = forces.spinning + forces.quadratic_spin * abs(w)
    side = sideways(forces.across, forces.by_speed, forces.by_spin, math.sqrt(squared), w)
    return (
        -sliding * ux - side * uy,
        -sliding * uy + side * ux,
        -spinning * w,
        sliding * squared + spinning * w * w,
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
def jumps(forces: Forces) -> bool:
    """Whether a force jumps where the spin changes its sign."""
    return forces.across != 0.0 and forces.by_spin < 1.0


@inlined
def given_force(forces: Forces, piece: int, t: float) -> tuple[float, float, float]:
    """Given force and torque at a time, on the piece of the drive that ``piece`` rows precede."""
    fx, fy, torque = given_by(forces.drive, piece, t)
    return forces.x + fx, forces.y + fy, forces.torque + torque
