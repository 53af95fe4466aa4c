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
from typing import Any, NamedTuple

from puck_tables.contact.base import Base
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.fitting.forward_model import Moving, Rims
from puck_tables.fitting.speed_motion import SpeedFriction, law_named
from puck_tables.fitting.unit_motions import UnitMotions, unit_motions_of
from puck_tables.motion.body import LARGEST_GYRATION, SMALLEST_GYRATION
from puck_tables.puck import Puck


class Parameter(NamedTuple):
    """Unit, the allowed range, what values are plausible within, and what it is."""

    unit: str
    low: float
    high: float
    plausible: float
    words: str


MOST_NODES = 8  # slip speeds of a law over speed: each is one more number to find
NODES = tuple(f"friction_{k}" for k in range(MOST_NODES))  # f at slip speeds that are given
_AT_SPEED = Parameter("1", 0.0, math.inf, 1.0, "friction coefficient at a slip speed")
PUCK = {
    "friction": Parameter("1", 0.0, math.inf, 1.0, "Coulomb's coefficient f"),
    "decel": Parameter("m/s^2", 0.0, math.inf, 10.0, "deceleration of a slide, f g"),
    "delta": Parameter("1", 0.0, 4.0, 1.0, "dimensionless height 2 f h / r"),
    "height": Parameter("m", 0.0, math.inf, 0.0, "height of the puck"),
    "radius": Parameter("m", 0.0, math.inf, 0.0, "radius of the base"),
    "gravity": Parameter("m/s^2", 0.0, math.inf, 10.0, "gravity"),
    "gyration": Parameter(
        "1", SMALLEST_GYRATION, LARGEST_GYRATION, 0.5, "radius of gyration over r"
    ),
    "inner": Parameter("1", 0.0, 1.0, 0.5, "inner radius of an annulus over r"),
    "drag": Parameter("1/s", -math.inf, math.inf, 1.0, "linear drag, of speed and of spin"),
    "air": Parameter("1/m", 0.0, math.inf, 1.0, "drag of the speed squared over the mass"),
    "spin_drag": Parameter("1/s", 0.0, math.inf, 1.0, "drag of the spin alone"),
    "friction_rest": Parameter("1", 0.0, math.inf, 1.0, "friction of a named law at rest"),
    "law_speed": Parameter("m/s", 0.0, math.inf, 1.0, "slip speed of a named law"),
    "slope_x": Parameter("1", -1.0, 1.0, 0.1, "pull of a slope along x, over g"),
    "slope_y": Parameter("1", -1.0, 1.0, 0.1, "pull of a slope along y, over g"),
    "belt_x": Parameter("m/s", -100.0, 100.0, 1.0, "velocity of the floor along x"),
    "belt_y": Parameter("m/s", -100.0, 100.0, 1.0, "velocity of the floor along y"),
    "mark_x": Parameter("m", -math.inf, math.inf, 0.0, "mark off the centre, along x of the body"),
    "mark_y": Parameter("m", -math.inf, math.inf, 0.0, "mark off the centre, along y of the body"),
    "readout": Parameter("s", -1.0, 1.0, 0.02, "time in which the lines of a picture are read"),
    "restitution": Parameter("1", 0.0, 1.0, 1.0, "restitution e of a wall"),
    "rim_friction": Parameter("1", 0.0, math.inf, 1.0, "friction of the rim on a wall"),
    "tangential": Parameter("1", -1.0, 1.0, 1.0, "tangential restitution of a wall"),
    "pair_restitution": Parameter("1", 0.0, 1.0, 1.0, "restitution e of two pucks"),
    "pair_friction": Parameter("1", 0.0, math.inf, 1.0, "friction of the rims of two pucks"),
    "pair_tangential": Parameter("1", -1.0, 1.0, 1.0, "tangential restitution of two pucks"),
    "mass_ratio": Parameter("1", 0.0, math.inf, 1.0, "mass of the second puck over the first's"),
    **dict.fromkeys(NODES, _AT_SPEED),
}
LAUNCH = {
    "launch_x": Parameter("m", -math.inf, math.inf, 0.0, "place at the launch along x"),
    "launch_y": Parameter("m", -math.inf, math.inf, 0.0, "place at the launch along y"),
    "launch_vx": Parameter("m/s", -math.inf, math.inf, 0.0, "launch velocity along x"),
    "launch_vy": Parameter("m/s", -math.inf, math.inf, 0.0, "launch velocity along y"),
    "launch_spin": Parameter("rad/s", -math.inf, math.inf, 0.0, "launch spin"),
    "launch_angle": Parameter("rad", -math.inf, math.inf, 1.0, "angle of the body at the launch"),
}
WALL = {
    "wall_angle": Parameter("rad", -math.inf, math.inf, 1.0, "direction to the wall"),
    "wall_distance": Parameter("m", -math.inf, math.inf, 0.0, "distance of the wall from (0, 0)"),
}
ALL = {**PUCK, **LAUNCH}
# what impacts have besides: unknown values of it mean these
OF_WALLS = {"restitution": 1.0, "rim_friction": math.inf, "tangential": 0.0}
OF_PAIRS = {
    "pair_restitution": 1.0, "pair_friction": math.inf, "pair_tangential": 0.0, "mass_ratio": 1.0,
}  # fmt: skip
OF_IMPACTS = {**OF_WALLS, **OF_PAIRS}
# more of it has no puck on a film: where a fit runs away it ends here; a friction is far larger
# where units are wrong, which is then said
MOST = {
    "friction": 1e6, "decel": 1e7, "gravity": 1e3, "drag": 100.0, "air": 100.0,
    "spin_drag": 100.0, "friction_rest": 10.0, "law_speed": 100.0, "rim_friction": 100.0,
    "pair_friction": 100.0, "mass_ratio": 1e3, **dict.fromkeys(NODES, 10.0),
}  # fmt: skip
TALLEST, LARGEST, SMALLEST = 100.0, 1e6, 1e-6  # times the radius; m
# 0 is none of their values
POSITIVE = ("radius", "gravity", "friction", "decel", "mass_ratio", "friction_rest", "law_speed")
OWN_MOTION = ("gyration", "inner")  # at each value of these unit motions are another curve
MARK = ("mark_x", "mark_y")
DRAGS, LAW_NUMBERS = ("air", "spin_drag"), ("friction_rest", "law_speed")
# of which no look-up has the motions
INTEGRATED = (*DRAGS, "slope_x", "slope_y", "belt_x", "belt_y", *LAW_NUMBERS)
# values that do nothing, or next to it: of no drag at all slopes to it are not computed
NOTHING = {"drag": 0.01, **dict.fromkeys((*INTEGRATED[: -len(LAW_NUMBERS)], *MARK), 0.0)}


def parameters_of(reach: float | None) -> Mapping[str, Parameter]:
    """All parameters of a puck and its launch, of one on a base that reaches so far (m) its own.

    >>> parameters_of(None)["gyration"][:3], parameters_of(0.25)["gyration"][:3]
    (('1', 0.1, 10.0), ('m', 0.025, 2.5))
    """
    if reach is None:
        return ALL
    _, low, high, plausible, _ = ALL["gyration"]
    own = Parameter("m", low * reach, high * reach, plausible * reach, "radius of gyration")
    return {**ALL, "gyration": own}


TINY = 1e-30  # step of derivatives along the imaginary axis
_FARTHEST = 10.0  # radii, of what is tracked from the centre: a stick on the body may be longer
_LEAST = 1e-9  # in its unit, of what must be more than 0


@dataclass(frozen=True)
class FitSpec:
    """What is to be found and what is known; InputError if the friction is neither free nor known.

    >>> spec = FitSpec(Puck(radius=0.0381), ("friction", "delta"), {}, {}, {}, {})
    >>> spec.scales({"friction": 0.2, "delta": 0.5})[0]
    1.96133
    """

    puck: Puck  # its numbers count where nothing else is said of them
    free: tuple[str, ...]  # names to be found, of PUCK
    fixed: Mapping[str, float]  # values by name, of PUCK or LAUNCH
    priors: Mapping[str, tuple[float, float]]  # value, standard deviation
    bounds: Mapping[str, tuple[float, float]]  # low, high
    start: Mapping[str, float]  # to begin with, besides what the tracks suggest
    freed: tuple[str, ...] = ()  # found since they have a prior or bounds
    of_impacts: Mapping[str, float] = field(default_factory=dict)  # where nothing else is said
    speeds: tuple[float, ...] = ()  # m/s, of slip, at which friction_0 and so on are found
    between: str = "cubic"  # or linear: f between these speeds
    law: str = ""  # over slip speed by its name, '' for none
    base: Base | None = None  # its reach is the radius of the puck; gyration is then in m

    def __post_init__(self) -> None:
        scale = self.speeds or {"friction", "decel"} & self.named
        if not scale and self.puck.friction == 0.0:
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

    @cached_property
    def named(self) -> frozenset[str]:
        """What is found, and what is held."""
        return frozenset((*self.free, *self.fixed))

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

    def numbers(self, result: Mapping[str, Any]) -> dict[str, Any]:
        """All numbers of the puck where some are found, real or complex."""
        return {**self.known(), **result}

    def scales(self, result: Mapping[str, Any]) -> tuple[Any, Any, Any]:
        """J, δ and r of what is found; of complex numbers, too."""
        all_of = self.numbers(result)
        if self.speeds or self.law:  # that of a puck about to stop
            all_of["friction"] = all_of[NODES[0] if self.speeds else LAW_NUMBERS[0]]
        direct = "decel" in self.named
        decel = all_of["decel"] if direct else all_of["friction"] * all_of["gravity"]
        if "delta" in self.named:
            return decel, all_of["delta"], all_of["radius"]
        friction = decel / all_of["gravity"]
        return decel, 2.0 * friction * all_of["height"] / all_of["radius"], all_of["radius"]

    def all_at(self, result: Mapping[str, Any]) -> dict[str, Any]:
        """All numbers of the puck where some are found, real or complex; J, δ, f and h follow."""
        numbers = self.numbers(result)
        decel, delta, radius = self.scales(result)
        friction = decel / numbers["gravity"]
        height = 0.5 * delta * radius / friction if friction != 0.0 else 0.0
        follows = {"decel": decel, "delta": delta, "friction": friction, "height": height}
        return {**numbers, **follows}

    def slopes(self, result: Mapping[str, float], name: str) -> tuple[float, float, float]:
        """The derivatives of δ, J and r to one that is found, by the complex step."""
        complex_values = {**result, name: result[name] + 1j * TINY}
        decel, delta, radius = ((one + 0j).imag / TINY for one in self.scales(complex_values))
        return delta, decel, radius

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

    def changes_motion(self, name: str) -> bool:
        """Whether a parameter is none of the scales, but changes the curve itself."""
        scale = bool(self.integrated) and name in ("friction", "decel", "gravity")
        return scale or name in (*OWN_MOTION, "drag", *INTEGRATED, *NODES)

    @property
    def integrated(self) -> tuple[str, ...]:
        """What is found, or known, with which no look-up has the motions."""
        return tuple(name for name in INTEGRATED if name in self.named)

    def plain(self) -> FitSpec:
        """What is asked without what is integrated: to begin from."""
        free = tuple(name for name in self.free if name not in INTEGRATED)
        fixed = {name: value for name, value in self.fixed.items() if name not in INTEGRATED}
        return replace(self, free=free, fixed=fixed, law="")

    def moving(self, result: Mapping[str, float], tall: bool) -> Moving:
        """What moves the puck."""
        (decel, delta, radius), numbers = self.scales(result), self.numbers(result)
        motions, by_speed = self._motions(numbers, tall), None
        if self.speeds or self.integrated:
            g = numbers["gravity"]
            law = self.speed_law(numbers) if self.speeds or self.law else float(decel / g)
            drags = tuple(numbers[name] for name in ("drag", *DRAGS))
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

    def highest(self, tall: bool) -> float:
        """The largest δ of which motions are known, of an annulus that is free as of the puck's."""
        return self._motions(self.known(), tall).highest

    def _motions(self, numbers: Mapping[str, float], tall: bool) -> UnitMotions:
        contact: Any = self.base or self.puck.body.law
        if "inner" in numbers:
            contact = f"annulus:{numbers['inner']!r}"
        lifts = tall and not self.integrated
        return unit_motions_of(contact, numbers["gyration"] / self._unit, lifts)

    def steepest(self, name: str) -> float:
        """The largest friction, or J, of a puck of known height and radius: 2fh/r is its δ."""
        known = self.known()
        own = {"height", "radius", "gravity"} & {*self.free}
        if own or "delta" in self.named or not known["height"]:
            return math.inf
        friction = 0.5 * self.highest(True) * known["radius"] / known["height"]
        return friction if name == "friction" else friction * known["gravity"]

    def begun(self) -> dict[str, float]:
        """Any numbers for what is free."""
        known, values = self.known(), {}
        middle = {"friction": 0.2, "decel": 2.0, "delta": 0.3, "height": 0.3 * self.puck.radius}
        for name in self.free:
            value = self.start.get(name, self.priors.get(name, (known.get(name) or 0.0,))[0])
            low, high = self.limits(name)
            values[name] = min(max(value or middle.get(name, value), low), high)
        return values

    def with_scales(self, decel: float, delta: float) -> dict[str, float]:
        """The free numbers, of those that J and δ follow from, which mean these."""
        result, others = {}, self.begun()
        gravity = self.numbers(others)["gravity"]
        if "friction" in others:
            result["friction"] = decel / gravity
        elif "decel" in others:
            result["decel"] = decel
        elif "gravity" in others:
            result["gravity"] = decel / self.known()["friction"]
        if "delta" in others:
            result["delta"] = delta
        elif "height" in others:
            others.update(result)
            radius, gravity = self.scales(others)[2], self.numbers(others)["gravity"]
            result["height"] = 0.5 * delta * radius * gravity / decel
        for name in result:
            low, high = self.limits(name)
            result[name] = min(max(result[name], low), high)
        return result

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


def is_annulus(puck: Puck) -> bool:
    """Whether it presses on a ring of some width."""
    return puck.body.law.name.startswith("annulus:")
