"""Derivatives of states by look-up, compiled.

In natural units (Q = J = r = 1 at the launch, spin positive, start along x) a motion is a place u
on the curve of :mod:`puck_tables.stopping.similarity`, du/d ln Q = −ρ, and ln Q − g(u, δ) stays the
same along it, g_u = −1/ρ.  The time that is left is Q T(u, δ).  So a change of u at the launch, or
of δ, changes u at the same Q by

    u_p = ρ [δu/ρ (launch) + (g_δ − g_δ(launch)) δδ] .

ρ = (c − c₀) P with the ratio of c − c₀ here and at the launch from its logarithm: nothing is
divided by what vanishes for a launch at the limit ratio.  The heading is h₀ ln Q + Σ(u, δ), and
what is left of time and way is that of a stop from here, whose derivatives are known.  Where a
state stands on the curve its value says; the rest is the chain rule of all pucks
(:mod:`puck_tables.stopping.launch_derivatives`).

Exact pure sliding and pure spin have the derivatives of launches 1e-25 beside them: the first
derivatives are continuous there.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import (
    BLOCK,
    LINE,
    inlined,
    into_row,
    into_rows,
    look_up,
    patience,
    row_of,
    rows_of,
)
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, logs_of
from puck_tables.motion import state
from puck_tables.stopping.launch_derivatives import (
    PLACED_STATES,
    Numbers,
    at_same_time,
    by_launch,
    placed_state,
    rotated,
    stop_by_speeds,
)
from puck_tables.stopping.similarity_lookup import TINY
from puck_tables.stopping.similarity_rates import (
    AT_PLACE,
    C0_TILT,
    DECEL,
    DELTA,
    EAST,
    FACTS,
    FAST,
    FIXED,
    FIXED_ROWS,
    FROM_LAUNCH,
    FROM_LAUNCH_ROWS,
    H0_TILT,
    HERE,
    HERE_ROWS,
    K_TILT,
    KAPPA,
    LEFT,
    LOG_RATIO,
    LOG_TILT,
    MOMENT,
    NORTH,
    ONE_KAPPA,
    ONE_TIME,
    PART,
    PUT,
    RADIUS,
    ROWS,
    SECTION_WIDTH,
    SENSE,
    SHARE,
    SLIP,
    SPIN,
    STOP,
    STOP_ROWS,
    TURN_SLOPE,
    TURN_TILT,
    TURNED,
    UNIT,
    WORK,
    coefficients_at,
    fetch,
    fill_up,
    find_facts,
    find_functions,
    of_stop,
    pole_at,
    turn_rate,
)
from puck_tables.stopping.state_lookup import gather
from puck_tables.stopping.stop_jacobian import row_by_row

# rows of a block for what is found on the way
_RATES, _RATE_ROWS, _SLIP, _GAP, _POLE = WORK, 7, WORK + 2, WORK + 4, WORK + 5
_LOGS, _LOG_ROWS = WORK + 7, 3
_CHANGE, _CHANGE_ROWS, _DIRECTIONS = WORK + 10, 4, WORK + 14
_T0, _ONE_POLE = FROM_LAUNCH + 2, FROM_LAUNCH + 6
_T, _ALONG, _T_SLOPE = 0, 1, SECTION_WIDTH - 4  # of what is found at a place


@inlined
def _find_places(room: FloatArray) -> None:
    """What time is left, and where on the curve the states are: side and 2w.

    From speed and spin in the rows of those.
    """
    for n in range(PART):
        left = 1.0 - row_of(room, MOMENT, n) * row_of(room, ONE_TIME, n)
        speed, spin = row_of(room, SHARE, n), row_of(room, FAST, n)
        rim = abs(spin) * row_of(room, RADIUS, n)
        larger, smaller = max(speed, rim), min(speed, rim)
        both = 0.5 * larger + 0.5 * smaller
        into_row(room, LEFT, n, left if (larger > 0.0) & (left > 0.0) else 0.0)
        into_row(room, SHARE, n, smaller / (both if larger > 0.0 else 1.0))
        into_row(room, FAST, n, 1.0 if rim > speed else 0.0)


@inlined
def _find_rates(room: FloatArray) -> None:
    """Q, and how fast Q, u and the heading change, where the states are."""
    for n in range(PART):
        is_fast, share = row_of(room, FAST, n) > 0.0, row_of(room, SHARE, n)
        fixed = rows_of(room, FIXED, FIXED_ROWS, n)
        result = rows_of(room, AT_PLACE, SECTION_WIDTH, n)
        left, delta = row_of(room, LEFT, n), row_of(room, DELTA, n)
        small, large = 0.5 * share, 1.0 - 0.5 * share
        norm = 1.0 / math.sqrt(small * small + large * large)
        cosine, sine = norm * (small if is_fast else large), norm * (large if is_fast else small)
        t, to_go = result[_T], (left if left > 0.0 else 1.0) * row_of(room, _T0, n)
        t_slope = sine * (cosine * cosine) * result[_T_SLOPE]
        gap, below = pole_at(is_fast, share, fixed, result)
        # all that is divided by in one division: T − ρ T_u is this over what ρ has below it
        slope = t * below + fixed[KAPPA] * (gap * t_slope)
        one, other = to_go * t, below * slope
        inverse = 1.0 / ((one * result[_ALONG]) * other)
        one_along = inverse * (one * other)
        inverse *= result[_ALONG]
        one_below, one_slope = inverse * (one * slope), below * (below * (inverse * one))
        inverse *= other
        pole = -fixed[KAPPA] * one_below
        rate = gap * pole
        rates = (
            cosine, sine, to_go * (to_go * inverse), t * (t * inverse) * one_slope, gap, pole,
            turn_rate(rate, cosine, sine, delta, one_along, result),
        )  # fmt: skip
        into_rows(room, _RATES, n, rates)


@inlined
def _find_logs(room: FloatArray) -> None:
    """Logarithms of 2w, 2 − 2w and Q."""
    for n in range(PART):
        share = row_of(room, SHARE, n)
        logs = logs_of(max(share, TINY), 2.0 - share, row_of(room, _SLIP, n))
        into_rows(room, _LOGS, n, logs)


@inlined
def _find_coefficients(room: FloatArray) -> None:
    """What places on the curve change by, and which way the states turned."""
    for n in range(PART):
        is_fast, share = row_of(room, FAST, n) > 0.0, row_of(room, SHARE, n)
        fixed, here = rows_of(room, FIXED, FIXED_ROWS, n), rows_of(room, HERE, HERE_ROWS, n)
        log_near, log_far, log = rows_of(room, _LOGS, _LOG_ROWS, n)
        coefficients = coefficients_at(
            is_fast, share, log_near, log_far, row_of(room, DELTA, n), fixed,
            rows_of(room, AT_PLACE, SECTION_WIDTH, n),
        )  # fmt: skip
        pole = row_of(room, _POLE, n)
        ratio = exp_of(fixed[KAPPA] * log - (coefficients[LOG_RATIO] - here[0]))  # of c − c₀
        raised = fixed[C0_TILT] * ratio - fixed[C0_TILT]
        raised += row_of(room, _GAP, n) * (coefficients[LOG_TILT] - here[1] - fixed[K_TILT] * log)
        turned = coefficients[TURN_TILT] - here[3] + fixed[H0_TILT] * log
        # ρ over that at the launch
        flown = ratio * (pole * row_of(room, _ONE_POLE, n))
        into_rows(
            room,
            _CHANGE,
            n,
            (flown, raised * (pole * fixed[ONE_KAPPA]), coefficients[TURN_SLOPE], turned),
        )
    for n in range(PART):
        cosine, sine = cosine_sine_of(row_of(room, TURNED, n))
        directions = rotated(cosine, sine, row_of(room, EAST, n), row_of(room, NORTH, n))
        into_rows(room, _DIRECTIONS, n, directions)


@inlined
def _at_same_q(
    u: float, turn: float, tilt: float, stopped: tuple[float, float, float, float], around: float,
    moving: Numbers, own: Numbers,
) -> Numbers:  # fmt: skip
    """How u, heading, time, x, y and body angle change at the same Q, for ``at_same_time``.

    ``u``, ``turn``, ``tilt``: changes of u, of the heading, of δ; ``stopped``: of the stop: time,
    x, y, body angle; ``around``: −1 for clockwise spin, then the mirror image; ``own``: the stop
    from there.
    """
    time, x, y, body = stopped
    speed, rim, c, s, east, north, _, _, _ = moving
    v, a, aside = -speed * (s * (s * u)), rim * (c * (c * u)), speed * turn
    # what is left of the way
    along = own[5] * v + own[6] * a - own[8] * aside + own[7] * tilt
    left = around * (own[9] * v + own[10] * a + own[4] * aside + own[11] * tilt)
    return (
        u, around * turn, time - (own[1] * v + own[2] * a + own[3] * tilt),
        x - (along * east - left * north), y - (along * north + left * east),
        body - (own[17] * v + own[18] * a + own[19] * tilt),
    )  # fmt: skip


@inlined
def _state_slopes(
    left: float, delta: float, around: float, launch_row: Numbers, here: Numbers, stop: Numbers,
    result: Numbers, rates: Numbers, coefficients: Numbers, directions: Numbers,
) -> Numbers:  # fmt: skip
    """A state and its derivatives along x and y, six rows of six, see ``by_launch``.

    Where the share ``left`` of time is left: 0 at rest.
    """
    speed0, rim0, t0, one_speed, u0, begun, _ = launch_row
    cosine, sine, slip, fall, gap, pole, swing = rates
    flown, raised, turn_slope, turned = coefficients
    _, _, turn0, _, far0, is_far = here
    slip *= 1.0 if left > 0.0 else 0.0  # at rest that of the stop alone
    speed, rim = slip * cosine, slip * sine
    own = stop_by_speeds(speed, rim, slip, cosine, sine, delta, of_stop(result, delta))
    ex, ey = directions
    moving = speed, rim, cosine, sine, ex, ey, fall, gap * pole, around * swing
    u = flown * u0
    turn = far0 - swing * begun if is_far > 0.0 else turn_slope * u - turn0
    ahead, aside = speed * own[4], around * (speed * own[8])
    value = (
        speed0 * stop[2] - (ahead * ex - aside * ey), speed0 * stop[5] - (ahead * ey + aside * ex),
        stop[8] - own[16], speed * ex, speed * ey, rim,
    )  # fmt: skip
    by_angle = (stop[0], stop[3], stop[6], stop[9])
    by_height = (stop[1], stop[4], stop[7], stop[10])
    tilted = turn_slope * raised + turned
    return by_launch(
        speed0, rim0, one_speed, (1.0 - left) * t0, value,
        at_same_time(_at_same_q(u, turn, 0.0, by_angle, around, moving, own), moving),
        at_same_time(_at_same_q(raised, tilted, 1.0, by_height, around, moving, own), moving),
        at_same_time((0.0, 0.0, -1.0, 0.0, 0.0, 0.0), moving),
    )  # fmt: skip


@inlined
def _find_jacobians(room: FloatArray) -> None:
    """Derivatives of a block of states from what is known of their launches and places.

    In loops of their own: of one as long the machine sees too little at once, and waits.
    """
    _find_rates(room)
    _find_logs(room)
    _find_coefficients(room)
    for n in range(PART):
        spin = row_of(room, SPIN, n)
        around = 1.0 if spin >= 0.0 else -1.0
        own = _state_slopes(
            row_of(room, LEFT, n), row_of(room, DELTA, n), around,
            rows_of(room, FROM_LAUNCH, FROM_LAUNCH_ROWS, n), rows_of(room, HERE, HERE_ROWS, n),
            rows_of(room, STOP, STOP_ROWS, n), rows_of(room, AT_PLACE, SECTION_WIDTH, n),
            rows_of(room, _RATES, _RATE_ROWS, n), rows_of(room, _CHANGE, _CHANGE_ROWS, n),
            rows_of(room, _DIRECTIONS, 2, n),
        )  # fmt: skip
        placed = placed_state(
            row_of(room, EAST, n), row_of(room, NORTH, n), around, spin, row_of(room, DECEL, n),
            row_of(room, UNIT, n), row_of(room, RADIUS, n), row_of(room, SENSE, n),
            row_of(room, SLIP, n), row_of(room, MOMENT, n), own,
        )  # fmt: skip
        into_rows(room, PUT, n, placed)


@look_up
def fill_state_jacobians(
    pucks: FloatArray, generic: FloatArray, constants: FloatArray, facts: FloatArray,
    which: npt.NDArray[np.int64], times: FloatArray, states: FloatArray, begin: int, end: int,
    of_state: FloatArray, of_rate: FloatArray, streamed: bool, out: FloatArray,
) -> None:  # fmt: skip
    """Derivatives of states into ``out`` (n, 6, 7).

    At ``times`` (n,) ≥ 0, from ``begin`` to ``end``, as in
    :func:`puck_tables.stopping.state_lookup.fill_states_at`, whose ``states`` (6, n) are needed;
    of pucks ``which`` of ``facts`` (49, m), or, where ``which`` is empty, of ``pucks``, see
    :func:`puck_tables.stopping.similarity_rates.fill_launch_facts`.
    Derivatives of x, y, body angle, vx, vy, ω by vx, vy, ω, δ, J, r, time; from the stop on those
    of the stop.
    """
    cells, fixed, held = float(of_state.shape[1] - 3), constants.reshape(-1), -1
    splines, rates = of_state.reshape(-1), of_rate.reshape(-1)
    numbers, room = out.reshape(-1), np.empty(ROWS * BLOCK + LINE)
    room = room[-(room.ctypes.data // 8) % LINE :]  # from the beginning of a line of the cache on
    for start in range(begin, end, PART):
        patience(1)
        count = min(PART, end - start)
        if which.size:
            held = gather(facts, which, begin, start, count, PART, held, room)
            for row in range(FACTS if held < 0 else 0):
                fill_up(room, row, count)
        else:
            fetch(pucks, generic, start - begin, count, room)
            find_facts(room, fixed, splines, rates, cells)
        moments, headings = times[start:], states[state.HEADING, start:]
        speeds, spins = states[state.SPEED, start:], states[state.SPIN, start:]
        for n in range(count):
            into_row(room, MOMENT, n, moments[n])
            into_rows(room, TURNED, n, (headings[n], speeds[n], spins[n]))
        for row in (MOMENT, TURNED, SHARE, FAST):
            fill_up(room, row, count)
        _find_places(room)
        find_functions(room, splines, rates, cells)
        _find_jacobians(room)
        row_by_row(room, PUT, PLACED_STATES, count, numbers, start, streamed)
