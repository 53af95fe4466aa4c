"""Take out of places and velocities what errors of steps have left: gaps, approaches, slips.

By the least change in the measure of the masses.  So energy does not grow, no order has a say, and
a change as small as the error of a step spoils no order of a method.
"""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inner
from puck_tables.world.group import APART, GAP, GRIP, STICKS, GroupBuffer, IntArray
from puck_tables.world.multipliers import (
    RIGHT,
    SOLUTION,
    add_forces,
    constrain,
    solve,
    stray,
    times_row,
)


@inner
def close_gaps(buffer: GroupBuffer, modes: IntArray, y: FloatArray) -> None:
    """Places where all that presses touches and all that is led is; the sights are of y (m, 6)."""
    count = constrain(buffer, modes, False, False)
    number = 0
    for c in range(modes.shape[0]):
        if modes[c] != APART:
            buffer.vectors[RIGHT, number] = -buffer.sights[c, GAP]
            number += 1
    stray(buffer, number, 0)
    solve(buffer, count)
    add_forces(buffer, count, y, 0)


@inner
def stop_slips(buffer: GroupBuffer, modes: IntArray, y: FloatArray) -> float:
    """Velocities with which nothing that presses approaches, and no rim slips that sticks.

    The heat of it: a force that stops a slip works at half of it.
    """
    count = constrain(buffer, modes, True, False)
    number = 0
    for c in range(modes.shape[0]):
        if modes[c] == APART:
            continue
        buffer.vectors[RIGHT, number] = times_row(buffer, number, y, 3)
        number += 1
        if modes[c] == STICKS and buffer.sights[c, GRIP] > 0.0:
            buffer.vectors[RIGHT, number] = times_row(buffer, number, y, 3)
            number += 1
    stray(buffer, number, 1)
    solve(buffer, count)
    add_forces(buffer, count, y, 3)
    heat = 0.0
    for r in range(count):
        heat += 0.5 * buffer.vectors[RIGHT, r] * buffer.vectors[SOLUTION, r]
    return heat
