"""Where the energy of those went who were integrated, step by step.

A group of discs, or one alone, is sent on at once; all go on from the same event, so the flight of
any of them tells when that ended.  A row is a step of it: powers at both ends and the work between,
of which a part is that of a polynomial of degree four.  A row without duration is a jump, at the
start.
"""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined

# of a ledger, J: heat of dry friction, of rims, of drag; work of slope and given forces, of driven
# discs, and of what moves under or leads the discs
FLOOR_HEAT, RIM_HEAT, DRAG_HEAT, PULL_WORK, DRIVE_WORK, SUPPORT_WORK = range(6)
LEDGER = 6

# columns: the flight of one of them, a row of the history, or NO_FLIGHT; start and duration of the
# step; at its start and end the powers, W, and the works in between and up to its middle, J
FLIGHT, START, DURATION, FIRST = range(4)
NO_FLIGHT = -1
WORK_COLUMNS = FIRST + 4 * LEDGER
BEGUN, DONE, ENDED, HALFWAY = range(FIRST, WORK_COLUMNS, LEDGER)


@inlined
def write_work(
    row: FloatArray, start: float, h: float, begin: FloatArray, done: FloatArray, end: FloatArray,
    halfway: FloatArray,
) -> None:  # fmt: skip
    """A step: the powers at its start, the works, the powers at its end, the works half way."""
    row[START], row[DURATION] = start, h
    for i in range(LEDGER):
        row[BEGUN + i], row[DONE + i], row[ENDED + i] = begin[i], done[i], end[i]
        row[HALFWAY + i] = halfway[i]


def worked(rows: FloatArray, ends: FloatArray, times: FloatArray) -> FloatArray:
    """The ledger (6, times) at ascending times of rows whose flights ended at ``ends`` (rows,), J.

    Examples
    --------
    >>> row = np.zeros((1, WORK_COLUMNS))
    >>> row[0, [DURATION, DONE, BEGUN, ENDED, HALFWAY]] = 2.0, 4.0, 1.0, 3.0, 1.5
    >>> worked(row, np.array([1.5]), np.array([1.0, 9.0]))[0].tolist()
    [1.5, 2.625]
    """
    first = rows[:, START]
    last = np.minimum(first + rows[:, DURATION], ends)
    order = np.argsort(last, kind="stable")
    done = np.cumsum(_part(rows, ends)[order], axis=0)
    total = np.vstack([np.zeros(LEDGER), done])[np.searchsorted(last[order], times, side="right")]
    begin, end = np.searchsorted(times, first, "right"), np.searchsorted(times, last, "left")
    counts = np.maximum(end - begin, 0)  # of times that lie within a row
    row = np.repeat(np.arange(len(rows)), counts)
    at = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts - begin, counts)
    np.add.at(total, at, _part(rows[row], times[at]))
    return np.ascontiguousarray(total.T)


def _part(rows: FloatArray, ends: FloatArray) -> FloatArray:
    """What each row works until its end, (rows, 6)."""
    h = rows[:, DURATION]
    share = np.where(h > 0.0, (ends - rows[:, START]) / np.where(h > 0.0, h, 1.0), 1.0)
    s, h = np.clip(share, 0.0, 1.0)[:, None], h[:, None]
    firsts = (BEGUN, DONE, ENDED, HALFWAY)
    begun, done, ended, halfway = (rows[:, first : first + LEDGER] for first in firsts)
    part = done * s * s * (3.0 - 2.0 * s) + h * s * (1.0 - s) * (begun * (1.0 - s) - ended * s)
    bend = halfway - 0.5 * done - 0.125 * h * (begun - ended)
    part = part + 16.0 * bend * (s * (1.0 - s)) ** 2
    whole: FloatArray = np.where(s < 1.0, part, done)
    return whole
