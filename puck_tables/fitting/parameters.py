"""The numbers that a fit knows: their units, their ranges, and what a caller may say of each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from puck_tables._core.arrays import bracketed, pair_of, real
from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.motion.body import LARGEST_GYRATION, SMALLEST_GYRATION


class Parameter(NamedTuple):
    """Unit, the allowed range, what values are plausible within, and what it is."""

    unit: str
    low: float
    high: float
    plausible: float
    words: str


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
}
MOST_NODES = 8  # slip speeds of a law over speed: each is one more number to find
NODES = tuple(f"friction_{k}" for k in range(MOST_NODES))  # f at slip speeds that are given
PUCK.update({
    name: Parameter("1", 0.0, math.inf, 1.0, "friction coefficient at a slip speed")
    for name in NODES
})  # fmt: skip
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


def refuse_unknown(name: str, known: Mapping[str, Parameter], what: str) -> None:
    """Refuse a name that is no parameter, with the nearest that is."""
    if name not in known:
        usable = [one for one in known if one not in NODES]
        hint = meant(name, usable, 0.3)
        raise InputError(f"{what} names '{name}', which is none of {', '.join(usable)}{hint}")


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


def in_range(name: str, value: Any, known: Mapping[str, Parameter]) -> float:
    """A value of a parameter."""
    refuse_unknown(name, known, "the fit")
    number, kind = real(name, value, known[name].unit), known[name]
    if not kind.low <= number <= kind.high or (name in POSITIVE and number == 0.0):
        raise InputError(
            f"{name} must be {_range(name, kind)}{bracketed(kind.unit)}, got {number:g}"
        )
    return number


def _range(name: str, kind: Parameter) -> str:
    """What values a parameter may have, in words."""
    if name in POSITIVE:
        return f"greater than {kind.low:g}"
    if kind.high == math.inf:
        return f"{kind.low:g} or more"
    return f"from {kind.low:g} to {kind.high:g}"


def prior_of(name: str, pair: Any, known: Mapping[str, Parameter]) -> tuple[float, float]:
    """A value and its standard deviation."""
    value, spread = _pair(name, pair, "prior", "value and a standard deviation", known)
    if not spread > 0.0:
        raise InputError(
            f"the prior of {name} needs a standard deviation > 0, got {spread:g}: to hold {name} "
            "at a value, fix it"
        )
    return in_range(name, value, known), spread


def bounds_of(name: str, pair: Any, known: Mapping[str, Parameter]) -> tuple[float, float]:
    """The least and the largest value."""
    low, high = _pair(name, pair, "bounds", "least and a largest value", known)
    kind = known[name]
    if not low < high:
        raise InputError(f"the bounds of {name} must ascend, got {low:g} and {high:g}")
    if high <= kind.low or low >= kind.high:
        raise InputError(
            f"the bounds of {name}, {low:g} to {high:g}, hold none of its values: {name} is "
            f"{_range(name, kind)}{bracketed(kind.unit)}"
        )
    return low, high


def _pair(
    name: str, pair: Any, what: str, words: str, known: Mapping[str, Parameter]
) -> tuple[float, float]:
    first, second = pair_of(f"the {what} of {name} must be a {words}", pair)
    unit = known[name].unit
    return real(f"the {what} of {name}", first, unit), real(f"the {what} of {name}", second, unit)
