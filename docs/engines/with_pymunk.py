"""pymunk: seen from above, a pivot and a gear joint of limited force to the ground."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pymunk
from task import FLAT, Played, gravity, timed

SETTINGS = (
    "view from above; PivotJoint of at most f m g and GearJoint of at most 2/3 f m g r to the "
    "ground, max_bias 0, 10 iterations"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)


def can(scene: dict[str, Any]) -> bool:
    """Two limits of force know nothing of rings; floors that move, and borders, are left out."""
    floor = scene.get("floor", {})
    pucks = scene["puck"] if isinstance(scene["puck"], list) else [scene["puck"]]
    moves = any(floor.get("velocity", (0.0, 0.0))) or floor.get("turning", 0.0)
    if moves or floor.get("strips"):
        return False
    return all(p.get("pressure", "uniform") == "uniform" for p in pucks)


def pucks_of(scene: dict[str, Any]) -> list[dict[str, Any]]:
    """The pucks of a scene, each with its launch."""
    if isinstance(scene["puck"], list):
        return scene["puck"]
    return [{**scene["puck"], "launch": scene["launch"]}]


def _space(scene: dict[str, Any]) -> tuple[pymunk.Space, list[pymunk.Body]]:
    space, bodies = pymunk.Space(), []
    for puck in pucks_of(scene):
        m, r, f = puck["mass"], puck["radius"], puck["friction"]
        slope = scene.get("floor", {}).get("slope", 0.0)
        load = f * m * puck["gravity"] * math.cos(slope)
        body = pymunk.Body(m, pymunk.moment_for_circle(m, 0.0, r))
        launch = puck["launch"]
        body.position = tuple(launch.get("position", (0.0, 0.0)))
        body.velocity = tuple(launch.get("velocity") or (0.0, 0.0))
        body.angular_velocity = launch.get("spin", 0.0)
        shape = pymunk.Circle(body, r)
        shape.elasticity = math.sqrt(puck.get("restitution", 1.0))  # of two it takes the product
        shape.friction = math.sqrt(min(puck.get("rim", 0.0), 1e6))
        slide = pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), (0.0, 0.0))
        turn = pymunk.GearJoint(space.static_body, body, 0.0, 1.0)
        slide.max_bias = turn.max_bias = 0.0
        slide.max_force, turn.max_force = load, 2.0 / 3.0 * load * r
        space.add(body, shape, slide, turn)
        bodies.append(body)
    if scene.get("floor", {}).get("slope"):
        gx, gy, _ = gravity(scene)
        space.gravity = (gx, gy)
    for wall in scene.get("wall", []):
        (px, py), (nx, ny) = wall["point"], wall["normal"]
        line = pymunk.Segment(
            space.static_body, (px - 10 * ny, py + 10 * nx), (px + 10 * ny, py - 10 * nx), 0.0
        )
        shape = next(iter(bodies[0].shapes))
        shape.elasticity = line.elasticity = math.sqrt(wall["restitution"])
        shape.friction = line.friction = math.sqrt(wall["friction"])
        space.add(line)
    return space, bodies


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    space, bodies = _space(scene)
    count = round(until / dt)
    rows = np.empty((count + 1, 7))
    for n in range(count + 1):
        if n:
            space.step(dt)
        b = bodies[0]
        rows[n] = [n * dt, *b.position, b.angle, *b.velocity, b.angular_velocity]
    space, _ = _space(scene)

    def steps() -> None:
        for _ in range(count):
            space.step(dt)

    return Played(rows, FLAT, timed(steps))
