"""Whether a puck at rest on its floor stays there, and which way it slips if it does not.

The floor holds the puck while no slip that walls and constraints allow gains energy: with the force
F and torque T that friction would have to hold, and the power D of dry friction at Q = 1 in the
direction φ (Salnikova, Treschev, Gallyamov 2012, section 6, at slip zero),

    F cos φ + (T/r) sin φ ≤ D(φ) = f N (cos²φ ρ_∥ + ½ sin²φ ρ_ω)   for every φ.

Without a torque this is F ≤ f N.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.equations import SPIN, THETA, VX, VY, X, Y, against_walls, dry_friction
from puck_tables.scene.ingredients import (
    FREE,
    PIVOT,
    RAIL,
    Body,
    Dry,
    Hold,
    Stretch,
    floor_acceleration,
    given_force,
)

FloatArray = npt.NDArray[np.float64]

_SLACK = 1e-12  # of f N: a demand this close to the limit is held
_ANGLES = 64


@inlined
def _held_pivot(
    dry: Dry, hold: Hold, radius: float, theta: float, fx: float, fy: float,
    torque: float, slip: FloatArray,
) -> bool:  # fmt: skip
    """The same where the only slip is a turn about the pivot: one direction, φ = atan(r/reach)."""
    cosine, sine = math.cos(theta + hold.angle), math.sin(theta + hold.angle)
    reach = hold.reach
    demand = torque - reach * (cosine * fy - sine * fx)
    size = math.hypot(reach, radius)
    _, _, _, heat = dry_friction(dry, radius, reach / size, 0.0, 1.0 / size)
    way = 1.0 if demand >= 0.0 else -1.0
    slip[0], slip[1] = way * reach * sine / size, -way * reach * cosine / size
    slip[2] = way / size
    return abs(demand) <= size * heat + _SLACK * dry.load * radius


@inlined
def _held_free(
    dry: Dry, radius: float, fx: float, fy: float, torque: float, slip: FloatArray
) -> bool:
    """The same where the puck may slip along the force and turn."""
    force = math.hypot(fx, fy)
    east, north = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    excess, best = -math.inf, 0.0
    low, high, count = 0.0, 0.5 * math.pi, (1 if torque == 0.0 else _ANGLES)
    for _ in range(1 if torque == 0.0 else 6):  # the best angle, six times closer looked at
        for i in range(count):
            phi = low + (high - low) * (i / max(count - 1, 1))
            cosine, sine = math.cos(phi), math.sin(phi)
            _, _, _, heat = dry_friction(dry, radius, cosine, 0.0, sine / radius)
            gain = force * cosine + abs(torque) / radius * sine - heat
            if gain > excess:
                excess, best = gain, phi
        width = (high - low) / max(count - 1, 1)
        low, high = max(best - width, 0.0), min(best + width, 0.5 * math.pi)
    way = 1.0 if torque >= 0.0 else -1.0
    slip[0], slip[1] = math.cos(best) * east, math.cos(best) * north
    slip[2] = way * math.sin(best) / radius
    return excess <= _SLACK * dry.load


@inlined
def _held_with(
    dry: Dry, hold: Hold, body: Body, theta: float, ax: float, ay: float,
    turning: float, fx: float, fy: float, torque: float, slip: FloatArray,
) -> bool:  # fmt: skip
    """By kind of constraint; a floor whose motion a constraint forbids never holds the puck."""
    if hold.kind == FREE:
        return _held_free(dry, body.radius, fx, fy, torque, slip)
    cosine, sine = math.cos(theta + hold.angle), math.sin(theta + hold.angle)
    if hold.kind == PIVOT:
        centripetal = turning * turning * hold.reach
        gap = math.hypot(ax - centripetal * cosine, ay - centripetal * sine)
        holds = _held_pivot(dry, hold, body.radius, theta, fx, fy, torque, slip)
        return holds and gap <= 1e-9 * math.hypot(ax, ay)
    ex, ey = (-hold.ay, hold.ax) if hold.kind == RAIL else (cosine, sine)
    along = fx * ex + fy * ey
    holds = _held_free(dry, body.radius, along * ex, along * ey, torque, slip)
    return holds and turning == 0.0


@kernel
def held_by_floor(stretch: Stretch, t: float, y: FloatArray, slip: FloatArray) -> bool:
    """Whether friction holds a puck at rest on the floor.

    ``slip`` (3,) becomes the direction (vx, vy, ω) in which it starts, scaled to Q = 1.
    """
    model = stretch.model
    body = model.body
    ax, ay = floor_acceleration(model.surface, y[X], y[Y])
    gx, gy, torque = given_force(model, stretch.piece, t)
    fx, fy = against_walls(stretch.leaning, gx - body.mass * ax, gy - body.mass * ay)
    return _held_with(
        stretch.dry, model.hold, body, y[THETA], ax, ay, model.surface.spin, fx, fy, torque, slip
    )


@kernel
def seed(y: FloatArray, slip: FloatArray, speed: float) -> None:
    """Start to slip: a relative velocity so small that it changes nothing else."""
    y[VX] += speed * slip[0]
    y[VY] += speed * slip[1]
    y[SPIN] += speed * slip[2]
