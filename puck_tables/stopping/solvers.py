"""The two ways to a stop, behind one face: by look-up, or integrated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.executor import in_slices
from puck_tables._core.real import instance, real
from puck_tables.accuracy.front import COARSEST, INTEGRATED, LOOK_UP, Choice, choose
from puck_tables.errors import AccuracyError, InputError
from puck_tables.stopping.lookup import STOP_POWERS
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable

FloatArray = npt.NDArray[np.float64]
Status = npt.NDArray[np.int8]

METHODS = (LOOK_UP, "rk4", "adaptive")
TABLE_FACTOR = 5.0  # an error of the friction enters a stop at most so many times

OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")
STATUS_MEANINGS = ("stopped", "step_limit", "overflow")


@dataclass(frozen=True)
class LookUp:
    """Stops from a stop table, as coarse a cut of it as is good enough: nothing is integrated."""

    table: StopTable
    powers: int = STOP_POWERS
    thinning: int = 1
    choice: Choice | None = None
    method: str = "look-up"

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return self.table.source

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        return {
            "by": self.method, "values": self.table.values, "powers": self.powers,
            "thinning": self.thinning,
        }  # fmt: skip

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table."""
        return self.table.checked_range(delta)

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """Stop time, x, y (3, n) and status (n,) of checked launches (6, n)."""
        out, overflows = self.table.stops(launches, self.powers, self.thinning)
        return _marked(out, launches, overflows)

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of :data:`OUTPUTS` (6, n) and status (n,) of checked launches (6, n)."""
        from puck_tables.stopping.curve_lookup import BODY, LENGTH, TURN

        known = self.table.known(launches)
        first, status = self.first(launches)
        out = np.concatenate([first, known[[LENGTH, TURN, BODY]]])
        out[:, status != 0] = np.nan
        return out, status


@dataclass(frozen=True)
class Integration:
    """Stops by an integrator: Runge–Kutta 4, or the adaptive pair where ``steps`` is 0."""

    table: ResultantTable
    steps: float
    tolerance: float
    exact: bool
    choice: Choice | None = None
    method: str = "integrated"

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return self.table.source

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        return {
            "by": self.method, "values": self.table.values, "steps": self.steps,
            "tolerance": self.tolerance, "exact": self.exact,
        }  # fmt: skip

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table."""
        return self.table.checked_range(delta)

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """The same as :meth:`all`: no part of it comes cheaper."""
        return self.all(launches)

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of :data:`OUTPUTS` (6, n) and status (n,) of checked launches (6, n)."""
        from puck_tables.motion.bulk import fill_stops
        from puck_tables.motion.steppers import DORMAND_PRINCE

        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.empty(launches.shape[1], np.int8)
        coefficients = np.empty((2, 0, 5)) if self.exact else self.table.columns

        def work(start: int, stop: int) -> None:
            some, part = np.ascontiguousarray(launches[:, start:stop]), out[:, start:stop].copy()
            fill_stops(
                some, DORMAND_PRINCE, self.steps, self.tolerance, coefficients,
                part, status[start:stop],
            )  # fmt: skip
            out[:, start:stop] = part

        in_slices(work, launches.shape[1])
        return out, status


def _marked(out: FloatArray, launches: FloatArray, overflows: int) -> tuple[FloatArray, Status]:
    """Status 2 and NaN where a motion is too large for floating point."""
    status = np.zeros(out.shape[1], np.int8)
    if overflows:
        bad = ~fits(launches)
        status[bad] = STATUS_MEANINGS.index("overflow")
        out[:, bad] = np.nan
    return out, status


def fits(launches: FloatArray, longest: float = 2.0) -> npt.NDArray[np.bool_]:
    """Whether Q/J, Q²/J and Q²/(J r) of launches (6, n) are within floating point, (n,).

    ``longest``: how many times as large times, places and angles may get.

    Examples
    --------
    >>> fits(np.array([[1.0, 1e200], [0, 0], [0, 0], [0, 0], [1, 1], [1, 1]])).tolist()
    [True, False]
    """
    vx, vy, spin, _, decel, radius = launches
    with np.errstate(over="ignore", invalid="ignore"):
        slip = np.hypot(np.hypot(vx, vy), radius * spin)
        size = longest * slip / decel * slip
        inside: npt.NDArray[np.bool_] = np.isfinite(size / radius + size)
    return inside


def solver_for(
    tol: float, table: ResultantTable | StopTable | None, method: str | None = None
) -> LookUp | Integration:
    """The cheapest way to stops within a tolerance, in units of Q/J and Q²/J.

    Parameters
    ----------
    tol : largest error
    table : StopTable for look-up, ResultantTable for integration
        Left out: the tables that come along, or closed forms.
    method : 'look-up', 'rk4' or 'adaptive'
        Left out: any.

    Raises
    ------
    AccuracyError
        If it is out of reach.
    InputError
        If the method is not known or does not go with the table.

    Examples
    --------
    >>> solver_for(1e-8, None).method, solver_for(1e-12, None).method
    ('look-up', 'integrated')
    """
    wanted = real("tol", tol, "dimensionless")
    instance("table", table, ResultantTable, StopTable, type(None))
    if method not in (None, *METHODS):
        raise InputError(f"method must be one of {', '.join(METHODS)}, got {method!r}")
    if isinstance(table, StopTable):
        if method not in (None, LOOK_UP):
            raise InputError(f"method {method} needs a table of resultants, not of stops")
        if not table.tolerance <= wanted <= COARSEST:
            raise AccuracyError(
                f"tol must be from {table.tolerance:.1g} (that of the stop table) to {COARSEST:g}, "
                f"got {wanted:g}: give a tol in that range; a finer table comes from "
                "'puck build-tables --kind stops --accuracy A' with A down to 1e-11"
            )
        return LookUp(table)
    if isinstance(table, ResultantTable):
        table.checked_range(0.0)  # refuses one of another pressure law
    if isinstance(table, ResultantTable) and method == LOOK_UP:
        raise InputError("method look-up needs a table of stops, not of resultants")
    choice = choose_with("stop", wanted, method, table)
    way = choice.way
    if way.method == LOOK_UP:
        return LookUp(
            StopTable.shipped(), int(way.number("powers")), int(way.number("thinning")), choice
        )
    return Integration(
        ResultantTable.shipped() if table is None else table,
        steps=way.number("steps") if way.method.startswith("rk4") else 0.0,
        tolerance=way.number("local") if way.method.startswith("adaptive") else 1.0,
        exact=way.method.endswith("closed forms") and table is None,
        choice=choice,
    )


def choose_with(
    question: str, tol: float, method: str | None, table: ResultantTable | None, exact: bool = False
) -> Choice:
    """The knob, when a method, closed forms or a table of one's own may be asked for.

    The error of an integration with one's own table is that of the integrator with closed forms
    and what the table adds: at most five times its own error.

    Examples
    --------
    >>> choose_with("trajectory", 1e-9, "rk4", None).way.method
    'rk4, table'
    """
    methods = tuple(m for m in (LOOK_UP, *INTEGRATED) if method is None or m.startswith(method))
    if exact or table is not None:
        methods = tuple(m for m in methods if m.endswith("closed forms"))
    added = 0.0 if table is None else TABLE_FACTOR * table.tolerance
    try:
        choice = choose(question, tol, methods, added)
    except AccuracyError as error:
        raise AccuracyError(_with_table(str(error), table)) from None
    return replace(choice, why=_with_table(choice.why, table))


def _with_table(text: str, table: ResultantTable | None) -> str:
    """The knob's words, where a table of one's own stands for the closed forms it measured."""
    return text if table is None else text.replace("closed forms", f"the table {table.source}")
