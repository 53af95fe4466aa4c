"""pymunk: seen from above, a pivot and a gear joint of limited force to the ground."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pymunk
from task import (
    FLAT,
    Played,
    gravity,
    is_steady,
    joint_limits,
    moments_of,
    motion_of,
    reach_of,
    strips_of,
    timed,
)

SETTINGS = (
    "view from above; PivotJoint of at most f m g and GearJoint of at most f m g times the mean "
    "arm to a kinematic ground, f under the centre, max_bias 0, 10 iterations"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)


can = is_steady


def pucks_of(scene: dict[str, Any]) -> list[dict[str, Any]]:
    """The pucks of a scene, each with its launch."""
    if isinstance(scene["puck"], list):
        return scene["puck"]
    return [{**scene["puck"], "launch": scene["launch"]}]


def _space(scene: dict[str, Any]) -> tuple[pymunk.Space, list[pymunk.Body], Callable[[], None]]:
    """The space, its bodies, and what must be done before each step."""
    space, bodies, joints = pymunk.Space(), [], []
    ground = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    *velocity, ground.angular_velocity = motion_of(scene)
    ground.velocity = tuple(velocity)
    space.add(ground)
    for puck in pucks_of(scene):
        m, r = puck["mass"], reach_of(puck)
        body = pymunk.Body(m, moments_of(puck)[2])
        launch = puck["launch"]
        body.position = tuple(launch.get("position", (0.0, 0.0)))
        body.velocity = tuple(launch.get("velocity") or (0.0, 0.0))
        body.angle, body.angular_velocity = launch.get("orientation", 0.0), launch.get("spin", 0.0)
        shape = pymunk.Circle(body, r)
        shape.elasticity = math.sqrt(puck.get("restitution", 1.0))  # of two it takes the product
        shape.friction = math.sqrt(min(puck.get("rim", 0.0), 1e6))
        slide = pymunk.PivotJoint(ground, body, (0.0, 0.0), (0.0, 0.0))
        turn = pymunk.GearJoint(ground, body, body.angle, 1.0)
        slide.max_bias = turn.max_bias = 0.0
        slide.max_force, turn.max_force = joint_limits(scene, puck, body.position)
        space.add(body, shape, slide, turn)
        bodies.append(body)
        joints.append((puck, body, slide, turn))

    def follow() -> None:
        for puck, body, slide, turn in joints:
            slide.anchor_a = ground.world_to_local(body.position)
            slide.max_force, turn.max_force = joint_limits(scene, puck, body.position)

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
    return space, bodies, follow if any(motion_of(scene)) or strips_of(scene) else lambda: None


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    space, bodies, follow = _space(scene)
    count = round(until / dt)
    rows = np.empty((count + 1, 7))
    for n in range(count + 1):
        if n:
            follow()
            space.step(dt)
        b = bodies[0]
        rows[n] = [n * dt, *b.position, b.angle, *b.velocity, b.angular_velocity]
    space, _, follow = _space(scene)

    def steps() -> None:
        for _ in range(count):
            follow()
            space.step(dt)

    return Played(rows, FLAT, timed(steps))
