"""What is known of launches, compiled: their stops, and where on the curve of all motions they are.

For many launches at once: see :mod:`puck_tables.stopping.similarity_lookup`, where it is said what
all of it is.
"""

from __future__ import annotations

import math

import numpy as np

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
from puck_tables.motion.path import TURN_SHARE
from puck_tables.stopping.launch_arrays import (
    DECEL,
    DELTA,
    RADIUS,
    SPIN,
    VX,
    VY,
    fetch_block,
    fill_constants,
)
from puck_tables.stopping.lookup import (
    EDGE,
    FIRST,
    HEIGHTS,
    INSIDE,
    LARGEST,
    PLACED,
    SLIP,
    SPEED,
    STOP_POWERS,
    WIDTH,
    place_block,
)
from puck_tables.stopping.similarity_lookup import (
    LAUNCH_COLUMNS,
    LAUNCH_ROWS,
    MOTION_WIDTH,
    TURN_POWERS,
    TURN_STEP,
    cell_of,
    constants_at,
    heading_at,
    number_at,
    place_after,
    place_of_log,
    share_of,
    stopped,
)
from puck_tables.stopping.state_lookup import PUCK_ROWS, fill_states_at

# numbers from one node to the next: of stops, of the curve, of turns
_ROW, _MOTION_ROW = WIDTH * STOP_POWERS, MOTION_WIDTH * HEIGHTS
_TURNS_ROW = TURN_STEP * TURN_POWERS
_REST, _ALL = 3, 6  # rows of what a stop has besides time and place, and with them
# rows of a block: the functions, those of the height, and what becomes of it
_F_TIME, _F_ALONG, _F_ACROSS, _F_BODY, _F_TURN, _F_LOG_RATIO, _F_LENGTH = range(PLACED, PLACED + 7)
_C0, _KAPPA, _TURNING, _QUARTER, _S = range(PLACED + 7, PLACED + 12)
_BEGUN, _SWUNG = PLACED + 12, PLACED + 13
_OUT = PLACED + 14  # from here on the rows of what is known
_ROWS = _OUT + LAUNCH_ROWS
_TIME, _X, _Y, _LENGTH, _BODY, _TURN = range(_OUT, _OUT + 6)
_Q, _V, _T, _LOG_N, _SIGN_N, _HEADING, _OWN_KAPPA, _OWN_TURNING = range(_OUT + 6, _ROWS)


@look_up
def fill_launch_lookup(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, stops: FloatArray, functions: FloatArray,
    turns: FloatArray, constants: FloatArray, turn_share: float, out: FloatArray,
) -> tuple[int, int]:  # fmt: skip
    """Launches, and what is known of them, into ``out`` (6 + 14, n).

    Or of a stop alone: time, x, y, path length, turn of heading and of the body (6, n); without
    time and place (3, n).  ``stops`` (2, cells + 3, 8 × 4) is a cut of the stop table,
    ``functions`` (2, cells + 3, 9 × 4) holds the other functions, ``turns`` (2, cells + 3, 12) the
    heading's regular part over the place by Q; ``constants`` (4, 14) as
    :func:`puck_tables.stopping.similarity_lookup.constants_at`.  Returns of how many Q²/J or
    Q²/(J r) may be too large, and how many are no launches.
    """
    patience(out.shape[1])
    flat, flat_functions, flat_turns = stops.reshape(-1), functions.reshape(-1), turns.reshape(-1)
    room, is_rest = np.empty(_ROWS * BLOCK), out.shape[0] == _REST
    cells, log_share = float(stops.shape[1] - 3), math.log(turn_share)
    fill_constants(vx, vy, spin, delta, decel, radius, out.shape[1], room)
    doubtful, bad = 0, 0
    for start in range(0, out.shape[1], BLOCK):
        count = min(BLOCK, out.shape[1] - start)
        fetch_block(vx, vy, step, spin, delta, decel, radius, start, count, room)
        bad += place_block(room, count, stops, _ROW)
        _find_constants(room, count, constants)
        for n in range(count):
            at = int(row_of(room, FIRST, n)) // _ROW * _MOTION_ROW
            s, weights = row_of(room, _S, n), basis(row_of(room, INSIDE, n))
            f = spline_values(flat_functions, at, weights, s, MOTION_WIDTH, HEIGHTS)
            into_row(room, _F_BODY, n, f[0])
            into_row(room, _F_TURN, n, f[1])
            into_row(room, _F_LOG_RATIO, n, f[2])
            into_row(room, _F_LENGTH, n, f[3])
        if is_rest:
            for n in range(count):
                into_row(room, _F_TIME, n, 1.0)
        else:
            for n in range(count):
                s, weights = row_of(room, _S, n), basis(row_of(room, INSIDE, n))
                f = spline_values(flat, int(row_of(room, FIRST, n)), weights, s, WIDTH, STOP_POWERS)
                into_row(room, _F_TIME, n, f[0])
                into_row(room, _F_ALONG, n, f[1])
                into_row(room, _F_ACROSS, n, f[2])
        doubtful += _find_stops(room, count)
        _find_places(room, count, cells, log_share)
        if out.shape[0] > _ALL:
            _find_numbers(room, count)
        for n in range(count):
            s, weights = row_of(room, _S, n), basis(row_of(room, INSIDE, n))
            s2 = s * s
            at = int(row_of(room, FIRST, n))
            f = spline_values(flat_turns, at, weights, s2 * s2, TURN_STEP, TURN_POWERS)
            into_row(room, _SWUNG, n, (f[0] + f[1] * s) + s2 * (f[2] + f[3] * s))
        _find_turns(room, count)
        for row in range(out.shape[0]):
            if out.shape[0] <= _ALL:
                first = _OUT + _ALL - out.shape[0] + row
                first = _TURN if first == _BODY else (_BODY if first == _TURN else first)
            else:
                first = row if row < LAUNCH_COLUMNS else row - LAUNCH_COLUMNS + _OUT
            values, place = room[first * BLOCK : (first + 1) * BLOCK], out[row, start:]
            for n in range(count):
                place[n] = values[n]
    return doubtful, bad


@look_up
def fill_states_of_one(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, stops: FloatArray, functions: FloatArray,
    turns: FloatArray, constants: FloatArray, splines: FloatArray, moments: FloatArray,
    out: FloatArray,
) -> int:  # fmt: skip
    """States at ``moments`` (n,) of the one launch into ``out`` (6, n).

    The other arguments and the rows are those of :func:`fill_launch_lookup` and
    :func:`puck_tables.stopping.state_lookup.fill_states_at`, the same to the last bit.  Returns
    how much of it may have to be refused: 0 if it is good.
    """
    puck = np.empty((PUCK_ROWS, 1))
    doubtful, bad = fill_launch_lookup(
        vx, vy, step, spin, delta, decel, radius, stops, functions, turns, constants, TURN_SHARE,
        puck,
    )  # fmt: skip
    which = np.zeros(1, np.int64)
    late = fill_states_at(puck, which, moments, 0, moments.size, splines, out)
    return doubtful + bad + late


@inlined
def _find_constants(room: FloatArray, count: int, constants: FloatArray) -> None:
    """c₀, κ, h₀, ln T(π/4) of the heights."""
    for n in range(count):
        tilt = row_of(room, DELTA, n)
        s = 2.0 * tilt * tilt - 1.0
        c0, kappa, turning, quarter = constants_at(constants, s)
        into_row(room, _S, n, s)
        into_row(room, _C0, n, c0)
        into_row(room, _KAPPA, n, kappa)
        into_row(room, _TURNING, n, turning * tilt)
        into_row(room, _QUARTER, n, quarter)


@inlined
def _find_stops(room: FloatArray, count: int) -> int:
    """Stop time, x, y, path, body angle, Q, T, v; how many may be too large for floating point."""
    doubtful = 0
    for n in range(count):
        vx, vy, rim = row_of(room, VX, n), row_of(room, VY, n), row_of(room, EDGE, n)
        speed, slip = row_of(room, SPEED, n), row_of(room, SLIP, n)
        decel = row_of(room, DECEL, n)
        f = rows_of(room, _F_TIME, 3, n)
        stops = stopped(
            vx, vy, rim, row_of(room, SPIN, n), speed, slip, row_of(room, DELTA, n), decel,
            (f[0], f[1], f[2], row_of(room, _F_BODY, n), row_of(room, _F_LENGTH, n)),
        )  # fmt: skip
        into_row(room, _TIME, n, stops[0])
        into_row(room, _X, n, stops[1])
        into_row(room, _Y, n, stops[2])
        into_row(room, _LENGTH, n, stops[3])
        into_row(room, _BODY, n, stops[4])
        into_row(room, _Q, n, slip)
        into_row(room, _V, n, speed)
        into_row(room, _T, n, stops[5])
        size = slip / decel * slip
        usual = (size < LARGEST) & (size < LARGEST * row_of(room, RADIUS, n))
        doubtful += 0 if usual else 1
    return doubtful


@inlined
def _find_places(room: FloatArray, count: int, cells: float, log_share: float) -> None:
    """Where on the curve the launches are, and where they will be when Q has fallen so far."""
    for n in range(count):
        speed = row_of(room, SPEED, n)
        rim = abs(row_of(room, EDGE, n))
        tilt = row_of(room, DELTA, n)
        c0, kappa = row_of(room, _C0, n), row_of(room, _KAPPA, n)
        turning = row_of(room, _TURNING, n)
        is_fast, share = rim > speed, share_of(speed, rim)
        sign, by_slip = number_at(is_fast, share, c0, kappa, tilt, row_of(room, _F_LOG_RATIO, n))
        heading = heading_at(is_fast, share, turning, tilt, row_of(room, _F_TURN, n))
        ends_fast, log_y, swung = place_after(log_share, sign, by_slip, kappa, turning, tilt)
        _, xi = place_of_log(log_y)
        first, inside = cell_of(xi, ends_fast, cells, _TURNS_ROW)
        constant = (speed == 0.0) | (rim == 0.0)
        into_row(room, FIRST, n, first)
        into_row(room, INSIDE, n, inside)
        into_row(room, _BEGUN, n, swung - heading)
        into_row(room, _LOG_N, n, by_slip)
        into_row(room, _SIGN_N, n, 0.0 if constant else sign)
        into_row(room, _HEADING, n, 0.0 if constant else heading)


@inlined
def _find_numbers(room: FloatArray, count: int) -> None:
    """ln|N|, and the constants of the heights, for states."""
    for n in range(count):
        kappa, quarter = row_of(room, _KAPPA, n), row_of(room, _QUARTER, n)
        log_n = row_of(room, _LOG_N, n) + kappa * (log_of(row_of(room, _T, n)) - quarter)
        into_row(room, _LOG_N, n, 0.0 if row_of(room, _SIGN_N, n) == 0.0 else log_n)
        into_row(room, _OWN_KAPPA, n, kappa)
        into_row(room, _OWN_TURNING, n, row_of(room, _TURNING, n))


@inlined
def _find_turns(room: FloatArray, count: int) -> None:
    """The turn of the heading until Q has fallen so far."""
    for n in range(count):
        rim = row_of(room, EDGE, n)
        swung = row_of(room, _BEGUN, n) + row_of(room, DELTA, n) * row_of(room, _SWUNG, n)
        constant = (row_of(room, SPEED, n) == 0.0) | (rim == 0.0)
        into_row(room, _TURN, n, 0.0 if constant else (swung if rim > 0.0 else -swung))
