"""Where the energy of those went who were integrated, step by step.

A group of discs, or one alone, is sent on at once; all go on from the same event, so the segment of
any of them tells when that ended.  A row is a step of it: powers at both ends and the work between,
of which a part is that of a polynomial of degree four.  A row without duration is a jump, at the
start.
"""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined

# of a ledger, J: heat of dry friction, of rims, of drag; work of slope and given forces, of driven
# discs, and of what moves under or leads the discs; and N s, by its powers in N: what all contacts
# push the driven discs with
FLOOR_HEAT, RIM_HEAT, DRAG_HEAT, PULL_WORK, DRIVE_WORK, SUPPORT_WORK, BACK_X, BACK_Y = range(8)
LEDGER = 8

# columns: the segment of one of them, a row of the history, or NO_FLIGHT; start and duration of the
# step; which disc is driven among them, or NONE, or SEVERAL; at its start and end the powers, W,
# and the works in between and up to its middle, J
SEGMENT, WORK_START, DURATION, LED_BY, FIRST = range(5)
NO_SEGMENT = -1
NONE, SEVERAL = -1, -2
WORK_COLUMNS = FIRST + 4 * LEDGER
BEGUN, DONE, ENDED, HALFWAY = range(FIRST, WORK_COLUMNS, LEDGER)


@inlined
def write_work(
    row: FloatArray, start: float, h: float, begin: FloatArray, done: FloatArray, end: FloatArray,
    halfway: FloatArray,
) -> None:  # fmt: skip
    """A step: the powers at its start, the works, the powers at its end, the works half way."""
    row[WORK_START], row[DURATION], row[LED_BY] = start, h, NONE
    for i in range(LEDGER):
        row[BEGUN + i], row[DONE + i], row[ENDED + i] = begin[i], done[i], end[i]
        row[HALFWAY + i] = halfway[i]


@inlined
def add_worked(row: FloatArray, t: float, ledger: FloatArray) -> None:
    """Add what a row has worked by t to a ledger, J."""
    h = row[DURATION]
    s = (t - row[WORK_START]) / h if h > 0.0 else 1.0
    for i in range(LEDGER):
        done = row[DONE + i]
        if 0.0 < s < 1.0:
            begun, ended = row[BEGUN + i], row[ENDED + i]
            accel = row[HALFWAY + i] - 0.5 * done - 0.125 * h * (begun - ended)
            done *= s * s * (3.0 - 2.0 * s)
            done += h * s * (1.0 - s) * (begun * (1.0 - s) - ended * s)
            done += 16.0 * accel * (s * (1.0 - s)) ** 2
        ledger[i] += done if s > 0.0 else 0.0
