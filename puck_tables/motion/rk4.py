"""Runge–Kutta 4 to the stop, unrolled: the same steps as :mod:`puck_tables.motion.path` takes.

Nothing is recorded on the way and no energy is counted, so the seven numbers of a state stay in
registers: a step costs two thirds of the general one.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.motion.equations_of_motion import (
    at_constant_angle,
    crossed_line,
    ratios_at,
    slip_ratio,
)
from puck_tables.motion.path import TURN_Z, end_of_steps, q_of, step_length
from puck_tables.motion.state import LENGTH, PSI, THETA, T, U, X, Y

State = tuple[float, float, float, float, float, float, float]  # u, ψ, t, x, y, θ, path length


@inlined
def _rates(z: float, u: float, psi: float, cut: FloatArray, delta: float) -> State:
    """The equations of motion, see :mod:`puck_tables.motion.equations_of_motion`."""
    k, fast, cosine, sine = slip_ratio(u)
    inverse, across, spin = ratios_at(k, fast, cut, delta)
    left = 1.0 - z
    q = left * left * left * left
    norm = 4.0 / (left * (cosine * cosine + sine * sine * spin))
    rate = q * inverse * norm
    along = q * rate * cosine
    return (
        (1.0 - spin) * norm, -sine * across * norm, rate,
        along * math.cos(psi), along * math.sin(psi), q * rate * sine, along,
    )  # fmt: skip


@inlined
def _step(z: float, y: State, d1: State, h: float, cut: FloatArray, delta: float) -> State:
    half, w = 0.5 * h, h / 6.0
    d2 = _rates(z + half, y[0] + half * d1[0], y[1] + half * d1[1], cut, delta)
    d3 = _rates(z + half, y[0] + half * d2[0], y[1] + half * d2[1], cut, delta)
    d4 = _rates(z + h, y[0] + h * d3[0], y[1] + h * d3[1], cut, delta)
    return (
        y[0] + w * (d1[0] + 2.0 * (d2[0] + d3[0]) + d4[0]),
        y[1] + w * (d1[1] + 2.0 * (d2[1] + d3[1]) + d4[1]),
        y[2] + w * (d1[2] + 2.0 * (d2[2] + d3[2]) + d4[2]),
        y[3] + w * (d1[3] + 2.0 * (d2[3] + d3[3]) + d4[3]),
        y[4] + w * (d1[4] + 2.0 * (d2[4] + d3[4]) + d4[4]),
        y[5] + w * (d1[5] + 2.0 * (d2[5] + d3[5]) + d4[5]),
        y[6] + w * (d1[6] + 2.0 * (d2[6] + d3[6]) + d4[6]),
    )


@kernel
def to_stop(
    u: float, steps: float, cut: FloatArray, delta: float, state: FloatArray, result: FloatArray
) -> int:
    """Run from (u, everything else 0) to the stop; returns the number of steps.

    Parameters
    ----------
    u : start value, finite
    steps : about how many steps to take
    cut, delta : friction at this δ, see :mod:`puck_tables.motion.equations_of_motion`
    state, result : arrays (8,), (8 + 1): work space, and the state at the stop (its ψ: the turn)
    """
    y = (u, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    z, turn, turn_read, count = 0.0, 0.0, False, 0
    z_end = end_of_steps(steps, 1.0, cut)
    while z < z_end:
        patience(1)
        h = step_length(y[0], steps, cut)
        target = z_end if turn_read else TURN_Z
        landed = z + 1.1 * h >= target  # never leave a sliver before the target
        if landed:
            h = target - z
        d1 = _rates(z, y[0], y[1], cut, delta)
        new = _step(z, y, d1, h, cut, delta)
        crossed, line = crossed_line(y[0], new[0], cut)
        if crossed:  # a step ends exactly on a singular line
            landed = False
            rate = (new[0] - y[0]) / h
            for _ in range(12):
                h = min(max(h - (new[0] - line) / rate, 0.0), 1.5 * h)
                new = _step(z, y, d1, h, cut, delta)
                if abs(new[0] - line) < 1e-15:
                    break
                rate = _rates(z + h, new[0], new[1], cut, delta)[0]
            new = (line, new[1], new[2], new[3], new[4], new[5], new[6])
        z = target if landed else z + h
        y = new
        count += 1
        if landed and not turn_read:
            turn, turn_read = y[1], True
    state[U], state[PSI], state[T], state[X], state[Y] = y[0], y[1], y[2], y[3], y[4]
    state[THETA], state[LENGTH] = y[5], y[6]
    at_constant_angle(q_of(z), state, 0.0, cut, delta, result)
    result[PSI] = turn
    return count
