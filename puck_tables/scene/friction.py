"""Dry friction on a puck that slips in a given direction, and what walls take of a force.

With u, w the velocity and spin relative to the floor, Q = hypot(u, r w), sin φ = r w/Q (Salnikova,
Treschev, Gallyamov 2012, sections 4–6, with relative velocities)

    F = −f N (ρ_∥ u + sin φ ρ_⊥ u^⊥)/Q,   M = −½ f N r sin φ ρ_ω,   power −f N Q (cos²φ ρ_∥ +
    ½ sin²φ ρ_ω),

u^⊥ being u turned by +90°.  Where f depends on the slip speed, f ρ are integrals over the base that
depend on Q too (:mod:`puck_tables.contact.speed_quadrature`).  Where it depends on the direction
see :mod:`puck_tables.scene.orthotropic`.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.speed_spline import speed_ratios
from puck_tables.motion.equations_of_motion import ratios_at
from puck_tables.scene.base_balance import friction_on_floor
from puck_tables.scene.ingredients import BySpeed, DryFriction, is_mixed, is_over_belts
from puck_tables.scene.orthotropic import ellipse_in, elliptic_friction, is_elliptic

X, Y, THETA, VX, VY, SPIN = range(6)  # of a state; integrated, the last three are over the floor


@inlined
def size(a: float, b: float, c: float) -> float:
    """√(a² + b² + c²); the scales of a scene keep the squares in range."""
    return math.sqrt(a * a + b * b + c * c)


@kernel
def friction_force(
    friction: DryFriction, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor."""
    law, slip = friction.by_speed, size(ux, uy, radius * w)
    if law.normal == 0.0 or friction.load == 0.0 or (slip == 0.0 and not is_over_belts(friction)):
        return _plain_friction(friction, radius, ux, uy, w)
    if is_mixed(friction):
        return friction_on_floor(law.table, ux, uy, w, law.moving)
    if is_elliptic(law.table):
        axes = ellipse_in(law.table, law.height_ratio, law.normal)
        return elliptic_friction(axes, radius, ux, uy, w)
    speed, rim = size(ux, uy, 0.0), radius * abs(w)
    fast = rim > speed
    ratio = speed / rim if fast else rim / speed
    along, across, turning = speed_ratios(
        law.table, law.height_ratio, ratio, fast, law.moving * slip
    )
    normal = law.normal
    return _against(
        radius, ux, uy, w, speed, slip, along * normal, across * normal, turning * normal
    )


@inlined
def friction_force_here(
    friction: DryFriction, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and power of dry friction; where only its direction counts, pasted in.

    To hand on a record takes as long as to look friction up.
    """
    if friction.by_speed.normal != 0.0:
        return friction_force(friction, radius, ux, uy, w)
    return _plain_friction(friction, radius, ux, uy, w)


@inlined
def _plain_friction(
    friction: DryFriction, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    load, rim = friction.load, radius * abs(w)
    slip = size(ux, uy, rim)
    if load == 0.0 or slip == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    speed = size(ux, uy, 0.0)
    fast = rim > speed
    ratio = speed / rim if fast else rim / speed
    inverse, accel, spin = ratios_at(ratio, fast, friction.limits, friction.delta)
    along = load / inverse
    return _against(radius, ux, uy, w, speed, slip, along, accel * along, spin * along)


@inlined
def _against(
    radius: float, ux: float, uy: float, w: float, speed: float, slip: float, along: float,
    across: float, turning: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Force, torque and power of the resultants f N ρ."""
    sine = radius * w / slip
    push, bent = along / slip, across * sine / slip
    cos2 = (speed / slip) * (speed / slip)
    return (
        bent * uy - push * ux,
        -push * uy - bent * ux,
        -0.5 * radius * sine * turning,
        slip * (cos2 * along + 0.5 * sine * sine * turning),
    )


@inlined
def at_slip_zero(friction: DryFriction, static: float) -> DryFriction:
    """The friction that a puck at rest would start against, whatever its coefficient does later.

    ``static``: times what it is in a slip; its ratios are then those of no height, or summed.
    """
    law = friction.by_speed
    still = BySpeed(law.table, static * law.height_ratio, static * law.normal, 0.0)
    return DryFriction(static * friction.load, static * friction.delta, friction.limits, still)
