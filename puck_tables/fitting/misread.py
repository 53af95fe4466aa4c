"""What may have been said wrongly of tracks that do not fit: their angles, or the radius.

Each is tried out: where residuals then are far smaller, about as noise is, that is told.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fitted import fitted
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
            tried = fitted(other, known, refit=False)
        except InputError:  # such a puck, or such a track, there is not
            continue
        gain = _size(found, 1.0) - _size(tried, scale)
        radius = tried.problem.asked.scales(tried.problem.found(tried.x))[2]
        same = other.films is problem.films and abs(radius / given - 1.0) < _NEAR
        if gain > best and not same and _fits(tried, problem.noise[0]):
            told = f"Residuals would be {math.exp(gain):.2g} times smaller " + words.format(radius)
            best = gain
    return told


def _others(problem: Problem) -> Iterator[tuple[str, Problem, float]]:
    """Other readings, each in words and with the factor of its angles."""
    asked = problem.asked
    if all(film.angle is None for film in problem.films):  # the radius is told by angles alone
        return
    if not any(name in given for name in _HELD for given in (asked.fixed, asked.bounds)):
        for factor, words in _ANGLES:
            films = tuple(
                film if film.angle is None else replace(film, angle=factor * film.angle)
                for film in problem.films
            )
            noise = problem.noise[0], abs(factor) * problem.noise[1]
            yield words, replace(problem.with_films(films), noise=noise), abs(factor)
    if "radius" not in (*asked.free, *asked.fixed):
        words = "with a radius of {:.3g} m: is " + f"{asked.puck.radius:g} m right?"
        wider = replace(asked, free=(*asked.free, "radius"))
        yield words, replace(problem, asked=wider), 1.0


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
    angles = [
        np.abs(one[TURN, np.isfinite(film.angle)]) for film, one in zip(films, off, strict=True)
        if film.angle is not None
    ]  # fmt: skip
    return np.concatenate([np.hypot(*one[:TURN]) for one in off]), np.concatenate(angles)
