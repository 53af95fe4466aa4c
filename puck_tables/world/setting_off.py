"""How discs set off: those whom an event concerns, and those whom somebody puts by hand."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.world.contact_row import ACTS, NX, NY, approach
from puck_tables.world.contact_search import SLOWEST
from puck_tables.world.engine_state import GOT, N_CONTACTS, N_EVENTS, PLACED, REMOVED, Engine
from puck_tables.world.floor_under import law_goes_to, lay_down, moves_along, slips
from puck_tables.world.impact import as_forces
from puck_tables.world.layout import (
    ARC,
    CORNER,
    DECEL,
    EDGE,
    HOLD,
    INV_MASS,
    KIND,
    OVERHANG,
    POCKET,
    PULL_X,
    PULL_Y,
    RADIUS,
    ROUNDED,
    SIDE,
    SPAN,
    kinetic,
    normal_to,
)
from puck_tables.world.multipliers import stop_slips
from puck_tables.world.segment import GONE, STILL
from puck_tables.world.segment_starts import (
    BY_HAND,
    CURRENT,
    SENT,
    STALE,
    Room,
    drive_on,
    hang_over,
    integrate,
    lacks_pieces,
    leave,
    locate,
    note,
    take_off,
)  # fmt: skip
from puck_tables.world.touching import (
    find_touching,
    is_integrated,
    press_somewhere,
    sets_off_too_fast,
)

# how a call of the engine ends
(
    REACHED, FULL, CROWDED, TANGLED, PAUSED, PUSHING, OFF_TABLE, TOO_SHORT, MISPLACED, UNSEEN,
) = range(10)  # fmt: skip

OVERLAP = 1e-11  # of the radius: what pushes overlaps by less, and may be put where it was
SURELY = 1.0 - 1e-12  # of the fastest slip yet: below it rounding makes none faster
_KEPT, _PUT, _MOVED, _MATE = range(4)  # what is done to a disc: nothing, a state, also a place
_ROUNDED = 4e-16  # of the speeds of both: less cannot be taken out
_ROUNDS = 8  # of contacts that approach as others are stopped, at most


@inlined
def _moves(engine: Engine, room: Room, i: int) -> bool:
    """Whether it is a disc that gives way: the floor holds none that is at rest."""
    if i < 0 or engine.discs[i, INV_MASS] == 0.0:
        return False
    disc = engine.discs[i]
    steep = engine.surface.static * disc[DECEL] <= math.hypot(disc[PULL_X], disc[PULL_Y])
    return steep or slips(engine, i, room.states[i])


@inlined
def _speed(room: Room, i: int) -> float:
    return math.hypot(room.states[i, VX], room.states[i, VY]) if i >= 0 else 0.0


@inner
def quieten(engine: Engine, count: int, t: float, room: Room) -> None:
    """Take out of the contacts found what approaches too slowly for an impact: mere rounding.

    Over seconds discs would creep into each other by it.  What the floor holds at rest stays.  Who
    changes is marked; whole groups are already, whoever of them is touched.
    """
    contacts, rows, buffer = room.contacts, room.rows, room.buffer
    for n in range(count):
        rows[n, ACTS] = 0.0
    for _ in range(_ROUNDS):
        more = False
        for n in range(count):
            i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
            un, _ = approach(engine, i, j, row[NX], row[NY], room.states)
            least = _ROUNDED * (_speed(room, i) + _speed(room, j))
            if row[ACTS] > 0.0 or not least < un <= SLOWEST * engine.scale[0]:
                continue
            if _moves(engine, room, i) or _moves(engine, room, j):
                row[ACTS], more = 1.0, True
        acting = as_forces(engine, t, contacts, count, rows, room.states, buffer) if more else 0
        if acting <= 0:
            return
        for n in range(count):
            for m in range(2):
                i = contacts[n, m]
                if rows[n, ACTS] == 0.0 or i < 0:
                    continue
                if _moves(engine, room, i):
                    room.marks[i] = STALE
                else:
                    buffer.inverse[i, 0] = buffer.inverse[i, 1] = 0.0
        modes = buffer.modes[0, :acting]
        modes[:] = 1
        stop_slips(buffer, modes, room.states)


@inlined
def take_off_all(engine: Engine, t: float, room: Room) -> int:
    """New segments of all that are concerned and not driven; how it ended.

    FULL: not yet of all; TOO_SHORT: no step is short enough to follow one.
    """
    for j in range(engine.discs.shape[0]):
        driven = engine.drives[j, 0] < engine.drives[j, 1]
        if room.marks[j] != STALE or engine.kinds[j] == GONE or driven:
            continue
        if is_integrated(engine, j, room.states[j]):
            if lacks_pieces(engine):
                return FULL
            if not integrate(engine, j, t, room):
                return TOO_SHORT
        else:
            take_off(engine, j, t, room)
        room.marks[j] = SENT
    return REACHED


@inlined
def go_on(engine: Engine, t: float, count: int, room: Room) -> int:
    """New segments of all that are concerned.

    PUSHING: some push each other, or slip faster than the friction law is known: before, the caller
    does what is to be done.
    """
    engine.counts[N_CONTACTS] = count
    quieten(engine, count, t, room)
    pushes = press_somewhere(engine, count, t, room)
    for j in range(engine.discs.shape[0]):
        pushes = pushes or (room.marks[j] == STALE and sets_off_too_fast(engine, j, room.states[j]))
    return PUSHING if pushes else take_off_all(engine, t, room)


@inlined
def _depth_in(obstacle: FloatArray, disc: FloatArray, x: float, y: float) -> float:
    """How deep a disc would lie in what stands, or in a hole, m; at most 0: not at all."""
    shape, driven = int(obstacle[KIND]), disc[INV_MASS] == 0.0
    if shape >= OVERHANG or (driven and shape in (POCKET, EDGE)):
        return 0.0
    gap, _, _, there = normal_to(obstacle, disc[RADIUS], x, y, 0.0)
    if shape == ARC and obstacle[SPAN] < 2.0 * math.pi and (not there or gap < -2.0 * disc[RADIUS]):
        return 0.0  # beside it, or behind
    if shape in (SIDE, CORNER) and not there:
        return 0.0
    return -gap


@inner
def _overlaps(engine: Engine, t: float, room: Room) -> bool:
    """Whether a disc that is moved would overlap: who and whom in ``room.contacts[0]``.

    And by how much, m, in ``room.work[0]``; all discs are located.
    """
    count = engine.discs.shape[0]
    for j in range(count):
        if room.shares[j] == _KEPT and engine.kinds[j] != GONE:
            locate(engine, j, t, room)
    for i in range(count):
        if room.shares[i] != _MOVED:
            continue
        x, y, radius = room.before[i, X], room.before[i, Y], engine.discs[i, RADIUS]
        far = abs(x) + abs(y) + radius
        for k in range(engine.obstacles.shape[0]):
            depth = _depth_in(engine.obstacles[k], engine.discs[i], x, y)
            if depth > OVERLAP * radius + 2.0 * ROUNDED * far:
                room.contacts[0, 0], room.contacts[0, 1], room.work[0] = i, -1 - k, depth
                return True
        for j in range(count):
            if j == i or (room.shares[j] == _KEPT and engine.kinds[j] == GONE):
                continue
            at = room.states[j] if room.shares[j] == _KEPT else room.before[j]
            depth = radius + engine.discs[j, RADIUS] - math.hypot(at[X] - x, at[Y] - y)
            if depth > OVERLAP * radius + 2.0 * ROUNDED * far:
                room.contacts[0, 0], room.contacts[0, 1], room.work[0] = i, j, depth
                return True
    return False


@inlined
def _put_down(engine: Engine, i: int, what: int, t: float, moved: bool, room: Room) -> None:
    """A disc gets its state, and an event says what that gave."""
    disc, state = engine.discs[i], room.states[i]
    before = 0.0
    if engine.kinds[i] != GONE:
        before = kinetic(disc, state[VX], state[VY], state[SPIN])
    for column in range(6):
        state[column] = room.before[i, column]
    if engine.kinds[i] == GONE:
        engine.kinds[i] = STILL
    note(engine, t, what, i, i, state[X], state[Y])
    after = kinetic(disc, state[VX], state[VY], state[SPIN])
    engine.events[engine.counts[N_EVENTS] - 1, GOT] = after - before
    if moved:
        hang_over(engine, i, t, state)
        lay_down(engine, i, state)
    if engine.drives[i, 0] < engine.drives[i, 1]:
        drive_on(engine, i, t, room)
        locate(engine, i, t, room)


@inlined
def _is_unseen(engine: Engine, i: int, swift: bool, state: FloatArray) -> bool:
    """Whether a state of a disc, if ``swift`` with another velocity, asks for more than a look."""
    disc = engine.discs[i]
    if disc[HOLD] != FREE or disc[INV_MASS] == 0.0:
        return True
    if moves_along(engine.surface) or law_goes_to(engine.regions) < math.inf:
        return True
    slip = math.hypot(math.hypot(state[VX], state[VY]), disc[RADIUS] * state[SPIN])
    return swift and not slip <= SURELY * engine.scale[0]


@inner
def put(engine: Engine, what: int, t: float, room: Room) -> int:
    """Give marked pucks the states ``room.before``, as by an impact from outside; how it ended.

    NaN in them stays as it is; nothing is PLACED where it is.  REMOVED: they leave play.
    MISPLACED: nothing was changed, for one would overlap, see :func:`_overlaps`.  UNSEEN: neither,
    for of those that are marked as BY_HAND one is more than a free disc that surely slips no faster
    than anything has yet.
    """
    count, moves = engine.discs.shape[0], False
    for i in range(count):
        room.shares[i] = _KEPT
        if room.marks[i] == CURRENT:
            continue
        locate(engine, i, t, room)
        changed, moved = what != PLACED, engine.kinds[i] == GONE and what != REMOVED
        swift = False
        for column in range(6):
            before = room.before[i, column]
            if math.isnan(before) or before == room.states[i, column]:
                room.before[i, column] = room.states[i, column]
            else:
                changed, moved, swift = True, moved or column <= Y, swift or column >= VX
        if room.marks[i] == BY_HAND and changed and _is_unseen(engine, i, swift, room.before[i]):
            return UNSEEN
        if moved:
            room.shares[i], moves = _MOVED, True
        elif changed:
            room.shares[i] = _PUT
    if moves and _overlaps(engine, t, room):
        return MISPLACED
    for i in range(count):  # and whoever pushes them, or is pushed by them
        if engine.group[i] == 0 or room.shares[i] in (_KEPT, _MATE):
            continue
        for j in range(count):
            if room.shares[j] == _KEPT and engine.group[j] == engine.group[i]:
                locate(engine, j, t, room)
                room.shares[j] = _MATE
    for i in range(count):
        if room.shares[i] in (_PUT, _MOVED):
            if what == REMOVED:
                leave(engine, i, t, REMOVED, i, room)
            else:
                _put_down(engine, i, what, t, room.shares[i] == _MOVED, room)
    for i in range(count):  # who has left play touches nobody
        touches = room.shares[i] != _KEPT and engine.kinds[i] != GONE
        room.marks[i] = STALE if touches else CURRENT
    contacts = find_touching(engine, t, room)
    if contacts < 0:
        return CROWDED
    for i in range(count):
        with_them = engine.group[i] > 0 and room.marks[i] != CURRENT
        is_involved = room.shares[i] != _KEPT or with_them
        room.marks[i] = STALE if is_involved else CURRENT
    return go_on(engine, t, contacts, room)
