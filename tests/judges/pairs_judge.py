"""Every ingredient of a scene in pairs and triples, against the judge's own integrator.

Strips, which a base feels under each of its parts, have a judge of their own (astride_judge.py).

The verdict is error <= tol * max(1, amplification): how much the judge's end moves when the launch
and the forces change by 1e-7 of themselves, over that.  Units: the fastest slip and the sharpest
acceleration along the way.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

INGREDIENTS = (
    "slope", "belt", "turntable", "drag", "force", "force over time", "smooth wall",
    "rough wall", "edge", "rail", "pivot", "blade", "tall", "gyration", "pressure", "from rest",
)  # fmt: skip
_HOLDS = {"rail", "pivot", "blade"}
_CLASHES = [
    {"tall", "pressure"}, {"rail", "pivot"}, {"rail", "blade"}, {"pivot", "blade"},
    {"smooth wall", "rough wall"},
    *({hold, wall} for hold in _HOLDS for wall in ("smooth wall", "rough wall")),
]  # fmt: skip


def chosen(rng: np.random.Generator) -> list[str]:
    """Two or three ingredients that go together."""
    while True:
        names = sorted(rng.choice(INGREDIENTS, int(rng.integers(2, 4)), replace=False).tolist())
        if not any(clash <= set(names) for clash in _CLASHES):
            return names


def draw(seed: int, index: int) -> dict[str, Any]:
    """A scene; ``class``: its ingredients."""
    rng = np.random.default_rng([seed, index, 11])
    names = chosen(rng)
    radius = float(10.0 ** rng.uniform(-2.0, -0.5))
    mass, friction = float(10.0 ** rng.uniform(-1.0, 0.5)), float(rng.choice([0.1, 0.3]))
    weight = 9.80665 * mass
    delta = float(rng.choice([1.5, 2.5, 3.0]) if "tall" in names else rng.choice([0.0, 0.5]))
    speed = float(10.0 ** rng.uniform(-0.7, 0.5))
    way = rng.uniform(-math.pi, math.pi)
    ahead = np.array([math.cos(way), math.sin(way)])
    stop = speed**2 / (2.0 * friction * 9.80665)
    spin = float(rng.choice([0.0, 1.0, -1.0, 4.0])) * speed / radius
    velocity = speed * ahead
    floor: dict[str, Any] = {}
    puck = {
        "radius": radius, "mass": mass, "height": delta * radius / (2.0 * friction),
        "friction": friction,
    }  # fmt: skip
    scene: dict[str, Any] = {"class": " + ".join(names), "puck": puck, "floor": floor}
    duration = 4.0 * speed / (friction * 9.80665)
    if "gyration" in names:
        puck["gyration"] = float(rng.choice([0.3, 0.5, 1.0, 2.0, 3.0]))
    if "pressure" in names:
        puck["pressure"] = str(rng.choice(["ring", "hertz"]))
    if "from rest" in names:
        velocity, spin = np.zeros(2), 0.0
    if "slope" in names:
        floor["slope"] = float(math.atan(friction * rng.choice([0.3, 0.9, 1.1, 1.5])))
        floor["downhill"] = float(rng.uniform(-math.pi, math.pi))
    if "belt" in names:
        belt = rng.choice([0.5, 1.0, 20.0]) * speed * rng.normal(size=2)
        floor["velocity"] = belt.tolist()
        if math.hypot(*belt) > 10.0 * speed or rng.random() < 0.3:
            velocity = velocity + belt
    if "turntable" in names:
        floor["turning"] = float(rng.normal() * friction * 9.80665 / speed)
        floor["centre"] = (stop * rng.normal(size=2)).tolist()
    if "drag" in names:
        rate = mass * friction * 9.80665 / speed
        scene["drag"] = {
            "sliding": float(rate * rng.uniform(0.0, 2.0)),
            "spinning": float(rate * radius**2 * rng.uniform(0.0, 1.0)),
        }
    if "force" in names:
        scene["force"] = {
            "constant": (friction * weight * rng.choice([0.3, 0.9]) * rng.normal(size=2)).tolist(),
            "torque": float(0.3 * friction * weight * radius * rng.normal()),
        }
    if "force over time" in names:
        rows = np.zeros((5, 4))
        rows[:, 0] = np.sort(rng.uniform(-0.1, 1.0, 5)) * duration + 0.01 * np.arange(5)
        rows[:, 1:] = friction * weight * rng.normal(size=(5, 3))
        rows[:, 3] *= 0.3 * radius
        scene["drive"] = rows.tolist()
    launch: dict[str, Any] = {
        "velocity": velocity.tolist(), "spin": spin,
        "orientation": float(rng.uniform(-math.pi, math.pi)),
    }  # fmt: skip
    if names and ("smooth wall" in names or "rough wall" in names):
        walls = []
        for turn in rng.choice(
            [[0.0], [0.7, -0.7], [0.3, 2.2]][int(rng.integers(3))], 1 + int(rng.integers(2))
        ):
            n = -np.array([math.cos(way + turn), math.sin(way + turn)])
            wall = {
                "point": (-(radius + stop * rng.uniform(0.05, 0.6)) * n).tolist(),
                "normal": n.tolist(), "restitution": float(rng.choice([0.3, 0.7, 0.9, 1.0])),
            }  # fmt: skip
            if "rough wall" in names:
                wall["tangential"] = float(rng.choice([-0.5, 0.0, 0.5]))
                wall["friction"] = float(rng.choice([0.1, 0.5]))
            walls.append(wall)
        scene["wall"] = walls
    if "edge" in names:
        turn = rng.uniform(-1.4, 1.4)
        n = -np.array([math.cos(way + turn), math.sin(way + turn)])
        place = (-stop * rng.uniform(0.1, 1.0) * n).tolist()  # carried by all the floor until then
        scene["edge"] = [{"point": place, "normal": n.tolist(), "beyond": "floor"}]
    held = [name for name in names if name in _HOLDS]
    if held:
        hold: dict[str, Any] = {"kind": held[0], "angle": float(rng.uniform(-math.pi, math.pi))}
        angle = hold["angle"] + (launch["orientation"] if held[0] == "blade" else 0.0)
        along = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-along[1], along[0]])
        ground = np.zeros(2)  # a blade grips its floor, a rail and a pivot the laboratory
        if held[0] == "blade" and floor:
            arm = np.array(floor.get("centre", (0.0, 0.0)))
            ground = np.array(floor.get("velocity", (0.0, 0.0)))
            ground = ground + floor.get("turning", 0.0) * np.array([arm[1], -arm[0]])
        going = 0.3 * speed * rng.normal() if rng.random() < 0.3 else 0.0
        if going and held[0] == "blade":
            hold["side_slip"] = float(going)
        elif going:
            hold["velocity"] = (going * across).tolist()
        launch["velocity"] = (
            (velocity @ along) * along + (ground @ across + going) * across
        ).tolist()
        if held[0] == "pivot":
            hold["reach"] = float(radius * rng.uniform(0.2, 3.0))
            del launch["velocity"]
            if "from rest" not in names:
                launch["spin"] = float(rng.choice([-1.0, 1.0]) * speed / radius)
        scene["constraint"] = hold
    scene["launch"] = launch
    scene |= {"time": float(duration), "frames": 1}
    return scene
