"""Rows of what a run leaves: states at moments, and events; velocities in the laboratory."""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.equations import ROW, SECOND, SIZE, rates, to_laboratory
from puck_tables.scene.ingredients import CARRIED, Model, Stretch

FRAME_COLUMNS = ROW + 3  # time, state, λ, carried, heat of impacts
EVENT_COLUMNS = 3 + SIZE + 3  # time, what, which, state; velocities before an impact
BEFORE = 3 + SIZE


@inlined
def noted(row: FloatArray, model: Model, t: float, what: int, which: int, y: FloatArray) -> None:
    """An event of a kind, at a wall, an edge or in a region, at the state ``y``."""
    row[0], row[1], row[2] = t, what, which
    for i in range(SIZE):
        row[3 + i] = y[i]
    to_laboratory(model, row[3:], 1.0)


@inlined
def framed(
    row: FloatArray, stretch: Stretch, t: float, y: FloatArray, heat: float, work: FloatArray
) -> None:
    """The state ``y`` with what holds it, and the heat of all impacts before."""
    rates(stretch, t, y, work, SECOND)
    row[0] = t
    for i in range(SIZE):
        row[1 + i] = y[i]
    to_laboratory(stretch.model, row[1:], 1.0)
    row[1 + SIZE], row[2 + SIZE] = work[SECOND, SIZE], work[SECOND, SIZE + 1]
    row[1 + ROW] = 1.0 if stretch.mode == CARRIED else 0.0
    row[2 + ROW] = heat
