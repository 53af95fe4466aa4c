"""What the test of a file by its vectors measures errors with."""

from __future__ import annotations

from math import sqrt

from puck_tables.export.program.base_step import BASE_SQUARE, STEP_ERROR
from puck_tables.export.program.intrinsics import Numbers
from puck_tables.export.program.launch_motion import TOLERANCE


def misses(got: float, wanted: float, unit: float) -> int:
    """1 where a number is off by more than the tolerance, in units of its scale; else 0."""
    return 0 if abs(got - wanted) <= TOLERANCE * unit + 1e-300 else 1


def stop_unit(c: Numbers, k: int, j: int) -> float:
    """The scale of a stop time, a place, a path length or a body angle.

    From c[k] on the case has vx, vy, w, delta, J, r.
    """
    edge: float = c[k + 5] * c[k + 2]
    slip: float = sqrt(c[k] * c[k] + c[k + 1] * c[k + 1] + edge * edge)
    unit: float = slip / c[k + 4] * (1.0 if j == 0 else slip)
    return unit / c[k + 5] if j == 4 else unit


def state_unit(c: Numbers, k: int, j: int) -> float:
    """The scale of a place, an angle, a velocity or a spin."""
    unit: float = stop_unit(c, k, 1) if j < 3 else stop_unit(c, k, 0) * c[k + 4]
    return unit / c[k + 5] if j == 2 or j == 5 else unit


def step_unit(j: int) -> float:
    """The scale of a number after a step, which errs by more than the tolerance."""
    least: float = STEP_ERROR / TOLERANCE
    least = least if least > 1.0 else 1.0
    return least / sqrt(BASE_SQUARE) if j == 2 or j == 5 else least
