"""Equations of a puck in a scene for the judge: slip relative to the floor as the unknown.

State y (6,): place from ``base``, angle, and velocity and spin relative to the floor, so that a
slow slip on a fast floor keeps its digits.  A wall that the puck leans on takes the force into
it; its rim feels Coulomb's friction where the wall is rough, as of infinitely many small rebounds.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from contact_truth import tabled_friction
from numba import njit

FREE, RAIL, PIVOT, BLADE = range(4)
REGION, PIECE, LEAN, OTHER, RIM, MODE, LAST, WORK = range(8)  # of the context, whole numbers
SLIDES, RESTS = 0, 1
STICKS, SMOOTH = 0, 2  # of RIM, beside ±1: the way it slips
NONE = 1e-30  # the size of a slip that has a direction only: drag and spin do nothing on it


class World(NamedTuple):
    """``body``: m, I, r; ``pull``: Fx, Fy, torque; ``floor``: vx, vy, cx, cy, Ω; ``drag``: two.

    ``hold``: kind, n_x, n_y of a rail, reach of a pivot, angle of both others, and v (side slip).
    ``weakest``: by how much friction brakes a slip of any direction, at least, in each region.
    """

    body: np.ndarray
    pull: np.ndarray
    drive: np.ndarray
    floor: np.ndarray
    drag: np.ndarray
    hold: np.ndarray
    walls: np.ndarray
    edges: np.ndarray
    borders: np.ndarray
    loads: np.ndarray
    ends: np.ndarray
    series: np.ndarray
    counts: np.ndarray
    weakest: np.ndarray


@njit(cache=True)
def driven(world, piece, t):
    """Given force and torque."""
    pull, drive = world.pull, world.drive
    fx, fy, fm = pull[0], pull[1], pull[2]
    if 0 < piece < len(drive):
        a, b = drive[piece - 1], drive[piece]
        share = (t - a[0]) / (b[0] - a[0])
        fx += a[1] + share * (b[1] - a[1])
        fy += a[2] + share * (b[2] - a[2])
        fm += a[3] + share * (b[3] - a[3])
    return fx, fy, fm


@njit(cache=True)
def floor_at(world, x, y):
    floor = world.floor
    return floor[0] - floor[4] * (y - floor[3]), floor[1] + floor[4] * (x - floor[2])


@njit(cache=True)
def rates(world, ctx, base, t, y, ux, uy, w, out, fr):
    """d/dt of the state y that slips at (ux, uy, w) into ``out``; reactions N, N', T of walls."""
    ctx[WORK] += 1
    m, inertia, r = world.body
    turn = world.floor[4]
    sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
    vx, vy, spin = ux + sx, uy + sy, w + turn
    fx, fy, fm = driven(world, ctx[PIECE], t)
    region = ctx[REGION]
    load = world.loads[region]
    if load > 0.0:
        tabled_friction(
            world.ends[region], world.series[region], world.counts[region], ux, uy, r * w, fr
        )
        fx += load * fr[0]
        fy += load * fr[1]
        fm += load * r * fr[2]
    fx -= world.drag[0] * ux
    fy -= world.drag[0] * uy
    fm -= world.drag[1] * w
    push, other, grip = 0.0, 0.0, 0.0
    if ctx[LEAN] >= 0:
        wall = world.walls[ctx[LEAN]]
        nx, ny = wall[0], wall[1]
        if ctx[OTHER] >= 0:  # held in a smooth corner
            second = world.walls[ctx[OTHER]]
            cross = nx * second[1] - ny * second[0]
            push = -(fx * second[1] - fy * second[0]) / cross
            other = -(nx * fy - ny * fx) / cross
            fx, fy = 0.0, 0.0
        else:
            push = -(fx * nx + fy * ny)
            fx += push * nx
            fy += push * ny
            if ctx[RIM] != SMOOTH:
                if ctx[RIM] == STICKS:
                    along = (nx * fy - ny * fx) / m - r * fm / inertia
                    grip = -along / (1.0 / m + r * r / inertia)
                else:
                    grip = -wall[5] * push * ctx[RIM]
                fx -= grip * ny
                fy += grip * nx
                fm -= r * grip
    hold = world.hold
    kind = int(hold[0])
    if kind == RAIL:
        back = -(fx * hold[1] + fy * hold[2])
        fx += back * hold[1]
        fy += back * hold[2]
    elif kind == BLADE:
        # along the floor: d/dt of the side slip −s u_x + c u_y is 0
        c, s = math.cos(y[2] + hold[4]), math.sin(y[2] + hold[4])
        back = m * (spin * (c * ux + s * uy) + turn * (c * vx + s * vy)) - (-s * fx + c * fy)
        fx -= back * s
        fy += back * c
    elif kind == PIVOT:
        # v = v_p + ω reach (s, −c) about the pivot
        c, s, reach = math.cos(y[2] + hold[4]), math.sin(y[2] + hold[4]), hold[3]
        about = fm + reach * (s * fx - c * fy)
        gain = about / (inertia + m * reach * reach)
        fx = m * (gain * reach * s + spin * spin * reach * c)
        fy = m * (-gain * reach * c + spin * spin * reach * s)
        fm = inertia * gain
    out[0], out[1], out[2] = vx, vy, spin
    if ctx[MODE] == RESTS:
        out[3], out[4], out[5] = 0.0, 0.0, 0.0
    else:
        out[3], out[4], out[5] = fx / m + turn * vy, fy / m - turn * vx, fm / inertia
    return push, other, grip


@njit(cache=True)
def allowed(world, y, n):
    """Of the direction n (3,) of a slip only what the constraint lets be, of size 1 again."""
    hold, kind = world.hold, int(world.hold[0])
    if kind == FREE:
        return
    c, s = math.cos(y[2] + hold[4]), math.sin(y[2] + hold[4])
    if kind == PIVOT:
        reach, r = hold[3], world.body[2]
        share = (reach * (s * n[0] - c * n[1]) + r * n[2]) / (reach * reach + r * r)
        n[0], n[1], n[2] = share * reach * s, -share * reach * c, share * r
    else:
        if kind == RAIL:
            c, s = hold[2], -hold[1]
        along = c * n[0] + s * n[1]
        n[0], n[1] = c * along, s * along
    size = math.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    if size == 0.0:  # straight against it
        n[0], n[1], n[2] = 0.0, 0.0, 1.0
        size = 1.0
        if kind == PIVOT:
            n[0], n[1], n[2] = hold[3] * s, -hold[3] * c, world.body[2]
            size = math.sqrt(hold[3] ** 2 + world.body[2] ** 2)
    for i in range(3):
        n[i] /= size


@njit(cache=True)
def slow_way(world, ctx, base, t, y, guess, out, fr):
    """The direction (3,) that a slip of no size settles to, and the rate at which it grows.

    Near Q = 0 the direction n turns by Q n′ = a − (a·n) n; it is followed to where it stays.
    """
    r = world.body[2]
    n = guess.copy()
    mode = ctx[MODE]
    ctx[MODE] = SLIDES
    gain, step, before, last = 0.0, 0.0, math.inf, -math.inf
    a, trial = np.empty(3), np.empty(3)
    for again in range(3000):
        allowed(world, y, n)
        rates(world, ctx, base, t, y, NONE * n[0], NONE * n[1], NONE * n[2] / r, out, fr)
        a[0], a[1], a[2] = out[3], out[4], r * out[5]
        if again == 0 and world.hold[0] == FREE and ctx[LEAN] < 0:
            load, (m, inertia, _) = world.loads[ctx[REGION]], world.body
            fx, fy = a[0] - load * fr[0] / m, a[1] - load * fr[1] / m
            pull = math.hypot(math.hypot(fx, fy), a[2] - load * r * r * fr[2] / inertia)
            if pull < 0.9 * world.weakest[ctx[REGION]]:  # it is held, whatever the way
                ctx[MODE] = mode
                return n, pull - world.weakest[ctx[REGION]]
        gain = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
        off = 0.0
        for i in range(3):
            off += (a[i] - gain * n[i]) ** 2
        off = math.sqrt(off)
        whole = math.sqrt(a[0] ** 2 + a[1] ** 2 + a[2] ** 2)
        friction = world.loads[ctx[REGION]] / world.body[0]
        if again == 0:
            step = 0.3 / max(whole, friction, 1e-300)
        if off <= 2e-14 * whole or (off > 0.99 * before and off < 1e-12 * whole):
            break
        if off > before and gain < last:  # too far; away from an unstable way off grows, too
            step *= 0.7
        else:
            step *= 1.03
        before, last = off, gain
        size = 0.0
        for i in range(3):
            trial[i] = n[i] + step * (a[i] - gain * n[i])
            size += trial[i] ** 2
        for i in range(3):
            n[i] = trial[i] / math.sqrt(size)
    ctx[MODE] = mode
    return n, gain


@njit(cache=True)
def best_way(world, ctx, base, t, y, guess, out, fr):
    """:func:`slow_way`, and of the ways that a rim on a rough wall can go the one that grows."""
    if ctx[LEAN] < 0 or ctx[RIM] == SMOOTH or ctx[OTHER] >= 0:
        return slow_way(world, ctx, base, t, y, guess, out, fr)
    wall = world.walls[ctx[LEAN]]
    was, n, gain = ctx[RIM], guess, -math.inf
    for rim in (1, -1, STICKS):
        for sign in (1.0, -1.0):
            ctx[RIM] = rim
            turn = sign * math.sqrt(0.5) if rim == STICKS else -0.6 * rim
            along = sign * math.sqrt(0.5) if rim == STICKS else 0.8 * rim
            trial = np.array([-wall[1] * along, wall[0] * along, turn])
            way, growth = slow_way(world, ctx, base, t, y, trial, out, fr)
            slip = wall[0] * way[1] - wall[1] * way[0] - way[2]
            push, _, grip = rates(
                world, ctx, base, t, y, way[0], way[1], way[2] / world.body[2], out, fr
            )
            fits = abs(grip) <= wall[5] * push if rim == STICKS else rim * slip > 0.0
            if fits and growth > gain:
                n, gain, was = way, growth, rim
    ctx[RIM] = was
    return n, gain


@njit(cache=True)
def leaving_way(world, ctx, base, t, y, out, fr):
    """:func:`best_way` from two guesses: where a constraint leaves two ways, one may end."""
    n, gain = best_way(world, ctx, base, t, y, np.array([0.6, 0.0, 0.8]), out, fr)
    other, growth = best_way(world, ctx, base, t, y, np.array([-0.48, 0.64, -0.6]), out, fr)
    if growth > gain:
        return other, growth
    return n, gain
