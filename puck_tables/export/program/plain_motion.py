"""Where and when a launch stops, and its states on the way, of plain pucks.

A launch is measured in natural units; its place in the tables tells its stop.  States lie along the
one curve that all motions are: the number N of :mod:`puck_tables.stopping.similarity_lookup` falls
along a motion like a power of the time that is left; a table tells the slip from it.
"""

from __future__ import annotations

from math import cos, exp, expm1, log, log1p, nan, sin, sqrt

from puck_tables.export.program.intrinsics import Numbers, Out, Rows, room

# tables of one error: cells, degree, powers, quantum and numbers; all that stands here stands for
# what a file is written with
STOP: Numbers = ()
STOP_ROWS: Rows = ()
STOP_DEGREE, STOP_POWERS, STOP_QUANTUM = 1, 1, 1.0
SIMILARITY: Numbers = ()
SIMILARITY_ROWS: Rows = ()
SIMILARITY_DEGREE, SIMILARITY_POWERS, SIMILARITY_QUANTUM = 1, 1, 1.0
INVERSE: Numbers = ()
INVERSE_ROWS: Rows = ()
INVERSE_DEGREE, INVERSE_POWERS, INVERSE_QUANTUM = 1, 1, 1.0
CONSTANTS: Numbers = ()
CONSTANTS_POWERS, CONSTANTS_QUANTUM = 1, 1.0
# the kind of puck: its largest delta, s = STEEP delta^2 - 1 from -1 to 1, how long pure spin lasts
# and more than any motion does, in Q/J; and the error of a file
TALLEST, STEEP, SPIN_TIME, LONGEST, TOLERANCE = 1.0, 2.0, 0.75, 2.0, 1.0

MOST_WEIGHTS, WIDEST = 8, 70  # room for any degree, and for any row, that a file is written with
LARGEST = 8e307  # of places, and of places over radii
SMALLEST = 1e-300  # its reciprocal is still a number
TURN_SHARE = 1e-3  # of Q: where the turn of a heading is read off
ROUNDS = 12  # of Newton's method at most
# of a measured launch
SLIP, SPEED, RIM, EAST, NORTH, SIDE, SHARE, AROUND = 0, 1, 2, 3, 4, 5, 6, 7
MEASURED = 8  # the eight above
# beside what is measured of a launch
KAPPA, TURNING, LOG_N, SIGN, HEADING, T_LAUNCH = 8, 9, 10, 11, 12, 13
KNOWN = 14  # with the six above
# of a place on the curve
THERE_SIDE, THERE_SHARE, REGULAR = 0, 1, 2
# of the functions of a stop
TIME, ALONG, ACROSS, LENGTH, BODY = 0, 1, 2, 3, 4
STOP_FUNCTIONS = 5  # T, X, Y, path, body angle


def refused(out: Out, size: int, code: int) -> int:
    """The code of a refusal; all results are not a number."""
    for n in range(size):
        out[n] = nan
    return code


def measured(
    vx: float, vy: float, spin: float, delta: float, decel: float, radius: float, m: Out
) -> int:
    """What a launch is, and the code of a refusal.

    m: 0 slip speed Q, 1 v/Q, 2 r|w|/Q, 3 vx/Q, 4 vy/Q, 5 whether r|w| > v, 6 2 min(v, r|w|)/(v +
    r|w|), 7 the sign of w.
    """
    # 0, or not a number where one of them is infinite or none
    none: float = vx - vx + (vy - vy) + (spin - spin) + (decel - decel) + (radius - radius)
    if not (none == 0.0 and delta >= 0.0 and delta <= TALLEST and decel > 0.0 and radius > 0.0):
        return 1
    edge: float = radius * spin
    if edge - edge != 0.0:
        return 2
    x: float = vx
    y: float = vy
    e: float = edge
    large: float = abs(vx) + abs(vy) + abs(edge)
    if large > 1e-100 and large < 1e100:
        large = 1.0
    else:  # squares would leave floating point
        large = abs(vx) if abs(vx) > abs(vy) else abs(vy)
        large = abs(edge) if abs(edge) > large else large
        if large == 0.0:
            for n in range(AROUND):
                m[n] = 0.0
            m[AROUND] = 1.0
            return 0
        x = vx / large
        y = vy / large
        e = edge / large
    speed2: float = x * x + y * y
    speed: float = sqrt(speed2)
    rim: float = abs(e)
    q: float = sqrt(speed2 + e * e)
    unit: float = 1.0 / q
    m[SLIP] = large * q
    m[SPEED] = speed * unit
    m[RIM] = rim * unit
    m[EAST] = x * unit
    m[NORTH] = y * unit
    m[SIDE] = 1.0 if rim > speed else 0.0
    m[SHARE] = 2.0 * (rim if rim < speed else speed) / (speed + rim)
    m[AROUND] = -1.0 if edge < 0.0 else 1.0
    size: float = LONGEST * (m[SLIP] / decel) * m[SLIP]
    return 0 if size < LARGEST and size < LARGEST * radius else 2


def place_of(double_share: float) -> float:
    """The place xi on the axis of the tables, from 2 min(v, r|w|)/(v + r|w|)."""
    q: float = sqrt(double_share)
    return 1.0 - sqrt(1.0 - q if q < 1.0 else 0.0)


def look_up(
    table: Numbers, first: int, cells: int, degree: int, powers: int, functions: int,
    quantum: float, xi: float, s: float, out_row: Out,
) -> None:  # fmt: skip
    """The functions of a table, from its number first on, at a place and at a height s."""
    w = room(MOST_WEIGHTS)
    p: float = xi * cells
    cell: int = int(p)
    cell = cells - 1 if cell > cells - 1 else cell
    t: float = p - cell
    # uniform B-splines times the factorial of their degree, which the quantum takes out
    w[0] = quantum
    for d in range(1, degree + 1):
        saved: float = 0.0
        for r in range(d):
            part: float = w[r]
            w[r] = saved + (r + 1 - t) * part
            saved = (t + (d - 1 - r)) * part
        w[d] = saved
    width: int = powers * functions
    here: int = first + cell * width
    row = room(WIDEST)
    for j in range(width):
        row[j] = w[0] * table[here + j]
    for n in range(1, degree + 1):
        for j in range(width):
            row[j] += w[n] * table[here + n * width + j]
    for f in range(functions):
        value: float = row[width - functions + f]
        for k in range(powers - 2, -1, -1):
            value = value * s + row[k * functions + f]
        out_row[f] = value


def table_at(side: int, share: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle by look-up; side 1 where r|w| > v."""
    look_up(
        STOP, STOP_ROWS[side] * STOP_POWERS * STOP_FUNCTIONS,
        STOP_ROWS[side + 1] - STOP_ROWS[side] - STOP_DEGREE, STOP_DEGREE, STOP_POWERS,
        STOP_FUNCTIONS, STOP_QUANTUM, place_of(share), STEEP * delta * delta - 1.0, f,
    )  # fmt: skip


def stop_functions(side: int, share: float, delta: float, f: Out) -> None:
    """The functions of a stop: by look-up, in pure sliding and in pure spin exactly."""
    table_at(side, share, delta, f)
    if share == 0.0 and side == 0:
        f[TIME] = 1.0
        f[ALONG] = 0.5
        f[LENGTH] = 0.5
    elif share == 0.0:
        f[TIME] = SPIN_TIME
        f[BODY] = 0.5 * SPIN_TIME


def stopped(m: Out, f: Out, delta: float, decel: float, radius: float, out: Out) -> None:
    """Stop time, place, path length and body angle of a measured launch."""
    duration: float = m[SLIP] / decel
    size: float = duration * m[SLIP]
    across: float = delta * m[AROUND] * m[RIM] * f[ACROSS]
    out[0] = duration * f[TIME]
    out[1] = size * (f[ALONG] * m[EAST] - across * m[NORTH])
    out[2] = size * (f[ALONG] * m[NORTH] + across * m[EAST])
    out[3] = size * m[SPEED] * f[LENGTH]
    out[4] = size / radius * m[AROUND] * m[RIM] * f[BODY]


def stop(
    vx: float, vy: float, spin: float, delta: float, decel: float, radius: float, out: Out
) -> int:
    """Stop time s, place x m, y m, path length m and body angle rad of a launch, into out[5].

    vx, vy m/s; spin rad/s, counter-clockwise positive; delta = 2 f h / r from 0 to TALLEST;
    decel = f g m/s^2; radius m.  Errors: the tolerance times Q/J, Q^2/J, Q^2/J and Q^2/(J r), where
    Q = hypot(v, r w) and J is decel.  Returns 0; 1 where a number is not finite or out of range, 2
    where the motion is too large for floating point: nothing but NaN is in out then.
    """
    m = room(MEASURED)
    f = room(5)
    code: int = measured(vx, vy, spin, delta, decel, radius, m)
    if code != 0:
        return refused(out, 5, code)
    stop_functions(int(m[SIDE]), m[SHARE], delta, f)
    stopped(m, f, delta, decel, radius, out)
    return 0


def constant(row: int, s: float) -> float:
    """One of the numbers that depend on the height alone."""
    total: float = 0.0
    for m in range(CONSTANTS_POWERS - 1, -1, -1):
        total = total * s + CONSTANTS[row * CONSTANTS_POWERS + m]
    return CONSTANTS_QUANTUM * total


def slow_rate(delta: float) -> float:
    """How fast pure sliding is left."""
    return 0.5 + 0.125 * delta * delta


def fast_rate(delta: float) -> float:
    """How fast pure spin is left."""
    return (9.0 + 4.0 * delta * delta) / (36.0 + 4.0 * delta * delta)


def regular_heading(
    side: int, double_share: float, delta: float, turning: float, part: float
) -> float:
    """The heading, but for its part that goes with ln Q."""
    small: float = log(double_share)
    large: float = log1p(1.0 - double_share)
    plus: float = large if side == 1 else small
    minus: float = small if side == 1 else large
    spin_turn: float = 9.0 * delta / (36.0 + 4.0 * delta * delta)
    return (
        turning / slow_rate(delta) * plus
        + (turning - spin_turn) / fast_rate(delta) * minus
        + delta * part
    )


def similarity_at(side: int, share: float, s: float, out_row: Out) -> None:
    """The regular parts of ln N and of the heading."""
    look_up(
        SIMILARITY, SIMILARITY_ROWS[side] * SIMILARITY_POWERS * 2,
        SIMILARITY_ROWS[side + 1] - SIMILARITY_ROWS[side] - SIMILARITY_DEGREE, SIMILARITY_DEGREE,
        SIMILARITY_POWERS, 2, SIMILARITY_QUANTUM, place_of(share), s, out_row,
    )  # fmt: skip


def know(delta: float, time: float, launch: Out) -> None:
    """What the curve says of a measured launch that both slides and spins; ``time``: its T."""
    c = room(2)
    s: float = 2.0 * delta * delta - 1.0
    side: int = int(launch[SIDE])
    share: float = launch[SHARE]
    similarity_at(side, share, s, c)
    share = share if share > SMALLEST else SMALLEST
    limit: float = constant(0, s)
    kappa: float = constant(1, s)
    turning: float = delta * constant(2, s)
    small: float = log(share)
    large: float = log1p(1.0 - share)
    plus: float = large if side == 1 else small
    minus: float = small if side == 1 else large
    place: float = 1.0 - share if side == 1 else share - 1.0
    gap: float = abs((place - limit) / limit)
    gap = gap if gap > SMALLEST else SMALLEST
    launch[KAPPA] = kappa
    launch[TURNING] = turning
    launch[SIGN] = 1.0 if place > limit else -1.0
    launch[LOG_N] = (
        log(gap)
        - kappa * (plus / slow_rate(delta) + minus / fast_rate(delta))
        + kappa * (log(time) - constant(3, s))
        + c[0]
    )
    launch[HEADING] = regular_heading(side, share, delta, turning, c[1])
    launch[T_LAUNCH] = time


def arrive(launch: Out, delta: float, log_left: float, place: Out, f: Out) -> None:
    """The place on the curve and the functions of a stop there, from the time that is left."""
    c = room(2)
    s: float = 2.0 * delta * delta - 1.0
    sign: float = launch[SIGN]
    log_n: float = launch[LOG_N] + launch[KAPPA] * log_left
    side: int = 0 if sign < 0.0 and log_n >= 0.0 else 1
    log_y: float = 0.0
    if side == 0:
        log_y = -slow_rate(delta) / launch[KAPPA] * log_n
    elif sign > 0.0 and log_n > 1.0:
        log_y = -fast_rate(delta) / launch[KAPPA] * (log_n + log1p(2.0 * exp(-log_n)))
    else:
        log_y = -fast_rate(delta) / launch[KAPPA] * log1p(1.0 + sign * exp(log_n))
    y: float = exp(log_y)
    rest: float = -expm1(0.25 * log_y)
    xi: float = 1.0 - sqrt(rest if rest > 0.0 else 0.0)
    look_up(
        INVERSE, INVERSE_ROWS[side] * INVERSE_POWERS,
        INVERSE_ROWS[side + 1] - INVERSE_ROWS[side] - INVERSE_DEGREE, INVERSE_DEGREE,
        INVERSE_POWERS, 1, INVERSE_QUANTUM, xi, s, c,
    )  # fmt: skip
    share: float = y * c[0]
    share = 1.0 if share > 1.0 else share
    share = share if share > SMALLEST else SMALLEST
    stop_functions(side, share, delta, f)
    similarity_at(side, share, s, c)
    place[THERE_SIDE] = side
    place[THERE_SHARE] = share
    place[REGULAR] = regular_heading(side, share, delta, launch[TURNING], c[1])


def state(
    vx: float, vy: float, spin: float, delta: float, decel: float, radius: float, time: float,
    out: Out,
) -> int:  # fmt: skip
    """Place x m, y m, body angle rad, velocity vx, vy m/s and spin rad/s at a time, into out[6].

    The launch is that of stop(); time s >= 0 after it, at rest from the stop on.  Errors: the
    tolerance times Q^2/J (place), Q^2/(J r) (angle), Q (velocity) and Q/r (spin) of the launch.
    Returns 0, 1 or 2 as stop() does.
    """
    launch = room(KNOWN)
    f = room(5)
    g = room(5)
    end = room(5)
    place = room(3)
    code: int = measured(vx, vy, spin, delta, decel, radius, launch)
    if not (time - time == 0.0 and time >= 0.0):
        code = 1
    if code != 0:
        return refused(out, 6, code)
    stop_functions(int(launch[SIDE]), launch[SHARE], delta, f)
    stopped(launch, f, delta, decel, radius, end)
    left: float = 1.0 - time / end[0] if time < end[0] else 0.0
    if left == 0.0 or launch[SPEED] == 0.0 or launch[RIM] == 0.0 or time == 0.0:
        done: float = (1.0 - left) * (1.0 + left)
        out[0] = end[1] * done
        out[1] = end[2] * done
        out[2] = end[4] * done
        out[3] = left * vx
        out[4] = left * vy
        out[5] = left * spin
        return 0
    slip: float = launch[SLIP]
    around: float = launch[AROUND]
    size: float = slip / decel * slip
    know(delta, f[TIME], launch)
    arrive(launch, delta, log1p(-(time / end[0])), place, g)
    fall: float = left * launch[T_LAUNCH] / g[TIME]
    small: float = 0.5 * place[THERE_SHARE]
    large: float = 1.0 - small
    unit: float = fall / sqrt(small * small + large * large)
    now: float = unit * (small if place[THERE_SIDE] == 1.0 else large)
    turn: float = unit * (large if place[THERE_SIDE] == 1.0 else small)
    heading: float = 0.0
    if delta > 0.0:
        heading = around * (launch[TURNING] * log(fall) + place[REGULAR] - launch[HEADING])
    cosine: float = cos(heading)
    sine: float = sin(heading)
    east: float = (cosine * launch[EAST] - sine * launch[NORTH]) / launch[SPEED]
    north: float = (cosine * launch[NORTH] + sine * launch[EAST]) / launch[SPEED]
    ahead: float = size * fall * now * g[ALONG]
    aside: float = size * around * delta * turn * now * g[ACROSS]
    out[0] = end[1] - (ahead * east - aside * north)
    out[1] = end[2] - (ahead * north + aside * east)
    out[2] = end[4] - size / radius * around * fall * turn * g[BODY]
    out[3] = slip * now * east
    out[4] = slip * now * north
    out[5] = slip / radius * around * turn
    return 0


def turn(
    vx: float, vy: float, spin: float, delta: float, decel: float, radius: float, out: Out
) -> int:
    """How far the heading turns until Q has fallen to 1/1000, rad, into out[1].

    For delta > 0 it turns on without end.  The launch is that of stop(), the error the tolerance in
    rad, the code as there.
    """
    launch = room(KNOWN)
    g = room(5)
    place = room(3)
    code: int = measured(vx, vy, spin, delta, decel, radius, launch)
    if code != 0:
        return refused(out, 1, code)
    out[0] = 0.0
    if launch[SPEED] == 0.0 or launch[RIM] == 0.0 or delta == 0.0:
        return 0
    stop_functions(int(launch[SIDE]), launch[SHARE], delta, g)
    know(delta, g[TIME], launch)
    left: float = TURN_SHARE
    for _ in range(ROUNDS):  # T changes little: each round takes an error to a tenth or less
        arrive(launch, delta, log(left), place, g)
        left = TURN_SHARE * g[TIME] / launch[T_LAUNCH]
    heading: float = launch[TURNING] * log(TURN_SHARE) + place[REGULAR] - launch[HEADING]
    out[0] = launch[AROUND] * heading
    return 0
