"""The puck, and what can be asked of it.

What answers stands below, and is loaded when it is asked: importing the puck stays light.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy.typing as npt

from puck_tables.verbs_of_many import VerbsOfMany

if TYPE_CHECKING:
    from puck_tables.stopping.aim_at_targets import Aim
    from puck_tables.stopping.states import States
    from puck_tables.stopping.stops import Stops
    from puck_tables.table.table import Table
    from puck_tables.trajectory import Trajectory


@dataclass(frozen=True, repr=False)
class Puck(VerbsOfMany):
    """A flat puck on a rough floor.

    Its motion depends, up to scale, on ``delta`` = 2fh/r, the pressure and the gyration; the scale
    of time is Q/(fg) with ``decel`` = fg.

    Parameters
    ----------
    radius : m, > 0, of the base
    height : m, ≥ 0
        Of the puck, whose centre of mass lies half as high; of a body that is not homogeneous,
        twice the height of its centre of mass.
    friction : Coulomb coefficient f, ≥ 0
        0, where it is left out: a puck that never stops by itself, for scenes alone.
    mass : kg, > 0; of a free puck only energies depend on it
    gravity : m/s², > 0; left out, that of its scene, or 9.80665
    pressure : contact pressure: uniform, galin, hertz, ring, annulus:INNER, a CSV file of ρ, W, or
        a Law
    gyration : radius of gyration about the vertical axis over r, 0.1 to 10; √½ for a homogeneous
        puck, 1 for a ring; with a base in m, left out that of a homogeneous body
    base : Base, or its text (:func:`puck_tables.contact.named_base.base_of`), in place of radius
        ``simulate``, ``stop``, ``states`` then integrate (:mod:`puck_tables.motion.base_motion`),
        with Q = hypot(v, kω); what is looked up or differentiated is refused.
    name, colour : in reports and pictures of a scene of several pucks, for which all below is
        A colour is '#rrggbb' or a name of CSS, such as 'steelblue'.
    launch : Launch
        Its place, and how it is sent; left out it lies at rest until it is hit.  Before
        ``launch.time`` it lies at its place.  Velocities (n, 2) are many launches, of one puck of
        a scene: an axis of its sweep.
    restitution, tangential, rim : impacts with other pucks
        e, 0 to 1, or a law by which it falls with the speed of approach, see
        :mod:`puck_tables.scene.restitution`; tangential restitution, −1 smooth, 0 the rims stop on
        each other, 1 their slip reverses; Coulomb's coefficient of the rims, which limits the
        tangential impulse.  Where two pucks meet the smaller of each counts, of restitutions at
        that speed; cushions have their own; a :class:`Rim` of a pair comes before both.
    path : rows or CSV of t, x, y and perhaps the angle
        A body that is driven there, straight between the rows, such as a mallet: pucks bounce off
        it, and nothing stops it.  :func:`puck_tables.rows_over_time` makes rows of a function.
    force, constraint : Force and Constraint, optional
        What acts on this puck alone, and what leads it.

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
    >>> box = Puck(base="box:0.2x0.1", friction=0.3)
    >>> round(box.simulate((1.0, 0.0), 10.0).stop_time, 6)
    0.448246
    >>> from puck_tables import Launch
    >>> Puck(0.0206, friction=0.1, name="striker", launch=Launch((3.0, 0.0))).launch.spin
    0.0
    """

    def regime(self, velocity: npt.ArrayLike, spin: float = 0.0) -> str:
        """Which kind of motion a launch leads to.

        Returns
        -------
        str
            A rest, B0 pure spin, C0 pure translation, D limit motion, B more spin than the limit
            motion, C less.  Of round pucks.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck.similar().regime((1.0, 0.0), 5.0)
        'B'
        """
        from puck_tables.motion.limits import regime

        self.refuse_base("regime")
        return regime(velocity, spin, self.delta, self.radius, self.pressure, self.gyration)

    def simulate(
        self,
        velocity: npt.ArrayLike,
        spin: float = 0.0,
        *,
        orientation: float = 0.0,
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
        orientation : rad
            Angle of the body at the launch, on a base that is not round.
        frames : int, optional
            How many states, equally spaced from the launch to the stop (1: the launch); default
            101.
        times : array_like, s, ≥ 0, any order, optional
            The times of the states instead; after the stop the puck is at rest.
        tol : float
            Largest error of the stop wanted, in units of Q/(fg) (time) and Q²/(fg) (place); 1e-13
            to 0.01, from 1e-11 on for a puck with δ > 1, another law or radius of gyration.  Of
            these the states on the way keep it too, speed and rω in units of Q; those of other
            pucks may be off by 3 times that (measured: 2.8, launched next to φ = π/4).  The
            cheapest integrator whose measured error is below it is taken; ``explain()`` of the
            result says which and why.  On a base that is not round 1e-12 to 0.01, and the angle of
            the body is as good: what it moves the farthest point of the base by, in units of
            Q²/(fg).
        method : 'adaptive' (Dormand–Prince 5(4)) or 'rk4', optional
            Only this one.
        exact : bool
            Closed forms instead of the table: a homogeneous puck under uniform pressure in full
            contact.
        table : Table of resultants, optional
            Under the pressure law of the puck.  Left out: the default table, or the law itself.

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
        >>> from puck_tables import Puck
        >>> run = Puck.similar().simulate((1.0, 0.0), 5.0)
        >>> run.regime, round(run.stop_time, 8), round(run.stop_position[0], 8)
        ('B', 3.96299205, 2.21395163)
        """
        from puck_tables.trajectory import simulate, simulate_on_base

        self.refuse_unless_free()
        if self.shape is not None:
            self.refuse_for_round(method=method, exact=exact, table=table)
            return simulate_on_base(
                self, velocity, spin, frames=frames, times=times, tol=tol, orientation=orientation
            )  # fmt: skip
        return simulate(
            self, velocity, spin, frames=frames, times=times, tol=tol, method=method, exact=exact,
            table=cast(Any, table), orientation=orientation,
        )  # fmt: skip

    def stop(
        self,
        velocity: npt.ArrayLike,
        spin: npt.ArrayLike = 0.0,
        *,
        tol: float = 1e-8,
        method: str | None = None,
        table: Table | None = None,
        jacobian: bool = False,
        threads: int | None = None,
    ) -> Stops:
        """Where and when launches of this puck stop; velocity and spin broadcast.

        Parameters
        ----------
        velocity : array_like (…, 2), m/s
        spin : array_like (…), rad/s, counter-clockwise positive
        tol, method, table, jacobian, threads
            As for :func:`puck_tables.stop`.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck.similar(delta=1.0).stop((1.0, 0.0), [1.0, 5.0]).stop_time.round(6).tolist()
        [1.395088, 4.000189]
        """
        if self.shape is not None:
            from puck_tables.stopping.stops import stop_on_base

            self.refuse_unless_free()
            self.refuse_for_round(method=method, table=table, jacobian=jacobian)
            return stop_on_base(self, velocity, spin, tol, threads)
        from puck_tables.stopping.stops import stop

        return stop(
            velocity, spin, **self.arguments(), tol=tol, method=method, table=cast(Any, table),
            jacobian=jacobian, threads=threads,
        )  # fmt: skip

    def states(
        self,
        velocity: npt.ArrayLike,
        spin: npt.ArrayLike,
        time: npt.ArrayLike,
        *,
        table: Table | None = None,
        jacobian: bool = False,
        threads: int | None = None,
    ) -> States:
        """States of this puck at any times after launches, by look-up; all broadcasts.

        Parameters
        ----------
        velocity : array_like (…, 2), m/s
        spin : array_like (…), rad/s
        time : array_like (…), s, ≥ 0
        table : Table of stops, optional
        jacobian : whether derivatives are wanted, as for :func:`puck_tables.states`
        threads : how many share the work, as for :func:`puck_tables.states`

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck.similar().states((1.0, 0.0), 5.0, [2.0, 0.0]).x.round(6).tolist()
        [1.590682, 0.0]
        """
        if self.shape is not None:
            from puck_tables.stopping.stops import states_on_base

            self.refuse_unless_free()
            self.refuse_for_round(table=table, jacobian=jacobian)
            return states_on_base(self, velocity, spin, time, threads)
        from puck_tables.stopping.states import states

        return states(
            velocity,
            spin,
            time,
            **self.arguments(),
            table=cast(Any, table),
            jacobian=jacobian,
            threads=threads,
        )

    def aim(
        self,
        target: npt.ArrayLike,
        *,
        spin: npt.ArrayLike | None = None,
        speed: npt.ArrayLike | None = None,
        stop_time: npt.ArrayLike | None = None,
        angle: npt.ArrayLike | None = None,
        max_speed: float | None = None,
        max_spin: float | None = None,
        count: int = 8,
        threads: int | None = None,
    ) -> Aim:
        """Launches after which the puck comes to rest at given displacements; all broadcasts.

        They are a family for each target: one for each slip angle and sense of spin.  A spin, a
        speed or a stop time picks one or two of it, an angle of the body at rest one for
        each number of whole turns; without any, a sample is given.

        Parameters
        ----------
        target : (x, y) or array_like (…, 2), m from the launch
        spin : array_like (…), wanted, rad/s, with its sign
        speed : array_like (…), launch speed wanted, m/s
        stop_time : array_like (…), duration wanted, s
        angle : array_like (…), of the body at rest wanted, rad up to whole turns, 0 at the launch
            Of each sense of spin the ``count`` launches with the fewest turns, within the bounds.
        max_speed, max_spin : bounds on speed (m/s) and on |spin| (rad/s)
        count : how many slip angles a sample has, for each sense of spin
            Equally spaced from the least spin that ``max_speed`` allows (0 without it) to
            ``max_spin`` (without it: to φ = 80°).  Where the bounds allow several ranges of slip
            angles, each has its share, at least one.
        threads : how many share the work, as for :func:`puck_tables.stop`

        Returns
        -------
        Aim
            All launches, looked up: some 1e-10 of the distance off, 1e-9 for δ > 1 or another kind
            of puck; ``miss`` integrates them.  Where nothing leads to one target, ``answer`` says
            why.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range, two of ``spin``, ``speed``,
            ``stop_time`` and ``angle`` are given, or the puck is on a base: that is aimed by
            :meth:`Scene.aim`.

        Notes
        -----
        Displacement = (Q²/(fg)) Rot(ψ)(X, ±Y)(φ, δ), so at each φ the place fixes Q and ψ.  As φ
        goes from 0 to π/2 the speed falls from √(2fgD) to 0, spin and stop time grow without bound
        from 0 and √(2D/(fg)), D the distance: each value is met once for each sense of spin.  For
        tall pucks, δ from about 3.5 on, speed and time are not monotonic: a value may be met
        several times, and a launch with spin may be faster than any without.  All are found.

        References
        ----------
        Salnikova, Treschev, Gallyamov 2012, section 2: the symmetry of the motion.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> found = Puck.similar().aim((2.0, 0.1), spin=5.0)
        >>> found.launch_velocity.round(6).tolist(), found.stop_time.round(6).tolist()
        ([[0.899671, 0.109151]], [3.927704])
        >>> many = Puck.similar().aim([(2.0, 0.1), (1.0, -1.0)], speed=1.7)
        >>> many.launches.tolist(), many.launch_spin.round(6).tolist()
        ([2, 0], [-1.981038, 1.981038])
        >>> pose = Puck.similar().aim((2.0, 0.1), angle=1.0, count=1)
        >>> pose.launch_spin.round(6).tolist(), pose.body_angle.round(6).tolist()
        ([-3.547515, 0.735296], [-5.283185, 1.0])
        """
        from puck_tables.stopping.aim_at_targets import aim

        self.refuse_base(
            "aim", "of round pucks: one on a base is aimed as a scene, Scene(puck).aim((x, y))"
        )
        self.refuse_unless_free()
        return aim(
            self, target, spin=spin, speed=speed, stop_time=stop_time, angle=angle,
            max_speed=max_speed, max_spin=max_spin, count=count, threads=threads,
        )  # fmt: skip
