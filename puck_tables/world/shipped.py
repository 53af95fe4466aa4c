"""A board that is played without Python: all its arrays, and two flat doors to it.

What it is lies in the first slot of its store, and what it becomes goes to the second; whoever
plays it takes it from there, keeps as many boards as he likes, and puts one back to go on with it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.kernels.compile import arrays_in, kernel
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import stored
from puck_tables.world.bench import LED, LET_GO, REPORT_COLUMNS, TO_DO, WAITS, Bench, Orders, Slots
from puck_tables.world.engine_state import REMOVED, Whole
from puck_tables.world.lasting import LONG, braking_of
from puck_tables.world.layout import RADIUS
from puck_tables.world.lone import LONGEST
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.prepare import fastest_allowed, least_scales
from puck_tables.world.segment_starts import locate
from puck_tables.world.setting_off import REACHED
from puck_tables.world.worlds import Worlds

# what :func:`play_shipped` says beside how many events there were
NOTHING_HAPPENS, TOO_FAST, FAILED = -1, -2, -3  # FAILED and less: FAILED − how the engine ended
# of ``limits``: see :func:`shipped`
_RADIUS, _STEADY, FASTEST, _LEVER, _PUSHED, _DRAGS = range(6)


class Shipped(NamedTuple):
    """A board, where it is played, and what is said of it.

    ``limits`` (6,): the least radius, m, the largest steady acceleration, m/s², the fastest slip,
    m/s, and of how long it may last :func:`puck_tables.world.lasting.braking_of`.  ``reports``
    (rows, 12): events; ``states`` (1, pucks, 6), ``moving`` (1, pucks).
    """

    bench: Bench
    store: Slots
    orders: Orders
    limits: FloatArray
    reports: FloatArray
    first: Whole
    states: FloatArray
    moving: Whole


def shipped(scene: SceneSpec) -> tuple[Shipped, Worlds]:
    """A scene at its start, ready to be played, and the board as it is played in Python.

    Raises InputError if a number of it is a range, its floor moves, or a constraint leads a puck.
    """
    board = Worlds(scene, 1)
    if not board._plain:
        raise InputError(
            "a floor that moves, or a puck that a constraint leads, goes into no file: play this "
            "board in Python"
        )
    engine, count = board._first._engine, len(board.names)
    radius, steady = least_scales(engine)
    bench = board._bench(count * LONGEST)
    for array in arrays_in((bench.room.buffer, bench.place.buffer)):
        array[...] = 0  # nobody has written there yet
    kept, pieces = board._store, np.zeros((2, count * LONGEST, PIECE_COLUMNS))
    pieces[0, : kept.pieces.shape[1]] = kept.pieces[-1]
    store = Slots(
        np.stack([kept.numbers[-1]] * 2), np.stack([kept.whole[-1]] * 2), pieces,
        np.full(2, kept.due[-1]),
    )  # fmt: skip
    one, none = np.zeros(1), np.zeros(1, np.int64)
    orders = Orders(
        none, none.copy(), none + 1, one, one.copy(), none.copy(), np.zeros((1, 1, 6)),
        np.zeros((1, 2)), one.copy(), one.copy(), none.copy(),
    )  # fmt: skip
    limits = np.array([radius, steady, fastest_allowed(engine), *braking_of(engine)])
    rows = np.zeros((2 * len(bench.engine.events), REPORT_COLUMNS))
    return Shipped(
        bench, store, orders, limits, rows, none.copy(), np.zeros((1, count, 6)),
        np.zeros((1, count), np.int64),
    ), board  # fmt: skip


@kernel
def play_shipped(ship: Shipped, what: int, until: float) -> int:
    """Do something to the board: how many events there were, or why it is not done.

    ``what``: an event by hand (the disc and its row stand in the orders), LED, or LET_GO until a
    time; inf: until nothing more can happen.
    """
    orders, store, bench = ship.orders, ship.store, ship.bench
    scales, limits = orders.scales[0], ship.limits
    scales[0], scales[1] = store.numbers[0, 0], store.numbers[0, 1]
    if what == LET_GO:
        slowing = limits[_LEVER] * (scales[0] + limits[_PUSHED])
        orders.longest[0] = LONG * max(slowing, scales[0] / scales[1], limits[_DRAGS])
    elif what != REMOVED:
        i, row = orders.discs[0], orders.rows[0, 0]
        stored.take(store, 0, orders.time[0], bench)
        locate(bench.engine, i, orders.time[0], bench.room)
        state = bench.room.states[i]
        for column in range(VX, SPIN + 1):
            if row[column] == row[column]:  # not NaN
                state[column] = row[column]
        rim = 0.0 if what == LED else bench.engine.discs[i, RADIUS] * state[SPIN]
        slip = math.hypot(math.hypot(state[VX], state[VY]), rim)
        if slip > limits[FASTEST]:
            return TOO_FAST
        if slip > scales[0]:
            rate = limits[_STEADY] if limits[_STEADY] > 0.0 else slip * slip / limits[_RADIUS]
            scales[0], scales[1] = slip, max(scales[1], rate)
    orders.until[0], orders.how[0] = until, TO_DO
    _, used = stored.play(what, orders, store, bench, 0, 1, ship.reports)
    if orders.how[0] == WAITS:
        return NOTHING_HAPPENS
    return used if orders.how[0] == REACHED else FAILED - orders.how[0]


@kernel
def see_shipped(ship: Shipped, time: float) -> int:
    """States of all pucks at a time before anything happens, and who moves; how many pucks."""
    ship.orders.after[0] = time
    stored.fill_states(
        ship.store, ship.first, ship.orders.after, ship.bench, 0, 1, ship.states, ship.moving
    )
    return ship.moving.shape[1]
