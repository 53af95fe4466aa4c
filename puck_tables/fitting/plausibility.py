"""Numbers that nobody would believe, in words: units, scales or what was known may be wrong."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.numbers import KNOWN, EstimatedLaunch, Number
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.parameters import ALL, LAUNCH, WALL
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.side_forces import SideForces

_GRIP, _SLICK = 5.0, 1e-4  # friction coefficients of dry surfaces are smaller, and larger
_TALL = 8.0  # radii: pucks are lower
_OTHER = 3.0  # times the radius that was given
_FAST, _FAST_RIM = 100.0, 300.0  # m/s: no puck on a film slides, or turns, faster
_HEAVIER = 100.0  # times the other puck
_LEVEL, _UNTOLD = 0.05, 5.0  # degrees of a slope that is told, and that is not
_AT_END = 1e-3  # of the width of a range
_UNITS = "the unit of the places, or of the times, the scale or the frames a second may be wrong"


def doubts(
    numbers: Mapping[str, Number], launches: Sequence[EstimatedLaunch], radius: float
) -> tuple[str, ...]:
    """A sentence for each number that was found and that no puck has.

    Parameters
    ----------
    numbers, launches : as they were found
    radius : m, of the puck as it was given

    Examples
    --------
    >>> tall = Number(10.0, 0.1, 9.8, 10.2, "m", "follows")
    >>> doubts({"height": tall}, (), 0.026)[0][:55]
    'A height of 10 m is 385 times the radius, as no puck is'
    """
    said = []
    result = {
        name: one for name, one in numbers.items()
        if one.how != KNOWN and one.determined and math.isfinite(one.value)
    }  # fmt: skip
    friction, height, own = (result.get(name) for name in ("friction", "height", "radius"))
    if friction is not None and (friction.low > _GRIP or friction.high < _SLICK):
        than = "more" if friction.low > _GRIP else "less"
        said.append(
            f"A friction of {friction.value:.3g} is {than} than dry surfaces have: {_UNITS}"
        )
    true = radius if own is None else own.value
    if not said and height is not None and height.value > _TALL * true and height.low > true:
        said.append(
            f"A height of {height.value:.3g} m is {height.value / true:.3g} times the radius, as "
            "no puck is: the path bends for another reason, or the floor slopes; give the height "
            "if it is known"
        )
    if own is not None and not 1.0 / _OTHER < own.value / radius < _OTHER:
        said.append(
            f"A radius of {own.value:.3g} m was found where {radius:.3g} m was said: the scale, or "
            "the unit of the angles, may be wrong"
        )
    gyration = result.get("gyration")
    if gyration is not None and gyration.low > 1.0:
        said.append(
            f"A radius of gyration of {gyration.value:.3g} r is that of no body within its rim: "
            "the radius, or the unit of the angles, may be wrong"
        )
    ratio = result.get("mass_ratio")
    if ratio is not None and not 1.0 / _HEAVIER < ratio.value < _HEAVIER:
        said.append(f"A mass ratio of {ratio.value:.3g} is that of no two pucks of one size")
    for one in launches:
        speed, rim = math.hypot(*one.velocity), true * abs(one.spin)
        if speed > _FAST:
            said.append(f"{one.name} slides at {speed:.3g} m/s, as no puck does: {_UNITS}")
        elif rim > _FAST_RIM and one.numbers["launch_spin"].determined:
            said.append(
                f"The rim of {one.name} turns at {rim:.3g} m/s, as no puck does: the unit of the "
                "angles or of the times may be wrong, or it turns by whole turns less"
            )
    return tuple(said)


def rounded(film: Observations) -> list[str]:
    """A sentence for what is rounded more coarsely than its noise is."""
    return [
        f"{what} of {film.name} are rounded to {step:.3g} {unit}, which is no noise where the puck "
        "is slow: frames in which one stays at a value and comes back, or ends there, count as "
        "two, and errors are those that parts of the frames show. Better give "
        "them as they were measured"
        for what, step, unit in zip(("Places", "Angles"), film.steps, ("m", "rad"), strict=True)
        if step
    ]


def taken_for_granted(forces: SideForces, numbers: Mapping[str, Number]) -> list[str]:
    """A sentence where a table that is hardly out of level would change much, and is not seen to.

    Examples
    --------
    >>> friction = Number(0.15, 1e-4, 0.1498, 0.1502, "1", "found")
    >>> said = taken_for_granted(SideForces(level=0.7, by_slope={"friction": 0.0017}),
    ...                          {"friction": friction})
    >>> said[0][:74]
    'A level table is taken for granted: one out of level by 0.1 degrees would '
    """
    if not forces.level > _LEVEL:
        return []
    changes = [
        f"{name} by up to {change:.2g}" for name, change in forces.by_slope.items()
        if math.isfinite(numbers[name].error) and change > numbers[name].error
    ]  # fmt: skip
    if not changes:
        return []
    how = f"tell its slope to {forces.level:.2g} degrees alone" if forces.level < _UNTOLD \
        else "do not tell its slope"  # fmt: skip
    return [
        f"A level table is taken for granted: one out of level by 0.1 degrees would change "
        f"{' and '.join(changes)}, and the tracks {how}"
    ]


def ran_away(problem: Problem, x: FloatArray) -> str:
    """A sentence where a launch lies on the end of what the film leaves it; else none."""
    for (track, name), value, low, high in zip(problem.names, x, *problem.limits, strict=True):
        if name in problem.spec.bounds or name not in (*LAUNCH, *WALL) or low == -math.inf:
            continue
        if min(value - low, high - value) <= _AT_END * (high - low):
            kind = ALL.get(name) or WALL[name]
            of = f" of {problem.films[track].name}" if track >= 0 else ""
            return (
                f"Nothing is determined: the fit runs away, {kind.words}{of} to {value:.3g} "
                f"{kind.unit}, the end of what is looked for, as nobody would believe: the tracks "
                "look alike all the way, or another law moves this puck. What would tell: angle "
                f"marks on the puck, or bounds of {name}, or its value, if it is known"
            )
    return ""
