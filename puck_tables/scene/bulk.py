"""Many launches of one scene: the compiled loop over the compiled loop."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, patience
from puck_tables.scene.at_once import AS_IT_COMES, FIRST_BY_NUMBER, GROWN, LAST_BY_NUMBER
from puck_tables.scene.boundaries import BOUNCES, Boundaries
from puck_tables.scene.desk import Ask, Desk, desk_for
from puck_tables.scene.friction import X, Y
from puck_tables.scene.ground import patches_on
from puck_tables.scene.ingredients import Model, Regions
from puck_tables.scene.loop import follow
from puck_tables.scene.outcome import NOT_FINITE, UNDECIDED
from puck_tables.scene.records import EVENT_COLUMNS, FRAME_COLUMNS

ENDS_COLUMNS = FRAME_COLUMNS + 1  # the last row, and the number of bounces
_FINER, _FINEST = 1 / 30, 3e-14  # of the local error, and the finest


@allocating
def _in_both_orders(
    model: Model, regions: Regions, bounds: Boundaries, ask: Ask, state: FloatArray, region: int,
    row: FloatArray, events: FloatArray, desk: Desk,
) -> tuple[int, int]:  # fmt: skip
    """How a run ends of which it is not sure what is met first, and the number of events.

    The last state into ``row`` where both orders lead there; else with finer steps.
    """
    no_frames, other = np.empty(0), np.empty((1, FRAME_COLUMNS))
    allowed, tolerance = GROWN * ask.tolerance, ask.tolerance
    while True:
        apart = 0.0
        for order in (FIRST_BY_NUMBER, LAST_BY_NUMBER, AS_IT_COMES):
            again = Ask(
                ask.until, ask.to_the_end, tolerance, ask.scale, ask.speed, ask.step_limit,
                ask.twin, order,
            )  # fmt: skip
            how, _, count, _, _, _ = follow(
                model, regions, bounds, again, state, region, no_frames, row, events, desk
            )
            if order == FIRST_BY_NUMBER:
                other[:] = row
            else:
                place = math.hypot(row[0, 1 + X] - other[0, 1 + X], row[0, 1 + Y] - other[0, 1 + Y])
                late = ask.speed * abs(row[0, 0] - other[0, 0])
                apart = max(apart, place / ask.scale[X], late / ask.scale[X])
        if desk.at_once[0] == 0.0 or apart <= allowed:
            return how, count
        if tolerance <= _FINEST or how == NOT_FINITE:
            return UNDECIDED, count
        tolerance = max(_FINER * tolerance, _FINEST)


@allocating
def follow_many(
    model: Model,
    regions: Regions,
    bounds: Boundaries,
    asks: FloatArray,
    to_the_end: bool,
    tolerance: float,
    step_limit: int,
    event_limit: int,
    states: FloatArray,
    starts: npt.NDArray[np.int64],
    out: FloatArray,
    status: npt.NDArray[np.int8],
) -> None:
    """Ends of launches from ``states`` (n, 10) in the regions ``starts`` (n,) into ``out`` (16, n).

    ``asks`` (n, 12): until when, the scale of speeds, and the scales of the state.  One launch
    never influences another, so any cutting into chunks gives the same bits.
    """
    patience(len(states))
    no_frames = np.empty(0)
    row = np.empty((1, FRAME_COLUMNS))
    events = np.empty((event_limit, EVENT_COLUMNS))
    desk = desk_for(bounds, patches_on(regions.ground))
    regions = Regions(
        regions.load, regions.delta, regions.cuts, regions.by_speed, regions.astride,
        regions.ground.copy(),
    )  # fmt: skip
    for n in range(len(states)):
        ask = Ask(
            asks[n, 0], to_the_end, tolerance, asks[n, 2:], asks[n, 1], step_limit, 0.0, AS_IT_COMES
        )  # fmt: skip
        how, _, count, _, _, _ = follow(
            model, regions, bounds, ask, states[n], starts[n], no_frames, row, events, desk
        )
        if desk.at_once[0] > 0.0:
            how, count = _in_both_orders(
                model, regions, bounds, ask, states[n], starts[n], row, events, desk
            )
        bounces = 0
        for i in range(count):
            bounces += 1 if events[i, 1] == BOUNCES else 0
        for i in range(FRAME_COLUMNS):
            out[i, n] = row[0, i]
        out[FRAME_COLUMNS, n] = bounces
        status[n] = how
