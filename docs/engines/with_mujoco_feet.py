"""MuJoCo again, the base as 61 small feet: a cylinder touches a plane at its rim alone."""

from __future__ import annotations

from typing import Any

import with_mujoco
from task import Played
from with_mujoco import STEPS as STEPS
from with_mujoco import can as can

FEET = 61
SETTINGS = with_mujoco.SETTINGS.replace(
    "cylinder, box or mesh of a prism", f"{FEET} spheres that share the base"
)


def run(scene: dict[str, Any], dt: float, until: float) -> Played:
    return with_mujoco.run(scene, dt, until, FEET)
