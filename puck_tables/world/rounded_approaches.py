"""Approaches that are mere rounding are taken out of discs that touch.

They are too slow for an impact, but over seconds discs would creep into each other: by 1e-12 of the
speeds times the time.  What the floor holds at rest stays there.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import VX, VY
from puck_tables.world.contact_row import ACTS, NX, NY, approach
from puck_tables.world.contact_search import QUIET
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import slips
from puck_tables.world.impact import as_forces
from puck_tables.world.layout import DECEL, LIGHTNESS, PULL_X, PULL_Y
from puck_tables.world.putting_right import stop_slips
from puck_tables.world.segment_starts import CONCERNED, Room

_ROUNDED = 4e-16  # of the speeds of both: less cannot be taken out
_ROUNDS = 8  # of contacts that approach as others are stopped, at most


@inlined
def _moves(engine: Engine, room: Room, i: int) -> bool:
    """Whether it is a disc that gives way: the floor holds none that is at rest."""
    if i < 0 or engine.discs[i, LIGHTNESS] == 0.0:
        return False
    disc = engine.discs[i]
    steep = engine.surface.static * disc[DECEL] <= math.hypot(disc[PULL_X], disc[PULL_Y])
    return steep or slips(engine.surface, disc, room.states[i])


@inlined
def _speed(room: Room, i: int) -> float:
    return math.hypot(room.states[i, VX], room.states[i, VY]) if i >= 0 else 0.0


@inner
def quieten(engine: Engine, count: int, t: float, room: Room) -> None:
    """Take out of the contacts found what approaches too slowly for an impact.

    Who changes is marked; whole groups are already, whoever of them is touched.
    """
    contacts, rows, buffer = room.contacts, room.rows, room.buffer
    for n in range(count):
        rows[n, ACTS] = 0.0
    for _ in range(_ROUNDS):
        more = False
        for n in range(count):
            i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
            un, _ = approach(engine, i, j, row[NX], row[NY], room.states)
            least = _ROUNDED * (_speed(room, i) + _speed(room, j))
            if row[ACTS] > 0.0 or not least < un <= QUIET * engine.scale[0]:
                continue
            if _moves(engine, room, i) or _moves(engine, room, j):
                row[ACTS], more = 1.0, True
        acting = as_forces(engine, t, contacts, count, rows, room.states, buffer) if more else 0
        if acting <= 0:
            return
        for n in range(count):
            for m in range(2):
                i = contacts[n, m]
                if rows[n, ACTS] == 0.0 or i < 0:
                    continue
                if _moves(engine, room, i):
                    room.marks[i] = CONCERNED
                else:
                    buffer.inverse[i, 0] = buffer.inverse[i, 1] = 0.0
        modes = buffer.modes[0, :acting]
        modes[:] = 1
        stop_slips(buffer, modes, room.states)
