"""What may act on a puck, as compiled code reads it; what a scene lacks is zero, or empty.

One code serves every scene, so that it is compiled once.  Zeros change no bit of a sum, and beside
the friction law they cost nothing that can be measured.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import cosine_sine_of
from puck_tables.scene.floor_map import (
    ANGLE,
    BELTS,
    COSINE,
    PLACE_X,
    PLACE_Y,
    SHARE,
    SINE,
    TURNED,
    TURNING,
    parts_in,
    set_factor,
)
from puck_tables.scene.forces import Forces
from puck_tables.scene.over_time import (
    FLOOR_SPIN,
    FLOOR_X,
    FLOOR_Y,
    ON_ALL,
    ON_PART,
    has_factors,
    held_at,
    rate_at,
    turned_at,
)

if TYPE_CHECKING:
    from puck_tables.scene.parts import Constraint, Launch

FREE, RAIL, PIVOT, BLADE = range(4)
SLIDES, STICKING, STOPS = range(3)
# in place of a normal force: where a base lies on several frictions; times as much where they hold
SUMMED = -1.0
NO_DIRECTION = (0.0, 0.0, 0.0, 0.0)  # of a stretch that is no stop


class Body(NamedTuple):
    """Mass in kg, moment of inertia about the vertical in kg m², radius in m."""

    mass: float
    inertia: float
    radius: float


class BySpeed(NamedTuple):
    """Friction that depends on the slip speed, or on its direction; no ``normal``: there is none.

    ``table``: see :func:`puck_tables.kernels.speed_spline.packed`, or of the direction
    :func:`puck_tables.scene.orthotropic.ellipse_in`; ``height_ratio``: 2h/r
    over 4⟨x²⟩/r², which is 1 under uniform pressure;
    ``normal``: N; ``moving``: 1, or 0 for the friction at slip zero.
    """

    table: FloatArray
    height_ratio: float
    normal: float
    moving: float


class Regions(NamedTuple):
    """Dry friction in every region of the floor: f N, δ, and the friction ratios at that δ.

    ``load``, ``delta``: arrays (regions,); ``limits``: (regions, …), see
    :func:`puck_tables.motion.equations_of_motion.ratios_at`; ``by_speed`` takes the place of all.
    ``astride`` (regions,): where the base lies on several frictions of the ``floor_map``, see
    :mod:`puck_tables.scene.base_on_floor`, or is not round; there load and δ are the largest of
    them.  A run has its own ground, in which it says where the base is.  ``laws`` (discs, 2): where
    the table by speed of a disc begins and ends in that of ``by_speed``.
    """

    load: FloatArray
    delta: FloatArray
    limits: FloatArray
    by_speed: BySpeed
    summed: npt.NDArray[np.bool_]
    floor_map: FloatArray
    laws: npt.NDArray[np.int64]


class DryFriction(NamedTuple):
    """Dry friction in one region; no load: none.

    Of a base astride several frictions, or of one that is not round, ``by_speed.table`` is their
    ground and its ``normal`` is SUMMED: a record of its own would be handed on with every call,
    which costs all scenes more.
    """

    load: float
    delta: float
    limits: FloatArray
    by_speed: BySpeed


@inlined
def is_mixed(friction: DryFriction) -> bool:
    """Whether the base lies on several frictions, or is not round."""
    return friction.by_speed.normal < 0.0


@inlined
def is_over_belts(friction: DryFriction) -> bool:
    """Whether velocities of the floor differ, so that parts of a base may slip each its own way."""
    return is_mixed(friction) and friction.by_speed.table[BELTS] != 0.0


@inlined
def put_at(friction: DryFriction, x: float, y: float, angle: float) -> None:
    """Put the base at a place, turned, which matters where it is astride, or not round."""
    if is_mixed(friction):
        floor_map = friction.by_speed.table
        floor_map[PLACE_X], floor_map[PLACE_Y], floor_map[ANGLE] = x, y, angle
        floor_map[COSINE], floor_map[SINE] = cosine_sine_of(angle)


@inlined
def changes_over_time(friction: DryFriction, drive: FloatArray) -> bool:
    """Whether dry friction is another at another time, where all else is the same."""
    if is_mixed(friction) and friction.by_speed.table[TURNING] != 0.0:
        return True
    return has_factors(drive)


@inlined
def friction_at(friction: DryFriction, drive: FloatArray, piece: int, t: float) -> DryFriction:
    """The dry friction at a time, on the piece of what is given over time that rows precede."""
    law, factor = friction.by_speed, 1.0
    if has_factors(drive):
        factor = held_at(drive, piece, ON_ALL, t)
    height_ratio, normal = factor * law.height_ratio, factor * law.normal
    if is_mixed(friction):
        height_ratio, normal = law.height_ratio, law.normal
        law.table[TURNED] = law.table[TURNING] * t
        if has_factors(drive):
            law.table[TURNED] += turned_at(drive, piece, t)
            law.table[SHARE] = factor
            for phase in range(parts_in(law.table)):
                set_factor(law.table, phase, held_at(drive, piece, ON_PART + phase, t))
    return DryFriction(
        factor * friction.load, factor * friction.delta, friction.limits,
        BySpeed(law.table, height_ratio, normal, law.moving),
    )  # fmt: skip


class Surface(NamedTuple):
    """A floor that moves like a rigid body: velocity at a centre, m/s, and spin, rad/s.

    And how fast they change, m/s², rad/s².  ``changes``: 1 if they do, as rows over time say, else
    0; ``static``: by what friction holds more at rest than it brakes.
    """

    vx: float
    vy: float
    cx: float
    cy: float
    spin: float
    ax: float
    ay: float
    turn: float
    changes: float
    static: float


@inlined
def surface_at(surface: Surface, drive: FloatArray, piece: int, t: float) -> Surface:
    """How a floor moves at a time, on the piece of what is given over time that rows precede."""
    if surface.changes == 0.0 or len(drive) == 0:
        return surface
    return Surface(
        held_at(drive, piece, FLOOR_X, t), held_at(drive, piece, FLOOR_Y, t), surface.cx,
        surface.cy, held_at(drive, piece, FLOOR_SPIN, t), rate_at(drive, piece, FLOOR_X),
        rate_at(drive, piece, FLOOR_Y), rate_at(drive, piece, FLOOR_SPIN), 1.0, surface.static,
    )  # fmt: skip


class VelocityConstraint(NamedTuple):
    """A linear constraint on the velocities.

    ``kind`` FREE: none.  RAIL: the centre stays on a line with the unit normal (ax, ay).  PIVOT:
    the body point at distance ``reach`` and at ``angle`` in the body stays at a point, (ax, ay) at
    the launch.  BLADE: no side slip over the floor along the body axis at ``angle``.  (vx, vy):
    velocity of rail or pivot; for the blade vx is the side slip, to the left.
    """

    kind: int
    ax: float
    ay: float
    reach: float
    angle: float
    vx: float
    vy: float


class Model(NamedTuple):
    """All of them but dry friction and walls."""

    body: Body
    surface: Surface
    forces: Forces
    hold: VelocityConstraint


class Phase(NamedTuple):
    """What acts between two events.

    ``piece``: how many rows of ``forces.drive`` have passed; ``mode`` SLIDES, STICKING (at rest on
    the floor), STOPS: with the constant relative acceleration direction[3] times direction[:3];
    ``newton``: 0 for explicit steps; for implicit ones, where the slip settles much faster than it
    changes, how well to solve their equations, in units of the scales.
    """

    model: Model
    friction: DryFriction
    piece: int
    mode: int
    direction: tuple[float, float, float, float]
    newton: float


def hold_of(hold: Constraint | None, launch: Launch) -> VelocityConstraint:
    """The constraint, fixed to where the puck is launched.

    >>> from puck_tables import Constraint, Launch
    >>> hold_of(Constraint("pivot", reach=0.5), Launch()).ax
    0.5
    """
    if hold is None:
        return VelocityConstraint(FREE, *[0.0] * 6)
    if hold.kind == "rail":
        nx, ny = -math.sin(hold.angle), math.cos(hold.angle)
        return VelocityConstraint(RAIL, nx, ny, 0.0, 0.0, *hold.velocity)
    if hold.kind == "blade":
        return VelocityConstraint(BLADE, 0.0, 0.0, 0.0, hold.angle, hold.side_slip, 0.0)
    bearing = launch.orientation + hold.angle
    ex, ey = math.cos(bearing), math.sin(bearing)
    x, y = launch.position
    return VelocityConstraint(
        PIVOT, x + hold.reach * ex, y + hold.reach * ey, hold.reach, hold.angle, *hold.velocity
    )


@inlined
def floor_velocity(surface: Surface, x: float, y: float) -> tuple[float, float, float]:
    """Velocity and spin of the floor under the puck."""
    return (
        surface.vx - surface.spin * (y - surface.cy),
        surface.vy + surface.spin * (x - surface.cx),
        surface.spin,
    )


@inlined
def floor_acceleration(
    surface: Surface, x: float, y: float, vx: float, vy: float
) -> tuple[float, float]:  # fmt: skip
    """How fast the velocity of the floor under a puck changes while the puck moves at (vx, vy)."""
    return (
        surface.ax - surface.turn * (y - surface.cy) - surface.spin * vy,
        surface.ay + surface.turn * (x - surface.cx) + surface.spin * vx,
    )


@inlined
def surface_now(phase: Phase, t: float) -> Surface:
    """How the floor of a stretch moves at a time."""
    model = phase.model
    return surface_at(model.surface, model.forces.drive, phase.piece, t)


@inlined
def held(
    hold: VelocityConstraint, body: Body, surface: Surface, y: FloatArray,
    fx: float, fy: float, torque: float,
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """Force and torque of the constraint, its multipliers, and the power it puts in.

    With the constraint A V = e of the velocities V = (vx, vy, ω), the reaction is Aᵀλ with
    (A M⁻¹ Aᵀ) λ = −A M⁻¹ F − A′ V (Chetaev, eq. 2.3 and 2.4); its power is λ e.  Rail and pivot
    stand in the laboratory; a blade grips the floor, so its V and e are relative to it.
    """
    if hold.kind == FREE:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if hold.kind == RAIL:
        reaction = -(hold.ax * fx + hold.ay * fy)
        power = reaction * (hold.ax * hold.vx + hold.ay * hold.vy)
        return reaction * hold.ax, reaction * hold.ay, 0.0, reaction, 0.0, power
    cosine, sine = math.cos(y[2] + hold.angle), math.sin(y[2] + hold.angle)
    spin = y[5] + surface.spin
    if hold.kind == BLADE:
        # n = (−sin, cos), n′ u = −ω (cos, sin)·u
        sx, sy, _ = floor_velocity(surface, y[0], y[1])
        cx, cy = floor_acceleration(surface, y[0], y[1], y[3] + sx, y[4] + sy)
        swing = spin * (cosine * y[3] + sine * y[4])
        reaction = sine * fx - cosine * fy + body.mass * (swing - sine * cx + cosine * cy)
        power = reaction * (hold.vx - sine * sx + cosine * sy)
        return -reaction * sine, reaction * cosine, 0.0, reaction, 0.0, power
    # the pivot: in axes along and across the arm only one multiplier meets the inertia
    reach = hold.reach
    along = -(cosine * fx + sine * fy) + body.mass * spin * spin * reach
    push = cosine * fy - sine * fx
    compliance = 1.0 / body.mass + reach * reach / body.inertia
    across = -(push / body.mass + reach * torque / body.inertia) / compliance
    rx, ry = along * cosine - across * sine, along * sine + across * cosine
    return rx, ry, reach * across, rx, ry, rx * hold.vx + ry * hold.vy
