"""Whole turns from frame to frame: what angles alone do not tell.

A body that turns k times more between two frames looks the same.  What its path and its slowing say
of k counts, and what is usual: a spin is taken as less than half a turn a frame unless that is
excluded by far.  Where a puck turns so fast, in so few frames, that angles cannot be followed from
frame to frame, the path is fitted first: it says about how the puck turns, and of the ways in which
it may turn within the errors of that, those are followed that meet the angles.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.least_squares import minimise_robustly
from puck_tables.fitting.observations import MEDIAN, Observations
from puck_tables.fitting.problem import ANGLE, PLACE, TURN, Problem

EXCLUDED = 25.0  # of χ²: a spin of less than half a turn a frame
MISFIT, LESS = 1.5, 5.0  # residuals over the noise that are none, and how many times less count
_FARTHEST = 16.0  # of the square of a residual
_DIRECTIONS, _CERTAIN, _WIDE = 3, 0.3, 3.5  # phases; rad that need no search; standard deviations
_STEP, _MOST = 0.8, 2e6  # rad; phases of frames that are looked at
_LOST = 1e4  # rad: places tell nothing of how it turns
_FOLLOWED = 12  # starts of a search that agree best
_LITTLE_DRAG, _MOST_DRAG = 0.01, 10.0  # 1/s


class Judged(NamedTuple):
    """A motion: whether it turns less than half a turn a frame, χ², and residuals over noise."""

    slow: bool
    chi2: float
    size: float


def half_turns(film: Observations) -> float:
    """The spin of half a turn a frame, rad/s, infinite of a track without angles."""
    return math.inf if film.angle is None else math.pi / film.usual_step


def is_slow(problem: Problem, x: FloatArray) -> bool:
    """Whether no body with angles turns more than half a turn from frame to frame."""
    spins = np.abs(problem.launches(x)[:, 4])
    return all(spin <= half_turns(film) for spin, film in zip(spins, problem.films, strict=True))


def preferred(motions: list[Judged]) -> int:
    """Which motion is taken: a slow one unless that is excluded by far.

    Where none fits, χ² of a wrong model says little: a faster spin has to fit by far better.

    >>> slow, fast = Judged(True, 130.0, 1.0), Judged(False, 110.0, 1.0)
    >>> preferred([fast, slow]), preferred([fast, slow._replace(chi2=150.0)])
    (1, 0)
    >>> preferred([Judged(False, 5000.0, 7.0), Judged(True, 9000.0, 9.0)])
    1
    """
    best = min(range(len(motions)), key=lambda k: motions[k].chi2)
    slow = [k for k in range(len(motions)) if motions[k].slow]
    if not slow:
        return best
    slowest = min(slow, key=lambda k: motions[k].chi2)
    one, other = motions[slowest], motions[best]
    near = one.chi2 - other.chi2 <= EXCLUDED
    poor = other.size > MISFIT and one.size < LESS * other.size
    return slowest if near or poor else best


def on_another_floor(problem: Problem, x: FloatArray) -> tuple[Problem, FloatArray] | None:
    """The motion on a floor with drag besides friction, if that may be and is not asked for.

    Where such a slow motion fits as well as a fast one it is the floor that is another.
    """
    spec = problem.spec
    if spec.speeds or "drag" in spec.free or "drag" in spec.fixed:
        return None
    bounds = {**spec.bounds, "drag": (0.0, _MOST_DRAG)}
    other = replace(spec, free=(*spec.free, "drag"), bounds=bounds)
    return replace(problem, spec=other, weights=()), np.insert(x, len(spec.free), _LITTLE_DRAG)


def in_order(problem: Problem, minima: list[FloatArray]) -> list[FloatArray]:
    """Minima of one track, the one that is taken first, then by χ².

    Where residuals of the deepest say that the noise is larger than it was taken to be, it is.
    """
    rows = [problem.residuals(x) for x in minima]
    slow = [is_slow(problem, x) for x in minima]
    first, chi2 = _judged(problem, rows, slow)
    if not slow[first] and any(slow):
        x = min((k for k in range(len(minima)) if slow[k]), key=lambda k: chi2[k])
        other = on_another_floor(problem, minima[x])
        if other is not None:
            there, _ = minimise_robustly(*other)
            dragged = rows.copy()
            dragged[x] = other[0].residuals(there)
            if slow[_judged(problem, dragged, slow)[0]] and is_slow(other[0], there):
                first = x
    order = sorted(range(len(minima)), key=lambda k: (k != first, chi2[k]))
    return [minima[k] for k in order]


def _judged(
    problem: Problem, rows: list[FloatArray], slow: list[bool]
) -> tuple[int, list[float]]:  # fmt: skip
    """Which motion is taken, and χ² of each, from the residuals of each."""
    scale, errors = np.ones((len(rows), problem.kinds.size)), np.ones((len(rows), 2))
    for kind in (PLACE, ANGLE):
        mine = problem.kinds == kind
        if mine.any():
            share = max(1.0 - 0.5 * len(problem.names) / mine.sum(), 0.1)
            errors[:, kind] = [float(np.median(np.abs(one[mine]))) / MEDIAN / share for one in rows]
            scale[:, mine] = np.maximum(1.0, errors[:, kind, None])
    best = int(np.argmin([float(np.minimum(one**2, _FARTHEST).sum()) for one in rows]))
    chi2 = [float(np.minimum((one / scale[best]) ** 2, _FARTHEST).sum()) for one in rows]
    sizes = errors.max(axis=1).tolist()
    return preferred([Judged(*one) for one in zip(slow, chi2, sizes, strict=True)]), chi2


def by_place(problem: Problem, blind: Problem, minima: list[FloatArray]) -> list[
    tuple[Problem, FloatArray]
]:  # fmt: skip
    """Starts of a track from motions that its places allow and that meet its angles.

    ``blind``: the same problem without angles; ``minima``: its unknowns.
    """
    (film,) = problem.films
    assert film.angle is not None
    seen = np.isfinite(film.angle)
    starts = []
    for x in minima:
        whole = problem.unknowns(blind.numbers_at(x), blind.launches(x))
        moved = np.array([k for k, one in enumerate(problem.names) if one in blind.names])
        # of unknowns that places alone tell, no wider than what may be
        rows, jacobian = blind.residuals_and_jacobian(x)
        _, _, vx, vy, spin, _ = blind.launches(x)[0].tolist()
        rim = math.hypot(vx, vy) / blind.spec.scales(blind.numbers_at(x))[2]
        wide = {"launch_spin": max(abs(spin), rim), "delta": 1.0}
        least = 1e-3 * (film.time[-1] or 1.0)
        sizes = np.array([wide.get(name, max(abs(value), least))
                          for (_, name), value in zip(blind.names, x, strict=True)])  # fmt: skip
        excess = max(1.0, float(rows @ rows) / max(rows.size - x.size, 1))
        square = (jacobian * sizes).T @ (jacobian * sizes) / excess + np.eye(sizes.size)
        covariance = np.linalg.inv(square) * np.outer(sizes, sizes)
        slopes = problem.jacobian(whole)[problem.kinds == ANGLE][:, moved] * problem.noise[1]
        slopes = slopes - slopes.mean(axis=0)  # where it begins is free
        variances, axes = np.linalg.eigh(slopes @ covariance @ slopes.T)
        order = np.argsort(-variances)[:_DIRECTIONS]
        spreads, axes = np.sqrt(np.maximum(variances[order], 0.0)), axes[:, order]
        swings = spreads * np.abs(axes).max(axis=0)
        counts = [1 + 2 * math.ceil(_WIDE * one / _STEP) if one > _CERTAIN else 1 for one in swings]
        if not np.isfinite(swings).all() or swings.max() > _LOST:
            continue
        fewer = (math.prod(counts) * seen.sum() / _MOST) ** (1.0 / _DIRECTIONS)
        counts = [math.ceil(n / max(fewer, 1.0)) for n in counts]
        sides = [np.linspace(-_WIDE, _WIDE, n) if n > 1 else np.zeros(1) for n in counts]
        grid = np.array(list(product(*sides)))
        path = problem.paths(whole)[0][TURN, seen]
        deviations = np.exp(1j * (film.angle[seen] - path))
        together = np.exp(-1j * (grid * spreads) @ axes.T) @ deviations / deviations.size
        for k in np.argsort(-np.abs(together))[:_FOLLOWED]:
            change = axes @ (grid[k] * np.divide(1.0, spreads, where=spreads > 0.0,
                                                 out=np.zeros_like(spreads)))  # fmt: skip
            one = whole.copy()
            one[moved] += covariance @ slopes.T @ change
            turned = path + axes @ (grid[k] * spreads) + np.angle(together[k])
            angle = np.full(film.time.size, np.nan)
            angle[seen] = film.angle[seen]
            angle[seen] += 2.0 * math.pi * np.round((turned - angle[seen]) / (2.0 * math.pi))
            one[problem.names.index((0, "launch_angle"))] = np.angle(together[k]) \
                if (0, "launch_angle") in problem.names else 0.0  # fmt: skip
            starts.append((replace(problem, whole=(angle,)), np.clip(one, *problem.limits)))
    return starts
