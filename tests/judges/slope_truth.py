"""Derivatives of the motions of any puck by scipy on the judge's own quadrature of friction.

In τ with dt = Q dτ (Q = J = r = 1 at the launch) ln v, ψ and ln rω have rates that only depend on
the slip angle.  By the speeds of the launch and by the radius of gyration: complex steps, friction
continued by its Chebyshev series, or differences of order 6.  By δ: differences, friction anew at
every height.
"""

from __future__ import annotations

import math

import numpy as np
from contact_truth import NODES, tabled
from scipy.integrate import solve_ivp

STEP, APART, SHARE = 1e-30, 0.02, 0.025
BESIDE = 2e-3  # of a speed: a step that does not reach a line 0.01 rad away
# complex steps err by up to 5e-7 in narrow panels of the series, differences across a line
WAYS = ({"near": True}, {"share": BESIDE})
WEIGHTS = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
TIME, X, Y, LENGTH, BODY, VX, VY, RIM = range(8)


def friction(law: str, delta: float, phi: np.ndarray) -> np.ndarray:
    """F_∥/cos φ, F_⊥/(sin φ cos φ), M/sin φ at complex slip angles, (3, n)."""
    ends, series = tabled(law, delta)
    panel = np.clip(np.searchsorted(ends, phi.real, side="right") - 1, 0, len(series) - 1)
    low, high = ends[panel], ends[panel + 1]
    x = (2.0 * phi - low - high) / (high - low)
    one, two = np.zeros((3, phi.size), complex), np.zeros((3, phi.size), complex)
    for j in range(NODES - 1, 0, -1):
        one, two = series[panel, :, j].T + 2.0 * x * one - two, one
    return series[panel, :, 0].T + x * one - two


def moved(law: str, delta: float, square: complex, v, w, moments) -> np.ndarray:
    """t, x, y, path, body angle, vx, vy, rω at moments of τ, and their rates; (2, 8, m, n).

    ``square``: k²/r²; ``v``, ``w`` (n,): v and rω at the launch.
    """
    n = v.size
    start = np.zeros((8, n), complex)
    start[0], start[2] = np.log(v), np.log(w)

    def rates(_: float, flat: np.ndarray) -> np.ndarray:
        log_v, turn, log_w = flat.reshape(8, n)[:3]
        ratio = np.exp(log_w - log_v)
        along, across, torque = friction(law, delta, np.arctan(ratio))
        speed, rim = np.exp(log_v), np.exp(log_w)
        q = np.sqrt(speed**2 + rim**2)
        return np.concatenate([
            -along, -rim / q * across, -torque / square, q, q * speed * np.cos(turn),
            q * speed * np.sin(turn), q * speed, q * rim,
        ])  # fmt: skip

    found = solve_ivp(
        rates, (0.0, moments[-1]), start.ravel(), "DOP853", rtol=3e-13, atol=1e-15, t_eval=moments
    )
    assert found.success
    states = found.y.T.reshape(len(moments), 8, n)
    onward = np.array([rates(0.0, y).reshape(8, n) for y in found.y.T])
    log_v, turn, log_w, *rest = np.moveaxis(states, 1, 0)
    d_log_v, d_turn, d_log_w, *d_rest = np.moveaxis(onward, 1, 0)
    speed, rim = np.exp(log_v), np.exp(log_w)
    vx, vy = speed * np.cos(turn), speed * np.sin(turn)
    d_vx, d_vy = d_log_v * vx - d_turn * vy, d_log_v * vy + d_turn * vx
    return np.stack(
        [np.stack([*rest, vx, vy, rim]), np.stack([*d_rest, d_vx, d_vy, d_log_w * rim])]
    )


def slopes(
    law: str, delta: float, gyration: float, phi: np.ndarray, moments, near: bool,
    share: float = SHARE,
) -> tuple:  # fmt: skip
    """Values (8, m, n), derivatives by v, rω, k/r, δ at equal τ (4, 8, m, n), rates (8, m, n).

    ``near``: what is next to a line, by the speeds in complex steps; else by differences, which
    a rough derivative of the series does not hurt.
    """
    v, w = np.cos(phi) + 0j, np.sin(phi) + 0j
    values, rates = moved(law, delta, gyration**2, v, w, moments).real

    def at(row: int, shift) -> np.ndarray:
        dv, dw, dk, dh = (shift if n == row else 0.0 for n in range(4))
        return moved(law, delta + dh, (gyration + dk) ** 2, v + dv, w + dw, moments)[0]

    by = []
    for row, h in enumerate([share * v.real, share * w.real, APART, APART]):
        if near and row < 3:
            by.append(at(row, 1j * STEP).imag / STEP)
        else:
            by.append(sum(
                sign * weight / h * at(row, sign * n * h).real
                for n, weight in WEIGHTS.items() for sign in (1.0, -1.0)
            ))  # fmt: skip
    return values, np.stack(by), rates


def stop_slopes(
    law: str, delta: float, gyration: float, phi: np.ndarray, near: bool = False,
    share: float = SHARE,
) -> np.ndarray:  # fmt: skip
    """By v, rω, k/r, δ of time, x, y, path, body angle of stops from the launch at φ; (4, 5, n)."""
    slowest = max(1.0, 3.0 * gyration**2)
    return slopes(law, delta, gyration, phi, np.array([32.0 * slowest]), near, share)[1][:, :5, 0]


def state_slopes(
    law: str, delta: float, gyration: float, phi: np.ndarray, moments: np.ndarray,
    near: bool = False,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Times (m, n), x, y, body angle, vx, vy, rω (6, m, n), by v, rω, k/r, δ, t (5, 6, m, n)."""
    values, by, rates = slopes(law, delta, gyration, phi, moments, near)
    rows = [X, Y, BODY, VX, VY, RIM]
    by_time = rates[rows] / rates[TIME]
    fixed = by[:, rows] - by_time * by[:, None, TIME]
    return values[TIME], values[rows], np.concatenate([fixed, by_time[None]])


def next_to(*places: float) -> np.ndarray:
    """Slip angles on both sides of places, at 1e-2 … 1e-6."""
    near = [at + side * off for at in places for off in (1e-2, 1e-4, 1e-6) for side in (-1, 1)]
    return np.array([phi for phi in near if 0.0 < phi < 0.5 * math.pi])
