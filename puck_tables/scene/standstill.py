"""What a puck does whose slip has ended: the floor carries it, or it begins to slip."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inner
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.ingredients import CARRIED, NO_WAY, SLIDES, Phase
from puck_tables.scene.moments import REST, direction_of_end
from puck_tables.scene.rest import SLACK, excess_at_rest

_FIRST = 1e-16  # of the scale of speeds: what a slip begins with, for its direction
_QUICK = 0.01  # of friction: a slip that grows faster has its direction from the first


@inner
def from_standstill(
    phase: Phase, speed: float, t: float, y: FloatArray, work: FloatArray
) -> tuple[int, bool, float]:
    """Its mode from now on, whether the slip that begins settles fast, and its size in ``y``.

    ``phase``: as it would be carried; ``speed``: the scale of speeds; ``work``: to work in.
    """
    model, load = phase.model, phase.friction.load
    excess, nx, ny, nw = excess_at_rest(phase, t, y)
    if excess <= SLACK * load:
        return CARRIED, False, 0.0
    q = 2.0 * REST * speed
    slips = Phase(model, phase.friction, phase.piece, SLIDES, NO_WAY, 0.0)
    if model.surface.static > 1.0:  # once it slips that holds no more
        excess, nx, ny, nw = excess_at_rest(slips, t, y)
    if excess == math.inf:  # it is led where the floor does not go
        return SLIDES, False, 0.0
    if excess <= _QUICK * load:
        q = _FIRST * speed
        y[VX], y[VY], y[SPIN] = q * nx, q * ny, q * nw
        return SLIDES, True, q
    y[VX], y[VY], y[SPIN] = q * nx, q * ny, q * nw
    direction_of_end(slips, t, q, y, work)
    return SLIDES, True, q
