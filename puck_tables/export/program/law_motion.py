"""Under another pressure law: places beside all lines of it, and on the two orbits of all motions.

These functions stand in for those of the same names in
:mod:`puck_tables.export.program.plain_motion` and
:mod:`puck_tables.export.program.resultant_formulas`.  The places, and the orbits over the logarithm
of the time that is left, are those of :mod:`puck_tables.export.law_values`; a launch is found on
its orbit by bracketing.
"""

from __future__ import annotations

from math import exp, log, sqrt

from puck_tables.export.program.intrinsics import Numbers, Out, Rows, room
from puck_tables.export.program.plain_motion import (
    HEADING,
    LOG_N,
    REGULAR,
    SHARE,
    SIDE,
    SIGN,
    SMALLEST,
    STEEP,
    STOP,
    STOP_DEGREE,
    STOP_FUNCTIONS,
    STOP_POWERS,
    STOP_QUANTUM,
    STOP_ROWS,
    T_LAUNCH,
    TALLEST,
    THERE_SHARE,
    THERE_SIDE,
    TOLERANCE,
    TURNING,
    constant,
    look_up,
    stop_functions,
)

# tables under another pressure law; all that stands here stands for what a file is written with
BORDERS: Numbers = ()
ORIGINS: Numbers = ()
SCALES: Numbers = ()
SIDES = 4  # pieces of φ between singular lines
PATCH: Numbers = ()
PATCH_ROWS: Rows = ()
PATCH_DEGREE, PATCH_QUANTUM = 1, 1.0
MOTION: Numbers = ()
MOTION_ROWS: Rows = ()
MOTION_CELLS: Rows = ()
MOTION_POWERS: Rows = ()
MOTION_DEGREE = 1
MOTION_QUANTA: Numbers = ()
REACH, END = 16.0, 0.5
RATE_UNITS: Numbers = ()  # in pure sliding, in pure spin, at the limit

PATCH_FUNCTIONS = 3  # ρ_∥, ρ_⊥, ρ_ω


def look_up_near(
    table: Numbers, rows: Rows, degree: int, powers: int, functions: int, quantum: float, c: float,
    s: float, out_row: Out,
) -> None:  # fmt: skip
    """The functions of a table beside the mark of a side, xi = 0, up to the next side, xi = 1."""
    side: int = 0
    for n in range(SIDES - 1):
        side += 1 if c >= BORDERS[n] else 0
    look_up(
        table, rows[side] * powers * functions, rows[side + 1] - rows[side] - degree, degree,
        powers, functions, quantum, sqrt(sqrt((c - ORIGINS[side]) * SCALES[side])), s, out_row,
    )  # fmt: skip


def table_at(side: int, share: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle by look-up; side 1 where r|w| > v."""
    look_up_near(
        STOP, STOP_ROWS, STOP_DEGREE, STOP_POWERS, STOP_FUNCTIONS, STOP_QUANTUM,
        1.0 - share if side == 1 else share - 1.0, STEEP * delta * delta - 1.0, f,
    )  # fmt: skip


def shape_integrals(ratio: float, fast: bool, p: Out) -> None:
    """p_a, p_b and p_d, by look-up."""
    c: float = (1.0 - ratio) / (1.0 + ratio)
    look_up_near(
        PATCH,
        PATCH_ROWS,
        PATCH_DEGREE,
        1,
        PATCH_FUNCTIONS,
        PATCH_QUANTUM,
        c if fast else -c,
        0.0,
        p,
    )


# of the height alone: limit of c; c at theta = 0 of both orbits; rates and turnings over
# delta/TALLEST in pure sliding, in pure spin and at the limit
LIMIT, START, RATE, TURN = 0, 1, 3, 6
SEARCH = 60  # steps of the Illinois rule at most


def limit_motion_at(branch: int, xi: float, s: float, out_row: Out) -> None:
    """C less its limit, on pieces 0 and 2 share exp(z); and the regular part of the heading."""
    powers: int = MOTION_POWERS[branch]
    look_up(  # at least one: compilers see that all they read is set
        MOTION, MOTION_ROWS[branch], MOTION_CELLS[branch], MOTION_DEGREE,
        powers if powers > 1 else 1, 2, MOTION_QUANTA[branch], xi, s, out_row,
    )  # fmt: skip


def heading_of(xi: float) -> float:
    """z, the way from theta = 0 in units of 1/rate."""
    x: float = END * xi
    return REACH * x * x / (1.0 - x)


def error_of(branch: int, xi: float, s: float, wanted: float, f: Out) -> float:
    """How far a place is from the launch: c, or before theta = 0 the log of the share."""
    limit_motion_at(branch, xi, s, f)
    return f[0] - wanted if branch == 1 or branch == 3 else log(f[0] / wanted) - heading_of(xi)


def heading_at(end: int, theta: float, rate: float, delta: float, s: float, part: float) -> float:
    """The heading on an orbit that comes from, or to, an end."""
    regular: float = part * RATE_UNITS[end] / rate
    return delta / TALLEST * (constant(TURN + end, s) * theta + regular)


def know(delta: float, time: float, launch: Out) -> None:
    """Where on its orbit a measured launch is that both slides and spins; ``time``: its T."""
    f = room(2)
    s: float = STEEP * delta * delta - 1.0
    c: float = 1.0 - launch[SHARE] if launch[SIDE] == 1.0 else launch[SHARE] - 1.0
    limit: float = constant(LIMIT, s)
    fast: int = 1 if c > limit else 0
    start: float = constant(START + fast, s)
    ahead: int = 1 if (c < start if fast == 1 else c > start) else 0
    branch: int = 2 * fast + ahead
    wanted: float = c - limit
    if ahead == 0:
        wanted = launch[SHARE] if launch[SIDE] == fast else 2.0 - launch[SHARE]
        wanted = wanted if wanted > SMALLEST else SMALLEST
    last: float = 0.0
    xi: float = 1.0
    was: float = error_of(branch, last, s, wanted, f)
    error: float = error_of(branch, xi, s, wanted, f)
    beyond: float = 0.0
    if was * error > 0.0:  # beside the table: at the end that is nearer, or where it goes on
        xi = last if abs(was) < abs(error) else xi
        beyond = error if ahead == 0 and xi == 1.0 else 0.0
        error = 0.0
    n: int = 0
    while n < SEARCH and abs(error) > 1e-3 * TOLERANCE:  # the Illinois rule
        now: float = xi - (xi - last) * (error / (error - was))
        here: float = error_of(branch, now, s, wanted, f)
        if here * error < 0.0:
            last = xi
            was = error
        else:
            was = 0.5 * was
        xi = now
        error = here
        n = n + 1
    limit_motion_at(branch, xi, s, f)
    end: int = 2 if ahead == 1 else fast
    rate: float = constant(RATE + end, s)
    theta: float = (heading_of(xi) + beyond) / rate
    theta = -theta if ahead == 1 else theta
    launch[SIGN] = fast
    launch[LOG_N] = theta
    launch[TURNING] = 0.0
    launch[HEADING] = heading_at(end, theta, rate, delta, s, f[1])
    launch[T_LAUNCH] = time


def arrive(launch: Out, delta: float, log_left: float, place: Out, f: Out) -> None:
    """The place on the orbit and the functions of a stop there, from the time that is left."""
    o = room(2)
    s: float = STEEP * delta * delta - 1.0
    theta: float = launch[LOG_N] + log_left
    fast: int = int(launch[SIGN])
    ahead: int = 1 if theta < 0.0 else 0
    end: int = 2 if ahead == 1 else fast
    rate: float = constant(RATE + end, s)
    z: float = abs(theta) * rate
    heading: float = z / REACH
    xi: float = 0.5 * (sqrt(heading * (heading + 4.0)) - heading) / END
    limit_motion_at(2 * fast + ahead, xi if xi < 1.0 else 1.0, s, o)
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
    place[REGULAR] = heading_at(end, theta, rate, delta, s, o[1])
    stop_functions(side, share, delta, f)
