"""Which contacts press, and which rims stick: λ ≥ 0, gap″ ≥ 0, λ gap″ = 0, |τ| ≤ μλ.

Modes are guessed, the forces solved for, and all modes that these contradict are changed at once,
so that the order of contacts has no say.  Where that goes round in circles, forces that are moved
by small steps towards what they should be, all at once, show other modes to start from.
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
from puck_tables.world.multipliers import (
    LEFT,
    RIGHT,
    SOLUTION,
    constrain,
    fill_matrix,
    leads,
    push_and_move,
    right_hand_side,
)

_GUESSES, _TRIES = 25, 5  # of modes from those before; of modes from forces
_STEPS = 400  # of forces, before modes are guessed from them; four times as many each time
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
def better_mode(buffer: GroupBuffer, c: int, mode: int, scales: Scales) -> int:
    """The mode that forces and accelerations ask for, when it was supposed to be ``mode``."""
    gap, slip, soft, rolls = leads(buffer, c)
    slack = 0.5 * LEVEL * scales.rate
    if soft == 0.0:  # between two that cannot move nothing is known, if they do not part
        return APART if gap > slack else mode
    sight, push, rim = buffer.sights[c], buffer.pushes[c, 0], buffer.pushes[c, 1]
    if mode == APART:
        return rim_mode(sight, scales.speed) if gap < -slack else APART
    if push * soft < -slack:
        return APART
    if sight[GRIP] == 0.0 or sight[GRIP] == math.inf:
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
    for attempt in range(_TRIES):
        for _ in range(_GUESSES):
            left = push_and_move(buffer, modes, members)
            changed = False
            for c in range(count):
                mode = better_mode(buffer, c, modes[c], scales)
                buffer.order[c] = mode
                changed = changed or mode != modes[c]
            if not changed:
                return left <= _LEFT_OVER
            for c in range(count):
                modes[c] = buffer.order[c]
        _by_small_steps(buffer, modes, members, scales, _STEPS * 4**attempt // 4)
    return False


@inlined
def _by_small_steps(
    buffer: GroupBuffer, modes: IntArray, members: int, scales: Scales, steps: int
) -> None:
    """Modes from forces that go, all at once, by small steps to where they should be."""
    for c in range(modes.shape[0]):
        modes[c] = STICKS
    count = constrain(buffer, modes, True, False)
    fill_matrix(buffer, count)
    right_hand_side(buffer, modes)
    v = buffer.vectors
    for r in range(count):
        v[SOLUTION, r] = 0.0
    for _ in range(steps):
        for r in range(count):
            total, weight = v[RIGHT, r], 0.0
            for c in range(count):
                total -= buffer.matrix[r, c] * v[SOLUTION, c]
                weight += abs(buffer.matrix[r, c])
            v[LEFT, r] = total / weight if weight > 0.0 else 0.0
        number = 0
        for c in range(modes.shape[0]):
            sight = buffer.sights[c]
            push = max(v[SOLUTION, number] + v[LEFT, number], 0.0)
            v[SOLUTION, number] = push
            number += 1
            if sight[GRIP] > 0.0:
                slides, bound = rim_mode(sight, scales.speed), most(sight, push)
                rim = v[SOLUTION, number] + v[LEFT, number]
                if slides != STICKS:
                    rim = slides * bound
                v[SOLUTION, number] = min(max(rim, -bound), bound)
                number += 1
        for tie in range(number, count):
            v[SOLUTION, tie] += v[LEFT, tie]
    number = 0
    for c in range(modes.shape[0]):
        sight = buffer.sights[c]
        push, bound = v[SOLUTION, number], most(sight, v[SOLUTION, number])
        number += 1
        modes[c] = rim_mode(sight, scales.speed)
        if sight[GRIP] > 0.0:
            rim = v[SOLUTION, number]
            if modes[c] == STICKS and abs(rim) >= bound:
                modes[c] = 1 if rim > 0.0 else -1
            number += 1
        if push == 0.0:
            modes[c] = APART
