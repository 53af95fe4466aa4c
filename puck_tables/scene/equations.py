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
    Stretch,
    drag_force,
    floor_acceleration,
    floor_velocity,
    given_force,
    held,
)

FloatArray = npt.NDArray[np.float64]

SIZE = 10
X, Y, THETA, VX, VY, SPIN, GIVEN, DRY, VISCOUS, SUPPORT = range(SIZE)
LAMBDA = SIZE  # the two multipliers follow the state; they are not integrated
ROW = SIZE + 2


@inlined
def slip_speed(model: Model, y: FloatArray) -> float:
    """Q relative to the floor under the puck."""
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    return _size(y[VX] - sx, y[VY] - sy, model.body.radius * (y[SPIN] - sw))


@inlined
def slip_rate(model: Model, y: FloatArray, work: FloatArray) -> float:
    """The size of the change of the relative velocity, from d/dt of the state in work[0]."""
    turning = model.surface.spin  # under a puck that moves the floor changes its velocity too
    return _size(
        work[0, VX] + turning * y[VY],
        work[0, VY] - turning * y[VX],
        model.body.radius * work[0, SPIN],
    )


@inlined
def _size(a: float, b: float, c: float) -> float:
    return math.sqrt(a * a + b * b + c * c)  # the scales of a scene keep squares in range


@kernel
def dry_friction(
    dry: Dry, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor."""
    load, rim = dry.load, radius * abs(w)
    slip = _size(ux, uy, rim)
    if load == 0.0 or slip == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    speed = _size(ux, uy, 0.0)
    fast = rim > speed
    ratio = speed / rim if fast else rim / speed
    inverse, across, turning = ratios_at(ratio, fast, dry.cut, dry.delta)
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


@kernel
def rates(stretch: Stretch, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """d/dt of the state and λ into out[row] (12,), sliding or carried; then λ is not determined."""
    model = stretch.model
    body = model.body
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    gx, gy, gm = given_force(model, stretch.piece, t)
    if stretch.carried:
        ax, ay = floor_acceleration(model.surface, y[X], y[Y])
        out[row, X], out[row, Y], out[row, THETA] = sx, sy, sw
        out[row, VX], out[row, VY], out[row, SPIN] = ax, ay, 0.0
        given = gx * sx + gy * sy + gm * sw
        out[row, GIVEN], out[row, DRY], out[row, VISCOUS] = given, 0.0, 0.0
        out[row, SUPPORT] = body.mass * (ax * sx + ay * sy) - given
        out[row, LAMBDA], out[row, LAMBDA + 1] = 0.0, 0.0
        return
    ux, uy, w = y[VX] - sx, y[VY] - sy, y[SPIN] - sw
    hx, hy, hm, heat = dry_friction(stretch.dry, body.radius, ux, uy, w)
    vx, vy, vm, warmth = drag_force(model.drag, ux, uy, w)
    fx, fy, fm = gx + hx + vx, gy + hy + vy, gm + hm + vm
    fx, fy = against_walls(stretch.leaning, fx, fy)
    rx, ry, rm, first, second, power = held(
        model.hold, body, y[THETA], y[VX], y[VY], y[SPIN], fx, fy, fm
    )
    out[row, X], out[row, Y], out[row, THETA] = y[VX], y[VY], y[SPIN]
    out[row, VX] = (fx + rx) / body.mass
    out[row, VY] = (fy + ry) / body.mass
    out[row, SPIN] = (fm + rm) / body.inertia
    out[row, GIVEN] = gx * y[VX] + gy * y[VY] + gm * y[SPIN]
    out[row, DRY], out[row, VISCOUS] = heat, warmth
    out[row, SUPPORT] = (hx + vx) * sx + (hy + vy) * sy + (hm + vm) * sw + power
    out[row, LAMBDA], out[row, LAMBDA + 1] = first, second


@inlined
def kinetic_energy(body: Body, y: FloatArray) -> float:
    """½ m v² + ½ I ω²."""
    return 0.5 * body.mass * (y[VX] * y[VX] + y[VY] * y[VY]) + (
        0.5 * body.inertia * y[SPIN] * y[SPIN]
    )
