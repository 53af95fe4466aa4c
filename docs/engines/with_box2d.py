"""Box2D: seen from above, a friction joint to the ground."""

from __future__ import annotations

import math
from typing import Any

import Box2D as b2
import numpy as np
from task import FLAT, Played, gravity, timed
from with_pymunk import can as can  # the same cases
from with_pymunk import pucks_of

SETTINGS = (
    "view from above, lengths in cm; b2FrictionJoint of at most f m g and 2/3 f m g r, 8 velocity "
    "and 3 position iterations, no sleeping"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
CENTI = 100.0  # it is made for sizes about 1


def _world(scene: dict[str, Any]) -> tuple[Any, list[Any]]:
    flat = (0.0, 0.0)
    if scene.get("floor", {}).get("slope"):
        gx, gy, _ = gravity(scene)
        flat = (CENTI * gx, CENTI * gy)
    world = b2.b2World(gravity=flat, doSleep=False)
    ground, bodies = world.CreateStaticBody(), []
    for wall in scene.get("wall", []):
        (px, py), (nx, ny) = wall["point"], wall["normal"]
        ends = [(CENTI * (px + way * 10 * ny), CENTI * (py - way * 10 * nx)) for way in (-1.0, 1.0)]
        ground.CreateFixture(
            shape=b2.b2EdgeShape(vertices=ends),
            restitution=wall["restitution"],
            friction=wall["friction"],
        )
    of_wall = scene.get("wall", [{}])[0]
    for puck in pucks_of(scene):
        m, r, launch = puck["mass"], CENTI * puck["radius"], puck["launch"]
        slope = scene.get("floor", {}).get("slope", 0.0)
        load = CENTI * puck["friction"] * m * puck["gravity"] * math.cos(slope)
        x, y = launch.get("position", (0.0, 0.0))
        vx, vy = launch.get("velocity") or (0.0, 0.0)
        body = world.CreateDynamicBody(
            position=(CENTI * x, CENTI * y),
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
        world.CreateFrictionJoint(
            bodyA=ground,
            bodyB=body,
            anchor=body.position,
            collideConnected=True,
            maxForce=load,
            maxTorque=2.0 / 3.0 * load * r,
        )
        bodies.append(body)
    return world, bodies


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    world, bodies = _world(scene)
    count = round(until / dt)
    rows = np.empty((count + 1, 7))
    for n in range(count + 1):
        if n:
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
    world, _ = _world(scene)

    def steps() -> None:
        for _ in range(count):
            world.Step(dt, 8, 3)

    return Played(rows, FLAT, timed(steps))
