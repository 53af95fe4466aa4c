"""PyBullet: a cylinder on a plane, its sequential impulses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pybullet as p
from task import SETTLE, SPACE, Played, gravity, is_one_disc_on_a_plane, only_puck, timed

SETTINGS = (
    "GEOM_CYLINDER on a plane, friction product f x 1, 200 solver iterations to 1e-12, no damping, "
    "no sleeping, no restitution"
)
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
can = is_one_disc_on_a_plane


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
    plane = p.createMultiBody(0.0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=puck["radius"], height=puck["height"])
    disc = p.createMultiBody(puck["mass"], shape, basePosition=[0.0, 0.0, 0.5 * puck["height"]])
    p.changeDynamics(plane, -1, lateralFriction=1.0, restitution=0.0)
    inertia = puck["mass"] * (puck["radius"] ** 2 / 4.0 + puck["height"] ** 2 / 12.0)
    p.changeDynamics(
        disc,
        -1,
        lateralFriction=puck["friction"],
        spinningFriction=0.0,
        rollingFriction=0.0,
        restitution=0.0,
        linearDamping=0.0,
        angularDamping=0.0,
        contactProcessingThreshold=1.0,
        localInertiaDiagonal=[inertia, inertia, 0.5 * puck["mass"] * puck["radius"] ** 2],
        activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING,
    )
    for _ in range(round(SETTLE / dt)):
        p.stepSimulation()
    p.setGravity(gx, gy, gz)
    (_, _, z), _ = p.getBasePositionAndOrientation(disc)
    launch = puck["launch"]
    p.resetBasePositionAndOrientation(disc, [0.0, 0.0, z], [0.0, 0.0, 0.0, 1.0])
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
