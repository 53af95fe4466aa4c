"""Drake: a rigid disc with a fine base on a compliant hydroelastic half space, discrete steps.

A hydroelastic cylinder would do worse: the triangles of its base reach from the middle to the rim,
and friction is taken at their centroids, so at 2/3 r alone, whatever the resolution hint.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from pydrake.all import (
    AddCompliantHydroelasticProperties,
    AddCompliantHydroelasticPropertiesForHalfSpace,
    AddContactMaterial,
    AddMultibodyPlant,
    AddRigidHydroelasticProperties,
    Box,
    CoulombFriction,
    DiagramBuilder,
    HalfSpace,
    InMemoryMesh,
    MemoryFile,
    Mesh,
    MultibodyPlantConfig,
    PlanarJoint,
    ProximityProperties,
    RigidTransform,
    RotationMatrix,
    Simulator,
    SpatialInertia,
    SpatialVelocity,
    UnitInertia,
)
from task import (
    FAR,
    HEAVY,
    SETTLE,
    SPACE,
    Played,
    gravity,
    has_one_puck_and_no_cushion,
    hole_of,
    moments_of,
    motion_of,
    only_puck,
    parts_of,
    strips_of,
    timed,
    turned_by,
)

SETTINGS = (
    "hydroelastic contact: rigid solid, its base in 8 rings of triangles, on a compliant half "
    "space (1 cm, 1e6 Pa or what sinks by 1.25 um, dissipation 10 s/m), discrete steps, "
    "approximation lagged (the default)"
)
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
SINKS = 1.25e-4  # of the depth, at most: where sides sink in they plough
MODULUS, DEPTH, DISSIPATION, RINGS = 1e6, 0.01, 10.0, 8
THIN = 1e-3  # m
SLIPS = 1e9  # of the disc: f of two is 2 f1 f2/(f1 + f2), so twice the half that the floor has
APPROXIMATION = "lagged"  # SAP would let it glide above the floor
can = has_one_puck_and_no_cushion


def ringed(part: Any, hole: float) -> tuple[list[Any], list[Any], list[list[int]]]:
    """A disc or a convex polygon in rings of alike triangles: places, triangles, borders."""
    if isinstance(part[0], float):
        x, y, r = part
        sectors = 6

        def at(share: float, turn: float) -> tuple[float, float]:
            a = 2.0 * np.pi * turn / sectors
            return x + r * share * np.cos(a), y + r * share * np.sin(a)
    else:
        corners = np.array(part)
        sectors, middle = len(corners), corners.mean(axis=0)

        def at(share: float, turn: float) -> tuple[float, float]:
            side, along = int(turn) % sectors, turn % 1.0
            edge = (1.0 - along) * corners[side] + along * corners[(side + 1) % sectors]
            return tuple((1.0 - share) * middle + share * edge)

    first, places = round(RINGS * hole), [at(0.0, 0.0)]
    for ring in range(1, RINGS + 1):
        places += [at(ring / RINGS, n / ring) for n in range(sectors * ring)]

    def number(ring: int, n: int) -> int:
        return 1 + sectors * ring * (ring - 1) // 2 + n % (sectors * ring) if ring else 0

    faces = []
    for ring in range(first + 1, RINGS + 1):
        for side in range(sectors):
            for n in range(ring):
                outer, inner = side * ring + n, side * (ring - 1) + n
                faces.append(
                    (number(ring, outer), number(ring, outer + 1), number(ring - 1, inner))
                )
                if n < ring - 1:
                    last = number(ring - 1, inner + 1)
                    faces.append((number(ring - 1, inner), number(ring, outer + 1), last))
    borders = [[number(RINGS, n) for n in range(sectors * RINGS)]]
    if first:
        borders.append([number(first, -n) for n in range(sectors * first)])
    return places, faces, borders


def as_obj(part: Any, h: float, hole: float) -> str:
    """A closed solid on a part of a base; its top is the same."""
    places, faces, borders = ringed(part, hole)
    count = len(places)
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for z in (-0.5 * h, 0.5 * h) for x, y in places]
    sides = []
    for border in borders:
        for one, two in zip(border, border[1:] + border[:1], strict=True):
            sides += [(one, two, two + count), (one, two + count, one + count)]
    base = [(a, c, b) for a, b, c in faces]
    top = [(a + count, b + count, c + count) for a, b, c in faces]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in (*base, *top, *sides)]
    return "\n".join(lines) + "\n"


def _modulus(puck: dict[str, Any]) -> float:
    """Of the floor, Pa: stiffer under a base that presses harder."""
    area = puck.get("solid", {}).get("area", float("inf"))
    return max(MODULUS, puck["mass"] * puck["gravity"] / area / SINKS)


def _floors(
    scene: dict[str, Any], friction: float, modulus: float
) -> list[tuple[str, Any, Any, Any]]:
    """A half space; or a box for each strip: thin, for so far from its sides it is softer."""
    found = []
    for low, high, f in strips_of(scene) or [(-FAR, FAR, friction)]:
        soft, pose, form = ProximityProperties(), RigidTransform(), HalfSpace()
        AddContactMaterial(
            friction=CoulombFriction(0.5 * f, 0.5 * f), dissipation=DISSIPATION, properties=soft
        )
        if strips_of(scene):
            turn = RotationMatrix.MakeZRotation(scene["floor"]["strips"]["direction"])
            pose = RigidTransform(turn, turn @ [0.5 * (low + high), 0.0, -0.5 * THIN])
            form = Box(high - low, 2.0 * FAR, THIN)
            AddCompliantHydroelasticProperties(FAR, 0.5 * THIN / DEPTH * modulus, soft)
        else:
            AddCompliantHydroelasticPropertiesForHalfSpace(DEPTH, modulus, soft)
        found.append((f"floor {len(found)}", pose, form, soft))
    return found


def _launched(scene: dict[str, Any], dt: float) -> tuple[Any, Any, Any]:
    puck = only_puck(scene)
    h, f = puck["height"], puck["friction"]
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlant(
        MultibodyPlantConfig(
            time_step=dt, contact_model="hydroelastic", discrete_contact_approximation=APPROXIMATION
        ),
        builder,
    )
    about = UnitInertia(*np.array(moments_of(puck)) / puck["mass"])
    inertia = SpatialInertia(puck["mass"], np.zeros(3), about)
    disc = plant.AddRigidBody("disc", inertia)
    hard = ProximityProperties()
    AddContactMaterial(friction=CoulombFriction(SLIPS, SLIPS), properties=hard)
    AddRigidHydroelasticProperties(hard)
    for n, part in enumerate(parts_of(puck)):
        obj = MemoryFile(as_obj(part, h, hole_of(puck)), ".obj", f"part {n}")
        mesh = Mesh(InMemoryMesh(mesh_file=obj))
        plant.RegisterCollisionGeometry(disc, RigidTransform(), mesh, f"part {n}", hard)
    ground = plant.AddRigidBody("ground", SpatialInertia(HEAVY, np.zeros(3), UnitInertia(1, 1, 1)))
    moves = any(motion_of(scene))
    if moves:
        joint = plant.AddJoint(PlanarJoint("floor", plant.world_frame(), ground.body_frame()))
    else:
        plant.WeldFrames(plant.world_frame(), ground.body_frame())
    for name, pose, form, soft in _floors(scene, f, _modulus(puck)):
        plant.RegisterCollisionGeometry(ground, pose, form, name, soft)
    gx, gy, gz = gravity(scene)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, gz])
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    launch = puck["launch"]
    x, y = launch.get("position", (0.0, 0.0))
    plant.SetFreeBodyPose(context, disc, RigidTransform([x, y, 0.5 * h - 1e-7]))
    simulator.AdvanceTo(round(SETTLE / dt) * dt)
    z = plant.EvalBodyPoseInWorld(context, disc).translation()[2]
    if gx or gy:  # gravity leans from the launch on; a force on the centre is the same
        raise_force(plant, context, disc, puck["mass"] * np.array([gx, gy, 0.0]))
    cosine, sine = turned_by(launch)
    turn = RotationMatrix.MakeZRotation(2.0 * np.arctan2(sine, cosine))
    plant.SetFreeBodyPose(context, disc, RigidTransform(turn, [x, y, z]))
    if moves:
        vx, vy, turning = motion_of(scene)
        joint.set_translation(context, [0.0, 0.0])
        joint.set_rotation(context, 0.0)
        joint.set_translational_velocity(context, [vx, vy])
        joint.set_angular_velocity(context, turning)
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
        if n:  # half a step early: the n-th is taken, and no rounding takes another
            simulator.AdvanceTo(start + (n - 0.5) * dt)
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
