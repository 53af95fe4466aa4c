"""Where a launched puck is at the moments of a film, and how that depends on what is to be found.

Dry friction alone is looked up, or integrated (:mod:`puck_tables.fitting.unit_motions`).

Drag c, in 1/s, that brakes speed and spin alike, v′ = … − c v, ω′ = … − c ω, needs no motion of its
own: v = e^(−ct) V(s), ω = e^(−ct) W(s) with s = (e^(ct) − 1)/c, where V and W are those without
drag, since dry friction depends on their direction only.  So place = ∫ V ds/(1 + cs)², by parts

    place = X(s)/(1 + cs)² + 2c ∫ X ds/(1 + cs)³ ,

and so for every derivative of it.  Drag of the speed squared, or of the spin alone, is integrated
(:mod:`puck_tables.fitting.speed_motion`).  For a homogeneous flat puck under uniform pressure
linear drag is the law f(u) = f + (c/g) u of a coefficient that rises (c > 0) or falls (c < 0) with
the slip speed u.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.speed_motion import SpeedFriction, speed_path
from puck_tables.fitting.unit_motions import UnitMotions

_SPEED_STEP = 1e-6
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)

VX, VY, SPIN, DELTA, DECEL, RADIUS, TIME = range(7)  # what states are differentiated to
PLACE, RATE = slice(0, 3), slice(3, 6)  # of a state: x, y, angle and vx, vy, spin


class Moving(NamedTuple):
    """What moves a puck: the scale J m/s², δ, r m, drag c 1/s, and its motions.

    ``by_speed``: f over slip speed, or drags of another kind, in place of the motions; J and δ are
    then those at rest.
    """

    decel: float
    delta: float
    radius: float
    drag: float
    motions: UnitMotions
    by_speed: SpeedFriction | None = None

    def arguments(self, launch: FloatArray) -> FloatArray:
        """Of a launch (6,), what states are differentiated to: vx, vy, ω, δ, J, r."""
        return np.array([*launch[2:5], self.delta, self.decel, self.radius])


def states_of(moving: Moving, launch: FloatArray, times: FloatArray) -> FloatArray:
    """States (6, n) at times (n,) s after a launch: x, y (m), angle (rad), vx, vy (m/s), spin.

    ``launch`` (6,): x, y, vx, vy, spin, angle.

    Examples
    --------
    >>> from puck_tables.fitting.unit_motions import unit_motions_of
    >>> plain = Moving(1.0, 0.5, 1.0, 0.0, unit_motions_of("uniform", 0.5**0.5))
    >>> launch = np.array([0.0, 0.0, 1.0, 0.0, 5.0, 0.0])
    >>> states_of(plain, launch, np.array([2.0]))[0].round(6).tolist()
    [1.590682]
    """
    return _placed(launch, _path(moving, launch, times, False)[0])


def states_and_slopes(
    moving: Moving, launch: FloatArray, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """States (6, n), and their derivatives (n, 6, 7) to vx, vy, ω, δ, J, r and time."""
    states, slopes = _path(moving, launch, times, True)
    return _placed(launch, states), slopes


def _placed(launch: FloatArray, states: FloatArray) -> FloatArray:
    states[PLACE] += launch[[0, 1, 5], None]
    return states


def _path(
    moving: Moving, launch: FloatArray, times: FloatArray, want: bool
) -> tuple[FloatArray, FloatArray]:
    """States from (0, 0) on, and derivatives if they are wanted."""
    c, at = moving.drag, moving.arguments(launch)
    if not at[:3].any():
        return np.zeros((6, times.size)), np.zeros((times.size, 6, 7))
    if moving.by_speed is not None:
        return _by_speed(moving.by_speed, at, times, want)
    if c == 0.0:
        return _without_drag(moving, at, times, want)
    s = np.expm1(c * times) / c
    ends = np.concatenate([[0.0], s])
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    inner = middle[:, None] + half[:, None] * _POINTS
    states, slopes = _without_drag(moving, at, np.concatenate([s, inner.ravel()]), want)
    weights = half[:, None] * _WEIGHTS / (1.0 + c * inner) ** 3
    slower = np.exp(-c * times)

    def dragged(rows: FloatArray) -> FloatArray:
        """Of places (3, …) and rates (3, …) over all times those at the moments themselves."""
        result: FloatArray = rows[..., : s.size] * slower
        within = rows[PLACE, ..., s.size :].reshape(3, *rows.shape[1:-1], s.size, _POINTS.size)
        integral = np.cumsum((within * weights).sum(axis=-1), axis=-1)
        result[PLACE] = rows[PLACE, ..., : s.size] / (1.0 + c * s) ** 2 + 2.0 * c * integral
        return result

    moved = dragged(states)
    if not want:
        return moved, slopes
    out = np.moveaxis(dragged(np.moveaxis(slopes, 0, 2)), 2, 0)
    out[:, PLACE, TIME] = moved[RATE].T
    out[:, RATE, TIME] = slopes[: s.size, RATE, TIME] - c * moved[RATE].T
    return moved, out


def _without_drag(
    moving: Moving, at: FloatArray, times: FloatArray, want: bool
) -> tuple[FloatArray, FloatArray]:
    if want:
        return moving.motions.states_and_slopes(at, times)
    return moving.motions.states(at[:, None], times[None])[:, 0], np.empty((0, 6, 7))


def _by_speed(
    friction: SpeedFriction, at: FloatArray, times: FloatArray, want: bool
) -> tuple[FloatArray, FloatArray]:
    """The same where friction depends on the slip speed: no similarity, so all by differences.

    J does nothing, its place is taken by the numbers of the law.
    """
    height = friction.gravity / at[DECEL]  # δ times it is 2h/r

    def path(by: FloatArray, times: FloatArray) -> FloatArray:
        velocity, spin, delta, radius = by[:2], float(by[SPIN]), by[DELTA], float(by[RADIUS])
        moved = speed_path(friction, delta * height, radius, velocity, spin, times)
        return np.concatenate(moved)

    instant = _SPEED_STEP * (float(times.max(initial=0.0)) or 1.0)
    result, later = np.split(path(at, np.concatenate([times, times + instant])), 2, axis=1)
    out = np.zeros((times.size, 6, 7))
    if not want:
        return result, out
    scale = max(abs(at[VX]), abs(at[VY]), at[RADIUS] * abs(at[SPIN]))
    steps = {VX: scale, VY: scale, SPIN: scale / at[RADIUS], DELTA: 1.0, RADIUS: at[RADIUS]}
    for k, size in steps.items():
        step = np.zeros(6)
        step[k] = _SPEED_STEP * size
        out[:, :, k] = ((path(at + step, times) - result) / step[k]).T
    out[:, PLACE, TIME], out[:, RATE, TIME] = result[RATE].T, (later - result)[RATE].T / instant
    return result, out
