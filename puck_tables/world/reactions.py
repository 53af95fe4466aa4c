"""With what force constraints lead their discs, at moments of the past."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.scene.equations import (
    FIRST,
    GIVEN,
    LAMBDA,
    ROW,
    SIZE,
    rates,
    slip_speed,
    to_laboratory,
)
from puck_tables.scene.friction import X, Y
from puck_tables.scene.ingredients import FREE, NO_WAY, SLIDES, Phase
from puck_tables.scene.over_time import rows_passed
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import friction_under_disc, lie_at
from puck_tables.world.lasting import at_rest_below
from puck_tables.world.layout import HOLD, KIND, NO_CUSHION, RADIUS
from puck_tables.world.lone import model_of
from puck_tables.world.obstacle_shapes import normal_to

_NEAR = 1e-9  # of the radius: what is as near may press


def reactions(
    engine: Engine, times: FloatArray, states: FloatArray, in_play: FloatArray
) -> FloatArray:
    """The multipliers λ of every disc (times, discs, 2), N, at states (times, discs, 6).

    ``in_play`` (times, discs): 0 of those that have left.

    0 of what is free, and of what rests: there the floor shares the force, and nobody knows how.
    NaN where a disc touches another or a cushion, which may press it too.
    """
    regions = engine.regions._replace(floor_map=engine.regions.floor_map.copy())
    own = engine._replace(discs=engine.discs.copy(), regions=regions)
    out = np.zeros((len(times), len(engine.discs), 2))
    _fill(own, times, in_play, states, np.empty(SIZE), np.empty((1, ROW)), out)
    return out


@kernel
def _fill(
    engine: Engine, times: FloatArray, in_play: FloatArray, states: FloatArray,
    y: FloatArray, work: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    for i in range(engine.discs.shape[0]):
        if int(engine.discs[i, HOLD]) == FREE:
            continue
        model, drive = model_of(engine, i), engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
        for n in range(times.size):
            patience(1)
            for k in range(SIZE):
                y[k] = states[n, i, k] if k < GIVEN else 0.0
            lie_at(engine, i, y[X], y[Y])
            to_laboratory(model.surface, y, -1.0)
            slips = slip_speed(engine.discs[i, RADIUS], y) > at_rest_below(engine)
            if in_play[n, i] == 0.0 or not slips:
                continue
            if _touches(engine, i, states[n]):
                out[n, i, 0] = out[n, i, 1] = math.nan
                continue
            rows = rows_passed(drive, 0, len(drive), times[n])
            friction = friction_under_disc(engine.regions, engine.discs, i)
            phase = Phase(model, friction, rows, SLIDES, NO_WAY, 0.0)
            rates(phase, times[n], y, work, FIRST)
            out[n, i, 0], out[n, i, 1] = work[0, LAMBDA], work[0, LAMBDA + 1]


@inlined
def _touches(engine: Engine, i: int, states: FloatArray) -> bool:
    """Whether a disc touches a cushion or another disc, at states (n, 6)."""
    x, y, radius = states[i, X], states[i, Y], engine.discs[i, RADIUS]
    for k in range(engine.obstacles.shape[0]):
        gap, _, _, there = normal_to(engine.obstacles[k], radius, x, y, 0.0)
        if there and gap < _NEAR * radius and int(engine.obstacles[k, KIND]) < NO_CUSHION:
            return True
    for j in range(engine.discs.shape[0]):
        gap = math.hypot(states[j, X] - x, states[j, Y] - y) - radius - engine.discs[j, RADIUS]
        if j != i and gap < _NEAR * radius:
            return True
    return False
