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
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.patches import ASTRIDE, INSIDE, OUTSIDE
from puck_tables.scene.pieces import Line
from puck_tables.world.borders import to_round
from puck_tables.world.flight import FASTEST, GONE, ROOM, START, moves_until, state_at
from puck_tables.world.footing import lies_to
from puck_tables.world.game import ENTERS, LEAVES, N_HISTORY, PASSES, Game, Whole
from puck_tables.world.layout import RADIUS
from puck_tables.world.meeting import QUIET, ROUNDED, arc_step, bend_of, safe_step

# columns of a line: a straight one goes from (A, B) to (C, D); a round one has the radius R > 0
# about (A, B)
A, B, C, D, R = range(5)
CENTRE, RIM = 0, 1  # what passes
UNKNOWN = -1  # on which side one lies that was put on the line
TIME, WHAT, WHO, LINE, AT_X, AT_Y, ACROSS = range(7)
COLUMNS = 7


def rows_of(lines: Sequence[Line]) -> FloatArray:
    """Lines as the kernels read them, array (lines, 5).

    Examples
    --------
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


def called_line(lines: Sequence[Line], number: int) -> str:
    """A line in an event.

    Examples
    --------
    >>> called_line([Line((0.0, 0.0), (1.0, 0.0)), Line((0.0, 1.0), (1.0, 1.0), name="goal")], 1)
    'goal'
    """
    return lines[number].name or f"line {number}"


class Passings:
    """What passed the lines of a world so far.

    Examples
    --------
    >>> Passings([], 3).rows.shape
    (0, 7)
    """

    def __init__(self, lines: Sequence[Line], discs: int, rimless: Sequence[bool] = ()) -> None:
        self._lines = rows_of(lines)
        parts = (discs, len(lines), 2)
        self._sides, self._done = np.full(parts, UNKNOWN), np.zeros(parts)
        self._done[np.flatnonzero(rimless), :, RIM] = math.inf
        self._flights, self._seen = np.full(discs, -1), np.zeros(1, np.int64)
        self.rows: FloatArray = np.zeros((0, COLUMNS))

    def copy(self) -> Passings:
        """One that goes on by itself."""
        other = object.__new__(Passings)
        kept = {name: one.copy() for name, one in self.__dict__.items() if name != "_lines"}
        other.__dict__.update(kept, _lines=self._lines)
        return other

    def follow(self, game: Game) -> None:
        """See what passed until now."""
        size = 16
        while self._lines.size:
            own = self.copy()
            found = np.zeros((size, COLUMNS))
            count = _follow(
                game, own._lines, own._sides, own._done, own._flights, own._seen, np.empty(ROOM),
                np.empty(6), found,
            )  # fmt: skip
            if count <= size:
                order = np.lexsort((found[:count, LINE], found[:count, WHO], found[:count, TIME]))
                own.rows = np.vstack([self.rows, found[:count][order]])
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
    line: FloatArray, part: int, side: int, radius: float, state: FloatArray, bend: float
) -> tuple[float, float, float]:
    """The room that is left on a side, how fast it changes, and how long it surely stays."""
    x, y, vx, vy = state[X], state[Y], state[VX], state[VY]
    if line[R] > 0.0:
        room, rate, step, _, _, _ = to_round(
            line[A] - x, line[B] - y, vx, vy, line[R], side, radius, bend
        )
        return room, rate, step
    ax, ay, bx, by = x - line[A], y - line[B], line[C] - line[A], line[D] - line[B]
    long = math.hypot(bx, by)
    if part == CENTRE:
        sign = 1.0 if side == OUTSIDE else -1.0
        room, rate = sign * (ax * by - ay * bx) / long, sign * (vx * by - vy * bx) / long
        return room, rate, safe_step(max(room, 0.0), rate, bend)
    share = min(max((ax * bx + ay * by) / (long * long), 0.0), 1.0)
    ox, oy = ax - share * bx, ay - share * by
    far = math.hypot(ox, oy)
    rate = (ox * vx + oy * vy) / far if far > 0.0 else 0.0
    if side == ASTRIDE:
        return radius - far, -rate, arc_step(max(radius - far, 0.0), ox, oy, vx, vy, bend)
    return far - radius, rate, safe_step(max(far - radius, 0.0), rate, bend)


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
        if ASTRIDE not in (side, to) and not 0.0 <= along <= long * long:
            return False
    row[WHAT] = ENTERS if to == ASTRIDE else LEAVES if side == ASTRIDE else PASSES
    row[AT_X], row[AT_Y] = x, y
    row[ACROSS] = state[VX] * nx + state[VY] * ny
    return True


@inlined
def _beyond(line: FloatArray, side: int, radius: float, state: FloatArray) -> int:
    """Where a disc comes that leaves a side now."""
    if radius == 0.0:
        return INSIDE if side == OUTSIDE else OUTSIDE
    if side != ASTRIDE:
        return ASTRIDE
    return INSIDE if _away(line, RIM, state[X], state[Y]) < 0.0 else OUTSIDE


@inner
def _along(
    game: Game, n: int, until: float, lines: FloatArray, k: int, part: int, sides: Whole,
    done: FloatArray, room: FloatArray, state: FloatArray, found: FloatArray, count: int,
) -> int:  # fmt: skip
    """What passes one line on one flight; how many rows of ``found`` are used, or would be."""
    i, kind, flight = int(game.history[n, 0]), int(game.history[n, 1]), game.history[n, 2:]
    disc, line, now = game.discs[i], lines[k], max(done[i, k, part], flight[START])
    radius = disc[RADIUS] if part == RIM else 0.0
    last = min(until, moves_until(kind, flight))
    done[i, k, part] = max(done[i, k, part], until)
    if kind == GONE:
        return count
    state_at(kind, flight, disc, game.curves, game.pieces, now, room, state)
    away = _away(line, part, state[X], state[Y])
    rounded = ROUNDED * (abs(state[X]) + abs(state[Y]) + radius + line[R])
    if abs(abs(away) - radius) > rounded:  # it was put there, or flies on
        sides[i, k, part] = lies_to(away, radius)
    elif sides[i, k, part] == UNKNOWN:  # where it goes from there, it was
        side = INSIDE if away < 0.0 and part == RIM else OUTSIDE
        _, rate, _ = _look(line, part, side, radius, state, 0.0)
        if rate != 0.0:
            sides[i, k, part] = _beyond(line, side, radius, state) if rate < 0.0 else side
    if abs(away) - radius > flight[FASTEST] * max(last - now, 0.0) * (1.0 + 1e-9):
        return count
    t = now
    while t < last:
        patience(1)
        side, bend = int(sides[i, k, part]), bend_of(kind, flight, disc, state, t)
        gap, rate, step = _look(line, part, side, radius, state, bend)
        if gap <= rounded:
            if rate < -QUIET * game.pace[0]:
                to = _beyond(line, side, radius, state)
                sides[i, k, part] = to
                row = found[min(count, found.shape[0] - 1)]
                if _note(line, side, to, state, row):
                    row[TIME], row[WHO], row[LINE] = t, i, k
                    count += 1
                continue
            if bend > 0.0:
                step = max(step, math.sqrt(2.0 * rounded / bend))
            elif rate != 0.0:
                step = max(step, 2.0 * rounded / abs(rate))
        if t + step == t:
            step = abs(np.spacing(t))
        t = min(t + step, last)
        state_at(kind, flight, disc, game.curves, game.pieces, t, room, state)
    return count


@kernel
def _follow(
    game: Game, lines: FloatArray, sides: Whole, done: FloatArray, flights: Whole, seen: Whole,
    room: FloatArray, state: FloatArray, found: FloatArray,
) -> int:  # fmt: skip
    """All that passed until now; how many rows of ``found`` that takes, perhaps more than it has.

    ``flights`` (discs,): the row of the history on which a disc is; ``seen`` (1,): how many were.
    """
    count = 0
    for n in range(seen[0], game.counts[N_HISTORY] + game.discs.shape[0]):
        patience(1)
        new = n < game.counts[N_HISTORY]
        i = int(game.history[n, 0]) if new else n - int(game.counts[N_HISTORY])
        until = game.history[n, 2 + START] if new else game.clock[0]
        if flights[i] >= 0:
            for k in range(lines.shape[0]):
                for part in range(2):
                    if done[i, k, part] < until:
                        count = _along(
                            game, flights[i], until, lines, k, part, sides, done, room, state,
                            found, count,
                        )  # fmt: skip
        if new:
            flights[i] = n
    seen[0] = game.counts[N_HISTORY]
    return count
