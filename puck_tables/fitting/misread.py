"""Why tracks do not fit: their angles, the radius, drag, or a friction over the slip speed.

Each is tried out: where residuals then are far smaller, about as noise is, that is told.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.by_speed import tried
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fitted import fitted
from puck_tables.fitting.parameters import NODES
from puck_tables.fitting.problem import TURN, Problem
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
_DRAG = "with drag besides friction"
_BETTER = math.log(1.2)  # more numbers always fit a little better
_MOST, _LEAST = 10.0, 1e-3  # times one friction for all speeds: laws that some floor has
_HELD = ("launch_spin", "launch_angle")  # what is said of these is said of the angles as they are


def misread(found: Estimate, problem: Problem, known: Known) -> str:
    """A sentence that says which other reading fits far better; empty if none does.

    Parameters
    ----------
    found : the estimate of slides that do not fit
    problem : what was asked, with all frames
    known : whether the noise of places, of angles and of time stamps is
    """
    told, best, given = "", math.log(_FAR), problem.asked.known()["radius"]
    for words, other, scale in _others(problem):
        try:
            one = fitted(other, known, refit=False)
        except InputError:  # such a puck, or such a track, there is not
            continue
        gain = _size(found, 1.0) - _size(one, scale)
        radius = one.problem.asked.scales(one.problem.found(one.x))[2]
        found_radius = "radius" in other.asked.free and "radius" not in problem.asked.free
        same = found_radius and abs(radius / given - 1.0) < _NEAR
        if gain > best and not same and _fits(one, problem.noise[0]):
            told = f"Residuals would be {math.exp(gain):.2g} times smaller " + words.format(radius)
            best = gain
    if _may_change(problem.asked):
        far = best + _BETTER if told else best
        told = _by_speed(found, far, problem.noise[0]) or told
    return told


def _may_change(asked: Asked) -> bool:
    """Whether nothing was asked that goes with no friction over slip speed."""
    named = {"drag", "inner", "decel", "gravity"} & {*asked.free, *asked.fixed}
    uniform = asked.puck.body.law.name == "uniform"
    return uniform and not named and not asked.speeds and "friction" in asked.free


def _by_speed(found: Estimate, best: float, noise: float) -> str:
    """A sentence on a friction over slip speed, if that fits far better than ``best``."""
    try:
        other = tried(found)
    except InputError:  # hardly any friction, at no speed
        return ""
    gain = _size(found, 1.0) - _size(other, 1.0)
    if not (gain > best and _fits(other, noise)):
        return ""
    asked, numbers = other.problem.asked, other.problem.found(other.x)
    speeds = asked.speeds
    values = [numbers[name] for name in NODES[: len(speeds)]]
    usual = found.problem.found(found.x)["friction"]
    if max(values) > _MOST * usual or min(values) < _LEAST * usual:  # such a law fits noise
        return ""
    told = ", ".join(f"{f:.2g} at {u:g} m/s" for u, f in zip(speeds, values, strict=True))
    return (
        f"Residuals would be {math.exp(gain):.2g} times smaller with a friction over slip speed "
        f"({told}): find it (--slip-speeds {','.join(f'{u:g}' for u in speeds)})"
    )


def _others(problem: Problem) -> Iterator[tuple[str, Problem, float]]:
    """Other readings, each in words and with the factor of its angles."""
    asked = problem.asked
    angled = any(film.angle is not None for film in problem.films)
    if angled and not any(name in given for name in _HELD for given in (asked.fixed, asked.bounds)):
        for factor, words in _ANGLES:
            films = tuple(
                film if film.angle is None else replace(film, angle=factor * film.angle)
                for film in problem.films
            )
            noise = problem.noise[0], abs(factor) * problem.noise[1]
            yield words, replace(problem.with_films(films), noise=noise), abs(factor)
    if angled and "radius" not in (*asked.free, *asked.fixed):  # told by angles alone
        words = "with a radius of {:.3g} m: is " + f"{asked.puck.radius:g} m right?"
        wider = replace(asked, free=(*asked.free, "radius"))
        yield words, replace(problem, asked=wider), 1.0
    if _may_change(asked):
        # from a speed e^20 times as slow, or as fast, at the end nothing is told any more
        most = _MOST_DRAG / max(float(film.time[-1]) for film in problem.films)
        bounds = {**asked.bounds, "drag": (-most, most)}
        dragged = replace(asked, free=(*asked.free, "drag"), bounds=bounds)
        free = ",".join(dragged.free)
        words = f"{_DRAG}: find it, too (--free {free})"
        yield words, replace(problem, asked=dragged), 1.0


def _size(found: Estimate, scale: float) -> float:
    """The logarithm of the usual size of residuals, that of angles in units of ``scale``.

    Angles that nothing explains are as far off in any unit.
    """
    places, angles = _off(found)
    if angles.size and float(np.median(angles)) < _BY_CHANCE:
        angles = angles / scale
    sizes = [size for size in (places, angles) if size.size]
    usual = [math.log(max(float(np.median(size)), 1e-300)) for size in sizes]
    return float(np.average(usual, weights=[size.size for size in sizes]))


def _fits(tried: Estimate, noise: float) -> bool:
    """Whether places are about as far off as their noise, and angles are explained."""
    places, angles = _off(tried)
    told = not angles.size or float(np.median(angles)) < _BY_CHANCE
    return told and float(np.median(places)) < _AS_NOISE * noise


def _off(found: Estimate) -> tuple[FloatArray, FloatArray]:
    """How far places (m) and angles (rad) are off."""
    films, off = found.problem.films, found.problem.off(found.x)
    angles = [np.empty(0)] + [
        np.abs(one[TURN, np.isfinite(film.angle)]) for film, one in zip(films, off, strict=True)
        if film.angle is not None
    ]  # fmt: skip
    return np.concatenate([np.hypot(*one[:TURN]) for one in off]), np.concatenate(angles)
