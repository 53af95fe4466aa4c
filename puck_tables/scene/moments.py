"""When something happens that is no line: the floor lets go, a slip stops, begins, φ = π/4."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import SIDES
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.equations import SECOND, rates, slip_side, stopping
from puck_tables.scene.floor_map import BASE
from puck_tables.scene.forces import has_sign, jumps
from puck_tables.scene.friction import SPIN, VX, VY, size
from puck_tables.scene.ingredients import (
    NO_DIRECTION,
    SLIDES,
    STICKING,
    DryFriction,
    Model,
    Phase,
    is_mixed,
    surface_now,
)
from puck_tables.scene.orthotropic import is_elliptic
from puck_tables.scene.rest import SLACK, excess_at_rest, held_by_floor, slip_led
from puck_tables.scene.steps import step

# watched: equal speeds of centre and rim; nothing; no spin
EQUAL, NOTHING, SPINLESS = -1, -2, -3
_TURNS, _CONVERGED = 3000, 1e-12  # at most; of friction: a direction stays
_SLOW = 1e-3  # of friction: what brakes less comes closer to rest before it goes straight
REST = 1e-13  # of the scale of speeds: as good as at rest
_MARGIN = 0.2  # of friction
_UNLIKE = 0.1  # of what brakes: so much less, at least, that may be in another direction
_BLURRED = 10.0  # times the local error: a slip that steps blur
_CLOSE = 1e-12  # of a step: how well a moment in it is known
_FIRST = 1e-16  # of the scale of speeds: what a slip begins with, for its direction
_QUICK = 0.01  # of friction: a slip that grows faster has its direction from the first


@inner
def lost(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """When within a step to ``new`` the floor loses a puck that it carries; inf: it does not.

    On a floor that turns the demand swings, and astride what holds changes: it is looked at where a
    parabola has its top, too.
    """
    slack = SLACK * phase.friction.load
    first, last = excess_at_rest(phase, t, y)[0], excess_at_rest(phase, t + h, new)[0]
    low, high = 0.0, math.inf if last <= slack else h  # no number: it tips
    swings = phase.model.surface.spin != 0.0 or phase.model.surface.changes != 0.0
    if (swings or is_mixed(phase.friction)) and last <= slack:
        step(phase, t, 0.5 * h, y, scale, work, new)
        middle = excess_at_rest(phase, t + 0.5 * h, new)[0]
        accel = 2.0 * (first - 2.0 * middle + last)
        top = 0.25 - (last - first) / (2.0 * accel) + 0.25 if accel < 0.0 else 0.5
        top = min(max(top, 0.0), 1.0) * h
        step(phase, t, top, y, scale, work, new)
        high = math.inf if excess_at_rest(phase, t + top, new)[0] <= slack else top
    if high == math.inf:
        return high
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            return high
        step(phase, t, middle, y, scale, work, new)
        if held_by_floor(phase, t + middle, new):
            low = middle
        else:
            high = middle


@inlined
def rests_on(model: Model, friction: DryFriction, piece: int, y: FloatArray) -> bool:
    """Whether the floor, at rest, holds a puck whatever forces are still to come.

    Between two rows a force lies between theirs; a curve that bulges inwards is given a margin.
    """
    law = friction.by_speed
    uniform = law.normal == 0.0 or (is_elliptic(law.table) and law.height_ratio == 0.0)
    flat = friction.delta == 0.0 and uniform
    level, rows = (SLACK if flat else -_MARGIN) * friction.load, len(model.forces.drive)
    if piece == rows:
        return True
    for row in range(piece, rows + 1):  # at last what is left when the rows have ended
        at = row if row == rows else max(row, 1)
        phase = Phase(model, friction, at, STICKING, NO_DIRECTION, 0.0)
        if not excess_at_rest(phase, model.forces.drive[min(row, rows - 1), 0], y)[0] <= level:
            return False
    return True


@inlined
def watched(phase: Phase, what: int, y: FloatArray) -> float:
    """What changes its sign at a moment that is looked for."""
    return slip_side(phase.model.body.radius, y) if what == EQUAL else float(y[SPIN])


@inner
def zero(
    phase: Phase, what: int, t: float, h: float, y: FloatArray, scale: FloatArray,
    work: FloatArray, new: FloatArray,
) -> float:  # fmt: skip
    """When within a step what is watched passes 0; ``new`` then.

    By the method of false position, with the weight of an end that stays halved (Illinois).  Where
    a step is not solved, ``new`` is NaN.
    """
    low, high, close = 0.0, h, 0.5 * _CLOSE * h
    first, last = watched(phase, what, y), watched(phase, what, new)
    sign, stays = 1.0 if last > 0.0 else -1.0, 0
    for _ in range(60):
        if high - low <= _CLOSE * h or last == 0.0:
            break
        middle = (low * last - high * first) / (last - first)
        middle = min(max(middle, low + close), high - close)  # past it, where it is an end
        error = step(phase, t, middle, y, scale, work, new)
        if not error < math.inf:  # an implicit step that is not solved
            return middle
        value = watched(phase, what, new)
        if sign * value >= 0.0:
            first = 0.5 * first if stays > 0 else first
            high, last, stays = middle, value, 1
        else:
            last = 0.5 * last if stays < 0 else last
            low, first, stays = middle, value, -1
    step(phase, t, high, y, scale, work, new)
    return high


@inlined
def _is_round(friction: DryFriction) -> bool:
    """Whether friction is singular where the rim has a point without slip: it has no sides."""
    if not is_mixed(friction):
        return True
    table = friction.by_speed.table
    return table[int(table[BASE]) + SIDES] == 0.0


@inlined
def first_event_on(
    phase: Phase, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """What happens first on a step to ``new`` that is no line, or NOTHING; when; ``new`` then."""
    radius, first = phase.model.body.radius, NOTHING
    for passed in range(2):
        what = NOTHING
        if passed == 0 and phase.mode == SLIDES and _is_round(phase.friction):
            what = EQUAL if slip_side(radius, y) * slip_side(radius, new) < 0.0 else what
        turns_over = y[SPIN] * new[SPIN] < 0.0 and jumps(phase.model.forces.drags)
        turns_over = turns_over and (
            has_sign(y[SPIN], size(y[VX], y[VY], 0.0))
            or has_sign(new[SPIN], size(new[VX], new[VY], 0.0))
        )
        if passed == 1 and phase.mode == SLIDES and turns_over:
            what = SPINLESS
        if what != NOTHING:
            when = zero(phase, what, t, h, y, scale, work, new)
            if what == EQUAL and t + when == t:  # the slip is too small for a step to tell
                step(phase, t, h, y, scale, work, new)
            else:
                first, h = what, when
    return first, h


@inner
def direction_of_end(phase: Phase, t: float, q: float, y: FloatArray, work: FloatArray) -> None:
    """Turn a slip of size q that begins into the direction that it keeps.

    A small slip turns by Q n′ = a − (a·n) n, much faster than it grows; that is followed.
    """
    radius = phase.model.body.radius
    load, mass = phase.friction.load, phase.model.body.mass
    scale, before = 0.3 * mass / load, math.inf
    for _ in range(_TURNS):
        rates(phase, t, y, work, SECOND)
        wx, wy, ww = y[VX] / q, y[VY] / q, radius * y[SPIN] / q
        ax, ay, aw = work[SECOND, VX], work[SECOND, VY], radius * work[SECOND, SPIN]
        gain = ax * wx + ay * wy + aw * ww
        ox, oy, ow = ax - gain * wx, ay - gain * wy, aw - gain * ww
        off = size(ox, oy, ow)
        if not off > _CONVERGED * load / mass:
            return
        scale *= 0.7 if off > before else 1.03
        before = off
        wx, wy, ww = wx + scale * ox, wy + scale * oy, ww + scale * ow
        whole = q / size(wx, wy, ww)
        y[VX], y[VY], y[SPIN] = whole * wx, whole * wy, whole * ww / radius


@inlined
def goes_straight(
    phase: Phase, speed: float, tolerance: float, unit: float, t: float, q: float, pull: float,
    slow: float, y: FloatArray, work: FloatArray,
) -> tuple[tuple[float, float, float, float], float]:  # fmt: skip
    """The way of a slip that is about to stop: its direction and rate; no rate: not yet.

    Also by how much, s, it may stop later: a direction that still turns may settle to the one that
    brakes least, of which what friction leaves at rest is known.  That must be a local error, in
    ``unit``, s, or the slip not be more than such errors are, ``tolerance``, of ``speed``: nobody
    knows which way it is turned.  What brakes slowly must have settled, and all else be small.
    """
    if slip_led(phase.model.hold, surface_now(phase, t), y) > 2.0 * REST * speed:
        return NO_DIRECTION, 0.0  # a constraint leads it on
    direction = stopping(phase.model.body.radius, y, work)
    brakes, mass = -direction[3], phase.model.body.mass
    if not brakes > 0.0:
        return NO_DIRECTION, 0.0
    still = q <= 2.0 * REST * speed
    across = math.sqrt(max(pull * pull - brakes * brakes, 0.0))
    small = _SLOW * phase.friction.load
    excess = excess_at_rest(phase, t, y)[0]
    least = max(-excess, small) / (mass * slow)
    late = q / brakes * max(brakes / least - 1.0, _UNLIKE) * min(across / brakes, 1.0)
    blurred = q <= _BLURRED * tolerance * speed
    quick = brakes > small / mass / slow and across <= brakes
    quick = quick and (blurred or late <= tolerance * unit)
    if quick and len(phase.model.forces.drive) > 0:  # what brakes it may change until then
        change = excess_at_rest(phase, t + q / brakes, y)[0] - excess
        quick = 0.5 * q / brakes * abs(change) <= tolerance * unit * mass * brakes
    if excess > SLACK * phase.friction.load or not (quick or still):
        return NO_DIRECTION, 0.0
    return direction, late


@inner
def from_standstill(
    phase: Phase, speed: float, t: float, y: FloatArray, work: FloatArray
) -> tuple[int, bool, float]:
    """Its mode from now on, whether the slip that begins settles fast, and its size in ``y``.

    ``phase``: as it would be carried; ``speed``: the scale of speeds; ``work``: to work in.
    """
    model, load = phase.model, phase.friction.load
    excess, nx, ny, nw = excess_at_rest(phase, t, y)
    if excess <= SLACK * load:
        return STICKING, False, 0.0
    q = 2.0 * REST * speed
    if math.isnan(excess):  # no pressure carries it at rest: it tips, whatever a slip would do
        y[VX] = y[VY] = y[SPIN] = excess
        return SLIDES, False, q
    slips = Phase(model, phase.friction, phase.piece, SLIDES, NO_DIRECTION, 0.0)
    if model.surface.static > 1.0:  # once it slips that holds no more
        excess, nx, ny, nw = excess_at_rest(slips, t, y)
    if excess == math.inf:  # it is led where the floor does not go
        return SLIDES, False, 0.0
    if excess <= _QUICK * load:
        q = _FIRST * speed
        y[VX], y[VY], y[SPIN] = q * nx, q * ny, q * nw
        return SLIDES, True, q
    y[VX], y[VY], y[SPIN] = q * nx, q * ny, q * nw
    direction_of_end(slips, t, q, y, work)
    return SLIDES, True, q
