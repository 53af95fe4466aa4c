"""What every adapter is given and gives back, and how a log is written."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

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
    """The puck of a scene of one, with its launch."""
    return {**scene["puck"], "launch": scene["launch"]}


def gravity(scene: dict[str, Any]) -> tuple[float, float, float]:
    """Gravity in the axes of the floor, z out of it: a slope is gravity that leans."""
    g, floor = only_puck(scene)["gravity"], scene.get("floor", {})
    slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
    flat = g * np.sin(slope)
    return float(flat * np.cos(down)), float(flat * np.sin(down)), float(-g * np.cos(slope))


def is_one_disc_on_a_plane(scene: dict[str, Any]) -> bool:
    """Whether an adapter in space can run it: one whole disc, one floor at rest, no cushion."""
    if isinstance(scene["puck"], list) or scene.get("wall"):
        return False
    floor, puck = scene.get("floor", {}), scene["puck"]
    if floor.get("strips"):
        return False
    moves = any(floor.get("velocity", (0.0, 0.0))) or floor.get("turning", 0.0)
    return not moves and puck.get("pressure", "uniform") == "uniform"
