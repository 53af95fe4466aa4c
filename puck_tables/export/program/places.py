"""A launch in natural units, and its place in the tables."""

from __future__ import annotations

from math import nan, sqrt

from puck_tables.export.program.intrinsics import LONGEST, TALLEST, Numbers, Out, room

MOST_WEIGHTS, WIDEST = 8, 70  # room for any degree, and for any row, that a file is written with
LARGEST = 8e307  # of places, and of places over radii
# of a measured launch
SLIP, SPEED, RIM, EAST, NORTH, SIDE, SHARE, AROUND = 0, 1, 2, 3, 4, 5, 6, 7
MEASURED = 8  # the eight above


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
    quantum: float, xi: float, s: float, found: Out,
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
        found[f] = value
