"""A world with one puck more: the same arrays, longer by a disc that is not yet in play."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.scene.floor_map import OVER_X, OVER_Y
from puck_tables.scene.friction import VX
from puck_tables.scene.over_time import drive_of, over_time
from puck_tables.scene.parts import Force, Launch
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import layout
from puck_tables.world.by_hand import with_integrated
from puck_tables.world.engine_state import (
    LAUNCH_I,
    N_HISTORY,
    N_LAUNCHES,
    N_PIECES,
    Engine,
    Whole,
)
from puck_tables.world.floor_under import law_goes_to
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.paths import BEGINS
from puck_tables.world.prepare import Start, prepared, with_law_up_to
from puck_tables.world.segment import ANGLE, GONE, PLACE_X, SEGMENT_COLUMNS, START, UNTIL


def board_with(scene: SceneSpec, puck: ScenePuck) -> SceneSpec:
    """A scene with a puck more, which fits its board; its pucks may have moved since.

    Raises InputError if the puck does not go with the board, or its name is taken.
    """
    if not isinstance(puck, ScenePuck):
        raise InputError(f"puck must be a Puck, got a {type(puck).__name__}")
    there = pucks_of(scene)
    bare: dict[str, Any] = {"puck": None, "launch": Launch(), "force": Force(), "constraint": None}
    alone = replace(scene, **bare, pucks=(puck,), rims=()).single()
    own = alone.pucks[0]
    if own.name and own.name in {one.name for one in there}:
        raise InputError(f"puck.name = {own.name!r}: there is one of that name")
    if own.gravity != there[0].gravity:
        raise InputError(
            f"puck.gravity = {own.gravity:g}: the pucks of this world have {there[0].gravity:g}"
        )
    if own.constraint is not None and any(own.constraint.velocity):
        raise InputError(
            f"puck.constraint: a {own.constraint.kind} that moves must be there from the start"
        )
    board = object.__new__(type(scene))
    parts = {name: part for name, part in vars(scene).items() if name != "_pucks"}
    parts |= {name: getattr(alone, name) for name in bare}
    vars(board).update(parts | {"pucks": (*there, own)})
    return board


def with_puck(
    engine: Engine, board: SceneSpec, order: Whole, now: float
) -> tuple[Start, FloatArray]:
    """The world of a board with a puck more, the last, which is out of play; and its state (6,)."""
    count = len(order)
    order = np.append(order, count)
    fresh = prepared(board, order)
    new, state = fresh.engine, fresh.states[count]
    top = law_goes_to(engine.regions)
    if law_goes_to(new.regions) < top < math.inf:
        new = with_law_up_to(new, board, order, top)
    discs = new.discs.copy()
    own = [layout.RESTITUTION, layout.MAKE]  # which law is called how may be another
    mine = discs[:count, own]
    discs[:count] = engine.discs
    discs[:count, own] = mine
    strips = engine.discs[:, layout.REGION] // count
    discs[:count, layout.REGION] = strips * (count + 1) + np.arange(count)
    _keep_belts(engine, new, count)
    forcing = engine.forcing
    if not board.pucks[-1].path:
        forcing = np.vstack([forcing, _rows_from(board, now)])
    spans = np.vstack([engine.spans, [[len(engine.forcing), len(forcing)]]])
    used, motion = int(engine.counts[N_PIECES]), new.pieces[slice(*new.drives[count])].copy()
    motion[:, BEGINS] += now
    pieces = np.vstack([engine.pieces[:used], motion, np.zeros((max(used, 128), motion.shape[1]))])
    launch = new.launches[new.launches[:, LAUNCH_I] == count] + np.array([now, 0, 0, 0, 0])
    done = int(engine.counts[N_LAUNCHES])
    later = np.vstack([engine.launches[done:], launch])
    later = later[np.argsort(later[:, 0], kind="stable")]
    segment = np.zeros(SEGMENT_COLUMNS)
    segment[PLACE_X : ANGLE + 1], segment[UNTIL], segment[START] = state[:3], math.inf, 0.0
    longer: dict[str, Any] = {
        "kinds": np.append(engine.kinds, GONE),
        "segments": np.vstack([engine.segments, segment]),
        "group": np.append(engine.group, 0),
        "held": np.vstack([engine.held, np.zeros((6, 2), np.int64)]),
        "next_time": np.append(engine.next_time, math.inf),
        "next_partner": np.append(engine.next_partner, new.next_partner[count]),
        "launches": np.vstack([engine.launches[:done], later]),
        "drives": np.vstack([engine.drives, [[used, used + len(motion)]]]),
        "hangs": np.vstack([engine.hangs, np.zeros_like(new.hangs[:1])]),
        "history": np.vstack([engine.history, np.zeros_like(engine.history[:1])]),
        "counts": engine.counts.copy(),
        "scale": np.append(
            np.maximum(engine.scale, new.scale)[:2], [new.scale[2], *engine.scale[3:]]
        ),
    }
    before = np.concatenate([[count, GONE], segment])  # until now it was not there
    longer["history"][engine.counts[N_HISTORY]] = before
    longer["counts"][N_HISTORY] += 1
    longer["counts"][N_PIECES] += len(motion)
    whole = engine._replace(
        discs=discs, regions=new.regions, floors=new.floors, rims=new.rims,
        obstacles=new.obstacles, forcing=forcing, spans=spans, pieces=pieces, **longer,
    )  # fmt: skip
    integrated = engine.floors[:, 2].reshape(-1, count).any(axis=0)
    whole = with_integrated(whole, board, order, np.flatnonzero(integrated))
    if len(motion):
        state[VX:] = 0.0  # it goes on as its way has it
    return Start(board, order, whole, fresh.states), state


def _keep_belts(engine: Engine, new: Engine, count: int) -> None:
    """The velocities of the floor that states of the discs there are relative to stay."""
    if engine.regions.floor_map.size:  # else no base there was on one
        before = engine.regions.floor_map.reshape(count, -1)
        after = new.regions.floor_map.reshape(count + 1, -1)
        after[:count, [OVER_X, OVER_Y]] = before[:, [OVER_X, OVER_Y]]


def _rows_from(board: SceneSpec, now: float) -> FloatArray:
    """What changes over time under the last puck, whose force counts from now."""
    own = board.pucks[-1]
    force = own.force
    if force.over_time:
        drive = drive_of(force.over_time) + np.array([now, 0.0, 0.0, 0.0])
        force = replace(force, over_time=tuple(map(tuple, drive.tolist())))
    return over_time(board.floor, force)
