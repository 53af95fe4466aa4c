"""What the motion does at a place of the curve, and all that is known of a launch, compiled.

For derivatives of states: of a launch it is found once for all its moments.  Functions of
:mod:`puck_tables.stopping.slopes` are looked up for a block of places, in rows of one array; what
follows from them is done for several places at once.  Every block is full (the last place is
repeated), so that each number is computed alike wherever it stands.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    LINE,
    inlined,
    inner,
    into_line,
    into_row,
    into_rows,
    look_up,
    patience,
    row_of,
    rows_of,
    spline_polynomials,
    spline_slopes,
    spline_values,
    turn_square,
    weighted_rows,
)
from puck_tables.kernels.elementary import logs_of
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping import similarity_lookup as known
from puck_tables.stopping.launch_derivatives import (
    PLACED_STATES,
    Numbers,
    direction,
    rotated,
    stop_by_speeds,
)
from puck_tables.stopping.lookup import CONSTANT_HEIGHTS, HEIGHTS
from puck_tables.stopping.similarity_lookup import LAUNCH_COLUMNS, TINY, cell_of
from puck_tables.stopping.slopes import RATE_WIDTH, STATE_WIDTH, STOP_POWERS

PART = 32  # places of a block: with so many rows the nearest cache holds no more
_SHARED = 2  # rows for each place for which it pays to have them evaluated once
# numbers of a node: of states, of rates
_STATE_ROW, _RATE_ROW = HEIGHTS * STATE_WIDTH, STOP_POWERS * RATE_WIDTH
SECTION_WIDTH = 2 * STATE_WIDTH + RATE_WIDTH  # numbers found at a place: states, slopes, rates

# rows of a block: what is known of a launch: its puck, its place on the curve in natural units
EAST, NORTH, SPIN, DELTA, DECEL, RADIUS, ONE_TIME, SLIP, UNIT, SENSE = range(10)
FROM_LAUNCH, FROM_LAUNCH_ROWS = 10, 7  # the first row, and how many: of the launch itself
V0, A0, T0, ONE_V, U0, BEGUN, ONE_POLE = range(FROM_LAUNCH, FROM_LAUNCH + FROM_LAUNCH_ROWS)
# of its height: constants of the curve, their derivatives by δ, and factors of what is at its ends
FIXED, FIXED_ROWS = 17, 15
KAPPA, H0, C0, K_TILT, H0_TILT, C0_TILT, ONE_KAPPA = range(7)
LOG_SLOW, LOG_FAST, TILT_SLOW, TILT_FAST, TURN_SLOW, TURN_FAST, HEADING_SLOW, HEADING_FAST = range(
    7, 15
)
# what was where it began, and its stop
HERE, HERE_ROWS = 32, 6
STOP, STOP_ROWS = 38, 11  # the first row, and how many: of its stop
FACTS = STOP + STOP_ROWS
# where a state is, what stands there, and its derivatives
MOMENT, LEFT, TURNED, SHARE, FAST, _FIRST, _INSIDE = range(FACTS, FACTS + 7)
AT_PLACE = FACTS + 7
WORK, WORK_ROWS = AT_PLACE + SECTION_WIDTH, 16
PUT = WORK + WORK_ROWS
_NEAR = PUT + PLACED_STATES  # from here on rows of the table next to a block of places
ROWS = PUT + 2 * PLACED_STATES
# the functions found at a place
_T, _ALONG, _ACROSS, _BODY, _LOG_RATIO, _TURN, _LOG_SLOPE, _TURN_SLOPE = range(STATE_WIDTH)
_BY_S, _D = STATE_WIDTH, 2 * STATE_WIDTH
# what the motion does there
LOG_RATIO, LOG_TILT, TURN_SLOPE, TURN_TILT = range(4)

_NEAR_LIMIT = 0.05  # of c − c₀
_CONSTANTS = 4  # c₀, κ, h₀/δ and another
_WITH_SLOPES = 2 * _CONSTANTS  # the four, then their slopes by δ
_KAPPA, _H0 = FIXED + KAPPA, FIXED + H0  # their rows
# rows that hold for a while what is known of pucks, and of their neighbours
_OF_PUCK = (
    *enumerate(range(LAUNCH_COLUMNS)), (ONE_TIME, LAUNCH_COLUMNS + known.TIME),
    (SLIP, LAUNCH_COLUMNS + known.SLIP), (UNIT, LAUNCH_COLUMNS + known.SPEED0),
)  # fmt: skip
_OF_NEIGHBOUR = (
    (V0, LAUNCH_COLUMNS + known.SPEED0), (A0, SPIN), (ONE_V, RADIUS),
    (U0, LAUNCH_COLUMNS + known.SLIP), (T0, LAUNCH_COLUMNS + known.T_LAUNCH),
    (_KAPPA, LAUNCH_COLUMNS + known.KAPPA), (_H0, LAUNCH_COLUMNS + known.TURNING),
)  # fmt: skip


@inlined
def _functions(
    states: FloatArray, rates: FloatArray, cell: int, weights: Numbers, delta: float
) -> Numbers:
    """The functions (8) and their derivatives by s = 2δ² − 1 (8), D of the first four."""
    s = 2.0 * delta * delta - 1.0
    return (
        *spline_slopes(states, _STATE_ROW * cell, weights, s, STATE_WIDTH, HEIGHTS),
        *spline_values(rates, _RATE_ROW * cell, weights, s, RATE_WIDTH, STOP_POWERS),
    )


@inlined
def turn_lines(room: FloatArray, width: int, row: int) -> None:
    """Lines of ``width`` numbers, one a place, behind ``PUT``, to rows from one on."""
    for n in range(0, PART, 4):
        for k in range(0, width, 4):
            at, goal = PUT * BLOCK + width * n + k, (row + k) * BLOCK + n
            turn_square(room, at, width, room, goal, BLOCK)


@inlined
def _each_by_itself(
    room: FloatArray, states: FloatArray, rates: FloatArray, begin: int, end: int
) -> None:
    """The functions of places from the table."""
    for n in range(begin, end):
        cell, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
        result = _functions(states, rates, cell, weights, row_of(room, DELTA, n))
        into_line(room, PUT * BLOCK + SECTION_WIDTH * n, result)


@inlined
def _of_one_height(
    room: FloatArray, states: FloatArray, rates: FloatArray, begin: int, end: int
) -> None:
    """The functions of places of one height, from rows that they share if that are few."""
    low, high = row_of(room, _FIRST, begin), row_of(room, _FIRST, begin)
    for n in range(begin, end):
        low, high = min(low, row_of(room, _FIRST, n)), max(high, row_of(room, _FIRST, n))
    near, count = int(low), int(high) - int(low) + 4
    if count > _SHARED * (end - begin):
        _each_by_itself(room, states, rates, begin, end)
        return
    for row in range(count):
        result = _functions(states, rates, near + row, (1.0,), row_of(room, DELTA, begin))
        into_line(room, _NEAR * BLOCK + SECTION_WIDTH * row, result)
    for n in range(begin, end):
        cell, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
        first = _NEAR * BLOCK + SECTION_WIDTH * (cell - near)
        values = weighted_rows(room, first, weights, SECTION_WIDTH)
        into_line(room, PUT * BLOCK + SECTION_WIDTH * n, values)


@inner
def find_functions(room: FloatArray, states: FloatArray, rates: FloatArray, cells: float) -> None:
    """The functions where the rows say: fast or not, and 2w."""
    for n in range(PART):
        # 1 − ξ from 2w: exact to √ε only where all slopes by ξ vanish
        q = math.sqrt(math.sqrt(row_of(room, SHARE, n)))
        first, inside = cell_of(1.0 - math.sqrt(1.0 - q), row_of(room, FAST, n) > 0.0, cells, 1)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    alike = 0
    for n in range(PART - 1):
        alike += 1 if row_of(room, DELTA, n) == row_of(room, DELTA, n + 1) else 0
    if alike < PART // 2:
        _each_by_itself(room, states, rates, 0, PART)
    else:
        begin = 0
        for end in range(1, PART + 1):
            if end == PART or row_of(room, DELTA, end) != row_of(room, DELTA, begin):
                _of_one_height(room, states, rates, begin, end)
                begin = end
    turn_lines(room, SECTION_WIDTH, AT_PLACE)


@inlined
def of_stop(result: Numbers, delta: float) -> Numbers:
    """What ``stop_by_speeds`` reads; of the path nothing."""
    k = 4.0 * delta
    return (
        result[_T], result[_ALONG], result[_ACROSS], result[_BODY], 0.0,
        result[_D + _T], result[_D + _ALONG], result[_D + _ACROSS], result[_D + _BODY], 0.0,
        k * result[_BY_S + _T], k * result[_BY_S + _ALONG], k * result[_BY_S + _ACROSS],
        k * result[_BY_S + _BODY], 0.0,
    )  # fmt: skip


@inlined
def pole_at(is_fast: bool, share: float, fixed: Numbers, f: Numbers) -> tuple[float, float]:
    """C − c₀ and −κ/P, from the functions at a place of the curve: ρ = (c − c₀) P."""
    plus, minus = (2.0 - share, share) if is_fast else (share, 2.0 - share)  # 1 + c and 1 − c
    gap = (1.0 - share if is_fast else share - 1.0) - fixed[C0]
    ends = 0.5 * (minus * fixed[LOG_SLOW] - plus * fixed[LOG_FAST])
    return gap, 0.5 * plus * minus + gap * (f[_LOG_SLOPE] - ends)


@inlined
def coefficients_at(
    is_fast: bool, share: float, log_near: float, log_far: float, delta: float, fixed: Numbers,
    f: Numbers,
) -> Numbers:  # fmt: skip
    """What the motion does at a place of the curve (4), from the functions there.

    κ g without its pole, and the derivative of that by δ; Σ_u and Σ_δ.
    """
    k, near, far = 4.0 * delta, share, 2.0 - share
    log_plus, log_minus = (log_far, log_near) if is_fast else (log_near, log_far)
    plus, minus = (far, near) if is_fast else (near, far)
    return (
        f[_LOG_RATIO] - (log_plus * fixed[LOG_SLOW] + log_minus * fixed[LOG_FAST]),
        k * f[_BY_S + _LOG_RATIO] + (log_plus * fixed[TILT_SLOW] + log_minus * fixed[TILT_FAST]),
        minus * fixed[HEADING_SLOW] - plus * fixed[HEADING_FAST] + delta * f[_TURN_SLOPE],
        log_plus * fixed[TURN_SLOW] + log_minus * fixed[TURN_FAST]
        + (f[_TURN] + delta * (k * f[_BY_S + _TURN])),
    )  # fmt: skip


@inlined
def turn_rate(
    rate: float, cosine: float, sine: float, delta: float, one_along: float, f: Numbers
) -> float:
    """H: how fast the heading turns, δ sin φ H, against ln Q; ``rate``: ρ; ``one_along``: 1/α."""
    across = f[_ACROSS]
    rise = sine * cosine * cosine * f[_D + _ACROSS] + (cosine * cosine - sine * sine) * across
    return delta * sine * ((rate * rise - 2.0 * across) * one_along)


@inlined
def fill_up(room: FloatArray, row: int, count: int) -> None:
    """Repeat the last of ``count`` numbers of a row up to a full block."""
    for n in range(count, PART):
        room[row * BLOCK + n] = room[row * BLOCK + count - 1]


@inlined
def fetch(pucks: FloatArray, generic: FloatArray, start: int, count: int, room: FloatArray) -> None:
    """What is known of ``count`` pucks from ``start`` on into the rows of a block."""
    for row, own in _OF_PUCK:
        values = pucks[own, start : start + count]
        for n in range(count):
            room[row * BLOCK + n] = values[n]
        fill_up(room, row, count)
    for row, own in _OF_NEIGHBOUR:
        values = generic[own, start : start + count]
        for n in range(count):
            room[row * BLOCK + n] = values[n]
        fill_up(room, row, count)


@inlined
def _find_fixed(room: FloatArray, constants: FloatArray) -> None:
    """The place of the launch, and what its height says."""
    for n in range(PART):
        delta = row_of(room, DELTA, n)
        s = 2.0 * delta * delta - 1.0
        result = spline_polynomials(constants, 0, (1.0,), s, _CONSTANTS, CONSTANT_HEIGHTS)
        into_line(room, PUT * BLOCK + _WITH_SLOPES * n, result)
    turn_lines(room, _WITH_SLOPES, AT_PLACE)
    for n in range(PART):
        speed, slip = row_of(room, V0, n), row_of(room, U0, n)
        rim = abs(row_of(room, ONE_V, n) * row_of(room, A0, n))
        larger, smaller = max(speed, rim), min(speed, rim)
        into_row(room, SHARE, n, smaller / (0.5 * larger + 0.5 * smaller))
        into_row(room, FAST, n, 1.0 if rim > speed else 0.0)
        into_row(room, V0, n, speed / slip)
        into_row(room, A0, n, rim / slip)
        into_row(room, ONE_V, n, slip / speed)
        delta, result = row_of(room, DELTA, n), rows_of(room, AT_PLACE, _WITH_SLOPES, n)
        kappa, h0, k = row_of(room, _KAPPA, n), row_of(room, _H0, n), 4.0 * delta
        c0, c0_tilt, k_tilt = result[0], k * result[4], k * result[5]
        h0_tilt = result[2] + delta * (k * result[6])
        # 1/A, 1/B and h₁, and derivatives by δ of A, B and h₁
        d2 = delta * delta
        below, inverse = 36.0 + 4.0 * d2, 1.0 / (36.0 + 4.0 * d2)
        one_slow, one_fast, h1 = 8.0 / (4.0 + d2), below / (9.0 + 4.0 * d2), 9.0 * delta / below
        by_slow, by_fast = 0.25 * delta, 216.0 * delta * (inverse * inverse)
        by_h1, rest = (9.0 - 72.0 * d2 * inverse) / below, h0 - h1
        fixed = (
            kappa, h0, c0, k_tilt, h0_tilt, c0_tilt, 1.0 / kappa, kappa * one_slow,
            kappa * one_fast, (kappa * (by_slow * one_slow) - k_tilt) * one_slow,
            (kappa * (by_fast * one_fast) - k_tilt) * one_fast,
            (h0_tilt - h0 * (one_slow * by_slow)) * one_slow,
            (h0_tilt - by_h1 - rest * (one_fast * by_fast)) * one_fast,
            0.5 * h0 * one_slow, 0.5 * rest * one_fast,
        )  # fmt: skip
        into_rows(room, FIXED, n, fixed)


@inlined
def find_facts(
    room: FloatArray, constants: FloatArray, states: FloatArray, rates: FloatArray, cells: float
) -> None:
    """All facts of a block of launches, from what was fetched."""
    _find_fixed(room, constants)
    find_functions(room, states, rates, cells)
    for n in range(PART):
        c, s, delta = row_of(room, V0, n), row_of(room, A0, n), row_of(room, DELTA, n)
        share, result = row_of(room, SHARE, n), rows_of(room, AT_PLACE, SECTION_WIDTH, n)
        is_fast = row_of(room, FAST, n) > 0.0
        fixed = rows_of(room, FIXED, FIXED_ROWS, n)
        log_near, log_far, _ = logs_of(max(share, TINY), 2.0 - share, 1.0)
        coefficients = coefficients_at(is_fast, share, log_near, log_far, delta, fixed, result)
        gap, below = pole_at(is_fast, share, fixed, result)
        rate, u0 = gap * (-fixed[KAPPA] / below), 1.0 / (c * s)
        deflection = turn_rate(rate, c, s, delta, 1.0 / result[1], result)
        into_rows(room, U0, n, (u0, u0 / rate, below * -fixed[ONE_KAPPA]))
        far = 1.0 if abs(gap) > _NEAR_LIMIT else 0.0
        here = (
            coefficients[LOG_RATIO], coefficients[LOG_TILT], coefficients[TURN_SLOPE] * u0,
            coefficients[TURN_TILT], deflection * (u0 / rate), far,
        )  # fmt: skip
        into_rows(room, HERE, n, here)
        speed, spin = row_of(room, UNIT, n), row_of(room, SPIN, n)
        east, north = direction(row_of(room, EAST, n), row_of(room, NORTH, n), speed)
        around = 1.0 if spin >= 0.0 else -1.0
        own = stop_by_speeds(c, s, 1.0, c, s, delta, of_stop(result, delta))
        x, y = rotated(own[4], around * own[8], east, north)
        x1, y1 = rotated(c * own[6] - s * own[5], around * (c * own[10] - s * own[9]), east, north)
        x4, y4 = rotated(own[7], around * own[11], east, north)
        stopped = (
            c * own[2] - s * own[1], own[3], x, x1, x4, y, y1, y4,
            own[16], c * own[18] - s * own[17], own[19],
        )  # fmt: skip
        into_rows(room, STOP, n, stopped)
        into_rows(room, EAST, n, (east, north))
        more = (
            1.0 / row_of(room, ONE_TIME, n), row_of(room, SLIP, n), 1.0 / row_of(room, DECEL, n),
            1.0 / row_of(room, RADIUS, n),
        )  # fmt: skip
        into_rows(room, ONE_TIME, n, more)


@look_up
def fill_launch_facts(
    pucks: FloatArray, generic: FloatArray, constants: FloatArray, states: FloatArray,
    rates: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that derivatives of states need of launches, into ``out`` (49, m).

    ``pucks`` (20, m), see :func:`puck_tables.stopping.launch_lookup.fill_launch_lookup`;
    ``generic``: the same, but with others beside them in place of exact pure motions; ``constants``
    (14, 4), powers ascending.
    """
    patience(pucks.shape[1])
    cells, fixed = float(states.shape[1] - 3), constants.reshape(-1)
    of_state, of_rate, room = states.reshape(-1), rates.reshape(-1), np.empty(ROWS * BLOCK + LINE)
    room = room[-(room.ctypes.data // 8) % LINE :]  # from the beginning of a line of the cache on
    for start in range(0, pucks.shape[1], PART):
        count = min(PART, pucks.shape[1] - start)
        fetch(pucks, generic, start, count, room)
        find_facts(room, fixed, of_state, of_rate, cells)
        for row in range(FACTS):
            values, place = room[row * BLOCK :], out[row, start : start + count]
            for n in range(count):
                place[n] = values[n]
