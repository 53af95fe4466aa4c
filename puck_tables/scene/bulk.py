"""Many launches of one scene: the compiled loop over the compiled loop."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating
from puck_tables.scene.boundaries import BOUNCES, Boundaries
from puck_tables.scene.ingredients import Model, Regions
from puck_tables.scene.loop import Ask, desk_for, follow
from puck_tables.scene.records import EVENT_COLUMNS, FRAME_COLUMNS

ENDS_COLUMNS = FRAME_COLUMNS + 1  # the last row, and the number of bounces


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
    no_frames = np.empty(0)
    row = np.empty((1, FRAME_COLUMNS))
    events = np.empty((event_limit, EVENT_COLUMNS))
    desk = desk_for(bounds)
    for n in range(len(states)):
        ask = Ask(asks[n, 0], to_the_end, tolerance, asks[n, 2:], asks[n, 1], step_limit, 0.0)
        how, _, count, _, _, _ = follow(
            model, regions, bounds, ask, states[n], starts[n], no_frames, row, events, desk
        )
        bounces = 0
        for i in range(count):
            bounces += 1 if events[i, 1] == BOUNCES else 0
        for i in range(FRAME_COLUMNS):
            out[i, n] = row[0, i]
        out[FRAME_COLUMNS, n] = bounces
        status[n] = how
