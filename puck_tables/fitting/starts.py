"""Values to begin with, from the track itself.

A fit of nonlinear motions finds the nearest minimum, so it is begun near the deepest:

1. a robust parabola through the first frames gives the launch place and velocity;
2. angles from frame to frame give the spin, up to whole turns from frame to frame; a puck that
   comes to rest says how many, others are tried; without angles a range of spins is;
3. for each spin and a few δ, motions with a range of J are laid beside places and rates of turning;
4. the best are fitted to places and to the angles in one piece, abreast: all take the same few
   steps, then the worse half is left behind, and so on; the best of the last is taken.

A body that turns k times more between two frames looks the same: less than half a turn is usual,
and taken unless that is excluded by far.  Of a puck that turns too fast for so few frames the path
is fitted first: of the motions within its errors those are followed that meet the angles.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.fit_spec import LAUNCH, FitSpec
from puck_tables.fitting.forward_model import DELTA
from puck_tables.fitting.observations import (
    MEDIAN,
    Observations,
    Turning,
    rests_from,
    robust_parabola,
    turning_of,
)
from puck_tables.fitting.problem import (
    ANGLE,
    FROM_AFAR,
    PLACE,
    ROBUST,
    TURN,
    Problem,
    Start,
    minimise_robustly,
    multi_start,
)
from puck_tables.fitting.slowing import on_another_floor

EXCLUDED = 25.0  # of χ²: a spin of less than half a turn a frame
MISFIT, LESS = 1.5, 5.0  # residuals over the noise that are none, and how many times less count
_FARTHEST = 16.0  # of the square of a residual
_DIRECTIONS, _CERTAIN, _WIDE = 3, 0.3, 3.5  # phases; rad that need no search; standard deviations
_STEP, _MOST = 0.8, 2e6  # rad; phases of frames that are looked at
_LOST = 1e4  # rad: places tell nothing of how it turns
_FOLLOWED = 12  # starts of a search that agree best


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


def _judged(problem: Problem, rows: list[FloatArray], slow: list[bool]) -> tuple[int, list[float]]:
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


def by_place(problem: Problem, blind: Problem, minima: list[FloatArray]) -> list[Start]:
    """Starts of a track from motions that its places allow and that meet its angles.

    ``blind``: the same problem without angles; ``minima``: its unknowns.
    """
    (film,) = problem.films
    seen = np.isfinite(film.angles)
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
        slopes = problem.residuals_and_jacobian(whole)[1][problem.kinds == ANGLE][:, moved]
        slopes = slopes * problem.noise[1]
        slopes = slopes - slopes.mean(axis=0)  # where it begins is free
        variances, axes = np.linalg.eigh(slopes @ covariance @ slopes.T)
        order = np.argsort(-variances)[:_DIRECTIONS]
        spreads, axes = np.sqrt(np.maximum(variances[order], 0.0)), axes[:, order]
        swings = spreads * np.abs(axes).max(axis=0)
        if not swings.max() <= _LOST:
            continue
        counts = [1 + 2 * math.ceil(_WIDE * one / _STEP) if one > _CERTAIN else 1 for one in swings]
        fewer = (math.prod(counts) * seen.sum() / _MOST) ** (1.0 / _DIRECTIONS)
        counts = [math.ceil(n / max(fewer, 1.0)) for n in counts]
        sides = [np.linspace(-_WIDE, _WIDE, n) if n > 1 else np.zeros(1) for n in counts]
        grid = np.array(list(product(*sides)))
        path = problem.paths(whole)[0][TURN, seen]
        deviations = np.exp(1j * (film.angles[seen] - path))
        together = np.exp(-1j * (grid * spreads) @ axes.T) @ deviations / deviations.size
        for k in np.argsort(-np.abs(together))[:_FOLLOWED]:
            change = axes @ (grid[k] * np.divide(1.0, spreads, where=spreads > 0.0,
                                                 out=np.zeros_like(spreads)))  # fmt: skip
            one = whole.copy()
            one[moved] += covariance @ slopes.T @ change
            turned = path + axes @ (grid[k] * spreads) + np.angle(together[k])
            angle = film.angles.copy()
            angle[seen] += 2.0 * math.pi * np.round((turned - angle[seen]) / (2.0 * math.pi))
            if (0, "launch_angle") in problem.spots:
                one[problem.spots[0, "launch_angle"]] = np.angle(together[k])
            starts.append((replace(problem, whole=(angle,)), np.clip(one, *problem.limits)))
    return starts


_SHARE, _FEW = 0.25, 6  # of the moving frames, and at least: the parabola
_MOST_TURNS = 3  # whole turns more from frame to frame, to either side
_HEIGHTS = (0.05, 0.2, 0.5, 0.9)  # δ to begin from, all of full contact
# rω/v tried where no angle is seen
_RATIOS = (0.0, 0.15, 0.3, 0.5, 0.75, 1.1, 1.6, 2.3, 3.5, 6.0, 12.0)
_DECELS = 2.0 ** np.arange(-3.0, 3.1, 0.5)  # times the one that fits the loss of speed
_FRAMES = 24  # laid beside each other
_FEW_FRAMES = 60  # frames to which the guesses are fitted
_KEPT, _KEPT_BLIND = 9, 22  # guesses that are fitted; of tracks without angles
_WORSE = 15.0  # what minima that are compared on all frames may cost more
_BLIND = 4  # motions that places alone allow
_NEARER = 2.0 ** np.arange(-0.4, 0.41, 0.05)  # times the best of these: their gap, finer
_PLACE_SHARE, _FINER_SHARE, _RATE_SHARE = 0.02, 0.005, 0.05
_LEAST_SPEED = 1e-6  # m/s, that is divided by


class _Guess(NamedTuple):
    """A start: what moves the puck, its spin, and the angles in one piece."""

    decel: float
    delta: float
    spin: float
    turns: int
    score: float


def minima_of(problem: Problem) -> list[FloatArray]:
    """The unknowns at the deepest minima of a problem of one track, the deepest first."""
    problem = replace(problem, weights=())
    film, spec = problem.films[0], problem.spec
    if problem.rests and problem.rests[0]:  # it lies still
        launch = np.array([*np.median(film.place, axis=0), 0.0, 0.0, 0.0, 0.0])
        if film.angle is not None:
            launch[5] = np.angle(np.nanmean(np.exp(1j * film.angle)))
        return [problem.unknowns(spec.begun(), launch[None])]
    place, velocity, slowing, moving = _first_parabola(film, problem.noise[0])
    turning = turning_of(film)
    # on a base from those of a round puck that reaches as far, of less than half a turn a frame
    like = replace(problem, spec=replace(spec, base=None))
    guesses = _guesses(like, velocity, slowing, turning, rests=moving < film.time.size)
    if spec.base is not None:
        guesses = [guess for guess in guesses if guess.turns == 0]
        if not guesses:
            raise InputError(
                f"{film.name} would turn by half a turn a frame and more, which is not followed on "
                "a base: is the unit of its angles right, and launch_spin, if it is held?"
            )
    part = film.thinned(_FEW_FRAMES)
    few = np.isin(film.frame, part.frame)
    starts = []
    for guess in guesses:
        launch = np.array([*place, *velocity, guess.spin, 0.0])
        whole = None
        if turning is not None:
            whole = turning.with_more(guess.turns, film.time)[1]
            launch[5] = whole[np.isfinite(whole)][0]
            whole = whole[few]
        pieces = replace(problem, films=(part,), whole=(whole,))
        result = {**spec.begun(), **spec.with_scales(guess.decel, guess.delta)}
        starts.append((pieces, pieces.unknowns(result, launch[None])))
    more: list[FloatArray] = []
    if spec.start:  # where the caller wants to begin
        angle = 0.0 if film.angle is None else film.angle[np.isfinite(film.angle)][0]
        begun = dict(zip(LAUNCH, (*place, *velocity, 0.0, angle), strict=True)) | {**spec.start}
        launch = np.array([begun[name] for name in LAUNCH])
        more = [np.clip(problem.unknowns(spec.begun(), launch[None]), *problem.limits)]
    if turning is not None and not turning.sure and spec.base is None:
        blind = replace(problem, films=(replace(film, angle=None),))
        by_angle = by_place(problem, blind, minima_of(blind)[:_BLIND])
        more += [x for x, _ in multi_start(by_angle, FROM_AFAR, ROBUST)]
    return _deepest(problem, multi_start(starts, FROM_AFAR, ROBUST, _WORSE), more)


def _deepest(
    problem: Problem, minima: list[tuple[FloatArray, float]], more: list[FloatArray]
) -> list[FloatArray]:
    """Of minima for some of the frames, and ``more``, those that are deepest for all, in order.

    Spins of less than half a turn from frame to frame come first unless they are excluded.
    """
    x, least = minima[0]
    deepest = [x, *(other for other, cost in minima[1:] if cost < least + _WORSE), *more]
    marked = problem.films[0].angle is not None
    if marked and "launch_spin" not in problem.spec.fixed:
        spin = problem.names.index((0, "launch_spin"))
        half = half_turns(problem.films[0])
        if abs(x[spin]) > half:
            deepest.append(x.copy())
            deepest[-1][spin] = math.remainder(x[spin], 2.0 * half)
    if len(deepest) == 1:
        return deepest
    polished = sorted((minimise_robustly(problem, one) for one in deepest), key=lambda one: one[1])
    result = [one for one, _ in polished]
    return in_order(problem, result) if marked else result


def slowing_of(film: Observations, spread: float) -> float:
    """About how fast a puck slows down while it moves, m/s²; ``spread`` m: of its places.

    >>> t = np.arange(40.0) / 100.0
    >>> place = np.stack([t - 0.5 * t * t, 0.0 * t], axis=1)
    >>> round(slowing_of(Observations("a", 0.0, t, place, None, np.arange(40)), 1e-6), 6)
    1.0
    """
    return _first_parabola(film, spread)[2]


def _first_parabola(film: Observations, spread: float) -> tuple[FloatArray, FloatArray, float, int]:
    """Place, velocity at the start, deceleration along it over the run, m/s²; frames it moves."""
    moving = max(rests_from(film, spread), min(_FEW, film.time.size))
    first = robust_parabola(film.time, film.place, 0, min(max(_FEW, int(_SHARE * moving)), moving))
    last = robust_parabola(film.time, film.place, max(0, moving - max(_FEW, moving // 4)), moving)
    span = float(film.time[moving - 1])
    end = last[1] + 2.0 * last[2] * span
    speed = math.hypot(*first[1])
    slowing = (speed - math.hypot(*end)) / span if span > 0.0 else 0.0
    return first[0], first[1], max(slowing, 0.02 * speed / max(span, 1e-300), 1e-9), moving


def _guesses(
    problem: Problem, velocity: FloatArray, slowing: float, turning: Turning | None, rests: bool
) -> list[_Guess]:
    """The motions that lie nearest to the track, of different spins or heights."""
    spec, film = problem.spec, problem.films[0]
    speed, radius = math.hypot(*velocity), spec.scales(spec.begun())[2]
    chosen = np.unique(np.linspace(0, film.time.size - 1, _FRAMES).astype(int))
    time = film.time[chosen]
    ahead = np.array([velocity, [-velocity[1], velocity[0]]]) / max(speed, _LEAST_SPEED)
    places = (film.place[chosen] - film.place[0]) @ ahead.T
    size = float(np.abs(places).max()) + problem.noise[0]
    motions = problem.moving(spec.begun()).motions
    moments = time if turning is None else np.concatenate([time, turning.time])
    result: list[_Guess] = []

    def scores(
        decels: FloatArray, share: float, launches: FloatArray, rates: FloatArray | None
    ) -> FloatArray:
        # what J does: the same states J times as early, and J times as near
        sooner = decels[..., None] * moments
        states = motions.states(launches, sooner.reshape(len(sooner), -1)).reshape(6, *sooner.shape)
        paths = states[:2, ..., : time.size] / decels[..., None]
        deviations = np.hypot(paths[0] - places[:, 0], paths[1] - places[:, 1]) / (share * size)
        score: FloatArray = np.log1p(deviations * deviations).mean(axis=-1)
        if rates is not None:
            scale = _RATE_SHARE * abs(rates[0]) + 0.01 / film.usual_step
            score += np.log1p(((states[5, ..., time.size :] - rates) / scale) ** 2).mean(axis=-1)
        return score

    spins = [(0.0, 0)] if problem.spinless[0] else _spins(spec, turning, speed, radius, rests)
    for spin, turns in spins:
        share = speed / (math.hypot(speed, radius * spin) or 1.0)
        rates = None if turning is None else turning.with_more(turns, film.time)[0]
        heights, decels = _scales(spec, slowing / max(share, 0.1))
        heights = np.minimum(heights, motions.highest)
        launches = np.tile([[speed], [0.0], [spin], [0.0], [1.0], [radius]], heights.size)
        launches[DELTA] = heights
        if decels.shape[1] > 1:
            best = scores(decels, _PLACE_SHARE, launches, rates).argmin(axis=1)
            decels = decels[np.arange(heights.size), best][:, None] * _NEARER
        finer = scores(decels, _FINER_SHARE, launches, rates)
        for n, k in enumerate(finer.argmin(axis=1).tolist()):
            decel, height = float(decels[n, k]), float(heights[n])
            result.append(_Guess(decel, height, spin, turns, float(finer[n, k])))
    result.sort(key=lambda guess: guess.score)
    if turning is not None:
        nearest = {guess.turns: guess for guess in reversed(result)}
        return [*dict.fromkeys((*result[:_KEPT], *nearest.values()))]
    # without angles every spin is a chance, with the height that suits it
    by_spin = {guess.spin: guess for guess in reversed(result)}
    return sorted(by_spin.values(), key=lambda guess: guess.score)[:_KEPT_BLIND]


def _spins(
    spec: FitSpec, turning: Turning | None, speed: float, radius: float, rests: bool
) -> list[tuple[float, int]]:
    """Spins to try, with how many more turns from frame to frame each means."""
    if "launch_spin" in spec.fixed:
        spin = spec.fixed["launch_spin"]
        more_turns = 0.0 if turning is None else (spin - turning.rate[0]) * turning.step
        return [(spin, round(float(more_turns) / (2.0 * math.pi)))]
    more = [spec.start["launch_spin"]] if "launch_spin" in spec.start else []
    if turning is None:
        scale = max(speed, _LEAST_SPEED) / radius
        spins = sorted({sign * ratio * scale for ratio, sign in product(_RATIOS, (1.0, -1.0))})
        return [(spin, 0) for spin in (*spins, *more)]
    slope = (turning.rate[1] - turning.rate[0]) / (turning.time[1] - turning.time[0]) \
        if turning.rate.size > 1 else 0.0  # fmt: skip
    first = float(turning.rate[0] - slope * turning.time[0])
    whole = 2.0 * math.pi / turning.step
    if rests:
        at_rest = -round(float(turning.rate[-1]) / whole)
        return [(first + at_rest * whole, at_rest)]
    turns = {*range(-_MOST_TURNS, _MOST_TURNS + 1), *(round((n - first) / whole) for n in more)}
    return [(first + k * whole, k) for k in sorted(turns)]


def _scales(spec: FitSpec, slowing: float) -> tuple[FloatArray, FloatArray]:
    """Heights δ to try (n,), each with a range of J (n, m)."""
    decel, delta, _ = spec.scales(spec.begun())
    free = {"friction", "decel", "gravity"} & {*spec.free}
    decels = np.append(slowing * _DECELS, decel) if free else np.array([decel])
    heights = {delta}
    if {"delta", "height"} & {*spec.free}:
        low, high = spec.limits("delta") if "delta" in spec.free else (0.0, 4.0)
        tried = {min(max(height, low), high) for height in (*_HEIGHTS, delta)}
        known = "delta" in spec.start or "height" in spec.start
        heights = (tried if known else tried - heights) or heights
    elif "delta" not in spec.named:  # δ = 2 f h / r goes with J
        return delta * decels / decel, decels[:, None]
    return np.array(sorted(heights)), np.tile(decels, (len(heights), 1))
