"""States at times, compiled: one look-up on the curve of all motions for each."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    inlined,
    into_row,
    look_up,
    patience,
    row_of,
    rows_of,
    spline_values,
)
from puck_tables.kernels.elementary import log_of
from puck_tables.kernels.quadratic import basis
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN, STATE_ROWS
from puck_tables.stopping.lookup import HEIGHTS
from puck_tables.stopping.similarity_lookup import (
    LAUNCH_COLUMNS,
    LAUNCH_ROWS,
    STOPS_WIDTH,
    TINY,
    cell_of,
    place_after,
    place_of_log,
    state_there,
)

PUCK_ROWS = LAUNCH_COLUMNS + LAUNCH_ROWS  # of a puck: its launch, and what is known of that
_ROW = STOPS_WIDTH * HEIGHTS  # numbers of a node
# rows of a block: those of the puck, of its place on the curve, of the functions, of the state
_VX, _VY, _SPIN, _DELTA, _DECEL, _RADIUS, _TIME, _X, _Y, _, _BODY, _TURN = range(12)
_Q, _V, _T, _LOG_N, _SIGN_N, _HEADING, _KAPPA, _TURNING = range(12, PUCK_ROWS)
_MOMENT, _LEFT, _SHARE, _SWUNG, _FAST, _FIRST, _INSIDE = range(PUCK_ROWS, PUCK_ROWS + 7)
_VALUES = PUCK_ROWS + 7
_F_SHARE, _F_TIME, _F_ALONG, _F_ACROSS, _F_BODY, _F_TURN = range(_VALUES, _VALUES + 6)
_OUT = _VALUES + 6
_ROWS = _OUT + STATE_ROWS
_TO_X, _TO_Y, _TO_HEADING = _OUT + PUCK_X, _OUT + PUCK_Y, _OUT + HEADING
_TO_ANGLE, _TO_SPEED, _TO_SPIN = _OUT + ORIENTATION, _OUT + SPEED, _OUT + SPIN


@inlined
def gather(
    columns: FloatArray, which: npt.NDArray[np.int64], begin: int, start: int, count: int,
    width: int, held: int, room: FloatArray,
) -> int:  # fmt: skip
    """Columns for a block of moments, from ``start`` on, into the first rows of ``room``.

    ``width``: how many moments a block has that is full.

    Columns ``which`` (n,) or (1,); those from ``begin`` on, one after the other, where it is empty.
    The column that all of the block hold, −1 if not one; ``held``: that of the block before.
    """
    first, same = 0, which.size == 1
    if which.size > 1:
        first, same = which[start], True
        for n in range(count):
            same &= which[start + n] == first
    elif same:
        first = which[0]
    if same and first == held:
        return held
    for row in range(columns.shape[0]):
        values, block = columns[row], room[row * BLOCK : (row + 1) * BLOCK]
        if same:
            value = values[first]
            for n in range(width):
                block[n] = value
        elif which.size == 0:
            own = values[start - begin : start - begin + count]
            for n in range(count):
                block[n] = own[n]
        else:
            for n in range(count):
                block[n] = values[which[start + n]]
    return first if same else -1


@look_up
def fill_states_at(
    pucks: FloatArray, which: npt.NDArray[np.int64], times: FloatArray, begin: int, end: int,
    splines: FloatArray, out: FloatArray,
) -> int:  # fmt: skip
    """States at ``times`` of ``pucks`` (20, m), see :mod:`puck_tables.stopping.launch_lookup`.

    Of ``times`` (n,) and into ``out`` (6, n) those from ``begin`` to ``end`` alone.  ``which``
    (n,): puck each of them is of; (1,): all of one; (0,): of puck after puck, the first of which is
    that at ``begin``.  ``splines`` (2, cells + 3, 9 × 8).  Rows: x, y, heading from that at the
    launch, body angle, v, ω; at rest the angles are those of the stop.  Returns how many times are
    none, or negative.
    """
    flat, cells, room = splines.reshape(-1), float(splines.shape[1] - 3), np.empty(_ROWS * BLOCK)
    bad, held = 0, -1
    for start in range(begin, end, BLOCK):
        patience(1)
        count = min(BLOCK, end - start)
        held = gather(pucks, which, begin, start, count, BLOCK, held, room)
        moments = times[start : start + count]
        for n in range(count):
            into_row(room, _MOMENT, n, moments[n])
        bad += _find_places(room, count, cells)
        for n in range(count):
            tilt, at = row_of(room, _DELTA, n), int(row_of(room, _FIRST, n))
            s, weights = 2.0 * tilt * tilt - 1.0, basis(row_of(room, _INSIDE, n))
            f = spline_values(flat, at, weights, s, STOPS_WIDTH, HEIGHTS)
            into_row(room, _F_SHARE, n, f[0])
            into_row(room, _F_TIME, n, f[1])
            into_row(room, _F_ALONG, n, f[2])
            into_row(room, _F_ACROSS, n, f[3])
            into_row(room, _F_BODY, n, f[4])
            into_row(room, _F_TURN, n, f[5])
        _find_states(room, count)
        for row in range(STATE_ROWS):
            values, place = room[(_OUT + row) * BLOCK :], out[row, start : start + count]
            for n in range(count):
                place[n] = values[n]
    return bad


@inlined
def _find_places(room: FloatArray, count: int, cells: float) -> int:
    """Where on the curve the states are; how many of the times are none, or negative."""
    bad = 0
    for n in range(count):
        time, tilt = row_of(room, _MOMENT, n), row_of(room, _DELTA, n)
        bad += 0 if (time >= 0.0) & (time < math.inf) else 1
        left = 1.0 - time / row_of(room, _TIME, n)
        left = left if left > 0.0 else 0.0
        log_left = log_of(max(left, TINY))
        turning = row_of(room, _TURNING, n)
        is_fast, log_y, swung = place_after(
            log_left, row_of(room, _SIGN_N, n), row_of(room, _LOG_N, n), row_of(room, _KAPPA, n),
            turning, tilt,
        )  # fmt: skip
        y, xi = place_of_log(log_y)
        first, inside = cell_of(xi, is_fast, cells, _ROW)
        swung += turning * log_of(max(row_of(room, _T, n), TINY)) - row_of(room, _HEADING, n)
        into_row(room, _LEFT, n, left)
        into_row(room, _SHARE, n, y)
        into_row(room, _SWUNG, n, swung)
        into_row(room, _FAST, n, 1.0 if is_fast else 0.0)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    return bad


@inlined
def _find_states(room: FloatArray, count: int) -> None:
    """From functions to states, in the frame of the launch."""
    for n in range(count):
        spin, left, speed = (
            row_of(room, _SPIN, n), row_of(room, _LEFT, n), row_of(room, _V, n),
        )  # fmt: skip
        tilt, x, y = row_of(room, _DELTA, n), row_of(room, _X, n), row_of(room, _Y, n)
        body = row_of(room, _BODY, n)
        slip = row_of(room, _Q, n) * (left * row_of(room, _T, n) / row_of(room, _F_TIME, n))
        share = min(row_of(room, _SHARE, n) * row_of(room, _F_SHARE, n), 1.0)
        turn = row_of(room, _SWUNG, n) + tilt * row_of(room, _F_TURN, n)
        there = state_there(
            (row_of(room, _VX, n), row_of(room, _VY, n), spin, tilt, row_of(room, _DECEL, n),
             row_of(room, _RADIUS, n), speed), (x, y, body), row_of(room, _FAST, n) > 0.0, share,
            slip, turn if spin > 0.0 else -turn, rows_of(room, _F_ALONG, 3, n),
        )  # fmt: skip
        done = (1.0 - left) * (1.0 + left)
        in_between = (row_of(room, _SIGN_N, n) != 0.0) & (left > 0.0) & (left < 1.0)
        at_rest = row_of(room, _TURN, n) if left == 0.0 else 0.0
        into_row(room, _TO_X, n, there[0] if in_between else x * done)
        into_row(room, _TO_Y, n, there[1] if in_between else y * done)
        into_row(room, _TO_HEADING, n, there[2] if in_between else at_rest)
        into_row(room, _TO_ANGLE, n, there[3] if in_between else body * done)
        into_row(room, _TO_SPEED, n, there[4] if in_between else left * speed)
        into_row(room, _TO_SPIN, n, there[5] if in_between else left * spin)
