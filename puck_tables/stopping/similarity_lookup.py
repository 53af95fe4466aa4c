"""States by look-up, compiled: along the universal curve and back.

The signed number

    N = sign(c − c₀) exp(κ (ln Q + ln T)) / (its modulus at φ = π/4)

(ln Q of :mod:`puck_tables.stopping.similarity`) falls along every motion like the κ-th power of the
time that is left, N ∝ (t₀ − t)^κ, and is one and the same monotonic function of c for both generic
classes: negative below the limit ratio, −1 at π/4, positive above.  Its inverse is tabulated, so a
state at a time is found without solving anything.  Without ln T the same holds for Q itself.

The inverse is tabulated on the axis ξ of the table, but for

    y = (−N)^(−A/κ)  for N ≤ −1 (v > r|ω|),    y = (2 + N)^(−B/κ)  above,

which is 1 at π/4 and proportional to 2w = 2 min(v, r|ω|)/(v + r|ω|) at the ends; what is splined is
2w/y.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.spline import basis, cell_at
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN
from puck_tables.stopping.axes import HEIGHTS
from puck_tables.stopping.lookup import STOP_POWERS, slip_place

# order of the functions of the curve
BODY_SUM, TURN_SUM, LENGTH_SUM, CURVE_SUM = range(4)

_SMALLEST_SHARE = 1e-300  # of the slower motion; less is a limit reached long before

# rows of what is known of a launch
TIME, STOP_X, STOP_Y, LENGTH, BODY, TURN = range(6)
SLIP, SPEED0, T_LAUNCH, LOG_N, SIGN_N, HEADING0, KAPPA, TURNING = range(6, 14)
LAUNCH_ROWS = 14  # the fourteen above
LAUNCH_COLUMNS = 6  # vx, vy, ω, δ, J, r


@inlined
def _cell(xi: float, cells: int) -> tuple[int, float, float, float, float]:
    p = xi * cells
    i = cell_at(p, cells)
    w0, w1, w2, w3 = basis(p - i)
    return i, w0, w1, w2, w3


@inlined
def place_of_share(double_share: float) -> float:
    """ξ from 2w."""
    q = math.sqrt(math.sqrt(double_share))
    return 1.0 - math.sqrt((1.0 - double_share) / ((1.0 + q) * (1.0 + q * q)))


@inlined
def _polynomial(c: FloatArray, function: int, s: float) -> float:
    """The polynomial of degree 8 that starts at 9 · function."""
    total = 0.0
    for m in range(HEIGHTS - 1, -1, -1):
        total = total * s + c[function * HEIGHTS + m]
    return total


@inlined
def _constant(constants: FloatArray, row: int, s: float) -> float:
    total = 0.0
    for m in range(constants.shape[1] - 1, -1, -1):
        total = total * s + constants[row, m]
    return total


@inlined
def _stop_functions(
    c: FloatArray, side: int, xi: float, s: float, sums: FloatArray
) -> tuple[float, float, float]:
    """T, along, across."""
    i, w0, w1, w2, w3 = _cell(xi, c.shape[1] - 3)
    for m in range(3 * STOP_POWERS):
        sums[m] = w0 * c[side, i, m] + w1 * c[side, i + 1, m]
        sums[m] += w2 * c[side, i + 2, m] + w3 * c[side, i + 3, m]
    f, g, h = 0.0, 0.0, 0.0
    for m in range(STOP_POWERS - 1, -1, -1):
        f = f * s + sums[3 * m]
        g = g * s + sums[3 * m + 1]
        h = h * s + sums[3 * m + 2]
    return f, g, h


@inlined
def _curve_sums(c: FloatArray, side: int, xi: float, sums: FloatArray, functions: int) -> None:
    """Polynomials of the first functions of: body, S/δ, length, κR."""
    i, w0, w1, w2, w3 = _cell(xi, c.shape[1] - 3)
    for m in range(functions * HEIGHTS):
        sums[m] = w0 * c[side, i, m] + w1 * c[side, i + 1, m]
        sums[m] += w2 * c[side, i + 2, m] + w3 * c[side, i + 3, m]


@inlined
def end_rates(delta: float) -> tuple[float, float, float]:
    """A, B and h₁, in elementary form."""
    d2 = delta * delta
    return 0.5 + 0.125 * d2, (9.0 + 4.0 * d2) / (36.0 + 4.0 * d2), 9.0 * delta / (36.0 + 4.0 * d2)


@inlined
def inverse_end_rates(delta: float) -> tuple[float, float, float]:
    """1/A, 1/B and h₁/B."""
    d2 = delta * delta
    one = 1.0 / (9.0 + 4.0 * d2)
    return 8.0 / (4.0 + d2), (36.0 + 4.0 * d2) * one, 9.0 * delta * one


@inlined
def end_logs(side: int, double_share: float) -> tuple[float, float]:
    """ln(1 + c) and ln(1 − c) from 2w."""
    small, large = math.log(double_share), math.log1p(1.0 - double_share)
    return (large, small) if side == 1 else (small, large)


@inlined
def _log_n(side: int, double_share: float, c0: float, kappa: float, delta: float,
           curve: float, log_time: float) -> float:  # fmt: skip
    """ln|N|, or with log_time = 0 the same of Q alone."""
    slow, fast, _ = end_rates(delta)
    log_plus, log_minus = end_logs(side, double_share)
    c = 1.0 - double_share if side == 1 else double_share - 1.0
    return (
        math.log(abs((c - c0) / c0))
        - kappa * (log_plus / slow + log_minus / fast - log_time)
        + curve
    )


@inlined
def _log_y(side: int, sign: float, log_n: float, kappa: float, delta: float) -> float:
    """Ln y of a number N = sign·exp(log_n) that lies on this side."""
    slow, fast, _ = end_rates(delta)
    if side == 0:
        return -(slow / kappa) * log_n
    if sign > 0.0 and log_n > 1.0:
        return -(fast / kappa) * (log_n + math.log1p(2.0 * math.exp(-log_n)))
    return -(fast / kappa) * math.log1p(1.0 + sign * math.exp(log_n))


@inlined
def _inverse_place(
    sign: float, log_n: float, kappa: float, delta: float
) -> tuple[int, float, float]:
    """Side, ξ and y of the number sign·exp(log_n)."""
    side = 0 if sign < 0.0 and log_n >= 0.0 else 1
    log_y = _log_y(side, sign, log_n, kappa, delta)
    if log_y < -0.5:
        y = math.exp(log_y)
        rest = 1.0 - y
    else:
        rest = -math.expm1(log_y)
        y = 1.0 - rest
    q = math.sqrt(math.sqrt(y))
    return side, 1.0 - math.sqrt(rest / ((1.0 + q) * (1.0 + q * q))), y


@inlined
def inverse_sum(c: FloatArray, side: int, xi: float, s: float, sums: FloatArray) -> float:
    """2w/y."""
    _curve_sums(c, side, xi, sums, 1)
    return _polynomial(sums, 0, s)


@inlined
def _heading(side: int, double_share: float, delta: float, turning: float, part: float) -> float:
    """The heading without its part h₀ ln Q."""
    slow, fast, spin_turn = end_rates(delta)
    log_plus, log_minus = end_logs(side, double_share)
    return turning / slow * log_plus + (turning - spin_turn) / fast * log_minus + delta * part


@inlined
def know_launch(
    launch: FloatArray, stops: FloatArray, curve: FloatArray, turn_inverse: FloatArray,
    constants: FloatArray, turn_share: float, sums: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """All that is known of a launch (6,): vx, vy, ω, δ, J, r, into ``out`` (14,).

    Stop time, x, y; path length, body angle, turn of the heading until Q has fallen to
    ``turn_share`` (0: not asked); Q, T; ln|N|, its sign, the heading's regular part; v.
    """
    vx, vy, spin = launch[0], launch[1], launch[2]
    delta, decel, radius = launch[3], launch[4], launch[5]
    edge = radius * spin
    speed, rim = math.hypot(vx, vy), abs(edge)
    slip = math.hypot(speed, rim)
    s = 2.0 * delta * delta - 1.0
    side, xi = slip_place(speed, rim)
    t, along, across = _stop_functions(stops, side, xi, s, sums)
    _curve_sums(curve, side, xi, sums, 4)
    body, length = _polynomial(sums, BODY_SUM, s), _polynomial(sums, LENGTH_SUM, s)
    r, part = _polynomial(sums, CURVE_SUM, s), _polynomial(sums, TURN_SUM, s)
    if rim == 0.0:
        t, along, length = 1.0, 0.5, 0.5
    elif speed == 0.0:
        t, body = 0.75, 0.375
    scale = slip / decel
    out[TIME] = scale * t
    across *= delta * edge / decel
    along *= scale
    out[STOP_X] = along * vx - across * vy
    out[STOP_Y] = along * vy + across * vx
    out[LENGTH] = scale * length * speed
    out[BODY] = scale * body * spin
    out[SLIP], out[T_LAUNCH], out[SPEED0] = slip, t, speed
    out[TURN] = out[SIGN_N] = 0.0
    if speed == 0.0 or rim == 0.0:
        return
    c0, kappa = _constant(constants, 0, s), _constant(constants, 1, s)
    turning = delta * _constant(constants, 2, s)
    quarter = _constant(constants, 3, s)
    # max + min by parts: their sum may overflow
    share = min(speed, rim) / max(speed, rim)
    double_share = max(2.0 * share / (1.0 + share), _SMALLEST_SHARE)
    sign = 1.0 if side == 1 and 1.0 - double_share > c0 else -1.0
    log_n = _log_n(side, double_share, c0, kappa, delta, r, 0.0)
    heading = _heading(side, double_share, delta, turning, part)
    out[SIGN_N], out[HEADING0] = sign, heading
    out[KAPPA], out[TURNING] = kappa, turning
    out[LOG_N] = log_n + kappa * (math.log(t) - quarter)
    if delta > 0.0 and turn_share > 0.0:
        log_share = math.log(turn_share)
        end, xi, y = _inverse_place(sign, log_n + kappa * log_share, kappa, delta)
        share = min(y * inverse_sum(turn_inverse, end, xi, s, sums), 1.0)
        _curve_sums(curve, end, place_of_share(share), sums, 2)
        part = _polynomial(sums, TURN_SUM, s)
        turn = turning * log_share + _heading(end, share, delta, turning, part) - heading
        out[TURN] = turn if edge > 0.0 else -turn


@inlined
def fill_state(
    launch: FloatArray, time: float, side: int, double_share: float,
    left: float, log_left: float, found: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """One state from what was found at its place; side −1: at rest, the launch, or φ constant."""
    known = launch[LAUNCH_COLUMNS:]
    vx, vy, spin = launch[0], launch[1], launch[2]
    delta, decel, radius = launch[3], launch[4], launch[5]
    x, y, body = known[STOP_X], known[STOP_Y], known[BODY]
    if side < 0:
        left = 1.0 - time / known[TIME] if time < known[TIME] else 0.0
        done = (1.0 - left) * (1.0 + left)
        out[PUCK_X], out[PUCK_Y], out[ORIENTATION] = x * done, y * done, body * done
        out[SPEED], out[SPIN] = left * known[SPEED0], left * spin
        out[HEADING] = known[TURN] if left == 0.0 else 0.0
        return
    around = 1.0 if spin > 0.0 else -1.0
    fall = left * known[T_LAUNCH] / found[0]
    slip = known[SLIP] * fall
    small, large = 0.5 * double_share, 1.0 - 0.5 * double_share
    norm = slip / math.sqrt(small * small + large * large)
    speed, rim = (small, large) if side == 1 else (large, small)
    speed, rim = norm * speed, norm * rim
    heading = 0.0
    if delta > 0.0:
        regular = _heading(side, double_share, delta, known[TURNING], found[4])
        heading = around * (known[TURNING] * math.log(fall) + regular - known[HEADING0])
    cosine, sine = math.cos(heading), math.sin(heading)
    # the way that is left, along and across the new heading
    along = found[1] * slip / decel * speed
    across = around * delta * found[2] * rim / decel * speed
    east, north = vx / known[SPEED0], vy / known[SPEED0]
    ahead = along * cosine - across * sine
    aside = along * sine + across * cosine
    out[PUCK_X] = x - (ahead * east - aside * north)
    out[PUCK_Y] = y - (ahead * north + aside * east)
    out[HEADING] = heading
    out[ORIENTATION] = body - around * found[3] * (slip / decel) * (rim / radius)
    out[SPEED], out[SPIN] = speed, around * rim / radius


@inlined
def place_in_time(puck: FloatArray, time: float) -> tuple[int, float, float, float, float]:
    """Side (−1: no place on the curve), ξ and y, the share of time that is left and its log."""
    known = puck[LAUNCH_COLUMNS:]
    done = time / known[TIME]
    if known[SIGN_N] == 0.0 or not 0.0 < done < 1.0:
        return -1, 0.0, 0.0, 0.0, 0.0
    log = math.log1p(-done)
    log_n = known[LOG_N] + known[KAPPA] * log
    side, xi, y = _inverse_place(known[SIGN_N], log_n, known[KAPPA], puck[3])
    return side, xi, y, 1.0 - done, log


@inlined
def functions_at(
    stops: FloatArray, curve: FloatArray, side: int, double_share: float, s: float,
    sums: FloatArray, found: FloatArray,
) -> None:  # fmt: skip
    """T, along, across, body angle, S/δ into ``found`` (5,)."""
    xi = place_of_share(double_share)
    found[0], found[1], found[2] = _stop_functions(stops, side, xi, s, sums)
    _curve_sums(curve, side, xi, sums, 2)
    found[3], found[4] = _polynomial(sums, BODY_SUM, s), _polynomial(sums, TURN_SUM, s)


@inlined
def look_up_state(
    puck: FloatArray, time: float, stops: FloatArray, curve: FloatArray, time_inverse: FloatArray,
    sums: FloatArray, found: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """One of :func:`fill_states`; ``sums`` (40,) and ``found`` (5,) are room to work."""
    side, xi, y, left, log = place_in_time(puck, time)
    if side >= 0:
        s = 2.0 * puck[3] * puck[3] - 1.0
        y = min(y * inverse_sum(time_inverse, side, xi, s, sums), 1.0)
        functions_at(stops, curve, side, y, s, sums, found)
    fill_state(puck, time, side, y, left, log, found, out)
