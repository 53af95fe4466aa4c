"""What a scene run gives: states, reactions, events and an energy ledger."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.scene.plan import Plan
from puck_tables.scene.scene import Scene

FloatArray = npt.NDArray[np.float64]

ENDS = (
    "at rest", "carried by the floor", "time is up", "over the edge", "step limit", "event limit",
    "not finite", "no end found", "refused",
)  # fmt: skip
NO_END, REFUSED = len(ENDS) - 2, len(ENDS) - 1  # of a run in a sweep, which goes on
EVENTS = ("rests", "slips", "bounces", "leans", "border", "edge")

COLUMNS = {
    "time": ("s", "time since the launch"),
    "x": ("m", "place of the centre along x"),
    "y": ("m", "place of the centre along y"),
    "orientation": ("rad", "angle of the body, counter-clockwise"),
    "vx": ("m/s", "velocity of the centre along x"),
    "vy": ("m/s", "velocity of the centre along y"),
    "spin": ("rad/s", "angular velocity, counter-clockwise"),
    "work_given": ("J", "work of gravity and of given forces"),
    "heat_dry": ("J", "heat of dry friction"),
    "heat_viscous": ("J", "heat of viscous friction, 2 f2"),
    "work_support": ("J", "work of moving floor and constraints, -f1"),
    "lambda_1": ("N", "reaction of the constraint: across rail or blade, along x for a pivot"),
    "lambda_2": ("N", "reaction of the pivot along y"),
    "carried": ("1", "1: at rest on the floor, which then shares the reaction"),
    "heat_impact": ("J", "energy lost in impacts"),
    "kinetic_energy": ("J", "of the centre and of the spin"),
}


class Event(NamedTuple):
    """What happened on the way: when (s), what, which wall, edge or region, where (m)."""

    time: float
    what: str
    which: int
    x: float
    y: float


@dataclass(frozen=True)
class SceneRun:
    """What happened.

    ``end``: 'at rest', 'carried by the floor' (at rest on a moving one), 'time is up' or 'over the
    edge'; ``end_time`` s; ``events``: what happened, one of rests, slips, bounces, leans (stays at
    the wall), border, edge.
    ``plan``: the model that was taken, and why.  ``energy_residual``: what the ledger misses, as a
    share of its largest entry.  ``error_estimate``: of the end time in
    units of Q/J and of places in Q²/J, with ``speed_scale`` = Q in m/s and ``rate_scale`` = J in
    m/s² (the slip at the launch, and the largest of friction, forces and what a turning floor asks
    over the mass; without slip Q² = J r).  It is above ``run.tol`` where the motion amplifies
    errors so much that tol cannot be kept.
    ``columns``: arrays (n,) by name, units in :data:`COLUMNS`;
    ``last``: the same at the end, numbers.  ``files``: what stood in the files that the scene
    names, by the path of the entry.
    """

    scene: Scene
    plan: Plan
    end: str
    end_time: float
    events: list[Event]
    energy_residual: float
    error_estimate: float
    speed_scale: float
    rate_scale: float
    steps: int
    last: Mapping[str, float]
    columns: Mapping[str, FloatArray] = field(repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)


def ledger(
    columns: Mapping[str, FloatArray], start: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """What is missing in the energy ledger, and its largest entry, J, for every element.

    ``start``: the kinetic energy at the launch, J.

    Examples
    --------
    >>> names = ("work_given", "work_support", "heat_viscous", "heat_impact")
    >>> entries = {name: np.zeros(1) for name in names}
    >>> entries |= {"kinetic_energy": np.ones(1), "heat_dry": np.ones(1) + 1.0}
    >>> ledger(entries, 4.0)
    (array([1.]), array([4.]))
    """
    gains = [columns[name] for name in ("work_given", "work_support")]
    names = ("kinetic_energy", "heat_dry", "heat_viscous", "heat_impact")
    losses = [columns[name] for name in names]
    missing = np.abs(np.asarray(start) + sum(gains) - sum(losses))
    entries = np.broadcast_arrays(np.asarray(start), *gains, *losses)
    return missing, np.max(np.abs(entries), axis=0)


def ledger_residual(columns: Mapping[str, FloatArray], start: float) -> float:
    """The largest miss of a run as a share of the largest entry of its ledger.

    Examples
    --------
    >>> names = ("work_given", "work_support", "heat_viscous", "heat_impact", "heat_dry")
    >>> ledger_residual({"kinetic_energy": np.ones(2), **{n: np.zeros(2) for n in names}}, 1.0)
    0.0
    """
    missing, largest = ledger(columns, start)
    return float(missing.max()) / float(largest.max()) if largest.max() > 0.0 else 0.0
