"""The state of any puck at any time, by look-up: nothing is integrated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.executor import run_chunks
from puck_tables._core.real import broadcast, finite_array, instance, velocity_array
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of
from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import InputError
from puck_tables.io.dataset import Dataset, variable
from puck_tables.motion.body import body_of, is_plain
from puck_tables.result import Result
from puck_tables.stopping.solvers import fits
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.stops import positive_array

FloatArray = npt.NDArray[np.float64]

_CHUNK = 1 << 15


@dataclass(frozen=True, eq=False, repr=False)
class States(Result):
    """States of pucks at the times asked for, arrays of one shape.

    ``time`` s; ``x``, ``y`` m from the launch; ``heading`` rad, of the velocity (at rest that of
    the moment when Q had fallen to 1/1000); ``orientation`` rad, how far the body has turned;
    ``speed`` v m/s; ``spin`` ω rad/s.  ``vx``, ``vy`` m/s, ``slip_speed`` Q = hypot(v, rω) m/s and
    ``slip_angle`` φ rad follow, 0 at rest.
    """

    time: FloatArray
    x: FloatArray
    y: FloatArray
    heading: FloatArray
    orientation: FloatArray
    speed: FloatArray
    spin: FloatArray
    radius: FloatArray

    picture: ClassVar[str] = "places"

    def __repr__(self) -> str:
        return f"States({self.x.size} states of shape {self.x.shape})"

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

    def explain(self) -> str:
        """How they were got."""
        return "looked up, to 1e-9 of Q, Q^2/J and Q^2/(J r)"

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
    delta: npt.ArrayLike = 0.5,
    decel: npt.ArrayLike = 1.0,
    radius: npt.ArrayLike = 1.0,
    table: StopTable | None = None,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
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
    decel : array_like (…), J = fg, m/s², > 0
    radius : array_like (…), m, > 0
    table : Table of stops, optional
        The default one if left out.
    pressure, gyration
        As :class:`puck_tables.Puck`.  For δ > 1 or another kind of puck each puck is integrated,
        which takes some milliseconds, and a second for each different height.

    Returns
    -------
    States
        Of the shape to which the pucks and ``time`` broadcast: for every time of every puck give
        the pucks one axis more, ``states(velocity[:, None, :], spin[:, None], time)``.  With the
        default table, and of every other puck, errors stay below 1e-9 of Q, Q²/J (places) and
        Q²/(J r) (body angle); of the heading, times v/Q.

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range, or a motion is
        too large for floating point.

    Notes
    -----
    All motions of a puck of height δ are one curve, up to rotation, reflection and scale; the time
    that is left says where on it a state stands (:mod:`puck_tables.stopping.curve_lookup`).

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2 (symmetry) and eq. 6.2–6.7.

    Examples
    --------
    >>> found = states((1.0, 0.0), 5.0, [2.0, 0.0, 99.0])
    >>> found.x.round(6).tolist(), found.spin.round(6).tolist()
    ([1.590682, 0.0, 2.213952], [2.426862, 5.0, 0.0])
    """
    from puck_tables.motion.sliced import states_of
    from puck_tables.stopping.curve_lookup import STATE_ROWS, fill_states

    instance("table", table, StopTable, type(None))
    if table is None:
        highest = float(np.max(checked_delta(delta), initial=0.0))
        plain = is_plain(pressure, gyration, highest)
    elif not (plain := is_plain(pressure, gyration, 0.0)):
        raise InputError("stop tables are of a homogeneous puck under uniform pressure")
    chosen = StopTable.shipped() if table is None else table
    velocities = velocity_array(velocity)
    columns = broadcast(
        vx=velocities[..., 0],
        vy=velocities[..., 1],
        spin=finite_array("spin", spin, "rad/s"),
        delta=chosen.checked_range(delta) if plain else checked_delta(delta),
        decel=positive_array("decel", decel, "m/s^2"),
        radius=positive_array("radius", radius, "m"),
    )
    times = finite_array("time", time, "s")
    if not np.all(times >= 0.0):
        raise InputError(f"time must not be negative, got {times.min():g} s")
    launches = np.stack([column.ravel() for column in columns])
    longest = 2.0 if plain else body_of(pressure, 0.0, gyration).longest
    if not fits(launches, longest).all():
        raise InputError(
            "velocity, spin, radius and decel give a motion too large for floating point: "
            "use larger units"
        )
    numbers = np.arange(launches.shape[1]).reshape(columns[0].shape)
    which, moments = broadcast(velocity=numbers.astype(np.float64), time=times)
    shape = which.shape
    flat_which = np.ascontiguousarray(which, np.int64).reshape(-1)
    flat_moments = np.ascontiguousarray(moments).reshape(-1)
    out = np.empty((STATE_ROWS, flat_which.size))
    if not plain:
        law = pressure if isinstance(pressure, Law) else law_of(pressure)
        bodies = {d: body_of(law, d, gyration) for d in np.unique(launches[3]).tolist()}

        def integrate(start: int, stop: int) -> None:
            for n in range(start, stop):
                mine = flat_which == n
                if mine.any():
                    out[:, mine] = states_of(
                        bodies[float(launches[3, n])], launches[:, n], flat_moments[mine]
                    )

        run_chunks(integrate, launches.shape[1], 1)
        return _states(out, moments, launches, flat_which, shape)
    known = chosen.known(launches)
    pucks = np.concatenate([launches, known]).T.copy()

    def work(start: int, stop: int) -> None:
        part = np.empty((STATE_ROWS, stop - start))
        fill_states(
            pucks, flat_which[start:stop], flat_moments[start:stop],
            chosen.stop_coefficients, chosen.curve_coefficients, chosen.time_inverse, part,
        )  # fmt: skip
        out[:, start:stop] = part

    run_chunks(work, flat_which.size, _CHUNK)
    return _states(out, moments, launches, flat_which, shape)


def _states(
    out: FloatArray, moments: FloatArray, launches: FloatArray, which: npt.NDArray[np.int64],
    shape: tuple[int, ...],
) -> States:  # fmt: skip
    """Rows of states, headings from those of the launches, in their shape."""
    from puck_tables.stopping.curve_lookup import PSI, SPEED, SPIN, THETA, X, Y

    rows = [row.reshape(shape) for row in out]
    direction = np.where(
        (launches[0] == 0.0) & (launches[1] == 0.0), 0.0, np.arctan2(launches[1], launches[0])
    )
    return States(
        time=np.array(moments).reshape(shape),
        x=rows[X],
        y=rows[Y],
        heading=rows[PSI] + direction[which].reshape(shape),
        orientation=rows[THETA],
        speed=rows[SPEED],
        spin=rows[SPIN],
        radius=launches[5][which].reshape(shape),
    )
