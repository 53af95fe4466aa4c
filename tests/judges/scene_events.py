"""What happens on the way of a scene: when, found by sampling and bisection, and what follows."""

from __future__ import annotations

import math

from numba import njit
from scene_motion import (
    BLADE,
    LAST,
    LEAN,
    MODE,
    OTHER,
    PIECE,
    PIVOT,
    RAIL,
    REGION,
    RESTS,
    RIM,
    SLIDES,
    SMOOTH,
    STICKS,
    best_way,
    floor_at,
    leaving_way,
    rates,
)
from scene_steps import dense

BOUNCE, BORDER, EDGE, LEANS, REST, SLIP, LEAVES = range(7)
SAMPLES = 12


@njit(cache=True)
def gap(world, ctx, base, y, which):
    """Distance inside a line and its rate; lines are counted walls, edges, borders."""
    walls, edges = len(world.walls), len(world.edges)
    sign = 1.0
    if which < walls:
        nx, ny, c = world.walls[which, 0], world.walls[which, 1], world.walls[which, 2]
    elif which < walls + edges:
        nx, ny, c = world.edges[which - walls]
    else:
        j = which - walls - edges
        sign = 1.0 if j == ctx[REGION] - 1 else -1.0
        nx, ny, c = world.borders[j]
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    rate = sign * (nx * (y[3] + sx) + ny * (y[4] + sy))
    if which == ctx[LAST]:
        return sign * (nx * y[0] + ny * y[1]), rate
    return sign * ((nx * base[0] + ny * base[1] - c) + nx * y[0] + ny * y[1]), rate


@njit(cache=True)
def rim_slip(world, wall, base, y):
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    spin = y[5] + world.floor[4]
    return wall[0] * (y[4] + sy) - wall[1] * (y[3] + sx) - world.body[2] * spin


@njit(cache=True)
def test(world, ctx, base, t, y, which, out, fr, speed):
    """Value of a test that a step must keep ≥ 0, and its rate where that is known."""
    total = len(world.walls) + len(world.edges) + len(world.borders)
    if which < total:
        return gap(world, ctx, base, y, which)
    if which < total + 3:
        push, other, grip = rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
        if which == total:
            return push, 0.0
        if which == total + 1:
            return other, 0.0
        wall = world.walls[ctx[LEAN]]
        if ctx[RIM] == STICKS:
            return wall[5] * push - abs(grip), 0.0
        return ctx[RIM] * rim_slip(world, wall, base, y) + 1e-15 * speed, 0.0
    # whether the floor still holds
    _, gain = leaving_way(world, ctx, base, t, y, out, fr)
    return -gain, 0.0


@njit(cache=True)
def tested(world, ctx, which):
    walls, edges, borders = len(world.walls), len(world.edges), len(world.borders)
    if which < walls:
        return which != ctx[LEAN] and which != ctx[OTHER]
    if which < walls + edges:
        return True
    if which < walls + edges + borders:
        j = which - walls - edges
        return j == ctx[REGION] or j == ctx[REGION] - 1
    which -= walls + edges + borders
    if which == 0:
        return ctx[LEAN] >= 0 and ctx[MODE] == SLIDES
    if which == 1:
        return ctx[OTHER] >= 0 and ctx[MODE] == SLIDES
    if which == 2:
        return ctx[LEAN] >= 0 and ctx[RIM] != SMOOTH and ctx[OTHER] < 0 and ctx[MODE] == SLIDES
    changes = world.floor[4] != 0.0 or 0 < ctx[PIECE] < len(world.drive)
    return ctx[MODE] == RESTS and changes


@njit(cache=True)
def _dip(world, ctx, base, t, h, y, f, at, out, fr, speed, which, low, high):
    """Where on a step (0 … 1) a test is least between two samples, and that value: by thirds."""
    for _ in range(60):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        dense(y, f, left, at)
        one, _ = test(world, ctx, base, t + left * h, at, which, out, fr, speed)
        if one < 0.0:
            return left, one
        dense(y, f, right, at)
        two, _ = test(world, ctx, base, t + right * h, at, which, out, fr, speed)
        if two < 0.0:
            return right, two
        if one <= two:
            high = right
        else:
            low = left
    return low, one


@njit(cache=True)
def first_event(world, ctx, base, t, h, y, f, at, out, fr, speed):
    """The first test that a step breaks, and where on it (0 … 1)."""
    total = len(world.walls) + len(world.edges) + len(world.borders)
    best, found = 2.0, -1
    for which in range(total + 4):
        if not tested(world, ctx, which):
            continue
        line = which < total
        low = 0.0
        value, rate = test(world, ctx, base, t, y, which, out, fr, speed)
        if line and ctx[MODE] == RESTS and value <= 0.0 and abs(rate) <= 1e-12 * speed:
            rate = 0.0  # rounding, where a floor that turns carries it off
        if line and value <= 0.0 and rate < 0.0:
            return which, 0.0
        if total <= which < total + 2 and value < 0.0:  # a wall does not pull
            return which, 0.0
        friction = world.loads[ctx[REGION]] / world.body[0]
        if which == total + 3 and value < -1e-10 * friction:  # it was not held, another way
            return which, 0.0
        earlier, first = low, value  # the sample before
        for i in range(SAMPLES):
            high = (i + 1.0) / SAMPLES
            if low >= best:
                break
            dense(y, f, high, at)
            after, pace = test(world, ctx, base, t + high * h, at, which, out, fr, speed)
            a, b, broken = low, high, after < 0.0 and (value >= 0.0 or (line and rate > 0.0))
            if (
                line
                and rate != 0.0
                and rate * pace < 0.0
                and ((rate < 0.0 and after >= 0.0) or (rate > 0.0 and after < 0.0))
            ):  # a turning point of the gap
                p, q = low, high
                while True:
                    middle = 0.5 * (p + q)
                    if middle <= p or middle >= q or q - p < 1e-17:
                        break
                    dense(y, f, middle, at)
                    _, turning = gap(world, ctx, base, at, which)
                    if turning * rate > 0.0:
                        p = middle
                    else:
                        q = middle
                dense(y, f, q, at)
                extreme, _ = gap(world, ctx, base, at, which)
                if rate < 0.0:
                    broken, b = extreme < 0.0, q
                elif extreme > 0.0:
                    a = q
                else:
                    a, b = low, low  # it never left
            lowest = not line and 0.0 <= value < min(first, after)
            if not broken and lowest and value < max(first, after) - value:
                place, least = _dip(
                    world, ctx, base, t, h, y, f, at, out, fr, speed, which, earlier, high
                )
                broken = least < 0.0
                a, b = earlier, place
            if broken:
                while True:
                    middle = 0.5 * (a + b)
                    if middle <= a or middle >= b or b - a < 1e-17:
                        break
                    dense(y, f, middle, at)
                    inside, _ = test(world, ctx, base, t + middle * h, at, which, out, fr, speed)
                    if inside >= 0.0:
                        a = middle
                    else:
                        b = middle
                if b < best:
                    best, found = b, which
                break
            earlier, first = low, value
            low, value, rate = high, after, pace
    return found, best


@njit(cache=True)
def impact(world, ctx, base, y, which, restitution):
    """Impulses of a wall at the rim; the speed into it before."""
    m, inertia, r = world.body
    wall = world.walls[which]
    nx, ny = wall[0], wall[1]
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    fall = -(nx * (y[3] + sx) + ny * (y[4] + sy))
    normal = (1.0 + restitution) * m * max(fall, 0.0)
    along = -(1.0 + wall[4]) * rim_slip(world, wall, base, y) / (1.0 / m + r * r / inertia)
    most = wall[5] * normal
    along = min(max(along, -most), most)
    y[3] += (normal * nx - along * ny) / m
    y[4] += (normal * ny + along * nx) / m
    y[5] -= r * along / inertia
    return fall


@njit(cache=True)
def still(world, base, y, which):
    """No velocity through a wall."""
    wall = world.walls[which]
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    off = wall[0] * (y[3] + sx) + wall[1] * (y[4] + sy)
    y[3] -= off * wall[0]
    y[4] -= off * wall[1]


@njit(cache=True)
def kept(world, base, y):
    """The constraint, of which rounding would take a little at every step."""
    hold, kind = world.hold, int(world.hold[0])
    c, s = math.cos(y[2] + hold[4]), math.sin(y[2] + hold[4])
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    if kind == BLADE:
        off = -s * y[3] + c * y[4] - hold[5]
        y[3] += off * s
        y[4] -= off * c
    elif kind == RAIL:
        off = hold[1] * (y[3] + sx - hold[5]) + hold[2] * (y[4] + sy - hold[6])
        y[3] -= off * hold[1]
        y[4] -= off * hold[2]
    elif kind == PIVOT:
        rim = hold[3] * (y[5] + world.floor[4])
        y[3], y[4] = hold[5] + rim * s - sx, hold[6] - rim * c - sy


@njit(cache=True)
def rim_state(world, ctx, base, t, y, out, fr, speed):
    """Whether the rim slips along the wall that the puck leans on, and which way."""
    wall = world.walls[ctx[LEAN]]
    if wall[4] == -1.0 or wall[5] == 0.0:
        ctx[RIM] = SMOOTH
        return
    u = rim_slip(world, wall, base, y)
    if abs(u) > 1e-11 * speed:
        ctx[RIM] = 1 if u > 0.0 else -1
        return
    ctx[RIM] = STICKS
    mode = ctx[MODE]
    ctx[MODE] = SLIDES
    push, _, grip = rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
    ctx[MODE] = mode
    if abs(grip) > wall[5] * push:
        ctx[RIM] = -1 if grip > 0.0 else 1


@njit(cache=True)
def rebased(base, y):
    base[0] += y[0]
    base[1] += y[1]
    y[0], y[1] = 0.0, 0.0


@njit(cache=True)
def begins(world, ctx, base, t, y, n, gain, speed, until, out, fr):
    """Leave rest along n; the moment at which the slip has a size."""
    r = world.body[2]
    q = 2e-13 * speed
    if gain > 1e-5 * world.loads[ctx[REGION]] / world.body[0]:
        wait = q / gain
    else:
        eps = 1e-7 * max(until - t, 0.0)
        _, later = best_way(world, ctx, base, t + eps, y, n, out, fr)
        pace = (later - gain) / eps if eps > 0.0 else 0.0
        if gain * gain + 2.0 * q * pace <= 0.0 or (gain <= 0.0 and pace <= 0.0):
            return math.inf  # it would stop again before it has moved
        root = math.sqrt(gain * gain + 2.0 * q * pace)
        wait = 2.0 * q / (gain + root)
        n, _ = best_way(world, ctx, base, t + wait, y, n, out, fr)
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    y[0] += wait * sx
    y[1] += wait * sy
    y[2] += wait * world.floor[4]
    y[3], y[4], y[5] = q * n[0], q * n[1], q * n[2] / r
    return t + wait
