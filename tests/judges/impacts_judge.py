"""Films of pucks that meet walls or each other: slides by scipy, impacts by their law, written out.

Motions are those of ``film_judge``; the moment of an impact is a root of scipy's ``brentq``, bounds
are differences of whole films.
"""

from __future__ import annotations

import math

import film_judge
import numpy as np
from scipy.optimize import brentq

_SHORT = 1e-6


def state(motion: tuple, launch: np.ndarray, time: float) -> np.ndarray:
    """x, y, vx, vy, spin, angle of a launch (6,) of the same after a time; motion: J, δ, r."""
    x, y, vx, vy, spin, angle = launch.tolist()
    if not (vx or vy or spin):
        return launch.copy()
    at = np.array([max(time - _SHORT, 0.0), time, time + _SHORT])
    path = film_judge.path((vx, vy), spin, *motion, at)
    rate = (path[:, 2] - path[:, 0]) / (at[2] - at[0]) if time > 0.0 else launch[2:5]
    return np.array([x + path[0, 1], y + path[1, 1], *rate, angle + path[2, 1]])


def path(motion: tuple, launch: np.ndarray, times: np.ndarray) -> np.ndarray:
    """x, y, angle (3, n) at times after a launch, from 0 on."""
    x, y, vx, vy, spin, angle = launch.tolist()
    if not (vx or vy or spin):
        return np.outer([x, y, angle], np.ones(times.size))
    found = film_judge.path((vx, vy), spin, *motion, np.maximum(times, 0.0))
    return found + np.array([[x], [y], [angle]])


def _pushed(one: np.ndarray, n: np.ndarray, push: float, rub: float, radius: float) -> np.ndarray:
    """A homogeneous disc of mass 1 after impulses −push n − rub t at the rim towards n."""
    out = one.copy()
    out[2:4] -= push * n + rub * np.array([-n[1], n[0]])
    out[4] -= 2.0 * rub / radius
    return out


def wall_film(
    motion: tuple, launch: np.ndarray, walls: list[tuple[float, float]], hits: list[float],
    rims: tuple[float, float], times: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """A film (3, n) of a puck that meets walls (angle, distance) one after the other.

    ``hits``: about when; ``rims``: restitution, friction (and a tangential restitution of 0).
    """
    since, out = 0.0, np.empty((3, times.size))
    for wall, about in zip(walls, hits, strict=True):
        hit, after = after_wall(motion, launch, wall, about - since, rims)
        mine = (times >= since) & (times < since + hit)
        out[:, mine] = path(motion, launch, times[mine] - since)
        launch, since = after, since + hit
    mine = times >= since
    out[:, mine] = path(motion, launch, times[mine] - since)
    return out


def after_wall(
    motion: tuple, launch: np.ndarray, wall: tuple[float, float], about: float,
    rims: tuple[float, float],
) -> tuple[float, np.ndarray]:  # fmt: skip
    """When a puck meets a wall, s after its launch, and how it leaves."""
    radius, n = motion[2], np.array([math.cos(wall[0]), math.sin(wall[0])])

    def gap(t: float) -> float:
        return wall[1] - radius - float(n @ state(motion, launch, t)[:2])

    hit = brentq(gap, about - 0.03, about + 0.03, xtol=1e-13)
    at = state(motion, launch, hit)
    push = (1.0 + rims[0]) * float(at[2:4] @ n)
    slip = float(at[3] * n[0] - at[2] * n[1]) + radius * at[4]
    rub = math.copysign(min(rims[1] * push, abs(slip) / 3.0), slip)
    return hit, _pushed(at, n, push, rub, radius)


def pair_film(
    motion: tuple, launches: tuple[np.ndarray, np.ndarray], about: float,
    rims: tuple[float, float, float], times: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Films (3, n) of two pucks that meet; ``rims``: restitution, friction, second mass."""
    e, mu, mass = rims
    radius = motion[2]

    def gap(t: float) -> float:
        one, two = (state(motion, launch, t) for launch in launches)
        return math.hypot(*(two[:2] - one[:2])) - 2.0 * radius

    hit = brentq(gap, about - 0.03, about + 0.03, xtol=1e-13)
    one, two = (state(motion, launch, hit) for launch in launches)
    n = (two[:2] - one[:2]) / (2.0 * radius)
    reduced = mass / (1.0 + mass)
    push = (1.0 + e) * reduced * float((one[2:4] - two[2:4]) @ n)
    t = np.array([-n[1], n[0]])
    slip = float((one[2:4] - two[2:4]) @ t) + radius * (one[4] + two[4])
    rub = math.copysign(min(mu * push, abs(slip) * reduced / 3.0), slip)
    after = (
        _pushed(one, n, push, rub, radius),
        # seen from the second puck the first lies along −n, and its impulse is the opposite
        _pushed(two, -n, push / mass, rub / mass, radius),
    )
    films = []
    for launch, new in zip(launches, after, strict=True):
        films.append(
            np.where(times < hit, path(motion, launch, times), path(motion, new, times - hit))
        )
    return films[0], films[1]


def bound(film, truth: np.ndarray, scale: np.ndarray, noise: tuple[float, float]) -> np.ndarray:
    """Cramér–Rao bounds of the parameters of ``film(parameters) -> (3, n)``."""
    rows = []
    weights = np.array([[1.0 / noise[0]], [1.0 / noise[0]], [1.0 / noise[1]]])
    for k in range(truth.size):
        step = np.zeros(truth.size)
        step[k] = scale[k]
        rows.append(
            ((film(truth + step) - film(truth - step)) * weights / (2.0 * scale[k])).ravel()
        )
    matrix = np.array(rows)
    return np.sqrt(np.diag(np.linalg.inv(matrix @ matrix.T)))
