"""A scene that is no more than a free puck: its trajectory, moved to where the scene has it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.scene.agreement import launch_velocity
from puck_tables.scene.one_run import NAME, partner_of, run_of
from puck_tables.scene.outcome import LEDGER
from puck_tables.scene.plan import Plan, free_velocity
from puck_tables.scene.run import Event, Run
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.trajectory import simulate as trajectory


def run_plain(scene: SceneSpec, needed: SceneSpec, plan: Plan, times: FloatArray | None,
    simulated: Callable[..., Run],
) -> Run:  # fmt: skip
    """Run it as a free puck in the frame of the floor; on a belt the floor's work is m b·Δv.

    ``needed``: the scene without what the puck does not reach.
    """
    free, velocity, spin = needed.puck, free_velocity(needed), needed.launch.spin
    free_run = trajectory(
        free, velocity, spin, frames=1, times=None, tol=scene.tol, method=None, exact=False,
        table=None,
    )  # fmt: skip
    length = free_run.stop_time
    limit = scene.time
    moves = any(scene.floor.velocity)
    stops = limit is None or length <= limit
    end_time = length if limit is None or (stops and not moves) else limit
    moments = np.linspace(0.0, end_time, int(scene.frames)) if times is None else times
    if moves or not stops:
        moments = moments[moments <= end_time]
    run = free_run(np.append(moments, end_time))
    belt = scene.floor.velocity
    rests = run.time >= length
    vx = np.where(rests, 0.0, run.speed * np.cos(run.heading)) + belt[0]
    vy = np.where(rests, 0.0, run.speed * np.sin(run.heading)) + belt[1]
    start = launch_velocity(scene)
    mass = scene.puck.mass
    inertia = mass * (scene.puck.gyration * scene.puck.radius) ** 2
    energy = 0.5 * mass * (start[0] * start[0] + start[1] * start[1]) + 0.5 * inertia * spin * spin
    if not max(energy, spin * spin, float(run.speed[0]) ** 2) < math.inf:
        raise InputError(
            f"launch.velocity = {list(start)} and launch.spin = {spin:g} are too large for "
            "floating point: use other units"
        )
    kept = 0.5 * mass * run.speed**2 + 0.5 * inertia * run.spin**2
    zero = np.zeros_like(run.time)
    whole = {
        "time": run.time,
        "x": scene.launch.position[0] + run.x + belt[0] * run.time,
        "y": scene.launch.position[1] + run.y + belt[1] * run.time,
        "orientation": scene.launch.orientation + run.orientation,
        "vx": vx,
        "vy": vy,
        "spin": run.spin,
        "work_given": zero,
        "heat_dry": run.kinetic_energy - kept,
        "heat_viscous": zero,
        "work_support": mass * (belt[0] * (vx - start[0]) + belt[1] * (vy - start[1])),
        "lambda_1": zero,
        "lambda_2": zero,
        "carried": np.where(rests, 1.0, 0.0),
        "heat_impact": zero,
        "kinetic_energy": 0.5 * mass * (vx * vx + vy * vy) + 0.5 * inertia * run.spin**2,
    }
    assert tuple(whole) == LEDGER
    stop_place = (
        scene.launch.position[0] + run.stop_position[0] + belt[0] * length,
        scene.launch.position[1] + run.stop_position[1] + belt[1] * length,
    )
    exact = {
        "energy_residual": run.energy_residual, "error_estimate": run.error_estimate,
        "speed_scale": math.hypot(*velocity, scene.puck.radius * spin), "rate_scale": free.decel,
        "steps": run.steps, "simulated": simulated,
    }  # fmt: skip
    end = "time is up" if not stops else ("carried by the floor" if moves else "at rest")
    stick = Event(length, "stick", NAME, partner_of("stick", 0, scene), *stop_place)
    events = [stick] if stops else []
    return run_of(scene, plan, end, float(end_time), events, whole, energy, exact)
