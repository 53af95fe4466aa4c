"""Derivatives of states by look-up, compiled.

In natural units (Q = J = r = 1 at the launch, spin positive, start along x) a motion is a place u
on the curve of :mod:`puck_tables.stopping.curve`, du/d ln Q = −ρ, and ln Q − g(u, δ) stays the same
along it, g_u = −1/ρ.  The time that is left is Q T(u, δ).  So a change of launch or height, with
changes of ln Q and u at the launch, of its stop time t₀, and of the time τ asked for, changes the
state by

    δu = (T Y − ρ W)/M,    δ ln Q = (W − T_u Y)/M,    M = T − ρ T_u,
    W = (δt₀ − δτ)/Q − T_δ δδ,    Y = ρ [(δ ln Q + δu/ρ)(launch) + (g_δ − g_δ(launch)) δδ] .

ρ = (c − c₀) P with the ratio of c − c₀ here and at the launch from its logarithm: nothing is
divided by what vanishes for a launch at the limit ratio.  The heading is h₀ ln Q + Σ(u, δ), and
what is left of the way is that of a stop from here, whose derivatives are known
(:mod:`puck_tables.stopping.stop_jacobian`).

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
    allocating,
    inlined,
    into_row,
    into_rows,
    row_of,
    rows_of,
    spline_polynomials,
    weighted_rows,
)
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, log_of
from puck_tables.kernels.spline import basis
from puck_tables.stopping.axes import HEIGHTS
from puck_tables.stopping.curve_lookup import (
    KAPPA,
    LAUNCH_COLUMNS,
    LOG_N,
    SIGN_N,
    SLIP,
    SPEED0,
    T_LAUNCH,
    TIME,
    TURNING,
    end_rates,
    place_of_share,
)
from puck_tables.stopping.launch_frame import PLACED_STATES, placed_state, rotated
from puck_tables.stopping.orbit import TINY, cell_of, log_place, place_of_log
from puck_tables.stopping.slopes import CURVE_WIDTH
from puck_tables.stopping.stop_jacobian import (
    BY_HEIGHT,
    OWN,
    STOP_FOUND,
    STOP_ROW,
    D,
    Numbers,
    T,
    row_by_row,
    stop_by_speeds,
    stop_functions,
)

_NEAR_LIMIT = 0.05  # of c − c₀
_CURVE_ROW, _FLOWN = HEIGHTS * CURVE_WIDTH, 7
# what is known of a launch: its puck, its place on the curve in natural units, its stop
_VX, _VY, _SPIN, _DELTA, _DECEL, _RADIUS, _TIME, _Q, _V = range(9)
_OF_PUCK = (0, 1, 2, 3, 4, 5, *(LAUNCH_COLUMNS + row for row in (TIME, SLIP, SPEED0)))
_V0, _A0, _T0, _LOG_N, _SIGN_N = range(9, 14)
_FIXED, _KAPPA, _H0, _C0, _K_TILT, _H0_TILT, _C0_TILT = 14, *range(14, 20)
_PLACE, _STOP = 20, 28
FACTS = _STOP + OWN
# of a place on the curve
_GAP, _CURVE, _CURVE_TILT, _POLE, _TURN, _TURN_SLOPE, _TURN_TILT, _BEND = range(8)
# rows of a block behind these: where a state is, what stands there, and its derivatives
_MOMENT, _LEFT, _SHARE, _FAST, _FIRST, _INSIDE = range(FACTS, FACTS + 6)
_FOUND = FACTS + 6
_FLOW = _FOUND + STOP_FOUND
_PUT = _FLOW + _FLOWN
_ROWS = _PUT + PLACED_STATES


@inlined
def _flow_at(is_fast: bool, share: float, delta: float, fixed: Numbers, f: Numbers) -> Numbers:
    """What the motion does at a place of the curve (8), from the functions there (7)."""
    kappa, h0, c0, k_tilt, h0_tilt = fixed[0], fixed[1], fixed[2], fixed[3], fixed[4]
    slow, fast, h1 = end_rates(delta)
    d2 = delta * delta
    below = 36.0 + 4.0 * d2
    # derivatives of A, B and h₁ by δ
    by_slow, by_fast = 0.25 * delta, 216.0 * delta / (below * below)
    by_h1 = (9.0 - 72.0 * d2 / below) / below
    near, far = share, 2.0 - share
    log_near, log_far = log_of(max(near, TINY)), log_of(far)
    log_plus, log_minus = (log_far, log_near) if is_fast else (log_near, log_far)
    plus, minus = (far, near) if is_fast else (near, far)  # 1 + c and 1 − c
    gap = (1.0 - share if is_fast else share - 1.0) - c0
    ends = 0.5 * (minus / slow - plus / fast)
    pole = -kappa / (0.5 * near * far + gap * (f[2] - kappa * ends))
    # κ g without its pole, and without the derivative of that
    logs = log_plus / slow + log_minus / fast
    by_logs = by_slow / (slow * slow) * log_plus + by_fast / (fast * fast) * log_minus
    rest = h0 - h1
    turn_tilt = (h0_tilt - h0 / slow * by_slow) / slow * log_plus
    turn_tilt += (h0_tilt - by_h1 - rest / fast * by_fast) / fast * log_minus
    small, large = 0.5 * near, 0.5 * far
    sine = (large if is_fast else small) / math.sqrt(small * small + large * large)
    return (
        gap, f[0] - kappa * logs, f[5] - k_tilt * logs + kappa * by_logs, pole,
        h0 / slow * log_plus + rest / fast * log_minus + delta * f[1],
        0.5 * (h0 / slow * minus - rest / fast * plus) + delta * f[3],
        turn_tilt + f[1] + delta * f[6], delta * sine * f[4],
    )  # fmt: skip


@inlined
def _find_functions(
    room: FloatArray, count: int, cells: float, stops: FloatArray, curve: FloatArray
) -> None:
    """The functions of the stop and of the curve where the rows say."""
    for n in range(count):
        xi = place_of_share(row_of(room, _SHARE, n))
        first, inside = cell_of(xi, row_of(room, _FAST, n) > 0.0, cells, 1)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    for n in range(count):
        cell, inside = int(row_of(room, _FIRST, n)), row_of(room, _INSIDE, n)
        delta = row_of(room, _DELTA, n)
        into_rows(room, _FOUND, n, stop_functions(stops, STOP_ROW * cell, inside, delta))
        s, k = 2.0 * delta * delta - 1.0, 4.0 * delta
        f = spline_polynomials(curve, _CURVE_ROW * cell, basis(inside), s, CURVE_WIDTH, HEIGHTS)
        flow = f[0], f[1], f[2], f[3], f[4], k * f[8], k * f[9]
        into_rows(room, _FLOW, n, flow)


@inlined
def _find_constants(room: FloatArray, count: int, constants: FloatArray) -> None:
    """c₀, and derivatives by δ of κ, h₀ and c₀."""
    for n in range(count):
        into_rows(room, _C0, n, (0.0, 0.0, 0.0, 0.0))
        into_rows(room, _FOUND, n, (0.0, 0.0))
    for m in range(constants.shape[1] - 1, -1, -1):
        a, b, d = constants[0, m], constants[1, m], constants[2, m]
        for n in range(count):
            s = 2.0 * row_of(room, _DELTA, n) ** 2 - 1.0
            c0, k_tilt, h0_tilt, c0_tilt = rows_of(room, _C0, 4, n)
            kappa, h0 = rows_of(room, _FOUND, 2, n)
            slopes = c0 * s + a, k_tilt * s + kappa, h0_tilt * s + h0, c0_tilt * s + c0
            into_rows(room, _C0, n, slopes)
            into_rows(room, _FOUND, n, (kappa * s + b, h0 * s + d))
    for n in range(count):
        delta = row_of(room, _DELTA, n)
        k = 4.0 * delta
        c0, k_tilt, h0_tilt, c0_tilt = rows_of(room, _C0, 4, n)
        _, h0 = rows_of(room, _FOUND, 2, n)
        turning = h0 + delta * k * h0_tilt
        into_rows(room, _C0, n, (c0, k * k_tilt, turning, k * c0_tilt))


@allocating
def fill_launch_facts(
    pucks: FloatArray, natural: FloatArray, constants: FloatArray, stop_slopes: FloatArray,
    curve_slopes: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that derivatives of states need of launches, into ``out`` (48, m).

    ``pucks`` (20, m), see :func:`puck_tables.stopping.known.fill_known`; ``natural``: the same, but
    with others beside them in place of exact pure motions.
    """
    cells = float(stop_slopes.shape[1] - 3)
    stops, curve, room = stop_slopes.reshape(-1), curve_slopes.reshape(-1), np.empty(_ROWS * BLOCK)
    for start in range(0, pucks.shape[1], BLOCK):
        count = min(BLOCK, pucks.shape[1] - start)
        for row in range(len(_OF_PUCK)):
            values = pucks[_OF_PUCK[row], start : start + count]
            for n in range(count):
                room[row * BLOCK + n] = values[n]
        known = natural[LAUNCH_COLUMNS:, start : start + count]
        for n in range(count):
            slip, speed = known[SLIP, n], known[SPEED0, n]
            rim = abs(natural[_RADIUS, start + n] * natural[_SPIN, start + n])
            larger, smaller = max(speed, rim), min(speed, rim)
            ratio = smaller / larger
            into_row(room, _SHARE, n, 2.0 * ratio / (1.0 + ratio))
            into_row(room, _FAST, n, 1.0 if rim > speed else 0.0)
            begun = (
                speed / slip, rim / slip, known[T_LAUNCH, n], known[LOG_N, n], known[SIGN_N, n],
                known[KAPPA, n], known[TURNING, n],
            )  # fmt: skip
            into_rows(room, _V0, n, begun)
        _find_constants(room, count, constants)
        _find_functions(room, count, cells, stops, curve)
        for n in range(count):
            c, s, delta = row_of(room, _V0, n), row_of(room, _A0, n), row_of(room, _DELTA, n)
            flow = _flow_at(
                row_of(room, _FAST, n) > 0.0, row_of(room, _SHARE, n), delta,
                rows_of(room, _FIXED, 6, n), rows_of(room, _FLOW, _FLOWN, n),
            )  # fmt: skip
            into_rows(room, _PLACE, n, flow)
            found = rows_of(room, _FOUND, STOP_FOUND, n)
            into_rows(room, _STOP, n, stop_by_speeds(c, s, 1.0, c, s, delta, found))
        for row in range(FACTS):
            values, place = room[row * BLOCK :], out[row, start : start + count]
            for n in range(count):
                place[n] = values[n]


@inlined
def _gather(
    facts: FloatArray, which: npt.NDArray[np.int64], start: int, count: int, room: FloatArray
) -> None:
    """Columns of ``facts`` for a block of moments into the first rows of ``room``."""
    first, last = which[start], which[start + count - 1]
    same = True
    for n in range(count):
        same &= which[start + n] == first
    if same and start > 0 and which[start - 1] == last:
        return  # they are there
    for row in range(FACTS):
        values, block = facts[row], room[row * BLOCK : (row + 1) * BLOCK]
        if same:
            value = values[first]
            for n in range(BLOCK):
                block[n] = value
        else:
            for n in range(count):
                block[n] = values[which[start + n]]


@inlined
def _find_places(room: FloatArray, count: int, cells: float, inverse: FloatArray) -> None:
    """Where on the curve the states are: side and 2w."""
    for n in range(count):
        left = 1.0 - row_of(room, _MOMENT, n) / row_of(room, _TIME, n)
        moving = left > 0.0
        kappa = row_of(room, _KAPPA, n)
        slow, fast, _ = end_rates(row_of(room, _DELTA, n))
        log_n = row_of(room, _LOG_N, n) + kappa * log_of(max(left, TINY) if moving else 1.0)
        is_fast, log_y = log_place(row_of(room, _SIGN_N, n), log_n, kappa, slow, fast)
        y, xi = place_of_log(log_y)
        first, inside = cell_of(xi, is_fast, cells, HEIGHTS)
        into_row(room, _LEFT, n, left if moving else 0.0)
        into_row(room, _SHARE, n, y)
        into_row(room, _FAST, n, 1.0 if is_fast else 0.0)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    for n in range(count):
        at, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
        row, total = weighted_rows(inverse, at, weights, HEIGHTS), 0.0
        s = 2.0 * row_of(room, _DELTA, n) ** 2 - 1.0
        for m in range(HEIGHTS - 1, -1, -1):
            total = total * s + row[m]
        into_row(room, _SHARE, n, min(row_of(room, _SHARE, n) * total, 1.0))


@inlined
def _change(
    log_q0: float, u0: float, late: float, tilt: float, gone: Numbers, rates: Numbers,
    here: Numbers, flow: Numbers, turnings: Numbers, own: Numbers,
) -> Numbers:  # fmt: skip
    """How a state changes with its launch: x, y, body angle, vx, vy, rω.

    ``log_q0``, ``u0``: of ln Q and u at the launch; ``late``: of its stop less that of the moment;
    ``tilt``: of δ.
    """
    slip, cosine, sine, cos_turn, sin_turn, log = gone
    t, t_slope, t_tilt, rate, flown, raised, way = rates
    h0, h0_tilt = turnings
    w = late / slip - t_tilt * tilt
    y = rate * log_q0 + flown * u0 + raised * tilt
    u = (t * y - rate * w) / way
    log_q = (w - t_slope * y) / way
    turn = h0 * (log_q - log_q0) + flow[_TURN_SLOPE] * u - here[_TURN_SLOPE] * u0
    turn += (h0_tilt * log + flow[_TURN_TILT] - here[_TURN_TILT]) * tilt
    if tilt == 0.0:
        begun = u0 / (here[_GAP] * here[_POLE])
        far = flow[_BEND] * (w - t * (log_q0 + begun)) / way + here[_BEND] * begun
        turn = far if abs(here[_GAP]) > _NEAR_LIMIT else turn
    speed, rim = slip * cosine, slip * sine
    v = speed * (log_q - sine * sine * u)
    a = rim * (log_q + cosine * cosine * u)
    vx, vy = rotated(v, speed * turn, cos_turn, sin_turn)
    # what is left of the way
    ahead = own[5] * v + own[6] * a + own[7] * tilt - speed * own[8] * turn
    aside = own[9] * v + own[10] * a + own[11] * tilt + speed * own[4] * turn
    x, y = rotated(ahead, aside, cos_turn, sin_turn)
    return x, y, own[17] * v + own[18] * a + own[19] * tilt, vx, vy, a


@inlined
def _state_slopes(
    left: float, is_fast: bool, share: float, delta: float, launched: Numbers, fixed: Numbers,
    here: Numbers, stop: Numbers, found: Numbers, flow: Numbers,
) -> Numbers:  # fmt: skip
    """A state and its derivatives in natural units, six rows of six.

    At the place (is fast, 2w) on the curve, where the share ``left`` of time is left: 0 at rest.
    Rows: x, y, body angle, vx, vy, rω, y to the left of the launch.  Columns: itself; by v, v
    across, rω, δ, time.
    """
    speed0, rim0, t0 = launched
    kappa, h0, _, k_tilt, h0_tilt, c0_tilt = fixed
    t = found[T]
    slip = (left if left > 0.0 else 1.0) * t0 / t
    small, large = 0.5 * share, 1.0 - 0.5 * share
    norm = 1.0 / math.sqrt(small * small + large * large)
    cosine, sine = (norm * small, norm * large) if is_fast else (norm * large, norm * small)
    speed, rim = slip * cosine, slip * sine
    own = stop_by_speeds(speed, rim, slip, cosine, sine, delta, found)
    t_slope = sine * cosine * cosine * found[D + T]
    rate = flow[_GAP] * flow[_POLE]
    log = log_of(slip)
    log_ratio = kappa * log - (flow[_CURVE] - here[_CURVE])
    ratio = exp_of(log_ratio)  # of c − c₀
    flown = ratio * flow[_POLE] / here[_POLE]  # ρ over that at the launch
    raised = rate * (flow[_CURVE_TILT] - here[_CURVE_TILT] - k_tilt * log) / kappa
    raised += c0_tilt / kappa * flow[_POLE] * (ratio - 1.0)
    turned = h0 * log + flow[_TURN] - here[_TURN] if delta > 0.0 else 0.0
    cos_turn, sin_turn = cosine_sine_of(turned)
    gone = slip, cosine, sine, cos_turn, sin_turn, log
    rates = t, t_slope, found[BY_HEIGHT + T], rate, flown, raised, t - rate * t_slope
    common = gone, rates, here, flow, (h0, h0_tilt), own
    # by v, by rω, by δ, by time
    x1, y1, b1, p1, q1, a1 = _change(speed0, -1.0 / speed0, stop[1], 0.0, *common)
    x3, y3, b3, p3, q3, a3 = _change(rim0, 1.0 / rim0, stop[2], 0.0, *common)
    x4, y4, b4, p4, q4, a4 = _change(0.0, 0.0, stop[3], 1.0, *common)
    _, _, _, p5, q5, a5 = _change(0.0, 0.0, -1.0, 0.0, *common)
    k = 1.0 if left > 0.0 else 0.0  # at rest that of the stop alone
    vx, vy, a = k * speed * cos_turn, k * speed * sin_turn, k * rim
    left_x, left_y = rotated(speed * own[4], speed * own[8], cos_turn, sin_turn)
    x, y = stop[4] - k * left_x / speed0, stop[8] - k * left_y / speed0  # over v
    return (
        speed0 * x, stop[5] - k * x1, -y, stop[6] - k * x3, stop[7] - k * x4, vx,
        speed0 * y, stop[9] - k * y1, x, stop[10] - k * y3, stop[11] - k * y4, vy,
        stop[16] - k * own[16], stop[17] - k * b1, 0.0, stop[18] - k * b3, stop[19] - k * b4, a,
        vx, k * p1, -vy / speed0, k * p3, k * p4, k * p5,
        vy, k * q1, vx / speed0, k * q3, k * q4, k * q5,
        a, k * a1, 0.0, k * a3, k * a4, k * a5,
    )  # fmt: skip


@allocating
def fill_state_jacobians(
    facts: FloatArray, which: npt.NDArray[np.int64], times: FloatArray, time_inverse: FloatArray,
    stop_slopes: FloatArray, curve_slopes: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """Derivatives of states into ``out`` (n, 6, 7).

    Of pucks ``which`` (n,) of ``facts`` (48, m) at ``times`` (n,) ≥ 0.  ``time_inverse`` (2,
    cells + 3, 9): that of the stop table.  Derivatives of x, y, body angle, vx, vy, ω by vx, vy, ω,
    δ, J, r, time; from the stop on those of the stop.
    """
    cells = float(stop_slopes.shape[1] - 3)
    stops, curve = stop_slopes.reshape(-1), curve_slopes.reshape(-1)
    inverse, numbers = time_inverse.reshape(-1), out.reshape(-1)
    room = np.empty(_ROWS * BLOCK)
    for start in range(0, times.size, BLOCK):
        count = min(BLOCK, times.size - start)
        _gather(facts, which, start, count, room)
        moments = times[start : start + count]
        for n in range(count):
            into_row(room, _MOMENT, n, moments[n])
        _find_places(room, count, cells, inverse)
        _find_functions(room, count, cells, stops, curve)
        for n in range(count):
            is_fast, share = row_of(room, _FAST, n) > 0.0, row_of(room, _SHARE, n)
            delta, fixed = row_of(room, _DELTA, n), rows_of(room, _FIXED, 6, n)
            flow = _flow_at(is_fast, share, delta, fixed, rows_of(room, _FLOW, _FLOWN, n))
            own = _state_slopes(
                row_of(room, _LEFT, n), is_fast, share, delta, rows_of(room, _V0, 3, n), fixed,
                rows_of(room, _PLACE, 8, n), rows_of(room, _STOP, OWN, n),
                rows_of(room, _FOUND, STOP_FOUND, n), flow,
            )  # fmt: skip
            placed = placed_state(
                row_of(room, _VX, n), row_of(room, _VY, n), row_of(room, _SPIN, n),
                row_of(room, _DECEL, n), row_of(room, _RADIUS, n), row_of(room, _V, n),
                row_of(room, _Q, n), row_of(room, _MOMENT, n), own,
            )  # fmt: skip
            into_rows(room, _PUT, n, placed)
        row_by_row(room, _PUT, PLACED_STATES, count, numbers[PLACED_STATES * start :])
