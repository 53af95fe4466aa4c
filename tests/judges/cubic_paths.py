"""Frictionless pucks under forces that are straight over time: their paths are cubics, exactly.

Rebounds, borders and edges come from the roots of a cubic, found between its turning points, so
none can be missed.  Nothing of puck_tables is used.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

BOUNCES, BORDER, EDGE = 0, 1, 2
TIME_UP, OVER_EDGE, SETTLES, MANY = range(4)


@njit(cache=True)
def value(c, s):
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]))


@njit(cache=True)
def first_descent(c, h):
    """The first time in (0, h] at which a cubic passes 0 downwards; inf: never."""
    turns = np.empty(4)
    turns[0], count = 0.0, 1
    a, b, d = 3.0 * c[3], 2.0 * c[2], c[1]
    roots = np.empty(2)
    found = 0
    if a != 0.0:
        root = b * b - 4.0 * a * d
        if root > 0.0:
            q = -0.5 * (b + math.copysign(math.sqrt(root), b))
            roots[0] = q / a
            found = 1
            if q != 0.0:
                roots[1] = d / q
                found = 2
            if found == 2 and roots[0] > roots[1]:
                roots[0], roots[1] = roots[1], roots[0]
    elif b != 0.0:
        roots[0] = -d / b
        found = 1
    for i in range(found):
        if 0.0 < roots[i] < h:
            turns[count] = roots[i]
            count += 1
    turns[count] = h
    before = c[0]
    for i in range(count):
        low, high = turns[i], turns[i + 1]
        after = value(c, high)
        if after < 0.0 and (before > 0.0 or (before == 0.0 and i == 0)):
            if before == 0.0:
                return low
            while True:
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    return high
                if value(c, middle) > 0.0:
                    low = middle
                else:
                    high = middle
        before = after
    return math.inf


@njit(cache=True)
def follow(mass, inertia, radius, drive, pull, until, walls, edges, borders, start, events):
    """Events (n, 5): time, what, which, x, y.

    ``start``: x, y, vx, vy, ω, becomes the last state; walls: n_x, n_y, c (moved in by the
    radius), e, e_τ, μ.
    Returns how it ended, when, the number of events, the size of the path, the fastest speed.
    """
    x, y, vx, vy, spin = start
    x0, y0 = x, y
    lines = len(walls) + len(edges) + len(borders)
    region = 0
    for i in range(len(borders)):
        if borders[i, 0] * x + borders[i, 1] * y >= borders[i, 2]:
            region = i + 1
    t, piece, count, last = 0.0, 0, 0, -1
    extent, fastest = 0.0, math.hypot(vx, vy)
    c = np.empty(4)
    while t < until:
        while piece < len(drive) and drive[piece, 0] <= t:
            piece += 1
        target = min(until, drive[piece, 0]) if piece < len(drive) else until
        fx, fy, fm, gx, gy, gm = pull[0], pull[1], pull[2], 0.0, 0.0, 0.0
        if 0 < piece < len(drive):
            low, high = drive[piece - 1], drive[piece]
            span = high[0] - low[0]
            gx, gy, gm = (high[1:] - low[1:]) / span
            fx += low[1] + gx * (t - low[0])
            fy += low[2] + gy * (t - low[0])
            fm += low[3] + gm * (t - low[0])
        h = target - t
        moment, chosen = math.inf, -1
        for i in range(lines):
            sign = 1.0
            if i < len(walls):
                nx, ny, d = walls[i, 0], walls[i, 1], walls[i, 2]
            elif i < len(walls) + len(edges):
                nx, ny, d = edges[i - len(walls)]
            else:
                j = i - len(walls) - len(edges)
                if j != region and j != region - 1:
                    continue
                sign = 1.0 if j == region - 1 else -1.0
                nx, ny, d = borders[j]
            c[0] = sign * (nx * x + ny * y - d)
            if i == last:
                c[0] = 0.0
            c[1] = sign * (nx * vx + ny * vy)
            c[2] = 0.5 * sign * (nx * fx + ny * fy) / mass
            c[3] = sign * (nx * gx + ny * gy) / (6.0 * mass)
            when = first_descent(c, h)
            if when < moment:
                moment, chosen = when, i
        s = min(moment, h)
        x += s * (vx + s * (0.5 * fx + s * gx / 6.0) / mass)
        y += s * (vy + s * (0.5 * fy + s * gy / 6.0) / mass)
        vx += s * (fx + 0.5 * s * gx) / mass
        vy += s * (fy + 0.5 * s * gy) / mass
        spin += s * (fm + 0.5 * s * gm) / inertia
        extent = max(extent, math.hypot(x - x0, y - y0))
        fastest = max(fastest, math.hypot(vx, vy))
        start[0], start[1], start[2], start[3], start[4] = x, y, vx, vy, spin
        if chosen < 0:
            t, last = target, -1 if s > 0.0 else last
            continue
        t += s
        if count == len(events):
            return MANY, t, count, extent, fastest
        events[count, 0], events[count, 3], events[count, 4] = t, x, y
        last = chosen
        if chosen < len(walls):
            events[count, 1], events[count, 2] = BOUNCES, chosen
            count += 1
            nx, ny = walls[chosen, 0], walls[chosen, 1]
            fall = -(nx * vx + ny * vy)
            corner = count > 1 and events[count - 2, 1] == BOUNCES
            corner = corner and t - events[count - 2, 0] <= 1e-9 * until
            if fall < 1e-3 * fastest or corner:  # what follows is not this judge's to say
                return SETTLES, t, count, extent, fastest
            normal = (1.0 + walls[chosen, 3]) * mass * fall
            slip = nx * vy - ny * vx - radius * spin
            along = -(1.0 + walls[chosen, 4]) * slip / (1.0 / mass + radius * radius / inertia)
            most = walls[chosen, 5] * normal
            along = min(max(along, -most), most)
            vx += (normal * nx - along * ny) / mass
            vy += (normal * ny + along * nx) / mass
            spin -= radius * along / inertia
        elif chosen < len(walls) + len(edges):
            events[count, 1], events[count, 2] = EDGE, chosen - len(walls)
            return OVER_EDGE, t, count + 1, extent, fastest
        else:
            region = region - 1 if chosen - len(walls) - len(edges) == region - 1 else region + 1
            events[count, 1], events[count, 2] = BORDER, region
            count += 1
    return TIME_UP, until, count, extent, fastest
