"""Under another pressure law: places on the two orbits that all motions follow.

These functions stand in for those of the same names in :mod:`puck_tables.export.program.state`.
The orbits, over the logarithm of the time that is left, are those of
:mod:`puck_tables.export.law_values`; a launch is found on them by bracketing.
"""

from __future__ import annotations

from math import exp, log, sqrt

from puck_tables.export.program.given import (
    CONSTANTS,
    CONSTANTS_POWERS,
    CONSTANTS_QUANTUM,
    ORBIT,
    ORBIT_CELLS,
    ORBIT_DEGREE,
    ORBIT_POWERS,
    ORBIT_QUANTUM,
    REACH,
    STEEP,
    Out,
    room,
)
from puck_tables.export.program.law_places import stop_functions
from puck_tables.export.program.places import SHARE, SIDE, look_up
from puck_tables.export.program.state import (
    HEADING,
    KAPPA,
    LOG_N,
    REGULAR,
    SIGN,
    SMALLEST,
    T_LAUNCH,
    THERE_SHARE,
    THERE_SIDE,
    TURNING,
)

LIMIT, TURNING_LIMIT, TURNING_SPIN, RATE, START = 0, 1, 2, 3, 5  # the last two for each orbit
SEARCH, FURTHEST, SAME = 60, 0.9999, 1e-13


def constant(row: int, s: float) -> float:
    """Limit of c, turning per theta there and in pure spin, rates of both orbits, their start."""
    total: float = 0.0
    for m in range(CONSTANTS_POWERS - 1, -1, -1):
        total = total * s + CONSTANTS[row * CONSTANTS_POWERS + m]
    return CONSTANTS_QUANTUM * total


def orbit_at(piece: int, xi: float, s: float, found: Out) -> None:
    """C, on pieces 0 and 2 share exp(rate theta), and the regular part of the heading."""
    look_up(ORBIT, ORBIT_CELLS, ORBIT_DEGREE, ORBIT_POWERS, 2, ORBIT_QUANTUM, piece, xi, s, found)


def off_by(piece: int, xi: float, s: float, wanted: float, rate: float, f: Out) -> float:
    """How far a place is from the launch: c, or before theta = 0 the log of the share."""
    orbit_at(piece, xi, s, f)
    if piece == 1 or piece == 3:
        return f[0] - wanted
    return log(f[0] / wanted) - rate * REACH * xi * xi / (1.0 - xi)


def heading_at(piece: int, theta: float, delta: float, s: float, regular: float) -> float:
    """The heading on an orbit."""
    slope: float = 0.0
    if piece == 1 or piece == 3:
        slope = constant(TURNING_LIMIT, s)
    elif piece == 2:
        slope = constant(TURNING_SPIN, s)
    return delta * (slope * theta + regular)


def know(delta: float, time: float, known: Out) -> None:
    """Where on its orbit a measured launch is that both slides and spins; ``time``: its T."""
    f = room(2)
    s: float = STEEP * delta * delta - 1.0
    c: float = 1.0 - known[SHARE] if known[SIDE] == 1.0 else known[SHARE] - 1.0
    fast: int = 1 if c > constant(LIMIT, s) else 0
    start: float = constant(START + fast, s)
    piece: int = 2 * fast + (1 if (c < start if fast == 1 else c > start) else 0)
    rate: float = constant(RATE + fast, s)
    wanted: float = c
    if piece == 0 or piece == 2:
        wanted = known[SHARE] if known[SIDE] == fast else 2.0 - known[SHARE]
        wanted = wanted if wanted > SMALLEST else SMALLEST
    last: float = 0.0
    xi: float = FURTHEST
    was: float = off_by(piece, last, s, wanted, rate, f)
    off: float = off_by(piece, xi, s, wanted, rate, f)
    if was * off > 0.0:  # beside the table: at the end that is nearer
        xi = last if abs(was) < abs(off) else xi
        off = 0.0
    n: int = 0
    while n < SEARCH and abs(off) > SAME:  # the Illinois rule
        now: float = xi - (xi - last) * (off / (off - was))
        here: float = off_by(piece, now, s, wanted, rate, f)
        if here * off < 0.0:
            last = xi
            was = off
        else:
            was = 0.5 * was
        xi = now
        off = here
        n = n + 1
    orbit_at(piece, xi, s, f)
    theta: float = REACH * xi * xi / (1.0 - xi)
    theta = -theta if piece == 1 or piece == 3 else theta
    known[SIGN] = fast
    known[KAPPA] = rate
    known[LOG_N] = theta
    known[TURNING] = 0.0
    known[HEADING] = heading_at(piece, theta, delta, s, f[1])
    known[T_LAUNCH] = time


def arrive(known: Out, delta: float, log_left: float, place: Out, f: Out) -> None:
    """The place on the orbit and the functions of a stop there, from the time that is left."""
    o = room(2)
    s: float = STEEP * delta * delta - 1.0
    theta: float = known[LOG_N] + log_left
    fast: int = int(known[SIGN])
    piece: int = 2 * fast + (1 if theta < 0.0 else 0)
    way: float = abs(theta) / REACH
    orbit_at(piece, 2.0 * way / (way + sqrt(way * way + 4.0 * way)) if way > 0.0 else 0.0, s, o)
    share: float = 1.0 - abs(o[0])
    side: int = 1 if o[0] > 0.0 else 0
    if theta >= 0.0:
        share = o[0] * exp(-known[KAPPA] * theta)
        side = fast if share <= 1.0 else 1 - fast
        share = share if share <= 1.0 else 2.0 - share
    if share < 0.0:
        share = 0.0
    place[THERE_SIDE] = side
    place[THERE_SHARE] = share
    place[REGULAR] = heading_at(piece, theta, delta, s, o[1])
    stop_functions(side, share, delta, f)
