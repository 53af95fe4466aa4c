"""Stops integrated one by one with closed forms, to rounding."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables.kernels.compile import allocating, patience
from puck_tables.kernels.patience import A_MOTION
from puck_tables.kernels.quadratic import NO_SECTION
from puck_tables.motion.equations_of_motion import at_constant_angle
from puck_tables.motion.path import STOPPED, integrate
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, T, U, X, Y
from puck_tables.motion.steppers import DORMAND_PRINCE, DORMAND_PRINCE_8, Tableau

_LOCAL_TOLERANCE = 2e-14  # of a step: 1e-15 of the stop
_STEP_LIMIT = 100_000  # more is a motion that does not end
_CHUNK = 64  # motions that a thread takes at once


@allocating
def _fill_exact_stops(
    u: FloatArray, delta: FloatArray, place_unit: FloatArray, section: FloatArray, tableau: Tableau,
    tolerance: float, out: FloatArray,
) -> None:  # fmt: skip
    """T, X, Y, path, body angle, turn of launches at u, δ into ``out`` (n, 6); NaN: no stop."""
    patience(A_MOTION * u.size)
    no_z, no_y = np.empty(0), np.empty((0, SIZE))
    start, result = np.zeros(SIZE), np.empty(SIZE + 1)
    for n in range(u.size):
        status = STOPPED
        if math.isinf(u[n]):
            start[U] = u[n]
            at_constant_angle(1.0, start, 0.0, section, delta[n], result)
        else:
            status, _ = integrate(
                u[n], tableau, 0.0, tolerance, place_unit[n], section, delta[n], _STEP_LIMIT, no_z,
                no_y, result,
            )  # fmt: skip
        good = status == STOPPED
        out[n, 0] = result[T] if good else math.nan
        out[n, 1], out[n, 2] = result[X], result[Y]
        out[n, 3], out[n, 4], out[n, 5] = result[LENGTH], result[THETA], result[PSI]


def integrated_stops(
    u: FloatArray, delta: FloatArray, section: FloatArray, tolerance: float,
    place_unit: float | FloatArray = 1.0, threads: int | None = None,
) -> FloatArray:  # fmt: skip
    """Stops in natural units by the integrator.

    ``u``: array (n,), ln(rω/v), infinite for pure sliding (−) and pure spin (+); ``delta``: array
    (n,); ``section``: friction, see :mod:`puck_tables.motion.equations_of_motion`; ``tolerance``:
    local error of a step; ``place_unit``: array (n,) or 1, what local errors of the place are
    measured in, with cos φ places next to pure spin, all as small as that, keep their digits;
    ``threads``: how many share the work.  Returns array (n, 6): T, X, Y, path length, body angle,
    and the turn until Q has fallen to 1/1000 (at infinite u 0).

    >>> integrated_stops(np.array([0.0]), np.array([1.0]), NO_SECTION, 1e-9)[0, :3].round(8)
    array([ 0.98647594,  0.32409373, -0.04297451])
    """
    out = np.empty((u.size, 6))
    # closed forms are as smooth as the higher order needs; splines of a section are not
    tableau = DORMAND_PRINCE if section.size else DORMAND_PRINCE_8
    unit = np.ascontiguousarray(np.broadcast_to(place_unit, u.shape), np.float64)

    def work(start: int, stop: int) -> None:
        part = slice(start, stop)
        _fill_exact_stops(u[part], delta[part], unit[part], section, tableau, tolerance, out[part])

    run_chunks(work, u.size, _CHUNK, threads)
    return out


def exact_stops(u: FloatArray, delta: FloatArray) -> FloatArray:
    """Stops in natural units by the integrator with closed forms, to rounding.

    ``u``: array (n,), ln(rω/v), infinite for pure sliding (−) and pure spin (+); ``delta``: array
    (n,).  Returns array (n, 5): T, X, Y, path length and body angle; error about 1e-15.

    >>> exact_stops(np.array([0.0]), np.array([1.0])).round(11).tolist()[0][:3]
    [0.98647593897, 0.32409372866, -0.04297450852]
    """
    return integrated_stops(u, delta, NO_SECTION, _LOCAL_TOLERANCE)[:, :5]
