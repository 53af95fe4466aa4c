"""Which contacts press, and which rims stick: λ ≥ 0, gap″ ≥ 0, λ gap″ = 0, |τ| ≤ μλ.

One problem for accelerations and for impacts, which have impulses for forces and velocities for
accelerations.  Modes are guessed, the forces solved for, and all modes that these contradict are
changed at once, so that the order of contacts has no say.  Where that goes round in circles, modes
come from :mod:`puck_tables.world.lemke`, which finds forces wherever there are some.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.world.group import (
    APART,
    GRIP,
    LEVEL,
    SLIP,
    SMOOTH_SLIP,
    STICKS,
    GroupBuffer,
    IntArray,
    Scales,
)
from puck_tables.world.lemke import modes_of_lemke
from puck_tables.world.multipliers import leads, push_and_move

_GUESSES = 25  # of modes from those before: beyond, they go round in circles
_LEFT_OVER = 1e-9  # of what is given: the equations have no solution


@inlined
def rim_mode(sight: FloatArray, speed: float) -> int:
    """How the rims slip, as seen; rims without friction slide."""
    slip = sight[SLIP]
    if abs(slip) <= 2.0 * SMOOTH_SLIP * speed and sight[GRIP] > 0.0:
        return STICKS
    return 1 if slip >= 0.0 else -1


@inlined
def most(sight: FloatArray, push: float) -> float:
    """The most that the rims bear where they are pressed."""
    return math.inf if sight[GRIP] == math.inf else sight[GRIP] * max(push, 0.0)


@inlined
def load_of(sight: FloatArray, mode: int, push: float, rim: float) -> float:
    """What presses a contact: λ, or on rims without bound that slide, τ against the slip."""
    return mode * rim if mode != STICKS and sight[GRIP] == math.inf else push


@inlined
def better_mode(buffer: GroupBuffer, c: int, mode: int, scales: Scales, may_slide: bool) -> int:
    """The mode that forces and accelerations ask for, when it was supposed to be ``mode``.

    ``may_slide``: also on rims without bound, which then nothing presses; guesses from the start go
    round in circles with it (13 of 300 racks were refused, 2 are).
    """
    gap, slip, soft, rolls = leads(buffer, c)
    slack = 0.5 * LEVEL * scales.rate
    if soft == 0.0:  # between two that cannot move nothing is known, if they do not part
        return APART if gap > slack else mode
    sight, push, rim = buffer.sights[c], buffer.pushes[c, 0], buffer.pushes[c, 1]
    if mode == APART:
        if gap >= -slack:
            return APART
        mode = rim_mode(sight, scales.speed)
        if mode == STICKS and abs(slip) * soft > most(sight, -gap) * rolls:  # as it would alone
            mode = 1 if slip > 0.0 else -1
        return mode
    if load_of(sight, mode, push, rim) * soft < -slack:
        if may_slide and mode == STICKS and sight[GRIP] == math.inf and rim != 0.0:
            return 1 if rim > 0.0 else -1
        return APART
    if sight[GRIP] == 0.0:
        return mode
    if mode == STICKS:
        if (abs(rim) - most(sight, push)) * rolls > slack:
            return 1 if rim > 0.0 else -1
        return STICKS
    begins = abs(sight[SLIP]) <= 2.0 * SMOOTH_SLIP * scales.speed
    return STICKS if begins and slip * mode < -slack else mode


@inner
def find_modes(buffer: GroupBuffer, modes: IntArray, members: int, scales: Scales) -> bool:
    """Modes that contradict nothing, from those given; pushes and accelerations.  Whether found."""
    count = modes.shape[0]
    for attempt in range(2):
        if attempt == 1 and not modes_of_lemke(buffer, modes, scales):
            return False
        for _ in range(_GUESSES):
            left = push_and_move(buffer, modes, members)
            changed = False
            for c in range(count):
                mode = better_mode(buffer, c, modes[c], scales, attempt == 1)
                buffer.order[c] = mode
                changed = changed or mode != modes[c]
            if not changed and left <= _LEFT_OVER:
                return True
            if not changed:
                break
            for c in range(count):
                modes[c] = buffer.order[c]
    return False
