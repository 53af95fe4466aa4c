"""What slows a puck: starts of a fit where more than one friction moves it, and other floors.

A polynomial of time through places and angles in one piece tells velocity v and spin ω.  With these
places and angles are linear in the launch, in friction, drags and a push, for a flat puck

    Δx = v₀ t + ∬ (−f g I_a v/|v| − c v − k |v| v + p) dt² ,
    Δφ = ω₀ t + ∬ (−f g (r/k_g²) I_d sgn ω − (c + s) ω) dt² ,

with the integrals I_a, I_d of the base over the direction of slip (uniform pressure).  Over a belt
v is relative to it; f of a named law counts at the slip √(v² + (rω)²).  What is not linear, the
speed of a law or a belt, is tried out.  No motion near the truth is needed, and angles stay in one
piece.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.errors import InputError
from puck_tables.fitting.checked_spec import over
from puck_tables.fitting.estimate import Estimate, estimate
from puck_tables.fitting.fit_spec import NODES, NOTHING, FitSpec
from puck_tables.fitting.observations import MEDIAN, Observations, rests_from, turning_of
from puck_tables.fitting.problem import (
    FROM_SLOWING,
    ROBUST,
    ROUGH,
    UNSEEN,
    Known,
    Problem,
    Start,
    minimise_robustly,
    multi_start,
)
from puck_tables.fitting.slides import NumbersOf
from puck_tables.fitting.speed_motion import shape

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


def starts_from_slowing(problem: Problem) -> list[Start]:
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


def nearest_start(problem: Problem, starts: list[Start]) -> Start:
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

    known = spec.numbers(trial)
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


def _moments(film: Observations, angle: FloatArray | None, moving: int, radius: float) -> _Moments:
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


_ROUGHLY = 15  # steps
_FALLS = 0.99  # of the cost before: a floor that still comes nearer is followed
_NEAR = 3.0  # times the noise: floors that are fitted to the end
_FRAMES = 80  # that tell whether such a law may be the reason of a misfit
_FAINT = 0.02  # of the largest friction of a line: the smallest
_FAINTEST, _STRONGEST = 0.02, 10.0  # times one friction for all speeds: laws that some floor has
_SHARES = (0.0, 0.08, 0.3, 1.0)  # of the fastest slip
_LITTLE_DRAG, _MOST_DRAG = 0.01, 10.0  # 1/s
ALL_KNOWN = Known(True, True, True)


def over_speeds(result: Estimate, speeds: tuple[float, ...], between: str) -> Estimate:
    """The estimate with a friction coefficient for each slip speed, from that of one for all."""
    if (fastest := result.problem.fastest(result.x)) > speeds[-1]:
        raise InputError(
            f"the puck slips at up to {fastest:.4g} m/s, but the last of the slip speeds is "
            f"{speeds[-1]:g} m/s: give speeds up to {math.ceil(10.0 * fastest) / 10.0:g}"
        )
    moved, start = _begun(result.problem, result.x, speeds)
    lines, _ = minimise_robustly(moved, start)
    spec = replace(moved.spec, between=between)
    return estimate(replace(moved, spec=spec), lines)


def on_a_floor(problem: Problem) -> Estimate:
    """The estimate of a floor that is compared with others: about, where it does not come near."""
    begun, x = nearest_start(problem, starts_from_slowing(problem))
    cost, falls = math.inf, True
    while falls:
        x, less = minimise_robustly(begun, x, _ROUGHLY)
        rows = problem.residuals(x)
        if problem.usual(rows) < _NEAR:
            return estimate(problem, x)
        cost, falls = less, less < _FALLS * cost
    noise = (problem.usual(rows) / MEDIAN * problem.noise[0], problem.noise[1])
    wider = problem if problem.known.place else problem.with_noise(noise, x)
    none = np.zeros((rows.size, x.size))
    return Estimate(wider, x, problem.kinds != UNSEEN, wider.residuals(x), none)


def tried(result: Estimate) -> Estimate:
    """About what a law over slip speed leaves of the frames of an estimate."""
    problem = result.problem
    top = problem.fastest(result.x)
    speeds = tuple(float(f"{1.1 * top * share:.2g}") for share in _SHARES)
    fewer = problem.with_films(tuple(film.thinned(_FRAMES) for film in problem.films))
    usual = problem.numbers_at(result.x)["friction"]
    bounds = {"friction": (_FAINTEST * usual, _STRONGEST * usual), **problem.spec.bounds}
    fewer = replace(fewer, known=ALL_KNOWN, level=ROUGH, spec=replace(problem.spec, bounds=bounds))
    return over_speeds(replace(result, problem=fewer), speeds, "cubic")


def _begun(problem: Problem, x: FloatArray, speeds: tuple[float, ...]) -> Start:
    """A problem of lines between slip speeds, with the friction of an estimate at each.

    Where drag besides friction is nearer to the tracks, which is a line, it is that of the line.
    Where f is the same at all speeds the slopes of a cubic jump: lines lead away from there.
    """
    spec = over(problem.spec, speeds, "linear")
    numbers, launches = problem.numbers_at(x), problem.launches(x)
    numbers.update({name: numbers["friction"] for name in spec.free if name in NODES})
    moved = replace(problem, spec=spec, weights=(), tall=False)
    start = moved.unknowns(numbers, launches, problem.estimated_walls(x))
    line = None if problem.impact_specs else on_another_floor(problem, x)
    if line is None:
        return moved, start
    there, _ = minimise_robustly(*line)
    result, gravity = line[0].numbers_at(there), problem.spec.known()["gravity"]
    values = result["friction"] + result["drag"] / gravity * np.array(speeds)
    values = np.maximum(values, _FAINT * values.max())
    numbers.update(dict(zip(NODES, values.tolist(), strict=False)))
    if "delta" in numbers:  # of the same height
        numbers["delta"] = min(numbers["delta"] * values[0] / numbers["friction"], 1.0)
    other = moved.unknowns(numbers, line[0].launches(there))
    near = [float((moved.residuals(one) ** 2).sum()) for one in (start, other)]
    return moved, other if near[1] < near[0] else start


def law_over(
    result: Estimate, covariance: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The friction coefficient at slip speeds (n,) m/s, and its standard errors (n,)."""
    spec, numbers = result.problem.spec, result.problem.numbers_at(result.x)
    count = len(spec.speeds)
    slopes = np.zeros((at.size, count))
    for k, name in enumerate(spec.free[:count]):
        step = 1e-4 * numbers[name]
        ends = [spec.speed_law({**numbers, name: numbers[name] + by})(at) for by in (step, -step)]
        slopes[:, k] = (ends[0] - ends[1]) / (2.0 * step)
    spread = np.einsum("ni,ik,nk->n", slopes, covariance[:count, :count], slopes)
    return np.asarray(spec.speed_law(numbers)(at)), np.sqrt(spread)


def on_another_floor(problem: Problem, x: FloatArray) -> Start | None:
    """The motion on a floor with drag besides friction, if that may be and is not asked for.

    Where such a slow motion fits as well as a fast one it is the floor that is another.
    """
    spec = problem.spec
    if spec.speeds or "drag" in spec.free or "drag" in spec.fixed:
        return None
    bounds = {**spec.bounds, "drag": (0.0, _MOST_DRAG)}
    other = replace(spec, free=(*spec.free, "drag"), bounds=bounds)
    return replace(problem, spec=other, weights=()), np.insert(x, len(spec.free), _LITTLE_DRAG)
