"""Derivatives of states by look-up, compiled.

In natural units (Q = J = r = 1 at the launch, spin positive, start along x) a motion is a place u
on the curve of :mod:`puck_tables.stopping.curve`, du/d ln Q = −ρ, and ln Q − g(u, δ) stays the same
along it, g_u = −1/ρ.  The time that is left is Q T(u, δ).  So a change of slip angle or height,
with changes of u at the launch, and of its stop time t₀, changes the state at the time t by

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
    allocating,
    inlined,
    into_row,
    into_rows,
    kernel,
    row_of,
    rows_of,
    spline_polynomials,
    weighted_rows,
)
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, log_of
from puck_tables.kernels.spline import basis
from puck_tables.motion.state import HEADING
from puck_tables.motion.state import SPEED as FOUND_SPEED
from puck_tables.motion.state import SPIN as FOUND_SPIN
from puck_tables.stopping.axes import CONSTANT_HEIGHTS, HEIGHTS
from puck_tables.stopping.curve_lookup import (
    KAPPA,
    LAUNCH_COLUMNS,
    SLIP,
    SPEED0,
    T_LAUNCH,
    TIME,
    TURNING,
    place_of_share,
)
from puck_tables.stopping.launch_frame import PLACED_STATES, placed_state, rotated
from puck_tables.stopping.orbit import TINY, cell_of
from puck_tables.stopping.orbit_lookup import gather
from puck_tables.stopping.slopes import CURVE_WIDTH
from puck_tables.stopping.stop_jacobian import (
    BY_HEIGHT,
    STOP_FOUND,
    STOP_ROW,
    TURN_RATE,
    D,
    Numbers,
    T,
    direction,
    row_by_row,
    stop_by_speeds,
    stop_functions,
)

_NEAR_LIMIT = 0.05  # of c − c₀
_CURVE_ROW, _FLOWN, _PLACED = HEIGHTS * CURVE_WIDTH, 6, 7
# what is known of a launch: its puck, its place on the curve in natural units, its stop
_EAST, _NORTH, _SPIN, _DELTA, _DECEL, _RADIUS, _TIME, _Q, _UNIT = range(9)
_OF_PUCK = (0, 1, 2, 3, 4, 5, *(LAUNCH_COLUMNS + row for row in (TIME, SLIP, SPEED0)))
_V0, _A0, _U0, _LAUNCHED = 9, 10, 13, 7
_FIXED, _KAPPA, _C0 = 16, 16, 18
_PLACE, _STOP, _STOPPED = 22, 22 + _PLACED, 11
FACTS = _STOP + _STOPPED
# of a place on the curve
_GAP, _CURVE, _CURVE_TILT, _POLE, _TURN_SLOPE, _TURN_TILT, _BEND = range(_PLACED)
# rows of a block behind these: where a state is, what stands there, and its derivatives
_MOMENT, _LEFT, _TURNED, _SHARE, _FAST, _FIRST, _INSIDE = range(FACTS, FACTS + 7)
_FOUND = FACTS + 7
_FLOW = _FOUND + STOP_FOUND
SECTION_WIDTH = 24  # both, padded to whole registers
_PUT = _FOUND + SECTION_WIDTH
_ROWS = _PUT + 2 * PLACED_STATES
_PART = 24  # columns of a block at a time: with so many rows the nearest cache holds no more


@inlined
def _flow_at(
    is_fast: bool, share: float, sine: float, delta: float, fixed: Numbers, f: Numbers,
    turn_rate: float,
) -> Numbers:  # fmt: skip
    """What the motion does at a place of the curve (7), from the functions there (6)."""
    kappa, h0, c0, k_tilt, h0_tilt = fixed[0], fixed[1], fixed[2], fixed[3], fixed[4]
    # A, B and h₁, and their derivatives by δ
    # divisions cost most here; what is left are where a·b + c·d could be contracted in two ways
    d2 = delta * delta
    below, inverse = 36.0 + 4.0 * d2, 1.0 / (36.0 + 4.0 * d2)
    one_slow, one_fast, h1 = 8.0 / (4.0 + d2), below / (9.0 + 4.0 * d2), 9.0 * delta / below
    by_slow, by_fast = 0.25 * delta, 216.0 * delta * (inverse * inverse)
    by_h1 = (9.0 - 72.0 * d2 * inverse) / below
    near, far = share, 2.0 - share
    log_near, log_far = log_of(max(near, TINY)), log_of(far)
    log_plus, log_minus = (log_far, log_near) if is_fast else (log_near, log_far)
    plus, minus = (far, near) if is_fast else (near, far)  # 1 + c and 1 − c
    gap = (1.0 - share if is_fast else share - 1.0) - c0
    ends = 0.5 * (minus * one_slow - plus * one_fast)
    pole = -kappa / (0.5 * near * far + gap * (f[2] - kappa * ends))
    # κ g without its pole, and without the derivative of that
    plus_slow, minus_fast = log_plus * one_slow, log_minus * one_fast
    logs = plus_slow + minus_fast
    by_logs = by_slow * one_slow * plus_slow + by_fast * one_fast * minus_fast
    rest = h0 - h1
    turn_tilt = (h0_tilt - h0 * one_slow * by_slow) * plus_slow
    turn_tilt += (h0_tilt - by_h1 - rest * one_fast * by_fast) * minus_fast
    return (
        gap, f[0] - kappa * logs, f[4] - k_tilt * logs + kappa * by_logs, pole,
        0.5 * (h0 * one_slow * minus - rest * one_fast * plus) + delta * f[3],
        turn_tilt + f[1] + delta * f[5], delta * sine * turn_rate,
    )  # fmt: skip


@inlined
def _functions(
    stops: FloatArray, curve: FloatArray, cell: int, weights: Numbers, delta: float
) -> Numbers:
    """Those of the stop and of the curve from rows of a cell on (22), and nothing (2)."""
    s, k = 2.0 * delta * delta - 1.0, 4.0 * delta
    f = spline_polynomials(curve, _CURVE_ROW * cell, weights, s, CURVE_WIDTH, HEIGHTS)
    of_stop = stop_functions(stops, STOP_ROW * cell, weights, delta)
    return (*of_stop, f[0], f[1], f[2], f[3], k * f[4], k * f[5], 0.0, 0.0)


@kernel
def fill_section(
    delta: float, stop_slopes: FloatArray, curve_slopes: FloatArray, out: FloatArray
) -> None:
    """The functions of one height into ``out`` (2, cells + 3, 24)."""
    stops, curve, flat = stop_slopes.reshape(-1), curve_slopes.reshape(-1), out.reshape(-1)
    for row in range(flat.size // SECTION_WIDTH):
        found = _functions(stops, curve, row, (1.0,), delta)
        for k in range(SECTION_WIDTH):
            flat[SECTION_WIDTH * row + k] = found[k]


@inlined
def _find_functions(
    room: FloatArray, count: int, stops: FloatArray, curve: FloatArray, section: FloatArray,
    cells: float,
) -> None:  # fmt: skip
    """The functions of the stop and of the curve where the rows say."""
    for n in range(count):
        xi = place_of_share(row_of(room, _SHARE, n))
        first, inside = cell_of(xi, row_of(room, _FAST, n) > 0.0, cells, 1)
        into_row(room, _FIRST, n, first)
        into_row(room, _INSIDE, n, inside)
    for n in range(count):
        cell, weights = int(row_of(room, _FIRST, n)), basis(row_of(room, _INSIDE, n))
        if section.size:
            found = weighted_rows(section, SECTION_WIDTH * cell, weights, SECTION_WIDTH)
        else:
            found = _functions(stops, curve, cell, weights, row_of(room, _DELTA, n))
        into_rows(room, _FOUND, n, found)


@inlined
def _find_constants(room: FloatArray, count: int, constants: FloatArray) -> None:
    """c₀, and derivatives by δ of κ, h₀ and c₀."""
    for n in range(count):
        delta = row_of(room, _DELTA, n)
        s, k = 2.0 * delta * delta - 1.0, 4.0 * delta
        c0, c0_tilt, kappa, k_tilt, h0, h0_tilt = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for m in range(CONSTANT_HEIGHTS - 1, -1, -1):
            c0_tilt, c0 = c0_tilt * s + c0, c0 * s + constants[0, m]
            k_tilt, kappa = k_tilt * s + kappa, kappa * s + constants[1, m]
            h0_tilt, h0 = h0_tilt * s + h0, h0 * s + constants[2, m]
        into_rows(room, _C0, n, (c0, k * k_tilt, h0 + delta * k * h0_tilt, k * c0_tilt))


@allocating
def fill_launch_facts(
    pucks: FloatArray, natural: FloatArray, constants: FloatArray, stop_slopes: FloatArray,
    curve_slopes: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that derivatives of states need of launches, into ``out`` (40, m).

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
            into_rows(room, _V0, n, (speed / slip, rim / slip, known[T_LAUNCH, n], slip / speed))
            into_rows(room, _KAPPA, n, (known[KAPPA, n], known[TURNING, n]))
        _find_constants(room, count, constants)
        _find_functions(room, count, stops, curve, stops[:0], cells)
        for n in range(count):
            c, s, delta = row_of(room, _V0, n), row_of(room, _A0, n), row_of(room, _DELTA, n)
            found = rows_of(room, _FOUND, STOP_FOUND, n)
            flow = _flow_at(
                row_of(room, _FAST, n) > 0.0, row_of(room, _SHARE, n), s, delta,
                rows_of(room, _FIXED, 6, n), rows_of(room, _FLOW, _FLOWN, n), found[TURN_RATE],
            )  # fmt: skip
            vx, vy = row_of(room, _EAST, n), row_of(room, _NORTH, n)
            into_rows(room, _EAST, n, direction(vx, vy, row_of(room, _UNIT, n)))
            into_row(room, _UNIT, n, 1.0 / row_of(room, _DECEL, n))
            u0 = 1.0 / (c * s)
            begun = u0, u0 / (flow[_GAP] * flow[_POLE]), 1.0 / flow[_POLE]
            into_rows(room, _U0, n, begun)
            into_rows(room, _PLACE, n, flow)
            own = stop_by_speeds(c, s, 1.0, c, s, delta, found)
            stopped = (
                c * own[2] - s * own[1], own[3],
                own[4], c * own[6] - s * own[5], own[7],
                own[8], c * own[10] - s * own[9], own[11],
                own[16], c * own[18] - s * own[17], own[19],
            )  # fmt: skip
            into_rows(room, _STOP, n, stopped)
        for row in range(FACTS):
            values, place = room[row * BLOCK :], out[row, start : start + count]
            for n in range(count):
                place[n] = values[n]


@inlined
def _find_places(room: FloatArray, count: int) -> None:
    """What time is left, and where on the curve the states are: side and 2w.

    From heading, speed and spin in the rows of those.
    """
    for n in range(count):
        left = 1.0 - row_of(room, _MOMENT, n) / row_of(room, _TIME, n)
        speed, spin = row_of(room, _SHARE, n), row_of(room, _FAST, n)
        turned = row_of(room, _TURNED, n)
        rim = abs(spin) * row_of(room, _RADIUS, n)
        larger, smaller = max(speed, rim), min(speed, rim)
        ratio = smaller / (larger if larger > 0.0 else 1.0)
        into_row(room, _LEFT, n, left if (larger > 0.0) & (left > 0.0) else 0.0)
        into_row(room, _SHARE, n, 2.0 * ratio / (1.0 + ratio))
        into_row(room, _FAST, n, 1.0 if rim > speed else 0.0)
        into_row(room, _TURNED, n, turned if row_of(room, _SPIN, n) >= 0.0 else -turned)


@inlined
def _change(
    u0: float, late: float, tilt: float, gone: Numbers, rates: Numbers, here: Numbers,
    flow: Numbers, turnings: Numbers, own: Numbers,
) -> Numbers:  # fmt: skip
    """How a state changes with its launch: what is left of x, y, body angle; vx, vy, rω.

    ``u0``: of u at the launch; ``late``: of its stop; ``tilt``: of δ.
    """
    slip, one_slip, cosine, sine, cos_turn, sin_turn, log = gone
    t, t_slope, t_tilt, rate, flown, raised, one_way, begun = rates
    h0, h0_tilt = turnings
    w = late * one_slip - t_tilt * tilt
    y = flown * u0 + raised * tilt
    u = (t * y - rate * w) * one_way
    log_q = (w - t_slope * y) * one_way
    turn = h0 * log_q + flow[_TURN_SLOPE] * u - here[_TURN_SLOPE] * u0
    turn += (h0_tilt * log + flow[_TURN_TILT] - here[_TURN_TILT]) * tilt
    if tilt == 0.0:
        far = flow[_BEND] * (w - t * begun) * one_way + here[_BEND] * begun
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
    left: float, turned: float, is_fast: bool, share: float, delta: float, launched: Numbers,
    fixed: Numbers, here: Numbers, stop: Numbers, found: Numbers, curve: Numbers,
) -> Numbers:  # fmt: skip
    """A state and its derivatives in natural units, six rows of six.

    At the place (is fast, 2w) on the curve, where the share ``left`` of time is left: 0 at rest.
    Rows: x, y, body angle, vx, vy, rω, y to the left of the launch.  Columns: itself; by v, v
    across, rω, δ, time.
    """
    speed0, rim0, t0, one_speed, u0, begun, one_pole = launched
    kappa, h0, _, k_tilt, h0_tilt, c0_tilt = fixed
    t, to_go = found[T], (left if left > 0.0 else 1.0) * t0
    inverse = 1.0 / (to_go * t)
    slip, one_slip = to_go * to_go * inverse, t * t * inverse
    small, large = 0.5 * share, 1.0 - 0.5 * share
    norm = 1.0 / math.sqrt(small * small + large * large)
    cosine, sine = (norm * small, norm * large) if is_fast else (norm * large, norm * small)
    flow = _flow_at(is_fast, share, sine, delta, fixed, curve, found[TURN_RATE])
    speed, rim = slip * cosine, slip * sine
    own = stop_by_speeds(speed, rim, slip, cosine, sine, delta, found)
    t_slope = sine * cosine * cosine * found[D + T]
    rate = flow[_GAP] * flow[_POLE]
    log = log_of(slip)
    ratio = exp_of(kappa * log - (flow[_CURVE] - here[_CURVE]))  # of c − c₀
    flown = ratio * flow[_POLE] * one_pole  # ρ over that at the launch
    raised = c0_tilt * ratio - c0_tilt
    raised += flow[_GAP] * (flow[_CURVE_TILT] - here[_CURVE_TILT] - k_tilt * log)
    raised *= flow[_POLE] / kappa
    cos_turn, sin_turn = cosine_sine_of(turned)
    gone = slip, one_slip, cosine, sine, cos_turn, sin_turn, log
    one_way = 1.0 / (t - rate * t_slope)
    rates = t, t_slope, found[BY_HEIGHT + T], rate, flown, raised, one_way, begun
    common = gone, rates, here, flow, (h0, h0_tilt), own
    k = 1.0 if left > 0.0 else 0.0  # at rest that of the stop alone
    # by φ and by δ
    x1, y1, b1, p1, q1, a1 = _change(u0, stop[0], 0.0, *common)
    x4, y4, b4, p4, q4, a4 = _change(0.0, stop[1], 1.0, *common)
    # by time: velocity and acceleration
    log_q = -k * one_slip * one_way
    u = -rate * log_q
    p5, q5 = rotated(
        speed * (log_q - sine * sine * u), speed * flow[_BEND] * log_q, cos_turn, sin_turn
    )
    a5 = rim * (log_q + cosine * cosine * u)
    vx, vy, a = k * speed * cos_turn, k * speed * sin_turn, k * rim
    left_x, left_y = rotated(speed * own[4], speed * own[8], cos_turn, sin_turn)
    x, y = stop[2] - k * left_x * one_speed, stop[5] - k * left_y * one_speed  # over v
    b = stop[8] - k * own[16]
    x1, y1, b1 = stop[3] - k * x1, stop[6] - k * y1, stop[9] - k * b1
    p1, q1, a1 = k * p1, k * q1, k * a1
    # by ln Q, from the similarity
    time = (1.0 - left) * t0
    x0, y0, b0 = 2.0 * speed0 * x - time * vx, 2.0 * speed0 * y - time * vy, 2.0 * b - time * a
    p0, q0, a0 = vx - time * p5, vy - time * q5, a - time * a5
    return (
        speed0 * x, speed0 * x0 - rim0 * x1, -y, rim0 * x0 + speed0 * x1, stop[4] - k * x4, vx,
        speed0 * y, speed0 * y0 - rim0 * y1, x, rim0 * y0 + speed0 * y1, stop[7] - k * y4, vy,
        b, speed0 * b0 - rim0 * b1, 0.0, rim0 * b0 + speed0 * b1, stop[10] - k * b4, a,
        vx, speed0 * p0 - rim0 * p1, -vy * one_speed, rim0 * p0 + speed0 * p1, k * p4, p5,
        vy, speed0 * q0 - rim0 * q1, vx * one_speed, rim0 * q0 + speed0 * q1, k * q4, q5,
        a, speed0 * a0 - rim0 * a1, 0.0, rim0 * a0 + speed0 * a1, k * a4, a5,
    )  # fmt: skip


@allocating
def fill_state_jacobians(
    facts: FloatArray, which: npt.NDArray[np.int64], times: FloatArray, states: FloatArray,
    begin: int, end: int, stop_slopes: FloatArray, curve_slopes: FloatArray, section: FloatArray,
    streamed: bool, out: FloatArray,
) -> None:  # fmt: skip
    """Derivatives of states into ``out`` (n, 6, 7).

    Of pucks ``which`` of ``facts`` (40, m) at ``times`` (n,) ≥ 0, from ``begin`` to ``end``; as in
    :func:`puck_tables.stopping.orbit_lookup.fill_orbit_states`, whose ``states`` (6, n) are needed.
    ``section``: that of :func:`fill_section` where all have one height, or empty.
    Derivatives of x, y, body angle, vx, vy, ω by vx, vy, ω, δ, J, r, time; from the stop on those
    of the stop.
    """
    cells = float(stop_slopes.shape[1] - 3)
    stops, curve, sections = stop_slopes.reshape(-1), curve_slopes.reshape(-1), section.reshape(-1)
    numbers, room = out.reshape(-1), np.empty(_ROWS * BLOCK)
    part = _PART if which.size else BLOCK  # facts of many pucks are copied faster at length
    held = -1
    for start in range(begin, end, part):
        count = min(part, end - start)
        held = gather(facts, which, begin, start, count, held, room)
        moments = times[start : start + count]
        for n in range(count):
            into_row(room, _MOMENT, n, moments[n])
        heading, speed = states[HEADING, start:], states[FOUND_SPEED, start:]
        spin = states[FOUND_SPIN, start:]
        for n in range(count):
            into_rows(room, _TURNED, n, (heading[n], speed[n], spin[n]))
        _find_places(room, count)
        _find_functions(room, count, stops, curve, sections, cells)
        for n in range(count):
            is_fast, share = row_of(room, _FAST, n) > 0.0, row_of(room, _SHARE, n)
            own = _state_slopes(
                row_of(room, _LEFT, n), row_of(room, _TURNED, n), is_fast, share,
                row_of(room, _DELTA, n), rows_of(room, _V0, _LAUNCHED, n),
                rows_of(room, _FIXED, 6, n), rows_of(room, _PLACE, _PLACED, n),
                rows_of(room, _STOP, _STOPPED, n), rows_of(room, _FOUND, STOP_FOUND, n),
                rows_of(room, _FLOW, _FLOWN, n),
            )  # fmt: skip
            placed = placed_state(
                row_of(room, _EAST, n), row_of(room, _NORTH, n), row_of(room, _SPIN, n),
                row_of(room, _DECEL, n), row_of(room, _UNIT, n), row_of(room, _RADIUS, n),
                row_of(room, _Q, n), row_of(room, _MOMENT, n), own,
            )  # fmt: skip
            into_rows(room, _PUT, n, placed)
        row_by_row(room, _PUT, PLACED_STATES, count, numbers, start, streamed)
