"""The estimate of tracks, from starts of their own, without frames that are no free motion.

A free puck changes its velocity smoothly, whatever the floor is: a hand that lets go, a grip or a
wall makes velocity or acceleration jump, and nothing but a push makes a puck on a level floor
faster.  So frames before and after a moment are laid beside two parabolas, and beside one
polynomial with as many coefficients: where the two are far nearer something happened there.  Frames
at the ends before a hand lets go, or after a grip or a wall, are left out.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import certainty_at, certainty_of
from puck_tables.fitting.estimate import FARTHEST, Estimate, estimate, only_outliers
from puck_tables.fitting.fit_spec import DRAGS, NOTHING
from puck_tables.fitting.observations import (
    FEWEST,
    GIVE_NOISE,
    Mask,
    Observations,
    noise_of,
    rests_from,
)
from puck_tables.fitting.problem import ANGLE, UNSEEN, Problem
from puck_tables.fitting.residuals import NO_PATTERN, NOISY, is_clean
from puck_tables.fitting.slowing import nearest_start, starts_from_slowing
from puck_tables.fitting.starts import minima_of

FAR = 25.0  # of χ²: by so much nearer, and by as much for each 1 of it that is left
_REACHES = (6, 12, 24, 48)  # frames to either side
_FEWEST_NEARBY, _CURVED = 3, 5  # frames of a side, and those that tell a curvature
_SPIKE = 6.0  # standard deviations of a frame that is no motion
_JUMPS, _PARTS, _FASTER = 5.0, 4, 1.1  # standard errors; parts of a track; times a speed before


def first_touch(film: Observations, first: int, last: int) -> int | None:
    """The frame from ``first`` to ``last`` before which the motion jumps most; None if none does.

    >>> t = np.arange(60) / 60.0
    >>> noise = np.random.default_rng(1).normal(0.0, 1e-4, (60, 2))
    >>> impact = np.stack([np.where(t < 0.5, t, 0.75 - 0.5 * t), 0.0 * t], axis=1) + noise
    >>> slid = np.stack([t - 0.4 * t * t, 0.0 * t], axis=1) + noise
    >>> films = [Observations("a", 0.0, t, place, None, np.arange(60)) for place in (impact, slid)]
    >>> [first_touch(film, 2, 57) for film in films]
    [31, None]
    """
    noise = noise_of([film])[0]
    if not noise > 0.0:
        return None
    steady = ~_spikes(film.place, noise)
    rests = rests_from(film, noise)
    best, where = 0.0, None
    for middle in range(max(first, _FEWEST_NEARBY), min(last, film.time.size - _FEWEST_NEARBY) + 1):
        for reach in _REACHES:
            gain = _gain(film, noise, steady, middle, reach, rests)
            if gain > best:
                best, where = gain, middle
            if min(middle, film.time.size - middle) <= reach:
                break
    return where


def pushed(film: Observations, start: int, stop: int) -> bool:
    """Whether the puck gets faster between two frames.

    >>> t = np.arange(40) / 40.0
    >>> noise = np.random.default_rng(1).normal(0.0, 1e-4, (40, 2))
    >>> place = np.stack([t * t, 0.0 * t], axis=1) + noise
    >>> film = Observations("a", 0.0, t, place, None, np.arange(40))
    >>> pushed(film, 0, 40), pushed(film, 0, 6)
    (True, False)
    """
    width = (stop - start) // _PARTS
    noise = noise_of([film])[0]
    if width < _FEWEST_NEARBY or not noise > 0.0:
        return False
    slowest, error = math.inf, noise * math.sqrt(12.0 / width**3) / film.usual_step
    for at in range(start, start + _PARTS * width, width):
        part = slice(at, at + width)
        speed = math.hypot(*np.polyfit(film.time[part], film.place[part], 1)[0])
        if speed > max(slowest + _JUMPS * error, _FASTER * slowest):
            return True
        slowest = min(slowest, speed)
    return False


def _gain(
    film: Observations, noise: float, steady: Mask, middle: int, reach: int, rests: int
) -> float:
    """By how much two parabolas are nearer than one polynomial, 0 where that is by chance.

    ``rests``: the frame from which on the puck does.  It comes to rest by itself, where its
    acceleration jumps: before that what comes after does not count, there the velocity has to jump.
    """
    stops = middle >= rests - _FEWEST_NEARBY
    end = middle + reach if stops else min(middle + reach, rests)
    ends = (max(0, middle - reach), middle), (middle, end)
    sides = [np.flatnonzero(steady[start:stop]) + start for start, stop in ends]
    if min(side.size for side in sides) < _FEWEST_NEARBY:
        return 0.0
    time = film.time - film.time[middle]
    left, count, slopes = 0.0, 0, []
    for side in sides:
        order = 2 if side.size >= _CURVED else 1
        result, deviations = _near(time[side], film.place[side], order)
        left, count = left + deviations, count + order + 1
        slopes.append((result[1], 192.0 if order == 2 else 12.0, side.size, result[order]))
    both = np.concatenate(sides)
    one = _near(time[both], film.place[both], count - 1)[1]
    left, one = left / noise**2, one / noise**2
    gain = one - left
    if gain < FAR * max(1.0, left / max(2 * (both.size - count), 1)):
        return 0.0
    if stops:
        jump = math.hypot(*(slopes[1][0] - slopes[0][0]))
        error = math.sqrt(sum(spread / size**3 for _, spread, size, _ in slopes)) * noise
        slowing = 2.0 * math.hypot(*slopes[0][3])
        hidden = _FEWEST_NEARBY * film.usual_step
        hidden += 2.0 * math.sqrt(10.0 * noise / max(slowing, 1e-12))
        if jump < max(_JUMPS * error / film.usual_step, slowing * hidden):
            return 0.0
    return gain


def _near(time: FloatArray, place: FloatArray, order: int) -> tuple[FloatArray, float]:
    """Coefficients of the nearest polynomial, and the squares that are left."""
    scale = float(np.abs(time).max())
    powers = np.vander(time / scale, order + 1, increasing=True)
    result = np.linalg.lstsq(powers, place, rcond=None)[0]
    left = place - powers @ result
    return result / scale ** np.arange(order + 1.0)[:, None], float((left**2).sum())


def _spikes(place: FloatArray, noise: float) -> Mask:
    """Frames that lie far from the cubic through the two before and the two after (n,)."""
    deviations = np.zeros(len(place))
    inner = place[2:-2] - (4.0 * (place[1:-3] + place[3:-1]) - place[:-4] - place[4:]) / 6.0
    deviations[2:-2] = np.hypot(*inner.T) / (1.4 * noise)
    around = np.stack([np.roll(deviations, k) for k in (-2, -1, 1, 2)]).max(axis=0)
    return np.asarray((deviations > _SPIKE) & (deviations >= around))


_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_NEARBY = 0.1  # of the frames that are left, at most
_SMALLER = 0.45  # of the frames: a hand or what a wall did
_SLACK = 3  # frames
_MOSTLY = 0.7  # of them are outliers


def trimmed(result: Estimate, uncut: tuple[Observations, ...]) -> tuple[Observations, ...]:
    """The tracks without what lies at their ends and is not of the motion; ``uncut``: with all.

    What is off there is left out where something touches the puck (:func:`first_touch`); else it is
    the model that is wrong.  A hand that lets go slows otherwise by about J, and is off by as much
    as an outlier only the time √(2 · 4σ/J) before: so long beside what is foreign is left out, too.
    """
    films, problem = [], result.problem
    decel = problem.spec.scales(problem.numbers_at(result.x))[0]
    hidden = math.sqrt(2.0 * FARTHEST * problem.noise[0] / decel)
    for film, whole, (x, _, _) in zip(problem.films, uncut, problem.each(), strict=True):
        out = _out(result, x)
        ends = [_foreign(out), _foreign(out[::-1])]
        close = math.ceil(min(hidden / film.usual_step, _NEARBY * (out.size - sum(ends))))
        for n, before in enumerate(ends):
            edge = before if n == 0 else out.size - before
            at = int(np.searchsorted(whole.frame, film.frame[min(edge, out.size - 1)]))
            at += edge == out.size
            ends[n] = before + close if before and _ends(whole, at, close, n == 0) else 0
        inner = np.arange(film.time.size)
        chosen = (inner >= ends[0]) & (inner < out.size - ends[1])
        same = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if same else film.part(chosen))
    same = all(a is b for a, b in zip(films, problem.films, strict=True))
    return problem.films if same else tuple(films)


def _ends(whole: Observations, at: int, close: int, first: bool) -> bool:
    """Whether the free motion begins, or ends, about a frame since something touches the puck."""
    rests = rests_from(whole, noise_of([whole])[0])
    if not whole.cuttable[0 if first else 1] or (first and at >= rests - FEWEST):
        return False
    if first_touch(whole, at - close - _SLACK, at + close + _SLACK) is not None:
        return True
    count = whole.time.size
    foreign, free = ((0, at), (at, count)) if first else ((at, count), (0, at))
    return pushed(whole, *foreign) and not pushed(whole, *free)


def without_ends(film: Observations) -> list[Observations]:
    """A track without what lies before or after a touch, where that is the smaller part."""
    order, parts = np.arange(film.time.size), []
    count = round(_SMALLER * order.size)
    for end, ends in enumerate(((0, count), (order.size - count, order.size))):
        at = first_touch(film, *ends) if film.cuttable[end] else None
        if at is not None:
            parts.append(film.part((order >= at) != bool(end)))
    return [part for part in parts if part.time.size >= FEWEST + 2]


def _out(result: Estimate, x: slice) -> Mask:
    """Which frames of a track, whose residuals along x are these, are outliers."""
    out: Mask = ~result.kept[x] & (result.problem.kinds[x] != UNSEEN)
    return out


def begins_off(result: Estimate) -> str:
    """A sentence on tracks whose first frames are off the motion that is launched there."""
    for film, (x, _, _) in zip(result.problem.films, result.problem.each(), strict=True):
        if film.cuttable[0] and (off := _foreign(_out(result, x))):
            start, free = film.start + film.time[[0, min(off, film.time.size - 1)]]
            return (
                f"The first {off} frames of {film.name} are off the motion of the others: its "
                f"launch, at {start:.6g} s, is where that would have begun. If a hand or a wall is "
                f"there, give --since {free:.6g} (since={free:.6g})"
            )
    return ""


def _foreign(out: Mask) -> int:
    """How many frames at the beginning are mostly outliers."""
    sizes = np.arange(1, out.size + 1)
    mostly = out & (np.cumsum(out) >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    return int(sizes[mostly].max(initial=0))


_LIFTS = 0.995  # δ from which on a uniform puck is fitted with part of its base lifted
_TRIMS = 3  # times that ends are cut off and fitted anew, at most
_SHARES_OF_AIR = (0.0, 0.3, 0.6, 0.9)  # of the slowing, to begin from
_JUDGED = 10  # degrees of freedom that tell the noise


def initial_estimate(problem: Problem, refit: bool) -> Estimate:
    """The estimate of a problem, from starts of its own.

    ``refit``: whether frames at the ends that are no free motion are left out.
    """
    problem = _with_room(problem)
    count = int((problem.kinds <= ANGLE).sum())
    left = count - len(problem.names) + len(problem.priors)
    if left <= 0:
        raise InputError(
            f"{count} observations cannot tell {len(problem.names)} unknowns: give more frames, or "
            "hold a number (--fix, fixed=)"
        )
    known = problem.known
    if left < _JUDGED and not (known.place and (known.angle or not problem.angled)):
        raise InputError(
            f"{count} observations of {len(problem.names)} unknowns are too few to judge their "
            f"noise by: {GIVE_NOISE}"
        )
    result = _integrated(problem) if problem.spec.integrated else _looked_up(problem)
    if not refit:
        return result
    result = _trimmed(result, problem)
    if len(problem.films) == 1 and not is_clean(result, NOISY, NO_PATTERN):
        # a hand or a wall may lead the fit so far away that no frame is seen to be foreign
        for film in without_ends(problem.films[0]):
            part = initial_estimate(problem.with_films((film,)), refit=False)
            part = _trimmed(part, problem)
            if is_clean(part):
                result = part
                break
    if only_outliers(result):
        return result
    # frames that are off together are good ones: what the model cannot follow is not hidden
    return replace(estimate(result.problem, result.x, strict=True), minima=result.minima)


def _looked_up(problem: Problem) -> Estimate:
    """The estimate where motions are looked up, or integrated once and for all."""
    rests = problem.rests or (False,) * len(problem.films)
    parts = [
        replace(problem, films=(film,), rests=(rest,), jitter=0.0)
        for film, rest in zip(problem.films, rests, strict=True)
    ]
    minima = [minima_of(part) for part in parts]
    result = estimate(problem, _joint_start(problem, parts, minima))
    if "drag" in problem.spec.free and not is_clean(result, NOISY, NO_PATTERN):
        begun = [(problem, result.x), *starts_from_slowing(problem)]
        result = estimate(problem, nearest_start(problem, begun)[1])
    if len(parts) == 1:
        result = replace(result, minima=tuple(minima[0]))
    return _lifted(result)


def _integrated(problem: Problem) -> Estimate:
    """The estimate with what no look-up has the motions of: drags, a slope, a belt, a law.

    Begun from what slows the puck; where that cannot be told, or does not lead to a motion that
    fits, drags are begun from the motion without them.
    """
    spec, starts = problem.spec, starts_from_slowing(problem)
    drags, begun = {*DRAGS} >= {*spec.integrated}, []
    if starts or not drags:
        result = estimate(problem, nearest_start(problem, starts)[1])
        if not drags or is_clean(result, NOISY, NO_PATTERN):
            return result
        begun = [(problem, result.x)]
    plain = initial_estimate(replace(problem, spec=spec.plain()), refit=False)
    numbers, launches = plain.problem.numbers_at(plain.x), plain.problem.launches(plain.x)
    decel, delta, _ = plain.problem.spec.scales(numbers)
    speed = float(np.hypot(*launches[:, 2:4].T).max())
    for share in _SHARES_OF_AIR:  # of the slowing at half the speed that is by air
        less = spec.with_scales((1.0 - share) * decel, (1.0 - share) * delta)
        air = 4.0 * share * decel / max(speed, 1e-9) ** 2
        x = problem.unknowns({**NOTHING, **numbers, **less, "air": air}, launches)
        begun.append((problem, np.clip(x, *problem.limits)))
    return estimate(problem, nearest_start(problem, begun)[1])


def _with_room(problem: Problem) -> Problem:
    """A problem whose pucks may be as tall as the bounds of δ want them."""
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


def _trimmed(result: Estimate, problem: Problem) -> Estimate:
    """An estimate without frames at the ends that are no free motion, a lesser part of a track.

    What they did to the fit may have hidden more of them.
    """
    for _ in range(_TRIMS):
        films = trimmed(result, problem.films)
        lost = (2 * part.time.size < film.time.size
                for part, film in zip(films, problem.films, strict=True))  # fmt: skip
        if films == result.problem.films or any(lost):
            break
        result = initial_estimate(problem.with_films(films), refit=False)
    return result


def _lifted(result: Estimate) -> Estimate:
    """An estimate with part of the base lifted, where δ seems above that of full contact."""
    problem = result.problem
    law = problem.spec.puck.body.law
    delta = problem.spec.scales(problem.numbers_at(result.x))[1]
    if problem.tall or not law.can_lift or delta < _LIFTS:
        return result
    if any(certainty_at(result).undetermined[: len(problem.spec.free)]):
        return result
    return estimate(replace(problem, tall=True), result.x)


def _joint_start(
    problem: Problem, parts: list[Problem], minima: list[list[FloatArray]]
) -> FloatArray:
    """The unknowns of all tracks from those of each: what is shared is their weighted mean."""
    if len(parts) == 1:
        return minima[0][0]
    shared = len(problem.spec.free)
    weights, sums = np.zeros((shared, shared)), np.zeros(shared)
    for part, (x, *_) in zip(parts, minima, strict=True):
        if shared and not part.rests[0]:  # which tells nothing of what moves
            _, slopes = part.residuals_and_jacobian(x)
            spread = certainty_of(slopes, part.plausible(x)).covariance
            weight = np.linalg.pinv(spread[:shared, :shared])
            weights += weight
            sums += weight @ x[:shared]
    mean = np.linalg.solve(weights, sums) if shared else sums
    mean = np.clip(mean, *(ends[:shared] for ends in problem.limits))
    launches = [part.launches(x)[0] for part, (x, *_) in zip(parts, minima, strict=True)]
    return problem.unknowns(problem.numbers_at(mean), np.array(launches))
