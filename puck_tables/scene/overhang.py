"""Where the rim of a base comes over an edge.

The base is carried as if there were no edge until its centre is over it: friction and load of a
part that hangs in the air are not known here.  So the motion does not change there, and no step
ends there, but it is told.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.boundaries import Line, arc_of, crossing, gap_polynomial, line_to
from puck_tables.scene.equations import SIZE
from puck_tables.scene.ingredients import Stretch
from puck_tables.scene.records import noted
from puck_tables.scene.steps import step

OVERHANGS = 7  # among what happens on the way


@inlined
def _to_rim(edges: FloatArray, k: int, radius: float, y: FloatArray) -> Line:
    line = line_to(edges, k, 1.0, y)
    return Line(line.x, line.y, line.gap - radius)


@inlined
def look_at_edges(
    edges: FloatArray, radius: float, hangs: npt.NDArray[np.bool_], stretch: Stretch, t: float,
    y: FloatArray, events: FloatArray, count: int,
) -> int:  # fmt: skip
    """See over which edges a base hangs at its start; the number of events."""
    for k in range(len(edges)):
        hangs[k] = _to_rim(edges, k, radius, y).gap < 0.0
        if hangs[k] and count < len(events):
            noted(events[count], stretch.model, t, OVERHANGS, k, y)
            count += 1
    return count


@inner
def come_over_edges(
    edges: FloatArray, radius: float, hangs: npt.NDArray[np.bool_], stretch: Stretch, t: float,
    h: float, y: FloatArray, scale: FloatArray, work: FloatArray, last: FloatArray,
    new: FloatArray, gaps: FloatArray, trial: FloatArray, events: FloatArray, count: int,
) -> int:  # fmt: skip
    """Note over which edges the rim comes on a step to ``new``; the number of events.

    ``last``: the rates at its end.  One that is back may come over again.
    """
    arc = arc_of(stretch, work[0], last, new)
    for k in range(len(edges)):
        line = _to_rim(edges, k, radius, y)
        if hangs[k]:
            hangs[k] = line.gap + (line.x * new[SIZE] + line.y * new[SIZE + 1]) <= 0.0
            continue
        if count == len(events) or not gap_polynomial(line, arc, h, gaps):
            continue
        when = crossing(line, gaps, stretch, t, h, y, scale, work, trial)
        if when < math.inf:
            step(stretch, t, when, y, scale, work, trial)
            noted(events[count], stretch.model, t + when, OVERHANGS, k, trial)
            hangs[k] = True
            count += 1
    return count
