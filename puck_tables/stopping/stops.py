"""Where and when launches stop, in bulk."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast, finite_array, velocity_array
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.io.columns import derived, following
from puck_tables.io.dataset import Dataset, variable
from puck_tables.result import Result
from puck_tables.stopping.jacobian import (
    LAUNCH_NAMES,
    STOP_NAMES,
    Differentiated,
    Kind,
    refuse_rest,
    stop_jacobians,
)
from puck_tables.stopping.per_height import SolverPerHeight
from puck_tables.stopping.solvers import OUTPUTS, STATUS_MEANINGS
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable

DEFAULT_TOL = 1e-8
_LAUNCHES = ("launch_vx", "launch_vy", "launch_spin", "delta")


class Stops(Differentiated, Result):
    """Stops of launches of shape (…).

    ``stop_time`` (…) s, ``stop_position`` (…, 2) m from the launch, ``status`` (…) int8, 0 where
    all is well, ``method`` ('look-up', 'integrated', or both where heights differ), ``selections``
    (what was selected for the tolerance, see :class:`puck_tables.accuracy.front.Selection`; empty
    with a stop table of one's own).
    Computed when first asked for: ``path_length`` (…) m, ``body_angle`` (…) rad, ``turn_angle``
    (…) rad: how far the heading has turned when Q has fallen to 1/1000 (for δ > 0 it turns on
    without end).
    """

    picture: ClassVar[str] = "places"
    JACOBIAN_ROWS: ClassVar[tuple[str, ...]] = STOP_NAMES
    JACOBIAN_COLUMNS: ClassVar[tuple[str, ...]] = LAUNCH_NAMES

    def __init__(
        self, solver: SolverPerHeight, launches: FloatArray, shape: tuple[int, ...],
        jacobian: FloatArray | None, table: StopTable | None, kind: Kind | None,
    ) -> None:  # fmt: skip
        self._values, status = solver.first(launches)
        self._solver: SolverPerHeight | None = solver
        self._launches, self._shape = launches, shape
        self.method, self.selections = solver.method, solver.selections
        self._explanation = solver.explanation
        self.stop_time: FloatArray = self._values[0].reshape(shape)
        self.stop_position: FloatArray = np.stack([self._row(1), self._row(2)], axis=-1)
        self.status: npt.NDArray[np.int8] = status.reshape(shape)
        if jacobian is not None:
            jacobian[status != 0] = np.nan
            self._jacobian = jacobian.reshape(*shape, *jacobian.shape[1:])
            self._arguments, self._table, self._kind = launches, table, kind

    def __repr__(self) -> str:
        return f"Stops({self.status.size} launches of shape {self._shape}, by {self.method})"

    def __getstate__(self) -> dict[str, Any]:
        """The results alone: tables stay where they are."""
        return {**self.__dict__, "_values": self._all, "_solver": None}

    @property
    def _all(self) -> FloatArray:
        if len(self._values) == 3 and self._solver is not None:
            self._values = self._solver.all(self._launches)[0]
        return self._values

    def _row(self, index: int) -> FloatArray:
        values = self._values if index < 3 else self._all
        row: FloatArray = values[index].reshape(self._shape)
        return row

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others, such as ``stop_distance`` (…) m."""
        if name in ("stop_x", "stop_y"):
            return self._row(OUTPUTS.index(name))
        column: FloatArray = following(self, name)
        return column

    @property
    def path_length(self) -> FloatArray:
        """Metres."""
        return self._row(3)

    @property
    def turn_angle(self) -> FloatArray:
        """Radians; integrated, good to a hundred times the tolerance only."""
        return self._row(4)

    @property
    def body_angle(self) -> FloatArray:
        """Radians."""
        return self._row(5)

    def _again(self, arguments: FloatArray) -> FloatArray:
        if self._kind is not None:
            solver = SolverPerHeight(*self._kind)
            solver.prepare(arguments[3])
            found: FloatArray = solver.all(arguments)[0][[0, 1, 2, 3, 5]]
            return found
        known = (self._table or StopTable.shipped()).known(arguments)
        return known[: len(STOP_NAMES)]

    def explain(self) -> str:
        """Which method was taken, and why."""
        return self._explanation

    def dataset(self) -> Dataset:
        """Launches and their stops, over as many axes as the launches have."""
        dims = tuple(f"axis_{n}" for n in range(len(self._shape))) or ("launch",)
        shape = self._shape or (1,)
        launches = dict(zip(_LAUNCHES, self._launches, strict=False))
        columns = {**launches, **dict(zip(OUTPUTS, self._all, strict=True))}
        columns |= derived(columns)
        variables = {n: variable(n, row.reshape(shape), dims) for n, row in columns.items()}
        status = self.status.reshape(shape)
        variables["status"] = variable("status", status, dims, STATUS_MEANINGS)
        return Dataset({}, variables, {"title": "Stops of launches", "method": self.method})


def stop(
    velocity: npt.ArrayLike,
    spin: npt.ArrayLike = 0.0,
    *,
    delta: npt.ArrayLike = 0.5,
    decel: npt.ArrayLike = 1.0,
    radius: npt.ArrayLike = 1.0,
    tol: float = DEFAULT_TOL,
    method: str | None = None,
    table: ResultantTable | StopTable | None = None,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
    jacobian: bool = False,
) -> Stops:
    """Where and when pucks stop; everything broadcasts.

    Parameters
    ----------
    velocity : array_like (…, 2), m/s
    spin : array_like (…), rad/s, counter-clockwise positive
    delta : array_like (…), dimensionless height 2fh/r
        Below 3.9637 under uniform pressure, up to the full contact of another law; with a table, in
        its range (0 to 1).  Beyond 1 or for another kind of puck each different height takes about
        a second to prepare, at most 500 of them; the others are looked up as if they were alone.
    decel : array_like (…), J = fg, m/s², > 0
    radius : array_like (…), m, > 0
    tol : float
        Largest error in units of Q/J (time) and Q²/J (place), Q = hypot(v, rω); 1e-13 to 0.01.  The
        cheapest method whose measured error is below it is taken; ``explain()`` of the result says
        which and why.
    method : 'look-up', 'rk4' or 'adaptive', optional
        Only this one.
    table : Table, optional
        Of stops: looked up.  Of resultants, under the pressure law of the puck: integrated.
    pressure, gyration
        As :class:`puck_tables.Puck`.
    jacobian : bool
        Whether derivatives are wanted too: of stop_time, stop_x, stop_y, path_length and body_angle
        by vx, vy, spin, delta, decel and radius, in this order.

    Returns
    -------
    Stops
        With ``jacobian``, ``jacobian`` (…, 5, 6).

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range, or derivatives
        of a launch at rest are asked for.
    AccuracyError
        If the tolerance, or an error of 1e-7 of the derivatives, is out of reach.

    Notes
    -----
    Derivatives come from splines of their own (:mod:`puck_tables.stopping.slopes`), those of other
    than plain pucks from variational equations (:mod:`puck_tables.stopping.varied`) or, where
    launches of one height are many, splines through these, whatever the method of the stop: in
    units of Q, J, r of the launch they are wrong by at most 1e-7 at any slip angle.  On φ = 0 and
    π/2, where stops carry broken powers of |φ|, they are the derivatives from both sides; only the
    path of exact pure spin grows like |v| and has none by vx and vy: NaN.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7.

    Examples
    --------
    >>> result = stop((1.0, 0.0), [1.0, 5.0], delta=1.0)
    >>> result.stop_time.round(6).tolist(), result.method
    ([1.395088, 4.000189], 'look-up')
    >>> float(stop((1.0, 0.0), 5.0, jacobian=True).derivative("stop_y", "delta").round(6))
    -0.310273
    """
    solver = SolverPerHeight(pressure, gyration, tol, method, table)
    velocities = velocity_array(velocity)
    columns = broadcast(
        vx=velocities[..., 0],
        vy=velocities[..., 1],
        spin=finite_array("spin", spin, "rad/s"),
        delta=solver.checked_range(delta),
        decel=positive_array("decel", decel, "m/s^2"),
        radius=positive_array("radius", radius, "m"),
    )
    shape = columns[0].shape
    launches = as_rows(columns)
    if jacobian:
        refuse_rest(launches, shape)
    solver.prepare(launches[3])
    slopes = kind = None
    if jacobian:
        by = table if isinstance(table, StopTable) else StopTable.shipped()
        plain, bodies = solver.kinds(launches[3])
        slopes = stop_jacobians(launches, plain, bodies, by)
        kind = Kind(pressure, gyration, tol, method, table) if bodies else None
    own = table if isinstance(table, StopTable) else None
    return Stops(solver, launches, shape, slopes, own, kind)


def as_rows(columns: list[FloatArray]) -> FloatArray:
    """Arrays of one shape as the rows of a matrix.

    Examples
    --------
    >>> as_rows([np.array([[1.0, 2.0]]), np.array([[3.0, 4.0]])]).tolist()
    [[1.0, 2.0], [3.0, 4.0]]
    """
    rows = np.empty((len(columns), *columns[0].shape))
    for n, column in enumerate(columns):
        rows[n] = column
    return rows.reshape(len(columns), -1)


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
