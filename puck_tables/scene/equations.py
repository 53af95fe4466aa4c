"""Equations of motion of a puck in a scene, in the laboratory, with the power of every ingredient.

Given forces act on the centre, so the balance of moments that tilts
the pressure stays that of the free puck.  The state carries, beside position and velocity, the
energies: work of given forces, heat of dry friction, heat of viscous friction (2f₂
of Chetaev), work of moving supports and constraints (−f₁, and what dry friction and reactions do
at the velocity of their support).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.friction import (
    SPIN,
    THETA,
    VX,
    VY,
    X,
    Y,
    against_walls,
    dry_friction,
    size,
)  # fmt: skip
from puck_tables.scene.ingredients import (
    SLIDES,
    STARTS,
    STOPS,
    Body,
    Model,
    Stretch,
    drag_force,
    floor_velocity,
    given_force,
    held,
)
from puck_tables.scene.rest import excess_at_rest

FloatArray = npt.NDArray[np.float64]

SIZE = 10
GIVEN, DRY, VISCOUS, SUPPORT = range(6, SIZE)
LAMBDA = SIZE  # the two multipliers follow the state; they are not integrated
ROW = SIZE + 2


@inlined
def slip_speed(model: Model, y: FloatArray) -> float:
    """Q relative to the floor under the puck."""
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    return size(y[VX] - sx, y[VY] - sy, model.body.radius * (y[SPIN] - sw))


@inlined
def slip_side(model: Model, y: FloatArray) -> float:
    """(r|w| − u)/(r|w| + u), relative to the floor: 0 where φ = π/4, and within rounding of it."""
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    speed, rim = size(y[VX] - sx, y[VY] - sy, 0.0), model.body.radius * abs(y[SPIN] - sw)
    side = (rim - speed) / (rim + speed) if rim + speed > 0.0 else 0.0
    return side if abs(side) > 1e-11 else 0.0


@inlined
def slip_rate(model: Model, y: FloatArray, work: FloatArray) -> float:
    """The size of the change of the relative velocity, from d/dt of the state in work[0]."""
    turning = model.surface.spin  # under a puck that moves the floor changes its velocity too
    return size(
        work[0, VX] + turning * y[VY],
        work[0, VY] - turning * y[VX],
        model.body.radius * work[0, SPIN],
    )


@inlined
def stopping(model: Model, y: FloatArray, work: FloatArray) -> tuple[float, float, float, float]:
    """The direction (vx, vy, ω) of the slip, scaled to Q = 1, and the rate of Q."""
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    ux, uy, w, turning = y[VX] - sx, y[VY] - sy, y[SPIN] - sw, model.surface.spin
    r2 = model.body.radius * model.body.radius
    q = size(ux, uy, model.body.radius * w)
    rate = ux * (work[0, VX] + turning * y[VY]) + uy * (work[0, VY] - turning * y[VX])
    return ux / q, uy / q, w / q, (rate + r2 * w * work[0, SPIN]) / q


@kernel
def rates(stretch: Stretch, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """d/dt of the state and λ into out[row] (12,); λ is not determined at rest.

    Next to rest the puck moves with the floor, and slips in the direction that :mod:`rest` finds
    (it starts) or that ``way`` gives (it stops): there the direction settles at once, and
    following it would take steps without number.
    """
    model = stretch.model
    body = model.body
    sx, sy, sw = floor_velocity(model.surface, y[X], y[Y])
    gx, gy, gm = given_force(model, stretch.piece, t)
    if stretch.mode != SLIDES:
        ax, ay = -sw * y[VY], sw * y[VX]  # of the floor that the puck meets on its way
        nx, ny, nw, gain = 0.0, 0.0, 0.0, 0.0
        if stretch.mode == STARTS:
            excess, nx, ny, nw = excess_at_rest(stretch, t, y)
            gain = max(excess, 0.0) / (body.mass * (nx * nx + ny * ny) + body.inertia * nw * nw)
        elif stretch.mode == STOPS:
            nx, ny, nw, gain = stretch.way
        ax, ay, aw = ax + gain * nx, ay + gain * ny, gain * nw
        out[row, X], out[row, Y], out[row, THETA] = y[VX], y[VY], y[SPIN]
        out[row, VX], out[row, VY], out[row, SPIN] = ax, ay, aw
        # what the floor and what holds the puck there do besides the given forces
        fx, fy, fm = body.mass * ax - gx, body.mass * ay - gy, body.inertia * aw - gm
        out[row, GIVEN] = gx * y[VX] + gy * y[VY] + gm * y[SPIN]
        out[row, DRY] = -(fx * (y[VX] - sx) + fy * (y[VY] - sy) + fm * (y[SPIN] - sw))
        out[row, VISCOUS] = 0.0
        out[row, SUPPORT] = fx * sx + fy * sy + fm * sw
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
