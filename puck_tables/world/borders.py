"""When the rim of a disc comes over a border or a patch of the floor, or leaves it.

Friction changes from there on, so that no rim may come over anything unseen.  The distance to a
border, and to the round or to an edge of a patch from outside, is convex: as with what stands
(:mod:`puck_tables.world.contact_search`), a rim at a distance g that nears by g′ is not there
before s = 2g/(√(g′² + 2Ag) − g′).  To a polygon it comes over the first of its edges, from inside
as from outside, and has left when it has left the last: of a circle about any point under the base
it is known how long the centre stays in it, as in an arc.  After the rim has left, friction astride
is what it is on one friction; so that moment need not be met closely.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    BORDERS,
    CORNER,
    CORNERS,
    INSIDE,
    MIDDLE_X,
    MIDDLE_Y,
    OUTSIDE,
    OVERLAPS,
    REACH,
    corner_of,
    patch_of,
)
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.world.contact_search import (
    MOST_LOOKS,
    PATIENCE,
    SLOWEST,
    arc_step,
    distance2,
    distance_left,
    largest_accel,
    moment_there,
    once_round,
    safe_step,
)
from puck_tables.world.engine_state import N_LOOKS, Engine
from puck_tables.world.floor_under import floor_map_span, off_border
from puck_tables.world.layout import INV_MASS, LIES, RADIUS, ROUNDED, A
from puck_tables.world.segment import GONE, corridor, moves_until, state_at
from puck_tables.world.separation import stays_apart

_UNFELT = 1e-10  # of a radius: whose rim has left by less may be looked at later

# how far the rim is from the border, how fast that changes, for how long it surely is not there,
# for how long it is at nothing but the nearest straight or convex piece, and the way to that; where
# there is no such piece the latter time is 0
Clearance = tuple[float, float, float, float, float, float]


@inlined
def _to_line(away: float, rate: float, how: int, radius: float, accel: float) -> Clearance:
    """Of a straight border in the direction (1, 0)."""
    if how == OVERLAPS:
        on, back = radius + away, radius - away
        step = min(safe_step(max(on, 0.0), rate, accel), safe_step(max(back, 0.0), -rate, accel))
        return (on, rate, step, 0.0, 1.0, 0.0) if on < back else (back, -rate, step, 0.0, 1.0, 0.0)
    sign = 1.0 if how == OUTSIDE else -1.0
    room, rate = sign * away - radius, sign * rate
    return room, rate, safe_step(max(room, 0.0), rate, accel), math.inf, sign, 0.0


@inlined
def to_round(
    dx: float, dy: float, vx: float, vy: float, reach: float, how: int, radius: float, accel: float
) -> Clearance:
    """Of a circle, whose middle is at (dx, dy) from the centre of the disc."""
    far = math.sqrt(dx * dx + dy * dy)
    rate = -(dx * vx + dy * vy) / far if far > 0.0 else math.sqrt(vx * vx + vy * vy)
    nx, ny = (dx / far, dy / far) if far > 0.0 else (1.0, 0.0)
    if how == OUTSIDE:
        room = far - reach - radius
        return room, rate, safe_step(max(room, 0.0), rate, accel), math.inf, nx, ny
    if how == INSIDE:
        room = reach - radius - far
        return room, -rate, arc_step(max(room, 0.0), -dx, -dy, vx, vy, accel), 0.0, -nx, -ny
    room = reach + radius - far
    step = arc_step(max(room, 0.0), -dx, -dy, vx, vy, accel)
    if reach > radius:
        inner = far - reach + radius
        step = min(step, safe_step(max(inner, 0.0), rate, accel))
        if inner < room:
            return inner, rate, step, 0.0, nx, ny
    return room, -rate, step, 0.0, -nx, -ny


@inner
def _to_polygon(
    floor_map: FloatArray, number: int, state: FloatArray, how: int, radius: float, accel: float
) -> Clearance:
    """Of a polygon: by the nearest point of each of its edges."""
    count = int(patch_of(floor_map, number, CORNERS))
    first = int(patch_of(floor_map, number, CORNER))
    x, y, vx, vy = state[X], state[Y], state[VX], state[VY]
    nearest, rate, step, others, stays = math.inf, 0.0, math.inf, math.inf, 0.0
    nx, ny = 1.0, 0.0
    for n in range(count):
        one = corner_of(floor_map, first + n)
        two = corner_of(floor_map, first + (n + 1 if n + 1 < count else 0))
        ax, ay, bx, by = x - one[0], y - one[1], two[0] - one[0], two[1] - one[1]
        share = min(max((ax * bx + ay * by) / (bx * bx + by * by), 0.0), 1.0)
        ox, oy = ax - share * bx, ay - share * by
        far = math.sqrt(ox * ox + oy * oy)
        if how == OVERLAPS and far < radius:
            stays = max(stays, arc_step(radius - far, ox, oy, vx, vy, accel))
        opens = (ox * vx + oy * vy) / far if far > 0.0 else 0.0
        one_step = safe_step(max(far - radius, 0.0), opens, accel)
        if far < nearest:
            others, step = min(others, step), one_step
            nearest, rate = far, opens
            if far > 0.0:
                nx, ny = -ox / far, -oy / far
        else:
            others = min(others, one_step)
    if how == OVERLAPS:
        return radius - nearest, -rate, stays, 0.0, -nx, -ny
    return nearest - radius, rate, min(step, others), others, nx, ny


@inlined
def _look(
    floor_map: FloatArray, number: int, how: int, radius: float, state: FloatArray, accel: float
) -> Clearance:
    """How the rim of a disc in a state (6,) is to a border, or a patch."""
    borders = int(floor_map[BORDERS])
    vx, vy = state[VX], state[VY]
    if number < borders:
        east, north = floor_map[ACROSS_X], floor_map[ACROSS_Y]
        away, rate = off_border(floor_map, number, state[X], state[Y]), -(east * vx + north * vy)
        room, rate, step, others, sign, _ = _to_line(away, rate, how, radius, accel)
        return room, rate, step, others, sign * east, sign * north
    number -= borders
    if int(patch_of(floor_map, number, CORNERS)) > 0:
        return _to_polygon(floor_map, number, state, how, radius, accel)
    dx = patch_of(floor_map, number, MIDDLE_X) - state[X]
    dy = patch_of(floor_map, number, MIDDLE_Y) - state[Y]
    return to_round(dx, dy, vx, vy, patch_of(floor_map, number, REACH), how, radius, accel)


@inlined
def _never_near(
    floor_map: FloatArray, number: int, how: int, radius: float,
    length: tuple[float, float, float, float, float],
) -> bool:  # fmt: skip
    """Whether a disc whose centre stays in a corridor never comes over a border or patch."""
    ax, ay, bx, by, margin = length
    borders = int(floor_map[BORDERS])
    if how == OVERLAPS or margin == math.inf:
        return False
    reach = (radius + margin) * (1.0 + 1e-9)
    if number < borders:
        sign = 1.0 if how == OUTSIDE else -1.0
        one = sign * off_border(floor_map, number, ax, ay)
        return min(one, sign * off_border(floor_map, number, bx, by)) > reach
    if how == INSIDE:
        return False
    number -= borders
    mx, my = patch_of(floor_map, number, MIDDLE_X), patch_of(floor_map, number, MIDDLE_Y)
    reach += patch_of(floor_map, number, REACH) * (1.0 + 1e-9)
    return distance2(ax, ay, bx, by, mx, my) > reach * reach


@inner
def next_border(
    engine: Engine, i: int, k: int, now: float, horizon: float, room: FloatArray, one: FloatArray
) -> float:
    """When the rim of a disc comes over, or leaves, the border or patch that the obstacle k is.

    Up to the horizon; else inf; −1 − t: look again at t.  The state at the end in one.
    """
    kind, segment, disc = engine.kinds[i], engine.segments[i], engine.discs[i]
    last = min(horizon, moves_until(kind, segment), once_round(kind, segment, now))
    if kind == GONE or not last > now or disc[INV_MASS] == 0.0:
        return math.inf
    first, after = floor_map_span(engine, i)
    floor_map, radius = engine.regions.floor_map[first:after], disc[RADIUS]
    number = int(engine.obstacles[k, A])
    how = int(disc[LIES + number])
    state_at(kind, segment, disc, engine.lookups, engine.pieces, now, room, one)
    if _never_near(floor_map, number, how, radius, corridor(kind, segment, disc, one, last, now)):
        return math.inf
    t = now
    for look in range(MOST_LOOKS):
        engine.counts[N_LOOKS] += 1
        accel = largest_accel(kind, segment, disc, one, t)
        gap, rate, step, others, nx, ny = _look(floor_map, number, how, radius, one, accel)
        if gap > distance_left(kind, segment, disc, one, t) * (1.0 + 1e-9):
            return math.inf
        rounded = ROUNDED * (abs(one[X]) + abs(one[Y]) + radius)
        if gap <= rounded:
            if rate < -SLOWEST * engine.scale[0]:
                return t
            rounded = max(rounded, _UNFELT * radius) if how == OVERLAPS else rounded
            step = max(step, moment_there(rounded, rate, accel, t))
        if look >= PATIENCE and others > step:
            longer = stays_apart(
                engine, i, -1 - k, t, max(gap, rounded), nx, ny, 0.0, False, room, one, one
            )
            step = max(step, min(others, longer))
        if t + step > last or step == math.inf:
            return math.inf
        if t + step == t:
            return t if rate < -SLOWEST * engine.scale[0] else math.inf
        t += step
        state_at(kind, segment, disc, engine.lookups, engine.pieces, t, room, one)
    return -1.0 - t
