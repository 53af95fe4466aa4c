"""Where and when a launch stops, and its states on the way.

A launch is measured in natural units; its place in the tables tells its stop.  States lie on the
two orbits that all motions of a kind of puck are (:mod:`puck_tables.export.law_values`): a launch
is found on its orbit by secants, and its state where the logarithm of the time left has fallen.
"""

from __future__ import annotations

from math import cos, exp, log, log1p, nan, sin, sqrt

from puck_tables.export.program.intrinsics import Out, room
from puck_tables.export.program.look_ups import (
    END,
    RATE_UNITS,
    REACH,
    STEEP,
    TALLEST,
    constant,
    limit_motion_at,
    stop_table_at,
)

# what a file is written with: how long pure spin lasts and more than any motion does, in Q/J; and
# the error of a file
SPIN_TIME, LONGEST, TOLERANCE = 0.75, 2.0, 1.0

LARGEST = 8e307  # of places, and of places over radii
SMALLEST = 1e-300  # its reciprocal is still a number
TURN_SHARE = 1e-3  # of Q: where the turn of a heading is read off
ROUNDS = 12  # of Newton's method at most
SEARCH, FARTHEST = 40, 1e3  # secants at most; more than any z is, where shares are numbers
CLOSE, FAINT = 0.01, 0.05  # of the error of a file: where a launch is found, from the limit
# of a measured launch
SLIP, SPEED, RIM, EAST, NORTH, SIDE, SHARE, AROUND = 0, 1, 2, 3, 4, 5, 6, 7
MEASURED = 8  # the eight above
# beside what is measured of a launch
FAST, THETA, HEADING, T_LAUNCH = 8, 9, 10, 11
KNOWN = 12  # with the four above
# of a place on an orbit
THERE_SIDE, THERE_SHARE, THERE_HEADING = 0, 1, 2
# of the functions of a stop
TIME, ALONG, ACROSS, LENGTH, BODY = 0, 1, 2, 3, 4
# of the height alone: limit of c; c at theta = 0 of both orbits; rates and turnings over
# delta/TALLEST in pure sliding, in pure spin and at the limit
LIMIT, START, RATE, TURN = 0, 1, 3, 6


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


def stop_functions(side: int, share: float, delta: float, f: Out) -> None:
    """The functions of a stop: by look-up, in pure sliding and in pure spin exactly."""
    stop_table_at(1.0 - share if side == 1 else share - 1.0, delta, f)
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


def heading_at(end: int, theta: float, rate: float, delta: float, s: float, part: float) -> float:
    """The heading on an orbit that comes from, or to, an end."""
    regular: float = part * RATE_UNITS[end] / rate
    return delta / TALLEST * (constant(TURN + end, s) * theta + regular)


def falls_short(branch: int, z: float, s: float, wanted: float, f: Out) -> float:
    """By how much z, the way from theta = 0, falls short, nearly: what is there falls like exp(-z).

    Pieces 0 and 2 hold share exp(z) in its stead.
    """
    limit_motion_at(branch, z, s, f)
    there: float = -f[0] if branch == 1 else f[0]
    if not there > 0.0:  # so near the limit the table does not tell the side
        return -1.0
    return log(there / wanted) - (z if branch == 0 or branch == 2 else 0.0)


def know(delta: float, time: float, launch: Out) -> None:
    """Where on its orbit a measured launch is that both slides and spins; ``time``: its T."""
    f = room(2)
    s: float = STEEP * delta * delta - 1.0
    c: float = 1.0 - launch[SHARE] if launch[SIDE] == 1.0 else launch[SHARE] - 1.0
    limit: float = constant(LIMIT, s)
    fast: int = 1 if c > limit else 0
    start: float = constant(START + fast, s)
    ahead: int = 1 if (c < start if fast == 1 else c > start) else 0
    wanted: float = abs(c - limit)
    first: float = abs(start - limit)
    least: float = FAINT * TOLERANCE
    if ahead == 0:
        wanted = launch[SHARE] if launch[SIDE] == fast else 2.0 - launch[SHARE]
        first = 1.0 - start if fast == 1 else 1.0 + start
        least = SMALLEST
    wanted = wanted if wanted > least else least
    close: float = CLOSE * TOLERANCE / (wanted if ahead == 1 else 1.0)
    branch: int = 2 * fast + ahead
    low: float = 0.0
    high: float = REACH * END * END / (1.0 - END) if ahead == 1 else FARTHEST
    before: float = log(first / wanted) if first > wanted else 0.0
    z: float = before if before < high else high
    error: float = falls_short(branch, z, s, wanted, f)
    slope: float = (error - before) / z if z > 0.0 else -1.0
    n: int = 0
    while n < SEARCH and abs(error) > close:
        low = z if error > 0.0 else low
        high = high if error > 0.0 else z
        slope = slope if slope < 0.0 else -1.0
        last: float = z
        before = error
        z = z - error / slope
        z = z if z >= low and z <= high else 0.5 * (low + high)
        error = falls_short(branch, z, s, wanted, f)
        slope = (error - before) / (z - last) if z != last else -1.0
        n = n + 1
    end: int = 2 if ahead == 1 else fast
    rate: float = constant(RATE + end, s)
    theta: float = -z / rate if ahead == 1 else z / rate
    launch[FAST] = fast
    launch[THETA] = theta
    launch[HEADING] = heading_at(end, theta, rate, delta, s, f[1])
    launch[T_LAUNCH] = time


def arrive(launch: Out, delta: float, log_left: float, place: Out, f: Out) -> None:
    """The place on the orbit and the functions of a stop there, from the time that is left."""
    o = room(2)
    s: float = STEEP * delta * delta - 1.0
    theta: float = launch[THETA] + log_left
    fast: int = int(launch[FAST])
    ahead: int = 1 if theta < 0.0 else 0
    end: int = 2 if ahead == 1 else fast
    rate: float = constant(RATE + end, s)
    z: float = abs(theta) * rate
    limit_motion_at(2 * fast + ahead, z, s, o)
    c: float = constant(LIMIT, s) + o[0]
    share: float = 1.0 - abs(c)
    side: int = 1 if c > 0.0 else 0
    if ahead == 0:
        share = o[0] * exp(-z)
        side = fast if share <= 1.0 else 1 - fast
        share = share if share <= 1.0 else 2.0 - share
    if share < 0.0:
        share = 0.0
    place[THERE_SIDE] = side
    place[THERE_SHARE] = share
    place[THERE_HEADING] = heading_at(end, theta, rate, delta, s, o[1])
    stop_functions(side, share, delta, f)


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
    heading: float = around * (place[THERE_HEADING] - launch[HEADING])
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
    out[0] = launch[AROUND] * (place[THERE_HEADING] - launch[HEADING])
    return 0
