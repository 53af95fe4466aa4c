"""A round load on the floor, as friction over the slip speed is summed under it.

It is a pile of uniform discs, or of thin circles.  A disc or circle of radius a slides like one of
radius r whose rim slips at a ω: with Q' = hypot(v, a ω) its share is

    p_a: p_a' Q/Q',    p_b, p_d, p_e: (a/r)² p_b' Q/Q' … ,

the p' at the slip of its own rim.  An annulus is its disc less that of its hole.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray, real
from puck_tables.contact.base import Base
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.laws import THINNEST, Law, law_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError

# how a load is spread over circles: on one, by a profile, or (n + 1) cosⁿθ sin θ dθ, ρ = sin θ
ALONE, PROFILE = -2.0, -1.0
_POWERS = {"ring": ALONE, "galin": 0.0, "hertz": 2.0}
_LEAST_REACH = 1e-3  # of the radius
_THIN = 0.999  # of the radius is the hole: from here on discs cancel, circles do not


@dataclass(frozen=True)
class RoundLoad:
    """A pressure law on the inner part of a radius.

    ``law``: uniform, galin, hertz, ring, annulus or a profile; ``reach``: where the load ends, in
    units of the radius at whose rim slips are reckoned, up to 1.  Raises InputError if the law is
    given by a function of the slip angle.

    >>> RoundLoad(law_of("annulus:0.8"), 0.5).edges
    (0.4, 0.5)
    """

    law: Law
    reach: float = 1.0

    def __post_init__(self) -> None:
        kind = self.law.name.partition(":")[0]
        by_name = kind in _POWERS or kind in ("uniform", "annulus")
        if self.law.profile is None and not (by_name and law_of(self.law.name) == self.law):
            raise InputError(
                f"the pressure law {self.law.name} is given by a function, which holds for a "
                "constant friction only: under a friction law give it as a profile (profile_law)"
            )

    @property
    def edges(self) -> tuple[float, ...]:
        """Where it begins, ends or jumps, ascending, in units of the radius."""
        return tuple(self.reach * edge for edge in self.law.edges)

    @property
    def is_simple(self) -> bool:
        """Whether it is singular at the rim alone."""
        return self.edges == (1.0,)

    @property
    def mean_square(self) -> float:
        """⟨x²⟩ over it, in units of the radius squared."""
        return self.reach**2 * self.law.mean_square

    @property
    def discs(self) -> FloatArray:
        """Radii and shares of its discs (n, 2), none where circles take their place."""
        kind, _, inner = self.law.name.partition(":")
        if self.law.profile is None and kind == "uniform":
            return np.array([[self.reach, 1.0]])
        if self.law.profile is None and kind == "annulus" and (a := float(inner)) < _THIN:
            outside = 1.0 / ((1.0 - a) * (1.0 + a))
            return np.array([[self.reach, outside], [a * self.reach, -a * a * outside]])
        return np.empty((0, 2))

    @property
    def is_integrated(self) -> bool:
        """Whether it is spread over circles of all radii."""
        return not len(self.discs) and self.circles[0] != ALONE

    @property
    def growth(self) -> float:
        """How much larger than the error under each of its discs that of their sum may be."""
        return float(np.abs(self.discs[:, 1]).sum())

    @property
    def circles(self) -> tuple[float, FloatArray]:
        """How its load is spread over circles, and the parts of a profile (n, 4).

        A part is the radii of its ends, in units of its own, and twice the pressure there over the
        mean.
        """
        kind, _, inner = self.law.name.partition(":")
        if self.law.profile is None and kind in _POWERS:
            return _POWERS[kind], np.array([[0.0, 0.5 * np.pi, 0.0, 0.0]])
        radii, weight = self.law.profile or (np.array([float(inner), 1.0]), np.ones(2))
        low, high, first, last = radii[:-1], radii[1:], weight[:-1], weight[1:]
        whole = (high - low) * (first * (2.0 * low + high) + last * (low + 2.0 * high)) / 3.0
        unit = 2.0 / whole.sum()
        parts = np.stack([low, high, unit * first, unit * last], axis=1)
        return PROFILE, parts[(first > 0.0) | (last > 0.0)]


def load_of(base: Base, radius: float) -> RoundLoad | None:
    """The load of a base about its middle, a disc or an annulus; None of any other.

    ``radius``: that of the rim, m.

    >>> load = load_of(Base.annulus(0.08, 0.04), 0.1)
    >>> load.law.name, round(load.reach, 12)
    ('annulus:0.5', 0.8)
    >>> load_of(Base.box(0.2, 0.1), 0.2) is None
    True
    """
    discs = sorted(base.discs, key=lambda disc: -disc[2])
    if base.outlines or len(discs) > 2 or any(disc[:2] != base.middle for disc in discs):
        return None
    if len(discs) == 1:
        return RoundLoad(law_of("uniform"), discs[0][2] / radius)
    inner = discs[1][2] / discs[0][2]
    if discs[1][3] > 0.0 or inner > THINNEST:
        return None
    return RoundLoad(law_of(f"annulus:{inner!r}"), discs[0][2] / radius)


def load_of_law(pressure: str | Law, reach: float, friction: object) -> RoundLoad:
    """The load of a pressure law on a part of the radius, as a friction law is tabulated under it.

    Raises InputError if it is none, or friction under it is not known.

    >>> load_of_law("annulus:0.5", 1.0, SpeedLaw([0.0, 1.0], [0.2, 0.3])).edges
    (0.5, 1.0)
    """
    part = real("reach", reach, "a share of the radius")
    if not _LEAST_REACH <= part <= 1.0:
        raise InputError(
            f"reach must be from {_LEAST_REACH:g} to 1 (of the radius to the rim), got {part:g}"
        )
    load = RoundLoad(pressure if isinstance(pressure, Law) else law_of(pressure), part)
    if not isinstance(friction, SpeedLaw | FrictionLaw) and not len(load.discs):
        raise InputError(
            f"under the pressure law {load.law.name} a friction law must be one of points "
            "(SpeedLaw) or by name, not a function"
        )
    return load
