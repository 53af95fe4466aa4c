"""The two ways to a stop, behind one face: by look-up, or integrated."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.errors import AccuracyError
from puck_tables.puck import real
from puck_tables.real import instance
from puck_tables.similarity.file import load_stop_table
from puck_tables.similarity.stop_table import StopTable
from puck_tables.table.table import Table

FloatArray = npt.NDArray[np.float64]
Status = npt.NDArray[np.int8]

COARSEST_ACCURACY = 0.01

# The error of RK4 with N steps is at most 0.29 N⁻⁴ in units of Q/J and Q²/J: that of Simpson's rule
# for the place in pure sliding, where all else is smaller.  With a margin:
RK4_CONSTANT = 0.36
FEWEST_STEPS = 8

OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")
STATUS_MEANINGS = ("stopped", "step_limit", "overflow")


@dataclass(frozen=True)
class LookUp:
    """Stops from a stop table: nothing is integrated."""

    table: StopTable
    method: str = "look-up"

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """Stop time, x, y (3, n) and status (n,) of checked launches (6, n)."""
        from puck_tables.similarity.lookup import fill_stops_by_table

        out = np.empty((3, launches.shape[1]))
        overflows = fill_stops_by_table(launches, self.table.stop_coefficients, out)
        return _marked(out, launches, overflows)

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of :data:`OUTPUTS` (6, n) and status (n,) of checked launches (6, n)."""
        from puck_tables.similarity.curve_lookup import BODY, LENGTH, TURN

        known = self.table.known(launches)
        first, status = self.first(launches)
        out = np.concatenate([first, known[[LENGTH, TURN, BODY]]])
        out[:, status != 0] = np.nan
        return out, status


@dataclass(frozen=True)
class Integration:
    """Stops by Runge–Kutta 4 and the resultants."""

    table: Table
    steps: float
    method: str = "integrated"

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """The same as :meth:`all`: no part of it comes cheaper."""
        return self.all(launches)

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of :data:`OUTPUTS` (6, n) and status (n,) of checked launches (6, n)."""
        from puck_tables.motion.bulk import fill_stops
        from puck_tables.motion.steppers import RK4

        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.empty(launches.shape[1], np.int8)
        table = self.table
        fill_stops(
            launches, RK4, self.steps, table.coefficients, table.delta_axis.upper, out, status
        )
        return out, status


def _marked(out: FloatArray, launches: FloatArray, overflows: int) -> tuple[FloatArray, Status]:
    """Status 2 and NaN where a motion is too large for floating point."""
    status = np.zeros(out.shape[1], np.int8)
    if overflows:
        bad = ~fits(launches)
        status[bad] = STATUS_MEANINGS.index("overflow")
        out[:, bad] = np.nan
    return out, status


def fits(launches: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether Q²/J and Q²/(J r) of launches (6, n) are within floating point, (n,).

    Examples
    --------
    >>> fits(np.array([[1.0, 1e200], [0, 0], [0, 0], [0, 0], [1, 1], [1, 1]])).tolist()
    [True, False]
    """
    vx, vy, spin, _, decel, radius = launches
    with np.errstate(over="ignore", invalid="ignore"):
        slip = np.hypot(np.hypot(vx, vy), radius * spin)
        size = slip / decel * slip
        inside: npt.NDArray[np.bool_] = np.isfinite(size / radius + size)
    return inside


def solver_for(accuracy: float, table: Table | StopTable | None) -> LookUp | Integration:
    """The way to stops of an accuracy, in units of Q/J and Q²/J.

    Parameters
    ----------
    accuracy : largest error
    table : StopTable for look-up, Table for integration
        Left out: look-up with the default table where it is exact enough, else integration.

    Raises
    ------
    AccuracyError
        If it is out of reach.

    Examples
    --------
    >>> solver_for(1e-8, None).method
    'look-up'
    """
    wanted = real("accuracy", accuracy, "dimensionless")
    instance("table", table, Table, StopTable, type(None))
    if isinstance(table, Table):
        return Integration(table, steps_for(wanted, table))
    chosen = load_stop_table() if table is None else table
    if not chosen.tolerance <= wanted <= COARSEST_ACCURACY:
        raise AccuracyError(
            f"accuracy must be from {chosen.tolerance:.1g} (that of the stop table) to "
            f"{COARSEST_ACCURACY:g}, got {wanted:g}: a finer table comes from "
            "'puck build-tables --kind stops --accuracy A' with A down to 1e-11"
        )
    return LookUp(chosen)


def steps_for(accuracy: float, table: Table) -> float:
    """How many RK4 steps reach an accuracy (in units of Q/J and Q²/J) with a table.

    Raises
    ------
    AccuracyError
        If it is out of reach.

    Examples
    --------
    >>> from puck_tables import load_table
    >>> steps_for(1e-7, load_table())
    44.0
    """
    finest = 5.0 * table.tolerance
    if not finest <= accuracy <= COARSEST_ACCURACY:
        raise AccuracyError(
            f"accuracy must be from {finest:.1g} (five times the table's own error) to 0.01, "
            f"got {accuracy:g}"
        )
    return float(max(FEWEST_STEPS, math.ceil((RK4_CONSTANT / accuracy) ** 0.25)))
