"""What is asked of a fit: names and numbers, checked against each other and the puck."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from puck_tables._core.arrays import instance
from puck_tables.errors import InputError
from puck_tables.fitting.fit_spec import FitSpec, is_annulus
from puck_tables.fitting.parameters import (
    ALL,
    INTEGRATED,
    LARGEST,
    NODES,
    OF_IMPACTS,
    PUCK,
    SMALLEST,
    bounds_of,
    in_range,
    parameters_of,
    prior_of,
    refuse_unknown,
)
from puck_tables.puck import Puck

_CLASHES = (("friction", "decel", ", decel is f g"), ("delta", "height", ""))


def spec_of(
    puck: Puck, free: Iterable[str] | None, fixed: Mapping[str, Any],
    priors: Mapping[str, Any], bounds: Mapping[str, Any], start: Mapping[str, Any],
    impacts: bool = False, rows: bool = False,
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
    for name in (*wanted, *known):
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
    return FitSpec(
        puck, wanted, known, {n: prior_of(n, v, every) for n, v in priors.items()},
        {n: bounds_of(n, v, every) for n, v in bounds.items()},
        {n: in_range(n, v, every) for n, v in start.items()}, freed, base=base,
    )  # fmt: skip


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
