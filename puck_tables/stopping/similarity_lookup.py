"""States by look-up, compiled: along the universal curve and back.

The signed number

    N = sign(c − c₀) exp(κ (ln Q + ln T)) / (its modulus at φ = π/4)

(ln Q of :mod:`puck_tables.stopping.similarity`) falls along every motion like the κ-th power of the
time that is left, N ∝ (t₀ − t)^κ, and is one and the same monotonic function of c for both generic
classes: negative below the limit ratio, −1 at π/4, positive above.  Its inverse is tabulated, so a
state at a time is found without solving anything.  Without ln T the same holds for Q itself.

The inverse is tabulated over the place ξ of

    y = (−N)^(−A/κ)  for N ≤ −1 (v > r|ω|),    y = (2 + N)^(−B/κ)  above,

which is 1 at π/4 and proportional to 2w = 2 min(v, r|ω|)/(v + r|ω|) at the ends; what is splined is
2w/y, and beside it all that stands there: T, along, across, body angle, and the heading's part G,

    δ G = regular − a ln y [− h₀ ln T],    a = h₀/A for v > r|ω|, (h₀ − h₁)/B above,

in which ln 2w = ln y + ln(2w/y) leaves nothing singular.

One launch and one moment are looked up here; many, with the same formulas, by
:mod:`puck_tables.stopping.launch_lookup` and :mod:`puck_tables.stopping.state_lookup`.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, spline_values
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, log_of
from puck_tables.kernels.quadratic import basis, cell_at
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN
from puck_tables.stopping.lookup import CONSTANT_HEIGHTS, HEIGHTS, STOP_POWERS, WIDTH, slip_place

Numbers = tuple[float, ...]

MOTION_WIDTH = 4  # body angle, S/δ, κR, path length
TURN_FUNCTION, LOG_FUNCTION = 1, 2  # of these
STOPS_WIDTH = 8  # 2w/y, T, along, across; body angle, G and nothing
REGULAR = 5  # G of these
TURN_STEP, TURN_POWERS = 4, 3  # of one function: powers m, m + 4, m + 8 of s, m = 0 … 3
TINY = 1e-300  # its logarithm is a number

# rows of what is known of a launch
TIME, STOP_X, STOP_Y, LENGTH, BODY, TURN = range(6)
SLIP, SPEED0, T_LAUNCH, LOG_N, SIGN_N, HEADING0, KAPPA, TURNING = range(6, 14)
LAUNCH_ROWS = 14  # the fourteen above
LAUNCH_COLUMNS = 6  # vx, vy, ω, δ, J, r


@inlined
def log_place(
    sign: float, log_n: float, kappa: float, slow: float, fast: float
) -> tuple[bool, float]:
    """Whether r|ω| > v, and ln y of the number sign·exp(log_n), by arithmetic alone."""
    is_slow = (sign < 0.0) & (log_n >= 0.0)
    is_large = (sign > 0.0) & (log_n > 1.0)
    moderate = log_n if log_n < 1.0 else 1.0
    power = exp_of(-log_n if is_large else moderate)
    log = log_of(1.0 + 2.0 * power if is_large else 2.0 + sign * power)
    log_fast = fast * (log + (log_n if is_large else 0.0))
    return not is_slow, -(slow * log_n if is_slow else log_fast) / kappa


@inlined
def place_of_log(log_y: float) -> tuple[float, float]:
    """Y and ξ from ln y ≤ 0."""
    y = exp_of(log_y if log_y < 0.0 else 0.0)
    q = math.sqrt(math.sqrt(y))
    return y, 1.0 - math.sqrt((1.0 - y) / ((1.0 + q) * (1.0 + q * q)))


@inlined
def cell_of(xi: float, is_fast: bool, cells: float, row: int) -> tuple[float, float]:
    """The place of the first row of a cell in a flat table, and that in the cell."""
    p = xi * cells
    inside = p if p > 0.0 else 0.0
    last = cells - 1.0
    cell = np.floor(inside if inside < last else last)
    return row * (cell + (cells + 3.0 if is_fast else 0.0)), p - cell


@inlined
def constants_at(constants: FloatArray, s: float) -> tuple[float, float, float, float]:
    """c₀, κ, h₀/δ and ln T(π/4) from their polynomials (4, 14) in s = 2δ² − 1."""
    c0, kappa, turning, quarter = 0.0, 0.0, 0.0, 0.0
    for m in range(CONSTANT_HEIGHTS - 1, -1, -1):
        c0, kappa = c0 * s + constants[0, m], kappa * s + constants[1, m]
        turning, quarter = turning * s + constants[2, m], quarter * s + constants[3, m]
    return c0, kappa, turning, quarter


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
def state_at_one_angle(
    left: float, stop: Numbers, speed: float, spin: float, turn: float
) -> Numbers:
    """X, y, heading, body angle, v and ω where φ stays as at the launch, or at rest.

    ``left``: the share of the time to the stop that is left; ``stop``: x, y, body angle; ``speed``,
    ``spin``: of the launch; ``turn``: the heading at rest.
    """
    done = (1.0 - left) * (1.0 + left)
    return (
        stop[0] * done, stop[1] * done, turn if left == 0.0 else 0.0, stop[2] * done, left * speed,
        left * spin,
    )  # fmt: skip


@inlined
def place_after(
    log_left: float, sign: float, log_n: float, kappa: float, turning: float, delta: float
) -> tuple[bool, float, float]:
    """Where a motion is when its time, or Q, has fallen so far: whether r|ω| > v, and ln y.

    And the heading's part h₀ ln Q with what is singular of the rest.
    """
    slow, fast, _ = end_rates(delta)
    by_slow, by_fast, spin_turn = inverse_end_rates(delta)
    is_fast, log_y = log_place(sign, log_n + kappa * log_left, kappa, slow, fast)
    by_fast = turning * by_fast - spin_turn
    swung = turning * log_left + (by_fast if is_fast else turning * by_slow) * log_y
    return is_fast, log_y, swung


@inlined
def look_up_launch(
    launch: FloatArray, stops: FloatArray, functions: FloatArray, constants: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """All that is known of a launch (6,): vx, vy, ω, δ, J, r, into ``out`` (14,).

    Stop time, x, y; path length, body angle, nothing; Q, v, T; ln|N|, its sign, the heading's
    regular part; κ, h₀.  Tables as :func:`puck_tables.stopping.launch_lookup.fill_launch_lookup`
    reads them.
    """
    vx, vy, spin = launch[0], launch[1], launch[2]
    delta, decel, radius = launch[3], launch[4], launch[5]
    edge = radius * spin
    speed, rim = math.hypot(vx, vy), abs(edge)
    slip = math.hypot(speed, rim)
    s = 2.0 * delta * delta - 1.0
    side, xi = slip_place(speed, rim)
    cells = stops.shape[1] - 3
    place = xi * cells
    cell = cell_at(place, cells)
    node, weights = side * stops.shape[1] + cell, basis(place - cell)
    t, along, across, _ = spline_values(
        stops.reshape(-1), WIDTH * STOP_POWERS * node, weights, s, WIDTH, STOP_POWERS
    )
    body, part, regular, length = spline_values(
        functions.reshape(-1), MOTION_WIDTH * HEIGHTS * node, weights, s, MOTION_WIDTH, HEIGHTS
    )
    out[TIME], out[STOP_X], out[STOP_Y], out[LENGTH], out[BODY], t = stopped(
        vx, vy, edge, spin, speed, slip, delta, decel, (t, along, across, body, length)
    )
    out[SLIP], out[T_LAUNCH], out[SPEED0] = slip, t, speed
    out[TURN] = out[SIGN_N] = 0.0
    if speed == 0.0 or rim == 0.0:
        return
    c0, kappa, turning, quarter = constants_at(constants, s)
    turning, is_fast, share = delta * turning, side == 1, share_of(speed, rim)
    out[SIGN_N], log_n = number_at(is_fast, share, c0, kappa, delta, regular)
    out[HEADING0] = heading_at(is_fast, share, turning, delta, part)
    out[KAPPA], out[TURNING] = kappa, turning
    out[LOG_N] = log_n + kappa * (log_of(t) - quarter)


@inlined
def look_up_state(puck: FloatArray, time: float, splines: FloatArray, out: FloatArray) -> None:
    """The state of a puck (20,), its launch and what is known of it, at a time, into ``out`` (6,).

    ``splines`` as :func:`puck_tables.stopping.state_lookup.fill_states_at` reads them.
    """
    known = puck[LAUNCH_COLUMNS:]
    x, y, body, spin = known[STOP_X], known[STOP_Y], known[BODY], puck[2]
    elapsed = time / known[TIME]
    if known[SIGN_N] == 0.0 or not 0.0 < elapsed < 1.0:  # at rest, the launch, or φ constant
        left = 1.0 - elapsed if time < known[TIME] else 0.0
        (out[PUCK_X], out[PUCK_Y], out[HEADING], out[ORIENTATION], out[SPEED], out[SPIN]) = (
            state_at_one_angle(left, (x, y, body), known[SPEED0], spin, known[TURN])
        )
        return
    delta, turning = puck[3], known[TURNING]
    is_fast, log_y, swung = place_after(
        math.log1p(-elapsed), known[SIGN_N], known[LOG_N], known[KAPPA], turning, delta
    )
    part, xi = place_of_log(log_y)
    first, inside = cell_of(xi, is_fast, float(splines.shape[1] - 3), STOPS_WIDTH * HEIGHTS)
    f = spline_values(
        splines.reshape(-1), int(first), basis(inside), 2.0 * delta * delta - 1.0, STOPS_WIDTH,
        HEIGHTS,
    )  # fmt: skip
    turn = swung + turning * log_of(known[T_LAUNCH]) - known[HEADING0] + delta * f[REGULAR]
    (out[PUCK_X], out[PUCK_Y], out[HEADING], out[ORIENTATION], out[SPEED], out[SPIN]) = state_there(
        (puck[0], puck[1], spin, delta, puck[4], puck[5], known[SPEED0]), (x, y, body), is_fast,
        min(part * f[0], 1.0), known[SLIP] * ((1.0 - elapsed) * known[T_LAUNCH] / f[1]),
        turn if spin > 0.0 else -turn, (f[2], f[3], f[4]),
    )  # fmt: skip
