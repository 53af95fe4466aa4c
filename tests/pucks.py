"""Questions about one puck with its numbers among the arguments, as most tests put them."""

from __future__ import annotations

from typing import Any

import numpy as np

from puck_tables import Puck
from puck_tables.stopping.aim_at_targets import Aim
from puck_tables.stopping.population import StopMap
from puck_tables.trajectory import Trajectory

KIND = ("delta", "decel", "radius", "mass", "pressure", "gyration")


def parted(options: dict[str, Any]) -> tuple[Puck, dict[str, Any]]:
    """The puck of these options, and what is left of them."""
    kind = {name: options[name] for name in KIND if name in options}
    return Puck.similar(**kind), {k: v for k, v in options.items() if k not in kind}


def simulate(velocity: Any, spin: Any = 0.0, **options: Any) -> Trajectory:
    puck, rest = parted(options)
    return puck.simulate(velocity, spin, **rest)


def sweep(spin: Any = None, speed: Any = None, **options: Any) -> StopMap:
    ranged = {}
    if np.ndim(options.get("delta", 0.0)) > 0:
        ranged["delta"] = options.pop("delta")
        options = {**options, "delta": float(np.min(ranged["delta"], initial=0.5))}
    puck, rest = parted(options)
    return puck.sweep(spin, speed, **rest, **ranged)


def aim(target: Any, **options: Any) -> Aim:
    puck, rest = parted(options)
    return puck.aim(target, **rest)
