"""The integrator with its events: from a launch to the stop, and back to any moment between.

Events, all placed exactly on a step end:

* every singular line of the friction: u = 0, the crossing of φ = π/4, where the equations have
  only one derivative and a bit; for other pucks the lines of their section;
* Q = TURN_SHARE Q₀, where the turn of the heading is read off (see below);
* the end of integration, from where the exact motion at constant angle leads to the stop.

The heading of a puck with δ > 0 turns without end, logarithmically in Q, while it stops; a final
direction does not exist.  "Turn" therefore means: until Q has fallen to TURN_SHARE of its start.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, inner, patience
from puck_tables.motion.equations_of_motion import (
    at_constant_angle,
    crossed_line,
    derivatives,
    distance_to_line,
    inertia,
    kinetic_energy,
    slowest_stop,
)
from puck_tables.motion.state import PSI, SIZE, WORK, T, U, X, Y
from puck_tables.motion.steppers import AT_EVENT, ROWS, Tableau, estimated, step, times_as_long

TURN_SHARE = 1e-3  # of Q₀: beyond, the heading turns on without end
TURN_Z = 1.0 - TURN_SHARE**0.25  # z there: Q/Q₀ = (1 − z)⁴

STOPPED, STEP_LIMIT = 0, 1  # how an integration ends

_NEAR_CROSSING = 0.5  # of u, from where on steps shrink towards a singular line
_CROSSING_FLOOR = 4.0  # over steps: the shortest step over the longest


@inlined
def q_of(z: float) -> float:
    """Q/Q₀ at z."""
    return (1.0 - z) * (1.0 - z) * (1.0 - z) * (1.0 - z)


@inlined
def end_of_steps(steps: float, tolerance: float, section: FloatArray) -> float:
    """The z from where the motion at constant angle leads to the stop.

    What it neglects is at most what is left of Q times the longest stop: a puck of much inertia may
    slide to a crawl with hardly any spin, and then spins for long.
    """
    left = max(tolerance, 1e-16) ** 0.25 if steps == 0.0 else 1.0 / steps
    return max(1.0 - left / slowest_stop(section) ** 0.25, 0.5 + 0.5 * TURN_Z)


@inlined
def step_length(u: float, steps: float, section: FloatArray) -> float:
    """Length of the next step when about ``steps`` are to be taken in all.

    Like √|u − line| near a singular line: steps crowd there so that order 4 survives it.
    """
    near = math.sqrt(min(distance_to_line(u, section) / _NEAR_CROSSING, 1.0))
    return max(near, _CROSSING_FLOOR / steps) / steps


@allocating
def integrate(
    u: float, tableau: Tableau, steps: float, tolerance: float, place_unit: float,
    section: FloatArray, delta: float, step_limit: int, z_path: FloatArray, y_path: FloatArray,
    result: FloatArray,
) -> tuple[int, int]:  # fmt: skip
    """Run from (u, everything else 0), u finite, to the stop; a status, the number of step ends.

    ``steps``: about how many to take; 0 lets the error estimate choose them, with a local error of
    ``tolerance`` per step; ``place_unit``: what errors of the place are measured in, 1 for Q₀²/J; a
    launch of nearly pure spin moves by that times cos φ only; ``section``, ``delta``: friction at
    this δ, see :mod:`puck_tables.motion.equations_of_motion`; ``z_path``, ``y_path``: (n,), (n, 8)
    for the step ends, or empty when nobody wants them; ``result`` (8 + 1): the state at the stop
    (its ψ: the turn), energy residual.
    """
    adaptive = steps == 0.0
    exponent = 1.0 / tableau.order
    work = np.empty((ROWS, SIZE))
    y = np.empty(SIZE)
    new = np.empty(SIZE)
    for i in range(SIZE):
        y[i] = 0.0
    y[U] = u
    z = 0.0
    z_end = end_of_steps(steps, tolerance, section)
    turn = 0.0
    turn_read = False
    square = inertia(section)
    energy = kinetic_energy(1.0, u, square)
    residual = 0.0
    record = z_path.size > 0
    count = 1
    if record:
        _record(count - 1, z, y, z_path, y_path)
    h = 0.005
    derivatives(z, y, section, delta, work[0])
    while z < z_end:
        patience(1)
        if count > step_limit:
            return STEP_LIMIT, count
        if not adaptive:
            h = step_length(y[U], steps, section)
        target = z_end if turn_read else TURN_Z
        # never leave a sliver before the target
        trial = h if z + 1.1 * h < target else target - z
        error = step(tableau, z, y, trial, section, delta, work, new)
        if place_unit < 1.0:
            place = abs(estimated(tableau, work, X)) + abs(estimated(tableau, work, Y))
            error = max(error, abs(trial) * place / place_unit)
        if adaptive and not error <= tolerance:
            h = trial * times_as_long(error, tolerance, exponent, 0.2)
            if z + h == z:
                return STEP_LIMIT, count
            continue
        crossed, line = crossed_line(y[U], new[U], section)
        if crossed:
            trial = _land_on_line(tableau, line, z, y, trial, section, delta, work, new)
        landed = not crossed and trial == target - z
        z = target if landed else z + trial
        for i in range(SIZE):
            y[i] = new[i]
        if tableau.reused and adaptive and not crossed:  # the last stage is the next one's first
            for i in range(SIZE):
                work[0, i] = work[tableau.b.size - 1, i]
        else:
            derivatives(z, y, section, delta, work[0])
        if landed and not turn_read:
            turn = y[PSI]
            turn_read = True
        if record:
            if count == z_path.size:
                return STEP_LIMIT, count
            lost = energy - kinetic_energy(q_of(z), y[U], square)
            residual = max(residual, abs(lost - y[WORK]) / energy)
            _record(count, z, y, z_path, y_path)
        count += 1
        if adaptive and not crossed:
            h = min(trial * times_as_long(error, tolerance, exponent, 0.2), 0.5 * (1.0 - z))
    at_constant_angle(q_of(z), y, 0.0, section, delta, result)
    result[PSI] = turn
    result[SIZE] = max(residual, abs(energy - result[WORK]) / energy)
    return STOPPED, count


@inlined
def _record(n: int, z: float, y: FloatArray, z_path: FloatArray, y_path: FloatArray) -> None:
    z_path[n] = z
    for i in range(SIZE):
        y_path[n, i] = y[i]


@inner
def _land_on_line(
    tableau: Tableau, line: float, z: float, y: FloatArray, h: float, section: FloatArray,
    delta: float, work: FloatArray, new: FloatArray,
) -> float:  # fmt: skip
    """Shorten a step that crosses a singular line so that it ends there; ``new`` is its end.

    Regula falsi starts, Newton on repeated steps finishes: u(h) is monotonic and nearly straight.
    """
    rate = (new[U] - y[U]) / h
    for _ in range(12):
        h = min(max(h - (new[U] - line) / rate, 0.0), 1.5 * h)
        step(tableau, z, y, h, section, delta, work, new)
        if abs(new[U] - line) < 1e-15:
            break
        derivatives(z + h, new, section, delta, work[AT_EVENT])
        rate = work[AT_EVENT, U]
    new[U] = line
    return h


@allocating
def states_at(
    times: FloatArray, z_path: FloatArray, y_path: FloatArray, result: FloatArray, tableau: Tableau,
    section: FloatArray, delta: float, q_out: FloatArray, y_out: FloatArray,
) -> None:  # fmt: skip
    """States at dimensionless times from a recorded path: ``q_out`` (n,), ``y_out`` (n, 8).

    Dense output without an interpolation error: the moment is found by Newton's method on a step
    of the same method from the last step end before it.  At rest q = 0, and ψ is the turn.
    """
    work = np.empty((ROWS, SIZE))
    new = np.empty(SIZE)
    last = z_path.size - 1
    for n in range(times.size):
        patience(1)
        time = times[n]
        if time >= result[T]:
            _record(n, 0.0, result, q_out, y_out)
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
            q = q_of(z_path[last])
            at_constant_angle(q, first, q * min(left, 1.0), section, delta, new)
            _record(n, q * min(left, 1.0), new, q_out, y_out)
            continue
        derivatives(z_path[i], first, section, delta, work[0])
        whole = z_path[i + 1] - z_path[i]
        h = whole * (time - first[T]) / (y_path[i + 1, T] - first[T])
        for _ in range(20):
            step(tableau, z_path[i], first, h, section, delta, work, new)
            derivatives(z_path[i] + h, new, section, delta, work[AT_EVENT])
            change = (time - new[T]) / work[AT_EVENT, T]
            h = min(max(h + change, 0.0), whole)
            if abs(change) <= 4e-16:
                break
        step(tableau, z_path[i], first, h, section, delta, work, new)
        new[T] = time
        _record(n, q_of(z_path[i] + h), new, q_out, y_out)
