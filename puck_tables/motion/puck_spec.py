"""The numbers of a puck, without what can be asked of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

from puck_tables._core.arrays import FloatArray, positive, real
from puck_tables._core.doubts import MOST_FRICTION, OF_A_PUCK, question, unquestioned
from puck_tables._core.drawn_outlines import SUFFIXES
from puck_tables._core.fields import KeepsDefaults, Unsaid, of
from puck_tables._core.own_folder import say
from puck_tables._core.reading import Reading, entries_in, mark_checked, read_values
from puck_tables.contact.base import Base
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.contact.named_base import NAMES as BASES
from puck_tables.contact.named_base import base_of
from puck_tables.errors import ContactError, InputError
from puck_tables.kernels.base_friction import packed
from puck_tables.motion.body import (
    LARGEST_GYRATION,
    SMALLEST_GYRATION,
    STANDARD_GRAVITY,
    UnitPuck,
    body_of,
)

ROUND_ONLY = "of round pucks: give a radius in place of the base"
_ROUNDED = 0.01  # of a radius: what a profile and a puck may differ by


@dataclass(frozen=True)
class PuckSpec(KeepsDefaults):
    """The numbers of a puck, checked when it is made; :class:`puck_tables.Puck` adds its verbs.

    What computes takes this class: it stands below all that can be asked of a puck.

    >>> puck = PuckSpec(radius=0.0381, height=0.0254, friction=0.1, mass=0.17)  # ice hockey
    >>> round(puck.delta, 6), round(puck.decel, 6)
    (0.133333, 0.980665)
    """

    radius: float = of(
        "number", None, "m", low=0.0, above=True, usual=OF_A_PUCK, objects=(Unsaid,),
        doc="of a round base, or of the rim around a base of another shape",
    )  # fmt: skip
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
        "number", None, low=0.0, above=True, objects=(Unsaid,),
        doc="radius of gyration about the vertical over the radius; with a base in m; homogeneous "
        "if left out",
    )  # fmt: skip
    base: str | Base = of(
        "text", "", file=SUFFIXES, objects=(Base,), doc=f"that is not round: {BASES}"
    )  # fmt: skip

    def __post_init__(self) -> None:
        reading = Reading([], None)
        values = read_values(type(self), entries_in(self), "", reading)
        if values is None:
            raise InputError("; ".join(reading.errors))
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if self.shape is not None:
            self._stand_on(self.shape)
        else:
            self._be_round()
        mark_checked(self)

    def _be_round(self) -> None:
        """Check a round puck, and give it what was left out."""
        if self.radius is None or isinstance(self.radius, Unsaid):
            raise InputError("radius is missing: it must be a number > 0 m, or give a base")
        if self.gyration is None or isinstance(self.gyration, Unsaid):
            object.__setattr__(self, "gyration", HOMOGENEOUS)
        self._refuse_out_of_range(self.delta)
        object.__setattr__(self, "gyration", self.body.gyration)
        if (rim := self.body.law.rim) is not None and abs(rim - self.radius) > _ROUNDED * rim:
            say(  # once for a law, however many radii
                f"{self.body.law.name} ends at {rim:g} m: pucks of another radius have its "
                "pressure over their own"
            )

    def _stand_on(self, shape: Base) -> None:
        """Check a puck on a base, and give it what was left out.

        Raises InputError.
        """
        if self.has_rim and not self.radius >= shape.reach:
            raise InputError(
                f"radius = {self.radius:g} m: with a base it is that of the rim, which must not be "
                f"less than the reach of the base, {shape.reach:.6g} m, or left out"
            )
        if self.pressure != "uniform":
            raise InputError(
                "pressure: under a base it is linear, and fixed by the weight; pressure laws are "
                "of round pucks with a radius"
            )
        if not isinstance(self.base, str):  # of a text its lengths are
            question("base", shape.reach, "m", OF_A_PUCK)
        if not self.has_rim:
            object.__setattr__(self, "radius", Unsaid(shape.reach))
        if self.gyration is None or isinstance(self.gyration, Unsaid):
            if not shape.is_centred:
                raise InputError(
                    "gyration is missing: a body whose centre of mass is not the middle of its "
                    "base is not homogeneous; give its radius of gyration, m"
                )
            object.__setattr__(self, "gyration", Unsaid(shape.gyration))
        ratio = self.gyration / shape.reach
        if not SMALLEST_GYRATION <= ratio <= LARGEST_GYRATION:
            raise InputError(
                f"gyration of a base must be {SMALLEST_GYRATION:g} to {LARGEST_GYRATION:g} times "
                f"its reach, {SMALLEST_GYRATION * shape.reach:g} to "
                f"{LARGEST_GYRATION * shape.reach:g} m, got {self.gyration:g}"
            )
        self._refuse_out_of_range(self.lever / shape.reach)

    def _refuse_out_of_range(self, height: float) -> None:
        if not (math.isfinite(height) and self.decel < math.inf) or (
            self.decel == 0.0 and self.friction > 0.0
        ):
            raise InputError(
                f"radius {self.radius:g} m, height {self.height:g} m, friction {self.friction:g} "
                f"and gravity {self.gravity:g} m/s^2 give delta = {height:g} and J = "
                f"{self.decel:g} m/s^2: out of the range of floating point"
            )

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
        decel : fg, m/s², > 0
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
        with unquestioned():  # a puck in units of its own may have any size
            return cls(
                radius=r, height=0.5 * height * r, friction=1.0, mass=mass,
                gravity=positive("decel", decel, "m/s^2"), pressure=pressure, gyration=gyration,
            )  # fmt: skip

    @property
    def delta(self) -> float:
        """Dimensionless height 2fh/r, of a round puck."""
        self.refuse_base("delta = 2 f h / r")
        return 2.0 * self.friction * self.height / self.radius

    @cached_property
    def shape(self) -> Base | None:
        """The base, of a puck that has one in place of a radius.

        >>> puck = PuckSpec(base="box:0.2x0.1", friction=0.3)
        >>> round(puck.shape.area, 6), round(puck.radius, 6), round(puck.gyration, 6)
        (0.02, 0.111803, 0.06455)
        """
        return base_of(self.base) if isinstance(self.base, str) and self.base else self.base or None

    @property
    def has_rim(self) -> bool:
        """Whether it has a round rim, which may meet walls and other pucks.

        >>> PuckSpec(base="box:0.2x0.1").has_rim, PuckSpec(0.15, base="box:0.2x0.1").has_rim
        (False, True)
        """
        return self.radius is not None and not isinstance(self.radius, Unsaid)

    @property
    def lever(self) -> float:
        """Friction times the height of the centre of mass, m."""
        return 0.5 * self.friction * self.height

    def refuse_lift(self) -> None:
        """Raise ContactError for a puck on a base of which friction would lift a part."""
        if self.shape is not None:
            try:
                self.shape.refuse_lift(self.friction, self.height)
            except ContactError as error:
                raise ContactError(f"{error}; a Scene moves it, one-sided") from None

    @property
    def packed_base(self) -> FloatArray:
        """What of it touches, in one array; ContactError if a part of it would lift."""
        self.refuse_lift()
        return packed(self.shape or Base.disc(self.radius), self.lever)

    @property
    def inertia_radius(self) -> float:
        """Radius of gyration about the vertical, m.

        >>> PuckSpec(0.04, gyration=0.5).inertia_radius
        0.02
        """
        return self.gyration if self.shape is not None else self.gyration * self.radius

    def refuse_base(self, what: str, instead: str = ROUND_ONLY) -> None:
        """Refuse what is of round pucks alone, by an InputError with what to do."""
        if self.shape is not None:
            raise InputError(f"{what} is {instead}")

    def refuse_for_round(self, **values: Any) -> None:
        """Raise InputError where an argument is given that a puck on a base has no use for."""
        for name, value in values.items():
            if value is not None and value is not False:
                self.refuse_base(name)

    @property
    def decel(self) -> float:
        """Deceleration of a slide without spin, fg, m/s²."""
        return self.friction * self.gravity

    @cached_property
    def body(self) -> UnitPuck:
        """Pressure law, δ and gyration: what the motion of a round puck depends on."""
        self.refuse_base("what is looked up")
        return body_of(self.pressure, self.delta, self.gyration)

    @property
    def limit_ratio(self) -> float:
        """The ratio rω/v that every motion with speed and spin tends to; 0 and inf included.

        >>> round(PuckSpec.similar(delta=0.0).limit_ratio, 6)
        1.531389
        """
        self.refuse_base("limit_ratio")
        return self.body.limit_ratio

    @property
    def limit_epsilon(self) -> float:
        """The limit ratio as ε = v/(rω), as several papers write it.

        >>> round(PuckSpec.similar(delta=0.0).limit_epsilon, 6)
        0.653002
        """
        ratio = self.limit_ratio
        return math.inf if ratio == 0.0 else 1.0 / ratio

    def refuse_unless_free(self) -> None:
        """Raise InputError where the stop is asked for of a puck that nothing brakes."""
        if self.friction == 0.0:
            raise InputError(
                "a puck with friction = 0 never stops: give friction > 0, or put it into a Scene"
            )

    def arguments(self) -> dict[str, Any]:
        """Keyword arguments of functions over arrays of pucks."""
        self.refuse_unless_free()
        return {
            "delta": self.delta, "decel": self.decel, "radius": self.radius,
            "pressure": self.pressure, "gyration": self.gyration,
        }  # fmt: skip

    def described(self) -> dict[str, Any]:
        """Its numbers by name, with δ and J, as results and files carry them."""
        numbers = {name: getattr(self, name) for name in ("radius", "height", "friction", "mass")}
        if self.shape is not None:
            del numbers["radius"]
            return {
                "base": self.shape.name, **numbers, "gravity": self.gravity, "decel": self.decel,
                "gyration": self.gyration,
            }  # fmt: skip
        law = self.body.law.name
        return {
            **numbers, "gravity": self.gravity, "delta": self.delta, "decel": self.decel,
            "pressure": law, "gyration": self.gyration,
        }  # fmt: skip

    @property
    def units(self) -> dict[str, str]:
        """Of what describes it.

        >>> PuckSpec(base="disc:0.1").units["gyration"], PuckSpec(0.1).units["gyration"]
        ('m', '1')
        """
        names = self.described()
        units = {name: unit for name, unit in PUCK_UNITS.items() if name in names}
        return units if self.shape is None else {**units, "gyration": "m"}


PUCK_UNITS = {
    "radius": "m", "height": "m", "friction": "1", "mass": "kg", "gravity": "m/s^2", "delta": "1",
    "decel": "m/s^2", "gyration": "1",
}  # fmt: skip
