"""Motions to put claims to: launches by slip ratio, and what is read off their states."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.puck import Puck
from puck_tables.trajectory import Trajectory

ACCURACY = 1e-13


class Simulate(Protocol):
    """What :func:`simulate` does, or something put to the test."""

    def __call__(
        self, velocity: npt.ArrayLike, spin: float, *, delta: float, frames: int | None = None,
        times: npt.ArrayLike | None = None,
    ) -> Trajectory: ...  # fmt: skip


def simulate(
    velocity: npt.ArrayLike, spin: float, *, delta: float, frames: int | None = None,
    times: npt.ArrayLike | None = None,
) -> Trajectory:  # fmt: skip
    """The motion with r = J = 1 by closed forms.

    >>> simulate((1.0, 0.0), 0.0, delta=0.5).stop_time
    1.0
    """
    puck = Puck.similar(delta=delta)
    return puck.simulate(velocity, spin, exact=True, tol=ACCURACY, frames=frames, times=times)


def launch(
    simulate: Simulate, ratio: float, delta: float, *, speed: float = 1.0, heading: float = 0.0,
    shares: npt.ArrayLike | None = None,
) -> Trajectory:  # fmt: skip
    """The motion (r = J = 1) launched with rω/v = ratio and Q = speed.

    ``shares`` are the times of its states, as shares of the stop time still left; 101 equally
    spaced states by default.

    >>> launch(simulate, 5.0, 0.5, shares=[1.0, 0.0]).slip_speed.tolist()
    [1.0, 0.0]
    """
    v = speed / math.hypot(1.0, ratio)
    spin = ratio * v if math.isfinite(ratio) else speed
    v0 = (v * math.cos(heading), v * math.sin(heading))

    def run(frames: int | None = None, times: npt.ArrayLike | None = None) -> Trajectory:
        return simulate(v0, spin, delta=delta, frames=frames, times=times)

    if shares is None:
        return run()
    return run(times=run(frames=1).stop_time * (1.0 - np.asarray(shares)))


def velocity(run: Trajectory) -> FloatArray:
    """(v_x, v_y) of every state, shape (n, 2).

    >>> velocity(simulate((3.0, 4.0), 0.0, delta=0.5))[0].round(12).tolist()
    [3.0, 4.0]
    """
    return np.stack([run.vx, run.vy], axis=-1)


def time_left(run: Trajectory) -> FloatArray:
    """How long before the stop each state is.

    >>> time_left(simulate((1.0, 0.0), 0.0, delta=0.5, times=[0.25])).tolist()
    [0.75]
    """
    return run.stop_time - run.time


def slip_ratio(run: Trajectory) -> FloatArray:
    """ε = rω/v of every state; the puck must be moving.

    >>> float(slip_ratio(simulate((1.0, 0.0), 5.0, delta=0.5, frames=1))[0].round(12))
    5.0
    """
    return run.puck.radius * run.spin / run.speed  # tan φ would lose digits next to π/2


def curvature_radius(friction_across: FloatArray, run: Trajectory) -> FloatArray:
    """R = Q² cos φ/(sin φ ρ_⊥ J), from mv²/R = F_⊥; ``friction_across`` is ρ_⊥ at the states.

    >>> from puck_tables import resultants
    >>> run = simulate((1.0, 0.0), 1.0, delta=1.0, frames=1)
    >>> across = resultants(run.slip_angle, 1.0).perpendicular
    >>> float(curvature_radius(across, run)[0].round(6))  # Q² = 2, ρ_⊥ = 0.37941 at π/4
    5.271341
    """
    phi = run.slip_angle
    across = np.sin(phi) * friction_across * run.puck.decel
    return np.asarray(run.slip_speed**2 * np.cos(phi) / across)
