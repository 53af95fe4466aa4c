"""What one would write without this program: scipy over time, the same physics (J = r = 1)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.closed_form_kernel import friction_ratios
from puck_tables.kernels.compile import allocating
from puck_tables.tradeoff.truth import Contender, Made, Question

# tolerances that reach about 1e-4, 1e-6, 1e-8, 1e-11 for usual starts; the absolute one has to be
# small, or the steps jump over the stop and the solver trembles there for ever
_SETTINGS = (
    ("RK45", 1e-5, 1e-9), ("LSODA", 1e-5, 1e-7), ("LSODA", 1e-8, 1e-9), ("DOP853", 1e-6, 1e-10),
    ("DOP853", 1e-11, 1e-13),
)  # fmt: skip
_GRID = (20, 40)  # radial and angular patches
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
    out[0], out[1] = along * vx - left * vy, along * vy + left * vx
    out[2], out[3], out[4] = -turning / inverse * spin / q, vx, vy
    return out


def _until_stopped(
    function: Any, start: tuple[float, ...], end: float, longest: float = 2.0, **options: Any
) -> FloatArray:
    """Time, x, y when Q of ``start`` has fallen to its ``end``; NaN if not within ``longest`` Q."""
    from scipy.integrate import solve_ivp

    q0, calls = math.hypot(*start[:3]), 0

    def left(t: float, state: FloatArray, *_: float) -> float:
        return math.hypot(*state[:3]) - end * q0

    def counted(t: float, state: FloatArray, *args: float) -> Any:
        nonlocal calls
        calls += 1
        if calls > _MOST_CALLS:  # stepped over the stop, where friction jumps, it trembles there
            raise TimeoutError
        return function(t, state, *args)

    left.terminal = True  # type: ignore[attr-defined]
    with suppress(TimeoutError):
        solution = solve_ivp(counted, (0.0, longest * q0), start, events=left, **options)
        if solution.status == 1:
            return np.array([solution.t[-1], *solution.y[3:5, -1]])
    return np.full(3, math.nan)


def scripted(stop: Callable[..., FloatArray], *fixed: Any) -> Made:
    """Nothing kept; ``stop`` asked of one launch after another: its velocities and what follows."""
    return None, lambda launches: np.stack([stop(*fixed, *one[:4]) for one in launches.T], axis=1)


def scipy_stop(
    method: str, rtol: float, atol: float, vx: float, vy: float, spin: float, delta: float
) -> FloatArray:
    """Stop time, x, y by ``solve_ivp`` on the closed forms."""
    return _until_stopped(
        rates, (vx, vy, spin, 0.0, 0.0), _END, method=method, rtol=rtol, atol=atol, args=(delta,)
    )


def scripts(easy: Question) -> Iterator[Contender]:
    """What one would write for stops of a homogeneous round puck."""
    for method, rtol, atol in _SETTINGS:
        make = partial(scripted, scipy_stop, method, rtol, atol)
        name, words = f"scipy {method}, closed forms", f"rtol={rtol:g} atol={atol:g}"
        yield Contender(easy, name, words, make, 1, outsider=True)
    words, make = f"patches={_GRID[0]}x{_GRID[1]}", partial(scripted, disc_by_patches)
    yield Contender(easy, "patches and scipy RK45", words, make, 1, outsider=True)


def patch_script(
    points: FloatArray, weights: FloatArray, gyration: float, height: float, gravity: float,
    friction: Callable[[FloatArray], FloatArray],
) -> Callable[[float, float, float], FloatArray]:  # fmt: skip
    """A function of vx, vy, ω to stop time, x, y: friction summed over patches, scipy's defaults.

    ``points`` (2, n), m, from the centre of mass, with ``weights`` (n,); ``gyration`` k and
    ``height`` of the centre of mass, m; ``gravity``, m/s²; ``friction``: at slip speeds (n,).
    """
    inertia = np.linalg.inv(weights * points @ points.T)

    def motion(t: float, state: FloatArray) -> list[float]:
        spin, cosine, sine = state[2] / gyration, math.cos(state[5]), math.sin(state[5])
        turn = np.array([[cosine, -sine], [sine, cosine]])
        x, y = turn @ points
        slip = np.stack([state[0] - spin * y, state[1] + spin * x])
        speed = np.hypot(*slip)
        pull = -weights * friction(speed) * slip / speed
        # the force F at the height of the centre of mass tilts the pressure, which changes F
        tilt = height * turn @ inertia @ turn.T
        force = np.linalg.solve(np.eye(2) + pull @ np.stack([x, y]).T @ tilt, pull.sum(axis=1))
        pressure = 1.0 - force @ tilt @ np.stack([x, y])
        torque = ((x * pull[1] - y * pull[0]) * pressure).sum()
        return [*(gravity * force), gravity * torque / gyration, state[0], state[1], spin]

    def stop(vx: float, vy: float, spin: float) -> FloatArray:
        launch = vx, vy, gyration * spin
        least = gravity * float(friction(np.array([math.hypot(*launch)]))[0])
        return _until_stopped(motion, (*launch, 0.0, 0.0, 0.0), _PATCH_END, 4.0 / least)

    return stop


def ring_patches(
    inner: float, outer: float, radial: int, angular: int
) -> tuple[FloatArray, FloatArray]:
    """Centres of patches between two radii, (2, n), and their weights, in proportion to areas."""
    radii = inner + (outer - inner) * (np.arange(radial) + 0.5) / radial
    angle = 2.0 * np.pi * (np.arange(angular) + 0.5) / angular
    points = np.multiply.outer(np.stack([np.cos(angle), np.sin(angle)]), radii).reshape(2, -1)
    weights = np.tile(radii, angular)
    return points, weights / weights.sum()


def disc_by_patches(vx: float, vy: float, spin: float, delta: float) -> FloatArray:
    """Stop time, x, y of a homogeneous round puck (J = r = 1) by such a script."""
    points, weights = ring_patches(0.0, 1.0, *_GRID)
    return patch_script(points, weights, 0.5**0.5, 0.25 * delta, 1.0, np.ones_like)(vx, vy, spin)
