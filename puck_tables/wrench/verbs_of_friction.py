"""What friction does with a puck that slips, and with one that is pushed and rests."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy.typing as npt

from puck_tables.scene.pucks_and_posts import ScenePuck

if TYPE_CHECKING:
    from puck_tables.wrench.friction_hold import Hold, Twist, Wrench
    from puck_tables.wrench.surface import LimitSurface


@dataclass(frozen=True, repr=False)
class VerbsOfFriction(ScenePuck):
    """A puck, and the questions about forces on it; :class:`puck_tables.Puck` has all."""

    def limit_surface(self, n: int | None = None) -> LimitSurface:
        """What force and torque friction takes up, over the direction of slip.

        Parameters
        ----------
        n : how many slip angles, equally spaced from −π/2 to π/2
            5 to 1e6 and one, 181 if left out; with a base 5 to 1001, 31 if left out, each in
            2n − 1 directions of slip.

        Returns
        -------
        LimitSurface
            With the ellipsoid and the convex polynomial of order 4 that fit it best; with a base
            over the direction of slip, too, in the axes of the base.

        Raises
        ------
        InputError
            If ``n`` is not such a number, or the puck has no friction.

        References
        ----------
        S. Goyal, A. Ruina, J. Papadopoulos, Planar sliding with dry friction, Wear 143, 1991.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> surface = Puck.similar(delta=0.0).limit_surface(91)
        >>> float(surface.torque[-1].round(6)), round(surface.ellipsoid.error, 3)
        (0.666667, 0.04)
        """
        from puck_tables.wrench.surface import limit_surface

        return limit_surface(self, n)

    def wrench(
        self, velocity: npt.ArrayLike, spin: npt.ArrayLike = 0.0, angle: npt.ArrayLike = 0.0, *,
        jacobian: bool = False,
    ) -> Wrench:  # fmt: skip
        """Force and torque of friction on this puck while it slips; all broadcasts.

        Parameters
        ----------
        velocity : array_like (…, 2), m/s, of the centre of mass over the floor
        spin : array_like (…), rad/s, counter-clockwise positive
        angle : array_like (…), rad, by which a base is turned
        jacobian : whether derivatives are wanted

        Returns
        -------
        Wrench
            ``force`` (…, 2), N, ``torque`` (…), N m, about the vertical through the centre of mass,
            as the floor exerts them, and ``jacobian`` (…, 3, 3), to v_x, v_y and the spin, or None.
            They err by some 1e-13 of f m g.

        Raises
        ------
        InputError
            If an argument is not finite or has the wrong shape, or a slip is 0.

        Notes
        -----
        Derivatives are closed forms under any base and uniform pressure in full contact; else
        central differences, good to 1e-8 off the singular lines of the pressure law.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> box = Puck(base="box:0.2x0.1", friction=0.3, mass=2.0)
        >>> found = box.wrench((1.0, 0.0), 10.0)
        >>> found.force.round(6).tolist(), float(found.torque.round(6))
        ([-5.090855, 0.0], -0.170834)
        """
        from puck_tables.wrench.friction_hold import wrench

        return wrench(self, velocity, spin, angle, jacobian)

    def twist(
        self, force: npt.ArrayLike, torque: npt.ArrayLike = 0.0, angle: npt.ArrayLike = 0.0
    ) -> Twist:
        """The slip in which friction is along a force and a torque; all broadcasts.

        The inverse of :meth:`wrench`.  What a push leads to is the slip whose friction is against
        it: give its negative.

        Parameters
        ----------
        force : array_like (…, 2), N
        torque : array_like (…), N m; force and torque of any size, not both 0
        angle : array_like (…), rad, by which a base is turned

        Returns
        -------
        Twist
            ``velocity`` (…, 2), m/s, and ``spin`` (…), rad/s, with hypot(v, lω) = 1 m/s, where l is
            the radius, or with a base the radius of gyration.

        Raises
        ------
        InputError
            If an argument is not finite or has the wrong shape, or no wrench acts.
        ContactError
            If the slip of a tall body was not found.

        Notes
        -----
        Of a flat body it is the least of what friction dissipates among slips of the same power
        against the wrench, which is convex; friction in it is along the wrench to 1e-11 of f m g,
        under other pressure laws than uniform to 1e-9.  Of a tall body that slip is given to which
        the one of the flat body leads.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> box = Puck(base="box:0.2x0.1", friction=0.3, mass=2.0)
        >>> found = box.twist((-5.0, 0.0), -0.2)
        >>> found.velocity.round(6).tolist(), float(found.spin.round(6))
        ([0.792114, 0.0], 9.455852)
        """
        from puck_tables.wrench.friction_hold import twist

        return twist(self, force, torque, angle)

    def holds(
        self, force: npt.ArrayLike, torque: npt.ArrayLike = 0.0, angle: npt.ArrayLike = 0.0
    ) -> Hold:
        """Whether friction holds this puck at rest under a force and a torque; all broadcasts.

        Parameters
        ----------
        force : array_like (…, 2), N
        torque : array_like (…), N m, counter-clockwise positive
        angle : array_like (…), rad, by which a base is turned

        Returns
        -------
        Hold
            ``held`` and ``margin``, by what they could be multiplied until it slips; true where a
            single puck is held.

        Raises
        ------
        InputError
            If an argument is not finite or has the wrong shape, or the puck has no friction.
        ContactError
            If the slip of a tall body on a base was not found.

        Notes
        -----
        Held are the force and torque that are not larger than those of their kind on the limit
        surface; margins err by 1e-9.  Scenes decide by the same rule.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> puck = Puck.similar(delta=0.0)  # f m g = 1 N, r = 1 m
        >>> bool(puck.holds((0.9, 0.0))), float(puck.holds((0.0, 0.0), 0.5).margin.round(6))
        (True, 1.333333)
        """
        from puck_tables.wrench.friction_hold import holds

        return holds(self, force, torque, angle)
