"""The estimate of tracks, from starts that the tracks themselves suggest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import certainty_of
from puck_tables.fitting.estimate import Estimate, estimate, only_outliers
from puck_tables.fitting.free_motion import is_clean, trimmed, without_ends
from puck_tables.fitting.numbers import plausible_for
from puck_tables.fitting.problem import ANGLE, Problem
from puck_tables.fitting.residual_tests import NO_PATTERN, NOISY
from puck_tables.fitting.starts import minima_of
from puck_tables.fitting.timing import Known

_LIFTS = 0.995  # δ from which on a uniform puck is fitted with part of its base lifted
_TRIMS = 3
_JUDGED = 10  # degrees of freedom that tell the noise


def initial_estimate(problem: Problem, known: Known, refit: bool) -> Estimate:
    """The estimate of a problem, from starts of its own.

    Parameters
    ----------
    problem : Problem
    known : whether the noise of places, of angles and of time stamps is
    refit : whether frames at the ends that are no free motion are left out
    """
    problem = _with_room(problem)
    left = _observations(problem) - len(problem.names) + len(problem.priors)
    if left <= 0:
        raise InputError(
            f"{_observations(problem)} observations cannot tell {len(problem.names)} unknowns: "
            "give more frames, or fix something"
        )
    angled = any(film.angle is not None for film in problem.films)
    if left < _JUDGED and not (known.place and (known.angle or not angled)):
        raise InputError(
            f"{_observations(problem)} observations of {len(problem.names)} unknowns are too few "
            "to judge their noise by: give the noise, or more frames"
        )
    rests = problem.rests or (False,) * len(problem.films)
    parts = [
        replace(problem, films=(film,), rests=(rest,), jitter=0.0)
        for film, rest in zip(problem.films, rests, strict=True)
    ]
    minima = [minima_of(part) for part in parts]
    result = estimate(problem, _joint_start(problem, parts, minima), known)
    if len(parts) == 1:
        result = replace(result, minima=tuple(minima[0]))
    result = _lifted(result, known)
    if not refit:
        return result
    result = _trimmed(result, problem, known)
    if len(parts) == 1 and not is_clean(result, NOISY, NO_PATTERN):
        result = _of_a_part(problem, known) or result
    if only_outliers(result):
        return result
    # frames that are off together are good ones: what the model cannot follow is not hidden
    return replace(estimate(result.problem, result.x, known, strict=True), minima=result.minima)


def _with_room(problem: Problem) -> Problem:
    """The same, of pucks so tall as the bounds of δ want them.

    Raises
    ------
    InputError
        If no value within bounds is one of which motions are known.
    """
    low, high = problem.limits
    narrow = np.flatnonzero(low >= high)
    if not narrow.size:
        return problem
    k = int(narrow[0])
    name = problem.names[k][1]
    law = problem.spec.puck.body.law
    if name == "delta" and law.can_lift and not problem.tall:
        return _with_room(replace(problem, tall=True))
    least, most = problem.spec.bounds[name]
    low, high = replace(problem, spec=replace(problem.spec, bounds={})).limits
    raise InputError(
        f"the bounds of {name}, {least:g} to {most:g}, hold none of its values: of such a puck "
        f"under pressure {law.name} {name} is from {low[k]:g} to {high[k]:g}"
    )


def _trimmed(result: Estimate, problem: Problem, known: Known) -> Estimate:
    """The same without frames at the ends that are no free motion, the smaller part of each track.

    What they did to the fit may have hidden more of them.
    """
    for _ in range(_TRIMS):
        films = trimmed(result, problem.films)
        lost = (2 * part.time.size < film.time.size
                for part, film in zip(films, problem.films, strict=True))  # fmt: skip
        if films == result.problem.films or any(lost):
            break
        result = initial_estimate(problem.with_films(films), known, refit=False)
    return result


def _of_a_part(problem: Problem, known: Known) -> Estimate | None:
    """The estimate of a track without a hand or a wall at its end; None if that is not the matter.

    They may lead the fit of all frames so far away that none of these is seen to be foreign.
    """
    for part in without_ends(problem.films[0]):
        result = initial_estimate(problem.with_films((part,)), known, refit=False)
        result = _trimmed(result, problem, known)
        if is_clean(result):
            return result
    return None


def _lifted(result: Estimate, known: Known) -> Estimate:
    """The same with part of the base lifted, where δ seems to be above that of full contact."""
    problem = result.problem
    law = problem.spec.puck.body.law
    delta = problem.spec.scales(problem.numbers_at(result.x))[1]
    if problem.tall or not law.can_lift or delta < _LIFTS:
        return result
    certainty = certainty_of(result.jacobian[result.kept], plausible_for(problem, result.x))
    if certainty.undetermined[: len(problem.spec.free)].count(True):
        return result
    return estimate(replace(problem, tall=True), result.x, known)


def _joint_start(
    problem: Problem, parts: list[Problem], minima: list[list[FloatArray]]
) -> FloatArray:
    """The unknowns of all tracks from those of each: what is shared is their weighted mean."""
    if len(parts) == 1:
        return minima[0][0]
    shared = len(problem.spec.free)
    weights, sums, launches = np.zeros((shared, shared)), np.zeros(shared), []
    for part, (x, *_) in zip(parts, minima, strict=True):
        launches.append(part.launches(x)[0])
        if part.rests[0]:  # it tells nothing of what moves
            continue
        spread = certainty_of(part.jacobian(x), plausible_for(part, x)).covariance
        if shared:
            weight = np.linalg.pinv(spread[:shared, :shared])
            weights += weight
            sums += weight @ x[:shared]
    mean = np.linalg.solve(weights, sums) if shared else sums
    mean = np.clip(mean, *(ends[:shared] for ends in problem.limits))
    return problem.unknowns(
        dict(zip(problem.spec.free, mean.tolist(), strict=True)), np.array(launches)
    )


def _observations(problem: Problem) -> int:
    return int((problem.kinds <= ANGLE).sum())
