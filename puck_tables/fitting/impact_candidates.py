"""Motions of slides apart that joined slides may have begun with.

Without angles a slide tells its spin by how it slows and bends: each friction has spins of its own,
of either sign where the path hardly bends, and what the law of impact makes of them differs.  So
frictions and tilts are tried in turn; with both held every slide is a problem of its own, and the
few spins that suit it are found.  The ways are all that slides and spins may go together, those
first in which the slides fit best.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.multi_start import ROBUST, multi_start
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.starts import numbers_with

_DECELS = (0.5, 0.62, 0.77, 1.0, 1.3, 1.65)  # times the one that was found
_DELTAS = (0.05, 0.2, 0.5)
_RATIOS = (0.2, 0.8, 2.0)  # rω/v, of either sign
_MODERATE = 4.0
_STEPS = ((2, 4), (8, 3))  # and how many spins then go on
_FRAMES = 40
_CLOSE = 60.0  # what another spin of a slide may cost more
_ALIKE = 0.15  # of v/r: spins so near are one
_EACH = 6  # ways of one friction
_LEAST_SPEED = 1e-6

Option = tuple[float, FloatArray]


def candidates_of(slides: Estimate) -> list[FloatArray]:
    """Unknowns of slides apart, those that were found first.

    Where all slides have angles there are no others.
    """
    problem = slides.problem
    if all(film.angle is not None for film in problem.films):
        return [slides.x]
    spec, numbers = problem.spec, problem.numbers_at(slides.x)
    decel, delta, _ = spec.scales(numbers)
    decels = [decel * one for one in _DECELS] \
        if {"friction", "decel", "gravity"} & {*spec.free} else [decel]  # fmt: skip
    deltas = _DELTAS if {"delta", "height"} & {*spec.free} else (delta,)
    low, high = (ends[: len(spec.free)] for ends in problem.limits)
    ranked: list[tuple[float, FloatArray]] = []
    for one in decels:
        mine: list[tuple[float, FloatArray]] = []
        for tilt in deltas:
            result = {**numbers, **numbers_with(spec, one, tilt)}
            values = np.clip([result[name] for name in spec.free], low, high).tolist()
            result = dict(zip(spec.free, values, strict=True))
            options = [_spins_of(slides, n, result) for n in range(len(problem.films))]
            for chosen in product(*options):
                launches = np.array([launch for _, launch in chosen])
                cost = sum(cost for cost, _ in chosen)
                mine.append((cost, problem.unknowns(result, launches)))
        ranked += sorted(mine, key=lambda option: option[0])[:_EACH]
    ranked.sort(key=lambda option: option[0])
    return [slides.x, *(x for _, x in ranked)]


def _spins_of(slides: Estimate, n: int, result: dict[str, float]) -> list[Option]:
    """Launches of a slide, with what they cost, for numbers of the puck that are held."""
    problem = slides.problem
    launch = problem.launches(slides.x)[n]
    film = problem.films[n]
    if film.angle is not None or problem.spinless[n] or (problem.rests and problem.rests[n]):
        return [(0.0, launch)]
    radius = problem.spec.scales(result)[2]
    speed = max(math.hypot(launch[2], launch[3]), _LEAST_SPEED)
    # of few frames no spin but an absurd one is seen
    moderate = {"launch_spin": (0.0, _MODERATE * speed / radius)}
    fixed, priors = {**problem.spec.fixed, **result}, {**moderate, **problem.spec.priors}
    held = replace(problem.spec, free=(), fixed=fixed, priors=priors)
    few = np.zeros(film.time.size, bool)
    few[np.linspace(0, film.time.size - 1, _FRAMES).astype(int)] = True
    alone = Problem(held, (film.part(few),), problem.noise, problem.tall)
    starts = []
    for ratio, sign in product(_RATIOS, (1.0, -1.0)):
        other = launch.copy()
        other[4] = held.fixed.get("launch_spin", sign * ratio * speed / radius)
        starts.append((alone, alone.unknowns({}, other[None])))
    walked = multi_start(starts, _STEPS, ROBUST)
    options: list[Option] = []
    for x, cost in walked:
        one = alone.launches(x)[0]
        new = all(abs(one[4] - other[4]) > _ALIKE * speed / radius for _, other in options)
        if cost < walked[0][1] + _CLOSE and new:
            options.append((cost, one))
    return options
