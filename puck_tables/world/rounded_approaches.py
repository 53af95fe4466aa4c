"""Approaches that are mere rounding are taken out of discs that touch.

They are too slow for an impact, but over seconds discs would creep into each other: by 1e-12 of the
speeds times the time.  What the floor holds at rest stays there.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import VX, VY
from puck_tables.world.contact_row import ACTS, NX, NY, PN, approach
from puck_tables.world.contact_search import QUIET
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import slips
from puck_tables.world.layout import DECEL, LIGHTNESS, PULL_X, PULL_Y
from puck_tables.world.segment_starts import CONCERNED, Room

_ROUNDED = 4e-16  # of the speeds of both: less cannot be taken out
_ROUNDS = 200  # rounds: where contacts share a disc, each takes out a part


@inlined
def _moved_by(engine: Engine, room: Room, i: int) -> float:
    """1/m; 0 of what the floor holds at rest, and of no disc."""
    if i < 0:
        return 0.0
    disc = engine.discs[i]
    steep = disc[DECEL] <= math.hypot(disc[PULL_X], disc[PULL_Y])
    if not (steep or slips(engine.surface, disc, room.states[i])):
        return 0.0
    return engine.discs[i, LIGHTNESS]


@inlined
def _speed(room: Room, i: int) -> float:
    return math.hypot(room.states[i, VX], room.states[i, VY]) if i >= 0 else 0.0


@inner
def quieten(engine: Engine, count: int, room: Room) -> bool:
    """Take out of the contacts found what approaches too slowly for an impact; whether any did.

    Who changes is marked.
    """
    found = False
    for _ in range(_ROUNDS):
        most = 0
        for n in range(count):
            i, j, row = room.contacts[n, 0], room.contacts[n, 1], room.rows[n]
            un, _ = approach(engine, i, j, row[NX], row[NY], room.states)
            soft = _moved_by(engine, room, i) + _moved_by(engine, room, j)
            row[ACTS] = row[PN] = 0.0
            least = _ROUNDED * (_speed(room, i) + _speed(room, j))
            if soft > 0.0 and least < un <= QUIET * engine.scale[0]:
                row[ACTS], row[PN] = 1.0, un / soft
        for n in range(count):  # how many share a disc, at most
            if room.rows[n, ACTS] > 0.0:
                for m in range(2):
                    if room.contacts[n, m] >= 0:
                        room.shares[room.contacts[n, m]] = 0
        for n in range(count):
            if room.rows[n, ACTS] > 0.0:
                for m in range(2):
                    if room.contacts[n, m] >= 0:
                        room.shares[room.contacts[n, m]] += 1
                        most = max(most, room.shares[room.contacts[n, m]])
        if most == 0:
            return found
        found = True
        for n in range(count):
            row = room.rows[n]
            if row[ACTS] > 0.0:
                for m in range(2):
                    disc = room.contacts[n, m]
                    change = (1.0 - 2.0 * m) * _moved_by(engine, room, disc) * row[PN] / most
                    if change != 0.0:
                        room.states[disc, VX] -= change * row[NX]
                        room.states[disc, VY] -= change * row[NY]
                        room.marks[disc] = CONCERNED
    return found
