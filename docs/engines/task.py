"""What every adapter is given and gives back, and how a log is written.

Of a puck on a base that is not round run_all.py says the ``solid``: ``parts`` of the base, convex
polygons [[x, y], ...] and discs [x, y, r], m from the centre of mass; ``points`` spread evenly over
it; ``area``, ``reach``, ``gyration`` and mean ``arm`` of friction; ``square``: the mean of x², y².
"""

from __future__ import annotations

import math
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
    """The puck of a scene of one, with its launch; in space a puck has at least some height."""
    height = max(scene["puck"]["height"], 1e-3)
    return {**scene["puck"], "height": height, "launch": scene["launch"]}


def moments_of(puck: dict[str, Any]) -> tuple[float, float, float]:
    """Moments of inertia about two level axes of the puck and about the vertical, kg m²."""
    m, solid = puck["mass"], puck.get("solid")
    upright = m * (solid["gyration"] if solid else puck["gyration"] * puck["radius"]) ** 2
    x2, y2 = solid["square"] if solid else (0.5 * upright / m,) * 2
    tall = puck["height"] ** 2 / 12.0
    return m * (y2 + tall), m * (x2 + tall), upright


def parts_of(puck: dict[str, Any]) -> list[Any]:
    """Convex polygons and discs that the base is made of; of a disc itself."""
    return puck["solid"]["parts"] if "solid" in puck else [[0.0, 0.0, puck["radius"]]]


def box_of(part: Any) -> tuple[float, float, float, float] | None:
    """Middle and half lengths of a part that is a rectangle along the axes; None: it is not."""
    if isinstance(part[0], float) or len(part) != 4:
        return None
    (x0, y0), (x1, y1) = np.min(part, axis=0).tolist(), np.max(part, axis=0).tolist()
    if {(x0, y0), (x1, y0), (x1, y1), (x0, y1)} != {tuple(corner) for corner in part}:
        return None
    return 0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (x1 - x0), 0.5 * (y1 - y0)


def points_of(puck: dict[str, Any], count: int) -> list[tuple[float, float]]:
    """So many places spread evenly over the base."""
    if "solid" in puck:
        return puck["solid"]["points"][:count]
    golden, radius, hole = math.pi * (3.0 - math.sqrt(5.0)), puck["radius"], hole_of(puck)
    arms = (radius * math.sqrt(hole**2 + (1.0 - hole**2) * (n + 0.5) / count) for n in range(count))
    return [(r * math.cos(golden * n), r * math.sin(golden * n)) for n, r in enumerate(arms)]


def reach_of(puck: dict[str, Any]) -> float:
    """How far the base extends from the centre of mass, m."""
    return puck["solid"]["reach"] if "solid" in puck else puck["radius"]


def turned_by(launch: dict[str, Any]) -> tuple[float, float]:
    """Cosine and sine of half the angle by which a puck is turned at the launch."""
    half = 0.5 * launch.get("orientation", 0.0)
    return math.cos(half), math.sin(half)


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
    slope = scene.get("floor", {}).get("slope", 0.0)
    load = friction_under(scene, puck, *at) * puck["mass"] * puck["gravity"] * np.cos(slope)
    if "solid" in puck:
        return float(load), float(load * puck["solid"]["arm"])
    a = hole_of(puck)
    arm = 2.0 / 3.0 * puck["radius"] * (1.0 - a**3) / (1.0 - a**2)
    return float(load), float(load * arm)


def gravity(scene: dict[str, Any]) -> tuple[float, float, float]:
    """Gravity in the axes of the floor, z out of it: a slope is gravity that leans."""
    g, floor = only_puck(scene)["gravity"], scene.get("floor", {})
    slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
    flat = g * np.sin(slope)
    return float(flat * np.cos(down)), float(flat * np.sin(down)), float(-g * np.cos(slope))


def is_steady(scene: dict[str, Any]) -> bool:
    """Whether no strip of the floor has a velocity of its own, and nothing changes over time."""
    changes = any(scene.get(part, {}).get("over_time") for part in ("floor", "force"))
    return not changes and "across" not in (scene.get("floor", {}).get("strips") or {})


def has_one_puck_and_no_cushion(scene: dict[str, Any]) -> bool:
    """What the adapters in space can run."""
    return not (isinstance(scene["puck"], list) or scene.get("wall")) and is_steady(scene)
