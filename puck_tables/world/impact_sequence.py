"""What a disc went through on its way: which impacts led to where it ends."""

from __future__ import annotations

from puck_tables.kernels.compile import kernel, patience
from puck_tables.world.engine_state import (
    CONTACT,
    IMPACT,
    N_EVENTS,
    OVER_EDGE,
    PARTNER,
    POCKETED,
    TIPS,
    WHAT,
    WHO,
    Engine,
    Whole,
)

PRINT, LENGTH, FATE, PASSES = range(4)  # columns of a course
COURSE_COLUMNS = 4  # the four above

_PRIME = 2147483647  # products of two numbers below it fit 64 bits


@kernel
def trace(
    engine: Engine, disc: int, through: int, prints: Whole, marks: Whole, sequence: Whole
) -> None:
    """The course of a disc, from the events of a run.

    ``sequence`` (4,): a print, the same for runs in which the same impacts led there (in whatever
    order those happened that do not bear on each other); how many; the obstacle −1 − k by which it
    left play, or 0; whether the disc ``through`` was in one of them, 1 or 0.

    ``prints``, ``marks`` (n,): room.
    """
    for i in range(engine.discs.shape[0]):
        prints[i], marks[i] = i + 1, 0
    events = engine.counts[N_EVENTS]
    sequence[FATE] = 0
    for n in range(events):
        patience(1)
        what, i = int(engine.events[n, WHAT]), int(engine.events[n, WHO])
        if what not in (IMPACT, CONTACT, POCKETED, OVER_EDGE, TIPS):
            continue
        j = int(engine.events[n, PARTNER])
        other = prints[j] if j >= 0 else (-j * 742938285) % _PRIME
        both = (prints[i] + other) % _PRIME * 48271 + prints[i] * other % _PRIME * 16807 + what
        prints[i] = (both % _PRIME * 40692 + i + 1) % _PRIME
        if j >= 0:
            prints[j] = (both % _PRIME * 40692 + j + 1) % _PRIME
        elif i == disc and what in (POCKETED, OVER_EDGE):
            sequence[FATE] = j
    sequence[PRINT], sequence[LENGTH], sequence[PASSES] = prints[disc], 0, 0
    marks[disc] = 1
    for back in range(events):
        row = engine.events[events - 1 - back]
        what, i, j = int(row[WHAT]), int(row[WHO]), int(row[PARTNER])
        if what not in (IMPACT, CONTACT):
            continue
        if marks[i] == 1 or (j >= 0 and marks[j] == 1):
            marks[i] = 1
            if j >= 0:
                marks[j] = 1
                if through in (i, j):
                    sequence[PASSES] = 1
            sequence[LENGTH] += 1
