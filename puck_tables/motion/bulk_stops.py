"""Stops of many launches: the compiled loop behind ``stop`` and ``sweep``.

Runge–Kutta 4 to the stop is unrolled: the same steps as :mod:`puck_tables.motion.path` takes, but
nothing is recorded on the way and no energy is counted, so the seven numbers of a state stay in
registers: a step costs two thirds of the general one.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, kernel, patience
from puck_tables.kernels.patience import A_MOTION
from puck_tables.kernels.quadratic import room_for_section, section_at
from puck_tables.motion.equations_of_motion import (
    at_constant_angle,
    crossed_line,
    ratios_at,
    slip_ratio,
)
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import STOPPED, TURN_Z, end_of_steps, integrate, q_of, step_length
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, T, U, X, Y
from puck_tables.motion.steppers import Tableau

State = tuple[float, float, float, float, float, float, float]  # u, ψ, t, x, y, θ, path length
OVERFLOW = 2  # index of solvers.STATUS_MEANINGS

_STEP_LIMIT = 100_000  # more is a motion that does not end


@inlined
def _rates(z: float, u: float, psi: float, section: FloatArray, delta: float) -> State:
    """The equations of motion, see :mod:`puck_tables.motion.equations_of_motion`."""
    k, fast, cosine, sine = slip_ratio(u)
    inverse, across, spin = ratios_at(k, fast, section, delta)
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
def _step(z: float, y: State, d1: State, h: float, section: FloatArray, delta: float) -> State:
    half, w = 0.5 * h, h / 6.0
    d2 = _rates(z + half, y[0] + half * d1[0], y[1] + half * d1[1], section, delta)
    d3 = _rates(z + half, y[0] + half * d2[0], y[1] + half * d2[1], section, delta)
    d4 = _rates(z + h, y[0] + h * d3[0], y[1] + h * d3[1], section, delta)
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
    u: float, steps: float, section: FloatArray, delta: float, state: FloatArray, result: FloatArray
) -> int:
    """Run from (u, everything else 0) to the stop; returns the number of steps.

    ``u``: start value, finite; ``steps``: about how many steps to take; ``section``, ``delta``:
    friction at this δ, see :mod:`puck_tables.motion.equations_of_motion`; ``state``, ``result``:
    arrays (8,), (8 + 1): work space, and the state at the stop (its ψ: the turn).
    """
    y = (u, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    z, turn, turn_read, count = 0.0, 0.0, False, 0
    z_end = end_of_steps(steps, 1.0, section)
    while z < z_end:
        patience(1)
        h = step_length(y[0], steps, section)
        target = z_end if turn_read else TURN_Z
        landed = z + 1.1 * h >= target  # never leave a sliver before the target
        if landed:
            h = target - z
        d1 = _rates(z, y[0], y[1], section, delta)
        new = _step(z, y, d1, h, section, delta)
        crossed, line = crossed_line(y[0], new[0], section)
        if crossed:  # a step ends exactly on a singular line
            landed = False
            rate = (new[0] - y[0]) / h
            for _ in range(12):
                h = min(max(h - (new[0] - line) / rate, 0.0), 1.5 * h)
                new = _step(z, y, d1, h, section, delta)
                if abs(new[0] - line) < 1e-15:
                    break
                rate = _rates(z + h, new[0], new[1], section, delta)[0]
            new = (line, new[1], new[2], new[3], new[4], new[5], new[6])
        z = target if landed else z + h
        y = new
        count += 1
        if landed and not turn_read:
            turn, turn_read = y[1], True
    state[U], state[PSI], state[T], state[X], state[Y] = y[0], y[1], y[2], y[3], y[4]
    state[THETA], state[LENGTH] = y[5], y[6]
    at_constant_angle(q_of(z), state, 0.0, section, delta, result)
    result[PSI] = turn
    return count


@allocating
def fill_stops(
    launches: FloatArray, tableau: Tableau, steps: float, tolerance: float, columns: FloatArray,
    section: FloatArray, out: FloatArray, status: npt.NDArray[np.int8],
) -> None:  # fmt: skip
    """Stops of launches (6, n): vx, vy, ω, δ, J, r, into ``out`` (6, n), see solvers.OUTPUTS.

    By ``tableau`` with about ``steps`` steps, or, if that is 0, with the local error ``tolerance``.
    ``columns``: of a table of resultants; ``section``: of the one kind of puck that all launches
    are of; both are empty for closed forms.
    One launch never influences another, so any cutting into chunks gives the same bits.
    """
    patience(A_MOTION * launches.shape[1])
    by_table = columns.size > 0
    one_height = room_for_section(columns) if by_table else section
    row_delta = -1.0
    no_z, no_y = np.empty(0), np.empty((0, SIZE))
    start = np.empty(SIZE)
    result = np.empty(SIZE + 1)
    for n in range(launches.shape[1]):
        patience(1)
        vx, vy, spin = launches[0, n], launches[1, n], launches[2, n]
        delta, decel, radius = launches[3, n], launches[4, n], launches[5, n]
        speed, rim = math.hypot(vx, vy), radius * abs(spin)
        q0 = math.hypot(speed, rim)
        status[n] = STOPPED
        if q0 == 0.0:
            for i in range(6):
                out[i, n] = 0.0
            continue
        if not q0 < math.inf:
            status[n] = OVERFLOW
            for i in range(6):
                out[i, n] = math.nan
            continue
        if by_table and delta != row_delta:
            section_at(columns, delta, one_height)
            row_delta = delta
        if speed == 0.0 or rim == 0.0:
            for i in range(SIZE):
                start[i] = 0.0
            start[U] = math.inf if speed == 0.0 else -math.inf
            at_constant_angle(1.0, start, 0.0, section, delta, result)  # plain: closed forms
        elif steps > 0.0 and tableau.unrolled:
            to_stop(log_ratio(speed, rim), steps, one_height, delta, start, result)
        else:
            code, _ = integrate(
                log_ratio(speed, rim), tableau, steps, tolerance, 1.0, one_height, delta,
                _STEP_LIMIT, no_z, no_y, result,
            )  # fmt: skip
            status[n] = code
        side = 1.0 if spin >= 0.0 else -1.0
        ex, ey = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
        time = q0 / decel
        length = time * q0
        along, left = result[X] * length, side * result[Y] * length
        out[0, n] = result[T] * time
        out[1, n] = along * ex - left * ey
        out[2, n] = along * ey + left * ex
        out[3, n] = result[LENGTH] * length
        out[4, n] = side * result[PSI]
        out[5, n] = side * result[THETA] * (length / radius)
        finite = True
        for i in range(6):
            finite = finite and math.isfinite(out[i, n])
        if status[n] == STOPPED and not finite:
            status[n] = OVERFLOW
        if status[n] != STOPPED:
            for i in range(6):
                out[i, n] = math.nan
