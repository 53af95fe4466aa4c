"""What the motion of a puck depends on besides its scale: its law, height and spread of mass."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from puck_tables._core.arrays import instance, real
from puck_tables.contact.closed_form import checked_delta
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of, limit_ratio
from puck_tables.errors import InputError
from puck_tables.table.friction_section import FrictionSection, friction_for, section_of_table
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.singular_lines import refuse_height

STANDARD_GRAVITY = 9.80665  # m/s², by the third General Conference on Weights and Measures, 1901
# k/r: beyond, motions have stops too steep for splines and steps
SMALLEST_GYRATION, LARGEST_GYRATION = 0.1, 10.0
_FULL_CONTACT = 1.0  # δ up to which a plain puck lies on its whole base in every motion


def plain_up_to(pressure: str | Law, gyration: float) -> float:
    """The height up to which closed forms and the shipped tables hold for a kind of puck.

    Returns float: 1 for a homogeneous puck under uniform pressure, −inf for any other.

    >>> plain_up_to("uniform", HOMOGENEOUS), plain_up_to("ring", HOMOGENEOUS)
    (1.0, -inf)
    """
    if not isinstance(pressure, str):
        instance("pressure", pressure, Law)
    radius = gyration if type(gyration) is float else checked_gyration(gyration)
    uniform = pressure == "uniform" or (isinstance(pressure, Law) and pressure.can_lift)
    return _FULL_CONTACT if uniform and radius == HOMOGENEOUS else -math.inf


def checked_gyration(gyration: float) -> float:
    """A radius of gyration in units of r.

    >>> checked_gyration(1)
    1.0
    """
    radius = real("gyration", gyration, "k/r")
    if not SMALLEST_GYRATION <= radius <= LARGEST_GYRATION:
        raise InputError(
            f"gyration must be the radius of gyration in units of r, from {SMALLEST_GYRATION:g} to "
            f"{LARGEST_GYRATION:g} (homogeneous: 0.7071, a ring: 1), got {radius:g}"
        )
    return radius


def is_plain(pressure: str | Law, gyration: float, delta: float) -> bool:
    """Whether closed forms and the shipped tables hold for a puck of this height.

    >>> is_plain("uniform", HOMOGENEOUS, 0.5), is_plain("ring", HOMOGENEOUS, 0.5)
    (True, False)
    """
    return not delta > plain_up_to(pressure, gyration)


@dataclass(frozen=True)
class UnitPuck:
    """What the motion of a puck depends on besides its scale.

    ``law``: Law, the pressure law; ``delta``: dimensionless height 2fh/r; ``gyration``: radius of
    gyration about the vertical axis in units of r; ``table``: of its friction, where one was given;
    else friction comes from the law itself.

    >>> round(body_of("ring", 0.0, 1.0).limit_ratio, 9)
    1.0
    """

    law: Law
    delta: float
    gyration: float
    table: ResultantTable | None = None

    @property
    def is_plain(self) -> bool:
        """Whether closed forms and the shipped tables hold for it."""
        return is_plain(self.law, self.gyration, self.delta)

    @property
    def has_closed_forms(self) -> bool:
        """Whether it is homogeneous and under uniform pressure, of whatever height."""
        return plain_up_to(self.law, self.gyration) > 0.0

    @property
    def kind(self) -> str:
        """Pressure and gyration in words; empty for a homogeneous puck under uniform pressure.

        >>> body_of("ring", 0.0, 1.0).kind
        'pressure ring, k/r = 1'
        """
        if self.has_closed_forms:
            return ""
        return f"pressure {self.law.name}, k/r = {self.gyration:.6g}"

    @cached_property
    def limit_ratio(self) -> float:
        """The ratio rω/v that its motions tend to, 0 and inf included."""
        return limit_ratio(self.law, self.delta, self.gyration)

    @property
    def limit(self) -> float:
        """Ln of :attr:`limit_ratio`."""
        ratio = self.limit_ratio
        return math.log(ratio) if ratio > 0.0 else -math.inf

    @property
    def inertia(self) -> float:
        """k²/r², exactly ½ for a homogeneous puck."""
        return 0.5 if self.gyration == HOMOGENEOUS else self.gyration**2

    @property
    def longest(self) -> float:
        """More than any motion lasts, in units of Q/J, and than it moves, in units of Q²/J."""
        return 2.0 if self.is_plain else max(4.0, 4.0 * self.inertia)

    @property
    def spin_time(self) -> float:
        """How long pure spin lasts, in units of r|ω|/J: 2k²/(r² ρ_ω(π/2))."""
        if self.is_plain:
            return 0.75
        return 2.0 * self.inertia / float(self.law.friction(0.5 * math.pi, 0.0).spin)

    def with_table(self, table: ResultantTable | None) -> UnitPuck:
        """The puck with friction from a table of its pressure law that reaches its height."""
        if table is None:
            return self
        table.checked_range(self.delta, self.law)
        return replace(self, table=table)

    def friction(self, accuracy: float) -> FrictionSection:
        """Its friction over the slip angle."""
        if self.table is not None:
            return section_of_table(self.table, self.delta, accuracy)
        return friction_for(self.law, self.delta, accuracy)


def body_of(pressure: str | Law, delta: float, gyration: float) -> UnitPuck:
    """A puck, checked.

    Raises InputError if the pressure law is not known or a number is out of range; ContactError if
    the puck tips, or its contact is not known or not determined.

    >>> body_of("hertz", 0.5, 0.6).law.name
    'hertz'
    """
    instance("pressure", pressure, str, Law)
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    radius = checked_gyration(gyration)
    height = float(checked_delta(real("delta", delta, "units of 2 f h / r")))
    refuse_height(law, height)
    return UnitPuck(law, height, radius)
