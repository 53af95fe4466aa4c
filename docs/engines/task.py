"""What every adapter is given and gives back, and how a log is written."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

FAR = 2.0  # m: no puck of a case comes so far
HEAVY = 1e3  # kg: a floor that moves, and that a puck slows by 1e-4 at most
SETTLE = 0.2  # s, for a disc to sink into a soft floor before it is launched
FLAT = "t [s],x [m],y [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]"
SPACE = (
    "t [s],x [m],y [m],z [m],qw,qx,qy,qz,vx [m/s],vy [m/s],vz [m/s],wx [rad/s],wy [rad/s],"
    "wz [rad/s]"
)


@dataclass
class Played:
    """The log of a run, a row a step from the launch on, its header, seconds for the steps."""

    rows: np.ndarray
    header: str
    seconds: float

    def write(self, path: Path) -> None:
        np.savetxt(path, self.rows, "%.12g", ",", header=self.header, comments="")


def timed(steps: Callable[[], None]) -> float:
    """Seconds of the processor for some steps: other programs may run beside."""
    begin = time.process_time()
    steps()
    return time.process_time() - begin


def only_puck(scene: dict[str, Any]) -> dict[str, Any]:
    """The puck of a scene of one, with its launch; in space a disc has at least some height."""
    height = max(scene["puck"]["height"], 1e-3)
    return {**scene["puck"], "height": height, "launch": scene["launch"]}


def moments_of(puck: dict[str, Any]) -> tuple[float, float]:
    """Moments of inertia about a diameter and about the axis, kg m²."""
    upright = puck["mass"] * (puck["gyration"] * puck["radius"]) ** 2
    return 0.5 * upright + puck["mass"] * puck["height"] ** 2 / 12.0, upright


def hole_of(puck: dict[str, Any]) -> float:
    """The inner radius of an annulus over the outer; 0 of a disc."""
    return float(puck.get("pressure", "uniform").partition(":")[2] or 0.0)


def motion_of(scene: dict[str, Any]) -> tuple[float, float, float]:
    """Velocity of a belt, spin of a turntable about the origin."""
    floor = scene.get("floor", {})
    return (*floor.get("velocity", (0.0, 0.0)), floor.get("turning", 0.0))


def strips_of(scene: dict[str, Any]) -> list[tuple[float, float, float]]:
    """Where each strip of a floor begins and ends along its direction, and its friction."""
    strips = scene.get("floor", {}).get("strips")
    if not strips:
        return []
    ends = [-FAR, *strips["borders"], FAR]
    return list(zip(ends[:-1], ends[1:], strips["friction"], strict=True))


def friction_under(scene: dict[str, Any], puck: dict[str, Any], x: float, y: float) -> float:
    """The friction of the strip on which a point lies."""
    direction = scene["floor"]["strips"]["direction"] if strips_of(scene) else 0.0
    along = x * np.cos(direction) + y * np.sin(direction)
    return next((f for low, high, f in strips_of(scene) if low <= along < high), puck["friction"])


def joint_limits(scene: dict[str, Any], puck: dict[str, Any], at: Any) -> tuple[float, float]:
    """Force and torque of friction, each by itself: f m g, and f m g times the mean arm."""
    slope, a = scene.get("floor", {}).get("slope", 0.0), hole_of(puck)
    load = friction_under(scene, puck, *at) * puck["mass"] * puck["gravity"] * np.cos(slope)
    arm = 2.0 / 3.0 * puck["radius"] * (1.0 - a**3) / (1.0 - a**2)
    return float(load), float(load * arm)


def gravity(scene: dict[str, Any]) -> tuple[float, float, float]:
    """Gravity in the axes of the floor, z out of it: a slope is gravity that leans."""
    g, floor = only_puck(scene)["gravity"], scene.get("floor", {})
    slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
    flat = g * np.sin(slope)
    return float(flat * np.cos(down)), float(flat * np.sin(down)), float(-g * np.cos(slope))


def has_one_puck_and_no_cushion(scene: dict[str, Any]) -> bool:
    """What the adapters in space can run."""
    return not (isinstance(scene["puck"], list) or scene.get("wall"))
