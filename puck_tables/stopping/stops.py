"""Where and when launches stop, in bulk; on bases of any shape, too."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, checked_flag, checked_threads, real_view
from puck_tables.accuracy.method_errors import Selection
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, derived, following, variable
from puck_tables.motion.base_slides import LONGEST, WHY_INTEGRATED, local_error
from puck_tables.motion.puck_spec import ROUND_ONLY, PuckSpec
from puck_tables.motion.state import STATE_ROWS
from puck_tables.result import Result
from puck_tables.stopping.jacobian import (
    DEFAULT_DECEL,
    DEFAULT_DELTA,
    DEFAULT_GRAVITY,
    DEFAULT_HEIGHT,
    FRICTION_NAMES,
    LAUNCH_NAMES,
    STOP_NAMES,
    ByFriction,
    Differentiated,
    delta_and_decel,
    refuse_rest,
    stop_jacobians,
)
from puck_tables.stopping.launch_arrays import TOO_LARGE, Launches, fits, launches_in, launches_of
from puck_tables.stopping.per_height import SolverPerHeight
from puck_tables.stopping.solvers import OUTPUTS, STATUS_MEANINGS, BaseSolver, followed
from puck_tables.stopping.state_values import refuse_times
from puck_tables.stopping.states import States, each_of, moments_of, states_in
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable

DEFAULT_TOL = 1e-8  # of Q/(fg), Q²/(fg)


class Stops(Differentiated, Result):
    """Stops of launches of shape (…).

    ``stop_time`` (…) s, ``stop_position`` (…, 2) m from the launch, ``status`` (…) int8, 0 where
    all is well, ``method`` ('look-up', 'integrated', or both where heights differ), ``selections``
    (what was selected for the tolerance, see :class:`puck_tables.accuracy.method_errors.Selection`;
    empty with a stop table of one's own).
    Computed when first asked for: ``path_length`` (…) m, ``body_angle`` (…) rad, ``turn_angle``
    (…) rad: how far the heading has turned when Q has fallen to 1/1000 (for δ > 0 it turns on
    without end); of other than plain pucks, looked up, it errs by up to some 2000 ``tol``.  For
    that more than 16384 launches are held as they were given, not copied: where their arrays have
    been changed in the meantime it is refused.  On a base that is not round there is no
    ``turn_angle``.
    """

    picture: ClassVar[str] = "places"
    JACOBIAN_ROWS: ClassVar[tuple[str, ...]] = STOP_NAMES
    JACOBIAN_COLUMNS: tuple[str, ...] = LAUNCH_NAMES
    _said: dict[str, Any]  # of results that were pickled

    def __init__(
        self, solver: SolverPerHeight | BaseSolver, launches: Launches, threads: int | None,
        jacobian: FloatArray | None, anew: Callable[..., Stops] | None, highest: float,
        by: ByFriction | None = None,
    ) -> None:  # fmt: skip
        time, place, status, self._mark, self._rest = solver.first(launches, threads)
        self._solver: SolverPerHeight | BaseSolver | None = solver
        self._launch_columns, self._outputs = solver.launch_columns, solver.outputs
        self._launches, self._threads = launches, threads
        self.stop_time: FloatArray = time.reshape(launches.shape)
        self.stop_position: FloatArray = place.reshape(*launches.shape, 2)
        self.status: npt.NDArray[np.int8] = status.reshape(launches.shape)
        if jacobian is not None:
            jacobian[status != 0] = np.nan
            self._jacobian = jacobian.reshape(*launches.shape, *jacobian.shape[1:])
            self._arguments, self._anew, self._highest = launches.matrix, anew, highest
            if by is not None:
                self._arguments = by.chained(launches, jacobian)
                self.JACOBIAN_COLUMNS = FRICTION_NAMES

    def __repr__(self) -> str:
        return f"Stops({self.status.size} launches of shape {self.status.shape}, by {self.method})"

    def __getstate__(self) -> dict[str, Any]:
        """The results alone: tables stay where they are."""
        said = {"method": self.method, "selections": self.selections, "explanation": self.explain()}
        kept = {"_rest": self._others, "_launches": self._own_launches}
        return {**self.__dict__, **kept, "_solver": None, "_said": said}

    @property
    def method(self) -> str:
        """'look-up', 'integrated', or both where heights differ."""
        return self._said["method"] if self._solver is None else self._solver.method

    @property
    def selections(self) -> tuple[Selection, ...]:
        """What was selected for the tolerance; empty with a stop table of one's own."""
        return self._said["selections"] if self._solver is None else self._solver.selections

    @property
    def _own_launches(self) -> Launches:
        """The launches, copied; refused where their arrays have been changed."""
        self._launches.refuse_changed(self._mark)
        return launches_in(self._launches.matrix, self._launches.shape)

    @property
    def _others(self) -> FloatArray:
        """Path length, turn of heading and of the body (3, n)."""
        if self._rest is None:
            assert isinstance(self._solver, SolverPerHeight)
            self._launches.refuse_changed(self._mark)
            self._rest = self._solver.rest(self._launches, self._threads)
            if self.status.any():
                self._rest[:, self.status.ravel() != 0] = np.nan
        return self._rest

    def _row(self, index: int) -> FloatArray:
        row: FloatArray = self._others[index].reshape(self.status.shape)
        return row

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others, such as ``stop_distance`` (…) m."""
        if name in ("stop_x", "stop_y"):
            return self.stop_position[..., ("stop_x", "stop_y").index(name)]
        column: FloatArray = following(self, name)
        return column

    @property
    def path_length(self) -> FloatArray:
        """Metres."""
        return self._row(0)

    @property
    def turn_angle(self) -> FloatArray:
        """Radians; integrated, good to a hundred times the tolerance only.

        Raises
        ------
        InputError
            If the base is not round.
        """
        if "turn_angle" not in self._outputs:
            raise InputError(f"turn_angle is {ROUND_ONLY}")
        return self._row(1)

    @property
    def body_angle(self) -> FloatArray:
        """Radians."""
        return self._row(2)

    def explain(self) -> str:
        """Which method was taken, and why."""
        return str(self._said["explanation"]) if self._solver is None else self._solver.explanation

    def dataset(self) -> Dataset:
        """Launches and their stops, over as many axes as the launches have."""
        shape = self.status.shape
        dims = tuple(f"axis_{n}" for n in range(len(shape))) or ("launch",)
        shape = shape or (1,)
        launches = dict(zip(self._launch_columns, self._own_launches.matrix, strict=False))
        stops = (self.stop_time, self.stop_x, self.stop_y, *self._others)
        values = dict(zip(OUTPUTS, stops, strict=True))
        columns = {**launches, **{name: values[name] for name in self._outputs}}
        columns |= derived(columns)
        variables = {n: variable(n, row.reshape(shape), dims) for n, row in columns.items()}
        status = self.status.reshape(shape)
        variables["status"] = variable("status", status, dims, STATUS_MEANINGS)
        return Dataset({}, variables, {"title": "Stops of launches", "method": self.method})


def stop(
    velocity: npt.ArrayLike,
    spin: npt.ArrayLike = 0.0,
    *,
    delta: npt.ArrayLike = DEFAULT_DELTA,
    decel: npt.ArrayLike = DEFAULT_DECEL,
    radius: npt.ArrayLike = 1.0,
    friction: npt.ArrayLike | None = None,
    height: npt.ArrayLike = DEFAULT_HEIGHT,
    gravity: float = DEFAULT_GRAVITY,
    tol: float = DEFAULT_TOL,
    method: str | None = None,
    table: ResultantTable | StopTable | None = None,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
    jacobian: bool = False,
    threads: int | None = None,
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
    decel : array_like (…), fg, m/s², > 0
    radius : array_like (…), m, > 0
    friction, height : array_like (…), Coulomb's coefficient f > 0 and the height h ≥ 0, m
        In place of ``delta`` and ``decel``: δ = 2fh/r and fg follow with ``gravity``, m/s², a
        number.  Derivatives are then by friction and height.
    tol : float
        Largest error in units of Q/(fg) (time) and Q²/(fg) (place), Q = hypot(v, rω); 1e-13 to
        0.01. The cheapest method whose measured error is below it is taken; ``explain()`` of the
        result says which and why.
    method : 'look-up', 'rk4' or 'adaptive', optional
        Only this one.
    table : Table, optional
        Of stops: looked up.  Of resultants, under the pressure law of the puck: integrated.
    pressure, gyration
        As :class:`puck_tables.Puck`.
    jacobian : bool
        Whether derivatives are wanted too: of stop_time, stop_x, stop_y, path_length and body_angle
        by vx, vy, spin, delta, decel and radius, in this order, as ``JACOBIAN_COLUMNS`` has it.
    threads : int, optional
        How many share the work: as many as the process may use cores, if left out.  The numbers do
        not depend on it, to the last bit.

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
    than plain pucks from variational equations (:mod:`puck_tables.stopping.variational`) or, where
    launches of one height are many, splines through these, whatever the method of the stop: in
    units of Q, J, r of the launch they are wrong by at most 1e-7 at any slip angle.  On φ = 0 and
    π/2, where stops carry broken powers of |φ|, they are the derivatives from both sides; only the
    path of exact pure spin grows like |v| and has none by vx and vy: NaN.

    There is no column for ``gyration``, a number of the kind of puck: the difference of stops at
    k ± 0.001 over 0.002 is its derivative to some 1e-6 (``tol`` = 1e-10, in units of Q, J, r).

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
    >>> slider = {"radius": 0.04, "friction": 0.2, "height": 0.05, "gravity": 10.0}
    >>> found = stop((1.0, 0.0), 5.0, **slider, jacobian=True)
    >>> round(float(found.stop_time), 6), float(found.derivative("stop_x", "friction").round(6))
    (0.515885, -1.26231)
    """
    checked_threads(threads)
    checked_flag("jacobian", jacobian)
    solver = SolverPerHeight(pressure, gyration, tol, method, table)
    delta, decel, by = delta_and_decel(delta, decel, radius, friction, height, gravity)
    launches = launches_of(velocity, spin, delta, decel, radius)
    if jacobian:
        launches.refuse_bad()
        refuse_rest(launches.matrix, launches.shape)
    solver.prepare_for(launches, threads)
    slopes = anew = None
    highest = 1.0
    if jacobian:
        plain, bodies = solver.kinds(launches.matrix[3])
        known = table if isinstance(table, StopTable) else StopTable.shipped()
        slopes = stop_jacobians(launches, plain, bodies, known, threads)
        highest = math.inf if bodies else 1.0
        how: dict[str, Any] = {"method": method, "table": table, "pressure": pressure}
        if by is not None:
            how["gravity"] = by.gravity
        anew = partial(stop, tol=tol, gyration=gyration, threads=threads, **how)
    return Stops(solver, launches, threads, slopes, anew, highest, by)


STATES_TOL = 1e-9  # of Q/(fg), Q²/(fg), as the states of other pucks are good to


def stop_on_base(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike, tol: float, threads: int | None
) -> Stops:
    """Where launches of a puck on a base stop, as :meth:`puck_tables.Puck.stop` has it."""
    checked_threads(threads)
    assert puck.shape is not None
    puck.refuse_lift()
    solver = BaseSolver(puck.shape, tol)
    return Stops(solver, _launches(puck, velocity, spin), threads, None, None, 0.0)


def states_on_base(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike, time: npt.ArrayLike,
    threads: int | None,
) -> States:  # fmt: skip
    """States of a puck on a base, as :meth:`puck_tables.Puck.states` has them."""
    checked_threads(threads)
    assert puck.shape is not None
    launches = _launches(puck, velocity, spin)
    rows = launches.matrix
    if not fits(rows, LONGEST).all():
        raise InputError(TOO_LARGE)
    which, moments, shape = moments_of(launches, real_view("time", time, "s"))
    refuse_times(moments)
    each = each_of(which, moments.size)
    order = np.lexsort((moments, each))
    ends = np.searchsorted(each[order], np.arange(launches.size + 1))
    slip = np.hypot(np.hypot(rows[0], rows[1]), rows[5] * rows[2])
    unit = np.where(slip > 0.0, slip / rows[4], 1.0)
    base, local = puck.packed_base, local_error(STATES_TOL)
    in_order = (moments / unit[each])[order]
    _, states, status = followed(base, rows, local, in_order, ends, threads)
    if status.any():
        raise InputError(TOO_LARGE)
    out = np.empty((STATE_ROWS, moments.size))
    out[:, order] = states.T
    explanation = f"{launches.size} pucks integrated, to 1e-9 of Q and Q^2/(f g).\n{WHY_INTEGRATED}"
    return states_in(out, moments, launches, which, shape, explanation)


def _launches(puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike) -> Launches:
    """Launches with f z in place of δ, and the radius of gyration in place of the radius."""
    launches = launches_of(velocity, spin, puck.lever, puck.decel, puck.inertia_radius)
    launches.refuse_bad()
    return launches
