"""Equations of motion of a puck in a scene, with the power of every ingredient.

The state holds place and angle in the laboratory, and velocity and spin *relative to the floor*
under the puck: so a slip keeps all its digits however fast the floor moves.  With s the velocity of
the floor there and Ω its spin, x′ = v = u + s and u′ = F/m − Ω × v.  Given forces act on the
centre, so the balance of moments that tilts the pressure stays that of the free puck.  The state
carries the energies too: work of given forces, heat of dry friction, heat of viscous friction (2f₂
of Chetaev), work of moving supports and constraints (−f₁, and what dry friction and reactions do at
the velocity of their support).

A blade has its velocity by its own axes, along it and to its left: a spin turns nothing there.
With e along it, n to its left and u = p e + q n over the floor,

    u′ = (p′ − θ′ q) e + (q′ + θ′ p) n .

In the axes of the laboratory u turns with the body, and steps would follow every turn of it; p and
q know nothing of that.  Within a step velocities of a blade are p, q; all else has u.
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.base_balance import heat_at_rest
from puck_tables.scene.forces import damping, dragged, prescribed_force
from puck_tables.scene.friction import (
    SPIN,
    THETA,
    VX,
    VY,
    X,
    Y,
    friction_force,
    friction_force_here,
    size,
)
from puck_tables.scene.ingredients import (
    BLADE,
    SLIDES,
    STICKING,
    Body,
    Model,
    Phase,
    Surface,
    changes_over_time,
    floor_acceleration,
    floor_velocity,
    friction_at,
    held,
    is_over_belts,
    put_at,
    surface_now,
)

SIZE = 10  # numbers that are integrated: six of the state, the four works
FORCE_WORK, DRY, VISCOUS, SUPPORT = range(6, SIZE)
LAMBDA = SIZE  # the two multipliers follow the state; they are not integrated
ROW = SIZE + 2  # with the multipliers
# rows; plain numbers would compile ``rates`` once for each
FIRST, SECOND = cast(int, np.int64(0)), cast(int, np.int64(1))


@inlined
def slip_speed(radius: float, y: FloatArray) -> float:
    """Q relative to the floor under the puck."""
    return size(y[VX], y[VY], radius * y[SPIN])


@inlined
def slip_side(radius: float, y: FloatArray) -> float:
    """(r|w| − u)/(r|w| + u): 0 where φ = π/4, and within rounding of it."""
    speed, rim = size(y[VX], y[VY], 0.0), radius * abs(y[SPIN])
    side = (rim - speed) / (rim + speed) if rim + speed > 0.0 else 0.0
    return side if abs(side) > 1e-11 else 0.0


@inlined
def slip_rate(radius: float, work: FloatArray) -> float:
    """The size of the change of the slip, from d/dt of the state in work[0]."""
    return size(work[0, VX], work[0, VY], radius * work[0, SPIN])


@inlined
def slip_change(radius: float, y: FloatArray, work: FloatArray) -> float:
    """The rate of Q, from d/dt of the state in work[0]."""
    spins = radius * radius * y[SPIN] * work[0, SPIN]
    return (y[VX] * work[0, VX] + y[VY] * work[0, VY] + spins) / slip_speed(radius, y)


@inlined
def settling_rates(model: Model, load: float) -> tuple[float, float]:
    """How fast, at most, what is damped settles, 1/s, and times the slip its direction, m/s²."""
    body = model.body
    lever = body.mass * body.radius * body.radius / body.inertia
    return damping(model.forces.drags), load / body.mass * max(1.0, 0.5 * lever)


@inlined
def stopping(radius: float, y: FloatArray, work: FloatArray) -> tuple[float, float, float, float]:
    """The direction (ux, uy, w) of the slip, scaled to Q = 1, and the rate of Q."""
    q = slip_speed(radius, y)
    return y[VX] / q, y[VY] / q, y[SPIN] / q, slip_change(radius, y, work)


@inner
def rates(phase: Phase, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """:func:`rates_here` for callers whose time it is not worth to paste it in."""
    rates_here(phase, t, y, out, row)


@inlined
def rates_here(phase: Phase, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """d/dt of the state and λ into out[row] (12,); λ is not determined at rest.

    At rest the puck moves with the floor.  What is about to rest slips in the direction that
    ``direction`` of the phase gives: to follow how that settles would take steps without number.
    """
    model = phase.model
    body = model.body
    surface = surface_now(phase, t)
    sx, sy, turning = floor_velocity(surface, y[X], y[Y])
    vx, vy, spin = y[VX] + sx, y[VY] + sy, y[SPIN] + turning
    cx, cy = floor_acceleration(surface, y[X], y[Y], vx, vy)
    gx, gy, gm = prescribed_force(model.forces, phase.piece, t)
    out[row, X], out[row, Y], out[row, THETA] = vx, vy, spin
    out[row, FORCE_WORK] = gx * vx + gy * vy + gm * spin
    if phase.mode != SLIDES:
        nx, ny, nw, gain = phase.direction
        gain = 0.0 if phase.mode == STICKING else gain
        ax, ay, aw = gain * nx, gain * ny, gain * nw
        out[row, VX], out[row, VY], out[row, SPIN] = ax, ay, aw
        fx, fy, fm = gx - body.mass * cx, gy - body.mass * cy, gm - body.inertia * surface.turn
        # what the floor and what holds the puck there do besides the given forces
        fx, fy, fm = body.mass * ax - fx, body.mass * ay - fy, body.inertia * aw - fm
        rubs = 0.0
        if is_over_belts(phase.friction):
            put_at(phase.friction, y[X], y[Y], y[THETA])
            friction = friction_at(phase.friction, model.forces.drive, phase.piece, t)
            rubs = heat_at_rest(friction.by_speed.table, fx, fy)
        out[row, DRY] = rubs - (fx * y[VX] + fy * y[VY] + fm * y[SPIN])
        out[row, VISCOUS] = 0.0
        out[row, SUPPORT] = rubs + fx * sx + fy * sy + fm * turning
        out[row, LAMBDA], out[row, LAMBDA + 1] = 0.0, 0.0
        return
    put_at(phase.friction, y[X], y[Y], y[THETA])
    drive = model.forces.drive
    if changes_over_time(phase.friction, drive):
        friction = friction_at(phase.friction, drive, phase.piece, t)
        hx, hy, hm, heat = friction_force(friction, body.radius, y[VX], y[VY], y[SPIN])
    else:
        hx, hy, hm, heat = friction_force_here(phase.friction, body.radius, y[VX], y[VY], y[SPIN])
    ax, ay, aw, warmth, spin_warmth = dragged(model.forces.drags, y[VX], y[VY], y[SPIN])
    dx, dy, dm = body.mass * ax, body.mass * ay, body.inertia * aw
    warmth = body.mass * warmth + body.inertia * spin_warmth
    fx, fy, fm = gx + hx + dx, gy + hy + dy, gm + hm + dm
    rx, ry, rm, first, second, power = held(model.hold, body, surface, y, fx, fy, fm)
    out[row, VX] = (fx + rx) / body.mass - cx
    out[row, VY] = (fy + ry) / body.mass - cy
    out[row, SPIN] = (fm + rm) / body.inertia - surface.turn
    out[row, DRY], out[row, VISCOUS] = heat, warmth
    out[row, SUPPORT] = (hx + dx) * sx + (hy + dy) * sy + (hm + dm) * turning + power
    if is_over_belts(phase.friction):  # what others of them do
        out[row, SUPPORT] += heat + hx * y[VX] + hy * y[VY] + hm * y[SPIN]
    out[row, LAMBDA], out[row, LAMBDA + 1] = first, second


@inlined
def to_laboratory(surface: Surface, y: FloatArray, sign: float) -> None:
    """Relative velocities of a state into those of the laboratory; ``sign`` −1: and back."""
    sx, sy, turning = floor_velocity(surface, y[X], y[Y])
    y[VX] += sign * sx
    y[VY] += sign * sy
    y[SPIN] += sign * turning


@inlined
def kinetic_energy(body: Body, y: FloatArray) -> float:
    """½ m v² + ½ I ω² of a state in the laboratory."""
    return 0.5 * body.mass * (y[VX] * y[VX] + y[VY] * y[VY]) + (
        0.5 * body.inertia * y[SPIN] * y[SPIN]
    )


@inlined
def has_axes(phase: Phase) -> bool:
    """Whether a step has velocities by the blade's axes."""
    return phase.model.hold.kind == BLADE and phase.mode == SLIDES


@inlined
def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * x - sine * y, sine * x + cosine * y


@inlined
def by_blade(phase: Phase, y: FloatArray) -> None:
    """A state with u into one with p, q."""
    y[VX], y[VY] = _turned(y[VX], y[VY], -(y[THETA] + phase.model.hold.angle))


@inlined
def by_floor(phase: Phase, y: FloatArray) -> None:
    """A state with p, q into one with u."""
    y[VX], y[VY] = _turned(y[VX], y[VY], y[THETA] + phase.model.hold.angle)


@inlined
def rates_by_blade(phase: Phase, y: FloatArray, out: FloatArray, row: int) -> None:
    """Rates of u in out[row] into those of p, q, at a state ``y`` with p, q."""
    angle, turns = y[THETA] + phase.model.hold.angle, out[row, THETA]
    along, across = _turned(out[row, VX], out[row, VY], -angle)
    out[row, VX], out[row, VY] = along + turns * y[VY], across - turns * y[VX]


@inlined
def rates_in_step(phase: Phase, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """:func:`puck_tables.scene.equations.rates` of a state within a step."""
    if not has_axes(phase):
        rates(phase, t, y, out, row)
        return
    along, across = y[VX], y[VY]
    by_floor(phase, y)
    rates(phase, t, y, out, row)
    y[VX], y[VY] = along, across
    rates_by_blade(phase, y, out, row)
