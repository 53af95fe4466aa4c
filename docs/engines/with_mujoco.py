"""MuJoCo: a cylinder on a plane, elliptic cones, Newton's solver to rest, implicitfast."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
from task import SETTLE, SPACE, Played, gravity, is_one_disc_on_a_plane, only_puck, timed

SETTINGS = (
    "cylinder on plane, condim 3, elliptic cone, impratio 10, Newton 100 iterations to 1e-12, "
    "implicitfast, solref 0.01 1"
)
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
can = is_one_disc_on_a_plane


def _feet(radius: float, half: float, count: int) -> str:
    """Small spheres that share the base evenly, in place of a cylinder."""
    golden, small = math.pi * (3.0 - math.sqrt(5.0)), 0.02 * radius
    places = ((radius * math.sqrt((n + 0.5) / count), golden * n) for n in range(count))
    return "".join(
        f'<geom type="sphere" size="{small}" pos="{rho * math.cos(a)} {rho * math.sin(a)} '
        f'{small - half}"/>'
        for rho, a in places
    )


def _model(scene: dict[str, Any], dt: float, feet: int) -> Any:
    puck = only_puck(scene)
    r, m, h = puck["radius"], puck["mass"], puck["height"]
    flat = m * (r * r / 4.0 + h * h / 12.0)
    body = f'<geom type="cylinder" size="{r} {0.5 * h}"/>'
    if feet:
        body = _feet(r, 0.5 * h, feet)
    gx, gy, gz = gravity(scene)
    half, f = 0.5 * puck["height"], puck["friction"]
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{dt}" gravity="{gx} {gy} {gz}" cone="elliptic" impratio="10" solver="Newton"
    iterations="100" tolerance="1e-12" integrator="implicitfast"/>
  <default>
    <geom friction="{f} 0 0" condim="3" solref="0.01 1" contype="1" conaffinity="2"/>
  </default>
  <worldbody>
    <geom type="plane" size="10 10 1" contype="2" conaffinity="1"/>
    <body pos="0 0 {half}">
      <freejoint/>
      <inertial pos="0 0 0" mass="{m}" diaginertia="{flat} {flat} {0.5 * m * r * r}"/>
      {body}
    </body>
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
    data.qpos[:2], data.qpos[3:] = 0.0, (1.0, 0.0, 0.0, 0.0)
    data.qvel[:] = [*launch["velocity"], 0.0, 0.0, 0.0, launch["spin"]]
    return model, data


def run(scene: dict[str, Any], dt: float, until: float, feet: int = 0) -> Played:
    model, data = _launched(scene, dt, feet)
    count = round(until / dt)
    rows = np.empty((count + 1, 14))
    for n in range(count + 1):
        if n:
            mujoco.mj_step(model, data)
        turn = np.empty(9)  # spins of a free joint are in the axes of the body
        mujoco.mju_quat2Mat(turn, data.qpos[3:])
        rows[n] = [data.time, *data.qpos, *data.qvel[:3], *(turn.reshape(3, 3) @ data.qvel[3:])]
    model, data = _launched(scene, dt, feet)
    return Played(rows, SPACE, timed(lambda: mujoco.mj_step(model, data, count)))
