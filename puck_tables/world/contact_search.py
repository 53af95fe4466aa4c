"""When two discs, or a disc and an obstacle, meet next.

The gap between two discs is g = |d| − R with the distance d of their centres, and

    g″ = w_⊥²/|d| + n·a ≥ −A,    A the sum of the largest accelerations of both

(of dry friction J = f g, whatever the spin).  So it cannot close before

    s = 2g/(√(g′² + 2 A g) − g′),

and steps by s reach the contact from before, with quadratic convergence: Newton's method that
cannot pass a root.  A straight wall is the same without w_⊥; inside an arc |d| is bounded along the
tangent instead.  Those that go beside each other for long are bounded closer
(:mod:`puck_tables.world.separation`).  Pairs whose corridors do not touch need no look.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.forces import farthest, per_speed
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.world.engine_state import N_HELD, N_LOOKS, Engine, Whole
from puck_tables.world.layout import (
    ARC,
    CORNER,
    DRAG,
    EDGE,
    EDGE_NUMBER,
    END_X,
    END_Y,
    KIND,
    OVERHANG,
    POCKET,
    RADIUS,
    ROUNDED,
    SIDE,
    START_X,
    START_Y,
    WALL,
    A,
    B,
    C,
    beyond_ends,
    normal_to,
    slack_of,
)
from puck_tables.world.segment import (
    DAMPED,
    DRIFT_X,
    DRIFT_Y,
    GONE,
    LOOKED_UP,
    PATH,
    RIDING,
    STILL,
    STRONGEST,
    UNTIL,
    corridor,
    drifts,
    moves_until,
    state_at,
)  # fmt: skip
from puck_tables.world.separation import stays_apart

OUTSIDE = 1e-9  # of the radius
SLOWEST = 1e-12  # of the scale of speeds: an approach as slow is none
# of the scales of speeds and accelerations: as good as none, of what touches; discs that part
# begin to with an error of it, and meet only where it has brought them nearer than rounding
HARDLY = 1e-11
MOST_LOOKS = 20_000  # at one pair in a row: then others have their turn
PATIENCE = 8  # looks, before those who go beside each other are bounded closer


@inlined
def safe_step(gap: float, rate: float, accel: float) -> float:
    """How long a gap cannot close whose second derivative is −bend at least."""
    root = math.sqrt(rate * rate + 2.0 * accel * gap)
    if rate < 0.0:
        return 2.0 * gap / (root - rate)
    return (rate + root) / accel if accel > 0.0 else math.inf


@inlined
def moment_there(rounded: float, rate: float, accel: float, t: float) -> float:
    """How long a gap of about 0 that does not close is nothing but rounded, from t on.

    What only bends moves by so little meanwhile; what opens has opened by then, and may meet what
    it goes to from there: another side of a border, or an arc.
    """
    turns = math.sqrt(2.0 * rounded / accel) if accel > 0.0 else math.inf
    opens = max(2.0 * rounded / rate, 4.0 * ROUNDED * abs(t)) if rate > 0.0 else math.inf
    short = min(turns, opens)
    return short if short < math.inf else 0.0


@inlined
def _to_circle(along: float, speed2: float, rest: float) -> float:
    """When a straight path inside a circle meets it, ``rest`` the difference of the squares."""
    root = math.sqrt(along * along + speed2 * rest)
    return (root - along) / speed2 if along < 0.0 else rest / (along + root)


@inlined
def arc_step(gap: float, dx: float, dy: float, vx: float, vy: float, accel: float) -> float:
    """How long a centre inside an arc cannot meet it, (dx, dy) from its middle, gap to go.

    One that comes nearer to the middle is, until it is nearest, within the chord of its distance:
    so it may start on the arc.
    """
    size, speed2 = math.hypot(dx, dy), vx * vx + vy * vy
    reach = size + gap
    along = dx * vx + dy * vy
    inwards = 0.0
    if along < 0.0:
        inwards = -along / speed2
        closes = -along / (size + math.sqrt(max(size * size + along * inwards, 0.0)))
        if 2.0 * closes < accel * inwards:
            inwards = 2.0 * closes / accel
    speed = math.sqrt(speed2)
    root = math.sqrt(speed2 + 2.0 * accel * gap)
    if not speed + root > 0.0:
        return math.inf
    least = max(inwards, 2.0 * gap / (speed + root))  # whatever the direction
    if size > 0.0:  # and by the parabola about the distance from the middle
        least = max(least, safe_step(gap, -along / size, speed2 / size + accel))
    if speed2 > 0.0 and gap > 0.0:
        out = _to_circle(along, speed2, reach * reach - size * size)
        nearer = reach - 0.5 * accel * out * out
        if nearer > size:
            return max(least, _to_circle(along, speed2, nearer * nearer - size * size))
    return least


@inlined
def distance2(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> float:
    """The square of the distance of a point from the segment a–b."""
    ex, ey = bx - ax, by - ay
    size2 = ex * ex + ey * ey
    share = ((px - ax) * ex + (py - ay) * ey) / size2 if size2 > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    dx, dy = px - ax - share * ex, py - ay - share * ey
    return dx * dx + dy * dy


@inlined
def are_apart(
    one: tuple[float, float, float, float, float], two: tuple[float, float, float, float, float],
    reach: float,
) -> bool:  # fmt: skip
    """Whether two corridors stay farther than this from each other."""
    ax, ay, bx, by, margin = one
    cx, cy, dx, dy, other = two
    reach += margin + other
    if reach == math.inf:
        return False
    over = reach * (1.0 + 1e-9)
    if min(ax, bx) > max(cx, dx) + over or min(cx, dx) > max(ax, bx) + over:
        return True
    if min(ay, by) > max(cy, dy) + over or min(cy, dy) > max(ay, by) + over:
        return True
    # segments that cross are not apart
    first = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    second = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    third = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    fourth = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    if first * second < 0.0 and third * fourth < 0.0:
        return False
    nearest = min(
        min(distance2(ax, ay, bx, by, cx, cy), distance2(ax, ay, bx, by, dx, dy)),
        min(distance2(cx, cy, dx, dy, ax, ay), distance2(cx, cy, dx, dy, bx, by)),
    )
    return nearest > reach * reach * (1.0 + 1e-9)


@inlined
def are_held(engine: Engine, i: int, j: int) -> bool:
    """Whether the contact of disc i with partner j is one of a group that pushes."""
    if engine.group[i] == 0 or (j >= 0 and engine.group[j] != engine.group[i]):
        return False
    return is_among(engine.held, engine.counts[N_HELD], i, j)


@inlined
def is_among(contacts: Whole, count: int, i: int, j: int) -> bool:
    """Whether the contact of disc i with partner j is among the first ``count``, either way."""
    for n in range(count):
        a, b = contacts[n, 0], contacts[n, 1]
        if (a == i and b == j) or (a == j and b == i):
            return True
    return False


@inlined
def rest_together(kind: int, segment: FloatArray, other: int, second: FloatArray) -> bool:
    """Whether two discs rest on the same floor, or one has left play."""
    if kind == GONE or other == GONE or (kind == RIDING and other == RIDING):
        return True
    same = segment[DRIFT_X] == second[DRIFT_X] and segment[DRIFT_Y] == second[DRIFT_Y]
    return kind == STILL and other == STILL and same


@inlined
def largest_accel(
    kind: int, segment: FloatArray, disc: FloatArray, state: FloatArray, t: float
) -> float:
    """The largest acceleration from now on; of drag alone it falls with the speed."""
    if kind == DAMPED:
        speed = math.hypot(state[VX] - segment[DRIFT_X], state[VY] - segment[DRIFT_Y])
        return speed * per_speed(disc[DRAG:], speed)
    return segment[STRONGEST] if kind != LOOKED_UP or t < segment[UNTIL] else 0.0


@inlined
def once_round(kind: int, segment: FloatArray, now: float) -> float:
    """When a disc on a turntable is back where it is now."""
    return now + 2.0 * math.pi / abs(segment[2]) if kind == RIDING else math.inf


@inlined
def distance_left(
    kind: int, segment: FloatArray, disc: FloatArray, state: FloatArray, t: float
) -> float:
    """How far a disc goes at most."""
    speed = math.hypot(state[VX], state[VY])
    if drifts(segment) or kind in (PATH, RIDING):
        return math.inf
    if kind == DAMPED:
        return farthest(disc[DRAG:], speed)
    return speed * max(segment[UNTIL] - t, 0.0) if kind == LOOKED_UP else 0.0


@inner
def next_contact(
    engine: Engine, i: int, j: int, now: float, horizon: float, room: FloatArray, one: FloatArray,
    two: FloatArray,
) -> float:  # fmt: skip
    """When two discs touch next, up to the horizon; else inf; −1 − t: look again at t.

    States at the end in one and two.
    """
    kind, other = engine.kinds[i], engine.kinds[j]
    segment, second = engine.segments[i], engine.segments[j]
    if rest_together(kind, segment, other, second):
        return math.inf
    last = min(horizon, max(moves_until(kind, segment), moves_until(other, second)))
    if other == STILL and not drifts(second):
        last = min(last, once_round(kind, segment, now))
    if kind == STILL and not drifts(segment):
        last = min(last, once_round(other, second, now))
    if kind == PATH:
        last = min(last, segment[UNTIL])
    if other == PATH:
        last = min(last, second[UNTIL])
    if not last > now or are_held(engine, i, j):
        return math.inf
    discs, lookups, pieces = engine.discs, engine.lookups, engine.pieces
    reach = discs[i, RADIUS] + discs[j, RADIUS]
    if kind in (DAMPED, PATH):
        state_at(kind, segment, discs[i], lookups, pieces, now, room, one)
    if other in (DAMPED, PATH):
        state_at(other, second, discs[j], lookups, pieces, now, room, two)
    if are_apart(
        corridor(kind, segment, discs[i], one, last, now),
        corridor(other, second, discs[j], two, last, now),
        reach,
    ):
        return math.inf
    if kind not in (DAMPED, PATH):
        state_at(kind, segment, discs[i], lookups, pieces, now, room, one)
    if other not in (DAMPED, PATH):
        state_at(other, second, discs[j], lookups, pieces, now, room, two)
    t = now
    for look in range(MOST_LOOKS):
        engine.counts[N_LOOKS] += 1
        dx, dy = two[X] - one[X], two[Y] - one[Y]
        size = math.hypot(dx, dy)
        gap = size - reach
        rate = (dx * (two[VX] - one[VX]) + dy * (two[VY] - one[VY])) / size
        rounded = ROUNDED * (abs(one[X]) + abs(one[Y]) + reach)
        accel = largest_accel(kind, segment, discs[i], one, t) + largest_accel(
            other, second, discs[j], two, t
        )
        step = safe_step(max(gap, 0.0), rate, accel)
        left = distance_left(kind, segment, discs[i], one, t)
        if gap > (left + distance_left(other, second, discs[j], two, t)) * (1.0 + 1e-9):
            return math.inf
        hardly = rate >= -HARDLY * engine.scale[0] and gap >= -rounded
        if gap <= rounded:
            if rate < -SLOWEST * engine.scale[0] and not hardly:
                return t
            step = max(step, moment_there(rounded, rate, accel, t))
        if look >= PATIENCE or (gap <= rounded and rate < 0.0):
            nx, ny, more = dx / size, dy / size, max(gap, rounded)
            longer = stays_apart(engine, i, j, t, more, nx, ny, 0.0, False, room, one, two)
            step = max(step, longer)
        if t + step > last or step == math.inf:
            return math.inf
        if t + step == t:
            return t if rate < -SLOWEST * engine.scale[0] else math.inf
        t += step
        state_at(kind, segment, discs[i], lookups, pieces, t, room, one)
        state_at(other, second, discs[j], lookups, pieces, t, room, two)
    return -1.0 - t


@inner
def next_crossing(
    engine: Engine, i: int, k: int, now: float, horizon: float, room: FloatArray, one: FloatArray
) -> float:
    """When a disc touches obstacle k next, or its centre or rim passes it; else inf; −1 − t."""
    kind, segment = engine.kinds[i], engine.segments[i]
    last = min(horizon, moves_until(kind, segment), once_round(kind, segment, now))
    if kind == GONE or not last > now or are_held(engine, i, -1 - k):
        return math.inf
    disc, obstacle = engine.discs[i], engine.obstacles[k]
    radius, shape = disc[RADIUS], int(obstacle[KIND])
    hangs = shape == OVERHANG and engine.hangs[i, int(obstacle[EDGE_NUMBER])] != 0
    side = -1.0 if hangs else 1.0  # over an edge it comes back
    if kind in (DAMPED, PATH):
        state_at(kind, segment, disc, engine.lookups, engine.pieces, now, room, one)
    ax, ay, bx, by, margin = corridor(kind, segment, disc, one, last, now)
    if shape in (WALL, EDGE, OVERHANG):
        nearest = min(
            side * normal_to(obstacle, radius, ax, ay, 0.0)[0],
            side * normal_to(obstacle, radius, bx, by, 0.0)[0],
        )
        if nearest > margin * (1.0 + 1e-9):
            return math.inf
    elif shape == SIDE:
        ends = obstacle[START_X], obstacle[START_Y], obstacle[END_X], obstacle[END_Y], 0.0
        if are_apart((ax, ay, bx, by, margin), ends, radius):
            return math.inf
    elif shape == ARC:
        farthest = max(
            math.hypot(ax - obstacle[A], ay - obstacle[B]),
            math.hypot(bx - obstacle[A], by - obstacle[B]),
        )
        if farthest + margin < (obstacle[C] - radius) * (1.0 - 1e-9):
            return math.inf
    else:
        reach = obstacle[C] + (0.0 if shape == POCKET else radius) + margin
        near = distance2(ax, ay, bx, by, obstacle[A], obstacle[B])
        if near > reach * reach * (1.0 + 1e-9):
            return math.inf
    if kind not in (DAMPED, PATH):
        state_at(kind, segment, disc, engine.lookups, engine.pieces, now, room, one)
    t, partly = now, shape in (ARC, SIDE, CORNER)
    for look in range(MOST_LOOKS):
        engine.counts[N_LOOKS] += 1
        slack = slack_of(radius, one[X], one[Y]) if shape == SIDE else 0.0
        gap, nx, ny, there = normal_to(obstacle, radius, one[X], one[Y], slack)
        gap, nx, ny = side * gap, side * nx, side * ny
        rate = -(nx * one[VX] + ny * one[VY])
        accel = largest_accel(kind, segment, disc, one, t)
        if gap > distance_left(kind, segment, disc, one, t) * (1.0 + 1e-9):
            return math.inf
        rounded = ROUNDED * (abs(one[X]) + abs(one[Y]) + radius + obstacle[C] * (shape == ARC))
        if shape == ARC and gap >= 0.0:
            dx, dy = one[X] - obstacle[A], one[Y] - obstacle[B]
            step = arc_step(gap, dx, dy, one[VX], one[VY], accel)
        elif shape == ARC or (there and partly and gap < -OUTSIDE * radius):
            step = safe_step(-gap, -rate, accel)  # outside it: until it comes back
        else:
            step = safe_step(max(gap, 0.0), rate, accel)
        if not there and shape != ARC:
            away, gx, gy = beyond_ends(obstacle, one[X], one[Y])
            closes = gx * one[VX] + gy * one[VY]
            step = max(step, safe_step(max(away - slack, 0.0), closes, accel))
        # farther outside an arc it has passed where the arc is not
        if gap <= rounded and (not partly or gap > -OUTSIDE * radius):
            if rate < -SLOWEST * engine.scale[0] and there:
                return t
            step = max(step, moment_there(rounded, rate, accel, t))
            if not there and rate != 0.0:
                step = max(step, 4.0 * rounded / abs(rate))
        if look >= PATIENCE and (not partly or gap >= 0.0):
            far = math.hypot(one[X] - obstacle[A], one[Y] - obstacle[B])
            step = max(step, stays_apart(
                engine, i, -1 - k, t, max(gap, rounded), nx, ny, far, shape == ARC, room, one, one,
            ))  # fmt: skip
        if t + step > last or step == math.inf:
            return math.inf
        if t + step == t:
            return t if rate < -SLOWEST * engine.scale[0] and (there or shape == ARC) else math.inf
        t += step
        state_at(kind, segment, disc, engine.lookups, engine.pieces, t, room, one)
    return -1.0 - t
