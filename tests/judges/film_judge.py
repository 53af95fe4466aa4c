"""Films of pucks by scipy: the judge of fits, which shares no code with what it judges.

Motions are integrated in Cartesian velocities over time (DOP853) with the elliptic integrals of
``reference.py``; derivatives are differences of such motions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from reference import friction
from scipy.integrate import solve_ivp

G = 9.80665
_REST = 1e-6  # of Q: slower, it is at rest
Besides = Callable[[float, np.ndarray, float], Any]


def path(
    velocity: tuple[float, float], spin: float, decel: float, delta: float, radius: float,
    times: np.ndarray, drag: float = 0.0, besides: Besides | None = None,
) -> np.ndarray:  # fmt: skip
    """x, y and angle (3, n) at times after a launch at the origin.

    ``besides``: what else speeds it up (m/s^2 along x, y, rad/s^2), of time, velocity and spin.
    """
    slip = math.hypot(*velocity, radius * spin)

    def speed(_: float, z: np.ndarray) -> float:
        return math.hypot(z[0], z[1], z[2]) - _REST

    def rates(s: float, z: np.ndarray) -> list[float]:
        if speed(0.0, z) <= -0.5 * _REST:
            return [0.0] * 6
        if abs(z[2]) <= 1e-13 * math.hypot(z[0], z[1]):
            v = math.hypot(z[0], z[1])
            pull = (-z[0] / v, -z[1] / v, 0.0)
        else:
            pull = friction(z[0], z[1], z[2], delta)
        c = drag * slip / decel
        more = (0.0, 0.0, 0.0)
        if besides is not None:
            more = besides(s * slip / decel, slip * z[:2], slip * z[2] / radius)
        units = (decel, decel, decel / radius)
        return [pull[k] - c * z[k] + more[k] / units[k] for k in range(3)] + list(z[:3])

    speed.terminal = True  # type: ignore[attr-defined]
    start = [velocity[0] / slip, velocity[1] / slip, radius * spin / slip, 0.0, 0.0, 0.0]
    scaled = times * decel / slip
    found = solve_ivp(
        rates, (0.0, scaled[-1] + 1e-9), start, "DOP853", rtol=1e-11, atol=1e-13,
        dense_output=True, events=speed,
        max_step=np.inf if besides is None else (scaled[-1] + 1e-9) / 150.0,
    )  # fmt: skip
    z = found.sol(np.minimum(scaled, found.t[-1]))
    length = slip * slip / decel
    return np.stack([length * z[3], length * z[4], length / radius * z[5]])


def bound(
    velocity: tuple[float, float], spin: float, decel: float, delta: float, radius: float,
    times: np.ndarray, noise: tuple[float, float | None],
) -> tuple[float, float]:  # fmt: skip
    """The Cramér–Rao bounds of J (m/s²) and δ, with the launch unknown."""
    truth = np.array([*velocity, spin, decel, delta])
    rows = []
    for k in range(5):
        step = 1e-3 * max(abs(truth[k]), 0.1)
        ends = []
        for side in (1.0, -1.0):
            moved = truth.copy()
            moved[k] += side * step
            vx, vy, w, j, d = moved.tolist()
            ends.append(path((vx, vy), w, j, d, radius, times))
        rows.append((ends[0] - ends[1]) / (2.0 * step))
    weights = [1.0 / noise[0], 1.0 / noise[0]] + ([] if noise[1] is None else [1.0 / noise[1]])
    seen = len(weights)
    slopes = [(row[:seen] * np.array(weights)[:, None]).ravel() for row in rows]
    for k in range(seen):
        one = np.zeros((seen, times.size))
        one[k] = weights[k]
        slopes.append(one.ravel())
    matrix = np.array(slopes)
    covariance = np.linalg.inv(matrix @ matrix.T)
    return math.sqrt(covariance[3, 3]), math.sqrt(covariance[4, 4])


def noisy(
    rng: np.random.Generator, true: np.ndarray, noise: tuple[float, float], wrong: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2) and angles (n,) of a film; a share ``wrong`` of the frames is far off."""
    count = true.shape[1]
    place = true[:2].T + noise[0] * rng.normal(size=(count, 2))
    angle = true[2] + noise[1] * rng.normal(size=count)
    bad = rng.random(count) < wrong
    place[bad] += 30.0 * noise[0] * rng.normal(size=(int(bad.sum()), 2))
    angle[bad] += 30.0 * noise[1] * rng.normal(size=int(bad.sum()))
    return place, np.angle(np.exp(1j * angle))
