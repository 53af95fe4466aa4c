"""One step in time: of order 8, or where the slip settles fast Radau IIA of order 5.

A step ends on the constraint.  That of order 8 is of the pair 8(5,3) of Dormand and Prince
(:data:`puck_tables.motion.steppers.DORMAND_PRINCE_8`).  Its error is h e₅²/√(e₅² + e₃²/100), of
order 8, with e₅ and e₃ those of embedded methods of order 5, 3.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial.legendre import legint, legval, legvander

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.steppers import DORMAND_PRINCE_8
from puck_tables.scene.equations import (
    FIRST,
    FORCE_WORK,
    SIZE,
    by_blade,
    by_floor,
    has_axes,
    kinetic_energy,
    rates,
    rates_by_blade,
    rates_here,
    slip_change,
    slip_speed,
)
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    BLADE,
    FREE,
    PIVOT,
    RAIL,
    SLIDES,
    STICKING,
    Body,
    Phase,
    Surface,
    VelocityConstraint,
    floor_acceleration,
    floor_velocity,
    is_over_belts,
)
from puck_tables.scene.radau import radau_step

STAGES = len(DORMAND_PRINCE_8.c)  # the last one stands at the end of the step

_A, _C = DORMAND_PRINCE_8.a, DORMAND_PRINCE_8.c
_ERROR_5, _ERROR_3 = DORMAND_PRINCE_8.e
# of each stage, the first one besides that at the start that it is made of; and of the end
_SECOND = np.array([
    [*np.flatnonzero(row), stage, stage][1] for stage, row in enumerate(_A)
])  # fmt: skip
_LATE = int(_SECOND[-1])

# a step is known at so many shares of it, by weights of the stages for what an integral has come
# there, over 1, with the error h⁷, and for its rate: of a polynomial through all that are exact to
# h⁵, with different nodes
SHARES = 16
_EXACT = [n for n, row in enumerate(_A) if abs(row @ _C**4 - _C[n] ** 5 / 5) < 1e-14]
_NODES = [n for n in _EXACT if n == STAGES - 1 or _C[n] < 1.0]
_FIRST_NODE, _AT = _NODES[1], np.linspace(-1.0, 1.0, SHARES + 1)  # besides that at the start
_BASIS = np.linalg.inv(legvander(2.0 * _C[_NODES] - 1.0, len(_NODES) - 1))
_CHANGES, _RATES = np.zeros((2, SHARES + 1, STAGES))
_CHANGES[:, _NODES] = legval(_AT, 0.5 * legint(_BASIS, lbnd=-1)).T
_RATES[:, _NODES] = legval(_AT, _BASIS).T


@inlined
def come_by(share: int, h: float, work: FloatArray, i: int) -> float:
    """By how much a number of the state has changed at so many shares of a step done over h."""
    total = _CHANGES[share, 0] * work[0, i]
    for stage in range(_FIRST_NODE, STAGES):
        total += _CHANGES[share, stage] * work[stage, i]
    return h * total


@inlined
def rate_at(share: int, work: FloatArray, i: int) -> float:
    """The rate of a number of the state at so many shares of a step done."""
    total = _RATES[share, 0] * work[0, i]
    for stage in range(_FIRST_NODE, STAGES):
        total += _RATES[share, stage] * work[stage, i]
    return total


@inlined
def _five(y: FloatArray, i: int, h: float, stage: int, work: FloatArray, new: FloatArray) -> None:
    """Five numbers, from i on, of the state at a stage into ``new``.

    By name, so that they stay in registers: a compiler does not see that ``new`` and ``work`` are
    apart, and in loops over both to write and read again takes as long as to add.
    """
    w = h * _A[stage, 0]
    a, b, c = y[i] + w * work[0, i], y[i + 1] + w * work[0, i + 1], y[i + 2] + w * work[0, i + 2]
    d, e = y[i + 3] + w * work[0, i + 3], y[i + 4] + w * work[0, i + 4]
    for j in range(_SECOND[stage], stage):
        w = h * _A[stage, j]
        a, b, c = a + w * work[j, i], b + w * work[j, i + 1], c + w * work[j, i + 2]
        d, e = d + w * work[j, i + 3], e + w * work[j, i + 4]
    new[i], new[i + 1], new[i + 2], new[i + 3], new[i + 4] = a, b, c, d, e


@inlined
def explicit_step(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new``; its error in ``scale``.

    On entry work[0] is dy/dt at t, on return work[STAGES − 1] that at the end.  Velocities of a
    blade are by its own axes, on entry and on return.
    """
    own = has_axes(phase)
    for stage in range(1, STAGES):
        moment = t + h * _C[stage]
        _five(y, 0, h, stage, work, new)
        _five(y, 5, h, stage, work, new)
        along, across = new[VX], new[VY]
        if own:
            by_floor(phase, new)
        rates_here(phase, moment, new, work, stage)
        if own:
            new[VX], new[VY] = along, across
            rates_by_blade(phase, new, work, stage)
    largest = 0.0
    for i in range(SIZE):
        rate = work[0, i]
        fifth, third = _ERROR_5[0] * rate, _ERROR_3[0] * rate
        for k in range(_LATE, STAGES - 1):
            rate = work[k, i]
            fifth += _ERROR_5[k] * rate
            third += _ERROR_3[k] * rate
        measured = h / scale[i]
        fifth, third = measured * fifth, measured * third
        square = fifth * fifth
        below = square + 0.01 * third * third
        error = 0.0 if below == 0.0 else square * square / below  # squared
        if not error <= largest:
            largest = error
    return math.sqrt(largest)


_ULP = 4e-16  # of a number: rounding of steps to it


@inlined
def follow_scales(
    scale: FloatArray, tolerance: float, accel: float, body: Body, y: FloatArray
) -> None:
    """Let the scales follow a motion that leaves them: no step is better than rounding.

    That of friction is a share of all of it.  Energies are known to a share of the largest.
    """
    share, slip = _ULP / tolerance, slip_speed(body.radius, y)
    for i in range(FORCE_WORK):
        least = slip if i >= VX else slip * slip / accel
        least = least / body.radius if i in (THETA, SPIN) else least
        scale[i] = max(scale[i], share * max(abs(y[i]), least))
    largest = kinetic_energy(body, y)
    for i in range(FORCE_WORK, SIZE):
        largest = max(largest, abs(y[i]))
    for i in range(FORCE_WORK, SIZE):
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
def _put_right(hold: VelocityConstraint, surface: Surface, t: float, y: FloatArray) -> None:
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
    if phase.mode == STICKING:
        new[VX] = new[VY] = new[SPIN] = 0.0
        moves = model.surface.spin != 0.0 or model.surface.changes != 0.0
        if not (moves or is_over_belts(phase.friction)):
            error = 0.0  # straight on: what looks like an error is rounding
    elif phase.mode == SLIDES and model.hold.kind != FREE:
        _put_right(model.hold, model.surface, t + h, new)
    return error
