"""Rebounds that settle: on slopes, under forces, on belts and turntables, smooth and rough walls.

The judge follows every rebound down to 1e-11 of the speed, in places measured from the wall; what
is left is one impact and a lean, with Coulomb's friction at the rim: what many small impacts give.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

KINDS = ("slope", "force", "belt", "turntable")
STEEP = [0.0017, 0.02, 0.1]  # most of the speed is lost at once


def draw(seed: int, index: int) -> dict[str, Any]:
    """A puck that is driven against one wall; ``class``: of what kind."""
    rng = np.random.default_rng([seed, index, 7])
    kind, rough = KINDS[index % 4], bool(index // 4 % 2)
    restitution = float(rng.choice([*STEEP, 0.3, 0.5, 0.7, 0.8, 0.9, 0.97, 0.99, 0.999]))
    friction = float(rng.choice([0.0, 0.05, 0.1, 0.3]))
    if kind in ("belt", "turntable"):
        friction = max(friction, 0.05)
    radius = float(10.0 ** rng.uniform(-2.0, -1.0))
    mass = float(10.0 ** rng.uniform(-1.0, 0.5))
    weight = mass * 9.80665
    gap = float(10.0 ** rng.uniform(-2.0, -0.5))
    angle = rng.uniform(-math.pi, math.pi)  # of the way to the wall
    ahead = np.array([math.cos(angle), math.sin(angle)])
    left = np.array([-ahead[1], ahead[0]])
    scene: dict[str, Any] = {
        "class": f"{kind}, {'rough' if rough else 'smooth'}",
        "puck": {
            "radius": radius, "mass": mass, "gyration": float(rng.choice([0.5, 0.7071, 1.0])),
            "height": float(rng.choice([0.0, 0.0, 0.5])) * radius / max(2.0 * friction, 0.1),
            "friction": friction,
        },

        "launch": {},
    }  # fmt: skip
    extra = float(rng.choice([0.05, 0.3, 1.0]))  # acceleration, over friction
    lean = rng.choice([0.0, 0.2, -0.5, 1.0])
    pull = angle + lean
    strength = friction + extra
    if kind == "slope":
        scene["floor"] = {"slope": float(math.atan(strength)), "downhill": float(pull)}
        rate = 9.80665 * math.cos(math.atan(strength)) * extra
    elif kind == "force":
        force = strength * weight * np.array([math.cos(pull), math.sin(pull)])
        scene["force"] = {"constant": force.tolist()}
        if rng.random() < 0.4:
            scene["force"]["torque"] = float(0.1 * weight * radius * rng.normal())
        rate = 9.80665 * extra
    elif kind == "belt":
        belt = float(rng.choice([0.3, 2.0])) * (ahead + 0.3 * lean * left)
        scene["floor"] = {"velocity": belt.tolist()}
        rate = 9.80665 * friction
    else:
        turning = float(rng.choice([-1.0, 1.0]) * rng.uniform(1.0, 5.0))
        back = math.copysign(1.0, turning) * left * rng.uniform(0.2, 0.6)
        scene["floor"] = {"turning": turning, "centre": back.tolist()}
        rate = 9.80665 * friction
    speed = float(math.sqrt(2.0 * rate * gap) * rng.choice([0.0, 0.5, 2.0]))
    velocity = speed * (ahead + rng.choice([0.0, 0.3, -1.0]) * left)
    scene["launch"] = {
        "velocity": velocity.tolist(),
        "spin": float(rng.choice([0.0, 1.0, -5.0]) * max(speed, 0.3) / radius),
    }
    wall: dict[str, Any] = {
        "point": ((gap + radius) * ahead).tolist(), "normal": (-ahead).tolist(),
        "restitution": restitution,
    }  # fmt: skip
    if rough:
        wall["tangential"] = float(rng.choice([-0.93, -0.5, 0.0, 0.3, 0.5, 0.9, 1.0]))
        wall["friction"] = float(rng.choice([0.05, 0.2, 1.0]))
    elif rng.random() < 0.5:
        wall |= {"tangential": 0.0, "friction": 0.0}
    scene["wall"] = [wall]
    hit = math.hypot(speed, math.sqrt(2.0 * rate * gap))
    settle = 2.0 * hit / rate / (1.0 - restitution)
    scene |= {"time": float(1.3 * (hit / rate + min(settle, 60.0))), "frames": 1}
    return scene
