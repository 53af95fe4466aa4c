"""The numbers of a puck, without what can be asked of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

from puck_tables._core.doubts import MOST_FRICTION, OF_A_PUCK
from puck_tables._core.fields import Unsaid, of
from puck_tables._core.own_folder import say
from puck_tables._core.reading import Reading, entries_in, mark_checked, read_values
from puck_tables._core.real import positive, real
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.motion.body import (
    LARGEST_GYRATION,
    SMALLEST_GYRATION,
    STANDARD_GRAVITY,
    UnitPuck,
    body_of,
)

_ROUNDED = 0.01  # of a radius: what a profile and a puck may differ by


@dataclass(frozen=True)
class PuckSpec:
    """The numbers of a puck, checked when it is made; :class:`puck_tables.Puck` adds its verbs.

    What computes takes this class: it stands below all that can be asked of a puck.

    Examples
    --------
    >>> puck = PuckSpec(radius=0.0381, height=0.0254, friction=0.1, mass=0.17)  # ice hockey
    >>> round(puck.delta, 6), round(puck.decel, 6)
    (0.133333, 0.980665)
    """

    radius: float = of("number", unit="m", low=0.0, above=True, usual=OF_A_PUCK, doc="of the base")
    height: float = of(
        "number", 0.0, "m", low=0.0, usual=OF_A_PUCK,
        doc="twice that of its centre of mass; 0: no tilt",
    )  # fmt: skip
    friction: float = of("number", 0.0, low=0.0, usual=MOST_FRICTION, doc="Coulomb's coefficient f")
    mass: float = of("number", 1.0, "kg", low=0.0, above=True)
    gravity: float = of(
        "number", Unsaid(STANDARD_GRAVITY), "m/s^2", low=0.0, above=True, objects=(Unsaid,),
        doc="in a scene that has none of its own",
    )  # fmt: skip
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
        values = read_values(type(self), entries_in(self, {}), "", reading)
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
        if (rim := self.body.law.rim) is not None and abs(rim - self.radius) > _ROUNDED * rim:
            say(  # once for a law, however many radii
                f"{self.body.law.name} ends at {rim:g} m: pucks of another radius have its "
                "pressure over their own"
            )
        mark_checked(self)

    @classmethod
    def similar(
        cls, *, delta: float = 0.5, decel: float = 1.0, radius: float = 1.0, mass: float = 1.0,
        pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
    ) -> Self:  # fmt: skip
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
        >>> from puck_tables import Puck
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
    def body(self) -> UnitPuck:
        """Pressure law, δ and gyration: what the motion depends on besides its scale."""
        return body_of(self.pressure, self.delta, self.gyration)

    @property
    def limit_ratio(self) -> float:
        """The ratio rω/v that every motion with speed and spin tends to; 0 and inf included.

        Examples
        --------
        >>> round(PuckSpec.similar(delta=0.0).limit_ratio, 6)
        1.531389
        """
        return self.body.limit_ratio

    @property
    def limit_epsilon(self) -> float:
        """The same as ε = v/(rω), as several papers write it.

        Examples
        --------
        >>> round(PuckSpec.similar(delta=0.0).limit_epsilon, 6)
        0.653002
        """
        ratio = self.limit_ratio
        return math.inf if ratio == 0.0 else 1.0 / ratio

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

    def arguments(self) -> dict[str, Any]:
        """As the functions over arrays of pucks take it."""
        self.refuse_frictionless()
        return {
            "delta": self.delta, "decel": self.decel, "radius": self.radius,
            "pressure": self.pressure, "gyration": self.gyration,
        }  # fmt: skip

    def described(self) -> dict[str, Any]:
        """Its numbers by name, with δ and J, as results and files carry them."""
        numbers = {name: getattr(self, name) for name in ("radius", "height", "friction", "mass")}
        law = self.body.law.name
        return {
            **numbers, "gravity": self.gravity, "delta": self.delta, "decel": self.decel,
            "pressure": law, "gyration": self.gyration,
        }  # fmt: skip


PUCK_UNITS = {
    "radius": "m", "height": "m", "friction": "1", "mass": "kg", "gravity": "m/s^2", "delta": "1",
    "decel": "m/s^2", "gyration": "1",
}  # fmt: skip
