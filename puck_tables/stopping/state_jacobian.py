"""Derivatives of states by look-up, compiled.

In natural units (Q = J = r = 1 at the launch, spin positive, start along x) a motion is a place u
on the curve of :mod:`puck_tables.stopping.similarity`, du/d ln Q = −ρ, and ln Q − g(u, δ) stays the
same along it, g_u = −1/ρ.  The time that is left is Q T(u, δ).  So a change of slip angle or
height, with changes of u at the launch, and of its stop time t₀, changes the state at the time t by

    δu = (T Y − ρ W)/M,    δ ln Q = (W − T_u Y)/M,    M = T − ρ T_u,
    W = δt₀/Q − T_δ δδ,    Y = ρ [δu/ρ (launch) + (g_δ − g_δ(launch)) δδ] .

ρ = (c − c₀) P with the ratio of c − c₀ here and at the launch from its logarithm: nothing is
divided by what vanishes for a launch at the limit ratio.  The heading is h₀ ln Q + Σ(u, δ), and
what is left of the way is that of a stop from here, whose derivatives are known
(:mod:`puck_tables.stopping.stop_jacobian`).  Where a state stands on the curve its value says.

Over Q the similarity gives them: places and body angles grow like Q², velocities like Q, times like
Q.  With φ that makes those by v = Q cos φ and rω = Q sin φ.

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
    H0,
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
from puck_tables.stopping.stop_jacobian import (
    BY_HEIGHT,
    PLACED_STATES,
    Numbers,
    T,
    placed_state,
    rotated,
    row_by_row,
    stop_by_speeds,
)

# rows of a block for what is found on the way
_RATES, _RATE_ROWS, _FALL, _GAP, _POLE = WORK, 9, WORK + 2, WORK + 6, WORK + 7
_LOGS, _LOG_ROWS = WORK + 9, 3
_CHANGE, _CHANGE_ROWS, _DIRECTIONS = WORK + 12, 4, WORK + 16
_H0, _T0, _ONE_POLE = FIXED + H0, FROM_LAUNCH + 2, FROM_LAUNCH + 6
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
    """How fast Q, u and the heading change where the states are."""
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
            cosine, sine, to_go * (to_go * inverse), t * (t * inverse), t_slope, one_slope, gap,
            pole, turn_rate(rate, cosine, sine, delta, one_along, result),
        )  # fmt: skip
        into_rows(room, _RATES, n, rates)


@inlined
def _find_logs(room: FloatArray) -> None:
    """Logarithms of 2w, 2 − 2w and Q."""
    for n in range(PART):
        share = row_of(room, SHARE, n)
        logs = logs_of(max(share, TINY), 2.0 - share, row_of(room, _FALL, n))
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
def _change(
    u0: float, elapsed: float, tilt: float, gone: Numbers, rates: Numbers, here: Numbers,
    coefficients: Numbers, own: Numbers,
) -> Numbers:  # fmt: skip
    """How a state changes with its launch: what is left of x, y, body angle; vx, vy, rω.

    ``u0``: of u at the launch; ``elapsed``: of its stop; ``tilt``: of δ.
    """
    speed, rim, cosine, sine, one_slip, ex, ey, fx, fy = gone
    t, t_slope, t_tilt, rate, one_slope, h0, deflection, begun = rates
    flown, raised, turn_slope, turned = coefficients
    _, _, turn0, _, far0, is_far = here
    if tilt == 0.0:
        w, y = elapsed * one_slip, flown * u0
    else:
        w, y = elapsed * one_slip - t_tilt, raised
    u = (t * y - rate * w) * one_slope
    log_q = (w - t_slope * y) * one_slope
    turn = h0 * log_q + turn_slope * u
    if tilt == 0.0:
        turn = deflection * ((w - t * begun) * one_slope) + far0 if is_far > 0.0 else turn - turn0
    else:
        turn += turned
    v = speed * (log_q - sine * (sine * u))
    a = rim * (log_q + cosine * (cosine * u))
    aside = speed * turn
    # what is left of the way
    along = own[5] * v + own[6] * a - own[8] * aside
    left = own[9] * v + own[10] * a + own[4] * aside
    body = own[17] * v + own[18] * a
    if tilt != 0.0:
        along, left, body = along + own[7], left + own[11], body + own[19]
    return (
        along * ex + left * fx, along * ey + left * fy, body, v * ex + aside * fx,
        v * ey + aside * fy, a,
    )  # fmt: skip


@inlined
def _state_slopes(
    left: float, delta: float, around: float, launch_row: Numbers, h0: float, here: Numbers,
    stop: Numbers, result: Numbers, moving: Numbers, coefficients: Numbers, directions: Numbers,
) -> Numbers:  # fmt: skip
    """A state and its derivatives in natural units, along x and y, six rows of six.

    Where the share ``left`` of time is left: 0 at rest.  Rows: x, y, body angle, vx, vy, rω.
    Columns: itself; by v, v across, rω, δ, time.
    """
    speed0, rim0, t0, one_speed, u0, begun, _ = launch_row
    cosine, sine, slip, one_slip, t_slope, one_slope, gap, pole, deflection = moving
    k = 1.0 if left > 0.0 else 0.0  # at rest that of the stop alone
    from_stop, rate = of_stop(result, delta), gap * pole
    speed, rim = slip * cosine, slip * sine
    own = stop_by_speeds(speed, rim, slip, cosine, sine, delta, from_stop)
    ex, ey = directions
    fx, fy = -around * ey, around * ex
    gone = speed, rim, cosine, sine, one_slip, ex, ey, fx, fy
    rates = from_stop[T], t_slope, from_stop[BY_HEIGHT + T], rate, one_slope, h0, deflection, begun
    common = gone, rates, here, coefficients, own
    # by φ and by δ
    x1, y1, b1, p1, q1, a1 = _change(u0, stop[0], 0.0, *common)
    x4, y4, b4, p4, q4, a4 = _change(0.0, stop[1], 1.0, *common)
    # by time: velocity and acceleration
    log_q = -k * (one_slip * one_slope)
    u = -rate * log_q
    ahead, aside = speed * (log_q - sine * (sine * u)), speed * (deflection * log_q)
    p5, q5 = ahead * ex + aside * fx, ahead * ey + aside * fy
    a5 = rim * (log_q + cosine * (cosine * u))
    vx, vy, a = k * speed * ex, k * speed * ey, k * rim
    ahead, aside = k * (speed * one_speed) * own[4], k * (speed * one_speed) * own[8]
    x, y = stop[2] - (ahead * ex + aside * fx), stop[5] - (ahead * ey + aside * fy)  # over v
    b = stop[8] - k * own[16]
    x1, y1, b1 = stop[3] - k * x1, stop[6] - k * y1, stop[9] - k * b1
    p1, q1, a1 = k * p1, k * q1, k * a1
    # by ln Q, from the similarity
    time, twice = (1.0 - left) * t0, 2.0 * speed0
    x0, y0, b0 = twice * x - time * vx, twice * y - time * vy, 2.0 * b - time * a
    p0, q0, a0 = vx - time * p5, vy - time * q5, a - time * a5
    return (
        speed0 * x, speed0 * x0 - rim0 * x1, -y, rim0 * x0 + speed0 * x1, stop[4] - k * x4, vx,
        speed0 * y, speed0 * y0 - rim0 * y1, x, rim0 * y0 + speed0 * y1, stop[7] - k * y4, vy,
        b, speed0 * b0 - rim0 * b1, 0.0, rim0 * b0 + speed0 * b1, stop[10] - k * b4, a,
        vx, speed0 * p0 - rim0 * p1, -vy * one_speed, rim0 * p0 + speed0 * p1, k * p4, p5,
        vy, speed0 * q0 - rim0 * q1, vx * one_speed, rim0 * q0 + speed0 * q1, k * q4, q5,
        a, speed0 * a0 - rim0 * a1, 0.0, rim0 * a0 + speed0 * a1, k * a4, a5,
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
            rows_of(room, FROM_LAUNCH, FROM_LAUNCH_ROWS, n), row_of(room, _H0, n),
            rows_of(room, HERE, HERE_ROWS, n), rows_of(room, STOP, STOP_ROWS, n),
            rows_of(room, AT_PLACE, SECTION_WIDTH, n), rows_of(room, _RATES, _RATE_ROWS, n),
            rows_of(room, _CHANGE, _CHANGE_ROWS, n), rows_of(room, _DIRECTIONS, 2, n),
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
