"""One-sided contact judged by strips: shares no code with the package.

The pressure ξ = n·(x, y) − d is constant along strips parallel to the chord, and friction along a
straight strip is elementary; scipy integrates over the strips and finds the balance.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import quad
from scipy.optimize import root


def load_and_lever(d: float) -> tuple[float, float]:
    """∫ξ over the loaded segment and the mean of n·(x, y)."""
    last = math.acos(max(d, -1.0))

    def strip(t: float, power: int) -> float:
        return 2.0 * (math.cos(t) - d) * math.sin(t) ** 2 * math.cos(t) ** power

    load, moment = (quad(strip, 0.0, last, (k,), epsabs=0.0, epsrel=1e-13)[0] for k in (0, 1))
    return load, moment / load


def friction(phi: float, d: float, gamma: float) -> tuple[float, float, float]:
    """Means over the load: slip direction along and across, distance from the slip centre."""
    s = 1.0 / math.tan(phi)
    centre_n, centre_t = s * math.sin(gamma), s * math.cos(gamma)

    def strip(t: float, which: int) -> float:
        p, half = math.cos(t) - centre_n, math.sin(t)
        ends = []
        for q in (-half - centre_t, half - centre_t):
            distance = math.hypot(p, q)
            turn = math.asinh(q / abs(p)) if p != 0.0 else 0.0
            ends.append((-distance, p * turn, 0.5 * (q * distance + p * p * turn))[which])
        return (math.cos(t) - d) * half * (ends[1] - ends[0])

    last = math.acos(max(d, -1.0))
    points = [math.acos(centre_n)] if max(d, -1.0) < centre_n < 1.0 else None
    load = load_and_lever(d)[0]
    n, t, distance = (
        quad(strip, 0.0, last, (k,), epsabs=1e-14 * load, epsrel=1e-13, limit=400, points=points)[0]
        / load
        for k in range(3)
    )
    cosine, sine = math.cos(gamma), math.sin(gamma)
    return n * cosine - t * sine, n * sine + t * cosine, distance


def balance(phi: float, delta: float, start: tuple[float, float]) -> tuple[float, float]:
    """(d, γ) with ⟨(x, y)⟩ = (δ/4) ⟨slip direction⟩, from a start near by."""

    def residual(z: np.ndarray) -> list[float]:
        along, across, _ = friction(phi, z[0], z[1])
        lever = load_and_lever(z[0])[1]
        return [
            lever * math.cos(z[1]) - 0.25 * delta * along,
            lever * math.sin(z[1]) - 0.25 * delta * across,
        ]

    solution = root(residual, start, tol=1e-14)
    assert np.abs(residual(solution.x)).max() < 1e-12, solution.message
    return float(solution.x[0]), float(solution.x[1])


def resultants(phi: float, delta: float, start: tuple[float, float]) -> tuple[float, float, float]:
    """ρ_∥, ρ_⊥, ρ_ω of one-sided contact."""
    along, across, distance = friction(phi, *balance(phi, delta, start))
    sine, cosine = math.sin(phi), math.cos(phi)
    torque = distance - along * cosine / sine  # about the disc's centre
    return along / cosine, across / (sine * cosine), 2.0 * torque / sine
