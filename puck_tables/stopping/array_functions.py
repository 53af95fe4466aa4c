"""Stops and states as pure functions of arrays, for libraries that map functions over arrays.

Arrays in, a tuple of arrays out, all of one shape; each element depends on its own launch alone, to
the last bit, so that xarray and dask may cut the arrays as they like.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, finite_array, real
from puck_tables.accuracy.methods import Method
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.stopping.jacobian import (
    DEFAULT_DECEL,
    DEFAULT_DELTA,
    DEFAULT_GRAVITY,
    DEFAULT_HEIGHT,
)
from puck_tables.stopping.launch_arrays import TOO_LARGE
from puck_tables.stopping.states import states
from puck_tables.stopping.stop_section import FINEST_SECTION
from puck_tables.stopping.stops import stop

StopArrays = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]


def stop_arrays(
    vx: npt.ArrayLike, vy: npt.ArrayLike = 0.0, spin: npt.ArrayLike = 0.0,
    delta: npt.ArrayLike = DEFAULT_DELTA, decel: npt.ArrayLike = DEFAULT_DECEL,
    radius: npt.ArrayLike = 1.0, *, friction: npt.ArrayLike | None = None,
    height: npt.ArrayLike = DEFAULT_HEIGHT, gravity: float = DEFAULT_GRAVITY,
    tol: float = 1e-8, pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
) -> StopArrays:  # fmt: skip
    """Stops of launches; everything broadcasts.

    Parameters
    ----------
    vx, vy, spin : array_like (…), m/s, rad/s
    delta, decel, radius : array_like (…), 1, m/s², m
    friction, height, gravity, tol, pressure, gyration
        As for :func:`puck_tables.stop`.  Pucks with δ > 1 or of another kind are looked up for any
        number of launches, integrated where tol < 1e-10.

    Returns
    -------
    tuple of six arrays (…)
        ``stop_time`` s, ``stop_x``, ``stop_y``, ``path_length`` m, ``turn_angle``, ``body_angle``
        rad.

    Raises
    ------
    InputError, AccuracyError
        As :func:`puck_tables.stop`, and where a motion is too large for floating point: there is no
        column that could say so.

    Examples
    --------
    >>> time, x, *_ = stop_arrays([1.0, 2.0], spin=5.0)
    >>> time.round(6).tolist(), x.round(6).tolist()
    ([3.962992, 4.472821], [2.213952, 4.736946])
    """
    method = (
        Method.LOOK_UP if real("tol", tol, "dimensionless") >= FINEST_SECTION else Method.ADAPTIVE
    )
    stops = stop(
        _pairs(vx, vy), spin, delta=delta, decel=decel, radius=radius, friction=friction,
        height=height, gravity=gravity, tol=tol,
        method=method.value, pressure=pressure, gyration=gyration, threads=1,
    )  # fmt: skip
    if stops.status.any():
        raise InputError(TOO_LARGE)
    return (
        stops.stop_time, stops.stop_x, stops.stop_y, stops.path_length, stops.turn_angle,
        stops.body_angle,
    )  # fmt: skip


def state_arrays(
    vx: npt.ArrayLike, vy: npt.ArrayLike, spin: npt.ArrayLike, time: npt.ArrayLike,
    delta: npt.ArrayLike = DEFAULT_DELTA, decel: npt.ArrayLike = DEFAULT_DECEL,
    radius: npt.ArrayLike = 1.0, *, friction: npt.ArrayLike | None = None,
    height: npt.ArrayLike = DEFAULT_HEIGHT, gravity: float = DEFAULT_GRAVITY,
    pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
) -> StopArrays:  # fmt: skip
    """States at times after launches; everything broadcasts.

    Parameters
    ----------
    vx, vy, spin : array_like (…), m/s, rad/s, at the launch
    time : array_like (…), s, ≥ 0
    delta, decel, radius : array_like (…), 1, m/s², m
    friction, height, gravity, pressure, gyration
        As for :func:`puck_tables.states`.

    Returns
    -------
    tuple of six arrays (…)
        ``x``, ``y`` m from the launch, ``orientation`` rad, ``vx``, ``vy`` m/s, ``spin`` rad/s.

    Raises
    ------
    InputError
        As :func:`puck_tables.states`.

    Examples
    --------
    >>> x, y, *_ = state_arrays(1.0, 0.0, 5.0, [2.0, 0.0])
    >>> x.round(6).tolist()
    [1.590682, 0.0]
    """
    result = states(
        _pairs(vx, vy), spin, time, delta=delta, decel=decel, radius=radius, friction=friction,
        height=height, gravity=gravity,
        pressure=pressure, gyration=gyration,
    )  # fmt: skip
    return result.x, result.y, result.orientation, result.vx, result.vy, result.spin


def _pairs(vx: npt.ArrayLike, vy: npt.ArrayLike) -> FloatArray:
    parts = broadcast(vx=finite_array("vx", vx, "m/s"), vy=finite_array("vy", vy, "m/s"))
    return np.stack(parts, axis=-1)
