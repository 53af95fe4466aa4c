"""What a fit may find of a puck, what it takes as known, and what of that moves the puck.

Tracks tell J = f g and δ = 2 f h/r.  Friction, gravity and height stand in these two only, so one
of the three has to be known; any of them may be free, with a prior, or fixed, and what the tracks
cannot tell then is said (:mod:`puck_tables.fitting.certainty`).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from puck_tables.contact.base import Base
from puck_tables.contact.laws import law_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.fitting.forward_model import Moving, Rims
from puck_tables.fitting.parameters import (
    DRAGS,
    INTEGRATED,
    LARGEST,
    LAW_NUMBERS,
    MARK,
    MOST,
    NODES,
    NOTHING,
    OF_IMPACTS,
    OF_PAIRS,
    OF_WALLS,
    OWN_MOTION,
    POSITIVE,
    PUCK,
    SMALLEST,
    TALLEST,
    WALL,
    Parameter,
    parameters_of,
)
from puck_tables.fitting.speed_motion import LAWS, Drags, SpeedFriction, law_named
from puck_tables.fitting.unit_motions import UnitMotions, unit_motions_of
from puck_tables.puck import Puck

_KIND = (*OWN_MOTION, "drag", *INTEGRATED)  # change the curve itself
TINY = 1e-30  # step of derivatives along the imaginary axis
_FARTHEST = 10.0  # radii, of what is tracked from the centre: a stick on the body may be longer
_LEAST = 1e-9  # in its unit, of what must be more than 0


@dataclass(frozen=True)
class FitSpec:
    """What is to be found and what is known.

    Parameters
    ----------
    puck : Puck
        Its numbers count where nothing else is said of them.
    free : names to be found, of :data:`PUCK`
    fixed : values by name, of :data:`PUCK` or :data:`LAUNCH`
    priors : (value, standard deviation) by name
    bounds : (low, high) by name
    start : values to begin with, besides those that the tracks suggest
    freed : names that are found since they have a prior or bounds
    of_impacts : what is taken of the impacts that there are, by name, where nothing else is said

    speeds : slip speeds (m/s) at which friction coefficients are found, friction_0 and so on
    between : cubic or linear, f between these speeds
    law : a law over slip speed by its name, '' for none
    base : of a puck that is not round; its reach is then the radius of ``puck``, gyration is in m

    Raises
    ------
    InputError
        If the friction is neither free nor known.

    Examples
    --------
    >>> spec = FitSpec(Puck(radius=0.0381), ("friction", "delta"), {}, {}, {}, {})
    >>> spec.scales({"friction": 0.2, "delta": 0.5})[0]
    1.96133
    """

    puck: Puck
    free: tuple[str, ...]
    fixed: Mapping[str, float]
    priors: Mapping[str, tuple[float, float]]
    bounds: Mapping[str, tuple[float, float]]
    start: Mapping[str, float]
    freed: tuple[str, ...] = ()
    of_impacts: Mapping[str, float] = field(default_factory=dict)
    speeds: tuple[float, ...] = ()
    between: str = "cubic"
    law: str = ""
    base: Base | None = None

    def __post_init__(self) -> None:
        scale = {"friction", "decel"} & {*self.free, *self.fixed}
        if not scale and not self.speeds and self.puck.friction == 0.0:
            raise InputError(
                "the friction is neither free nor known: name friction in free, or give the puck "
                "its friction"
            )

    @cached_property
    def parameters(self) -> Mapping[str, Parameter]:
        """The parameters of such a puck and its launch."""
        return parameters_of(None if self.base is None else self.base.reach)

    @property
    def _unit(self) -> float:
        """The unit of a radius of gyration: the radius, but m on a base."""
        return 1.0 if self.base is None else self.base.reach

    @property
    def uses_delta(self) -> bool:
        """Whether δ is given itself, not by height."""
        return "delta" in self.free or "delta" in self.fixed

    def known(self) -> dict[str, float]:
        """All numbers of the puck that are not found."""
        puck = self.puck
        names = ("radius", "height", "friction", "gravity", "gyration")
        numbers = {name: float(getattr(puck, name)) for name in names}
        numbers["gyration"] *= self._unit
        numbers.update(dict.fromkeys(NOTHING, 0.0))
        if is_annulus(puck):
            numbers["inner"] = float(puck.body.law.name.partition(":")[2])
        return {**numbers, **self.of_impacts, **{n: v for n, v in self.fixed.items() if n in PUCK}}

    def scales(self, result: Mapping[str, Any]) -> tuple[Any, Any, Any]:
        """J, δ and r of what is found; of complex numbers, too."""
        all_of = {**self.known(), **result}
        if self.speeds or self.law:  # that of a puck about to stop
            all_of["friction"] = all_of[NODES[0] if self.speeds else LAW_NUMBERS[0]]
        decel = (
            all_of["decel"]
            if "decel" in {*self.free, *self.fixed}
            else all_of["friction"] * all_of["gravity"]
        )
        if self.uses_delta:
            return decel, all_of["delta"], all_of["radius"]
        friction = decel / all_of["gravity"]
        return decel, 2.0 * friction * all_of["height"] / all_of["radius"], all_of["radius"]

    def all_at(self, result: Mapping[str, Any]) -> dict[str, Any]:
        """All numbers of the puck where some are found, real or complex; J, δ, f and h follow."""
        numbers = {**self.known(), **result}
        decel, delta, radius = self.scales(result)
        friction = decel / numbers["gravity"]
        height = 0.5 * delta * radius / friction if friction != 0.0 else 0.0
        follows = {"decel": decel, "delta": delta, "friction": friction, "height": height}
        return {**numbers, **follows}

    def slopes(self, result: Mapping[str, float], name: str) -> tuple[float, float, float]:
        """The derivatives of J, δ and r to one that is found, by the complex step."""
        complex_values = {**result, name: result[name] + 1j * TINY}
        decel, delta, radius = ((one + 0j).imag / TINY for one in self.scales(complex_values))
        return decel, delta, radius

    def alone(self) -> FitSpec:
        """What is asked without numbers of impacts: of slides that nothing joins."""
        own = tuple(name for name in self.free if name not in OF_IMPACTS)
        priors = {name: one for name, one in self.priors.items() if name not in OF_IMPACTS}
        return replace(self, free=own, priors=priors, of_impacts={})

    def spinning(self, spin: float) -> FitSpec:
        """What is asked with the launch spin (rad/s) held."""
        priors, bounds, start = {**self.priors}, {**self.bounds}, {**self.start}
        for numbers in (priors, bounds, start):
            numbers.pop("launch_spin", None)
        fixed = {**self.fixed, "launch_spin": spin}
        return replace(self, fixed=fixed, priors=priors, bounds=bounds, start=start)

    def coupled(self, sizes: Collection[int], grips: bool) -> FitSpec:
        """What is asked with the numbers of the impacts that there are.

        ``sizes``: how many pucks meet, 1 those with walls; ``grips``: whether rims stop on what
        they meet in all of them, so that nothing tells their friction.
        """
        free, of_impacts = list(self.alone().free), dict[str, float]()
        named = [name for name in self.free if name in OF_IMPACTS]
        for size, numbers, what in ((1, OF_WALLS, "a wall"), (2, OF_PAIRS, "two pucks")):
            if size not in sizes:
                for name in (*named, *self.fixed, *self.priors, *self.bounds, *self.start):
                    if name in numbers:
                        raise InputError(f"there is no impact of {what} that {name} could be of")
                continue
            restitution, friction, tangential, *_ = numbers
            rub = tangential if grips and friction not in named else friction
            mine = [name for name in numbers if name in (restitution, rub, *named)]
            free += [name for name in mine if name not in self.fixed]
            of_impacts |= {n: v for n, v in numbers.items() if n not in mine and math.isfinite(v)}
        return replace(self, free=tuple(free), of_impacts=of_impacts)

    def rims(self, result: Mapping[str, float], pair: bool) -> Rims:
        """How rims meet, of two pucks or of one and a wall."""
        defaults = OF_PAIRS if pair else OF_WALLS
        numbers = {**defaults, **self.fixed, **result}
        return Rims(*(numbers[name] for name in defaults), *([] if pair else [math.inf]))

    def mark(self, result: Mapping[str, float]) -> tuple[float, float]:
        """Where what is tracked lies off the centre of mass, along the axes of the body, m."""
        values = {**dict.fromkeys(MARK, 0.0), **self.fixed, **result}
        return values["mark_x"], values["mark_y"]

    def readout(self, result: Mapping[str, float]) -> float:
        """The time in which a picture is read, s."""
        return {**self.fixed, **result}.get("readout", 0.0)

    def changes_motion(self, name: str) -> bool:
        """Whether a parameter is none of the scales."""
        scale = bool(self.integrated) and name in ("friction", "decel", "gravity")
        return name in _KIND or name in NODES or scale

    @property
    def integrated(self) -> tuple[str, ...]:
        """What is found, or known, with which no look-up has the motions."""
        return tuple(name for name in INTEGRATED if name in (*self.free, *self.fixed))

    def with_law(self, law: str) -> FitSpec:
        """What is asked with a law over slip speed by its name, whose numbers are found too."""
        if law not in LAWS:
            raise InputError(f"law must be one of {', '.join(LAWS)}, got {law!r:.40}")
        if "friction" not in self.free:
            raise InputError("a law over slip speed is found: do not give the friction")
        more = tuple(n for n in LAW_NUMBERS if n not in self.free and n not in self.fixed)
        return replace(self, law=law, free=(*self.free, *more))

    def refuse_integrated(self) -> None:
        """Refuse what does not go with motions that are integrated."""
        named = self.integrated
        self._refuse_pressure(f"{' and '.join(named)} are")
        if not self.law and any(name in LAW_NUMBERS for name in named):
            raise InputError(
                f"{' and '.join(LAW_NUMBERS)} are numbers of a law over slip speed: name it "
                f"(--law, law=): {', '.join(LAWS)}"
            )

    def _refuse_pressure(self, what: str) -> None:
        """Refuse pressure, or a base, under which no such motion is integrated."""
        if self.base is not None:
            raise InputError(f"{what} found of round pucks alone, not of base {self.base.name}")
        if self.puck.body.law.name != "uniform" or "inner" in (*self.free, *self.fixed):
            raise InputError(
                f"{what} found of uniform pressure alone, not of {self.puck.body.law.name}"
            )

    def plain(self) -> FitSpec:
        """What is asked without what is integrated: to begin from."""
        free = tuple(name for name in self.free if name not in INTEGRATED)
        fixed = {name: value for name, value in self.fixed.items() if name not in INTEGRATED}
        return replace(self, free=free, fixed=fixed, law="")

    def moving(self, result: Mapping[str, float], tall: bool) -> Moving:
        """What moves the puck."""
        decel, delta, radius = self.scales(result)
        numbers = {**self.known(), **result}
        pressure: Any = self.puck.body.law
        if "inner" in result or "inner" in self.fixed:
            pressure = f"annulus:{numbers['inner']!r}"
        motions = self._motions(pressure, numbers["gyration"], tall)
        by_speed = None
        if self.speeds or self.integrated:
            g = numbers["gravity"]
            law = self.speed_law(numbers) if self.speeds or self.law else float(decel / g)
            drags = Drags(numbers["drag"], *(numbers[name] for name in DRAGS))
            push = g * numbers["slope_x"], g * numbers["slope_y"]
            belt = numbers["belt_x"], numbers["belt_y"]
            by_speed = SpeedFriction(law, g, numbers["gyration"], drags, push, belt)
        # while a minimum is sought J, r and h may lead beyond; where it lies is judged in the end
        delta = min(delta, motions.highest)
        return Moving(decel, delta, radius, numbers["drag"], motions, by_speed)

    def speed_law(self, numbers: Mapping[str, float]) -> SpeedLaw:
        """The friction coefficient over slip speed."""
        if self.law:
            return law_named(self.law, *(numbers[n] for n in ("friction", *LAW_NUMBERS)))
        values = [numbers[name] for name in NODES[: len(self.speeds)]]
        return SpeedLaw(list(self.speeds), values, self.between)

    def over(self, speeds: tuple[float, ...], between: str) -> FitSpec:
        """What is asked with a friction coefficient for each of these slip speeds."""
        for name in ("decel", "gravity", "drag", *INTEGRATED, "inner"):
            if name in self.free or name in self.fixed:
                raise InputError(
                    f"{name} cannot be found or fixed beside a friction over slip speed: leave it "
                    "out"
                )
        if "friction" not in self.free:
            raise InputError("a friction over slip speed is found: do not give the friction")
        self._refuse_pressure("a friction over slip speed is")
        nodes = NODES[: len(speeds)]
        free = (*nodes, *(name for name in self.free if name != "friction"))
        bounds, priors = (
            {**of, **(dict.fromkeys(nodes, of["friction"]) if "friction" in of else {})}
            for of in (self.bounds, self.priors)
        )
        return replace(
            self, free=free, bounds=bounds, priors=priors, speeds=speeds, between=between
        )

    def highest(self, tall: bool) -> float:
        """The largest δ of which motions are known, of an annulus that is free as of the puck's."""
        pressure: Any = self.puck.body.law
        if "inner" in self.fixed:
            pressure = law_of(f"annulus:{self.fixed['inner']!r}")
        return self._motions(pressure, self.known()["gyration"], tall).highest

    def _motions(self, pressure: Any, gyration: float, tall: bool) -> UnitMotions:
        lifts = tall and not self.integrated
        return unit_motions_of(self.base or pressure, gyration / self._unit, lifts)

    def steepest(self, name: str) -> float:
        """The largest friction, or J, of a puck of known height and radius: 2fh/r is its δ."""
        known = self.known()
        if self.uses_delta or {"height", "radius", "gravity"} & {*self.free} or not known["height"]:
            return math.inf
        friction = 0.5 * self.highest(True) * known["radius"] / known["height"]
        return friction if name == "friction" else friction * known["gravity"]

    def limits(self, name: str) -> tuple[float, float]:
        """The range in which a parameter is looked for."""
        low, high = (self.parameters.get(name) or WALL[name])[1:3]
        if name == "inner":
            low, high = 1e-3, 0.999
        elif name == "radius":
            low, high = SMALLEST, LARGEST
        elif name in MARK:
            high = _FARTHEST * self.known()["radius"]
            low = -high
        elif name == "height":
            high = TALLEST * self.known()["radius"]
        elif name in POSITIVE or name in NODES:
            low = _LEAST
        high = min(high, MOST.get(name, high))
        wanted = self.bounds.get(name, (low, high))
        return max(low, wanted[0]), min(high, wanted[1])

    def plausible(self, name: str) -> float:
        """Within about how much one would think the value to lie without the tracks."""
        if name in ("height", "radius", *MARK):
            return self.puck.radius
        return self.parameters[name].plausible


def is_annulus(puck: Puck) -> bool:
    """Whether it presses on a ring of some width."""
    return puck.body.law.name.startswith("annulus:")
