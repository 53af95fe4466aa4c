"""A lone puck whose motion is integrated, from where it sets off until something changes.

The equations are those of one puck (:mod:`puck_tables.scene.equations`), by steps of order 8, or of
Radau IIA where the direction of the slip settles much faster than the slip changes.  A step is as
many pieces of its path as it takes for polynomials of degree five to be as good as the promise,
between states that its stages give.  A path ends where the puck comes to rest on the floor or
leaves that rest, where its rim has come over a border of the floor or slips faster than a friction
law goes, at a horizon, and after so many steps; whatever else meets it is found on the path.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, on_demand, patience
from puck_tables.motion.steppers import times_as_long
from puck_tables.scene.equations import (
    FIRST,
    FORCE_WORK,
    ROW,
    SIZE,
    rates,
    settling_rates,
    slip_change,
    slip_rate,
    slip_speed,
    to_laboratory,
)
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X
from puck_tables.scene.ingredients import (
    FREE,
    NO_DIRECTION,
    PIVOT,
    SLIDES,
    STICKING,
    STOPS,
    DryFriction,
    Model,
    Phase,
    floor_velocity,
    is_mixed,
    surface_now,
)
from puck_tables.scene.moments import (
    NOTHING,
    REST,
    first_event_on,
    from_standstill,
    goes_straight,
    lost,
    rests_on,
)
from puck_tables.scene.over_time import rows_passed
from puck_tables.scene.steps import STAGES, follow_scales, step, up_to_the_stop
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import (
    choose_belt,
    friction_under_disc,
    moves_along,
    nears_another,
    outruns_law,
    room_on_floor,
)
from puck_tables.world.layout import (
    BELT_X,
    BELT_Y,
    EDGE,
    KIND,
    LIES,
    RADIUS,
    A,
    B,
    C,
)
from puck_tables.world.lone_model import horizon_of, model_of, surface_of, swings
from puck_tables.world.step_pieces import ENDED, LoneBuffer, buffer_on, write_step

LONGEST = 128  # pieces of a path, before it ends for a new look
_MOST = 8  # of them a step: shorter ones are needed where its stages do not tell more
FINEST = 1e-14  # error of a step in units of the scales: finer is rounding
_BEGIN = 0.1  # of Q/J: the first step
_SHORTEST = 1e-16  # of Q/J: shorter steps lead nowhere
_ROUNDED = 1e-14  # of the floor's velocity: a slip over it is not known better when a path begins
# the power of how far steps reach over what the one before did by which the next is shorter: of it
# and half as much again; but less is a kink that is passed
_GOES_ON, _SUDDEN = 1.5, 0.3
_BRIEF = 1e-6  # of Q/J: on as short a step what a piece misses is rounding
_NEAR = 0.75  # of the time in which the slip would end, at most, is a step
_LAST = 0.03  # of the root of the error of a step: slips as small may go straight to their stop
# a step is implicit in which the direction of the slip settles by so much (or by so much, where the
# one before was implicit), if the slip changes by no more than that share of it
_STIFF, _MILD, _SLOWLY = 0.8, 0.3, 0.1
_NEWTON, _FINEST_NEWTON = 1e-3, 1e-15  # of the error of a step: how well implicit ones are solved
_SWING = 0.05  # rad that a floor turns under a puck at rest in a step, or half as it spins up
_OVER = 1e-12  # of a radius: beyond a border


@inlined
def _lay_out(
    engine: Engine, model: Model, t: float, state: FloatArray, tol: float, buffer: LoneBuffer
) -> None:
    """The state at the start, relative to the floor, and the scales of errors."""
    body, speed = model.body, engine.scale[0]
    length, energy = speed * speed / engine.scale[1], body.mass * speed * speed
    slow = max(1.0, 2.0 * body.inertia / (body.mass * body.radius * body.radius))
    for n in range(SIZE):
        buffer.y[n] = state[n] if n < FORCE_WORK else 0.0
        buffer.scale[n] = length if n < VX else (speed if n < FORCE_WORK else energy)
    buffer.scale[THETA] = length / body.radius
    buffer.scale[SPIN] = speed / (slow * body.radius)
    follow_scales(buffer.scale, tol, engine.scale[1], body, buffer.y)
    to_laboratory(surface_of(model, t), buffer.y, -1.0)


@inlined
def _leads_off(engine: Engine, i: int, buffer: LoneBuffer) -> bool:
    """Whether a step has led to where there is another friction, or none is known.

    The rim has come over a border, or left it, or the centre over an edge, or it slips faster than
    a law goes, or least over another belt.
    """
    y, disc, radius = buffer.new, engine.discs[i], engine.discs[i, RADIUS]
    vx, vy = y[VX] + disc[BELT_X], y[VY] + disc[BELT_Y]
    if nears_another(engine, i, y[X], y[X + 1], vx, vy):
        return True
    if outruns_law(engine, i, y[VX], y[VY], y[SPIN]):
        return True
    for k in range(engine.obstacles.shape[0]):
        row = engine.obstacles[k]
        if int(row[KIND]) == EDGE and row[A] * y[X] + row[B] * y[X + 1] < row[C]:
            return True
    if engine.discs.shape[1] == LIES:
        return False
    before = room_on_floor(engine, i, buffer.y) + _OVER * radius
    return before > 0.0 > room_on_floor(engine, i, y) + _OVER * radius


@inlined
def _longest(
    phase: Phase, t: float, h: float, q: float, speed: float, target: float, buffer: LoneBuffer
) -> tuple[float, bool]:
    """A step, and whether it ends at the target.

    Shorter where the slip is about to end, or may turn; at rest, where what holds it changes.
    """
    y, surface, radius = buffer.y, surface_now(phase, t), phase.model.body.radius
    if phase.mode == SLIDES and phase.friction.load > 0.0:
        pull, least = slip_rate(radius, buffer.stages), REST * speed
        h = up_to_the_stop(phase, h, q, least, pull, _NEAR, y, buffer.stages)
    elif phase.mode == STICKING:
        if surface.spin != 0.0:
            h = min(h, _SWING / abs(surface.spin))
        if surface.turn != 0.0:
            h = min(h, math.sqrt(_SWING / abs(surface.turn)))
        if is_mixed(phase.friction):
            sx, sy, _ = floor_velocity(surface, y[X], y[X + 1])
            h = min(h, _SWING * radius / max(math.hypot(sx, sy), 1e-300))
    landed = t + (1.0 if phase.mode == STOPS else 1.1) * h >= target
    return target - t if landed else h, landed


@inlined
def _keeps_direction(model: Model) -> bool:
    """Whether a pivot at rest leaves a slip on a floor at rest no direction to settle to."""
    hold = model.hold
    still = hold.vx == 0.0 and hold.vy == 0.0 and not moves_along(model.surface)
    return hold.kind == PIVOT and still


@inlined
def _is_stiff(model: Model, load: float, stiff: bool, h: float, q: float, pull: float) -> bool:
    """Whether the direction of the slip settles much faster than it changes."""
    if _keeps_direction(model):
        return False
    damps, turns = settling_rates(model, load)
    damping = h * (damps + turns / q if q > 0.0 else damps)
    return pull < _SLOWLY * (damps * q + turns) and damping > (_MILD if stiff else _STIFF)


@inlined
def _goes_on(
    phase: Phase, t: float, vx: float, vy: float, spin: float, q: float, y: FloatArray,
    work: FloatArray,
) -> float:  # fmt: skip
    """Let a slip go on that the path before began, where it grows; else it begins anew, with q."""
    radius, begun = phase.model.body.radius, (y[VX], y[VY], y[SPIN])
    y[VX], y[VY], y[SPIN] = vx, vy, spin
    rates(phase, t, y, work, FIRST)
    if slip_change(radius, y, work) > 0.0:
        return slip_speed(radius, y)
    y[VX], y[VY], y[SPIN] = begun
    return q


@inlined
def _is_held(phase: Phase, t: float, h: float, buffer: LoneBuffer) -> tuple[float, bool]:
    """How long of a step over h a puck at rest is held by the floor, and whether it is lost."""
    if phase.mode != STICKING:
        return h, False
    slips = lost(phase, t, h, buffer.y, buffer.scale, buffer.stages, buffer.new)
    length = min(slips, h)
    step(phase, t, length, buffer.y, buffer.scale, buffer.stages, buffer.new)
    return length, slips < math.inf


@inlined
def _from_rest(
    engine: Engine, i: int, model: Model, friction: DryFriction, rows: int, t: float, slow: float,
    begins: bool, buffer: LoneBuffer,
) -> tuple[int, bool, float, bool]:  # fmt: skip
    """How it goes on with no slip but what rounding leaves: mode, whether stiff, slip, and rests.

    ``slow``: the slip it has; where it ``begins`` so, it may be what the path before began, unless
    it is less than velocities in the laboratory are rounded to.
    """
    y, speed = buffer.y, engine.scale[0]
    vx, vy, spin = y[VX], y[VY], y[SPIN]
    y[VX] = y[VY] = y[SPIN] = 0.0
    at_rest = Phase(model, friction, rows, STICKING, NO_DIRECTION, 0.0)
    mode, stiff, q = from_standstill(at_rest, speed, t, y, buffer.stages)
    sx, sy, turning = floor_velocity(surface_of(model, t), y[X], y[X + 1])
    rounded = _ROUNDED * (math.hypot(sx, sy) + model.body.radius * abs(turning))
    if mode == SLIDES and begins and slow > max(q, rounded):
        q = _goes_on(Phase(model, friction, rows, SLIDES, NO_DIRECTION, 0.0), t, vx, vy, spin, q, y,
                     buffer.stages)  # fmt: skip
    rests = mode == STICKING and not swings(engine, i, model, friction, rows)
    rests = rests and rests_on(model, friction, rows, y)
    return mode, stiff and not _keeps_direction(model), q, rests


@inlined
def _last_of(
    phase: Phase, scale: FloatArray, tol: float, t: float, q: float, h: float,
    buffer: LoneBuffer,
) -> tuple[Phase, float]:  # fmt: skip
    """The last of a slip q, straight to its stop if it may, and how long a step is then, else h."""
    y, stages, speed, unit = buffer.y, buffer.stages, scale[0], scale[0] / scale[1]
    body = phase.model.body
    slow = max(1.0, 2.0 * body.inertia / (body.mass * body.radius * body.radius))
    pull = slip_rate(body.radius, stages)
    direction, _ = goes_straight(phase, speed, tol, unit, t, q, pull, slow, y, stages)
    if not direction[3] < 0.0:
        return phase, h
    straight = Phase(phase.model, phase.friction, phase.piece, STOPS, direction, 0.0)
    rates(straight, t, y, stages, FIRST)
    return straight, -q / direction[3]


@inlined
def _go_on_from(model: Model, tol: float, accel: float, buffer: LoneBuffer) -> None:
    """The end of a step is the start of the next."""
    for n in range(SIZE):
        buffer.y[n] = buffer.new[n]
    for n in range(ROW):
        buffer.stages[0, n] = buffer.ends[ENDED, n]
    follow_scales(buffer.scale, tol, accel, model.body, buffer.y)


@inlined
def _put_down(model: Model, t: float, state: FloatArray, buffer: LoneBuffer) -> None:
    """Where it rests, in the laboratory, into ``state`` (6,)."""
    to_laboratory(surface_of(model, t), buffer.y, 1.0)
    for n in range(FORCE_WORK):
        state[n] = buffer.y[n]


@inlined
def _held_back(grows: float, failed: bool, reach: float, before: float) -> float:
    """How many times as long the next step is, where errors of steps would let it be ``grows``.

    Not longer than one that took a second trial; and where steps get shorter, for friction is
    singular ahead, as if that went on.  ``reach``: how long the step might have been, and the one
    ``before``.
    """
    grows = min(grows, 1.0) if failed else grows
    shrinks = reach / before if reach < before < math.inf else 1.0
    return grows * max(shrinks, _SUDDEN) ** _GOES_ON


@on_demand("boolean", "float64", "int64", "boolean")
def follow_alone(
    engine: Engine, i: int, t: float, state: FloatArray, work: FloatArray
) -> tuple[bool, float, int, bool]:  # fmt: skip
    """Follow a disc from its state at t: whether it can be, until when, and by how many pieces.

    And whether the floor carries it all along.  The pieces stand after all that there are, and what
    they did to the energies after all works, uncounted.  Where it rests for good there are none,
    until inf; ``state`` (6,) is moved to rest.  Where it cannot be it tips by then, or at inf not.
    """
    choose_belt(engine, i, state)
    model, buffer = model_of(engine, i), buffer_on(work)
    friction = friction_under_disc(engine, i)
    y, new, stages = buffer.y, buffer.new, buffer.stages
    speed, unit, radius = engine.scale[0], engine.scale[0] / engine.scale[1], model.body.radius
    tol, drive, load = max(engine.scale[2], FINEST), model.forces.drive, friction.load
    _lay_out(engine, model, t, state, tol, buffer)
    straight, horizon = _LAST * math.sqrt(tol) * speed, horizon_of(engine, model, t)
    now, passed, h, count, mode, direction = t, 0.0, _BEGIN * unit, 0, SLIDES, NO_DIRECTION
    undecided, known, stiff, over, rests, tips = True, False, False, False, False, math.inf
    before, failed, held = math.inf, False, True
    while now < horizon and count <= LONGEST - _MOST and not over:
        patience(1)
        rows = rows_passed(drive, 0, len(drive), now)
        target = min(drive[rows, 0], horizon) if rows < len(drive) else horizon
        q = slip_speed(radius, y)
        if undecided:
            was, mode, direction = mode, SLIDES, NO_DIRECTION
            if load > 0.0 and q <= REST * speed:
                mode, stiff, q, rests = _from_rest(
                    engine, i, model, friction, rows, now, q, count == 0, buffer
                )
                if rests or ((mode == STICKING) != (was == STICKING) and count > 0 and now > t):
                    break
                h = target - now if mode == STICKING else h
        newton = max(_NEWTON * tol, _FINEST_NEWTON) if stiff and mode == SLIDES else 0.0
        phase = Phase(model, friction, rows, mode, direction, newton)
        if undecided or not known:
            rates(phase, now, y, stages, FIRST)
        undecided, known = False, True
        if mode == SLIDES and load > 0.0 and 0.0 < q <= straight:
            phase, h = _last_of(phase, engine.scale, tol, now, q, h, buffer)
            mode, direction, newton = phase.mode, phase.direction, phase.newton
        whole, landed = _longest(phase, now, h, q, speed, target, buffer)
        error = step(phase, now, whole, y, buffer.scale, stages, new)
        grows = times_as_long(error, tol, 0.25 if newton > 0.0 else 0.125, 0.1)
        nowhere = not math.isfinite(stages[STAGES - 1, VX])
        if nowhere or not error <= tol:
            # it tips there: a quarter as far, time and again; a table only ends with its law
            falls = nowhere and newton == 0.0 and is_mixed(friction)
            tips, failed = now + whole if falls else tips, failed or not falls
            h = whole * (0.25 if falls else grows)
            if falls and h < tol * unit and 0.0 < q <= straight:  # it stops before, if it is held
                y[VX] = y[VY] = y[SPIN] = straight = 0.0
                undecided, tips = True, math.inf
            elif h < (tol if falls else _SHORTEST) * unit:
                tips = tips if falls else math.inf
                break
            continue
        stuck, length = first_event_on(phase, now, whole, y, buffer.scale, stages, new)
        if not math.isfinite(new[VX]):  # a shorter implicit step, which was not solved
            h = 0.25 * length
            continue
        length, slips = _is_held(phase, now, length, buffer)
        landed = landed and stuck == NOTHING and not slips
        most = _MOST if length > _BRIEF * unit else 1
        parts, coarse, longest = write_step(engine, phase, now, length, count, tol, most, buffer)
        if most > 1 and coarse > 1.0 and longest < length:
            h = longest
            continue
        reach = whole * (tol / error) ** 0.125 if newton == 0.0 and error > 0.0 else math.inf
        h = min(whole * _held_back(grows, failed, reach, before), longest if most > 1 else math.inf)
        before, failed, held = reach, False, held and mode == STICKING
        count, passed = count + (parts if length > _SHORTEST * unit else 0), passed + length
        now = target if landed else max(t + passed, now + length)  # ``passed`` may be rounded off
        h = min(h, 0.5 * (tips - now)) if now < tips else h
        over = _leads_off(engine, i, buffer) or 0.0 < tips - now < tol * unit
        _go_on_from(model, tol, engine.scale[1], buffer)
        larger, q = q, slip_speed(radius, y)
        if mode == SLIDES:
            stiff = _is_stiff(model, load, newton > 0.0, length, q, slip_rate(radius, stages))
        undecided = landed or slips or mode == STOPS or (q <= REST * speed and q < larger)
        known = not undecided and model.hold.kind == FREE
    if count > 0 and now > t:
        return True, now, count, held
    _put_down(model, now, state, buffer)
    return rests, tips, 0, True
