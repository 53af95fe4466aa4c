"""Forces on a puck besides dry friction, walls and constraints: given, drag, lateral.

All of them in one record, zero where a scene lacks them.  A new force is its entries in
:mod:`puck_tables.scene.parts`, and here its numbers, what it does, and how strong it is at most.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.quantities import FORCE_X, FORCE_Y, TIME, TORQUE
from puck_tables._core.read_columns import numbers_of
from puck_tables.kernels.compile import inlined
from puck_tables.scene.parts import Rows

if TYPE_CHECKING:
    from puck_tables.scene.scene_spec import SceneSpec


MAX_DRIVE = 1 << 26  # bytes of a file of forces


class Forces(NamedTuple):
    """Numbers of the forces.

    ``x``, ``y`` N, ``torque`` N m: constant, with gravity along the slope; ``drive``: rows (n, 4)
    of time, force and torque over time, straight between the rows and nothing before and after;
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


def forces_of(scene: SceneSpec) -> Forces:
    """The forces of a scene.

    Raises
    ------
    InputError
        If the forces over time are none.

    Examples
    --------
    >>> from puck_tables import Drag, Puck, Scene
    >>> forces_of(Scene(Puck(1.0), drag=Drag(sliding=0.5))).sliding
    0.5
    """
    puck, floor, force, drag = scene.puck, scene.floor, scene.force, scene.drag
    pull = puck.mass * puck.gravity * math.sin(floor.slope)
    return Forces(
        x=force.constant[0] + pull * math.cos(floor.downhill),
        y=force.constant[1] + pull * math.sin(floor.downhill),
        torque=force.torque,
        drive=drive_of(force.over_time) if force.over_time else np.empty((0, 4)),
        sliding=drag.sliding,
        spinning=drag.spinning,
        quadratic=drag.quadratic,
        quadratic_spin=drag.spinning_quadratic,
        across=scene.lateral.strength,
        by_speed=scene.lateral.speed_exponent,
        by_spin=scene.lateral.spin_exponent,
    )


def strongest(forces: Forces, radius: float, speed: FloatArray) -> FloatArray:
    """The largest force, or torque over the radius, at slips of these speeds, N (n,)."""
    drive = forces.drive
    given = max(
        math.hypot(forces.x, forces.y),
        abs(forces.torque) / radius,
        float(np.hypot(drive[:, 1], drive[:, 2]).max(initial=0.0)),
        float(np.abs(drive[:, 3]).max(initial=0.0)) / radius,
    )
    spin = speed / radius
    with np.errstate(over="ignore"):
        across = abs(forces.across) * speed**forces.by_speed * spin**forces.by_spin
    turning = spin * (forces.spinning + forces.quadratic_spin * spin) / radius
    drag = np.maximum(speed * (forces.sliding + forces.quadratic * speed), turning)
    return np.asarray(np.maximum(np.maximum(given, drag), across))


def impulse_over_time(forces: Forces, radius: float) -> tuple[float, float]:
    """What forces over time give in all, N s, and when they have ended, s."""
    drive = forces.drive
    if not len(drive):
        return 0.0, 0.0
    force = np.hypot(drive[:, 1], drive[:, 2]) + np.abs(drive[:, 3]) / radius
    return float(np.trapezoid(force, drive[:, 0])), max(float(drive[-1, 0]), 0.0)


def drive_of(given: str | Rows) -> FloatArray:
    """Rows (n, 4) of t, Fx, Fy and torque, given or from a CSV file; they may lack the torque.

    Raises
    ------
    InputError
        If it cannot be read, or is no such file.
    """
    numbers = numbers_of(given, (TIME, FORCE_X, FORCE_Y, TORQUE), 3, MAX_DRIVE, "force.over_time")
    numbers.refuse_unless_ascending("the times")
    rows = numbers.rows
    return np.pad(rows, ((0, 0), (0, 4 - rows.shape[1])))


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
    if strength == 0.0 or speed == 0.0 or w == 0.0:
        return 0.0
    side = math.copysign(1.0, w) * strength * speed**by_speed / speed
    return side if by_spin == 0.0 else side * abs(w) ** by_spin


@inlined
def jumps(forces: Forces) -> bool:
    """Whether a force jumps where the spin changes its sign."""
    return forces.across != 0.0 and forces.by_spin < 1.0


@inlined
def given_force(forces: Forces, piece: int, t: float) -> tuple[float, float, float]:
    """Given force and torque at a time, on the piece of the drive that ``piece`` rows precede."""
    fx, fy, torque = given_by(forces.drive, piece, t)
    return forces.x + fx, forces.y + fy, forces.torque + torque


@inlined
def given_by(drive: FloatArray, piece: int, t: float) -> tuple[float, float, float]:
    """Force and torque of rows over time alone, of which so many have passed."""
    if piece == 0 or piece == len(drive):
        return 0.0, 0.0, 0.0
    i, j = piece - 1, piece
    share = (t - drive[i, 0]) / (drive[j, 0] - drive[i, 0])
    return (
        drive[i, 1] + share * (drive[j, 1] - drive[i, 1]),
        drive[i, 2] + share * (drive[j, 2] - drive[i, 2]),
        drive[i, 3] + share * (drive[j, 3] - drive[i, 3]),
    )
