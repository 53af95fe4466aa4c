"""A flat disc under friction over the slip speed, on a floor that slopes or moves, with drags.

Friction is summed over circles about the instantaneous centre of rotation, at 200 Gauss nodes; the
motion is integrated by scipy until the slip is ``until``, and then goes with the floor.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from film_judge import G
from scipy.integrate import solve_ivp

Law = Callable[[np.ndarray], np.ndarray]
_X, _W = np.polynomial.legendre.leggauss(200)
_X, _W = 0.5 * (_X + 1.0), 0.5 * _W


def friction(law: Law, v: float, rim: float) -> tuple[float, float]:
    """Force and torque over the weight, the latter over the radius, too, at speeds v, rim ≥ 0."""
    if rim < 1e-9 * v:
        return float(law(np.array([v]))[0]), 0.0
    s = v / rim
    near, far = abs(1.0 - s), 1.0 + s
    at = near + (far - near) * np.sin(0.5 * math.pi * _X) ** 2
    weight = 0.5 * math.pi * (far - near) * np.sin(math.pi * _X) * _W * law(rim * at) * at
    cosine = (at**2 + s**2 - 1.0) / (2.0 * at * s) if s > 0.0 else np.full(at.size, -1.0)
    half = np.arccos(np.clip(cosine, -1.0, 1.0))  # of the arc within the disc
    force = np.sum(weight * 2.0 * np.sin(half))
    torque = np.sum(weight * 2.0 * (half * at - s * np.sin(half)))
    if s < 1.0:  # whole circles
        inner = near * _X
        torque += 2.0 * math.pi * near * np.sum(_W * law(rim * inner) * inner**2)
    return float(force) / math.pi, float(torque) / math.pi


def slid(
    law: Law, radius: float, velocity: tuple[float, float], spin: float, times: np.ndarray, *,
    push: tuple[float, float] = (0.0, 0.0), belt: tuple[float, float] = (0.0, 0.0),
    drag: float = 0.0, air: float = 0.0, spin_drag: float = 0.0, until: float = 1e-4,
) -> np.ndarray:  # fmt: skip
    """x, y, angle (3, n) at times from 0 s on.

    ``push`` m/s², ``belt`` m/s, ``drag`` 1/s of speed and spin, ``air`` 1/m, ``spin_drag`` 1/s.
    """

    def rates(_: float, z: np.ndarray) -> list[float]:
        ahead, aside = z[3] - belt[0], z[4] - belt[1]
        v = math.hypot(ahead, aside)
        force, torque = friction(law, v, radius * abs(z[5]))
        braked = G * force / max(v, 1e-300) + drag + air * v
        turned = -2.0 * G * torque / radius * math.copysign(1.0, z[5]) - (drag + spin_drag) * z[5]
        return [*z[3:], push[0] - braked * ahead, push[1] - braked * aside, turned]

    def rests(_: float, z: np.ndarray) -> float:
        return math.hypot(z[3] - belt[0], z[4] - belt[1], radius * z[5]) - until

    rests.terminal = True
    start = [0.0, 0.0, 0.0, *velocity, spin]
    run = solve_ivp(
        rates, (0.0, times[-1]), start, "DOP853", rtol=1e-9, atol=1e-11, dense_output=True,
        events=rests,
    )  # fmt: skip
    moving = np.minimum(times, run.t[-1])
    out = run.sol(moving)[:3]
    out[:2] += np.outer(belt, times - moving)
    return out
