"""Where and when launches stop, in bulk."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.errors import AccuracyError, InputError
from puck_tables.puck import real, velocity_array
from puck_tables.real import broadcast, finite_array
from puck_tables.table.file import load_table
from puck_tables.table.table import Table

FloatArray = npt.NDArray[np.float64]

DEFAULT_ACCURACY = 1e-8

# The error of RK4 with N steps is at most 0.29 N⁻⁴ in units of Q/J and Q²/J: that of Simpson's rule
# for the place in pure sliding, where all else is smaller.  With a margin:
RK4_CONSTANT = 0.36
FEWEST_STEPS = 8

OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")


@dataclass(frozen=True)
class Stops:
    """Stops of launches of shape (…).

    ``stop_time`` (…) s, ``stop_position`` (…, 2) m from the launch, ``path_length`` (…) m,
    ``turn_angle`` (…) rad the heading has turned when Q has fallen to 1/1000 (for δ > 0 it turns
    on without end; good to a hundred times the accuracy asked), ``body_angle`` (…) rad, ``status``
    (…) int8, 0 where all is well.
    """

    stop_time: FloatArray
    stop_position: FloatArray
    path_length: FloatArray
    turn_angle: FloatArray
    body_angle: FloatArray
    status: npt.NDArray[np.int8]


def steps_for(accuracy: float, table: Table) -> float:
    """How many RK4 steps reach an accuracy (in units of Q/J and Q²/J) with a table.

    Raises
    ------
    AccuracyError
        If it is out of reach.

    Examples
    --------
    >>> steps_for(1e-7, load_table())
    44.0
    """
    accuracy = real("accuracy", accuracy, "dimensionless")
    finest = 5.0 * table.tolerance
    if not finest <= accuracy <= 0.01:
        raise AccuracyError(
            f"accuracy must be from {finest:.1g} (five times the table's own error) to 0.01, "
            f"got {accuracy:g}"
        )
    return float(max(FEWEST_STEPS, math.ceil((RK4_CONSTANT / accuracy) ** 0.25)))


def stop(
    v0: npt.ArrayLike,
    w0: npt.ArrayLike,
    *,
    delta: npt.ArrayLike = 0.5,
    decel: npt.ArrayLike = 1.0,
    radius: npt.ArrayLike = 1.0,
    accuracy: float = DEFAULT_ACCURACY,
    table: Table | None = None,
) -> Stops:
    """Where and when pucks stop; everything broadcasts.

    Parameters
    ----------
    v0 : array_like (…, 2), m/s
    w0 : array_like (…), rad/s, counter-clockwise positive
    delta : array_like (…), dimensionless height 2fh/r, in the table's range (0 to 1)
    decel : array_like (…), J = fg, m/s², > 0
    radius : array_like (…), m, > 0
    accuracy : float
        Largest error in units of Q/J (time) and Q²/J (place), Q = hypot(v, rω).
    table : Table, optional
        The default table if left out.

    Returns
    -------
    Stops

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range.
    AccuracyError
        If the accuracy is out of the table's reach.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7.

    Examples
    --------
    >>> result = stop((1.0, 0.0), [1.0, 5.0], delta=1.0)
    >>> result.stop_time.round(6).tolist()
    [1.395088, 4.000189]
    """
    chosen = load_table() if table is None else table
    steps = steps_for(accuracy, chosen)
    velocity = velocity_array(v0)
    columns = broadcast(
        vx=velocity[..., 0],
        vy=velocity[..., 1],
        w0=finite_array("w0", w0, "rad/s"),
        delta=chosen.checked_range(delta),
        decel=positive_array("decel", decel, "m/s^2"),
        radius=positive_array("radius", radius, "m"),
    )
    shape = columns[0].shape
    launches = np.stack([column.ravel() for column in columns], axis=-1)
    out, status = stops_of(launches, steps, chosen)
    rows = [row.reshape(shape) for row in out]
    return Stops(
        stop_time=rows[0],
        stop_position=np.stack(rows[1:3], axis=-1),
        path_length=rows[3],
        turn_angle=rows[4],
        body_angle=rows[5],
        status=status.reshape(shape),
    )


def positive_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """An array of finite numbers greater than zero.

    Examples
    --------
    >>> positive_array("radius", 0.5, "m")
    array(0.5)
    """
    array = finite_array(name, values, unit)
    if not np.all(array > 0.0):
        raise InputError(
            f"{name} must be greater than 0 {unit}, got {array[array <= 0.0].flat[0]:g}"
        )
    return array


def stops_of(
    launches: FloatArray, steps: float, table: Table
) -> tuple[FloatArray, npt.NDArray[np.int8]]:
    """Stops of checked launches (n, 6): vx, vy, ω, δ, J, r → (6, n) values and (n,) status.

    Examples
    --------
    >>> values, status = stops_of(np.array([[1.0, 0, 0, 0.5, 1.0, 1.0]]), 16.0, load_table())
    >>> values[:, 0].round(12).tolist(), int(status[0])
    ([1.0, 0.5, 0.0, 0.5, 0.0, 0.0], 0)
    """
    from puck_tables.motion.bulk import fill_stops
    from puck_tables.motion.steppers import RK4

    out = np.empty((len(OUTPUTS), len(launches)))
    status = np.empty(len(launches), np.int8)
    fill_stops(launches, RK4, steps, table.coefficients, table.delta_axis.upper, out, status)
    return out, status
