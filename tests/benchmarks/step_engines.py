"""The same board in engines of games, which step: pymunk and Box2D.

Floor friction is what their users do for a view from above: a joint between the ground and every
disc, as strong as f m g along the floor and 2/3 f m g r about the vertical.  It knows nothing of
how sliding and spinning brake each other.  Rims: Coulomb's friction that stops the slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import puck_tables as pt

STEP = 1e-3  # s
CENTI = 100.0  # Box2D is made for sizes about 1: lengths in cm
_STILL = 1e-6  # m/s
_LOOK = 50  # steps between two looks whether all are at rest
_MOST = 60_000  # steps


class Played(NamedTuple):
    """End time s, places (discs, 2) m, impacts as (time s, disc, disc), a wall is −1."""

    time: float
    places: np.ndarray
    impacts: list[tuple[float, int, int]]


def _until_rest(step: Callable[[], None], fastest: Callable[[], float]) -> int:
    for count in range(1, _MOST + 1):
        step()
        if count % _LOOK == 0 and fastest() < _STILL:
            break
    return count


def _corners(scene: pt.Scene) -> list[tuple[float, float]]:
    """Of a square board about the origin."""
    side = max(abs(c) for wall in scene.walls for c in wall.point)
    return [(-side, -side), (side, -side), (side, side), (-side, side)]


def play_pymunk(scene: pt.Scene, listen: bool = False) -> Played:
    """A board until rest.  Of two elasticities and frictions pymunk takes the product."""
    import pymunk

    space, impacts, clock = pymunk.Space(), [], [0.0]
    bodies, e, mu = [], math.sqrt(scene.pucks[0].restitution), math.sqrt(scene.pucks[0].rim)
    for number, p in enumerate(scene.pucks):
        body = pymunk.Body(p.mass, pymunk.moment_for_circle(p.mass, 0.0, p.radius))
        body.position, body.velocity = p.launch.position, p.launch.velocity or (0.0, 0.0)
        body.angular_velocity = p.launch.spin
        shape = pymunk.Circle(body, p.radius)
        shape.elasticity, shape.friction, shape.collision_type = e, mu, 1
        shape.number = number
        slide = pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), (0.0, 0.0))
        turn = pymunk.GearJoint(space.static_body, body, 0.0, 1.0)
        slide.max_bias = turn.max_bias = 0.0
        slide.max_force = p.mass * p.decel
        turn.max_force = 2.0 / 3.0 * p.mass * p.decel * p.radius
        space.add(body, shape, slide, turn)
        bodies.append(body)
    corners = _corners(scene)
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        line = pymunk.Segment(space.static_body, a, b, 0.0)
        line.elasticity, line.friction, line.number = e, mu, -1
        space.add(line)
    if listen:

        def begin(arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
            i, j = sorted((shape.number for shape in arbiter.shapes), reverse=True)
            impacts.append((clock[0], j, i) if j >= 0 else (clock[0], i, j))

        space.on_collision(begin=begin)

    def step() -> None:
        clock[0] += STEP
        space.step(STEP)

    count = _until_rest(step, lambda: max(abs(b.velocity) for b in bodies))
    return Played(count * STEP, np.array([tuple(b.position) for b in bodies]), impacts)


def play_box2d(scene: pt.Scene, listen: bool = False) -> Played:
    """A board until rest.  Box2D takes the larger restitution, the geometric mean of frictions."""
    import Box2D as b2

    impacts, clock = [], [0.0]

    class Listener(b2.b2ContactListener):
        def BeginContact(self, contact: b2.b2Contact) -> None:
            i, j = sorted((contact.fixtureA.userData, contact.fixtureB.userData), reverse=True)
            impacts.append((clock[0], j, i) if j >= 0 else (clock[0], i, j))

    listener = Listener() if listen else None
    world = b2.b2World(gravity=(0.0, 0.0), doSleep=True, contactListener=listener)
    law = {"restitution": scene.pucks[0].restitution, "friction": scene.pucks[0].rim}
    ground, bodies = world.CreateStaticBody(), []
    corners = [(CENTI * x, CENTI * y) for x, y in _corners(scene)]
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        ground.CreateFixture(shape=b2.b2EdgeShape(vertices=[a, b]), userData=-1, **law)
    for number, p in enumerate(scene.pucks):
        x, y = p.launch.position
        vx, vy = p.launch.velocity or (0.0, 0.0)
        body = world.CreateDynamicBody(
            position=(CENTI * x, CENTI * y), linearVelocity=(CENTI * vx, CENTI * vy),
            angularVelocity=p.launch.spin, bullet=True,
        )  # fmt: skip
        radius = CENTI * p.radius
        body.CreateFixture(
            shape=b2.b2CircleShape(radius=radius), density=p.mass / (math.pi * radius**2),
            userData=number, **law,
        )  # fmt: skip
        world.CreateFrictionJoint(
            bodyA=ground, bodyB=body, anchor=body.position, collideConnected=True,
            maxForce=CENTI * p.mass * p.decel,
            maxTorque=2.0 / 3.0 * CENTI * p.mass * p.decel * radius,
        )  # fmt: skip
        bodies.append(body)

    def step() -> None:
        clock[0] += STEP
        world.Step(STEP, 8, 3)

    count = _until_rest(step, lambda: max(b.linearVelocity.length for b in bodies) / CENTI)
    return Played(count * STEP, np.array([tuple(b.position) for b in bodies]) / CENTI, impacts)
