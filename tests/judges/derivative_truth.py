"""Derivatives of plain motions by the complex step: no difference, so no digit is lost.

A puck is integrated in complex numbers with one argument of the launch moved by 1e-40 i; imaginary
parts over 1e-40 are derivatives.  Friction from an arithmetic-geometric mean of its own, the motion
in Runge-Kutta steps of order 8 (coefficients from scipy) over u = ln(r|ω|/v) as far as φ = π/4,
where the friction is not smooth, and over −ln Q from there, the steps graded towards that place.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as dop

STEP = 1e-40
LAST = 40.0  # −ln of the share of Q that is left where a stop ends
STEPS = 40
U, PSI, LOG, TIME, X, Y, BODY, LENGTH = range(8)


def shapes(far: np.ndarray, fast: np.ndarray) -> tuple[np.ndarray, ...]:
    """p_a, p_b, p_d from |ln(r|ω|/v)|, by elliptic integrals of modulus k = min/max."""
    m = np.exp(-2.0 * far)
    a, b = np.ones_like(m), np.sqrt(-np.expm1(-2.0 * far))
    total, weight, e = 0.0, 1.0, None
    for _ in range(11):
        a, b = 0.5 * (a + b), np.sqrt(a * b)
        e = 0.25 / a if e is None else m * e * e / (4.0 * a)
        weight *= 2.0
        total = total + weight * e * e
    kk = 0.5 * math.pi / a
    g = kk * total
    d = 0.5 * (kk + m * g)
    e = kk - m * d
    larger = 1.0 / np.sqrt(1.0 + m)
    p_a = 4.0 / 3.0 * (e + kk - d)
    b_fast = -4.0 / 15.0 * d + (28.0 * e + 8.0 * kk) / 45.0 + m * (4.0 * kk - 8.0 * e) / 45.0
    d_fast = (16.0 * e - 4.0 * kk) / 9.0 + m * (4.0 * kk - 8.0 * e) / 9.0
    b_slow = (4.0 * e + 8.0 * kk) / 15.0 + (4.0 * g - 28.0 * d) / 45.0
    d_slow = 4.0 / 3.0 * kk + (4.0 * g - 16.0 * d) / 9.0
    unit = 1.0 / (math.pi * larger)
    return p_a * unit, np.where(fast, b_fast, b_slow) * unit, np.where(fast, d_fast, d_slow) * unit


def by_log(y: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """d/d ln Q of u, ψ, ln Q, t, x, y, body angle, path; J = r = 1, spin positive."""
    u = y[U]
    fast = u.real > 0.0
    far = np.where(fast, u, -u)
    k = np.exp(-far)
    large = 1.0 / np.sqrt(1.0 + k * k)
    s, c = np.where(fast, large, k * large), np.where(fast, k * large, large)
    a, b, d = shapes(far, fast)
    below = 1.0 - delta**2 * s**2 * b * (b - d)
    along, across = a / below, delta * a * b / below
    spin = 2.0 * (d + delta**2 * c**2 * a * b * (d - 2.0 * b) / below)
    brake = c**2 * along + s**2 * spin  # −Q'
    q = np.exp(y[LOG])
    return np.stack([
        -(along - spin) / brake, s * across / brake, np.ones_like(u), -q / brake,
        -q * q * c * np.cos(y[PSI]) / brake, -q * q * c * np.sin(y[PSI]) / brake,
        -q * q * s / brake, -q * q * c / brake,
    ])  # fmt: skip


def marched(y, delta, end, over_u: bool, grade_start: float, grade_end: float, steps: int):
    """The motion until u is 0 (or −ln Q is ``end``); steps graded towards start and end."""
    start = y[U] if over_u else -y[LOG]
    span = end - start

    def rates(sigma: float, y: np.ndarray) -> np.ndarray:
        if over_u:  # to the last digit, also next to 0
            y[U] = start * (1.0 - sigma) ** grade_end
        f = by_log(y, delta)
        stretch = sigma ** (grade_start - 1) * grade_start if grade_start > 1 else 1.0
        if grade_end > 1:
            stretch = grade_end * (1.0 - sigma) ** (grade_end - 1)
        return f * (span * stretch / (f[U] if over_u else -1.0))

    h = 1.0 / steps
    for n in range(steps):
        stages = []
        for j in range(12):
            z = y.copy()
            for w, f in zip(dop.A[j], stages, strict=False):
                if w:
                    z = z + (h * w) * f
            stages.append(rates((n + dop.C[j]) * h, z))
        y = y + h * sum(w * f for w, f in zip(dop.B, stages, strict=True))
    return y


def moved(launches: np.ndarray, share: np.ndarray | None, steps: int = STEPS) -> tuple:
    """Time, x, y, path, body angle, vx, vy, ω where Q has fallen to ``share`` (None: the stop).

    Launches (6, n), complex.  Also the derivatives of all by ln Q.
    """
    vx, vy, spin, delta, decel, radius = launches
    around = np.where(spin.real >= 0.0, 1.0, -1.0)
    v, a = np.sqrt(vx * vx + vy * vy), around * radius * spin
    q0 = np.sqrt(v * v + a * a)
    y = np.zeros((8, v.size), complex)
    y[U], y[LOG] = np.log(a / v), 0.0
    last = np.full(v.size, LAST) if share is None else -np.log(share)
    over = y[U].real >= 0.0
    for near in (True, False):  # next to pure sliding what counts grows as e^(4u): finer steps
        slow = np.flatnonzero((y[U].real < 0.0) & ((y[U].real > -4.0) == near) & ~over)
        if not slow.size:
            continue
        longest = float(np.abs(y[U, slow].real).max())
        count = math.ceil(steps * max(1.0, 0.2 * longest**2))
        crossed = marched(y[:, slow], delta[slow], 0.0, True, 1, 4, count)
        past = -crossed[LOG].real < last[slow]
        y[:, slow[past]] = crossed[:, past]
        y[U, slow[past]] = 1e-300  # beyond
        over[slow[past]] = True
    early, rest = np.flatnonzero(~over), np.flatnonzero(over)
    y[:, early] = marched(y[:, early], delta[early], last[early], False, 1, 4, 4 * steps)
    y[:, rest] = marched(y[:, rest], delta[rest], last[rest], False, 4, 1, 3 * steps)
    slope = by_log(y, delta)
    if share is None:
        y[PSI] = 0.0  # turns without end
    e = vx / v, vy / v

    def physical(y, q0, e, decel, radius) -> list:
        q = q0 * np.exp(y[LOG])
        c = 1.0 / np.sqrt(1.0 + np.exp(2.0 * y[U]))
        s = 1.0 / np.sqrt(1.0 + np.exp(-2.0 * y[U]))
        x, left = y[X], around * y[Y]
        wx, wy = q * c * np.cos(y[PSI]), around * q * c * np.sin(y[PSI])
        unit = q0 * q0 / decel
        return [
            q0 / decel * y[TIME], unit * (x * e[0] - left * e[1]), unit * (x * e[1] + left * e[0]),
            unit * y[LENGTH], around * unit / radius * y[BODY], wx * e[0] - wy * e[1],
            wx * e[1] + wy * e[0], around * q * s / radius,
        ]  # fmt: skip

    here = np.stack(physical(y, q0, e, decel, radius))
    fixed = q0.real, (e[0].real, e[1].real), decel.real, radius.real
    onward = np.stack(physical(y.real + 1j * STEP * slope.real, *fixed)).imag / STEP
    return here, onward


def derivatives(launches: np.ndarray, share: np.ndarray | None = None, steps: int = STEPS):
    """Values (8, n), their derivatives (8, 6, n) by vx, vy, ω, δ, J, r, and (8, n) by ln Q."""
    count = launches.shape[1]
    arguments = np.tile(launches.astype(complex), 6)  # all columns at once
    for column in range(6):
        arguments[column, column * count : (column + 1) * count] += 1j * STEP
    here, onward = moved(arguments, None if share is None else np.tile(share, 6), steps)
    columns = (here.imag / STEP).reshape(8, 6, count)
    return here.real[:, :count], columns, onward[:, :count]


def stop_truth(launches: np.ndarray, steps: int = STEPS) -> tuple[np.ndarray, np.ndarray]:
    """Time, x, y, path, body angle of stops (5, n), and derivatives (5, 6, n)."""
    here, columns, _ = derivatives(launches, None, steps)
    return here[:5], columns[:5]


def state_truth(
    launches: np.ndarray, share: np.ndarray, steps: int = STEPS
) -> tuple[np.ndarray, ...]:
    """Times (n,) when Q has fallen to ``share``, states there (6, n): x, y, body angle, vx, vy, ω.

    And their derivatives (6, 7, n) by vx, vy, ω, δ, J, r at that time, and by the time.
    """
    here, columns, onward = derivatives(launches, share, steps)
    rows = [1, 2, 4, 5, 6, 7]
    by_time = onward[rows] / onward[0]
    fixed = columns[rows] - by_time[:, None] * columns[0]
    return here[0], here[rows], np.concatenate([fixed, by_time[:, None]], axis=1)
