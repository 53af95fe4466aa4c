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
    return _motion(law, delta, gyration, u, rtol)[-1, 3:]


def motion_by_truth(
    law: str, delta: float, gyration: float, u: float
) -> tuple[np.ndarray, np.ndarray]:
    """T, X, Y, path length and body angle (5,), and v, ψ, rω, t, x, y, θ of states (n, 7)."""
    fast = min(1.0, gyration**2)
    moments = np.concatenate([fast * np.geomspace(0.01, 5.0, 12), np.geomspace(0.1, 12.0, 12)])
    rows = _motion(law, delta, gyration, np.array([u]), 3e-14, np.sort(moments))[:, :, 0]
    states = np.delete(rows[:-1], 6, axis=1)
    states[:, [0, 2]] = np.exp(states[:, [0, 2]])
    return rows[-1, 3:], states


def _motion(
    law: str, delta: float, gyration: float, u: np.ndarray, rtol: float,
    moments: np.ndarray | None = None,
) -> np.ndarray:  # fmt: skip
    """Ln v, ψ, ln rω, t, x, y, path length, θ at τ ``moments`` and at the stop, (…, 8, n)."""
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
    end = 30.0 * slowest
    solution = solve_ivp(
        rates, (0.0, end), start.ravel(), "DOP853", rtol=rtol, atol=1e-14,
        t_eval=np.append([] if moments is None else moments, end),
    )  # fmt: skip
    assert solution.success
    return solution.y.T.reshape(-1, 8, n)
