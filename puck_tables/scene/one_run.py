"""The run of a scene of one puck, from what its engine leaves: columns and rows of events."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.friction import SPIN, VX, X, Y
from puck_tables.scene.outcome import EVENTS
from puck_tables.scene.plan import Plan
from puck_tables.scene.records import BEFORE
from puck_tables.scene.run import Event, Run, residual
from puck_tables.scene.scene_spec import SceneSpec

NAME = "puck 0"
_MEETS = {"impact": "wall", "contact": "wall", "edge": "edge", "overhang": "edge"}


def run_of(
    scene: SceneSpec, plan: Plan, end: str, end_time: float, events: list[Event],
    whole: Mapping[str, FloatArray], given: float, more: dict[str, Any],
) -> Run:  # fmt: skip
    """The run; ``whole``: columns over time, the last row the end; ``given``: by the launch, J.

    ``more``: how exact it is, and who simulates it again.
    """
    zero = np.zeros_like(whole["time"])
    in_play = zero + 1.0
    in_play[-1] = 0.0 if end == "over the edge" else 1.0
    bound = scene.constraint is not None
    columns = {
        name: row for name, row in whole.items() if bound or not name.startswith("lambda")
    }  # fmt: skip
    columns |= {
        "in_play": in_play, "energy_given": zero + given, "energy_gone": zero, "work_driven": zero,
        "heat_rims": zero,
    }  # fmt: skip
    more["energy_residual"] = max(more.get("energy_residual", 0.0), residual(columns))
    last = {name: float(column[-1]) for name, column in columns.items()}
    rests = [event.time for event in events if event.what == "stick"]
    stop_time = end_time if end == "over the edge" else math.inf
    if last["carried"] and rests:
        stop_time = rests[-1]
    return Run(
        scene=scene, model=plan.model, why=plan.why, end=end, end_time=end_time, names=(NAME,),
        events=events, stop_times=np.array([stop_time]), last=last,
        columns={name: column[:-1] for name, column in columns.items()}, **more,
    )  # fmt: skip


def events_of(rows: FloatArray, scene: SceneSpec) -> list[Event]:
    """Rows of the engine (n, 16) as events, in their order in time."""
    found = [_event(row, scene) for row in rows]
    return sorted(found, key=lambda event: event.time)  # a rim may come over two edges on one step


def _event(row: FloatArray, scene: SceneSpec) -> Event:
    what, which = EVENTS[int(row[1])], int(row[2])
    state = row[3:]
    place = float(state[X]), float(state[Y])
    event = Event(float(row[0]), what, NAME, partner_of(what, which, scene), *place)
    if what not in ("impact", "contact"):
        return event
    puck, wall = scene.puck, scene.walls[which]
    size = math.hypot(*wall.normal)
    towards = -np.array(wall.normal) / size
    left = np.array([-towards[1], towards[0]])
    before, after = row[BEFORE : BEFORE + 3], state[[VX, VX + 1, SPIN]]
    got = -puck.mass * (after - before)[:2]
    inertia = puck.mass * (puck.gyration * puck.radius) ** 2
    weights = np.array([puck.mass, puck.mass, inertia])
    return event._replace(
        x=place[0] + puck.radius * float(towards[0]), y=place[1] + puck.radius * float(towards[1]),
        approach=float(before[:2] @ towards),
        slip=float(before[:2] @ left + puck.radius * before[2]),
        impulse=float(got @ towards), rub=float(got @ left),
        lost=float(0.5 * weights @ (before**2 - after**2)),
    )  # fmt: skip


def partner_of(what: str, which: int, scene: SceneSpec) -> str:
    """What a puck meets at an event, by its number in the engine."""
    strips = scene.floor.strips
    if what in ("entry", "exit"):
        borders = 0 if strips is None else len(strips.borders)
        return f"border {which}" if which < borders else f"patch {which - borders}"
    if what in _MEETS:
        return f"{_MEETS[what]} {which}"
    return "floor" if strips is None else f"strip {which}"
