"""A puck integrated by scipy, sharing no code with the package: the judge of its motions.

Elliptic integrals from scipy.special in the textbook combinations (good to 1e-11 for slip angles
that stay away from π/4), Cartesian velocities, time as the variable.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipe, ellipk

# stop time, x, y for J = 1, r = 1, v0 = (1, 0), w0 = k; correct to 1e-11
REFERENCE_RUNS = {
    (0.0, 0.2): (1.028093244886, 0.505041851253, 0.0),
    (0.0, 1.0): (1.340298282117, 0.637397224134, 0.0),
    (0.0, 5.0): (3.951102459819, 2.198985451329, 0.0),
    (1.0, 0.2): (1.044729311045, 0.505527276998, -0.018324355294),
    (1.0, 1.0): (1.395087651842, 0.648187457324, -0.085949017034),
    (1.0, 5.0): (4.000188799127, 2.257241156461, -0.308477350409),
}


_SHARES = np.array([math.comb(2 * n, n) / 4.0**n for n in range(26)]) ** 2
_K = 0.5 * math.pi * _SHARES  # K(m) is the sum of _K m^n, E(m) that of _E m^n
_E = _K / (1.0 - 2.0 * np.arange(26))


def _terms(*parts: tuple[float, float, int]) -> np.ndarray:
    """Coefficients of the sum of (e E + k K) m^power; those of 1/m cancel."""
    total = np.zeros(25)
    for e, k, power in parts:
        some = e * _E + k * _K
        total += some[1:] if power < 0 else np.append(np.zeros(power), some[: 25 - power])
    return total


_A = 4 / 3 * _terms((1, 1, 0), (1, -1, -1))
_B_SPINNING = 4 / 45 * _terms((7, 2, 0), (-2, 1, 1), (3, -3, -1))
_D_SPINNING = 4 / 9 * _terms((4, -1, 0), (-2, 1, 1))
_B_SLIDING = 4 / 45 * _terms((7, -8, 0), (-2, 2, -1), (3, 6, 1))
_D_SLIDING = 4 / 9 * _terms((4, -5, 0), (-2, 2, -1), (0, 3, 1))


def sums(s: float) -> tuple[float, float, float]:
    """Elliptic integrals of friction at s = v/(rω); as power series where their terms cancel."""
    s = 1.0 - 1e-15 if s == 1.0 else s  # at 1 itself K is infinite, times 0
    if s < 0.25 or s > 4.0:
        powers = (s * s if s < 1.0 else 1.0 / (s * s)) ** np.arange(25)
        if s < 1.0:
            return s * _A @ powers, _B_SPINNING @ powers, _D_SPINNING @ powers
        return _A @ powers, s * _B_SLIDING @ powers, s * _D_SLIDING @ powers
    if s < 1:
        E, K = ellipe(s * s), ellipk(s * s)
        a = 4 / 3 * ((s + 1 / s) * E + (s - 1 / s) * K)
        b = 4 / 45 * ((7 - 2 * s**2 + 3 / s**2) * E + (2 + s**2 - 3 / s**2) * K)
        d = 4 / 9 * ((4 - 2 * s**2) * E + (s**2 - 1) * K)
    else:
        E, K = ellipe(1 / s**2), ellipk(1 / s**2)
        a = 4 / 3 * ((1 + s**2) * E + (1 - s**2) * K)
        b = 4 / 45 * ((7 * s - 2 * s**3 + 3 / s) * E + (-8 * s + 2 * s**3 + 6 / s) * K)
        d = 4 / 9 * ((4 * s - 2 * s**3) * E + (-5 * s + 2 * s**3 + 3 / s) * K)
    return a, b, d


def friction(vx: float, vy: float, rim: float, delta: float) -> tuple[float, float, float]:
    """Accelerations of vx, vy and rω for J = 1."""
    v = math.hypot(vx, vy)
    if abs(rim) <= 1e-13 * v:
        return (-vx / v, -vy / v, 0.0) if v else (0.0, 0.0, 0.0)
    if v <= 1e-13 * abs(rim):
        return 0.0, 0.0, math.copysign(4.0 / 3.0, -rim)
    q = math.hypot(v, rim)
    sine, cosine = abs(rim) / q, v / q
    a, b, d = sums(cosine / sine)
    a, b, d = a / (math.pi * cosine), b / (math.pi * sine), d / (math.pi * sine)
    denominator = 1 - delta**2 * sine**2 * b * (b - d)
    along = a / denominator
    across = delta * a * b / denominator * math.copysign(1.0, rim)
    turning = 2 * (d + delta**2 * cosine**2 * a * b * (d - 2 * b) / denominator)
    return (
        -along * vx / q + across * sine * vy / q,
        -along * vy / q - across * sine * vx / q,
        -turning * rim / q,
    )


def states(v0: tuple[float, float], rim: float, delta: float, times: np.ndarray) -> np.ndarray:
    """vx, vy, rω, x, y, body angle at times before the stop, for J = r = 1."""

    def rates(_: float, z: np.ndarray) -> list[float]:
        return [*friction(z[0], z[1], z[2], delta), z[0], z[1], z[2]]

    solution = solve_ivp(
        rates, (0.0, times[-1]), [*v0, rim, 0.0, 0.0, 0.0], "DOP853",
        rtol=1e-12, atol=1e-13, t_eval=times,
    )  # fmt: skip
    return solution.y
