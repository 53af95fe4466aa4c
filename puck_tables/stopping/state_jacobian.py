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
from puck_tables.kernels.compile import allocating, inlined, spline_polynomials
from puck_tables.kernels.spline import basis, cell_at
from puck_tables.stopping.axes import HEIGHTS
from puck_tables.stopping.curve_lookup import (
    KAPPA,
    LAUNCH_COLUMNS,
    LAUNCH_ROWS,
    T_LAUNCH,
    TIME,
    end_logs,
    end_rates,
    fill_state,
    functions_at,
    inverse_sum,
    know_launch,
    place_in_time,
    place_of_share,
)
from puck_tables.stopping.launch_frame import (
    STATE_SPIN,
    STATE_TURNED,
    STATE_VX,
    STATE_VY,
    STATE_X,
    STATE_Y,
    place_state,
    rotated,
)
from puck_tables.stopping.lookup import CURVE_ROW, slip_place
from puck_tables.stopping.slopes import CURVE_WIDTH
from puck_tables.stopping.stop_jacobian import (
    BODY,
    BY_HEIGHT,
    BY_RIM,
    BY_SPEED,
    BY_TILT,
    STOP_FOUND,
    STOP_ROWS,
    STOP_X,
    STOP_Y,
    D,
    T,
    stop_by_speeds,
    stop_found,
)

_TINY = 1e-25
_NEAR_LIMIT = 0.05  # of c − c₀

# what is known of a launch: its puck in natural units, the place on the curve, its stop
_PUCK = LAUNCH_COLUMNS + LAUNCH_ROWS
_PLACE, _PLACES = _PUCK, 9
_SIDE, _XI, _SHARE = range(_PLACE + _PLACES, _PLACE + _PLACES + 3)
_FIXED = _SHARE + 1
_STOP = _FIXED + 6
FACTS = _STOP + 4 * STOP_ROWS
# of a place on the curve
_GAP, _CURVE, _CURVE_TILT, _RATE, _POLE, _TURN, _TURN_SLOPE, _TURN_TILT, _BEND = range(_PLACES)
# constants of the height and their derivatives
_C0, _K, _H0, _C0_TILT, _K_TILT, _H0_TILT = range(6)


@inlined
def _constants_of(constants: FloatArray, delta: float, out: FloatArray) -> None:
    """c₀, κ, h₀ and their derivatives by δ, into ``out`` (6,)."""
    s = 2.0 * delta * delta - 1.0
    for row in range(3):
        value, slope = 0.0, 0.0
        for m in range(constants.shape[1] - 1, -1, -1):
            slope = slope * s + value
            value = value * s + constants[row, m]
        out[row], out[3 + row] = value, 4.0 * delta * slope
    out[_H0_TILT] = out[_H0] + delta * out[_H0_TILT]
    out[_H0] *= delta


@inlined
def _end_tilts(delta: float) -> tuple[float, float, float]:
    """Derivatives of A, B and h₁ by δ."""
    d2 = delta * delta
    below = 36.0 + 4.0 * d2
    return 0.25 * delta, 216.0 * delta / (below * below), (9.0 - 72.0 * d2 / below) / below


@inlined
def _flow_at(
    slopes: FloatArray, cells: int, side: int, xi: float, share: float, delta: float,
    fixed: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """What the motion does at a place of the curve, into ``out`` (9,); ``slopes`` flat."""
    p = xi * cells
    i = cell_at(p, cells)
    first = (side * (cells + 3) + i) * (HEIGHTS * CURVE_WIDTH)
    s = 2.0 * delta * delta - 1.0
    f = spline_polynomials(slopes, first, basis(p - i), s, CURVE_WIDTH, HEIGHTS)
    slow, fast, h1 = end_rates(delta)
    by_slow, by_fast, by_h1 = _end_tilts(delta)
    log_plus, log_minus = end_logs(side, share)
    near, far = share, 2.0 - share
    plus, minus = (far, near) if side == 1 else (near, far)  # 1 + c and 1 − c
    c = 1.0 - share if side == 1 else share - 1.0
    kappa, h0 = fixed[_K], fixed[_H0]
    gap = c - fixed[_C0]
    ends = 0.5 * (minus / slow - plus / fast)
    pole = -kappa / (0.5 * near * far + gap * (f[2] - kappa * ends))
    out[_GAP], out[_POLE], out[_RATE] = gap, pole, gap * pole
    # κ g without its pole, and without the derivative of that
    out[_CURVE] = f[0] - kappa * (log_plus / slow + log_minus / fast)
    out[_CURVE_TILT] = 4.0 * delta * f[CURVE_WIDTH]
    out[_CURVE_TILT] -= fixed[_K_TILT] * (log_plus / slow + log_minus / fast)
    out[_CURVE_TILT] += kappa * (
        by_slow / (slow * slow) * log_plus + by_fast / (fast * fast) * log_minus
    )
    rest = h0 - h1
    out[_TURN] = h0 / slow * log_plus + rest / fast * log_minus + delta * f[1]
    out[_TURN_SLOPE] = 0.5 * (h0 / slow * minus - rest / fast * plus) + delta * f[3]
    out[_TURN_TILT] = (fixed[_H0_TILT] - h0 / slow * by_slow) / slow * log_plus
    out[_TURN_TILT] += (fixed[_H0_TILT] - by_h1 - rest / fast * by_fast) / fast * log_minus
    out[_TURN_TILT] += f[1] + 4.0 * delta * delta * f[CURVE_WIDTH + 1]
    small, large = 0.5 * near, 0.5 * far
    sine = (large if side == 1 else small) / math.sqrt(small * small + large * large)
    out[_BEND] = delta * sine * f[4]


@inlined
def _know_slopes(
    puck: FloatArray, stops: FloatArray, curve: FloatArray, turn_inverse: FloatArray,
    constants: FloatArray, stop_slopes: FloatArray, curve_slopes: FloatArray, cells: int,
    sums: FloatArray, found: FloatArray, own: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that the derivatives of its states need of a launch, into ``out``."""
    speed, rim = math.hypot(puck[0], puck[1]), abs(puck[5] * puck[2])
    slip = math.hypot(speed, rim)
    for m in range(out.size):
        out[m] = 0.0
    if slip == 0.0:
        return
    out[0] = max(speed / slip, _TINY)
    out[2] = max(rim / slip, _TINY)
    out[3], out[4], out[5] = puck[3], 1.0, 1.0
    know_launch(
        out[:LAUNCH_COLUMNS], stops, curve, turn_inverse, constants, 0.0, sums,
        out[LAUNCH_COLUMNS:_PUCK],
    )  # fmt: skip
    # the stop as states have it, so that both agree on when it is
    out[LAUNCH_COLUMNS + TIME] = puck[LAUNCH_COLUMNS + TIME] / slip * puck[4]
    delta = puck[3]
    side, xi = slip_place(out[0], out[2])
    small = min(out[0], out[2]) / max(out[0], out[2])
    share = 2.0 * small / (1.0 + small)
    fixed = out[_FIXED:_STOP]
    _constants_of(constants, delta, fixed)
    _flow_at(curve_slopes, cells, side, xi, share, delta, fixed, out[_PLACE:])
    out[_SIDE], out[_XI], out[_SHARE] = side, xi, share
    stop_found(stop_slopes, cells, side, xi, delta, found)
    stop_by_speeds(out[0], out[2], 1.0, out[0], out[2], delta, found, own)
    for row in range(STOP_ROWS):
        for column in range(4):
            out[_STOP + 4 * row + column] = own[row, column]


@inlined
def _state_slopes(
    facts: FloatArray, side: int, share: float, left: float, stop_slopes: FloatArray,
    curve_slopes: FloatArray, cells: int, found: FloatArray, own: FloatArray, flow: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """A state and its derivatives in natural units, into ``out`` (6, 6).

    At the place (side, 2w) on the curve, where the share ``left`` of time is left; side −1: the
    launch itself, and without time left at rest.  Rows: x, y, body angle, vx, vy, rω, y to the left
    of the launch.  Columns: itself; by v, v across, rω, δ, time.
    """
    stop = _STOP
    for row in range(6):
        for column in range(6):
            out[row, column] = 0.0
    # the stop
    speed0, rim0 = facts[0], facts[2]
    for row, which in ((STATE_X, STOP_X), (STATE_Y, STOP_Y), (STATE_TURNED, BODY)):
        out[row, 0] = facts[stop + 4 * which]
        out[row, 1] = facts[stop + 4 * which + BY_SPEED]
        out[row, 3] = facts[stop + 4 * which + BY_RIM]
        out[row, 4] = facts[stop + 4 * which + BY_TILT]
    over_x, over_y = out[STATE_X, 0], out[STATE_Y, 0]  # z/v
    out[STATE_X, 0], out[STATE_Y, 0] = speed0 * over_x, speed0 * over_y
    out[STATE_X, 2], out[STATE_Y, 2] = -over_y, over_x
    if left == 0.0:
        return
    delta = facts[3]
    known = facts[LAUNCH_COLUMNS:_PUCK]
    if side >= 0:
        xi = place_of_share(share)
    else:
        side, xi, share = int(facts[_SIDE]), facts[_XI], facts[_SHARE]
    fixed = facts[_FIXED:_STOP]
    stop_found(stop_slopes, cells, side, xi, delta, found)
    _flow_at(curve_slopes, cells, side, xi, share, delta, fixed, flow)
    here = facts[_PLACE : _PLACE + _PLACES]
    t = found[T]
    slip = left * known[T_LAUNCH] / t
    small, large = 0.5 * share, 1.0 - 0.5 * share
    norm = 1.0 / math.sqrt(small * small + large * large)
    cosine, sine = (norm * small, norm * large) if side == 1 else (norm * large, norm * small)
    speed, rim = slip * cosine, slip * sine
    stop_by_speeds(speed, rim, slip, cosine, sine, delta, found, own)
    t_slope = sine * cosine * cosine * found[D + T]
    t_tilt = found[BY_HEIGHT + T]
    rate = flow[_RATE]
    way = t - rate * t_slope  # M
    log = math.log(slip)
    log_ratio = known[KAPPA] * log - (flow[_CURVE] - here[_CURVE])
    ratio = math.exp(log_ratio)  # of c − c₀
    flown = ratio * flow[_POLE] / here[_POLE]  # ρ over that at the launch
    kappa = fixed[_K]
    raised = -fixed[_K_TILT] * log + flow[_CURVE_TILT] - here[_CURVE_TILT]
    raised = rate * raised / kappa + fixed[_C0_TILT] / kappa * flow[_POLE] * math.expm1(log_ratio)
    # heading
    turned = fixed[_H0] * log + flow[_TURN] - here[_TURN] if delta > 0.0 else 0.0
    cos_turn, sin_turn = math.cos(turned), math.sin(turned)
    far = abs(here[_GAP]) > _NEAR_LIMIT
    zx, zy = speed * own[STOP_X, 0], speed * own[STOP_Y, 0]  # what is left of the way
    wx, wy = speed * cos_turn, speed * sin_turn
    out[STATE_VX, 0], out[STATE_VY, 0], out[STATE_SPIN, 0] = wx, wy, rim
    left_x, left_y = rotated(zx, zy, cos_turn, sin_turn)
    out[STATE_X, 0] -= left_x
    out[STATE_Y, 0] -= left_y
    out[STATE_TURNED, 0] -= own[BODY, 0]
    # across the launch velocity everything turns
    out[STATE_X, 2], out[STATE_Y, 2] = -out[STATE_Y, 0] / speed0, out[STATE_X, 0] / speed0
    out[STATE_VX, 2], out[STATE_VY, 2] = -wy / speed0, wx / speed0
    for column in (1, 3, 4, 5):
        log_q0, u0, late, tilt = 0.0, 0.0, 0.0, 0.0
        if column == 1:
            log_q0, u0, late = speed0, -1.0 / speed0, facts[stop + BY_SPEED]
        elif column == 3:
            log_q0, u0, late = rim0, 1.0 / rim0, facts[stop + BY_RIM]
        elif column == 4:
            late, tilt = facts[stop + BY_TILT], 1.0
        else:
            late = -1.0
        w = late / slip - t_tilt * tilt
        y = rate * log_q0 + flown * u0 + raised * tilt
        u = (t * y - rate * w) / way
        log_q = (w - t_slope * y) / way
        if far and tilt == 0.0:
            kept = log_q0 + u0 / here[_RATE]
            turn = flow[_BEND] * (w - t * kept) / way
            turn += here[_BEND] * u0 / here[_RATE]
        else:
            turn = fixed[_H0] * (log_q - log_q0) + flow[_TURN_SLOPE] * u - here[_TURN_SLOPE] * u0
            turn += (fixed[_H0_TILT] * log + flow[_TURN_TILT] - here[_TURN_TILT]) * tilt
        v = speed * (log_q - sine * sine * u)
        a = rim * (log_q + cosine * cosine * u)
        vx, vy = rotated(v, speed * turn, cos_turn, sin_turn)
        out[STATE_VX, column], out[STATE_VY, column], out[STATE_SPIN, column] = vx, vy, a
        if column == 5:
            out[STATE_X, 5], out[STATE_Y, 5], out[STATE_TURNED, 5] = wx, wy, rim
        else:
            ahead = own[STOP_X, BY_SPEED] * v + own[STOP_X, BY_RIM] * a - zy * turn
            aside = own[STOP_Y, BY_SPEED] * v + own[STOP_Y, BY_RIM] * a + zx * turn
            ahead += own[STOP_X, BY_TILT] * tilt
            aside += own[STOP_Y, BY_TILT] * tilt
            ahead, aside = rotated(ahead, aside, cos_turn, sin_turn)
            out[STATE_X, column] -= ahead
            out[STATE_Y, column] -= aside
            body = own[BODY, BY_SPEED] * v + own[BODY, BY_RIM] * a + own[BODY, BY_TILT] * tilt
            out[STATE_TURNED, column] -= body


@inlined
def _share_at(
    puck: FloatArray, time: float, time_inverse: FloatArray, s: float, sums: FloatArray
) -> tuple[int, float, float, float]:
    """Side (−1: no place on the curve) and 2w, share of time that is left and its log."""
    side, xi, y, left, log = place_in_time(puck, time)
    if side >= 0:
        y = min(y * inverse_sum(time_inverse, side, xi, s, sums), 1.0)
    return side, y, left, log


@allocating
def fill_state_jacobians(
    pucks: FloatArray, which: npt.NDArray[np.int64], times: FloatArray, stops: FloatArray,
    curve: FloatArray, time_inverse: FloatArray, constants: FloatArray, stop_slopes: FloatArray,
    curve_slopes: FloatArray, values: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """States into ``values`` (6, n), and their derivatives into ``out`` (n, 6, 7).

    Of pucks ``which`` (n,) at ``times`` (n,) ≥ 0.  ``pucks`` (m, 6 + 14), ``stops``, ``curve``,
    ``time_inverse`` and the states as in :func:`puck_tables.stopping.curve_lookup.fill_states`.
    Derivatives of x, y, body angle, vx, vy, ω by vx, vy, ω, δ, J, r, time; from the stop on those
    of the stop.
    """
    cells = stop_slopes.shape[1] - 3
    flat_stops, flat_curve = stop_slopes.reshape(-1), curve_slopes.reshape(-1)
    sums, found, own = np.empty(CURVE_ROW), np.empty(STOP_FOUND), np.empty((STOP_ROWS, 4))
    flow, state = np.empty(_PLACES), np.empty((6, 6))
    facts = np.empty(FACTS)
    last = -1
    for n in range(times.size):
        puck, time = pucks[which[n]], times[n]
        s = 2.0 * puck[3] * puck[3] - 1.0
        side, share, left, log = _share_at(puck, time, time_inverse, s, sums)
        if side >= 0:
            functions_at(stops, curve, side, share, s, sums, found)
        fill_state(puck, time, side, share, left, log, found, values[:, n])
        slip = math.hypot(math.hypot(puck[0], puck[1]), puck[5] * puck[2])
        if slip == 0.0:
            for row in range(6):
                for column in range(7):
                    out[n, row, column] = 0.0
            continue
        if which[n] != last:  # states of a puck come together
            last = which[n]
            _know_slopes(
                puck, stops, curve, curve, constants, flat_stops, flat_curve, cells, sums, found,
                own, facts,
            )  # fmt: skip
        if not time < puck[LAUNCH_COLUMNS + TIME]:
            side, left = -1, 0.0
        elif facts[0] == _TINY or facts[2] == _TINY:  # as the neighbour that its facts are of
            natural = time / slip * puck[4]
            side, share, left, _ = _share_at(facts[:_PUCK], natural, time_inverse, s, sums)
        if side < 0 and time < puck[LAUNCH_COLUMNS + TIME]:
            left = 1.0
        _state_slopes(
            facts, side, share, left, flat_stops, flat_curve, cells, found, own, flow, state
        )
        place_state(puck, time, state, out[n])
