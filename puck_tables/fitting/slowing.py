"""Values to begin with where more than one friction moves a puck: from what slows and turns it.

A polynomial of time through places and angles in one piece tells velocity v and spin ω; what they
change by, from their means over the film, is linear in friction, drags and a push, for a flat puck

    Δv = −f g ∫ I_a v/|v| dt − c ∫ v dt − k ∫ |v| v dt + p t
    Δω = −f g (r/k_g²) ∫ I_d sgn ω dt − (c + s) ∫ ω dt

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
from puck_tables.fitting.least_squares import FROM_SLOWING, ROBUST, multi_start
from puck_tables.fitting.named_laws import shape
from puck_tables.fitting.observations import Observations, rests_from, turning_of
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.unknowns import NumbersOf

_DEGREE = 7  # of the polynomial: motions that slow are smooth
_FAR, _ROUNDS = 4.0, 4  # usual deviations of a frame that counts; so often others are left out
_MOMENTS = 60
_LEAST = 1e-3  # of the friction that slows alone
_KEPT = 5  # trials that begin a fit
_LINEAR = ("friction", "friction_rest", "drag", "air", "spin_drag", "slope_x", "slope_y")
_NOTHING = ("drag", "air", "spin_drag", "slope_x", "slope_y", "belt_x", "belt_y")
_LAW_SPEEDS = (0.03, 0.06, 0.1, 0.16, 0.25, 0.4, 0.6)  # of the fastest slip
_BELT_SPEEDS, _BELT_WAYS = (0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0), 16  # of the fastest speed


class _Moments(NamedTuple):
    """A track at moments (m,) s: velocities (2, m) m/s, speeds of the rim (m,), and its launch."""

    at: FloatArray
    velocity: FloatArray
    rim: FloatArray
    launch: list[float]


def starts_from_slowing(problem: Problem) -> list[tuple[Problem, FloatArray]]:
    """Starts of a problem of tracks with angles, or along lines; none where none can be followed.

    Of those of which friction, drags, a slope, a belt or the numbers of a law are found; with its
    unknowns comes the same problem with the angles of each track in one piece.  The last start is
    that of one friction and nothing else, which leaves no more in the end than that alone would.

    Examples
    --------
    >>> from puck_tables.film.puck_track import Track
    >>> from puck_tables.fitting.fit_spec import FitSpec
    >>> from puck_tables.fitting.observations import observations_in
    >>> from puck_tables.puck import Puck
    >>> t = 0.01 * np.arange(90)
    >>> track = Track(t, np.stack([2.0 * t - 0.49 * t**2, 0.0 * t], axis=1), 0.0 * t)
    >>> spec = FitSpec.of(Puck(0.03, gravity=9.8), ["friction", "air"], {}, {}, {}, {})
    >>> starts = starts_from_slowing(Problem(spec, (observations_in(track),), (1e-4, 1e-3)))
    >>> starts[0][1][:2].round(4)
    array([0.1, 0. ])
    """
    films, whole = [], []
    radius = problem.spec.known()["radius"]
    for film in problem.films:
        turning = turning_of(film)
        if film.angle is not None and (turning is None or not turning.sure):
            return []
        if film.angle is None and film.straight is None:
            return []
        angle = None if turning is None else turning.angle
        whole.append(angle)
        films.append(_moments(film, angle, rests_from(film, problem.noise[0]), radius))
    tried = [_linear_fit(problem, films, trial) for trial in _trials(problem, films)]
    tried = sorted(tried, key=lambda one: one[1])[:_KEPT]
    alone = {**tried[0][0], **dict.fromkeys(_NOTHING, 0.0), "friction": tried[0][2]}
    alone["friction_rest"] = alone["friction"]
    spec, known = problem.spec, problem.spec.known()
    moved = replace(problem, whole=tuple(whole), weights=())
    launches, starts = np.array([film.launch for film in films]), []
    for numbers in (*(one[0] for one in tried), alone):
        begun = {**known, "delta": 0.1, **numbers, **spec.start}
        begun["decel"] = begun["friction"] * known["gravity"]
        x = moved.unknowns({name: begun[name] for name in spec.free}, launches)
        starts.append((moved, np.clip(x, *moved.limits)))
    return starts


def nearest_start(problem: Problem) -> tuple[Problem, FloatArray] | None:
    """That of the starts which leads to the deepest minimum, there; None where there are none."""
    starts = starts_from_slowing(problem)
    if not starts:
        return None
    (x, _), *_ = multi_start(starts, FROM_SLOWING, ROBUST)
    return starts[0][0], x


def begun_or_refused(problem: Problem) -> tuple[Problem, FloatArray]:
    """The same, refused where none can be followed."""
    begun = nearest_start(problem)
    if begun is None:
        raise InputError(
            f"{' and '.join(problem.spec.integrated)} are found of tracks with angles that can be "
            "followed from frame to frame, or along a line: film a mark on the puck"
        )
    return begun


def _trials(problem: Problem, films: list[_Moments]) -> Iterator[NumbersOf]:
    """Values of what is not linear."""
    spec = problem.spec
    fastest = max(float(np.hypot(np.hypot(*one.velocity), one.rim).max()) for one in films)
    if "law_speed" in spec.free:
        yield from ({"law_speed": share * fastest} for share in _LAW_SPEEDS)
    elif {"belt_x", "belt_y"} & {*spec.free}:
        way = 2.0 * np.pi * np.arange(_BELT_WAYS) / _BELT_WAYS
        ends = [one.velocity[:, -1] for one in films]
        tried = [share * fastest * np.array([np.cos(a), np.sin(a)])
                 for share in _BELT_SPEEDS for a in way]  # fmt: skip
        for belt in (*ends, *tried):
            yield {"belt_x": float(belt[0]), "belt_y": float(belt[1])}
    else:
        yield {}


def _linear_fit(
    problem: Problem, films: list[_Moments], trial: NumbersOf
) -> tuple[NumbersOf, float, float]:  # fmt: skip
    """The numbers that linear least squares find with those tried, what is left, and f alone."""
    spec = problem.spec
    known = {**spec.known(), **trial}
    names = [n for n in _LINEAR if n in spec.free or (n == "friction" and "decel" in spec.free)]
    parts = [_columns(one, spec.law, known) for one in films]
    every = np.concatenate([columns for columns, _ in parts])
    change = np.concatenate([lost for _, lost in parts])
    at = [_LINEAR.index(name) for name in names]
    held = [k for k in range(len(_LINEAR)) if k not in at]
    fixed = np.array([known.get(name, 0.0) for name in _LINEAR])
    if spec.law == "":
        fixed[_LINEAR.index("friction_rest")] = 0.0
    rest = change - every[:, held] @ fixed[held]
    found = np.linalg.lstsq(every[:, at], rest, rcond=None)[0]
    left = float(np.sum((every[:, at] @ found - rest) ** 2))
    alone = float(change @ every[:, 0] / max(every[:, 0] @ every[:, 0], 1e-300))
    values = dict(zip(names, found.tolist(), strict=True))
    for name in ("drag", "air", "spin_drag"):
        if name in values:
            values[name] = max(values[name], 0.0)
    for name in ("friction", "friction_rest"):
        if name in values:
            values[name] = max(values[name], _LEAST * abs(alone))
    return {**trial, **values}, left, max(alone, _LEAST)


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
    x, y, turn = smooth
    vx, vy, spin = (one.deriv()(at) for one in smooth)
    launch = [float(one) for one in (x(0.0), y(0.0), vx[0], vy[0], spin[0], turn(0.0))]
    return _Moments(at, np.stack([vx, vy]), radius * spin, launch)


def _columns(
    film: _Moments, law: str, known: NumbersOf
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """What each of the linear numbers does to the speeds along x and y and of the rim (3m, 7).

    And by how much these changed (3m,).
    """
    belt = np.array([known.get("belt_x", 0.0), known.get("belt_y", 0.0)])
    velocity = film.velocity - belt[:, None]
    v, rim, g = np.hypot(*velocity), np.abs(film.rim), known["gravity"]
    slip = np.maximum(np.hypot(v, rim), 1e-300)
    fast = (rim > v).astype(np.float64)
    a, _, d = closed_form.shape_integrals(
        np.minimum(v, rim) / np.maximum(np.maximum(v, rim), 1e-300), fast
    )
    side = np.sign(film.rim)
    braking = -g * np.stack(
        [*(velocity / slip * a), side * rim / slip * d / known["gyration"] ** 2]
    )
    share = np.zeros(v.size) if law == "" else shape(law, slip / known["law_speed"])
    none = np.zeros(v.size)
    rates = [
        braking * (1.0 - share), braking * share,
        -np.stack([*velocity, film.rim]), -np.stack([*(v * velocity), none]),
        -np.stack([none, none, film.rim]),
        np.stack([none + g, none, none]), np.stack([none, none + g, none]),
    ]  # fmt: skip
    steps = np.diff(film.at)
    columns = []
    for rate in rates:
        parts = np.cumsum(0.5 * steps * (rate[:, 1:] + rate[:, :-1]), axis=1)
        columns.append(np.concatenate([np.zeros((3, 1)), parts], axis=1))
    columns.append(np.concatenate([film.velocity, film.rim[None]]))
    # from their means: a polynomial is least sure at its ends
    *columns, moved = [(one - one.mean(axis=1, keepdims=True)).ravel() for one in columns]
    return np.stack(columns, axis=1), moved
