"""Why tracks do not fit: their angles, the radius, drag, or a friction over the slip speed.

Each is tried out: where residuals then are far smaller, about as noise is, that is told.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.parameters import NODES
from puck_tables.fitting.problem import TURN, Problem
from puck_tables.fitting.speed_law_fit import tried
from puck_tables.fitting.timing import Known

_FAR = 1.5  # times smaller are residuals of a reading that is told
_NEAR = 0.01  # of the radius: it is not another one
_BY_CHANCE = 0.5  # rad, as angles are off that nothing explains
_AS_NOISE = 3.0  # times the noise of a place: a reading that fits
_DEGREE = math.pi / 180.0
_ANGLES = (
    (-1.0, "if angles, or y, grew the other way: negate one of them in the file"),
    (_DEGREE, "if angles were in degrees, not in rad: say their unit"),
    (1.0 / _DEGREE, "if angles were in rad, not in degrees: say their unit"),
)
_MOST_DRAG = 20.0  # over the time of a film
_BETTER = math.log(1.2)  # more numbers always fit a little better
_ALIKE = math.log(1.5)  # readings that fit about as well
_MUCH = math.log(3.0)  # so much smaller residuals tell, though they are no noise yet
_LITTLE, _CLEAN = math.log(1.1), 1.4  # less than that is no reason; times the noise of a place
_MOST, _LEAST = 10.0, 1e-3  # times one friction for all speeds: laws that some floor has
_HELD = ("launch_spin", "launch_angle")  # what is said of these is said of the angles as they are


class _Reading(NamedTuple):
    """What else may be: in words, by how much smaller residuals are, if a floor, if it fits."""

    words: str
    gain: float
    floor: bool = False
    fits: bool = True


def misfit(result: Estimate, problem: Problem, known: Known, speeds: bool) -> str:
    """A sentence that says which other reading fits far better; empty if none does.

    A floor is named before angles or a radius that fit about as well.

    Parameters
    ----------
    result : the estimate of slides that do not fit
    problem : what was asked, with all frames
    known : whether the noise of places, of angles and of time stamps is
    speeds : whether a friction over slip speed does not fit, either
    """
    floor = _may_change(problem.spec) and not speeds
    told = [one for one in (_by_drag(result, problem, known), _by_speed(result, problem)) if one] \
        if floor else []  # fmt: skip
    if len(told) == 2 and told[1].gain < told[0].gain + _BETTER:  # more numbers fit a little better
        del told[1]
    told = sorted(told, key=lambda one: -one.gain)[:1]
    told += _otherwise(result, problem, known)
    air = _may_change(problem.spec) and not any(one.fits for one in told)
    if air and (words := _by_air(result, problem, known)):
        return words
    best = max((one.gain for one in told), default=0.0)
    # sizes and angles are known better than floors: a floor that tells much is named first
    near = [one for one in told if one.gain > best - _ALIKE or (one.floor and one.gain > _MUCH)]
    near.sort(key=lambda one: not one.floor)
    if near:
        words = f"{near[0].words}{f'; or {near[1].words}' if len(near) > 1 else ''}"
        return f"Residuals would be {math.exp(near[0].gain):.2g} times smaller {words}"
    return ""


def _otherwise(result: Estimate, problem: Problem, known: Known) -> list[_Reading]:
    """The angles, or the radius, read otherwise, if one of these fits far better."""
    best, given = _Reading("", math.log(_FAR)), problem.spec.known()["radius"]
    for words, other, scale in _others(problem):
        try:
            one = initial_estimate(other, known, refit=False)
        except InputError:  # such a puck, or such a track, there is not
            continue
        gain = _size(result, 1.0) - _size(one, scale)
        radius = one.problem.spec.scales(one.problem.numbers_at(one.x))[2]
        found_radius = "radius" in other.spec.free and "radius" not in problem.spec.free
        same = found_radius and abs(radius / given - 1.0) < _NEAR
        if gain > best.gain and not same and _fits(one, problem.noise[0]):
            best = _Reading(words.format(radius), gain)
    return [best] if best.words else []


def _tells(result: Estimate, other: Estimate, noise: float) -> float:
    """By how much smaller residuals are of another floor; 0 where that tells nothing.

    It leaves far less, or no more than noise where one friction leaves more than that.  Where air
    or a floor changes in a way that no few numbers tell it may still leave more than noise.
    """
    gain = _size(result, 1.0) - _size(other, 1.0)
    left = float(np.median(_deviations(other)[0])) / noise
    clean = gain > _LITTLE and left < _CLEAN
    fits = (gain > math.log(_FAR) or clean) and _fits(other, noise)
    return gain if fits or (gain > _MUCH and _explained(other)) else 0.0


def _dragged(problem: Problem) -> Problem:
    """The same with drag besides friction."""
    spec = problem.spec
    # from a speed e^20 times as slow, or as fast, at the end nothing is told any more
    most = _MOST_DRAG / max(float(film.time[-1]) for film in problem.films)
    bounds = {**spec.bounds, "drag": (-most, most)}
    return replace(problem, spec=replace(spec, free=(*spec.free, "drag"), bounds=bounds))


def _by_drag(result: Estimate, problem: Problem, known: Known) -> _Reading | None:
    """Drag of speed and spin alike, if that fits far better."""
    other = _dragged(problem)
    try:
        one = initial_estimate(other, known, refit=False)
    except InputError:
        return None
    gain = _tells(result, one, problem.noise[0])
    words = f"with drag besides friction: find it, too (--free {','.join(other.spec.free)})"
    return _Reading(words, gain, True, _fits(one, problem.noise[0])) if gain else None


def _may_change(spec: FitSpec) -> bool:
    """Whether nothing was asked that goes with no friction over slip speed."""
    named = {"drag", "inner", "decel", "gravity"} & {*spec.free, *spec.fixed}
    uniform = spec.puck.body.law.name == "uniform"
    lifts = spec.bounds.get("delta", (0.0, 1.0))[0] >= 1.0  # under such laws no base does
    return uniform and not named and not spec.speeds and not lifts and "friction" in spec.free


def _by_speed(result: Estimate, problem: Problem) -> _Reading | None:
    """A friction over slip speed, if that fits far better."""
    try:
        other = tried(result)
    except InputError:  # hardly any friction, at no speed
        return None
    gain = _tells(result, other, problem.noise[0])
    spec, numbers = other.problem.spec, other.problem.numbers_at(other.x)
    speeds = spec.speeds
    values = [numbers[name] for name in NODES[: len(speeds)]]
    usual = result.problem.numbers_at(result.x)["friction"]
    if max(values) > _MOST * usual or min(values) < _LEAST * usual:  # such a law fits noise
        return None
    told = ", ".join(f"{f:.2g} at {u:g} m/s" for u, f in zip(speeds, values, strict=True))
    words = (
        f"with a friction over slip speed ({told}): find it (--slip-speeds "
        f"{','.join(f'{u:g}' for u in speeds)})"
    )
    return _Reading(words, gain, True, _fits(other, problem.noise[0])) if gain else None


def _by_air(result: Estimate, problem: Problem, known: Known) -> str:
    """A sentence where places alone are those of another floor, and angles are not.

    Air slows the centre, and hardly the spin.
    """
    if len(problem.films) > 1 or problem.films[0].angle is None:
        return ""
    spec, spin = problem.spec, float(result.problem.launches(result.x)[0, 4])
    spec = spec.spinning(spin)
    films = tuple(replace(film, angle=None) for film in problem.films)
    blind = replace(problem.with_films(films), spec=spec)
    try:
        one = initial_estimate(blind, known, refit=False)
        others = [tried(one), initial_estimate(_dragged(blind), known, refit=False)]
    except InputError:
        return ""
    if not any(_tells(one, other, problem.noise[0]) for other in others):
        return ""
    return (
        "Without its angles the track is that of a puck under drag, or friction over slip speed, "
        "and with them it is not: what slows it hardly brakes its spin, as air does. A fit has no "
        "such drag, a scene has (drag.sliding, drag.quadratic); what slows it is found without "
        f"angles (--fix launch_spin={spin:.4g} and --free or --slip-speeds)"
    )


def _others(problem: Problem) -> Iterator[tuple[str, Problem, float]]:
    """Other readings, each in words and with the factor of its angles."""
    spec = problem.spec
    angled = any(film.angle is not None for film in problem.films)
    if angled and not any(name in given for name in _HELD for given in (spec.fixed, spec.bounds)):
        for factor, words in _ANGLES:
            films = tuple(
                film if film.angle is None else replace(film, angle=factor * film.angle)
                for film in problem.films
            )
            noise = problem.noise[0], abs(factor) * problem.noise[1]
            yield words, replace(problem.with_films(films), noise=noise), abs(factor)
    if angled and "radius" not in (*spec.free, *spec.fixed):  # told by angles alone
        words = "with a radius of {:.3g} m: is " + f"{spec.puck.radius:g} m right?"
        wider = replace(spec, free=(*spec.free, "radius"))
        yield words, replace(problem, spec=wider), 1.0


def _size(result: Estimate, scale: float) -> float:
    """The logarithm of the usual size of residuals, that of angles in units of ``scale``.

    Angles that nothing explains are as far off in any unit.
    """
    places, angles = _deviations(result)
    if angles.size and float(np.median(angles)) < _BY_CHANCE:
        angles = angles / scale
    sizes = [size for size in (places, angles) if size.size]
    usual = [math.log(max(float(np.median(size)), 1e-300)) for size in sizes]
    return float(np.average(usual, weights=[size.size for size in sizes]))


def _fits(tried: Estimate, noise: float) -> bool:
    """Whether places are about as far off as their noise, and angles are explained."""
    return _explained(tried) and float(np.median(_deviations(tried)[0])) < _AS_NOISE * noise


def _explained(tried: Estimate) -> bool:
    """Whether angles are explained."""
    angles = _deviations(tried)[1]
    return not angles.size or float(np.median(angles)) < _BY_CHANCE


def _deviations(result: Estimate) -> tuple[FloatArray, FloatArray]:
    """How far places (m) and angles (rad) are off."""
    films, deviations = result.problem.films, result.problem.deviations(result.x)
    angles = [np.empty(0)] + [
        np.abs(one[TURN, np.isfinite(film.angle)]) for film, one in zip(films, deviations,
        strict=True) if film.angle is not None
    ]  # fmt: skip
    return np.concatenate([np.hypot(*one[:TURN]) for one in deviations]), np.concatenate(angles)
