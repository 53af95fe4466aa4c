"""Do scenes find every wall, edge and border?  Cubic paths, exactly."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from cubic_paths import BORDER, BOUNCES, EDGE, MANY, SETTLES, follow
from report import engine, lines

WORDS = {"impact": BOUNCES, "contact": BOUNCES, "entry": BORDER, "exit": BORDER, "edge": EDGE}


def draw(seed: int, index: int) -> dict[str, Any]:
    """A frictionless scene; ``drive`` rows stand in place of the file of forces."""
    rng = np.random.default_rng([seed, index])
    radius = float(10.0 ** rng.uniform(-2.5, -0.7))
    mass = float(10.0 ** rng.uniform(-1.0, 0.5))
    span = float(10.0 ** rng.uniform(-0.3, 1.0))
    count = int(rng.integers(2, 9))
    times = np.sort(rng.uniform(-0.2, 1.1, count)) * span
    times += 1e-3 * span * np.arange(count)
    speed = float(10.0 ** rng.uniform(-0.5, 0.7))
    rows = np.column_stack([times, rng.normal(size=(count, 3)) * mass * speed / span])
    rows[:, 1:3] *= 10.0 ** rng.uniform(0.0, 1.3)  # so strong that paths turn back
    rows[:, 3] *= radius
    heading = rng.uniform(-math.pi, math.pi)
    scene: dict[str, Any] = {
        "puck": {
            "radius": radius, "mass": mass, "gyration": float(rng.uniform(0.3, 1.5)),
            "friction": 0.0,
        },
        "launch": {
            "velocity": [speed * math.cos(heading), speed * math.sin(heading)],
            "spin": float(rng.choice([0.0, 1.0, -3.0])) * speed / radius,
        },
        "time": span,
        "frames": 1,
        "drive": rows.tolist(),
    }  # fmt: skip
    if rng.random() < 0.3:
        scene["force"] = {"constant": (rng.normal(size=2) * mass * speed / span).tolist()}
    room = speed * span * 10.0 ** rng.uniform(-2.0, 0.3)
    walls, edges = [], []
    for _ in range(int(rng.choice([0, 0, 1, 2]))):  # lines that the path, were it free, just grazes
        place, velocity = free_state(scene, span * rng.uniform(0.05, 1.0))
        n = np.array([-velocity[1], velocity[0]]) / np.hypot(*velocity)
        bend = free_state(scene, scene["time"])[0] - place
        n *= math.copysign(1.0, n @ bend) * rng.choice([1.0, 1.0, -1.0])
        depth = span * speed * rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, -1.0)
        line = {"point": (place + depth * n).tolist(), "normal": n.tolist()}
        if -n @ line["point"] <= 0.0:
            continue  # the launch is beyond it
        if rng.random() < 0.3:
            edges.append(line)
        elif -n @ line["point"] > radius:
            line["point"] = (place + (depth - radius) * n).tolist()
            walls.append({**line, "restitution": 0.8, "tangential": 0.0, "friction": 0.3})
    for _ in range(int(rng.integers(0, 5))):
        angle = rng.uniform(-math.pi, math.pi)
        if walls and rng.random() < 0.4:  # a sharp angle with the one before
            n = walls[-1]["normal"]
            angle = math.atan2(n[1], n[0]) + math.pi + rng.uniform(-0.4, 0.4)
        n = np.array([math.cos(angle), math.sin(angle)])
        gap = radius + room * 10.0 ** rng.uniform(-2.0, 0.0)
        walls.append({
            "point": (-gap * n).tolist(), "normal": n.tolist(),
            "restitution": float(rng.choice([0.3, 0.5, 0.9, 1.0])),
            "tangential": float(rng.choice([-1.0, 0.0, 0.6])),
            "friction": float(rng.choice([0.0, 0.2, 10.0])),
        })  # fmt: skip
    if walls:
        scene["wall"] = walls
    if rng.random() < 0.5:  # strips, some narrower than a step
        places = np.sort(room * rng.normal(size=int(rng.integers(1, 6))))
        if rng.random() < 0.5:
            places = places[:1] + np.cumsum(np.full(len(places), room * 10 ** rng.uniform(-4, -1)))
        scene["floor"] = {"strips": {
            "borders": places.tolist(), "friction": [0.0] * (len(places) + 1),
            "direction": float(rng.uniform(-math.pi, math.pi)),
        }}  # fmt: skip
    if rng.random() < 0.3:
        angle = rng.uniform(-math.pi, math.pi)
        n = np.array([math.cos(angle), math.sin(angle)])
        edges.append({"point": (-2.0 * room * n).tolist(), "normal": n.tolist()})
    if edges:
        scene["edge"] = edges
    return scene


def free_state(scene: dict[str, Any], when: float) -> tuple[np.ndarray, np.ndarray]:
    """Place and velocity of the same puck without lines."""
    bare = {key: part for key, part in scene.items() if key not in ("wall", "edge")}
    bare["floor"], bare["time"] = {}, float(when)
    state = truth(bare)[5]
    return state[:2], state[2:4]


def truth(scene: dict[str, Any], shift: float = 0.0, turn: float = 0.0) -> tuple:
    """How it ends, when, events (n, 5), size of path, fastest speed, last state; lines moved."""
    puck, launch = scene["puck"], scene["launch"]
    walls, edges, _ = lines(scene)
    walls[:, 2] += shift
    edges[:, 2] += shift
    borders = rims(scene, shift)[0]
    force = scene.get("force", {})
    c, s = math.cos(turn), math.sin(turn)
    vx, vy = launch["velocity"]
    start = np.array(
        [*launch.get("position", (0.0, 0.0)), c * vx - s * vy, s * vx + c * vy, launch["spin"]]
    )
    events = np.empty((400, 5))
    how, when, count, extent, fastest = follow(
        puck["mass"], puck["mass"] * (puck["gyration"] * puck["radius"]) ** 2, puck["radius"],
        np.array(scene["drive"]), np.array([*force.get("constant", (0.0, 0.0)), 0.0]),
        scene["time"], walls, edges, borders, start, events,
    )  # fmt: skip
    return how, when, events[:count], extent, fastest, start


def rims(scene: dict[str, Any], shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Lines (2n, 3) at which a centre is when the rim meets or leaves a border, and which (2n,)."""
    borders, radius = lines(scene)[2], scene["puck"]["radius"]
    borders[:, 2] += shift * (-1.0) ** np.arange(len(borders))
    both = np.repeat(borders, 2, axis=0)
    both[:, 2] += np.tile([-radius, radius], len(borders))
    order = np.argsort(both[:, 2], kind="stable")
    return both[order], np.repeat(np.arange(len(borders)), 2)[order]


def prepared(seed: int, index: int) -> dict[str, Any]:
    """A scene that ends before its rebounds settle, and before 300 events."""
    scene = draw(seed, index)
    how, _, events, *_ = truth(scene)
    if how in (SETTLES, MANY):
        keep = events[min(len(events) - 1, 300), 0]
        scene["time"] = float(0.999 * keep)
    return scene


def _borders(scene: dict[str, Any], events: np.ndarray) -> np.ndarray:
    """Which wall, edge or border was met: of the zones that were entered, which border."""
    ways, numbers = rims(scene)
    x, y = scene["launch"].get("position", (0.0, 0.0))
    zone = int(sum(nx * x + ny * y >= c for nx, ny, c in ways))
    which = events[:, 2].copy()
    for i, (_, what, entered, *_) in enumerate(events):
        if what == BORDER:
            which[i], zone = numbers[min(zone, int(entered))], int(entered)
    return which


def certain(scene: dict[str, Any], tol: float) -> tuple[np.ndarray, np.ndarray, int]:
    """Events that lines moved by 10 tol of the path's size keep: times, spreads, how many."""
    _, _, events, extent, *_ = truth(scene)
    spread, sure = np.zeros(len(events)), len(events)
    for shift, turn in ((1, 0), (-1, 0), (0.5, 1), (-0.5, -1), (1, 1), (-1, 1)):
        _, _, other, *_ = truth(scene, 10.0 * tol * extent * shift, 10.0 * tol * turn)
        same = min(len(events), len(other))
        differ = np.flatnonzero(np.any(events[:same, 1:3] != other[:same, 1:3], axis=1))
        sure = min(sure, same if not len(differ) else int(differ[0]))
        spread[:same] = np.maximum(spread[:same], np.abs(events[:same, 0] - other[:same, 0]))
    return events, spread, sure


def verdict(scene: dict[str, Any], tol: float, folder: Path) -> tuple[str, str, int]:
    """'right', 'missed', 'invented', 'late' or 'refused', in words, and the number of events."""
    events, spread, sure = certain(scene, tol)
    span = scene["time"]
    run, words = engine(scene, tol, folder)
    if run is None:
        return "refused", words, sure
    found = [
        (e.time, WORDS[e.what], int(e.partner.split()[-1])) for e in run.events if e.what in WORDS
    ]
    events[:, 2] = _borders(scene, events)
    complete = sure == len(events)
    for i in range(sure):
        t, what, which = events[i, :3]
        if i >= len(found):
            return "missed", f"event {i} ({what:g}, {which:g}) at {t:.12g}: there is none", sure
        if found[i][1:] != (what, which):
            kind = "missed" if found[i][0] > t else "invented"
            return kind, f"event {i} ({what:g}, {which:g}) at {t:.12g}: {found[i]}", sure
        allowed = 3.0 * spread[i] + 10.0 * tol * span
        if abs(found[i][0] - t) > allowed:
            return "late", f"event {i} at {t:.12g}: {found[i][0]:.12g} (± {allowed:.2g})", sure
    if complete and len(found) > sure:
        return "invented", f"{found[sure]} after the last", sure
    return "right", "", sure
