"""The integrator with its events: from a launch to the stop, and back to any moment between.

Events, all placed exactly on a step end:

* u = 0, the crossing of φ = π/4, where the equations have only two derivatives;
* s = TURN_FALL, where the turn of the heading is read off (see below);
* the end of integration, from where the exact motion at constant angle leads to the stop.

The heading of a puck with δ > 0 turns without end, logarithmically in Q, while it stops; a final
direction does not exist.  "Turn" therefore means: until Q has fallen to TURN_SHARE of its start.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.equations import (
    PSI,
    SIZE,
    WORK,
    T,
    U,
    at_constant_angle,
    derivatives,
    kinetic_energy,
)
from puck_tables.motion.steppers import ROWS, Tableau, step

FloatArray = npt.NDArray[np.float64]

TURN_SHARE = 1e-3
TURN_FALL = -math.log(TURN_SHARE)

STOPPED, STEP_LIMIT = 0, 1

_GROWTH = 6.0  # RK4 steps grow like Q^(-1/6): what happens late matters less
_LONGEST_STEP = 2.0  # the approach to the limit angle stays stable
_NEAR_CROSSING = 0.5


@inlined
def rk4_length(s: float, u: float, steps: float) -> float:
    """Length of the next RK4 step when about ``steps`` are to be taken in all.

    Like √|u| near the crossing of φ = π/4: steps crowd there so that order 4 survives it.
    """
    h = _GROWTH / steps
    near = max(math.sqrt(min(abs(u) / _NEAR_CROSSING, 1.0)), h)
    return min(h * math.exp(s / _GROWTH) * near, _LONGEST_STEP)


@kernel
def integrate(
    u: float,
    tableau: Tableau,
    steps: float,
    tolerance: float,
    cut: FloatArray,
    delta: float,
    step_limit: int,
    s_path: FloatArray,
    y_path: FloatArray,
    result: FloatArray,
) -> tuple[int, int]:
    """Run from (u, everything else 0) to the stop.

    Parameters
    ----------
    u : start value, finite
    tableau : the method
    steps : about how many steps to take; 0 lets the error estimate choose them
    tolerance : the local error then allowed per step
    cut, delta : friction ratios at this δ; an empty cut means closed forms
    step_limit : the most steps
    s_path, y_path : arrays (n,), (n, 8) for the step ends, or empty when nobody wants them
    result : array (8 + 1): the state at the stop (its ψ: the turn), energy residual

    Returns
    -------
    status, number of step ends
    """
    adaptive = steps == 0.0
    work = np.empty((ROWS, SIZE))
    y = np.empty(SIZE)
    new = np.empty(SIZE)
    for i in range(SIZE):
        y[i] = 0.0
    y[U] = u
    s = 0.0
    s_end = max(-math.log(tolerance), 3.0) if adaptive else _GROWTH * math.log(steps)
    s_end = min(max(s_end, TURN_FALL + 1.0), 36.0)
    turn = 0.0
    turn_read = False
    energy = kinetic_energy(0.0, u)
    residual = 0.0
    record = s_path.size > 0
    count = 1
    if record:
        _record(count - 1, s, y, s_path, y_path)
    h = 0.02
    derivatives(s, y, cut, delta, work[0])
    while s < s_end:
        if count > step_limit:
            return STEP_LIMIT, count
        if not adaptive:
            h = rk4_length(s, y[U], steps)
        target = s_end if turn_read else TURN_FALL
        # never leave a sliver before the target
        trial = h if s + 1.1 * h < target else target - s
        error = step(tableau, s, y, trial, cut, delta, work, new)
        if adaptive and not error <= tolerance:
            shrink = 0.2 if not error < math.inf else max(0.2, 0.9 * (tolerance / error) ** 0.2)
            h = trial * shrink
            if s + h == s:
                return STEP_LIMIT, count
            continue
        crossed = y[U] * new[U] < 0.0
        if crossed:
            trial = _land_on_crossing(tableau, s, y, trial, cut, delta, work, new)
        landed = not crossed and trial == target - s
        s = target if landed else s + trial
        for i in range(SIZE):
            y[i] = new[i]
        if adaptive and not crossed:  # the pair's last stage is the next step's first
            for i in range(SIZE):
                work[0, i] = work[tableau.b.size - 1, i]
        else:
            derivatives(s, y, cut, delta, work[0])
        if landed and not turn_read:
            turn = y[PSI]
            turn_read = True
        if record:
            if count == s_path.size:
                return STEP_LIMIT, count
            lost = energy - kinetic_energy(s, y[U])
            residual = max(residual, abs(lost - y[WORK]) / energy)
            _record(count, s, y, s_path, y_path)
        count += 1
        if adaptive and not crossed:
            grow = 5.0 if error == 0.0 else 0.9 * (tolerance / error) ** 0.2
            h = min(trial * min(5.0, max(0.2, grow)), _LONGEST_STEP)
    at_constant_angle(s, y, math.inf, cut, delta, result)
    result[PSI] = turn
    result[SIZE] = max(residual, abs(energy - result[WORK]) / energy)
    return STOPPED, count


@inlined
def _record(n: int, s: float, y: FloatArray, s_path: FloatArray, y_path: FloatArray) -> None:
    s_path[n] = s
    for i in range(SIZE):
        y_path[n, i] = y[i]


@kernel
def _land_on_crossing(
    tableau: Tableau,
    s: float,
    y: FloatArray,
    h: float,
    cut: FloatArray,
    delta: float,
    work: FloatArray,
    new: FloatArray,
) -> float:
    """Shorten a step that crosses u = 0 so that it ends there; ``new`` is its end.

    Regula falsi starts, Newton on repeated steps finishes: u(h) is monotonic and nearly straight.
    """
    rate = (new[U] - y[U]) / h
    for _ in range(12):
        h = min(max(h - new[U] / rate, 0.0), 1.5 * h)
        step(tableau, s, y, h, cut, delta, work, new)
        if abs(new[U]) < 1e-15:
            break
        derivatives(s + h, new, cut, delta, work[6])
        rate = work[6, U]
    new[U] = 0.0
    return h


@kernel
def states_at(
    times: FloatArray,
    s_path: FloatArray,
    y_path: FloatArray,
    result: FloatArray,
    tableau: Tableau,
    cut: FloatArray,
    delta: float,
    s_out: FloatArray,
    y_out: FloatArray,
) -> None:
    """States at dimensionless times from a recorded path: ``s_out`` (n,), ``y_out`` (n, 8).

    Dense output without an interpolation error: the moment is found by Newton's method on a step
    of the same method from the last step end before it.  At rest s = inf, and ψ is the turn.
    """
    work = np.empty((ROWS, SIZE))
    new = np.empty(SIZE)
    last = s_path.size - 1
    for n in range(times.size):
        time = times[n]
        if time >= result[T]:
            _record(n, math.inf, result, s_out, y_out)
            continue
        i, above = 0, last + 1
        while above - i > 1:
            middle = (i + above) // 2
            if y_path[middle, T] <= time:
                i = middle
            else:
                above = middle
        first = y_path[i]
        if i == last:
            # the tail: the remaining time is proportional to Q
            left = (result[T] - time) / (result[T] - first[T])
            s = s_path[last] - math.log(min(left, 1.0))
            at_constant_angle(s_path[last], first, s, cut, delta, new)
            _record(n, s, new, s_out, y_out)
            continue
        derivatives(s_path[i], first, cut, delta, work[0])
        whole = s_path[i + 1] - s_path[i]
        h = whole * (time - first[T]) / (y_path[i + 1, T] - first[T])
        for _ in range(20):
            step(tableau, s_path[i], first, h, cut, delta, work, new)
            derivatives(s_path[i] + h, new, cut, delta, work[6])
            change = (time - new[T]) / work[6, T]
            h = min(max(h + change, 0.0), whole)
            if abs(change) <= 4e-16 * (1.0 + s_path[i]):
                break
        step(tableau, s_path[i], first, h, cut, delta, work, new)
        new[T] = time
        _record(n, s_path[i] + h, new, s_out, y_out)
