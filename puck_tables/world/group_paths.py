"""The paths of discs that push each other, until something changes: which contacts press, how long.

What is given up at once (a contact that parts, a rim that gives) is tried without it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.world.engine_state import Engine, Whole
from puck_tables.world.floor_under import is_over, moves_along
from puck_tables.world.group import (
    APART,
    HELD,
    LEVEL,
    PARTS,
    RESTS,
    RIM_GIVES,
    RIM_STOPS,
    RUNS_OFF,
    STICKS,
    UNSOLVED,
    GroupBuffer,
    Scales,
    buffer_for,
)
from puck_tables.world.layout import HOLD_VX, HOLD_VY, PULL_X, PULL_Y, TWIST, write_over
from puck_tables.world.lone import LONGEST
from puck_tables.world.paths import BEGINS, DURATION, FOR_EVER, PIECE_COLUMNS
from puck_tables.world.pressing import press
from puck_tables.world.pushing import follow
from puck_tables.world.step_ledger import LEDGER, WORK_COLUMNS

FINEST = 1e-13  # error of a step in units of the scales: finer is rounding
_TRIES = 100  # contacts given up at one moment, at most: more is no motion


class Workplace(NamedTuple):
    """Where one group after the other is set up.

    ``engine``: as all have it, but that its ``pieces`` and ``drives`` are the ways of the driven
    now; ``contacts`` (c, 3): disc, partner and row in the room; ``modes``
    (c,), ``members`` and ``motions`` (n,): of all these the first are those of the group; ``moved``
    (n, 6): states at the end; ``pieces`` (n, LONGEST, 20) and ``work_rows`` (LONGEST,
    37): the paths; ``jump`` (8,): the ledger of what happened at once; ``buffer``: to work on.
    """

    engine: Engine
    contacts: Whole
    modes: Whole
    members: Whole
    motions: Whole
    moved: FloatArray
    pieces: FloatArray
    work_rows: FloatArray
    jump: FloatArray
    buffer: GroupBuffer


def workplace_for(engine: Engine, contacts: int) -> Workplace:
    """The place to set up groups that push, with so many contacts."""
    n = len(engine.discs)
    own = engine._replace(pieces=np.zeros((n, PIECE_COLUMNS)), drives=np.zeros((n, 2), np.int64))
    return Workplace(
        own, np.zeros((contacts, 3), np.int64), np.zeros(contacts, np.int64),
        np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros((n, 6)),
        np.zeros((n, LONGEST, PIECE_COLUMNS)), np.zeros((LONGEST, WORK_COLUMNS)), np.zeros(LEDGER),
        buffer_for(n, contacts, n),
    )  # fmt: skip


@inlined
def _next_jump(engine: Engine, i: int, t: float) -> float:
    """When what acts on a disc over time, or how its floor moves, may jump after t."""
    first, last = engine.spans[i, 0], engine.spans[i, 1]
    for row in range(first, last):
        now = engine.forcing[row, 0]
        ends = row in (first, last - 1)  # and where a time stands twice
        ends = ends or now in (engine.forcing[row - 1, 0], engine.forcing[row + 1, 0])
        if now > t and (ends or engine.surface.changes != 0.0):
            return now
    return math.inf


@inlined
def _horizon(engine: Engine, t: float, size: int, place: Workplace) -> tuple[float, bool]:
    """Up to when a group is followed, and whether it may set off from rest by itself."""
    surface, horizon, jump = engine.surface, math.inf, math.inf
    pulled = over = False
    moves = moves_along(surface)
    for k in range(size):
        i = place.members[k]
        disc = engine.discs[i]
        pulled = pulled or disc[PULL_X] != 0.0 or disc[PULL_Y] != 0.0 or disc[TWIST] != 0.0
        moves = moves or disc[HOLD_VX] != 0.0 or disc[HOLD_VY] != 0.0
        jump = min(jump, _next_jump(engine, i, t))
        over = over or is_over(engine, i)
        if engine.drives[i, 0] < engine.drives[i, 1]:  # what drives may turn where its piece ends
            row = place.engine.pieces[i]
            moves = moves or row[DURATION] >= FOR_EVER  # by hand, until it turns
            horizon = min(horizon, row[BEGINS] + row[DURATION])
    jumps = jump < math.inf
    if pulled or moves or jumps:  # for ever, perhaps, and faster than bounds should be
        horizon = min(horizon, t + 2.0 * engine.scale[0] / engine.scale[1])
    swings = jumps or (surface.spin != 0.0 and pulled)
    # what holds those who lie astride changes as they are carried on
    return min(horizon, jump), swings or (over and moves_along(surface))


@inlined
def _keep(contacts: int, place: Workplace) -> int:
    """Drop the contacts that are APART; how many are left."""
    left = 0
    for c in range(contacts):
        if place.modes[c] != APART:
            write_over(place.contacts[left], place.contacts[c])
            place.modes[left] = place.modes[c]
            left += 1
    return left


@inner
def paths_of(
    engine: Engine, t: float, size: int, contacts: int, states: FloatArray, place: Workplace
) -> tuple[int, float, int]:
    """How many contacts of a group press, until when its paths are known, and their rows.

    0 where none presses; −1: no motion is found.  Where all rest until they are hit, for ever and
    no rows.
    """
    members, motions = place.members[:size], place.motions[:size]
    modes, buffer = place.modes, place.buffer
    scales = Scales(engine.scale[0], engine.scale[1], max(engine.scale[2], FINEST))
    horizon, swings = _horizon(engine, t, size, place)
    for c in range(contacts):
        modes[c] = STICKS
    for _ in range(_TRIES):
        how = press(
            place.engine, members, place.contacts[:contacts], states, t, scales,
            modes[:contacts], motions, place.jump, buffer,
        )  # fmt: skip
        if how == UNSOLVED:
            return -1, t, 0
        contacts = _keep(contacts, place)
        rests = not swings
        for k in range(size):
            rests = rests and motions[k] == HELD
        if contacts == 0 or rests:
            return contacts, math.inf, 0
        for i in members:
            write_over(place.moved[i], states[i])
        how, which, t_end, count = follow(
            place.engine, members, place.contacts[:contacts], place.moved, t, horizon, scales,
            modes[:contacts], motions, place.pieces, place.work_rows, buffer,
        )  # fmt: skip
        if t_end > t and count > 0:
            return contacts, t_end, count
        if how not in (PARTS, RIM_STOPS, RIM_GIVES, RUNS_OFF, RESTS):
            return -1, t, 0
        for i in members:  # sooner than a time is rounded to
            write_over(states[i], place.moved[i])
        for c in range(contacts):
            modes[c] = STICKS
            if how in (PARTS, RUNS_OFF) and (
                c == which or buffer.watched[0, c, 0] < LEVEL * scales.rate  # all that do
            ):
                modes[c] = APART
        if how == RIM_GIVES:
            modes[which] = -1 if buffer.pushes[which, 1] < 0.0 else 1
        contacts = _keep(contacts, place)
        if contacts == 0:
            return 0, t, 0
    return -1, t, 0
