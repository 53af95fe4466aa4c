"""Values to begin with where drags go beside friction: linear least squares of what slows a puck.

A polynomial of time through places and angles in one piece tells speed v and spin ω; what they lose
from the first moment to each other is linear in friction and drags, for a flat puck

    Δv = −f g ∫ I_a dt − c ∫ v dt − k ∫ v² dt ,  Δω = −(f g r/k_g²) ∫ I_d dt − (c + s) ∫ ω dt

with the integrals I_a, I_d of the base over the direction of slip (physics of the base, uniform
pressure).  It needs no motion near the truth, so that angles stay in one piece.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.polynomial import Chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.fitting.observations import Observations, Turning, rests_from, turning_of
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.unknowns import NumbersOf

_DEGREE = 7  # of the polynomial: motions that slow are smooth
_FAR, _ROUNDS = 4.0, 4  # usual deviations of a frame that counts; so often others are left out
_MOMENTS = 60
_LEAST = 1e-3  # of the friction that slows alone
_NAMES = ("friction", "drag", "air", "spin_drag")


def begun_with_drags(problem: Problem) -> tuple[Problem, FloatArray] | None:
    """A start of a problem of tracks with angles; None where one has none that can be followed.

    Parameters
    ----------
    problem : of which friction, drag, air or spin_drag are found

    Returns
    -------
    problem, unknowns
        The same problem with the angles of each track in one piece.

    Examples
    --------
    >>> from puck_tables.film.puck_track import Track
    >>> from puck_tables.fitting.fit_spec import FitSpec
    >>> from puck_tables.fitting.observations import observations_in
    >>> from puck_tables.puck import Puck
    >>> t = 0.01 * np.arange(90)
    >>> track = Track(t, np.stack([2.0 * t - 0.49 * t**2, 0.0 * t], axis=1), 0.0 * t)
    >>> spec = FitSpec.of(Puck(0.03, gravity=9.8), ["friction", "air"], {}, {}, {}, {})
    >>> begun_with_drags(Problem(spec, (observations_in(track),), (1e-4, 1e-3)))[1][:2].round(4)
    array([0.1, 0. ])
    """
    launches, rows, lost, whole = [], [], [], []
    known = {**problem.spec.known(), "delta": 0.0}
    radius = known["radius"]
    for film in problem.films:
        turning = turning_of(film)
        if turning is None or not turning.sure:
            return None
        moving = rests_from(film, problem.noise[0])
        x, y, angle = _smooth(film, turning, moving)
        at = np.linspace(0.0, float(film.time[moving - 1]), _MOMENTS)
        vx, vy, spin = (one.deriv()(at) for one in (x, y, angle))
        launches.append([x(0.0), y(0.0), vx[0], vy[0], spin[0], angle(0.0)])
        columns, change = _slowing(at, np.hypot(vx, vy), radius * spin, known["gyration"])
        columns[:, 0] *= known["gravity"]
        rows.append(columns)
        lost.append(change)
        whole.append(turning.angle)
    spec = problem.spec
    free = [k for k, name in enumerate(_NAMES) if name in spec.free]
    every, change = np.concatenate(rows), np.concatenate(lost)
    values = np.array([spec.fixed.get(name, known.get(name, 0.0)) for name in _NAMES])
    held = np.setdiff1d(np.arange(len(_NAMES)), free)
    told = np.linalg.lstsq(every[:, free], change - every[:, held] @ values[held], rcond=None)[0]
    alone = float(change @ every[:, 0] / (every[:, 0] @ every[:, 0]))
    values[free] = np.maximum(told, 0.0)
    values[0] = max(values[0], _LEAST * alone)
    numbers: NumbersOf = dict(zip(_NAMES, values.tolist(), strict=True))
    begun = {**known, **spec.start, **numbers, "delta": 0.1}
    begun["decel"] = numbers["friction"] * known["gravity"]
    x0 = problem.unknowns({name: begun[name] for name in spec.free}, np.array(launches))
    moved = replace(problem, whole=tuple(whole), weights=())
    return moved, np.clip(x0, *problem.limits)


def _smooth(film: Observations, turning: Turning, moving: int) -> list[Chebyshev]:
    """Polynomials of time through x, y and angle, without strays."""
    t, smooth = film.time[:moving], []
    for rows in (*film.place[:moving].T, turning.angle[:moving]):
        kept = np.isfinite(rows)
        for _ in range(_ROUNDS):
            degree = min(_DEGREE, max(int(kept.sum()) // 4, 2))
            one = Chebyshev.fit(t[kept], rows[kept], degree, [0.0, float(t[-1])])
            off = np.abs(rows - one(t))
            again = np.isfinite(rows) & (off <= _FAR * 1.48 * max(np.nanmedian(off), 1e-300))
            if np.array_equal(again, kept) or again.sum() < 2 * degree:
                break
            kept = again
        smooth.append(one)
    return smooth


def _slowing(
    at: FloatArray, v: FloatArray, rim: FloatArray, gyration: float
) -> tuple[FloatArray, FloatArray]:
    """What friction over g, drag, air and drag of the spin do to speeds of centre and rim (2n, 4).

    And what these lost (2n,).
    """
    turn = np.abs(rim)
    slip = np.maximum(np.maximum(v, turn), 1e-300)
    fast = (turn > v).astype(np.float64)
    a, _, d = closed_form.shape_integrals(np.minimum(v, turn) / slip, fast)
    whole = np.maximum(np.hypot(v, turn), 1e-300)
    none = np.zeros(at.size)
    ahead = np.stack([v / whole * a, v, v * v, none])
    turned = np.stack([turn / whole * d / gyration**2, turn, none, turn])
    steps = np.diff(at)

    def summed(rates: FloatArray) -> FloatArray:
        parts = 0.5 * steps * (rates[:, 1:] + rates[:, :-1])
        return np.concatenate([np.zeros((len(rates), 1)), np.cumsum(parts, axis=1)], axis=1)

    columns = np.concatenate([summed(ahead), summed(turned)], axis=1).T
    return columns, np.concatenate([v[0] - v, turn[0] - turn])
