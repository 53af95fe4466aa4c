"""MuJoCo: a cylinder on a plane, elliptic cones, Newton's solver to rest, implicitfast."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
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
    points_of,
    reach_of,
    strips_of,
    timed,
    turned_by,
)

SETTINGS = (
    "cylinder, box or mesh of a prism on a plane (on boxes where strips differ or the floor "
    "moves), condim 3, elliptic cone, impratio 10, Newton 100 iterations to 1e-12, "
    "implicitfast, solref 0.01 1"
)
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
can = has_one_puck_and_no_cushion


def _feet(puck: dict[str, Any], count: int) -> str:
    """Small spheres that share the base evenly, in place of a solid."""
    small = 0.02 * reach_of(puck)
    low = small - 0.5 * puck["height"]
    return "".join(
        f'<geom type="sphere" size="{small}" pos="{x} {y} {low}"/>'
        for x, y in points_of(puck, count)
    )


def _solid(puck: dict[str, Any]) -> tuple[str, str]:
    """Cylinders, boxes and other prisms on the base, and the meshes of these."""
    half, geoms, meshes = 0.5 * puck["height"], [], []
    for n, part in enumerate(parts_of(puck)):
        if isinstance(part[0], float):
            x, y, r = part
            geoms.append(f'<geom type="cylinder" size="{r} {half}" pos="{x} {y} 0"/>')
        elif (box := box_of(part)) is not None:
            x, y, a, b = box
            geoms.append(f'<geom type="box" size="{a} {b} {half}" pos="{x} {y} 0"/>')
        else:
            places = " ".join(f"{x} {y} {z}" for z in (-half, half) for x, y in part)
            meshes.append(f'<mesh name="part{n}" vertex="{places}"/>')
            geoms.append(f'<geom type="mesh" mesh="part{n}"/>')
    return "".join(geoms), "".join(meshes)


def _floor(scene: dict[str, Any], friction: float) -> str:
    """A plane; a box for each strip; a heavy box on joints where the floor moves."""
    looks = 'contype="2" conaffinity="1" friction="{} 0 0"'
    if any(motion_of(scene)):
        joints = [("slide", "1 0 0"), ("slide", "0 1 0"), ("hinge", "0 0 1")]
        return (
            "<body>"
            + "".join(f'<joint type="{kind}" axis="{axis}"/>' for kind, axis in joints)
            + f'<geom type="box" size="{FAR} {FAR} {FAR}" pos="0 0 {-FAR}" mass="{HEAVY}" '
            f"{looks.format(friction)}/></body>"
        )
    direction = scene["floor"]["strips"]["direction"] if strips_of(scene) else 0.0
    c, s = math.cos(direction), math.sin(direction)
    boxes = [
        f'<geom type="box" size="{0.5 * (high - low)} {FAR} {FAR}" {looks.format(f)} pos='
        f'"{0.5 * (low + high) * c} {0.5 * (low + high) * s} {-FAR}" euler="0 0 {direction}"/>'
        for low, high, f in strips_of(scene)
    ]
    return "".join(boxes) or f'<geom type="plane" size="10 10 1" {looks.format(friction)}/>'


def _model(scene: dict[str, Any], dt: float, feet: int) -> Any:
    puck = only_puck(scene)
    x, y = puck["launch"].get("position", (0.0, 0.0))
    half = 0.5 * puck["height"]
    inertia = " ".join(map(str, moments_of(puck)))
    body, meshes = (_feet(puck, feet), "") if feet else _solid(puck)
    gx, gy, gz = gravity(scene)
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian"/>
  <option timestep="{dt}" gravity="{gx} {gy} {gz}" cone="elliptic" impratio="10" solver="Newton"
    iterations="100" tolerance="1e-12" integrator="implicitfast"/>
  <default>
    <geom friction="0 0 0" condim="3" solref="0.01 1" contype="1" conaffinity="2"/>
  </default>
  <asset>{meshes}</asset>
  <worldbody>
    <body pos="{x} {y} {half}">
      <freejoint/>
      <inertial pos="0 0 0" mass="{puck["mass"]}" diaginertia="{inertia}"/>
      {body}
    </body>
    {_floor(scene, puck["friction"])}
  </worldbody>
</mujoco>""")


def _launched(scene: dict[str, Any], dt: float, feet: int) -> tuple[Any, Any]:
    model = _model(scene, dt, feet)
    data, launch = mujoco.MjData(model), only_puck(scene)["launch"]
    leaning = model.opt.gravity.copy()
    model.opt.gravity[:2] = 0.0
    mujoco.mj_step(model, data, round(SETTLE / dt))
    model.opt.gravity[:] = leaning
    data.time = 0.0
    cosine, sine = turned_by(launch)
    data.qpos[:2], data.qpos[3:7] = launch.get("position", (0.0, 0.0)), (cosine, 0.0, 0.0, sine)
    data.qvel[:6] = [*launch["velocity"], 0.0, 0.0, 0.0, launch["spin"]]
    if any(motion_of(scene)):
        data.qpos[7:], data.qvel[6:] = 0.0, motion_of(scene)
    return model, data


def run(scene: dict[str, Any], dt: float, until: float, feet: int = 0) -> Played:
    model, data = _launched(scene, dt, feet)
    count = round(until / dt)
    rows = np.empty((count + 1, 14))
    for n in range(count + 1):
        if n:
            mujoco.mj_step(model, data)
        turn = np.empty(9)  # spins of a free joint are in the axes of the body
        mujoco.mju_quat2Mat(turn, data.qpos[3:7])
        spin = turn.reshape(3, 3) @ data.qvel[3:6]
        rows[n] = [data.time, *data.qpos[:7], *data.qvel[:3], *spin]
    model, data = _launched(scene, dt, feet)
    return Played(rows, SPACE, timed(lambda: mujoco.mj_step(model, data, count)))
