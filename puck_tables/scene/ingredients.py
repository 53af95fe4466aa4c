"""What may act on a puck, as the compiled loop reads it; what a scene lacks is None.

Branches on None are cut out when the loop is compiled, one loop for each set of ingredients, so
that an ingredient costs nothing where it is absent.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined

FloatArray = npt.NDArray[np.float64]

RAIL, PIVOT, BLADE = 0, 1, 2
NO_REACTION = (0.0, 0.0)


class Body(NamedTuple):
    """Mass in kg, moment of inertia about the vertical in kg m², radius in m."""

    mass: float
    inertia: float
    radius: float


class Dry(NamedTuple):
    """Dry friction in every region of the floor: f N, δ, and the friction ratios at that δ.

    ``load``, ``delta``: arrays (regions,); ``cuts``: (regions, …), see
    :func:`puck_tables.motion.equations.ratios_at`.
    """

    load: FloatArray
    delta: FloatArray
    cuts: FloatArray


class Surface(NamedTuple):
    """A floor that moves like a rigid body: velocity at a centre, m/s, and spin, rad/s."""

    vx: float
    vy: float
    cx: float
    cy: float
    spin: float


class Drag(NamedTuple):
    """Viscous drag: force per relative speed, kg/s, and torque per relative spin, N m s."""

    sliding: float
    spinning: float


class Pull(NamedTuple):
    """A constant force, N, and torque, N m."""

    x: float
    y: float
    torque: float


class Drive(NamedTuple):
    """Force and torque over time, straight between the given moments, nothing before and after."""

    time: FloatArray
    x: FloatArray
    y: FloatArray
    torque: FloatArray


class Hold(NamedTuple):
    """A linear constraint on the velocities.

    ``kind`` RAIL: the centre stays on a line with the unit normal (ax, ay).  PIVOT: the body point
    at distance ``reach`` and at ``angle`` in the body stays at a point, (ax, ay) at the launch.
    BLADE: no side slip along the body axis at ``angle``.  (vx, vy): velocity of rail or pivot;
    for the blade vx is the side slip, to the left.
    """

    kind: int
    ax: float
    ay: float
    reach: float
    angle: float
    vx: float
    vy: float


class Model(NamedTuple):
    """All of them; every one but the body may be None."""

    body: Body
    dry: Dry | None
    surface: Surface | None
    drag: Drag | None
    pull: Pull | None
    drive: Drive | None
    hold: Hold | None


@inlined
def floor_velocity(surface: Surface | None, x: float, y: float) -> tuple[float, float, float]:
    """Velocity and spin of the floor under the puck."""
    if surface is None:
        return 0.0, 0.0, 0.0
    return (
        surface.vx - surface.spin * (y - surface.cy),
        surface.vy + surface.spin * (x - surface.cx),
        surface.spin,
    )


@inlined
def floor_acceleration(surface: Surface | None, x: float, y: float) -> tuple[float, float]:
    """Acceleration of the point of the floor under the puck."""
    if surface is None:
        return 0.0, 0.0
    return (
        -surface.spin * (surface.vy + surface.spin * (x - surface.cx)),
        surface.spin * (surface.vx - surface.spin * (y - surface.cy)),
    )


@inlined
def knots_of(drive: Drive | None) -> FloatArray:
    """Moments at which the force has a corner."""
    if drive is None:
        return np.empty(0)
    return drive.time


@inlined
def drag_force(
    drag: Drag | None, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take (Chetaev's 2f₂) at velocities relative to the floor."""
    if drag is None:
        return 0.0, 0.0, 0.0, 0.0
    return (
        -drag.sliding * ux,
        -drag.sliding * uy,
        -drag.spinning * w,
        drag.sliding * (ux * ux + uy * uy) + drag.spinning * w * w,
    )


@inlined
def pull_force(pull: Pull | None) -> tuple[float, float, float]:
    """Constant force and torque."""
    if pull is None:
        return 0.0, 0.0, 0.0
    return pull.x, pull.y, pull.torque


@inlined
def drive_force(drive: Drive | None, t: float, inside: float) -> tuple[float, float, float]:
    """Force and torque at a time, on the piece that holds the moment ``inside``.

    A step ends at every knot; its stages all take the piece of the step's middle, so that a jump
    at a knot is seen from the right side.
    """
    if drive is None:
        return 0.0, 0.0, 0.0
    time = drive.time
    last = time.size - 1
    if inside < time[0] or inside > time[last]:
        return 0.0, 0.0, 0.0
    i = min(max(int(np.searchsorted(time, inside)) - 1, 0), last - 1)
    share = (t - time[i]) / (time[i + 1] - time[i])
    return (
        drive.x[i] + share * (drive.x[i + 1] - drive.x[i]),
        drive.y[i] + share * (drive.y[i + 1] - drive.y[i]),
        drive.torque[i] + share * (drive.torque[i + 1] - drive.torque[i]),
    )


@inlined
def held(
    hold: Hold | None,
    body: Body,
    theta: float,
    vx: float,
    vy: float,
    spin: float,
    fx: float,
    fy: float,
    torque: float,
) -> tuple[float, float, float, float, float, float]:
    """Force and torque of the constraint, its multipliers, and the power it puts in.

    With the constraint A V = e of the velocities V = (vx, vy, ω), the reaction is Aᵀλ with
    (A M⁻¹ Aᵀ) λ = −A M⁻¹ F − A′ V (Chetaev, eq. 2.3 and 2.4); its power is λ e.
    """
    if hold is None:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if hold.kind == RAIL:
        reaction = -(hold.ax * fx + hold.ay * fy)
        power = reaction * (hold.ax * hold.vx + hold.ay * hold.vy)
        return reaction * hold.ax, reaction * hold.ay, 0.0, reaction, 0.0, power
    cosine, sine = math.cos(theta + hold.angle), math.sin(theta + hold.angle)
    if hold.kind == BLADE:
        # n = (−sin, cos), n′ V = −ω (cos, sin)·v
        reaction = sine * fx - cosine * fy + body.mass * spin * (cosine * vx + sine * vy)
        return -reaction * sine, reaction * cosine, 0.0, reaction, 0.0, reaction * hold.vx
    # the pivot: in axes along and across the arm only one multiplier meets the inertia
    reach = hold.reach
    along = -(cosine * fx + sine * fy) + body.mass * spin * spin * reach
    push = cosine * fy - sine * fx
    compliance = 1.0 / body.mass + reach * reach / body.inertia
    across = -(push / body.mass + reach * torque / body.inertia) / compliance
    rx, ry = along * cosine - across * sine, along * sine + across * cosine
    return rx, ry, reach * across, rx, ry, rx * hold.vx + ry * hold.vy
