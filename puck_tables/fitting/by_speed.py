"""From one friction coefficient to one over slip speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate, estimate
from puck_tables.fitting.least_squares import LOOSE, minimise
from puck_tables.fitting.parameters import NODES
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.timing import Known
from puck_tables.fitting.turns import on_another_floor

_FRAMES = 80  # that tell whether such a law may be the reason of a misfit
_LEAST = 0.02  # of the largest friction of a line: the smallest
_SHARES = (0.0, 0.08, 0.3, 1.0)  # of the fastest slip


def over_speeds(found: Estimate, speeds: tuple[float, ...], between: str, known: Known) -> Estimate:
    """The estimate with a friction coefficient for each slip speed, from that of one for all."""
    moved, start = _begun(found.problem, found.x, speeds)
    lines, _ = minimise(moved, start, LOOSE)
    asked = replace(moved.asked, between=between)
    return estimate(replace(moved, asked=asked), lines, known)


def tried(found: Estimate) -> Estimate:
    """About what a law over slip speed leaves of the frames of an estimate."""
    problem = found.problem
    films = []
    for film in problem.films:
        few = np.zeros(film.time.size, bool)
        few[np.linspace(0, film.time.size - 1, _FRAMES).astype(int)] = True
        films.append(film.part(few))
    radius = problem.asked.scales(problem.found(found.x))[2]
    _, _, vx, vy, spin, _ = problem.launches(found.x).T
    top = float((np.hypot(vx, vy) + radius * np.abs(spin)).max())
    speeds = tuple(float(f"{1.1 * top * share:.2g}") for share in _SHARES)
    fewer = problem.with_films(tuple(films))
    moved, start = _begun(fewer, found.x, speeds)
    lines, _ = minimise(moved, start, LOOSE)
    smooth = replace(moved, asked=replace(moved.asked, between="cubic"))
    x, _ = minimise(smooth, lines, LOOSE)
    return replace(found, problem=smooth, x=x, minima=())


def _begun(
    problem: Problem, x: FloatArray, speeds: tuple[float, ...]
) -> tuple[Problem, FloatArray]:
    """A problem of lines between slip speeds, with the friction of an estimate at each.

    Where drag besides friction is nearer to the tracks, which is a line, it is that of the line.
    Where f is the same at all speeds the slopes of a cubic jump: lines lead away from there.
    """
    asked = problem.asked.over(speeds, "linear")
    numbers, launches = problem.found(x), problem.launches(x)
    numbers.update({name: numbers["friction"] for name in asked.free if name in NODES})
    moved = replace(problem, asked=asked, weights=(), tall=False)
    start = moved.unknowns(numbers, launches, problem.found_walls(x))
    line = None if problem.meetings else on_another_floor(problem, x)
    if line is None:
        return moved, start
    there, _ = minimise(*line, LOOSE)
    found, gravity = line[0].found(there), problem.asked.known()["gravity"]
    values = found["friction"] + found["drag"] / gravity * np.array(speeds)
    values = np.maximum(values, _LEAST * values.max())
    numbers.update(dict(zip(NODES, values.tolist(), strict=False)))
    if "delta" in numbers:  # of the same height
        numbers["delta"] = min(numbers["delta"] * values[0] / numbers["friction"], 1.0)
    other = moved.unknowns(numbers, line[0].launches(there))
    near = [float((moved.residuals(one) ** 2).sum()) for one in (start, other)]
    return moved, other if near[1] < near[0] else start


def law_over(
    found: Estimate, covariance: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The friction coefficient at slip speeds (n,) m/s, and its standard errors (n,)."""
    asked, numbers = found.problem.asked, found.problem.found(found.x)
    count = len(asked.speeds)
    slopes = np.zeros((at.size, count))
    for k, name in enumerate(asked.free[:count]):
        step = 1e-4 * numbers[name]
        ends = [asked.speed_law({**numbers, name: numbers[name] + by})(at) for by in (step, -step)]
        slopes[:, k] = (ends[0] - ends[1]) / (2.0 * step)
    spread = np.einsum("ni,ik,nk->n", slopes, covariance[:count, :count], slopes)
    return np.asarray(asked.speed_law(numbers)(at)), np.sqrt(spread)
