"""PyBullet: a cylinder on a plane, its sequential impulses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pybullet as p
from task import (
    FAR,
    HEAVY,
    SETTLE,
    SPACE,
    Played,
    box_of,
    gravity,
    has_one_puck_and_no_cushion,
    moments_of,
    motion_of,
    only_puck,
    parts_of,
    strips_of,
    timed,
    turned_by,
)

SETTINGS = (
    "GEOM_CYLINDER, GEOM_BOX or GEOM_MESH on a plane (on boxes where strips differ or the floor "
    "moves), friction 1 x f, 200 solver iterations to 1e-12, no damping, "
    "no sleeping, no restitution"
)
DEEP = 0.5  # m
MANY = {"shapeType": "shapeTypes", "radius": "radii", "length": "lengths",
        "halfExtents": "halfExtents"}  # fmt: skip
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
can = has_one_puck_and_no_cushion


def _floor(scene: dict[str, Any], friction: float) -> Callable[[], None]:
    """A plane; a box for each strip; a heavy box on a joint where the floor moves: it starts it."""
    vx, vy, turning = motion_of(scene)
    rubs: dict[str, Any] = {"restitution": 0.0, "linearDamping": 0.0, "angularDamping": 0.0}
    if not (vx or vy or turning or strips_of(scene)):
        plane = p.createMultiBody(0.0, p.createCollisionShape(p.GEOM_PLANE))
        p.changeDynamics(plane, -1, lateralFriction=friction, **rubs)
        return lambda: None
    direction = scene["floor"]["strips"]["direction"] if strips_of(scene) else 0.0
    turn = p.getQuaternionFromEuler([0.0, 0.0, direction])
    for low, high, f in strips_of(scene):
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5 * (high - low), FAR, DEEP])
        place = 0.5 * (low + high) * np.array([np.cos(direction), np.sin(direction)])
        strip = p.createMultiBody(0.0, shape, -1, [*place, -DEEP], turn)
        p.changeDynamics(strip, -1, lateralFriction=f, **rubs)
    if strips_of(scene):
        return lambda: None
    speed = float(np.hypot(vx, vy))
    belt = p.createMultiBody(
        baseMass=0.0,
        linkMasses=[HEAVY],
        linkCollisionShapeIndices=[
            p.createCollisionShape(p.GEOM_BOX, halfExtents=[FAR, FAR, DEEP])
        ],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0.0, 0.0, -DEEP]],
        linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkInertialFramePositions=[[0.0, 0.0, 0.0]],
        linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_REVOLUTE if turning else p.JOINT_PRISMATIC],
        linkJointAxis=[[0.0, 0.0, 1.0] if turning else [vx / speed, vy / speed, 0.0]],
    )
    p.changeDynamics(belt, 0, lateralFriction=friction, jointDamping=0.0, **rubs)
    p.setJointMotorControl2(belt, 0, p.VELOCITY_CONTROL, force=0.0)
    return lambda: p.resetJointState(belt, 0, 0.0, turning or speed)


def _solid(puck: dict[str, Any]) -> int:
    """A cylinder, or the cylinders, boxes and other prisms on the base."""
    half, alone = 0.5 * puck["height"], len(parts_of(puck)) == 1
    kinds: list[dict[str, Any]] = []
    for part in parts_of(puck):
        if isinstance(part[0], float):
            x, y, r = part
            size = {"radius": r, "height" if alone else "length": 2.0 * half}
            kinds.append({"shapeType": p.GEOM_CYLINDER, **size, "at": [x, y, 0.0]})
        elif (box := box_of(part)) is not None:
            x, y, a, b = box
            size = {"halfExtents": [a, b, half]}
            kinds.append({"shapeType": p.GEOM_BOX, **size, "at": [x, y, 0.0]})
        else:
            corners = [[x, y, z] for z in (-half, half) for x, y in part]
            kinds.append({"shapeType": p.GEOM_MESH, "vertices": corners, "at": [0.0, 0.0, 0.0]})
    if alone:
        (kind,) = kinds
        return p.createCollisionShape(collisionFramePosition=kind.pop("at"), **kind)
    places = [kind.pop("at") for kind in kinds]
    columns = {MANY[name]: [kind[name] for kind in kinds] for name in kinds[0]}
    return p.createCollisionShapeArray(collisionFramePositions=places, **columns)


def _launched(scene: dict[str, Any], dt: float) -> int:
    p.resetSimulation()
    puck = only_puck(scene)
    p.setPhysicsEngineParameter(
        fixedTimeStep=dt,
        numSubSteps=0,
        numSolverIterations=200,
        solverResidualThreshold=1e-12,
        enableConeFriction=1,
    )
    gx, gy, gz = gravity(scene)
    p.setGravity(0.0, 0.0, gz)
    start = _floor(scene, puck["friction"])
    shape = _solid(puck)
    launch = puck["launch"]
    x, y = launch.get("position", (0.0, 0.0))
    disc = p.createMultiBody(puck["mass"], shape, basePosition=[x, y, 0.5 * puck["height"]])
    p.changeDynamics(
        disc,
        -1,
        lateralFriction=1.0,
        spinningFriction=0.0,
        rollingFriction=0.0,
        restitution=0.0,
        linearDamping=0.0,
        angularDamping=0.0,
        contactProcessingThreshold=1.0,
        localInertiaDiagonal=moments_of(puck),
        activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING,
    )
    for _ in range(round(SETTLE / dt)):
        p.stepSimulation()
    p.setGravity(gx, gy, gz)
    (_, _, z), _ = p.getBasePositionAndOrientation(disc)
    start()
    cosine, sine = turned_by(launch)
    p.resetBasePositionAndOrientation(disc, [x, y, z], [0.0, 0.0, sine, cosine])
    p.resetBaseVelocity(disc, [*launch["velocity"], 0.0], [0.0, 0.0, launch["spin"]])
    return disc


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    client = p.connect(p.DIRECT)
    disc = _launched(scene, dt)
    count = round(until / dt)
    rows = np.empty((count + 1, 14))
    for n in range(count + 1):
        if n:
            p.stepSimulation()
        place, (qx, qy, qz, qw) = p.getBasePositionAndOrientation(disc)
        linear, angular = p.getBaseVelocity(disc)
        rows[n] = [n * dt, *place, qw, qx, qy, qz, *linear, *angular]
    _launched(scene, dt)

    def steps() -> None:
        for _ in range(count):
            p.stepSimulation()

    seconds = timed(steps)
    p.disconnect(client)
    return Played(rows, SPACE, seconds)
