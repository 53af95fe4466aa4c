"""The estimate of tracks, from starts that the tracks themselves suggest.

Frames at their ends that are no free motion, a hand before, a grip or a wall after, are left out.

Where more than one friction moves a puck starts come from what slows and turns it.  A polynomial of
time through places and angles in one piece tells velocity v and spin ω.  With these places and
angles are linear in the launch, in friction, drags and a push, for a flat puck

    Δx = v₀ t + ∬ (−f g I_a v/|v| − c v − k |v| v + p) dt² ,
    Δφ = ω₀ t + ∬ (−f g (r/k_g²) I_d sgn ω − (c + s) ω) dt² ,

with the integrals I_a, I_d of the base over the direction of slip (uniform pressure).  Over a belt
v is relative to it; f of a named law counts at the slip √(v² + (rω)²).  What is not linear, the
speed of a law or a belt, is tried out.  No motion near the truth is needed, and angles stay in one
piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import certainty_at, certainty_of
from puck_tables.fitting.estimate import Estimate, estimate, only_outliers
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.least_squares import FROM_SLOWING, ROBUST, multi_start
from puck_tables.fitting.observations import GIVE_NOISE, Observations, rests_from, turning_of
from puck_tables.fitting.parameters import DRAGS, NOTHING
from puck_tables.fitting.problem import ANGLE, Problem
from puck_tables.fitting.residuals import NO_PATTERN, NOISY, is_clean
from puck_tables.fitting.speed_motion import shape
from puck_tables.fitting.starts import minima_of, numbers_with
from puck_tables.fitting.touches import trimmed, without_ends
from puck_tables.fitting.unknowns import NumbersOf

_DEGREE = 7  # of the polynomial: motions that slow are smooth
_FAR, _ROUNDS = 4.0, 4  # usual deviations of a frame that counts; so often others are left out
_MOMENTS = 60  # at which polynomials stand for a track
_LEAST = 1e-3  # of the friction that slows alone
_KEPT = 5  # trials that begin a fit
_FRICTIONS = ("friction", "friction_rest")
_LINEAR = ("friction", "friction_rest", "drag", "air", "spin_drag", "slope_x", "slope_y")
# of the base, by radius and direction: half of it, the other is its mirror image
_PARTS = np.outer(
    np.sqrt((np.arange(6) + 0.5) / 6.0), np.exp(1j * np.pi * ((np.arange(16) + 0.5) / 16.0 - 0.5))
).ravel()  # fmt: skip
_LAW_SPEEDS = tuple(np.geomspace(0.02, 0.9, 12).tolist())  # of the fastest slip
_BELT_SPEEDS, _BELT_DIRECTIONS = (0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0), 16  # of the fastest speed


class _Moments(NamedTuple):
    """A track at moments (m,) s: x, y and the way of the rim (3, m) m, and their speeds (3, m)."""

    at: FloatArray
    place: FloatArray
    speed: FloatArray

    @property
    def line(self) -> FloatArray:
        """What a launch does to each of the places (m, 2), by where and how fast it begins."""
        return np.stack([np.ones(self.at.size), self.at], axis=1)


def starts_from_slowing(problem: Problem) -> list[tuple[Problem, FloatArray]]:
    """Starts of a problem of tracks with angles, or along lines; none where none can be followed.

    Of those of which friction, drags, a slope, a belt or the numbers of a law are found; with its
    unknowns comes the same problem with the angles of each track in one piece.  The last start is
    that of one friction and nothing else, which leaves no more in the end than that alone would.

    >>> from puck_tables.film.film import Track
    >>> from puck_tables.fitting.checked_spec import spec_of
    >>> from puck_tables.fitting.observations import observations_in
    >>> from puck_tables.puck import Puck
    >>> t = 0.01 * np.arange(90)
    >>> track = Track(t, np.stack([2.0 * t - 0.49 * t**2, 0.0 * t], axis=1), 0.0 * t)
    >>> spec = spec_of(Puck(0.03, gravity=9.8), ["friction", "air"], {}, {}, {}, {})
    >>> starts = starts_from_slowing(Problem(spec, (observations_in(track),), (1e-4, 1e-3)))
    >>> starts[0][1][:2].round(4)
    array([0.1, 0. ])
    """
    films, whole = [], []
    radius = problem.spec.known()["radius"]
    for film in problem.films:
        turning = turning_of(film)
        followed = film.straight is not None if film.angle is None else turning and turning.sure
        if not followed:
            return []
        angle = None if turning is None else turning.angle
        whole.append(angle)
        films.append(_moments(film, angle, rests_from(film, problem.noise[0]), radius))
    spec, known = problem.spec, problem.spec.known()
    alone = _linear_fit(replace(spec.plain(), free=("friction",)), films, {}, 0.0)
    one = alone.numbers["friction"]
    tried = [_linear_fit(spec, films, trial, _LEAST * one) for trial in _trials(problem, films)]
    tried = sorted(tried, key=lambda one: one.left)[:_KEPT]
    law_speed = tried[0].numbers.get("law_speed", 0.0)
    alone.numbers.update({**NOTHING, "friction_rest": one, "law_speed": law_speed})
    moved = replace(problem, whole=tuple(whole), weights=())
    starts = []
    for numbers, launches, _ in (*tried, alone):
        begun = {**known, "delta": 0.1, **numbers, **spec.start}
        begun["decel"] = begun["friction"] * known["gravity"]
        x = moved.unknowns({name: begun[name] for name in spec.free}, launches)
        starts.append((moved, np.clip(x, *moved.limits)))
    return starts


def nearest_start(
    problem: Problem, starts: list[tuple[Problem, FloatArray]]
) -> tuple[Problem, FloatArray]:
    """That of the starts which leads to the deepest minimum, there; refused where there are none.

    With its unknowns comes the problem with the angles of each track in one piece.
    """
    if not starts:
        raise InputError(
            f"{' and '.join(problem.spec.integrated)} are found of tracks with angles that can be "
            "followed from frame to frame, or along a line: film a mark on the puck"
        )
    return starts[0][0], multi_start(starts, FROM_SLOWING, ROBUST)[0][0]


def _trials(problem: Problem, films: list[_Moments]) -> Iterator[NumbersOf]:
    """Values of what is not linear."""
    spec = problem.spec
    fastest = max(float(np.linalg.norm(one.speed, axis=0).max()) for one in films)
    if "law_speed" in spec.free:
        yield from ({"law_speed": share * fastest} for share in _LAW_SPEEDS)
    elif {"belt_x", "belt_y"} & {*spec.free}:
        angles = 2.0 * np.pi * np.arange(_BELT_DIRECTIONS) / _BELT_DIRECTIONS
        ends = [one.speed[:2, -1] for one in films]
        tried = [share * fastest * np.array([np.cos(a), np.sin(a)])
                 for share in _BELT_SPEEDS for a in angles]  # fmt: skip
        for belt in (*ends, *tried):
            yield {"belt_x": float(belt[0]), "belt_y": float(belt[1])}
    else:
        yield {}


class _LinearFit(NamedTuple):
    """Numbers of the puck, launches (tracks, 6), and the squares that are left, m²."""

    numbers: NumbersOf
    launches: FloatArray
    left: float


def _linear_fit(spec: FitSpec, films: list[_Moments], trial: NumbersOf, least: float) -> _LinearFit:
    """What linear least squares find with the numbers tried; ``least``: of a friction."""
    from scipy.optimize import lsq_linear

    known = {**spec.known(), **trial}
    names = [n for n in _LINEAR if n in spec.free or (n == "friction" and "decel" in spec.free)]
    at = [_LINEAR.index(name) for name in names]
    fixed = np.array([known.get(name, 0.0) for name in _LINEAR])
    fixed[at] = 0.0
    if spec.law == "":
        fixed[_LINEAR.index("friction_rest")] = 0.0
    columns = [_columns(one, spec.law, known) for one in films]
    rest = [one.place.T - column @ fixed for one, column in zip(films, columns, strict=True)]
    lines = [np.linalg.qr(film.line)[0] for film in films]
    every, seen = (  # what no launch can do of places
        np.concatenate([
            (one - np.tensordot(line @ line.T, one, 1)).reshape(-1, *one.shape[2:])
            for line, one in zip(lines, rows, strict=True)
        ]) for rows in ([column[..., at] for column in columns], rest)
    )  # fmt: skip
    solution, left = np.zeros(len(at)), float(seen @ seen)
    if names:
        size = np.maximum(np.linalg.norm(every, axis=0), 1e-300)
        low, high = np.array([spec.limits(name) for name in names]).T
        low = np.maximum(low, [least if name in _FRICTIONS else -np.inf for name in names])
        result = lsq_linear(every / size, seen, (low * size, high * size), method="bvls")
        solution, left = result.x / size, 2.0 * float(result.cost)
    radius, launches = spec.known()["radius"], []
    for film, column, one in zip(films, columns, rest, strict=True):
        begun, speed = np.linalg.lstsq(film.line, one - column[..., at] @ solution, rcond=None)[0]
        launches.append([*begun[:2], *speed[:2], speed[2] / radius, begun[2] / radius])
    numbers = dict(zip(names, solution.tolist(), strict=True))
    return _LinearFit({**trial, **numbers}, np.array(launches), left)


def _moments(
    film: Observations, angle: FloatArray | None, moving: int, radius: float
) -> _Moments:  # fmt: skip
    """A track along polynomials of time, without strays."""
    t, smooth = film.time[:moving], []
    at = np.linspace(0.0, float(t[-1]), _MOMENTS)
    turned = np.zeros(moving) if angle is None else angle[:moving]
    for rows in (*film.place[:moving].T, turned):
        kept = np.isfinite(rows)
        for _ in range(_ROUNDS):
            degree = min(_DEGREE, max(int(kept.sum()) // 4, 2))
            one = Chebyshev.fit(t[kept], rows[kept], degree, [0.0, float(t[-1])])
            off = np.abs(rows - one(t))
            again = np.isfinite(rows) & (off <= _FAR * 1.48 * max(np.nanmedian(off), 1e-12))
            if np.array_equal(again, kept) or again.sum() < 2 * degree:
                break
            kept = again
        smooth.append(one)
    speed = np.stack([one.deriv()(at) for one in smooth])
    size = np.array([[1.0], [1.0], [radius]])
    return _Moments(at, size * np.stack([one(at) for one in smooth]), size * speed)


def _columns(film: _Moments, law: str, known: NumbersOf) -> FloatArray:
    """What each of the linear numbers does to x, y and the way of the rim (m, 3, 7)."""
    belt = np.array([known.get("belt_x", 0.0), known.get("belt_y", 0.0)])
    velocity, turning = film.speed[:2] - belt[:, None], film.speed[2]
    v, rim, g = np.hypot(*velocity), np.abs(turning), known["gravity"]
    slip = np.maximum(np.hypot(v, rim), 1e-300)
    a, _, d = closed_form.shape_integrals(
        np.minimum(v, rim) / np.maximum(np.maximum(v, rim), 1e-300), (rim > v).astype(np.float64)
    )
    whole = np.stack([v / slip * a, rim / slip * d])
    part = np.zeros_like(whole) if law == "" else _of_law(v, rim, law, known["law_speed"])
    directions = np.stack([*(velocity / np.maximum(v, 1e-300)), np.sign(turning)])
    directions[2] /= known["gyration"] ** 2
    braking, resting = (-g * one[[0, 0, 1]] * directions for one in (whole - part, part))
    none = np.zeros(v.size)
    rates = np.stack([
        braking, resting,
        -np.stack([*velocity, turning]), -np.stack([*(v * velocity), none]),
        -np.stack([none, none, turning]),
        np.stack([none + g, none, none]), np.stack([none, none + g, none]),
    ], axis=2)  # fmt: skip
    for _ in range(2):
        steps = np.diff(film.at)[:, None] * 0.5 * (rates[:, 1:] + rates[:, :-1])
        rates = np.concatenate([np.zeros((3, 1, 7)), np.cumsum(steps, axis=1)], axis=1)
    return np.swapaxes(rates, 0, 1)


def _of_law(v: FloatArray, rim: FloatArray, law: str, speed: float) -> FloatArray:
    """Force and torque of φ of a law over the base, at speeds (m,) of its middle and rim, (2, m).

    Over f N and f N r; summed over parts of the base of equal size.
    """
    along, aside = _PARTS.real, _PARTS.imag
    ahead, across = v[:, None] - rim[:, None] * aside, rim[:, None] * along
    slip = np.maximum(np.hypot(ahead, across), 1e-300)
    pull = shape(law, slip / speed) / slip
    pulls = np.stack([pull * ahead, pull * (across * along - ahead * aside)])
    return np.asarray(pulls.mean(axis=2))


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
        less = numbers_with(spec, (1.0 - share) * decel, (1.0 - share) * delta)
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
            spread = certainty_of(part.jacobian(x), part.plausible(x)).covariance
            weight = np.linalg.pinv(spread[:shared, :shared])
            weights += weight
            sums += weight @ x[:shared]
    mean = np.linalg.solve(weights, sums) if shared else sums
    mean = np.clip(mean, *(ends[:shared] for ends in problem.limits))
    launches = [part.launches(x)[0] for part, (x, *_) in zip(parts, minima, strict=True)]
    return problem.unknowns(problem.numbers_at(mean), np.array(launches))
