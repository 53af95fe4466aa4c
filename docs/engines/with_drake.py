"""Drake: a compliant hydroelastic cylinder on a rigid half space, discrete steps."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.all import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddMultibodyPlant,
    AddRigidHydroelasticProperties,
    CoulombFriction,
    Cylinder,
    DiagramBuilder,
    HalfSpace,
    MultibodyPlantConfig,
    ProximityProperties,
    RigidTransform,
    Simulator,
    SpatialInertia,
    SpatialVelocity,
    UnitInertia,
)
from task import SETTLE, SPACE, Played, gravity, is_one_disc_on_a_plane, only_puck, timed

SETTINGS = (
    "hydroelastic contact: compliant cylinder (modulus 1e6 Pa, mesh hint r/5, dissipation 10 s/m) "
    "on a rigid half space, discrete steps, approximation lagged (the default)"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
MODULUS, DISSIPATION, APPROXIMATION = 1e6, 10.0, "lagged"  # SAP would let it glide above the floor
can = is_one_disc_on_a_plane


def _launched(scene: dict[str, Any], dt: float) -> tuple[Any, Any, Any]:
    puck = only_puck(scene)
    r, h, f = puck["radius"], puck["height"], puck["friction"]
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlant(
        MultibodyPlantConfig(
            time_step=dt, contact_model="hydroelastic", discrete_contact_approximation=APPROXIMATION
        ),
        builder,
    )
    inertia = SpatialInertia(puck["mass"], np.zeros(3), UnitInertia.SolidCylinder(r, h, [0, 0, 1]))
    disc = plant.AddRigidBody("disc", inertia)
    soft, hard = ProximityProperties(), ProximityProperties()
    AddContactMaterial(friction=CoulombFriction(f, f), dissipation=DISSIPATION, properties=soft)
    AddCompliantHydroelasticProperties(r / 5.0, MODULUS, soft)
    AddContactMaterial(friction=CoulombFriction(f, f), properties=hard)
    AddRigidHydroelasticProperties(hard)
    plant.RegisterCollisionGeometry(disc, RigidTransform(), Cylinder(r, h), "disc", soft)
    world = plant.world_body()
    plant.RegisterCollisionGeometry(world, RigidTransform(), HalfSpace(), "floor", hard)
    gx, gy, gz = gravity(scene)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, gz])
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, disc, RigidTransform([0.0, 0.0, 0.5 * h]))
    simulator.AdvanceTo(round(SETTLE / dt) * dt)
    z = plant.EvalBodyPoseInWorld(context, disc).translation()[2]
    if gx or gy:  # gravity leans from the launch on; a force on the centre is the same
        raise_force(plant, context, disc, puck["mass"] * np.array([gx, gy, 0.0]))
    plant.SetFreeBodyPose(context, disc, RigidTransform([0.0, 0.0, z]))
    launch = puck["launch"]
    velocity = SpatialVelocity([0.0, 0.0, launch["spin"]], [*launch["velocity"], 0.0])
    plant.SetFreeBodySpatialVelocity(context, disc, velocity)
    return simulator, plant, disc


def raise_force(plant: Any, context: Any, disc: Any, force: np.ndarray) -> None:
    """A steady force at the centre of mass."""
    from pydrake.all import ExternallyAppliedSpatialForce, SpatialForce, Value

    applied = ExternallyAppliedSpatialForce()
    applied.body_index, applied.F_Bq_W = disc.index(), SpatialForce(np.zeros(3), force)
    plant.get_applied_spatial_force_input_port().FixValue(context, Value([applied]))


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    simulator, plant, disc = _launched(scene, dt)
    context = plant.GetMyContextFromRoot(simulator.get_context())
    start = context.get_time()
    count = round(until / dt)
    rows = np.empty((count + 1, 14))
    for n in range(count + 1):
        if n:  # an advance by nothing would take the step that is due
            simulator.AdvanceTo(start + n * dt)
        pose = plant.EvalBodyPoseInWorld(context, disc)
        velocity = plant.EvalBodySpatialVelocityInWorld(context, disc)
        q = pose.rotation().ToQuaternion()
        rows[n] = [
            n * dt,
            *pose.translation(),
            q.w(),
            q.x(),
            q.y(),
            q.z(),
            *velocity.translational(),
            *velocity.rotational(),
        ]
    simulator, *_ = _launched(scene, dt)
    return Played(rows, SPACE, timed(lambda: simulator.AdvanceTo(start + count * dt)))
