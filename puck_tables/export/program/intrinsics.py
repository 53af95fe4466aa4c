"""What the programs find beside them: tables, and the words that every language has its own for.

The numbers of a table are whole; times its quantum they are the coefficients of uniform B-splines
in ξ (:mod:`puck_tables.export.compact_tables`), a row a node: the powers of 2δ² − 1, ascending, and
within a power the functions.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence

Numbers = Sequence[float]
Out = MutableSequence[float]
Room = list[float]
Rows = Sequence[int]  # where the rows of each side begin, and where all end; how many they are

# tables of one error: cells, degree, powers, quantum and numbers
STOP: Numbers = ()
# all numbers here stand for those that a file is written with
STOP_ROWS: Rows = ()
STOP_DEGREE, STOP_POWERS = 1, 1
STOP_QUANTUM = 1.0
CURVE: Numbers = ()
CURVE_ROWS: Rows = ()
CURVE_DEGREE, CURVE_POWERS = 1, 1
CURVE_QUANTUM = 1.0
INVERSE: Numbers = ()
INVERSE_ROWS: Rows = ()
INVERSE_DEGREE, INVERSE_POWERS = 1, 1
INVERSE_QUANTUM = 1.0
CONSTANTS: Numbers = ()
CONSTANTS_POWERS = 1
CONSTANTS_QUANTUM = 1.0

# the kind of puck: its largest delta, s = STEEP delta^2 - 1 from -1 to 1, how long pure spin lasts
# and more than any motion does, in Q/J
TALLEST, STEEP, SPIN_TIME, LONGEST = 1.0, 2.0, 0.75, 2.0

# tables under another pressure law (law_places, law_state)
BORDERS: Numbers = ()
ORIGINS: Numbers = ()
SCALES: Numbers = ()
SIDES = 4  # pieces of φ between singular lines
PATCH: Numbers = ()
PATCH_ROWS: Rows = ()
PATCH_DEGREE = 1
PATCH_QUANTUM = 1.0
ORBIT: Numbers = ()
ORBIT_ROWS: Rows = ()
ORBIT_CELLS: Rows = ()
ORBIT_POWERS: Rows = ()
ORBIT_DEGREE = 1
ORBIT_QUANTA: Numbers = ()
REACH, END = 16.0, 0.5
RATE_UNITS: Numbers = ()  # in pure sliding, in pure spin, at the limit

# what the test of a file compares with
TOLERANCE = 1.0
STOP_CASES: Numbers = ()
STATE_CASES: Numbers = ()
TURN_CASES: Numbers = ()
RESULTANTS_CASES: Numbers = ()
STOP_COUNT = STATE_COUNT = TURN_COUNT = RESULTANTS_COUNT = 0


def room(size: int) -> Room:
    """An array to work in."""
    return [0.0] * size
