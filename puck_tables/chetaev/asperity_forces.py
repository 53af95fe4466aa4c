"""Dry friction from asperities: horizontal force against speed, the speed held by a drive.

A drive keeps x′ = V on the support y ≥ −a cos(x/b).  Then λ of contact is −Y(1 + w cos θ) exactly,
θ = x/b, with w = (V/V₀)², V₀² = −Y b²/(m a): Chetaev's leading terms.  In units of Coulomb's force
−Y a/b everything depends on w alone.  In contact the support resists with (1 + w cos θ) sin θ.  For
w > 1 the point leaves at θ₀ = π − arccos(1/w), before each crest, flies the parabola and lands at
θ₁.  The drive's work over whole periods is what the landings lose, ½m(jump of y′)² each.

Where λ would be negative at θ₁ the point flies on at once.  As soon as it has slid it leaves at θ₀
again, so that one such round is the mean for all time.  In some windows of speed it never slides
again: it falls into a cycle of hops (once a period at sin θ = π/w, for instance, with the mean
force π/w), whose mean is taken instead; of 2000 hops if there is no cycle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, checked_progress, finite_array, instance, shown
from puck_tables._core.waiting import Progress
from puck_tables.chetaev.wavy_support import Asperity, landing, on_support
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.result import Result

CURVES = ("crude", "greatest", "undriven", "mean", "landing_phase", "flights_per_period")
_LANDINGS = 4000  # landings without a period: then the mean is that of the later half
_LONGEST_CYCLE, _SAME_PHASE = 40, 1e-11  # landings, rad: so far back the same phase is looked for
MOST_LEAPS = 5  # that are told as they are: more are no single steps of the force
LEAP = 0.2  # of Coulomb's force: by so much the mean force at neighbouring speeds may differ
MAX_SPEED = 1e3  # of V₀: beyond it a flight passes a million periods and its landing is chance


class HopCycle(NamedTuple):
    """What happens between two departures at θ₀ when the speed is held, in dimensionless terms."""

    landing: float  # phase from which it slides; −π if it never flies, NaN if it never slides again
    flights: int
    periods: int
    mean: float  # force over −Y a/b


@dataclass(frozen=True, eq=False, repr=False)
class AsperityCurve(Result):
    """Horizontal force of the support against the speed; forces in N, resisting positive.

    Attributes
    ----------
    asperity : Asperity
    held_speed, landing_phase, flights_per_period : arrays (k,)
        In m/s; phase x/b ∈ (−π, π] of the landing after which it slides, NaN where there is none.
    crude, greatest, undriven, mean : arrays (k,), N
        Coulomb's force −Y a/b.  The greatest in contact by the leading terms of λ, which are exact
        where the speed is held, blows of landings left out; 0 where it only hops.  The greatest by
        the exact λ of a point that has the speed and is not driven: less by 1 + κ² sin² θ.  The
        mean over all time of the drive's force, landings included.
    """

    asperity: Asperity
    held_speed: FloatArray
    crude: FloatArray = field(repr=False)
    greatest: FloatArray = field(repr=False)
    undriven: FloatArray = field(repr=False)
    mean: FloatArray = field(repr=False)
    landing_phase: FloatArray = field(repr=False)
    flights_per_period: FloatArray = field(repr=False)

    picture: ClassVar[str] = "asperity"

    def __repr__(self) -> str:
        return (
            f"AsperityCurve({self.held_speed.size} speeds, V0 = {self.asperity.lift_speed:.4g} m/s)"
        )

    def __str__(self) -> str:
        """Slope, Coulomb's force and lift speed, and whether the speeds are too far apart."""
        support = self.asperity
        text = (
            f"a/b = {support.slope:.4g}, Coulomb's force {self.crude[0]:.4g} N; leaves the crest "
            f"above V0 = {support.lift_speed:.4g} m/s"
        )
        if self.leaps > MOST_LEAPS:
            text += (
                f"\nbetween {self.leaps} of {self.held_speed.size - 1} neighbouring speeds the "
                "force leaps: it varies faster than they show; give more speeds, or lower ones"
            )
        return text

    def explain(self) -> str:
        """How it was got."""
        return "leading terms of the force, and every landing: Chetaev 1960, section 5"

    def dataset(self) -> Dataset:
        """Forces over the speed; the support as attributes."""
        dims, support = ("held_speed",), self.asperity
        columns = {name: variable(name, getattr(self, name), dims) for name in CURVES}
        return Dataset({"held_speed": variable("held_speed", self.held_speed, dims)}, columns, {
            "title": "Friction of a point on a wavy one-sided support", "load": support.load,
            "amplitude": support.amplitude, "length": support.length, "mass": support.mass,
            "lift_speed": support.lift_speed,
        })  # fmt: skip

    @property
    def leaps(self) -> int:
        """Between how many neighbouring speeds the mean force leaps: what it does there is lost.

        >>> bumps = Asperity(amplitude=1.0, length=4.0, load=1.0, mass=1.0)
        >>> asperity_curve(bumps, [0.0, 5.0, 10.0]).leaps
        2
        """
        return int((np.abs(np.diff(self.mean)) > LEAP * self.crude[1:]).sum())

    def law(self, which: str = "greatest") -> SpeedLaw:
        """The force over the load as a friction coefficient that depends on the speed.

        ``which``: 'crude', 'greatest', 'undriven' or 'mean', else InputError; as where the speeds
        do not begin at 0.

        >>> bumps = Asperity(amplitude=1e-6, length=4e-6, load=1.0, mass=0.1)
        >>> law = asperity_curve(bumps, np.linspace(0.0, 0.02, 9)).law()
        >>> float(law(0.0))  # a/b
        0.25
        """
        if which not in CURVES[:4]:
            raise InputError(f"which must be crude, greatest, undriven or mean, got {shown(which)}")
        return SpeedLaw(self.held_speed, getattr(self, which) / self.asperity.load)


def asperity_curve(
    asperity: Asperity, speed: npt.ArrayLike, progress: Progress | None = None
) -> AsperityCurve:
    """Horizontal force of a wavy one-sided support on a point: Chetaev 1960, section 5.

    Parameters
    ----------
    asperity : Asperity
        Not pulled, else InputError: the drive does that.
    speed : array_like (k,), m/s, ascending
        From 0 to 1000 V₀, else InputError.
    progress : callable (done, total), optional

    Examples
    --------
    >>> bumps = Asperity(amplitude=1.0, length=4.0, load=1.0, mass=1.0)  # a/b = 1/4, V₀ = 4 m/s
    >>> curve = asperity_curve(bumps, [0.0, 4.0, 6.0, 12.0])
    >>> curve.greatest.round(6).tolist(), curve.mean.round(6).tolist()
    ([0.25, 0.32476, 0.470022, 1.004852], [0.0, 0.0, 0.190728, 0.232894])
    """
    instance("asperity", asperity, Asperity)
    checked_progress(progress)
    V = finite_array("speed", speed, "m/s")
    if asperity.pull != 0.0:
        raise InputError("pull must be 0 where a drive holds the speed: its force is what is asked")
    if V.ndim != 1 or V.size == 0 or not (np.diff(V) > 0.0).all():
        raise InputError("speed must be one or more numbers in m/s, ascending")
    highest = MAX_SPEED * asperity.lift_speed
    if V[0] < 0.0 or V[-1] > highest:
        raise InputError(
            f"speed must be from 0 to {highest:g} m/s ({MAX_SPEED:g} times the speed at which the "
            f"crest is left), got {V[0] if V[0] < 0.0 else V[-1]:g}"
        )
    rows = []
    for w in ((V / asperity.lift_speed) ** 2).tolist():
        run = held_round(w)
        greatest = [greatest_force(w, run.landing, kappa) for kappa in (0.0, asperity.slope)]
        landed = run.landing if run.flights else math.nan
        rows.append([1.0, *greatest, run.mean, landed, run.flights / run.periods])
        if progress is not None:
            progress(len(rows), V.size)
    columns = np.array(rows).T
    return AsperityCurve(asperity, V, *(asperity.load * asperity.slope * columns[:4]), *columns[4:])


def greatest_force(w: float, first: float, slope: float = 0.0) -> float:
    """Largest (1 + w cos θ) sin θ/(1 + κ² sin² θ) in contact, from ``first`` to the departure.

    With ``slope`` κ = 0 that of the held speed; 0 without contact, where ``first`` is NaN.  Its
    places solve an equation of degree 4 in cos θ.

    >>> greatest_force(0.0, -np.pi), round(greatest_force(1.0, -np.pi), 12)  # 3√3/4
    (1.0, 1.299038105677)
    """
    if math.isnan(first):
        return 0.0
    squared = slope * slope
    # (c + w(2c² − 1))(1 + κ²(1 − c²)) − 2κ² c (1 − c²)(1 + wc)
    turning = np.polysub(
        np.polymul([2.0 * w, 1.0, -w], [-squared, 0.0, 1.0 + squared]),
        np.polymul([-2.0 * squared, 0.0, 2.0 * squared, 0.0], [w, 1.0]),
    )
    roots = np.roots(turning)
    cosine = roots[np.abs(roots.imag) < 1e-9].real
    last = math.pi if w <= 1.0 else math.pi - math.acos(1.0 / w)
    places = np.arccos(cosine[np.abs(cosine) <= 1.0])
    places = np.append(places[(places >= first) & (places <= last)], first)
    force = (1.0 + w * np.cos(places)) * np.sin(places) / (1.0 + squared * np.sin(places) ** 2)
    return float(force.max())


def held_round(w: float) -> HopCycle:
    """Flights and landings at a held speed, w = (V/V₀)², from a departure at θ₀ on.

    >>> run = held_round(2.25)
    >>> round(run.landing, 6), run.periods, round(run.mean, 6)
    (0.797713, 1, 0.762913)
    >>> hopping = held_round(3.61)  # hops once a period at sin θ = π/w: the mean is π/w
    >>> hopping.landing, round(hopping.mean * 3.61, 9)
    (nan, 3.141592654)
    """
    if w <= 1.0:
        return HopCycle(-math.pi, 0, 1, 0.0)
    # a, b, V = 1, so that time is phase: the load is then 1/w
    unit, start = Asperity(1.0, 1.0, 1.0 / w, 1.0), math.pi - math.acos(1.0 / w)
    phases, lengths, jumps = [start], list[float](), list[float]()
    landed, counted = math.nan, _LANDINGS // 2
    while len(jumps) < _LANDINGS:
        arc = on_support(unit, 0.0, phases[-1], 1.0, leaves=True)
        lengths.append(landing(unit, arc, math.inf))
        late = phases[-1] + lengths[-1]
        jumps.append((math.sin(late) - (arc.vy - lengths[-1] / w)) ** 2)
        phases.append(math.remainder(late, 2.0 * math.pi))
        if 1.0 + w * math.cos(phases[-1]) >= 0.0 and abs(phases[-1]) <= start:
            landed, counted = phases[-1], len(jumps)
            lengths.append(start - landed)
            break
        before = np.array(phases[-2 : -_LONGEST_CYCLE - 2 : -1])
        alike = np.abs(before - phases[-1]) < _SAME_PHASE
        if alike.any():
            counted = int(alike.argmax()) + 1
            break
    turned = math.fsum(lengths[-counted if math.isnan(landed) else 0 :])
    periods = max(round(turned / (2.0 * math.pi)), 1)
    mean = w * math.fsum(jumps[-counted:]) / (4.0 * math.pi * periods)
    return HopCycle(landed, counted, periods, mean)
