"""The test of a file by vectors that it carries."""

from __future__ import annotations

from math import sqrt

from puck_tables.export.program.intrinsics import Numbers, room
from puck_tables.export.program.plain_motion import TOLERANCE, state, stop, turn
from puck_tables.export.program.polygon_motion import BASE_SQUARE, STEP_ERROR, step, wrench
from puck_tables.export.program.resultant_formulas import resultants

# what the test of a file compares with
STOP_CASES: Numbers = ()
STATE_CASES: Numbers = ()
TURN_CASES: Numbers = ()
RESULTANTS_CASES: Numbers = ()
WRENCH_CASES: Numbers = ()
STEP_CASES: Numbers = ()
WRENCH_COUNT = STEP_COUNT = 0
STOP_COUNT = STATE_COUNT = TURN_COUNT = RESULTANTS_COUNT = 0


def misses(got: float, wanted: float, unit: float) -> int:
    """1 where a number is off by more than the tolerance, in units of its scale; else 0."""
    return 0 if abs(got - wanted) <= TOLERANCE * unit + 1e-300 else 1


def slip_of(launch: Numbers, k: int) -> float:
    """Q of the launch of a case: vx, vy, w, delta, J, r."""
    edge: float = launch[k + 5] * launch[k + 2]
    return sqrt(launch[k] * launch[k] + launch[k + 1] * launch[k + 1] + edge * edge)


def stop_misses() -> int:
    """How many numbers of the test vectors stop() misses."""
    c: Numbers = STOP_CASES
    out = room(5)
    missed: int = 0
    for n in range(STOP_COUNT):
        k: int = n * 11
        missed += stop(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out)
        slip: float = slip_of(c, k)
        for j in range(5):
            unit: float = slip / c[k + 4] * (1.0 if j == 0 else slip)
            missed += misses(out[j], c[k + 6 + j], unit / c[k + 5] if j == 4 else unit)
    return missed


def state_misses() -> int:
    """How many numbers of the test vectors state() misses."""
    c: Numbers = STATE_CASES
    out = room(6)
    missed: int = 0
    for n in range(STATE_COUNT):
        k: int = n * 13
        missed += state(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], c[k + 6], out)
        slip: float = slip_of(c, k)
        for j in range(6):
            unit: float = slip / c[k + 4] * slip if j < 3 else slip
            unit = unit / c[k + 5] if j == 2 or j == 5 else unit
            missed += misses(out[j], c[k + 7 + j], unit)
    return missed


def turn_misses() -> int:
    """How many numbers of the test vectors turn() misses."""
    c: Numbers = TURN_CASES
    out = room(1)
    missed: int = 0
    for n in range(TURN_COUNT):
        k: int = n * 7
        missed += turn(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out)
        missed += misses(out[0], c[k + 6], 1.0)
    return missed


def resultants_misses() -> int:
    """How many numbers of the test vectors resultants() misses."""
    c: Numbers = RESULTANTS_CASES
    out = room(3)
    missed: int = 0
    for n in range(RESULTANTS_COUNT):
        missed += resultants(c[n * 5], c[n * 5 + 1], out)
        for j in range(3):
            missed += misses(out[j], c[n * 5 + 2 + j], 1.0)
    return missed


def wrench_misses() -> int:
    """How many numbers of the test vectors wrench() misses."""
    c: Numbers = WRENCH_CASES
    out = room(3)
    missed: int = 0
    for n in range(WRENCH_COUNT):
        k: int = n * 7
        missed += wrench(c[k], c[k + 1], c[k + 2], c[k + 3], out)
        for j in range(3):
            missed += misses(out[j], c[k + 4 + j], 1.0)
    return missed


def step_misses() -> int:
    """How many numbers of the test vectors step() misses."""
    c: Numbers = STEP_CASES
    out = room(6)
    missed: int = 0
    least: float = STEP_ERROR / TOLERANCE
    least = least if least > 1.0 else 1.0
    for n in range(STEP_COUNT):
        k: int = n * 9
        missed += step(0.0, 0.0, 0.0, c[k], c[k + 1], c[k + 2], 1.0, 0.5, out)
        for j in range(6):
            unit: float = least / sqrt(BASE_SQUARE) if j == 2 or j == 5 else least
            missed += misses(out[j], c[k + 3 + j], unit)
    return missed
