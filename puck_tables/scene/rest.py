"""Whether a puck at rest on its floor stays there, and which way it slips if it does not.

What friction can take up are the forces and torques (F, T) below those that it has in some slip,
the curve (Salnikova, Treschev, Gallyamov 2012, section 6)

    F(φ) = f N cos φ hypot(ρ_∥, sin φ ρ_⊥),   T(φ) = ½ f N r sin φ ρ_ω .

The demand on the floor lies in the direction of one of its points, φ; it is held if it is not
larger.  If it is larger the puck starts to slip there, at first with the power of the excess.
Without a torque this is F ≤ f N.  For δ = 0 it is the same as: no slip gains energy.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.floor_map import EDGES, LEVER, LIFTS, SHARE
from puck_tables.scene.forces import prescribed_force
from puck_tables.scene.friction import THETA, X, Y, at_slip_zero, friction_force
from puck_tables.scene.ingredients import (
    BLADE,
    FREE,
    PIVOT,
    RAIL,
    STICKING,
    Body,
    DryFriction,
    Phase,
    Surface,
    VelocityConstraint,
    floor_acceleration,
    floor_velocity,
    friction_at,
    is_mixed,
    is_over_belts,
    put_at,
    surface_now,
)
from puck_tables.scene.mixed_rest import least_under, mixed_yield
from puck_tables.scene.orthotropic import ellipse_in, elliptic_demand, is_elliptic

SLACK = 1e-12  # of f N: a demand this close to the limit is held
_HINT = 1e-100  # of a torque: a force that only says which way the puck is led

Yield = tuple[float, float, float, float]


@inlined
def _pivot_yield(
    friction: DryFriction, hold: VelocityConstraint, radius: float, theta: float,
    fx: float, fy: float, torque: float,
) -> Yield:  # fmt: skip
    """The yield where the only slip is a turn about the pivot: one direction, φ = atan(r/reach)."""
    cosine, sine = math.cos(theta + hold.angle), math.sin(theta + hold.angle)
    reach = hold.reach
    demand = torque - reach * (cosine * fy - sine * fx)
    length = math.hypot(reach, radius)
    w = (1.0 if demand >= 0.0 else -1.0) / length
    if is_mixed(friction):  # it is summed with what friction holds, and as it was again
        floor_map = friction.by_speed.table
        share = floor_map[SHARE]
        floor_map[SHARE] = -friction.by_speed.normal * share
    _, _, _, heat = friction_force(friction, radius, w * reach * sine, -w * reach * cosine, w)
    if is_mixed(friction):
        floor_map[SHARE] = share
    return abs(demand) / length - heat, w * reach * sine, -w * reach * cosine, w


@kernel
def demand(
    friction: DryFriction, radius: float, fx: float, fy: float, torque: float, guided: bool
) -> tuple[float, float, float, float, float]:
    """A force and a torque as a share of what friction takes up of their kind; W and the slip.

    ``guided``: the slip is along the force only.
    """
    law = friction.by_speed
    if is_elliptic(law.table):
        axes = ellipse_in(law.table, law.height_ratio, law.normal)
        return elliptic_demand(axes, radius, fx, fy, torque, guided)
    force = math.hypot(fx, fy)
    east, north = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    sense = 1.0 if torque >= 0.0 else -1.0
    low, high, phi = 0.0, 0.5 * math.pi, (0.0 if torque == 0.0 else 0.25 * math.pi)
    while True:
        patience(1)
        cosine, sine = math.cos(phi), sense * math.sin(phi) / radius
        along, across, turning, heat = friction_force(friction, radius, cosine, 0.0, sine)
        across = 0.0 if guided else across
        resist = math.hypot(along, across)
        if torque == 0.0:
            break
        if force * abs(turning) < abs(torque) * resist:
            low = phi
        else:
            high = phi
        phi = 0.5 * (low + high)
        if phi <= low or phi >= high:
            break
    share = math.hypot(radius * force, torque) / math.hypot(radius * resist, turning)
    # friction is against the force: the slip is turned from it by as much as friction from the slip
    ex, ey = (-along / resist, across / resist) if resist > 0.0 else (1.0, 0.0)
    return share, heat, cosine * (ex * east - ey * north), cosine * (ex * north + ey * east), sine


@inner
def free_yield(
    friction: DryFriction, radius: float, fx: float, fy: float, torque: float, guided: bool
) -> Yield:
    """The yield where the puck may slip and turn; ``guided``: along the force only."""
    if friction.load == 0.0:
        size = math.hypot(math.hypot(fx, fy), torque / radius)
        if size == 0.0:
            return 0.0, 1.0, 0.0, 0.0
        return size, fx / size, fy / size, torque / radius / size / radius
    if is_mixed(friction):
        law = friction.by_speed
        return mixed_yield(
            law.table, friction.load, -law.normal, radius, fx, fy, torque, guided
        )  # fmt: skip
    share, heat, ux, uy, w = demand(friction, radius, fx, fy, torque, guided)
    return (share - 1.0) * heat, ux, uy, w


@inlined
def slip_led(hold: VelocityConstraint, surface: Surface, y: FloatArray) -> float:
    """How fast a constraint leads a puck past its floor that slips no more than it must, m/s."""
    sx, sy, turning = floor_velocity(surface, y[X], y[Y])
    vx, vy = hold.vx - sx, hold.vy - sy
    if hold.kind == RAIL:
        return abs(hold.ax * vx + hold.ay * vy)
    if hold.kind == BLADE:
        return abs(hold.vx)
    if hold.kind == PIVOT:
        rim, angle = turning * hold.reach, y[THETA] + hold.angle
        return math.hypot(vx + rim * math.sin(angle), vy - rim * math.cos(angle))
    return 0.0


@inlined
def constrained_yield(
    friction: DryFriction, hold: VelocityConstraint, body: Body, theta: float, ax: float, ay: float,
    turning: float, fx: float, fy: float, torque: float, guided: bool,
) -> Yield:  # fmt: skip
    """By kind of constraint; a floor whose motion a constraint forbids never holds the puck."""
    cosine, sine = math.cos(theta + hold.angle), math.sin(theta + hold.angle)
    if hold.kind == PIVOT:
        centripetal = turning * turning * hold.reach
        gap = math.hypot(ax - centripetal * cosine, ay - centripetal * sine)
        if gap > 1e-9 * math.hypot(ax, ay):
            return math.inf, 0.0, 0.0, 0.0
        return _pivot_yield(friction, hold, body.radius, theta, fx, fy, torque)
    if (hold.kind == RAIL and turning != 0.0) or (hold.kind == BLADE and hold.vx != 0.0):
        return math.inf, 0.0, 0.0, 0.0
    ex, ey = (-hold.ay, hold.ax) if hold.kind == RAIL else (cosine, sine)
    along = fx * ex + fy * ey
    if along == 0.0 and is_mixed(friction):  # a turn leads along it, even so
        along = _HINT * torque / body.radius
    return free_yield(friction, body.radius, along * ex, along * ey, torque, guided)


@inlined
def _may_tip(friction: DryFriction) -> bool:
    """Whether a force may leave a base that is summed with no pressure that carries it."""
    floor_map = friction.by_speed.table
    return floor_map[LEVER] != 0.0 and (floor_map[LIFTS] != 0.0 or floor_map[EDGES] != 0.0)


@kernel
def excess_at_rest(phase: Phase, t: float, y: FloatArray) -> Yield:
    """By how much the power of the best slip at Q = 1 exceeds friction, W, and that slip.

    The slip is a direction (ux, uy, w), scaled to Q = 1; friction holds while nothing exceeds it:
    static friction, where the puck is carried.
    """
    model = phase.model
    body = model.body
    surface = surface_now(phase, t)
    sx, sy, turning = floor_velocity(surface, y[X], y[Y])
    ax, ay = floor_acceleration(surface, y[X], y[Y], sx, sy)
    gx, gy, torque = prescribed_force(model.forces, phase.piece, t)
    torque -= body.inertia * surface.turn
    fx, fy = gx - body.mass * ax, gy - body.mass * ay
    static = surface.static if phase.mode == STICKING else 1.0
    friction = friction_at(phase.friction, model.forces.drive, phase.piece, t)
    friction = at_slip_zero(friction, static)
    put_at(friction, y[X], y[Y], y[THETA])
    guided = model.hold.kind != FREE
    if guided:
        return constrained_yield(
            friction, model.hold, body, y[THETA], ax, ay, turning, fx, fy, torque, guided
        )
    is_moved = torque == 0.0 and (sx != 0.0 or sy != 0.0)
    if is_moved and is_mixed(friction) and not _may_tip(friction) and not is_over_belts(friction):
        # Without a torque b = κ F, and as |u| is convex no slip gains where F is below the least f
        # alone: ∫ σ |u| dA ≥ N |u at the centre of pressure|.  A puck that is carried asks often.
        force = math.sqrt(fx * fx + fy * fy)
        least = static * least_under(friction.by_speed.table, body.radius)
        if force < least:
            return force - least, fx / force if force > 0.0 else 1.0, fy / max(force, 1e-300), 0.0
    return free_yield(friction, body.radius, fx, fy, torque, False)


@inlined
def held_by_floor(phase: Phase, t: float, y: FloatArray) -> bool:
    """Whether friction holds a puck at rest on the floor."""
    return excess_at_rest(phase, t, y)[0] <= SLACK * phase.friction.load
