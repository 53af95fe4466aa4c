"""Box2D: seen from above, a friction joint to the ground."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import Box2D as b2
import numpy as np
from task import (
    FLAT,
    Played,
    gravity,
    joint_limits,
    moments_of,
    motion_of,
    reach_of,
    strips_of,
    timed,
)
from with_pymunk import can as can  # the same cases
from with_pymunk import pucks_of

SETTINGS = (
    "view from above, lengths in cm; b2FrictionJoint of at most f m g and f m g times the mean arm "
    "to a kinematic ground, f under the centre, 8 velocity and 3 position iterations, no sleeping"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
CENTI = 100.0  # it is made for sizes about 1


def _world(scene: dict[str, Any]) -> tuple[Any, list[Any], Callable[[], None]]:
    """The world, its bodies, and what must be done before each step."""
    flat = (0.0, 0.0)
    if scene.get("floor", {}).get("slope"):
        gx, gy, _ = gravity(scene)
        flat = (CENTI * gx, CENTI * gy)
    world = b2.b2World(gravity=flat, doSleep=False)
    cushions, bodies, joints = world.CreateStaticBody(), [], []
    vx, vy, turning = motion_of(scene)
    ground = world.CreateKinematicBody(
        linearVelocity=(CENTI * vx, CENTI * vy), angularVelocity=turning
    )

    def joined(puck: dict[str, Any], body: Any) -> Any:
        x, y = body.position
        force, torque = joint_limits(scene, puck, (x / CENTI, y / CENTI))
        return world.CreateFrictionJoint(
            bodyA=ground,
            bodyB=body,
            anchor=body.position,
            collideConnected=True,
            maxForce=CENTI * force,
            maxTorque=CENTI**2 * torque,
        )

    for wall in scene.get("wall", []):
        (px, py), (nx, ny) = wall["point"], wall["normal"]
        ends = [(CENTI * (px + way * 10 * ny), CENTI * (py - way * 10 * nx)) for way in (-1.0, 1.0)]
        cushions.CreateFixture(
            shape=b2.b2EdgeShape(vertices=ends),
            restitution=wall["restitution"],
            friction=wall["friction"],
        )
    of_wall = scene.get("wall", [{}])[0]
    for puck in pucks_of(scene):
        m, r, launch = puck["mass"], CENTI * reach_of(puck), puck["launch"]
        x, y = launch.get("position", (0.0, 0.0))
        vx, vy = launch.get("velocity") or (0.0, 0.0)
        body = world.CreateDynamicBody(
            position=(CENTI * x, CENTI * y),
            angle=launch.get("orientation", 0.0),
            linearVelocity=(CENTI * vx, CENTI * vy),
            angularVelocity=launch.get("spin", 0.0),
            bullet=True,
        )
        body.CreateFixture(
            shape=b2.b2CircleShape(radius=r),
            density=m / (math.pi * r * r),
            restitution=puck.get("restitution", of_wall.get("restitution", 0.0)),
            friction=min(puck.get("rim", 1e6), of_wall.get("friction", 1e6)),
        )
        body.massData = b2.b2MassData(mass=m, center=(0, 0), I=CENTI**2 * moments_of(puck)[2])
        bodies.append(body)
        joints.append((puck, body, joined(puck, body)))

    def follow() -> None:  # a joint has its place once and for all
        for n, (puck, body, joint) in enumerate(joints):
            world.DestroyJoint(joint)
            joints[n] = puck, body, joined(puck, body)

    return world, bodies, follow if turning or strips_of(scene) else lambda: None


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    world, bodies, follow = _world(scene)
    count = round(until / dt)
    rows = np.empty((count + 1, 7))
    for n in range(count + 1):
        if n:
            follow()
            world.Step(dt, 8, 3)
        b = bodies[0]
        rows[n] = [
            n * dt,
            b.position[0] / CENTI,
            b.position[1] / CENTI,
            b.angle,
            b.linearVelocity[0] / CENTI,
            b.linearVelocity[1] / CENTI,
            b.angularVelocity,
        ]
    world, _, follow = _world(scene)

    def steps() -> None:
        for _ in range(count):
            follow()
            world.Step(dt, 8, 3)

    return Played(rows, FLAT, timed(steps))
