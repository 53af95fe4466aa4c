"""Equations of motion of a puck in a scene, in the laboratory, with the power of every ingredient.

With u, w the velocity and spin relative to the floor, Q = hypot(u, r w), sin φ = r w/Q, dry
friction is (Salnikova, Treschev, Gallyamov 2012, sections 4–6, with relative velocities)

    F = −f N (ρ_∥ u + sin φ ρ_⊥ u^⊥)/Q,   M = −½ f N r sin φ ρ_ω,   power −f N Q (cos²φ ρ_∥ +
    ½ sin²φ ρ_ω),

u^⊥ being u turned by +90°.  Given forces act on the centre, so the balance of moments that tilts
the pressure stays that of the free puck.  The state carries, beside position and velocity, the
energies: work of given forces, heat of dry friction, heat of viscous friction (2f₂
of Chetaev), work of moving supports and constraints (−f₁, and what dry friction and reactions do
at the velocity of their support).
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.equations import ratios_at
from puck_tables.scene.ingredients import (
    Body,
    Dry,
    Model,
    drag_force,
    drive_force,
    floor_acceleration,
    floor_velocity,
    held,
    pull_force,
)

FloatArray = npt.NDArray[np.float64]

SIZE = 10
X, Y, THETA, VX, VY, SPIN, GIVEN, DRY, VISCOUS, SUPPORT = range(SIZE)
LAMBDA = SIZE  # the two multipliers follow the state; they are not integrated
ROW = SIZE + 2


@inlined
def relative_velocity(model: Model, y: FloatArray) -> tuple[float, float, float]:
    """Velocity and spin of the puck relative to the floor under it."""
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    return y[VX] - sx, y[VY] - sy, y[SPIN] - sw


@kernel
def dry_friction(
    dry: Dry | None, radius: float, region: int, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor."""
    if dry is None:
        return 0.0, 0.0, 0.0, 0.0
    speed, rim = math.hypot(ux, uy), radius * abs(w)
    slip = math.hypot(speed, rim)
    if slip == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    fast = rim > speed
    ratio = speed / rim if fast else rim / speed
    inverse, across, turning = ratios_at(ratio, fast, dry.cuts[region], dry.delta[region])
    load = dry.load[region]
    sine = radius * w / slip
    push = -load / (inverse * slip)
    bend = across * sine
    cos2 = (speed / slip) * (speed / slip)
    return (
        push * (ux - bend * uy),
        push * (uy + bend * ux),
        -0.5 * load * radius * sine * turning / inverse,
        load * slip * (cos2 + 0.5 * sine * sine * turning) / inverse,
    )


@inlined
def against_walls(leaning: FloatArray, fx: float, fy: float) -> tuple[float, float]:
    """A force without what the walls that the puck leans on take up; rows of unit normals."""
    for _ in range(1 if leaning.shape[0] < 2 else 40):  # a corner: each wall turns it to the other
        for i in range(leaning.shape[0]):
            push = leaning[i, 0] * fx + leaning[i, 1] * fy
            if push < 0.0:
                fx -= push * leaning[i, 0]
                fy -= push * leaning[i, 1]
    return fx, fy


@inlined
def derivatives(
    t: float,
    inside: float,
    y: FloatArray,
    model: Model,
    region: int,
    leaning: FloatArray,
    out: FloatArray,
) -> None:
    """d/dt of the state while the puck slides, and λ, into ``out`` (12,)."""
    body = model.body
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    ux, uy, w = y[VX] - sx, y[VY] - sy, y[SPIN] - sw
    px, py, pm = pull_force(model.pull)
    qx, qy, qm = drive_force(model.drive, t, inside)
    gx, gy, gm = px + qx, py + qy, pm + qm
    hx, hy, hm, heat = dry_friction(model.dry, body.radius, region, ux, uy, w)
    vx, vy, vm, warmth = drag_force(model.drag, ux, uy, w)
    fx, fy, fm = gx + hx + vx, gy + hy + vy, gm + hm + vm
    if model.hold is None:
        fx, fy = against_walls(leaning, fx, fy)
    rx, ry, rm, first, second, power = held(
        model.hold, body, y[THETA], y[VX], y[VY], y[SPIN], fx, fy, fm
    )
    out[X], out[Y], out[THETA] = y[VX], y[VY], y[SPIN]
    out[VX] = (fx + rx) / body.mass
    out[VY] = (fy + ry) / body.mass
    out[SPIN] = (fm + rm) / body.inertia
    out[GIVEN] = gx * y[VX] + gy * y[VY] + gm * y[SPIN]
    out[DRY] = heat
    out[VISCOUS] = warmth
    out[SUPPORT] = (hx + vx) * sx + (hy + vy) * sy + (hm + vm) * sw + power
    out[LAMBDA], out[LAMBDA + 1] = first, second


@inlined
def carried_rates(t: float, inside: float, y: FloatArray, model: Model, out: FloatArray) -> None:
    """The same while the puck rests on the floor and is carried with it; λ is not determined."""
    body = model.body
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    ax, ay = floor_acceleration(model.surface, y[X], y[Y])
    px, py, pm = pull_force(model.pull)
    qx, qy, qm = drive_force(model.drive, t, inside)
    gx, gy, gm = px + qx, py + qy, pm + qm
    out[X], out[Y], out[THETA] = sx, sy, sw
    out[VX], out[VY], out[SPIN] = ax, ay, 0.0
    given = gx * sx + gy * sy + gm * sw
    out[GIVEN] = given
    out[DRY] = 0.0
    out[VISCOUS] = 0.0
    out[SUPPORT] = body.mass * (ax * sx + ay * sy) - given
    out[LAMBDA], out[LAMBDA + 1] = 0.0, 0.0


@kernel
def rates(
    t: float,
    inside: float,
    y: FloatArray,
    model: Model,
    region: int,
    leaning: FloatArray,
    carried: bool,
    out: FloatArray,
) -> None:
    """d/dt of the state, sliding or carried, into ``out`` (12,)."""
    if carried:
        carried_rates(t, inside, y, model, out)
    else:
        derivatives(t, inside, y, model, region, leaning, out)


@inlined
def kinetic_energy(body: Body, y: FloatArray) -> float:
    """½ m v² + ½ I ω²."""
    return 0.5 * body.mass * (y[VX] * y[VX] + y[VY] * y[VY]) + (
        0.5 * body.inertia * y[SPIN] * y[SPIN]
    )
