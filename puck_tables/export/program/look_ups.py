"""The tables of a file, and how they are read: uniform B-splines, polynomials in δ².

Places are those of c = (r|ω| − v)/(r|ω| + v) between marks, and the orbits over the logarithm of
the time that is left, of :mod:`puck_tables.export.law_values`.
"""

from __future__ import annotations

from math import sqrt

from puck_tables.export.program.intrinsics import Numbers, Out, Rows, room

# tables of one error: cells, degree, powers, quantum and numbers; all that stands here stands for
# what a file is written with
BORDERS: Numbers = ()
ORIGINS: Numbers = ()
SCALES: Numbers = ()
SIDES = 2  # pieces of φ between marks
STOP: Numbers = ()
STOP_ROWS: Rows = ()
STOP_DEGREE, STOP_POWERS, STOP_QUANTUM = 1, 1, 1.0
PATCH: Numbers = ()
PATCH_ROWS: Rows = ()
PATCH_DEGREE, PATCH_QUANTUM = 1, 1.0
MOTION: Numbers = ()
MOTION_ROWS: Rows = ()
MOTION_CELLS: Rows = ()
MOTION_POWERS: Rows = ()
MOTION_DEGREE = 1
MOTION_QUANTA: Numbers = ()
RATE_UNITS: Numbers = ()  # in pure sliding, in pure spin, at the limit
CONSTANTS: Numbers = ()
CONSTANTS_POWERS, CONSTANTS_QUANTUM = 1, 1.0
# the kind of puck: its largest delta, s = STEEP delta^2 - 1 from -1 to 1
TALLEST, STEEP = 1.0, 2.0
REACH, END = 16.0, 0.5  # of z on an orbit, and of x = END xi, z = REACH x^2/(1 - x)

MOST_WEIGHTS, WIDEST = 8, 70  # room for any degree, and for any row, that a file is written with
STOP_FUNCTIONS, PATCH_FUNCTIONS = 5, 3  # T, X, Y, path, body angle; ρ_∥, ρ_⊥, ρ_ω


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


def side_of(c: float) -> int:
    """Between which marks a place lies."""
    side: int = 0
    for n in range(SIDES - 1):
        side += 1 if c >= BORDERS[n] else 0
    return side


def root_of(side: int, c: float) -> float:
    """The root of the share of a side that lies between its origin and a place, from 0 to 1."""
    share: float = (c - ORIGINS[side]) * SCALES[side]
    share = share if share > 0.0 else 0.0
    return sqrt(share if share < 1.0 else 1.0)


def stop_table_at(c: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle by look-up."""
    side: int = side_of(c)
    xi: float = 1.0 - sqrt(1.0 - sqrt(root_of(side, c)))
    look_up(
        STOP, STOP_ROWS[side] * STOP_POWERS * STOP_FUNCTIONS,
        STOP_ROWS[side + 1] - STOP_ROWS[side] - STOP_DEGREE, STOP_DEGREE, STOP_POWERS,
        STOP_FUNCTIONS, STOP_QUANTUM, xi, STEEP * delta * delta - 1.0, f,
    )  # fmt: skip


def looked_up_integrals(ratio: float, fast: bool, p: Out) -> None:
    """p_a, p_b and p_d, closer at lines of the friction than stops are."""
    c: float = (1.0 - ratio) / (1.0 + ratio)
    c = c if fast else -c
    side: int = side_of(c)
    look_up(
        PATCH, PATCH_ROWS[side] * PATCH_FUNCTIONS,
        PATCH_ROWS[side + 1] - PATCH_ROWS[side] - PATCH_DEGREE, PATCH_DEGREE, 1, PATCH_FUNCTIONS,
        PATCH_QUANTUM, 1.0 - sqrt(sqrt(1.0 - root_of(side, c))), 0.0, p,
    )  # fmt: skip


def limit_motion_at(branch: int, z: float, s: float, out_row: Out) -> None:
    """C less its limit, on pieces 0 and 2 share exp(z); and the regular part of the heading."""
    part: float = z / REACH
    xi: float = 0.5 * (sqrt(part * (part + 4.0)) - part) / END
    powers: int = MOTION_POWERS[branch]
    look_up(  # at least one: compilers see that all they read is set
        MOTION, MOTION_ROWS[branch], MOTION_CELLS[branch], MOTION_DEGREE,
        powers if powers > 1 else 1, 2, MOTION_QUANTA[branch], xi if xi < 1.0 else 1.0, s, out_row,
    )  # fmt: skip


def constant(row: int, s: float) -> float:
    """One of the numbers that depend on the height alone."""
    total: float = 0.0
    for m in range(CONSTANTS_POWERS - 1, -1, -1):
        total = total * s + CONSTANTS[row * CONSTANTS_POWERS + m]
    return CONSTANTS_QUANTUM * total
