"""The puck, and all that can be asked of one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from puck_tables._core.executor import Progress
from puck_tables._core.fields import of
from puck_tables._core.reading import Reading, given_in, mark_checked, read_values
from puck_tables._core.real import positive, real
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.motion.body import (
    LARGEST_GYRATION,
    SMALLEST_GYRATION,
    STANDARD_GRAVITY,
    Body,
    body_of,
)

if TYPE_CHECKING:
    from puck_tables.stopping.aim import Aim
    from puck_tables.stopping.states import States
    from puck_tables.stopping.stops import Stops
    from puck_tables.stopping.sweep import StopMap
    from puck_tables.table.table import Table
    from puck_tables.trajectory import Trajectory


def _verb(module: str, name: str) -> Any:
    """What answers a question about a puck stands above it, and is loaded when it is asked."""
    return getattr(import_module(f"puck_tables.{module}"), name)


@dataclass(frozen=True)
class Puck:
    """A flat puck on a rough floor.

    Parameters
    ----------
    radius, height : m
        Of the base, > 0, and of the centre of mass over the floor, ≥ 0.
    friction : Coulomb coefficient f, ≥ 0
        0, where it is left out: a puck that never stops by itself, for scenes alone.
    mass : kg, > 0; of a free puck only energies depend on it
    gravity : m/s², > 0
    pressure : contact pressure: uniform, galin, hertz, ring, annulus:INNER, a CSV file of ρ, W, or
        a Law
    gyration : radius of gyration about the vertical axis over r, 0.1 to 10; √½ for a homogeneous
        puck, 1 for a ring

    Its motion depends, up to scale, on ``delta`` = 2fh/r, the pressure and the gyration; the scale
    of time is Q/J with ``decel`` = J = fg.

    Raises
    ------
    InputError
        If a number is not finite or out of range, or the pressure is not known.
    ContactError
        If the puck tips, or its contact is not known or not determined.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 1.

    Examples
    --------
    >>> puck = Puck(radius=0.0381, height=0.0254, friction=0.1, mass=0.17)  # ice hockey
    >>> round(puck.delta, 6), round(puck.decel, 6)
    (0.133333, 0.980665)
    >>> round(puck.simulate((2.0, 0.0), 30.0).stop_time, 6)
    2.345288
    """

    radius: float = of("number", unit="m", low=0.0, above=True, doc="of the base")
    height: float = of("number", 0.0, "m", low=0.0, doc="of the centre over the floor; 0: no tilt")
    friction: float = of("number", 0.0, low=0.0, doc="Coulomb's coefficient f")
    mass: float = of("number", 1.0, "kg", low=0.0, above=True)
    gravity: float = of("number", STANDARD_GRAVITY, "m/s^2", low=0.0, above=True)
    pressure: str | Law = of(
        "text", "uniform", file=".csv", objects=(Law,),
        doc="pressure law, as build-tables --pressure takes it",
    )  # fmt: skip
    gyration: float = of(
        "number", HOMOGENEOUS, low=SMALLEST_GYRATION, high=LARGEST_GYRATION,
        doc="radius of gyration about the vertical over the radius",
    )  # fmt: skip

    def __post_init__(self) -> None:
        reading = Reading([], None)
        values = read_values(type(self), given_in(self, {}), "", reading)
        if values is None:
            raise InputError("; ".join(reading.errors))
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if not (math.isfinite(self.delta) and self.decel < math.inf) or (
            self.decel == 0.0 and self.friction > 0.0
        ):
            raise InputError(
                f"radius {self.radius:g} m, height {self.height:g} m, friction {self.friction:g} "
                f"and gravity {self.gravity:g} m/s^2 give delta = {self.delta:g} and J = "
                f"{self.decel:g} m/s^2: out of the range of floating point"
            )
        object.__setattr__(self, "gyration", self.body.gyration)
        mark_checked(self)

    @classmethod
    def similar(
        cls, *, delta: float = 0.5, decel: float = 1.0, radius: float = 1.0, mass: float = 1.0,
        pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
    ) -> Puck:  # fmt: skip
        """A puck by what its motion depends on: δ, J and radius.

        Parameters
        ----------
        delta : dimensionless height 2fh/r, ≥ 0
            Below 3.9637 under uniform pressure (from 1 on part of the base may lift), up to the
            full contact of another law.
        decel : J = fg, m/s², > 0
        radius, mass, pressure, gyration
            As for :class:`Puck`.

        Returns
        -------
        Puck
            With friction 1 and the gravity and height that give these numbers: similar to every
            other with the same δ and J.

        Examples
        --------
        >>> puck = Puck.similar(delta=0.5)
        >>> puck.delta, puck.decel, puck.friction
        (0.5, 1.0, 1.0)
        """
        r, height = positive("radius", radius, "m"), real("delta", delta, "dimensionless")
        if not height >= 0.0:
            raise InputError(f"delta = 2 f h / r must not be negative, got {height:g}")
        return cls(
            radius=r, height=0.5 * height * r, friction=1.0, mass=mass,
            gravity=positive("decel", decel, "m/s^2"), pressure=pressure, gyration=gyration,
        )  # fmt: skip

    @property
    def delta(self) -> float:
        """Dimensionless height 2fh/r."""
        return 2.0 * self.friction * self.height / self.radius

    @property
    def decel(self) -> float:
        """Deceleration of a slide without spin, J = fg, m/s²."""
        return self.friction * self.gravity

    @cached_property
    def body(self) -> Body:
        """Pressure law, δ and gyration: what the motion depends on besides its scale."""
        return body_of(self.pressure, self.delta, self.gyration)

    @property
    def limit_ratio(self) -> float:
        """The ratio rω/v that every motion with speed and spin tends to; 0 and inf included.

        Examples
        --------
        >>> round(Puck.similar(delta=0.0).limit_ratio, 6)
        1.531389
        """
        return self.body.limit_ratio

    @property
    def limit_epsilon(self) -> float:
        """The same as ε = v/(rω), as several papers write it.

        Examples
        --------
        >>> round(Puck.similar(delta=0.0).limit_epsilon, 6)
        0.653002
        """
        ratio = self.limit_ratio
        return math.inf if ratio == 0.0 else 1.0 / ratio

    def regime(self, velocity: npt.ArrayLike, spin: float = 0.0) -> str:
        """Which kind of motion a launch leads to.

        Returns
        -------
        str
            A rest, B0 pure spin, C0 pure translation, D limit motion, B more spin than the limit
            motion, C less.

        Examples
        --------
        >>> Puck.similar().regime((1.0, 0.0), 5.0)
        'B'
        """
        kind: str = _verb("motion.limits", "regime")(
            velocity, spin, self.delta, self.radius, self.pressure, self.gyration
        )
        return kind

    def simulate(
        self,
        velocity: npt.ArrayLike,
        spin: float = 0.0,
        *,
        frames: int | None = None,
        times: npt.ArrayLike | None = None,
        tol: float = 1e-9,
        method: str | None = None,
        exact: bool = False,
        table: Table | None = None,
    ) -> Trajectory:
        """The motion after a launch, until the puck stops.

        Parameters
        ----------
        velocity : (vx, vy), m/s
        spin : rad/s, counter-clockwise positive
        frames : int, optional
            How many states, equally spaced from the launch to the stop (1: the launch); default
            101.
        times : array_like, s, ≥ 0, any order, optional
            The times of the states instead; after the stop the puck is at rest.
        tol : float
            Largest error of the stop wanted, in units of Q/J (time) and Q²/J (place); 1e-13 to
            0.01, from 1e-11 on for a puck with δ > 1, another law or radius of gyration.  Of these
            the states on the way keep it too, speed and rω in units of Q; those of other pucks may
            be off by 3 times that (measured: 2.8, launched next to φ = π/4).  The cheapest
            integrator whose measured error is below it is taken; ``explain()`` of the result says
            which and why.
        method : 'adaptive' (Dormand–Prince 5(4)) or 'rk4', optional
            Only this one.
        exact : bool
            Closed forms instead of the table: a homogeneous puck under uniform pressure in full
            contact.
        table : Table of resultants, optional
            Under the pressure law of the puck.  Left out: the default table, or the law itself.

        Returns
        -------
        Trajectory

        Raises
        ------
        InputError
            If an argument is not finite, has the wrong shape or lies outside its range.
        ContactError
            If, with ``exact``, part of the base would be lifted on the way.
        AccuracyError
            If the tolerance is out of reach of table or method.

        References
        ----------
        Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7.

        Examples
        --------
        >>> run = Puck.similar().simulate((1.0, 0.0), 5.0)
        >>> run.regime, round(run.stop_time, 8), round(run.stop_position[0], 8)
        ('B', 3.96299205, 2.21395163)
        """
        self.refuse_frictionless()
        run: Trajectory = _verb("trajectory", "simulate")(
            self, velocity, spin, frames=frames, times=times, tol=tol, method=method, exact=exact,
            table=table,
        )  # fmt: skip
        return run

    def stop(
        self,
        velocity: npt.ArrayLike,
        spin: npt.ArrayLike = 0.0,
        *,
        tol: float = 1e-8,
        method: str | None = None,
        table: Table | None = None,
    ) -> Stops:
        """Where and when launches of this puck stop; velocity and spin broadcast.

        Parameters
        ----------
        velocity : array_like (…, 2), m/s
        spin : array_like (…), rad/s, counter-clockwise positive
        tol, method, table
            As for :func:`puck_tables.stop`.

        Returns
        -------
        Stops

        Examples
        --------
        >>> Puck.similar(delta=1.0).stop((1.0, 0.0), [1.0, 5.0]).stop_time.round(6).tolist()
        [1.395088, 4.000189]
        """
        stops: Stops = _verb("stopping.stops", "stop")(
            velocity, spin, **self._kind(), tol=tol, method=method, table=table
        )
        return stops

    def states(
        self,
        velocity: npt.ArrayLike,
        spin: npt.ArrayLike,
        time: npt.ArrayLike,
        *,
        table: Table | None = None,
    ) -> States:
        """States of this puck at any times after launches, by look-up; all broadcasts.

        Parameters
        ----------
        velocity : array_like (…, 2), m/s
        spin : array_like (…), rad/s
        time : array_like (…), s, ≥ 0
        table : Table of stops, optional

        Returns
        -------
        States

        Examples
        --------
        >>> Puck.similar().states((1.0, 0.0), 5.0, [2.0, 0.0]).x.round(6).tolist()
        [1.590682, 0.0]
        """
        found: States = _verb("stopping.states", "states")(
            velocity, spin, time, **self._kind(), table=table
        )
        return found

    def sweep(
        self,
        spin: npt.ArrayLike | None = None,
        speed: npt.ArrayLike | None = None,
        *,
        velocity: npt.ArrayLike | None = None,
        delta: npt.ArrayLike | None = None,
        tol: float = 1e-8,
        method: str | None = None,
        table: Table | None = None,
        threads: int | None = None,
        chunk: int = 1024,
        progress: Progress | None = None,
        checkpoint: str | Path | None = None,
    ) -> StopMap:
        """Stops of all combinations of spins and speeds, and of heights.

        Parameters
        ----------
        spin : number or array (n,), rad/s
        speed : number or array (n,), m/s, ≥ 0, along x
            Without ``spin``, ``speed`` and ``velocity``: a map of 41 speeds by 41 spins.
        velocity : (vx, vy), m/s, instead of ``speed``
        delta : number or array (n,), optional
            Dimensionless heights instead of that of the puck.
        tol : float
            Largest error in units of Q/J (time) and Q²/J (place).
        method, table : optional
            As for :func:`puck_tables.stop`.
        threads, chunk : int
            How the work is cut; the numbers do not depend on it, to the last bit.
        progress : callable (done, total), optional
        checkpoint : path, optional
            A file that keeps what is done: called again with the same arguments, the work goes on
            from there.  It stays until you remove it.

        Returns
        -------
        StopMap
            One dimension for each argument that is an array.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range, the map would not fit in memory, or
            ``checkpoint`` belongs to other work.
        AccuracyError
            If the tolerance is out of reach.

        Examples
        --------
        >>> stops = Puck.similar(delta=0.0).sweep([0.0, 1.0, 2.0], velocity=(1.0, 0.0))
        >>> stops.stop_x.round(4).tolist()
        [0.5, 0.6374, 0.9835]
        """
        stops: StopMap = _verb("stopping.sweep", "sweep")(
            spin, speed, velocity=velocity, **{**self._kind(), **_given(delta=delta)}, tol=tol,
            method=method, table=table, threads=threads, chunk=chunk, progress=progress,
            checkpoint=checkpoint,
        )  # fmt: skip
        return stops

    def aim(
        self,
        target: npt.ArrayLike,
        *,
        spin: float | None = None,
        speed: float | None = None,
        stop_time: float | None = None,
        max_speed: float | None = None,
        max_spin: float | None = None,
        count: int = 8,
    ) -> Aim:
        """Launches after which the puck comes to rest at a given displacement.

        They are a family: one for each slip angle and sense of spin.  A spin, a speed or a stop
        time picks one or two of it; without any, a sample is given.

        Parameters
        ----------
        target : (x, y), m from the launch
        spin : wanted, rad/s, with its sign
        speed : launch speed wanted, m/s
        stop_time : duration wanted, s
        max_speed, max_spin : bounds on speed (m/s) and on |spin| (rad/s)
        count : how many slip angles a sample has, for each sense of spin
            Equally spaced from the least spin that ``max_speed`` allows (0 without it) to
            ``max_spin`` (without it: to φ = 80°).  Where the bounds allow several ranges of slip
            angles, each has its share, at least one.

        Returns
        -------
        Aim
            With no launch, and the reason in ``answer``, where there is none.  Errors of about
            1e-12 of the distance, 1e-9 for δ > 1 or another kind of puck; every launch is
            integrated and its ``miss`` reported.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range, or two of ``spin``, ``speed`` and
            ``stop_time`` are given.

        Notes
        -----
        Displacement = (Q²/J) Rot(ψ)(X, ±Y)(φ, δ), so at each φ the place fixes Q and ψ.  As φ goes
        from 0 to π/2 the speed falls from √(2JD) to 0, spin and stop time grow without bound from 0
        and √(2D/J), D the distance: each value is met once for each sense of spin.  For tall pucks,
        δ from about 3.5 on, speed and time are not monotonic: a value may be met several times, and
        a launch with spin may be faster than any without.  All are found.

        References
        ----------
        Salnikova, Treschev, Gallyamov 2012, section 2: the symmetry of the motion.

        Examples
        --------
        >>> found = Puck.similar().aim((2.0, 0.1), spin=5.0)
        >>> found.launch_velocity.round(6).tolist(), found.stop_time.round(6).tolist()
        ([[0.899671, 0.109151]], [3.927704])
        """
        self.refuse_frictionless()
        found: Aim = _verb("stopping.aim", "aim")(
            self, target, spin=spin, speed=speed, stop_time=stop_time, max_speed=max_speed,
            max_spin=max_spin, count=count,
        )  # fmt: skip
        return found

    def refuse_frictionless(self) -> None:
        """Refuse what asks for the stop of a puck that nothing brakes.

        Raises
        ------
        InputError
        """
        if self.friction == 0.0:
            raise InputError(
                "a puck with friction = 0 never stops: give friction > 0, or put it into a Scene"
            )

    def described(self) -> dict[str, Any]:
        """Its numbers by name, with δ and J, as results and files carry them."""
        numbers = {name: getattr(self, name) for name in ("radius", "height", "friction", "mass")}
        law = self.body.law.name
        return {
            **numbers, "gravity": self.gravity, "delta": self.delta, "decel": self.decel,
            "pressure": law, "gyration": self.gyration,
        }  # fmt: skip

    def _kind(self) -> dict[str, Any]:
        """As the functions over arrays of pucks take it."""
        self.refuse_frictionless()
        return {
            "delta": self.delta, "decel": self.decel, "radius": self.radius,
            "pressure": self.pressure, "gyration": self.gyration,
        }  # fmt: skip


PUCK_UNITS = {
    "radius": "m", "height": "m", "friction": "1", "mass": "kg", "gravity": "m/s^2", "delta": "1",
    "decel": "m/s^2", "gyration": "1",
}  # fmt: skip


def _given(**values: Any) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value is not None}
