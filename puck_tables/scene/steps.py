"""One step in time: of order 8, or where the slip settles fast Radau IIA of order 5.

A step ends on the constraint.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.equations import (
    FIRST,
    GIVEN,
    SIZE,
    by_blade,
    by_floor,
    has_axes,
    kinetic_energy,
    rates,
    rates_by_blade,
    slip_change,
)
from puck_tables.scene.explicit import STAGES, explicit_step
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    BLADE,
    CARRIED,
    FREE,
    PIVOT,
    RAIL,
    SLIDES,
    Body,
    Hold,
    Phase,
    Surface,
    floor_acceleration,
    floor_velocity,
)
from puck_tables.scene.radau import radau_step

_ULP = 4e-16  # of a number: rounding of steps to it


@inlined
def follow_scales(scale: FloatArray, tolerance: float, body: Body, y: FloatArray) -> None:
    """Let the scales follow a motion that leaves them: no step is better than rounding.

    Energies are known to a share of the largest.
    """
    for i in range(GIVEN):
        scale[i] = max(scale[i], _ULP / tolerance * abs(y[i]))
    largest = kinetic_energy(body, y)
    for i in range(GIVEN, SIZE):
        largest = max(largest, abs(y[i]))
    for i in range(GIVEN, SIZE):
        scale[i] = max(scale[i], largest)


@inlined
def up_to_the_stop(
    phase: Phase, h: float, q: float, least: float, pull: float, reach: float, y: FloatArray,
    work: FloatArray,
) -> float:  # fmt: skip
    """The length of a step, no longer than where a slip q ≥ 0 leads.

    ``pull``: how fast the slip changes.  An implicit step takes at most the share ``reach`` of the
    time in which that is as much as the slip, or ``least``; explicit ones that share of what brakes
    it, or turns it.
    """
    near, radius = max(q, least), phase.model.body.radius
    brakes = -slip_change(radius, y, work) if q > 0.0 else 0.0
    most = pull / reach
    if phase.newton == 0.0 and brakes > 0.0:
        most = max(math.sqrt(max(pull * pull - brakes * brakes, 0.0)), brakes) / reach
    return near / most if h * most > near else h


@inlined
def _put_right(hold: Hold, surface: Surface, t: float, y: FloatArray) -> None:
    """Position and velocity onto the constraint, from which rounding and step errors lead away."""
    if hold.kind == RAIL:
        sx, sy, _ = floor_velocity(surface, y[X], y[Y])
        off = hold.ax * (y[VX] - (hold.vx - sx)) + hold.ay * (y[VY] - (hold.vy - sy))
        y[VX] -= off * hold.ax
        y[VY] -= off * hold.ay
        return
    cosine, sine = math.cos(y[THETA] + hold.angle), math.sin(y[THETA] + hold.angle)
    if hold.kind == BLADE:
        off = -sine * y[VX] + cosine * y[VY] - hold.vx
        y[VX] += off * sine
        y[VY] -= off * cosine
    if hold.kind == PIVOT:
        y[X] = hold.ax + hold.vx * t - hold.reach * cosine
        y[Y] = hold.ay + hold.vy * t - hold.reach * sine
        sx, sy, turning = floor_velocity(surface, y[X], y[Y])
        rim = turning * hold.reach
        y[VX] = y[SPIN] * hold.reach * sine + (hold.vx + rim * sine - sx)
        y[VY] = -y[SPIN] * hold.reach * cosine + (hold.vy - rim * cosine - sy)


@inlined
def accelerations(
    surface: Surface, y: FloatArray, work: FloatArray, row: int
) -> tuple[float, float, float]:  # fmt: skip
    """Accelerations of the centre in the laboratory and of the spin, by a row of rates."""
    cx, cy = floor_acceleration(surface, y[X], y[Y], work[row, X], work[row, Y])
    return work[row, VX] + cx, work[row, VY] + cy, work[row, SPIN] + surface.turn


@inner
def step(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new``; its error in ``scale``.

    On entry work[0] is dy/dt at t; on return work[STAGES − 1] is that at the end.
    """
    own, implicit = has_axes(phase), phase.newton > 0.0 and h > 0.0  # something is at once
    ux, uy, ax, ay = y[VX], y[VY], work[0, VX], work[0, VY]
    if own:
        by_blade(phase, y)
        rates_by_blade(phase, y, work, FIRST)
    if implicit:
        error = radau_step(phase, t, h, y, scale, work, new)
    else:
        error = explicit_step(phase, t, h, y, scale, work, new)
    if own:
        y[VX], y[VY], work[0, VX], work[0, VY] = ux, uy, ax, ay
        by_floor(phase, new)
    if own or implicit:
        rates(phase, t + h, new, work, STAGES - 1)
    model = phase.model
    if phase.mode == CARRIED:
        new[VX] = new[VY] = new[SPIN] = 0.0
        if model.surface.spin == 0.0 and model.surface.changes == 0.0:
            error = 0.0  # straight on: what looks like an error is rounding
    elif phase.mode == SLIDES and model.hold.kind != FREE:
        _put_right(model.hold, model.surface, t + h, new)
    return error
