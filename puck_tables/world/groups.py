"""Discs that push each other: who they are, and the ways on which they go until that changes.

The engine says when contacts press; here those that do become groups, each is followed
(:mod:`puck_tables.world.pushing`), and its ways become the flights of its discs.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.friction import VX, VY
from puck_tables.world.engine import CONCERNED, PUSHED, Room, keep_flight
from puck_tables.world.flight import (
    ANGLE,
    FASTEST,
    FIRST_PIECE,
    LAST_PIECE,
    PATH,
    PLACE_X,
    PLACE_Y,
    START,
    STRONGEST,
    UNTIL,
)
from puck_tables.world.game import N_CONTACTS, N_GROUPS, N_HELD, N_PIECES, Game, Whole
from puck_tables.world.group import (
    APART,
    HELD,
    LEDGER,
    NOT_FINITE,
    PARTS,
    RUNS_OFF,
    UNSOLVED,
    Group,
    Scales,
    desk_for,
)
from puck_tables.world.impact import ACTS
from puck_tables.world.paths import DURATION, FIRST, PIECE_COLUMNS
from puck_tables.world.pressing import press
from puck_tables.world.pushing import follow

STEP_TOL = 1e-11  # of a step, in units of Q and Q²/J
ROWS = 400  # steps of a group before its flights end for a new look
_GRACE = 1.5  # times accelerations at the ends of steps, between them
_TRIES = 100


def push_on(game: Game, room: Room) -> Game:
    """Send the groups that push now on their way; marks say who is left to fly alone."""
    contacts = room.contacts[: game.counts[N_CONTACTS]]
    contacts = contacts[room.rows[: len(contacts), ACTS] > 0.0]
    for i in np.flatnonzero(room.marks == CONCERNED):
        game.group[i] = 0
    held = game.held[: game.counts[N_HELD]]
    held = held[game.group[held[:, 0]] > 0]
    t, scales = float(game.clock[0]), Scales(float(game.pace[0]), float(game.pace[1]), STEP_TOL)
    shared = Group(game.discs, game.obstacles, game.regions, game.pieces, game.drives, 0.0, 0.0)
    for part in _components(contacts, len(game.discs)):
        members, kept, t_end, ways = _follow(shared, part, room.states, t, scales)
        if not len(kept):
            continue
        game.counts[N_GROUPS] += 1
        held = np.vstack([held, kept])
        for place, i in enumerate(members):
            game.group[i] = game.counts[N_GROUPS]
            if game.drives[i, 0] < game.drives[i, 1]:
                continue  # it stays on its own way
            game = _with_pieces(game, ways[place])
            _set_out(game, int(i), t, t_end, ways[place])
            room.marks[i] = PUSHED
    game.held[: len(held)], game.counts[N_HELD] = held, len(held)
    return game


def _components(contacts: Whole, discs: int) -> list[Whole]:
    """Contacts that hang together."""
    root = np.arange(discs)

    def find(i: int) -> int:
        while root[i] != i:
            i = int(root[i])
        return i

    for i, j in contacts:
        if j >= 0:
            a, b = find(int(i)), find(int(j))
            root[max(a, b)] = min(a, b)
    roots = np.array([find(int(i)) for i in contacts[:, 0]], np.int64)
    return [contacts[roots == one] for one in np.unique(roots)]


def _follow(
    shared: Group, contacts: Whole, states: FloatArray, t: float, scales: Scales
) -> tuple[Whole, Whole, float, FloatArray]:
    """Members of a group, its contacts that press, until when, and pieces (m, rows, 20).

    No contacts, where none presses.
    """
    for _ in range(_TRIES):
        members = np.unique(contacts[contacts >= 0])
        desk, ledger = desk_for(len(members), len(contacts)), np.zeros(LEDGER)
        modes, doings = np.zeros(len(contacts), np.int64), np.zeros(len(members), np.int64)
        how = press(shared, members, contacts, states, t, scales, modes, doings, ledger, desk)
        if how == UNSOLVED:
            break
        contacts, modes = contacts[modes != APART], modes[modes != APART]
        if not len(contacts) or (doings == HELD).all():
            return members, contacts[:0], t, np.zeros((0, 0, PIECE_COLUMNS))
        pieces = np.zeros((len(members), ROWS, PIECE_COLUMNS))
        after = states.copy()
        how, which, t_end, count = follow(
            shared, members, contacts, after, t, math.inf, scales, modes, doings, pieces, ledger,
            desk,
        )  # fmt: skip
        if how in (UNSOLVED, NOT_FINITE) and count == 0:
            break
        if t_end > t and count > 0:
            return members, contacts, t_end, pieces[:, :count]
        if how in (PARTS, RUNS_OFF):
            contacts = np.delete(contacts, which, axis=0)
            if not len(contacts):
                return members, contacts, t, pieces[:, :0]
    raise PuckError(
        f"at {t:.6g} s {len(members)} pucks press on each other so that no forces satisfy all laws "
        "of their rims: give their rims a finite friction (rim), or move one of them"
    )


def _with_pieces(game: Game, rows: FloatArray) -> Game:
    """With rows of a way at the end of its pieces."""
    first = int(game.counts[N_PIECES])
    if first + len(rows) > len(game.pieces):
        more = np.zeros((first + 2 * len(rows), PIECE_COLUMNS))
        game = game._replace(pieces=np.vstack([game.pieces[:first], more]))
    game.pieces[first : first + len(rows)] = rows
    game.counts[N_PIECES] = first + len(rows)
    return game


def _set_out(game: Game, i: int, t: float, t_end: float, rows: FloatArray) -> None:
    """The flight of a disc along the rows that were written last."""
    last, flight = int(game.counts[N_PIECES]), game.flights[i]
    speeds = np.hypot(rows[:, [FIRST + VX, FIRST + 9 + VX]], rows[:, [FIRST + VY, FIRST + 9 + VY]])
    bends = np.hypot(rows[:, [FIRST + 6, FIRST + 15]], rows[:, [FIRST + 7, FIRST + 16]])
    flight[START], flight[UNTIL] = t, t_end
    flight[PLACE_X], flight[PLACE_Y], flight[ANGLE] = rows[0, FIRST : FIRST + 3]
    flight[STRONGEST] = _GRACE * bends.max()
    flight[FASTEST] = float((speeds.max(axis=1) + flight[STRONGEST] * rows[:, DURATION]).max())
    flight[FIRST_PIECE], flight[LAST_PIECE] = last - len(rows), last
    game.kinds[i] = PATH
    keep_flight(game, i)
