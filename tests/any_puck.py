"""Stops of any puck by scipy on truth friction: no table, no spline, none of the program's motion.

In τ with dt = Q dτ (J = r = 1) the complex velocity V and the rim speed w obey

    d ln V/dτ = −(ρ∥ + i sin φ ρ⊥),   d ln w/dτ = −(r²/2k²) ρω,   dt/dτ = Q,   dp/dτ = QV .
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from puck_tables.contact.laws import law_of


def stops_by_truth(
    law: str, delta: float, gyration: float, u: np.ndarray, rtol: float = 3e-13
) -> np.ndarray:
    """T, X, Y, path length and body angle of launches at u = ln(rω/v), Q = 1; (5, n)."""
    pressure, n = law_of(law), u.size
    large = -0.5 * np.log1p(np.exp(-2.0 * np.abs(u)))
    start = np.zeros((8, n))
    start[0], start[2] = large - np.maximum(u, 0.0), large + np.minimum(u, 0.0)

    def rates(_: float, flat: np.ndarray) -> np.ndarray:
        log_v, turn, log_w = flat.reshape(8, n)[:3]
        phi = np.arctan(np.exp(np.clip(log_w - log_v, -700.0, 700.0)))
        rho = pressure.friction(phi, delta)
        v, w = np.exp(log_v), np.exp(log_w)
        q = np.hypot(v, w)
        return np.concatenate([
            -rho.parallel, -np.sin(phi) * rho.perpendicular, -rho.spin / (2.0 * gyration**2),
            q, q * v * np.cos(turn), q * v * np.sin(turn), q * v, q * w,
        ])  # fmt: skip

    slowest = 1.0 / min(1.0, 0.3 / gyration**2)
    solution = solve_ivp(
        rates, (0.0, 30.0 * slowest), start.ravel(), "DOP853", rtol=rtol, atol=1e-14,
    )  # fmt: skip
    assert solution.success
    return solution.y[:, -1].reshape(8, n)[3:]
