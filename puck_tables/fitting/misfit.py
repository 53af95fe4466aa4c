"""Why tracks do not fit.

Angles or a radius read otherwise, another pressure law, drag, air, a slope, or a friction over the
slip speed are tried out: where residuals then are far smaller, about as noise is, that is told.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.fitting.checked_spec import FLOORS
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import INTEGRATED, MARK, NODES, NOTHING, FitSpec
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.problem import ROUGH, TURN, Problem
from puck_tables.fitting.residuals import NO_PATTERN, SideForces
from puck_tables.fitting.slowing import (
    nearest_start,
    starts_from_slowing,
    tried,
)

_FAR = 1.5  # times smaller are residuals of a reading that is told
_NEAR, _LEAST = 0.01, 1e-3  # of the radius: it is not another one; units are not mixed up by more
_BY_CHANCE, _MOST = 0.5, 0.75  # rad, as angles are off that nothing explains; of all
_AS_NOISE = 3.0  # times the noise of a place: a reading that fits
_ROUNDING = 1e-12  # m or rad: of a film that was computed less tells nothing
_FIRST = 2  # readings are told that are no floors, if they are among so many
_DEGREE = math.pi / 180.0  # rad
_AGAIN = "if angles came again after {} a turn, as those of {} do: numpy.unwrap(angle, period=pi{})"
_Read = Callable[[FloatArray], FloatArray]
_ANGLES: tuple[tuple[str, float, _Read], ...] = (  # their scale; the last is of a base
    ("if angles, or y, grew the other way: negate one of them in the file", 1.0, np.negative),
    ("if angles were in degrees, not in rad: say their unit", _DEGREE, np.radians),
    ("if angles were in rad, not in degrees: say their unit", 1.0 / _DEGREE, np.degrees),
    (_AGAIN.format("half", "a bar", ""), 1.0, lambda angle: _unwrapped(angle, math.pi)),
    (_AGAIN.format("a quarter of", "a square", "/2"), 1.0,
     lambda angle: _unwrapped(angle, 0.5 * math.pi)),
    ("if angles were those of the y axis of the base: add a quarter turn, or swap its sides", 1.0,
     lambda angle: angle + 0.5 * math.pi),
)  # fmt: skip
_MOST_DRAG = 20.0  # over the time of a film
_BETTER = math.log(1.2)  # more numbers always fit a little better
_ALIKE = math.log(1.5)  # readings that fit about as well
_MUCH = math.log(3.0)  # so much smaller residuals tell, though they are no noise yet
_LITTLE, _CLEAN = math.log(1.1), 1.4  # less than that is no reason; times the noise of a place
_SPINS = 0.1  # rim speed over speed: such a puck's path is seen to bend
_FAINT = 1e-3  # of what friction does: no force explains anything by so little
_STEEP, _STEEPEST = 3.0, 10.0  # degrees: hardly anybody, or nobody, takes that for a level table
_AS_A_RING = 0.99  # inner radius of an annulus over r
_MIDDLE = {"inner": 0.5}  # where a search begins
_PRESSURES = (("hertz", ()), ("annulus:0.7", ("inner",)))  # to either side of uniform pressure
_HELD = ("launch_spin", "launch_angle")  # what is said of these is said of the angles as they are


class _Left(NamedTuple):
    """How far places (m), and angles (rad), are off."""

    places: FloatArray
    angles: FloatArray

    @property
    def explained(self) -> bool:
        """Whether most angles are explained; half of those off by half turns always are."""
        return not self.angles.size or float(np.quantile(self.angles, _MOST)) < _BY_CHANCE

    def near(self, noise: float) -> bool:
        """Whether places are about as far off as their noise, and angles are explained."""
        return self.explained and float(np.median(self.places)) < _AS_NOISE * noise

    def size(self, scale: float = 1.0) -> float:
        """The logarithm of the usual size of residuals, that of angles in units of ``scale``.

        Angles that nothing explains are as far off in any unit.
        """
        angles = self.angles / scale if self.angles.size and self.explained else self.angles
        sizes = [size for size in (self.places, angles) if size.size]
        usual = [math.log(max(float(np.median(size)), _ROUNDING)) for size in sizes]
        return float(np.average(usual, weights=[size.size for size in sizes]))


def _left(problem: Problem, x: FloatArray) -> _Left:
    """What motions leave of the tracks."""
    deviations = problem.deviations(x)
    angles = [np.abs(one[TURN, np.isfinite(one[TURN])]) for one in deviations]
    places = [np.hypot(*one[:TURN]) for one in deviations]
    return _Left(np.concatenate(places), np.concatenate(angles))


class _Reading(NamedTuple):
    """What else may be: in words, by how much smaller residuals are, if a floor.

    ``turns_paths``: if one that bends any path, as a slope does: it comes first only if about the
    best, and not before angles read otherwise; ``same``: if it takes no more numbers, as these.
    """

    words: str
    gain: float
    floor: bool = False
    turns_paths: bool = False
    same: bool = False


def misfit(result: Estimate, problem: Problem, forces: SideForces, speeds: bool) -> str:
    """A sentence that says which other reading fits far better; empty if none does.

    A floor is named before angles or a radius that fit about as well.  ``problem``: what was asked,
    with all frames; ``speeds``: whether a friction over slip speed does not fit, either.
    """
    # residuals are compared, not numbers, and of frames that were kept: a hand fits no reading
    problem = replace(problem.with_films(result.problem.films), level=ROUGH)
    launches = result.problem.launches(result.x).tolist()
    for film, (_, _, vx, vy, spin, _) in zip(problem.films, launches, strict=False):
        spins = problem.spec.known()["radius"] * abs(spin) > _SPINS * math.hypot(vx, vy)
        if film.straight is not None and film.angle is not None and spins:
            return (
                f"Places of {film.name} lie on one line, from which spin and height turn a puck: "
                "are both x and y in the file?"
            )
    explanations = list[_Reading]()
    if _may_change(problem.spec) and not speeds:
        drag, air, slope = (
            _reading(partial(_by_floor, result, problem, one)) for one in ("drag", "air", "slope")
        )
        law = _reading(partial(_by_speed, result, problem))
        if drag and law and law.gain < drag.gain + _BETTER:  # more numbers fit a little better
            law = law._replace(gain=min(law.gain, drag.gain))
        explanations = [one for one in (drag, law, air, slope) if one]
    more = (_reading(partial(by, result, problem)) for by in (_by_mark, _by_pressure))
    explanations += [*filter(None, more), *_otherwise(result, problem)]
    best = max((one.gain for one in explanations), default=0.0)
    # sizes and angles are known better than floors: a floor that tells much is named first
    near = [
        one for one in explanations
        if one.gain > best - _ALIKE or (one.floor and one.gain > max(_MUCH, best - _MUCH))
    ]  # fmt: skip
    least = max([best - _BETTER, *(one.gain + _BETTER for one in near if one.same)])
    near.sort(key=lambda one: (not one.floor or (one.turns_paths and one.gain < least),
                               -one.gain - _BETTER * one.same))  # fmt: skip
    if near:
        words = "; or ".join(
            one.words for n, one in enumerate(near)
            if one.floor or n < _FIRST or one.gain > best - _BETTER
        )  # fmt: skip
        return f"Residuals would be {math.exp(near[0].gain):.2g} times smaller {words}"
    if forces.chance < NO_PATTERN:
        return f"What may leave such a pattern: {forces.words}"
    return ""


def _reading(of: Callable[[], _Reading]) -> _Reading | None:
    """One that is worth telling; None where there is no such motion, or it gains nothing."""
    try:
        one = of()
    except InputError:
        return None
    return one if one.gain else None


def _otherwise(result: Estimate, problem: Problem) -> list[_Reading]:
    """The angles, or the radius, read otherwise, if one of these fits far better."""
    best, spec = _Reading("", 0.0), problem.spec
    known, others = spec.known()["radius"], []
    held = any(name in said for name in _HELD for said in (spec.fixed, spec.bounds))
    angles = _ANGLES[:-1] if spec.base is None else _ANGLES
    for words, scale, read in angles if problem.angled and not held else ():
        if (other := _with_angles(problem, scale, read)) is not None:
            others.append((words, other, scale))
    wider = problem.angled and spec.base is None and "radius" not in spec.named  # angles tell it
    if wider:
        words = "with a radius of {:.3g} m" + f" (said to be {spec.puck.radius:g} m)"
        other = replace(problem, spec=replace(spec, free=(*spec.free, "radius")))
        others.append((words, other, 1.0))
    for words, other, scale in others:  # and the factor of its angles
        try:
            one = initial_estimate(other, refit=False)
        except InputError:  # such a puck, or such a track, there is not
            continue
        left = _left(one.problem, one.x)
        gain = _gain(result, left, problem.noise[0], scale)
        radius = one.problem.spec.scales(one.problem.numbers_at(one.x))[2]
        same = abs(radius / known - 1.0) < _NEAR or radius < _LEAST * known
        same = same and wider and "radius" in other.spec.free
        if gain > best.gain and not same and left.near(problem.noise[0]):
            best = _Reading(words.format(radius), gain, same=other.spec == spec)
    return [best] if best.words else []


def _with_angles(problem: Problem, scale: float, read: _Read) -> Problem | None:
    """What was asked, with angles read otherwise, their noise ``scale`` times as much.

    None if they differ by whole turns alone.
    """
    films, differ = [], False
    for film in problem.films:
        if film.angle is not None:
            angle = read(film.angle)
            turned = np.abs(np.sin(0.5 * (angle - film.angle)))
            differ = differ or float(np.nanmax(turned)) > _ROUNDING
            film = replace(film, angle=angle)
        films.append(film)
    noise = problem.noise[0], scale * problem.noise[1]
    return replace(problem.with_films(tuple(films)), noise=noise) if differ else None


def _unwrapped(angle: FloatArray, period: float) -> FloatArray:
    """Angles, rad, as they go on where steps of more than half a period are taken for wraps."""
    seen, unwrapped = np.isfinite(angle), angle.copy()
    unwrapped[seen] = np.unwrap(angle[seen], period=period)
    return unwrapped


def _by_mark(result: Estimate, problem: Problem) -> _Reading:
    """What is tracked lies off the centre of mass, if that fits far better."""
    spec = problem.spec
    if not problem.angled or {*MARK} & spec.named:
        return _Reading("", 0.0)
    free = (*spec.free, *MARK)
    one = initial_estimate(replace(problem, spec=replace(spec, free=free)), refit=False)
    words = f"if what is tracked lies off the centre: find where (--free {','.join(free)})"
    return _Reading(words, _gain(result, _left(one.problem, one.x), problem.noise[0]), True)


def _near(result: Estimate, other: Problem) -> tuple[float, dict[str, float]]:
    """By how much smaller residuals of another problem are near what was found, and its numbers."""
    at, launches = result.problem.numbers_at(result.x), result.problem.launches(result.x)
    plain = np.clip(other.unknowns({**NOTHING, **_MIDDLE, **at}, launches), *other.limits)
    x = nearest_start(other, starts_from_slowing(other) or [(other, plain)])[1]
    return _gain(result, _left(other, x), other.noise[0]), other.numbers_at(x)


def _by_pressure(result: Estimate, problem: Problem) -> _Reading:
    """The pressure of Hertz, or that of an annulus, if it fits far better than that asked."""
    best, spec = _Reading("", 0.0), problem.spec
    if spec.base is not None or spec.integrated or spec.speeds or "inner" in spec.named:
        return best
    for name, more in _PRESSURES:
        free, puck = (*spec.free, *more), replace(spec.puck, pressure=law_of(name))
        other = replace(problem, spec=replace(spec, puck=puck, free=free), tall=False)
        gain, numbers = _near(result, other)
        inner = numbers.get("inner", 1.0)
        law = "ring" if more and inner > _AS_A_RING else name
        words = f"with the base pressed as {law}: say so (--pressure {law})"
        if more and law == name:
            words = (
                f"with the base pressed outside {inner:.2g} r alone: find where (--pressure {name} "
                f"--free {','.join(free)})"
            )
        if gain > best.gain and law != spec.puck.body.law.name:
            best = _Reading(words, gain, same=not more)
    return best


def _gain(result: Estimate, other: _Left, noise: float, scale: float = 1.0) -> float:
    """By how much smaller residuals are of another reading; 0 where that tells nothing.

    ``scale``: of its angles.  It leaves far less, or no more than noise where one friction leaves
    more; angles that are made small tell nothing so.  It may still leave more than noise.
    """
    gain = _left(result.problem, result.x).size() - other.size(scale)
    clean = scale == 1.0 and gain > _LITTLE and float(np.median(other.places)) / noise < _CLEAN
    fits = (gain > math.log(_FAR) or clean) and other.near(noise)
    return gain if fits or (gain > _MUCH and other.explained) else 0.0


def _by_floor(result: Estimate, problem: Problem, floor: str) -> _Reading:
    """Drag of speed and spin alike, air, or a table out of level, if that fits far better."""
    at, launches = result.problem.numbers_at(result.x), result.problem.launches(result.x)
    spec, bounds = problem.spec, problem.spec.bounds
    if floor == "drag":
        # from a speed e^20 times as slow, or as fast, at the end nothing is told any more
        most = _MOST_DRAG / max(float(film.time[-1]) for film in problem.films)
        bounds = {**bounds, "drag": (-most, most)}
    spec = replace(spec, free=(*spec.free, *FLOORS[floor]), bounds=bounds)
    other = replace(problem, spec=spec, tall=False)
    gain, numbers = _near(result, other)
    speed = float(np.hypot(*launches[:, 2:4].T).max())
    tilt, slowing, free = 0.0, result.problem.spec.scales(at)[0], f"(--free {','.join(spec.free)})"
    if floor == "drag":
        force = abs(numbers["drag"]) * speed
        words = f"with drag besides friction: find it, too {free}"
    elif floor == "air":
        force = numbers["air"] * speed**2
        words = (
            f"if air slowed it, by {numbers['air']:.2g}/m times the square of its speed (what "
            f"slows it hardly brakes its spin, as air does): find it, too {free}"
        )
    else:
        pull = numbers["slope_x"], numbers["slope_y"]
        tilt, heading = math.degrees(math.hypot(*pull)), math.degrees(math.atan2(pull[1], pull[0]))
        force = math.hypot(*pull) * spec.known()["gravity"] if tilt < _STEEPEST else 0.0
        words = (
            f"with a table out of level by {tilt:.2g} degrees, down along {heading % 360.0:.3g} "
            "degrees from x: level it, or find its slope, too (slope_x, slope_y)"
        )
    gain = gain if force > _FAINT * slowing else 0.0
    return _Reading(words, gain, floor != "slope" or tilt < _STEEP, floor == "slope")


def _may_change(spec: FitSpec) -> bool:
    """Whether nothing was asked that goes with no friction over slip speed."""
    named = {"drag", *INTEGRATED, "inner", "decel", "gravity"} & spec.named or spec.speeds
    uniform = spec.puck.body.law.name == "uniform" and spec.base is None
    lifts = spec.bounds.get("delta", (0.0, 1.0))[0] >= 1.0  # under such laws no base does
    return uniform and not named and not lifts and "friction" in spec.free


def _by_speed(result: Estimate, problem: Problem) -> _Reading:
    """A friction over slip speed, if that fits far better."""
    other = tried(result)
    gain = _gain(result, _left(other.problem, other.x), problem.noise[0])
    speeds, numbers = other.problem.spec.speeds, other.problem.numbers_at(other.x)
    each = zip(speeds, NODES, strict=False)
    points = ", ".join(f"{numbers[name]:.2g} at {u:g} m/s" for u, name in each)
    words = (
        f"with a friction over slip speed ({points}): find it (--slip-speeds "
        f"{','.join(f'{u:g}' for u in speeds)})"
    )
    return _Reading(words, gain, True)
