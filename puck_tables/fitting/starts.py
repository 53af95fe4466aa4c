"""Values to begin with, from the track itself.

A fit of nonlinear motions finds the nearest minimum, so it is begun near the deepest:

1. a robust parabola through the first frames gives the launch place and velocity;
2. angles from frame to frame give the spin, up to whole turns from frame to frame; a puck that
   comes to rest says how many, others are tried; without angles a range of spins is;
3. for each spin and a few δ, motions with a range of J are laid beside places and rates of turning;
4. the best are fitted to places and to the angles in one piece, abreast: all take the same few
   steps, then the worse half is left behind, and so on; the best of the last is taken.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import DELTA
from puck_tables.fitting.least_squares import FROM_AFAR, ROBUST, minimise_robustly, multi_start
from puck_tables.fitting.observations import Observations, Turning, rests_from, turning_of
from puck_tables.fitting.parameters import LAUNCH
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.unknowns import NumbersOf
from puck_tables.fitting.whole_turns import by_place, half_turns, in_order

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
        return [problem.unknowns(_any(spec), launch[None])]
    moving = _moving_frames(film, problem.noise[0])
    place, velocity, slowing = _first_parabola(film, moving)
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
        result = {**_any(spec), **numbers_with(spec, guess.decel, guess.delta)}
        starts.append((pieces, pieces.unknowns(result, launch[None])))
    more: list[FloatArray] = []
    if spec.start:  # where the caller wants to begin
        launch = np.array([*place, *velocity, 0.0, 0.0])
        if film.angle is not None:
            launch[5] = film.angle[np.isfinite(film.angle)][0]
        launch = np.array(
            [spec.start.get(name, at) for name, at in zip(LAUNCH, launch, strict=True)]
        )
        more = [np.clip(problem.unknowns(_any(spec), launch[None]), *problem.limits)]
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
    return _first_parabola(film, _moving_frames(film, spread))[2]


def _moving_frames(film: Observations, spread: float) -> int:
    """How many frames it moves for, at least so many as a parabola needs."""
    return max(rests_from(film, spread), min(_FEW, film.time.size))


def _first_parabola(film: Observations, moving: int) -> tuple[FloatArray, FloatArray, float]:
    """Place and velocity at the start, and the deceleration along it over the whole run, m/s²."""
    first = robust_parabola(film.time, film.place, 0, min(max(_FEW, int(_SHARE * moving)), moving))
    last = robust_parabola(film.time, film.place, max(0, moving - max(_FEW, moving // 4)), moving)
    span = float(film.time[moving - 1])
    end = last[1] + 2.0 * last[2] * span
    speed = math.hypot(*first[1])
    slowing = (speed - math.hypot(*end)) / span if span > 0.0 else 0.0
    return first[0], first[1], max(slowing, 0.02 * speed / max(span, 1e-300), 1e-9)


def robust_parabola(time: FloatArray, place: FloatArray, start: int, stop: int) -> FloatArray:
    """Coefficients (3, 2) of a parabola through frames, outliers weighing little."""
    t, p = time[start:stop], place[start:stop]
    powers = np.stack([np.ones(t.size), t, t * t], axis=1)[:, : min(3, max(1, t.size - 1))]
    weights = np.ones(t.size)
    result = np.zeros((3, 2))
    for _ in range(6):
        root = np.sqrt(weights)[:, None]
        coefficients = np.linalg.lstsq(powers * root, p * root, rcond=None)[0]
        deviations = np.hypot(*(p - powers @ coefficients).T)
        spread = max(float(np.median(deviations)), 1e-9 * float(np.abs(p).max()), 1e-150)
        weights = 1.0 / (1.0 + (deviations / (2.0 * spread)) ** 2) ** 2
    result[: len(coefficients)] = coefficients
    return result


def _guesses(
    problem: Problem, velocity: FloatArray, slowing: float, turning: Turning | None, rests: bool
) -> list[_Guess]:
    """The motions that lie nearest to the track, of different spins or heights."""
    spec, film = problem.spec, problem.films[0]
    speed, radius = math.hypot(*velocity), spec.scales(_any(spec))[2]
    chosen = np.unique(np.linspace(0, film.time.size - 1, _FRAMES).astype(int))
    time = film.time[chosen]
    ahead = np.array([velocity, [-velocity[1], velocity[0]]]) / max(speed, _LEAST_SPEED)
    places = (film.place[chosen] - film.place[0]) @ ahead.T
    size = float(np.abs(places).max()) + problem.noise[0]
    motions = problem.moving(_any(spec)).motions
    result: list[_Guess] = []
    spins = [(0.0, 0)] if problem.spinless[0] else _spins(spec, turning, speed, radius, rests)
    for spin, turns in spins:
        share = speed / (math.hypot(speed, radius * spin) or 1.0)
        rates = None if turning is None else turning.with_more(turns, film.time)[0]
        moments = time if turning is None else np.concatenate([time, turning.time])
        heights, decels = _scales(spec, slowing / max(share, 0.1))
        heights = np.minimum(heights, motions.highest)
        launches = np.array([
            np.full(heights.size, value) if n != DELTA else heights
            for n, value in enumerate((speed, 0.0, spin, 0.0, 1.0, radius))
        ])  # fmt: skip

        def scores(
            decels: FloatArray, share: float, launches: FloatArray = launches,
            rates: FloatArray | None = rates, moments: FloatArray = moments,
        ) -> FloatArray:  # fmt: skip
            # what J does: the same states J times as early, and J times as near
            sooner = decels[..., None] * moments
            states = motions.states(launches, sooner.reshape(len(sooner), -1))
            states = states.reshape(6, *sooner.shape)
            paths = states[:2, ..., : time.size] / decels[..., None]
            deviations = np.hypot(paths[0] - places[:, 0], paths[1] - places[:, 1]) / (share * size)
            score: FloatArray = np.log1p(deviations * deviations).mean(axis=-1)
            if rates is not None:
                scale = _RATE_SHARE * abs(rates[0]) + 0.01 / film.usual_step
                left = (states[5, ..., time.size :] - rates) / scale
                score += np.log1p(left**2).mean(axis=-1)
            return score

        if decels.shape[1] > 1:
            best = scores(decels, _PLACE_SHARE).argmin(axis=1)
            decels = decels[np.arange(heights.size), best][:, None] * _NEARER
        finer = scores(decels, _FINER_SHARE)
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
        if turning is None:
            return [(spin, 0)]
        first = float(turning.rate[0])
        return [(spin, round((spin - first) * turning.step / (2.0 * math.pi)))]
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


def _any(spec: FitSpec) -> NumbersOf:
    """Any numbers for what is free."""
    known, values = spec.known(), {}
    middle = {"friction": 0.2, "decel": 2.0, "delta": 0.3, "height": 0.3 * spec.puck.radius}
    for name in spec.free:
        value = spec.start.get(name, spec.priors.get(name, (known.get(name) or 0.0,))[0])
        low, high = spec.limits(name)
        values[name] = min(max(value or middle.get(name, value), low), high)
    return values


def _scales(spec: FitSpec, slowing: float) -> tuple[FloatArray, FloatArray]:
    """Heights δ to try (n,), each with a range of J (n, m)."""
    result = _any(spec)
    decel, delta, _ = spec.scales(result)
    decel_free = {"friction", "decel", "gravity"} & {*spec.free}
    decels = np.append(slowing * _DECELS, decel) if decel_free else np.array([decel])
    heights = {delta}
    if {"delta", "height"} & {*spec.free}:
        low, high = spec.limits("delta") if "delta" in spec.free else (0.0, 4.0)
        tried = {min(max(height, low), high) for height in (*_HEIGHTS, delta)}
        known = "delta" in spec.start or "height" in spec.start
        heights = (tried if known else tried - heights) or heights
    elif not spec.uses_delta:  # δ = 2 f h / r goes with J
        return delta * decels / decel, decels[:, None]
    return np.array(sorted(heights)), np.tile(decels, (len(heights), 1))


def numbers_with(spec: FitSpec, decel: float, delta: float) -> NumbersOf:
    """The free numbers, of those that J and δ follow from, which mean these."""
    result, others = {}, _any(spec)
    gravity = {**spec.known(), **others}["gravity"]
    if "friction" in others:
        result["friction"] = decel / gravity
    elif "decel" in others:
        result["decel"] = decel
    elif "gravity" in others:
        result["gravity"] = decel / spec.known()["friction"]
    if "delta" in others:
        result["delta"] = delta
    elif "height" in others:
        others.update(result)
        radius, gravity = spec.scales(others)[2], {**spec.known(), **others}["gravity"]
        result["height"] = 0.5 * delta * radius * gravity / decel
    for name in result:
        low, high = spec.limits(name)
        result[name] = min(max(result[name], low), high)
    return result
