"""Random scenes of every kind, seeded: what the tests of the scene engine draw from."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

FIELD = 4.0  # m: half the width of a field that walls or edges close


def draw(seed: int, folder: Path | None = None, *, smooth: bool = False) -> dict[str, Any]:
    """A valid scene; without walls, strips and edges if ``smooth``; forces over time in a file."""
    rng = np.random.default_rng([seed, 20240611])

    def chance(share: float) -> bool:
        return bool(rng.random() < share)

    radius = 10.0 ** rng.uniform(-1.5, 0.0)
    puck: dict[str, Any] = {"radius": radius, "mass": 10.0 ** rng.uniform(-1.0, 1.0)}
    friction = rng.choice([0.05, 0.1, 0.3, 0.6])
    if chance(0.5):
        puck["height"] = rng.uniform(0.0, 1.0) * radius / (2.0 * friction)
    if chance(0.3):
        puck["gyration"] = rng.uniform(0.3, 1.0)
    mass, weight = puck["mass"], puck["mass"] * 9.80665
    puck["friction"] = float(friction)
    floor: dict[str, Any] = {}
    speed = 10.0 ** rng.uniform(-1.0, 0.7)
    launch: dict[str, Any] = {
        "velocity": [float(v) for v in speed * rng.normal(size=2)],
        "spin": float(rng.choice([0.0, 1.0, -1.0, 5.0])) * speed / radius,
        "position": [float(v) for v in rng.uniform(-1.5, 1.5, 2)],
        "orientation": rng.uniform(-3.0, 3.0),
    }
    scene: dict[str, Any] = {"puck": puck, "floor": floor, "launch": launch}
    if chance(0.4):
        floor["slope"] = float(math.atan(friction) * rng.choice([0.3, 0.9, 1.3]))
        floor["downhill"] = rng.uniform(-3.0, 3.0)
    if chance(0.3):
        floor["velocity"] = [float(v) for v in rng.normal(size=2)]
    if chance(0.3):
        floor["turning"] = rng.uniform(-2.0, 2.0)
        floor["centre"] = [float(v) for v in rng.uniform(-1.0, 1.0, 2)]
    if chance(0.4):
        scene["drag"] = {
            "sliding": mass * rng.uniform(0.0, 1.0),
            "spinning": mass * radius**2 * rng.uniform(0.0, 1.0),
        }
    if chance(0.3):
        scene["force"] = {
            "constant": [float(v) for v in 0.5 * friction * weight * rng.normal(size=2)],
            "torque": 0.3 * friction * weight * radius * rng.normal(),
        }
    if folder is not None and chance(0.3):
        times = np.cumsum(rng.uniform(0.05, 0.5, 6)) - 0.2
        table = np.column_stack([times, friction * weight * rng.normal(size=(6, 3))])
        table[:, 3] *= 0.3 * radius
        path = folder / f"force-{seed}.csv"
        np.savetxt(path, table, delimiter=",", fmt="%.17g")
        scene.setdefault("force", {})["over_time"] = str(path)
    if chance(0.3):
        _hold(scene, rng)
    elif not smooth and chance(0.6):
        _close(scene, rng)
    if not smooth and chance(0.3):
        frictions = [float(f) for f in rng.choice([0.0, 0.5, 1.0], 3) * friction]
        frictions[1] = float(friction)
        floor["strips"] = {
            "borders": [-0.5, 0.7], "friction": frictions, "direction": rng.uniform(-3.0, 3.0),
        }  # fmt: skip
    scene |= {"time": float(rng.uniform(1.0, 6.0)), "frames": 7}
    return scene


def _hold(scene: dict[str, Any], rng: np.random.Generator) -> None:
    """A rail, a pivot or a blade, moving in half of the cases; the launch follows it."""
    kind = str(rng.choice(["rail", "pivot", "blade"]))
    hold: dict[str, Any] = {"kind": kind, "angle": rng.uniform(-3.0, 3.0)}
    moves = bool(rng.random() < 0.5)
    launch = scene["launch"]
    along, across = float(rng.normal()), 0.0
    if kind == "pivot":
        hold["reach"] = scene["puck"]["radius"] * rng.uniform(0.2, 3.0)
        launch.pop("velocity")
    if kind == "blade":
        if moves:
            hold["side_slip"] = across = float(rng.normal())
        angle = launch["orientation"] + hold["angle"]
    else:
        if moves:
            hold["velocity"] = [float(v) for v in rng.normal(size=2)]
        angle = hold["angle"]
    if kind != "pivot":
        nx, ny = -math.sin(angle), math.cos(angle)
        if kind == "rail" and moves:
            across = nx * hold["velocity"][0] + ny * hold["velocity"][1]
        if kind == "blade":  # over the floor
            floor, (x, y) = scene["floor"], launch["position"]
            turning, (cx, cy) = floor.get("turning", 0.0), floor.get("centre", (0.0, 0.0))
            vx, vy = floor.get("velocity", (0.0, 0.0))
            across += nx * (vx - turning * (y - cy)) + ny * (vy + turning * (x - cx))
        launch["velocity"] = [along * ny + across * nx, -along * nx + across * ny]
    scene["constraint"] = hold


def _close(scene: dict[str, Any], rng: np.random.Generator) -> None:
    """Walls around the field, or on some sides, and an edge far out."""
    sides = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
    count = int(rng.integers(1, 5))
    scene["wall"] = [
        {
            "point": [-FIELD * nx, -FIELD * ny],
            "normal": [nx, ny],
            "restitution": float(rng.choice([0.0, 0.5, 0.9, 1.0])),
            "tangential": float(rng.choice([-1.0, 0.0, 0.5])),
            "friction": float(rng.choice([0.0, 0.2, 10.0])),
        }
        for nx, ny in sides[:count]
    ]
    if rng.random() < 0.5:
        scene["edge"] = [{"point": [2.0 * FIELD, FIELD], "normal": [-1.0, 0.3]}]
