"""All that derivatives of states need of a launch, compiled: found once for all its moments."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    LINE,
    inlined,
    into_line,
    into_row,
    into_rows,
    look_up,
    patience,
    row_of,
    rows_of,
    spline_polynomials,
)
from puck_tables.kernels.elementary import logs_of
from puck_tables.stopping import similarity_lookup
from puck_tables.stopping.axes import CONSTANT_HEIGHTS
from puck_tables.stopping.launch_frame import rotated
from puck_tables.stopping.similarity_lookup import LAUNCH_COLUMNS
from puck_tables.stopping.similarity_rates import (
    A0,
    CURVE,
    CURVE_TILT,
    DECEL,
    DELTA,
    EAST,
    FACTS,
    FAST,
    FIXED,
    FIXED_ROWS,
    FOUND,
    H0,
    HERE,
    KAPPA,
    NORTH,
    ONE_KAPPA,
    ONE_TIME,
    ONE_V,
    PART,
    PUT,
    RADIUS,
    ROWS,
    SECTION_WIDTH,
    SHARE,
    SLIP,
    SPIN,
    STOP,
    T0,
    TURN_SLOPE,
    TURN_TILT,
    U0,
    UNIT,
    V0,
    find_functions,
    flow_at,
    of_stop,
    pole_at,
    turn_lines,
    turn_rate,
)
from puck_tables.stopping.state_splines import TINY
from puck_tables.stopping.stop_jacobian import direction, stop_by_speeds

_NEAR_LIMIT = 0.05  # of c − c₀
_CONSTANTS = 4  # c₀, κ, h₀/δ and another
_WITH_SLOPES = 2 * _CONSTANTS
_KAPPA, _H0 = FIXED + KAPPA, FIXED + H0
# rows that hold for a while what is known of pucks, and of their neighbours
_OF_PUCK = tuple(
    (row, row if row < LAUNCH_COLUMNS else LAUNCH_COLUMNS + known)
    for row, known in zip(
        (EAST, NORTH, SPIN, DELTA, DECEL, RADIUS, ONE_TIME, SLIP, UNIT),
        (
            0,
            0,
            0,
            0,
            0,
            0,
            similarity_lookup.TIME,
            similarity_lookup.SLIP,
            similarity_lookup.SPEED0,
        ),
        strict=True,
    )
)
_OF_NEIGHBOUR = (
    (V0, LAUNCH_COLUMNS + similarity_lookup.SPEED0), (A0, SPIN), (ONE_V, RADIUS),
    (U0, LAUNCH_COLUMNS + similarity_lookup.SLIP), (T0, LAUNCH_COLUMNS +
    similarity_lookup.T_LAUNCH), (_KAPPA, LAUNCH_COLUMNS + similarity_lookup.KAPPA),
    (_H0, LAUNCH_COLUMNS + similarity_lookup.TURNING),
)  # fmt: skip


@inlined
def fill_up(room: FloatArray, row: int, count: int) -> None:
    """Repeat the last of ``count`` numbers of a row up to a full block."""
    for n in range(count, PART):
        room[row * BLOCK + n] = room[row * BLOCK + count - 1]


@inlined
def fetch(pucks: FloatArray, natural: FloatArray, start: int, count: int, room: FloatArray) -> None:
    """What is known of ``count`` pucks from ``start`` on into the rows of a block."""
    for row, known in _OF_PUCK:
        values = pucks[known, start : start + count]
        for n in range(count):
            room[row * BLOCK + n] = values[n]
        fill_up(room, row, count)
    for row, known in _OF_NEIGHBOUR:
        values = natural[known, start : start + count]
        for n in range(count):
            room[row * BLOCK + n] = values[n]
        fill_up(room, row, count)


@inlined
def _find_fixed(room: FloatArray, constants: FloatArray) -> None:
    """The place of the launch, and what its height says."""
    for n in range(PART):
        delta = row_of(room, DELTA, n)
        s = 2.0 * delta * delta - 1.0
        found = spline_polynomials(constants, 0, (1.0,), s, _CONSTANTS, CONSTANT_HEIGHTS)
        into_line(room, PUT * BLOCK + _WITH_SLOPES * n, found)
    turn_lines(room, _WITH_SLOPES, FOUND)
    for n in range(PART):
        speed, slip = row_of(room, V0, n), row_of(room, U0, n)
        rim = abs(row_of(room, ONE_V, n) * row_of(room, A0, n))
        larger, smaller = max(speed, rim), min(speed, rim)
        into_row(room, SHARE, n, smaller / (0.5 * larger + 0.5 * smaller))
        into_row(room, FAST, n, 1.0 if rim > speed else 0.0)
        into_row(room, V0, n, speed / slip)
        into_row(room, A0, n, rim / slip)
        into_row(room, ONE_V, n, slip / speed)
        delta, found = row_of(room, DELTA, n), rows_of(room, FOUND, _WITH_SLOPES, n)
        kappa, h0, k = row_of(room, _KAPPA, n), row_of(room, _H0, n), 4.0 * delta
        c0, c0_tilt, k_tilt = found[0], k * found[4], k * found[5]
        h0_tilt = found[2] + delta * (k * found[6])
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
    find_functions(room, states, rates, states[:0], cells)
    for n in range(PART):
        c, s, delta = row_of(room, V0, n), row_of(room, A0, n), row_of(room, DELTA, n)
        share, found = row_of(room, SHARE, n), rows_of(room, FOUND, SECTION_WIDTH, n)
        is_fast = row_of(room, FAST, n) > 0.0
        fixed = rows_of(room, FIXED, FIXED_ROWS, n)
        log_near, log_far, _ = logs_of(max(share, TINY), 2.0 - share, 1.0)
        flow = flow_at(is_fast, share, log_near, log_far, delta, fixed, found)
        gap, below = pole_at(is_fast, share, fixed, found)
        rate, u0 = gap * (-fixed[KAPPA] / below), 1.0 / (c * s)
        bend = turn_rate(rate, c, s, delta, 1.0 / found[1], found)
        into_rows(room, U0, n, (u0, u0 / rate, below * -fixed[ONE_KAPPA]))
        far = 1.0 if abs(gap) > _NEAR_LIMIT else 0.0
        here = (
            flow[CURVE], flow[CURVE_TILT], flow[TURN_SLOPE] * u0, flow[TURN_TILT],
            bend * (u0 / rate), far,
        )  # fmt: skip
        into_rows(room, HERE, n, here)
        speed, spin = row_of(room, UNIT, n), row_of(room, SPIN, n)
        east, north = direction(row_of(room, EAST, n), row_of(room, NORTH, n), speed)
        around = 1.0 if spin >= 0.0 else -1.0
        own = stop_by_speeds(c, s, 1.0, c, s, delta, of_stop(found, delta))
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
    pucks: FloatArray, natural: FloatArray, constants: FloatArray, states: FloatArray,
    rates: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that derivatives of states need of launches, into ``out`` (49, m).

    ``pucks`` (20, m), see :func:`puck_tables.stopping.launch_lookup.fill_known`; ``natural``: the
    same, but with others beside them in place of exact pure motions; ``constants`` (14, 4), powers
    ascending.
    """
    patience(pucks.shape[1])
    cells, fixed = float(states.shape[1] - 3), constants.reshape(-1)
    of_state, of_rate, room = states.reshape(-1), rates.reshape(-1), np.empty(ROWS * BLOCK + LINE)
    room = room[-(room.ctypes.data // 8) % LINE :]  # from the beginning of a line of the cache on
    for start in range(0, pucks.shape[1], PART):
        count = min(PART, pucks.shape[1] - start)
        fetch(pucks, natural, start, count, room)
        find_facts(room, fixed, of_state, of_rate, cells)
        for row in range(FACTS):
            values, place = room[row * BLOCK :], out[row, start : start + count]
            for n in range(count):
                place[n] = values[n]
