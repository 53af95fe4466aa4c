"""When pucks pass the lines of a scene: found on the paths that they had, which no line changes.

A side is left when the room on it is used up: as with what stands in the way
(:mod:`puck_tables.world.borders`) it cannot be before s = 2g/(√(g′² + 2Ag) − g′) where the room g
is convex but for the acceleration A, so that steps of s reach the moment from before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience
from puck_tables.scene.floor_map import INSIDE, OUTSIDE, OVERLAPS
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.pucks_and_posts import Line
from puck_tables.world.borders import to_round
from puck_tables.world.contact_search import (
    SLOWEST,
    arc_step,
    distance_left,
    largest_accel,
    moment_there,
    once_round,
    safe_step,
)
from puck_tables.world.engine_state import ENTERS, LEAVES, N_HISTORY, PASSES, Engine, Whole
from puck_tables.world.floor_under import lies_to
from puck_tables.world.layout import RADIUS, ROUNDED
from puck_tables.world.segment import GONE, ROOM, START, moves_until, state_at

# columns of a line: a straight one goes from (A, B) to (C, D); a round one has the radius R > 0
# about (A, B)
A, B, C, D, R = range(5)
CENTRE, RIM = 0, 1  # what passes
# what is seen of one: its side, from when on it may leave it, and when it does; < 0: not looked for
SIDE, FROM, NEXT = range(3)
_NEXT = 4e-16  # of a moment: the next one is no later
UNKNOWN = -1  # on which side one lies that was put on the line
TIME, WHAT, WHO, LINE, AT_X, AT_Y, ACROSS = range(7)
COLUMNS = 7


def rows_of(lines: Sequence[Line]) -> FloatArray:
    """Lines as the kernels read them, array (lines, 5).

    >>> rows_of([Line((0.0, -1.0), (0.0, 1.0)), Line(centre=(2.0, 0.0), radius=0.5)]).tolist()
    [[0.0, -1.0, 0.0, 1.0, 0.0], [2.0, 0.0, 0.0, 0.0, 0.5]]
    """
    rows = [
        (*line.centre, 0.0, 0.0, line.radius)
        if line.start is None or line.end is None
        else (*line.start, *line.end, 0.0)
        for line in lines
    ]
    return np.array(rows, np.float64).reshape(-1, 5)


class Passings:
    """What passed the lines of a world so far.

    ``seen`` (discs, lines, 2, 3): where each lies to each line, with its centre and its rim;
    ``segments`` (discs + 1,): on which rows of the history they are, and how many were looked at.

    >>> Passings([], 3).rows.shape
    (0, 7)
    """

    def __init__(self, lines: Sequence[Line], discs: int, rimless: Sequence[bool] = ()) -> None:
        self.lines = rows_of(lines)
        self.seen = np.tile([UNKNOWN, 0.0, -1.0], (discs, len(lines), 2, 1))
        self.seen[np.flatnonzero(rimless), :, RIM, FROM:] = math.inf
        self.segments = np.append(np.full(discs, -1), 0)
        self.rows: FloatArray = np.zeros((0, COLUMNS))

    def copy(self) -> Passings:
        """One that goes on by itself."""
        other = object.__new__(Passings)
        kept = {name: one.copy() for name, one in self.__dict__.items() if name != "lines"}
        other.__dict__.update(kept, lines=self.lines)
        return other

    def with_disc(self, has_rim: bool) -> Passings:
        """One that follows a disc more, the last."""
        other, own = self.copy(), np.tile([UNKNOWN, 0.0, -1.0], (1, len(self.lines), 2, 1))
        if not has_rim:
            own[:, :, RIM, FROM:] = math.inf
        other.seen = np.concatenate([self.seen, own])
        other.segments = np.insert(self.segments, -1, -1)
        return other

    def follow(self, engine: Engine) -> None:
        """See what passed until now."""
        size = 16
        while self.lines.size:
            own, passings = self.copy(), np.zeros((size, COLUMNS))
            count = find_passings(
                engine, own.lines, own.seen, own.segments, np.empty(ROOM), np.empty(6), passings
            )
            if count <= size:
                passings = passings[:count]
                order = np.lexsort((passings[:, LINE], passings[:, WHO], passings[:, TIME]))
                own.rows = np.vstack([self.rows, passings[order]])
                self.__dict__.update(own.__dict__)
                return
            size *= 4


@inlined
def _away(line: FloatArray, part: int, x: float, y: float) -> float:
    """How far a place is from a line; of a centre left of it, or within, less than 0."""
    if line[R] > 0.0:
        return math.hypot(x - line[A], y - line[B]) - line[R]
    ax, ay, bx, by = x - line[A], y - line[B], line[C] - line[A], line[D] - line[B]
    if part == CENTRE:
        return (ay * -bx + ax * by) / math.hypot(bx, by)
    share = min(max((ax * bx + ay * by) / (bx * bx + by * by), 0.0), 1.0)
    return math.hypot(ax - share * bx, ay - share * by)


@inlined
def _look(
    line: FloatArray, part: int, side: int, radius: float, state: FloatArray, accel: float
) -> tuple[float, float, float]:
    """The room that is left on a side, how fast it changes, and how long it surely stays."""
    x, y, vx, vy = state[X], state[Y], state[VX], state[VY]
    if line[R] > 0.0:
        room, rate, step, _, _, _ = to_round(
            line[A] - x, line[B] - y, vx, vy, line[R], side, radius, accel
        )
        return room, rate, step
    ax, ay, bx, by = x - line[A], y - line[B], line[C] - line[A], line[D] - line[B]
    long = math.hypot(bx, by)
    if part == CENTRE:
        sign = 1.0 if side == OUTSIDE else -1.0
        room, rate = sign * (ax * by - ay * bx) / long, sign * (vx * by - vy * bx) / long
        return room, rate, safe_step(max(room, 0.0), rate, accel)
    share = min(max((ax * bx + ay * by) / (long * long), 0.0), 1.0)
    ox, oy = ax - share * bx, ay - share * by
    far = math.hypot(ox, oy)
    rate = (ox * vx + oy * vy) / far if far > 0.0 else 0.0
    if side == OVERLAPS:
        return radius - far, -rate, arc_step(max(radius - far, 0.0), ox, oy, vx, vy, accel)
    return far - radius, rate, safe_step(max(far - radius, 0.0), rate, accel)


@inlined
def _note(line: FloatArray, side: int, to: int, state: FloatArray, row: FloatArray) -> bool:
    """Write down a passing, if the line is there."""
    x, y = state[X], state[Y]
    if line[R] > 0.0:
        far = math.hypot(x - line[A], y - line[B])
        nx, ny = ((line[A] - x) / far, (line[B] - y) / far) if far > 0.0 else (1.0, 0.0)
    else:
        ax, ay, bx, by = x - line[A], y - line[B], line[C] - line[A], line[D] - line[B]
        long = math.hypot(bx, by)
        nx, ny = -by / long, bx / long
        along = ax * bx + ay * by
        if OVERLAPS not in (side, to) and not 0.0 <= along <= long * long:
            return False
    row[WHAT] = ENTERS if to == OVERLAPS else LEAVES if side == OVERLAPS else PASSES
    row[AT_X], row[AT_Y] = x, y
    row[ACROSS] = state[VX] * nx + state[VY] * ny
    return True


@inlined
def _beyond(line: FloatArray, side: int, radius: float, state: FloatArray) -> int:
    """Where a disc comes that leaves a side now."""
    if radius == 0.0:
        return INSIDE if side == OUTSIDE else OUTSIDE
    if side != OVERLAPS:
        return OVERLAPS
    return INSIDE if _away(line, RIM, state[X], state[Y]) < 0.0 else OUTSIDE


@inlined
def _side_at_start(
    line: FloatArray, part: int, before: int, radius: float, rounded: float, state: FloatArray
) -> int:  # fmt: skip
    """On which side a segment begins; on the line itself it is the side from which one came."""
    away = _away(line, part, state[X], state[Y])
    if abs(abs(away) - radius) > rounded:
        return lies_to(away, radius)
    if before != UNKNOWN:
        return before
    side = INSIDE if away < 0.0 and part == RIM else OUTSIDE
    _, rate, _ = _look(line, part, side, radius, state, 0.0)
    if rate == 0.0:
        return UNKNOWN
    return _beyond(line, side, radius, state) if rate < 0.0 else side


@inner
def _next_passing(
    engine: Engine, n: int, last: float, until: float, line: FloatArray, part: int,
    seen: FloatArray, room: FloatArray, state: FloatArray,
) -> float:  # fmt: skip
    """When a side is left on a segment, up to a time, else inf; the state then in ``state``.

    < 0: not until then, nor before ``seen[FROM]``.
    """
    kind, segment = int(engine.history[n, 1]), engine.history[n, 2:]
    disc, t, side = engine.discs[int(engine.history[n, 0])], seen[FROM], int(seen[SIDE])
    radius = disc[RADIUS] if part == RIM else 0.0
    while True:
        patience(1)
        state_at(kind, segment, disc, engine.lookups, engine.pieces, t, room, state)
        rounded = ROUNDED * (abs(state[X]) + abs(state[Y]) + radius + line[R])
        accel = largest_accel(kind, segment, disc, state, t)
        gap, rate, step = _look(line, part, side, radius, state, accel)
        if gap > distance_left(kind, segment, disc, state, t) * (1.0 + 1e-9):
            return math.inf
        if gap <= rounded:
            if rate < -SLOWEST * engine.scale[0]:
                return t
            step = max(step, moment_there(rounded, abs(rate), accel, t))
        if t + step > last or step == math.inf:
            return math.inf
        t = max(t + step, t * (1.0 + _NEXT) + _NEXT * _NEXT)
        if t > until:
            seen[FROM] = t
            return -1.0


@inner
def _along(
    engine: Engine, n: int, until: float, line: FloatArray, part: int, seen: FloatArray,
    room: FloatArray, state: FloatArray, passings: FloatArray, count: int,
) -> int:  # fmt: skip
    """What passes a line on a segment; how many rows of ``passings`` are used, or would be."""
    i, kind, segment = int(engine.history[n, 0]), int(engine.history[n, 1]), engine.history[n, 2:]
    if kind == GONE:
        return count
    radius = engine.discs[i, RADIUS] if part == RIM else 0.0
    if seen[SIDE] == UNKNOWN or seen[FROM] == segment[START]:
        state_at(
            kind, segment, engine.discs[i], engine.lookups, engine.pieces, segment[START], room,
            state,
        )  # fmt: skip
        rounded = ROUNDED * (abs(state[X]) + abs(state[Y]) + radius + line[R])
        seen[SIDE] = _side_at_start(line, part, int(seen[SIDE]), radius, rounded, state)
    while seen[NEXT] <= until and seen[SIDE] != UNKNOWN:
        if seen[NEXT] < 0.0:
            last = min(moves_until(kind, segment), once_round(kind, segment, seen[FROM]))
            far = until if last == math.inf else math.inf
            if seen[FROM] <= far:
                seen[NEXT] = _next_passing(engine, n, last, far, line, part, seen, room, state)
            if seen[NEXT] < 0.0:
                return count
            continue
        side, at = int(seen[SIDE]), seen[NEXT]
        state_at(kind, segment, engine.discs[i], engine.lookups, engine.pieces, at, room, state)
        to = _beyond(line, side, radius, state)
        row = passings[min(count, passings.shape[0] - 1)]
        if _note(line, side, to, state, row):
            row[TIME], row[WHO] = at, i
            count += 1
        seen[SIDE], seen[FROM], seen[NEXT] = to, at, -1.0
    return count


@kernel
def find_passings(
    engine: Engine, lines: FloatArray, seen: FloatArray, segments: Whole, room: FloatArray,
    state: FloatArray, passings: FloatArray,
) -> int:  # fmt: skip
    """All that passed until now; how many rows of ``passings`` it takes, perhaps too many.

    ``segments`` (discs + 1,): the row of the history on which a disc is; how many there were.
    """
    count, discs = 0, engine.discs.shape[0]
    begun = int(engine.counts[N_HISTORY])
    for n in range(segments[discs], begun + discs):
        patience(1)
        i = int(engine.history[n, 0]) if n < begun else n - begun
        until = engine.history[n, 2 + START] if n < begun else engine.clock[0]
        for k in range(lines.shape[0]):
            for part in range(2):
                if segments[i] >= 0 and seen[i, k, part, NEXT] <= until:
                    used = count
                    count = _along(
                        engine, segments[i], until, lines[k], part, seen[i, k, part], room, state,
                        passings, count,
                    )  # fmt: skip
                    for row in range(used, min(count, passings.shape[0])):
                        passings[row, LINE] = k
                if n < begun and seen[i, k, part, FROM] < math.inf:
                    seen[i, k, part, FROM], seen[i, k, part, NEXT] = until, -1.0
        if n < begun:
            segments[i] = n
    segments[discs] = begun
    return count
