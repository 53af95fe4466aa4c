"""When the rim of a disc comes over a border or a patch of the floor, or leaves it.

Friction changes from there on, so that no rim may come over anything unseen.  The distance to a
border, and to the round or to an edge of a patch from outside, is convex: as with what stands
(:mod:`puck_tables.world.meeting`), a rim at the distance g that comes nearer by g′ is not there
before s = 2g/(√(g′² + 2Ag) − g′).  To a polygon it comes over the first of its edges, from inside
as from outside, and has left when it has left the last: of a circle about any point under the base
it is known how long the centre stays in it, as in an arc.  After the rim has left, friction astride
is what it is on one friction; so that moment need not be met closely.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.ground import (
    ACROSS_X,
    ACROSS_Y,
    BORDERS,
    CORNER,
    CORNERS,
    MIDDLE_X,
    MIDDLE_Y,
    REACH,
    corner_of,
    patch_of,
)
from puck_tables.scene.patches import ASTRIDE, INSIDE, OUTSIDE
from puck_tables.world.beside import stays_apart
from puck_tables.world.flight import GONE, corridor, moves_until, state_at
from puck_tables.world.footing import ground_span, off_border
from puck_tables.world.game import N_LOOKS, Game
from puck_tables.world.layout import LIES, LIGHTNESS, RADIUS, A
from puck_tables.world.meeting import (
    MOST_LOOKS,
    PATIENCE,
    QUIET,
    ROUNDED,
    arc_step,
    bend_of,
    distance2,
    moment_there,
    once_round,
    safe_step,
    way_left,
)

# how far the rim is from the border, how fast that changes, for how long it surely is not there,
# for how long it is at nothing but the nearest straight or convex piece, and the way to that; where
# there is no such piece the latter time is 0
Sight = tuple[float, float, float, float, float, float]


@inlined
def _to_line(away: float, rate: float, how: int, radius: float, bend: float) -> Sight:
    """Of a straight border in the direction (1, 0)."""
    if how == ASTRIDE:
        on, back = radius + away, radius - away
        step = min(safe_step(max(on, 0.0), rate, bend), safe_step(max(back, 0.0), -rate, bend))
        return (on, rate, step, 0.0, 1.0, 0.0) if on < back else (back, -rate, step, 0.0, 1.0, 0.0)
    sign = 1.0 if how == OUTSIDE else -1.0
    room, rate = sign * away - radius, sign * rate
    return room, rate, safe_step(max(room, 0.0), rate, bend), math.inf, sign, 0.0


@inlined
def to_round(
    dx: float, dy: float, vx: float, vy: float, reach: float, how: int, radius: float, bend: float
) -> Sight:
    """Of a circle, whose middle is at (dx, dy) from the centre of the disc."""
    far = math.sqrt(dx * dx + dy * dy)
    rate = -(dx * vx + dy * vy) / far if far > 0.0 else math.sqrt(vx * vx + vy * vy)
    nx, ny = (dx / far, dy / far) if far > 0.0 else (1.0, 0.0)
    if how == OUTSIDE:
        room = far - reach - radius
        return room, rate, safe_step(max(room, 0.0), rate, bend), math.inf, nx, ny
    if how == INSIDE:
        room = reach - radius - far
        return room, -rate, arc_step(max(room, 0.0), -dx, -dy, vx, vy, bend), 0.0, -nx, -ny
    room = reach + radius - far
    step = arc_step(max(room, 0.0), -dx, -dy, vx, vy, bend)
    if reach > radius:
        inner = far - reach + radius
        step = min(step, safe_step(max(inner, 0.0), rate, bend))
        if inner < room:
            return inner, rate, step, 0.0, nx, ny
    return room, -rate, step, 0.0, -nx, -ny


@inner
def _to_polygon(
    ground: FloatArray, number: int, state: FloatArray, how: int, radius: float, bend: float
) -> Sight:
    """Of a polygon: by the nearest point of each of its edges."""
    count, first = int(patch_of(ground, number, CORNERS)), int(patch_of(ground, number, CORNER))
    x, y, vx, vy = state[X], state[Y], state[VX], state[VY]
    nearest, rate, step, others, stays = math.inf, 0.0, math.inf, math.inf, 0.0
    nx, ny = 1.0, 0.0
    for n in range(count):
        one = corner_of(ground, first + n)
        two = corner_of(ground, first + (n + 1 if n + 1 < count else 0))
        ax, ay, bx, by = x - one[0], y - one[1], two[0] - one[0], two[1] - one[1]
        share = min(max((ax * bx + ay * by) / (bx * bx + by * by), 0.0), 1.0)
        ox, oy = ax - share * bx, ay - share * by
        far = math.sqrt(ox * ox + oy * oy)
        if how == ASTRIDE and far < radius:
            stays = max(stays, arc_step(radius - far, ox, oy, vx, vy, bend))
        opens = (ox * vx + oy * vy) / far if far > 0.0 else 0.0
        one_step = safe_step(max(far - radius, 0.0), opens, bend)
        if far < nearest:
            others, step = min(others, step), one_step
            nearest, rate = far, opens
            if far > 0.0:
                nx, ny = -ox / far, -oy / far
        else:
            others = min(others, one_step)
    if how == ASTRIDE:
        return radius - nearest, -rate, stays, 0.0, -nx, -ny
    return nearest - radius, rate, min(step, others), others, nx, ny


@inlined
def _look(
    ground: FloatArray, number: int, how: int, radius: float, state: FloatArray, bend: float
) -> Sight:
    """How the rim of a disc in a state (6,) is to a border, or a patch."""
    borders = int(ground[BORDERS])
    vx, vy = state[VX], state[VY]
    if number < borders:
        east, north = ground[ACROSS_X], ground[ACROSS_Y]
        away, rate = off_border(ground, number, state[X], state[Y]), -(east * vx + north * vy)
        room, rate, step, others, sign, _ = _to_line(away, rate, how, radius, bend)
        return room, rate, step, others, sign * east, sign * north
    number -= borders
    if int(patch_of(ground, number, CORNERS)) > 0:
        return _to_polygon(ground, number, state, how, radius, bend)
    dx = patch_of(ground, number, MIDDLE_X) - state[X]
    dy = patch_of(ground, number, MIDDLE_Y) - state[Y]
    return to_round(dx, dy, vx, vy, patch_of(ground, number, REACH), how, radius, bend)


@inlined
def _never_near(
    ground: FloatArray, number: int, how: int, radius: float,
    way: tuple[float, float, float, float, float],
) -> bool:  # fmt: skip
    """Whether a disc whose centre stays in a corridor never comes over a border or patch."""
    ax, ay, bx, by, margin = way
    borders = int(ground[BORDERS])
    if how == ASTRIDE or margin == math.inf:
        return False
    reach = (radius + margin) * (1.0 + 1e-9)
    if number < borders:
        sign = 1.0 if how == OUTSIDE else -1.0
        one = sign * off_border(ground, number, ax, ay)
        return min(one, sign * off_border(ground, number, bx, by)) > reach
    if how == INSIDE:
        return False
    number -= borders
    mx, my = patch_of(ground, number, MIDDLE_X), patch_of(ground, number, MIDDLE_Y)
    reach += patch_of(ground, number, REACH) * (1.0 + 1e-9)
    return distance2(ax, ay, bx, by, mx, my) > reach * reach


@inner
def next_border(
    game: Game, i: int, k: int, now: float, horizon: float, room: FloatArray, one: FloatArray
) -> float:
    """When the rim of a disc comes over, or leaves, the border or patch that the obstacle k is.

    Up to the horizon; else inf; −1 − t: look again at t.  The state at the end in one.
    """
    kind, flight, disc = game.kinds[i], game.flights[i], game.discs[i]
    last = min(horizon, moves_until(kind, flight), once_round(kind, flight, now))
    if kind == GONE or not last > now or disc[LIGHTNESS] == 0.0:
        return math.inf
    first, after = ground_span(game.regions, game.discs, i)
    ground, radius = game.regions.ground[first:after], disc[RADIUS]
    number = int(game.obstacles[k, A])
    how = int(disc[LIES + number])
    state_at(kind, flight, disc, game.curves, game.pieces, now, room, one)
    if _never_near(ground, number, how, radius, corridor(kind, flight, disc, one, last, now)):
        return math.inf
    t = now
    for look in range(MOST_LOOKS):
        game.counts[N_LOOKS] += 1
        bend = bend_of(kind, flight, disc, one, t)
        gap, rate, step, others, nx, ny = _look(ground, number, how, radius, one, bend)
        if gap > way_left(kind, flight, disc, one, t) * (1.0 + 1e-9):
            return math.inf
        rounded = ROUNDED * (abs(one[X]) + abs(one[Y]) + radius)
        if gap <= rounded:
            if rate < -QUIET * game.pace[0]:
                return t
            step = max(step, moment_there(rounded, rate, bend, t))
        if look >= PATIENCE and others > step:
            longer = stays_apart(
                game, i, -1 - k, t, max(gap, rounded), nx, ny, 0.0, False, room, one, one
            )
            step = max(step, min(others, longer))
        if t + step > last:
            return math.inf
        if t + step == t:
            return t if rate < -QUIET * game.pace[0] else math.inf
        t += step
        state_at(kind, flight, disc, game.curves, game.pieces, t, room, one)
    return -1.0 - t
