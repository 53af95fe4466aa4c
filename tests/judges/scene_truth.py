"""A scene from launch to end, by the judge: order 8, every event sampled and refined."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from contact_truth import tabled, tabled_friction
from numba import njit
from report import lines
from scene_events import (
    BORDER,
    BOUNCE,
    EDGE,
    LEANS,
    LEAVES,
    REST,
    SLIP,
    begins,
    first_event,
    gap,
    impact,
    kept,
    rebased,
    rim_state,
    still,
)
from scene_motion import (
    BLADE,
    FREE,
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
    WORK,
    World,
    best_way,
    floor_at,
    leaving_way,
    rates,
)
from scene_steps import ALL, advance, dense, prepare_dense, stage

EVENTS = ("impact", "border", "edge", "contact", "stick", "slip", "leaves")
DONE, GONE, STEPS, MANY, CORNER = range(5)
_WORK = 250  # evaluations of the forces per step of the limit: more than a step can need
ENDS = ("done", "over the edge", "too many steps", "too many events", "a rough corner")


@njit(cache=True)
def follow(world, start, until, frames, states, events, tol, speed, length, limit):
    """How it ends, when, events and frames reached, steps, fastest slip, largest rate of slip.

    ``states`` (n, 7): the six and whether it rests; place, angle, velocity and spin in the
    laboratory.
    """
    k, f = np.empty((ALL, 6)), np.empty((7, 6))
    tmp, out, new, at, fr = np.empty(6), np.empty(6), np.empty(6), np.empty(6), np.empty(3)
    y, base = start.copy(), np.zeros(2)
    ctx = np.zeros(8, np.int64)
    ctx[LEAN] = ctx[OTHER] = ctx[LAST] = -1
    ctx[RIM] = SMOOTH
    walls, edges, borders = len(world.walls), len(world.edges), len(world.borders)
    total = walls + edges + borders
    for j in range(borders):
        if world.borders[j, 0] * y[0] + world.borders[j, 1] * y[1] >= world.borders[j, 2]:
            ctx[REGION] = j + 1
    r, m, drive, turn = world.body[2], world.body[0], world.drive, world.floor[4]
    sx, sy = floor_at(world, y[0], y[1])
    y[3] -= sx
    y[4] -= sy
    y[5] -= turn
    size = np.array([length, length, length / r, speed, speed, speed / r]) * tol
    t, h, count, frame, steps = 0.0, 1e-4 * until, 0, 0, 0
    fastest, sharpest = 0.0, 0.0
    small = 1e-13 * speed
    look, over, how = True, False, DONE
    turns = 0
    while t < until:
        turns += 1
        if turns > 2 * limit or ctx[WORK] > _WORK * limit:
            how = STEPS
            break
        if count >= len(events) - 4:
            how = MANY
            break
        while ctx[PIECE] < len(drive) and drive[ctx[PIECE], 0] <= t:
            ctx[PIECE] += 1
            look = True
        target = min(until, drive[ctx[PIECE], 0]) if ctx[PIECE] < len(drive) else until
        load = world.loads[ctx[REGION]]
        q = math.sqrt(y[3] ** 2 + y[4] ** 2 + (r * y[5]) ** 2)
        if load > 0.0 and q <= small and int(world.hold[0]) == RAIL and turn != 0.0:
            # the floor goes on across the rail: the slip along it and the spin end, all the same
            sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
            wait = 10.0 * small / max(abs(turn) * math.hypot(sx, sy), 1e-9 * load / m)
            t += wait
            y[0] += wait * sx
            y[1] += wait * sy
            y[2] += wait * turn
            y[3], y[4], y[5] = 0.0, 0.0, 0.0
            kept(world, base, y)
            h = wait
        elif load > 0.0 and (q <= small and (look or ctx[MODE] == SLIDES)):
            if ctx[MODE] == RESTS or q == 0.0:
                n = np.array([0.6, 0.0, 0.8])
            else:
                n = np.array([y[3] / q, y[4] / q, r * y[5] / q])
            toward = 0.0  # how fast the slip ends
            if ctx[MODE] == SLIDES and q > 0.0:
                rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
                toward = -(y[3] * out[3] + y[4] * out[4] + r * r * y[5] * out[5]) / q
            held = True
            for _ in range(2):  # from the slip that is, and from another
                n, gain = best_way(world, ctx, base, t, y, n, out, fr)
                if gain > 0.0:
                    held = False
                    break
                n = np.array([-0.48, 0.64, -0.6])
            if held:
                if ctx[MODE] == SLIDES:
                    ctx[MODE] = RESTS
                    if toward > 0.0:
                        t += q / toward
                    events[count] = np.array([t, REST, ctx[REGION], base[0] + y[0], base[1] + y[1]])
                    count += 1
                    y[3], y[4], y[5] = 0.0, 0.0, 0.0
                    if ctx[LEAN] >= 0 and ctx[OTHER] < 0 and turn != 0.0:
                        wall = world.walls[ctx[LEAN]]
                        arm = base + y[:2] - world.floor[2:4]
                        if wall[0] * arm[0] + wall[1] * arm[1] < 0.0:  # carried off it
                            rebased(base, y)
                            ctx[LAST], ctx[LEAN], ctx[RIM] = ctx[LEAN], -1, SMOOTH
                h = max(h, 0.02 * (target - t))
            else:
                if ctx[MODE] == RESTS:
                    events[count] = np.array([t, SLIP, ctx[REGION], base[0] + y[0], base[1] + y[1]])
                    count += 1
                ctx[MODE] = SLIDES
                if toward > 0.0:
                    t += q / toward
                begun = begins(world, ctx, base, t, y, n, gain, speed, target, out, fr)
                if begun == math.inf:
                    ctx[MODE] = RESTS
                    y[3], y[4], y[5] = 0.0, 0.0, 0.0
                    h = 1e-4 * (target - t)
                    continue
                t = begun
                h = 1e-13 * speed / max(gain, 1e-9 * load / m)
        elif ctx[MODE] == RESTS and (load == 0.0 or q > small):
            ctx[MODE] = SLIDES
        look = False
        if t >= target:
            continue
        q = math.sqrt(y[3] ** 2 + y[4] ** 2 + (r * y[5]) ** 2)
        stage(world, ctx, base, t, y, out, k, 0, fr)
        pull = math.sqrt(k[0, 3] ** 2 + k[0, 4] ** 2 + (r * k[0, 5]) ** 2)
        fastest, sharpest = max(fastest, q), max(sharpest, pull)
        if ctx[MODE] == SLIDES and load > 0.0 and pull > 0.0:
            h = min(h, 0.3 * max(q, small) / pull)
        if ctx[MODE] == RESTS:
            h = min(h, 0.02 * (until - t) + 1e-9 * until)
        landed = t + h * (1.0 + 1e-9) >= target
        if landed:
            h = target - t
        error = advance(world, ctx, base, t, h, y, new, k, tmp, out, fr, size)
        steps += 1
        if steps > limit:
            how = STEPS
            break
        if not error <= 1.0 and h > 1e-14 * until * 1e-6:
            h *= max(0.1, 0.9 * error ** (-0.125)) if error == error else 0.1
            continue
        prepare_dense(world, ctx, base, t, h, y, new, k, tmp, out, fr, f)
        which, share = first_event(world, ctx, base, t, h, y, f, at, out, fr, speed)
        length_of_step = h * share if which >= 0 else h
        end = t + length_of_step if which >= 0 else (target if landed else t + h)
        while frame < len(frames) and frames[frame] <= end:
            x = min(max((frames[frame] - t) / h, 0.0), 1.0)
            dense(y, f, x, at)
            sx, sy = floor_at(world, base[0] + at[0], base[1] + at[1])
            states[frame, 0], states[frame, 1] = base[0] + at[0], base[1] + at[1]
            states[frame, 2] = at[2]
            states[frame, 3], states[frame, 4] = at[3] + sx, at[4] + sy
            states[frame, 5], states[frame, 6] = at[5] + turn, ctx[MODE]
            frame += 1
        if which < 0:
            y[:] = new
            kept(world, base, y)
            t = end
            grow = 5.0 if error == 0.0 else min(5.0, 0.9 * error ** (-0.125))
            h *= grow
            continue
        # the event, on a real step
        if which < total and share > 0.0:
            for _ in range(3):
                advance(world, ctx, base, t, length_of_step, y, new, k, tmp, out, fr, size)
                value, rate = gap(world, ctx, base, new, which)
                if rate >= 0.0 or abs(value / rate) > 0.3 * length_of_step:
                    break
                length_of_step -= value / rate
                if abs(value / rate) < 1e-16 * length_of_step:
                    break
        if share > 0.0:
            advance(world, ctx, base, t, length_of_step, y, new, k, tmp, out, fr, size)
            y[:] = new
        t += length_of_step
        look = True
        px, py = base[0] + y[0], base[1] + y[1]
        if which < walls:
            rebased(base, y)
            ctx[LAST] = which
            ctx[MODE] = SLIDES
            y_before = y.copy()
            fall = impact(world, ctx, base, y, which, world.walls[which, 3])
            rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
            nx, ny = world.walls[which, 0], world.walls[which, 1]
            sx, sy = floor_at(world, base[0], base[1])
            inward = nx * (out[3] - turn * out[1]) + ny * (out[4] + turn * out[0])
            settles = fall < 1e-11 * speed or world.walls[which, 3] == 0.0
            what = BOUNCE
            if settles and inward <= 0.0:
                y[:] = y_before
                impact(world, ctx, base, y, which, 0.0)
                what = LEANS
                if ctx[LEAN] >= 0:
                    rough = False
                    for i in (ctx[LEAN], which):
                        rough = rough or (world.walls[i, 4] != -1.0 and world.walls[i, 5] > 0.0)
                    if rough or ctx[OTHER] >= 0:
                        how = CORNER
                        break
                    ctx[OTHER] = which
                else:
                    ctx[LEAN] = which
                still(world, base, y, which)
                if ctx[OTHER] >= 0:
                    still(world, base, y, ctx[LEAN])
                    sx, sy = floor_at(world, base[0], base[1])
                    y[3], y[4] = -sx, -sy
                    ctx[RIM] = SMOOTH
                else:
                    rim_state(world, ctx, base, t, y, out, fr, speed)
            elif ctx[LEAN] >= 0:  # does it leave the wall on which it leant?
                j = ctx[LEAN]
                ctx[LAST] = -1
                sx, sy = floor_at(world, base[0], base[1])
                away = world.walls[j, 0] * (y[3] + sx) + world.walls[j, 1] * (y[4] + sy)
                if abs(away) > 1e-12 * speed:
                    ctx[LEAN] = ctx[OTHER] = -1
                    ctx[RIM] = SMOOTH
                    if away < 0.0:
                        events[count] = np.array([t, what, float(which), px, py])
                        count += 1
                        impact(world, ctx, base, y, j, world.walls[j, 3])
                        which = j
                else:
                    still(world, base, y, j)
                    rim_state(world, ctx, base, t, y, out, fr, speed)
            events[count] = np.array([t, what, float(which), px, py])
            count += 1
        elif which < walls + edges:
            events[count] = np.array([t, EDGE, float(which - walls), px, py])
            count += 1
            how, over = GONE, True
            break
        elif which < total:
            j = which - walls - edges
            ctx[REGION] = j if j == ctx[REGION] - 1 else j + 1
            if ctx[LAST] < 0 or ctx[LAST] >= walls:
                rebased(base, y)
                ctx[LAST] = which
            events[count] = np.array([t, BORDER, float(ctx[REGION]), px, py])
            count += 1
        elif which < total + 2:
            left = ctx[LEAN] if which == total else ctx[OTHER]
            if which == total:
                ctx[LEAN] = ctx[OTHER]
            ctx[OTHER] = -1
            ctx[RIM] = SMOOTH
            rebased(base, y)
            still(world, base, y, left)
            ctx[LAST] = left
            if ctx[LEAN] >= 0:
                rim_state(world, ctx, base, t, y, out, fr, speed)
            events[count] = np.array([t, LEAVES, float(left), px, py])
            count += 1
        elif which == total + 2:
            if ctx[RIM] == STICKS:
                _, _, grip = rates(world, ctx, base, t, y, y[3], y[4], y[5], out, fr)
                ctx[RIM] = -1 if grip > 0.0 else 1
            else:
                rim_state(world, ctx, base, t, y, out, fr, speed)
            look = False
        else:
            events[count] = np.array([t, SLIP, ctx[REGION], px, py])
            count += 1
            n, gain = leaving_way(world, ctx, base, t, y, out, fr)
            ctx[MODE] = SLIDES
            begun = begins(world, ctx, base, t, y, n, max(gain, 0.0), speed, target, out, fr)
            if begun == math.inf:
                ctx[MODE] = RESTS
                h = 1e-6 * (target - t)
                t += h
                continue
            t = begun
            h = 1e-12 * speed / (1e-9 * load / m)
            look = False
    while not over and how == DONE and frame < len(frames):
        sx, sy = floor_at(world, base[0] + y[0], base[1] + y[1])
        states[frame, 0], states[frame, 1] = base[0] + y[0], base[1] + y[1]
        states[frame, 2] = y[2]
        states[frame, 3], states[frame, 4] = y[3] + sx, y[4] + sy
        states[frame, 5], states[frame, 6] = y[5] + turn, ctx[MODE]
        frame += 1
    return how, t, count, frame, steps, fastest, sharpest


def _weakest(places: np.ndarray, series: np.ndarray, m: float, turns: float) -> float:
    """By how much friction brakes a slip of any direction at least, for 1 N."""
    brakes, slip = [], np.empty(3)
    for way in np.linspace(0.0, 0.5 * math.pi, 200):
        c, s = math.cos(way), math.sin(way)
        tabled_friction(places, series, len(series), c, 0.0, s, slip)
        brakes.append(-slip[0] * c / m - turns * slip[2] * s)
    return min(brakes)


def world_of(scene: dict[str, Any]) -> tuple[World, np.ndarray]:
    """A scene dict as the judge takes it, and its launch (6,)."""
    puck, floor, launch = scene["puck"], scene.get("floor", {}), scene.get("launch", {})
    m, r = puck.get("mass", 1.0), puck["radius"]
    inertia = m * (puck.get("gyration", math.sqrt(0.5)) * r) ** 2
    g = puck.get("gravity", 9.80665)
    slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
    force, drag = scene.get("force", {}), scene.get("drag", {})
    pull = np.array([*force.get("constant", (0.0, 0.0)), force.get("torque", 0.0)], float)
    pull[:2] += m * g * math.sin(slope) * np.array([math.cos(down), math.sin(down)])
    walls, edges, borders = lines(scene)
    strips = floor.get("strips")
    frictions = strips["friction"] if strips else [puck.get("friction", 0.0)]
    tables = []
    for f in frictions:
        delta = round(2.0 * f * puck.get("height", 0.0) / r, 13)
        tables.append(tabled(puck.get("pressure", "uniform"), delta if f > 0.0 else 0.0))
    most = max(len(series) for _, series in tables)
    ends, series = np.zeros((len(tables), most + 1)), np.zeros((len(tables), most, 3, 16))
    counts = np.array([len(part) for _, part in tables])
    for i, (places, part) in enumerate(tables):
        ends[i, : len(places)], series[i, : len(part)] = places, part
    hold = np.zeros(7)
    velocity = list(launch.get("velocity", (0.0, 0.0)))
    place, angle, spin = (
        launch.get("position", (0.0, 0.0)), launch.get("orientation", 0.0), launch.get("spin", 0.0)
    )  # fmt: skip
    held = scene.get("constraint")
    if held:
        a, v = held.get("angle", 0.0), held.get("velocity", (0.0, 0.0))
        if held["kind"] == "rail":
            hold[:] = RAIL, -math.sin(a), math.cos(a), 0.0, 0.0, *v
        elif held["kind"] == "blade":
            hold[[0, 4, 5]] = BLADE, a, held.get("side_slip", 0.0)
        else:
            reach = held["reach"]
            hold[:] = PIVOT, 0.0, 0.0, reach, a, *v
            velocity = [
                v[0] + spin * reach * math.sin(angle + a),
                v[1] - spin * reach * math.cos(angle + a),
            ]
    drive = np.array(scene.get("drive", []), float).reshape(-1, 4)
    loads = m * g * math.cos(slope) * np.array(frictions, float)
    weakest = [_weakest(*part, m, r * r / inertia) for part in tables] * loads
    world = World(
        np.array([m, inertia, r]), pull, drive,
        np.array([
            *floor.get("velocity", (0.0, 0.0)), *floor.get("centre", (0.0, 0.0)),
            floor.get("turning", 0.0),
        ], float),
        np.array([drag.get("sliding", 0.0), drag.get("spinning", 0.0)], float), hold,
        walls, edges, borders, loads, ends, series, counts, weakest,
    )  # fmt: skip
    return world, np.array([*place, angle, *velocity, spin], float)


def truth(
    scene: dict[str, Any], frames: np.ndarray | None = None, tol: float = 1e-14,
    limit: int = 400_000, change: np.ndarray | None = None, most: int = 200_000,
) -> dict[str, Any]:  # fmt: skip
    """``end``, ``time``, ``events`` (n, 5), ``states`` (n, 7), the scales of slip and acceleration.

    ``change`` (9,): relative changes of the launch (6), of its velocity also in units of the slip,
    and of the forces (3).
    """
    world, start = world_of(scene)
    r, m = world.body[2], world.body[0]
    sx = world.floor[0] - world.floor[4] * (start[1] - world.floor[3])
    sy = world.floor[1] + world.floor[4] * (start[0] - world.floor[2])
    slip = math.sqrt(
        (start[3] - sx) ** 2 + (start[4] - sy) ** 2 + (r * (start[5] - world.floor[4])) ** 2
    )
    if change is not None:
        start = start * (1.0 + change[:6])
        if world.hold[0] == FREE:  # a launch at rest is uncertain, too
            start[3:] += slip * change[3:6] / np.array([1.0, 1.0, r])
        world = world._replace(
            pull=world.pull * (1.0 + change[6:]),
            drive=world.drive * np.array([1.0, *(1.0 + change[6:])]),
        )
    rows = world.drive[:, 1:] if len(world.drive) else np.zeros((1, 3))
    sharp = max(
        float(world.loads.max()) / m,
        float(np.hypot(*(world.pull[:2, None] + rows.T[:2])).max()) / m,
        float(np.abs(world.pull[2] + rows[:, 2]).max()) / (m * r),
    )
    speed = max(slip, math.sqrt(sharp * r) * 0.1, 1e-12)
    until = scene["time"]
    length = max(speed * speed / sharp if sharp > 0.0 else speed * until, 1e-3 * r)
    frames = np.array([]) if frames is None else np.asarray(frames, float)
    states, events = np.full((len(frames), 7), np.nan), np.empty((most, 5))
    how, when, count, reached, steps, fastest, sharpest = follow(
        world, start, until, frames, states, events, tol, speed, length, limit
    )
    return {
        "end": ENDS[how], "time": when, "events": events[:count].copy(),
        "states": states[:reached], "steps": steps,
        "speed": fastest if fastest > 0.0 else speed,
        "rate": sharpest if sharpest > 0.0 else max(sharp, speed / until),
    }  # fmt: skip
