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
from puck_tables.kernels.elementary import cosine_sine_of, log_of
from puck_tables.kernels.spline import basis, cell_at
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN
from puck_tables.stopping.axes import HEIGHTS
from puck_tables.stopping.lookup import STOP_POWERS, slip_place
from puck_tables.stopping.state_splines import TINY, log_place, place_of_log

Numbers = tuple[float, ...]

# order of the functions of the curve
BODY_SUM, TURN_SUM, LENGTH_SUM, CURVE_SUM = range(4)

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
def _similarity_sums(c: FloatArray, side: int, xi: float, sums: FloatArray, functions: int) -> None:
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
def stopped(
    vx: float, vy: float, edge: float, spin: float, speed: float, slip: float, delta: float,
    decel: float, f: Numbers,
) -> Numbers:  # fmt: skip
    """Stop time, x, y, path length, body angle and T; ``edge``: rω.

    From T, along, across, body angle and path length at the place of the launch.
    """
    no_spin, still = edge == 0.0, speed == 0.0
    t = 1.0 if no_spin else (0.75 if still else f[0])
    scale = slip / decel
    along = scale * (0.5 if no_spin else f[1])
    across = f[2] * (delta * edge / decel)
    body, length = 0.375 if still else f[3], 0.5 if no_spin else f[4]
    return (
        scale * t, along * vx - across * vy, along * vy + across * vx, scale * length * speed,
        scale * body * spin, t,
    )  # fmt: skip


@inlined
def share_of(speed: float, rim: float) -> float:
    """2w of a launch, at least the least whose logarithm is a number."""
    larger, smaller = max(speed, rim), min(speed, rim)
    # max + min by parts: their sum may overflow
    ratio = smaller / (larger if larger > 0.0 else 1.0)
    return max(2.0 * ratio / (1.0 + ratio), TINY)


@inlined
def ends_of(is_fast: bool, share: float, delta: float) -> tuple[float, float]:
    """ln(1 + c)/A and ln(1 − c), from 2w."""
    by_slow, _, _ = inverse_end_rates(delta)
    small, large = log_of(share), log_of(2.0 - share)
    return by_slow * (large if is_fast else small), small if is_fast else large


@inlined
def heading_at(is_fast: bool, share: float, turning: float, delta: float, part: float) -> float:
    """The heading without its part h₀ ln Q; ``part``: S/δ there."""
    plus, minus = ends_of(is_fast, share, delta)
    _, by_fast, spin_turn = inverse_end_rates(delta)
    return turning * plus + (turning * by_fast - spin_turn) * minus + delta * part


@inlined
def number_at(
    is_fast: bool, share: float, c0: float, kappa: float, delta: float, regular: float
) -> tuple[float, float]:
    """Sign and ln of the number of Q alone; ``regular``: κR there."""
    plus, minus = ends_of(is_fast, share, delta)
    _, by_fast, _ = inverse_end_rates(delta)
    c = 1.0 - share if is_fast else share - 1.0
    sign = 1.0 if is_fast & (1.0 - share > c0) else -1.0
    log_n = log_of(max(abs((c - c0) / c0), TINY)) - kappa * (plus + by_fast * minus)
    return sign, log_n + regular


@inlined
def state_there(
    launch: Numbers, stop: Numbers, is_fast: bool, share: float, slip: float, turn: float,
    f: Numbers,
) -> Numbers:  # fmt: skip
    """X, y, heading, body angle, v and ω at a place of the curve, in the frame of the launch.

    ``launch``: vx, vy, ω, δ, J, r, v; ``stop``: x, y, body angle; ``slip``: Q there; ``f``: along,
    across, body angle there.
    """
    vx, vy, spin, delta, decel, radius, launch_speed = launch
    around = 1.0 if spin > 0.0 else -1.0
    small, large = 0.5 * share, 1.0 - 0.5 * share
    norm = slip / math.sqrt(small * small + large * large)
    speed, rim = norm * (small if is_fast else large), norm * (large if is_fast else small)
    cosine, sine = cosine_sine_of(turn)
    duration = slip / decel
    # the way that is left, along and across the new heading
    along, across = f[0] * duration * speed, around * delta * f[1] * (rim / decel) * speed
    one = 1.0 / (launch_speed if launch_speed > 0.0 else 1.0)
    east, north = vx * one, vy * one
    ahead, aside = along * cosine - across * sine, along * sine + across * cosine
    turning = around * (rim / radius)
    return (
        stop[0] - (ahead * east - aside * north), stop[1] - (ahead * north + aside * east), turn,
        stop[2] - f[2] * duration * turning, speed, turning,
    )  # fmt: skip


@inlined
def inverse_sum(c: FloatArray, side: int, xi: float, s: float, sums: FloatArray) -> float:
    """2w/y."""
    _similarity_sums(c, side, xi, sums, 1)
    return _polynomial(sums, 0, s)


@inlined
def look_up_launch(
    launch: FloatArray, stops: FloatArray, nodes: FloatArray, turn_inverse: FloatArray,
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
    _similarity_sums(nodes, side, xi, sums, 4)
    body, length = _polynomial(sums, BODY_SUM, s), _polynomial(sums, LENGTH_SUM, s)
    r, part = _polynomial(sums, CURVE_SUM, s), _polynomial(sums, TURN_SUM, s)
    out[TIME], out[STOP_X], out[STOP_Y], out[LENGTH], out[BODY], t = stopped(
        vx, vy, edge, spin, speed, slip, delta, decel, (t, along, across, body, length)
    )
    out[SLIP], out[T_LAUNCH], out[SPEED0] = slip, t, speed
    out[TURN] = out[SIGN_N] = 0.0
    if speed == 0.0 or rim == 0.0:
        return
    c0, kappa = _constant(constants, 0, s), _constant(constants, 1, s)
    turning = delta * _constant(constants, 2, s)
    share = share_of(speed, rim)
    sign, log_n = number_at(side == 1, share, c0, kappa, delta, r)
    heading = heading_at(side == 1, share, turning, delta, part)
    out[SIGN_N], out[HEADING0] = sign, heading
    out[KAPPA], out[TURNING] = kappa, turning
    out[LOG_N] = log_n + kappa * (log_of(t) - _constant(constants, 3, s))
    if delta > 0.0 and turn_share > 0.0:
        log_share = math.log(turn_share)
        slow, fast, _ = end_rates(delta)
        is_fast, log_y = log_place(sign, log_n + kappa * log_share, kappa, slow, fast)
        y, xi = place_of_log(log_y)
        end = 1 if is_fast else 0
        share = max(min(y * inverse_sum(turn_inverse, end, xi, s, sums), 1.0), TINY)
        _similarity_sums(nodes, end, place_of_share(share), sums, 2)
        part = _polynomial(sums, TURN_SUM, s)
        later = heading_at(is_fast, share, turning, delta, part)
        turn = turning * log_share + later - heading
        out[TURN] = turn if edge > 0.0 else -turn


@inlined
def functions_at(
    stops: FloatArray, nodes: FloatArray, side: int, double_share: float, s: float,
    sums: FloatArray, result: FloatArray,
) -> None:  # fmt: skip
    """T, along, across, body angle, S/δ into ``result`` (5,)."""
    xi = place_of_share(double_share)
    result[0], result[1], result[2] = _stop_functions(stops, side, xi, s, sums)
    _similarity_sums(nodes, side, xi, sums, 2)
    result[3], result[4] = _polynomial(sums, BODY_SUM, s), _polynomial(sums, TURN_SUM, s)


@inlined
def look_up_state(
    puck: FloatArray, time: float, stops: FloatArray, nodes: FloatArray, time_inverse: FloatArray,
    sums: FloatArray, result: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """One state; ``sums`` (40,) and ``result`` (5,) are room to work."""
    known = puck[LAUNCH_COLUMNS:]
    x, y, body, spin = known[STOP_X], known[STOP_Y], known[BODY], puck[2]
    elapsed = time / known[TIME]
    if known[SIGN_N] == 0.0 or not 0.0 < elapsed < 1.0:  # at rest, the launch, or φ constant
        left = 1.0 - elapsed if time < known[TIME] else 0.0
        done = (1.0 - left) * (1.0 + left)
        out[PUCK_X], out[PUCK_Y], out[ORIENTATION] = x * done, y * done, body * done
        out[SPEED], out[SPIN] = left * known[SPEED0], left * spin
        out[HEADING] = known[TURN] if left == 0.0 else 0.0
        return
    delta, kappa, turning = puck[3], known[KAPPA], known[TURNING]
    s = 2.0 * delta * delta - 1.0
    slow, fast, _ = end_rates(delta)
    log_n = known[LOG_N] + kappa * math.log1p(-elapsed)
    is_fast, log_y = log_place(known[SIGN_N], log_n, kappa, slow, fast)
    part, xi = place_of_log(log_y)
    side = 1 if is_fast else 0
    share = max(min(part * inverse_sum(time_inverse, side, xi, s, sums), 1.0), TINY)
    functions_at(stops, nodes, side, share, s, sums, result)
    fall = (1.0 - elapsed) * known[T_LAUNCH] / result[0]
    heading = heading_at(is_fast, share, turning, delta, result[4])
    turn = turning * log_of(fall) + heading - known[HEADING0] if delta > 0.0 else 0.0
    (
        out[PUCK_X], out[PUCK_Y], out[HEADING], out[ORIENTATION], out[SPEED], out[SPIN],
    ) = state_there(
        (puck[0], puck[1], spin, delta, puck[4], puck[5], known[SPEED0]), (x, y, body), is_fast,
        share, known[SLIP] * fall, turn if spin > 0.0 else -turn,
        (result[1], result[2], result[3]),
    )  # fmt: skip
