"""What the motion does at a place of the curve, for derivatives of states, compiled.

Functions of :mod:`puck_tables.stopping.slopes` are looked up for a block of places, in rows of one
array; what follows from them is done for several places at once.  Every block is full (the last
place is repeated), so that each number is computed alike wherever it stands.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    inlined,
    inner,
    into_line,
    into_row,
    kernel,
    patience,
    row_of,
    spline_slopes,
    spline_values,
    turn_square,
    weighted_rows,
)
from puck_tables.kernels.spline import basis
from puck_tables.stopping.axes import HEIGHTS
from puck_tables.stopping.launch_frame import PLACED_STATES
from puck_tables.stopping.slopes import RATE_WIDTH, STATE_WIDTH, STOP_POWERS
from puck_tables.stopping.state_splines import cell_of
from puck_tables.stopping.stop_jacobian import Numbers

PART = 32  # places of a block: with so many rows the nearest cache holds no more
_SHARED = 2  # rows for each place for which it pays to have them evaluated once
_STATE_ROW, _RATE_ROW = HEIGHTS * STATE_WIDTH, STOP_POWERS * RATE_WIDTH
SECTION_WIDTH = 2 * STATE_WIDTH + RATE_WIDTH

# rows of a block: what is known of a launch: its puck, its place on the curve in natural units
EAST, NORTH, SPIN, DELTA, DECEL, RADIUS, ONE_TIME, SLIP, UNIT, BEND = range(10)
LAUNCHED, LAUNCHED_ROWS = 10, 7  # the first row, and how many: of the launch itself
V0, A0, T0, ONE_V, U0, BEGUN, ONE_POLE = range(LAUNCHED, LAUNCHED + LAUNCHED_ROWS)
# of its height: constants of the curve, their derivatives by δ, and factors of what is at its ends
FIXED, FIXED_ROWS = 17, 15
KAPPA, H0, C0, K_TILT, H0_TILT, C0_TILT, ONE_KAPPA = range(7)
LOG_SLOW, LOG_FAST, TILT_SLOW, TILT_FAST, TURN_SLOW, TURN_FAST, BEND_SLOW, BEND_FAST = range(7, 15)
# what was where it began, and its stop
HERE, HERE_ROWS = 32, 6
STOP, STOP_ROWS = 38, 11  # the first row, and how many: of its stop
FACTS = STOP + STOP_ROWS
# where a state is, what stands there, and its derivatives
MOMENT, LEFT, TURNED, SHARE, FAST, _FIRST, _INSIDE = range(FACTS, FACTS + 7)
FOUND = FACTS + 7
WORK, WORK_ROWS = FOUND + SECTION_WIDTH, 18
PUT = WORK + WORK_ROWS
_NEAR = PUT + PLACED_STATES  # from here on rows of the table next to a block of places
ROWS = PUT + 2 * PLACED_STATES
# the functions found at a place
_T, _ALONG, _ACROSS, _BODY, _CURVE, _TURN, _CURVE_SLOPE, _TURN_SLOPE = range(STATE_WIDTH)
_BY_S, _D = STATE_WIDTH, 2 * STATE_WIDTH
# what the motion does there
CURVE, CURVE_TILT, TURN_SLOPE, TURN_TILT = range(4)


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


@kernel
def fill_section(delta: float, states: FloatArray, rates: FloatArray, out: FloatArray) -> None:
    """The functions of one height into ``out`` (2, cells + 3, 20)."""
    of_state, of_rate, flat = states.reshape(-1), rates.reshape(-1), out.reshape(-1)
    for row in range(flat.size // SECTION_WIDTH):
        patience(1)
        found = _functions(of_state, of_rate, row, (1.0,), delta)
        into_line(flat, SECTION_WIDTH * row, found)


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
        found = _functions(states, rates, cell, weights, row_of(room, DELTA, n))
        into_line(room, PUT * BLOCK + SECTION_WIDTH * n, found)


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
        found = _functions(states, rates, near + row, (1.0,), row_of(room, DELTA, begin))
        into_line(room, _NEAR * BLOCK + SECTION_WIDTH * row, found)
    for n in range(begin, end):
        cell, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
        first = _NEAR * BLOCK + SECTION_WIDTH * (cell - near)
        values = weighted_rows(room, first, weights, SECTION_WIDTH)
        into_line(room, PUT * BLOCK + SECTION_WIDTH * n, values)


@inner
def find_functions(
    room: FloatArray, states: FloatArray, rates: FloatArray, section: FloatArray, cells: float
) -> None:
    """The functions where the rows say: fast or not, and 2w.

    From the table, or from its ``section`` if there is one: to the same bits.
    """
    for n in range(PART):
        # 1 − ξ from 2w: exact to √ε only where all slopes by ξ vanish
        q = math.sqrt(math.sqrt(row_of(room, SHARE, n)))
        first, inside = cell_of(1.0 - math.sqrt(1.0 - q), row_of(room, FAST, n) > 0.0, cells, 1)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    if section.size:
        for n in range(PART):
            cell, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
            found = weighted_rows(section, SECTION_WIDTH * cell, weights, SECTION_WIDTH)
            into_line(room, PUT * BLOCK + SECTION_WIDTH * n, found)
        turn_lines(room, SECTION_WIDTH, FOUND)
        return
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
    turn_lines(room, SECTION_WIDTH, FOUND)


@inlined
def of_stop(found: Numbers, delta: float) -> Numbers:
    """What :func:`puck_tables.stopping.stop_jacobian.stop_by_speeds` reads; of the path nothing."""
    k = 4.0 * delta
    return (
        found[_T], found[_ALONG], found[_ACROSS], found[_BODY], 0.0,
        found[_D + _T], found[_D + _ALONG], found[_D + _ACROSS], found[_D + _BODY], 0.0,
        k * found[_BY_S + _T], k * found[_BY_S + _ALONG], k * found[_BY_S + _ACROSS],
        k * found[_BY_S + _BODY], 0.0,
    )  # fmt: skip


@inlined
def pole_at(is_fast: bool, share: float, fixed: Numbers, f: Numbers) -> tuple[float, float]:
    """C − c₀ and −κ/P, from the functions at a place of the curve: ρ = (c − c₀) P."""
    plus, minus = (2.0 - share, share) if is_fast else (share, 2.0 - share)  # 1 + c and 1 − c
    gap = (1.0 - share if is_fast else share - 1.0) - fixed[C0]
    ends = 0.5 * (minus * fixed[LOG_SLOW] - plus * fixed[LOG_FAST])
    return gap, 0.5 * plus * minus + gap * (f[_CURVE_SLOPE] - ends)


@inlined
def flow_at(
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
        f[_CURVE] - (log_plus * fixed[LOG_SLOW] + log_minus * fixed[LOG_FAST]),
        k * f[_BY_S + _CURVE] + (log_plus * fixed[TILT_SLOW] + log_minus * fixed[TILT_FAST]),
        minus * fixed[BEND_SLOW] - plus * fixed[BEND_FAST] + delta * f[_TURN_SLOPE],
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
