"""Until when discs move over their floor, and until when a run goes on that is given no time.

At rest on a floor that moves a disc may still come to what sets it off: a border, a cushion, an
edge.  A belt carries it there or not at all; a turntable comes round again, so that one whole turn
shows all that will ever happen.  And up to which slip a friction law of the floor is known, as
pucks get faster on the way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import ContactError, InputError, SpeedError
from puck_tables.kernels.compile import inlined, inner, kernel
from puck_tables.scene.by_speed import FARTHER, end_of_laws, laws_in
from puck_tables.scene.equations import SIZE
from puck_tables.scene.forces import SLIDING
from puck_tables.scene.ingredients import NO_DIRECTION, SLIDES, DryFriction, Phase
from puck_tables.scene.over_time import FLOOR_SPIN, FLOOR_X, FLOOR_Y
from puck_tables.scene.rest import excess_at_rest
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import LAUNCH_TIME, N_EVENTS, N_HISTORY, TIME, Engine, Whole
from puck_tables.world.floor_under import SURE, floor_of, law_goes_to, law_under, least_slip
from puck_tables.world.floors import slip_of_rim
from puck_tables.world.layout import DRAG, INV_INERTIA, INV_MASS, PULL_X, PULL_Y, RADIUS, TWIST
from puck_tables.world.lone_model import model_of
from puck_tables.world.paths import BEGINS, DURATION, FOR_EVER
from puck_tables.world.prepare import with_law_up_to
from puck_tables.world.segment import (
    DAMPED,
    FIRST_PIECE,
    GONE,
    LAST_PIECE,
    LOOKED_UP,
    PATH,
    RIDES,
    RIDING,
    START,
    UNTIL,
    state_at,
)  # fmt: skip
from puck_tables.world.segment_starts import STALE, Room
from puck_tables.world.setting_off import REACHED, UNSEEN

STUCK, _WITHIN = 1e-11, 10.0  # of the scale of speeds, and times the error of a step in it
LONG = 100.0  # times what friction takes, at most: whatever moves then may never stop
_FAR = 10.0  # times that limit: what a belt carries discs to by then is waited for
_SLOWEST = 1e-9  # of the largest friction: what brakes less than that does not brake
_UNKNOWN, _NOT_YET = -2.0, -1.0  # in place of a time
# of a run without a time, beside how :func:`puck_tables.world.engine.advance` ends
GOES_ON, ENDED = -1, REACHED
ROUND, NEVER_ENDS, LEADS_ON = range(UNSEEN + 1, UNSEEN + 4)


@inlined
def at_rest_below(engine: Engine) -> float:
    """A slip, m/s, that is none: steps end at 1e-12 of the scale; within one less is known."""
    return max(STUCK, _WITHIN * engine.scale[2]) * engine.scale[0]


@inlined
def _slip_at(engine: Engine, n: int, t: float, room: Room) -> float:
    """The slip, m/s, of the disc of a segment, a row of the history, on it at t."""
    segment = engine.history[n]
    i, state = int(segment[0]), room.one
    state_at(
        int(segment[1]), segment[2:], engine.discs[i], engine.lookups, engine.pieces, t, room.work,
        state,
    )  # fmt: skip
    return least_slip(engine, i, state, t)


@inlined
def middle_of(engine: Engine, n: int, end: float) -> float:
    """A moment on a path up to its end, between two pieces, where its velocities are known best.

    A path that leads from rest to rest, or is cut short before it is fast, slips there.
    """
    segment = engine.history[n, 2:]
    piece, last = int(segment[FIRST_PIECE]), int(segment[LAST_PIECE]) - 1
    while last > piece and engine.pieces[last, BEGINS] >= end:
        last -= 1
    if piece == last:
        return engine.pieces[last, BEGINS] + engine.pieces[last, DURATION]
    half = 0.5 * (engine.pieces[piece, BEGINS] + engine.pieces[last, BEGINS])
    while engine.pieces[piece, BEGINS] < half:
        piece += 1
    return engine.pieces[piece, BEGINS]


@inlined
def _floor_stops(engine: Engine, i: int) -> float:
    """When the floor over time under a disc comes to rest; inf: it never moves, or goes on."""
    first, row = engine.spans[i, 0], engine.spans[i, 1] - 1
    if engine.surface.changes == 0.0:
        return math.inf
    stops = math.inf
    while row >= first:
        over = engine.forcing[row]
        if over[FLOOR_X] != 0.0 or over[FLOOR_Y] != 0.0 or over[FLOOR_SPIN] != 0.0:
            return stops
        stops = over[0]
        row -= 1
    return math.inf


@inner
def moves_on(engine: Engine, n: int, end: float, room: Room) -> float:
    """Until when somebody moves over the floor on a segment that ended so; −inf: not at all.

    Or until a floor stops that carried it, and moves no more.
    """
    kind, segment = int(engine.history[n, 1]), engine.history[n, 2:]
    start = segment[START]
    if kind == GONE:
        return start
    if kind == LOOKED_UP:
        return min(segment[UNTIL], end)
    if kind == DAMPED:
        return end
    if kind == PATH:
        driven = engine.discs[int(engine.history[n, 0]), INV_MASS] == 0.0
        end = min(end, segment[UNTIL])
        if driven or _slip_at(engine, n, start, room) > at_rest_below(engine):
            return end
        slips = _slip_at(engine, n, middle_of(engine, n, end), room) > STUCK * engine.scale[0]
        if slips and segment[RIDES] == 0.0:
            return end
        stops = _floor_stops(engine, int(engine.history[n, 0]))
        return min(end, stops) if stops < math.inf else -math.inf
    return -math.inf


@kernel
def fill_motion_ends(engine: Engine, room: Room, out: FloatArray) -> None:
    """Until when each disc has moved over the floor (n,), or when it left play; inf: it still does.

    0: it has lain there since the start.
    """
    now = engine.clock[0]
    for i in range(out.size):
        out[i], room.before[i, 0] = _UNKNOWN, now
    for n in range(engine.counts[N_HISTORY] - 1, -1, -1):
        i = int(engine.history[n, 0])
        if out[i] >= 0.0:
            continue
        current = out[i] == _UNKNOWN and int(engine.history[n, 1]) != GONE
        end = moves_on(engine, n, room.before[i, 0], room)
        if current and end >= now and engine.history[n, 2 + UNTIL] > now:
            end = math.inf
        out[i] = max(end, _NOT_YET)
        room.before[i, 0] = engine.history[n, 2 + START]
    for i in range(out.size):
        out[i] = max(out[i], 0.0)


@kernel
def next_target(
    engine: Engine, limit: float, scheduled: float, room: Room, ends: FloatArray
) -> tuple[int, float]:
    """Whether a run without a time goes on from now, and until when; or how it ended, and when.

    NEVER_ENDS: at the limit somebody still moves over the floor; LEADS_ON: or is carried on to
    where it may slip; ROUND: the floor carries discs over the same borders again and again.
    ``scheduled``: when the last launch, force or film is over; ``ends`` (n,): to work in.
    """
    now, turning = engine.clock[0], abs(engine.surface.spin)
    turn = 2.0 * math.pi / turning if turning > 0.0 else math.inf
    fill_motion_ends(engine, room, ends)
    last, pending, carries = 0.0, math.inf, False
    for i in range(ends.size):
        last, pending = max(last, ends[i]), min(pending, engine.next_time[i])
        carries = carries or engine.kinds[i] in (RIDING, PATH)
    count = engine.counts[N_EVENTS]
    happened = engine.events[count - 1, TIME] if count > 0 else 0.0
    if last == math.inf:
        return (NEVER_ENDS, now) if now >= limit else (GOES_ON, min(limit, now + turn))
    if carries and turning > 0.0:
        turned = max(last, scheduled) + turn
        if now < turned:
            return GOES_ON, turned
        return (ROUND, turned) if happened > last else (ENDED, last)
    if now < limit:
        return GOES_ON, limit
    if pending == math.inf:
        return ENDED, max(last, happened)
    return (GOES_ON, pending) if pending <= _FAR * limit else (LEADS_ON, now)


def limits_of(engine: Engine, scales: FloatArray) -> tuple[FloatArray, float]:
    """Until when runs without a time are followed, s, and when all that they are given is over.

    ``scales`` (n, 2): their scales of speed and acceleration.
    """
    prescribed = prescribed_until(engine)
    return max(float(engine.clock[0]), prescribed) + longest_of(engine, scales), prescribed


@kernel
def prescribed_until(engine: Engine) -> float:
    """When the last launch, force or film is over, s."""
    last = 0.0
    for row in range(engine.launches.shape[0]):
        last = max(last, engine.launches[row, LAUNCH_TIME])
    for row in range(engine.forcing.shape[0]):
        last = max(last, engine.forcing[row, 0])
    for i in range(engine.drives.shape[0]):
        for row in range(engine.drives[i, 0], engine.drives[i, 1]):
            if engine.pieces[row, DURATION] < FOR_EVER:
                last = max(last, engine.pieces[row, BEGINS] + engine.pieces[row, DURATION])
    return last


def longest_of(engine: Engine, scales: FloatArray) -> FloatArray:
    """LONG times what the least friction takes at such scales of speed and acceleration, s."""
    lever, pushed, drags = braking_of(engine)
    times = np.maximum(lever * (scales[:, 0] + pushed), scales[:, 0] / scales[:, 1])
    return LONG * np.maximum(times, drags)


def braking_of(engine: Engine) -> tuple[float, float, float]:
    """How long the least friction takes over a speed, s²/m, what forces add to it, m/s; drag, s."""
    free = engine.discs[engine.discs[:, INV_MASS] > 0.0]
    decels = engine.floors[:, 0]
    brakes = _brakes(engine)
    brakes = brakes[(decels > 0.0) & (brakes > _SLOWEST * decels.max())]
    arms = free[:, INV_MASS] / (free[:, INV_INERTIA] * free[:, RADIUS] ** 2)  # k²
    lever = float((2.0 * arms).max(initial=1.0)) / float(brakes.min(initial=math.inf))
    drags = free[free[:, DRAG + SLIDING] > 0.0, DRAG + SLIDING]
    return lever, float(_pushed(engine).max()), float((1.0 / drags).max(initial=0.0))


def _brakes(engine: Engine) -> FloatArray:
    """What friction leaves to brake every disc beside what pulls at it, by rows of floors, m/s²."""
    discs = engine.discs
    pulls = np.hypot(discs[:, PULL_X], discs[:, PULL_Y])
    brakes = np.abs(engine.floors[:, 0].reshape(-1, len(discs)) - pulls).ravel()
    if discs[:, TWIST].any():
        _fill_brakes(engine, np.zeros(SIZE), brakes)
    return brakes


@kernel
def _fill_brakes(engine: Engine, y: FloatArray, out: FloatArray) -> None:
    """What brakes discs that a torque turns: how far friction is from what it could just hold."""
    regions, count = engine.regions, engine.discs.shape[0]
    for row in range(out.size):
        i = row % count
        if engine.discs[i, TWIST] == 0.0 or regions.summed[row] or regions.load[row] == 0.0:
            continue
        law = law_under(engine, i)
        friction = DryFriction(regions.load[row], regions.delta[row], regions.limits[row], law)
        phase = Phase(model_of(engine, i), friction, 0, SLIDES, NO_DIRECTION, 0.0)
        excess = abs(excess_at_rest(phase, 0.0, y)[0])
        out[row] = min(excess, regions.load[row]) * engine.discs[i, INV_MASS]


def _pushed(engine: Engine) -> FloatArray:
    """What speed forces over time give every disc at most, m/s."""
    pushes = np.zeros(len(engine.discs))
    for i in np.flatnonzero(engine.spans[:, 0] < engine.spans[:, 1]).tolist():
        rows, disc = engine.forcing[slice(*engine.spans[i])], engine.discs[i]
        strength = np.hypot(rows[:, 1], rows[:, 2]) + np.abs(rows[:, 3]) / disc[RADIUS]
        pushes[i] = disc[INV_MASS] * np.trapezoid(strength, rows[:, 0])
    return pushes


def refuse_too_fast(engine: Engine, scene: SceneSpec, name: str, i: int, state: FloatArray) -> None:
    """Refuse a strike beyond what rows of the friction law of the floor say."""
    top = law_goes_to(engine.regions)
    fastest = slip_of_rim(
        engine.discs[i, RADIUS], floor_of(engine.surface, engine.discs[i]), state.tolist()
    )
    if fastest > top and top == end_of_laws(scene)[0]:
        raise InputError(
            f"{name}: its rim would slip at {fastest:.6g} m/s, and the friction law "
            f"{end_of_laws(scene)[1]} ends at {top:g} m/s: strike more softly, or give it more "
            "speeds"
        )


def with_law_for(
    engine: Engine, room: Room, scene: SceneSpec, order: Whole, names: Sequence[str], time: float
) -> Engine:
    """The state of the engine with friction that is known at all slips of those that set off now.

    Raises InputError if its law ends below one, or lifts part of a base there.
    """
    top = law_goes_to(engine.regions)
    if top == math.inf:
        return engine
    for i in np.flatnonzero(room.marks == STALE):
        fastest = slip_of_rim(
            engine.discs[i, RADIUS],
            floor_of(engine.surface, engine.discs[i]),
            room.states[i].tolist(),
        )
        if engine.discs[i, INV_MASS] == 0.0 or fastest < SURE * top:
            continue
        if top == end_of_laws(scene)[0]:
            raise SpeedError(
                f"at {time:.6g} s the rim of {names[order[i]]} slips at {fastest:.6g} m/s, and the "
                f"friction law {end_of_laws(scene)[1]} ends at {top:g} m/s: nothing is known "
                "beyond; give it more speeds"
            )
        top = min(FARTHER * fastest, end_of_laws(scene)[0])
        try:
            engine = with_law_up_to(engine, scene, order, top)
        except ContactError as error:  # at the launch the heights were in order
            raise InputError(
                f"at {time:.6g} s the rim slips at {fastest:.6g} m/s, where friction by "
                f"{', '.join(laws_in(scene))} tilts the pressure so much that part of a base would "
                "lift: a slip that grows may never stop; give a shorter time, or less that drives "
                "it"
            ) from error
    return engine
