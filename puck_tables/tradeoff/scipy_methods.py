"""What one would write without this program: scipy over time, the same physics (J = r = 1)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.closed_form_kernel import friction_ratios
from puck_tables.kernels.compile import allocating

# tolerances that reach about 1e-4, 1e-6, 1e-8, 1e-11 for usual starts; the absolute one has to be
# small, or the steps jump over the stop and the solver trembles there for ever
SCIPY_SETTINGS = (
    ("RK45", 1e-5, 1e-9),
    ("LSODA", 1e-5, 1e-7),
    ("LSODA", 1e-8, 1e-9),
    ("DOP853", 1e-6, 1e-10),
    ("DOP853", 1e-11, 1e-13),
)
PATCH_GRID = (20, 40)  # radial and angular patches
_END = 1e-8  # of Q, where the integration is called finished
_PATCH_END = 1e-3  # of Q₀, at which it counts as at rest
_MOST_CALLS = 20_000  # of the right-hand side: then it is given up


@allocating
def rates(t: float, state: FloatArray, delta: float) -> FloatArray:
    """d/dt of vx, vy, ω, x, y, friction by the compiled closed forms."""
    vx, vy, spin = state[0], state[1], state[2]
    speed, rim = math.hypot(vx, vy), abs(spin)
    q = math.hypot(speed, rim)
    fast = 1.0 if rim > speed else 0.0
    inverse, across, turning = friction_ratios(min(speed, rim) / max(speed, rim), fast, delta)
    along, left = -1.0 / (inverse * q), -across * spin / (inverse * q * q)
    out = np.empty(5)
    out[0] = along * vx - left * vy
    out[1] = along * vy + left * vx
    out[2] = -turning / inverse * spin / q
    out[3] = vx
    out[4] = vy
    return out


def _until_stopped(
    function: Any, launch: tuple[float, float, float], end: float, **options: Any
) -> FloatArray:
    """Time and place when the slip speed has fallen to ``end`` of its start; NaN if never."""
    from scipy.integrate import solve_ivp

    q0, calls = math.hypot(*launch), 0

    def left(t: float, state: FloatArray, *_: float) -> float:
        return math.hypot(state[0], state[1], state[2]) - end * q0

    def counted(t: float, state: FloatArray, *args: float) -> Any:
        nonlocal calls
        calls += 1
        if calls > _MOST_CALLS:  # stepped over the stop, where friction jumps, it trembles there
            raise TimeoutError
        return function(t, state, *args)

    left.terminal = True  # type: ignore[attr-defined]
    try:
        solution = solve_ivp(counted, (0.0, 2.0 * q0), [*launch, 0.0, 0.0], events=left, **options)
    except TimeoutError:
        return np.full(3, math.nan)
    if solution.status != 1:
        return np.full(3, math.nan)
    return np.array([solution.t[-1], *solution.y[3:, -1]])


def scipy_stop(
    method: str, rtol: float, atol: float, vx: float, vy: float, spin: float, delta: float
) -> FloatArray:
    """Stop time, x, y by ``solve_ivp`` on the closed forms.

    Examples
    --------
    >>> scipy_stop("DOP853", 1e-9, 1e-12, 1.0, 0.0, 5.0, 1.0).round(6).tolist()
    [4.000189, 2.257241, -0.308477]
    """
    return _until_stopped(
        rates, (vx, vy, spin), _END, method=method, rtol=rtol, atol=atol, args=(delta,)
    )


def patch_script(vx: float, vy: float, spin: float, delta: float) -> FloatArray:
    """Stop time, x, y with friction summed over patches and scipy's default tolerances.

    Examples
    --------
    >>> patch_script(1.0, 0.0, 5.0, 1.0).round(2).tolist()
    [4.0, 2.26, -0.31]
    """
    radial, angular = PATCH_GRID
    rho = (np.arange(radial) + 0.5) / radial
    angle = 2.0 * np.pi * (np.arange(angular) + 0.5) / angular
    x, y = np.outer(rho, np.cos(angle)).ravel(), np.outer(rho, np.sin(angle)).ravel()
    weight = np.repeat(rho / (rho.sum() * angular), angular)

    def motion(t: float, state: FloatArray) -> list[float]:
        u, v = state[0] - state[2] * y, state[1] + state[2] * x
        pull = -weight / np.sqrt(u * u + v * v)
        u, v = u * pull, v * pull
        # the friction force F tilts the pressure by -δ F·(x, y), which changes F
        tilted = np.array([[u @ x, u @ y], [v @ x, v @ y]])
        force = np.linalg.solve(np.eye(2) + delta * tilted, [u.sum(), v.sum()])
        pressure = 1.0 - delta * (force[0] * x + force[1] * y)
        torque = ((x * v - y * u) * pressure).sum()
        return [force[0], force[1], 2.0 * torque, state[0], state[1]]

    return _until_stopped(motion, (vx, vy, spin), _PATCH_END)
