"""Stops of many launches: the compiled loop behind ``stop`` and ``sweep``."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, patience
from puck_tables.kernels.patience import A_MOTION
from puck_tables.kernels.quadratic import room_for_section, section_at
from puck_tables.motion.equations_of_motion import at_constant_angle
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import STOPPED, integrate
from puck_tables.motion.rk4 import to_stop
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, T, U, X, Y
from puck_tables.motion.tableaus import Tableau

OVERFLOW = 2  # index of solvers.STATUS_MEANINGS

_STEP_LIMIT = 100_000  # more is a motion that does not end


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
    cut_delta = -1.0
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
        if by_table and delta != cut_delta:
            section_at(columns, delta, one_height)
            cut_delta = delta
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
