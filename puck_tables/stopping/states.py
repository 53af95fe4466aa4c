"""The state of any puck at any time: by look-up, of few other than plain ones by integration."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any, ClassVar, cast

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, checked_flag, checked_threads, real_view
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.body import UnitPuck, body_of, plain_up_to
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN, STATE_ROWS
from puck_tables.result import Result
from puck_tables.stopping.jacobian import (
    DEFAULT_DECEL,
    DEFAULT_DELTA,
    DEFAULT_GRAVITY,
    DEFAULT_HEIGHT,
    FRICTION_NAMES,
    MOMENT_NAMES,
    STATE_NAMES,
    Differentiated,
    delta_and_decel,
    integrated_jacobians,
)
from puck_tables.stopping.launch_arrays import TOO_LARGE, Launches, fits, launches_in, launches_of
from puck_tables.stopping.per_height import refuse_many
from puck_tables.stopping.state_section import fill_others
from puck_tables.stopping.state_values import all_looked_up, refuse_times
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.stop_values import UPPER_DELTA
from puck_tables.table.table import refuse_other_kind

# of nothing and of one, made once: to make them takes as long as a look-up
_NONE, _FIRST = np.empty(0, np.int64), np.zeros(1, np.int64)


def _row(index: int, words: str) -> FloatArray:
    """A row of states by its name."""

    def row(states: States) -> FloatArray:
        return states.rows[index, ...]

    return cast(FloatArray, property(row, doc=words))


@dataclass(frozen=True, eq=False, repr=False)
class States(Differentiated, Result):
    """States of pucks at the times asked for, arrays of one shape.

    ``time`` s; ``x``, ``y`` m from the launch; ``heading`` rad, of the velocity (at rest that of
    the moment when Q had fallen to 1/1000); ``orientation`` rad, how far the body has turned;
    ``speed`` v m/s; ``spin`` ω rad/s.  ``vx``, ``vy`` m/s, ``slip_speed`` Q = hypot(v, rω) m/s and
    ``slip_angle`` φ rad follow, 0 at rest.  With ``jacobian=True``: ``jacobian`` (…, 6, 7), the
    derivatives of x, y, orientation, vx, vy and spin by vx, vy, spin, delta, decel and radius of
    the launch, and by time.
    """

    time: FloatArray
    rows: FloatArray = field(repr=False)
    radius: FloatArray
    explanation: str = ""
    _jacobian: FloatArray | None = None
    _wanted: tuple[FloatArray, npt.NDArray[np.int64]] | None = None  # launches (6, m), and which
    _anew: Callable[..., Any] | None = None
    _highest: float = 1.0
    JACOBIAN_COLUMNS: tuple[str, ...] = MOMENT_NAMES

    picture: ClassVar[str] = "places"
    JACOBIAN_ROWS: ClassVar[tuple[str, ...]] = STATE_NAMES

    def __repr__(self) -> str:
        return f"States({self.time.size} states of shape {self.time.shape})"

    x = _row(PUCK_X, "Place along x, m from the launch.")
    y = _row(PUCK_Y, "Place along y, m from the launch.")
    heading = _row(HEADING, "Direction of the velocity, rad.")
    orientation = _row(ORIENTATION, "How far the body has turned, rad.")
    speed = _row(SPEED, "V, m/s.")
    spin = _row(SPIN, "Ω, rad/s.")

    @property
    def vx(self) -> FloatArray:
        """Velocity along x, m/s."""
        return self.speed * np.cos(self.heading)

    @property
    def vy(self) -> FloatArray:
        """Velocity along y, m/s."""
        return self.speed * np.sin(self.heading)

    @property
    def slip_speed(self) -> FloatArray:
        """Q = hypot(v, rω), m/s."""
        return np.hypot(self.speed, self.radius * self.spin)

    @property
    def slip_angle(self) -> FloatArray:
        """Φ = atan2(rω, v), rad; 0 at rest."""
        return np.arctan2(self.radius * self.spin, self.speed)

    @property
    def _arguments(self) -> FloatArray:  # type: ignore[override]
        assert self._wanted is not None
        launches, which = self._wanted
        each = each_of(which, self.time.size)
        return np.concatenate([launches[:, each], self.time.reshape(1, -1)])

    def explain(self) -> str:
        """How they were got."""
        return self.explanation

    def dataset(self) -> Dataset:
        """The states, over as many axes as they have."""
        dims = tuple(f"axis_{n}" for n in range(self.x.ndim)) or ("state",)
        shape = self.x.shape or (1,)
        names = (
            "time", "x", "y", "vx", "vy", "heading", "orientation", "speed", "spin", "slip_speed",
            "slip_angle",
        )  # fmt: skip
        columns = {n: variable(n, getattr(self, n).reshape(shape), dims) for n in names}
        return Dataset({}, columns, {"title": "States of sliding, spinning pucks"})


def states(
    velocity: npt.ArrayLike,
    spin: npt.ArrayLike,
    time: npt.ArrayLike,
    *,
    delta: npt.ArrayLike = DEFAULT_DELTA,
    decel: npt.ArrayLike = DEFAULT_DECEL,
    radius: npt.ArrayLike = 1.0,
    friction: npt.ArrayLike | None = None,
    height: npt.ArrayLike = DEFAULT_HEIGHT,
    gravity: float = DEFAULT_GRAVITY,
    table: StopTable | None = None,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
    jacobian: bool = False,
    threads: int | None = None,
) -> States:
    """States of pucks at times after their launches, in any order, also after the stop.

    Parameters
    ----------
    velocity : array_like (…, 2), m/s
    spin : array_like (…), rad/s, counter-clockwise positive
    time : array_like (…), s, ≥ 0
    delta : array_like (…), dimensionless height 2fh/r
        Below 3.9637 under uniform pressure, up to the full contact of another law; with a table 0
        to 1.
    decel : array_like (…), fg, m/s², > 0
    radius : array_like (…), m, > 0
    friction, height : array_like (…), Coulomb's coefficient f > 0 and the height h ≥ 0, m
        In place of ``delta`` and ``decel``: δ = 2fh/r and fg follow with ``gravity``, m/s², a
        number.  Derivatives are then by friction and height.
    table : Table of stops, optional
        The default one if left out.
    pressure, gyration
        As :class:`puck_tables.Puck`.  For δ > 1 or another kind of puck each puck is integrated,
        which takes some milliseconds, and a second for each different height; from 1500 pucks of
        one height on they are looked up where splines are as good, made in one to three seconds.
    jacobian : bool
        Whether derivatives are wanted too: of x, y, orientation, vx, vy and spin by vx, vy, spin,
        delta, decel and radius of the launch, and by time (velocity and acceleration), in this
        order.
    threads : int, optional
        How many share the work: as many as the process may use cores, if left out.  The numbers do
        not depend on it, to the last bit.

    Returns
    -------
    States
        Of the shape to which the pucks and ``time`` broadcast: for every time of every puck give
        the pucks one axis more, ``states(velocity[:, None, :], spin[:, None], time)``.  With the
        default table, and of every other puck, errors stay below 1e-9 of Q, Q²/(fg) (places) and
        Q²/(fg r) (body angle); of the heading, times v/Q.  With ``jacobian``, ``jacobian`` (…, 6,
        7); see the notes for its error.

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range, a motion is too
        large for floating point.
    AccuracyError
        If derivatives are asked for, and an error of 1e-7 is out of reach for such a puck.

    Notes
    -----
    All motions of a puck of height δ are one curve, up to rotation, reflection and scale; the time
    that is left says where on it a state stands (:mod:`puck_tables.stopping.similarity_lookup`).

    Derivatives follow from that curve by the chain rule, of other than plain pucks from variational
    equations; nothing is differenced (:mod:`puck_tables.stopping.state_jacobian`,
    :mod:`puck_tables.stopping.variational`).  In units of Q, J, r of the launch they err by at
    most 1e-7 until Q has fallen to 1/1000, for launches of any slip angle.  Towards the stop the
    direction turns without end, and the velocity is that of a moment as far off as the stop time
    may be, 1e-10 Q/(fg).  At the stop and after it they are those of the stop, and of velocities 0.
    In exact pure sliding and pure spin they are the limits from launches beside.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2 (symmetry) and eq. 6.2–6.7.

    Examples
    --------
    >>> result = states((1.0, 0.0), 5.0, [2.0, 0.0, 99.0])
    >>> result.x.round(6).tolist(), result.spin.round(6).tolist()
    ([1.590682, 0.0, 2.213952], [2.426862, 5.0, 0.0])
    >>> result = states((1.0, 0.0), 5.0, 2.0, jacobian=True)
    >>> float(result.derivative("x", "delta").round(6))
    0.029301
    """
    checked_threads(threads)
    checked_flag("jacobian", jacobian)
    refuse_other_kind(table, StopTable)
    highest = plain_up_to(pressure, gyration)
    if table is not None:
        if not highest > 0.0:
            raise InputError("stop tables are of a homogeneous puck under uniform pressure")
        highest = UPPER_DELTA
    chosen = StopTable.shipped() if table is None else table
    delta, decel, by = delta_and_decel(delta, decel, radius, friction, height, gravity)
    launches = launches_of(velocity, spin, delta, decel, radius)
    times = real_view("time", time, "s")
    all_plain = launches.tallest <= highest
    if not all_plain:
        launches.refuse_bad()
        if table is not None:
            table.checked_range(launches.delta)
    which, moments, shape = moments_of(launches, times)
    slopes = np.empty((moments.size, len(STATE_NAMES), len(MOMENT_NAMES))) if jacobian else None
    if all_plain:
        looked_up = all_looked_up(chosen, launches, which, moments, threads, slopes)
        bodies, words = {}, _explained(launches.size, 0)
    else:
        refuse_times(moments)
        each = each_of(which, moments.size)
        rows = launches.matrix
        plain = rows[3] <= highest
        bodies = _bodies(pressure, gyration, rows[3, ~plain])
        longest = max((body.longest for body in bodies.values()), default=2.0)
        if not fits(rows, longest).all():
            raise InputError(TOO_LARGE)
        looked_up, looked = np.empty((STATE_ROWS, moments.size)), plain[each]
        which_plain = (np.cumsum(plain) - 1)[each[looked]]
        part = None if slopes is None else np.empty((which_plain.size, *slopes.shape[1:]))
        looked_up[:, looked] = all_looked_up(
            chosen, launches_in(rows[:, plain]), which_plain, moments[looked], threads, part
        )
        others = np.flatnonzero(~plain)
        if slopes is not None:
            slopes[looked] = part
            integrated_jacobians(bodies, rows, others, each, moments, slopes, threads)
        looked = fill_others(bodies, rows, others, each, moments, looked_up, threads)
        words = _explained(int(plain.sum()) + looked, others.size - looked)
    if slopes is None:
        return states_in(looked_up, moments, launches, which, shape, words)
    rows, names = launches.matrix, MOMENT_NAMES
    how: dict[str, Any] = {"table": table, "pressure": pressure, "gyration": gyration}
    if by is not None:
        rows = by.chained(launches, slopes, each_of(which, moments.size))
        names, how["gravity"] = (*FRICTION_NAMES, "time"), by.gravity
    return states_in(
        looked_up, moments, launches, which, shape, words,
        slopes.reshape(*shape, *slopes.shape[1:]), (rows, which),
        partial(states, threads=threads, **how), math.inf if bodies else 1.0, names,
    )  # fmt: skip


@lru_cache
def _explained(looked: int, integrated: int) -> str:
    each = ((looked, "looked up"), (integrated, "integrated"))
    words = [f"{count} pucks {how}" for count, how in each if count] or ["no pucks looked up"]
    return " and ".join(words) + ", to 1e-9 of Q, Q^2/(f g) and Q^2/(f g r)"


def moments_of(
    launches: Launches, times: FloatArray
) -> tuple[npt.NDArray[np.int64], FloatArray, tuple[int, ...]]:
    """Which launch each moment is of, as compiled code reads it, the moments, and their shape.

    >>> one = launches_of((1.0, 0.0), 0.0, 0.5, 1.0, 1.0)
    >>> [part.tolist() for part in moments_of(one, np.array([0.0, 2.0]))[:2]]
    [[0], [0.0, 2.0]]
    """
    if launches.shape == () or launches.shape == times.shape:
        which = _NONE if launches.shape else _FIRST
        flat = times.reshape(-1)
        return which, flat if flat.flags.writeable else flat.copy(), times.shape
    numbers = np.arange(launches.size).reshape(launches.shape)
    one, other = broadcast(velocity=numbers.astype(np.float64), time=times)
    moments = np.array(other, order="C").reshape(-1)
    if one.shape == launches.shape:
        return _NONE, moments, one.shape
    return one.reshape(-1).astype(np.int64), moments, one.shape


def each_of(which: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.int64]:
    """Which launch each of so many moments is of.

    >>> each_of(np.array([3]), 2).tolist(), each_of(np.empty(0, int), 2).tolist()
    ([3, 3], [0, 1])
    """
    return np.broadcast_to(which, count) if which.size else np.arange(count)


def _bodies(pressure: str | Law, gyration: float, delta: FloatArray) -> dict[float, UnitPuck]:
    """The pucks of these heights."""
    heights = np.unique(delta)
    refuse_many(heights)
    if not heights.size:
        return {}
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    return {height: body_of(law, height, gyration) for height in heights.tolist()}


def states_in(
    out: FloatArray, moments: FloatArray, launches: Launches, which: npt.NDArray[np.int64],
    shape: tuple[int, ...], explanation: str, *differentiated: Any,
) -> States:  # fmt: skip
    """Rows of states in their shape; ``differentiated``: derivatives, and of what they are."""
    radius = launches.radius
    if radius.size > 1:
        radius = radius[which] if which.size else radius.copy()
    radius = (
        radius.reshape(shape) if radius.size == moments.size else np.broadcast_to(radius, shape)
    )
    rows = out.reshape((STATE_ROWS, *shape))
    return States(moments.reshape(shape).copy(), rows, radius, explanation, *differentiated)
