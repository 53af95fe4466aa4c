"""What is asked of a fit: names and numbers, checked against each other and the puck."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import Any

from puck_tables._core.arrays import bracketed, instance, pair_of, real
from puck_tables._core.wording import meant
from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.fitting.fit_spec import (
    ALL,
    INTEGRATED,
    LARGEST,
    LAW_NUMBERS,
    NODES,
    OF_IMPACTS,
    POSITIVE,
    PUCK,
    SMALLEST,
    FitSpec,
    Parameter,
    is_annulus,
    parameters_of,
)
from puck_tables.fitting.speed_motion import LAWS
from puck_tables.puck import Puck


def refuse_unknown(name: str, known: Mapping[str, Parameter], what: str) -> None:
    """Refuse a name that is no parameter, with the nearest that is."""
    if name not in known:
        usable = [one for one in known if one not in NODES]
        hint = meant(name, usable, 0.3)
        raise InputError(f"{what} names '{name}', which is none of {', '.join(usable)}{hint}")


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


_CLASHES = (("friction", "decel", ", decel is f g"), ("delta", "height", ""))


def spec_of(
    puck: Puck, free: Iterable[str] | None, fixed: Mapping[str, Any], priors: Mapping[str, Any],
    bounds: Mapping[str, Any], start: Mapping[str, Any], impacts: bool = False, rows: bool = False,
) -> FitSpec:  # fmt: skip
    """What is asked of a fit, checked; free where nothing is said: f, and δ where no height is.

    The arguments are those of :class:`FitSpec`; ``impacts``: whether they are looked for; ``rows``:
    whether it is said which rows of a rolling shutter a picture has.  Raises InputError if a name
    is not known (the nearest is told), or named in two ways that clash, or a number is out of
    range.

    >>> spec_of(Puck(radius=0.0381), None, {}, {}, {}, {}).free
    ('friction', 'delta')
    """
    instance("puck", puck, Puck)
    puck.refuse_moved()
    if not SMALLEST <= puck.radius <= LARGEST:
        raise InputError(
            f"the radius of a puck on a film is from {SMALLEST:g} to {LARGEST:g} m, got "
            f"{puck.radius:g}: say it in m"
        )
    puck.refuse_lift()
    base, puck = puck.shape, _round(puck)
    every = parameters_of(None if base is None else base.reach)
    known = {name: in_range(name, value, every) for name, value in fixed.items()}
    freed: tuple[str, ...] = ()
    if free is None:
        scale = () if {"friction", "decel"} & {*known} else ("friction",)
        if "decel" in priors or "decel" in bounds:
            scale = ("decel",)
        tilt = () if {"delta", "height"} & {*known} or puck.height else ("delta",)
        if tilt and ("height" in priors or "height" in bounds):
            tilt = ("height",)
        wanted = (*scale, *tilt)
        named = dict.fromkeys((*priors, *bounds))
        freed = tuple(name for name in named if name in PUCK and name not in wanted)
        wanted += freed
    else:
        wanted = tuple([free] if isinstance(free, str) else free)
    if rows and "readout" not in (*wanted, *known):
        wanted += ("readout",)
    for name in wanted:
        refuse_unknown(name, PUCK, "free")
        if name in known:
            raise InputError(
                f"{name} is both free and fixed at {known[name]:g}: leave out one of the two"
            )
    if len(set(wanted)) < len(wanted):
        raise InputError(f"free names {', '.join(wanted)}: name each parameter once")
    _refuse_unasked((*wanted, *known), impacts, rows)
    for numbers, what in ((priors, "prior"), (bounds, "bounds"), (start, "start")):
        for name in numbers:
            refuse_unknown(name, ALL, what)
            if name in known:
                raise InputError(f"{name} is fixed at {known[name]:g}: leave out its {what}")
            if name in PUCK and name not in wanted and not (impacts and name in OF_IMPACTS):
                raise InputError(f"{name} is not free: name it in free to give it a {what}")
    for one, other, since in _CLASHES:
        if {one, other} <= {*wanted, *known}:
            raise InputError(f"{one} and {other} say the same{since}: leave out one of them")
    if base is not None:
        _refuse_for_base({*wanted, *known}, impacts)
    if "inner" in (*wanted, *known) and not is_annulus(puck):
        raise InputError(
            "inner is the inner radius of an annulus: give the puck the pressure 'annulus:0.8'"
        )
    ranges = {n: bounds_of(n, v, every) for n, v in bounds.items()}
    begun = {n: in_range(n, v, every) for n, v in start.items()}
    for name, (low, high) in ranges.items():
        if not low <= begun.get(name, low) <= high:
            raise InputError(
                f"the start of {name}, {begun[name]:g}, lies outside its bounds, {low:g} to "
                f"{high:g}: give one within them, or none"
            )
    return FitSpec(
        puck, wanted, known, {n: prior_of(n, v, every) for n, v in priors.items()}, ranges, begun,
        freed, base=base,
    )  # fmt: skip


def _refuse_unasked(named: Collection[str], impacts: bool, rows: bool) -> None:
    """Refuse numbers of slip speeds, of a rolling shutter or of impacts that nobody asked for."""
    for name in named:
        if name in NODES:
            raise InputError(
                f"{name} is found where slip speeds are given (--slip-speeds, slip_speeds=), "
                "and cannot be named"
            )
        if name == "readout" and not rows:
            raise InputError(
                "readout is of a rolling shutter: say which y (m) the first and the last line "
                "of the picture show (--rows, rows=)"
            )
        if name in OF_IMPACTS and not impacts:
            raise InputError(
                f"{name} is a number of impacts, which are not looked for: ask for them "
                "(--impacts, impacts=True)"
            )


def _round(puck: Puck) -> Puck:
    """A round puck that reaches as far, whose numbers stand for those of a puck on a base."""
    if puck.shape is None:
        return puck
    reach = puck.shape.reach
    return Puck(
        reach, height=puck.height, friction=puck.friction, mass=puck.mass, gravity=puck.gravity,
        gyration=puck.gyration / reach,
    )  # fmt: skip


def _refuse_for_base(named: Collection[str], impacts: bool) -> None:
    """Refuse what is of round pucks alone."""
    if impacts:
        raise InputError("impacts are fitted of round pucks: cut the film before the first")
    for name in ("radius", "drag", "inner", *INTEGRATED):
        if name in named:
            raise InputError(f"{name} is found, or held, of round pucks: leave it out with a base")


def with_law(spec: FitSpec, law: str) -> FitSpec:
    """What is asked with a law over slip speed by its name, whose numbers are found too."""
    if law not in LAWS:
        raise InputError(f"law must be one of {', '.join(LAWS)}, got {law!r:.40}")
    if "friction" not in spec.free:
        raise InputError("a law over slip speed is found: do not give the friction")
    more = tuple(name for name in LAW_NUMBERS if name not in spec.named)
    return replace(spec, law=law, free=(*spec.free, *more))


def refuse_integrated(spec: FitSpec) -> None:
    """Refuse what does not go with motions that are integrated."""
    named = spec.integrated
    _refuse_pressure(spec, f"{' and '.join(named)} are")
    if not spec.law and any(name in LAW_NUMBERS for name in named):
        raise InputError(
            f"{' and '.join(LAW_NUMBERS)} are numbers of a law over slip speed: name it "
            f"(--law, law=): {', '.join(LAWS)}"
        )


def _refuse_pressure(spec: FitSpec, what: str) -> None:
    """Refuse pressure, or a base, under which no such motion is integrated."""
    if spec.base is not None:
        raise InputError(f"{what} found of round pucks alone, not of base {spec.base.name}")
    if spec.puck.body.law.name != "uniform" or "inner" in spec.named:
        raise InputError(
            f"{what} found of uniform pressure alone, not of {spec.puck.body.law.name}"
        )


def over(spec: FitSpec, speeds: tuple[float, ...], between: str) -> FitSpec:
    """What is asked with a friction coefficient for each of these slip speeds."""
    if spec.law:
        raise InputError("law and slip_speeds both find friction over slip speed: give one of them")
    for name in ("decel", "gravity", "drag", *INTEGRATED, "inner"):
        if name in spec.named:
            raise InputError(
                f"{name} cannot be found or fixed beside a friction over slip speed: leave it out"
            )
    if "friction" not in spec.free:
        raise InputError("a friction over slip speed is found: do not give the friction")
    _refuse_pressure(spec, "a friction over slip speed is")
    nodes = NODES[: len(speeds)]
    free = (*nodes, *(name for name in spec.free if name != "friction"))
    bounds, priors = (
        {**of, **(dict.fromkeys(nodes, of["friction"]) if "friction" in of else {})}
        for of in (spec.bounds, spec.priors)
    )
    return replace(spec, free=free, bounds=bounds, priors=priors, speeds=speeds, between=between)


# what may go with a pressure law, and what is then found besides
FLOORS = {
    "drag": ("drag",), "air": ("air",), "stribeck": LAW_NUMBERS, "hyperbola": LAW_NUMBERS,
    "two-valued": LAW_NUMBERS, "slope": ("slope_x", "slope_y"), "belt": ("belt_x", "belt_y"),
}  # fmt: skip
EVERY_FLOOR = "floors"  # of uniform pressure: all of these


def variants_of(spec: FitSpec, names: Any) -> dict[str, FitSpec]:
    """What is asked of each law by its name."""
    if isinstance(names, str):
        raise InputError(f"laws must be a list of names, got the text '{names}'")
    floors = ["uniform", *(f"uniform+{one}" for one in FLOORS)]
    names = [more for name in names for more in (floors if name == EVERY_FLOOR else [name])]
    if len(set(names)) < len(names):
        raise InputError(f"laws {', '.join(names)}: name each law once")
    other = {"inner", *(one for numbers in FLOORS.values() for one in numbers)}
    plain = tuple(n for n in spec.free if n not in other)
    fixed = {n: v for n, v in spec.fixed.items() if n not in other}
    variants = {}
    for name in names:
        pressure, plus, floor = name.partition("+")
        if plus and floor not in FLOORS:
            raise InputError(f"laws {name}: behind + may stand {', '.join(FLOORS)}")
        puck, law = replace(spec.puck, pressure=law_of(pressure)), floor if floor in LAWS else ""
        free = plain + FLOORS.get(floor, ())
        variants[name] = replace(spec, puck=puck, free=free, fixed=fixed, law=law)
        if variants[name].integrated:
            refuse_integrated(variants[name])
    return variants
